//! Names of the quantities of a run for readers, and the names of their units: the scene's names if
//! it gives them, else nothing. Keys and columns for programs keep their names.

use crate::model::{Magnitude, Model};
use crate::results::{Quantity, Unit};
use crate::scene;
use crate::space::Space;
use serde::{Deserialize, Serialize};

/// Words for the numbers of a run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Labels {
    units: Option<UnitNames>,
    /// Whether forces are per thickness.
    is_plane: bool,
    /// Meaning of the half width of the contact.
    extent: ContactExtent,
}

/// Names of units as they appear beside numbers and in `summary.json`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(super) struct UnitNames {
    length: String,
    force: String,
    stress: String,
    /// Unit of the total load.
    load: String,
}

/// Meaning of the half width of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum ContactExtent {
    /// Half the width of a strip.
    #[default]
    HalfWidth,
    /// The radius of a circle round the axis.
    Radius,
    /// The smaller half axis of a patch.
    SmallerHalfAxis,
}

impl Labels {
    /// Labels of the results of a model.
    pub fn of(model: &Model) -> Self {
        let is_plane = !model.kind.is_axisymmetric() && !model.kind.is_solid();
        let units = model.scene.units.clone().map(|names| UnitNames {
            load: load_unit(model, &names, is_plane),
            length: names.length,
            force: names.force,
            stress: names.stress,
        });
        // A contact that begins at the axis is a circle.
        let is_on_axis = |slave: usize| model.mesh.point(slave)[0] == 0.0;
        let reaches_axis = model.contacts.iter().any(|contact| contact.axis.is_some())
            || model.pairs.iter().any(|pair| is_on_axis(pair.slave));
        let extent = match model.kind {
            Space::Solid => ContactExtent::SmallerHalfAxis,
            Space::Axisymmetric if reaches_axis => ContactExtent::Radius,
            _ => ContactExtent::HalfWidth,
        };
        Labels {
            units,
            is_plane,
            extent,
        }
    }

    /// Returns the labels recorded in `summary.json` for a run of this kind.
    pub(super) fn recorded(
        kind: &str,
        units: Option<UnitNames>,
        extent: Option<ContactExtent>,
    ) -> Self {
        let plane = [Space::PlaneStrain, Space::PlaneStress];
        Labels {
            units,
            is_plane: plane.iter().any(|space| space.name() == kind),
            extent: extent.unwrap_or_default(),
        }
    }

    /// The names of the units for `summary.json`.
    pub(super) fn units(&self) -> Option<UnitNames> {
        self.units.clone()
    }

    /// Returns the meaning of the half width, for `summary.json`.
    pub(super) fn extent(&self) -> ContactExtent {
        self.extent
    }

    /// Unit of lengths; empty if none is named.
    pub fn length(&self) -> &str {
        self.units.as_ref().map_or("", |names| &names.length)
    }

    /// Unit of stresses; empty if none is named.
    pub fn stress(&self) -> &str {
        self.units.as_ref().map_or("", |names| &names.stress)
    }

    /// Unit of the total load; empty if none is named.
    pub fn load(&self) -> &str {
        self.units.as_ref().map_or("", |names| &names.load)
    }

    /// Unit of a quantity; empty if none is named.
    pub fn unit(&self, unit: Unit) -> String {
        let Some(names) = &self.units else {
            return String::new();
        };
        let (force, length) = (&names.force, &names.length);
        match unit {
            Unit::One => String::new(),
            Unit::Length => length.clone(),
            Unit::Stress => names.stress.clone(),
            Unit::Load => names.load.clone(),
            Unit::Area if self.is_plane => length.clone(),
            Unit::Area => format!("{length}\u{b2}"),
            Unit::Size if self.is_plane => format!("{length}\u{b2}"),
            Unit::Size => format!("{length}\u{b3}"),
            // Work is per unit thickness.
            Unit::Work if self.is_plane => force.clone(),
            Unit::Work => format!("{force} {length}"),
        }
    }

    /// Returns the labels of the two axes of a plane picture.
    pub fn axes(&self, space: Space) -> [String; 2] {
        let names = space.axes();
        [0, 1].map(|axis| labelled(names[axis], self.length()))
    }

    /// Returns the name of the half width of the contact.
    pub fn half_width(&self) -> &'static str {
        match self.extent {
            ContactExtent::HalfWidth => "half width",
            ContactExtent::Radius => "contact radius",
            ContactExtent::SmallerHalfAxis => "smaller half axis",
        }
    }

    /// Returns the heading of a quantity's column, in lines.
    pub fn heading(&self, quantity: &Quantity) -> &'static str {
        match (quantity.key, self.extent) {
            ("half_width", ContactExtent::Radius) => "contact\nradius",
            ("half_width", ContactExtent::SmallerHalfAxis) => "smaller\nhalf axis",
            _ => quantity.heading,
        }
    }

    /// Returns a quantity's name in one line, with its unit.
    pub fn name(&self, quantity: &Quantity) -> String {
        labelled(&in_line(self.heading(quantity)), &self.unit(quantity.unit))
    }
}

/// Returns the unit of the total load, that of the leading load. Displacements and gaps are stated
/// by the force that they take; temperatures and strains have no named unit.
fn load_unit(model: &Model, names: &scene::Units, is_plane: bool) -> String {
    let leading = model.leading_load().and_then(|load| model.loads.get(load));
    match leading.map(|load| load.measures) {
        Some(Magnitude::Stress) => names.stress.clone(),
        Some(Magnitude::Temperature | Magnitude::Strain | Magnitude::Carried) => String::new(),
        None | Some(Magnitude::Force | Magnitude::Displacement | Magnitude::Gap) if is_plane => {
            format!("{}/{}", names.force, names.length)
        }
        None | Some(Magnitude::Force | Magnitude::Displacement | Magnitude::Gap) => {
            names.force.clone()
        }
    }
}

/// Joins a heading of several lines into one line.
pub(crate) fn in_line(heading: &str) -> String {
    heading.replace("-\n", "").replace('\n', " ")
}

/// The text with a capital first letter.
#[cfg(feature = "report")]
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next();
    first
        .into_iter()
        .flat_map(char::to_uppercase)
        .chain(letters)
        .collect()
}

/// Returns `name [unit]`, or the name alone if the unit is empty.
pub(crate) fn labelled(name: &str, unit: &str) -> String {
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

    fn labels(name: &str, with_units: bool) -> Labels {
        let root = env!("CARGO_MANIFEST_DIR");
        let mut scene = Scene::load(format!("{root}/data/scenes/{name}.toml")).unwrap();
        scene.units = scene.units.filter(|_| with_units);
        Labels::of(&Model::new(&scene).unwrap())
    }

    /// The load is per length in the plane and that of the whole about an axis; a pressure is a
    /// stress, and a temperature has no named unit.
    #[test]
    fn the_unit_of_the_load_is_that_of_what_loads() {
        for (name, expected) in [
            ("cylinder_on_half_plane", "N/mm"),
            ("ball_on_half_space", "N"),
            ("ball_on_flat_3d", "N"),
            ("thick_cylinder", "MPa"),
            ("shrink_fit", "N/mm"),
            ("fit_by_heat", ""),
        ] {
            assert_eq!(labels(name, true).load(), expected, "{name}");
        }
        assert_eq!(labels("contact_patch", false).load(), "");
    }

    /// The name "radius" is only used for a contact round the axis, not for every axisymmetric
    /// contact.
    #[test]
    fn a_half_width_is_called_what_it_is() {
        let width = Quantity::of("half_width").unwrap();
        for (name, expected) in [
            ("cylinder_on_half_plane", "half width [mm]"),
            ("ball_on_half_space", "contact radius [mm]"),
            ("ball_on_flat_3d", "smaller half axis [mm]"),
        ] {
            assert_eq!(labels(name, true).name(width), expected, "{name}");
        }
    }
}
