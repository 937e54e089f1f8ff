use super::*;
use crate::material::{Lame, Material};
use crate::shape::Rule;

mod solid;

/// Largest number of nodes of a plane element.
const MAX_NODES: usize = 8;
const MAX_FREEDOMS: usize = 2 * MAX_NODES;
type PlaneGradients = Gradients<2, 4, 4, 8>;
type PlaneSampling = Sampling<2, 4, 4, 8>;

fn gauss(space: Space, shape: Shape, x: &[[f64; 2]; MAX_NODES]) -> PlaneGradients {
    Kernel::plane(space).gauss((shape, Integration::Reduced), x)
}

fn sampling(space: Space, shape: Shape, x: &[[f64; 2]; MAX_NODES]) -> PlaneSampling {
    Kernel::plane(space).sampling(shape, x)
}

/// A distorted element off the axis; mid-side nodes lie at the middle of straight sides.
fn coordinates(shape: Shape) -> [[f64; 2]; MAX_NODES] {
    let corners = [[1.0, 0.2], [2.1, 0.0], [2.4, 1.3], [0.9, 1.0]];
    let n = shape.n_corners();
    let mut all = corners[..n].to_vec();
    if shape.is_quadratic() {
        for i in 0..n {
            let (a, b) = (corners[i], corners[(i + 1) % n]);
            all.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        }
    }
    padded(&all)
}

fn padded(points: &[[f64; 2]]) -> [[f64; 2]; MAX_NODES] {
    let mut out = [[0.0; 2]; MAX_NODES];
    out[..points.len()].copy_from_slice(points);
    out
}

/// Strains at each point, at the sampling points if `sampled`, otherwise at the Gauss points.
fn strains_at(
    sampled: bool,
    space: Space,
    shape: Shape,
    x: &[[f64; 2]; MAX_NODES],
    u: &[[f64; 2]; MAX_NODES],
) -> Vec<[f64; 4]> {
    let (strains, n) = if sampled {
        let sampling = sampling(space, shape, x);
        (sampling.strains(u), sampling.n_points())
    } else {
        let gradients = gauss(space, shape, x);
        (gradients.strains(u), gradients.n_points())
    };
    (0..n)
        .map(|g| strains.each_ref().map(|lanes| lanes[g]))
        .collect()
}

fn steel(space: Space) -> Lame {
    Material {
        name: "s".into(),
        youngs_modulus: 10.0,
        poissons_ratio: 0.3,
        hardening: None,
        back_stresses: Default::default(),
        space,
    }
    .lame()
}

#[test]
fn linear_fields_give_exact_strains() {
    for shape in Shape::PLANE {
        for space in [Space::PlaneStrain, Space::PlaneStress] {
            let x = coordinates(shape);
            let u = x.map(|p| [0.3 * p[0] - 0.2 * p[1], 0.5 * p[0] + 0.1 * p[1]]);
            for sampled in [false, true] {
                for e in strains_at(sampled, space, shape, &x, &u) {
                    // The mean dilatation of a constant strain equals that strain; e_zz is then
                    // only round-off.
                    for (value, exact) in e.iter().zip([0.3, 0.1, 0.0, 0.3]) {
                        assert!((value - exact).abs() < 1e-14, "{shape:?} {e:?}");
                    }
                }
            }
        }
    }
}

/// Weight and matrix B of each point, with the rows xx, yy, zz, xy.
type Textbook = Vec<(f64, [[f64; MAX_FREEDOMS]; 4])>;

/// Textbook matrix B and weight at each point of a rule, with B-bar where the element uses it.
fn textbook(space: Space, shape: Shape, x: &[[f64; 2]], rule: &Rule) -> Textbook {
    let mut out = without_mean(space, shape, x, rule);
    if shape == Shape::Quad4 && space != Space::PlaneStress {
        let gauss = without_mean(space, shape, x, shape.reference().gauss);
        let volume: f64 = gauss.iter().map(|(w, _)| w).sum();
        for k in 0..2 * shape.n_nodes() {
            let trace = |b: &[[f64; MAX_FREEDOMS]; 4]| b[0][k] + b[1][k] + b[2][k];
            let mean = gauss.iter().map(|(w, b)| w * trace(b)).sum::<f64>() / volume;
            for (_, b) in &mut out {
                let change = (mean - trace(b)) / 3.0;
                b[..3].iter_mut().for_each(|row| row[k] += change);
            }
        }
    }
    out
}

fn without_mean(space: Space, shape: Shape, x: &[[f64; 2]], rule: &Rule) -> Textbook {
    let n = shape.n_nodes();
    let mut out: Vec<_> = rule
        .iter()
        .map(|(reference, weight)| {
            let at = shape.functions(*reference);
            let (values, gradients) = (at.values, at.gradients);
            let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
            let j: [[f64; 2]; 2] = std::array::from_fn(|a| {
                std::array::from_fn(|d| sum(&|i| gradients[i][a] * x[i][d]))
            });
            let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            let r = sum(&|i| values[i] * x[i][0]);
            let mut b = [[0.0; MAX_FREEDOMS]; 4];
            for i in 0..n {
                let dx = (j[1][1] * gradients[i][0] - j[0][1] * gradients[i][1]) / det;
                let dy = (j[0][0] * gradients[i][1] - j[1][0] * gradients[i][0]) / det;
                (b[0][2 * i], b[1][2 * i + 1]) = (dx, dy);
                (b[3][2 * i], b[3][2 * i + 1]) = (dy, dx);
                if space == Space::Axisymmetric {
                    b[2][2 * i] = values[i] / r;
                }
            }
            let around = if space == Space::Axisymmetric {
                2.0 * std::f64::consts::PI * r
            } else {
                1.0
            };
            (weight * det * around, b)
        })
        .collect();
    if shape == Shape::Quad4 && space == Space::Axisymmetric {
        // Slopes du/dy and radius at the centre, where the gradients along the reference
        // coordinates are +-1/4.
        let sign = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let sum = |a: usize, d: usize| (0..4).map(|i| 0.25 * sign[i][a] * x[i][d]).sum::<f64>();
        let j = [[sum(0, 0), sum(0, 1)], [sum(1, 0), sum(1, 1)]];
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let center = x[..4].iter().map(|x| x[0]).sum::<f64>() / 4.0;
        for ((_, b), (reference, _)) in out.iter_mut().zip(rule) {
            let values = shape.functions(*reference).values;
            let r = (0..4).map(|i| values[i] * x[i][0]).sum::<f64>();
            let factor = (r / center).sqrt();
            for i in 0..4 {
                let slope = 0.25 * (j[0][0] * sign[i][1] - j[1][0] * sign[i][0]) / det;
                b[3][2 * i] = factor * slope;
                b[3][2 * i + 1] *= factor;
            }
        }
    }
    out
}

/// Elastic matrix of [`steel`], with E = 10 and nu = 0.3.
fn textbook_elasticity(space: Space) -> [[f64; 4]; 4] {
    let (e, nu) = (10.0, 0.3);
    let shear = e / (2.0 * (1.0 + nu));
    if space == Space::PlaneStress {
        let c = e / (1.0 - nu * nu);
        return [
            [c, c * nu, 0.0, 0.0],
            [c * nu, c, 0.0, 0.0],
            [0.0; 4],
            [0.0, 0.0, 0.0, shear],
        ];
    }
    let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let (own, other) = (c * (1.0 - nu), c * nu);
    [
        [own, other, other, 0.0],
        [other, own, other, 0.0],
        [other, other, own, 0.0],
        [0.0, 0.0, 0.0, shear],
    ]
}

#[test]
fn strains_forces_and_stiffness_are_those_of_the_textbooks_b() {
    for shape in Shape::PLANE {
        for space in Space::PLANE {
            let x = coordinates(shape);
            let d = textbook_elasticity(space);
            let gradients = gauss(space, shape, &x);
            let reference = textbook(space, shape, &x, shape.reference().gauss);
            let n = 2 * shape.n_nodes();
            let u: [[f64; 2]; MAX_NODES] =
                std::array::from_fn(|k| [0, 1].map(|d| (1.7 * (2 * k + d) as f64).sin()));
            let strains = gradients.strains(&u);
            let stress: Components = std::array::from_fn(|c| {
                std::array::from_fn(|g| [1.0 + g as f64, -2.0, 0.5, 0.3][c])
            });
            let mut force = [0.0; MAX_FREEDOMS];
            let mut stiffness = [[0.0; MAX_FREEDOMS]; MAX_FREEDOMS];
            for (g, (weight, b)) in reference.iter().enumerate() {
                assert!((gradients.weights()[g] - weight).abs() < 1e-14 * weight);
                for c in 0..4 {
                    let terms = b[c].iter().zip(u.as_flattened());
                    let strain: f64 = terms.map(|(b, u)| b * u).sum();
                    assert!(
                        (strains[c][g] - strain).abs() < 1e-14,
                        "{shape:?} {space:?}"
                    );
                    for r in 0..n {
                        force[r] += weight * b[c][r] * stress[c][g];
                        for k in 0..4 {
                            for s in 0..n {
                                stiffness[r][s] += weight * b[c][r] * d[c][k] * b[k][s];
                            }
                        }
                    }
                }
            }
            let forces = gradients.forces(&stress);
            let forces = forces.as_flattened();
            let mut packed_stiffness = vec![0.0; n * (n + 1) / 2];
            gradients.stiffness_into(&steel(space), &mut packed_stiffness);
            // Sums of a few hundred terms of order 10 have a round-off of 1e-13.
            for r in 0..n {
                assert!((forces[r] - force[r]).abs() < 1e-13, "{shape:?} {space:?}");
                for s in 0..n {
                    let difference = packed_stiffness[packed(r, s)] - stiffness[r][s];
                    assert!(difference.abs() < 1e-12, "{shape:?} {space:?} {difference}");
                }
            }
        }
    }
}

/// Rectangles of different sizes on the axis and next to it, their nodes moved by `u_r = a r z`,
/// `u_z = b r^2 + c z^2` with `c` such that the stresses are in equilibrium. No residual force
/// remains on an interior node or on a node on the axis. With the shear of the bilinear field,
/// forces on the axis would remain.
#[test]
fn what_is_regular_at_the_axis_is_in_equilibrium_node_by_node() {
    let (r, z) = ([0.0, 0.7, 1.1, 2.0], [-0.3, 0.2, 1.0]);
    let d = steel(Space::Axisymmetric);
    let (lambda, shear) = (d.lambda, d.mu);
    for (a, b) in [(0.4, 0.3), (-0.4, 0.2), (0.0, 1.0)] {
        // Equilibrium requires d(s_zz)/dz + d(r s_rz)/dr/r = 0.
        let along_z = 2.0 * lambda * a + 2.0 * shear * (a + 2.0 * b);
        let c = -along_z / (2.0 * lambda + 4.0 * shear);
        let mut forces = [[[0.0f64; 2]; 3]; 4];
        let mut largest = 0.0f64;
        for i in 0..3 {
            for j in 0..2 {
                let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                let x = corners.map(|[i, j]| [r[i], z[j]]);
                let u = padded(&x.map(|[r, z]| [a * r * z, b * r * r + c * z * z]));
                let gradients = gauss(Space::Axisymmetric, Shape::Quad4, &padded(&x));
                let strains = gradients.strains(&u);
                let mut stress = Components::default();
                for g in 0..4 {
                    let at_point = d.times(&strains.map(|lanes| lanes[g]));
                    (0..4).for_each(|c| stress[c][g] = at_point[c]);
                }
                let force = gradients.forces(&stress);
                for (k, [i, j]) in corners.into_iter().enumerate() {
                    for axis in 0..2 {
                        forces[i][j][axis] += force[k][axis];
                        largest = largest.max(force[k][axis].abs());
                    }
                }
            }
        }
        // Sums of some dozen terms of the size of the largest force of an element.
        for (i, column) in forces[..3].iter().enumerate() {
            for axis in 0..2 {
                let is_held = i == 0 && axis == 0;
                let left = column[1][axis];
                assert!(
                    is_held || left.abs() <= 1e-14 * largest,
                    "{i} {axis}: {left} of {largest}"
                );
            }
        }
    }
}

/// Distorted elements on the axis and off it: constant strains are exact. A cross-section that
/// rotates has the hoop strain of the rotation, reduced by the mean dilatation, but no shear.
#[test]
fn constant_strains_are_exact_and_a_turning_section_has_no_shear() {
    let on_axis = padded(&[[0.0, 0.2], [1.1, 0.0], [1.4, 1.3], [0.0, 1.0]]);
    for x in [coordinates(Shape::Quad4), on_axis] {
        let stretched = x.map(|[r, z]| [0.3 * r, -0.2 * z]);
        let turned = x.map(|[r, z]| [-0.4 * z, 0.4 * r]);
        for sampled in [false, true] {
            let strains = |u| strains_at(sampled, Space::Axisymmetric, Shape::Quad4, &x, u);
            for e in strains(&stretched) {
                for (value, exact) in e.iter().zip([0.3, -0.2, 0.3, 0.0]) {
                    assert!((value - exact).abs() < 1e-14, "{x:?} {e:?}");
                }
            }
            for e in strains(&turned) {
                assert!(e[3].abs() < 1e-14, "{x:?} {e:?}");
            }
        }
    }
}

#[test]
fn stiffness_is_free_of_rigid_motion() {
    for shape in Shape::PLANE {
        for space in Space::PLANE {
            let x = coordinates(shape);
            let gradients = gauss(space, shape, &x);
            let n = 2 * shape.n_nodes();
            let mut k = vec![0.0; n * (n + 1) / 2];
            gradients.stiffness_into(&steel(space), &mut k);
            let mut motions: Vec<Vec<f64>> = vec![x.iter().flat_map(|_| [0.0, 1.0]).collect()];
            if space != Space::Axisymmetric {
                motions.push(x.iter().flat_map(|_| [1.0, 0.0]).collect());
                motions.push(x.iter().flat_map(|p| [-p[1], p[0]]).collect());
            }
            for u in motions {
                for i in 0..n {
                    let f: f64 = (0..n).map(|j| k[packed(i, j)] * u[j]).sum();
                    assert!(f.abs() < 1e-11, "{shape:?} {space:?} {f}");
                }
            }
        }
    }
}

/// The rigid motion along the axis is the only free motion of an axisymmetric `quad4`, on the axis
/// or off it, long or flat, upright or on its corner.
#[test]
fn no_other_motion_of_a_ring_is_free() {
    let block = |from: f64, [width, height]: [f64; 2]| {
        let to = from + width;
        padded(&[[from, 0.0], [to, 0.0], [to, height], [from, height]])
    };
    let diamond = padded(&[[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]]);
    let mut rings = vec![coordinates(Shape::Quad4), diamond];
    for from in [0.0, 0.1, 10.0] {
        rings.extend([[1.0, 1.0], [20.0, 1.0], [1.0, 20.0]].map(|size| block(from, size)));
    }
    for x in rings {
        let gradients = gauss(Space::Axisymmetric, Shape::Quad4, &x);
        let mut k = vec![0.0; 36];
        gradients.stiffness_into(&steel(Space::Axisymmetric), &mut k);
        let matrix = nalgebra::SMatrix::<f64, 8, 8>::from_fn(|i, j| k[packed(i, j)]);
        let mut sizes = matrix.symmetric_eigenvalues().data.0[0];
        sizes.sort_by(f64::total_cmp);
        // The softest motion is the bending of a plate: its stiffness over that of the shear is
        // about a tenth of the fourth power of the slenderness, 1/20.
        assert!(sizes[0].abs() < 1e-12 * sizes[7], "{x:?}: {sizes:?}");
        assert!(
            sizes[1] > 0.01 / 20f64.powi(4) * sizes[7],
            "{x:?}: {sizes:?}"
        );
    }
}

#[test]
fn weights_sum_to_the_area() {
    for shape in Shape::PLANE {
        let x = coordinates(shape);
        let n = shape.n_corners();
        let area: f64 = (0..n)
            .map(|i| 0.5 * (x[i][0] * x[(i + 1) % n][1] - x[(i + 1) % n][0] * x[i][1]))
            .sum();
        let gradients = gauss(Space::PlaneStrain, shape, &x);
        let sum: f64 = gradients.weights().iter().sum();
        assert!((sum - area).abs() < 1e-14);
    }
}

#[test]
fn facets_integrate_length_and_point_outward() {
    const LINE3: &crate::shape::FacetReference = crate::shape::FacetReference::ALL[1];
    let nodes = [[0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let points: Vec<FacetPoint> = facet_points(Space::PlaneStrain, LINE3, &nodes).collect();
    assert!((points.iter().map(|p| p.weight).sum::<f64>() - 2.0).abs() < 1e-15);
    assert_eq!(points[0].normal, [0.0, -1.0, 0.0]);
    let mid: f64 = points.iter().map(|p| p.weight * p.values[2]).sum();
    assert!((mid - 2.0 * 4.0 / 6.0).abs() < 1e-15);
    // On the axis of revolution the corner of a quadratic facet carries no load.
    let axis = facet_points(Space::Axisymmetric, LINE3, &nodes);
    let corner: f64 = axis.map(|p| p.weight * p.values[0]).sum();
    assert!(corner.abs() < 1e-14);
}

#[test]
fn sampled_strains_are_those_of_the_textbooks_b_there() {
    for shape in Shape::PLANE {
        for space in Space::PLANE {
            let x = coordinates(shape);
            let u = x.map(|p| [0.3 * p[0] * p[1], 0.2 * p[0] * p[0] - 0.1 * p[1] * p[0]]);
            let rule = shape.reference().sampling;
            let sampled = strains_at(true, space, shape, &x, &u);
            assert_eq!(sampled.len(), rule.len());
            for (strain, (_, b)) in sampled.iter().zip(textbook(space, shape, &x, rule)) {
                for (e, row) in strain.iter().zip(b) {
                    let terms = row.iter().zip(u.as_flattened());
                    let expected: f64 = terms.map(|(b, u)| b * u).sum();
                    assert!((e - expected).abs() < 1e-14, "{shape:?} {space:?}");
                }
            }
            let positions = sampling(space, shape, &x).positions(&x);
            for (g, (place, _)) in rule.iter().enumerate() {
                let values = shape.functions(*place).values;
                for d in 0..2 {
                    let at: f64 = values.iter().zip(&x).map(|(n, x)| n * x[d]).sum();
                    assert!((positions[d][g] - at).abs() < 1e-15);
                }
            }
        }
    }
}

/// Elements with fewer points than the kernel has lanes give the same results, including the mean
/// dilatation and the shear of an axisymmetric `quad4`.
#[test]
fn the_kernel_of_full_integration_has_the_same_elements() {
    let law = steel(Space::PlaneStrain);
    for shape in Shape::PLANE {
        for space in Space::PLANE {
            let x = coordinates(shape);
            let kind = (shape, Integration::Reduced);
            let n = 2 * shape.n_nodes();
            let [mut own, mut other] = [0, 1].map(|_| vec![0.0; n * (n + 1) / 2]);
            gauss(space, shape, &x).stiffness_into(&law, &mut own);
            let full = Kernel::full_plane(space).gauss(kind, &x);
            full.stiffness_into(&law, &mut other);
            let size = own.iter().fold(0.0f64, |m, k| m.max(k.abs()));
            for (a, b) in own.iter().zip(&other) {
                assert!((a - b).abs() < 1e-14 * size, "{shape:?} {space:?}");
            }
            let u = x.map(|p| [0.3 * p[0] * p[1], 0.2 * p[0] * p[0]]);
            let strains = [0, 1].map(|i| match i {
                0 => strains_at(false, space, shape, &x, &u),
                _ => {
                    let all = full.strains(&u);
                    let at = |g: usize| all.each_ref().map(|lanes| lanes[g]);
                    (0..full.n_points()).map(at).collect()
                }
            });
            for (a, b) in strains[0]
                .as_flattened()
                .iter()
                .zip(strains[1].as_flattened())
            {
                assert!((a - b).abs() < 1e-14, "{shape:?} {space:?}");
            }
        }
    }
}
