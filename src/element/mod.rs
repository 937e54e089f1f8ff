//! Element kernels: they see one element's coordinates, never the mesh or the global matrix.
//!
//! Strain is `[xx, yy, zz, xy]` (axisymmetric `[rr, zz, tt, rz]`) with engineering shear,
//! `eps = B u_e`, `K_e = sum_g w_g B' D B`, `f_e = sum_g w_g B' sigma`. Element vectors run node by
//! node, `[u_x0, u_y0, u_x1, ...]`.
//!
//! `quad4` uses the mean dilatation (B-bar), `quad8` reduced integration: neither locks in
//! isochoric plastic flow. `tri3` does.
//!
//! # The shear of an axisymmetric `quad4`
//!
//! Next to the axis a regular field is `u_r = a r z`, `u_z = b r^2 + c z^2` to second order, with
//! the shear `(a + 2 b) r`. In a bilinear element `b r^2` has the slope of the centre, and the
//! virtual work of its shear is wrong by a share that the next element makes good; on the axis
//! there is none. What is left acts as a line load of the order `h^2` along the axis, and stresses
//! beside it are wrong by the order `h`. With `r_c` the radius of the centre and
//!
//! ```text
//! g_rz = sqrt(r/r_c) (du_r/dz at the centre + du_z/dr)
//! ```
//!
//! at the Gauss points the work of that field in a variation of `u_z` is
//! `sum w (r/r_c) (a r_c + 2 b r_c) dv/dr = sum w (a + 2 b) r dv/dr`: exact, element by element.
//! The interpolated field then is in equilibrium node by node on rectangles of any size (tested).
//! Constant normal strains and turned sections have what they had.
//!
//! Measured errors in %, with those of the shear at the point and without factor in brackets:
//!
//! - Hertz' point contact, pole pressure at first yield with 8, 16, 32 elements over the radius:
//!   0.01, 0.02, 0.00 (-2.8, -1.5, -0.8); load 0.16, 0.10, 0.06 (-0.01, -0.06, -0.02); radius 0.18,
//!   0.08, 0.04 (0.03, -0.02, -0.01). At three times the load, plastic, the pole's pressure: 0.8,
//!   0.3, 0.1 (-1.7, -1.0, -0.6).
//! - Thick sphere, nu 0.3, bore on the axis, 6, 12, 24 elements: displacement 1.1, 0.5, 0.2 (3.0,
//!   1.1, 0.3); limit pressure with 8, 16, for nu 0.4999 too: 0.47, 0.12 (0.49, 0.12). A circular
//!   punch's limit load is 0.2 % lower than it was, with 40 elements.
//! - Point force beside a block: the largest error of stress at the axis falls with order 1.5
//!   (0.8), to a fifth with 32 elements; the mean error of displacements is 3 to 11 % larger.
//! - Thin plates, four elements over the thickness that are 1, 5, 20 times as wide as high:
//!   deflection 3 to 6, 3 to 5, -1 to 5 (2 to 5, -23 to 0, -82 to -35: shear locks). Rings that
//!   turn in their section, 1 to 10 times as wide: 1 to 5 (-14 to 4). What is left is the mean
//!   dilatation's, of order `h^2`.
//! - Tubes of elements that are long along the axis lock as before (four over the wall, five times
//!   as long: -10), because `du_z/dr` is that of the point. That of the centre mends it (-1 to 1)
//!   and is in equilibrium too, but displacements of massive bodies are a fifth less accurate.
//! - A tube whose bore is pushed along the axis, four elements from radius 1 to 2: -0.6 (-0.3).
//!
//! `du_r/dz` must be that of the centre: with that of the point, times `sqrt(r_c/r)`, the field is
//! in equilibrium too, but sections that turn are sheared, and a ring of flat elements is up to 65
//! % too stiff.
//!
//! # Source
//! The shear is derived here. It is an assumed strain, of the kind of M. Fredriksson,
//! N. S. Ottosen, A simple and accurate four-node axisymmetric element, Int. J. Numer. Meth. Engng
//! 71 (2007) 175-200, doi:10.1002/nme.1939.

mod facet;
mod mapping;
mod operator;

pub use facet::{FacetPoint, facet_points};
pub use mapping::{Components, Lanes, Mapping, sampled_strains};
pub use operator::{AtPoints, Form, packed};

use crate::material::Lame;
use crate::scene::Kind;
use crate::shape::{MAX_NODES, Rule, Shape};
use operator::MAX_VALUES;

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

    /// `K_e` for an elastic law, packed lower triangle ([`packed`]).
    pub fn stiffness_into(&self, elastic: &Lame, out: &mut [f64]) {
        self.form.stiffness_into(&self.values, elastic, out);
    }
}

/// Whether the dilatation of an element is replaced by its mean (B-bar).
fn has_mean(kind: Kind, shape: Shape) -> bool {
    shape.reference().has_mean_dilatation && kind != Kind::PlaneStress
}

/// The Gauss points of an element.
#[inline]
pub fn gauss_points(kind: Kind, shape: Shape, coordinates: &[[f64; 2]]) -> Points {
    let mut out = Points::none(kind, shape, shape.n_gauss_points());
    out.evaluate(shape, coordinates, shape.reference().gauss);
    if out.form.has_mean {
        let mean = mean_dilatation(&out);
        out.set_mean(&mean);
    }
    out
}

/// The points at which stress is most accurate, with the same treatment of the dilatation.
pub fn sampling(kind: Kind, shape: Shape, coordinates: &[[f64; 2]]) -> Points {
    let points = shape.reference().sampling;
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
    fn evaluate(&mut self, shape: Shape, coordinates: &[[f64; 2]], rule: &Rule) {
        let (form, n) = (self.form, shape.n_nodes());
        let center =
            (form.has_shear_from_center()).then(|| Place::new(shape, coordinates, [0.0; 3]));
        let points = self.values.chunks_exact_mut(form.stride());
        for ((point, position), (reference, weight)) in points.zip(&mut self.positions).zip(rule) {
            let at = Place::new(shape, coordinates, *reference);
            for (i, [a, b]) in at.gradients.into_iter().enumerate().take(n) {
                (point[1 + i], point[1 + n + i]) = (a, b);
            }
            point[0] = weight * at.determinant;
            if form.is_axisymmetric {
                point[0] *= 2.0 * std::f64::consts::PI * at.position[0];
                for (r, value) in point[1 + 2 * n..=3 * n].iter_mut().zip(at.values) {
                    *r = value / at.position[0];
                }
            }
            if let Some(center) = &center {
                point[1 + 3 * n] = (at.position[0] / center.position[0]).sqrt();
            }
            *position = at.position;
        }
        if let Some(center) = center {
            let (start, slopes) = (form.center_at(), center.gradients.map(|[_, y]| y));
            self.values[start..start + n].copy_from_slice(&slopes[..n]);
        }
    }
}

/// The shape functions at a place of an element.
struct Place {
    values: [f64; MAX_NODES],
    /// Along the global axes.
    gradients: [[f64; 2]; MAX_NODES],
    position: [f64; 2],
    /// Of the Jacobian.
    determinant: f64,
}

impl Place {
    #[inline]
    fn new(shape: Shape, coordinates: &[[f64; 2]], reference: [f64; 3]) -> Self {
        let n = shape.n_nodes();
        let at = shape.functions(reference);
        let (values, mut gradients) = (at.values, at.gradients.map(|[a, b, _]| [a, b]));
        let mut position = [0.0; 2];
        let mut jacobian = [[0.0; 2]; 2];
        for (i, c) in coordinates.iter().enumerate().take(n) {
            for d in 0..2 {
                position[d] += values[i] * c[d];
                jacobian[0][d] += gradients[i][0] * c[d];
                jacobian[1][d] += gradients[i][1] * c[d];
            }
        }
        let determinant = jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0];
        for gradient in gradients.iter_mut().take(n) {
            let [a, b] = *gradient;
            *gradient = [
                (jacobian[1][1] * a - jacobian[0][1] * b) / determinant,
                (jacobian[0][0] * b - jacobian[1][0] * a) / determinant,
            ];
        }
        Place {
            values,
            gradients,
            position,
            determinant,
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
            for (m, r) in mean.iter_mut().zip(&point[1 + 2 * n..=3 * n]) {
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
