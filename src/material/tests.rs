use super::tensor::{double_dot, tensor_of};
use super::*;

mod fading;
mod solid;
mod strain_path;

fn material(space: Space, nu: f64, hardening: Hardening) -> Material {
    Material {
        name: "m".into(),
        youngs_modulus: 200.0,
        poissons_ratio: nu,
        hardening: Some(hardening),
        back_stresses: BackStresses::default(),
        space,
    }
}

/// Returns the material without kinematic hardening, with Prager's, and with Prager's and two
/// fading back stresses.
fn each_kind(material: Material) -> [Material; 3] {
    let laws: [&[[f64; 2]]; 3] = [
        &[],
        &[[25.0, 0.0]],
        &[[60.0, 40.0], [10.0, 0.0], [30.0, 300.0]],
    ];
    laws.map(|laws| Material {
        back_stresses: BackStresses::new(laws.iter().copied()),
        ..material.clone()
    })
}

/// A point with its history; the fading back stresses hold a share of the plastic strain.
#[derive(Debug, Clone)]
struct Point<const S: usize> {
    state: PlasticState<S>,
    back: Vec<[f64; S]>,
    lost_work: f64,
}

impl<const S: usize> Point<S> {
    fn new(m: &Material) -> Self {
        Self::with(m, [0.0; S], 0.0)
    }

    fn with(m: &Material, strain: [f64; S], equivalent: f64) -> Self {
        let share = |i: usize| if i == 0 { 0.5 } else { -0.2 };
        let back = (0..m.back_stresses.n_stored()).map(|i| strain.map(|e| share(i) * e));
        Point {
            state: PlasticState { strain, equivalent },
            back: back.collect(),
            lost_work: 0.0,
        }
    }

    fn past(&self) -> Past<'_, S> {
        Past {
            state: &self.state,
            back: &self.back,
            harder: 0.0,
        }
    }

    fn integrate(&self, m: &Material, strain: &[f64; S]) -> Update<S> {
        m.integrate(&m.lame(), strain, &self.past())
    }

    /// Stress at a total strain, without changing the point.
    fn stress(&self, m: &Material, strain: &[f64; S]) -> [f64; S] {
        let plastic = self.integrate(m, strain).state.strain;
        m.lame().stress(strain, &plastic)
    }

    /// Moves the point to a total strain and returns the stress there.
    fn advance(&mut self, m: &Material, strain: &[f64; S]) -> [f64; S] {
        let state = self.integrate(m, strain).state;
        let laws = &m.back_stresses;
        self.lost_work += laws.carry(&mut self.back, &self.state, &state);
        self.state = state;
        m.lame().stress(strain, &state.strain)
    }

    fn work(&self, m: &Material) -> f64 {
        m.plastic_work(&self.past()) + self.lost_work
    }
}

/// Stress that flow takes off the elastic stress of a strain increment.
fn lost<const S: usize>(update: &Update<S>, strain: &[f64; S]) -> [f64; S] {
    let (out, flow) = (
        update.softening.times(strain),
        update.softening.flow(strain),
    );
    std::array::from_fn(|k| out[k] + flow * update.turn[k])
}

/// Matrix of a linear map.
fn matrix<const S: usize>(map: impl Fn(&[f64; S]) -> [f64; S]) -> [[f64; S]; S] {
    let columns: [[f64; S]; S] = std::array::from_fn(|j| {
        let mut unit = [0.0; S];
        unit[j] = 1.0;
        map(&unit)
    });
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

fn curves() -> [Hardening; 3] {
    [
        Hardening::linear(1.0, 0.0),
        Hardening::linear(1.0, 30.0),
        Hardening::table(&[[0.0, 1.0], [0.004, 1.3], [0.01, 1.4]]),
    ]
}

#[test]
fn hardening_curves_interpolate() {
    let table = Hardening::table(&[[0.0, 1.0], [0.004, 1.4], [0.01, 1.7]]);
    assert_eq!(table.yield_stress(0.002), 1.2);
    assert!((table.slope(0.0) - 100.0).abs() < 1e-12);
    assert!((table.slope(0.004) - 50.0).abs() < 1e-12);
    assert_eq!(table.yield_stress(1.0), 1.7);
    // Area of trapezoids, and of a rectangle beyond the last row.
    let exact = 0.004 * 1.2 + 0.006 * 1.55 + 0.99 * 1.7;
    assert!((table.work(1.0) - exact).abs() < 4.0 * f64::EPSILON * exact);
    assert_eq!((table.work(0.0), table.work(0.002)), (0.0, 0.002 * 1.1));
    let linear = Hardening::linear(2.0, 30.0);
    assert!((linear.work(0.1) - (0.2 + 15.0 * 0.01)).abs() < 1e-15);
    assert_eq!(table.slope(1.0), 0.0);
}

/// A bar of E = 200, yield stress 1 and tangent modulus 40 under a strain of 0.03: the stress is
/// `1 + 40 (0.03 - 1/200) = 2`, and `0.03 - 2/200 = 0.02` of the strain is plastic.
#[test]
fn a_tangent_modulus_is_the_slope_of_the_whole_strain() {
    let data = crate::scene::Material {
        youngs_modulus: 200.0,
        poissons_ratio: 0.3,
        yield_stress: Some(1.0),
        tangent_modulus: Some(40.0),
        ..Default::default()
    };
    let hardening = Hardening::from_scene(&data).unwrap();
    assert!((hardening.yield_stress(0.02) - 2.0).abs() <= 4.0 * f64::EPSILON);
    let (d, slope) = hardening.solve(2.0 + 200.0 * 0.02, 200.0, 0.0);
    assert!(
        (d - 0.02).abs() <= 4.0 * f64::EPSILON && slope == 50.0,
        "{d} {slope}"
    );
}

#[test]
fn stress_after_flow_lies_on_the_yield_surface() {
    for space in [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric] {
        let all = curves().into_iter();
        for m in all.flat_map(|curve| each_kind(material(space, 0.3, curve))) {
            let curve = m.hardening.clone().unwrap();
            let d = m.lame();
            let strain = match space {
                Space::Axisymmetric => [0.012, -0.004, 0.003, 0.009],
                _ => [0.012, -0.004, 0.0, 0.009],
            };
            let mut point = Point::with(&m, [0.001, -0.0004, -0.0006, 0.0002], 0.0011);
            let old = point.state;
            let new = point.integrate(&m, &strain);
            assert!(new.yields);
            point.advance(&m, &strain);
            let q = von_mises(&m.relative_stress(&d, &strain, &point.past()));
            let y = curve.yield_stress(new.state.equivalent);
            assert!(
                (q - y).abs() < 1e-13 * (1.0 + 200.0 * 0.02),
                "{space:?} {curve:?}: {q} {y}"
            );
            let trace: f64 = new.state.strain[..3].iter().sum();
            assert!(trace.abs() < 1e-16);
            let step: Vec<f64> = (0..4)
                .map(|i| new.state.strain[i] - old.strain[i])
                .collect();
            let norm = (2.0 / 3.0
                * (step[0].powi(2) + step[1].powi(2) + step[2].powi(2) + 0.5 * step[3].powi(2)))
            .sqrt();
            assert!((norm - (new.state.equivalent - old.equivalent)).abs() < 1e-15);
        }
    }
}

/// The consistent tangent is the derivative of the stress: central differences, error O(step^2).
#[test]
fn softening_is_the_derivative_of_the_stress() {
    for space in [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric] {
        let all = curves().into_iter();
        for m in all.flat_map(|curve| each_kind(material(space, 0.3, curve))) {
            let d = m.lame();
            let strain = [
                0.009,
                -0.006,
                if space == Space::Axisymmetric {
                    0.002
                } else {
                    0.0
                },
                0.007,
            ];
            let point = Point::with(&m, [0.0007, -0.0003, -0.0004, 0.0003], 0.0009);
            let update = point.integrate(&m, &strain);
            let tangent = matrix(|e| lost(&update, e));
            let symmetric = matrix(|e| update.softening.times(e));
            let elastic = matrix::<4>(|e| d.times(e));
            let h = 1e-7;
            for j in 0..4 {
                if space == Space::PlaneStress && j == 2 {
                    continue;
                }
                let at = |t: f64| {
                    let mut e = strain;
                    e[j] += t;
                    point.stress(&m, &e)
                };
                let (plus, minus) = (at(h), at(-h));
                for i in 0..4 {
                    if space == Space::PlaneStress && i == 2 {
                        continue;
                    }
                    let derivative = (plus[i] - minus[i]) / (2.0 * h);
                    let consistent = elastic[i][j] - tangent[i][j];
                    // Truncation ~ |D| h^2/strain^2, round-off ~ eps stress/h.
                    assert!(
                        (derivative - consistent).abs() < 200.0 * 1e-6,
                        "{space:?} {i}{j}: {derivative} {consistent}"
                    );
                    assert!((symmetric[i][j] - symmetric[j][i]).abs() < 1e-11);
                }
            }
        }
    }
}

/// The tangent of plane stress agrees with central differences in many states: strains from just
/// beyond yield to fifty times as much, histories of either sign, all curves. Unloading points are
/// elastic and lose nothing; points whose differences straddle a kink of a table are left out.
#[test]
fn the_tangent_of_plane_stress_is_consistent_in_states_of_all_kinds() {
    let mut seed = 1u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let (mut yielding, mut elastic) = (0, 0);
    for round in 0..3000 {
        let curve = curves()[round % 3].clone();
        let knees: &[f64] = if round % 3 == 2 { &[0.004, 0.01] } else { &[] };
        let m = material(Space::PlaneStress, [0.0, 0.3, 0.49][round % 7 % 3], curve);
        let m = each_kind(m)[round / 3 % 3].clone();
        let d = m.lame();
        let size = 0.003 * 80f64.powf(0.5 + 0.5 * random());
        let strain = [size * random(), size * random(), 0.0, size * random()];
        let p = [
            0.2 * size * random(),
            0.2 * size * random(),
            0.2 * size * random(),
        ];
        let equivalent = 0.3 * size * (1.0 + random());
        let mut point = Point::with(&m, [p[0], p[1], -p[0] - p[1], p[2]], equivalent);
        // Back stresses are limited to what flow can produce.
        let fading = m.back_stresses.rates().zip(&mut point.back);
        for (rate, back) in fading {
            let strain = tensor_of(back);
            let norm = (2.0 / 3.0 * double_dot(&strain, &strain)).sqrt();
            let share = 1.0 / (1.0 + rate * norm);
            back.iter_mut().for_each(|e| *e *= share);
        }
        let old = point.state;
        let update = point.integrate(&m, &strain);
        if !update.yields {
            assert_eq!(update.softening, Softening::NONE);
            elastic += 1;
            continue;
        }
        let h = 1e-6 * size;
        let near_knee = |k: &f64| (update.state.equivalent - k).abs() <= 10.0 * h;
        let just_flows = update.state.equivalent - old.equivalent <= 10.0 * h;
        if just_flows || knees.iter().any(near_knee) {
            continue;
        }
        yielding += 1;
        let elastic = matrix::<4>(|e| d.times(e));
        let lost = matrix(|e| lost(&update, e));
        for j in [0, 1, 3] {
            let at = |t: f64| {
                let mut e = strain;
                e[j] += t;
                point.stress(&m, &e)
            };
            let (plus, minus) = (at(h), at(-h));
            for i in [0, 1, 3] {
                let derivative = (plus[i] - minus[i]) / (2.0 * h);
                let consistent = elastic[i][j] - lost[i][j];
                assert!(
                    (derivative - consistent).abs() <= 1e-5 * elastic[0][0],
                    "{round} {i}{j}: {derivative} {consistent}"
                );
            }
        }
    }
    assert!(yielding > 1000 && elastic > 100, "{yielding} {elastic}");
}

/// Cyclic test of one element under uniaxial stress in plane stress: the yield stress grows with
/// the length of the plastic path.
#[test]
fn cyclic_uniaxial_stress_follows_the_hardening_curve() {
    let (e, h, y) = (200.0, 20.0, 1.0);
    let m = material(Space::PlaneStress, 0.3, Hardening::linear(y, h));
    let et = e * h / (e + h);
    let mut point = Point::new(&m);
    let mut yield_now = y;
    let mut axial_plastic = 0.0;
    for target in [0.02, -0.02, 0.03, -0.01] {
        // The lateral stress must vanish: the lateral strain is found by bisection of a monotone
        // function.
        let (mut a, mut b) = (-0.1, 0.1);
        for _ in 0..200 {
            let lateral = 0.5 * (a + b);
            let s = point.stress(&m, &[target, lateral, 0.0, 0.0]);
            if s[1] > 0.0 { b = lateral } else { a = lateral }
        }
        let strain = [target, 0.5 * (a + b), 0.0, 0.0];
        let sigma = point.advance(&m, &strain)[0];
        let sign = (target - axial_plastic).signum();
        let at_yield = axial_plastic + sign * yield_now / e;
        let expected = sign * yield_now + et * (target - at_yield);
        assert!((sigma - expected).abs() < 1e-12, "{sigma} {expected}");
        yield_now = sigma.abs();
        axial_plastic = target - sigma / e;
    }
}

/// A point with a higher yield stress behaves like a material whose whole curve is higher.
#[test]
fn a_harder_point_has_a_higher_curve() {
    for space in [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric] {
        let higher = Hardening::table(&[[0.0, 1.2], [0.004, 1.5], [0.01, 1.6]]);
        let usual = Hardening::table(&[[0.0, 1.0], [0.004, 1.3], [0.01, 1.4]]);
        let materials = each_kind(material(space, 0.3, usual)).into_iter();
        for (m, other) in materials.zip(each_kind(material(space, 0.3, higher))) {
            let point = Point::with(&m, [0.0007, -0.0003, -0.0004, 0.0003], 0.0009);
            for strain in [[0.009, -0.006, 0.0, 0.007], [0.0052, -0.001, 0.0, 0.001]] {
                let past = Past {
                    harder: 0.2,
                    ..point.past()
                };
                let law = m.lame();
                let (found, expected) = (
                    m.integrate(&law, &strain, &past),
                    other.integrate(&law, &strain, &point.past()),
                );
                assert_eq!(found.yields, expected.yields);
                assert_eq!(m.stays_elastic(&law, &strain, &past), !found.yields);
                for k in 0..4 {
                    let off = found.state.strain[k] - expected.state.strain[k];
                    assert!(off.abs() < 1e-15, "{space:?}");
                }
                let [a, b] = [&found, &expected].map(|update| matrix(|e| lost(update, e)));
                for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
                    assert!((a - b).abs() < 1e-10, "{space:?} {a} {b}");
                }
                let [mine, others] = [m.plastic_work(&past), other.plastic_work(&point.past())];
                assert!((mine - others).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn elastic_material_never_flows() {
    let m = Material {
        hardening: None,
        ..material(Space::PlaneStrain, 0.3, Hardening::linear(1.0, 0.0))
    };
    let point = Point::new(&m);
    assert!(!point.integrate(&m, &[1.0, -2.0, 0.0, 3.0]).yields);
}
