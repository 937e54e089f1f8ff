//! Spheres and circular cylinders on which the nodes of a solid's surface lie.
//!
//! Both are fitted to distances from a centre or an axis by the Gauss-Newton method, which starts
//! from the sphere of least algebraic error or from the axis to which the facets are parallel.
//! Nodes that were placed on such a surface lie on the fitted one up to round-off.

use super::face::MortarFace;
use crate::mesh::{Curve, Mesh, Surface};
use crate::space::{Vector, along, cross, difference, direction, dot, length, unit};
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen};
use std::collections::BTreeMap;

/// Largest distance of a node from a curved surface at which the surface is recognised, relative to
/// the sagitta of the chords between nodes.
pub(super) const OFF: f64 = 1e-2;
/// Smallest ratio of sagitta to chord at which nodes count as off a straight line.
pub(super) const BENT: f64 = 1e-8;
/// Largest turn in degrees from one facet to the next; facets that turn by more form a polygon.
pub(super) const LARGEST_TURN: f64 = 30.0;
/// Smallest number of nodes: twice the number of parameters of a cylinder.
const FEWEST: usize = 10;
/// Largest number of steps of a fit, which converges in a few.
const STEPS: usize = 20;
/// Ratio of eigenvalues of the normals' moments below which facets are parallel to an axis.
const ACROSS: f64 = 0.1;

/// Finds the sphere or cylinder on which the nodes of a surface lie.
pub(super) fn find(mesh: &Mesh, surface: &Surface) -> Option<Curve> {
    let facets = surface.facets.iter();
    let faces: Vec<MortarFace> = facets.map(|&facet| MortarFace::new(mesh, facet)).collect();
    let mut nodes: BTreeMap<usize, Vector> = BTreeMap::new();
    let mut normal_at: BTreeMap<usize, Vector> = BTreeMap::new();
    let straightest = LARGEST_TURN.to_radians().cos();
    for face in &faces {
        for (&node, &x) in face.nodes.iter().zip(&face.x) {
            nodes.insert(node, x);
            let other = *normal_at.entry(node).or_insert(face.normal);
            if dot(other, face.normal) < straightest {
                return None;
            }
        }
    }
    if nodes.len() < FEWEST {
        return None;
    }
    let points: Vec<Vector> = nodes.into_values().collect();
    let fits = |curve: &Curve| is_on(curve, &points, &faces);
    let sphere = || sphere(&points).filter(fits);
    let cylinder = || cylinder(&points, &faces).filter(fits);
    let curve = sphere().or_else(cylinder)?;
    let out = |face: &MortarFace| {
        let from = curve.spine(face.center).map_or([0.0; 3], |spine| spine.0);
        dot(difference(face.center, from), face.normal)
    };
    let outward = out(&faces[0]) > 0.0;
    let agree = faces.iter().all(|face| (out(face) > 0.0) == outward);
    agree.then(|| curve.facing(outward))
}

/// Whether points deviate from a surface by only a small fraction of the deviation of the facets
/// between them.
fn is_on(curve: &Curve, points: &[Vector], faces: &[MortarFace]) -> bool {
    let depth = |face: &MortarFace| {
        let Some((from, radius, _)) = curve.spine(face.center) else {
            return 0.0;
        };
        let out = direction(difference(face.center, from));
        // For a cylinder, distances across the axis only.
        let across = |&x: &Vector| match curve {
            Curve::Cylinder { axis, .. } => dot(difference(x, face.center), cross(*axis, out)),
            _ => length(difference(x, face.center)),
        };
        let half = face
            .x
            .iter()
            .map(across)
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        if half * half <= 2.0 * BENT * radius * half {
            return 0.0;
        }
        half * half / (2.0 * radius)
    };
    let depth = faces.iter().map(depth).fold(0.0, f64::max);
    let off = |&x: &Vector| curve.nearest(x).map_or(f64::INFINITY, |(_, off)| off);
    depth > 0.0 && points.iter().all(|x| off(x) <= OFF * depth)
}

fn mean(points: &[Vector]) -> Vector {
    let sum = points.iter().fold([0.0; 3], |sum, &x| along(sum, 1.0, x));
    sum.map(|x| x / points.len() as f64)
}

/// Least squares: returns the step that minimises `residual + slope . step`.
fn least<const N: usize>(
    rows: impl Iterator<Item = (SVector<f64, N>, f64)>,
) -> Option<SVector<f64, N>> {
    let (mut matrix, mut right) = (SMatrix::<f64, N, N>::zeros(), SVector::<f64, N>::zeros());
    for (slope, residual) in rows {
        matrix += slope * slope.transpose();
        right -= slope * residual;
    }
    let scale: SVector<f64, N> = SVector::from_fn(|i, _| matrix[(i, i)].sqrt());
    if scale.iter().any(|s| *s <= 0.0 || !s.is_finite()) {
        return None;
    }
    let scaled = SMatrix::<f64, N, N>::from_fn(|i, j| matrix[(i, j)] / (scale[i] * scale[j]));
    let solved = scaled.cholesky()?.solve(&right.component_div(&scale));
    let step = solved.component_div(&scale);
    step.iter().all(|s| s.is_finite()).then_some(step)
}

fn sphere(points: &[Vector]) -> Option<Curve> {
    let middle = mean(points);
    // Solves `|x|^2 = 2 c . x + (R^2 - |c|^2)`, with x relative to the mean.
    let rows = points.iter().map(|&x| {
        let [a, b, c] = difference(x, middle);
        let slope = SVector::from([2.0 * a, 2.0 * b, 2.0 * c, 1.0]);
        (slope, -(a * a + b * b + c * c))
    });
    let found = least(rows)?;
    let mut center = [found[0], found[1], found[2]];
    let mut radius = (found[3] + dot(center, center)).sqrt();
    center = along(middle, 1.0, center);
    for _ in 0..STEPS {
        let rows = points.iter().map(|&x| {
            let way = difference(x, center);
            let far = length(way);
            let [a, b, c] = way.map(|w| -w / far);
            (SVector::from([a, b, c, -1.0]), far - radius)
        });
        let step = least(rows)?;
        center = along(center, 1.0, [step[0], step[1], step[2]]);
        radius += step[3];
        if step.amax() <= f64::EPSILON * radius {
            break;
        }
    }
    (radius > 0.0 && radius.is_finite()).then_some(Curve::Sphere {
        center,
        radius,
        outward: true,
    })
}

fn cylinder(points: &[Vector], faces: &[MortarFace]) -> Option<Curve> {
    let mut moments = Matrix3::zeros();
    for face in faces {
        let n = SVector::from(face.normal);
        moments += n * n.transpose() * face.radius.powi(2);
    }
    let eigen = SymmetricEigen::new(moments);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [low, middle, _] = order.map(|k| eigen.eigenvalues[k]);
    // For a plane two eigenvalues vanish.
    if low > ACROSS * middle {
        return None;
    }
    let vector = eigen.eigenvectors.column(order[0]);
    let mut axis = direction([vector[0], vector[1], vector[2]]);
    let mut point = mean(points);
    let [u, v] = across(axis);
    let rows = points.iter().map(|&x| {
        let way = difference(x, point);
        let [a, b] = [dot(way, u), dot(way, v)];
        (SVector::from([2.0 * a, 2.0 * b, 1.0]), -(a * a + b * b))
    });
    let found = least(rows)?;
    let mut radius = (found[2] + found[0].powi(2) + found[1].powi(2)).sqrt();
    point = along(along(point, found[0], u), found[1], v);
    for _ in 0..STEPS {
        let [u, v] = across(axis);
        let rows = points.iter().map(|&x| {
            let way = difference(x, point);
            let high = dot(way, axis);
            let out = along(way, -high, axis);
            let far = length(out);
            let [a, b] = [-dot(out, u) / far, -dot(out, v) / far];
            // Tilts are scaled by the radius.
            let arm = high / radius;
            (SVector::from([a, b, a * arm, b * arm, -1.0]), far - radius)
        });
        let step = least(rows)?;
        point = along(along(point, step[0], u), step[1], v);
        axis = direction(along(along(axis, step[2] / radius, u), step[3] / radius, v));
        radius += step[4];
        if step.amax() <= f64::EPSILON * radius {
            break;
        }
    }
    (radius > 0.0 && radius.is_finite()).then_some(Curve::Cylinder {
        point,
        axis,
        radius,
        outward: true,
    })
}

/// Two directions at right angles to a third and to each other.
fn across(axis: Vector) -> [Vector; 2] {
    let least = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs()));
    let first = direction(cross(unit(least.unwrap_or(0)), axis));
    [first, cross(axis, first)]
}
