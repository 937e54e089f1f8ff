//! The strain operator of an element without its zeros.
//!
//! With the gradients `n_x = dN/dx`, `n_y = dN/dy`, `n_r = N/r` (axisymmetric) of a node's shape
//! function at a point and the mean dilatation `m` of the element (B-bar) the operator, its
//! transpose and the stiffness are
//!
//! ```text
//! e_xx = sum n_x u + c,  e_yy = sum n_y v + c,  e_zz = sum n_r u + c,  g_xy = sum n_y u + n_x v
//!        c = (sum m_x u + m_y v - sum (n_x + n_r) u + n_y v)/3
//! f_x  = w (n_x s_x + n_r s_z + n_y t + m_x p),  f_y = w (n_y s_y + n_x t + m_y p)
//!        p = mean stress, s = stress less p
//! K    = sum_g w_g B' (D - kappa 1 1') B + V kappa m m'      kappa the bulk modulus, V the volume
//! ```
//!
//! (`c`, `p` and `kappa` are zero without B-bar): for a quad4 about a sixth of the numbers of the
//! full B. What one writes `B' sigma` in books is [`Form::forces`] here, `B u` is
//! [`Form::strains`]. In the shear of an axisymmetric quad4 ([`super`]) `n_y` of the element's
//! centre stands for that of the point, and all of it has a factor.
//!
//! # Source
//! T. J. R. Hughes, *The Finite Element Method* (1987), sections 2.7 and 4.5 (B-bar).

use super::{MAX_FREEDOMS, MAX_POINTS};
use crate::material::Lame;
use crate::shape::MAX_NODES;

/// Stresses or strains at the points of an element.
pub type AtPoints = [[f64; 4]; MAX_POINTS];

/// Most numbers of an operator: four points with weight and three gradients of eight nodes (a quad4
/// has more kinds of them, but four nodes).
pub const MAX_VALUES: usize = MAX_POINTS * (1 + 3 * MAX_NODES);

/// What stands in the values of an operator: per point weight, `n_x`, `n_y` and, axisymmetric,
/// `n_r` of all nodes; then, with B-bar, `m_x` and `m_y` of all nodes. With a shear from the centre
/// every point has its factor behind `n_r`, and `n_y` of the centre of all nodes comes last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    /// Nodes of the element.
    pub n_nodes: u8,
    /// Points.
    pub n_points: u8,
    /// Whether there are hoop strains.
    pub is_axisymmetric: bool,
    /// Whether the dilatation is replaced by its mean.
    pub has_mean: bool,
}

impl Form {
    /// Numbers of each point.
    pub(super) fn stride(self) -> usize {
        self.stride_of(usize::from(self.n_nodes))
    }

    fn stride_of(self, n_nodes: usize) -> usize {
        let n_gradients = 2 + usize::from(self.is_axisymmetric);
        1 + n_nodes * n_gradients + usize::from(self.has_shear_from_center())
    }

    /// Whether the slope `du_r/dz` in the shear is that of the centre, and the shear has a factor:
    /// the axisymmetric quad4.
    pub(super) fn has_shear_from_center(self) -> bool {
        self.is_axisymmetric && self.has_mean
    }

    /// Where the mean dilatation begins.
    pub(super) fn mean_at(self) -> usize {
        usize::from(self.n_points) * self.stride()
    }

    /// Where the gradients of the centre begin.
    pub(super) fn center_at(self) -> usize {
        self.mean_at() + 2 * usize::from(self.n_nodes) * usize::from(self.has_mean)
    }

    /// Numbers of the operator.
    pub fn n_values(self) -> usize {
        let of_center = usize::from(self.n_nodes) * usize::from(self.has_shear_from_center());
        self.center_at() + of_center
    }

    /// `eps = B u` at all points, for element displacements `[u_x0, u_y0, u_x1, ...]` in global
    /// axes.
    #[inline]
    pub fn strains(self, values: &[f64], u: &[f64; MAX_FREEDOMS]) -> AtPoints {
        match self.n_nodes {
            3 => self.strains_of::<3>(values, u),
            4 => self.strains_of::<4>(values, u),
            6 => self.strains_of::<6>(values, u),
            _ => self.strains_of::<8>(values, u),
        }
    }

    /// `f = sum_g w_g B' sigma`, as element vector in global axes.
    #[inline]
    pub fn forces(self, values: &[f64], stress: &AtPoints) -> [f64; MAX_FREEDOMS] {
        match self.n_nodes {
            3 => self.forces_of::<3>(values, stress),
            4 => self.forces_of::<4>(values, stress),
            6 => self.forces_of::<6>(values, stress),
            _ => self.forces_of::<8>(values, stress),
        }
    }

    /// `K_e` for an elastic law, packed lower triangle in global axes, into `out`.
    pub fn stiffness_into(self, values: &[f64], elastic: &Lame, out: &mut [f64]) {
        match self.n_nodes {
            3 => self.stiffness_of::<3>(values, elastic, out),
            4 => self.stiffness_of::<4>(values, elastic, out),
            6 => self.stiffness_of::<6>(values, elastic, out),
            _ => self.stiffness_of::<8>(values, elastic, out),
        }
    }

    fn points<const N: usize>(self, values: &[f64]) -> std::slice::ChunksExact<'_, f64> {
        let stride = self.stride_of(N);
        values[..usize::from(self.n_points) * stride].chunks_exact(stride)
    }

    /// `m_x` and `m_y`.
    fn mean<const N: usize>(self, values: &[f64]) -> Option<(&[f64], &[f64])> {
        self.has_mean.then(|| {
            let start = usize::from(self.n_points) * self.stride_of(N);
            values[start..start + 2 * N].split_at(N)
        })
    }

    /// `n_y` of the centre.
    fn center<const N: usize>(self, values: &[f64]) -> Option<&[f64]> {
        self.has_shear_from_center().then(|| {
            let start = usize::from(self.n_points) * self.stride_of(N) + 2 * N;
            &values[start..start + N]
        })
    }

    fn strains_of<const N: usize>(self, values: &[f64], nodal: &[f64; MAX_FREEDOMS]) -> AtPoints {
        let u: [f64; N] = std::array::from_fn(|k| nodal[2 * k]);
        let v: [f64; N] = std::array::from_fn(|k| nodal[2 * k + 1]);
        let mean = self
            .mean::<N>(values)
            .map(|(x, y)| dot::<N>(x, &u) + dot::<N>(y, &v));
        let slope = self.center::<N>(values).map(|y| dot::<N>(y, &u));
        let mut out = AtPoints::default();
        for (strain, point) in out.iter_mut().zip(self.points::<N>(values)) {
            let (x, y) = (&point[1..=N], &point[1 + N..=2 * N]);
            let mut e = [
                dot::<N>(x, &u),
                dot::<N>(y, &v),
                0.0,
                dot::<N>(y, &u) + dot::<N>(x, &v),
            ];
            if self.is_axisymmetric {
                e[2] = dot::<N>(&point[1 + 2 * N..], &u);
            }
            if let Some(slope) = slope {
                e[3] = point[1 + 3 * N] * (slope + dot::<N>(x, &v));
            }
            if let Some(mean) = mean {
                let change = (mean - (e[0] + e[1] + e[2])) / 3.0;
                for e in &mut e[..3] {
                    *e += change;
                }
            }
            *strain = e;
        }
        out
    }

    fn forces_of<const N: usize>(self, values: &[f64], stress: &AtPoints) -> [f64; MAX_FREEDOMS] {
        let mut fx = [0.0; N];
        let mut fy = [0.0; N];
        let center = self.center::<N>(values);
        let (mut pressure, mut of_center) = (0.0, 0.0);
        for (s, point) in stress.iter().zip(self.points::<N>(values)) {
            let p = if self.has_mean {
                (s[0] + s[1] + s[2]) / 3.0
            } else {
                0.0
            };
            let weight = point[0];
            let [sx, sy, sz, t] = [s[0] - p, s[1] - p, s[2] - p, s[3]].map(|s| weight * s);
            pressure += weight * p;
            let (x, y) = (&point[1..=N], &point[1 + N..=2 * N]);
            // What the shear does along x and along y here.
            let [tx, ty] = if center.is_some() {
                [0.0, point[1 + 3 * N] * t]
            } else {
                [t; 2]
            };
            of_center += ty;
            for k in 0..N {
                fx[k] += x[k] * sx + y[k] * tx;
                fy[k] += y[k] * sy + x[k] * ty;
            }
            if self.is_axisymmetric {
                for (f, r) in fx.iter_mut().zip(&point[1 + 2 * N..]) {
                    *f += r * sz;
                }
            }
        }
        if let Some((x, y)) = self.mean::<N>(values) {
            for k in 0..N {
                fx[k] += x[k] * pressure;
                fy[k] += y[k] * pressure;
            }
        }
        if let Some(y) = center {
            for k in 0..N {
                fx[k] += y[k] * of_center;
            }
        }
        let mut out = [0.0; MAX_FREEDOMS];
        for k in 0..N {
            out[2 * k] = fx[k];
            out[2 * k + 1] = fy[k];
        }
        out
    }

    fn stiffness_of<const N: usize>(self, values: &[f64], elastic: &Lame, out: &mut [f64]) {
        out[..N * (2 * N + 1)].fill(0.0);
        let (mean, center) = (self.mean::<N>(values), self.center::<N>(values));
        let bulk = if self.has_mean { elastic.bulk() } else { 0.0 };
        let mut volume = 0.0;
        for point in self.points::<N>(values) {
            let weight = point[0];
            volume += weight;
            let (lambda, mu) = (weight * (elastic.lambda - bulk), weight * elastic.mu);
            let d: [[f64; 3]; 3] = std::array::from_fn(|i| {
                std::array::from_fn(|j| if i == j { lambda + 2.0 * mu } else { lambda })
            });
            let shear = mu;
            let (x, y) = (&point[1..=N], &point[1 + N..=2 * N]);
            let mut r = [0.0; N];
            if self.is_axisymmetric {
                r.copy_from_slice(&point[1 + 2 * N..=3 * N]);
            }
            // The gradients in the shear: of displacements along x, and along y.
            let (by_x, by_y): ([f64; N], [f64; N]) = match center {
                Some(y) => {
                    let factor = point[1 + 3 * N];
                    let times = |n: &[f64]| std::array::from_fn(|k| factor * n[k]);
                    (times(y), times(x))
                }
                None => (std::array::from_fn(|k| y[k]), std::array::from_fn(|k| x[k])),
            };
            for j in 0..N {
                // Stresses of a unit displacement of node j along x and along y.
                let along_x: [f64; 3] = std::array::from_fn(|i| d[i][0] * x[j] + d[i][2] * r[j]);
                let along_y: [f64; 3] = std::array::from_fn(|i| d[i][1] * y[j]);
                let (shear_x, shear_y) = (shear * by_x[j], shear * by_y[j]);
                for i in j..N {
                    let column = 2 * j;
                    let upper = row_start(2 * i) + column;
                    let lower = row_start(2 * i + 1) + column;
                    out[upper] += x[i] * along_x[0] + r[i] * along_x[2] + by_x[i] * shear_x;
                    out[lower] += y[i] * along_x[1] + by_y[i] * shear_x;
                    out[lower + 1] += y[i] * along_y[1] + by_y[i] * shear_y;
                    if i > j {
                        out[upper + 1] += x[i] * along_y[0] + r[i] * along_y[2] + by_x[i] * shear_y;
                    }
                }
            }
        }
        if let Some((x, y)) = mean {
            let m: [[f64; 2]; N] = std::array::from_fn(|k| [x[k], y[k]]);
            for i in 0..2 * N {
                for j in 0..=i {
                    out[row_start(i) + j] += volume * bulk * m[i / 2][i % 2] * m[j / 2][j % 2];
                }
            }
        }
    }
}

/// First entry of a row of a packed lower triangle.
fn row_start(row: usize) -> usize {
    row * (row + 1) / 2
}

/// Place of (i, j) in a packed lower triangle of a symmetric matrix.
pub fn packed(i: usize, j: usize) -> usize {
    row_start(i.max(j)) + i.min(j)
}

fn dot<const N: usize>(a: &[f64], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a[..N].iter().zip(b) {
        sum += a * b;
    }
    sum
}
