//! The search for an increment: wrong statuses are corrected, increments that do not converge are
//! cut.

use super::collapse::not_found;
use super::increment::increment;
use super::outcome::{Attempt, EndsAt, Increment, NoIncrement};
use super::search::Search;
use super::settling::Rounds;
use super::settling::wrong_at_end;
use super::step::{Rules, stopped};
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::loose::move_loose_bodies;
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, ErrorKind, Result};
use crate::scene::Stepping;
use std::collections::HashSet;

/// Factor by which an increment that did not converge is shortened.
const CUT: f64 = 0.25;
/// Fraction of an increment below which equilibrium and length are no longer searched together. If
/// cutting helps, three cuts cost less than a separate search; if they do not help, further cuts do
/// not either.
const CUT_TOGETHER: f64 = 0.02;
/// Number of status corrections at one point of the path after which statuses count as cycling.
const MOST_CORRECTIONS: usize = 60;

/// Largest number of cuts of an increment because a pair starts with a gap or force of zero that
/// becomes negative.
const MOST_CROSSINGS: usize = 2;

/// Record of the attempts at one increment, and settings of the next attempt.
struct Tries {
    /// Share of the way that was asked for; `smallest` is the smallest share that is tried.
    left: f64,
    smallest: f64,
    /// Share of the way for the next attempt.
    most: f64,
    /// Number of status corrections; `crossings` counts cuts made because a pair that began at zero
    /// became negative.
    corrections: usize,
    crossings: usize,
    /// Sets of statuses that were corrected.
    seen: Vec<Vec<bool>>,
    /// Statuses at the start; `border` holds the pairs with a gap or force of zero there.
    open: Vec<bool>,
    border: Vec<usize>,
    usual: Stepping,
    /// Stepping of the next attempt. If no set of statuses is right at the end of the increment,
    /// the path is followed from change to change.
    stepping: Stepping,
    search: Search,
}

impl Tries {
    /// The record before the first attempt.
    fn new(solver: &Solver, usual: Stepping, left: f64, smallest: f64) -> Self {
        Tries {
            left,
            smallest,
            most: left,
            corrections: 0,
            crossings: 0,
            seen: Vec::new(),
            open: solver.tableau.open().to_vec(),
            border: solver.border.clone(),
            usual,
            stepping: usual,
            search: Search::FIRST,
        }
    }
}

/// Finds elastoplastic increments by the rules of a program.
pub(super) struct Stepper<'s, 'm> {
    pub(super) solver: &'s mut Solver<'m>,
    pub(super) rules: Rules<'s>,
}

impl<'s, 'm> Stepper<'s, 'm> {
    pub(super) fn new(solver: &'s mut Solver<'m>, rules: Rules<'s>) -> Self {
        Stepper { solver, rules }
    }

    /// Searches for one increment, see [`increment`].
    fn increment(
        &mut self,
        end: &LoadPoint,
        most: f64,
        how: (EndsAt, Search),
        ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> std::result::Result<Increment, NoIncrement> {
        increment(self.solver, self.rules, (end, most), how, ahead)
    }

    /// Finds an increment with statuses that are right at its start (events) or at its end (steps).
    /// An increment that does not converge is cut, then searched with equilibrium and length apart,
    /// and cut again, down to the share `smallest`. Returns the increment and whether it was cut.
    /// If a state `ahead` is known, the first attempt is predicted from it.
    pub(super) fn find_increment(
        &mut self,
        end: &LoadPoint,
        left: f64,
        smallest: f64,
        mut ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> Result<(Increment, bool)> {
        move_loose_bodies(self.solver, end)?;
        self.solver.forget_tangent();
        let mut tries = Tries::new(self.solver, self.rules.program.stepping, left, smallest);
        loop {
            match self.try_once(&tries, end, ahead.take())? {
                Ok(increment) => {
                    self.refuse_free_motion(&increment)?;
                    let at_once = tries.search == Search::FIRST && tries.stepping == tries.usual;
                    self.solver.cost.counts.hard_increments += usize::from(!at_once);
                    return Ok((increment, tries.most < left));
                }
                Err(why) => self.try_otherwise(&mut tries, end, why)?,
            }
        }
    }

    /// Makes the next attempt at an increment.
    fn try_once(
        &mut self,
        tries: &Tries,
        end: &LoadPoint,
        ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> Result<std::result::Result<Increment, NoIncrement>> {
        let (most, search) = (tries.most, tries.search);
        let gamma = self.rules.program.gamma;
        Ok(match tries.stepping {
            Stepping::Events if tries.corrections < MOST_CORRECTIONS => {
                self.increment(end, most, (EndsAt::NextChange { gamma }, search), ahead)
            }
            Stepping::Events => self.solve_step((end, 1e-3 * most), search, ahead)?,
            Stepping::Auto => self.solve_together((end, most), search, ahead),
            Stepping::Steps => self.solve_step((end, most), search, ahead)?,
        })
    }

    /// Changes the settings of the next attempt after an attempt that found no increment.
    ///
    /// # Errors
    /// Failures after which no other attempt is worthwhile.
    fn try_otherwise(
        &mut self,
        tries: &mut Tries,
        end: &LoadPoint,
        why: NoIncrement,
    ) -> Result<()> {
        match why {
            // The gap or force of a pair that started at zero changed the sign of its rate within
            // the increment. A shorter increment shows where, unless that was at the very start.
            NoIncrement::Crossed(_) if tries.crossings < MOST_CROSSINGS => {
                tries.crossings += 1;
                tries.most *= CUT;
            }
            NoIncrement::WrongStatus(pairs) | NoIncrement::Crossed(pairs) => {
                self.correct_statuses(tries, &pairs);
            }
            // Contact at the end of a short increment is solved, whatever happens on the way.
            NoIncrement::Jumps => tries.corrections = MOST_CORRECTIONS,
            NoIncrement::Stopped => return Err(stopped()),
            NoIncrement::Failed(error) => return Err(error),
            NoIncrement::Undecided
                if tries.stepping != Stepping::Events && tries.stepping == tries.usual =>
            {
                self.solver.restore_statuses(&tries.open, &tries.border);
                tries.stepping = Stepping::Events;
            }
            NoIncrement::Undecided => return Err(self.not_settled(end, tries.most)),
            NoIncrement::NotConverged(attempt) => {
                // The points that count as yielding are still those of the state that failed. The
                // tangent of that state is often singular and must not predict the next increment.
                self.solver.assume_elastic();
                self.after_no_convergence(tries, end, &attempt)?;
            }
        }
        Ok(())
    }

    /// Changes the statuses of pairs that were wrong: all at once, or only the least index if a set
    /// of statuses has come back.
    fn correct_statuses(&mut self, tries: &mut Tries, pairs: &[usize]) {
        tries.corrections += 1;
        let open = self.solver.tableau.open().to_vec();
        let repeated = tries.seen.contains(&open);
        tries.seen.push(open);
        for &k in pairs.iter().take(if repeated { 1 } else { pairs.len() }) {
            if self.solver.tableau.flip(k) {
                self.solver.cost.counts.contact_changes += 1;
            }
            if !self.solver.border.contains(&k) {
                self.solver.border.push(k);
            }
        }
    }

    /// Chooses the next attempt after an increment that did not converge: a shorter one, or another
    /// search.
    ///
    /// # Errors
    /// Errors of [`not_found`], if nothing is left to try.
    fn after_no_convergence(
        &mut self,
        tries: &mut Tries,
        end: &LoadPoint,
        attempt: &Attempt,
    ) -> Result<()> {
        // This comparison is written so that a way of length zero, whose shares are NaN, is not
        // cut.
        let worth_cutting = CUT * tries.most >= tries.smallest;
        let cut_enough = !worth_cutting || tries.most < CUT_TOGETHER * tries.left;
        // If the structure flows away, no other search at this length helps.
        let flows = attempt.mechanism.is_some();
        if tries.stepping == Stepping::Auto {
            self.solver.restore_statuses(&tries.open, &tries.border);
            if tries.most < tries.left || !worth_cutting {
                tries.stepping = Stepping::Events;
            }
            tries.most = match tries.stepping == Stepping::Auto || flows && worth_cutting {
                true => CUT * tries.most,
                false => tries.left,
            };
            return Ok(());
        }
        let events = tries.stepping == Stepping::Events;
        if flows && worth_cutting {
            tries.most *= CUT;
        } else if events && tries.search.together && cut_enough && !flows {
            (tries.search, tries.most) = (Search::APART, tries.left);
        } else if !worth_cutting && !flows && tries.search != tries.search.to_the_end() {
            tries.search = tries.search.to_the_end();
        } else if worth_cutting {
            tries.most *= CUT;
        } else {
            let goal = self.solver.at.towards(end, tries.most);
            let error = not_found(self.solver, self.rules.settings, &goal, attempt);
            // Close to a limit load, the search may find no length that ends at a change of
            // contact. An increment of fixed length needs no such search.
            let undecided = error.kind() == ErrorKind::Analysis;
            if !(undecided && events && tries.usual != Stepping::Steps) {
                return Err(error);
            }
            tries.stepping = Stepping::Steps;
            (tries.search, tries.most) = (Search::FIRST, tries.left);
        }
        Ok(())
    }

    /// Refuses an increment in which a pair that cannot open is in tension: the load would carry
    /// its body away.
    fn refuse_free_motion(&self, increment: &Increment) -> Result<()> {
        let force = &increment.state.force;
        match (0..force.len()).find(|&k| {
            force[k] < -1e-6 * self.solver.scales.force && self.solver.tableau.would_free(k)
        }) {
            Some(k) => Err(self.solver.structure.unbounded(k, self.solver.at.alpha)),
            None => Ok(()),
        }
    }

    /// Finds an increment at whose end contact is solved together with the plastic flow, in one
    /// iteration.
    fn solve_together(
        &mut self,
        (end, most): (&LoadPoint, f64),
        search: Search,
        ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> std::result::Result<Increment, NoIncrement> {
        // The increment is made a piece of its own, which it covers wholly: a pair that closes has
        // no gap at its end, whatever gap the pair had at the start.
        let goal = self.solver.at.towards(end, most);
        let increment = self.increment(&goal, 1.0, (EndsAt::EndOfPiece, search), ahead)?;
        self.solver.border.clear();
        Ok(Increment {
            t: most,
            changes: Vec::new(),
            ..increment
        })
    }

    /// Solves an increment as [`Stepper::solve_together`] does. If that does not converge, goes
    /// through sets of contact statuses and solves the plastic flow again for each.
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
            let wrong = wrong_at_end(self.solver, &increment.state);
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
            "contact did not settle: load factor {:.9} is the last that was held, and on the way \
             to {:.9} the same sets of closed pairs come back, none of which is right to \
             round-off. Look for pairs that are in two contacts, or bodies that such pairs alone \
             hold, or reach this load by other increments (program.stepping, a target on the way)",
            self.solver.at.alpha,
            self.solver.at.towards(end, most).alpha
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::choice::zone_choice::{first_guess, place_of_first_yield};
    use crate::analysis::structure::starting;
    use crate::assembly::assemble;
    use crate::linalg::Backend;
    use crate::model::Model;
    use crate::scene::Scene;

    const TWO_BLOCKS: &str = r#"
kind = "plane_strain"
[[mesh.parts]]
body = "lower"
block = { x = [0.0, 2.0], y = [0.0, 1.0], elements = [2, 1] }
[[mesh.parts]]
body = "upper"
block = { x = [0.0, 2.0], y = [1.0, 2.0], elements = [2, 1] }
[materials.metal]
youngs_modulus = 1000.0
poissons_ratio = 0.3
yield_stress = 10.0
[bodies.lower]
material = "metal"
[bodies.upper]
material = "metal"
[[contact]]
first = "upper.bottom"
second = "lower.top"
[[support]]
on = "lower.bottom"
fix = ["x", "y"]
[[support]]
on = "upper.left"
fix = ["x"]
[[load]]
on = "upper.top"
pressure = 1.0
[program]
targets = [{ load_factor = 1.0 }]
"#;

    /// If statuses come back, the increment is followed from change to change with the statuses at
    /// its start. If that does not settle either, the error names the last load factor in
    /// equilibrium.
    #[test]
    fn statuses_that_come_back_end_by_name() {
        let scene = Scene::parse(TWO_BLOCKS, "blocks.toml").unwrap();
        let model = Model::new(&scene).unwrap();
        let system = assemble(&model, Backend::Dense).unwrap();
        let (choice, within) = (place_of_first_yield(&model), first_guess(&model).elements);
        let elements = choice.elements.clone();
        let mut solver = Solver::new(
            &model,
            &system,
            Backend::Dense,
            &within,
            elements,
            &choice.guard,
        )
        .unwrap();
        starting::begin(&mut solver).unwrap();
        let end = solver.structure.point(0.5);
        let rules = Rules {
            settings: &model.settings,
            program: &model.program,
            zone_until: f64::INFINITY,
            stop: &|| false,
        };
        let open = solver.tableau.open().to_vec();
        let mut tries = Tries::new(&solver, rules.program.stepping, 1.0, 1e-6);
        assert!(solver.tableau.flip(0));
        let mut stepper = Stepper::new(&mut solver, rules);
        let mut again = || stepper.try_otherwise(&mut tries, &end, NoIncrement::Undecided);
        again().unwrap();
        let why = again().unwrap_err();
        assert_eq!(why.kind(), ErrorKind::Analysis);
        for words in ["load factor 0.0", "is the last that was held", "to 0.5"] {
            assert!(why.message().contains(words), "{why}");
        }
        assert_eq!(tries.stepping, Stepping::Events);
        assert_eq!(solver.tableau.open(), open);
    }
}
