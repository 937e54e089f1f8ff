//! Finding an increment: statuses that come out wrong are mended, increments that do not converge
//! cut.

use super::outcome::{EndsAt, Increment, NoIncrement};
use super::search::Search;
use super::settling::Rounds;
use super::step::stopped;
use super::stepper::Stepper;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::error::{Error, ErrorKind, Result};
use crate::scene::Stepping;
use std::collections::HashSet;

/// Cut factor after an increment that did not converge.
const CUT: f64 = 0.25;
/// Share of an increment below which equilibrium and length are no longer searched together: three
/// cuts cost less than a search apart where they help, and where they do not, more do not either.
const CUT_TOGETHER: f64 = 0.02;
/// Status corrections at one point of the path before they are taken to cycle.
const MOST_CORRECTIONS: usize = 60;

/// Cuts of an increment in which a pair goes back over the border it began at.
const MOST_CROSSINGS: usize = 2;

impl Stepper<'_, '_> {
    /// An increment with statuses that are right at its begin (events) or at its end (steps).
    /// Increments that do not converge are cut, searched with equilibrium and length apart and cut
    /// again, down to the share `smallest`; returns whether any was. A state that is known `ahead`
    /// predicts the first that is tried.
    pub(super) fn find_increment(
        &mut self,
        end: &LoadPoint,
        left: f64,
        smallest: f64,
        mut ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> Result<(Increment, bool)> {
        self.solver.move_loose_bodies(end)?;
        self.solver.forget_tangent();
        let mut most = left;
        let mut corrections = 0;
        let mut crossings = 0;
        let mut seen: Vec<Vec<bool>> = Vec::new();
        let (open, border) = (
            self.solver.tableau.open().to_vec(),
            self.solver.border.clone(),
        );
        // An increment at whose end no statuses are right is followed from change to change.
        let usual = self.rules.stepping;
        let mut stepping = usual;
        let mut search = Search::FIRST;
        loop {
            let outcome = match stepping {
                Stepping::Events if corrections < MOST_CORRECTIONS => self.increment(
                    end,
                    most,
                    (
                        EndsAt::NextChange {
                            gamma: self.rules.program.gamma,
                        },
                        search,
                    ),
                    ahead.take(),
                ),
                Stepping::Events => self.solve_step((end, 1e-3 * most), search, ahead.take())?,
                Stepping::Auto => self.solve_together((end, most), search, ahead.take()),
                Stepping::Steps => self.solve_step((end, most), search, ahead.take())?,
            };
            match outcome {
                Ok(increment) => {
                    self.refuse_free_motion(&increment)?;
                    let at_once = search == Search::FIRST && stepping == usual;
                    self.solver.cost.counts.hard_increments += usize::from(!at_once);
                    return Ok((increment, most < left));
                }
                // The rate of a pair at its border turned within the increment: a shorter one shows
                // where, unless it turned at the very begin.
                Err(NoIncrement::Crossed(_)) if crossings < MOST_CROSSINGS => {
                    crossings += 1;
                    most *= CUT;
                }
                Err(NoIncrement::WrongStatus(pairs) | NoIncrement::Crossed(pairs)) => {
                    corrections += 1;
                    seen.push(self.solver.tableau.open().to_vec());
                    // All at once; one alone (the least index) once a set of statuses has come
                    // back.
                    let repeated = seen[..seen.len() - 1].contains(&seen[seen.len() - 1]);
                    for &k in pairs.iter().take(if repeated { 1 } else { pairs.len() }) {
                        if self.solver.tableau.flip(k) {
                            self.solver.cost.counts.contact_changes += 1;
                        }
                        if !self.solver.border.contains(&k) {
                            self.solver.border.push(k);
                        }
                    }
                }
                // Contact at the end of a short increment is solved whatever happens on the way.
                Err(NoIncrement::Jumps) => corrections = MOST_CORRECTIONS,
                Err(NoIncrement::Stopped) => return Err(stopped()),
                Err(NoIncrement::Failed(error)) => return Err(error),
                Err(NoIncrement::Undecided)
                    if stepping != Stepping::Events && stepping == usual =>
                {
                    self.solver.restore_statuses(&open, &border);
                    stepping = Stepping::Events;
                }
                Err(NoIncrement::Undecided) => return Err(self.not_settled(end, most)),
                Err(NoIncrement::NotConverged(attempt)) => {
                    // The points yield as in the state that failed: its tangent, often singular,
                    // must not predict the next.
                    self.solver.assume_elastic();
                    // Written so that a way of no length, of which nothing is a share, ends here
                    // too.
                    let worth_cutting = CUT * most >= smallest;
                    let cut_enough = !worth_cutting || most < CUT_TOGETHER * left;
                    // Where the structure flows away no other search at this length helps.
                    let flows = attempt.mechanism.is_some();
                    if stepping == Stepping::Auto {
                        self.solver.restore_statuses(&open, &border);
                        if most < left || !worth_cutting {
                            stepping = Stepping::Events;
                        }
                        most = match stepping == Stepping::Auto || flows && worth_cutting {
                            true => CUT * most,
                            false => left,
                        };
                        continue;
                    }
                    if flows && worth_cutting {
                        most *= CUT;
                        continue;
                    }
                    if stepping == Stepping::Events && search.together && cut_enough && !flows {
                        (search, most) = (Search::APART, left);
                        continue;
                    }
                    if !worth_cutting && !flows && search != search.to_the_end() {
                        search = search.to_the_end();
                        continue;
                    }
                    if !worth_cutting {
                        let goal = self.solver.at.towards(end, most);
                        let error = self.not_found(&goal, &attempt);
                        // Close to a limit load no length may be right: a fixed one needs none.
                        let undecided = error.kind() == ErrorKind::Analysis;
                        if undecided && stepping == Stepping::Events && usual != Stepping::Steps {
                            stepping = Stepping::Steps;
                            (search, most) = (Search::FIRST, left);
                            continue;
                        }
                        return Err(error);
                    }
                    most *= CUT;
                }
            }
        }
    }

    /// A pair that cannot open must not be in tension: the load would carry its body away.
    fn refuse_free_motion(&self, increment: &Increment) -> Result<()> {
        let force = &increment.state.force;
        match (0..force.len()).find(|&k| {
            force[k] < -1e-6 * self.solver.scales.force && self.solver.tableau.would_free(k)
        }) {
            Some(k) => Err(self.solver.structure.unbounded(k, self.solver.at.alpha)),
            None => Ok(()),
        }
    }

    /// An increment at whose end contact is solved in one iteration with the plastic flow.
    fn solve_together(
        &mut self,
        (end, most): (&LoadPoint, f64),
        search: Search,
        ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> std::result::Result<Increment, NoIncrement> {
        // The end of the increment is the end of a piece of its own: a pair that closes has no gap
        // there, whatever gap it had.
        let goal = self.solver.at.towards(end, most);
        let increment = self.increment(&goal, 1.0, (EndsAt::EndOfPiece, search), ahead)?;
        self.solver.border.clear();
        Ok(Increment {
            t: most,
            changes: Vec::new(),
            ..increment
        })
    }

    /// As [`Stepper::solve_together`] or, where that does not converge, with plastic flow for each
    /// set of statuses.
    fn solve_step(
        &mut self,
        (end, most): (&LoadPoint, f64),
        search: Search,
        mut ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> Result<std::result::Result<Increment, NoIncrement>> {
        let goal = self.solver.at.towards(end, most);
        let open = self.solver.tableau.open().to_vec();
        match self.solve_together((end, most), search, ahead.take()) {
            Err(NoIncrement::NotConverged(_) | NoIncrement::Undecided) => {
                let border = self.solver.border.clone();
                self.solver.restore_statuses(&open, &border);
            }
            found => return Ok(found),
        }
        let mut rounds = Rounds::default();
        let mut seen: HashSet<Vec<bool>> = HashSet::new();
        for _ in 0..10 * (self.solver.now.gap.len() + 10) {
            let found =
                self.increment(&goal, 1.0, (EndsAt::EndOfPieceFrozen, search), ahead.take());
            let increment = match found {
                Ok(increment) => increment,
                Err(error) => return Ok(Err(error)),
            };
            let wrong = self.wrong_at_end(&increment.state);
            if wrong.is_empty() {
                self.solver.border.clear();
                return Ok(Ok(Increment {
                    t: most,
                    changes: Vec::new(),
                    ..increment
                }));
            }
            let take = rounds.take(wrong.len());
            if take == 1 && !seen.insert(self.solver.tableau.open().to_vec()) {
                break;
            }
            for &k in wrong.iter().take(take) {
                if self.solver.tableau.flip(k) {
                    self.solver.cost.counts.contact_changes += 1;
                }
            }
        }
        Ok(Err(NoIncrement::Undecided))
    }

    fn not_settled(&self, end: &LoadPoint, most: f64) -> Error {
        Error::analysis(format!(
            "contact did not settle in the increment from load factor {:.6} to {:.6}: the statuses \
             repeat",
            self.solver.at.alpha,
            self.solver.at.towards(end, most).alpha
        ))
    }
}
