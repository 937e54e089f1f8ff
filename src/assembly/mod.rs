//! The elastic stiffness and the load vectors on the free freedoms.
//!
//! The pattern and the values are built column by column: every column is owned by one thread and
//! gathers its elements' contributions in ascending element order, so the result has the same bits
//! for any number of threads.

mod pattern;

pub use pattern::Incidence;

use crate::element::{packed, with_kernel};
use crate::error::Result;
use crate::linalg::{self, SymmetricCsc};
use crate::model::{Model, Slot};
use rayon::prelude::*;

/// The assembled system `K u = sum_l h_l P_l + contact forces + initial loads`.
#[derive(Debug, Clone)]
pub struct System {
    /// Upper triangle of the elastic stiffness, `n x n`.
    pub stiffness: SymmetricCsc,
    /// Its infinity norm.
    pub norm: f64,
    /// Load vector of each load at factor 1 (`n` each); those of prescribed displacements are
    /// `-K_fp u_p`.
    pub loads: Vec<Vec<f64>>,
}

/// Assembles stiffness and loads.
///
/// # Errors
/// None on a valid model; the result type leaves room for memory limits.
pub fn assemble(model: &Model) -> Result<System> {
    let incidence = Incidence::new(model);
    let elements = ElementMatrices::new(model);
    let mut loads: Vec<Vec<f64>> = model
        .loads
        .iter()
        .map(|load| {
            let mut vector = vec![0.0; model.freedoms.n];
            for &(freedom, force) in &load.forces {
                vector[freedom] += force;
            }
            vector
        })
        .collect();
    if !model.freedoms.prescribed.is_empty() {
        elements.add_prescribed(model, &mut loads);
    }
    let (pointers, rows) = incidence.pattern();
    let mut values = vec![0.0; rows.len()];
    let mut columns: Vec<&mut [f64]> = Vec::with_capacity(model.freedoms.n);
    let mut rest = values.as_mut_slice();
    for j in 0..model.freedoms.n {
        let (column, tail) = rest.split_at_mut((pointers[j + 1] - pointers[j]) as usize);
        columns.push(column);
        rest = tail;
    }
    columns
        .into_par_iter()
        .enumerate()
        .with_min_len(1024)
        .for_each(|(j, column)| {
            let rows = &rows[pointers[j] as usize..pointers[j + 1] as usize];
            for &(element, local) in incidence.elements(j) {
                let freedoms = incidence.freedoms(element as usize);
                let matrix = elements.matrix(element as usize);
                for (i, &freedom) in freedoms.iter().enumerate() {
                    if (0..=j as i64).contains(&freedom)
                        && let Ok(at) = rows.binary_search(&freedom)
                    {
                        column[at] += matrix[packed(i, local as usize)];
                    }
                }
            }
        });
    let n = model.freedoms.n;
    let stiffness = SymmetricCsc::new_csc((n, n), pointers, rows, values);
    Ok(System {
        norm: linalg::norm(&stiffness),
        stiffness,
        loads,
    })
}

/// All element stiffness matrices on what they act on ([`Model::slots_of`]), packed lower
/// triangles, and those of springs.
struct ElementMatrices {
    offsets: Vec<usize>,
    values: Vec<f64>,
}

impl ElementMatrices {
    fn new(model: &Model) -> Self {
        let n_elements = model.mesh.n_elements();
        let mut offsets = Vec::with_capacity(n_elements + 1);
        offsets.push(0);
        for (e, shape) in model.mesh.shapes.iter().enumerate() {
            let own = model.freedoms.per_node * shape.n_nodes();
            let n = model.sums_of(e).map_or(own, |sums| sums.slots.len());
            offsets.push(offsets[offsets.len() - 1] + n * (n + 1) / 2);
        }
        let elastic: Vec<_> = model.materials.iter().map(|m| m.lame()).collect();
        let mut values = vec![0.0; offsets[n_elements]];
        let mut blocks: Vec<&mut [f64]> = Vec::with_capacity(n_elements);
        let mut rest = values.as_mut_slice();
        for e in 0..n_elements {
            let (block, tail) = rest.split_at_mut(offsets[e + 1] - offsets[e]);
            blocks.push(block);
            rest = tail;
        }
        let blocks = blocks.into_par_iter().enumerate().with_min_len(256);
        with_kernel!(model, kernel => blocks.for_each(|(e, block)| {
            let elastic = &elastic[model.mesh.element_body[e] as usize];
            let gradients = model.gradients(&kernel, e);
            let Some(sums) = model.sums_of(e) else {
                return gradients.stiffness_into(elastic, block);
            };
            let n = model.freedoms.per_node * model.mesh.shapes[e].n_nodes();
            let mut own = vec![0.0; n * (n + 1) / 2];
            gradients.stiffness_into(elastic, &mut own);
            sums.stiffness(n, &own, block);
        }));
        for spring in &model.freedoms.springs {
            values.push(spring.stiffness);
            offsets.push(values.len());
        }
        ElementMatrices { offsets, values }
    }

    fn matrix(&self, element: usize) -> &[f64] {
        &self.values[self.offsets[element]..self.offsets[element + 1]]
    }

    /// Adds `-K_fp u_p` of each load's prescribed displacements.
    fn add_prescribed(&self, model: &Model, loads: &mut [Vec<f64>]) {
        for e in 0..model.mesh.n_elements() {
            let slots = model.slots_of(e);
            for (j, slot) in slots.iter().enumerate() {
                let Slot::Prescribed(p) = *slot else { continue };
                let prescribed = model.freedoms.prescribed[p as usize];
                for (i, row) in slots.iter().enumerate() {
                    if let Slot::Free(f) = *row {
                        loads[prescribed.load][f as usize] -=
                            self.matrix(e)[packed(i, j)] * prescribed.value;
                    }
                }
            }
        }
    }
}
