//! Fading back stresses compared with closed forms in one dimension and with the law in small
//! explicit steps.

use super::*;
use nalgebra::{SMatrix, SVector};

/// Material with E = 200, isotropic hardening by a table, two fading back stresses and one linear.
fn steel(space: Space) -> Material {
    let curve = Hardening::table(&[[0.0, 1.0], [0.004, 1.3], [0.01, 1.4]]);
    each_kind(material(space, 0.3, curve))[2].clone()
}

/// Pulls a point to an axial strain with free sides; returns the axial stress and plastic strain.
fn pull<const S: usize>(point: &mut Point<S>, m: &Material, axial: f64) -> [f64; 2] {
    let at = |lateral: f64| {
        let mut strain = [0.0; S];
        (strain[0], strain[1]) = (axial, lateral);
        if m.space != Space::PlaneStress {
            strain[2] = lateral;
        }
        strain
    };
    let lateral = root::of(|e| point.stress(m, &at(e))[1], -0.2, 0.2);
    let stress = point.advance(m, &at(lateral));
    [stress[0], point.state.strain[0]]
}

/// Shears a point; returns `sqrt 3` times the shear stress, and the plastic shear over `sqrt 3`.
fn shear(point: &mut Point<6>, m: &Material, strain: f64) -> [f64; 2] {
    let root = 3f64.sqrt();
    let stress = point.advance(m, &[0.0, 0.0, 0.0, root * strain, 0.0, 0.0]);
    [root * stress[3], point.state.strain[3] / root]
}

/// Law in one dimension, integrated exactly: `C/gamma (1 - exp(-gamma |deps_p|))` and so on.
struct Bar {
    plastic: f64,
    equivalent: f64,
    back: Vec<f64>,
}

impl Bar {
    /// Stress after a change of plastic strain in one direction.
    fn flow(&mut self, m: &Material, plastic: f64) -> f64 {
        let step = plastic - self.plastic;
        (self.plastic, self.equivalent) = (plastic, self.equivalent + step.abs());
        let hardening = m.hardening.as_ref().unwrap();
        let mut stress = step.signum() * hardening.yield_stress(self.equivalent);
        for (back, [modulus, rate]) in self.back.iter_mut().zip(LAWS) {
            *back = match rate == 0.0 {
                true => modulus * plastic,
                false => {
                    let end = step.signum() * modulus / rate;
                    end + (*back - end) * (-rate * step.abs()).exp()
                }
            };
            stress += *back;
        }
        stress
    }
}

/// Moduli and rates of the last material of [`each_kind`].
const LAWS: [[f64; 2]; 3] = [[60.0, 40.0], [10.0, 0.0], [30.0, 300.0]];

/// Tension and shear in both directions, each way in one increment or in many.
#[test]
fn paths_in_one_direction_are_exact_however_long_the_increments() {
    for steps in [1, 7] {
        for kind in 0..3 {
            let space = [Space::PlaneStress, Space::PlaneStrain, Space::Solid][kind];
            let m = steel(space);
            let (mut plane, mut solid) = (Point::<4>::new(&m), Point::<6>::new(&m));
            let mut bar = Bar {
                plastic: 0.0,
                equivalent: 0.0,
                back: vec![0.0; 3],
            };
            let mut before = 0.0;
            for target in [0.04, -0.03, 0.05, 0.0] {
                for i in 1..=steps {
                    let strain = before + (target - before) * f64::from(i) / f64::from(steps);
                    let [stress, plastic] = match kind {
                        0 => pull(&mut plane, &m, strain),
                        1 => pull(&mut solid, &m, strain),
                        _ => shear(&mut solid, &m, strain),
                    };
                    if plastic == bar.plastic {
                        continue;
                    }
                    let exact = bar.flow(&m, plastic);
                    // Round-off of trial stresses: 200 * 0.1.
                    assert!(
                        (stress - exact).abs() < 1e-13 * 20.0,
                        "{kind} {stress} {exact}"
                    );
                    let found = 200.0 * (strain - plastic);
                    if kind < 2 {
                        assert!((stress - found).abs() < 1e-12);
                    }
                }
                before = target;
            }
            assert!(bar.equivalent > 0.1);
        }
    }
}

/// Stress cycles about a mean stress with one fading back stress: the strain grows by
///
/// ```text
/// 1/gamma log(((C/gamma)^2 - (low + Y)^2)/((C/gamma)^2 - (high - Y)^2))     in each cycle
/// ```
///
/// from the exact integrals of both ways.
#[test]
fn ratchetting_goes_on_at_its_rate() {
    let (c, gamma, y, high, low) = (60.0, 40.0, 1.0, 1.9, -1.5);
    let m = Material {
        back_stresses: BackStresses::new([[c, gamma]]),
        ..material(Space::Solid, 0.3, Hardening::linear(y, 0.0))
    };
    let limit: f64 = c / gamma;
    let open = |stress: f64| limit * limit - stress * stress;
    let rate = (open(low + y) / open(high - y)).ln() / gamma;
    assert!(rate > 1e-3);
    let mut point = Point::<6>::new(&m);
    let mut ends = Vec::new();
    for _ in 0..6 {
        for target in [high, low] {
            let excess = |strain: f64| pull(&mut point.clone(), &m, strain)[0] - target;
            let strain = root::of(excess, -1.0, 1.0);
            let [stress, plastic] = pull(&mut point, &m, strain);
            assert!((stress - target).abs() < 1e-11);
            if target == high {
                ends.push(plastic);
            }
        }
    }
    for pair in ends.windows(2).skip(1) {
        let found = pair[1] - pair[0];
        assert!((found / rate - 1.0).abs() < 1e-9, "{found} {rate}");
    }
}

/// A strain path that turns, compared with the law integrated in 400 000 explicit steps: the
/// implicit rule is of first order.
#[test]
fn a_path_that_turns_approaches_the_law_with_the_steps() {
    let path = |s: f64| {
        [
            0.02 * s,
            -0.008 * s,
            -0.006 * s,
            0.03 * s * s,
            0.0,
            0.01 * s,
        ]
    };
    let m = steel(Space::Solid);
    let explicit = explicit(&m, path, 400_000);
    let errors = [10, 20, 40, 80].map(|steps: usize| {
        let mut point = Point::<6>::new(&m);
        let mut stress = [0.0; 6];
        for i in 1..=steps {
            stress = point.advance(&m, &path(i as f64 / steps as f64));
        }
        let off: [f64; 6] = std::array::from_fn(|k| stress[k] - explicit[k]);
        off
    });
    for pair in errors.windows(2) {
        let order = (von_mises(&pair[0]) / von_mises(&pair[1])).log2();
        assert!((order - 1.0).abs() < 0.05, "{errors:?}");
    }
    // The remaining error is of second order, since both have the same limit.
    let left: [f64; 6] = std::array::from_fn(|k| 2.0 * errors[3][k] - errors[2][k]);
    assert!(von_mises(&left) < 2e-4, "{left:?}");
}

/// The law by the forward rule: Prandtl and Reuss with the consistency condition, no return
/// mapping.
fn explicit(m: &Material, path: impl Fn(f64) -> [f64; 6], steps: usize) -> [f64; 6] {
    let (law, g) = (m.lame(), m.shear_modulus());
    let hardening = m.hardening.as_ref().unwrap();
    let mut plastic = [0.0; 6];
    let mut back = [[0.0; 6]; 3];
    let mut equivalent = 0.0;
    let relative = |strain: &[f64; 6], plastic: &[f64; 6], back: &[[f64; 6]; 3]| {
        let stress = law.stress(strain, plastic);
        let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
        let deviator = |k: usize| if k < 3 { stress[k] - mean } else { stress[k] };
        let xi: [f64; 6] =
            std::array::from_fn(|k| deviator(k) - back.iter().map(|a| a[k]).sum::<f64>());
        xi
    };
    for i in 0..steps {
        let [from, to] = [i, i + 1].map(|i| path(i as f64 / steps as f64));
        let xi = relative(&from, &plastic, &back);
        let q = von_mises(&xi);
        let rate: [f64; 6] = std::array::from_fn(|k| to[k] - from[k]);
        // From the yield condition: 3/2 xi/q : (2G deps) = dp (3G + H + sum C - 3/2 gamma xi:a/q).
        let drive = 3.0 * g / q * double_dot(&xi, &tensor_of(&rate));
        if q < hardening.yield_stress(equivalent) || drive <= 0.0 {
            continue;
        }
        let mut stiffness = 3.0 * g + hardening.slope(equivalent);
        for (a, [modulus, gamma]) in back.iter().zip(LAWS) {
            stiffness += modulus - 1.5 * gamma * double_dot(&xi, a) / q;
        }
        let d = drive / stiffness;
        equivalent += d;
        for k in 0..6 {
            let flow = 1.5 * d * xi[k] / q;
            plastic[k] += if k < 3 { flow } else { 2.0 * flow };
            for (a, [modulus, gamma]) in back.iter_mut().zip(LAWS) {
                a[k] += 2.0 / 3.0 * modulus * flow - gamma * a[k] * d;
            }
        }
    }
    law.stress(&path(1.0), &plastic)
}

/// Newton's method for the strain at a given stress, from a state after a path that turned. The
/// full tangent converges quadratically; its symmetric part alone does not.
#[test]
fn newton_converges_to_second_order() {
    let m = steel(Space::Solid);
    let mut point = Point::<6>::new(&m);
    point.advance(&m, &[0.02, -0.01, -0.01, 0.0, 0.0, 0.0]);
    let goal = [0.0, 0.004, -0.004, 0.03, 0.01, 0.0];
    let target = SVector::<f64, 6>::from(point.stress(&m, &goal));
    let elastic = matrix::<6>(|e| m.lame().times(e));
    let residuals = |whole: bool| -> Vec<f64> {
        let mut strain = goal;
        strain[3] *= 0.8;
        strain[0] += 0.004;
        let newton = (0..9).map(|_| {
            let update = point.integrate(&m, &strain);
            let taken = matrix(|e| match whole {
                true => lost(&update, e),
                false => update.softening.times(e),
            });
            let tangent = SMatrix::<f64, 6, 6>::from_fn(|i, j| elastic[i][j] - taken[i][j]);
            let left = target - SVector::from(point.stress(&m, &strain));
            let step = tangent.lu().solve(&left).unwrap();
            strain = std::array::from_fn(|k| strain[k] + step[k]);
            left.norm()
        });
        newton.collect()
    };
    let (with, without) = (residuals(true), residuals(false));
    // Errors relative to the yield stress, which is 1.
    assert!(with[1] < 0.1 && with[2] < with[1].powi(2), "{with:?}");
    assert!(with[3] < with[2].powi(2) && with[4] < 1e-13, "{with:?}");
    assert!(
        without[3] > 1e3 * with[3] && without[4] > 1e6 * with[4],
        "{without:?}"
    );
}

/// Work on plastic strains around loops in tension and shear equals `int sigma deps_p` of the path
/// in small steps.
#[test]
fn work_is_that_of_the_path() {
    let m = steel(Space::Solid);
    let (mut point, mut work, n) = (Point::<6>::new(&m), 0.0, 4000);
    let mut before = ([0.0; 6], [0.0; 6]);
    for i in 1..=4 * n {
        let angle = f64::from(i) / f64::from(n) * std::f64::consts::PI;
        let axial = 0.02 * angle.sin();
        let strain = [
            axial,
            -0.5 * axial,
            -0.5 * axial,
            0.03 * (1.0 - angle.cos()),
            0.0,
            0.0,
        ];
        let stress = point.advance(&m, &strain);
        let plastic = point.state.strain;
        work += (0..6)
            .map(|k| 0.5 * (stress[k] + before.0[k]) * (plastic[k] - before.1[k]))
            .sum::<f64>();
        before = (stress, plastic);
    }
    let found = point.work(&m);
    assert!(point.lost_work > 0.1 * work, "{} {work}", point.lost_work);
    assert!((found / work - 1.0).abs() < 1e-4, "{found} {work}");
}
