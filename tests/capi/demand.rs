//! A demanded accuracy through the C interface.
#![cfg(feature = "capi")]

use crate::support::program::summary;
use crate::support::scene_path;
use brinell::capi::*;
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

fn message() -> String {
    // SAFETY: the library's own text, valid until the next failure.
    unsafe { CStr::from_ptr(brinell_last_error()) }
        .to_str()
        .unwrap()
        .to_string()
}

/// A scene with `accuracy` is run to it: finer than it stands, and with the status of a demand
/// where it is not reached.
#[test]
fn a_demanded_accuracy_is_kept_or_has_a_status() {
    let scenes = [
        ("thick_cylinder", c"accuracy=5 %", BRINELL_OK),
        ("pin_in_hole", c"accuracy=approach=1 %", BRINELL_INACCURATE),
    ];
    for (name, set, expected) in scenes {
        let path = CString::new(scene_path(name)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let to = CString::new(out.to_str().unwrap()).unwrap();
        let (mut scene, mut results) = (null_mut(), null_mut());
        // SAFETY: texts and places live through the calls, handles are freed once.
        unsafe {
            let loaded = brinell_scene_load(path.as_ptr(), [set.as_ptr()].as_ptr(), 1, &mut scene);
            assert_eq!(loaded, BRINELL_OK, "{}", message());
            let status = brinell_run(scene, null(), None, null_mut(), &mut results);
            assert_eq!(status, expected, "{name}: {}", message());
            assert_eq!(brinell_results_write(results, to.as_ptr()), BRINELL_OK);
            brinell_results_free(results);
            brinell_scene_free(scene);
        }
        let summary = summary(&out);
        let demand = &summary["accuracy"]["demand"];
        assert_eq!(demand["reached"], expected == BRINELL_OK, "{demand}");
    }
    assert!(message().contains("NOT reached"), "{}", message());
}
