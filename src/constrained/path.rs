//! Load path of a structure, from one change of contact to the next.

use super::ConstrainedStructure;
use super::held::pushed_away;
use super::loaded_state::Way;
use crate::contact::{Change, Path, PathEnd};
use crate::error::{Error, Result};
use std::sync::Arc;

/// State at which [`ConstrainedStructure::step`] stopped.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Position on the piece: the load is `start + t rate`.
    pub t: f64,
    /// Changes of contact at `t`; empty at the end of the piece.
    pub changes: Vec<Change>,
}

impl ConstrainedStructure {
    /// Starts a piece of the load path: from the current state on the load is `f + t rate`, with
    /// `t` from 0.
    ///
    /// # Errors
    /// Errors of [`ConstrainedStructure::solve`].
    pub fn start(&mut self, rate: &[f64]) -> Result<()> {
        self.check_load(rate)?;
        let condensed_rate = self.condense(rate)?;
        let begin = self.forces_if_tied(&self.state.condensed, 1.0);
        let change = self.forces_if_tied(&condensed_rate, 0.0);
        let scale = self.gaps.iter().fold(0.0f64, |m, g| m.max(g.abs()));
        // `q` is the sum of a part from the load and a part from the gaps, which may cancel.
        let terms = (&*self.contact_matrix * &self.gaps).amax() + begin.amax();
        let path = Path::new(
            &mut self.tableau,
            begin.as_slice().to_vec(),
            change.as_slice().to_vec(),
            self.state.gap.to_vec(),
            self.state.force.to_vec(),
            scale,
            terms,
        )
        .map_err(pushed_away)?;
        self.way = Some(Way {
            path,
            start: self.state.clone(),
            rate: rate.to_vec(),
            condensed_rate,
            at_event: false,
        });
        Ok(())
    }

    /// Goes on to `t = end` or to the next change of contact, whichever comes first.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Input`] if no piece was started or `end` is before the current `t`;
    /// [`crate::ErrorKind::Unheld`], naming the row, if the load pushes a body away from every
    /// contact.
    pub fn step(&mut self, end: f64) -> Result<Event> {
        let Some(way) = &mut self.way else {
            return Err(Error::input("no piece of the load path was started"));
        };
        if end.is_nan() || end < way.path.t {
            return Err(Error::input(format!(
                "the end {end} of the step lies behind t = {}",
                way.path.t
            )));
        }
        if way.at_event {
            way.path.turn(&mut self.tableau).map_err(pushed_away)?;
            way.at_event = false;
        }
        let outcome = way.path.advance(&mut self.tableau, end);
        let t = way.path.t;
        let changes = match outcome {
            PathEnd::Target => Vec::new(),
            PathEnd::Event(changes) => {
                way.at_event = true;
                changes
            }
        };
        for ((load, start), rate) in self
            .state
            .load
            .iter_mut()
            .zip(&way.start.load)
            .zip(&way.rate)
        {
            *load = start + t * rate;
        }
        self.state.condensed = &way.start.condensed + t * &way.condensed_rate;
        replace(&mut self.state.gap, &way.path.gap);
        replace(&mut self.state.force, &way.path.force);
        Ok(Event { t, changes })
    }
}

/// Replaces the values in place if nobody else holds them, otherwise allocates new ones.
fn replace(kept: &mut Arc<Vec<f64>>, values: &[f64]) {
    match Arc::get_mut(kept) {
        Some(own) => own.copy_from_slice(values),
        None => *kept = Arc::new(values.to_vec()),
    }
}
