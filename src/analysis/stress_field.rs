//! The stresses of a state, evaluated element by element where they are looked at.
//!
//! Nothing is stored: an element is quickly evaluated again, while the stresses of all take a tenth
//! of the factor's memory.

use super::free_strain::take_off;
use super::local_yield::largest_ratio;
use super::zone::ZoneOf;
use crate::element::{Components, Gradients, Kernel};
use crate::material::{Lame, PlasticState};
use crate::model::Model;
use crate::space::Vector;

/// Elements of the mesh that share an entry in the list of where the zone's begin.
const GROUP: usize = 64;

/// Stresses as a function of the element.
pub(super) struct StressField<'a, const D: usize, const S: usize, const P: usize, const N: usize> {
    pub(super) kernel: Kernel<D, S, P, N>,
    pub(super) model: &'a Model,
    pub(super) zone: &'a ZoneOf<D, S, P, N>,
    /// Elements of the zone, ascending.
    in_zone: &'a [usize],
    /// The first of them in each group of elements of the mesh.
    first_of_group: Vec<u32>,
    /// Of the nodes, in global axes.
    displacements: Vec<Vector>,
    /// Factor of each load.
    pub(super) factors: Vec<f64>,
    elastic: Vec<Lame>,
}

/// What is read off a stress field of either dimension.
pub(super) trait OfStresses {
    /// What comes out.
    type Answer;

    /// Reads it.
    fn of<const D: usize, const S: usize, const P: usize, const N: usize>(
        self,
        field: &StressField<D, S, P, N>,
    ) -> Self::Answer;
}

/// An element and the stresses at its Gauss points.
pub(super) struct ElementStress<'a, const D: usize, const S: usize, const P: usize, const N: usize>
{
    pub(super) gradients: Gradients<D, S, P, N>,
    pub(super) stress: Components<S, P>,
    /// Of its points; empty outside the zone.
    pub(super) history: &'a [PlasticState<S>],
}

impl<'a, const D: usize, const S: usize, const P: usize, const N: usize>
    StressField<'a, D, S, P, N>
{
    /// The stresses for nodal displacements in global axes, with the loads' factors, and the
    /// committed history of the zone, whose elements are `in_zone` (ascending).
    pub(super) fn new(
        kernel: Kernel<D, S, P, N>,
        model: &'a Model,
        zone: &'a ZoneOf<D, S, P, N>,
        in_zone: &'a [usize],
        (displacements, factors): (Vec<Vector>, Vec<f64>),
    ) -> Self {
        let n_groups = model.mesh.n_elements().div_ceil(GROUP);
        let mut first_of_group = vec![0u32; n_groups + 1];
        for &e in in_zone {
            first_of_group[e / GROUP + 1] += 1;
        }
        for group in 0..n_groups {
            first_of_group[group + 1] += first_of_group[group];
        }
        StressField {
            kernel,
            model,
            zone,
            in_zone,
            first_of_group,
            displacements,
            factors,
            elastic: model.materials.iter().map(|m| m.lame()).collect(),
        }
    }

    /// Place of an element in the zone.
    pub(super) fn place_in_zone(&self, e: usize) -> Option<usize> {
        let [first, end] = [0, 1].map(|i| self.first_of_group[e / GROUP + i] as usize);
        let place = self.in_zone[first..end].binary_search(&e).ok()?;
        Some(first + place)
    }

    /// The elements of the zone that have yielded, ascending, with their places in it.
    pub(super) fn yielded(&self) -> impl Iterator<Item = (usize, usize)> {
        let zone = self.zone;
        let elements = self.in_zone.iter().enumerate();
        let has_yielded = |past: &PlasticState<S>| past.equivalent > 0.0;
        elements
            .map(|(i, &e)| (e, i))
            .filter(move |&(_, i)| zone.states(i).iter().any(has_yielded))
    }

    /// The stresses of an element.
    #[inline]
    pub(super) fn at(&self, e: usize) -> ElementStress<'a, D, S, P, N> {
        let mesh = &self.model.mesh;
        let gradients = self.model.gradients(&self.kernel, e);
        let mut u = [[0.0; D]; N];
        for (u, &node) in u.iter_mut().zip(mesh.nodes(e)) {
            u.copy_from_slice(&self.displacements[node as usize][..D]);
        }
        let mut strain = gradients.strains(&u);
        for (load, components, nodal) in self.model.free_strains(e) {
            take_off(
                &mut strain,
                self.factors[load],
                (components, &gradients.at_points(&nodal)),
            );
        }
        let history = self
            .place_in_zone(e)
            .map_or(&[][..], |i| self.zone.states(i));
        for (g, past) in history.iter().enumerate() {
            for (strain, plastic) in strain.iter_mut().zip(&past.strain) {
                strain[g] -= plastic;
            }
        }
        ElementStress {
            stress: stress(&self.elastic[mesh.element_body[e] as usize], &strain),
            gradients,
            history,
        }
    }
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> ElementStress<'_, D, S, P, N> {
    /// Largest von Mises stress at a point.
    #[inline]
    pub(super) fn von_mises(&self) -> f64 {
        largest_von_mises(&self.stress, self.gradients.n_points())
    }

    /// Largest von Mises stress over yield stress at a point of the element `e`.
    pub(super) fn yield_ratio(&self, model: &Model, e: usize) -> f64 {
        let places = || self.gradients.positions(&model.mesh.element_coordinates(e));
        largest_ratio(model, e, &self.stress, (places, self.gradients.n_points()))
    }

    /// Largest equivalent plastic strain at a point.
    pub(super) fn plastic_strain(&self) -> f64 {
        let points = self.history.iter();
        points.fold(0.0, |m, past| m.max(past.equivalent))
    }
}

/// The elastic stress at all points.
#[inline]
pub(super) fn stress<const S: usize, const P: usize>(
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

/// The largest von Mises stress at the first `n` points.
#[inline]
pub(super) fn largest_von_mises<const S: usize, const P: usize>(
    stress: &Components<S, P>,
    n: usize,
) -> f64 {
    let (x, y, z) = (&stress[0], &stress[1], &stress[2]);
    let mut square = 0.0f64;
    for g in 0..n {
        let [a, b, c] = [x[g] - y[g], y[g] - z[g], z[g] - x[g]];
        let shear: f64 = stress[3..].iter().map(|t| t[g] * t[g]).sum();
        square = square.max(0.5 * (a * a + b * b + c * c) + 3.0 * shear);
    }
    square.sqrt()
}
