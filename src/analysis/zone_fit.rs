//! The zone of a run: fitted to the program's extreme loads, grown and moved where it must.

use super::program::Run;
use super::recovery::Recovery;
use super::zone_choice::{self, Choice};
use crate::error::Result;
use std::time::Instant;

impl Run<'_, '_> {
    /// Chooses the zone for the program's extreme loads from the elastic stress there.
    pub(super) fn fit_zone(&mut self) -> Result<()> {
        if self.recovery.is_none()
            || self.choice.guard.iter().all(|g| !g) && !self.choice.elements.is_empty()
        {
            return Ok(());
        }
        let Some(_) = self.yield_alpha else {
            // Nothing yields: the elastic path needs no zone at all.
            return Ok(());
        };
        let saved = (
            self.engine.at.clone(),
            self.engine.now.clone(),
            self.engine.tableau.open().to_vec(),
        );
        let mut ratios = vec![0.0f64; self.model().mesh.n_elements()];
        for alpha in self.extreme_factors() {
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
        let wanted = zone_choice::predict(self.model(), &ratios);
        if std::env::var_os("ZDEBUG").is_some() { eprintln!("guess {} wanted {} covers {}", self.choice.elements.len(), wanted.elements.len(), self.choice.covers(&wanted)); }
        if wanted != self.choice {
            self.set_zone(wanted)?;
        }
        if std::env::var_os("ZDEBUG").is_some() { eprintln!("zone freedoms {} factorizations {}", self.engine.sub.partition.zone.len(), self.engine.counts.factorizations); }
        Ok(())
    }

    /// Load factors between which the program moves; a target half width of m times that at yield stands for m^2.
    pub(super) fn extreme_factors(&self) -> Vec<f64> {
        let at_yield = self.yield_alpha.unwrap_or(1.0);
        let mut all: Vec<f64> = Vec::new();
        for target in &self.model().scene.program.targets {
            all.extend(target.load_factor);
            all.extend(target.half_width.map(|m| m * m * at_yield));
        }
        let high = all.iter().copied().fold(at_yield, f64::max);
        let low = all.iter().copied().fold(0.0, f64::min);
        if low < 0.0 {
            vec![high, low]
        } else {
            vec![high]
        }
    }

    /// Goes on with another zone; state and history are kept.
    pub(super) fn set_zone(&mut self, choice: Choice) -> Result<()> {
        self.observer.phase("factorisation");
        let start = Instant::now();
        // The old one goes before the new one comes: memory.
        self.recovery = None;
        self.engine
            .set_zone(choice.elements.clone(), &choice.guard)?;
        self.recovery = Some(Recovery::new(
            self.model(),
            &choice.elements,
            &self.engine.places,
        ));
        self.choice = choice;
        self.seconds.condensation += start.elapsed().as_secs_f64();
        Ok(())
    }
}
