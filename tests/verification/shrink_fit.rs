//! Shrink fit of a solid shaft in a ring, plane stress: `p = E d (b^2 - a^2)/(2 a b^2)`.
//!
//! Source: S. Timoshenko, Strength of Materials, part II (1956), art. 42; Lame.

use crate::support::run_file;
#[test]
fn pressure_converges_to_lame() {
    let error = |n: usize| {
        let (shaft, ring) = (
            format!("mesh.parts.0.disc.elements={n}"),
            format!("mesh.parts.1.ring.elements=[{n},{n}]"),
        );
        let results = run_file("shrink_fit", &[&shaft, &ring]);
        let pairs = &results.states[0].pairs;
        let force: f64 = pairs.iter().map(|p| p.force).sum();
        let area: f64 = pairs.iter().map(|p| p.area).sum();
        (force / area / 78.75 - 1.0).abs()
    };
    let (coarse, fine) = (error(8), error(16));
    // Bilinear elements: order h^2, and C from (h/a)^2 = (pi/32)^2 at 16.
    assert!(
        fine <= 0.1 * (std::f64::consts::PI / 32.0).powi(2),
        "{fine:.2e}"
    );
    assert!(fine <= coarse / 3.0, "{coarse:.2e} {fine:.2e}");
}

/// All pairs stay closed, so that the pressures are linear in the interference.
#[test]
fn an_interference_that_grows_with_the_load_is_applied_in_proportion() {
    let fitted = |until: &str| {
        run_file(
            "shrink_fit",
            &[
                "program.unit=load",
                "program.targets=[{name=\"fitted\",load_factor=1.0}]",
                until,
            ],
        )
    };
    let whole = fitted("program.interference_until=0.5");
    let half = fitted("program.interference_until=2.0");
    // A few units of round-off times the condition number, which is below 100.
    let ratio = half.states[0].max_pressure / whole.states[0].max_pressure;
    assert!((ratio / 0.5 - 1.0).abs() <= 1e-12, "{ratio}");
    assert_eq!(
        half.warnings,
        [
            "program.interference_until: 2 is beyond the largest target, 1: at most 50 % of the \
          interference is applied"
        ]
    );
    assert!(whole.warnings.is_empty(), "{:?}", whole.warnings);
}
