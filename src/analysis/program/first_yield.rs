//! First yield of the program: its load and place, and a check that the zone did not miss it.

use super::position::Purpose;
use super::run::{DOUBLINGS, Run, ZONE_ATTEMPTS};
use crate::analysis::choice::zone_choice::{self, Choice};
use crate::analysis::increments::elastic::ElasticDrive;
use crate::analysis::increments::step::{Arrival, stopped};
use crate::analysis::increments::yield_load::{peak_here, secant_yield_load};
use crate::analysis::stress::recovery::RecoveredPeak;
use crate::analysis::structure::state::State;
use crate::error::{Error, Result};
use crate::results::YieldPoint;
use crate::scene::{Unit, YieldMethod};

/// Result of a search for first yield.
pub(super) enum YieldSearch {
    /// First yield at this load factor.
    Found(f64, RecoveredPeak),
    /// Nothing yields up to the program's largest load factor.
    Nothing,
    /// Yielding begins outside the zone that was searched; the choice holds the place.
    Outside(Choice),
}

impl Run<'_, '_> {
    /// Finds the yield load on the path of growing load factor and returns to the start. Returns
    /// true if the material yields under the preload already, which was passed as if elastic.
    pub(super) fn find_yield(&mut self, required: bool) -> Result<bool> {
        let unit_is_yield = self.model().scene.program.unit == Unit::Yield;
        if self.position.first_yield.is_behind {
            return if unit_is_yield {
                Err(Error::analysis(
                    "`unit = \"yield\"`: the preload alone makes the material yield, so there is \
                     no yield load to count in; use `unit = \"load\"`",
                ))
            } else {
                Ok(false)
            };
        }
        let origin = self.solver.state();
        for _ in 0..ZONE_ATTEMPTS {
            let found = match self.model().scene.analysis.yield_load {
                YieldMethod::Exact => self.exact_yield(required)?,
                YieldMethod::Secant if required => {
                    let recovery = self
                        .zone
                        .recovery(&self.solver, self.position.first_yield.watched);
                    let recovery = recovery.ok_or_else(|| Error::internal("no recovery"))?;
                    let (alpha, peak) = secant_yield_load(&mut self.solver, recovery)?;
                    YieldSearch::Found(alpha, peak)
                }
                YieldMethod::Secant => YieldSearch::Nothing,
            };
            if let YieldSearch::Found(alpha, _) = found
                && alpha == origin.at.alpha
            {
                return Ok(true);
            }
            let (found, missed) = match found {
                YieldSearch::Found(alpha, peak) => (Some((alpha, peak)), self.missed_outside()?),
                YieldSearch::Nothing => (None, None),
                YieldSearch::Outside(choice) => (None, Some(choice)),
            };
            if missed.is_none() {
                if let Some((alpha, peak)) = found {
                    self.record_yield(peak);
                    if self.purpose == Purpose::YieldLoad {
                        self.at_yield = Some(self.solver.reading().quality_here()?);
                    }
                    let unit = if unit_is_yield { 1.0 } else { alpha };
                    self.position.first_yield.alpha = Some(unit);
                    if unit_is_yield {
                        self.solver.structure.unit = alpha;
                    }
                }
                let exact = self.model().scene.analysis.yield_load == YieldMethod::Exact;
                let searched = self.largest_factor().filter(|_| exact);
                let first_yield = &mut self.position.first_yield;
                first_yield.elastic_range[1] = first_yield.alpha.or(searched).unwrap_or(0.0);
            }
            self.come_back(&origin);
            match missed {
                None => return Ok(false),
                Some(choice) => self.set_zone(choice)?,
            }
        }
        Err(Error::analysis(
            "no yield load: the place of first yield keeps moving out of the zone that was \
             searched",
        ))
    }

    /// Restores an elastic state, even after the zone was changed.
    fn come_back(&mut self, origin: &State) {
        let solver = &mut self.solver;
        solver.restore_elastic(origin);
        // Without any loads the displacements are zero, and a body held by contact alone must not
        // be moved.
        solver.fresh = origin.equilibrium.u.largest() == 0.0;
        solver.now.u.fill(0.0);
        solver.refresh();
        self.position.first_yield.is_behind = false;
    }

    /// Searches for first yield along the path of growing load factor, up to the program's largest
    /// factor unless yield is required. At the end of each straight piece, where the stresses of a
    /// load that turns back are largest, the stresses outside the zone are checked, too.
    fn exact_yield(&mut self, required: bool) -> Result<YieldSearch> {
        let limit = if required {
            None
        } else {
            self.largest_factor()
        };
        let mut end = match limit {
            Some(largest) => largest,
            None => self.first_load_estimate()?,
        };
        for _ in 0..DOUBLINGS {
            for stop in self.stops(end) {
                let point = self.solver.structure.point(stop);
                let recovery = self
                    .zone
                    .recovery(&self.solver, self.position.first_yield.watched);
                if let Arrival::Yield(peak) = ElasticDrive::go(&mut self.solver, &point, recovery)?
                {
                    return Ok(YieldSearch::Found(self.solver.at.alpha, peak));
                }
                if let Some(choice) = self.missed_outside()? {
                    return Ok(YieldSearch::Outside(choice));
                }
            }
            if limit.is_some() {
                return Ok(YieldSearch::Nothing);
            }
            end *= 2.0;
            if self.observer.stop_requested() {
                return Err(stopped());
            }
        }
        Err(Error::analysis(format!(
            "no yield load: the stress stays below yield up to load factor {end:.3e}; do the \
             proportional loads press the bodies?"
        )))
    }

    /// Estimates a load factor of the order of the yield load, from one contact solve at factor 1.
    pub(super) fn first_load_estimate(&mut self) -> Result<f64> {
        let before = self.solver.state();
        let point = self.solver.structure.point(1.0);
        let solved = self.solver.solve_contact_at(&point);
        let recovery = self
            .zone
            .recovery(&self.solver, self.position.first_yield.watched);
        let estimate = match (solved, recovery) {
            (Ok(()), Some(recovery)) => peak_here(&mut self.solver, recovery).map(|p| p.ratio),
            _ => None,
        };
        self.solver.restore_elastic(&before);
        // Stress grows at least like the cube root of the load (point contact). The estimate aims
        // beyond yield; doubling continues from there.
        Ok(estimate
            .filter(|r| r.is_finite() && *r > 0.0)
            .map_or(1.0, |r| 1.2 / r.min(r * r)))
    }

    /// Records that the material yields in the current state.
    pub(super) fn record_yield(&mut self, peak: RecoveredPeak) {
        let figures = self.solver.contact_figures();
        self.position.first_yield.is_behind = true;
        self.position.first_yield.point.get_or_insert(YieldPoint {
            alpha: self.solver.at.alpha,
            load: self.solver.total_load_size(),
            max_pressure: figures.max_pressure,
            half_width: figures.half_width,
            half_width_reading: figures.half_width_reading,
            location: peak.location,
            body: peak.body,
        });
    }

    /// Checks, up to first yield, whether any element outside the zone is beyond yield. If so, the
    /// zone missed the place, and a better choice is returned.
    fn missed_outside(&mut self) -> Result<Option<Choice>> {
        if self.zone.choice.holds_all(self.model()) {
            return Ok(None);
        }
        let u = self.solver.all_displacements()?;
        let ratios = zone_choice::stress_ratios(self.model(), &u, &self.solver.at.factors);
        let outside = (0..ratios.len())
            .filter(|e| self.zone.choice.elements.binary_search(e).is_err())
            .map(|e| ratios[e])
            .fold(0.0, f64::max);
        let missed = (outside > 1.0).then(|| zone_choice::predict(self.model(), &ratios));
        self.zone.ratios_before_yield = ratios;
        Ok(missed)
    }
}
