//! Smooth flat punch of circular section on a perfectly plastic half space (von Mises): between
//! Tresca's answers.
//!
//! Source: R. T. Shield, Proc. R. Soc. A 233 (1955) 267-287: 5.69 k for Tresca's material
//! (`data/reference/punch`). Tresca's hexagon with k = Y/2 lies within von Mises' ellipse, that
//! with k = Y/sqrt(3) round it, and a material that carries more everywhere has the larger limit
//! load (R. Hill, The Mathematical Theory of Plasticity, chapter III): 2.845 Y <= p <= 3.285 Y.

use crate::support::{run_file, state};
use brinell::analytical::CircularPunch;

#[test]
fn limit_load_lies_between_those_of_tresca() {
    let y = 100.0;
    let punch = CircularPunch::new(1.0).unwrap();
    let (least, most) = (
        punch.smooth_limit_load(y / 2.0),
        punch.smooth_limit_load(y / 3f64.sqrt()),
    );
    let load = |n: usize| {
        let elements = format!("mesh.parts.0.block.elements=[{n},{n}]");
        let set = [
            "kind=axisymmetric",
            "symmetry=1",
            "reference=[]",
            elements.as_str(),
        ];
        let results = run_file("flat_punch", &set);
        // Collapsed: a tenth of the load's rise is left of the way from half the displacement to
        // the whole.
        let [half, whole] = ["alpha 0.5", "flow"].map(|name| state(&results, name).load);
        assert!(whole < 1.02 * half, "{n}: {half} {whole}");
        whole
    };
    let (coarse, fine) = (load(20), load(40));
    // From above, of order h: the jump of pressure at the edge takes one element.
    let extrapolated = 2.0 * fine - coarse;
    assert!(fine < coarse, "{coarse} {fine}");
    assert!(
        least < extrapolated && extrapolated < most,
        "{least} < {extrapolated} < {most}; {coarse} {fine}"
    );
}
