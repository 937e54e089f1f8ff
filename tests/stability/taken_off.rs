//! A load that is taken off wholly: the last pair opens where the load is zero, however badly the
//! elastic bodies are conditioned.

use crate::support;

/// Far boundaries of up to a hundred million contact radii: elimination keeps eight digits of the
/// load of plastic strains, whose resultant on a body is zero all the same. What round-off left of
/// it drove the ball away from the flat for good before the load was gone.
#[test]
fn round_off_of_plastic_strains_drives_no_body_away() {
    for (resolution, stepping) in [(4, "auto"), (4, "events"), (6, "auto"), (10, "auto")] {
        let scene = support::load(
            "ball_on_half_space",
            &[
                &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
                "mesh.cylinder_on_half_plane.growth=1.5",
                "mesh.cylinder_on_half_plane.far_size=3e5",
                "materials.steel.yield_stress=50.0",
                &format!("program.stepping=\"{stepping}\""),
                "program.targets=[{ yield = true }, { name = \"peak\", load_factor = 2.0 }, \
                 { name = \"off\", load_factor = 0.0 }]",
            ],
        );
        let results = support::run(&scene);
        assert!(results.incomplete.is_none(), "{:?}", results.incomplete);
        let [_, peak, off] = &results.states[..] else {
            panic!("{}", results.states.len());
        };
        assert!(peak.plastic_points > 0 && peak.closed_pairs > 0);
        // The last pair touches still, without force.
        let gone = [
            off.load,
            off.contact_force,
            off.max_pressure,
            off.half_width,
        ];
        assert_eq!(gone, [0.0; 4]);
        assert!(off.residual_depth > 0.0, "{}", off.residual_depth);
    }
}
