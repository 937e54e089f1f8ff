//! A steel cylinder on an aluminium block under 35 kN/mm.
//!
//! Source: NAFEMS R0094, Advanced Finite Element Contact Benchmarks, CB1
//! (`data/reference/nafems_r0094`).

use crate::support::{run_file, state};
use crate::verification::close;
/// Nodes on a circle of half width b meet a parabola's: Hertz's gap x^2/2R is off by a share of
/// (b/2R)^2 = 0.4 %; the rest is the mesh's.
#[test]
fn half_width_and_pressure_are_those_of_the_benchmark() {
    let errors = |n: usize| {
        let resolution = format!("mesh.cylinder_on_half_plane.resolution={n}");
        let results = run_file("nafems_cb1", &[&resolution]);
        let s = state(&results, "pressed");
        // Round-off times the condition of bodies a thousand half widths large.
        close(s.contact_force, 35e3, 1e-8);
        [s.half_width / 6.215 - 1.0, s.max_pressure / 3585.0 - 1.0].map(f64::abs)
    };
    let (coarse, fine) = (errors(8), errors(16));
    let model = (6.215f64 / 100.0).powi(2);
    for k in 0..2 {
        // Of order h^2: a constant of 1 for the pressure, whose slope at the pole is zero, and for
        // the width, which p^2 is extrapolated to.
        for (error, n) in [(coarse[k], 8.0), (fine[k], 16.0)] {
            assert!(error <= model + 1.0 / (n * n), "{k}: {coarse:?} {fine:?}");
        }
    }
}
