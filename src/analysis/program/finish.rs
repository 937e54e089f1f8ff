//! The results of a run at its end, wherever it ended.

use super::run::Run;
use super::stopwatch::TimeRow;
use crate::analysis::check::effects::effects;
use crate::analysis::figures::deformation::softened;
use crate::analysis::figures::quality;
use crate::analysis::structure::starting::end_state;
use crate::deck::words;
use crate::error::Result;
use crate::model::Model;
use crate::number::significant;
use crate::results::{Incomplete, PairState, Quality, Results, Sizes, State, Status, Tolerances};

/// Lower bound of the condition number above which the condition number is estimated without being
/// asked for: six digits of a displacement may be left.
const DOUBTFUL: f64 = 1e10;

/// The results of a run with the given outcome, as far as it came.
///
/// # Errors
/// The error of the outcome, if there are no results.
pub(super) fn results(mut run: Run, outcome: Result<()>) -> Result<Results> {
    run.position.seconds.switch(TimeRow::States);
    let results = std::mem::take(&mut run.results);
    let states = results.states.iter().map(|s| (s.name.clone(), s.quality));
    let at_yield = run.at_yield.map(|q| ("yield".to_string(), q));
    let ended = EndedRun {
        judged: states.chain(at_yield).collect(),
        tolerances: quality::tolerances(run.model()),
        results,
        run,
    };
    let mut results = ended.finish();
    match outcome {
        Ok(()) => {}
        Err(error) if results.states.is_empty() && results.history.is_empty() => {
            return Err(error);
        }
        Err(error) => {
            results.incomplete = Some(Incomplete {
                kind: error.kind(),
                why: error.in_full(),
            });
        }
    }
    Ok(results)
}

/// A run that goes no further, and what becomes of its results.
struct EndedRun<'m, 'o> {
    run: Run<'m, 'o>,
    results: Results,
    /// States with their quality, including the state at first yield.
    judged: Vec<(String, Quality)>,
    tolerances: Tolerances,
}

impl EndedRun<'_, '_> {
    /// Completes the results of the run, as far as it came.
    fn finish(mut self) -> Results {
        let model = self.run.model();
        self.results.sizes = self.sizes();
        let solver = &self.run.solver;
        self.results.counts = solver.cost.counts;
        self.results.first_yield = self.run.position.first_yield.point;
        self.results.factor = solver.structure.sub.cost();
        self.results.condition = solver.structure.condition;
        self.tell_of_round_off();
        self.tell_of_deformation();
        for text in never_closed(model, &self.results.states) {
            self.tell(text);
        }
        if let Some(text) = self.closed_though_opened() {
            self.tell_inaccurate(text);
        }
        self.judge_quality();
        let (solver, results) = (&self.run.solver, &mut self.results);
        let structure = &solver.structure;
        if model.settings.condition
            || !results.inaccurate.is_empty()
            || results.condition > DOUBTFUL
        {
            // The estimate is an additional figure: if its solve fails, it is left out.
            let estimate = structure.sub.condition_estimate(model, structure.system);
            results.condition_estimate = estimate.ok();
        }
        results.cycles = self.run.position.cycles.outcome(model);
        results.ranks = structure.system.stiffness.ranks();
        results.end_state = end_state(solver);
        self.with_effects()
    }

    fn sizes(&self) -> Sizes {
        let model = self.run.model();
        Sizes {
            freedoms: model.freedoms.n,
            nodes: model.mesh.n_nodes(),
            elements: model.mesh.n_elements(),
            contact_pairs: model.pairs.len(),
            zone_freedoms: self.run.solver.structure.sub.partition.zone.len(),
            zone_elements: self.run.zone.choice.elements.len(),
            degree: model.mesh.degree(),
        }
    }

    fn tell(&mut self, text: String) {
        let text = words::text_of_deck(&self.run.model().scene, &text);
        self.run.observer.warning(&text);
        self.results.warnings.push(text);
    }

    fn tell_inaccurate(&mut self, text: String) {
        self.tell(text.clone());
        self.results.inaccurate.push(text);
    }

    /// Warns if forces balance only to round-off.
    fn tell_of_round_off(&mut self) {
        // An elastic state is not iterated: its forces are out of balance by round-off.
        let excused = (self.judged.iter()).filter_map(|(_, q)| q.excused(&self.tolerances));
        let floor = excused.fold(self.run.solver.scales.round_off, f64::max);
        if floor > 0.0 {
            let tolerance = self.run.model().settings.tolerance;
            let text = format!(
                "forces balance to their round-off, {floor:.1e} of the largest force, and not to \
                 analysis.tolerance = {tolerance:.1e}: displacements are large compared with the \
                 strains of this mesh"
            );
            self.tell(text);
        }
    }

    /// Warns of strains and rotations that are not small, and of the effects left out if the scene
    /// asks for large deformations.
    fn tell_of_deformation(&mut self) {
        let model = self.run.model();
        if let Some(text) = self.run.position.deformation.warning() {
            self.tell(text);
        }
        let Some(place) = &model.scene.requests.large else {
            return;
        };
        let (text, is_small) = self.run.position.deformation.taken_small(place);
        self.tell(text.clone());
        if let Some(text) = softened(model, &self.results, place) {
            self.tell(text);
        }
        if !is_small {
            self.results.inaccurate.push(text);
        }
    }

    /// A message about a contact that a load opens by more than half the size of the model but that
    /// is nevertheless closed: its body has moved there, since nothing else holds the body.
    fn closed_though_opened(&self) -> Option<String> {
        let model = self.run.model();
        let far = 0.5 * model.mesh.diagonal();
        self.results.states.iter().find_map(|state| {
            let factors = self.run.solver.structure.point(state.alpha).factors;
            let opened = |pair: &PairState| -> f64 {
                let loads = model.loads.iter().zip(&factors);
                // A point on the axis of revolution may be no pair of the model.
                let own = model.pairs.get(pair.pair);
                own.map_or(0.0, |own| loads.map(|(load, h)| h * load.gap(own)).sum())
            };
            let mut closed = (state.pairs.iter()).filter(|pair| pair.status == Status::Closed);
            let pair = closed.find(|pair| opened(pair) > far)?;
            let contact = &model.contacts[pair.contact];
            Some(format!(
                "contact {} (`{}` on `{}`) carries a force in state `{}` though its surfaces are \
                 taken apart by {}: nothing else holds a body there, which moves as far; give it \
                 a support",
                pair.contact + 1,
                contact.names[0],
                contact.names[1],
                state.name,
                significant(opened(pair), 4)
            ))
        })
    }

    /// Sets the worst quality, and warns of states whose figures of quality miss their tolerances.
    fn judge_quality(&mut self) {
        let qualities = self.judged.iter().map(|(_, q)| q);
        self.results.quality = qualities.fold(Quality::default(), |w, q| w.merge_worst(q));
        let condition = self.results.condition;
        for (name, quality) in std::mem::take(&mut self.judged) {
            for (figure, value, most) in quality.misses(&self.tolerances) {
                self.tell_inaccurate(format!(
                    "state `{name}` is inaccurate: {figure} {value:.1e}, allowed {most:.1e} \
                     (condition at least {condition:.0e})"
                ));
            }
        }
    }

    /// The results with the effects, their time and memory, and the time table.
    fn with_effects(self) -> Results {
        let EndedRun {
            run, mut results, ..
        } = self;
        let model = run.model();
        let first_yield = run.position.first_yield;
        let yields = first_yield.alpha.is_some() || first_yield.is_behind;
        results.effects = effects(model, yields, model.start.as_ref());
        let mut seconds = run.position.seconds;
        let bytes = [
            run.solver.structure.sub.contact_bytes(),
            run.solver.zone.bytes(),
        ];
        // Freeing the memory of the solver takes time, too.
        drop((run.solver, run.zone));
        seconds.switch(TimeRow::States);
        for (row, name) in TimeRow::ALL {
            results
                .timings
                .push((name.to_string(), seconds.seconds(row)));
        }
        for effect in &mut results.effects {
            match effect.name.as_str() {
                "contact" => {
                    effect.seconds =
                        seconds.seconds(TimeRow::Contact) + seconds.seconds(TimeRow::YieldLoad);
                    effect.memory_bytes = bytes[0];
                }
                "plasticity" if effect.on => {
                    effect.seconds = seconds.seconds(TimeRow::Plasticity);
                    effect.memory_bytes = bytes[1];
                }
                _ => {}
            }
        }
        results
    }
}

/// Warnings about contacts none of whose pairs is closed in any state.
fn never_closed(model: &Model, states: &[State]) -> Vec<String> {
    // For each contact that is open in every state: the smallest gap, and the state with this gap.
    let mut nearest: Vec<Option<(f64, &str)>> = vec![None; model.contacts.len()];
    let mut closed = vec![false; model.contacts.len()];
    for state in states {
        for pair in &state.pairs {
            closed[pair.contact] |= pair.status == Status::Closed;
            let nearest = &mut nearest[pair.contact];
            if nearest.is_none_or(|(gap, _)| pair.gap < gap) {
                *nearest = Some((pair.gap, &state.name));
            }
        }
    }
    let contacts = model.contacts.iter().zip(nearest).zip(closed).enumerate();
    let open = contacts.filter(|(_, (_, closed))| !closed);
    let texts = open.filter_map(|(index, ((contact, nearest), _))| {
        let (gap, state) = nearest?;
        Some(format!(
            "contact {} (`{}` on `{}`) is open in every state: its smallest gap is {}, in state \
             `{state}`; do the surfaces look at each other, and does the load close it?",
            index + 1,
            contact.names[0],
            contact.names[1],
            significant(gap, 4),
        ))
    });
    texts.collect()
}
