//! The solver: the structure in its current state, with the data that increments are found with.

use super::cost::Cost;
use super::equilibrium::{EliminatedLoad, Equilibrium};
use super::factored::Structure;
use super::factored_tangent::FactoredTangent;
use super::flow::FlowOnset;
use super::load_point::LoadPoint;
use super::round_off::LOOSEST;
use crate::analysis::zone::elements::Zone;
use crate::assembly::System;
use crate::contact::Tableau;
use crate::contact::springs::{Springs, with_springs};
use crate::error::Result;
use crate::linalg::Backend;
use crate::model::{LoadCase, Magnitude, Model};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The structure in its current state.
pub struct Solver<'m> {
    /// The factored structure.
    pub structure: Structure<'m>,
    /// Contact matrix, with springs, and the statuses of the pairs.
    pub tableau: Tableau,
    /// Weak springs that keep bodies in place against motions that nothing holds and nothing
    /// drives.
    pub springs: Arc<[Springs]>,
    /// Elements that may yield, with their history.
    pub zone: Zone,
    /// Current load point.
    pub at: LoadPoint,
    /// Current equilibrium. Its displacements are valid only if `fresh`; they leave out the rigid
    /// motions that gaps allow.
    pub now: Equilibrium,
    /// Whether the displacements belong to the current gaps and forces.
    pub fresh: bool,
    /// Pairs whose gap or force came to zero at the last change of contact.
    pub border: Vec<usize>,
    /// The factored tangent, if one was made in the current increment.
    pub tangent: Option<Box<FactoredTangent>>,
    /// Data from which the next increment is predicted.
    pub predictor: Predictor,
    /// Reference sizes for residuals and round-off.
    pub scales: Scales,
    /// Cost of the run so far.
    pub cost: Cost,
}

/// Data from which an increment is predicted, in addition to the state and the points that yielded
/// last. The prediction decides how fast the increment converges.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Predictor {
    /// Change of the load point from the start of the last increment to the end of its straight
    /// piece of the load path. It tells loading from unloading.
    pub last_step: Vec<f64>,
    /// Load point at which flow began last, after a stretch without flow.
    pub flow: FlowOnset,
    /// Rate at which initial loads changed over the last increment. The rate in the next increment
    /// is nearly equal.
    pub pace: Option<InitialLoadRate>,
}

/// The rate of change of initial loads with the load.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct InitialLoadRate {
    /// The change for a distance of 1 between load points.
    pub initial: EliminatedLoad,
    /// The distance over which it was found.
    pub distance: f64,
    /// Factor by which the change was scaled since its loads were eliminated.
    pub stretched: f64,
}

/// The largest values in the run so far, against which residuals and round-off are measured.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Scales {
    /// Largest nodal force, applied or of contact.
    pub force: f64,
    /// Largest displacement, of a state or of the two sides of a pair relative to each other.
    pub displacement: f64,
    /// Largest displacement without rigid body motions of floating bodies. Stresses and their
    /// round-off are proportional to it.
    pub deformation: f64,
    /// Round-off at which equilibrium was accepted, if it is above the tolerance asked for; zero if
    /// it never was.
    pub round_off: f64,
}

impl<'m> Solver<'m> {
    /// Factors the structure so that zones may be chosen among the elements `within`, and chooses
    /// the zone of the given `elements`. `guard` marks the elements that are in the zone only to
    /// show when yielding reaches them.
    ///
    /// # Errors
    /// Errors of [`Structure::new`].
    pub fn new(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        within: &[usize],
        elements: Vec<usize>,
        guard: &[bool],
    ) -> Result<Self> {
        let mut cost = Cost::default();
        let structure = Structure::new(model, system, backend, within, elements, &mut cost)?;
        let mut solver = Solver {
            tableau: structure.sub.tableau(),
            springs: Arc::default(),
            zone: Zone::new(model, &structure.elements, guard, &structure.places),
            at: LoadPoint::unloaded(model.loads.len()),
            now: Equilibrium::none(&structure.sub.zeros(), structure.n_pairs()),
            fresh: true,
            border: Vec::new(),
            tangent: None,
            predictor: Predictor {
                last_step: vec![0.0; model.loads.len() + 1],
                flow: FlowOnset::none(model.loads.len()),
                pace: None,
            },
            scales: Scales::default(),
            cost,
            structure,
        };
        solver.unload();
        Ok(solver)
    }

    /// Returns to the unloaded state with the current zone. The plastic history of the zone is not
    /// changed: it must be empty, or be replaced afterwards.
    pub(super) fn unload(&mut self) {
        let structure = &self.structure;
        self.at = LoadPoint::unloaded(structure.model.loads.len());
        self.now = Equilibrium {
            gap: structure.gaps.initial.clone(),
            ..Equilibrium::none(&structure.sub.zeros(), structure.n_pairs())
        };
        self.set_springs(&Arc::default());
        let open: Vec<bool> = self.now.gap.iter().map(|g| *g > 0.0).collect();
        self.tableau.reset(&open);
        self.border.clear();
        self.predictor.last_step.fill(0.0);
        self.predictor.flow = FlowOnset::none(self.at.factors.len());
        self.predictor.pace = None;
        self.fresh = true;
    }

    /// Replaces the current springs and keeps the statuses. Returns false, and changes nothing, if
    /// the springs are of another structure.
    pub(super) fn set_springs(&mut self, springs: &Arc<[Springs]>) -> bool {
        let matrix = self.structure.sub.pair_matrix();
        if !springs.iter().all(|own| own.fit(matrix)) {
            return false;
        }
        let same = self.springs.len() == springs.len();
        let mut both = self.springs.iter().zip(springs.iter());
        let as_stiff = same && both.all(|(a, b)| a.as_stiff_as(b));
        self.springs = Arc::clone(springs);
        if !as_stiff {
            self.build_tableau();
        }
        true
    }

    /// Builds the tableau again with the same statuses.
    fn build_tableau(&mut self) {
        let open = self.tableau.open().to_vec();
        let matrix = with_springs(self.structure.sub.pair_matrix(), &self.springs);
        self.tableau = Tableau::new(matrix);
        self.tableau.reset(&open);
    }

    /// Adds the constant part of the spring forces to the forces `q` of the tied pairs.
    pub(in crate::analysis) fn add_springs(&self, q: &mut [f64]) {
        for springs in self.springs.iter() {
            springs.add_at_rest(q);
        }
    }

    /// Whether a body is held by springs alone.
    pub(in crate::analysis) fn springs_hold_a_body(&self) -> bool {
        let open = self.tableau.open();
        let mut springs = self.springs.iter();
        springs.any(|own| own.pairs().iter().all(|&k| open[k]))
    }

    /// Whether a spring bears more than a fraction of the largest force.
    pub(in crate::analysis) fn springs_bear(&self, share: f64) -> bool {
        let gap = &self.now.gap;
        let forces = self.springs.iter().map(|own| own.largest_force(gap));
        forces.fold(0.0, f64::max) > share * self.scales.force
    }

    /// Changes the zone to the given elements. State, statuses and history are kept.
    ///
    /// # Errors
    /// Errors of [`Structure::set_zone`].
    pub fn set_zone(&mut self, elements: Vec<usize>, guard: &[bool]) -> Result<()> {
        let before = self.structure.elements.clone();
        if self.structure.set_zone(elements, &mut self.cost)? {
            self.build_tableau();
        }
        let structure = &self.structure;
        let mut zone = Zone::new(
            structure.model,
            &structure.elements,
            guard,
            &structure.places,
        );
        zone.restore_of(&before, &self.zone.history());
        zone.set_factors(&self.at.factors);
        self.zone = zone;
        let initial = self.zone.initial_load(structure.sub.zeros());
        let initial = structure.eliminate_initial(initial, &mut self.cost);
        self.now = self.respond(&self.at.clone(), initial);
        self.fresh = true;
        self.predictor.pace = None;
        self.tangent = None;
        Ok(())
    }

    /// Bound on the round-off in the sum of the contact forces. The tied structure comes from a
    /// factor whose relative error is `eps` times the condition number of the stiffness. Unless
    /// Poisson's ratio is close to 1/2, the bound is below the tolerance of any iteration.
    pub fn round_off_of_contact(&self) -> f64 {
        let initial = self.now.initial.forces.iter().map(|r| r.abs());
        let terms: f64 = (0..self.now.gap.len())
            .map(|k| {
                let terms = self.structure.closed_force_terms(&self.at, k);
                terms.map(f64::abs).sum::<f64>()
            })
            .chain(initial)
            .sum();
        (8.0 * f64::EPSILON * self.structure.condition * terms).min(LOOSEST * self.scales.force)
    }

    /// Whether the load left up to `end` is no more than the round-off of the contact forces.
    pub(in crate::analysis) fn is_round_off(&self, end: &LoadPoint) -> bool {
        let model = self.structure.model;
        let [from, to] = [&self.at, end].map(|at| model.factors_of_alike(&at.factors));
        let left: f64 = (model.alike.iter())
            .zip(&self.structure.loads.condensed)
            .zip(from.zip(to))
            .map(|((alike, condensed), (from, to))| {
                let loads = || alike.iter().map(|&load| &model.loads[load]);
                let size: f64 = match model.loads[alike[0]].measures {
                    // A rigid surface that moves changes only gaps.
                    _ if loads().any(|load| !load.opens.is_empty()) => {
                        let all = condensed.load.iter().chain(&condensed.forces);
                        all.map(|f| f.abs()).sum()
                    }
                    Magnitude::Displacement | Magnitude::Carried => {
                        condensed.load.iter().map(|f| f.abs()).sum()
                    }
                    Magnitude::Gap => condensed.forces.iter().map(|f| f.abs()).sum(),
                    Magnitude::Force
                    | Magnitude::Stress
                    | Magnitude::Temperature
                    | Magnitude::Strain => loads().map(LoadCase::size).sum(),
                };
                (to - from).abs() * size
            })
            .sum();
        !self.now.gap.is_empty()
            && self.at.interference_share == end.interference_share
            && left <= self.round_off_of_contact()
    }

    /// Makes the prediction of the next increment assume that no point yields.
    pub fn assume_elastic(&mut self) {
        self.zone.assume_elastic();
        self.predictor.pace = None;
    }

    /// Forgets the factored tangent.
    pub(in crate::analysis) fn forget_tangent(&mut self) {
        self.zone.forget_softening();
        if let Some(tangent) = &mut self.tangent {
            (tangent.tableau, tangent.is_refused, tangent.spent) = (None, false, 0.0);
        }
    }

    /// Raises the scales to the forces and displacements of the current state.
    pub fn update_scales(&mut self) {
        let (structure, scales) = (&self.structure, &self.scales);
        let delta = structure.delta(&self.at);
        let slip = delta.iter().zip(&self.now.gap).map(|(d, g)| (d - g).abs());
        let displacement = slip.fold(scales.displacement, f64::max);
        let (deforming, _) = structure.sub.split_slip(&delta, &self.now.gap);
        let moved = if self.fresh {
            self.now.u.largest()
        } else {
            0.0
        };
        let deforming = deforming.iter().map(|s| s.abs());
        let deformation = deforming.fold(scales.deformation.max(moved), f64::max);
        let applied = structure.external(&self.at).largest();
        let force = scales.force.max(applied);
        self.scales = Scales {
            displacement,
            deformation,
            force: self.now.force.iter().fold(force, |m, r| m.max(*r)),
            ..self.scales
        };
    }

    /// Number of closed pairs.
    pub fn closed_pairs(&self) -> usize {
        self.tableau.open().iter().filter(|o| !**o).count()
    }
}
