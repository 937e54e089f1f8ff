//! The elements that may yield: strains, flow rule and initial loads.
//!
//! ```text
//! eps = B u,   J = sum_g w_g B' D eps_p(eps),   dJ = sum_g w_g B' (D - D_ep) B du
//! ```
//!
//! `J` are the paper's initial loads (4.1); the plastic strains depend on the committed history and on the
//! total strain at the end of the increment only, so within an increment they are a function of `u`.

use super::gather::{GatheredElement, Lookup, Places, Prescribed};
use crate::assembly::local_element;
use crate::element::MAX_FREEDOMS;
use crate::material::{Material, Matrix4, PlasticState, multiply};
use crate::model::Model;
use crate::substructure::Trailing;
use rayon::prelude::*;

/// Result of evaluating the material over the zone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evaluation {
    /// Gauss points that flow in this increment.
    pub flowing: usize,
    /// Guard elements in which a point flows.
    pub guard_flows: usize,
}

/// The plastic zone with its history.
pub struct Zone {
    elements: Vec<GatheredElement>,
    /// Elements in which flow means that the zone is too small.
    guard: Vec<bool>,
    first_point: Vec<usize>,
    materials: Vec<(Material, Matrix4)>,
    committed: Vec<PlasticState>,
    trial: Vec<PlasticState>,
    softening: Vec<Matrix4>,
    /// Elements with a flowing point, ascending.
    active: Vec<u32>,
    forces: Vec<[f64; MAX_FREEDOMS]>,
    prescribed: Prescribed,
}

impl Zone {
    /// Sets up the zone of the given elements (ascending); `guard` says which of them only watch. The free freedoms of
    /// the elements must be zone or contact freedoms.
    pub fn new(model: &Model, elements: &[usize], guard: &[bool], places: &Places) -> Self {
        let list: Vec<GatheredElement> = elements
            .par_iter()
            .map(|&e| GatheredElement::new(model, e, local_element(model, e), places))
            .collect();
        let mut first_point = Vec::with_capacity(list.len() + 1);
        first_point.push(0);
        for element in &list {
            first_point.push(first_point[first_point.len() - 1] + element.points.len());
        }
        let n_points = first_point[list.len()];
        Zone {
            forces: vec![[0.0; MAX_FREEDOMS]; list.len()],
            elements: list,
            guard: guard.to_vec(),
            first_point,
            materials: model
                .materials
                .iter()
                .map(|m| (m.clone(), m.elastic_matrix()))
                .collect(),
            committed: vec![PlasticState::default(); n_points],
            trial: vec![PlasticState::default(); n_points],
            softening: vec![[[0.0; 4]; 4]; n_points],
            active: Vec::new(),
            prescribed: Prescribed::new(model),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        (self.elements.capacity() * std::mem::size_of::<GatheredElement>()
            + self.forces.capacity() * std::mem::size_of::<[f64; MAX_FREEDOMS]>()
            + self.committed.capacity() * 2 * std::mem::size_of::<PlasticState>()
            + self.softening.capacity() * std::mem::size_of::<Matrix4>()) as u64
    }

    /// Load factors that scale the prescribed displacements from now on.
    pub fn set_factors(&mut self, factors: &[f64]) {
        self.prescribed.set_factors(factors);
    }

    /// Integrates the flow rule for displacements `u` and adds up the initial loads.
    pub fn evaluate(&mut self, u: &Trailing, initial_load: &mut Trailing) -> Evaluation {
        let lookup = Lookup::new(u, &self.prescribed);
        let (materials, committed, first_point) =
            (&self.materials, &self.committed, &self.first_point);
        let trial = split(&mut self.trial, first_point);
        let softening = split(&mut self.softening, first_point);
        let status: Vec<(usize, bool)> = self
            .elements
            .par_iter()
            .zip(first_point)
            .zip(trial.into_par_iter().zip(softening).zip(&mut self.forces))
            .with_min_len(64)
            .map(|((element, &first), ((trial, softening), force))| {
                let displacement = lookup.gather(element);
                let (material, elastic) = &materials[element.body as usize];
                let mut flowing = 0;
                let mut strained = false;
                force.fill(0.0);
                for (i, point) in element.points.iter().enumerate() {
                    let strain = point.strain(&displacement[..element.points.n_freedoms]);
                    let update = material.integrate(elastic, &strain, &committed[first + i]);
                    trial[i] = update.state;
                    softening[i] = update.softening;
                    flowing += usize::from(update.flows);
                    if update.state.equivalent > 0.0 {
                        strained = true;
                        point.add_force(&multiply(elastic, &update.state.strain), force);
                    }
                }
                (flowing, strained)
            })
            .collect();
        let mut result = Evaluation::default();
        self.active.clear();
        initial_load.fill(0.0);
        for (i, &(flowing, strained)) in status.iter().enumerate() {
            result.flowing += flowing;
            if flowing > 0 {
                self.active.push(i as u32);
                result.guard_flows += usize::from(self.guard[i]);
            }
            if strained {
                self.elements[i].scatter(&self.forces[i], initial_load);
            }
        }
        result
    }

    /// `out = sum_g w_g B' (D - D_ep) B v` at the last evaluated state, for a `v` that vanishes where displacements are
    /// prescribed.
    pub fn softening_times(&mut self, v: &Trailing, out: &mut Trailing) {
        let lookup = Lookup::homogeneous(v);
        let (elements, softening, first_point) =
            (&self.elements, &self.softening, &self.first_point);
        self.active
            .par_iter()
            .zip(&mut self.forces[..self.active.len()])
            .with_min_len(64)
            .for_each(|(&i, force)| {
                let element = &elements[i as usize];
                let displacement = lookup.gather(element);
                force.fill(0.0);
                for (point, matrix) in element
                    .points
                    .iter()
                    .zip(&softening[first_point[i as usize]..])
                {
                    let strain = point.strain(&displacement[..element.points.n_freedoms]);
                    point.add_force(&multiply(matrix, &strain), force);
                }
            });
        out.fill(0.0);
        for (&i, force) in self.active.iter().zip(&self.forces) {
            self.elements[i as usize].scatter(force, out);
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
        self.committed.copy_from_slice(&self.trial);
    }

    /// The history, point by point.
    pub fn history(&self) -> &[PlasticState] {
        &self.committed
    }

    /// Puts a history back.
    pub fn restore(&mut self, history: &[PlasticState]) {
        self.committed.copy_from_slice(history);
    }

    /// History by element of the mesh.
    pub fn history_by_element(&self) -> impl Iterator<Item = (usize, &[PlasticState])> {
        self.elements
            .iter()
            .enumerate()
            .map(|(i, e)| (e.element, &self.committed[self.points_of(i)]))
    }

    /// Initial loads of the committed plastic strains.
    pub fn initial_load(&self, mut out: Trailing) -> Trailing {
        out.fill(0.0);
        for (i, element) in self.elements.iter().enumerate() {
            let elastic = &self.materials[element.body as usize].1;
            let mut force = [0.0; MAX_FREEDOMS];
            for (point, state) in element
                .points
                .iter()
                .zip(&self.committed[self.points_of(i)])
            {
                if state.equivalent > 0.0 {
                    point.add_force(&multiply(elastic, &state.strain), &mut force);
                }
            }
            element.scatter(&force, &mut out);
        }
        out
    }

    fn points_of(&self, i: usize) -> std::ops::Range<usize> {
        self.first_point[i]..self.first_point[i + 1]
    }

    /// Takes over the history of elements that belong to another zone too.
    pub fn take_over(&mut self, other: &Zone) {
        let mut j = 0;
        for i in 0..self.elements.len() {
            while j < other.elements.len() && other.elements[j].element < self.elements[i].element {
                j += 1;
            }
            if j < other.elements.len() && other.elements[j].element == self.elements[i].element {
                let (to, from) = (self.points_of(i), other.points_of(j));
                self.committed[to].copy_from_slice(&other.committed[from]);
            }
        }
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

/// Cuts an array into the pieces of the elements.
fn split<'a, T>(mut values: &'a mut [T], first_point: &[usize]) -> Vec<&'a mut [T]> {
    let mut out = Vec::with_capacity(first_point.len());
    for pair in first_point.windows(2) {
        let (head, tail) = values.split_at_mut(pair[1] - pair[0]);
        out.push(head);
        values = tail;
    }
    out
}
