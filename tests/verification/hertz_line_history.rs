//! Loading and unloading of a cylinder on a half plane, the paper's figures 5.1 to 5.5.
//!
//! Source: N. Endahl, section 5.1; load factors from the legend of figure 5.3.

use crate::support::{run_file, state};
use crate::verification::close;
#[test]
fn loading_to_one_and_a_half_widths_and_back() {
    let results = run_file(
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=12"],
    );
    let loading = &results.states[..5];
    for pair in loading.windows(2) {
        assert!(pair[1].max_pressure > pair[0].max_pressure);
        assert!(pair[1].half_width > pair[0].half_width);
        assert!(pair[1].plastic_points > pair[0].plastic_points);
        assert!(pair[1].residual_depth > pair[0].residual_depth);
    }
    let peak = state(&results, "1.5 b*");
    // A target width is found to 1e-10 of an increment; the accuracy of hitting it, not that of the
    // mesh.
    close(
        peak.half_width,
        1.5 * results.first_yield.unwrap().half_width,
        1e-8,
    );
    // The legend's largest factor belongs to the paper's coarse mesh (Table I: 13 % in load at
    // yield, 2 % in width).
    close(peak.alpha, 2.0635, 0.03);

    let unloading = &results.states[4..];
    for pair in unloading.windows(2) {
        assert!(pair[1].max_pressure < pair[0].max_pressure);
        assert!(pair[1].half_width < pair[0].half_width);
        // Unloading is elastic here: nothing flows, so the history is the same to the last bit.
        assert_eq!(pair[1].plastic_points, peak.plastic_points);
        assert_eq!(
            pair[1].max_equivalent_plastic_strain,
            peak.max_equivalent_plastic_strain
        );
        close(pair[1].residual_depth, peak.residual_depth, 1e-9);
    }
    // At the same load contact is wider on the way down: the surfaces conform. Loading at 1.4351
    // lies between these.
    let (below, above) = (
        state(&results, "alpha 1.3207"),
        state(&results, "alpha 1.587"),
    );
    let share = (1.4351 - below.alpha) / (above.alpha - below.alpha);
    let loading_width = below.half_width + share * (above.half_width - below.half_width);
    assert!(state(&results, "unloading 1.4351").half_width > loading_width);
}
