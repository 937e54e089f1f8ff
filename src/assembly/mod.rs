//! The elastic stiffness and the load vectors on the free freedoms.

mod elements;
mod pattern;
#[cfg(feature = "mumps")]
pub mod shares;

use crate::element::packed;
use crate::error::Result;
use crate::linalg::{Backend, Symmetric};
use crate::model::{Magnitude, Model, Slot};
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
    /// Where the leading load prescribes displacements `v`: `v' (K_pp u_p - f_p)` of each load at
    /// factor 1, the work on them of what holds all prescribed freedoms while no free one moves.
    pub on_leading: Vec<f64>,
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
        on_leading: on_leading(model),
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

/// Elements with prescribed displacements.
fn of_prescribed(model: &Model) -> Vec<usize> {
    let is_prescribed = |slot: &Slot| matches!(slot, Slot::Prescribed(_));
    (0..model.mesh.n_elements())
        .filter(|&e| model.slots_of(e).iter().any(is_prescribed))
        .collect()
}

/// Adds `-K_fp u_p` of each load's prescribed displacements.
fn add_prescribed(model: &Model, loads: &mut [Vec<f64>]) {
    let elements = of_prescribed(model);
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

/// [`System::on_leading`].
fn on_leading(model: &Model) -> Vec<f64> {
    let mut work = vec![0.0; model.loads.len()];
    let is_displacement = |load: &usize| model.loads[*load].measures == Magnitude::Displacement;
    let Some(leading) = model.leading_load().filter(is_displacement) else {
        return work;
    };
    let moved = |slot| match slot {
        Slot::Prescribed(p) => Some(model.freedoms.prescribed[p as usize]),
        _ => None,
    };
    let led = |slot| moved(slot).filter(|p| p.load == leading);
    let elements = of_prescribed(model);
    let matrices = Matrices::new(&Elements::some_of(model, &elements));
    for (place, &e) in elements.iter().enumerate() {
        let slots = model.slots_of(e);
        for (i, row) in slots.iter().enumerate() {
            let Some(own) = led(*row) else { continue };
            for (j, column) in slots.iter().enumerate() {
                if let Some(other) = moved(*column) {
                    work[other.load] += own.value * matrices.of(place)[packed(i, j)] * other.value;
                }
            }
        }
    }
    for (work, load) in work.iter_mut().zip(&model.loads) {
        load.each_on_slots(&model.freedoms, |slot, force| {
            *work -= led(slot).map_or(0.0, |own| own.value * force);
        });
    }
    work
}
