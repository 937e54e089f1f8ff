//! Elements whose stiffness is assembled: all elements of a model, or a self-contained part of
//! them.

use crate::element::with_kernel;
use crate::material::Lame;
use crate::model::{Continuum, Model, Slot, Sums};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Elements of the continuum, followed by springs as elements with one freedom each.
#[derive(Serialize, Deserialize)]
pub(super) struct Elements<'a> {
    continuum: Cow<'a, Continuum>,
    /// Elements whose nodal displacements are weighted sums of the displacements at other slots.
    sums: BTreeMap<usize, Sums>,
    springs: Vec<f64>,
    /// Number of freedoms.
    n: usize,
    offsets: Vec<usize>,
    /// Freedoms of each element, -1 where a displacement is held.
    freedoms: Vec<i64>,
}

impl<'a> Elements<'a> {
    /// Collects all elements of a model, without springs.
    pub(super) fn of(model: &'a Model) -> Self {
        Self::new(
            model,
            Cow::Borrowed(&model.continuum),
            0..model.mesh.n_elements(),
        )
    }

    /// Collects the elements of `model` with the given numbers as a part of its own, without
    /// springs.
    fn new(
        model: &Model,
        continuum: Cow<'a, Continuum>,
        of_model: impl ExactSizeIterator<Item = usize>,
    ) -> Self {
        let mut offsets = Vec::with_capacity(of_model.len() + 1);
        offsets.push(0);
        let mut freedoms =
            Vec::with_capacity(model.freedoms.per_node * continuum.mesh.connectivity.len());
        let mut all_sums = BTreeMap::new();
        let number = |slot: &Slot| match *slot {
            Slot::Free(f) => i64::from(f),
            _ => -1,
        };
        for (e, of_model) in of_model.enumerate() {
            match model.sums_of(of_model) {
                Some(sums) => {
                    freedoms.extend(sums.slots.iter().map(number));
                    all_sums.insert(e, sums);
                }
                None => {
                    let nodes = model.mesh.nodes(of_model).iter();
                    let slots = nodes.flat_map(|&node| model.freedoms.of_node(node as usize));
                    freedoms.extend(slots.map(number));
                }
            }
            offsets.push(freedoms.len());
        }
        Elements {
            continuum,
            sums: all_sums,
            springs: Vec::new(),
            n: model.freedoms.n,
            offsets,
            freedoms,
        }
    }

    /// Adds springs, given as pairs of freedom and stiffness.
    pub(super) fn with_springs(mut self, springs: impl Iterator<Item = (usize, f64)>) -> Self {
        for (freedom, stiffness) in springs {
            self.springs.push(stiffness);
            self.freedoms.push(freedom as i64);
            self.offsets.push(self.freedoms.len());
        }
        self
    }

    /// Collects some elements of a model, ascending, on their own nodes; freedoms keep their
    /// numbers.
    pub(super) fn some_of(model: &Model, elements: &[usize]) -> Elements<'static> {
        let (part, _) = model.continuum.part(elements);
        Elements::new(model, Cow::Owned(part), elements.iter().copied())
    }

    /// Renumbers the freedoms in the same order without gaps, and returns their former numbers.
    #[cfg(feature = "mumps")]
    pub(super) fn renumber(&mut self) -> Vec<u32> {
        let free = self.freedoms.iter().filter(|f| **f >= 0);
        let mut numbers: Vec<u32> = free.map(|&f| f as u32).collect();
        numbers.sort_unstable();
        numbers.dedup();
        for freedom in self.freedoms.iter_mut().filter(|f| **f >= 0) {
            *freedom = numbers.partition_point(|n| i64::from(*n) < *freedom) as i64;
        }
        self.n = numbers.len();
        numbers
    }

    /// Number of freedoms on which the elements act.
    pub(super) fn n_freedoms(&self) -> usize {
        self.n
    }

    /// Number of elements, including springs.
    pub(super) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Freedoms of an element, -1 where a displacement is held.
    pub(super) fn freedoms(&self, element: usize) -> &[i64] {
        &self.freedoms[self.offsets[element]..self.offsets[element + 1]]
    }
}

/// Stiffness matrices of elements on the slots on which the elements act ([`Model::slots_of`]), as
/// packed lower triangles.
pub(super) struct Matrices {
    offsets: Vec<usize>,
    values: Vec<f64>,
}

impl Matrices {
    pub(super) fn new(elements: &Elements) -> Self {
        let continuum = &*elements.continuum;
        let mesh = &continuum.mesh;
        let elastic: Vec<Lame> = continuum.materials.iter().map(|m| m.lame()).collect();
        let n_elements = mesh.n_elements();
        let mut offsets = Vec::with_capacity(elements.len() + 1);
        offsets.push(0);
        for e in 0..elements.len() {
            let n = elements.freedoms(e).len();
            offsets.push(offsets[e] + n * (n + 1) / 2);
        }
        let mut values = vec![0.0; offsets[elements.len()]];
        values[offsets[n_elements]..].copy_from_slice(&elements.springs);
        let mut blocks: Vec<&mut [f64]> = Vec::with_capacity(n_elements);
        let mut rest = values.as_mut_slice();
        for e in 0..n_elements {
            let (block, tail) = rest.split_at_mut(offsets[e + 1] - offsets[e]);
            blocks.push(block);
            rest = tail;
        }
        let blocks = blocks.into_par_iter().enumerate().with_min_len(256);
        with_kernel!(continuum.kind, continuum.formulation, mesh, kernel => {
            blocks.for_each(|(e, block)| {
                let elastic = &elastic[mesh.element_body[e] as usize];
                let gradients = continuum.gradients(&kernel, e);
                let Some(sums) = elements.sums.get(&e) else {
                    return gradients.stiffness_into(elastic, block);
                };
                let n = mesh.dimension * mesh.shapes[e].n_nodes();
                let mut own = vec![0.0; n * (n + 1) / 2];
                gradients.stiffness_into(elastic, &mut own);
                sums.stiffness(n, &own, block);
            })
        });
        Matrices { offsets, values }
    }

    /// Packed stiffness matrix of an element.
    pub(super) fn of(&self, element: usize) -> &[f64] {
        &self.values[self.offsets[element]..self.offsets[element + 1]]
    }
}
