//! The zone of a run, and the data from which it is chosen.

use super::zone_choice::{Choice, PREDICTED};
use crate::analysis::stress::recovery::{Recovery, Watched};
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::packed::Ascending;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// The current zone, and the data from which it is chosen.
pub(in crate::analysis) struct ZoneFit {
    pub(in crate::analysis) choice: Choice,
    /// Recovered stress over the zone; `None` until it is first needed.
    recovery: Option<Recovery>,
    /// Ratio of elastic von Mises stress to yield stress of each element at the last search for
    /// first yield; empty if the zone holds all elements that may yield.
    pub(in crate::analysis) ratios_before_yield: Vec<f64>,
    /// Ratio of elastic von Mises stress to yield stress of each element, found on a coarser mesh;
    /// `None` once the zone was fitted to it.
    pub(in crate::analysis) expected: Option<Vec<f64>>,
    /// Predicted spread of yielding, by which the zone follows the load.
    pub(in crate::analysis) spread: Option<Spread>,
}

/// The stress that a run on another mesh predicts.
pub(in crate::analysis) struct Expected {
    /// Ratio of elastic von Mises stress to yield stress of each element: the larger of the values
    /// at first yield and at the program's extreme loads.
    pub(in crate::analysis) ratios: Vec<f64>,
    /// Time at which the run on the other mesh began.
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

    /// Drops the stress recovered over the zone, because another zone is chosen.
    pub(in crate::analysis) fn forget_recovery(&mut self) {
        self.recovery = None;
    }

    /// The recovered stress over the zone, at the points that are `watched`; `None` if there is no
    /// zone.
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

/// The extent to which yielding will spread, from the elastic stress at the program's extreme
/// loads.
#[derive(Serialize, Deserialize)]
pub(in crate::analysis) struct Spread {
    /// Elements that may be predicted to yield.
    elements: Ascending,
    /// Ratio of elastic von Mises stress to yield stress of these elements at the largest load, no
    /// less than the value extrapolated from the stress at first yield.
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

    /// The ratios of all elements; zero for elements below the limit of prediction.
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
