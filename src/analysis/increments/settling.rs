//! Contact in an increment whose end is given: statuses change with the iterates of plastic flow.

use super::outcome::NoIncrement;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;
use crate::contact;

/// Fraction of the largest gap or force by which a negative gap or force violates the contact
/// condition.
const WRONG: f64 = 1e-9;
/// Number of rounds of status changes without progress after which pairs change one by one.
const PATIENCE: usize = 6;

/// Decides how many of the wrong statuses change in a round. All change as long as that reduces
/// their number, or has done so in the last few rounds; otherwise only the least index changes
/// (finite for a given load: Habetler and Kostreva 1978, doi:10.1137/0316011).
#[derive(Debug)]
pub(super) struct Rounds {
    fewest: usize,
    patience: usize,
    /// Number of rounds so far.
    taken: usize,
}

impl Default for Rounds {
    fn default() -> Self {
        Rounds {
            fewest: usize::MAX,
            patience: PATIENCE,
            taken: 0,
        }
    }
}

impl Rounds {
    /// Number of pairs to change if `wrong` pairs have a wrong status.
    pub(in crate::analysis) fn take(&mut self, wrong: usize) -> usize {
        self.taken += 1;
        if wrong < self.fewest {
            self.fewest = wrong;
            self.patience = PATIENCE;
        } else {
            self.patience = self.patience.saturating_sub(1);
        }
        if self.patience > 0 { wrong } else { 1 }
    }

    /// Whether the rounds exceed a hundred plus ten times the number of pairs. Statuses of pairs
    /// whose force or gap is mere round-off may change without end while plastic flow changes with
    /// them.
    fn are_endless(&self, n_pairs: usize) -> bool {
        self.taken > 10 * (n_pairs + 10)
    }
}

/// Changes the statuses that an iterate shows to be wrong, and gives the iterate the gaps and
/// forces of the new statuses. Returns whether any were wrong. A change costs half a trailing
/// solve.
///
/// Each Newton iterate, with the gaps and forces of the tangent, is treated once: the primal-dual
/// active set method (M. Hintermüller, K. Ito, K. Kunisch 2002, doi:10.1137/S1052623401383558). If
/// contact were solved to the end each time, with the present plastic flow as a load, the response
/// would be that of the elastic body; near a limit load this would not converge. Contact is solved
/// to the end only if every change would set a body free. If changing all wrong statuses at once
/// does not reduce their number, only the least index changes.
pub(super) fn settle_contact(
    solver: &mut Solver,
    point: &LoadPoint,
    state: &mut Equilibrium,
    rounds: &mut Rounds,
) -> Result<bool, NoIncrement> {
    let mut wrong = wrong_at_end(solver, state);
    if wrong.is_empty() {
        return Ok(false);
    }
    let take = rounds.take(wrong.len());
    if rounds.are_endless(state.gap.len()) {
        return Err(NoIncrement::Undecided);
    }
    let tableau = &mut solver.tableau;
    if take > 1 {
        // Pairs that close are treated first, which keeps bodies held.
        wrong.sort_by_key(|&k| !tableau.open()[k]);
    }
    let changes = (wrong.iter().filter(|&&k| tableau.flip(k)))
        .take(take)
        .count();
    solver.cost.counts.contact_changes += changes;
    if changes == 0 {
        let q = solver.forces_if_tied(point, &state.initial);
        let (gap, force) = (&mut state.gap, &mut state.force);
        let solved = contact::solve(&mut solver.tableau, &q, gap, force);
        let certificate = solved.map_err(|_| NoIncrement::Undecided)?;
        solver.cost.counts.contact_changes += certificate.changes;
    }
    *state = solver.respond(point, state.initial.clone());
    Ok(true)
}

/// Pairs whose contact condition a state violates.
pub(super) fn wrong_at_end(solver: &Solver, state: &Equilibrium) -> Vec<usize> {
    let (gap, force) = (&state.gap, &state.force);
    let largest_force = (force.iter()).fold(solver.scales.force, |m, r| m.max(*r));
    let largest_gap = gap.iter().fold(0.0f64, |m, g| m.max(*g));
    let is_wrong = |k: usize| match solver.tableau.open()[k] {
        true => gap[k] < -WRONG * largest_gap,
        false => force[k] < -WRONG * largest_force,
    };
    (0..gap.len()).filter(|&k| is_wrong(k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_without_progress_end() {
        let mut rounds = Rounds::default();
        let takes: Vec<usize> = (0..8).map(|_| rounds.take(4)).collect();
        assert_eq!(takes, [4, 4, 4, 4, 4, 4, 1, 1]);
        assert!(!rounds.are_endless(3));
        while !rounds.are_endless(3) {
            rounds.take(4);
        }
        assert_eq!(rounds.taken, 131);
        // After progress, all wrong pairs change at once again.
        assert_eq!(rounds.take(3), 3);
    }
}
