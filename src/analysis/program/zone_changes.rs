//! The zone of a run: fitted to the program's extreme loads, and following the load.

use super::leg_targets::LegTargets;
use crate::analysis::choice::zone_choice::{self, Choice};
use crate::analysis::choice::zone_fit::{Spread, ZoneFit};
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use crate::model::{LoadCase, Model};
use crate::scene::History;

/// Factor on the load from one stage of the zone to the next. It balances the savings in trailing
/// solves against the cost of a stage, which is a copy of the zone's part of the factor.
const STAGE: f64 = 1.1;

impl ZoneFit {
    /// The zone for the program's extreme loads, from the elastic stress at these loads. The
    /// elements factored as zone usually include it; otherwise this is the second factorisation,
    /// and the last. `None` if the zone holds all elements that may yield.
    pub(super) fn for_program(
        &mut self,
        solver: &mut Solver,
        targets: &LegTargets,
        at_yield: f64,
    ) -> Result<Option<Choice>> {
        let model = solver.structure.model;
        if self.choice.holds_all(model) {
            return Ok(None);
        }
        let extremes = targets.extreme_factors(at_yield);
        let mut ratios = match self.expected.take() {
            Some(ratios) => ratios,
            None => elastic_ratios(solver, &extremes)?,
        };
        let choice = zone_choice::predict(model, &ratios);
        if is_proportional(model) {
            let highest = extremes.iter().fold(0.0f64, |m, a| m.max(a.abs()));
            // Stress at the place of first yield is extrapolated in proportion to contact pressure.
            // If the contact has grown far beyond this place, the elastic stress there is less:
            // near a surface, von Mises stress falls as pressure evens out. The larger of the two
            // values is kept.
            let growth = 1.0 / zone_choice::decline(model, at_yield.abs() / highest);
            for (ratio, before) in ratios.iter_mut().zip(&self.ratios_before_yield) {
                *ratio = ratio.max(before * growth);
            }
            self.spread = Some(Spread::new(&ratios, highest));
        }
        Ok(Some(choice))
    }

    /// The zone for a later leg of the program: enlarged by the elements in which elastic stress at
    /// the leg's targets, from target `first` on, is beyond yield. `None` if there are none.
    pub(super) fn for_leg(
        &self,
        solver: &mut Solver,
        targets: &LegTargets,
        first: usize,
    ) -> Result<Option<Choice>> {
        let model = solver.structure.model;
        if self.choice.holds_all(model) {
            return Ok(None);
        }
        let from = solver.at.alpha;
        let factors = targets.factors_from(first);
        let kinks = model.kinks().filter(|kink| *kink > from);
        let last = factors.clone().fold(from, f64::max);
        let factors: Vec<f64> = factors.chain(kinks.filter(|kink| *kink < last)).collect();
        let ratios = elastic_ratios(solver, &factors)?;
        let predicted = zone_choice::predict(model, &ratios);
        let known = |e: &usize| self.choice.elements.binary_search(e).is_ok();
        let is_enough = predicted.elements.iter().all(known);
        Ok((!is_enough).then(|| zone_choice::joined(model, [&predicted, &self.choice])))
    }

    /// The zone that follows the load: it stays small as long as the load is far below the
    /// program's largest load. `None` if there is no predicted spread of yielding, or if the load
    /// factor is below `until`, up to which the zone was chosen; otherwise `until` is raised.
    pub(super) fn for_load(&self, solver: &Solver, until: &mut f64) -> Option<Choice> {
        let (reached, before) = (solver.at.alpha.abs(), *until);
        let spread = self.spread.as_ref().filter(|_| reached >= before)?;
        let nothing = Choice::default();
        let old = if before == 0.0 {
            &nothing
        } else {
            &self.choice
        };
        let next = STAGE * reached;
        let share = (next / spread.highest).min(1.0);
        *until = if next >= spread.highest {
            f64::INFINITY
        } else {
            next
        };
        let model = solver.structure.model;
        let ratios = spread.ratios(model.mesh.n_elements());
        Some(zone_choice::stage(model, &ratios, share, old))
    }
}

/// Whether all that acts on a model grows in proportion to the load factor.
fn is_proportional(model: &Model) -> bool {
    let proportional = |l: &LoadCase| {
        !l.acts() || (matches!(l.history, History::Proportional) && l.opens.is_empty())
    };
    model.loads.iter().all(proportional) && model.pairs.iter().all(|p| p.interference == 0.0)
}

/// Ratio of elastic von Mises stress to yield stress of each element, the largest over the given
/// load factors.
pub(super) fn elastic_ratios(solver: &mut Solver, factors: &[f64]) -> Result<Vec<f64>> {
    let model = solver.structure.model;
    let before = solver.state();
    let mut ratios = vec![0.0f64; model.mesh.n_elements()];
    for &alpha in factors {
        let point = solver.structure.point(alpha);
        if solver.solve_contact_at(&point).is_err() {
            continue;
        }
        let u = solver.all_displacements()?;
        let here = zone_choice::stress_ratios(model, &u, &solver.at.factors);
        for (ratio, here) in ratios.iter_mut().zip(here) {
            *ratio = ratio.max(here);
        }
    }
    solver.restore_elastic(&before);
    Ok(ratios)
}
