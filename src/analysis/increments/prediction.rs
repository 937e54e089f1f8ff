//! The prediction of an increment: rates of the state with respect to the share of the piece.

use super::outcome::NoIncrement;
use super::step_length::{positive_values, step_limit};
use super::tangent::solve_tangent;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;

/// Accuracy (energy norm) of the tangent solve that predicts an increment. Points that begin to
/// yield within the increment change the response by more than that.
const PREDICTION: f64 = 0.02;

/// A change of contact in this last share of a piece counts as the end of the piece: the target
/// comes first.
pub(super) const AT_END: f64 = 1e-9;
/// A pair changes at once if the share of the increment up to its change is below this.
pub(super) const AT_ONCE: f64 = 1e-12;
/// Fraction of the largest rate below which the rate of a violated condition is round-off.
const BEYOND: f64 = 1e-9;

/// Changes of the state over the whole piece, at the rates that hold at its start.
pub(super) struct RatePrediction {
    pub(super) rates: Equilibrium,
    /// Factor by which the rates were stretched since their loads were eliminated.
    pub(super) stretched: f64,
}

impl RatePrediction {
    /// Predicts the rates: elastic ones (4.5), plus a plastic part if points yield and `tangent` is
    /// set. The plastic part continues as in the last increment; if its rate is not known, it
    /// follows from the tangent. `is_long` means that the increment covers the share `most` of the
    /// piece: the rate of the last increment then counts as stretched to this length.
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
        // The current state may have been in equilibrium with other statuses, or be off by gamma.
        // The prediction uses the present statuses.
        let mut rates = solver.respond(end, initial);
        rates.add(-1.0, &solver.now);
        if needs_tangent {
            let mut driven = solver.structure.sub.zeros();
            solver.zone.softening_times(&rates.u, &mut driven);
            let plastic = solve_tangent(solver, &driven, PREDICTION, 1.0);
            rates.add(1.0, &plastic);
        }
        RatePrediction { rates, stretched }
    }

    /// Rates that lead to a known state with the same statuses.
    pub(super) fn secant(
        solver: &Solver,
        end: &LoadPoint,
        (at, state): (LoadPoint, Equilibrium),
    ) -> Self {
        let mut rates = state;
        rates.rescale(&solver.now, 1.0 / solver.at.share_of(&at, end));
        rates.add(-1.0, &solver.now);
        RatePrediction {
            rates,
            stretched: 1.0,
        }
    }

    /// The share of the piece, at most `most`, at which contact changes according to the
    /// prediction. `base` holds the values at the start; the pairs in `exempt` do not count.
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

    /// Pairs that start with a gap or force of zero and whose rates make it negative.
    fn wrong_at_border(&self, solver: &Solver, values: &[f64]) -> Vec<usize> {
        let largest = |of: &[f64]| of.iter().fold(0.0f64, |m, value| m.max(value.abs()));
        let [gap, force] = [&self.rates.gap, &self.rates.force].map(|of| largest(of));
        let open = solver.tableau.open();
        let is_wrong = |k: usize| values[k] < -BEYOND * if open[k] { gap } else { force };
        let border = solver.border.iter().copied();
        border.filter(|&k| is_wrong(k)).collect()
    }
}
