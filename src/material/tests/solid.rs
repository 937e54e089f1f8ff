//! Tests of material points with all six components.

use super::*;

/// Pseudo-random numbers between -1 and 1.
fn numbers() -> impl FnMut() -> f64 {
    let mut seed = 7u64;
    move || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn in_space([x, y, z, xy]: [f64; 4]) -> [f64; 6] {
    [x, y, z, xy, 0.0, 0.0]
}

/// Six components `[xx, yy, zz, xy, yz, zx]` as a symmetric matrix, shears multiplied by `share`.
fn tensor([x, y, z, xy, yz, zx]: [f64; 6], share: f64) -> [[f64; 3]; 3] {
    let [xy, yz, zx] = [xy, yz, zx].map(|t| share * t);
    [[x, xy, zx], [xy, y, yz], [zx, yz, z]]
}

/// Rotated tensor `Q t Q'` as six components; `share` is 1/2 for engineering strains, 1 for
/// stresses.
fn turned(components: [f64; 6], share: f64, q: &[[f64; 3]; 3]) -> [f64; 6] {
    let t = tensor(components, share);
    let at = |i: usize, j: usize| -> f64 {
        let row = |k: usize| (0..3).map(|l| t[k][l] * q[j][l]).sum::<f64>();
        (0..3).map(|k| q[i][k] * row(k)).sum()
    };
    [
        at(0, 0),
        at(1, 1),
        at(2, 2),
        at(0, 1) / share,
        at(1, 2) / share,
        at(2, 0) / share,
    ]
}

/// Rotation about all three axes.
fn rotation(angles: [f64; 3]) -> [[f64; 3]; 3] {
    let mut q = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (axis, angle) in angles.into_iter().enumerate() {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (sin, cos) = angle.sin_cos();
        for row in &mut q {
            (row[i], row[j]) = (cos * row[i] - sin * row[j], sin * row[i] + cos * row[j]);
        }
    }
    q
}

/// Paths of loading, unloading and reversal in plane strain give the same histories, stresses and
/// tangents in four components and in six, of which two stay zero.
#[test]
fn a_path_of_plane_strain_is_the_same_in_six_components() {
    let mut number = numbers();
    let all = curves().into_iter();
    for m in all.flat_map(|curve| each_kind(material(Space::PlaneStrain, 0.3, curve))) {
        let (mut plane, mut space) = (Point::<4>::new(&m), Point::<6>::new(&m));
        let mut strain = [0.0; 4];
        let mut yielded = 0;
        for _ in 0..40 {
            strain = strain.map(|e| e + 0.01 * number());
            strain[2] = 0.0;
            let of_plane = plane.integrate(&m, &strain);
            let of_space = space.integrate(&m, &in_space(strain));
            assert_eq!(of_plane.yields, of_space.yields);
            yielded += usize::from(of_plane.yields);
            let stress = plane.advance(&m, &strain);
            assert_eq!(in_space(stress), space.advance(&m, &in_space(strain)));
            assert_eq!(in_space(plane.state.strain), space.state.strain);
            assert_eq!(plane.state.equivalent, space.state.equivalent);
            let backs = plane.back.iter().zip(&space.back);
            assert!(
                backs
                    .clone()
                    .all(|(plane, space)| in_space(*plane) == *space)
            );
            assert_eq!(von_mises(&stress), von_mises(&in_space(stress)));
            let direction = std::array::from_fn(|_| number());
            assert_eq!(
                in_space(lost(&of_plane, &direction)),
                lost(&of_space, &in_space(direction))
            );
        }
        assert!(yielded > 10, "{yielded}");
    }
}

/// Rotated strains and history give the rotated history and stress: the law is isotropic.
#[test]
fn a_turned_path_gives_the_turned_stress() {
    let mut number = numbers();
    let all = curves().into_iter();
    for m in all.flat_map(|curve| each_kind(material(Space::PlaneStrain, 0.3, curve))) {
        for _ in 0..20 {
            let q = rotation(std::array::from_fn(|_| 3.0 * number()));
            let (mut own, mut other) = (Point::<6>::new(&m), Point::<6>::new(&m));
            for _ in 0..5 {
                let strain: [f64; 6] = std::array::from_fn(|_| 0.02 * number());
                let turned_strain = turned(strain, 0.5, &q);
                let expected = turned(own.advance(&m, &strain), 1.0, &q);
                let stress = other.advance(&m, &turned_strain);
                let flow = own.state.equivalent - other.state.equivalent;
                assert!(flow.abs() < 1e-15);
                for (a, b) in stress.iter().zip(expected) {
                    // Trial stresses are about 200 * 0.02 * 3.
                    assert!((a - b).abs() < 64.0 * f64::EPSILON * 12.0, "{a} {b}");
                }
                let trace: f64 = other.state.strain[..3].iter().sum();
                assert!(trace.abs() < 1e-16);
            }
        }
    }
}

/// The stress lies on the yield surface and the tangent is its derivative, in all six components.
#[test]
fn the_tangent_is_the_derivative_in_six_components() {
    let mut number = numbers();
    let mut yielded = 0;
    for round in 0..300 {
        let curve = curves()[round % 3].clone();
        let knees: &[f64] = if round % 3 == 2 { &[0.004, 0.01] } else { &[] };
        let m = material(
            Space::PlaneStrain,
            [0.0, 0.3, 0.49][round % 7 % 3],
            curve.clone(),
        );
        let m = each_kind(m)[round / 3 % 3].clone();
        let law = m.lame();
        let strain: [f64; 6] = std::array::from_fn(|_| 0.02 * number());
        let mut past: [f64; 6] = std::array::from_fn(|_| 0.002 * number());
        past[2] = -past[0] - past[1];
        let point = Point::with(&m, past, 0.001);
        let update = point.integrate(&m, &strain);
        let h = 1e-8;
        let near_knee = |k: &f64| (update.state.equivalent - k).abs() <= 10.0 * h;
        if !update.yields || knees.iter().any(near_knee) {
            continue;
        }
        yielded += 1;
        let mut after = point.clone();
        after.advance(&m, &strain);
        let q = von_mises(&m.relative_stress(&law, &strain, &after.past()));
        assert!((q - curve.yield_stress(update.state.equivalent)).abs() < 1e-11);
        let (elastic, taken) = (matrix::<6>(|e| law.times(e)), matrix(|e| lost(&update, e)));
        for j in 0..6 {
            let at = |step: f64| {
                let mut e = strain;
                e[j] += step;
                point.stress(&m, &e)
            };
            let (plus, minus) = (at(h), at(-h));
            for i in 0..6 {
                let derivative = (plus[i] - minus[i]) / (2.0 * h);
                let consistent = elastic[i][j] - taken[i][j];
                assert!(
                    (derivative - consistent).abs() <= 1e-6 * elastic[0][0],
                    "{round} {i}{j}: {derivative} {consistent}"
                );
            }
        }
    }
    assert!(yielded > 200, "{yielded}");
}

/// The law of [`Lame`] equals Hooke's law, written with E and nu.
#[test]
fn lame_is_hooke() {
    let (e, nu) = (200.0, 0.3);
    let strain = [0.01, -0.02, 0.005, 0.004, -0.006, 0.003];
    let m = material(Space::PlaneStrain, nu, Hardening::linear(1.0, 0.0));
    let s = m.lame().times(&strain);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let found = (s[i] - nu * (s[j] + s[k])) / e;
        assert!((found - strain[i]).abs() < 1e-16);
        let shear = 2.0 * (1.0 + nu) / e * s[i + 3];
        assert!((shear - strain[i + 3]).abs() < 1e-16);
    }
    let plane = material(Space::PlaneStress, nu, Hardening::linear(1.0, 0.0)).lame();
    let [x, y, z, xy] = plane.times(&[0.01, -0.02, 7.0, 0.004]);
    assert_eq!((z, xy), (0.0, m.shear_modulus() * 0.004));
    assert!(((x - nu * y) / e - 0.01).abs() < 1e-16 && ((y - nu * x) / e + 0.02).abs() < 1e-16);
    let Lame { lambda, mu, .. } = m.lame();
    let reduced = 2.0 * lambda * mu / (lambda + 2.0 * mu);
    assert!((plane.lambda - reduced).abs() < 1e-13 * reduced);
    let bulk = e / (3.0 * (1.0 - 2.0 * nu));
    assert!((m.lame().bulk() - bulk).abs() < 1e-13 * bulk);
}
