//! The errors of a mesh compared with a demand.

use super::extrapolation::LEAST_ORDER;
use super::quantities::{formal_order, is_demanded_with_all, quantities};
use crate::number::percent;
use crate::results::{Accuracy, QuantityError, Results};
use crate::scene::AccuracyDemand;

/// The next mesh is chosen for an error of this fraction of the demanded one, so that the demand is
/// not narrowly missed.
const AIM: f64 = 0.8;
/// Two fractions of the demand. If the error of the path exceeds the first one and the error of the
/// mesh, the increments are made finer, so that the path's error falls to the second one.
pub(super) const PATH: [f64; 2] = [0.5, 0.25];

/// A quantity beyond its demand.
pub(super) struct Missed {
    pub path: String,
    pub relative: f64,
    pub order: Option<f64>,
}

/// The errors of a mesh compared with the demand.
#[derive(Default)]
pub(super) struct Outcome {
    /// Relative error of the quantity that is farthest beyond its demand, or nearest to it if none
    /// is beyond; NaN if no error is known.
    pub stated: f64,
    pub worst: Option<String>,
    /// Quantities whose error is not known.
    pub unknown: Vec<String>,
    /// Quantities beyond their demand.
    pub missed: Vec<Missed>,
    /// Largest error due to the mesh, to the path and to the algebra, as fractions of the demand.
    pub mesh: f64,
    pub path: f64,
    pub algebra: f64,
    /// How many times finer the mesh has to be.
    pub finer: f64,
    pub is_of_nothing: bool,
}

impl Outcome {
    pub(super) fn of(demand: &AccuracyDemand, results: &Results, found: &Accuracy) -> Self {
        let mut out = Outcome {
            stated: f64::NAN,
            finer: 1.0,
            is_of_nothing: true,
            ..Outcome::default()
        };
        let mut excess = 0.0;
        for (quantity, errors) in quantities(results).iter().zip(&found.quantities) {
            // A demand does not include figures of parts of a state.
            if quantity.is_of_part() {
                continue;
            }
            let all = demand.all().filter(|_| is_demanded_with_all(quantity.kind));
            let Some(wanted) = demand.named(&quantity.path).or(all) else {
                continue;
            };
            out.is_of_nothing = false;
            let is_zero = quantity.scale == 0.0 && errors.error == Some(0.0);
            let Some(relative) = errors.relative_error.or(is_zero.then_some(0.0)) else {
                out.unknown.push(quantity.path.clone());
                continue;
            };
            if out.worst.is_none() || relative / wanted > excess {
                excess = relative / wanted;
                out.stated = relative;
                out.worst = Some(quantity.path.clone());
            }
            if quantity.scale > 0.0 {
                let formal = formal_order(quantity.kind, results.sizes.degree);
                out.add(errors, [relative, wanted, quantity.scale], formal);
            }
        }
        out
    }

    fn add(&mut self, errors: &QuantityError, of: [f64; 3], formal: f64) {
        let [relative, wanted, scale] = of;
        let share = |error: f64| error / scale / wanted;
        let [mesh, path, algebra] = [
            errors.discretisation.unwrap_or(0.0),
            errors.path.unwrap_or(0.0),
            errors.algebraic,
        ]
        .map(share);
        self.mesh = self.mesh.max(mesh);
        self.path = self.path.max(path);
        self.algebra = self.algebra.max(algebra);
        if relative <= wanted {
            return;
        }
        self.missed.push(Missed {
            path: errors.quantity.clone(),
            relative,
            order: errors.order,
        });
        // An order above the formal one belongs to coarse meshes, and an order below the believed
        // ones means nothing.
        let order = errors.order.filter(|order| *order >= LEAST_ORDER);
        let order = order.map(|order| order.min(formal));
        let left = (1.0 - path - algebra).max(1.0 - PATH[0]);
        let finer = (mesh / (AIM * left)).powf(1.0 / order.unwrap_or(1.0));
        self.finer = self.finer.max(finer);
    }

    pub(super) fn is_within(&self) -> bool {
        self.unknown.is_empty() && self.missed.is_empty()
    }

    pub(super) fn words(&self) -> String {
        let worst = self.worst.iter().map(|worst| format!(" ({worst})"));
        let mut out = percent(self.stated);
        out.extend(worst);
        if !self.unknown.is_empty() {
            out += &format!(", none for {}", self.unknown.join(", "));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::State;

    /// A run with one state of load 10, and the parts of the error of its load.
    fn judged(demand: &str, parts: [f64; 3], order: f64) -> Outcome {
        let state = State {
            name: "pressed".into(),
            load: 10.0,
            ..State::default()
        };
        let results = Results {
            states: vec![state],
            ..Results::default()
        };
        let row = |quantity: &str, value: f64| QuantityError {
            quantity: quantity.to_string(),
            value,
            error: Some(parts.iter().sum()),
            relative_error: (value > 0.0).then(|| parts.iter().sum::<f64>() / value),
            discretisation: Some(parts[0]),
            path: Some(parts[1]),
            algebraic: parts[2],
            order: Some(order),
            extrapolated: (order > 0.5).then_some(value),
        };
        let found = Accuracy {
            quantities: vec![
                row("states.pressed.load", 10.0),
                row("states.pressed.approach", 0.0),
            ],
            ..Accuracy::default()
        };
        let demand = AccuracyDemand::try_from(demand.to_string()).unwrap();
        Outcome::of(&demand, &results, &found)
    }

    #[test]
    fn a_demand_is_judged_by_what_it_names() {
        let near = judged("load = 1 %", [0.09, 0.0, 0.0], 2.0);
        assert!(near.is_within() && (near.stated - 0.009).abs() < 1e-12);
        assert_eq!(near.worst.as_deref(), Some("states.pressed.load"));
        // The approach is zero but its error is not: its relative error is unknown, so a demand on
        // all quantities is not met.
        let all = judged("1 %", [0.09, 0.0, 0.0], 2.0);
        assert!(!all.is_within());
        assert_eq!(all.unknown, ["states.pressed.approach"]);
        assert!(judged("dent = 1 %", [0.0; 3], 2.0).is_of_nothing);
    }

    /// Of several demands, the worst quantity is the farthest beyond its own, not the least
    /// accurate.
    #[test]
    fn the_worst_is_the_farthest_beyond_its_demand() {
        let state = State {
            name: "pressed".into(),
            load: 10.0,
            approach: 2.0,
            ..State::default()
        };
        let results = Results {
            states: vec![state],
            ..Results::default()
        };
        let row = |path: &str, value: f64, relative: f64| QuantityError {
            quantity: path.to_string(),
            value,
            error: Some(relative * value),
            relative_error: Some(relative),
            discretisation: Some(relative * value),
            path: None,
            algebraic: 0.0,
            order: Some(2.0),
            extrapolated: None,
        };
        let all = quantities(&results);
        let rows = all.iter().map(|quantity| match quantity.kind {
            "load" => row(&quantity.path, quantity.value, 0.02),
            _ => row(&quantity.path, quantity.value, 0.05),
        });
        let found = Accuracy {
            quantities: rows.collect(),
            ..Accuracy::default()
        };
        let demand = AccuracyDemand::try_from("load = 1 %, approach = 10 %".to_string()).unwrap();
        let outcome = Outcome::of(&demand, &results, &found);
        assert_eq!(outcome.worst.as_deref(), Some("states.pressed.load"));
        assert_eq!(outcome.stated, 0.02);
    }

    #[test]
    fn the_next_mesh_follows_from_the_order() {
        // Four times beyond the demand, with second order: twice as fine, and a little for the aim.
        let second = judged("load = 1 %", [0.4, 0.0, 0.0], 2.0);
        assert!((second.finer - (4.0f64 / AIM).sqrt()).abs() < 1e-12);
        let unbelieved = judged("load = 1 %", [0.4, 0.0, 0.0], 0.3);
        assert!((unbelieved.finer - 4.0 / AIM).abs() < 1e-12);
        let slow = judged("load = 1 %", [0.4, 0.0, 0.0], -0.2);
        assert_eq!(slow.missed[0].path, "states.pressed.load");
        assert_eq!(slow.missed[0].order, Some(-0.2));
        let path = judged("load = 1 %", [0.02, 0.09, 0.0], 2.0);
        assert!((path.path - 0.9).abs() < 1e-12 && path.mesh < 0.3 && !path.is_within());
    }
}
