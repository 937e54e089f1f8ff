//! Sums over the stresses of all elements: the forces that they exert on the nodes, and the extent
//! of yielding.

use super::at_corners::largest_at_corners;
use super::element_stresses::{ElementStresses, ShownStresses};
use crate::analysis::zone::border::{self, Yielded};
use crate::analysis::zone::points::ZoneOf;
use crate::balls::Balls;
use crate::material::PlasticState;
use crate::model::{Model, Slot};
use crate::space::{Vector, dot};

/// Sums and largest values over all elements.
pub(in crate::analysis) struct Stresses {
    /// Internal forces on the free freedoms.
    pub(in crate::analysis) internal: Vec<f64>,
    /// Internal forces on nodes (or control points) in global axes.
    pub(in crate::analysis) nodal: Vec<Vector>,
    /// Internal force on each prescribed displacement.
    pub(in crate::analysis) reactions: Vec<f64>,
    /// Elements that may yield, are not in the zone and carry more than the yield stress.
    pub(in crate::analysis) beyond_yield_outside: Vec<usize>,
    /// Whether an element of the zone carries more than its initial yield stress.
    pub(in crate::analysis) beyond_yield_inside: bool,
    /// Values for the output fields (stresses, plastic strains); `None` if no such fields are asked
    /// for.
    pub(in crate::analysis) shown: Option<ShownStresses>,
    /// Number of Gauss points that have yielded, by body.
    pub(in crate::analysis) plastic_points: Vec<usize>,
    /// Volume of the Gauss points that have yielded.
    pub(in crate::analysis) plastic_volume: f64,
    /// Volume of one layer of points along the border of the yielded zone.
    pub(in crate::analysis) plastic_layer: f64,
    /// Work on the plastic strains of all points.
    pub(in crate::analysis) plastic_work: f64,
    /// Largest distance of a yielded point below a contact surface, along the normal of the nearest
    /// pair.
    pub(in crate::analysis) plastic_depth: f64,
    /// Largest equivalent plastic strain at a Gauss point.
    pub(in crate::analysis) plastic_strain: f64,
    /// Largest equivalent plastic strain at the corner of an element.
    pub(in crate::analysis) corner_strain: f64,
}

impl Stresses {
    /// Sums over the stresses of all elements, at the given load factors. The figures of yielding
    /// are zero until [`Stresses::add_yielded`] is called.
    pub(in crate::analysis) fn new(
        model: &Model,
        of_elements: ElementStresses,
        factors: &[f64],
    ) -> Self {
        let mut forces = of_elements.forces;
        let mut out = Stresses {
            internal: vec![0.0; model.freedoms.n],
            nodal: Vec::new(),
            reactions: vec![0.0; model.freedoms.prescribed.len()],
            beyond_yield_outside: of_elements.beyond_yield_outside,
            beyond_yield_inside: of_elements.beyond_yield_inside,
            shown: of_elements.shown,
            plastic_points: vec![0; model.mesh.bodies.len()],
            plastic_volume: 0.0,
            plastic_layer: 0.0,
            plastic_work: 0.0,
            plastic_depth: 0.0,
            plastic_strain: 0.0,
            corner_strain: 0.0,
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
        // The forces that would suppress free strains enter with the loads: the same forces are
        // added here.
        for (load, factor) in model.loads.iter().zip(factors) {
            if !load.free_strain.is_empty() {
                for &(freedom, force) in &load.forces {
                    out.internal[freedom] += factor * force;
                }
            }
        }
        out
    }

    /// Adds the extent of yielding in a zone of the given elements.
    pub(in crate::analysis) fn add_yielded<
        const D: usize,
        const S: usize,
        const P: usize,
        const N: usize,
    >(
        &mut self,
        model: &Model,
        zone: &ZoneOf<D, S, P, N>,
        elements: &[usize],
    ) {
        let has_yielded = |past: &PlasticState<S>| past.equivalent > 0.0;
        let slaves = model
            .pairs
            .iter()
            .map(|pair| (model.mesh.point(pair.slave), 0.0));
        let slaves = Balls::new(slaves.collect());
        let mut yielded = Vec::new();
        for (place, &e) in elements.iter().enumerate() {
            let history = zone.states(place);
            if !history.iter().any(has_yielded) {
                continue;
            }
            let gradients = zone.gradients(place);
            let body = model.mesh.element_body[e] as usize;
            let surface = nearest_pair(model, &slaves, e);
            let places = gradients.positions(&model.mesh.element_coordinates(e));
            for (g, (past, weight)) in history.iter().zip(gradients.weights()).enumerate() {
                if has_yielded(past) {
                    if let Some((foot, normal)) = surface {
                        let along = (0..D).map(|d| (places[d][g] - foot[d]) * normal[d]);
                        let depth = along.fold(0.0, |sum, part| sum + part).abs();
                        self.plastic_depth = self.plastic_depth.max(depth);
                    }
                    self.plastic_points[body] += 1;
                    self.plastic_volume += weight;
                    self.plastic_work += weight * zone.plastic_work(place, g);
                    self.plastic_strain = self.plastic_strain.max(past.equivalent);
                }
            }
            let (shape, rule) = (model.mesh.shapes[e], model.mesh.rule(e));
            let strains: Vec<f64> = history.iter().map(|past| past.equivalent).collect();
            let at_corners = largest_at_corners(shape, rule, &strains);
            self.corner_strain = self.corner_strain.max(at_corners);
            let volume = gradients.weights().iter().sum();
            let count = history.iter().filter(|past| has_yielded(past)).count();
            yielded.push(Yielded::new(e, volume, D, [count, history.len()]));
        }
        self.plastic_layer = border::layer(model, &yielded);
    }
}

/// Slave node and normal of the contact pair nearest to an element's first node; `slaves` are the
/// slave nodes of all pairs.
fn nearest_pair(model: &Model, slaves: &Balls, element: usize) -> Option<(Vector, Vector)> {
    let x = model.mesh.point(model.mesh.nodes(element)[0] as usize);
    let (_, nearest) = *slaves.nearest_few(x, 1).first()?;
    let pair = &model.pairs[nearest];
    Some((model.mesh.point(pair.slave), pair.normal))
}
