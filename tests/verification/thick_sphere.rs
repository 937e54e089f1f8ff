//! Thick sphere under internal pressure, elastic-perfectly plastic, exact for any nu.
//!
//! Source: R. Hill, The Mathematical Theory of Plasticity (1950), chapter V.

use crate::run::{close, run, scene, state};
use brinell::analytical::ThickSphere;

#[test]
fn expands_by_hill_and_converges() {
    for nu in [0.3, 0.4999] {
        let exact = ThickSphere::new(100.0, 200.0, 210e3, nu, 240.0)
            .unwrap()
            .displacement(200.0, 287.123)
            .unwrap();
        let error = |n: usize| {
            let results = run(&scene(
                "thick_sphere",
                &[
                    &format!("materials.steel.poissons_ratio={nu}"),
                    &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                ],
            ));
            close(
                results.first_yield.unwrap().alpha,
                140.0,
                0.3 / (n * n) as f64,
            );
            let front = state(&results, "front at 150").fields.as_ref().unwrap();
            let outer = front
                .displacement
                .chunks(2)
                .map(|d| d[0].hypot(d[1]))
                .fold(f64::INFINITY, f64::min);
            (outer / exact - 1.0).abs()
        };
        let (coarse, fine) = (error(6), error(12));
        // The front, a kink of the strain, lies inside an element: at least first order, C about 0.05.
        assert!(fine <= 0.05 / 12.0, "nu {nu}: {coarse:.2e} {fine:.2e}");
        assert!(
            fine <= coarse / 1.5 || fine <= 3e-4,
            "nu {nu}: {coarse:.2e} {fine:.2e}"
        );
    }
}
