//! Elliptical contact compared with published tables, its limits, and sums over point forces.

use super::super::{HertzLine, HertzPoint, contact_modulus};
use super::*;

#[test]
fn a_circle_is_the_point_contact() {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let ellipse = HertzEllipse::new([8.0, 8.0], modulus).unwrap();
    let point = HertzPoint::new(8.0, modulus).unwrap();
    let load = 700.0;
    let [x, y] = ellipse.semi_axes(load);
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    close(x, point.contact_radius(load));
    assert_eq!(x, y);
    close(ellipse.max_pressure(load), point.max_pressure(load));
    close(ellipse.approach(load), point.approach(load));
    for nu in [0.2, 0.3, 0.45] {
        close(
            ellipse.yield_pressure(nu, 1.0),
            HertzPoint::yield_pressure(nu, 1.0),
        );
        let depth = ellipse.yield_depth(nu, 500.0) / point.yield_depth(nu, 500.0);
        assert!((depth - 1.0).abs() < 1e-6);
    }
    // Nearly a circle, for which the formulas must not cancel.
    let nearly = HertzEllipse::new([8.0, 8.0 * (1.0 + 1e-9)], modulus).unwrap();
    assert!((nearly.axis_ratio() - 1.0).abs() < 1e-9);
}

/// Johnson's integral equations are satisfied: the displacement under the pressure closes the gap.
#[test]
fn the_pressure_closes_the_gap() {
    let ellipse = HertzEllipse::new([30.0, 4.0], 1000.0).unwrap();
    let load = 50.0;
    let [a, b] = ellipse.semi_axes(load);
    assert!(a > b && (b / a - ellipse.axis_ratio()).abs() < 1e-14);
    // u(0) - u(x) = x^2/(2 R): u = 1/(pi E*) int p/r dA, by rays from the point.
    let displacement = |px: f64, py: f64| {
        let mut sum = 0.0;
        let rays = 400;
        for i in 0..rays {
            let phi = 2.0 * PI * (i as f64 + 0.5) / rays as f64;
            let (c, s) = (phi.cos() / a, phi.sin() / b);
            let (x, y) = (px / a, py / b);
            // Along the ray 1 - |.|^2 is C - 2 B r - A r^2, and the integral of its square root is
            // elementary.
            let (qa, qb, qc) = (c * c + s * s, x * c + y * s, 1.0 - x * x - y * y);
            let d = qc / qa + (qb / qa).powi(2);
            let u0 = qb / qa;
            let root = (qc / qa).sqrt();
            sum += qa.sqrt() * 0.5 * (d * (0.5 * PI - (u0 / d.sqrt()).asin()) - u0 * root);
        }
        ellipse.max_pressure(load) * sum * 2.0 * PI / rays as f64 / (PI * 1000.0)
    };
    let middle = displacement(0.0, 0.0);
    assert!((middle / ellipse.approach(load) - 1.0).abs() < 1e-10);
    for (x, y) in [(0.4 * a, 0.0), (0.0, 0.7 * b), (0.3 * a, -0.5 * b)] {
        let gap = x * x / 60.0 + y * y / 8.0;
        assert!(
            ((middle - displacement(x, y)) / gap - 1.0).abs() < 1e-9,
            "{x} {y}"
        );
    }
}

#[test]
fn loads_invert_and_axes_exchange() {
    let ellipse = HertzEllipse::new([3.0, 11.0], 500.0).unwrap();
    let turned = HertzEllipse::new([11.0, 3.0], 500.0).unwrap();
    let load = 7.0;
    let [x, y] = ellipse.semi_axes(load);
    assert_eq!(turned.semi_axes(load), [y, x]);
    assert!(y > x);
    for back in [
        ellipse.load_for_semi_axis(0, x),
        ellipse.load_for_semi_axis(1, y),
        ellipse.load_for_max_pressure(ellipse.max_pressure(load)),
        ellipse.load_for_approach(ellipse.approach(load)),
    ] {
        assert!((back / load - 1.0).abs() < 1e-13);
    }
    // Equal cylinders crossed at right angles touch in a circle.
    let crossed = HertzEllipse::relative_radii([5.0, f64::INFINITY], [0.0, 5.0]).unwrap();
    assert_eq!(crossed, [5.0, 5.0]);
    assert!(HertzEllipse::relative_radii([5.0, 5.0], [-5.0, 20.0]).is_err());
    assert!(HertzEllipse::relative_radii([5.0, 0.0], [0.0, 0.0]).is_err());
}

/// The stress below the middle is the largest. At all other points the stress is found by summing
/// over all point forces.
#[test]
fn no_other_point_is_stressed_more() {
    for ratio in [0.1, 0.3, 0.6, 1.0] {
        for nu in [0.2, 0.3, 0.5] {
            let ellipse = HertzEllipse {
                radii: [1.0, 1.0],
                contact_modulus: 1.0,
                ratio,
            };
            let peak = ellipse.yield_peak(nu).stress;
            let shear = ellipse.peak(greatest_shear, nu).stress;
            for (x, y) in [
                (0.3, 0.0),
                (0.0, 0.3),
                (0.6, 0.0),
                (0.0, 0.6),
                (0.4, 0.4),
                (0.9, 0.0),
            ] {
                for depth in [0.15, 0.3, 0.45, 0.6, 0.8] {
                    let there = principal_at(1.0 / ratio, [x / ratio, y, depth], nu);
                    let own = [von_mises(there, 0.0), greatest_shear(there)];
                    assert!(
                        own[0] < peak * (1.0 + 1e-3) && own[1] < shear * (1.0 + 1e-3),
                        "{ratio} {nu} {x} {y} {depth}: {own:?} {peak} {shear}"
                    );
                }
            }
        }
    }
}

/// Gauss's rule with 8 points on each of 8 parts of an interval.
fn gauss(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    const HALF: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];
    const PARTS: usize = 8;
    let length = (to - from) / PARTS as f64;
    (0..PARTS).flat_map(move |part| {
        let middle = from + (part as f64 + 0.5) * length;
        HALF.into_iter()
            .flat_map(move |(x, w)| [-x, x].map(|x| (middle + 0.5 * length * x, 0.5 * length * w)))
    })
}

/// Principal stresses at any point below the surface, by Boussinesq's point forces.
fn principal_at(a: f64, [px, py, z]: [f64; 3], nu: f64) -> [f64; 3] {
    let mut t = [0.0; 6];
    let rays = 256;
    for ray in 0..rays {
        let (sin, cos) = (2.0 * PI * (ray as f64 + 0.5) / rays as f64).sin_cos();
        // From the point outwards the square of the pressure is C - 2 B r - A r^2.
        let qa = (cos / a).powi(2) + sin * sin;
        let qb = px * cos / (a * a) + py * sin;
        let qc = 1.0 - (px / a).powi(2) - py * py;
        let end = ((qb * qb + qa * qc).sqrt() - qb) / qa;
        for (v, weight) in gauss(0.0, 1.0) {
            let r = end * v * (2.0 - v);
            let p = (qc - 2.0 * qb * r - qa * r * r).max(0.0).sqrt();
            let share = weight * 2.0 * end * (1.0 - v) * p * r / rays as f64;
            // Vector from the point force to the point.
            let (x, y) = (-r * cos, -r * sin);
            let (r2, z2) = (r * r, z * z);
            let rho = (r2 + z2).sqrt();
            let (k, third) = (1.0 - 2.0 * nu, 3.0 * z / rho.powi(5));
            let slope = 1.0 / (rho * (rho + z));
            let turn = slope * (x * x - y * y);
            let part = [
                k / r2 * (turn + z * y * y / rho.powi(3)) - third * x * x,
                k / r2 * (-turn + z * x * x / rho.powi(3)) - third * y * y,
                -third * z2,
                k / r2 * (2.0 * slope * x * y - z * x * y / rho.powi(3)) - third * x * y,
                -third * z * y,
                -third * z * x,
            ];
            for (sum, part) in t.iter_mut().zip(part) {
                *sum += share * part;
            }
        }
    }
    let [x, y, z, xy, yz, zx] = t;
    let tensor = nalgebra::Matrix3::new(x, xy, zx, xy, y, yz, zx, yz, z);
    tensor.symmetric_eigenvalues().into()
}

/// Johnson, table 4.1, p. 99: depth and size of the largest shear for `nu = 0.3`.
#[test]
fn largest_shears_of_johnsons_table() {
    for (ratio, depth, shear) in [
        (0.2, 0.745, 0.322),
        (0.4, 0.665, 0.325),
        (0.6, 0.590, 0.323),
        (0.8, 0.530, 0.317),
        (1.0, 0.480, 0.310),
    ] {
        let found = of_ratio(ratio).peak(greatest_shear, 0.3);
        // The table gives depths to 0.005, for a maximum that is flat.
        assert!((found.stress - shear).abs() < 1e-3, "{ratio}: {found:?}");
        assert!((found.depth - depth).abs() < 7e-3, "{ratio}: {found:?}");
    }
}

/// W. C. Young, R. G. Budynas, *Roark's Formulas for Stress and Strain*, 7th ed. 2002, table 14.1,
/// case 4: half axes `alpha (P K_D C_E)^(1/3)` and `beta (..)^(1/3)`, approach
/// `lambda (P^2 C_E^2/K_D)^(1/3)` with `K_D = 1.5/(sum of curvatures)`, `C_E = 1/E*`.
#[test]
fn coefficients_of_roarks_table() {
    for (cosine, alpha, beta, lambda) in [
        (0.00, 1.000, 1.000, 0.750),
        (0.10, 1.070, 0.936, 0.748),
        (0.20, 1.150, 0.878, 0.743),
        (0.30, 1.242, 0.822, 0.734),
        (0.40, 1.351, 0.769, 0.721),
        (0.50, 1.486, 0.717, 0.703),
        (0.60, 1.661, 0.664, 0.678),
        (0.70, 1.905, 0.608, 0.644),
        (0.80, 2.292, 0.544, 0.594),
        (0.90, 3.093, 0.461, 0.510),
        (0.94, 3.824, 0.412, 0.452),
        (0.98, 5.937, 0.328, 0.345),
        (0.99, 7.774, 0.287, 0.288),
    ] {
        // Sum and difference of the relative curvatures: K_D = E* = P = 1.
        let sum = 1.5;
        let radii = [2.0 / (sum * (1.0 - cosine)), 2.0 / (sum * (1.0 + cosine))];
        let ellipse = HertzEllipse::new(radii, 1.0).unwrap();
        let [a, b] = ellipse.semi_axes(1.0);
        for (found, published) in [(a, alpha), (b, beta), (ellipse.approach(1.0), lambda)] {
            // Three digits after the decimal point, of which the last ones in the original (Hertz's
            // own interpolations) are off by up to four.
            assert!(
                (found - published).abs() < 4e-3,
                "{cosine}: {found} {published}"
            );
        }
    }
}

/// Lundberg and Palmgren's amplitude is the largest shear of the field, on both sides of the middle
/// and along both axes.
#[test]
fn orthogonal_shear_is_the_largest_of_the_field() {
    for ratio in [0.05, 0.3, 1.0] {
        let ellipse = of_ratio(ratio);
        for axis in [0, 1] {
            let along = ellipse.semi_axes(1.0)[axis];
            let peak = ellipse.orthogonal_shear(axis, 1.0);
            let at_depth = |z: f64| {
                let there = |x: f64| ellipse.shear(axis, x, z, 1.0).abs();
                maximum(there, 0.0, 1.2 * along, 60).1
            };
            let (depth, stress) = maximum(at_depth, 0.01 * along, along, 60);
            assert!((stress / peak.stress - 1.0).abs() < 1e-12, "{ratio} {axis}");
            assert!((depth / peak.depth - 1.0).abs() < 1e-6, "{ratio} {axis}");
        }
    }
    // Circle and line: 0.214 p0 at 0.35 a, p0/4 at b/2.
    let circle = of_ratio(1.0);
    let peak = circle.orthogonal_shear(0, 1.0);
    assert!((peak.stress / circle.max_pressure(1.0) - 0.214).abs() < 5e-4);
    assert!((peak.depth / circle.semi_axes(1.0)[0] - 0.351).abs() < 5e-4);
}

/// The stress below the middle is the sum over all point forces, and for a circle it agrees with
/// Huber's.
#[test]
fn stress_below_the_middle() {
    for ratio in [0.3, 1.0] {
        for depth in [0.6, 1.4] {
            for nu in [0.0, 0.3, 0.5] {
                let own = von_mises(axis_stress(1.0 / ratio, depth, nu), 0.0);
                let sum = principal_at(1.0 / ratio, [0.0, 0.0, depth], nu);
                let sum = von_mises(sum, 0.0);
                assert!(
                    (own / sum - 1.0).abs() < 1e-6,
                    "{ratio} {depth} {nu}: {own} {sum}"
                );
            }
        }
    }
    let (modulus, load) = (1000.0, 3.0);
    let point = HertzPoint::new(2.0, modulus).unwrap();
    let ellipse = HertzEllipse::new([2.0, 2.0], modulus).unwrap();
    for depth in [0.0, 1e-3, 0.1, 1.0] {
        let [x, y, z] = ellipse.stress_below_middle(depth, load, 0.3);
        let [rr, tt, zz, _] = point.stress(0.0, depth, load, 0.3);
        let scale = 1e-13 * point.max_pressure(load);
        assert!((x - rr).abs() < scale && (y - tt).abs() < scale && (z - zz).abs() < scale);
        assert_eq!(ellipse.shear(0, 0.0, depth, load), 0.0);
        let shear = ellipse.shear(0, 0.07, depth, load);
        assert!(
            (shear - point.stress(0.07, depth, load, 0.3)[3]).abs() < scale,
            "{depth}"
        );
    }
    // Exchanging the radii exchanges the axes.
    let [long, turned] = [[9.0, 2.0], [2.0, 9.0]].map(|r| HertzEllipse::new(r, modulus).unwrap());
    let [x, y, z] = long.stress_below_middle(0.1, load, 0.3);
    let found = turned.stress_below_middle(0.1, load, 0.3);
    for (own, other) in found.into_iter().zip([y, x, z]) {
        assert!((own / other - 1.0).abs() < 1e-14);
    }
}

/// Long ellipses approach a line contact with the load per length at their middle, `p0 pi b/2`:
/// half widths and shears across differ by order `(b/a)^2` and its logarithm, stresses along the
/// contact by order `b/a`.
#[test]
fn long_ellipses_approach_the_line() {
    for ratio in [1e-2, 1e-4] {
        let ellipse = of_ratio(ratio);
        let p0 = ellipse.max_pressure(1.0);
        let [a, b] = ellipse.semi_axes(1.0);
        assert!((b / a / ratio - 1.0).abs() < 1e-9, "{ratio}: {}", b / a);
        let line = HertzLine::new(ellipse.radii[1], ellipse.contact_modulus).unwrap();
        let load = line.load_for_max_pressure(p0);
        let square = 4.0 * ratio * ratio * (4.0 / ratio).ln() + 1e-9;
        let near = |found: f64, limit: f64, bound: f64| {
            assert!(
                (found / limit - 1.0).abs() < bound,
                "{ratio}: {found} {limit}"
            );
        };
        near(b, line.half_width(load), square);
        for nu in [0.0, 0.3, 0.5] {
            let (own, limit) = (ellipse.largest_shear(1.0, nu), line.largest_shear(load, nu));
            near(own.stress, limit.stress, 2.0 * ratio);
            let (own, limit) = (
                ellipse.largest_von_mises(1.0, nu),
                line.largest_von_mises(load, nu),
            );
            near(own.stress, limit.stress, 2.0 * ratio);
        }
        near(
            ellipse.orthogonal_shear(1, 1.0).stress,
            line.orthogonal_shear(load).stress,
            square,
        );
    }
}

/// An ellipse with the given ratio of its axes, the longer one along x.
fn of_ratio(ratio: f64) -> HertzEllipse {
    let d = complementary_d(ratio);
    let large = (complementary_k(ratio) - d) / (d * ratio * ratio);
    HertzEllipse::new([large, 1.0], 1.0).unwrap()
}
