//! What the stresses of all elements amount to: the forces that they exert on the nodes, and what
//! has yielded.

use super::stress_field::{OfStresses, StressField};
use crate::model::{Model, Pair, Slot};
use crate::space::{Vector, difference, dot};
use rayon::prelude::*;

/// Elements that are evaluated before their forces are summed: few enough to stay in the
/// processor's cache.
const BLOCK: usize = 2048;
/// Elements that a thread takes at a time.
const GRAIN: usize = 128;
/// Share by which a stress must be beyond yield to count: the accuracy of the equilibrium
/// iteration.
const BEYOND: f64 = 1e-8;

/// Sums and largest values over all elements.
pub(super) struct Stresses {
    /// Internal forces on the free freedoms.
    pub(super) internal: Vec<f64>,
    /// Those on nodes (control points) in global axes.
    pub(super) nodal: Vec<Vector>,
    /// Internal force on each prescribed displacement.
    pub(super) reactions: Vec<f64>,
    /// Elements that may yield, are not in the zone and carry more than the yield stress.
    pub(super) beyond_yield_outside: Vec<usize>,
    /// Gauss points that have yielded, by body.
    pub(super) plastic_points: Vec<usize>,
    /// Volume of the Gauss points that have yielded.
    pub(super) plastic_volume: f64,
    /// Work on their plastic strains.
    pub(super) plastic_work: f64,
    /// Largest distance of such a point below a contact surface, along the normal there.
    pub(super) plastic_depth: f64,
    /// Largest equivalent plastic strain.
    pub(super) plastic_strain: f64,
}

/// Asks for the [`Stresses`] of a field.
pub(super) struct AllStresses;

impl OfStresses for AllStresses {
    type Answer = Stresses;

    fn of<const D: usize, const S: usize, const P: usize, const N: usize>(
        self,
        field: &StressField<D, S, P, N>,
    ) -> Stresses {
        Stresses::new(field)
    }
}

/// An element as it comes out of a block.
struct Evaluated<const D: usize, const N: usize> {
    forces: [[f64; D]; N],
    beyond_yield_outside: bool,
}

impl Stresses {
    /// Evaluates all elements. Sums run in ascending element order: the bits do not depend on the
    /// number of threads.
    pub(super) fn new<const D: usize, const S: usize, const P: usize, const N: usize>(
        field: &StressField<D, S, P, N>,
    ) -> Self {
        let (mut forces, beyond_yield_outside) = nodal_forces(field);
        let model = field.model;
        let mut out = Stresses {
            internal: vec![0.0; model.freedoms.n],
            nodal: Vec::new(),
            reactions: vec![0.0; model.freedoms.prescribed.len()],
            beyond_yield_outside,
            plastic_points: vec![0; model.mesh.bodies.len()],
            plastic_volume: 0.0,
            plastic_work: 0.0,
            plastic_depth: 0.0,
            plastic_strain: 0.0,
        };
        for (node, force) in forces.iter().enumerate() {
            model.freedoms.each_term(node, |slot, v| match slot {
                Slot::Free(f) => out.internal[f as usize] += dot(v, *force),
                Slot::Prescribed(p) => out.reactions[p as usize] += dot(v, *force),
                Slot::Fixed | Slot::Sum(_) => {}
            });
        }
        model.freedoms.basis.share(&mut forces);
        out.nodal = forces;
        // What free strains would take to be held enters with the loads: the same forces here.
        for (load, factor) in model.loads.iter().zip(&field.factors) {
            if !load.free_strain.is_empty() {
                for &(freedom, force) in &load.forces {
                    out.internal[freedom] += factor * force;
                }
            }
        }
        for (e, place) in field.yielded() {
            let history = field.zone.states(place);
            let gradients = field.model.gradients(&field.kernel, e);
            let body = model.mesh.element_body[e] as usize;
            let surface = nearest_pair(model, e);
            let places = gradients.positions(&model.mesh.element_coordinates(e));
            for (g, (past, weight)) in history.iter().zip(gradients.weights()).enumerate() {
                if past.equivalent > 0.0 {
                    if let Some((foot, normal)) = surface {
                        let along = (0..D).map(|d| (places[d][g] - foot[d]) * normal[d]);
                        let depth = along.fold(0.0, |sum, part| sum + part).abs();
                        out.plastic_depth = out.plastic_depth.max(depth);
                    }
                    out.plastic_points[body] += 1;
                    out.plastic_volume += weight;
                    out.plastic_work += weight * field.zone.plastic_work(place, g);
                    out.plastic_strain = out.plastic_strain.max(past.equivalent);
                }
            }
        }
        out
    }
}

/// Place and normal of the pair of contact nearest to an element's first node.
fn nearest_pair(model: &Model, element: usize) -> Option<(Vector, Vector)> {
    let x = model.mesh.point(model.mesh.nodes(element)[0] as usize);
    let off = |pair: &Pair| {
        let way = difference(model.mesh.point(pair.slave), x);
        dot(way, way)
    };
    let nearest = model.pairs.iter().map(|pair| (off(pair), pair));
    let (_, pair) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((model.mesh.point(pair.slave), pair.normal))
}

/// Forces on the nodes in global axes, and the elements outside the zone that are beyond yield.
/// While the forces of one block are summed the next is evaluated.
fn nodal_forces<const D: usize, const S: usize, const P: usize, const N: usize>(
    field: &StressField<D, S, P, N>,
) -> (Vec<Vector>, Vec<usize>) {
    let mesh = &field.model.mesh;
    let n = mesh.n_elements();
    let limits: Vec<f64> = (field.model.materials.iter().zip(&field.model.may_yield))
        .map(|(material, may_yield)| match may_yield {
            true => material.yield_stress() * (1.0 + BEYOND),
            false => f64::INFINITY,
        })
        .collect();
    let by_depth: Vec<bool> = (field
        .model
        .yield_by_depth
        .iter()
        .zip(&field.model.may_yield))
    .map(|(profile, may_yield)| profile.is_some() && *may_yield)
    .collect();
    let evaluate = |start: usize, block: &mut Vec<Evaluated<D, N>>| {
        (start..(start + BLOCK).min(n))
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|e| {
                let element = field.at(e);
                let body = mesh.element_body[e] as usize;
                let is_beyond = || match by_depth[body] {
                    false => element.von_mises() > limits[body],
                    true => element.yield_ratio(field.model, e) > 1.0 + BEYOND,
                };
                Evaluated {
                    forces: element.gradients.forces(&element.stress),
                    beyond_yield_outside: is_beyond() && field.place_in_zone(e).is_none(),
                }
            })
            .collect_into_vec(block);
    };
    let mut forces = vec![[0.0; 3]; mesh.n_nodes()];
    let mut beyond = Vec::new();
    let (mut block, mut next) = (Vec::with_capacity(BLOCK), Vec::with_capacity(BLOCK));
    evaluate(0, &mut block);
    for start in (0..n).step_by(BLOCK) {
        let mut add = || {
            for (i, element) in block.iter().enumerate() {
                for (force, &node) in element.forces.iter().zip(mesh.nodes(start + i)) {
                    let sum = &mut forces[node as usize];
                    (0..D).for_each(|d| sum[d] += force[d]);
                }
                if element.beyond_yield_outside {
                    beyond.push(start + i);
                }
            }
        };
        match start + BLOCK {
            following if following < n => {
                rayon::join(add, || evaluate(following, &mut next));
            }
            _ => add(),
        }
        std::mem::swap(&mut block, &mut next);
    }
    (forces, beyond)
}
