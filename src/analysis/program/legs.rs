//! A program in legs: other supports hold the model in each of them.
//!
//! Each leg has a model, and a factorisation, of its own. Displacements are total ones, so the next
//! leg needs the plastic history, the displacements of nodes that are held from now on, and the
//! forces of supports that have ended ([`Model::next_leg`]). It begins with the loads at which the
//! last one ended, in the same equilibrium: that is checked.

use super::assembled::Analysis;
use super::position::{Position, Purpose};
use super::run::Run;
use super::stopwatch::TimeRow;
use crate::analysis::choice::zone_choice::{self, Choice};
use crate::analysis::choice::zone_fit::{Expected, ZoneFit};
use crate::analysis::structure::solver::{Scales, Solver};
use crate::analysis::structure::starting;
use crate::analysis::structure::state::State;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::number::significant;
use crate::progress::Observer;
use crate::results::{Counts, Results};
use crate::space::{Vector, along, length};

/// Largest difference between the displacements at the end of a leg and at the beginning of the
/// next, relative to the largest displacement. Equilibrium is met to `analysis.tolerance`, 1e-10,
/// of the forces; a condition of 1e10 turns round-off into as much.
const SAME_STATE: f64 = 1e-6;

/// What a run hands over to the run of the next leg.
struct HandedOver {
    position: Position,
    results: Results,
    zone: Choice,
    state: State,
    displacements: Vec<Vector>,
    counts: Counts,
    condition: f64,
    scales: Scales,
}

/// Result of the run of a leg.
enum Leg {
    /// The program is over.
    Last(Box<Results>),
    /// Another leg follows: its model, and what it begins with.
    Before(Box<(Model, HandedOver)>),
}

/// Runs a program leg by leg. A run that fails after increments were accepted returns the results
/// so far.
///
/// # Errors
/// Errors of [`Run::new`]; those of the factorisation of a later leg.
pub(super) fn run(
    first: &Analysis,
    expected: Option<Expected>,
    observer: &mut dyn Observer,
) -> Result<Results> {
    let run = Run::new(first, Purpose::Program, expected, &mut *observer)?;
    let mut leg = match run.leg()? {
        Leg::Last(results) => return Ok(*results),
        Leg::Before(next) => next,
    };
    loop {
        let (model, handed) = *leg;
        let analysis = Analysis::new(model, first.backend)?;
        let run = Run::going_on(&analysis, handed, &mut *observer)?;
        leg = match run.leg()? {
            Leg::Last(results) => return Ok(*results),
            Leg::Before(next) => next,
        };
    }
}

impl<'m, 'o> Run<'m, 'o> {
    /// Sets up the run of the next leg at its beginning.
    ///
    /// # Errors
    /// Errors of [`Solver::new`]; a state that is not that at the end of the last leg.
    fn going_on(
        analysis: &'m Analysis,
        handed: HandedOver,
        observer: &'o mut dyn Observer,
    ) -> Result<Self> {
        let model = &analysis.model;
        observer.phase("factorisation");
        let choice = handed.zone;
        let guess = zone_choice::first_guess(model);
        let within = zone_choice::including(model, &guess, &choice.elements);
        let (system, elements) = (&analysis.system, choice.elements.clone());
        let mut solver = Solver::new(
            model,
            system,
            analysis.backend,
            &within.elements,
            elements,
            &choice.guard,
        )?;
        solver.cost.counts = solver.cost.counts.and(&handed.counts);
        solver.scales = handed.scales;
        let condition = &mut solver.structure.condition;
        *condition = condition.max(handed.condition);
        starting::begin_at(&mut solver, &handed.state);
        let mut run = Run::of(solver, ZoneFit::new(choice), handed.results, observer);
        run.position = handed.position;
        run.follow_sets()?;
        run.check_same_state(&handed.displacements)?;
        run.tell_of_dents();
        run.timed(TimeRow::Zone, |run| run.fit_zone_of_leg())?;
        run.observer.phase("load program");
        Ok(run)
    }

    /// Runs to the end of the leg.
    ///
    /// # Errors
    /// Errors before the first increment.
    fn leg(mut self) -> Result<Leg> {
        let outcome = self.execute();
        let Some(end) = self.model().end_of_leg().filter(|_| outcome.is_ok()) else {
            return self
                .complete(outcome)
                .map(|results| Leg::Last(Box::new(results)));
        };
        self.position.seconds.switch(TimeRow::States);
        match self.next_model(end) {
            Ok((model, displacements)) => {
                let handed = self.hand_over(displacements);
                Ok(Leg::Before(Box::new((model, handed))))
            }
            Err(error) => {
                let results = self.complete(Err(error))?;
                Ok(Leg::Last(Box::new(results)))
            }
        }
    }

    /// The model of the next leg, from the state at the end of this one.
    ///
    /// # Errors
    /// Errors of [`Model::next_leg`].
    fn next_model(&mut self, at: f64) -> Result<(Model, Vec<Vector>)> {
        let fields = self.solver.reading().figures("", true)?.state.fields;
        let fields = fields.ok_or_else(|| Error::internal("a state without its fields"))?;
        let model = self.model();
        let vectors = |values: &[f64]| -> Vec<Vector> {
            let rows = values.chunks(model.mesh.dimension);
            let vector = |row: &[f64]| std::array::from_fn(|d| row.get(d).copied().unwrap_or(0.0));
            rows.map(vector).collect()
        };
        let displacements = vectors(&fields.displacement);
        let state = (displacements.clone(), vectors(&fields.force));
        let mut next = model.next_leg(at, state, &self.solver.at.factors)?;
        next.start = starting::end_state(&self.solver).filter(|state| !state.is_virgin());
        Ok((next, displacements))
    }

    /// Ends the run of a leg, whose state another run takes over.
    fn hand_over(mut self, displacements: Vec<Vector>) -> HandedOver {
        self.position.seconds.switch(TimeRow::Condensation);
        let solver = self.solver;
        HandedOver {
            position: self.position,
            results: self.results,
            zone: self.zone.choice,
            state: solver.state(),
            displacements,
            counts: solver.cost.counts,
            condition: solver.structure.condition,
            scales: solver.scales,
        }
    }

    /// Warns that dents count the supports of the leg as at rest.
    fn tell_of_dents(&mut self) {
        let model = self.model();
        let begun = model.scene.support.iter().any(|s| s.since.is_some());
        if begun && model.start.is_some() && !model.pairs.is_empty() {
            let text = format!(
                "residual depths from load factor {} on are those that the supports of this leg of \
                 the program would leave, were they at rest where the mesh has their nodes",
                significant(self.solver.at.alpha, 6)
            );
            self.warn(Some(text));
        }
    }

    /// Checks that the leg begins in the state in which the last one ended.
    fn check_same_state(&mut self, before: &[Vector]) -> Result<()> {
        let u = self.solver.reading().displacements()?.total;
        let model = self.model();
        let here = model.nodal(&u, &self.solver.at.factors);
        let sizes = before.iter().map(|u| length(*u));
        let largest = sizes.fold(self.solver.scales.displacement, f64::max);
        let off = here.iter().zip(before);
        let off = off.map(|(here, before)| length(along(*here, -1.0, *before)));
        let (mut node, mut most) = (0, 0.0);
        for (index, off) in off.enumerate() {
            if off > most {
                (node, most) = (index, off);
            }
        }
        // If nothing has moved yet, displacements are those of round-off.
        let round_off = f64::EPSILON * model.mesh.diagonal();
        if most <= round_off.max(SAME_STATE * largest) {
            return Ok(());
        }
        Err(Error::analysis(format!(
            "where supports change, at load factor {}, the equilibrium is lost: node {} jumps by \
             {}, {} of the largest displacement. Does a body rest on nothing but contact there, or \
             has its contact been taken off? Give it a support",
            significant(self.solver.at.alpha, 6),
            model.mesh.node_label(node),
            significant(most, 3),
            significant(most / largest, 2)
        )))
    }

    /// Enlarges the zone by the elements in which elastic stress at the targets of the leg is
    /// beyond yield.
    fn fit_zone_of_leg(&mut self) -> Result<()> {
        let model = self.model();
        if self.zone.choice.holds_all(model) {
            return Ok(());
        }
        let from = self.solver.at.alpha;
        let ahead = &model.scene.program.targets[self.position.target..self.last_target];
        let factors = ahead.iter().filter_map(|target| target.load_factor);
        let kinks = model.kinks().filter(|kink| *kink > from);
        let last = factors.clone().fold(from, f64::max);
        let factors: Vec<f64> = factors.chain(kinks.filter(|kink| *kink < last)).collect();
        let ratios = self.elastic_ratios(&factors)?;
        let predicted = zone_choice::predict(model, &ratios);
        let known = |e: &usize| self.zone.choice.elements.binary_search(e).is_ok();
        if predicted.elements.iter().all(known) {
            return Ok(());
        }
        let both = zone_choice::joined(model, [&predicted, &self.zone.choice]);
        self.set_zone(both)
    }
}
