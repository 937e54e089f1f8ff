//! The stresses of a state, evaluated for one element at a time on demand.
//!
//! Nothing is stored: evaluating an element again is quick, while the stresses of all elements
//! would take a tenth of the factor's memory.

use crate::analysis::zone::free_strain::take_off_all;
use crate::analysis::zone::local_yield::{largest_ratio, largest_von_mises};
use crate::element::{Components, Gradients, Kernel};
use crate::material::{Lame, PlasticState};
use crate::model::{Continuum, FreeOfLoad};
use crate::space::{Space, Vector};

/// Number of consecutive elements of the mesh that share an entry in the index of zone elements.
const GROUP: usize = 64;

/// The stresses of a state as a function of the element.
pub(in crate::analysis) struct StressField<
    'a,
    const D: usize,
    const S: usize,
    const P: usize,
    const N: usize,
> {
    kernel: Kernel<D, S, P, N>,
    pub(in crate::analysis) continuum: &'a Continuum,
    state: Strained<'a, S>,
    /// Number of zone elements that lie before each group of elements of the mesh.
    first_of_group: Vec<u32>,
    elastic: Vec<Lame>,
}

/// The state from which stresses follow.
pub(in crate::analysis) struct Strained<'a, const S: usize> {
    /// Displacements of the nodes, in global axes.
    pub(in crate::analysis) displacements: &'a [Vector],
    /// Factor of each load.
    pub(in crate::analysis) factors: &'a [f64],
    /// Free strains of the loads.
    pub(in crate::analysis) free: &'a [FreeOfLoad<'a>],
    /// Elements of the zone, ascending.
    pub(in crate::analysis) in_zone: &'a [usize],
    /// The committed history of the zone's points, with the same number of places for each element.
    pub(in crate::analysis) history: &'a [PlasticState<S>],
}

/// An element and the stresses at its Gauss points.
pub(in crate::analysis) struct ElementStress<
    'a,
    const D: usize,
    const S: usize,
    const P: usize,
    const N: usize,
> {
    number: usize,
    pub(in crate::analysis) gradients: Gradients<D, S, P, N>,
    pub(in crate::analysis) stress: Components<S, P>,
    /// Plastic history of the element's points; empty outside the zone.
    pub(in crate::analysis) history: &'a [PlasticState<S>],
}

impl<'a, const D: usize, const S: usize, const P: usize, const N: usize>
    StressField<'a, D, S, P, N>
{
    /// The stresses of the given state.
    pub(in crate::analysis) fn new(
        kernel: Kernel<D, S, P, N>,
        continuum: &'a Continuum,
        state: Strained<'a, S>,
    ) -> Self {
        let n_groups = continuum.mesh.n_elements().div_ceil(GROUP);
        let mut first_of_group = vec![0u32; n_groups + 1];
        for &e in state.in_zone {
            first_of_group[e / GROUP + 1] += 1;
        }
        for group in 0..n_groups {
            first_of_group[group + 1] += first_of_group[group];
        }
        StressField {
            kernel,
            continuum,
            state,
            first_of_group,
            elastic: continuum.materials.iter().map(|m| m.lame()).collect(),
        }
    }

    /// Index of an element in the zone; `None` outside it.
    pub(super) fn place_in_zone(&self, e: usize) -> Option<usize> {
        let [first, end] = [0, 1].map(|i| self.first_of_group[e / GROUP + i] as usize);
        let place = self.state.in_zone[first..end].binary_search(&e).ok()?;
        Some(first + place)
    }

    /// The history of an element's points; empty outside the zone.
    fn history(&self, e: usize) -> &'a [PlasticState<S>] {
        let Strained {
            in_zone, history, ..
        } = self.state;
        self.place_in_zone(e).map_or(&[], |place| {
            let stride = history.len() / in_zone.len();
            let n_points = self.continuum.mesh.n_points(e);
            &history[place * stride..][..n_points]
        })
    }

    /// The total strains from the displacements of an element's nodes.
    #[inline]
    fn of_displacements(&self, e: usize, gradients: &Gradients<D, S, P, N>) -> Components<S, P> {
        let mut u = [[0.0; D]; N];
        for (u, &node) in u.iter_mut().zip(self.continuum.mesh.nodes(e)) {
            u.copy_from_slice(&self.state.displacements[node as usize][..D]);
        }
        gradients.strains(&u)
    }

    #[inline]
    fn take_off_free_strain(
        &self,
        e: usize,
        gradients: &Gradients<D, S, P, N>,
        strain: &mut Components<S, P>,
    ) {
        let (mesh, state) = (&self.continuum.mesh, &self.state);
        let free = (state.free, state.factors);
        take_off_all(strain, (mesh, e), free, |nodal| gradients.at_points(nodal));
    }

    /// The total strains of an element. In plane stress they include the strain across the plane
    /// that stresses, plastic flow and temperature cause.
    pub(super) fn total_strain(&self, element: &ElementStress<'_, D, S, P, N>) -> Components<S, P> {
        let e = element.number;
        let mut strain = self.of_displacements(e, &element.gradients);
        if self.continuum.kind != Space::PlaneStress {
            return strain;
        }
        let mut taken_off = [[0.0; P]; S];
        self.take_off_free_strain(e, &element.gradients, &mut taken_off);
        let material = self.continuum.material(e);
        let contraction = -material.poissons_ratio / material.youngs_modulus;
        let stress = &element.stress;
        for g in 0..P {
            strain[2][g] = contraction * (stress[0][g] + stress[1][g]) - taken_off[2][g];
        }
        for (g, past) in element.history.iter().enumerate() {
            strain[2][g] += past.strain[2];
        }
        strain
    }

    /// Evaluates the stresses of an element.
    #[inline]
    pub(in crate::analysis) fn at(&self, e: usize) -> ElementStress<'a, D, S, P, N> {
        let mesh = &self.continuum.mesh;
        let gradients = self.continuum.gradients(&self.kernel, e);
        let mut strain = self.of_displacements(e, &gradients);
        self.take_off_free_strain(e, &gradients, &mut strain);
        let history = self.history(e);
        for (g, past) in history.iter().enumerate() {
            for (strain, plastic) in strain.iter_mut().zip(&past.strain) {
                strain[g] -= plastic;
            }
        }
        ElementStress {
            number: e,
            stress: stress(&self.elastic[mesh.element_body[e] as usize], &strain),
            gradients,
            history,
        }
    }
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> ElementStress<'_, D, S, P, N> {
    /// Largest von Mises stress at a point of the element.
    #[inline]
    pub(in crate::analysis) fn von_mises(&self) -> f64 {
        largest_von_mises(&self.stress, self.gradients.n_points())
    }

    /// Largest ratio of von Mises stress to yield stress at a point of the element `e`.
    pub(super) fn yield_ratio(&self, continuum: &Continuum, e: usize) -> f64 {
        let places = || {
            let nodes = continuum.mesh.element_coordinates(e);
            self.gradients.positions(&nodes)
        };
        largest_ratio(
            continuum,
            e,
            &self.stress,
            (places, self.gradients.n_points()),
        )
    }

    /// Largest equivalent plastic strain at a point.
    pub(in crate::analysis) fn plastic_strain(&self) -> f64 {
        let points = self.history.iter();
        points.fold(0.0, |m, past| m.max(past.equivalent))
    }
}

/// The elastic stress at all points.
#[inline]
pub(in crate::analysis) fn stress<const S: usize, const P: usize>(
    law: &Lame,
    strain: &Components<S, P>,
) -> Components<S, P> {
    let mut out = [[0.0; P]; S];
    for g in 0..P {
        let stress = law.times(&strain.each_ref().map(|lanes| lanes[g]));
        for (out, stress) in out.iter_mut().zip(stress) {
            out[g] = stress;
        }
    }
    out
}
