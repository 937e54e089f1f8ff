//! Strains and forces of an element that is looked at once: without its strain operator.
//!
//! The gradients of the shape functions in the reference element are the same for all elements of a
//! shape. With the Jacobian `J = sum_k x_k dN_k/dxi` of a point
//!
//! ```text
//! du/dx = J^-T sum_k u_k dN_k/dxi          f_k = sum_g (J^-1 w sigma) dN_k/dxi
//! ```
//!
//! take eight products each for a node and point, a fraction of what the gradients `dN_k/dx` of an
//! operator ([`super::Points`]) take to be made. With a mean dilatation (B-bar) the trace of the
//! strain is replaced by its mean over the element, and in the forces the mean stress by its mean:
//! the same as the mean of `tr B` over the nodes. Points are computed side by side: every quantity
//! is an array over them. A gradient at the centre of a `quad4` is the plain mean of those along
//! the reference coordinates at its points, through the inverse of the mean Jacobian.

use super::{MAX_POINTS, has_mean};
use crate::scene::Kind;
use crate::shape::{MAX_NODES, Rule, Shape};
use std::sync::LazyLock;

/// A number at each point; beyond the number of points that of the first.
pub type Lanes = [f64; MAX_POINTS];
/// Stress or strain at the points, component by component.
pub type Components = [Lanes; 4];

/// The points of a shape in its reference element.
struct Reference {
    /// Zero beyond the number of points.
    weights: Lanes,
    values: [Lanes; MAX_NODES],
    /// Along both reference coordinates.
    gradients: [[Lanes; 2]; MAX_NODES],
}

impl Reference {
    fn new(shape: Shape, points: &Rule) -> Self {
        let mut out = Reference {
            weights: [0.0; MAX_POINTS],
            values: [[0.0; MAX_POINTS]; MAX_NODES],
            gradients: [[[0.0; MAX_POINTS]; 2]; MAX_NODES],
        };
        for g in 0..MAX_POINTS {
            let (at, weight) = points.get(g).copied().unwrap_or((points[0].0, 0.0));
            let at = shape.functions(at);
            out.weights[g] = weight;
            for k in 0..MAX_NODES {
                out.values[k][g] = at.values[k];
                for d in 0..2 {
                    out.gradients[k][d][g] = at.gradients[k][d];
                }
            }
        }
        out
    }
}

static GAUSS: LazyLock<[Reference; 4]> =
    LazyLock::new(|| Shape::ALL.map(|s| Reference::new(s, s.reference().gauss)));
static SAMPLING: LazyLock<[Reference; 4]> =
    LazyLock::new(|| Shape::ALL.map(|s| Reference::new(s, s.reference().sampling)));

/// The map from the reference element at the points of an element.
pub struct Mapping {
    reference: &'static Reference,
    n_nodes: usize,
    n_points: usize,
    has_mean: bool,
    /// `dxi/dx, deta/dx, dxi/dy, deta/dy`.
    inverse: [Lanes; 4],
    /// Quadrature weight times Jacobian times thickness (1) or circumference (2 pi r).
    weights: Lanes,
    /// `1/r`, axisymmetric.
    per_radius: Option<Lanes>,
    shear: Option<ShearFromCenter>,
}

/// The shear of an axisymmetric `quad4` ([`super`]).
struct ShearFromCenter {
    /// `sqrt(r/r_c)`.
    factors: Lanes,
    /// `dxi/dy, deta/dy` at the centre.
    inverse: [f64; 2],
}

impl Mapping {
    /// The map at the Gauss points, for the coordinates of the element's nodes.
    #[inline]
    pub fn gauss(kind: Kind, shape: Shape, nodes: &[[f64; 2]; MAX_NODES]) -> Self {
        let reference = &GAUSS[shape as usize];
        Self::new(kind, shape, reference, shape.n_gauss_points(), nodes)
    }

    #[inline]
    fn new(
        kind: Kind,
        shape: Shape,
        reference: &'static Reference,
        n_points: usize,
        nodes: &[[f64; 2]; MAX_NODES],
    ) -> Self {
        let n_nodes = shape.n_nodes();
        let [x_xi, x_eta, y_xi, y_eta] = along_reference(reference, n_nodes, nodes);
        let mut inverse = [[0.0; MAX_POINTS]; 4];
        let mut weights = [0.0; MAX_POINTS];
        for g in 0..MAX_POINTS {
            let determinant = x_xi[g] * y_eta[g] - y_xi[g] * x_eta[g];
            let reciprocal = 1.0 / determinant;
            inverse[0][g] = y_eta[g] * reciprocal;
            inverse[1][g] = -y_xi[g] * reciprocal;
            inverse[2][g] = -x_eta[g] * reciprocal;
            inverse[3][g] = x_xi[g] * reciprocal;
            weights[g] = reference.weights[g] * determinant;
        }
        let mut out = Mapping {
            reference,
            n_nodes,
            n_points,
            has_mean: has_mean(kind, shape),
            inverse,
            weights,
            per_radius: None,
            shear: None,
        };
        if kind == Kind::Axisymmetric {
            let radius = out.interpolated(|k| nodes[k][0]);
            for (weight, r) in out.weights.iter_mut().zip(&radius) {
                *weight *= 2.0 * std::f64::consts::PI * r;
            }
            if out.has_mean {
                let [x_xi, x_eta, y_xi, y_eta] = [x_xi, x_eta, y_xi, y_eta].map(|j| plain_mean(&j));
                let determinant = x_xi * y_eta - y_xi * x_eta;
                let of_center = plain_mean(&radius);
                out.shear = Some(ShearFromCenter {
                    factors: radius.map(|r| (r / of_center).sqrt()),
                    inverse: [-x_eta / determinant, x_xi / determinant],
                });
            }
            out.per_radius = Some(radius.map(|r| 1.0 / r));
        }
        out
    }

    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.n_points
    }

    /// Weights of the points: quadrature weight times Jacobian times thickness (1) or circumference
    /// (2 pi r).
    pub fn weights(&self) -> &[f64] {
        &self.weights[..self.n_points]
    }

    /// Coordinates of the points, `x` then `y`.
    pub fn positions(&self, nodes: &[[f64; 2]; MAX_NODES]) -> [Lanes; 2] {
        [0, 1].map(|d| self.interpolated(|k| nodes[k][d]))
    }

    /// Mean over the element.
    #[inline]
    pub fn mean<const C: usize>(&self, values: &[Lanes; C]) -> [f64; C] {
        let volume: f64 = self.weights.iter().sum();
        values.map(|lanes| dot(&lanes, &self.weights) / volume)
    }

    /// Strains `[xx, yy, zz, xy]` at the points for displacements of the nodes in global axes.
    #[inline]
    pub fn strains(&self, u: &[[f64; 2]; MAX_NODES]) -> Components {
        let mut out = self.local_strains(u);
        if self.has_mean {
            let [mean] = self.mean(&[trace(&out)]);
            set_trace(&mut out, mean);
        }
        out
    }

    /// `f = sum_g w_g B' sigma` on the nodes, in global axes.
    #[inline]
    pub fn forces(&self, stress: &Components) -> [[f64; 2]; MAX_NODES] {
        let mut stress = *stress;
        if self.has_mean {
            let [mean] = self.mean(&[trace(&stress)]);
            set_trace(&mut stress, mean);
        }
        match self.n_nodes {
            3 => self.forces_of::<3>(&stress),
            4 => self.forces_of::<4>(&stress),
            6 => self.forces_of::<6>(&stress),
            _ => self.forces_of::<8>(&stress),
        }
    }

    /// Strains of the displacements alone, their dilatation as it is.
    #[inline]
    fn local_strains(&self, u: &[[f64; 2]; MAX_NODES]) -> Components {
        let [u_xi, u_eta, v_xi, v_eta] = along_reference(self.reference, self.n_nodes, u);
        let [xi_x, eta_x, xi_y, eta_y] = &self.inverse;
        let mut out = Components::default();
        for g in 0..MAX_POINTS {
            out[0][g] = xi_x[g] * u_xi[g] + eta_x[g] * u_eta[g];
            out[1][g] = xi_y[g] * v_xi[g] + eta_y[g] * v_eta[g];
            out[3][g] = (xi_y[g] * u_xi[g] + eta_y[g] * u_eta[g])
                + (xi_x[g] * v_xi[g] + eta_x[g] * v_eta[g]);
        }
        if let Some(shear) = &self.shear {
            let [xi, eta] = shear.inverse;
            let slope = xi * plain_mean(&u_xi) + eta * plain_mean(&u_eta);
            for g in 0..MAX_POINTS {
                let of_y = xi_x[g] * v_xi[g] + eta_x[g] * v_eta[g];
                out[3][g] = shear.factors[g] * (slope + of_y);
            }
        }
        if let Some(per_radius) = &self.per_radius {
            let radial = self.interpolated(|k| u[k][0]);
            for g in 0..MAX_POINTS {
                out[2][g] = per_radius[g] * radial[g];
            }
        }
        out
    }

    #[inline]
    fn forces_of<const N: usize>(&self, stress: &Components) -> [[f64; 2]; MAX_NODES] {
        let [xi_x, eta_x, xi_y, eta_y] = &self.inverse;
        // What the reference gradients are multiplied by: for the forces along x and y.
        let mut fluxes = [[[0.0; MAX_POINTS]; 2]; 2];
        let mut shears = [0.0; MAX_POINTS];
        // How much of the shear acts at the points: along x, and along y.
        let (at_point, factors) = match &self.shear {
            Some(of_center) => (0.0, of_center.factors),
            None => (1.0, [1.0; MAX_POINTS]),
        };
        for g in 0..MAX_POINTS {
            let weight = self.weights[g];
            let (x, y, shear) = (
                weight * stress[0][g],
                weight * stress[1][g],
                weight * stress[3][g],
            );
            let (along_x, along_y) = (at_point * shear, factors[g] * shear);
            shears[g] = along_y;
            fluxes[0][0][g] = xi_x[g] * x + xi_y[g] * along_x;
            fluxes[0][1][g] = eta_x[g] * x + eta_y[g] * along_x;
            fluxes[1][0][g] = xi_y[g] * y + xi_x[g] * along_y;
            fluxes[1][1][g] = eta_y[g] * y + eta_x[g] * along_y;
        }
        if let Some(of_center) = &self.shear {
            // The gradient at the centre is the mean of those at the points.
            let share = 0.25 * sum(&shears);
            for (fluxes, along) in fluxes[0].iter_mut().zip(of_center.inverse) {
                fluxes.iter_mut().for_each(|flux| *flux += along * share);
            }
        }
        let mut out = [[0.0; 2]; MAX_NODES];
        for (k, force) in out.iter_mut().enumerate().take(N) {
            let [xi, eta] = &self.reference.gradients[k];
            for (force, [along_xi, along_eta]) in force.iter_mut().zip(&fluxes) {
                let mut terms = [0.0; MAX_POINTS];
                for g in 0..MAX_POINTS {
                    terms[g] = xi[g] * along_xi[g] + eta[g] * along_eta[g];
                }
                *force = sum(&terms);
            }
        }
        if let Some(per_radius) = &self.per_radius {
            let mut hoop = [0.0; MAX_POINTS];
            for g in 0..MAX_POINTS {
                hoop[g] = self.weights[g] * per_radius[g] * stress[2][g];
            }
            for (force, values) in out.iter_mut().zip(&self.reference.values).take(N) {
                force[0] += dot(values, &hoop);
            }
        }
        out
    }

    /// A field with the nodal values `of` at the points.
    #[inline]
    fn interpolated(&self, of: impl Fn(usize) -> f64) -> Lanes {
        let mut out = [0.0; MAX_POINTS];
        for (k, values) in self.reference.values.iter().enumerate().take(self.n_nodes) {
            let value = of(k);
            for g in 0..MAX_POINTS {
                out[g] += values[g] * value;
            }
        }
        out
    }
}

/// Strains at the points where stress is most accurate ([`crate::shape::Reference`]), their dilatation
/// treated as in [`Mapping::strains`]; the number of these points.
pub fn sampled_strains(
    kind: Kind,
    shape: Shape,
    nodes: &[[f64; 2]; MAX_NODES],
    u: &[[f64; 2]; MAX_NODES],
) -> (Components, usize) {
    let n_points = shape.reference().sampling.len();
    let at = Mapping::new(kind, shape, &SAMPLING[shape as usize], n_points, nodes);
    let mut out = at.local_strains(u);
    if at.has_mean {
        let gauss = Mapping::gauss(kind, shape, nodes);
        let [mean] = gauss.mean(&[trace(&gauss.local_strains(u))]);
        set_trace(&mut out, mean);
    }
    (out, n_points)
}

/// Derivatives of a vector field with the values `of` at the nodes along the reference coordinates:
/// of its first component, then of its second.
#[inline]
fn along_reference(
    reference: &Reference,
    n_nodes: usize,
    of: &[[f64; 2]; MAX_NODES],
) -> [Lanes; 4] {
    match n_nodes {
        3 => along_reference_of::<3>(reference, of),
        4 => along_reference_of::<4>(reference, of),
        6 => along_reference_of::<6>(reference, of),
        _ => along_reference_of::<8>(reference, of),
    }
}

#[inline]
fn along_reference_of<const N: usize>(
    reference: &Reference,
    of: &[[f64; 2]; MAX_NODES],
) -> [Lanes; 4] {
    let mut out = [[0.0; MAX_POINTS]; 4];
    for ([xi, eta], [x, y]) in reference.gradients.iter().zip(of).take(N) {
        for g in 0..MAX_POINTS {
            out[0][g] += xi[g] * x;
            out[1][g] += eta[g] * x;
            out[2][g] += xi[g] * y;
            out[3][g] += eta[g] * y;
        }
    }
    out
}

#[inline]
fn trace([x, y, z, _]: &Components) -> Lanes {
    std::array::from_fn(|g| x[g] + y[g] + z[g])
}

/// Changes the normal components alike until their sum is `mean` at every point.
#[inline]
fn set_trace(components: &mut Components, mean: f64) {
    let change = trace(components).map(|trace| (mean - trace) * (1.0 / 3.0));
    for normal in &mut components[..3] {
        for g in 0..MAX_POINTS {
            normal[g] += change[g];
        }
    }
}

#[inline]
fn dot(a: &Lanes, b: &Lanes) -> f64 {
    sum(&std::array::from_fn(|g| a[g] * b[g]))
}

#[inline]
fn sum([a, b, c, d]: &Lanes) -> f64 {
    (a + b) + (c + d)
}

/// Mean over the four points, unweighted.
#[inline]
fn plain_mean(lanes: &Lanes) -> f64 {
    0.25 * sum(lanes)
}
