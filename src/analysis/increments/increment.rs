//! One elastoplastic increment: equilibrium iteration and step length together (paper, chapter 4).
//!
//! The unknowns are the initial loads `J`. For given `J`, displacements, gaps and contact forces
//! follow from one trailing solve (4.6). The flow rule returns `J(u)`, and `J(u) - J` is the true
//! out-of-balance force of the stresses. While this force is brought to zero, the increment is
//! scaled so that it ends at the next change of contact (4.17, 4.22).

use super::acceleration::Anderson;
use super::collapse::{flows_away, round_off_of_balance, settles};
use super::line_search::line_search;
use super::outcome::{Attempt, EndsAt, Increment, NoIncrement, STRETCH};
use super::prediction::{AT_END, AT_ONCE, RatePrediction};
use super::search::{PROGRESS, Search};
use super::settling::{Rounds, settle_contact};
use super::step::Rules;
use super::step_length::{LengthSearch, StepLimit, positive_values, step_limit};
use super::tangent::solve_tangent;
use crate::analysis::structure::equilibrium::Equilibrium;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::points::Evaluation;
use crate::scene::PlasticIteration;
use crate::substructure::Trailing;

/// Accuracy (energy norm) of every Newton direction. When points begin or cease to yield,
/// convergence is linear, however exact the directions are. An accuracy that becomes tighter as the
/// residual falls (a forcing term) therefore does not pay.
const FORCING: f64 = 0.05;
/// The plain and the Anderson iteration may take this many times Newton's limit of iterations.
const CHEAP_ITERATIONS: usize = 100;
/// Fraction of the largest gap or force by which a gap or force at the border may be negative.
const BORDER: f64 = 1e-8;
/// Fraction of the increment below which its length counts as zero, so that equilibrium is sought
/// at the start.
const AT_START: f64 = 1e-9;
/// Largest factor by which a change of state may be stretched over a run of increments that end at
/// the end of their piece. If these increments are of equal length in the root of the load, the
/// last is some thirty times as long as the first.
const STRETCH_OF_LONG: f64 = 1e2;

/// Searches for the increment from the current state towards `end`, at most to share `most` of the
/// way. If a state `ahead` is known, the increment is predicted from it.
pub(super) fn increment(
    solver: &mut Solver,
    rules: Rules,
    (end, most): (&LoadPoint, f64),
    (ends_at, search): (EndsAt, Search),
    ahead: Option<(LoadPoint, Equilibrium)>,
) -> Result<Increment, NoIncrement> {
    Iteration::begin(solver, rules, (end, most), (ends_at, search), ahead)?.run()
}

/// The search for one increment: its start, and the current iterate.
struct Iteration<'i, 'm> {
    solver: &'i mut Solver<'m>,
    rules: Rules<'i>,
    end: &'i LoadPoint,
    /// Largest share of the piece that the increment may cover.
    most: f64,
    ends_at: EndsAt,
    search: Search,
    /// Load point at the start, the paper's time `tau`.
    start: LoadPoint,
    /// Equilibrium at the start.
    before: Equilibrium,
    /// Gaps and forces at the start that must stay positive.
    base: Vec<f64>,
    /// Pairs that do not limit the step length.
    exempt: Vec<usize>,
    /// Share of the piece at the end of the iterate, `Delta alpha` of the paper.
    t: f64,
    /// The iterate: equilibrium at share `t` with the current initial loads.
    state: Equilibrium,
    /// Force out of balance of the iterate, `J(u) - J`.
    balance: Trailing,
    /// Result of evaluating the material at the iterate, if a line search has done so.
    known: Option<Evaluation>,
    /// Work space for the iterates that a line search tries.
    trial: (Equilibrium, Trailing),
    /// Number of material evaluations.
    iterations: usize,
    /// The smallest residual so far, and the number of evaluations after which it was found.
    best: (f64, usize),
    /// Share by which Newton's tangent is damped towards the elastic stiffness.
    damping: f64,
    /// Factor by which the change of state was stretched since its loads were eliminated.
    stretched: f64,
    /// Whether forces may still be accepted as balanced to round-off.
    may_settle: bool,
    rounds: Rounds,
    anderson: Anderson,
    length: LengthSearch,
}

/// Findings about one iterate.
struct Look {
    evaluation: Evaluation,
    /// The largest force, by which residuals are divided.
    scale: f64,
    /// Out-of-balance force divided by the force scale.
    residual: f64,
    limit: StepLimit,
    /// Whether the length is right: the iterate ends at the next change of contact, or at the
    /// largest share allowed.
    has_arrived: bool,
    /// Whether the residual is hardly less than the best so far.
    has_stalled: bool,
}

impl<'i, 'm> Iteration<'i, 'm> {
    /// Sets up the first iterate, scaled to the change of contact that the prediction shows.
    fn begin(
        solver: &'i mut Solver<'m>,
        rules: Rules<'i>,
        (end, most): (&'i LoadPoint, f64),
        (ends_at, search): (EndsAt, Search),
        ahead: Option<(LoadPoint, Equilibrium)>,
    ) -> Result<Self, NoIncrement> {
        let start = solver.at.clone();
        let before = solver.now.clone();
        solver.zone.begin_at(&before.u, &start.factors);
        let follows = matches!(ends_at, EndsAt::NextChange { .. });
        let newton = rules.settings.plastic_iteration == PlasticIteration::Newton;
        let prediction = match ahead {
            Some(ahead) => RatePrediction::secant(solver, end, ahead),
            None => RatePrediction::of_rates(solver, (end, most), newton, !follows),
        };
        let base = positive_values(solver.tableau.open(), &before.gap, &before.force);
        // A pair whose opening would set a body free cannot open. Its force may fall to zero within
        // round-off.
        let mut exempt = solver.border.clone();
        exempt.extend((0..base.len()).filter(|&k| solver.tableau.would_free(k)));
        let t = match follows {
            true => prediction.first_length(solver, (&base, &exempt), most)?,
            false => most,
        };
        let mut state = before.clone();
        state.add(t, &prediction.rates);
        let zeros = solver.structure.sub.zeros();
        let mut iteration = Iteration {
            solver,
            rules,
            end,
            most,
            ends_at,
            search,
            start,
            before,
            base,
            exempt,
            t,
            trial: (state.clone(), zeros.clone()),
            state,
            balance: zeros,
            known: None,
            iterations: 0,
            best: (f64::INFINITY, 0),
            damping: 0.0,
            stretched: prediction.stretched,
            may_settle: true,
            rounds: Rounds::default(),
            anderson: Anderson::default(),
            length: LengthSearch::default(),
        };
        iteration.settle_contact()?;
        Ok(iteration)
    }

    /// Iterates until forces balance and the length is right.
    fn run(mut self) -> Result<Increment, NoIncrement> {
        loop {
            let look = self.evaluate();
            let (is_balanced, floor) = self.judge(&look)?;
            if is_balanced && self.settle_contact()? {
                continue;
            }
            if is_balanced && look.has_arrived {
                if self.is_stretched_far() {
                    self.eliminate_anew();
                    continue;
                }
                return self.found(look, floor);
            }
            self.give_up(&look)?;
            if !is_balanced {
                self.correct(&look)?;
            }
            if self.follows() && (is_balanced || self.search.together) {
                self.rescale()?;
            }
        }
    }

    /// Whether the increment ends at the next change of contact.
    fn follows(&self) -> bool {
        matches!(self.ends_at, EndsAt::NextChange { .. })
    }

    /// The tolerances `gamma_u` and `gamma_R` of the paper (4.18, 4.23), which are one number here.
    fn gamma(&self) -> f64 {
        match self.ends_at {
            EndsAt::NextChange { gamma } => gamma,
            EndsAt::EndOfPiece | EndsAt::EndOfPieceFrozen => 0.0,
        }
    }

    /// The values of the iterate that must stay positive: gaps of open pairs, forces of closed ones
    /// (4.8, 4.9).
    fn values(&self) -> Vec<f64> {
        let state = &self.state;
        positive_values(self.solver.tableau.open(), &state.gap, &state.force)
    }

    /// The factor on the iterate at which contact changes (4.14 to 4.21).
    fn limit(&self) -> StepLimit {
        let open = self.solver.tableau.open();
        step_limit(open, &self.base, &self.values(), &self.exempt)
    }

    /// Computes the out-of-balance force of the iterate, and its distance from the change of
    /// contact.
    fn evaluate(&mut self) -> Look {
        let evaluation = match self.known.take() {
            Some(evaluation) => evaluation,
            None => {
                let point = self.start.towards(self.end, self.t);
                self.solver.zone.set_factors(&point.factors);
                self.solver
                    .out_of_balance_at(&self.state, &mut self.balance)
            }
        };
        self.iterations += 1;
        let forces = self.state.force.iter();
        let scale = forces.fold(self.solver.scales.force, |m, r| m.max(*r));
        let residual = if scale > 0.0 {
            self.balance.largest() / scale
        } else {
            0.0
        };
        let limit = match self.follows() {
            true => self.limit(),
            false => StepLimit::none(),
        };
        let reach = self.reach(&limit);
        let has_arrived = if limit.share < self.most / self.t {
            (reach - 1.0).abs() <= self.gamma()
        } else {
            self.t == self.most
        };
        Look {
            evaluation,
            scale,
            residual,
            limit,
            has_arrived,
            has_stalled: residual >= PROGRESS * self.best.0,
        }
    }

    /// Whether the forces of the iterate balance, to the tolerance or to their round-off. Also
    /// returns this round-off; zero if only the tolerance was considered.
    fn judge(&mut self, look: &Look) -> Result<(bool, f64), NoIncrement> {
        let is_balanced = look.residual <= self.rules.settings.tolerance;
        if is_balanced || !look.has_stalled || !self.may_settle {
            return Ok((is_balanced, 0.0));
        }
        let floor = round_off_of_balance(self.solver, &self.state.u)? / look.scale;
        let mut is_balanced = look.residual <= floor;
        if is_balanced {
            is_balanced = settles(self.solver, &self.state, floor);
            self.may_settle = is_balanced;
        }
        Ok((is_balanced, floor))
    }

    /// Changes the statuses that the iterate shows to be wrong, if the increment ends at the end of
    /// its piece. Returns whether there were any.
    fn settle_contact(&mut self) -> Result<bool, NoIncrement> {
        if self.ends_at != EndsAt::EndOfPiece {
            return Ok(false);
        }
        settle_contact(self.solver, self.end, &mut self.state, &mut self.rounds)
    }

    /// Whether the loads of the change of state must be eliminated again.
    fn is_stretched_far(&self) -> bool {
        let most = if self.follows() {
            STRETCH
        } else {
            STRETCH_OF_LONG
        };
        self.stretched > most
    }

    /// Eliminates the initial loads of the iterate again.
    fn eliminate_anew(&mut self) {
        self.stretched = 1.0;
        let (structure, cost) = (&self.solver.structure, &mut self.solver.cost);
        let initial = structure.eliminate_initial(self.state.initial.load.clone(), cost);
        let point = self.start.towards(self.end, self.t);
        self.state = self.solver.respond(&point, initial);
    }

    /// Returns the converged iterate as an increment; an error if a pair that began at the border
    /// has become negative.
    fn found(self, look: Look, floor: f64) -> Result<Increment, NoIncrement> {
        let gamma = self.gamma();
        if self.follows() {
            let crossed = self.crosses_border(gamma.max(BORDER), look.scale);
            if !crossed.is_empty() {
                return Err(NoIncrement::Crossed(crossed));
            }
        }
        let changes = if look.limit.share <= 1.0 + gamma {
            look.limit.pairs
        } else {
            Vec::new()
        };
        let scales = &mut self.solver.scales;
        scales.round_off = scales.round_off.max(floor);
        let at_end = self.start.towards(self.end, self.t);
        Ok(Increment {
            t: self.t,
            state: self.solver.respond(&at_end, self.state.initial),
            changes,
            iterations: self.iterations,
            residual: look.residual,
            guard_yields: look.evaluation.guard_yields,
            stretched: self.stretched,
        })
    }

    /// Returns an error if the iteration makes no progress, or if the caller asks to stop.
    fn give_up(&mut self, look: &Look) -> Result<(), NoIncrement> {
        if !look.has_stalled {
            self.best = (look.residual, self.iterations);
        }
        if (self.rules.stop)() {
            return Err(NoIncrement::Stopped);
        }
        let settings = self.rules.settings;
        let newton = settings.plastic_iteration == PlasticIteration::Newton;
        let is_stuck = newton && self.iterations - self.best.1 >= self.search.patience;
        // If the change of contact has moved nearer to the start than the accuracy of states, it
        // happens at once.
        let is_at_start = self.follows() && self.t <= settings.tolerance;
        if is_stuck && is_at_start && look.limit.share <= 1.0 + self.gamma() {
            return Err(NoIncrement::WrongStatus(look.limit.pairs.clone()));
        }
        let most = match newton {
            true => settings.max_iterations,
            false => settings.max_iterations * CHEAP_ITERATIONS,
        };
        if self.iterations >= most || is_stuck || !look.residual.is_finite() {
            return Err(self.not_converged(self.state.clone(), look, None));
        }
        Ok(())
    }

    fn not_converged(
        &self,
        state: Equilibrium,
        look: &Look,
        mechanism: Option<f64>,
    ) -> NoIncrement {
        match round_off_of_balance(self.solver, &self.before.u) {
            Ok(round_off) => NoIncrement::NotConverged(Box::new(Attempt {
                state,
                iterations: self.iterations,
                residual: look.residual,
                round_off: round_off / look.scale,
                mechanism,
            })),
            Err(error) => error.into(),
        }
    }

    /// Computes the next iterate at the same length.
    fn correct(&mut self, look: &Look) -> Result<(), NoIncrement> {
        let (direction, length) = match self.rules.settings.plastic_iteration {
            PlasticIteration::Newton => self.newton(look)?,
            PlasticIteration::Anderson => {
                let change = self
                    .anderson
                    .change(&self.state.initial.load, &self.balance);
                (self.solver.direction(change), 1.0)
            }
            PlasticIteration::Plain => (self.solver.direction(self.balance.clone()), 1.0),
        };
        self.state.add(length, &direction);
        if self.settle_contact()? {
            self.known = None;
            self.anderson.restart();
        }
        Ok(())
    }

    /// Newton's direction and the step length along it; the direction of the plain iteration if
    /// Newton's does not lower the energy.
    fn newton(&mut self, look: &Look) -> Result<(Equilibrium, f64), NoIncrement> {
        let keep = 1.0 - self.damping;
        let direction = solve_tangent(self.solver, &self.balance, FORCING, keep);
        let searched = (&self.state, &direction, &self.balance);
        let Some((length, evaluation)) = line_search(self.solver, searched, &mut self.trial) else {
            // The elastic stiffness is an upper bound of the tangent, so the plain step always
            // lowers the energy.
            self.damping = next_damping(self.damping, 0.0);
            return Ok((self.solver.direction(self.balance.clone()), 1.0));
        };
        self.damping = next_damping(self.damping, length);
        let goal = self.start.towards(self.end, self.t);
        let driven = (&self.balance, length);
        let mechanism = flows_away(self.solver, &goal, &direction, driven, &self.trial);
        if mechanism.is_some() {
            return Err(self.not_converged(self.trial.0.clone(), look, mechanism));
        }
        std::mem::swap(&mut self.balance, &mut self.trial.1);
        self.known = Some(evaluation);
        Ok((direction, length))
    }

    /// Scales the increment so that it ends at the next change of contact (4.17, 4.22).
    fn rescale(&mut self) -> Result<(), NoIncrement> {
        let limit = self.limit();
        let reach = self.reach(&limit);
        if reach <= AT_ONCE {
            return Err(NoIncrement::WrongStatus(limit.pairs));
        }
        if !reach.is_finite() || reach == 1.0 {
            return Ok(());
        }
        let (t, most, together) = (self.t, self.most, self.search.together);
        // If the change is predicted to be far off, the length is changed in moderation: the
        // response is not linear.
        let goal = (reach.clamp(0.1, 4.0) * t).min(most);
        if !together && t <= AT_START * most && goal < t {
            return Err(NoIncrement::Jumps);
        }
        let next = match together {
            true => t + self.length.relaxation(t, goal) * (goal - t),
            false => self.length.between(t, goal, AT_START * most),
        };
        let next = if next >= most * (1.0 - 4.0 * f64::EPSILON) {
            most
        } else {
            next
        };
        if next <= AT_ONCE {
            return Err(NoIncrement::WrongStatus(limit.pairs));
        }
        self.state.rescale(&self.before, next / t);
        self.stretched *= f64::max(next / t, 1.0);
        self.t = next;
        self.known = None;
        if !together {
            self.best = (f64::INFINITY, self.iterations);
        }
        self.anderson.restart();
        Ok(())
    }

    /// Factor on the iterate that takes it to the next change of contact or to the end.
    fn reach(&self, limit: &StepLimit) -> f64 {
        if limit.share * self.t >= self.most * (1.0 - AT_END) {
            self.most / self.t
        } else {
            limit.share
        }
    }

    /// Pairs that began at the border, with a gap or force of zero, and end with a negative one.
    /// The rate of such a value was right at the start and changed its sign within the increment;
    /// the step limit leaves these pairs out.
    fn crosses_border(&self, tolerance: f64, force_scale: f64) -> Vec<usize> {
        let state = &self.state;
        let largest_gap = state.gap.iter().fold(0.0f64, |m, g| m.max(*g));
        let crosses = |k: usize| {
            if self.solver.tableau.open()[k] {
                state.gap[k] < -tolerance * largest_gap
            } else {
                state.force[k] < -tolerance * force_scale
            }
        };
        let border = self.solver.border.iter().copied();
        border.filter(|&k| crosses(k)).collect()
    }
}

/// The next damping of Newton's tangent: more towards the elastic stiffness after a short step,
/// less after full steps.
fn next_damping(damping: f64, length: f64) -> f64 {
    if length < 0.5 {
        f64::min(4.0 * damping.max(0.01), 0.6)
    } else if length >= 1.0 {
        if damping < 0.01 { 0.0 } else { 0.25 * damping }
    } else {
        damping
    }
}
