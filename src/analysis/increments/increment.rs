//! One elastoplastic increment: equilibrium iteration and step length together (paper, chapter 4).
//!
//! The unknowns are the initial loads `J`. For given `J` displacements, gaps and contact forces
//! follow from one trailing solve (4.6); the flow rule gives `J(u)` back, and `J(u) - J` is the
//! true out-of-balance force of the stresses. While it is brought to zero the increment is scaled
//! so that it ends at the next change of contact (4.17, 4.22).

use super::acceleration::Anderson;
use super::outcome::{Attempt, EndsAt, Increment, NoIncrement, STRETCH};
use super::search::{PROGRESS, Search};
use super::settling::Rounds;
use super::step_length::{LengthSearch, StepLimit, step_limit};
use super::stepper::Stepper;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::scene::PlasticIteration;

/// Accuracy (energy norm) of the tangent that predicts an increment: what yields anew on the way
/// changes more than that.
const PREDICTION: f64 = 0.02;
/// Accuracy (energy norm) of every Newton direction. Where points begin or cease to yield
/// convergence is linear, however exact the directions are: forcing terms that follow the residual
/// cost a tenth more trailing solves for 4 % fewer material evaluations.
const FORCING: f64 = 0.05;
/// Iterations of the unaccelerated or Anderson iteration count for this many of Newton's limit.
const CHEAP_ITERATIONS: usize = 100;
/// A change of contact in this last share of a piece counts as its end: the target comes first.
const AT_END: f64 = 1e-9;
/// Share of the largest gap or force by which a pair may be beyond the border of its condition.
const BORDER: f64 = 1e-8;
/// A share of the increment below this means that a pair changes at once.
const AT_ONCE: f64 = 1e-12;
/// Share of the increment that is as good as none, where equilibrium at the start is asked for.
const AT_START: f64 = 1e-9;
/// The same of increments to the end of their piece, all of one run after the other: where they are
/// of equal length in the root of the load the last is some thirty times as long as the first.
const STRETCH_OF_LONG: f64 = 1e2;

impl Stepper<'_, '_> {
    /// Goes from the current state towards `end`, at most to share `most` of the way. A state that
    /// is known `ahead` predicts it.
    pub fn increment(
        &mut self,
        end: &LoadPoint,
        most: f64,
        (ends_at, search): (EndsAt, Search),
        ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> Result<Increment, NoIncrement> {
        let settings = self.rules.settings;
        let start = self.solver.at.clone();
        let before = self.solver.now.clone();
        self.solver.zone.begin_at(&before.u, &start.factors);
        let follows = matches!(ends_at, EndsAt::NextChange { .. });
        let mut stretched = 1.0;
        let rates = match ahead {
            Some(ahead) => self.secant(end, ahead),
            None => {
                if let (Some(pace), false) = (&self.solver.predictor.pace, follows) {
                    let ratio = most * start.distance(end) / pace.distance;
                    stretched = pace.stretched * f64::max(ratio, 1.0);
                }
                self.rates(end, settings.plastic_iteration == PlasticIteration::Newton)
            }
        };
        let values = |stepper: &Self, state: &Equilibrium| stepper.values(&state.gap, &state.force);
        let base = values(self, &before);
        // A pair whose opening would set a body free cannot open: its force may come down to the
        // round-off of zero.
        let mut exempt = self.solver.border.clone();
        exempt.extend((0..base.len()).filter(|&k| self.solver.tableau.would_free(k)));

        let mut t = most;
        if follows {
            let wrong = self.wrong_at_border(&rates);
            if !wrong.is_empty() {
                return Err(NoIncrement::WrongStatus(wrong));
            }
            let after: Vec<f64> = base
                .iter()
                .zip(self.values(&rates.gap, &rates.force))
                .map(|(b, r)| b + most * r)
                .collect();
            let limit = step_limit(&base, &after, &exempt);
            if limit.share <= AT_ONCE {
                return Err(NoIncrement::WrongStatus(limit.pairs));
            }
            t = if limit.share >= 1.0 - AT_END {
                most
            } else {
                most * limit.share
            };
        }
        let mut state = before.clone();
        state.add(t, &rates);
        let settles_contact = ends_at == EndsAt::EndOfPiece;
        let mut rounds = Rounds::default();
        if settles_contact {
            self.settle_contact(end, &mut state, &mut rounds)?;
        }

        let mut anderson = Anderson::default();
        let mut balance = self.solver.structure.sub.zeros();
        // A line search ends with the evaluation that the next iteration begins with.
        let mut known = None;
        let mut trial = (state.clone(), self.solver.structure.sub.zeros());
        let mut iterations = 0;
        let mut best = (f64::INFINITY, 0);
        let mut damping = 0.0;
        let mut length_search = LengthSearch::default();
        let mut may_settle = true;
        let newton = settings.plastic_iteration == PlasticIteration::Newton;
        let most_iterations = match settings.plastic_iteration {
            PlasticIteration::Newton => settings.max_iterations,
            _ => settings.max_iterations * CHEAP_ITERATIONS,
        };
        loop {
            let evaluation = match known.take() {
                Some(evaluation) => evaluation,
                None => {
                    self.solver.zone.set_factors(&start.towards(end, t).factors);
                    self.out_of_balance_at(&state, &mut balance)
                }
            };
            iterations += 1;
            let scale = state
                .force
                .iter()
                .fold(self.solver.scales.force, |m, r| m.max(*r));
            let residual = if scale > 0.0 {
                balance.largest() / scale
            } else {
                0.0
            };
            let limit = if follows {
                step_limit(&base, &values(self, &state), &exempt)
            } else {
                StepLimit {
                    share: f64::INFINITY,
                    pairs: Vec::new(),
                }
            };
            let reach = self.reach(&limit, t, most);
            let gamma = if let EndsAt::NextChange { gamma } = ends_at {
                gamma
            } else {
                0.0
            };
            let arrived = if limit.share < most / t {
                (reach - 1.0).abs() <= gamma
            } else {
                t == most
            };
            let stalled = residual >= PROGRESS * best.0;
            let mut balanced = residual <= settings.tolerance;
            let mut floor = 0.0;
            if stalled && !balanced && may_settle {
                floor = self.round_off_of_balance(&state.u)? / scale;
                if residual <= floor {
                    balanced = self.settles(&state, floor);
                    may_settle = balanced;
                }
            }
            if balanced && settles_contact && self.settle_contact(end, &mut state, &mut rounds)? {
                continue;
            }
            let most_stretched = if follows { STRETCH } else { STRETCH_OF_LONG };
            if balanced && arrived && stretched > most_stretched {
                stretched = 1.0;
                let (structure, cost) = (&self.solver.structure, &mut self.solver.cost);
                let initial = structure.eliminate(state.initial.load, cost);
                state = self.solver.respond(&start.towards(end, t), initial);
                continue;
            }
            if balanced && arrived {
                if follows {
                    let crossed = self.crosses_border(&state, gamma.max(BORDER), scale);
                    if !crossed.is_empty() {
                        return Err(NoIncrement::Crossed(crossed));
                    }
                }
                let changes = if limit.share <= 1.0 + gamma {
                    limit.pairs
                } else {
                    Vec::new()
                };
                self.solver.scales.round_off = self.solver.scales.round_off.max(floor);
                let at_end = start.towards(end, t);
                state = self.solver.respond(&at_end, state.initial);
                return Ok(Increment {
                    t,
                    state,
                    changes,
                    iterations,
                    residual,
                    guard_yields: evaluation.guard_yields,
                    stretched,
                });
            }
            if !stalled {
                best = (residual, iterations);
            }
            if (self.rules.stop)() {
                return Err(NoIncrement::Stopped);
            }
            let stuck = newton && iterations - best.1 >= search.patience;
            // The change comes ever nearer the start, within what states are known to: at once.
            if stuck && follows && t <= settings.tolerance && limit.share <= 1.0 + gamma {
                return Err(NoIncrement::WrongStatus(limit.pairs));
            }
            if iterations >= most_iterations || stuck || !residual.is_finite() {
                return Err(NoIncrement::NotConverged(Box::new(Attempt {
                    state,
                    iterations,
                    residual,
                    round_off: self.round_off_of_balance(&before.u)? / scale,
                    mechanism: None,
                })));
            }
            if !balanced {
                let (direction, length) = match settings.plastic_iteration {
                    PlasticIteration::Newton => {
                        let newton = self.solver.solve_tangent(&balance, FORCING, 1.0 - damping);
                        match self.line_search(&state, &newton, &balance, &mut trial) {
                            Some((length, evaluation)) => {
                                damping = next_damping(damping, length);
                                let goal = start.towards(end, t);
                                let driven = (&balance, length);
                                let mechanism = self.flows_away(&goal, &newton, driven, &trial);
                                if mechanism.is_some() {
                                    return Err(NoIncrement::NotConverged(Box::new(Attempt {
                                        state: trial.0,
                                        iterations,
                                        residual,
                                        round_off: self.round_off_of_balance(&before.u)? / scale,
                                        mechanism,
                                    })));
                                }
                                std::mem::swap(&mut balance, &mut trial.1);
                                known = Some(evaluation);
                                (newton, length)
                            }
                            // The elastic stiffness bounds the tangent from above: the plain step
                            // always lowers the energy.
                            None => {
                                damping = next_damping(damping, 0.0);
                                (self.solver.direction(balance.clone()), 1.0)
                            }
                        }
                    }
                    PlasticIteration::Anderson => {
                        let change = anderson.change(&state.initial.load, &balance);
                        (self.solver.direction(change), 1.0)
                    }
                    PlasticIteration::Plain => (self.solver.direction(balance.clone()), 1.0),
                };
                state.add(length, &direction);
                if settles_contact && self.settle_contact(end, &mut state, &mut rounds)? {
                    known = None;
                    anderson.restart();
                }
            }
            if follows && (balanced || search.together) {
                let limit = step_limit(&base, &values(self, &state), &exempt);
                let reach = self.reach(&limit, t, most);
                if reach <= AT_ONCE {
                    return Err(NoIncrement::WrongStatus(limit.pairs));
                }
                if reach.is_finite() && reach != 1.0 {
                    // Far-off predictions are followed carefully: the response is not linear.
                    let goal = (reach.clamp(0.1, 4.0) * t).min(most);
                    if !search.together && t <= AT_START * most && goal < t {
                        return Err(NoIncrement::Jumps);
                    }
                    let next = match search.together {
                        true => t + length_search.relaxation(t, goal) * (goal - t),
                        false => length_search.between(t, goal, AT_START * most),
                    };
                    let next = if next >= most * (1.0 - 4.0 * f64::EPSILON) {
                        most
                    } else {
                        next
                    };
                    if next <= AT_ONCE {
                        return Err(NoIncrement::WrongStatus(limit.pairs));
                    }
                    state.rescale(&before, next / t);
                    stretched *= f64::max(next / t, 1.0);
                    t = next;
                    known = None;
                    if !search.together {
                        best = (f64::INFINITY, iterations);
                    }
                    anderson.restart();
                }
            }
        }
    }

    /// Factor on the increment so far (share `t` of the piece) that brings it to the next change or
    /// to the end.
    fn reach(&self, limit: &StepLimit, t: f64, most: f64) -> f64 {
        if limit.share * t >= most * (1.0 - AT_END) {
            most / t
        } else {
            limit.share
        }
    }

    /// Rates of everything with the share of the piece: elastic, plus plastic where points yield.
    /// The plastic part goes on as in the last increment; after none it is that of the tangent.
    fn rates(&mut self, end: &LoadPoint, tangent: bool) -> Equilibrium {
        let yields = tangent && !self.solver.zone.is_idle();
        let pace = self.solver.predictor.pace.as_ref().filter(|_| yields);
        let needs_tangent = yields && pace.is_none();
        let mut initial = self.solver.now.initial.clone();
        if let Some(pace) = pace {
            initial.add(self.solver.at.distance(end), &pace.initial);
        }
        // `now` may have been in equilibrium with other statuses, or off by gamma: its own statuses
        // decide.
        let mut rates = self.solver.respond(end, initial);
        rates.add(-1.0, &self.solver.now);
        if needs_tangent {
            let mut driven = self.solver.structure.sub.zeros();
            self.solver.zone.softening_times(&rates.u, &mut driven);
            let plastic = self.solver.solve_tangent(&driven, PREDICTION, 1.0);
            rates.add(1.0, &plastic);
        }
        rates
    }

    /// Rates that lead to a state which is known already, statuses being the same.
    fn secant(&self, end: &LoadPoint, (at, state): (LoadPoint, Equilibrium)) -> Equilibrium {
        let mut rates = state;
        rates.rescale(&self.solver.now, 1.0 / self.solver.at.share_of(&at, end));
        rates.add(-1.0, &self.solver.now);
        rates
    }

    /// What must stay positive: gaps of open pairs, forces of closed ones.
    fn values(&self, gap: &[f64], force: &[f64]) -> Vec<f64> {
        self.solver
            .tableau
            .open()
            .iter()
            .enumerate()
            .map(|(k, open)| if *open { gap[k] } else { force[k] })
            .collect()
    }

    /// Pairs that began at the border of their condition and end beyond it: their rate was right at
    /// the start and turned within the increment, where no step limit watches it.
    fn crosses_border(&self, state: &Equilibrium, tolerance: f64, force_scale: f64) -> Vec<usize> {
        let largest_gap = state.gap.iter().fold(0.0f64, |m, g| m.max(*g));
        let crosses = |k: usize| {
            if self.solver.tableau.open()[k] {
                state.gap[k] < -tolerance * largest_gap
            } else {
                state.force[k] < -tolerance * force_scale
            }
        };
        self.solver
            .border
            .iter()
            .copied()
            .filter(|&k| crosses(k))
            .collect()
    }

    fn wrong_at_border(&self, rates: &Equilibrium) -> Vec<usize> {
        let values = self.values(&rates.gap, &rates.force);
        let largest_gap = rates.gap.iter().fold(0.0f64, |m, g| m.max(g.abs()));
        let largest_force = rates.force.iter().fold(0.0f64, |m, r| m.max(r.abs()));
        self.solver
            .border
            .iter()
            .copied()
            .filter(|&k| {
                let largest = if self.solver.tableau.open()[k] {
                    largest_gap
                } else {
                    largest_force
                };
                values[k] < -1e-9 * largest
            })
            .collect()
    }
}

/// Newton's tangent is damped towards the elastic stiffness after a short step and freed again
/// after full ones.
fn next_damping(damping: f64, length: f64) -> f64 {
    if length < 0.5 {
        f64::min(4.0 * damping.max(0.01), 0.6)
    } else if length >= 1.0 {
        if damping < 0.01 { 0.0 } else { 0.25 * damping }
    } else {
        damping
    }
}
