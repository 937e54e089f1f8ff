//! The elements of the zone and the Gauss points at which they may yield.

use super::free_strain::FreeStrains;
use super::gather::{GatheredElements, Nodal, Places};
use super::history::{BackStrains, PathEnds, PointHistory, chunks_or_none};
use super::local_yield;
use super::trial_points::TrialPoints;
use crate::element::{Components, Gradients, Kernel};
use crate::material::{Lame, Material, Past, PlasticState, Softening};
use crate::model::Model;
use crate::substructure::Trailing;
use rayon::prelude::*;

/// Least number of elements that a thread takes at a time.
pub(in crate::analysis) const GRAIN: usize = 128;

/// Counts from one evaluation of the material over the zone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evaluation {
    /// Number of Gauss points that yield in this increment.
    pub yielding: usize,
    /// Number of guard elements in which a point yields.
    pub guard_yields: usize,
}

/// The softening `D - D_ep` of all points at an earlier state, and the elements that have softened.
#[derive(Default)]
pub struct KeptSoftening<const S: usize> {
    pub(in crate::analysis) softening: Vec<Softening<S>>,
    pub(in crate::analysis) active: Vec<u32>,
}

/// The plastic zone with its history. Arrays over points have the same number of places (`stride`)
/// for every element, so that they are split by element without a list of offsets.
pub struct ZoneOf<const D: usize, const S: usize, const P: usize, const N: usize> {
    kernel: Kernel<D, S, P, N>,
    pub(in crate::analysis) elements: GatheredElements,
    pub(in crate::analysis) gradients: Vec<Gradients<D, S, P, N>>,
    /// Marks the guard: elements in which plastic flow means that the zone is too small.
    guard: Vec<bool>,
    pub(in crate::analysis) stride: usize,
    materials: Vec<(Material, Lame)>,
    committed: Vec<PlasticState<S>>,
    /// Strains that the fading back stresses keep from the history.
    back: BackStrains<S>,
    /// Yield stress of each point minus that of its material; empty if no yield stress varies.
    harder: Vec<f64>,
    /// Plastic states at the last evaluated state; equal to `committed` unless the point `yields`.
    trial: Vec<PlasticState<S>>,
    /// Ends of the strain paths to the last evaluated state, for points that have yielded in it.
    path_ends: PathEnds<S>,
    /// Softening `D - D_ep` at the last evaluated state; zero unless the point `yields`.
    pub(in crate::analysis) softening: Vec<Softening<S>>,
    /// Vector `t` of the unsymmetric part `t n'` of the softening, with `n` its normal; empty if no
    /// back stress fades.
    pub(in crate::analysis) turn: Vec<[f64; S]>,
    /// Whether each point yielded at the last evaluated state.
    pub(in crate::analysis) yields: Vec<bool>,
    /// Number of yielding points in each element at the last evaluated state.
    yielding: Vec<u8>,
    /// Elements with a point that yielded at the last evaluated state, ascending.
    pub(in crate::analysis) active: Vec<u32>,
    /// The tangent of an earlier state, if one is kept.
    pub(in crate::analysis) kept: Option<KeptSoftening<S>>,
    pub(in crate::analysis) forces: Vec<[[f64; D]; N]>,
    /// Free strains of the loads, at the points.
    free: FreeStrains<P>,
    /// Factor of each load.
    factors: Vec<f64>,
    /// Initial loads of the committed plastic strains, to which further yielding adds.
    base: Trailing,
    /// Initial loads of the committed plastic strains on the prescribed freedoms.
    base_on_prescribed: Vec<f64>,
    /// Displacements and load factors of the committed history: where the strain paths of an
    /// increment begin. `None` until they are known: the flow rule is then integrated in a single
    /// step.
    begin: Option<Begin>,
    pub(in crate::analysis) nodal: Nodal,
    pub(in crate::analysis) sums: Nodal,
}

/// Displacements and load factors at which the strain paths of an increment begin.
struct Begin {
    nodal: Nodal,
    factors: Vec<f64>,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> ZoneOf<D, S, P, N> {
    /// Sets up the zone of the given elements (ascending). `guard` marks the elements that are in
    /// the zone only to show when yielding reaches them. The free freedoms of the elements must be
    /// zone or contact freedoms.
    pub fn new(
        kernel: &Kernel<D, S, P, N>,
        model: &Model,
        elements: &[usize],
        guard: &[bool],
        places: &Places,
    ) -> Self {
        let gradients: Vec<Gradients<D, S, P, N>> = (elements.iter())
            .map(|&e| model.gradients(kernel, e))
            .collect();
        let free = FreeStrains::new(model, elements, |i, nodal| gradients[i].at_points(nodal));
        let yield_stresses = |i: usize| {
            let places = gradients[i].positions(&model.mesh.element_coordinates(elements[i]));
            local_yield::at_places(model, elements[i], &places, gradients[i].n_points())
        };
        let elements_of_mesh = elements;
        let elements = GatheredElements::new(model, elements, places);
        let n = elements.list.len();
        // The stride is that of the whole mesh, since histories pass from zone to zone.
        let stride = model.mesh.most_points();
        let mut harder = Vec::new();
        if model.yield_by_depth.iter().any(Option::is_some) {
            harder.resize(n * stride, 0.0);
            for (i, own) in harder.chunks_mut(stride).enumerate() {
                let usual = model.material(elements_of_mesh[i]).yield_stress();
                let stresses = yield_stresses(i).into_iter().flatten();
                own.iter_mut()
                    .zip(stresses)
                    .for_each(|(own, y)| *own = y - usual);
            }
        }
        let (n_zone, n_contact) = places.sizes();
        let fading = model.materials.iter().map(|m| m.back_stresses.n_stored());
        let fading = fading.max().unwrap_or(0);
        let back = BackStrains::new(fading, n * stride);
        ZoneOf {
            kernel: *kernel,
            turn: vec![[0.0; S]; if back.is_none() { 0 } else { n * stride }],
            harder,
            forces: vec![[[0.0; D]; N]; n],
            free,
            factors: vec![0.0; model.loads.len()],
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
            path_ends: PathEnds::new(fading, n * stride),
            softening: vec![Softening::NONE; n * stride],
            yields: vec![false; n * stride],
            yielding: vec![0; n],
            active: Vec::new(),
            kept: None,
            base: Trailing::zeros(n_zone, n_contact),
            base_on_prescribed: vec![0.0; model.freedoms.prescribed.len()],
            back,
            begin: None,
            nodal: Nodal::new(model, places),
            sums: Nodal::new(model, places),
        }
    }

    /// Bytes of heap held.
    pub fn bytes(&self) -> u64 {
        (self.elements.bytes()
            + self.free.bytes()
            + self.gradients.capacity() * size_of::<Gradients<D, S, P, N>>()
            + self.forces.capacity() * size_of::<[[f64; D]; N]>()
            + self.committed.capacity() * 2 * size_of::<PlasticState<S>>()
            + self.back.bytes()
            + self.path_ends.bytes()
            + self.harder.capacity() * size_of::<f64>()
            + self.turn.capacity() * size_of::<[f64; S]>()
            + self.softening.capacity() * size_of::<Softening<S>>()) as u64
    }

    /// Sets the load factors that scale prescribed displacements and free strains from now on.
    pub fn set_factors(&mut self, factors: &[f64]) {
        self.nodal.set_factors(factors);
        self.factors.copy_from_slice(factors);
    }

    /// Sets the displacements and load factors that the history belongs to. In the evaluations that
    /// follow, straight strain paths lead from there to the new strains.
    pub fn begin_at(&mut self, u: &Trailing, factors: &[f64]) {
        let begin = self.begin.get_or_insert_with(|| Begin {
            nodal: self.nodal.clone(),
            factors: factors.to_vec(),
        });
        begin.nodal.set_factors(factors);
        begin.nodal.displacements(u);
        begin.factors.copy_from_slice(factors);
    }

    /// Integrates the flow rule for displacements `u` and sums the initial loads: the loads of the
    /// committed plastic strains, plus the loads of the plastic strains added in the increment.
    pub fn evaluate(&mut self, u: &Trailing, initial_load: &mut Trailing) -> Evaluation {
        let nodal = self.nodal.displacements(u);
        let (elements, materials, stride) = (&self.elements, &self.materials, self.stride);
        let (free, factors) = (&self.free, &self.factors);
        let (back, harder, begin) = (&self.back, &self.harder, &self.begin);
        let n = elements.list.len();
        let points = (
            self.yields.par_chunks_mut(stride),
            self.trial.par_chunks_mut(stride),
            self.softening.par_chunks_mut(stride),
            chunks_or_none(&mut self.turn, stride, n),
            self.path_ends.par_chunks_mut(stride, n),
        )
            .into_par_iter()
            .map(|(yields, states, softening, turn, path_ends)| TrialPoints {
                yields,
                states,
                softening,
                turn,
                path_ends,
            });
        (
            &self.gradients,
            &mut self.yielding,
            &mut self.forces,
            points,
            self.committed.par_chunks(stride),
        )
            .into_par_iter()
            .enumerate()
            .with_min_len(GRAIN)
            .for_each(|(i, (gradients, yielding, force, mut points, committed))| {
                let packed = &elements.list[i];
                let (material, law) = &materials[packed.body as usize];
                let strains_at = |nodal: &[f64], factors: &[f64]| {
                    let mut strains = gradients.strains(&elements.displacements(i, nodal));
                    free.take_off(i, factors, &mut strains);
                    strains
                };
                let strains = strains_at(nodal, factors);
                // The strains at the start of the path are computed only if a point of the element
                // yields.
                let mut begins = None;
                let mut added = [[0.0; P]; S];
                *yielding = 0;
                for g in 0..gradients.n_points() {
                    let strain = &at_point(&strains, g);
                    let past = Past {
                        state: &committed[g],
                        back: back.of(i * stride + g),
                        harder: harder.get(i * stride + g).copied().unwrap_or(0.0),
                    };
                    if material.stays_elastic(law, strain, &past) {
                        points.stay_elastic(g, past.state);
                        continue;
                    }
                    if let (None, Some(begin)) = (&begins, begin) {
                        begins = Some(strains_at(begin.nodal.values(), &begin.factors));
                    }
                    let begin = begins.as_ref().map(|begins| at_point(begins, g));
                    let path = (begin.as_ref(), strain);
                    let change = points.integrate(g, (material, law), path, &past);
                    *yielding += 1;
                    put(&mut added, g, law.times(&change));
                }
                if *yielding > 0 {
                    *force = gradients.forces(&added);
                }
            });
        self.sum_forces(initial_load)
    }

    /// Sums the forces of the elements that yield to the initial loads of the committed plastic
    /// strains, and counts what yields.
    fn sum_forces(&mut self, initial_load: &mut Trailing) -> Evaluation {
        let mut result = Evaluation::default();
        self.active.clear();
        let sums = self.sums.start_sum(Some(&self.base));
        for (i, &yielding) in self.yielding.iter().enumerate() {
            if yielding > 0 {
                result.yielding += yielding as usize;
                self.active.push(i as u32);
                result.guard_yields += usize::from(self.guard[i]);
                self.elements.scatter(i, &self.forces[i], sums);
            }
        }
        self.sums.sum_into(initial_load);
        result
    }

    /// Whether the tangent is symmetric, as it is unless a back stress fades.
    pub fn is_symmetric(&self) -> bool {
        self.turn.is_empty()
    }

    /// Marks the zone freedoms of elements in which a point yielded at the last evaluated state.
    pub fn mark_active(&self, marks: &mut [bool]) {
        for &i in &self.active {
            self.elements.mark(i as usize, marks);
        }
    }

    /// Whether no point yielded at the last evaluated state.
    pub fn is_idle(&self) -> bool {
        self.active.is_empty()
    }

    /// Forgets which points yield, so that the next tangent is elastic.
    pub fn assume_elastic(&mut self) {
        self.active.clear();
    }

    /// Makes the last evaluated state the committed history.
    pub fn commit(&mut self) {
        self.begin = None;
        if !self.active.is_empty() {
            for &i in &self.active {
                let points = self.points_of(i as usize);
                self.committed[points.clone()].copy_from_slice(&self.trial[points.clone()]);
                for point in points.filter(|&point| self.yields[point]) {
                    self.back.take(point, &self.path_ends);
                }
            }
            self.renew_base();
        }
    }

    /// Number of places for points that the given elements take up in a history.
    pub fn n_points(&self, elements: &[usize]) -> usize {
        elements.len() * self.stride
    }

    /// The committed history, point by point.
    pub fn history(&self) -> PointHistory {
        PointHistory {
            points: self.committed.iter().map(PlasticState::resized).collect(),
            back: self.back.resized(),
        }
    }

    /// Restores a history of the same zone.
    pub fn restore(&mut self, history: &PointHistory) {
        self.begin = None;
        self.put(0..self.committed.len(), history, 0);
        self.trial.copy_from_slice(&self.committed);
        self.renew_base();
    }

    /// Restores the history of a zone of other elements (ascending). Elements outside that zone
    /// have no history.
    pub fn restore_of(&mut self, elements: &[usize], history: &PointHistory) {
        self.begin = None;
        for i in 0..self.elements.list.len() {
            let points = i * self.stride..(i + 1) * self.stride;
            let element = self.elements.list[i].element as usize;
            match elements.binary_search(&element) {
                Ok(j) => self.put(points, history, j * self.stride),
                Err(_) => {
                    self.committed[points.clone()].fill(PlasticState::default());
                    self.back.clear(points);
                }
            }
        }
        self.trial.copy_from_slice(&self.committed);
        self.yields.fill(false);
        self.softening.fill(Softening::NONE);
        self.active.clear();
        self.renew_base();
    }

    /// Overwrites the history of some points with a history from its point `from` on.
    fn put(&mut self, points: std::ops::Range<usize>, history: &PointHistory, from: usize) {
        let known = &history.points[from..][..points.len()];
        for (state, known) in self.committed[points.clone()].iter_mut().zip(known) {
            *state = known.resized();
        }
        self.back.put(points, &history.back, from);
    }

    /// Initial loads of the committed plastic strains on the prescribed freedoms.
    pub fn on_prescribed(&self) -> &[f64] {
        &self.base_on_prescribed
    }

    /// Initial loads of the committed plastic strains on zone and contact freedoms.
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
            let mut stress = [[0.0; P]; S];
            for (g, state) in states.iter().enumerate() {
                put(&mut stress, g, law.times(&state.strain));
            }
            elements.scatter(i, &gradients.forces(&stress), sums);
        }
        self.sums.sum_into(&mut self.base);
        self.base_on_prescribed
            .copy_from_slice(self.sums.on_prescribed());
    }

    /// Plastic work at a point of the zone's element `i`, per volume.
    pub fn plastic_work(&self, i: usize, point: usize) -> f64 {
        let place = i * self.stride + point;
        let material = &self.materials[self.elements.list[i].body as usize].0;
        let past = Past {
            state: &self.committed[place],
            back: self.back.of(place),
            harder: self.harder.get(place).copied().unwrap_or(0.0),
        };
        material.plastic_work(&past) + self.back.lost_work(place)
    }

    /// The kernel of the zone's elements.
    pub fn kernel(&self) -> Kernel<D, S, P, N> {
        self.kernel
    }

    /// The gradients of the zone's element `i`.
    pub fn gradients(&self, i: usize) -> &Gradients<D, S, P, N> {
        &self.gradients[i]
    }

    /// The committed history of all points, with `stride` places for each element.
    pub fn committed(&self) -> &[PlasticState<S>] {
        &self.committed
    }

    /// Committed history of the zone's element `i`.
    pub fn states(&self, i: usize) -> &[PlasticState<S>] {
        &self.committed[self.points_of(i)]
    }

    pub(super) fn points_of(&self, i: usize) -> std::ops::Range<usize> {
        let first = i * self.stride;
        first..first + self.gradients[i].n_points()
    }

    /// Number of Gauss points with plastic strain, and the largest equivalent plastic strain.
    pub fn extent(&self) -> (usize, f64) {
        self.committed.iter().fold((0, 0.0), |(n, largest), state| {
            (
                n + usize::from(state.equivalent > 0.0),
                f64::max(largest, state.equivalent),
            )
        })
    }
}

/// The components of a tensor at one point.
#[inline]
pub(super) fn at_point<const S: usize, const P: usize>(
    components: &Components<S, P>,
    g: usize,
) -> [f64; S] {
    components.each_ref().map(|lanes| lanes[g])
}

#[inline]
pub(in crate::analysis) fn put<const S: usize, const P: usize>(
    components: &mut Components<S, P>,
    g: usize,
    values: [f64; S],
) {
    for (lanes, value) in components.iter_mut().zip(values) {
        lanes[g] = value;
    }
}
