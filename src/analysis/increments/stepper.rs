//! What finds elastoplastic increments: the solver, by the rules of a program.

use super::step::Rules;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::points::Evaluation;
use crate::substructure::Trailing;

/// Finds elastoplastic increments by the rules of a program.
pub(super) struct Stepper<'s, 'm> {
    pub(in crate::analysis) solver: &'s mut Solver<'m>,
    pub(in crate::analysis) rules: Rules<'s>,
}

impl<'s, 'm> Stepper<'s, 'm> {
    pub(super) fn new(solver: &'s mut Solver<'m>, rules: Rules<'s>) -> Self {
        Stepper { solver, rules }
    }

    /// The force that the stresses at `state` leave out of balance: what the plastic strains there
    /// would be as initial loads, less the initial loads that the state is in equilibrium with.
    pub(super) fn out_of_balance_at(
        &mut self,
        state: &Equilibrium,
        balance: &mut Trailing,
    ) -> Evaluation {
        let evaluation = self.solver.zone.evaluate(&state.u, balance);
        balance.add(-1.0, &state.initial.load);
        self.solver.cost.counts.plastic_iterations += 1;
        evaluation
    }
}
