//! The force that moves what a load displaces, without the displacements of the whole model.
//!
//! Betti's theorem: of two states of one elastic structure, the forces of the first do the same
//! work on the displacements of the second as the forces of the second on those of the first. The
//! first is the state at hand. The second is the structure with all pairs tied, whose driven nodes
//! move by 1: its prescribed displacements are `v`, its free ones `w`, the forces of its pairs `t`.
//! Solved for the force `R` that drives the first state:
//!
//! ```text
//! R = sum_k h_k (v'(K_pp u_k - f_k) - w' P_k) - t'(delta - g) - w' J - v' J_p
//! ```
//!
//! Where a rigid surface moves, what drives it balances the forces of its pairs:
//! `R = -sum r_j n_j . d` with the unit direction `d` of its displacement.
//!
//! Load `k`, or list of loads that change alike, has the factor `h_k`, the prescribed displacements
//! `u_k`, the forces `f_k` on prescribed freedoms and the load vector `P_k` on free ones
//! ([`crate::assembly::System::loads`]). `delta - g` is how far each pair has moved together; `J`
//! and `J_p` are the initial loads of the plastic strains on free and on prescribed freedoms.

use super::solver::Solver;
use super::structure::{Cost, Structure};
use crate::error::Result;
use crate::model::Magnitude;
use crate::substructure::Trailing;

/// What the force that moves a load's nodes is the sum of.
pub(super) struct DrivingForce {
    load: usize,
    /// Force of each list of loads that change alike at factor 1 with all pairs tied.
    of_loads: Vec<f64>,
    /// Of a rigid surface all there is: the share of each pair's force in what drives it.
    of_rigid: Option<Vec<f64>>,
    /// Force of each tied pair where the nodes move by 1.
    of_pairs: Vec<f64>,
    /// Displacements of zone and contact freedoms where they do.
    moved: Trailing,
    /// The prescribed displacements themselves.
    prescribed: Vec<f64>,
}

impl DrivingForce {
    /// For the leading load of a structure whose loads are condensed; `None` where that one
    /// prescribes no displacement. Costs about half a full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(super) fn new(structure: &Structure, cost: &mut Cost) -> Result<Option<Self>> {
        let (model, system, loads) = (structure.model, structure.system, &structure.loads);
        let Some(load) = model.leading_load() else {
            return Ok(None);
        };
        let case = &model.loads[load];
        if case.measures != Magnitude::Displacement || case.magnitude == 0.0 {
            return Ok(None);
        }
        let size = case.magnitude;
        if !case.opens.is_empty() {
            let pairs = model.pairs.iter();
            return Ok(Some(DrivingForce {
                load,
                of_rigid: Some(pairs.map(|pair| -case.gap(pair) / size).collect()),
                of_loads: Vec::new(),
                of_pairs: Vec::new(),
                moved: Trailing::default(),
                prescribed: Vec::new(),
            }));
        }
        let own = model.alike.iter().position(|alike| alike[..] == [load]);
        let Some(own) = own else {
            return Ok(None);
        };
        let mut moved = loads.condensed[own].eliminated.clone();
        structure
            .sub
            .recover(&mut moved, &vec![0.0; structure.n_pairs()]);
        let all = structure.sub.recover_all(&loads.reduced[own], &moved)?;
        cost.counts.full_solves += 1;
        let dot = |f: &Vec<f64>| -> f64 { all.iter().zip(f).map(|(u, f)| u * f).sum() };
        let held = system.on_leading.iter().zip(&system.loads);
        let prescribed = model.freedoms.prescribed.iter();
        moved.iter_mut().for_each(|u| *u /= size);
        Ok(Some(DrivingForce {
            load,
            of_rigid: None,
            of_loads: held.map(|(held, f)| (held - dot(f)) / size).collect(),
            of_pairs: (loads.condensed[own].forces.iter())
                .map(|force| force / size)
                .collect(),
            moved,
            prescribed: prescribed
                .map(|p| if p.load == load { p.value / size } else { 0.0 })
                .collect(),
        }))
    }
}

impl Solver<'_> {
    /// The force that moves the nodes of the leading load along its displacement, of the whole:
    /// negative where they have to be held back, zero where it is no more than round-off of its
    /// terms. `None` where that load prescribes no displacement.
    pub(super) fn driving_force(&self) -> Option<f64> {
        let structure = &self.structure;
        let driving = structure.loads.driving.as_ref()?;
        let product = |(a, b): (&f64, &f64)| a * b;
        let of_whole = |force: f64| {
            Some(force * self.at.factors[driving.load].signum() * structure.model.symmetry)
        };
        if let Some(shares) = &driving.of_rigid {
            let forces = self.contact_forces();
            return of_whole(shares.iter().zip(forces.iter()).map(product).sum());
        }
        let delta = structure.delta(&self.at);
        let slip = delta.iter().zip(&self.now.gap).map(|(d, gap)| gap - d);
        let factors = structure.model.factors_of_alike(&self.at.factors);
        let of_loads = factors.zip(&driving.of_loads).map(|(h, force)| h * force);
        let of_pairs = driving.of_pairs.iter().zip(slip).map(|(t, slip)| t * slip);
        let initial = self.now.initial.load.iter();
        let of_initial = driving.moved.iter().zip(initial).map(product);
        let held = driving.prescribed.iter().zip(self.zone.on_prescribed());
        let plastic = of_initial.chain(held.map(product)).map(|work| -work);
        let terms = of_loads.chain(of_pairs).chain(plastic);
        let [force, size] = terms.fold([0.0, 0.0], |[sum, size], term| {
            [sum + term, size + f64::abs(term)]
        });
        if f64::abs(force) <= 8.0 * f64::EPSILON * structure.condition * size {
            return Some(0.0);
        }
        of_whole(force)
    }
}
