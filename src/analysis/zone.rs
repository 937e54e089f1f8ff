//! The elements that may yield: strains, flow rule and initial loads.
//!
//! ```text
//! eps = B u,   J = sum_g w_g B' D eps_p(eps),   dJ = sum_g w_g B' (D - D_ep) B du
//! ```
//!
//! `J` are the paper's initial loads (4.1); the plastic strains depend on the committed history and on the
//! total strain at the end of the increment only, so within an increment they are a function of
//! `u`.

mod yielding;

pub(super) use yielding::Yielding;

use super::gather::{GatheredElements, Nodal, Places};
use crate::element::{Components, PlaneGradients};
use crate::material::{Lame, Material, PlasticState, Softening};
use crate::model::Model;
use crate::shape::MAX_NODES;
use crate::substructure::Trailing;
use rayon::prelude::*;

/// Elements that a thread takes at a time.
const GRAIN: usize = 128;

/// Result of evaluating the material over the zone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evaluation {
    /// Gauss points that flow in this increment.
    pub flowing: usize,
    /// Guard elements in which a point flows.
    pub guard_flows: usize,
}

/// The plastic zone with its history. Arrays over points give every element the same number of
/// places (`stride`), so that they are cut by element without a list.
pub struct Zone {
    elements: GatheredElements,
    gradients: Vec<PlaneGradients>,
    /// Elements in which flow means that the zone is too small.
    guard: Vec<bool>,
    stride: usize,
    materials: Vec<(Material, Lame)>,
    committed: Vec<PlasticState>,
    /// Equal to `committed` except where `flows`.
    trial: Vec<PlasticState>,
    /// `D - D_ep` at the last evaluated state; zero except where `flows`.
    softening: Vec<Softening>,
    /// Points that flowed at the last evaluated state.
    flows: Vec<bool>,
    /// Flowing points of each element at the last evaluated state.
    flowing: Vec<u8>,
    /// Elements with a flowing point, ascending.
    active: Vec<u32>,
    forces: Vec<[[f64; 2]; MAX_NODES]>,
    /// Initial loads of the committed plastic strains: what flows adds to them.
    base: Trailing,
    nodal: Nodal,
    sums: Nodal,
}

impl Zone {
    /// Sets up the zone of the given elements (ascending); `guard` says which of them only watch.
    /// The free freedoms of the elements must be zone or contact freedoms.
    pub fn new(model: &Model, elements: &[usize], guard: &[bool], places: &Places) -> Self {
        let gradients = elements.iter().map(|&e| model.gradients(e)).collect();
        let elements = GatheredElements::new(model, elements, places);
        let n = elements.list.len();
        // That of the mesh, not of these elements: histories pass from zone to zone.
        let shapes = model.mesh.shapes.iter();
        let stride = shapes.map(|s| s.n_gauss_points()).max().unwrap_or(1);
        let (n_zone, n_contact) = places.sizes();
        Zone {
            forces: vec![[[0.0; 2]; MAX_NODES]; n],
            elements,
            gradients,
            guard: guard.to_vec(),
            stride,
            materials: model
                .materials
                .iter()
                .map(|m| (m.clone(), m.lame()))
                .collect(),
            committed: vec![PlasticState::default(); n * stride],
            trial: vec![PlasticState::default(); n * stride],
            softening: vec![Softening::NONE; n * stride],
            flows: vec![false; n * stride],
            flowing: vec![0; n],
            active: Vec::new(),
            base: Trailing::zeros(n_zone, n_contact),
            nodal: Nodal::new(model, places),
            sums: Nodal::new(model, places),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        (self.elements.bytes()
            + self.gradients.capacity() * size_of::<PlaneGradients>()
            + self.forces.capacity() * size_of::<[[f64; 2]; MAX_NODES]>()
            + self.committed.capacity() * 2 * size_of::<PlasticState>()
            + self.softening.capacity() * size_of::<Softening>()) as u64
    }

    /// Load factors that scale the prescribed displacements from now on.
    pub fn set_factors(&mut self, factors: &[f64]) {
        self.nodal.set_factors(factors);
    }

    /// Integrates the flow rule for displacements `u` and adds up the initial loads: those of the
    /// committed plastic strains, plus what the points that flow add.
    pub fn evaluate(&mut self, u: &Trailing, initial_load: &mut Trailing) -> Evaluation {
        let nodal = self.nodal.displacements(u);
        let (elements, materials, stride) = (&self.elements, &self.materials, self.stride);
        (
            &self.gradients,
            &mut self.flowing,
            &mut self.forces,
            self.trial.par_chunks_mut(stride),
            self.softening.par_chunks_mut(stride),
            self.flows.par_chunks_mut(stride),
            self.committed.par_chunks(stride),
        )
            .into_par_iter()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(
                |(i, (gradients, flowing, force, trial, softening, flows, committed))| {
                    let packed = &elements.list[i];
                    let (material, law) = &materials[packed.body as usize];
                    let strains = gradients.strains(&elements.displacements(i, nodal));
                    let mut added = Components::default();
                    *flowing = 0;
                    for g in 0..gradients.n_points() {
                        let (strain, old) = (&at_point(&strains, g), &committed[g]);
                        // Most points are elastic: nothing is stored for them.
                        if material.stays_elastic(law, strain, old) {
                            if flows[g] {
                                flows[g] = false;
                                trial[g] = *old;
                                softening[g] = Softening::NONE;
                            }
                            continue;
                        }
                        let update = material.integrate(law, strain, old);
                        trial[g] = update.state;
                        softening[g] = update.softening;
                        flows[g] = true;
                        *flowing += 1;
                        let change =
                            std::array::from_fn(|k| update.state.strain[k] - old.strain[k]);
                        put(&mut added, g, law.times(&change));
                    }
                    if *flowing > 0 {
                        *force = gradients.forces(&added);
                    }
                },
            );
        let mut result = Evaluation::default();
        self.active.clear();
        let sums = self.sums.start_sum(Some(&self.base));
        for (i, &flowing) in self.flowing.iter().enumerate() {
            if flowing > 0 {
                result.flowing += flowing as usize;
                self.active.push(i as u32);
                result.guard_flows += usize::from(self.guard[i]);
                self.elements.scatter(i, &self.forces[i], sums);
            }
        }
        self.sums.sum_into(initial_load);
        result
    }

    /// `out = sum_g w_g B' (D - D_ep) B v` at the last evaluated state, for a `v` that vanishes where displacements are
    /// prescribed.
    pub fn softening_times(&mut self, v: &Trailing, out: &mut Trailing) {
        let nodal = self.nodal.variation(v);
        let (elements, gradients) = (&self.elements, &self.gradients);
        let (softening, stride) = (&self.softening, self.stride);
        self.active
            .par_iter()
            .zip(&mut self.forces[..self.active.len()])
            .with_min_len(GRAIN)
            .for_each(|(&i, force)| {
                let i = i as usize;
                let gradients = &gradients[i];
                let strains = gradients.strains(&elements.displacements(i, nodal));
                let mut stress = Components::default();
                let points = &softening[i * stride..][..gradients.n_points()];
                for (g, lost) in points.iter().enumerate() {
                    put(&mut stress, g, lost.times(&at_point(&strains, g)));
                }
                *force = gradients.forces(&stress);
            });
        let sums = self.sums.start_sum(None);
        for (&i, force) in self.active.iter().zip(&self.forces) {
            self.elements.scatter(i as usize, force, sums);
        }
        self.sums.sum_into(out);
    }

    /// Marks the zone freedoms of elements in which a point flowed at the last evaluated state.
    pub fn mark_active(&self, marks: &mut [bool]) {
        for &i in &self.active {
            self.elements.mark(i as usize, marks);
        }
    }

    /// True where no point flowed at the last evaluated state.
    pub fn is_idle(&self) -> bool {
        self.active.is_empty()
    }

    /// Forgets which points flow, so that the next tangent is elastic.
    pub fn assume_elastic(&mut self) {
        self.active.clear();
    }

    /// Makes the last evaluated state the history.
    pub fn commit(&mut self) {
        if !self.active.is_empty() {
            for &i in &self.active {
                let points = self.points_of(i as usize);
                self.committed[points.clone()].copy_from_slice(&self.trial[points]);
            }
            self.renew_base();
        }
    }

    /// Number of places for points that so many elements take.
    pub fn n_points(&self, elements: &[usize]) -> usize {
        elements.len() * self.stride
    }

    /// The history, point by point.
    pub fn history(&self) -> &[PlasticState] {
        &self.committed
    }

    /// Puts a history back.
    pub fn restore(&mut self, history: &[PlasticState]) {
        self.committed.copy_from_slice(history);
        self.trial.copy_from_slice(history);
        self.renew_base();
    }

    /// Puts the history of a zone of other elements (ascending) back; elements that were not in it
    /// have none.
    pub fn restore_of(&mut self, elements: &[usize], history: &[PlasticState]) {
        for (i, packed) in self.elements.list.iter().enumerate() {
            let states = &mut self.committed[i * self.stride..][..self.stride];
            match elements.binary_search(&(packed.element as usize)) {
                Ok(j) => states.copy_from_slice(&history[j * self.stride..][..self.stride]),
                Err(_) => states.fill(PlasticState::default()),
            }
        }
        self.trial.copy_from_slice(&self.committed);
        self.flows.fill(false);
        self.softening.fill(Softening::NONE);
        self.active.clear();
        self.renew_base();
    }

    /// Initial loads of the committed plastic strains.
    pub fn initial_load(&self, mut out: Trailing) -> Trailing {
        out.copy_from(&self.base);
        out
    }

    fn renew_base(&mut self) {
        let (elements, materials, committed) = (&self.elements, &self.materials, &self.committed);
        let stride = self.stride;
        let sums = self.sums.start_sum(None);
        for (i, (packed, gradients)) in elements.list.iter().zip(&self.gradients).enumerate() {
            let states = &committed[i * stride..][..gradients.n_points()];
            if states.iter().all(|state| state.equivalent == 0.0) {
                continue;
            }
            let law = &materials[packed.body as usize].1;
            let mut stress = Components::default();
            for (g, state) in states.iter().enumerate() {
                put(&mut stress, g, law.times(&state.strain));
            }
            elements.scatter(i, &gradients.forces(&stress), sums);
        }
        self.sums.sum_into(&mut self.base);
    }

    /// History of the zone's element `i`.
    pub fn states(&self, i: usize) -> &[PlasticState] {
        &self.committed[self.points_of(i)]
    }

    fn points_of(&self, i: usize) -> std::ops::Range<usize> {
        let first = i * self.stride;
        first..first + self.gradients[i].n_points()
    }

    /// Gauss points with plastic strain and the largest equivalent plastic strain.
    pub fn extent(&self) -> (usize, f64) {
        self.committed.iter().fold((0, 0.0), |(n, largest), state| {
            (
                n + usize::from(state.equivalent > 0.0),
                f64::max(largest, state.equivalent),
            )
        })
    }
}

/// The components at a point.
#[inline]
fn at_point(components: &Components, g: usize) -> [f64; 4] {
    components.each_ref().map(|lanes| lanes[g])
}

#[inline]
fn put(components: &mut Components, g: usize, values: [f64; 4]) {
    for (lanes, value) in components.iter_mut().zip(values) {
        lanes[g] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    const TEXT: &str = r#"
title = "block"
kind = "plane_strain"
[[mesh.parts]]
body = "block"
block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [3, 2] }
[materials.metal]
youngs_modulus = 1000.0
poissons_ratio = 0.3
yield_stress = 10.0
plastic_modulus = 50.0
[bodies.block]
material = "metal"
[[load]]
on = "block.top"
pressure = 1.0
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
targets = [{ load_factor = 1.0 }]
"#;

    struct Case {
        model: Model,
        elements: Vec<usize>,
        places: Places,
    }

    impl Case {
        fn new() -> Self {
            let model = Model::new(&Scene::parse(TEXT, "test").unwrap()).unwrap();
            let n = model.freedoms.n;
            Case {
                elements: (0..model.mesh.n_elements()).collect(),
                places: Places::new(n, &(0..n).collect::<Vec<_>>(), &[]),
                model,
            }
        }

        fn zone(&self) -> Zone {
            let guard = vec![false; self.elements.len()];
            Zone::new(&self.model, &self.elements, &guard, &self.places)
        }

        /// Displacements `u_y = strain x y`: beyond yield on the right, elastic on the left.
        fn bent(&self, strain: f64) -> Trailing {
            let mut u = Trailing::zeros(self.model.freedoms.n, 0);
            for (node, slots) in self.model.freedoms.slots.iter().enumerate() {
                if let crate::model::Slot::Free(f) = slots[1] {
                    let [x, y] = self.model.mesh.point(node);
                    u.zone[f as usize] = strain * x * y;
                }
            }
            u
        }

        fn flow(&self, zone: &mut Zone, strain: f64) -> Evaluation {
            let mut load = Trailing::zeros(self.model.freedoms.n, 0);
            let evaluation = zone.evaluate(&self.bent(strain), &mut load);
            zone.commit();
            evaluation
        }
    }

    /// What a zone goes back to knows nothing of what it went through since: what flows next is
    /// what flows in a new one.
    #[test]
    fn a_restored_history_is_all_there_is() {
        let case = Case::new();
        let mut zone = case.zone();
        let virgin = zone.history().to_vec();
        assert!(case.flow(&mut zone, 0.3).flowing > 0);
        // Elastic from there: nothing flows any more, and the last flow is history.
        assert_eq!(case.flow(&mut zone, 0.29).flowing, 0);
        zone.restore(&virgin);
        assert_eq!(zone.extent(), (0, 0.0));
        let mut fresh = case.zone();
        let flowing = case.flow(&mut zone, 0.03);
        assert_eq!(flowing, case.flow(&mut fresh, 0.03));
        // In a part of an element's points, so that the others show what they remember.
        let points = fresh.history().chunks(fresh.stride);
        let partly = |states: &[PlasticState]| {
            let flowed = states.iter().filter(|s| s.equivalent > 0.0).count();
            flowed > 0 && flowed < states.len()
        };
        assert!(points.clone().any(partly));
        assert_eq!(zone.history(), fresh.history());
    }

    /// The history of a smaller zone: the elements that were not in it have none, whatever they
    /// have gone through since.
    #[test]
    fn elements_outside_a_restored_zone_have_no_history() {
        let case = Case::new();
        let mut zone = case.zone();
        case.flow(&mut zone, 0.3);
        let stride = zone.stride;
        // Of the second element of two, the first being elastic then.
        let mut small = vec![PlasticState::default(); 2 * stride];
        small[stride..].copy_from_slice(&zone.history()[4 * stride..5 * stride]);
        zone.restore_of(&[1, 4], &small);
        let mut expected = vec![PlasticState::default(); zone.history().len()];
        expected[4 * stride..5 * stride].copy_from_slice(&small[stride..]);
        assert!(expected.iter().any(|s| s.equivalent > 0.0));
        assert_eq!(zone.history(), expected);
        zone.restore_of(&[], &[]);
        let base = zone.initial_load(Trailing::zeros(case.model.freedoms.n, 0));
        assert_eq!((zone.extent(), base.largest()), ((0, 0.0), 0.0));
    }
}
