//! The zone of a run: fitted to the program's extreme loads, following the load, grown where it
//! must.

use super::program::Run;
use super::recovery::Recovery;
use super::zone_choice::{self, Choice};
use crate::error::Result;
use crate::scene::History;
use std::time::Instant;

/// Factor on the load from one stage of the zone to the next: what it saves in trailing solves
/// against what a stage costs, a copy of the zone's part of the factor.
const STAGE: f64 = 1.1;

/// How far yielding will spread, by the elastic stress at the program's extreme loads.
pub(super) struct Spread {
    /// Elastic von Mises stress over yield stress of each element at the largest load, and no less
    /// than what it is at first yield lets expect there.
    pub(super) ratios: Vec<f64>,
    /// The largest load factor.
    pub(super) highest: f64,
    /// Load factor up to which the zone at hand was chosen.
    pub(super) until: f64,
}

impl Run<'_, '_> {
    /// Chooses the zone for the program's extreme loads from the elastic stress there. What was
    /// factored as zone usually holds it; else this is the second factorisation, and the last.
    pub(super) fn fit_zone(&mut self) -> Result<()> {
        if self.choice.holds_all(self.model()) {
            return Ok(());
        }
        let Some(at_yield) = self.standing.yield_alpha else {
            // Nothing yields: the elastic path needs no zone at all.
            return Ok(());
        };
        let saved = (
            self.engine.at.clone(),
            self.engine.now.clone(),
            self.engine.tableau.open().to_vec(),
        );
        let mut ratios = vec![0.0f64; self.model().mesh.n_elements()];
        let extremes = self.extreme_factors(at_yield);
        for &alpha in &extremes {
            let point = self.engine.point(alpha);
            if self.engine.solve_contact_at(&point).is_err() {
                continue;
            }
            let u = self.engine.all_displacements()?;
            for (r, new) in ratios.iter_mut().zip(zone_choice::stress_ratios(
                self.model(),
                &u,
                &self.engine.at.factors,
            )) {
                *r = r.max(new);
            }
        }
        self.engine.tableau.reset(&saved.2);
        (self.engine.at, self.engine.now, self.engine.fresh) = (saved.0, saved.1, true);
        self.set_zone(zone_choice::predict(self.model(), &ratios))?;
        let model = self.model();
        let proportional = |l: &crate::model::LoadCase| matches!(l.history, History::Proportional);
        if model.loads.iter().all(proportional) && model.pairs.iter().all(|p| p.interference == 0.0)
        {
            let highest = extremes.iter().fold(0.0f64, |m, a| m.max(a.abs()));
            // Under a contact that has grown far beyond it, the place of first yield has less
            // stress than the law gives it: near a surface von Mises stress falls as pressure evens
            // out.
            let growth = 1.0 / zone_choice::decline(model, at_yield.abs() / highest);
            for (ratio, before) in ratios.iter_mut().zip(&self.ratios_before_yield) {
                *ratio = ratio.max(before * growth);
            }
            self.spread = Some(Spread {
                ratios,
                highest,
                until: 0.0,
            });
        }
        Ok(())
    }

    /// Lets the zone follow the load: while it is far below the program's largest, so is the zone.
    pub(super) fn follow_load(&mut self) -> Result<()> {
        let reached = self.engine.at.alpha.abs();
        let Some(spread) = self.spread.as_mut().filter(|s| reached >= s.until) else {
            return Ok(());
        };
        let nothing = Choice::default();
        let old = if spread.until == 0.0 {
            &nothing
        } else {
            &self.choice
        };
        spread.until = STAGE * reached;
        if spread.until >= spread.highest {
            spread.until = f64::INFINITY;
        }
        let share = (spread.until / spread.highest).min(1.0);
        let next = zone_choice::stage(self.engine.model, &spread.ratios, share, old);
        self.set_zone(next)
    }

    /// Load factors between which the program moves, and those on the way at which a load turns; a
    /// target half width of m times that at yield stands for m^2.
    fn extreme_factors(&self, at_yield: f64) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::new();
        for target in &self.model().scene.program.targets {
            all.extend(target.load_factor);
            all.extend(target.half_width.map(|m| m * m * at_yield));
        }
        let high = all.iter().copied().fold(at_yield, f64::max);
        let low = all.iter().copied().fold(0.0, f64::min);
        let mut extremes = vec![high];
        extremes.extend((low < 0.0).then_some(low));
        let kinks = self.model().loads.iter().flat_map(|load| load.kinks());
        extremes.extend(kinks.filter(|k| (at_yield..high).contains(k) || (low..0.0).contains(k)));
        extremes
    }

    /// Goes on with another zone; state and history are kept.
    pub(super) fn set_zone(&mut self, choice: Choice) -> Result<()> {
        if choice == self.choice {
            return Ok(());
        }
        let start = Instant::now();
        self.recovery = None;
        self.engine
            .set_zone(choice.elements.clone(), &choice.guard)?;
        self.choice = choice;
        self.standing.seconds.condensation += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Recovered stress over the zone at hand, if there is one.
    pub(super) fn recovery(&mut self) -> Option<&mut Recovery> {
        if self.choice.elements.is_empty() {
            return None;
        }
        let (model, choice, places) = (self.engine.model, &self.choice, &self.engine.places);
        Some(
            self.recovery
                .get_or_insert_with(|| Recovery::new(model, &choice.elements, places)),
        )
    }
}
