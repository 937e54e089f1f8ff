//! The results of a run at its end, wherever it ended.

use super::run::Run;
use super::stopwatch::TimeRow;
use crate::analysis::check::effects::effects;
use crate::analysis::figures::deformation::softened;
use crate::analysis::figures::quality;
use crate::analysis::structure::starting::end_state;
use crate::deck::words;
use crate::model::Model;
use crate::number::significant;
use crate::results::{PairState, Quality, Results, Sizes, State, Status, Tolerances};

/// Lower bound of the condition number above which the condition number is estimated without being
/// asked for: six digits of a displacement may be left.
const DOUBTFUL: f64 = 1e10;

/// States with their quality, including the state at first yield.
type JudgedStates = Vec<(String, Quality)>;

impl Run<'_, '_> {
    /// Completes the results of the run, as far as it came.
    pub(super) fn finish(mut self) -> Results {
        self.position.seconds.switch(TimeRow::States);
        let model = self.solver.structure.model;
        let mut results = std::mem::take(&mut self.results);
        results.sizes = self.sizes();
        results.counts = self.solver.cost.counts;
        results.first_yield = self.position.first_yield.point;
        results.factor = self.solver.structure.sub.cost();
        results.condition = self.solver.structure.condition;
        let states = results.states.iter().map(|s| (s.name.clone(), s.quality));
        let at_yield = self.at_yield.map(|q| ("yield".to_string(), q));
        let judged: JudgedStates = states.chain(at_yield).collect();
        let tolerances = quality::tolerances(model);
        self.tell_of_round_off(&mut results, &judged, &tolerances);
        self.tell_of_deformation(&mut results);
        for text in never_closed(model, &results.states) {
            self.tell(&mut results, text);
        }
        if let Some(text) = self.closed_though_opened(&results.states) {
            self.tell(&mut results, text.clone());
            results.inaccurate.push(text);
        }
        self.judge_quality(&mut results, &judged, &tolerances);
        if model.scene.analysis.condition
            || !results.inaccurate.is_empty()
            || results.condition > DOUBTFUL
        {
            // The estimate is an additional figure: if its solve fails, it is left out.
            let structure = &self.solver.structure;
            let estimate = structure.sub.condition_estimate(model, structure.system);
            results.condition_estimate = estimate.ok();
        }
        let qualities = judged.iter().map(|(_, q)| q);
        results.quality = qualities.fold(Quality::default(), |w, q| w.merge_worst(q));
        results.cycles = self.position.cycles.outcome(model);
        results.ranks = self.solver.structure.system.stiffness.ranks();
        results.end_state = end_state(&self.solver);
        self.add_effects(&mut results);
        results
    }

    fn sizes(&self) -> Sizes {
        let model = self.solver.structure.model;
        Sizes {
            freedoms: model.freedoms.n,
            nodes: model.mesh.n_nodes(),
            elements: model.mesh.n_elements(),
            contact_pairs: model.pairs.len(),
            zone_freedoms: self.solver.structure.sub.partition.zone.len(),
            zone_elements: self.zone.choice.elements.len(),
            degree: model.mesh.degree(),
        }
    }

    fn tell(&mut self, results: &mut Results, text: String) {
        let text = words::text_of_deck(&self.solver.structure.model.scene, &text);
        self.observer.warning(&text);
        results.warnings.push(text);
    }

    /// Warns if forces balance only to round-off.
    fn tell_of_round_off(
        &mut self,
        results: &mut Results,
        judged: &JudgedStates,
        tolerances: &Tolerances,
    ) {
        // An elastic state is not iterated: its forces are out of balance by round-off.
        let excused = judged.iter().filter_map(|(_, q)| q.excused(tolerances));
        let floor = excused.fold(self.solver.scales.round_off, f64::max);
        if floor > 0.0 {
            let tolerance = self.solver.structure.model.scene.analysis.tolerance;
            let text = format!(
                "forces balance to their round-off, {floor:.1e} of the largest force, and not to \
                 analysis.tolerance = {tolerance:.1e}: displacements are large compared with the \
                 strains of this mesh"
            );
            self.tell(results, text);
        }
    }

    /// Warns of strains and rotations that are not small, and of the effects left out if the scene
    /// asks for large deformations.
    fn tell_of_deformation(&mut self, results: &mut Results) {
        let model = self.solver.structure.model;
        if let Some(text) = self.position.deformation.warning() {
            self.tell(results, text);
        }
        let Some(place) = &model.scene.requests.large else {
            return;
        };
        let (text, is_small) = self.position.deformation.taken_small(place);
        self.tell(results, text.clone());
        if let Some(text) = softened(model, results, place) {
            self.tell(results, text);
        }
        if !is_small {
            results.inaccurate.push(text);
        }
    }

    /// The message about a contact that a load opens by more than half the size of the model, and
    /// that is closed all the same: its body has gone there, since nothing else holds it.
    fn closed_though_opened(&self, states: &[State]) -> Option<String> {
        let model = self.solver.structure.model;
        let far = 0.5 * model.mesh.diagonal();
        states.iter().find_map(|state| {
            let factors = self.solver.structure.point(state.alpha).factors;
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

    /// Warns of states whose figures of quality miss their tolerances.
    fn judge_quality(
        &mut self,
        results: &mut Results,
        judged: &JudgedStates,
        tolerances: &Tolerances,
    ) {
        for (name, quality) in judged {
            for (figure, value, most) in quality.misses(tolerances) {
                let text = format!(
                    "state `{name}` is inaccurate: {figure} {value:.1e}, allowed {most:.1e} \
                     (condition at least {:.0e})",
                    results.condition
                );
                self.tell(results, text.clone());
                results.inaccurate.push(text);
            }
        }
    }

    /// Adds the effects, with their time and memory, and the time table.
    fn add_effects(mut self, results: &mut Results) {
        let model = self.solver.structure.model;
        let first_yield = self.position.first_yield;
        let yields = first_yield.alpha.is_some() || first_yield.is_behind;
        results.effects = effects(model, yields, model.start.as_ref());
        let structure = &self.solver.structure;
        let bytes = [structure.sub.contact_bytes(), self.solver.zone.bytes()];
        // Freeing the memory of the solver takes time, too.
        drop((self.solver, self.zone));
        let seconds = &mut self.position.seconds;
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
