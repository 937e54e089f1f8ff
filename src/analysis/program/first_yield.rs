//! First yield of the program: its load and place, and a check that the zone did not miss it.

use super::position::{DOUBLINGS, Purpose};
use super::run::{Run, ZONE_ATTEMPTS};
use crate::analysis::choice::zone_choice::{self, Choice};
use crate::analysis::choice::zone_fit::ZoneFit;
use crate::analysis::figures::reading::Reading;
use crate::analysis::increments::elastic::ElasticDrive;
use crate::analysis::increments::step::{Arrival, stopped};
use crate::analysis::increments::yield_load::{peak_here, secant_yield_load};
use crate::analysis::stress::recovery::{RecoveredPeak, Watched};
use crate::analysis::structure::solver::Solver;
use crate::analysis::structure::state::State;
use crate::error::{Error, Result};
use crate::scene::{Unit, YieldMethod};

/// Where a search for first yield ended.
enum SearchEnd {
    /// First yield at this load factor.
    Yield(f64, RecoveredPeak),
    /// Nothing yields up to the program's largest load factor.
    Nothing,
    /// Yielding begins outside the zone that was searched; the choice is a zone that includes the
    /// place.
    Outside(Choice),
}

/// The search for the yield load on the path of growing load factor.
pub(super) struct YieldSearch<'r, 'm, 'o> {
    pub(super) run: &'r mut Run<'m, 'o>,
    /// Whether the search goes on beyond the program's largest load factor.
    pub(super) required: bool,
}

impl YieldSearch<'_, '_, '_> {
    /// Finds the yield load and returns to the start. Returns true if the material yields under the
    /// preload already, which was passed as if elastic.
    pub(super) fn find(mut self) -> Result<bool> {
        if self.run.position.first_yield.is_behind {
            return match self.run.model().program.unit {
                Unit::Yield => Err(Error::analysis(
                    "`unit = \"yield\"`: the preload alone makes the material yield, so there is \
                     no yield load to count in; use `unit = \"load\"`",
                )),
                Unit::Load => Ok(false),
            };
        }
        let origin = self.run.solver.state();
        for _ in 0..ZONE_ATTEMPTS {
            let (found, missed) = match self.go()? {
                SearchEnd::Yield(alpha, _) if alpha == origin.at.alpha => return Ok(true),
                SearchEnd::Yield(alpha, peak) => (Some((alpha, peak)), self.missed_outside()?),
                SearchEnd::Nothing => (None, None),
                SearchEnd::Outside(choice) => (None, Some(choice)),
            };
            if missed.is_none() {
                self.record(found)?;
            }
            self.come_back(&origin);
            match missed {
                None => return Ok(false),
                Some(choice) => self.run.set_zone(choice)?,
            }
        }
        Err(Error::analysis(
            "no yield load: the place of first yield keeps moving out of the zone that was \
             searched",
        ))
    }

    /// Searches from the present state on, by the method of the settings.
    fn go(&mut self) -> Result<SearchEnd> {
        match self.run.model().settings.yield_load {
            YieldMethod::Exact => self.exact(),
            YieldMethod::Secant if self.required => {
                let Run {
                    solver,
                    zone,
                    position,
                    ..
                } = &mut *self.run;
                let recovery = zone.recovery(solver, position.first_yield.watched);
                let recovery = recovery.ok_or_else(|| Error::internal("no recovery"))?;
                let (alpha, peak) = secant_yield_load(solver, recovery)?;
                Ok(SearchEnd::Yield(alpha, peak))
            }
            YieldMethod::Secant => Ok(SearchEnd::Nothing),
        }
    }

    /// Takes over what the search found: first yield, or the range in which nothing yields.
    fn record(&mut self, found: Option<(f64, RecoveredPeak)>) -> Result<()> {
        let model = self.run.model();
        if let Some((alpha, peak)) = found {
            let Run {
                solver, position, ..
            } = &mut *self.run;
            position.first_yield.record(solver, peak);
            if self.run.purpose == Purpose::YieldLoad {
                self.run.at_yield = Some(Reading::of(&mut self.run.solver).quality_here()?);
            }
            let unit_is_yield = model.program.unit == Unit::Yield;
            let unit = if unit_is_yield { 1.0 } else { alpha };
            self.run.position.first_yield.alpha = Some(unit);
            if unit_is_yield {
                self.run.solver.structure.unit = alpha;
            }
        }
        let exact = model.settings.yield_load == YieldMethod::Exact;
        let searched = self.run.targets.largest_factor().filter(|_| exact);
        let first_yield = &mut self.run.position.first_yield;
        first_yield.elastic_range[1] = first_yield.alpha.or(searched).unwrap_or(0.0);
        Ok(())
    }

    /// Restores an elastic state, even after the zone was changed.
    fn come_back(&mut self, origin: &State) {
        let solver = &mut self.run.solver;
        solver.restore_elastic(origin);
        // Without any loads the displacements are zero, and a body held by contact alone must not
        // be moved.
        solver.fresh = origin.equilibrium.u.largest() == 0.0;
        solver.now.u.fill(0.0);
        solver.refresh();
        self.run.position.first_yield.is_behind = false;
    }

    /// Searches for first yield along the path of growing load factor, up to the program's largest
    /// factor unless yield is required. At the end of each straight piece, where the stresses of a
    /// load that turns back are largest, the stresses outside the zone are checked, too.
    fn exact(&mut self) -> Result<SearchEnd> {
        let watched = self.run.position.first_yield.watched;
        let limit = if self.required {
            None
        } else {
            self.run.targets.largest_factor()
        };
        let mut end = match limit {
            Some(largest) => largest,
            None => first_load_estimate(&mut self.run.zone, &mut self.run.solver, watched)?,
        };
        for _ in 0..DOUBLINGS {
            for stop in self.run.stops(end) {
                let Run { solver, zone, .. } = &mut *self.run;
                let point = solver.structure.point(stop);
                let recovery = zone.recovery(solver, watched);
                if let Arrival::Yield(peak) = ElasticDrive::go(solver, &point, recovery)? {
                    return Ok(SearchEnd::Yield(solver.at.alpha, peak));
                }
                if let Some(choice) = self.missed_outside()? {
                    return Ok(SearchEnd::Outside(choice));
                }
            }
            if limit.is_some() {
                return Ok(SearchEnd::Nothing);
            }
            end *= 2.0;
            if self.run.observer.stop_requested() {
                return Err(stopped());
            }
        }
        Err(Error::analysis(format!(
            "no yield load: the stress stays below yield up to load factor {end:.3e}; do the \
             proportional loads press the bodies?"
        )))
    }

    /// Checks, up to first yield, whether any element outside the zone is beyond yield. If so, the
    /// zone missed the place, and a better choice is returned.
    fn missed_outside(&mut self) -> Result<Option<Choice>> {
        let Run { solver, zone, .. } = &mut *self.run;
        let model = solver.structure.model;
        if zone.choice.holds_all(model) {
            return Ok(None);
        }
        let u = solver.all_displacements()?;
        let ratios = zone_choice::stress_ratios(model, &u, &solver.at.factors);
        let outside = (0..ratios.len())
            .filter(|e| zone.choice.elements.binary_search(e).is_err())
            .map(|e| ratios[e])
            .fold(0.0, f64::max);
        let missed = (outside > 1.0).then(|| zone_choice::predict(model, &ratios));
        zone.ratios_before_yield = ratios;
        Ok(missed)
    }
}

/// Estimates a load factor of the order of the yield load, from one contact solve at factor 1.
fn first_load_estimate(zone: &mut ZoneFit, solver: &mut Solver, watched: Watched) -> Result<f64> {
    let before = solver.state();
    let point = solver.structure.point(1.0);
    let solved = solver.solve_contact_at(&point);
    let recovery = zone.recovery(solver, watched);
    let estimate = match (solved, recovery) {
        (Ok(()), Some(recovery)) => peak_here(solver, recovery).map(|p| p.ratio),
        _ => None,
    };
    solver.restore_elastic(&before);
    // The stress grows with the load or, in line contact, with its square root, so that this load
    // lies beyond yield; in point contact (cube root) it may fall short and is then doubled.
    Ok(estimate
        .filter(|r| r.is_finite() && *r > 0.0)
        .map_or(1.0, |r| 1.2 / r.min(r * r)))
}
