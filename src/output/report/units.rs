//! Units and labels: the scene's names where it gives them, else nothing.

use crate::model::{LoadCase, Magnitude, Model};
use crate::scene::{self, Kind};

/// Names of units as they stand beside numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Units {
    names: Option<scene::Units>,
    /// Of the total load.
    load: String,
}

impl Units {
    /// Those of a model.
    pub(super) fn of(model: &Model) -> Self {
        let names = model.scene.units.clone();
        let load = names.as_ref().map_or(String::new(), |names| {
            // The first load that varies is what the total load is said of; of a displacement it is the force that it takes.
            let varies = |load: &&LoadCase| load.history != scene::History::Constant;
            let leading = model.loads.iter().find(varies).or(model.loads.first());
            match leading.map(|load| load.measures) {
                Some(Magnitude::Stress) => names.stress.clone(),
                _ if model.kind == Kind::Axisymmetric => names.force.clone(),
                _ => format!("{}/{}", names.force, names.length),
            }
        });
        Units { names, load }
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

    /// Labels of the axes of the plane.
    pub(super) fn axes(&self, kind: Kind) -> [String; 2] {
        let names = match kind {
            Kind::Axisymmetric => ["r", "z"],
            _ => ["x", "y"],
        };
        names.map(|name| labelled(name, self.length()))
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
