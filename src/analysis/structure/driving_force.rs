//! The force that drives a load's prescribed displacement, found without the displacements of the
//! whole model.
//!
//! Betti's theorem: for two states of one elastic structure, the forces of the first do the same
//! work on the displacements of the second as the forces of the second on the displacements of the
//! first. The first state is the current one. The second is the structure with all pairs tied,
//! whose driven nodes move by 1: its prescribed displacements are `v`, its free displacements `w`,
//! the forces of its pairs `t`. The theorem, solved for the force `R` that drives the first state,
//! reads:
//!
//! ```text
//! R = sum_k h_k (v'(K_pp u_k - f_k) - w' P_k) - t'(delta - g) - w' J - v' J_p
//! ```
//!
//! If a rigid surface moves, the force that drives it balances the forces of its pairs:
//! `R = -sum r_j n_j . d` with the unit direction `d` of its displacement.
//!
//! Load `k`, which may stand for loads that change alike, has the factor `h_k`, the prescribed
//! displacements `u_k`, the forces `f_k` on prescribed freedoms and the load vector `P_k` on free
//! ones ([`crate::assembly::System::loads`]). The approach of each pair is `delta - g`. The initial
//! loads of the plastic strains are `J` on free freedoms and `J_p` on prescribed ones.

use super::cost::Cost;
use super::equilibrium::EliminatedLoad;
use crate::assembly::System;
use crate::error::Result;
use crate::model::{Magnitude, Model};
use crate::substructure::{Substructure, Trailing};

/// Terms of the force that drives the prescribed displacement of a load.
pub(super) struct DrivingForce {
    pub(in crate::analysis) load: usize,
    /// Force of each set of loads that change alike, at factor 1 with all pairs tied.
    pub(in crate::analysis) of_loads: Vec<f64>,
    /// Share of each pair's force in the force that drives a rigid surface, which has no other
    /// terms.
    pub(in crate::analysis) of_rigid: Option<Vec<f64>>,
    /// Force of each tied pair if the driven nodes move by 1.
    pub(in crate::analysis) of_pairs: Vec<f64>,
    /// Displacements of zone and contact freedoms if the driven nodes move by 1.
    pub(in crate::analysis) moved: Trailing,
    /// Displacements of the prescribed freedoms if the driven nodes move by 1.
    pub(in crate::analysis) prescribed: Vec<f64>,
}

impl DrivingForce {
    /// Driving force of the leading load of a structure whose loads are condensed. `None` if the
    /// leading load prescribes no displacement, or if other loads change alike with it and it moves
    /// no rigid surface. Costs about half a full solve.
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
