//! The zone of a run: fitted to the program's extreme loads, following the load, and enlarged when
//! it proves too small.

use super::run::Run;
use super::stopwatch::TimeRow;
use crate::analysis::choice::zone_choice::{self, Choice};
use crate::analysis::choice::zone_fit::Spread;
use crate::analysis::increments::step::crosses;
use crate::error::Result;
use crate::scene::History;

/// Factor on the load from one stage of the zone to the next. It balances the savings in trailing
/// solves against the cost of a stage, which is a copy of the zone's part of the factor.
const STAGE: f64 = 1.1;

impl Run<'_, '_> {
    /// Chooses the zone for the program's extreme loads from the elastic stress at these loads. The
    /// elements factored as zone usually include it; otherwise this is the second factorisation,
    /// and the last.
    pub(super) fn fit_zone(&mut self) -> Result<()> {
        if self.zone.choice.holds_all(self.model()) {
            return Ok(());
        }
        let Some(at_yield) = self.position.first_yield.alpha else {
            // Nothing yields: the elastic path needs no zone.
            return Ok(());
        };
        let extremes = self.extreme_factors(at_yield);
        let mut ratios = match self.zone.expected.take() {
            Some(ratios) => ratios,
            None => self.elastic_ratios(&extremes)?,
        };
        self.set_zone(zone_choice::predict(self.model(), &ratios))?;
        let model = self.model();
        let proportional = |l: &crate::model::LoadCase| {
            !l.acts() || (matches!(l.history, History::Proportional) && l.opens.is_empty())
        };
        if model.loads.iter().all(proportional) && model.pairs.iter().all(|p| p.interference == 0.0)
        {
            let highest = extremes.iter().fold(0.0f64, |m, a| m.max(a.abs()));
            // The place of first yield has less stress than this law predicts if the contact has
            // grown far beyond it: near a surface, von Mises stress falls as pressure evens out.
            let growth = 1.0 / zone_choice::decline(model, at_yield.abs() / highest);
            for (ratio, before) in ratios.iter_mut().zip(&self.zone.ratios_before_yield) {
                *ratio = ratio.max(before * growth);
            }
            self.zone.spread = Some(Spread::new(&ratios, highest));
        }
        Ok(())
    }

    /// Ratio of elastic von Mises stress to yield stress of each element: the larger of the values
    /// at first yield and at the program's extreme loads. `None` if nothing yields.
    pub(super) fn ratios_at_extremes(&mut self) -> Result<Option<Vec<f64>>> {
        let Some(at_yield) = self.position.first_yield.alpha else {
            return Ok(None);
        };
        let mut factors = self.extreme_factors(at_yield);
        factors.push(at_yield);
        self.elastic_ratios(&factors).map(Some)
    }

    /// Ratio of elastic von Mises stress to yield stress of each element, the largest over the
    /// given load factors.
    pub(super) fn elastic_ratios(&mut self, factors: &[f64]) -> Result<Vec<f64>> {
        let before = self.solver.state();
        let mut ratios = vec![0.0f64; self.model().mesh.n_elements()];
        for &alpha in factors {
            let point = self.solver.structure.point(alpha);
            if self.solver.solve_contact_at(&point).is_err() {
                continue;
            }
            let u = self.solver.all_displacements()?;
            let factors = &self.solver.at.factors;
            let here = zone_choice::stress_ratios(self.model(), &u, factors);
            for (ratio, here) in ratios.iter_mut().zip(here) {
                *ratio = ratio.max(here);
            }
        }
        self.solver.restore_elastic(&before);
        Ok(ratios)
    }

    /// Lets the zone follow the load: as long as the load is far below the program's largest load,
    /// the zone is small. Returns whether the monitored quantity vanished by the change of the
    /// zone.
    pub(super) fn follow_load(&mut self) -> Result<bool> {
        let (reached, until) = (self.solver.at.alpha.abs(), self.position.zone_until);
        let Some(spread) = self.zone.spread.as_ref().filter(|_| reached >= until) else {
            return Ok(false);
        };
        let nothing = Choice::default();
        let old = if until == 0.0 {
            &nothing
        } else {
            &self.zone.choice
        };
        let until = STAGE * reached;
        let share = (until / spread.highest).min(1.0);
        self.position.zone_until = if until >= spread.highest {
            f64::INFINITY
        } else {
            until
        };
        let model = self.solver.structure.model;
        let ratios = spread.ratios(model.mesh.n_elements());
        let next = zone_choice::stage(model, &ratios, share, old);
        self.change_zone(next)
    }

    /// Changes the zone in the middle of a drive. The state is brought into equilibrium again,
    /// within the tolerance, and this may be all that was missing: returns whether the monitored
    /// quantity vanished.
    pub(super) fn change_zone(&mut self, choice: Choice) -> Result<bool> {
        let measure = |run: &mut Self| match &run.monitor {
            Some(monitor) => monitor(&mut run.solver).map(Some),
            None => Ok(None),
        };
        if choice == self.zone.choice {
            return Ok(false);
        }
        let was = measure(self)?;
        self.set_zone(choice)?;
        let is = measure(self)?;
        Ok(was.zip(is).is_some_and(|(was, is)| crosses(was, is)))
    }

    /// The largest and smallest load factor of the program, and the factors in between at which a
    /// load has a kink. A target half width of m times that at yield counts as m^2 times the yield
    /// load.
    fn extreme_factors(&self, at_yield: f64) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::new();
        for target in self.targets_of_leg() {
            all.extend(target.load_factor);
            all.extend(target.half_width.map(|m| m * m * at_yield));
        }
        let high = all.iter().copied().fold(at_yield, f64::max);
        let low = all.iter().copied().fold(0.0, f64::min);
        let mut extremes = vec![high];
        extremes.extend((low < 0.0).then_some(low));
        let kinks = self.model().kinks();
        extremes.extend(kinks.filter(|k| (at_yield..high).contains(k) || (low..0.0).contains(k)));
        extremes
    }

    /// Changes the zone; state and history are kept.
    pub(super) fn set_zone(&mut self, choice: Choice) -> Result<()> {
        if choice == self.zone.choice {
            return Ok(());
        }
        self.zone.forget_recovery();
        self.timed(TimeRow::Condensation, |run| {
            let elements = choice.elements.clone();
            run.solver.set_zone(elements, &choice.guard)
        })?;
        self.zone.choice = choice;
        Ok(())
    }
}
