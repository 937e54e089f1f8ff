//! Smooth flat punch on a perfectly plastic block, plane strain: mean pressure (2 + pi) k.
//!
//! Source: L. Prandtl (1920); R. Hill, The Mathematical Theory of Plasticity (1950), chapter IX.

use crate::run::{run, scene, state};

#[test]
fn limit_load_converges_from_above() {
    for shape in ["quad4", "quad8"] {
        let load = |n: usize| {
            let results = run(&scene(
                "flat_punch",
                &[
                    &format!("mesh.parts.0.element=\"{shape}\""),
                    &format!("mesh.parts.0.block.elements=[{n},{n}]"),
                ],
            ));
            state(&results, "flow").load / 296.85
        };
        let (coarse, fine) = (load(10), load(20));
        // The jump of pressure at the edge takes one element: about half an element's share of the punch width, h/2.
        assert!(fine > 0.995 && fine < 1.0 + 0.6 * 5.0 / 20.0, "{shape}: {coarse} {fine}");
        assert!(fine < coarse, "{shape}: {coarse} {fine}");
    }
}
