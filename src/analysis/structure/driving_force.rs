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

use super::cost::Cost;
use super::equilibrium::EliminatedLoad;
use crate::assembly::System;
use crate::error::Result;
use crate::model::{Magnitude, Model};
use crate::substructure::{Substructure, Trailing};

/// What the force that moves a load's nodes is the sum of.
pub(super) struct DrivingForce {
    pub(in crate::analysis) load: usize,
    /// Force of each list of loads that change alike at factor 1 with all pairs tied.
    pub(in crate::analysis) of_loads: Vec<f64>,
    /// Share of each pair's force in what drives a rigid surface: nothing else drives one.
    pub(in crate::analysis) of_rigid: Option<Vec<f64>>,
    /// Force of each tied pair where the nodes move by 1.
    pub(in crate::analysis) of_pairs: Vec<f64>,
    /// Displacements of zone and contact freedoms where the nodes move by 1.
    pub(in crate::analysis) moved: Trailing,
    /// Displacements of the prescribed freedoms where the nodes move by 1.
    pub(in crate::analysis) prescribed: Vec<f64>,
}

impl DrivingForce {
    /// Driving force of the leading load of a structure whose loads are condensed; `None` where
    /// that load prescribes no displacement. Costs about half a full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub(super) fn new(
        model: &Model,
        system: &System,
        sub: &Substructure,
        (reduced, condensed): (&[Vec<f64>], &[EliminatedLoad]),
        cost: &mut Cost,
    ) -> Result<Option<Self>> {
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
        let mut moved = condensed[own].eliminated.clone();
        sub.recover(&mut moved, &vec![0.0; model.pairs.len()]);
        let all = sub.recover_all(&reduced[own], &moved)?;
        cost.counts.full_solves += 1;
        let dot = |f: &Vec<f64>| -> f64 { all.iter().zip(f).map(|(u, f)| u * f).sum() };
        let held = system.on_leading.iter().zip(&system.loads);
        let prescribed = model.freedoms.prescribed.iter();
        moved.iter_mut().for_each(|u| *u /= size);
        Ok(Some(DrivingForce {
            load,
            of_rigid: None,
            of_loads: held.map(|(held, f)| (held - dot(f)) / size).collect(),
            of_pairs: (condensed[own].forces.iter())
                .map(|force| force / size)
                .collect(),
            moved,
            prescribed: prescribed
                .map(|p| if p.load == load { p.value / size } else { 0.0 })
                .collect(),
        }))
    }
}
