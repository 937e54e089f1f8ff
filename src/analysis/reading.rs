//! What is read off the current state beside contact pressures: approach, dent, quality.

use super::solver::Solver;
use super::stress_field::StressField;
use crate::model::{AxisPoint, LoadCase, Magnitude};
use std::collections::BTreeMap;

/// Reads figures off the current state of a structure.
pub(super) struct Reading<'s, 'm> {
    pub(super) solver: &'s mut Solver<'m>,
}

impl<'m> Solver<'m> {
    /// The current state as it is read.
    pub(super) fn reading(&mut self) -> Reading<'_, 'm> {
        Reading { solver: self }
    }
}

impl Reading<'_, '_> {
    /// Stresses that follow from displacements of the whole model.
    pub(super) fn stress_field(&self, u: &[f64]) -> StressField<'_> {
        let (solver, structure) = (&self.solver, &self.solver.structure);
        let nodal = structure.model.nodal(u, &solver.at.factors);
        StressField::new(structure.model, &solver.zone, &structure.elements, nodal)
    }

    /// Distance of the two nodes of a point on the axis, for displacements of the whole model.
    pub fn distance_on_axis(&self, axis: &AxisPoint, u: &[f64]) -> f64 {
        let (freedoms, at) = (&self.solver.structure.model.freedoms, &self.solver.at);
        let of = |node| freedoms.displacement(node, u, &at.factors);
        let (first, second) = (of(axis.first), of(axis.node));
        let opened = [first[0] - second[0], first[1] - second[1]];
        axis.gap - at.interference * axis.interference
            + opened[0] * axis.normal[0]
            + opened[1] * axis.normal[1]
    }

    /// How far the loads that vary have brought the bodies together
    /// ([`crate::results::State::approach`]), for displacements of the whole model.
    pub fn approach(&self, u: &[f64]) -> f64 {
        let (structure, factors) = (&self.solver.structure, &self.solver.at.factors);
        let (loads, freedoms) = (&structure.model.loads, &structure.model.freedoms);
        let driven = |l: &&LoadCase| l.driven(structure.unit) > 0.0;
        let mut driving: Vec<&LoadCase> = loads.iter().filter(driven).collect();
        if driving.is_empty() {
            driving = loads.iter().collect();
        }
        let prescribed = driving
            .iter()
            .any(|l| l.measures == Magnitude::Displacement);
        if prescribed {
            driving.retain(|l| l.measures == Magnitude::Displacement);
        }
        // Sizes and, times these, displacements of the loads on each body.
        let mut of_body: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        for load in driving {
            let size = Some(load.driven(structure.unit))
                .filter(|s| *s > 0.0)
                .unwrap_or(1.0);
            let along = load.nodes.iter().zip(&load.shares).map(|(&node, share)| {
                let d = freedoms.displacement(node, u, factors);
                share * (d[0] * load.direction[0] + d[1] * load.direction[1])
            });
            let sums = of_body.entry(load.body).or_default();
            sums[0] += size;
            sums[1] += size * along.sum::<f64>();
        }
        if prescribed {
            return of_body.values().map(|[size, work]| work / size).sum();
        }
        let largest = of_body.values().fold(0.0f64, |m, [size, _]| m.max(*size));
        let work: f64 = of_body.values().map(|[_, work]| work).sum();
        if largest > 0.0 { work / largest } else { 0.0 }
    }
}
