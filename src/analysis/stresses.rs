//! Stresses of all elements, and the forces that they exert on the nodes.

use super::zone::Zone;
use crate::assembly::gauss_points_of;
use crate::element::{AtPoints, MAX_FREEDOMS};
use crate::material::{PlasticState, stress, von_mises};
use crate::model::{Model, Slot};
use rayon::prelude::*;

/// Elements that are evaluated before their forces are summed: few enough to stay in the processor's cache.
const BLOCK: usize = 4096;
/// Share by which a stress must be beyond yield to count: the accuracy of the equilibrium iteration.
const BEYOND: f64 = 1e-8;

/// What the stresses of all elements amount to.
pub(super) struct Stresses {
    /// Internal forces on the free freedoms.
    pub(super) internal: Vec<f64>,
    /// Internal force on each prescribed displacement.
    pub(super) reactions: Vec<f64>,
    /// Elements that may yield, are not in the zone and carry more than the yield stress.
    pub(super) beyond_yield_outside: Vec<usize>,
    /// Gauss points that have flowed, by body.
    pub(super) plastic_points: Vec<usize>,
    /// Volume of the Gauss points that have flowed.
    pub(super) plastic_volume: f64,
    /// Largest equivalent plastic strain.
    pub(super) plastic_strain: f64,
    /// The elements one by one, where asked for.
    pub(super) elements: Vec<ElementStress>,
}

/// Stresses of an element.
pub(super) struct ElementStress {
    /// At the Gauss points.
    pub(super) points: AtPoints,
    /// Mean over the element.
    pub(super) mean: [f64; 4],
    /// Largest von Mises stress at a Gauss point.
    pub(super) von_mises: f64,
    /// Largest equivalent plastic strain at a Gauss point.
    pub(super) plastic_strain: f64,
}

/// An element as it comes out of a block.
struct Evaluated {
    force: [f64; MAX_FREEDOMS],
    points: AtPoints,
    mean: [f64; 4],
    von_mises: f64,
    plastic_points: usize,
    plastic_volume: f64,
    plastic_strain: f64,
}

impl Stresses {
    /// Evaluates all elements for nodal displacements in global axes and the committed history of the zone, whose elements are
    /// `in_zone` (ascending). Sums run in ascending element order: the bits do not depend on the number of threads.
    pub(super) fn new(
        model: &Model,
        zone: &Zone,
        in_zone: &[usize],
        displacements: &[[f64; 2]],
        with_elements: bool,
    ) -> Self {
        let mesh = &model.mesh;
        let elastic: Vec<_> = model.materials.iter().map(|m| m.elastic_matrix()).collect();
        let history = |e: usize| {
            in_zone
                .binary_search(&e)
                .map_or(&[][..], |i| zone.states(i))
        };
        let evaluate = |e: usize| {
            let points = gauss_points_of(model, e);
            let mut u = [0.0; MAX_FREEDOMS];
            for (pair, &node) in u.chunks_exact_mut(2).zip(mesh.nodes(e)) {
                pair.copy_from_slice(&displacements[node as usize]);
            }
            let elastic = &elastic[mesh.element_body[e] as usize];
            let past = history(e);
            let mut out = Evaluated {
                force: [0.0; MAX_FREEDOMS],
                points: points.strains(&u),
                mean: [0.0; 4],
                von_mises: 0.0,
                plastic_points: 0,
                plastic_volume: 0.0,
                plastic_strain: 0.0,
            };
            let mut volume = 0.0;
            for (g, weight) in points.weights().enumerate() {
                let past = past.get(g).copied().unwrap_or(PlasticState::default());
                out.points[g] = stress(elastic, &out.points[g], &past.strain);
                volume += weight;
                for (mean, s) in out.mean.iter_mut().zip(&out.points[g]) {
                    *mean += weight * s;
                }
                out.von_mises = out.von_mises.max(von_mises(&out.points[g]));
                out.plastic_strain = out.plastic_strain.max(past.equivalent);
                if past.equivalent > 0.0 {
                    out.plastic_points += 1;
                    out.plastic_volume += weight;
                }
            }
            out.mean = out.mean.map(|sum| sum / volume);
            out.force = points.forces(&out.points);
            out
        };

        let mut out = Stresses {
            internal: vec![0.0; model.freedoms.n],
            reactions: vec![0.0; model.freedoms.prescribed.len()],
            beyond_yield_outside: Vec::new(),
            plastic_points: vec![0; mesh.bodies.len()],
            plastic_volume: 0.0,
            plastic_strain: 0.0,
            elements: Vec::with_capacity(if with_elements { mesh.n_elements() } else { 0 }),
        };
        let mut forces = vec![[0.0; 2]; mesh.n_nodes()];
        let mut block = Vec::with_capacity(BLOCK);
        for start in (0..mesh.n_elements()).step_by(BLOCK) {
            let elements = start..(start + BLOCK).min(mesh.n_elements());
            let evaluated = elements.clone().into_par_iter().with_min_len(128);
            evaluated.map(evaluate).collect_into_vec(&mut block);
            for (e, element) in elements.zip(&block) {
                for (force, &node) in element.force.chunks_exact(2).zip(mesh.nodes(e)) {
                    forces[node as usize][0] += force[0];
                    forces[node as usize][1] += force[1];
                }
                let body = mesh.element_body[e] as usize;
                out.plastic_points[body] += element.plastic_points;
                out.plastic_volume += element.plastic_volume;
                out.plastic_strain = out.plastic_strain.max(element.plastic_strain);
                if model.may_yield[body]
                    && element.von_mises > model.materials[body].yield_stress() * (1.0 + BEYOND)
                    && in_zone.binary_search(&e).is_err()
                {
                    out.beyond_yield_outside.push(e);
                }
                if with_elements {
                    out.elements.push(ElementStress {
                        points: element.points,
                        mean: element.mean,
                        von_mises: element.von_mises,
                        plastic_strain: element.plastic_strain,
                    });
                }
            }
        }
        for (node, force) in forces.iter().enumerate() {
            let force = model.freedoms.to_local(node, *force);
            for (slot, force) in model.freedoms.slots[node].iter().zip(force) {
                match slot {
                    Slot::Free(f) => out.internal[*f as usize] += force,
                    Slot::Prescribed(p) => out.reactions[*p as usize] += force,
                    Slot::Fixed => {}
                }
            }
        }
        out
    }
}
