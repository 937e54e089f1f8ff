//! A rigid surface without a mesh, through the C interface.

use super::*;
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Silent;
use crate::scene::Scene;

/// The figures are those of the same scene run in Rust.
#[test]
fn a_rigid_surface_gives_the_bits_of_the_scene() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/rigid_ball.toml"
    );
    let model = Model::new(&Scene::load(path).unwrap()).unwrap();
    let mut analysis = crate::analysis::Analysis::new(model, Backend::default()).unwrap();
    let expected = analysis.run(&mut Silent).unwrap();
    let path = CString::new(path).unwrap();
    let (mut scene, mut run) = (null_mut(), null_mut());
    // SAFETY: texts and places live through the calls, handles are freed once.
    unsafe {
        let loaded = brinell_scene_load(path.as_ptr(), null(), 0, &mut scene);
        assert_eq!(loaded, BRINELL_OK, "{}", message());
        let ran = brinell_run(scene, null(), None, null_mut(), &mut run);
        assert_eq!(ran, BRINELL_OK, "{}", message());
        for (path, expected) in [
            ("states.pressed.approach", expected.states[1].approach),
            (
                "states.unloaded.residual_depth",
                expected.states[2].residual_depth,
            ),
        ] {
            let path = CString::new(path).unwrap();
            let mut value = 0.0;
            assert_eq!(
                brinell_results_value(run, path.as_ptr(), &mut value),
                BRINELL_OK
            );
            assert!(
                value == expected && value > 0.0,
                "{path:?}: {value} {expected}"
            );
        }
        brinell_results_free(run);
        brinell_scene_free(scene);
    }
}
