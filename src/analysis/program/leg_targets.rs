//! The targets of a leg of the program.

use crate::model::{Model, ProgramTarget, TargetCondition};

/// The targets of the program, and the number of targets up to the end of the model's leg.
pub(super) struct LegTargets<'m> {
    model: &'m Model,
    /// Number of targets of the program up to the end of the leg.
    pub(super) end: usize,
}

impl<'m> LegTargets<'m> {
    pub(super) fn of(model: &'m Model) -> Self {
        LegTargets {
            model,
            end: model.targets_up_to_end_of_leg(),
        }
    }

    /// Number of targets of the whole program.
    pub(super) fn n_of_program(&self) -> usize {
        self.model.program.targets.len()
    }

    pub(super) fn target(&self, index: usize) -> &'m ProgramTarget {
        &self.model.program.targets[index]
    }

    /// The program's targets up to the end of the leg.
    fn up_to_end(&self) -> &'m [ProgramTarget] {
        &self.model.program.targets[..self.end]
    }

    /// Load factors from target `first` on, to the end of the leg.
    pub(super) fn factors_from(&self, first: usize) -> impl Iterator<Item = f64> + Clone + 'm {
        let ahead = &self.up_to_end()[first..];
        ahead.iter().filter_map(ProgramTarget::load_factor)
    }

    /// The largest absolute load factor among the targets up to the end of the leg; `None` if no
    /// target states a load factor.
    pub(super) fn largest_factor(&self) -> Option<f64> {
        self.factors_from(0).map(f64::abs).reduce(f64::max)
    }

    /// The largest load factor up to the end of the leg, the smallest if it is negative, and the
    /// factors in between at which a load has a kink. A target half width of m times that at yield
    /// counts as m^2 times the yield load.
    pub(super) fn extreme_factors(&self, at_yield: f64) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::new();
        for target in self.up_to_end() {
            match target.condition {
                TargetCondition::LoadFactor(alpha) => all.push(alpha),
                TargetCondition::HalfWidth(m) => all.push(m * m * at_yield),
                _ => {}
            }
        }
        let high = all.iter().copied().fold(at_yield, f64::max);
        let low = all.iter().copied().fold(0.0, f64::min);
        let mut extremes = vec![high];
        extremes.extend((low < 0.0).then_some(low));
        let kinks = self.model.kinks();
        extremes.extend(kinks.filter(|k| (at_yield..high).contains(k) || (low..0.0).contains(k)));
        extremes
    }
}
