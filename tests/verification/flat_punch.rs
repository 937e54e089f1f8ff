//! Smooth flat punch on a perfectly plastic block, plane strain: mean pressure (2 + pi) k.
//!
//! Source: L. Prandtl (1920); R. Hill, The Mathematical Theory of Plasticity (1950), chapter IX.

use crate::support::{run_file, state};
#[test]
fn limit_load_converges_from_above() {
    for shape in ["quad4", "quad8"] {
        let load = |n: usize| {
            let results = run_file(
                "flat_punch",
                &[
                    &format!("mesh.parts.0.element=\"{shape}\""),
                    &format!("mesh.parts.0.block.elements=[{n},{n}]"),
                ],
            );
            state(&results, "flow").load / 296.85
        };
        let (coarse, fine) = (load(10), load(20));
        // The jump of pressure at the edge takes one element, so the load is too high by the order
        // of h: from above, and what is left after extrapolation is of second order, (h/a)^2 = 1/16
        // of the correction's size.
        let extrapolated = 2.0 * fine - coarse;
        assert!(fine < coarse && fine > 1.0, "{shape}: {coarse} {fine}");
        assert!(
            (extrapolated - 1.0).abs() < 0.01,
            "{shape}: {coarse} {fine} {extrapolated}"
        );
    }
}
