use super::*;
use crate::material::Material;

/// A distorted element away from the axis; mid-side nodes at the middle of straight sides.
fn coordinates(shape: Shape) -> Vec<[f64; 2]> {
    let corners = [[1.0, 0.2], [2.1, 0.0], [2.4, 1.3], [0.9, 1.0]];
    let n = shape.n_corners();
    let mut all = corners[..n].to_vec();
    if shape.is_quadratic() {
        for i in 0..n {
            let (a, b) = (corners[i], corners[(i + 1) % n]);
            all.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        }
    }
    all
}

fn steel(kind: Kind) -> Lame {
    Material {
        name: "s".into(),
        youngs_modulus: 10.0,
        poissons_ratio: 0.3,
        hardening: None,
        kind,
    }
    .lame()
}

#[test]
fn linear_fields_give_exact_strains() {
    for shape in Shape::ALL {
        for kind in [Kind::PlaneStrain, Kind::PlaneStress] {
            let x = coordinates(shape);
            let u: Vec<f64> = x
                .iter()
                .flat_map(|p| [0.3 * p[0] - 0.2 * p[1], 0.5 * p[0] + 0.1 * p[1]])
                .collect();
            for points in [gauss_points(kind, shape, &x), sampling(kind, shape, &x)] {
                for e in &points.strains(&full(&u))[..points.len()] {
                    // The mean dilatation of a constant field is that field; e_zz then is round-off
                    // only.
                    for (value, exact) in e.iter().zip([0.3, 0.1, 0.0, 0.3]) {
                        assert!((value - exact).abs() < 1e-14, "{shape:?} {e:?}");
                    }
                }
            }
        }
    }
}

fn full(u: &[f64]) -> [f64; MAX_FREEDOMS] {
    let mut out = [0.0; MAX_FREEDOMS];
    out[..u.len()].copy_from_slice(u);
    out
}

const KINDS: [Kind; 3] = [Kind::PlaneStrain, Kind::PlaneStress, Kind::Axisymmetric];

/// The textbook's matrix B at each Gauss point with the point's weight: rows xx, yy, zz, xy, B-bar
/// where it applies.
fn textbook(kind: Kind, shape: Shape, x: &[[f64; 2]]) -> Vec<(f64, [[f64; MAX_FREEDOMS]; 4])> {
    let n = shape.n_nodes();
    let mut out: Vec<_> = shape
        .reference()
        .gauss
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
                if kind == Kind::Axisymmetric {
                    b[2][2 * i] = values[i] / r;
                }
            }
            let around = if kind == Kind::Axisymmetric {
                2.0 * std::f64::consts::PI * r
            } else {
                1.0
            };
            (weight * det * around, b)
        })
        .collect();
    if shape == Shape::Quad4 && kind == Kind::Axisymmetric {
        // Slopes du/dy and radius of the centre, where the gradients along the reference
        // coordinates are +-1/4.
        let sign = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let sum = |a: usize, d: usize| (0..4).map(|i| 0.25 * sign[i][a] * x[i][d]).sum::<f64>();
        let j = [[sum(0, 0), sum(0, 1)], [sum(1, 0), sum(1, 1)]];
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let center = x.iter().map(|x| x[0]).sum::<f64>() / 4.0;
        for ((_, b), (reference, _)) in out.iter_mut().zip(shape.reference().gauss) {
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
    if shape == Shape::Quad4 && kind != Kind::PlaneStress {
        let volume: f64 = out.iter().map(|(w, _)| w).sum();
        for k in 0..2 * n {
            let trace = |b: &[[f64; MAX_FREEDOMS]; 4]| b[0][k] + b[1][k] + b[2][k];
            let mean = out.iter().map(|(w, b)| w * trace(b)).sum::<f64>() / volume;
            for (_, b) in &mut out {
                let change = (mean - trace(b)) / 3.0;
                b[..3].iter_mut().for_each(|row| row[k] += change);
            }
        }
    }
    out
}

/// The elastic matrix of [`steel`], with E = 10 and nu = 0.3.
fn textbook_elasticity(kind: Kind) -> [[f64; 4]; 4] {
    let (e, nu) = (10.0, 0.3);
    let shear = e / (2.0 * (1.0 + nu));
    if kind == Kind::PlaneStress {
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
    for shape in Shape::ALL {
        for kind in KINDS {
            let x = coordinates(shape);
            let d = textbook_elasticity(kind);
            let points = gauss_points(kind, shape, &x);
            let reference = textbook(kind, shape, &x);
            let n = points.n_freedoms();
            let u = full(&(0..n).map(|i| (i as f64 * 1.7).sin()).collect::<Vec<_>>());
            let strains = points.strains(&u);
            let stress: AtPoints = std::array::from_fn(|g| [1.0 + g as f64, -2.0, 0.5, 0.3]);
            let mut force = [0.0; MAX_FREEDOMS];
            let mut stiffness = [[0.0; MAX_FREEDOMS]; MAX_FREEDOMS];
            for (g, (weight, b)) in reference.iter().enumerate() {
                for c in 0..4 {
                    let strain: f64 = b[c].iter().zip(&u).map(|(b, u)| b * u).sum();
                    assert!((strains[g][c] - strain).abs() < 1e-14, "{shape:?} {kind:?}");
                    for r in 0..n {
                        force[r] += weight * b[c][r] * stress[g][c];
                        for k in 0..4 {
                            for s in 0..n {
                                stiffness[r][s] += weight * b[c][r] * d[c][k] * b[k][s];
                            }
                        }
                    }
                }
            }
            let forces = points.forces(&stress);
            let mut packed_stiffness = vec![0.0; n * (n + 1) / 2];
            points.stiffness_into(&steel(kind), &mut packed_stiffness);
            // A few hundred terms of order 10: round-off 1e-13.
            for r in 0..n {
                assert!((forces[r] - force[r]).abs() < 1e-13, "{shape:?} {kind:?}");
                for s in 0..n {
                    let difference = packed_stiffness[packed(r, s)] - stiffness[r][s];
                    assert!(difference.abs() < 1e-12, "{shape:?} {kind:?} {difference}");
                }
            }
        }
    }
}

/// Rectangles of unlike sizes on the axis and beside it, their nodes moved as `u_r = a r z`,
/// `u_z = b r^2 + c z^2` with `c` such that the stresses are in equilibrium: no node inside has a
/// force left, nor one on the axis. With the shear of the bilinear field the nodes on the axis have
/// one.
#[test]
fn what_is_regular_at_the_axis_is_in_equilibrium_node_by_node() {
    let (r, z) = ([0.0, 0.7, 1.1, 2.0], [-0.3, 0.2, 1.0]);
    let d = steel(Kind::Axisymmetric);
    let (lambda, shear) = (d.lambda, d.mu);
    for (a, b) in [(0.4, 0.3), (-0.4, 0.2), (0.0, 1.0)] {
        // d(s_zz)/dz + d(r s_rz)/dr/r = 0.
        let along_z = 2.0 * lambda * a + 2.0 * shear * (a + 2.0 * b);
        let c = -along_z / (2.0 * lambda + 4.0 * shear);
        let mut forces = [[[0.0f64; 2]; 3]; 4];
        let mut largest = 0.0f64;
        for i in 0..3 {
            for j in 0..2 {
                let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                let x = corners.map(|[i, j]| [r[i], z[j]]);
                let u = x.map(|[r, z]| [a * r * z, b * r * r + c * z * z]);
                let points = gauss_points(Kind::Axisymmetric, Shape::Quad4, &x);
                let strains = points.strains(&full(u.as_flattened()));
                let stress = strains.map(|e| d.times(&e));
                let force = points.forces(&stress);
                for (k, [i, j]) in corners.into_iter().enumerate() {
                    for axis in 0..2 {
                        forces[i][j][axis] += force[2 * k + axis];
                        largest = largest.max(force[2 * k + axis].abs());
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

/// On the axis and off it, pulled out of shape: constant strains are exact, and a section that
/// turns has the strain of its hoops, less in the mean dilatation, but no shear.
#[test]
fn constant_strains_are_exact_and_a_turning_section_has_no_shear() {
    let on_axis = vec![[0.0, 0.2], [1.1, 0.0], [1.4, 1.3], [0.0, 1.0]];
    for x in [coordinates(Shape::Quad4), on_axis] {
        let moved =
            |u: fn([f64; 2]) -> [f64; 2]| -> Vec<f64> { x.iter().flat_map(|x| u(*x)).collect() };
        let stretched = full(&moved(|[r, z]| [0.3 * r, -0.2 * z]));
        let turned = full(&moved(|[r, z]| [-0.4 * z, 0.4 * r]));
        for points in [gauss_points, sampling].map(|f| f(Kind::Axisymmetric, Shape::Quad4, &x)) {
            for e in &points.strains(&stretched)[..points.len()] {
                for (value, exact) in e.iter().zip([0.3, -0.2, 0.3, 0.0]) {
                    assert!((value - exact).abs() < 1e-14, "{x:?} {e:?}");
                }
            }
            for e in &points.strains(&turned)[..points.len()] {
                assert!(e[3].abs() < 1e-14, "{x:?} {e:?}");
            }
        }
    }
}

#[test]
fn stiffness_is_free_of_rigid_motion() {
    for shape in Shape::ALL {
        for kind in KINDS {
            let x = coordinates(shape);
            let points = gauss_points(kind, shape, &x);
            let n = points.n_freedoms();
            let mut k = vec![0.0; n * (n + 1) / 2];
            points.stiffness_into(&steel(kind), &mut k);
            let mut motions: Vec<Vec<f64>> = vec![x.iter().flat_map(|_| [0.0, 1.0]).collect()];
            if kind != Kind::Axisymmetric {
                motions.push(x.iter().flat_map(|_| [1.0, 0.0]).collect());
                motions.push(x.iter().flat_map(|p| [-p[1], p[0]]).collect());
            }
            for u in motions {
                for i in 0..n {
                    let f: f64 = (0..n).map(|j| k[packed(i, j)] * u[j]).sum();
                    assert!(f.abs() < 1e-11, "{shape:?} {kind:?} {f}");
                }
            }
        }
    }
}

/// Nothing but the rigid motion along the axis is free in an axisymmetric `quad4`, on the axis or
/// off it, long or flat, upright or on its corner.
#[test]
fn no_other_motion_of_a_ring_is_free() {
    let block = |from: f64, [width, height]: [f64; 2]| {
        let to = from + width;
        vec![[from, 0.0], [to, 0.0], [to, height], [from, height]]
    };
    let diamond = vec![[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
    let mut rings = vec![coordinates(Shape::Quad4), diamond];
    for from in [0.0, 0.1, 10.0] {
        rings.extend([[1.0, 1.0], [20.0, 1.0], [1.0, 20.0]].map(|size| block(from, size)));
    }
    for x in rings {
        let points = gauss_points(Kind::Axisymmetric, Shape::Quad4, &x);
        let mut k = vec![0.0; 36];
        points.stiffness_into(&steel(Kind::Axisymmetric), &mut k);
        let matrix = nalgebra::SMatrix::<f64, 8, 8>::from_fn(|i, j| k[packed(i, j)]);
        let mut sizes = matrix.symmetric_eigenvalues().data.0[0];
        sizes.sort_by(f64::total_cmp);
        // The softest motion is the bending of a plate: the fourth power of its slenderness, 1/20,
        // beside the shear, times about a tenth.
        assert!(sizes[0].abs() < 1e-12 * sizes[7], "{x:?}: {sizes:?}");
        assert!(
            sizes[1] > 0.01 / 20f64.powi(4) * sizes[7],
            "{x:?}: {sizes:?}"
        );
    }
}

#[test]
fn weights_sum_to_the_area() {
    for shape in Shape::ALL {
        let x = coordinates(shape);
        let n = shape.n_corners();
        let area: f64 = (0..n)
            .map(|i| 0.5 * (x[i][0] * x[(i + 1) % n][1] - x[(i + 1) % n][0] * x[i][1]))
            .sum();
        let sum: f64 = gauss_points(Kind::PlaneStrain, shape, &x).weights().sum();
        assert!((sum - area).abs() < 1e-14);
    }
}

#[test]
fn facets_integrate_length_and_point_outward() {
    const LINE3: &crate::shape::FacetReference = crate::shape::FacetReference::ALL[1];
    let points = facet_points(
        Kind::PlaneStrain,
        LINE3,
        &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]],
    );
    assert!((points.iter().map(|p| p.weight).sum::<f64>() - 2.0).abs() < 1e-15);
    assert_eq!(points[0].normal, [0.0, -1.0]);
    let mid: f64 = points.iter().map(|p| p.weight * p.values[2]).sum();
    assert!((mid - 2.0 * 4.0 / 6.0).abs() < 1e-15);
    // On the axis of revolution the corner of a quadratic facet carries no load.
    let axis = facet_points(
        Kind::Axisymmetric,
        LINE3,
        &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]],
    );
    let corner: f64 = axis.iter().map(|p| p.weight * p.values[0]).sum();
    assert!(corner.abs() < 1e-14);
}

/// Without an operator strains, forces, weights and places are those with it, to the round-off of
/// their sums: any shape, any kinematics, elements pulled out of shape at random.
#[test]
fn a_mapping_gives_what_the_operator_gives() {
    let mut number = {
        let mut state = 1u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / 2f64.powi(30) - 1.0
        }
    };
    for shape in Shape::ALL {
        for kind in KINDS {
            for _ in 0..20 {
                let mut nodes = [[0.0; 2]; MAX_NODES];
                for (node, x) in nodes.iter_mut().zip(coordinates(shape)) {
                    *node = x.map(|x| x + 0.1 * number());
                }
                let mut moved = [[0.0; 2]; MAX_NODES];
                for u in &mut moved[..shape.n_nodes()] {
                    *u = [number(), number()];
                }
                let u = full(moved[..shape.n_nodes()].as_flattened());
                let points = gauss_points(kind, shape, &nodes);
                let mapping = Mapping::gauss(kind, shape, &nodes);
                let name = format!("{shape:?} {kind:?}");
                assert_eq!(mapping.n_points(), points.len());
                // Sums of two dozen terms; no gradient is larger than the largest number of the
                // operator.
                let size = points.values().iter().fold(1.0f64, |m, b| m.max(b.abs()));
                let round_off = 64.0 * f64::EPSILON * size;
                let compare = |a: &Components, b: &AtPoints, n: usize| {
                    for g in 0..n {
                        for c in 0..4 {
                            assert!(
                                (a[c][g] - b[g][c]).abs() <= round_off,
                                "{name}: strain {g} {c}"
                            );
                        }
                    }
                };
                compare(&mapping.strains(&moved), &points.strains(&u), points.len());
                let (sampled, n) = sampled_strains(kind, shape, &nodes, &moved);
                let samples = sampling(kind, shape, &nodes);
                assert_eq!(n, samples.len());
                compare(&sampled, &samples.strains(&u), n);

                let position = mapping.positions(&nodes);
                for (g, (weight, at)) in points.weights().zip(points.positions()).enumerate() {
                    assert!((mapping.weights()[g] - weight).abs() <= round_off * weight.abs());
                    for d in 0..2 {
                        assert!((position[d][g] - at[d]).abs() <= 64.0 * f64::EPSILON);
                    }
                }
                let stress: Components = std::array::from_fn(|_| std::array::from_fn(|_| number()));
                let by_point = std::array::from_fn(|g| stress.map(|lanes| lanes[g]));
                let volume: f64 = points.weights().sum();
                let forces = mapping.forces(&stress);
                let expected = points.forces(&by_point);
                for (a, b) in forces.as_flattened().iter().zip(&expected) {
                    assert!((a - b).abs() <= round_off * volume, "{name}: force {a} {b}");
                }
                for (mean, lanes) in mapping.mean(&stress).iter().zip(&stress) {
                    let sum: f64 = points.weights().zip(lanes).map(|(w, s)| w * s).sum();
                    assert!((mean - sum / volume).abs() <= round_off, "{name}: mean");
                }
            }
        }
    }
}
