//! Figures read from the current state in addition to contact pressures: stresses, approach, dent,
//! quality.

use crate::analysis::stress::element_stresses::ElementStresses;
use crate::analysis::stress::piece::{self, Whole};
use crate::analysis::stress::stress_field::{Strained, StressField};
use crate::analysis::stress::stresses::Stresses;
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::elements::{Zone, of_zone};
use crate::error::Result;
use crate::model::{AxisPoint, LoadCase, Magnitude};
use crate::space::{along, difference, dot};
use std::collections::BTreeMap;

/// Reader of figures from the current state of a structure.
pub(in crate::analysis) struct Reading<'s, 'm> {
    pub(in crate::analysis) solver: &'s mut Solver<'m>,
}

impl<'s, 'm> Reading<'s, 'm> {
    pub(in crate::analysis) fn of(solver: &'s mut Solver<'m>) -> Self {
        Reading { solver }
    }

    /// Sums over the stresses of all elements, for displacements of the whole model. If ranks share
    /// the matrix, they share the elements too.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub(in crate::analysis) fn stresses(&self, u: &[f64], with_fields: bool) -> Result<Stresses> {
        let (solver, structure) = (&self.solver, &self.solver.structure);
        let (model, in_zone) = (structure.model, &*structure.elements);
        let factors = &solver.at.factors;
        let displacements = model.nodal(u, factors);
        let matrix = &structure.system.stiffness;
        let of_elements = if matrix.n_ranks() > 1 {
            let whole = Whole {
                model,
                displacements: &displacements,
                factors,
                in_zone,
                history: &solver.zone.history(),
                with_fields,
            };
            let ask = |message: &mut dyn FnMut(usize) -> Vec<u8>| {
                matrix.evaluate(message, piece::evaluate)
            };
            piece::element_stresses(&whole, matrix.n_ranks(), ask)?
        } else {
            let free = model.free_of_loads();
            let all: Vec<usize> = (0..model.mesh.n_elements()).collect();
            of_zone!(&solver.zone, zone => {
                let state = Strained {
                    displacements: &displacements,
                    factors,
                    free: &free,
                    in_zone,
                    history: zone.committed(),
                };
                let field = StressField::new(zone.kernel(), &model.continuum, state);
                ElementStresses::new(&field, &all, with_fields)
            })
        };
        let mut stresses = Stresses::new(model, of_elements, factors);
        of_zone!(&solver.zone, zone => stresses.add_yielded(model, zone, in_zone));
        Ok(stresses)
    }

    /// Distance between the bodies at a point on the axis, for displacements of the whole model.
    pub fn distance_on_axis(&self, axis: &AxisPoint, u: &[f64]) -> f64 {
        let (freedoms, at) = (&self.solver.structure.model.freedoms, &self.solver.at);
        let of = |node| freedoms.displacement(node, u, &at.factors);
        let pair = &axis.pair;
        let masters = pair.masters.iter();
        let faced = masters.fold([0.0; 3], |sum, &(node, weight)| {
            along(sum, weight, of(node))
        });
        let opened = dot(difference(faced, of(pair.slave)), pair.normal);
        self.solver.structure.gap_unmoved(pair, at) + opened
    }

    /// The approach of the bodies under the loads that vary ([`crate::results::State::approach`]),
    /// for displacements of the whole model.
    pub fn approach(&self, u: &[f64]) -> f64 {
        let (structure, factors) = (&self.solver.structure, &self.solver.at.factors);
        let (loads, freedoms) = (&structure.model.loads, &structure.model.freedoms);
        let driven = |l: &&LoadCase| l.driven(structure.unit) > 0.0;
        let mut driving: Vec<&LoadCase> = loads.iter().filter(driven).collect();
        if driving.is_empty() {
            driving = loads.iter().filter(|l| l.opens.is_empty()).collect();
        }
        let prescribed = driving
            .iter()
            .any(|l| l.measures == Magnitude::Displacement);
        if prescribed {
            driving.retain(|l| l.measures == Magnitude::Displacement);
        }
        // For each body: the sum of the sizes of its loads, and the sum of their displacements
        // times their sizes.
        let mut of_body: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        for load in driving {
            let size = Some(load.driven(structure.unit))
                .filter(|s| *s > 0.0)
                .unwrap_or(1.0);
            let along = load.nodes.iter().zip(&load.shares).map(|(&node, share)| {
                let d = freedoms.displacement(node, u, factors);
                share * dot(d, load.direction)
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
