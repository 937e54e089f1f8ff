//! Element kernels: they see one element's coordinates, never the mesh or the global matrix.
//!
//! Strain is `[xx, yy, zz, xy]` (axisymmetric `[rr, zz, tt, rz]`) with engineering shear,
//! `eps = B u_e`, `K_e = sum_g w_g B' D B`, `f_e = sum_g w_g B' sigma`. Element vectors run node by
//! node, `[u_x0, u_y0, u_x1, ...]`.
//!
//! `quad4` uses the mean dilatation (B-bar), `quad8` reduced integration: neither locks in
//! isochoric plastic flow. `tri3` does.
//!
//! # What `quad4` leaves at an axis of revolution
//!
//! Next to the axis a regular field is `u_r = a r z`, `u_z = b r^2 + c z^2` to second order. In a
//! bilinear element `b r^2` has the slope of the centre, and the virtual work of its shear is wrong
//! by a share that the next element makes good; on the axis there is none. What is left acts as a
//! line load of the order `h^2` along the axis, and stresses beside it are of the order `h`: the
//! pole's pressure of Hertz' point contact is 1.0 % low with 12 elements over its radius. With the
//! shear `sqrt(r/r_c) (du_r/dz at the centre + du_z/dr)`, `r_c` the radius of the centre, that
//! field is in equilibrium node by node, and the pressure is 0.07 % off; plates and rings of flat
//! elements do not lock, but bend 2 % too easily with four elements over the thickness. It was
//! built, measured and left out: errors of that size change their sign from mesh to mesh, so that
//! what other meshes say of them was wrong by 0.1 to 19 times, and of 74 stated errors 64 held
//! instead of 71. (With `du_r/dz` at the point, times `sqrt(r_c/r)`, the field is in equilibrium
//! too, but a ring that turns in its section is 13 to 45 % too stiff.)

mod facet;
mod mapping;
mod operator;
mod shape_functions;

pub use facet::{FacetPoint, facet_points};
pub use mapping::{Components, Lanes, Mapping, sampled_strains};
pub use operator::{AtPoints, Form, packed};
pub use shape_functions::shape_functions;

use crate::material::Matrix4;
use crate::mesh::Shape;
use crate::scene::Kind;
use operator::MAX_VALUES;

/// Most nodes of an element.
pub const MAX_NODES: usize = 8;
/// Most Gauss points of an element.
pub const MAX_POINTS: usize = 4;
/// Most freedoms of an element.
pub const MAX_FREEDOMS: usize = 2 * MAX_NODES;

/// Points of an element with the strain operator at them, in global axes.
#[derive(Debug, Clone, Copy)]
pub struct Points {
    form: Form,
    values: [f64; MAX_VALUES],
    positions: [[f64; 2]; MAX_POINTS],
}

impl Points {
    /// Number of points.
    pub fn len(&self) -> usize {
        usize::from(self.form.n_points)
    }

    /// Never: every element has a point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of freedoms of the element.
    pub fn n_freedoms(&self) -> usize {
        2 * usize::from(self.form.n_nodes)
    }

    /// What stands in [`Points::values`].
    pub fn form(&self) -> Form {
        self.form
    }

    /// The numbers of the operator.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.form.n_values()]
    }

    /// Coordinates of the points.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions[..self.len()]
    }

    /// Weights of the points: quadrature weight times Jacobian times thickness (1) or circumference
    /// (2 pi r).
    pub fn weights(&self) -> impl Iterator<Item = f64> {
        let stride = self.form.stride();
        (0..self.len()).map(move |g| self.values[g * stride])
    }

    /// `eps = B u_e` at all points.
    pub fn strains(&self, u: &[f64; MAX_FREEDOMS]) -> AtPoints {
        self.form.strains(&self.values, u)
    }

    /// `f_e = sum_g w_g B' sigma`.
    pub fn forces(&self, stress: &AtPoints) -> [f64; MAX_FREEDOMS] {
        self.form.forces(&self.values, stress)
    }

    /// `K_e` for an isotropic elastic matrix, packed lower triangle ([`packed`]).
    pub fn stiffness_into(&self, elastic: &Matrix4, out: &mut [f64]) {
        self.form.stiffness_into(&self.values, elastic, out);
    }
}

/// Whether the dilatation of an element is replaced by its mean (B-bar).
fn has_mean(kind: Kind, shape: Shape) -> bool {
    shape == Shape::Quad4 && kind != Kind::PlaneStress
}

/// Gauss rule: reference coordinates and weight.
fn rule(shape: Shape) -> &'static [([f64; 2], f64)] {
    const G: f64 = 0.577_350_269_189_625_8;
    const QUAD: [([f64; 2], f64); 4] = [
        ([-G, -G], 1.0),
        ([G, -G], 1.0),
        ([G, G], 1.0),
        ([-G, G], 1.0),
    ];
    const TRI1: [([f64; 2], f64); 1] = [([1.0 / 3.0, 1.0 / 3.0], 0.5)];
    const A: f64 = 1.0 / 6.0;
    const TRI3: [([f64; 2], f64); 3] = [([A, A], A), ([4.0 * A, A], A), ([A, 4.0 * A], A)];
    match shape {
        Shape::Quad4 | Shape::Quad8 => &QUAD,
        Shape::Tri3 => &TRI1,
        Shape::Tri6 => &TRI3,
    }
}

/// Reference coordinates of the points at which stress is most accurate (superconvergent): the
/// centre of linear elements, the 2 x 2 or 3 Gauss points of quadratic ones.
pub fn sampling_points(shape: Shape) -> &'static [([f64; 2], f64)] {
    match shape {
        Shape::Quad4 => &[([0.0, 0.0], 4.0)],
        other => rule(other),
    }
}

/// Number of Gauss points of a shape.
pub fn n_gauss_points(shape: Shape) -> usize {
    rule(shape).len()
}

/// The Gauss points of an element.
#[inline]
pub fn gauss_points(kind: Kind, shape: Shape, coordinates: &[[f64; 2]]) -> Points {
    let mut out = Points::none(kind, shape, rule(shape).len());
    out.evaluate(shape, coordinates, rule(shape));
    if out.form.has_mean {
        let mean = mean_dilatation(&out);
        out.set_mean(&mean);
    }
    out
}

/// The points at which stress is most accurate, with the same treatment of the dilatation.
pub fn sampling(kind: Kind, shape: Shape, coordinates: &[[f64; 2]]) -> Points {
    let points = sampling_points(shape);
    let mut out = Points::none(kind, shape, points.len());
    out.evaluate(shape, coordinates, points);
    if out.form.has_mean {
        let mean = mean_dilatation(&gauss_points(kind, shape, coordinates));
        out.set_mean(&mean);
    }
    out
}

impl Points {
    fn none(kind: Kind, shape: Shape, n_points: usize) -> Self {
        Points {
            form: Form {
                n_nodes: shape.n_nodes() as u8,
                n_points: n_points as u8,
                is_axisymmetric: kind == Kind::Axisymmetric,
                has_mean: has_mean(kind, shape),
            },
            values: [0.0; MAX_VALUES],
            positions: [[0.0; 2]; MAX_POINTS],
        }
    }

    /// Weights, gradients and positions at the points of a rule.
    fn evaluate(&mut self, shape: Shape, coordinates: &[[f64; 2]], rule: &[([f64; 2], f64)]) {
        let (form, n) = (self.form, shape.n_nodes());
        let points = self.values.chunks_exact_mut(form.stride());
        for ((point, position), (reference, weight)) in points.zip(&mut self.positions).zip(rule) {
            let (values, gradients) = shape_functions(shape, *reference);
            let mut x = [0.0; 2];
            let mut jacobian = [[0.0; 2]; 2];
            for (i, c) in coordinates.iter().enumerate().take(n) {
                for d in 0..2 {
                    x[d] += values[i] * c[d];
                    jacobian[0][d] += gradients[i][0] * c[d];
                    jacobian[1][d] += gradients[i][1] * c[d];
                }
            }
            let determinant = jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0];
            for (i, [a, b]) in gradients.into_iter().enumerate().take(n) {
                point[1 + i] = (jacobian[1][1] * a - jacobian[0][1] * b) / determinant;
                point[1 + n + i] = (jacobian[0][0] * b - jacobian[1][0] * a) / determinant;
            }
            point[0] = weight * determinant;
            if form.is_axisymmetric {
                point[0] *= 2.0 * std::f64::consts::PI * x[0];
                for (r, value) in point[1 + 2 * n..].iter_mut().zip(values) {
                    *r = value / x[0];
                }
            }
            *position = x;
        }
    }
}

/// B-bar: the mean over the element of `tr B`, `m_x` of all nodes, then `m_y`.
///
/// # Source
/// T. J. R. Hughes, *The Finite Element Method* (1987), section 4.5.
fn mean_dilatation(points: &Points) -> [f64; MAX_FREEDOMS] {
    let (form, n) = (points.form, usize::from(points.form.n_nodes));
    let mut mean = [0.0; MAX_FREEDOMS];
    let mut volume = 0.0;
    for point in points.values.chunks_exact(form.stride()).take(points.len()) {
        volume += point[0];
        for (m, gradient) in mean.iter_mut().zip(&point[1..=2 * n]) {
            *m += point[0] * gradient;
        }
        if form.is_axisymmetric {
            for (m, r) in mean.iter_mut().zip(&point[1 + 2 * n..]) {
                *m += point[0] * r;
            }
        }
    }
    mean.map(|m| m / volume)
}

impl Points {
    fn set_mean(&mut self, mean: &[f64; MAX_FREEDOMS]) {
        let (start, n) = (self.form.mean_at(), self.n_freedoms());
        self.values[start..start + n].copy_from_slice(&mean[..n]);
    }
}

#[cfg(test)]
mod tests;
