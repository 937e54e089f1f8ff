//! What an increment is predicted by: the rates of state with the share of the piece.

use super::outcome::NoIncrement;
use super::step_length::{positive_values, step_limit};
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;

/// Accuracy (energy norm) of the tangent that predicts an increment: what yields anew on the way
/// changes more than that.
const PREDICTION: f64 = 0.02;

/// A change of contact in this last share of a piece counts as its end: the target comes first.
pub(super) const AT_END: f64 = 1e-9;
/// A share of the increment below this means that a pair changes at once.
pub(super) const AT_ONCE: f64 = 1e-12;
/// Share of the largest rate below which a rate beyond a border is round-off.
const BEYOND: f64 = 1e-9;

/// Changes of the state over the whole piece, as they begin.
pub(super) struct Prediction {
    pub(super) rates: Equilibrium,
    /// Factor by which the rates were stretched since their loads were eliminated.
    pub(super) stretched: f64,
}

impl Prediction {
    /// Rates that are elastic (4.5), plus plastic where points yield. The plastic part goes on as
    /// in the last increment; after none it is that of the `tangent`, if that is asked for. An
    /// increment that `is_long`, over the share `most` of the piece, stretches it.
    pub(super) fn of_rates(
        solver: &mut Solver,
        (end, most): (&LoadPoint, f64),
        tangent: bool,
        is_long: bool,
    ) -> Self {
        let mut stretched = 1.0;
        if let (Some(pace), true) = (&solver.predictor.pace, is_long) {
            let ratio = most * solver.at.distance(end) / pace.distance;
            stretched = pace.stretched * f64::max(ratio, 1.0);
        }
        let yields = tangent && !solver.zone.is_idle();
        let pace = solver.predictor.pace.as_ref().filter(|_| yields);
        let needs_tangent = yields && pace.is_none();
        let mut initial = solver.now.initial.clone();
        if let Some(pace) = pace {
            initial.add(solver.at.distance(end), &pace.initial);
        }
        // `now` may have been in equilibrium with other statuses, or off by gamma: its own statuses
        // decide.
        let mut rates = solver.respond(end, initial);
        rates.add(-1.0, &solver.now);
        if needs_tangent {
            let mut driven = solver.structure.sub.zeros();
            solver.zone.softening_times(&rates.u, &mut driven);
            let plastic = solver.solve_tangent(&driven, PREDICTION, 1.0);
            rates.add(1.0, &plastic);
        }
        Prediction { rates, stretched }
    }

    /// Rates that lead to a state which is known already, statuses being the same.
    pub(super) fn secant(
        solver: &Solver,
        end: &LoadPoint,
        (at, state): (LoadPoint, Equilibrium),
    ) -> Self {
        let mut rates = state;
        rates.rescale(&solver.now, 1.0 / solver.at.share_of(&at, end));
        rates.add(-1.0, &solver.now);
        Prediction {
            rates,
            stretched: 1.0,
        }
    }

    /// The share of the piece at which contact changes by the prediction, at most `most`: from the
    /// values at the start, some pairs being exempt.
    ///
    /// # Errors
    /// Pairs that change at once.
    pub(super) fn first_length(
        &self,
        solver: &Solver,
        (base, exempt): (&[f64], &[usize]),
        most: f64,
    ) -> Result<f64, NoIncrement> {
        let open = solver.tableau.open();
        let rates = positive_values(open, &self.rates.gap, &self.rates.force);
        let wrong = self.wrong_at_border(solver, &rates);
        if !wrong.is_empty() {
            return Err(NoIncrement::WrongStatus(wrong));
        }
        let after = base.iter().zip(rates).map(|(b, r)| b + most * r);
        let limit = step_limit(open, base, &after.collect::<Vec<_>>(), exempt);
        if limit.share <= AT_ONCE {
            return Err(NoIncrement::WrongStatus(limit.pairs));
        }
        Ok(if limit.share >= 1.0 - AT_END {
            most
        } else {
            most * limit.share
        })
    }

    /// Pairs at the border of their condition whose rates lead beyond it.
    fn wrong_at_border(&self, solver: &Solver, values: &[f64]) -> Vec<usize> {
        let largest = |of: &[f64]| of.iter().fold(0.0f64, |m, value| m.max(value.abs()));
        let [gap, force] = [&self.rates.gap, &self.rates.force].map(|of| largest(of));
        let open = solver.tableau.open();
        let is_wrong = |k: usize| values[k] < -BEYOND * if open[k] { gap } else { force };
        let border = solver.border.iter().copied();
        border.filter(|&k| is_wrong(k)).collect()
    }
}
