//! A committed state: the start of an increment, the state restored when an attempt fails, and part
//! of a checkpoint.

use super::equilibrium::Equilibrium;
use super::load_point::LoadPoint;
use super::solver::Solver;
use crate::analysis::zone::history::PointHistory;
use crate::analysis::zone::packed;
use crate::contact::springs::Springs;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A committed state of a structure.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::analysis) struct State {
    /// Load point of the state.
    pub(in crate::analysis) at: LoadPoint,
    /// Displacements, gaps, contact forces and initial loads.
    pub(in crate::analysis) equilibrium: Equilibrium,
    /// Whether the displacements belong to the gaps and forces.
    pub(in crate::analysis) fresh: bool,
    /// Which pairs are open.
    pub(in crate::analysis) open: Vec<bool>,
    /// Weak springs that keep bodies in place against motions that nothing holds and nothing
    /// drives.
    pub(in crate::analysis) springs: Arc<[Springs]>,
    /// Pairs whose gap or force came to zero at the last change of contact.
    pub(in crate::analysis) border: Vec<usize>,
    /// Number of the state's zone, counting the zones chosen in the run.
    pub(in crate::analysis) zone: usize,
    /// Elements of the zone, ascending.
    #[serde(with = "packed::ascending")]
    pub(in crate::analysis) elements: Arc<[usize]>,
    /// Plastic history of the elements of the zone, point by point.
    pub(in crate::analysis) history: PointHistory,
}

impl State {
    /// Whether the state is of a structure with these numbers of pairs, contact freedoms and loads,
    /// and the sizes of its parts agree.
    pub(in crate::analysis) fn fits(
        &self,
        [n_pairs, n_contact]: [usize; 2],
        n_loads: usize,
    ) -> bool {
        let now = &self.equilibrium;
        let trailing = [&now.initial.load, &now.initial.eliminated, &now.u];
        let pairs = [&now.gap, &now.force, &now.initial.forces];
        let same = |v: &&crate::substructure::Trailing| {
            v.zone.len() == now.u.zone.len() && v.contact.len() == n_contact
        };
        self.at.factors.len() == n_loads
            && self.open.len() == n_pairs
            && self.border.iter().all(|&k| k < n_pairs)
            && trailing.iter().all(same)
            && pairs.iter().all(|values| values.len() == n_pairs)
    }
}

impl Solver<'_> {
    /// A copy of the current state.
    pub(in crate::analysis) fn state(&self) -> State {
        State {
            at: self.at.clone(),
            equilibrium: self.now.clone(),
            fresh: self.fresh,
            open: self.tableau.open().to_vec(),
            springs: Arc::clone(&self.springs),
            border: self.border.clone(),
            zone: self.structure.zone_number,
            elements: Arc::clone(&self.structure.elements),
            history: self.zone.history(),
        }
    }

    /// Restores a state of the run, whether of the current zone or of an earlier one.
    pub(in crate::analysis) fn restore(&mut self, state: &State) {
        self.at = state.at.clone();
        if state.zone == self.structure.zone_number {
            self.zone.restore(&state.history);
            self.now.copy_from(&state.equilibrium);
            self.fresh = state.fresh;
        } else {
            self.zone.restore_of(&state.elements, &state.history);
            self.now.gap.copy_from_slice(&state.equilibrium.gap);
            self.now.force.copy_from_slice(&state.equilibrium.force);
            let initial = self.zone.initial_load(self.structure.sub.zeros());
            self.now.initial = self.structure.eliminate_initial(initial, &mut self.cost);
            self.fresh = false;
        }
        self.set_springs(&state.springs);
        self.restore_statuses(&state.open, &state.border);
    }

    /// Restores an elastic state after trial states. The contact matrix is swept from scratch.
    pub(in crate::analysis) fn restore_elastic(&mut self, state: &State) {
        self.set_springs(&state.springs);
        self.tableau.reset(&state.open);
        self.restore(state);
    }

    /// Gives the pairs the statuses `open` of an earlier state, and replaces the pairs at the
    /// border.
    pub(in crate::analysis) fn restore_statuses(&mut self, open: &[bool], border: &[usize]) {
        self.border = border.to_vec();
        // Pairs are closed first: a pair whose opening would free a motion can open once others are
        // closed.
        for closing in [true, false] {
            for (k, &wanted) in open.iter().enumerate() {
                let open = self.tableau.open()[k];
                if open != wanted && open == closing {
                    self.tableau.flip(k);
                }
            }
        }
    }
}
