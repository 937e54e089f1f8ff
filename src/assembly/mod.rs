//! Assembly of the elastic stiffness and the load vectors on the free freedoms.

mod elements;
mod pattern;
#[cfg(feature = "mumps")]
pub mod shares;
mod stiffness;

use crate::element::packed;
use crate::error::Result;
use crate::linalg::{Backend, Symmetric};
use crate::model::{Model, Prescribed, Slot};
use elements::{Elements, Matrices};

/// The assembled system `K u = sum_l h_l P_l + contact forces + initial loads`.
#[derive(Debug, Clone)]
pub struct System {
    /// Elastic stiffness, `n x n`.
    pub stiffness: Symmetric,
    /// Infinity norm of the stiffness.
    pub norm: f64,
    /// Load vector at factor 1 for each list of loads that change alike ([`Model::alike`]; `n`
    /// values each). The load vector of prescribed displacements is `-K_fp u_p`.
    pub loads: Vec<Vec<f64>>,
    /// Work on the displacements `v` that the leading load prescribes, for each list of loads at
    /// factor 1: `v' (K_pp u_p - f_p)`. It is the work of the supports of all prescribed freedoms
    /// while no free freedom moves. Zero if the leading load prescribes no displacement.
    pub on_leading: Vec<f64>,
}

/// Assembles stiffness and loads in the form that `backend` takes: a part of the stiffness on each
/// rank for MUMPS, the whole stiffness here for all other backends.
///
/// # Errors
/// Errors of the ranks; none for a valid model on one rank.
pub fn assemble(model: &Model, backend: Backend) -> Result<System> {
    let stiffness: Symmetric = match backend {
        #[cfg(feature = "mumps")]
        Backend::Mumps => Symmetric::Shared(shares::assemble(model)?),
        _ => all(model).stiffness(|_| true).into(),
    };
    let (loads, on_leading) = loads(model);
    Ok(System {
        norm: stiffness.norm()?,
        stiffness,
        loads,
        on_leading,
    })
}

fn all(model: &Model) -> Elements<'_> {
    let springs = model.freedoms.springs.iter();
    Elements::of(model).with_springs(springs.map(|spring| (spring.freedom, spring.stiffness)))
}

fn loads(model: &Model) -> (Vec<Vec<f64>>, Vec<f64>) {
    let forces = |alike: &Vec<usize>| {
        let mut vector = vec![0.0; model.freedoms.n];
        for &(freedom, force) in alike.iter().flat_map(|&load| &model.loads[load].forces) {
            vector[freedom] += force;
        }
        vector
    };
    let mut loads: Vec<Vec<f64>> = model.alike.iter().map(forces).collect();
    let on_leading = match model.freedoms.prescribed.is_empty() {
        true => vec![0.0; loads.len()],
        false => add_prescribed(model, &mut loads),
    };
    (loads, on_leading)
}

/// Adds `-K_fp u_p` of each load's prescribed displacements and returns [`System::on_leading`].
fn add_prescribed(model: &Model, loads: &mut [Vec<f64>]) -> Vec<f64> {
    let is_prescribed = |slot: &Slot| matches!(slot, Slot::Prescribed(_));
    let elements: Vec<usize> = (0..model.mesh.n_elements())
        .filter(|&e| model.slots_of(e).iter().any(is_prescribed))
        .collect();
    let leading = model.leading_load();
    let mut list_of = vec![0; model.loads.len()];
    for (list, alike) in model.alike.iter().enumerate() {
        alike.iter().for_each(|&load| list_of[load] = list);
    }
    let prescribed = |p: u32| model.freedoms.prescribed[p as usize];
    let moved = |slot| match slot {
        Slot::Prescribed(p) => Some(prescribed(p)).filter(|p| Some(p.load) == leading),
        _ => None,
    };
    let mut on_leading = vec![0.0; loads.len()];
    let matrices = Matrices::new(&Elements::some_of(model, &elements));
    for (place, &e) in elements.iter().enumerate() {
        let (slots, matrix) = (model.slots_of(e), matrices.of(place));
        for (j, slot) in slots.iter().enumerate() {
            let Slot::Prescribed(p) = *slot else { continue };
            let Prescribed { load, value } = prescribed(p);
            let load = list_of[load];
            for (i, row) in slots.iter().enumerate() {
                let force = matrix[packed(i, j)] * value;
                if let Slot::Free(f) = *row {
                    loads[load][f as usize] -= force;
                } else if let Some(own) = moved(*row) {
                    on_leading[load] += own.value * force;
                }
            }
        }
    }
    for (&list, load) in list_of.iter().zip(&model.loads) {
        load.each_on_slots(&model.freedoms, |slot, force| {
            on_leading[list] -= moved(slot).map_or(0.0, |own| own.value * force);
        });
    }
    on_leading
}
