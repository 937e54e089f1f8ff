//! Kernel of all elements: gradients of fields at the points of an element.
//!
//! The shape functions in the reference element are the same for all elements of a shape. With the
//! Jacobian `J = sum_k x_k dN_k/dxi` at a point
//!
//! ```text
//! du/dx = J^-T sum_k u_k dN_k/dxi          f_k = sum_g (J^-1 w sigma) dN_k/dxi
//! ```
//!
//! Only `J^-1` and the weights are therefore kept for each element, a third of the size of
//! `dN_k/dx`. With a mean dilatation (B-bar) the trace of the strain is replaced by its mean over
//! the element, and in the forces the mean stress by its mean over the element; this is equivalent
//! to averaging `tr B`. The points are computed in parallel: every quantity is an array over the
//! points.
//!
//! # Source
//! T. J. R. Hughes, *The Finite Element Method* (1987), sections 2.7 and 4.5 (B-bar).

use crate::shape::{ReferenceElement, Rule};
use crate::space::Space;

/// One number at each point; unused lanes repeat the value at the first point.
pub type Lanes<const P: usize = 4> = [f64; P];
/// Stress or strain at the points, component by component.
pub type Components<const S: usize = 4, const P: usize = 4> = [Lanes<P>; S];

/// Shape functions of one shape at the points of a rule.
#[derive(Debug)]
pub(super) struct ShapeFunctionTable<const D: usize, const P: usize, const N: usize> {
    n_nodes: usize,
    n_points: usize,
    /// Weights of the points; zero in unused lanes.
    weights: Lanes<P>,
    pub(super) values: [Lanes<P>; N],
    /// Derivatives along the reference coordinates.
    gradients: [[Lanes<P>; D]; N],
}

impl<const D: usize, const P: usize, const N: usize> ShapeFunctionTable<D, P, N> {
    pub(super) fn new(row: &ReferenceElement, rule: &Rule) -> Self {
        let mut out = ShapeFunctionTable {
            n_nodes: row.nodes.len(),
            n_points: rule.len(),
            weights: [0.0; P],
            values: [[0.0; P]; N],
            gradients: [[[0.0; P]; D]; N],
        };
        for g in 0..P {
            let (place, weight) = rule.get(g).copied().unwrap_or((rule[0].0, 0.0));
            let at = (row.functions)(place);
            out.weights[g] = weight;
            for k in 0..N {
                out.values[k][g] = at.values[k];
                for a in 0..D {
                    out.gradients[k][a][g] = at.gradients[k][a];
                }
            }
        }
        out
    }

    /// Derivatives along the reference coordinates of each component of the field that has the
    /// values `of` at the nodes.
    #[inline]
    fn along<const K: usize>(&self, of: &[[f64; D]; N]) -> [[Lanes<P>; D]; D] {
        let mut out = [[[0.0; P]; D]; D];
        for (gradient, value) in self.gradients.iter().zip(of).take(K) {
            for (out, value) in out.iter_mut().zip(value) {
                for (out, gradient) in out.iter_mut().zip(gradient) {
                    for g in 0..P {
                        out[g] += gradient[g] * value;
                    }
                }
            }
        }
        out
    }

    /// Values at the points of the field that has the values `of` at the nodes.
    #[inline]
    fn interpolated(&self, of: impl Fn(usize) -> f64) -> Lanes<P> {
        let mut out = [0.0; P];
        for (k, values) in self.values.iter().enumerate().take(self.n_nodes) {
            let value = of(k);
            for g in 0..P {
                out[g] += values[g] * value;
            }
        }
        out
    }
}

/// Calls a method that takes the number of nodes as a constant.
macro_rules! of_nodes {
    ($n:expr, $to:expr, $method:ident, $($argument:expr),*) => {
        match $n {
            3 => $to.$method::<3>($($argument),*),
            4 => $to.$method::<4>($($argument),*),
            6 => $to.$method::<6>($($argument),*),
            8 => $to.$method::<8>($($argument),*),
            10 => $to.$method::<10>($($argument),*),
            15 => $to.$method::<15>($($argument),*),
            _ => $to.$method::<20>($($argument),*),
        }
    };
}
pub(super) use of_nodes;

/// Gradients at up to P points of an element of up to N nodes in D dimensions, with S components of
/// strain.
#[derive(Debug, Clone)]
pub struct Gradients<const D: usize, const S: usize, const P: usize, const N: usize> {
    pub(super) table: &'static ShapeFunctionTable<D, P, N>,
    pub(super) has_mean: bool,
    /// Inverse Jacobian, `dxi_a/dx_d` as `[d][a]`.
    inverse: [[Lanes<P>; D]; D],
    /// Quadrature weight times Jacobian determinant times thickness (1) or circumference (2 pi r).
    pub(super) weights: Lanes<P>,
    /// Reciprocal radius `1/r` at the points if axisymmetric.
    pub(super) per_radius: Option<Lanes<P>>,
    pub(super) shear: Option<ShearFromCenter<D, P>>,
}

/// Shear of an axisymmetric `quad4` ([`super`]). A gradient at the centre is the unweighted mean
/// over the points of the gradients along the reference coordinates, times the inverse of the mean
/// Jacobian.
#[derive(Debug, Clone)]
pub(super) struct ShearFromCenter<const D: usize, const P: usize> {
    /// Factors `sqrt(r/r_c)` at the points.
    pub(super) factors: Lanes<P>,
    /// Inverse Jacobian at the centre, `dxi_a/dy`.
    inverse: [f64; D],
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> Gradients<D, S, P, N> {
    /// Computes the gradients at the points of `table` from the coordinates of the element's nodes.
    #[inline]
    pub(super) fn new(
        table: &'static ShapeFunctionTable<D, P, N>,
        space: Space,
        has_mean: bool,
        nodes: &[[f64; D]; N],
    ) -> Self {
        let jacobian = of_nodes!(table.n_nodes, table, along, nodes);
        let (inverse, determinant) = inverted(&jacobian);
        let mut out = Gradients {
            table,
            has_mean,
            inverse,
            weights: std::array::from_fn(|g| table.weights[g] * determinant[g]),
            per_radius: None,
            shear: None,
        };
        if space.is_axisymmetric() {
            let radius = table.interpolated(|k| nodes[k][0]);
            for (weight, r) in out.weights.iter_mut().zip(&radius) {
                *weight *= space.measure(*r);
            }
            if has_mean {
                let mean = |lanes: &Lanes<P>| plain_mean(lanes, table.n_points);
                let (inverse, _) = inverted(&jacobian.map(|row| row.map(|j| [mean(&j)])));
                let of_center = mean(&radius);
                out.shear = Some(ShearFromCenter {
                    factors: radius.map(|r| (r / of_center).sqrt()),
                    inverse: inverse[1].map(|[dxi]| dxi),
                });
            }
            out.per_radius = Some(radius.map(|r| 1.0 / r));
        }
        out
    }

    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.table.n_points
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.table.n_nodes
    }

    /// Weights of the points: quadrature weight times Jacobian determinant times thickness (1) or
    /// circumference (2 pi r).
    pub fn weights(&self) -> &[f64] {
        &self.weights[..self.n_points()]
    }

    /// Coordinates of the points, axis by axis, from the coordinates of the nodes.
    pub fn positions(&self, nodes: &[[f64; D]; N]) -> [Lanes<P>; D] {
        std::array::from_fn(|d| self.table.interpolated(|k| nodes[k][d]))
    }

    /// Values at the points of the field that has the values `nodal` at the nodes.
    #[inline]
    pub fn at_points(&self, nodal: &[f64; N]) -> Lanes<P> {
        self.table.interpolated(|k| nodal[k])
    }

    /// Mean of each component over the element's volume.
    #[inline]
    pub fn mean<const C: usize>(&self, values: &[Lanes<P>; C]) -> [f64; C] {
        let volume: f64 = self.weights.iter().sum();
        values.map(|lanes| dot(&lanes, &self.weights) / volume)
    }

    /// Strains at the points from the displacements of the nodes.
    #[inline]
    pub fn strains(&self, u: &[[f64; D]; N]) -> Components<S, P> {
        let mut out = self.local_strains(u);
        if self.has_mean {
            let [mean] = self.mean(&[trace(&out)]);
            set_trace(&mut out, mean);
        }
        out
    }

    /// Nodal forces of a stress, `f = sum_g w_g B' sigma`.
    #[inline]
    pub fn forces(&self, stress: &Components<S, P>) -> [[f64; D]; N] {
        let mut stress = *stress;
        if self.has_mean {
            let [mean] = self.mean(&[trace(&stress)]);
            set_trace(&mut stress, mean);
        }
        of_nodes!(self.n_nodes(), self, forces_of, &stress)
    }

    /// Strains of the displacements without replacing the dilatation by its mean.
    #[inline]
    pub(super) fn local_strains(&self, u: &[[f64; D]; N]) -> Components<S, P> {
        let along = of_nodes!(self.n_nodes(), self.table, along, u);
        // slope(i, d) is du_i/dx_d
        let slope = |i: usize, d: usize| {
            let mut out = [0.0; P];
            for (inverse, along) in self.inverse[d].iter().zip(&along[i]) {
                for g in 0..P {
                    out[g] += inverse[g] * along[g];
                }
            }
            out
        };
        let mut out = [[0.0; P]; S];
        for (d, out) in out.iter_mut().enumerate().take(D) {
            *out = slope(d, d);
        }
        for (out, [i, j]) in out[3..].iter_mut().zip(SHEARS) {
            let (a, b) = (slope(i, j), slope(j, i));
            for g in 0..P {
                out[g] = a[g] + b[g];
            }
        }
        if let Some(shear) = &self.shear {
            let terms = shear.inverse.iter().zip(&along[0]);
            let n = self.n_points();
            let at_center: f64 = terms.map(|(dxi, along)| dxi * plain_mean(along, n)).sum();
            let at_point = slope(1, 0);
            for g in 0..P {
                out[3][g] = shear.factors[g] * (at_center + at_point[g]);
            }
        }
        if let Some(per_radius) = &self.per_radius {
            let radial = self.table.interpolated(|k| u[k][0]);
            for g in 0..P {
                out[2][g] = per_radius[g] * radial[g];
            }
        }
        out
    }

    #[inline]
    fn forces_of<const K: usize>(&self, stress: &Components<S, P>) -> [[f64; D]; N] {
        let mut weighted = *stress;
        for lanes in &mut weighted {
            for g in 0..P {
                lanes[g] *= self.weights[g];
            }
        }
        if let Some(shear) = &self.shear {
            for g in 0..P {
                weighted[3][g] *= shear.factors[g];
            }
        }
        // Factors of the reference gradients in the forces along each axis.
        let mut fluxes = [[[0.0; P]; D]; D];
        for (i, fluxes) in fluxes.iter_mut().enumerate() {
            for (d, inverse) in self.inverse.iter().enumerate() {
                if let (Some(shear), 0, 1) = (&self.shear, i, d) {
                    // The gradient at the centre is the mean of the gradients at the points.
                    let share = plain_mean(&weighted[3], self.n_points());
                    for (flux, dxi) in fluxes.iter_mut().zip(shear.inverse) {
                        flux.iter_mut().for_each(|flux| *flux += dxi * share);
                    }
                    continue;
                }
                let stress = &weighted[component(i, d)];
                for (flux, inverse) in fluxes.iter_mut().zip(inverse) {
                    for g in 0..P {
                        flux[g] += inverse[g] * stress[g];
                    }
                }
            }
        }
        let mut out = [[0.0; D]; N];
        for (force, gradients) in out.iter_mut().zip(&self.table.gradients).take(K) {
            for (force, fluxes) in force.iter_mut().zip(&fluxes) {
                let mut terms = [0.0; P];
                for (gradient, flux) in gradients.iter().zip(fluxes) {
                    for g in 0..P {
                        terms[g] += gradient[g] * flux[g];
                    }
                }
                *force = sum(&terms);
            }
        }
        if let Some(per_radius) = &self.per_radius {
            let hoop = std::array::from_fn(|g| per_radius[g] * weighted[2][g]);
            for (force, values) in out.iter_mut().zip(&self.table.values).take(K) {
                force[0] += dot(values, &hoop);
            }
        }
        out
    }

    /// Gradients of the shape functions, `dN_k/dx_d` at the points as `[k][d]`.
    #[inline]
    pub(super) fn of_functions<const K: usize>(&self) -> [[Lanes<P>; D]; K] {
        let mut out = [[[0.0; P]; D]; K];
        for (out, gradients) in out.iter_mut().zip(&self.table.gradients) {
            for (out, inverse) in out.iter_mut().zip(&self.inverse) {
                for (inverse, gradient) in inverse.iter().zip(gradients) {
                    for g in 0..P {
                        out[g] += inverse[g] * gradient[g];
                    }
                }
            }
        }
        out
    }

    /// Derivatives `dN_k/dy` of the shape functions at the centre, for the shear taken there.
    pub(super) fn at_center<const K: usize>(&self, shear: &ShearFromCenter<D, P>) -> [f64; K] {
        std::array::from_fn(|k| {
            let terms = shear.inverse.iter().zip(&self.table.gradients[k]);
            terms
                .map(|(dxi, gradient)| dxi * plain_mean(gradient, self.n_points()))
                .sum()
        })
    }
}

/// Axes of each shear component, in the order of the components.
const SHEARS: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Index of the component along axes `i` and `j` in `[xx yy zz xy | yz zx]`.
const fn component(i: usize, j: usize) -> usize {
    match (i == j, i + j) {
        (true, _) => i,
        (_, 1) => 3,
        (_, 3) => 4,
        _ => 5,
    }
}

/// Returns the inverse of the Jacobian `dx_d/dxi_a` (`[d][a]`) as `dxi_a/dx_d` (`[d][a]`), and its
/// determinant, at all points.
#[inline]
fn inverted<const D: usize, const P: usize>(
    jacobian: &[[Lanes<P>; D]; D],
) -> ([[Lanes<P>; D]; D], Lanes<P>) {
    let mut inverse = [[[0.0; P]; D]; D];
    for d in 0..D {
        for a in 0..D {
            inverse[d][a] = cofactor(jacobian, d, a);
        }
    }
    let mut determinant = [0.0; P];
    for (j, c) in jacobian[0].iter().zip(&inverse[0]) {
        for g in 0..P {
            determinant[g] += j[g] * c[g];
        }
    }
    let reciprocal = determinant.map(|determinant| 1.0 / determinant);
    for lanes in inverse.as_flattened_mut() {
        for g in 0..P {
            lanes[g] *= reciprocal[g];
        }
    }
    (inverse, determinant)
}

#[inline]
fn cofactor<const D: usize, const P: usize>(
    j: &[[Lanes<P>; D]; D],
    d: usize,
    a: usize,
) -> Lanes<P> {
    if D == 2 {
        let sign = if d == a { 1.0 } else { -1.0 };
        return j[1 - d][1 - a].map(|j| sign * j);
    }
    let [d1, d2, a1, a2] = [(d + 1) % D, (d + 2) % D, (a + 1) % D, (a + 2) % D];
    std::array::from_fn(|g| j[d1][a1][g] * j[d2][a2][g] - j[d1][a2][g] * j[d2][a1][g])
}

#[inline]
fn trace<const S: usize, const P: usize>(components: &Components<S, P>) -> Lanes<P> {
    let (x, y, z) = (&components[0], &components[1], &components[2]);
    std::array::from_fn(|g| x[g] + y[g] + z[g])
}

/// Changes the normal components by equal amounts so that their sum is `mean` at every point.
#[inline]
pub(super) fn set_trace<const S: usize, const P: usize>(
    components: &mut Components<S, P>,
    mean: f64,
) {
    let change = trace(components).map(|trace| (mean - trace) * (1.0 / 3.0));
    for normal in &mut components[..3] {
        for g in 0..P {
            normal[g] += change[g];
        }
    }
}

#[inline]
pub(super) fn dot<const P: usize>(a: &Lanes<P>, b: &Lanes<P>) -> f64 {
    sum::<P>(&std::array::from_fn(|g| a[g] * b[g]))
}

/// Sums numbers by pairs.
#[inline]
pub(super) fn sum<const P: usize>(lanes: &Lanes<P>) -> f64 {
    let (mut lanes, mut n) = (*lanes, P);
    while n > 1 {
        let pairs = n / 2;
        for g in 0..pairs {
            lanes[g] = lanes[2 * g] + lanes[2 * g + 1];
        }
        if n % 2 == 1 {
            lanes[pairs] = lanes[n - 1];
        }
        n = n.div_ceil(2);
    }
    lanes[0]
}

/// Unweighted mean over the first `n` points.
#[inline]
fn plain_mean<const P: usize>(lanes: &Lanes<P>, n: usize) -> f64 {
    match n == P {
        true => sum(lanes) / P as f64,
        false => lanes[..n].iter().sum::<f64>() / n as f64,
    }
}
