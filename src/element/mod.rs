//! Element kernels: they see one element's coordinates, never the mesh or the global matrix.
//!
//! Strain is `[xx, yy, zz, xy]` (axisymmetric `[rr, zz, tt, rz]`) with engineering shear,
//! `eps = B u_e`, `K_e = sum_g w_g B' D B`, `f_e = sum_g w_g B' sigma`. Element vectors run node by node,
//! `[u_x0, u_y0, u_x1, ...]`.
//!
//! `quad4` uses the mean dilatation (B-bar), `quad8` reduced integration: neither locks in isochoric
//! plastic flow. `tri3` does.

mod facet;
mod shape_functions;

pub use facet::{FacetPoint, facet_points};
pub use shape_functions::shape_functions;

use crate::material::Matrix4;
use crate::mesh::Shape;
use crate::scene::Kind;

/// Most nodes of an element.
pub const MAX_NODES: usize = 8;
/// Most Gauss points of an element.
pub const MAX_POINTS: usize = 4;
/// Most freedoms of an element.
pub const MAX_FREEDOMS: usize = 2 * MAX_NODES;

/// Strain-displacement matrix at a Gauss point, with the weight of the point.
#[derive(Debug, Clone, Copy)]
pub struct GaussPoint {
    /// `4 x n_freedoms`.
    pub b: [[f64; MAX_FREEDOMS]; 4],
    /// Quadrature weight times Jacobian times thickness (1) or circumference (2 pi r).
    pub weight: f64,
    /// Coordinates.
    pub position: [f64; 2],
}

const EMPTY: GaussPoint = GaussPoint {
    b: [[0.0; MAX_FREEDOMS]; 4],
    weight: 0.0,
    position: [0.0; 2],
};

/// The Gauss points of an element.
#[derive(Debug, Clone, Copy)]
pub struct Points {
    points: [GaussPoint; MAX_POINTS],
    n_points: usize,
    /// Number of freedoms of the element.
    pub n_freedoms: usize,
}

impl Points {
    /// Lets the columns of B of a node act on displacements along the unit vectors `a` and `b`.
    pub fn turn(&mut self, node: usize, a: [f64; 2], b: [f64; 2]) {
        for point in &mut self.points[..self.n_points] {
            for row in &mut point.b {
                let (x, y) = (row[2 * node], row[2 * node + 1]);
                row[2 * node] = x * a[0] + y * a[1];
                row[2 * node + 1] = x * b[0] + y * b[1];
            }
        }
    }
}

impl std::ops::Deref for Points {
    type Target = [GaussPoint];
    fn deref(&self) -> &[GaussPoint] {
        &self.points[..self.n_points]
    }
}

/// Number of Gauss points of a shape.
pub fn n_points(shape: Shape) -> usize {
    rule(shape).len()
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

/// Reference coordinates of the points at which stress is most accurate (superconvergent): the centre of linear
/// elements, the 2 x 2 or 3 Gauss points of quadratic ones.
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

/// Strain-displacement matrices at the Gauss points.
pub fn gauss_points(kind: Kind, shape: Shape, coordinates: &[[f64; 2]]) -> Points {
    let mut out = at_points(kind, shape, coordinates, rule(shape));
    if shape == Shape::Quad4 && kind != Kind::PlaneStress {
        mean_dilatation(&mut out);
    }
    out
}

/// Strain-displacement matrices at the sampling points, with the same treatment of the dilatation.
pub fn sampling(kind: Kind, shape: Shape, coordinates: &[[f64; 2]]) -> Points {
    let points = sampling_points(shape);
    let mut out = at_points(kind, shape, coordinates, points);
    if shape == Shape::Quad4 && kind != Kind::PlaneStress {
        let mean = mean_volume_row(&at_points(kind, shape, coordinates, rule(shape)));
        replace_dilatation(&mut out, &mean);
    }
    out
}

fn at_points(
    kind: Kind,
    shape: Shape,
    coordinates: &[[f64; 2]],
    rule: &[([f64; 2], f64)],
) -> Points {
    let n = shape.n_nodes();
    let mut out = Points {
        points: [EMPTY; MAX_POINTS],
        n_points: rule.len(),
        n_freedoms: 2 * n,
    };
    for (point, (reference, weight)) in out.points.iter_mut().zip(rule) {
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
        for i in 0..n {
            let [a, b] = gradients[i];
            let dx = (jacobian[1][1] * a - jacobian[0][1] * b) / determinant;
            let dy = (jacobian[0][0] * b - jacobian[1][0] * a) / determinant;
            point.b[0][2 * i] = dx;
            point.b[1][2 * i + 1] = dy;
            point.b[3][2 * i] = dy;
            point.b[3][2 * i + 1] = dx;
            if kind == Kind::Axisymmetric {
                point.b[2][2 * i] = values[i] / x[0];
            }
        }
        point.position = x;
        point.weight = weight * determinant;
        if kind == Kind::Axisymmetric {
            point.weight *= 2.0 * std::f64::consts::PI * x[0];
        }
    }
    out
}

fn mean_volume_row(points: &Points) -> [f64; MAX_FREEDOMS] {
    let mut mean = [0.0; MAX_FREEDOMS];
    let mut volume = 0.0;
    for point in points.iter() {
        volume += point.weight;
        for (k, m) in mean.iter_mut().enumerate().take(points.n_freedoms) {
            *m += point.weight * (point.b[0][k] + point.b[1][k] + point.b[2][k]);
        }
    }
    mean.map(|m| m / volume)
}

fn replace_dilatation(points: &mut Points, mean: &[f64; MAX_FREEDOMS]) {
    let n = points.n_points;
    for point in &mut points.points[..n] {
        for k in 0..points.n_freedoms {
            let change = (mean[k] - (point.b[0][k] + point.b[1][k] + point.b[2][k])) / 3.0;
            for row in 0..3 {
                point.b[row][k] += change;
            }
        }
    }
}

/// B-bar: the dilatation is replaced by its mean over the element.
///
/// # Source
/// T. J. R. Hughes, *The Finite Element Method* (1987), section 4.5.
fn mean_dilatation(points: &mut Points) {
    let mean = mean_volume_row(points);
    replace_dilatation(points, &mean);
}

/// `K_e`, row-major `n x n` with `n = n_freedoms`, into the front of `out`.
pub fn stiffness_into(points: &Points, elastic: &Matrix4, out: &mut [f64]) {
    let n = points.n_freedoms;
    out[..n * n].fill(0.0);
    for point in points.iter() {
        let mut db = [[0.0; MAX_FREEDOMS]; 4];
        for i in 0..4 {
            for j in 0..4 {
                let d = elastic[i][j] * point.weight;
                if d != 0.0 {
                    for k in 0..n {
                        db[i][k] += d * point.b[j][k];
                    }
                }
            }
        }
        for r in 0..n {
            for i in 0..4 {
                let b = point.b[i][r];
                if b != 0.0 {
                    for k in 0..n {
                        out[r * n + k] += b * db[i][k];
                    }
                }
            }
        }
    }
}

impl GaussPoint {
    /// `eps = B u_e`.
    pub fn strain(&self, displacement: &[f64]) -> [f64; 4] {
        std::array::from_fn(|i| self.b[i].iter().zip(displacement).map(|(b, u)| b * u).sum())
    }

    /// Adds `w B' sigma` to an element vector.
    pub fn add_force(&self, stress: &[f64; 4], out: &mut [f64]) {
        for i in 0..4 {
            let s = self.weight * stress[i];
            for (f, b) in out.iter_mut().zip(&self.b[i]) {
                *f += b * s;
            }
        }
    }
}

#[cfg(test)]
mod tests;
