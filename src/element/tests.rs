use super::*;
use crate::material::Material;

const SHAPES: [Shape; 4] = [Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8];

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

fn steel(kind: Kind) -> Matrix4 {
    Material {
        name: "s".into(),
        youngs_modulus: 10.0,
        poissons_ratio: 0.3,
        hardening: None,
        kind,
    }
    .elastic_matrix()
}

#[test]
fn gradients_are_derivatives_and_values_sum_to_one() {
    for shape in SHAPES {
        let at = [0.21, 0.34];
        let (n, g) = shape_functions(shape, at);
        assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        for d in 0..2 {
            let h = 1e-6;
            let (mut up, mut down) = (at, at);
            up[d] += h;
            down[d] -= h;
            let (a, b) = (shape_functions(shape, up).0, shape_functions(shape, down).0);
            for i in 0..shape.n_nodes() {
                assert!(
                    ((a[i] - b[i]) / (2.0 * h) - g[i][d]).abs() < 1e-9,
                    "{shape:?} {i}"
                );
            }
        }
    }
}

#[test]
fn linear_fields_give_exact_strains() {
    for shape in SHAPES {
        for kind in [Kind::PlaneStrain, Kind::PlaneStress] {
            let x = coordinates(shape);
            let u: Vec<f64> = x
                .iter()
                .flat_map(|p| [0.3 * p[0] - 0.2 * p[1], 0.5 * p[0] + 0.1 * p[1]])
                .collect();
            for point in gauss_points(kind, shape, &x)
                .iter()
                .chain(sampling(kind, shape, &x).iter())
            {
                let e = point.strain(&u);
                // The mean dilatation of a constant field is that field; e_zz then is round-off only.
                for (value, exact) in e.iter().zip([0.3, 0.1, 0.0, 0.3]) {
                    assert!((value - exact).abs() < 1e-14, "{shape:?} {e:?}");
                }
            }
        }
    }
}

#[test]
fn stiffness_is_symmetric_and_free_of_rigid_motion() {
    for shape in SHAPES {
        for kind in [Kind::PlaneStrain, Kind::PlaneStress, Kind::Axisymmetric] {
            let x = coordinates(shape);
            let points = gauss_points(kind, shape, &x);
            let n = points.n_freedoms;
            let mut k = vec![0.0; n * n];
            stiffness_into(&points, &steel(kind), &mut k);
            for i in 0..n {
                for j in 0..n {
                    assert!((k[i * n + j] - k[j * n + i]).abs() < 1e-12);
                }
            }
            let mut motions: Vec<Vec<f64>> = vec![x.iter().flat_map(|_| [0.0, 1.0]).collect()];
            if kind != Kind::Axisymmetric {
                motions.push(x.iter().flat_map(|_| [1.0, 0.0]).collect());
                motions.push(x.iter().flat_map(|p| [-p[1], p[0]]).collect());
            }
            for u in motions {
                for i in 0..n {
                    let f: f64 = (0..n).map(|j| k[i * n + j] * u[j]).sum();
                    assert!(f.abs() < 1e-11, "{shape:?} {kind:?} {f}");
                }
            }
        }
    }
}

#[test]
fn force_is_stiffness_times_displacement() {
    for shape in SHAPES {
        let kind = Kind::Axisymmetric;
        let x = coordinates(shape);
        let d = steel(kind);
        let points = gauss_points(kind, shape, &x);
        let n = points.n_freedoms;
        let mut k = vec![0.0; n * n];
        stiffness_into(&points, &d, &mut k);
        let u: Vec<f64> = (0..n).map(|i| (i as f64 * 1.7).sin()).collect();
        let mut f = vec![0.0; n];
        for p in points.iter() {
            p.add_force(&crate::material::multiply(&d, &p.strain(&u)), &mut f);
        }
        for i in 0..n {
            let expected: f64 = (0..n).map(|j| k[i * n + j] * u[j]).sum();
            assert!((f[i] - expected).abs() < 1e-11);
        }
    }
}

#[test]
fn weights_sum_to_the_area() {
    for shape in SHAPES {
        let x = coordinates(shape);
        let n = shape.n_corners();
        let area: f64 = (0..n)
            .map(|i| 0.5 * (x[i][0] * x[(i + 1) % n][1] - x[(i + 1) % n][0] * x[i][1]))
            .sum();
        let sum: f64 = gauss_points(Kind::PlaneStrain, shape, &x)
            .iter()
            .map(|p| p.weight)
            .sum();
        assert!((sum - area).abs() < 1e-14);
    }
}

#[test]
fn facets_integrate_length_and_point_outward() {
    let points = facet_points(Kind::PlaneStrain, &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]);
    assert!((points.iter().map(|p| p.weight).sum::<f64>() - 2.0).abs() < 1e-15);
    assert_eq!(points[0].normal, [0.0, -1.0]);
    let mid: f64 = points.iter().map(|p| p.weight * p.values[2]).sum();
    assert!((mid - 2.0 * 4.0 / 6.0).abs() < 1e-15);
    // On the axis of revolution the corner of a quadratic facet carries no load.
    let axis = facet_points(Kind::Axisymmetric, &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]);
    let corner: f64 = axis.iter().map(|p| p.weight * p.values[0]).sum();
    assert!(corner.abs() < 1e-14);
}
