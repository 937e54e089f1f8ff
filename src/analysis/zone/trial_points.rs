//! The Gauss points of an element at the state that is evaluated.

use super::history::PathEndsOf;
use crate::material::{Lame, Material, Past, PlasticState, Softening};

/// Results of the flow rule at the points of one element.
pub(super) struct TrialPoints<'a, const S: usize> {
    /// Whether each point yields.
    pub yields: &'a mut [bool],
    /// Plastic states at the end of the increment.
    pub states: &'a mut [PlasticState<S>],
    /// Softening `D - D_ep` of the points.
    pub softening: &'a mut [Softening<S>],
    /// Vector of the unsymmetric part of the softening; empty if no back stress fades.
    pub turn: &'a mut [[f64; S]],
    /// Ends of the strain paths.
    pub path_ends: PathEndsOf<'a, S>,
}

impl<const S: usize> TrialPoints<'_, S> {
    /// Stores that a point stays elastic. Nothing is written for a point that was elastic already,
    /// as the majority is.
    #[inline]
    pub fn stay_elastic(&mut self, point: usize, committed: &PlasticState<S>) {
        if self.yields[point] {
            self.yields[point] = false;
            self.states[point] = *committed;
            self.softening[point] = Softening::NONE;
        }
    }

    /// Integrates the flow rule at a point that yields, along a straight strain path. Returns the
    /// plastic strain that the increment adds.
    #[inline]
    pub fn integrate(
        &mut self,
        point: usize,
        (material, law): (&Material, &Lame),
        path: (Option<&[f64; S]>, &[f64; S]),
        past: &Past<S>,
    ) -> [f64; S] {
        let mut memory = self.path_ends.memory_of(point);
        let update = material.integrate_along(law, path, past, &mut memory);
        let lost_work = memory.lost_work;
        self.path_ends.keep_lost_work(point, lost_work);
        self.states[point] = update.state;
        self.softening[point] = update.softening;
        if let Some(turn) = self.turn.get_mut(point) {
            *turn = update.turn;
        }
        self.yields[point] = true;
        std::array::from_fn(|k| update.state.strain[k] - past.state.strain[k])
    }
}
