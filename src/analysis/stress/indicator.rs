//! The difference between the stresses of an element and a smoother, more accurate field: an
//! indicator of where the mesh is too coarse.
//!
//! Around each element a polynomial of the degree of its displacements is fitted, by least squares,
//! to the stresses at the superconvergent points of the element and of all elements that share a
//! node with it. The recovered `sigma*` converges faster than `sigma_h`, so their difference in the
//! energy norm estimates the error of `sigma_h`:
//!
//! ```text
//!     eta_e^2 = integral over e of (sigma* - sigma_h) : C (sigma* - sigma_h),   C: compliance
//!     eta^2   = sum eta_e^2 / (sum of integral sigma_h : C sigma_h + sum eta_e^2)
//! ```
//!
//! # Source
//! O. C. Zienkiewicz, J. Z. Zhu, The superconvergent patch recovery and a posteriori error
//! estimates, parts 1 and 2, Int. J. Numer. Meth. Engng 33 (1992) 1331-1382,
//! doi:10.1002/nme.1620330702.
//!
//! The stress at a node is the mean, over its elements, of their polynomials at the node.

mod rules;

use super::neighbours::Neighbours;
use super::patch_fit::{PatchFit, ScaledCoordinates, Terms};
use super::stress_field::{ElementStress, StressField};
use crate::element::Lanes;
use crate::material::Material;
use crate::model::Continuum;
use crate::shape::Integration;
use crate::space::{cross, dot, unit};
use rayon::prelude::*;
use rules::{COMPARED, FROM_FULL};
use serde::{Deserialize, Serialize};

/// Smallest pivot of the scaled normal equations with which a fit counts as determined: about the
/// square root of the round-off of the pivots, 1e-14.
const DETERMINED: f64 = 1e-7;

/// Energy of the estimated stress error and of the stress itself, element by element.
pub(in crate::analysis) struct Indicator {
    /// `eta_e`, relative to the energy norm of the whole solution: the sum of the squares is the
    /// square of [`Indicator::total`].
    pub by_element: Vec<f64>,
    /// `eta`: estimated energy norm of the error divided by that of the solution, 0 to 1.
    pub total: f64,
    /// `n_nodes x S`: the recovered stress at the nodes.
    pub nodal_stress: Vec<f64>,
}

/// Energies and nodal stresses from the polynomials around some elements.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(in crate::analysis) struct RecoveredStresses {
    /// Energies of `sigma* - sigma_h` and of `sigma_h`, for each element.
    pub(super) energies: Vec<[f64; 2]>,
    /// `n_nodes x S`: sums of `sigma*` at the nodes of the mesh.
    pub(in crate::analysis) at_nodes: Vec<f64>,
    /// Number of elements that contribute to the sum at each node.
    pub(super) n_elements_of: Vec<u32>,
}

/// Number of elements whose stresses at the nodes are held at a time.
const AT_A_TIME: usize = 1 << 14;

impl RecoveredStresses {
    /// Fits polynomials around some elements of a stress field. The field must hold all elements
    /// that share a node with them.
    pub(in crate::analysis) fn new<
        const D: usize,
        const S: usize,
        const P: usize,
        const N: usize,
    >(
        field: &StressField<D, S, P, N>,
        elements: &[usize],
    ) -> Self {
        let continuum = field.continuum;
        let mesh = &continuum.mesh;
        let neighbours = Neighbours::new(mesh, 0..mesh.n_elements());
        let samples = ElementSamples::new(field);
        let mut out = RecoveredStresses {
            energies: Vec::with_capacity(elements.len()),
            at_nodes: vec![0.0; S * mesh.n_nodes()],
            n_elements_of: vec![0; mesh.n_nodes()],
        };
        for some in elements.chunks(AT_A_TIME) {
            let recovered: Vec<OfElement<S, N>> = some
                .par_iter()
                .with_min_len(64)
                .map_init(Vec::new, |patch, &e| {
                    neighbours.at(mesh.nodes(e), patch);
                    recovered(continuum, e, &field.at(e), patch, &samples)
                })
                .collect();
            // The sums run in the order of the elements: the same bits for any number of threads.
            for (&e, of_element) in some.iter().zip(&recovered) {
                out.energies.push(of_element.energies);
                for (&node, stress) in mesh.nodes(e).iter().zip(&of_element.at_nodes) {
                    let node = node as usize;
                    out.n_elements_of[node] += 1;
                    for (sum, s) in out.at_nodes[S * node..][..S].iter_mut().zip(stress) {
                        *sum += s;
                    }
                }
            }
        }
        out
    }

    /// Estimated energy norm of the error divided by that of the solution, over the elements that
    /// `counts` selects; `None` if these elements have no energy. `self` must hold all elements of
    /// the mesh.
    pub(in crate::analysis) fn error_of(&self, counts: impl Fn(usize) -> bool) -> Option<f64> {
        let ours = self.energies.iter().enumerate().filter(|(e, _)| counts(*e));
        let [error, whole] = ours.fold([0.0; 2], |sum, (_, e)| [sum[0] + e[0], sum[1] + e[1]]);
        (error + whole > 0.0).then(|| (error / (error + whole)).sqrt())
    }

    /// The indicator of the whole mesh, with the given number of stress components. `self` must
    /// hold all elements of the mesh.
    pub(in crate::analysis) fn indicator(self, components: usize) -> Indicator {
        let mut nodal_stress = self.at_nodes;
        let nodes = nodal_stress.chunks_exact_mut(components);
        for (stress, n) in nodes.zip(self.n_elements_of) {
            let n = f64::from(n.max(1));
            stress.iter_mut().for_each(|s| *s /= n);
        }
        let energies = self.energies;
        let sum = |i: usize| energies.iter().fold(0.0, |sum, e| sum + e[i]);
        let (error, whole) = (sum(0), sum(0) + sum(1));
        let share = |part: f64| {
            if whole > 0.0 {
                (part / whole).sqrt()
            } else {
                0.0
            }
        };
        Indicator {
            by_element: energies.iter().map(|e| share(e[0])).collect(),
            total: share(error),
            nodal_stress,
        }
    }
}

/// Energies and nodal stresses from the polynomial around one element.
struct OfElement<const S: usize, const N: usize> {
    /// Energies of `sigma* - sigma_h` and of `sigma_h`.
    energies: [f64; 2],
    /// `sigma*` at the nodes of the element.
    at_nodes: [[f64; S]; N],
}

/// Stress at a superconvergent point.
#[derive(Clone, Copy)]
struct PointStress<const D: usize, const S: usize> {
    position: [f64; D],
    stress: [f64; S],
}

/// The stress samples of all elements, element by element.
struct ElementSamples<const D: usize, const S: usize> {
    first: Vec<u32>,
    list: Vec<PointStress<D, S>>,
}

impl<const D: usize, const S: usize> ElementSamples<D, S> {
    fn new<const P: usize, const N: usize>(field: &StressField<D, S, P, N>) -> Self {
        let (continuum, mesh) = (field.continuum, &field.continuum.mesh);
        let mut first = vec![0u32];
        for (e, shape) in mesh.shapes.iter().enumerate() {
            let own = match degree(continuum, e) {
                1 => 1,
                _ => shape.n_points(Integration::Reduced),
            };
            first.push(first[e] + own as u32);
        }
        let none = PointStress {
            position: [0.0; D],
            stress: [0.0; S],
        };
        let mut list = vec![none; first[mesh.n_elements()] as usize];
        let mut of_elements = Vec::with_capacity(mesh.n_elements());
        let mut rest = list.as_mut_slice();
        for e in 0..mesh.n_elements() {
            let (own, tail) = rest.split_at_mut((first[e + 1] - first[e]) as usize);
            of_elements.push(own);
            rest = tail;
        }
        of_elements
            .into_par_iter()
            .enumerate()
            .with_min_len(256)
            .for_each(|(e, samples)| sample(continuum, e, &field.at(e), samples));
        ElementSamples { first, list }
    }

    fn of(&self, element: u32) -> &[PointStress<D, S>] {
        let e = element as usize;
        &self.list[self.first[e] as usize..self.first[e + 1] as usize]
    }
}

/// Values at the superconvergent points of a quadratic element, from its values at the Gauss
/// points. The two sets of points are equal unless the element is fully integrated.
fn superconvergent<const P: usize, const C: usize>(
    continuum: &Continuum,
    e: usize,
    values: &[Lanes<P>; C],
) -> [Lanes<P>; C] {
    let mesh = &continuum.mesh;
    if mesh.integration_of(e) == Integration::Reduced {
        return *values;
    }
    let of_points = &FROM_FULL[mesh.shapes[e] as usize];
    values.each_ref().map(|lanes| {
        let mut out = [0.0; P];
        for (out, shares) in out.iter_mut().zip(of_points) {
            *out = shares.iter().zip(lanes).map(|(share, v)| share * v).sum();
        }
        out
    })
}

/// Samples the stress of an element: a linear element has its mean at the centre, a quadratic
/// element its values at the superconvergent points.
fn sample<const D: usize, const S: usize, const P: usize, const N: usize>(
    continuum: &Continuum,
    e: usize,
    element: &ElementStress<D, S, P, N>,
    out: &mut [PointStress<D, S>],
) {
    let (gradients, stress) = (&element.gradients, &element.stress);
    let position = gradients.positions(&continuum.mesh.element_coordinates(e));
    if let [mean] = out {
        *mean = PointStress {
            position: gradients.mean(&position),
            stress: gradients.mean(stress),
        };
        return;
    }
    let position = superconvergent(continuum, e, &position);
    let stress = superconvergent(continuum, e, stress);
    for (g, sample) in out.iter_mut().enumerate() {
        *sample = PointStress {
            position: position.each_ref().map(|lanes| lanes[g]),
            stress: stress.each_ref().map(|lanes| lanes[g]),
        };
    }
}

/// Degree of the displacements of an element.
fn degree(continuum: &Continuum, e: usize) -> usize {
    continuum.mesh.shapes[e].reference().degree
}

/// A point of the quadrature: its coordinates, its weight and `sigma_h`.
type QuadraturePoint<const D: usize, const S: usize> = ([f64; D], f64, [f64; S]);

/// Calls `visit` for each point at which the stresses are compared. A quadratic element has its
/// stress at the Gauss points, where the stress is superconvergent and its error nearly vanishes.
/// Between these points the polynomial through them is taken.
fn quadrature<const D: usize, const S: usize, const P: usize, const N: usize>(
    continuum: &Continuum,
    e: usize,
    element: &ElementStress<D, S, P, N>,
    mut visit: impl FnMut(QuadraturePoint<D, S>),
) {
    let coordinates = continuum.mesh.element_coordinates::<D, N>(e);
    let stress = &element.stress;
    if degree(continuum, e) == 1 {
        let position = element.gradients.positions(&coordinates);
        for (g, &weight) in element.gradients.weights().iter().enumerate() {
            let at = position.each_ref().map(|lanes| lanes[g]);
            visit((at, weight, stress.each_ref().map(|lanes| lanes[g])));
        }
        return;
    }
    let shape = continuum.mesh.shapes[e];
    let stress = superconvergent(continuum, e, stress);
    for point in &COMPARED[shape as usize] {
        let at = &point.functions;
        let mut x = [0.0; D];
        let mut along = [[0.0; 3]; 3];
        for (k, c) in coordinates.iter().enumerate().take(shape.n_nodes()) {
            for d in 0..D {
                x[d] += at.values[k] * c[d];
                for (along, slope) in along.iter_mut().zip(at.gradients[k]) {
                    along[d] += slope * c[d];
                }
            }
        }
        if D == 2 {
            along[2] = unit(2);
        }
        let determinant = dot(cross(along[0], along[1]), along[2]);
        let between = stress.each_ref().map(|lanes| {
            point
                .shares
                .iter()
                .zip(lanes)
                .map(|(share, s)| share * s)
                .sum()
        });
        let weight = point.weight * determinant * continuum.kind.measure(x[0]);
        visit((x, weight, between));
    }
}

/// Fits the polynomial around element `e`, and returns its energies and nodal stresses.
fn recovered<const D: usize, const S: usize, const P: usize, const N: usize>(
    continuum: &Continuum,
    e: usize,
    element: &ElementStress<D, S, P, N>,
    patch: &[u32],
    samples: &ElementSamples<D, S>,
) -> OfElement<S, N> {
    let material = &continuum.materials[continuum.mesh.element_body[e] as usize];
    let frame = ScaledCoordinates::about(&continuum.mesh, e);
    // A patch that does not determine the polynomial (a single element, a row of elements) gets a
    // polynomial of lower degree.
    let fit = Some(degree(continuum, e))
        .filter(|degree| *degree > 1)
        .and_then(|_| fit::<2, D, S>(&frame, patch, samples))
        .or_else(|| fit::<1, D, S>(&frame, patch, samples))
        .or_else(|| fit::<0, D, S>(&frame, patch, samples));
    let mean = element.gradients.mean(&element.stress);
    let at = |x: &[f64; D], unknown: [f64; S]| match &fit {
        Some(fit) => fit.each_ref().map(|c| PatchFit::<D, 2>::value(c, 1.0, x)),
        None => unknown,
    };
    let mut energies = [0.0; 2];
    quadrature(continuum, e, element, |(position, weight, computed)| {
        let recovered = at(&frame.relative(position), computed);
        let difference: [f64; S] = std::array::from_fn(|c| recovered[c] - computed[c]);
        energies[0] += weight * compliance_energy(material, &difference);
        energies[1] += weight * compliance_energy(material, &computed);
    });
    let mut at_nodes = [[0.0; S]; N];
    for (stress, &node) in at_nodes.iter_mut().zip(continuum.mesh.nodes(e)) {
        *stress = at(&frame.relative(continuum.mesh.point(node as usize)), mean);
    }
    OfElement { energies, at_nodes }
}

/// Returns `sigma : C sigma = ((1 + nu) sigma : sigma - nu tr(sigma)^2) / E`.
fn compliance_energy<const S: usize>(material: &Material, stress: &[f64; S]) -> f64 {
    let nu = material.poissons_ratio;
    let trace = stress[0] + stress[1] + stress[2];
    let normal: f64 = stress[..3].iter().map(|s| s * s).sum();
    let shear: f64 = stress[3..].iter().map(|s| s * s).sum();
    let square = normal + 2.0 * shear;
    ((1.0 + nu) * square - nu * trace * trace) / material.youngs_modulus
}

/// Weight of a sample, from its distance to the centre in element sizes. Nearer samples count more:
/// otherwise a field that turns within the patch (stresses round a hole) would be smoothed away.
fn weight(x: &[f64]) -> f64 {
    let square: f64 = x.iter().map(|x| x * x).sum();
    1.0 / (1.0 + square * square)
}

/// The coefficients of the weighted least-squares polynomial for each stress component; `None` if
/// the samples do not determine it.
fn fit<const DEGREE: usize, const D: usize, const S: usize>(
    frame: &ScaledCoordinates<D>,
    patch: &[u32],
    samples: &ElementSamples<D, S>,
) -> Option<[Terms; S]> {
    let within = || patch.iter().flat_map(|&member| samples.of(member));
    // With only as many samples as terms, the polynomial would interpolate them, errors included.
    let n = PatchFit::<D, DEGREE>::N_TERMS;
    if n > 1 && within().count() <= n {
        return None;
    }
    let weighted = |sample: &PointStress<D, S>| {
        let x = frame.relative(sample.position);
        (weight(&x), x)
    };
    let fit = PatchFit::<D, DEGREE>::to(within().map(weighted), DETERMINED)?;
    let mut right = [Terms::default(); S];
    for sample in within() {
        let (weight, x) = weighted(sample);
        let terms = PatchFit::<D, DEGREE>::terms(weight, &x);
        for (right, stress) in right.iter_mut().zip(sample.stress) {
            for (right, term) in right.iter_mut().zip(&terms[..n]) {
                *right += term * stress;
            }
        }
    }
    Some(right.each_ref().map(|right| fit.solve(right)))
}
