//! The factored structure: the part of the analysis that increments use and do not change.

use super::cost::Cost;
use super::driving_force::DrivingForce;
use super::equilibrium::EliminatedLoad;
use super::load_point::LoadPoint;
use crate::analysis::zone::gather::Places;
use crate::assembly::System;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::Backend;
use crate::model::{Model, Pair, Slot, Work};
use crate::substructure::{Substructure, Trailing};
use rayon::prelude::*;
use std::sync::Arc;

/// Least number of freedoms that a thread takes at a time.
const GRAIN: usize = 1 << 14;

/// The factored structure with its zone and its loads. It changes only when another zone is chosen.
pub struct Structure<'m> {
    /// The model of the structure.
    pub model: &'m Model,
    /// Stiffness and loads.
    pub system: &'m System,
    backend: Backend,
    /// Elements whose freedoms were factored as zone.
    pub(in crate::analysis) factored: Arc<[usize]>,
    /// The condensed structure.
    pub sub: Substructure,
    /// Largest lower bound of the condition number among the factorisations so far
    /// ([`Substructure::condition`]). An inaccurate factorisation is not forgotten when another
    /// zone requires the next one.
    pub condition: f64,
    /// Work of each set of like loads at factor 1 on the rigid body motions of floating bodies.
    work: Vec<Vec<Work>>,
    /// Places of zone and contact freedoms in nodal vectors.
    pub places: Places,
    /// Elements of the zone, ascending.
    pub elements: Arc<[usize]>,
    /// Number of the current zone, counting the zones chosen so far.
    pub(super) zone_number: usize,
    /// Loads at factor 1.
    pub(in crate::analysis) loads: Loads,
    /// Gaps of the pairs without load.
    pub(in crate::analysis) gaps: Gaps,
    /// Factor on proportional loads at `alpha = 1`.
    pub unit: f64,
}

/// Loads at factor 1; loads that change alike ([`Model::alike`]) are taken together.
#[derive(Default)]
pub(in crate::analysis) struct Loads {
    /// Load vectors after elimination of the interior.
    pub(in crate::analysis) reduced: Vec<Vec<f64>>,
    /// Load vectors condensed on zone and contact freedoms.
    pub(in crate::analysis) condensed: Vec<EliminatedLoad>,
    /// Forces `t` of the tied pairs, including the forces from the gaps that loads add.
    pub(in crate::analysis) forces: Vec<Vec<f64>>,
    /// Weights of each rigid body motion in the far boundary
    /// ([`crate::model::RigidMotion::in_far_boundary`]), reduced as loads are.
    reduced_far: Vec<Vec<f64>>,
    /// Weights of each rigid body motion in the far boundary, condensed on zone and contact
    /// freedoms: their product with the displacements of these freedoms is the motion's amplitude.
    pub(in crate::analysis) far: Vec<Trailing>,
    /// Driving force of the leading load, if this load prescribes displacements.
    pub(super) driving: Option<DrivingForce>,
}

/// Gaps of the pairs without load, and the forces that these gaps and the interference cause.
pub(in crate::analysis) struct Gaps {
    pub(in crate::analysis) initial: Vec<f64>,
    /// The products of `T` with the initial gaps and with the whole interference.
    pub(in crate::analysis) forces: [Vec<f64>; 2],
}

/// Work of each set of like loads on the rigid body motions of floating bodies.
fn work_of_loads(model: &Model) -> Vec<Vec<Work>> {
    let sets = model.alike.iter().map(|alike| {
        let acting = || alike.iter().flat_map(|&load| &model.loads[load].forces);
        let motions = model.floating.motions.iter();
        motions.map(|motion| motion.work_of(acting())).collect()
    });
    sets.collect()
}

impl<'m> Structure<'m> {
    /// Factors the structure so that zones may be chosen among the elements `within`, and chooses
    /// the zone of the given `elements`.
    ///
    /// # Errors
    /// Errors of [`Substructure::new`].
    pub fn new(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        within: &[usize],
        elements: Vec<usize>,
        cost: &mut Cost,
    ) -> Result<Self> {
        let sub = Substructure::new(model, system, zone_freedoms(model, within), backend)?;
        cost.counts.factorizations += sub.factorizations();
        let initial: Vec<f64> = model.pairs.iter().map(|p| p.gap).collect();
        let mut structure = Structure {
            condition: sub.condition(),
            work: work_of_loads(model),
            places: places(model, &sub),
            factored: within.into(),
            elements: within.into(),
            zone_number: 0,
            loads: Loads::default(),
            gaps: Gaps {
                initial,
                forces: [Vec::new(), Vec::new()],
            },
            unit: 1.0,
            model,
            system,
            backend,
            sub,
        };
        if elements != within {
            structure.choose_zone(elements, cost)?;
        }
        structure.reduce_loads(cost)?;
        Ok(structure)
    }

    /// Changes the zone to the given elements. Factors the structure again only if necessary, and
    /// returns whether that was done.
    ///
    /// # Errors
    /// Errors of [`Substructure::new`].
    pub fn set_zone(&mut self, elements: Vec<usize>, cost: &mut Cost) -> Result<bool> {
        self.zone_number += 1;
        let factored = self.choose_zone(elements, cost)?;
        if factored {
            self.reduce_loads(cost)?;
        } else {
            self.condense_loads(cost)?;
        }
        Ok(factored)
    }

    fn choose_zone(&mut self, elements: Vec<usize>, cost: &mut Cost) -> Result<bool> {
        let freedoms = zone_freedoms(self.model, &elements);
        self.elements = elements.into();
        let sub = &mut self.sub;
        let factored = sub.set_zone(self.model, self.system, freedoms, self.backend)?;
        if factored {
            cost.counts.factorizations += sub.factorizations();
            self.condition = sub.condition().max(self.condition);
            self.factored = Arc::clone(&self.elements);
        }
        self.places = places(self.model, sub);
        Ok(factored)
    }

    /// Computes the effect of loads and gaps at factor 1 on tied pairs, after the structure was
    /// factored.
    fn reduce_loads(&mut self, cost: &mut Cost) -> Result<()> {
        let (sub, gaps) = (&self.sub, &mut self.gaps);
        let interference: Vec<f64> = self.model.pairs.iter().map(|p| p.interference).collect();
        gaps.forces = [&gaps.initial, &interference].map(|v| sub.slip_forces(v));
        // A load without forces stays zero and needs no solve.
        let acts = |load: &Vec<f64>| load.iter().any(|force| *force != 0.0);
        let loads = self.system.loads.iter();
        let reduced = loads.map(|load| match acts(load) {
            true => sub.reduce(load),
            false => Ok(load.clone()),
        });
        self.loads.reduced = reduced.collect::<Result<_>>()?;
        cost.counts.full_solves += self.system.loads.iter().filter(|load| acts(load)).count();
        self.reduce_far_boundary(cost)?;
        self.condense_loads(cost)?;
        let forces = self.loads.condensed.iter().map(|load| load.forces.clone());
        self.loads.forces = forces.collect();
        Ok(())
    }

    /// Reduces the weights of rigid body motions in the far boundary as loads are reduced. If
    /// forces act on zone and contact freedoms alone, `w.u` over all freedoms equals the product of
    /// the condensed weights with the condensed structure's `u` (Betti). Only the dent figures need
    /// the weights.
    fn reduce_far_boundary(&mut self, cost: &mut Cost) -> Result<()> {
        let (floating, n) = (&self.model.floating, self.model.freedoms.n);
        if self.n_pairs() == 0 || !self.model.may_yield.contains(&true) {
            return Ok(());
        }
        let reduced = floating.motions.iter().map(|motion| {
            let mut weights = vec![0.0; n];
            for &(freedom, weight) in &motion.in_far_boundary {
                weights[freedom as usize] = weight;
            }
            self.sub.reduce(&weights)
        });
        self.loads.reduced_far = reduced.collect::<Result<_>>()?;
        cost.counts.full_solves += self.loads.reduced_far.len();
        Ok(())
    }

    /// Computes the effect of loads at factor 1 on the zone, after the zone was chosen.
    fn condense_loads(&mut self, cost: &mut Cost) -> Result<()> {
        let far = self.loads.reduced_far.iter();
        self.loads.far = far.map(|w| self.sub.condense(w)).collect::<Result<_>>()?;
        let reduced = self.loads.reduced.iter();
        let condensed: Result<Vec<_>> = reduced.map(|l| self.sub.condense(l)).collect();
        let condensed = condensed?.into_iter();
        let condensed = condensed.zip(&self.model.alike).zip(&self.work);
        let eliminated = condensed.map(|((load, alike), work)| {
            let mut out = self.eliminate(load, cost);
            let of_alike = || alike.iter().map(|&load| &self.model.loads[load]);
            if of_alike().any(|case| !case.opens.is_empty()) {
                let opened = |pair: &Pair| of_alike().map(|case| case.gap(pair)).sum();
                let gaps: Vec<f64> = self.model.pairs.iter().map(opened).collect();
                let forces = self.sub.slip_forces(&gaps);
                out.forces
                    .iter_mut()
                    .zip(forces)
                    .for_each(|(t, force)| *t -= force);
            }
            self.sub.balance(&mut out.forces, work);
            out
        });
        self.loads.condensed = eliminated.collect();
        let (model, system, sub) = (self.model, self.system, &self.sub);
        let loads = (&self.loads.reduced[..], &self.loads.condensed[..]);
        self.loads.driving = DrivingForce::new(model, system, sub, loads, cost)?;
        Ok(())
    }

    /// Eliminates a load: the first half of its solve.
    pub fn eliminate(&self, load: Trailing, cost: &mut Cost) -> EliminatedLoad {
        let mut out = EliminatedLoad {
            eliminated: load.clone(),
            load,
            forces: vec![0.0; self.n_pairs()],
        };
        if out.load.largest() > 0.0 {
            self.sub.eliminate(&mut out.eliminated, &mut out.forces);
            cost.count_half();
        }
        out
    }

    /// Eliminates the load of initial strains: the first half of its solve. This load is
    /// self-equilibrated on each body. The resultants that round-off leaves are removed, because
    /// they would drive bodies that contact alone holds.
    pub fn eliminate_initial(&self, load: Trailing, cost: &mut Cost) -> EliminatedLoad {
        let mut out = self.eliminate(load, cost);
        self.sub.balance_in_bodies(&mut out.forces);
        out
    }

    /// Number of pairs.
    pub fn n_pairs(&self) -> usize {
        self.gaps.initial.len()
    }

    /// The load point at a load factor, with preloads fully applied and the share of the
    /// interference that the program applies at this factor.
    pub fn point(&self, alpha: f64) -> LoadPoint {
        let loads = self.model.loads.iter();
        LoadPoint {
            alpha,
            factors: loads.map(|l| l.factor(alpha, self.unit)).collect(),
            interference_share: self.model.interference_at(alpha),
        }
    }

    /// Condensed external load at a load point.
    pub fn external(&self, point: &LoadPoint) -> Trailing {
        let mut out = self.sub.zeros();
        let factors = self.model.factors_of_alike(&point.factors);
        for (load, factor) in self.loads.condensed.iter().zip(factors) {
            out.add(factor, &load.load);
        }
        out
    }

    /// Reduced external load at a load point.
    pub fn reduced_external(&self, point: &LoadPoint) -> Vec<f64> {
        combination(self.model, &self.loads.reduced, &point.factors)
    }

    /// The gap of a pair before anything moves: the initial gap minus the applied interference,
    /// plus the gaps that loads add.
    pub fn gap_unmoved(&self, pair: &Pair, point: &LoadPoint) -> f64 {
        let loads = self.model.loads.iter().zip(&point.factors);
        let opened: f64 = loads.map(|(load, factor)| factor * load.gap(pair)).sum();
        pair.gap - point.interference_share * pair.interference + opened
    }

    /// Values of [`Structure::gap_unmoved`] for all pairs.
    pub fn delta(&self, point: &LoadPoint) -> Vec<f64> {
        let pairs = self.model.pairs.iter();
        pairs.map(|pair| self.gap_unmoved(pair, point)).collect()
    }

    /// Terms of the force of tied pair `k` at a load point without initial loads: `t` of each load,
    /// and `-T delta`.
    pub(super) fn closed_force_terms<'a>(
        &'a self,
        point: &'a LoadPoint,
        k: usize,
    ) -> impl Iterator<Item = f64> + 'a {
        let factors = self.model.factors_of_alike(&point.factors);
        let loads = self.loads.forces.iter().zip(factors);
        let of_gaps = [
            -self.gaps.forces[0][k],
            point.interference_share * self.gaps.forces[1][k],
        ];
        loads.map(move |(t, factor)| factor * t[k]).chain(of_gaps)
    }

    /// The forces `q = t - T delta` of the contact problem at a load point without initial loads.
    /// For the forces with initial loads, see [`super::solver::Solver::forces_if_tied`].
    pub fn closed_forces(&self, point: &LoadPoint) -> Vec<f64> {
        (0..self.n_pairs())
            .map(|k| self.closed_force_terms(point, k).sum())
            .collect()
    }

    /// The largest sum, over the pairs, of the absolute values of the terms of
    /// [`Structure::closed_forces`]. Round-off of the forces is a fraction of it.
    pub fn closed_forces_size(&self, point: &LoadPoint) -> f64 {
        (0..self.n_pairs())
            .map(|k| self.closed_force_terms(point, k).map(f64::abs).sum())
            .fold(0.0, f64::max)
    }

    /// The error for a pair that nothing stops from opening.
    pub fn unbounded(&self, pair: usize, alpha: f64) -> Error {
        let names = self
            .model
            .pairs
            .get(pair)
            .and_then(|p| self.model.contacts.get(p.contact))
            .map_or(String::new(), |c| {
                format!(" (`{}` on `{}`)", c.names[0], c.names[1])
            });
        let floating = self.model.floating.bodies.join("`, `");
        Error::new(
            ErrorKind::Unheld,
            format!(
                "near load factor {alpha}: nothing stops pair {}{names} from opening; the load \
                 closes no contact that could hold body `{floating}`: check its direction, or add \
                 a support",
                pair + 1
            ),
        )
    }
}

/// Computes `sum factor * vector`, given one vector on all freedoms for each set of loads that
/// change alike, and the factors of all loads.
pub(super) fn combination(model: &Model, vectors: &[Vec<f64>], factors: &[f64]) -> Vec<f64> {
    let factors = model.factors_of_alike(factors);
    let acting: Vec<_> = vectors
        .iter()
        .zip(factors)
        .filter(|(_, f)| *f != 0.0)
        .collect();
    let sum = |i| acting.iter().fold(0.0, |sum, (v, f)| sum + *f * v[i]);
    (0..model.freedoms.n)
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(sum)
        .collect()
}

/// Free freedoms of the given elements except contact freedoms, ascending.
pub(in crate::analysis) fn zone_freedoms(model: &Model, elements: &[usize]) -> Vec<usize> {
    let mut marked = vec![false; model.freedoms.n];
    for &e in elements {
        for &node in model.mesh.nodes(e) {
            model.freedoms.each_term(node as usize, |slot, _| {
                if let Slot::Free(f) = slot {
                    marked[f as usize] = true;
                }
            });
        }
    }
    model.rows.freedoms.iter().for_each(|&f| marked[f] = false);
    (0..marked.len()).filter(|&f| marked[f]).collect()
}

fn places(model: &Model, sub: &Substructure) -> Places {
    let partition = &sub.partition;
    Places::new(model.freedoms.n, &partition.zone, &partition.contact)
}
