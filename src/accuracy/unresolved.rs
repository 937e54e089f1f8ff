//! Contacts that a mesh does not resolve, and the figures whose error is therefore unknown.
//!
//! The pressures of the last pairs at the edge of a contact ([`EdgeReading::AT_EDGE`]) are not
//! pressures at points. If a side of a contact has no other pairs, neither a pressure nor the
//! stress below it is known: meshes agree there only because all of them replace the contact by the
//! same few forces. If surfaces are apart on all meshes, but by less than the uncertainty that the
//! meshes leave, it is not known whether they touch.

use super::extrapolation::extrapolate;
use super::graded;
use super::quantities::{CONTACT_FORCE, Quantity};
use crate::number::significant;
use crate::results::{EdgeReading, Results, State};
use crate::scene::{LocalRefinement, Scene, Unit};
use std::collections::BTreeSet;

/// Figures of a state that the equilibrium of the whole decides, not the contact.
const OF_THE_WHOLE: [&str; 4] = ["load", "approach", "contact_force", CONTACT_FORCE];

/// Figures of a state that are zero as long as the surfaces are apart.
const OF_CONTACT: [&str; 4] = [
    "max_pressure",
    "pole_pressure",
    "half_width",
    "contact_area",
];

/// First yield and states in which the mesh is too coarse for the contact, states in which it is
/// not known whether the surfaces touch, and the refinement that would help.
pub(super) struct Unresolved {
    /// Whether the contact is not resolved at first yield.
    at_yield: bool,
    /// Whether load factors are in units of the load at first yield.
    in_yield_loads: bool,
    /// States that are reached at first yield.
    yielding: BTreeSet<String>,
    states: BTreeSet<String>,
    /// States in which it is not known whether the surfaces touch.
    nearly_closed: BTreeSet<String>,
    /// Refinement of the mesh that would help.
    refinement: Option<LocalRefinement>,
}

/// The smallest gap of a loaded state without contact forces. `None` if there are contact forces or
/// no pairs, or if there is no load, so that nothing presses the surfaces on each other.
fn gap_of_open(state: &State) -> Option<f64> {
    let gaps = state.pairs.iter().map(|pair| pair.gap);
    let is_open = state.contact_force == 0.0 && state.is_loaded;
    gaps.reduce(f64::min).filter(|_| is_open)
}

fn is_unresolved(width: f64, reading: &EdgeReading) -> bool {
    reading.pairs <= EdgeReading::AT_EDGE && reading.is_of_pressures(width)
}

impl Unresolved {
    pub(super) fn of(scene: &Scene, results: &Results) -> Self {
        let first = results.first_yield.as_ref();
        let targets = scene.program.targets.iter().zip(scene.program.labels());
        let states = results.states.iter();
        Unresolved {
            at_yield: first.is_some_and(|y| is_unresolved(y.half_width, &y.half_width_reading)),
            in_yield_loads: scene.program.unit == Unit::Yield,
            yielding: (targets.filter(|(target, _)| target.first_yield))
                .map(|(_, label)| label)
                .collect(),
            states: (states.filter(|s| is_unresolved(s.half_width, &s.half_width_reading)))
                .map(|state| state.name.clone())
                .collect(),
            nearly_closed: BTreeSet::new(),
            refinement: graded::suggested(scene, results),
        }
    }

    /// Finds the states in which all contacts are open on all meshes while the smallest gap is no
    /// larger than its uncertainty. `others` are the runs on other meshes with their element sizes,
    /// `formal` is the order of displacements.
    pub(super) fn find_nearly_closed(
        &mut self,
        results: &Results,
        others: &[(f64, &Results)],
        formal: f64,
    ) {
        for state in &results.states {
            let Some(gap) = gap_of_open(state) else {
                continue;
            };
            let there = others.iter().filter_map(|(ratio, other)| {
                let same = other.states.iter().find(|other| other.name == state.name);
                Some((*ratio, gap_of_open(same?)?))
            });
            let values: Vec<(f64, f64)> = std::iter::once((1.0, gap)).chain(there).collect();
            let found = extrapolate(&values, formal);
            if values.len() == others.len() + 1 && found.is_some_and(|f| f.uncertainty >= gap) {
                self.nearly_closed.insert(state.name.clone());
            }
        }
    }

    /// Whether the error of a quantity is unknown.
    pub(super) fn hides(&self, quantity: &Quantity) -> bool {
        let Some(state) = &quantity.state else {
            return self.at_yield;
        };
        if OF_CONTACT.contains(&quantity.kind) && self.nearly_closed.contains(state) {
            return true;
        }
        let is_of_yield = self.in_yield_loads || self.yielding.contains(state);
        let is_local = !OF_THE_WHOLE.contains(&quantity.kind);
        self.at_yield && is_of_yield || is_local && self.states.contains(state)
    }

    /// The notes about what is unknown and why.
    pub(super) fn notes(&self) -> impl Iterator<Item = String> {
        self.note_on_edges()
            .into_iter()
            .chain(self.note_on_open_contacts())
    }

    fn note_on_open_contacts(&self) -> Option<String> {
        let states = self.nearly_closed.iter().map(|state| format!("`{state}`"));
        let states: Vec<String> = states.collect();
        (!states.is_empty()).then(|| {
            format!(
                "all contacts are open on all meshes ({}), by less than the uncertainty of their \
                 gaps: it is not known whether the surfaces touch, and no error of pressures \
                 and widths is stated",
                states.join(", ")
            )
        })
    }

    fn note_on_edges(&self) -> Option<String> {
        let at_yield = self.at_yield.then(|| "first yield".to_string());
        let of_states = self.states.iter().map(|state| format!("`{state}`"));
        let places: Vec<String> = at_yield.into_iter().chain(of_states).collect();
        (!places.is_empty()).then(|| {
            format!(
                "no more than {} pairs of nodes carry a side of the contact ({}): the mesh \
                 does not resolve it, and the errors of pressures and of the strains below them \
                 are unknown; make the elements there smaller{}",
                EdgeReading::AT_EDGE,
                places.join(", "),
                self.in_words()
            )
        })
    }

    /// The refinement that would help, as a key of the scene.
    fn in_words(&self) -> String {
        let Some(LocalRefinement { at, radius, times }) = &self.refinement else {
            return String::new();
        };
        let [x, y, radius] = [at[0], at[1], *radius].map(|c| significant(c, 3));
        format!(
            ": `mesh.refine = [{{ at = [{x}, {y}], radius = {radius}, times = {times} }}]`, or \
             more times"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::quantities::quantities;
    use super::*;
    use crate::results::{PairState, State, Status, YieldPoint};

    /// Quantities with a hidden error, for a run whose contact has the given numbers of pairs on a
    /// side at first yield and in its state.
    fn hidden([at_yield, in_state]: [usize; 2], error: f64, unit: Unit) -> Vec<String> {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let mut scene = Scene::parse(text, "scene.toml").unwrap();
        scene.program.unit = unit;
        let half_width_reading = |pairs| EdgeReading { error, pairs };
        let mut results = Results {
            first_yield: Some(YieldPoint {
                alpha: 1.0,
                load: 5.0,
                max_pressure: 2.0,
                half_width: 0.1,
                half_width_reading: half_width_reading(at_yield),
                location: [0.0; 3],
                body: 0,
            }),
            states: vec![State {
                name: "pressed".into(),
                half_width: 0.1,
                half_width_reading: half_width_reading(in_state),
                ..State::default()
            }],
            ..Results::default()
        };
        results.sizes.contact_pairs = 9;
        let found = Unresolved::of(&scene, &results);
        let all = quantities(&results);
        let hidden = all.iter().filter(|quantity| found.hides(quantity));
        let hidden: Vec<String> = hidden.map(|quantity| quantity.path.clone()).collect();
        assert_eq!(hidden.is_empty(), found.notes().next().is_none());
        hidden
    }

    /// A state with a gap between its surfaces, under a load that is not the leading one, or none.
    fn apart(gap: f64, is_loaded: bool) -> Results {
        let pair = PairState {
            pair: 0,
            contact: 0,
            position: [0.0; 3],
            gap,
            force: 0.0,
            area: 1.0,
            pressure: 0.0,
            status: Status::Open,
        };
        let mut results = Results {
            states: vec![State {
                name: "pressed".into(),
                is_loaded,
                pairs: vec![pair],
                ..State::default()
            }],
            ..Results::default()
        };
        results.sizes.contact_pairs = 1;
        results
    }

    #[test]
    fn surfaces_that_may_touch_have_no_error() {
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        // The gaps of three meshes change by more or by less than their size; the last have no
        // load.
        for (gaps, is_loaded, expected) in [
            ([0.1, 0.3, 0.7], true, true),
            ([0.1, 0.1001, 0.1004], true, false),
            ([0.1, 0.3, 0.7], false, false),
        ] {
            let runs = gaps.map(|gap| apart(gap, is_loaded));
            let mut found = Unresolved::of(&scene, &runs[0]);
            let others = [(1.5, &runs[1]), (2.0, &runs[2])];
            found.find_nearly_closed(&runs[0], &others, 2.0);
            let all = quantities(&runs[0]);
            let pressure = all.iter().find(|q| q.kind == "max_pressure").unwrap();
            assert_eq!(found.hides(pressure), expected, "{gaps:?}");
            assert_eq!(found.notes().count(), usize::from(expected));
            let approach = all.iter().find(|q| q.kind == "approach").unwrap();
            assert!(!found.hides(approach));
        }
    }

    #[test]
    fn what_one_or_two_pairs_carry_has_no_error() {
        let all = |pairs| hidden(pairs, 0.01, Unit::Load);
        assert!(all([3, 3]).is_empty());
        // Contact that ends with its surfaces has no edge of pressures.
        assert!(hidden([1, 2], 0.0, Unit::Load).is_empty());
        let of_state = all([3, 2]);
        assert!(of_state.contains(&"states.pressed.max_pressure".to_string()));
        assert!(!of_state.contains(&"states.pressed.load".to_string()));
        assert!(!of_state.iter().any(|path| path.starts_with("yield.")));
        // One closed pair between open ones counts as no pair on either side of the middle.
        assert_eq!(all([0, 3]), all([1, 3]));
        let of_yield = all([1, 3]);
        assert!(of_yield.contains(&"yield.load".to_string()));
        assert!(of_yield.iter().all(|path| path.starts_with("yield.")));
        // If loads are in units of the load at first yield and the error of that load is unknown,
        // so is the error of the load of every state.
        let passed_on = hidden([1, 3], 0.01, Unit::Yield);
        assert!(passed_on.contains(&"states.pressed.load".to_string()));
    }
}
