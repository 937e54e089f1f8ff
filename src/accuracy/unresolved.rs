//! Contacts that a mesh does not resolve, and the figures whose error is therefore unknown.
//!
//! The pressures of the last two pairs at the edge of a contact are not those of points
//! ([`crate::results::EdgeReading`]). Where a side of a contact has no other pairs, no pressure is
//! known, and nor is the stress below it: meshes that agree there do so because all of them replace
//! the contact by the same few forces.

use super::quantities::Quantity;
use crate::results::{EdgeReading, Results};
use crate::scene::{Scene, Unit};
use std::collections::BTreeSet;

/// Pairs on a side of a contact up to which it is not resolved: those at its edge.
const AT_EDGE: usize = 2;
/// Figures of a state that the contact does not decide, but the equilibrium of the whole.
const OF_THE_WHOLE: [&str; 3] = ["load", "approach", "contact_force"];

/// Where the contact of a run is not resolved.
pub(super) struct Unresolved {
    /// Whether it is not at first yield.
    at_yield: bool,
    /// Whether load factors count in the load at first yield.
    in_yield_loads: bool,
    /// States that are reached at first yield.
    yielding: BTreeSet<String>,
    states: BTreeSet<String>,
}

fn is_unresolved(width: f64, reading: &EdgeReading) -> bool {
    (1..=AT_EDGE).contains(&reading.pairs) && reading.is_of_pressures(width)
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
        }
    }

    /// Whether the error of a quantity is unknown.
    pub(super) fn hides(&self, quantity: &Quantity) -> bool {
        let Some((state, _)) =
            (quantity.path.strip_prefix("states.")).and_then(|rest| rest.rsplit_once('.'))
        else {
            return self.at_yield;
        };
        let is_of_yield = self.in_yield_loads || self.yielding.contains(state);
        let is_local = !OF_THE_WHOLE.contains(&quantity.key());
        self.at_yield && is_of_yield || is_local && self.states.contains(state)
    }

    /// The note about what is unknown and why.
    pub(super) fn note(&self) -> Option<String> {
        let at_yield = self.at_yield.then(|| "first yield".to_string());
        let of_states = self.states.iter().map(|state| format!("`{state}`"));
        let places: Vec<String> = at_yield.into_iter().chain(of_states).collect();
        (!places.is_empty()).then(|| {
            format!(
                "no more than {AT_EDGE} pairs of nodes carry a side of the contact ({}): the mesh \
                 does not resolve it, and the errors of pressures and of the strains below them \
                 are unknown; make the elements there smaller",
                places.join(", ")
            )
        })
    }
}
