//! A program in legs: in each leg, other supports hold the model.
//!
//! Each leg has a model and a factorisation of its own. Displacements are counted from the start of
//! the program, so the next leg needs the plastic history, the displacements of nodes that are held
//! from now on, and the forces of supports that have ended ([`Model::next_leg`]). The next leg
//! begins with the loads at which the last leg ended. A check compares its first equilibrium with
//! the last equilibrium of the leg before.

use super::assembled::Analysis;
use super::finish;
use super::position::{Position, Purpose};
use super::run::Run;
use super::stopwatch::TimeRow;
use crate::analysis::choice::zone_choice::{self, Choice};
use crate::analysis::choice::zone_fit::{Expected, ZoneFit};
use crate::analysis::figures::reading::Reading;
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
/// next, relative to the largest displacement. Both equilibria are accurate to
/// `analysis.tolerance`, by default 1e-10 of the forces; at a condition number of 1e10 round-off is
/// as large as this bound.
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
    /// Another leg follows: its model, and the data with which it begins.
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
    let mut leg = match run_leg(run)? {
        Leg::Last(results) => return Ok(*results),
        Leg::Before(next) => next,
    };
    loop {
        let (model, handed) = *leg;
        let analysis = Analysis::new(model, first.backend)?;
        let run = handed.go_on(&analysis, &mut *observer)?;
        leg = match run_leg(run)? {
            Leg::Last(results) => return Ok(*results),
            Leg::Before(next) => next,
        };
    }
}

impl HandedOver {
    /// Ends the run of a leg, and keeps what the next leg needs.
    fn of(mut run: Run, displacements: Vec<Vector>) -> Self {
        run.position.seconds.switch(TimeRow::Condensation);
        let solver = run.solver;
        HandedOver {
            position: run.position,
            results: run.results,
            zone: run.zone.choice,
            state: solver.state(),
            displacements,
            counts: solver.cost.counts,
            condition: solver.structure.condition,
            scales: solver.scales,
        }
    }

    /// Sets up the run of the next leg at its beginning.
    ///
    /// # Errors
    /// Errors of [`Solver::new`]; a state that differs from the state at the end of the last leg.
    fn go_on<'m, 'o>(
        self,
        analysis: &'m Analysis,
        observer: &'o mut dyn Observer,
    ) -> Result<Run<'m, 'o>> {
        let model = &analysis.model;
        observer.phase("factorisation");
        let choice = self.zone;
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
        solver.cost.counts = solver.cost.counts.and(&self.counts);
        solver.scales = self.scales;
        let condition = &mut solver.structure.condition;
        *condition = condition.max(self.condition);
        starting::begin_at(&mut solver, &self.state);
        let mut run = Run::of(solver, ZoneFit::new(choice), self.results, observer);
        run.position = self.position;
        run.follow_sets();
        check_same_state(&mut run.solver, &self.displacements)?;
        run.warn(note_on_dents(&run.solver));
        run.timed(TimeRow::Zone, |run| {
            let first = run.position.target;
            let choice = run.zone.for_leg(&mut run.solver, &run.targets, first)?;
            choice.map_or(Ok(()), |choice| run.set_zone(choice))
        })?;
        run.observer.phase("load program");
        Ok(run)
    }
}

/// Runs to the end of the leg.
///
/// # Errors
/// Errors before the first increment.
fn run_leg(mut run: Run) -> Result<Leg> {
    let outcome = run.execute();
    let Some(end) = run.model().end_of_leg().filter(|_| outcome.is_ok()) else {
        return finish::results(run, outcome).map(|results| Leg::Last(Box::new(results)));
    };
    run.position.seconds.switch(TimeRow::States);
    match next_model(&mut run.solver, end) {
        Ok((model, displacements)) => {
            let handed = HandedOver::of(run, displacements);
            Ok(Leg::Before(Box::new((model, handed))))
        }
        Err(error) => {
            let results = finish::results(run, Err(error))?;
            Ok(Leg::Last(Box::new(results)))
        }
    }
}

/// The model of the next leg, from the state at the end of this one.
///
/// # Errors
/// Errors of [`Model::next_leg`].
fn next_model(solver: &mut Solver, at: f64) -> Result<(Model, Vec<Vector>)> {
    let fields = Reading::of(solver).figures("", true)?.state.fields;
    let fields = fields.ok_or_else(|| Error::internal("a state without its fields"))?;
    let model = solver.structure.model;
    let vectors = |values: &[f64]| -> Vec<Vector> {
        let rows = values.chunks(model.mesh.dimension);
        let vector = |row: &[f64]| std::array::from_fn(|d| row.get(d).copied().unwrap_or(0.0));
        rows.map(vector).collect()
    };
    let displacements = vectors(&fields.displacement);
    let state = (displacements.clone(), vectors(&fields.force));
    let mut next = model.next_leg(at, state, &solver.at.factors)?;
    next.start = starting::end_state(solver).filter(|state| !state.is_virgin());
    Ok((next, displacements))
}

/// A warning that dents are found with the supports of the leg at rest.
fn note_on_dents(solver: &Solver) -> Option<String> {
    let model = solver.structure.model;
    let begun = model.scene.support.iter().any(|s| s.since.is_some());
    (begun && model.start.is_some() && !model.pairs.is_empty()).then(|| {
        format!(
            "residual depths from load factor {} on are computed as if the supports of this leg \
             held their nodes where the mesh has them",
            significant(solver.at.alpha, 6)
        )
    })
}

/// Checks that the leg begins in the state in which the last one ended.
fn check_same_state(solver: &mut Solver, before: &[Vector]) -> Result<()> {
    let u = Reading::of(solver).displacements()?.total;
    let model = solver.structure.model;
    let here = model.nodal(&u, &solver.at.factors);
    let sizes = before.iter().map(|u| length(*u));
    let largest = sizes.fold(solver.scales.displacement, f64::max);
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
        significant(solver.at.alpha, 6),
        model.mesh.node_label(node),
        significant(most, 3),
        significant(most / largest, 2)
    )))
}
