//! What a trial of a demand says: whether it is reached, what is not known, and which mesh to try next.

use super::estimate::{SAFETY_OF_LAW, highest_order};
use super::limit::{SHARE, has_limit};
use super::quantities::{Quantity, quantities};
use super::refusal::percent;
use crate::results::{Accuracy, QuantityError, Results};

/// What is left to the path beside the mesh: so many times what it takes on this one.
const PATH_MARGIN: f64 = 2.0;
/// Share of the demand that the path may take.
pub(super) const PATH_SHARE: f64 = 1.0 / 3.0;
/// What is aimed at, of what is demanded: the error of a contact edge scatters.
pub(super) const AIM: f64 = 0.85;
/// Least step to the next mesh: one that is hardly finer says nothing new.
pub(super) const LEAST_STEP: f64 = 1.15;
/// The same from the foot, whose error is stated from one other mesh: its mesh for comparison must tell something there too.
const FIRST_STEP: f64 = 1.5;
/// Sums of parts of an error agree to so much.
const ROUND_OFF: f64 = 1e-12;

/// What a run says about the next.
pub(super) struct Outcome {
    /// Largest stated relative error of the governing quantities; NaN where none is known.
    pub stated: f64,
    /// Which quantity has it.
    pub worst: Option<String>,
    /// Quantities whose error was not estimated.
    pub unknown: Vec<String>,
    /// Largest part of the path.
    pub path: f64,
    /// Largest part of the algebra.
    pub algebraic: f64,
    /// How many times finer the mesh must be.
    pub refinement: f64,
    /// The same with the highest order and the safety factor left out.
    pub least: f64,
    /// Share of the demand that is left to the mesh.
    pub mesh_share: f64,
}

/// A run that was tried.
pub(super) struct Trial<'r> {
    pub results: &'r Results,
    /// Its errors.
    pub found: &'r Accuracy,
    pub demand: f64,
    /// Order of convergence of the elements.
    pub order: f64,
}

impl Outcome {
    /// Judges a trial.
    pub(super) fn of(trial: &Trial) -> Self {
        let Trial {
            results,
            found,
            demand,
            ..
        } = *trial;
        let mut out = Outcome {
            stated: f64::NAN,
            worst: None,
            unknown: Vec::new(),
            path: 0.0,
            algebraic: 0.0,
            refinement: 1.0,
            least: 1.0,
            mesh_share: 1.0,
        };
        for (quantity, errors) in quantities(results).iter().zip(&found.quantities) {
            if !quantity.governs {
                continue;
            }
            match relative(quantity, errors) {
                None => out.unknown.push(quantity.path.clone()),
                Some(error) => out.add(trial, quantity, errors, error),
            }
        }
        // A mesh that is not finer says nothing new.
        if !out.within(demand) {
            let least = match found.companions.len() {
                0 | 1 => FIRST_STEP,
                _ => LEAST_STEP,
            };
            out.refinement = out.refinement.max(least);
        }
        out
    }

    /// Whether all are within the demand: what was never estimated is not.
    pub(super) fn within(&self, demand: f64) -> bool {
        self.unknown.is_empty() && self.stated <= demand
    }

    fn add(&mut self, trial: &Trial, quantity: &Quantity, errors: &QuantityError, relative: f64) {
        let Trial { demand, order, .. } = *trial;
        if self.stated.is_nan() || relative > self.stated {
            self.stated = relative;
            self.worst = Some(errors.quantity.clone());
        }
        if quantity.scale == 0.0 {
            return;
        }
        let path = errors.path.unwrap_or(0.0) / quantity.scale;
        let mesh = relative - path - errors.algebraic / quantity.scale;
        self.path = self.path.max(path);
        self.algebraic = self.algebraic.max(errors.algebraic / quantity.scale);
        let share = 1.0 - (PATH_MARGIN * path / demand).min(PATH_SHARE);
        self.mesh_share = self.mesh_share.min(share);
        if relative <= demand {
            return;
        }
        let discretisation = errors.discretisation.unwrap_or(0.0) / quantity.scale;
        // One coarser mesh states with the lowest order, which is not that with which finer ones will be judged.
        let mesh = match trial.found.companions.as_slice() {
            [other] => {
                let (error, safety) = of_mesh(errors, 1);
                let r = other.ratio;
                safety * error * (r - 1.0) / (r.powf(order) - 1.0) / quantity.scale
            }
            _ => mesh,
        };
        let needed = mesh / (AIM * share * demand);
        let highest = highest_order(trial.results, &quantity.path);
        self.least = self
            .least
            .max((discretisation / demand).powf(1.0 / highest));
        let order = errors.order.unwrap_or(order);
        self.refinement = self.refinement.max(needed.powf(1.0 / order));
    }
}

/// The discretisation error of a quantity on the mesh itself, and the share of it that is stated of the reported value where three meshes follow a law.
pub(super) fn of_mesh(errors: &QuantityError, companions: usize) -> (f64, f64) {
    let stated = errors.discretisation.unwrap_or(0.0);
    let own = errors.of_mesh.map_or(stated, |own| own.discretisation);
    let extrapolated = match companions {
        // What the next mesh, judged by more, will make of it.
        0 | 1 => has_limit(&errors.quantity),
        _ => errors.of_mesh.is_some() && is_extrapolated(errors),
    };
    (own, if extrapolated { SHARE } else { SAFETY_OF_LAW })
}

/// Whether a value that is not that of its mesh is extrapolated from several, and not corrected for the increments alone: then what is stated of the mesh is
/// the error of the limit, without a factor of safety.
fn is_extrapolated(errors: &QuantityError) -> bool {
    let (Some(error), Some(discretisation)) = (errors.error, errors.discretisation) else {
        return false;
    };
    let of_limit = discretisation + errors.path.unwrap_or(0.0) + errors.algebraic;
    has_limit(&errors.quantity) && (error - of_limit).abs() <= ROUND_OFF * error
}

/// The stated error over the largest size of the quantity. A quantity that is zero in the whole run, on other meshes too, is known.
fn relative(quantity: &Quantity, errors: &QuantityError) -> Option<f64> {
    let relative = errors.relative_error.filter(|e| e.is_finite());
    relative.or_else(|| errors.error.filter(|e| *e == 0.0 && quantity.scale == 0.0))
}

/// What a trial came to, in words.
pub(super) fn told(outcome: &Outcome) -> String {
    let worst = outcome.worst.as_ref();
    let mut out = percent(outcome.stated);
    out += &worst.map_or(String::new(), |w| format!(" ({w})"));
    if !outcome.unknown.is_empty() {
        out += &format!(", none for {}", outcome.unknown.join(", "));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::quantities::pressed;
    use super::*;
    use crate::results::{Companion, OfMesh};

    /// A run with one state, and the errors of its quantities: load, approach.
    fn run(load: f64, approach: f64, errors: [Option<f64>; 2]) -> (Results, Accuracy) {
        let results = pressed(load, approach);
        let mut found = Accuracy::default();
        for ratio in [2.0, 3.0] {
            found.companions.push(Companion {
                ratio,
                freedoms: 10,
                seconds: 0.0,
            });
        }
        for (quantity, error) in quantities(&results).iter().zip(errors) {
            let scale = quantity.scale;
            found.quantities.push(QuantityError {
                quantity: quantity.path.clone(),
                value: quantity.value,
                error,
                relative_error: error.filter(|_| scale > 0.0).map(|e| e / scale),
                discretisation: error.map(|e| e / 2.0),
                path: Some(0.0),
                algebraic: 0.0,
                order: Some(2.0),
                of_mesh: None,
            });
        }
        (results, found)
    }

    fn judged(case: &(Results, Accuracy)) -> Outcome {
        Outcome::of(&Trial {
            results: &case.0,
            found: &case.1,
            demand: 0.01,
            order: 2.0,
        })
    }

    #[test]
    fn what_was_never_estimated_is_not_reached() {
        let known = judged(&run(10.0, 2.0, [Some(0.05), Some(0.01)]));
        assert!(known.within(0.01) && known.unknown.is_empty());
        let unknown = judged(&run(10.0, 2.0, [Some(0.05), None]));
        assert!(!unknown.within(0.01) && unknown.stated <= 0.01);
        assert!(unknown.refinement >= LEAST_STEP, "a finer mesh may have it");
        assert_eq!(unknown.unknown, ["states.pressed.approach"]);
        let not_a_number = judged(&run(10.0, 2.0, [Some(0.05), Some(f64::NAN)]));
        assert!(!not_a_number.within(0.01));
        // Nothing at all.
        assert!(!judged(&run(10.0, 2.0, [None, None])).within(0.01));
    }

    #[test]
    fn a_zero_is_known_where_other_meshes_have_it_too() {
        assert!(judged(&run(10.0, 0.0, [Some(0.05), Some(0.0)])).within(0.01));
        assert!(!judged(&run(10.0, 0.0, [Some(0.05), Some(1e-3)])).within(0.01));
    }

    /// What is stated of a half width that was corrected for the increments alone is still that of its mesh.
    #[test]
    fn a_correction_for_the_increments_leaves_the_error_of_the_mesh() {
        let (_, found) = run(10.0, 2.0, [Some(0.05), Some(0.01)]);
        let mut row = found.quantities[0].clone();
        assert_eq!(of_mesh(&row, 2), (0.025, SAFETY_OF_LAW));
        row.of_mesh = Some(OfMesh {
            value: 9.0,
            error: 0.08,
            discretisation: 0.025,
        });
        row.path = Some(0.01);
        row.error = Some(SAFETY_OF_LAW * 0.025 + 0.01);
        assert_eq!(of_mesh(&row, 2), (0.025, SAFETY_OF_LAW));
        // Extrapolated, once with an error as large as that of the mesh.
        for error in [0.015, 0.025] {
            row.discretisation = Some(error);
            row.error = Some(error + 0.01);
            assert_eq!(of_mesh(&row, 2), (0.025, SHARE));
        }
        row.quantity = "states.pressed.half_width".into();
        assert_eq!(of_mesh(&row, 1), (0.025, SAFETY_OF_LAW));
        assert_eq!(of_mesh(&row, 2), (0.025, SAFETY_OF_LAW));
    }
}
