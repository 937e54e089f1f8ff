//! The zone of a run, and what it is chosen by.

use super::zone_choice::{Choice, PREDICTED};
use crate::analysis::stress::recovery::{Recovery, Watched};
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::packed::Ascending;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// The zone at hand, and what it is chosen by.
pub(in crate::analysis) struct ZoneFit {
    pub(in crate::analysis) choice: Choice,
    /// Recovered stress over the zone, once it was asked for.
    recovery: Option<Recovery>,
    /// Elastic von Mises stress over yield stress of each element where first yield was last looked
    /// for; empty where the zone holds all that may yield.
    pub(in crate::analysis) ratios_before_yield: Vec<f64>,
    /// Elastic von Mises stress over yield stress of each element by a coarser mesh, until the zone
    /// was fitted to it.
    pub(in crate::analysis) expected: Option<Vec<f64>>,
    /// What the zone follows the load by.
    pub(in crate::analysis) spread: Option<Spread>,
}

/// What a run on another mesh predicts of the stress.
pub(in crate::analysis) struct Expected {
    /// Elastic von Mises stress over yield stress of each element at first yield and at the
    /// program's extreme loads, the larger one.
    pub(in crate::analysis) ratios: Vec<f64>,
    /// When the search for it began.
    pub(in crate::analysis) since: Instant,
}

impl ZoneFit {
    pub(in crate::analysis) fn new(choice: Choice) -> Self {
        ZoneFit {
            choice,
            recovery: None,
            ratios_before_yield: Vec::new(),
            expected: None,
            spread: None,
        }
    }

    /// Forgets what was recovered over the zone: another is chosen.
    pub(in crate::analysis) fn forget_recovery(&mut self) {
        self.recovery = None;
    }

    /// The stress over the zone where it is watched, if there is a zone.
    pub(in crate::analysis) fn recovery(
        &mut self,
        solver: &Solver,
        watched: Watched,
    ) -> Option<&mut Recovery> {
        if self.choice.elements.is_empty() {
            return None;
        }
        let (elements, places) = (&self.choice.elements, &solver.structure.places);
        self.recovery
            .take_if(|recovery| recovery.watched() != watched);
        let recovery = &mut self.recovery;
        Some(recovery.get_or_insert_with(|| {
            Recovery::new(solver.structure.model, elements, places, watched)
        }))
    }
}

/// How far yielding will spread, by the elastic stress at the program's extreme loads.
#[derive(Serialize, Deserialize)]
pub(in crate::analysis) struct Spread {
    /// Elements that may be predicted to yield.
    elements: Ascending,
    /// Elastic von Mises stress of these elements over yield stress at the largest load, no less
    /// than the value that the stress at first yield predicts there.
    ratios: Vec<f64>,
    /// The largest load factor.
    pub(in crate::analysis) highest: f64,
}

impl Spread {
    pub(in crate::analysis) fn new(ratios: &[f64], highest: f64) -> Self {
        let hot = |e: &usize| ratios[*e] >= PREDICTED;
        let elements: Vec<usize> = (0..ratios.len()).filter(hot).collect();
        Spread {
            ratios: elements.iter().map(|&e| ratios[e]).collect(),
            elements: Ascending::new(elements),
            highest,
        }
    }

    /// The ratios of all elements: zero where they do not matter.
    pub(in crate::analysis) fn ratios(&self, n_elements: usize) -> Vec<f64> {
        let mut all = vec![0.0; n_elements];
        for (element, ratio) in self.elements.iter().zip(&self.ratios) {
            if let Some(place) = all.get_mut(element) {
                *place = *ratio;
            }
        }
        all
    }
}
