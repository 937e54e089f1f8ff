//! The disc in the plate compared with the published figures and with its own field equations.

use super::*;

fn disc() -> DiscInPlate {
    DiscInPlate::new(1.0).unwrap()
}

#[test]
fn published_figures() {
    let d = disc();
    assert!((d.half_angle().to_degrees() - 19.625).abs() < 5e-4);
    assert!((d.pressure(0.0, 1.0) - 0.60908).abs() < 5e-6);
    let stress = d.yield_tension(Plane::Stress, 0.3, 1.0).unwrap();
    let strain = d.yield_tension(Plane::Strain, 0.3, 1.0).unwrap();
    assert!((stress - 0.3392).abs() < 5e-5, "{stress}");
    assert!((strain - 0.3566).abs() < 5e-5, "{strain}");
}

#[test]
fn bodies_touch_in_the_contact_and_nowhere_else() {
    let d = disc();
    let (e, q0) = (d.half_angle, d.mean_pressure);
    for i in 0..20 {
        // The integrand has a root singularity at the far end of the interval, as described at
        // `integrate`.
        let t = e * f64::from(i) / 20.0;
        assert!(unit_gap(t, e, q0).abs() < 1e-9, "{}", unit_gap(t, e, q0));
        assert!(d.pressure(t, 1.0) > 0.0);
    }
    let mut last = 0.0;
    for i in 1..=50 {
        let t = e + (FRAC_PI_2 - e) * f64::from(i) / 50.0;
        let gap = d.gap(t, 1.0, 1.0);
        assert!(gap > last);
        assert_eq!(d.pressure(t, 1.0), 0.0);
        assert!((d.gap(PI - t, 1.0, 1.0) - gap).abs() < 1e-12);
        last = gap;
    }
    assert_eq!(d.gap(0.5 * e, 1.0, 1.0), 0.0);
    assert_eq!(d.gap(PI + 0.5 * e, 1.0, 1.0), 0.0);
}

#[test]
fn mean_pressure_is_the_mean_and_the_pole_carries_the_cut() {
    let d = disc();
    let mean = 2.0 * integrate(|t| d.pressure(t, 1.0), 0.0, d.half_angle) / PI;
    assert!((mean - d.mean_pressure).abs() < 1e-10);
    // The cut y = 0 through the disc carries the force of one pole.
    let cut = -integrate(|x| d.disc_stress(x, 0.0, 1.0)[1], -1.0, 1.0);
    assert!((cut / d.pole_force(1.0) - 1.0).abs() < 1e-9, "{cut}");
}

#[test]
fn rims_carry_the_pressure_and_no_shear() {
    let d = DiscInPlate::new(2.0).unwrap();
    for i in 0..36 {
        let t = 0.05 + PI * f64::from(i) / 18.0;
        let n = [t.sin(), t.cos()];
        let p = d.pressure(t, 1.5);
        let in_disc = d.disc_stress(2.0 * n[0], 2.0 * n[1], 1.5);
        let in_plate = d.plate_stress(2.0 * n[0], 2.0 * n[1], 1.5);
        for s in [in_disc, in_plate] {
            let pull = [s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]];
            assert!((pull[0] * n[0] + pull[1] * n[1] + p).abs() < 1e-12);
            assert!((pull[0] * n[1] - pull[1] * n[0]).abs() < 1e-12);
        }
        let hoop = in_plate[0] + in_plate[1] + p;
        assert!((hoop - d.edge_hoop_stress(t, 1.5)).abs() < 1e-12);
    }
}

#[test]
fn fields_are_in_equilibrium_and_compatible() {
    let d = disc();
    // Central differences, h^2 times third derivatives of order 10; second differences lose
    // eps/h^2.
    let h = 1e-4;
    let disc_at = |x, y| d.disc_stress(x, y, 1.0);
    let plate_at = |x, y| d.plate_stress(x, y, 1.0);
    let check = |at: &dyn Fn(f64, f64) -> [f64; 3], x: f64, y: f64| {
        let (e, w, n, s, o) = (
            at(x + h, y),
            at(x - h, y),
            at(x, y + h),
            at(x, y - h),
            at(x, y),
        );
        let along = (e[0] - w[0] + n[2] - s[2]) / (2.0 * h);
        let up = (e[2] - w[2] + n[1] - s[1]) / (2.0 * h);
        assert!(along.abs() < 1e-5 && up.abs() < 1e-5, "{along} {up}");
        let sum = |a: [f64; 3]| a[0] + a[1];
        let laplace = (sum(e) + sum(w) + sum(n) + sum(s) - 4.0 * sum(o)) / (h * h);
        assert!(laplace.abs() < 1e-4, "{laplace}");
    };
    for (x, y) in [(0.0, 0.0), (0.3, 0.5), (-0.2, 0.7), (0.6, -0.3)] {
        check(&disc_at, x, y);
    }
    for (x, y) in [(0.0, 1.4), (0.9, 0.9), (-0.6, 1.3), (2.0, -3.0)] {
        check(&plate_at, x, y);
    }
    let far = d.plate_stress(2e4, 1e4, 1.0);
    assert!((far[0] - 1.0).abs() < 1e-7 && far[1].abs() < 1e-7 && far[2].abs() < 1e-7);
}

#[test]
fn plate_yields_at_the_pole_and_the_disc_stays_elastic_to_twice_the_load() {
    let d = disc();
    for (plane, nu) in [(Plane::Stress, 0.3), (Plane::Strain, 0.3)] {
        let tension = d.yield_tension(plane, nu, 1.0).unwrap();
        for i in 0..=60 {
            for j in 0..=60 {
                let r = 1.0 + 0.03 * f64::from(i);
                let t = FRAC_PI_2 * f64::from(j) / 60.0;
                let [sxx, syy, sxy] = d.plate_stress(r * t.sin(), r * t.cos(), tension);
                let szz = plane.out_of_plane(sxx + syy, nu);
                assert!(von_mises([sxx, syy, szz], sxy) <= 1.0 + 1e-12);
            }
        }
        for i in 0..=200 {
            for j in 0..=200 {
                let (sin, cos) = (FRAC_PI_2 * f64::from(j) / 200.0).sin_cos();
                let r = f64::from(i) / 200.0;
                let [sxx, syy, sxy] = d.disc_stress(r * sin, r * cos, 2.0 * tension);
                let szz = plane.out_of_plane(sxx + syy, nu);
                assert!(von_mises([sxx, syy, szz], sxy) < 1.0);
            }
        }
    }
}

#[test]
fn proportional_to_the_load_and_free_of_the_radius() {
    let (small, large) = (
        DiscInPlate::new(1e-3).unwrap(),
        DiscInPlate::new(7.0).unwrap(),
    );
    assert_eq!(small.half_angle(), large.half_angle());
    assert!((small.pressure(0.1, 4.0) - 4.0 * large.pressure(0.1, 1.0)).abs() < 1e-14);
    let ratio = large.gap(1.0, 1.0, 3.0) / small.gap(1.0, 1.0, 3.0);
    assert!((ratio / 7e3 - 1.0).abs() < 1e-12);
    assert!(DiscInPlate::new(f64::INFINITY).is_err());
    assert!(small.yield_tension(Plane::Stress, 0.6, 1.0).is_err());
    assert!(small.yield_tension(Plane::Stress, 0.3, 0.0).is_err());
}
