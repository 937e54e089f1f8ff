//! Results from the stresses of elements: forces on their nodes, and the values that fields show.

use super::indicator::RecoveredStresses;
use super::point_values;
use super::stress_field::StressField;
use crate::results::PointValues;
use crate::space::Vector;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Number of elements that are evaluated before their forces are summed: few enough to stay in the
/// processor's cache.
const BLOCK: usize = 2048;
/// Least number of elements that a thread takes at a time.
const GRAIN: usize = 128;
/// Share by which a stress must exceed the yield stress to count as beyond yield: the accuracy of
/// the equilibrium iteration.
const BEYOND: f64 = 1e-8;

/// Results from the stresses of some elements of a mesh.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(in crate::analysis) struct ElementStresses {
    /// Forces on the nodes of the mesh, in global axes.
    pub(in crate::analysis) forces: Vec<Vector>,
    /// Elements that may yield, are not in the zone and carry more than the yield stress.
    pub(in crate::analysis) beyond_yield_outside: Vec<usize>,
    /// Whether an element of the zone carries more than its initial yield stress.
    pub(in crate::analysis) beyond_yield_inside: bool,
    /// Values for the output fields (stresses, plastic strains); `None` if no such fields are asked
    /// for.
    pub(in crate::analysis) shown: Option<ShownStresses>,
}

/// Values for the output fields, one element after the other.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(in crate::analysis) struct ShownStresses {
    /// Mean stress of each element.
    pub(in crate::analysis) stress: Vec<f64>,
    /// The largest von Mises stress at a point of each element.
    pub(in crate::analysis) von_mises: Vec<f64>,
    /// The largest equivalent plastic strain at a point of each element.
    pub(in crate::analysis) plastic_strain: Vec<f64>,
    /// Recovered stresses and energies, from the polynomials around the elements.
    pub(in crate::analysis) recovered: RecoveredStresses,
    /// Values at the integration points, if they are asked for.
    pub(in crate::analysis) points: Option<PointValues>,
}

/// Result for one element of a block.
struct Evaluated<const D: usize, const N: usize> {
    forces: [[f64; D]; N],
    beyond_yield: bool,
}

impl ElementStresses {
    /// Evaluates the given elements (ascending). Sums run in the order of the elements, so the bits
    /// do not depend on the number of threads.
    pub(in crate::analysis) fn new<
        const D: usize,
        const S: usize,
        const P: usize,
        const N: usize,
    >(
        field: &StressField<D, S, P, N>,
        elements: &[usize],
        with_fields: bool,
    ) -> Self {
        let (forces, mut beyond_yield) = nodal_forces(field, elements);
        let n_beyond = beyond_yield.len();
        beyond_yield.retain(|&e| field.place_in_zone(e).is_none());
        ElementStresses {
            forces,
            beyond_yield_inside: beyond_yield.len() < n_beyond,
            beyond_yield_outside: beyond_yield,
            shown: with_fields.then(|| ShownStresses::new(field, elements)),
        }
    }

    /// Zero results for a mesh with the given numbers of nodes and elements.
    pub(in crate::analysis) fn zeros(
        n_nodes: usize,
        n_elements: usize,
        shown: Option<usize>,
    ) -> Self {
        ElementStresses {
            forces: vec![[0.0; 3]; n_nodes],
            beyond_yield_outside: Vec::new(),
            beyond_yield_inside: false,
            shown: shown.map(|components| ShownStresses {
                stress: vec![0.0; components * n_elements],
                von_mises: vec![0.0; n_elements],
                plastic_strain: vec![0.0; n_elements],
                recovered: RecoveredStresses {
                    energies: vec![[0.0; 2]; n_elements],
                    at_nodes: vec![0.0; components * n_nodes],
                    n_elements_of: vec![0; n_nodes],
                },
                points: None,
            }),
        }
    }

    /// Adds the results of a part of the mesh. `elements` were evaluated; `nodes` and `all` are the
    /// nodes and elements of the part, in the numbering of the mesh.
    pub(in crate::analysis) fn add(
        &mut self,
        part: ElementStresses,
        (elements, nodes, all): (&[usize], &[u32], &[usize]),
    ) {
        let nodes = || nodes.iter().map(|node| *node as usize);
        for (node, force) in nodes().zip(&part.forces) {
            (0..3).for_each(|d| self.forces[node][d] += force[d]);
        }
        let beyond = part.beyond_yield_outside.into_iter().map(|e| all[e]);
        self.beyond_yield_outside.extend(beyond);
        self.beyond_yield_inside |= part.beyond_yield_inside;
        let (Some(shown), Some(part)) = (&mut self.shown, part.shown) else {
            return;
        };
        let n_components = shown.stress.len() / shown.von_mises.len().max(1);
        let stresses = part.stress.chunks_exact(n_components);
        for (i, (&e, stress)) in elements.iter().zip(stresses).enumerate() {
            shown.stress[n_components * e..][..n_components].copy_from_slice(stress);
            shown.von_mises[e] = part.von_mises[i];
            shown.plastic_strain[e] = part.plastic_strain[i];
            shown.recovered.energies[e] = part.recovered.energies[i];
        }
        if let Some((points, of_part)) = shown.points.as_mut().zip(part.points) {
            points.put(elements, &of_part);
        }
        let stresses = part.recovered.at_nodes.chunks_exact(n_components);
        for ((node, stress), n) in nodes().zip(stresses).zip(part.recovered.n_elements_of) {
            shown.recovered.n_elements_of[node] += n;
            let sums = &mut shown.recovered.at_nodes[n_components * node..][..n_components];
            sums.iter_mut().zip(stress).for_each(|(sum, s)| *sum += s);
        }
    }
}

impl ShownStresses {
    fn new<const D: usize, const S: usize, const P: usize, const N: usize>(
        field: &StressField<D, S, P, N>,
        elements: &[usize],
    ) -> Self {
        let n = elements.len();
        let mut out = ShownStresses {
            stress: vec![0.0; S * n],
            von_mises: vec![0.0; n],
            plastic_strain: vec![0.0; n],
            recovered: RecoveredStresses::new(field, elements),
            points: (field.continuum.point_values).then(|| point_values::of(field, elements)),
        };
        let of_elements = (
            elements,
            out.stress.par_chunks_exact_mut(S),
            &mut out.von_mises,
            &mut out.plastic_strain,
        );
        let of_elements = of_elements.into_par_iter().with_min_len(256);
        of_elements.for_each(|(&e, stress, von_mises, plastic_strain)| {
            let element = field.at(e);
            stress.copy_from_slice(&element.gradients.mean(&element.stress));
            *von_mises = element.von_mises();
            *plastic_strain = element.plastic_strain();
        });
        out
    }
}

/// Returns forces on the nodes in global axes, and the elements that are beyond their initial yield
/// stress. While the forces of one block are summed, the next block is evaluated.
fn nodal_forces<const D: usize, const S: usize, const P: usize, const N: usize>(
    field: &StressField<D, S, P, N>,
    elements: &[usize],
) -> (Vec<Vector>, Vec<usize>) {
    let continuum = field.continuum;
    let mesh = &continuum.mesh;
    let limits: Vec<f64> = (continuum.materials.iter().zip(&continuum.may_yield))
        .map(|(material, may_yield)| match may_yield {
            true => material.yield_stress() * (1.0 + BEYOND),
            false => f64::INFINITY,
        })
        .collect();
    let by_depth: Vec<bool> = (continuum.yield_by_depth.iter())
        .zip(&continuum.may_yield)
        .map(|(profile, may_yield)| profile.is_some() && *may_yield)
        .collect();
    let evaluate = |elements: &[usize], block: &mut Vec<Evaluated<D, N>>| {
        let each = elements.par_iter().with_min_len(GRAIN).map(|&e| {
            let element = field.at(e);
            let body = mesh.element_body[e] as usize;
            let is_beyond = || match by_depth[body] {
                false => element.von_mises() > limits[body],
                true => element.yield_ratio(continuum, e) > 1.0 + BEYOND,
            };
            Evaluated {
                forces: element.gradients.forces(&element.stress),
                beyond_yield: is_beyond(),
            }
        });
        each.collect_into_vec(block);
    };
    let mut forces = vec![[0.0; 3]; mesh.n_nodes()];
    let mut beyond = Vec::new();
    let (mut block, mut next) = (Vec::with_capacity(BLOCK), Vec::with_capacity(BLOCK));
    let mut blocks = elements.chunks(BLOCK).peekable();
    if let Some(first) = blocks.peek() {
        evaluate(first, &mut block);
    }
    while let Some(some) = blocks.next() {
        let mut add = || {
            for (&e, element) in some.iter().zip(&block) {
                for (force, &node) in element.forces.iter().zip(mesh.nodes(e)) {
                    let sum = &mut forces[node as usize];
                    (0..D).for_each(|d| sum[d] += force[d]);
                }
                if element.beyond_yield {
                    beyond.push(e);
                }
            }
        };
        match blocks.peek() {
            Some(following) => {
                rayon::join(add, || evaluate(following, &mut next));
            }
            None => add(),
        }
        std::mem::swap(&mut block, &mut next);
    }
    (forces, beyond)
}
