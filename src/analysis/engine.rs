//! The structure under load: everything an increment works with.

mod record;

pub(super) use record::EngineRecord;

use super::equilibrium::{EliminatedLoad, Equilibrium};
use super::gather::Places;
use super::load_point::LoadPoint;
use super::quality::LOOSEST;
use super::zone::Zone;
use super::zone_choice::zone_freedoms;
use crate::assembly::System;
use crate::contact::Tableau;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::{Magnitude, Model};
use crate::results::Counts;
use crate::substructure::{Substructure, Trailing};
use rayon::prelude::*;
use std::sync::Arc;

/// Freedoms that a thread takes at a time.
const GRAIN: usize = 1 << 14;

/// The factored structure with its contact statuses, plastic zone and current state.
pub struct Engine<'m> {
    /// The model.
    pub model: &'m Model,
    /// Stiffness and loads.
    pub system: &'m System,
    backend: Backend,
    /// Elements whose freedoms were factored as zone.
    pub(super) factored: Arc<[usize]>,
    /// The condensed structure.
    pub sub: Substructure,
    /// Contact statuses.
    pub tableau: Tableau,
    /// Elements that may yield, with their history.
    pub zone: Zone,
    /// Where zone and contact freedoms are.
    pub places: Places,
    /// Elements of the zone, ascending.
    pub elements: Arc<[usize]>,
    /// Number of the zone among those that were chosen so far.
    pub(super) zone_number: usize,
    /// Loads at factor 1, reduced.
    pub(super) reduced_loads: Vec<Vec<f64>>,
    /// Condensed loads at factor 1.
    pub(super) loads: Vec<EliminatedLoad>,
    /// Weights of each rigid motion in the far boundary ([`RigidMotion::in_far_boundary`]), reduced
    /// as loads are.
    reduced_far: Vec<Vec<f64>>,
    /// The same on zone and contact freedoms: times their displacements they give the motion's
    /// amplitude.
    pub(super) far: Vec<Trailing>,
    /// Forces `t` of the tied pairs for each load at factor 1.
    pub(super) load_forces: Vec<Vec<f64>>,
    pub(super) gap: Vec<f64>,
    interference: Vec<f64>,
    /// `T gap` and `T interference`.
    pub(super) gap_forces: [Vec<f64>; 2],
    /// Factor on proportional loads that `alpha = 1` stands for.
    pub unit: f64,
    /// Cost so far.
    pub counts: Counts,
    /// Whether half a trailing solve has been counted for a whole one.
    pub(super) half: bool,
    /// Largest nodal force seen (applied or contact): what residuals are measured against.
    pub force_scale: f64,
    /// Largest lower bound of the condition among the factorisations so far
    /// ([`Substructure::condition`]): an inaccurate one is not forgotten when another zone asks for
    /// the next.
    pub condition: f64,
    /// Largest displacement seen (of a state, or of the nodes of a pair against each other).
    pub displacement_scale: f64,
    /// The same without rigid motions of floating bodies: what stresses and their round-off are a
    /// share of.
    pub deformation_scale: f64,
    /// Largest round-off that equilibrium was accepted at where it is above the tolerance asked
    /// for; zero where it never was.
    pub round_off_floor: f64,
    /// Current load point.
    pub at: LoadPoint,
    /// Current equilibrium; its displacements are valid where `fresh`, without the rigid motions
    /// that gaps allow.
    pub now: Equilibrium,
    /// Whether the displacements belong to the current gaps and forces.
    pub fresh: bool,
    /// Pairs that arrived at the border of their condition with the last event.
    pub border: Vec<usize>,
    /// Change of the load point over the piece of the last increment: tells loading from unloading.
    pub last_step: Vec<f64>,
    /// Change of the initial loads over the last increment, for a load factor that changes by 1:
    /// the next one's are much the same.
    pub pace: Option<EliminatedLoad>,
}

impl<'m> Engine<'m> {
    /// Factors the structure so that zones may be chosen among the elements `within`, and chooses
    /// one of the given elements (`guard` marks those that only watch).
    ///
    /// # Errors
    /// Those of [`Substructure::new`].
    pub fn new(
        model: &'m Model,
        system: &'m System,
        backend: Backend,
        within: &[usize],
        elements: Vec<usize>,
        guard: &[bool],
    ) -> Result<Self> {
        let mut sub = Substructure::new(model, system, zone_freedoms(model, within), backend)?;
        let mut factored: Arc<[usize]> = within.into();
        let mut factorizations = 1;
        let mut condition = sub.condition();
        if elements != within {
            let zone = zone_freedoms(model, &elements);
            if sub.set_zone(model, system, zone, backend)? {
                factorizations += 1;
                condition = sub.condition().max(condition);
                factored = elements.as_slice().into();
            }
        }
        let places = places(model, &sub);
        let zone = Zone::new(model, &elements, guard, &places);
        let n = model.pairs.len();
        let gap: Vec<f64> = model.pairs.iter().map(|p| p.gap).collect();
        let interference: Vec<f64> = model.pairs.iter().map(|p| p.interference).collect();
        let mut engine = Engine {
            model,
            system,
            backend,
            factored,
            tableau: sub.tableau(),
            reduced_loads: Vec::new(),
            loads: Vec::new(),
            reduced_far: Vec::new(),
            far: Vec::new(),
            load_forces: Vec::new(),
            gap_forces: [Vec::new(), Vec::new()],
            unit: 1.0,
            counts: Counts {
                factorizations,
                ..Counts::default()
            },
            half: false,
            force_scale: 0.0,
            condition,
            displacement_scale: 0.0,
            deformation_scale: 0.0,
            round_off_floor: 0.0,
            at: LoadPoint::unloaded(model.loads.len()),
            now: Equilibrium {
                gap: gap.clone(),
                ..Equilibrium::none(&sub.zeros(), n)
            },
            fresh: true,
            border: Vec::new(),
            last_step: vec![0.0; model.loads.len() + 1],
            pace: None,
            gap,
            interference,
            sub,
            zone,
            places,
            elements: elements.into(),
            zone_number: 0,
        };
        engine.reduce_loads()?;
        let open: Vec<bool> = engine.gap.iter().map(|g| *g > 0.0).collect();
        engine.tableau.reset(&open);
        Ok(engine)
    }

    /// Back to where nothing acts, with the zone at hand and no history.
    pub(super) fn begin_anew(&mut self) {
        let n = self.gap.len();
        self.at = LoadPoint::unloaded(self.model.loads.len());
        self.now = Equilibrium {
            gap: self.gap.clone(),
            ..Equilibrium::none(&self.sub.zeros(), n)
        };
        let open: Vec<bool> = self.gap.iter().map(|g| *g > 0.0).collect();
        self.tableau.reset(&open);
        self.border.clear();
        self.last_step.fill(0.0);
        self.pace = None;
        self.fresh = true;
    }

    /// Changes the zone to the given elements, factoring the structure again only where it must.
    /// State, statuses and history are kept.
    ///
    /// # Errors
    /// Those of [`Substructure::new`].
    pub fn set_zone(&mut self, elements: Vec<usize>, guard: &[bool]) -> Result<()> {
        let freedoms = zone_freedoms(self.model, &elements);
        if self
            .sub
            .set_zone(self.model, self.system, freedoms, self.backend)?
        {
            self.counts.factorizations += 1;
            self.condition = self.sub.condition().max(self.condition);
            self.factored = elements.as_slice().into();
            let open = self.tableau.open().to_vec();
            self.tableau = self.sub.tableau();
            self.reduce_loads()?;
            self.tableau.reset(&open);
        } else {
            self.condense_loads()?;
        }
        self.places = places(self.model, &self.sub);
        let mut zone = Zone::new(self.model, &elements, guard, &self.places);
        zone.restore_of(&self.elements, self.zone.history());
        zone.set_factors(&self.at.factors);
        (self.zone, self.elements) = (zone, elements.into());
        self.zone_number += 1;
        let initial = self.zone.initial_load(self.sub.zeros());
        let initial = self.eliminate(initial);
        self.now = self.respond(&self.at.clone(), initial);
        self.fresh = true;
        self.pace = None;
        Ok(())
    }

    /// What loads and gaps at factor 1 do to tied pairs, after the structure was factored.
    fn reduce_loads(&mut self) -> Result<()> {
        self.gap_forces = [&self.gap, &self.interference].map(|v| self.sub.slip_forces(v));
        let reduced: Result<Vec<_>> = self
            .system
            .loads
            .iter()
            .map(|l| self.sub.reduce(l))
            .collect();
        self.reduced_loads = reduced?;
        self.counts.full_solves += self.reduced_loads.len();
        self.reduce_far_boundary()?;
        self.condense_loads()?;
        self.load_forces = self.loads.iter().map(|l| l.forces.clone()).collect();
        Ok(())
    }

    /// The weights of rigid motions in the far boundary are reduced like loads: with forces on zone
    /// and contact freedoms alone, `w.u` of all freedoms is that of the condensed weights and the
    /// condensed structure's `u` (Betti). Only dents ask for it.
    fn reduce_far_boundary(&mut self) -> Result<()> {
        let (floating, n) = (&self.model.floating, self.model.freedoms.n);
        if self.gap.is_empty() || !self.model.may_yield.contains(&true) {
            return Ok(());
        }
        let reduced = floating.motions.iter().map(|motion| {
            let mut weights = vec![0.0; n];
            for &(freedom, weight) in &motion.in_far_boundary {
                weights[freedom as usize] = weight;
            }
            self.sub.reduce(&weights)
        });
        self.reduced_far = reduced.collect::<Result<_>>()?;
        self.counts.full_solves += self.reduced_far.len();
        Ok(())
    }

    /// What loads at factor 1 do to the zone, after it was chosen.
    fn condense_loads(&mut self) -> Result<()> {
        let far = self.reduced_far.iter().map(|w| self.sub.condense(w));
        self.far = far.collect::<Result<_>>()?;
        let reduced = self.reduced_loads.iter();
        let condensed: Result<Vec<_>> = reduced.map(|l| self.sub.condense(l)).collect();
        let condensed = condensed?.into_iter();
        self.loads = condensed.map(|load| self.eliminate(load)).collect();
        Ok(())
    }

    /// The load point at a load factor, preloads and interference fully applied.
    pub fn point(&self, alpha: f64) -> LoadPoint {
        LoadPoint {
            alpha,
            factors: self
                .model
                .loads
                .iter()
                .map(|l| l.factor(alpha, self.unit))
                .collect(),
            interference: 1.0,
        }
    }

    /// Condensed external load at a load point.
    pub fn external(&self, point: &LoadPoint) -> Trailing {
        let mut out = self.sub.zeros();
        for (load, &factor) in self.loads.iter().zip(&point.factors) {
            out.add(factor, &load.load);
        }
        out
    }

    /// Reduced external load at a load point.
    pub fn reduced_external(&self, point: &LoadPoint) -> Vec<f64> {
        combination(self.model.freedoms.n, &self.reduced_loads, &point.factors)
    }

    /// Initial gaps less the applied interference.
    pub fn delta(&self, point: &LoadPoint) -> Vec<f64> {
        self.gap
            .iter()
            .zip(&self.interference)
            .map(|(g, i)| g - point.interference * i)
            .collect()
    }

    /// What the force of tied pair `k` is the sum of at a load point without initial loads: `t` of
    /// each load, and `-T delta`.
    fn closed_force_terms(&self, point: &LoadPoint, k: usize) -> impl Iterator<Item = f64> {
        let loads = self.load_forces.iter().zip(&point.factors);
        let of_gaps = [
            -self.gap_forces[0][k],
            point.interference * self.gap_forces[1][k],
        ];
        loads.map(move |(t, factor)| factor * t[k]).chain(of_gaps)
    }

    /// `q` of the contact problem for a load point without initial loads: `t - T delta`.
    pub fn closed_forces(&self, point: &LoadPoint) -> Vec<f64> {
        (0..self.gap.len())
            .map(|k| self.closed_force_terms(point, k).sum())
            .collect()
    }

    /// The largest sum of absolute values of the terms of [`Engine::closed_forces`]: what its
    /// round-off is a share of.
    pub fn closed_forces_size(&self, point: &LoadPoint) -> f64 {
        (0..self.gap.len())
            .map(|k| self.closed_force_terms(point, k).map(f64::abs).sum())
            .fold(0.0, f64::max)
    }

    /// What round-off may leave in the sum of the contact forces: the tied structure comes from a
    /// factor that keeps
    /// `eps` times the condition of what it is made from. Far from Poisson's ratio 1/2 that is
    /// less than the tolerance of any iteration.
    pub fn round_off_of_contact(&self) -> f64 {
        let initial = self.now.initial.forces.iter().map(|r| r.abs());
        let terms: f64 = (0..self.gap.len())
            .map(|k| {
                let terms = self.closed_force_terms(&self.at, k);
                terms.map(f64::abs).sum::<f64>()
            })
            .chain(initial)
            .sum();
        (8.0 * f64::EPSILON * self.condition * terms).min(LOOSEST * self.force_scale)
    }

    /// Whether the load that is left up to `end` is no more than what round-off leaves in the
    /// contact forces.
    pub(super) fn is_round_off(&self, end: &LoadPoint) -> bool {
        let factors = self.at.factors.iter().zip(&end.factors);
        let loads = self.model.loads.iter().zip(&self.loads).zip(factors);
        let left: f64 = loads
            .map(|((load, condensed), (from, to))| {
                let size = match load.measures {
                    Magnitude::Displacement => condensed.load.iter().map(|f| f.abs()).sum(),
                    _ => load.size(),
                };
                (to - from).abs() * size
            })
            .sum();
        !self.gap.is_empty()
            && self.at.interference == end.interference
            && left <= self.round_off_of_contact()
    }

    /// The next increment is predicted as if no point flowed.
    pub fn assume_elastic(&mut self) {
        self.zone.assume_elastic();
        self.pace = None;
    }

    /// Relative displacement `u_second - u_first` of each pair.
    pub fn slip(&self) -> Vec<f64> {
        let delta = self.delta(&self.at);
        delta
            .iter()
            .zip(&self.now.gap)
            .map(|(d, g)| d - g)
            .collect()
    }

    /// Takes note of the forces and displacements at hand.
    pub fn update_scales(&mut self) {
        self.displacement_scale = self
            .slip()
            .iter()
            .fold(self.displacement_scale, |m, s| m.max(s.abs()));
        let (deforming, _) = self.sub.split_slip(&self.delta(&self.at), &self.now.gap);
        let moved = if self.fresh {
            self.now.u.largest()
        } else {
            0.0
        };
        self.deformation_scale = deforming
            .iter()
            .fold(self.deformation_scale.max(moved), |m, s| m.max(s.abs()));
        let applied = self.external(&self.at).largest();
        self.force_scale = self
            .now
            .force
            .iter()
            .fold(self.force_scale.max(applied), |m, r| m.max(*r));
    }

    /// Number of closed pairs.
    pub fn closed_pairs(&self) -> usize {
        self.tableau.open().iter().filter(|o| !**o).count()
    }

    /// An error for pairs that nothing holds together.
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
            crate::ErrorKind::Unheld,
            format!(
                "near load factor {alpha}: nothing stops pair {}{names} from opening; the load closes no contact that \
                 could hold body `{floating}`: check its direction, or add a support",
                pair + 1
            ),
        )
    }
}

/// `sum factor * vector`, of the length `n`.
pub(super) fn combination(n: usize, vectors: &[Vec<f64>], factors: &[f64]) -> Vec<f64> {
    let acting: Vec<_> = vectors
        .iter()
        .zip(factors)
        .filter(|(_, f)| **f != 0.0)
        .collect();
    let sum = |i| acting.iter().fold(0.0, |sum, (v, f)| sum + *f * v[i]);
    (0..n)
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(sum)
        .collect()
}

fn places(model: &Model, sub: &Substructure) -> Places {
    let partition = &sub.partition;
    Places::new(model.freedoms.n, &partition.zone, &partition.contact)
}
