//! Access to numbers by their paths.

use super::*;

/// Every quantity of the table is found at its path, and nothing else.
#[test]
fn numbers_are_found_by_their_paths() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/unload_reload.toml"
    );
    let path = CString::new(path).unwrap();
    let (mut scene, mut run) = (null_mut(), null_mut());
    let mut value = 0.0;
    let mut state = brinell_state {
        size: size_of::<brinell_state>(),
        alpha: 0.0,
        load: 0.0,
        contact_force: 0.0,
        max_pressure: 0.0,
        half_width: 0.0,
        residual_depth: 0.0,
        approach: 0.0,
        max_equivalent_plastic_strain: 0.0,
        plastic_points: 0,
        n_pairs: 0,
        has_fields: 0,
    };
    // SAFETY: texts and places live through the calls, handles are freed once.
    unsafe {
        let loaded = brinell_scene_load(path.as_ptr(), null(), 0, &mut scene);
        assert_eq!(loaded, BRINELL_OK, "{}", message());
        let ran = brinell_run(scene, null(), None, null_mut(), &mut run);
        assert_eq!(ran, BRINELL_OK, "{}", message());
        assert_eq!(brinell_results_state(run, 1, &mut state), BRINELL_OK);
        let mut at = |path: &str| {
            let path = CString::new(path).unwrap();
            let status = brinell_results_value(run, path.as_ptr(), &mut value);
            (status == BRINELL_OK).then_some(value)
        };
        let name = CStr::from_ptr(brinell_results_state_name(run, 1));
        let name = name.to_str().unwrap();
        for index in 0..brinell_n_quantities() {
            let key = CStr::from_ptr(brinell_quantity_key(index))
                .to_str()
                .unwrap();
            let by_number = at(&format!("states.1.{key}")).unwrap();
            let by_name = at(&format!("states.{name}.{key}")).unwrap();
            assert!(by_number == by_name || by_name.is_nan(), "{key}");
        }
        assert_eq!(at("states.1.load"), Some(state.load));
        assert_eq!(at("states.1.approach"), Some(state.approach));
        let points = Some(state.plastic_points as f64);
        assert!(at("states.1.plastic_points") == points && at("states.1.plastic_work") > Some(0.0));
        for wrong in [
            "load",
            "states.load",
            "states.99.load",
            "states.1.loud",
            "yield.name",
            "",
        ] {
            assert_eq!(at(wrong), None, "{wrong}");
        }
        assert!(message().contains("yield.KEY"), "{}", message());
        assert!(brinell_quantity_key(brinell_n_quantities()).is_null());
        brinell_results_free(run);
        brinell_scene_free(scene);
    }
}
