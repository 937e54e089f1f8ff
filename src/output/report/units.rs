//! Units and labels: the scene's names where it gives them, else nothing.

use crate::model::{LoadCase, Magnitude, Model};
use crate::results::Unit;
use crate::scene;
use crate::space::Space;

/// Names of units as they stand beside numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Units {
    names: Option<scene::Units>,
    /// Of the total load.
    load: String,
    /// Whether forces are per thickness.
    is_plane: bool,
}

impl Units {
    /// Those of a model.
    pub(super) fn of(model: &Model) -> Self {
        let names = model.scene.units.clone();
        let is_plane = !model.kind.is_axisymmetric() && !model.kind.is_solid();
        let load = names.as_ref().map_or(String::new(), |names| {
            // The first load that varies is what the total load is said of; of a displacement it is
            // the force that it takes.
            let varies = |load: &&LoadCase| load.history != scene::History::Constant;
            let leading = model.loads.iter().find(varies).or(model.loads.first());
            match leading.map(|load| load.measures) {
                Some(Magnitude::Stress) => names.stress.clone(),
                _ if !is_plane => names.force.clone(),
                _ => format!("{}/{}", names.force, names.length),
            }
        });
        Units {
            names,
            load,
            is_plane,
        }
    }

    /// Of lengths.
    pub(super) fn length(&self) -> &str {
        self.names.as_ref().map_or("", |names| &names.length)
    }

    /// Of stresses.
    pub(super) fn stress(&self) -> &str {
        self.names.as_ref().map_or("", |names| &names.stress)
    }

    /// Of the total load.
    pub(super) fn load(&self) -> &str {
        &self.load
    }

    /// Of a quantity.
    pub(super) fn of_quantity(&self, unit: Unit) -> String {
        let Some(names) = &self.names else {
            return String::new();
        };
        let (force, length) = (&names.force, &names.length);
        match unit {
            Unit::One => String::new(),
            Unit::Length => length.clone(),
            Unit::Stress => names.stress.clone(),
            Unit::Load => self.load.clone(),
            Unit::Size if self.is_plane => format!("{length}\u{b2}"),
            Unit::Size => format!("{length}\u{b3}"),
            // Per unit thickness.
            Unit::Work if self.is_plane => force.clone(),
            Unit::Work => format!("{force} {length}"),
        }
    }

    /// Labels of the axes of the plane.
    pub(super) fn axes(&self, space: Space) -> [String; 2] {
        let names = space.axes();
        [0, 1].map(|axis| labelled(names[axis], self.length()))
    }
}

/// `name [unit]`, or the name alone.
pub(super) fn labelled(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_string()
    } else {
        format!("{name} [{unit}]")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Per length in the plane, of the whole about an axis; a pressure is a stress.
    #[test]
    fn the_unit_of_the_load_is_that_of_what_loads() {
        for (name, expected) in [
            ("cylinder_on_half_plane", "N/mm"),
            ("ball_on_half_space", "N"),
            ("ball_on_flat_3d", "N"),
            ("thick_cylinder", "MPa"),
            ("contact_patch", ""),
        ] {
            let root = env!("CARGO_MANIFEST_DIR");
            let mut scene = Scene::load(format!("{root}/data/scenes/{name}.toml")).unwrap();
            if expected.is_empty() {
                scene.units = None;
            }
            let units = Units::of(&Model::new(&scene).unwrap());
            assert_eq!(units.load(), expected, "{name}");
        }
    }
}
