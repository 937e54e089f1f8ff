//! The elastic stiffness and the load vectors on the free freedoms.

mod elements;
mod pattern;
#[cfg(feature = "mumps")]
pub mod shares;

use crate::element::packed;
use crate::error::Result;
use crate::linalg::{Backend, Symmetric};
use crate::model::{Model, Slot};
use elements::{Elements, Matrices};

/// The assembled system `K u = sum_l h_l P_l + contact forces + initial loads`.
#[derive(Debug, Clone)]
pub struct System {
    /// The elastic stiffness, `n x n`.
    pub stiffness: Symmetric,
    /// Its infinity norm.
    pub norm: f64,
    /// Load vector of each load at factor 1 (`n` each); those of prescribed displacements are
    /// `-K_fp u_p`.
    pub loads: Vec<Vec<f64>>,
}

/// Assembles stiffness and loads as `backend` takes them: MUMPS a part of the stiffness on each
/// rank, the others all of it here.
///
/// # Errors
/// Those of the ranks; none of a valid model on one.
pub fn assemble(model: &Model, backend: Backend) -> Result<System> {
    let stiffness: Symmetric = match backend {
        #[cfg(feature = "mumps")]
        Backend::Mumps => Symmetric::Shared(shares::assemble(model)?),
        _ => all(model).stiffness(|_| true).into(),
    };
    Ok(System {
        norm: stiffness.norm()?,
        stiffness,
        loads: loads(model),
    })
}

fn all(model: &Model) -> Elements<'_> {
    let springs = model.freedoms.springs.iter();
    Elements::of(model).with_springs(springs.map(|spring| (spring.freedom, spring.stiffness)))
}

fn loads(model: &Model) -> Vec<Vec<f64>> {
    let forces = |load: &crate::model::LoadCase| {
        let mut vector = vec![0.0; model.freedoms.n];
        for &(freedom, force) in &load.forces {
            vector[freedom] += force;
        }
        vector
    };
    let mut loads: Vec<Vec<f64>> = model.loads.iter().map(forces).collect();
    if !model.freedoms.prescribed.is_empty() {
        add_prescribed(model, &mut loads);
    }
    loads
}

/// Adds `-K_fp u_p` of each load's prescribed displacements.
fn add_prescribed(model: &Model, loads: &mut [Vec<f64>]) {
    let is_prescribed = |slot: &Slot| matches!(slot, Slot::Prescribed(_));
    let elements: Vec<usize> = (0..model.mesh.n_elements())
        .filter(|&e| model.slots_of(e).iter().any(is_prescribed))
        .collect();
    let matrices = Matrices::new(&Elements::some_of(model, &elements));
    for (place, &e) in elements.iter().enumerate() {
        let slots = model.slots_of(e);
        for (j, slot) in slots.iter().enumerate() {
            let Slot::Prescribed(p) = *slot else { continue };
            let prescribed = model.freedoms.prescribed[p as usize];
            for (i, row) in slots.iter().enumerate() {
                if let Slot::Free(f) = *row {
                    loads[prescribed.load][f as usize] -=
                        matrices.of(place)[packed(i, j)] * prescribed.value;
                }
            }
        }
    }
}
