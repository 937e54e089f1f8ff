//! Misuse from the other side: a status and a message, never worse. What works is shown by the programs in `ffi/examples`.

use super::*;
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

fn message() -> String {
    // SAFETY: the library's own text, valid until the next failure.
    unsafe { CStr::from_ptr(brinell_last_error()) }
        .to_str()
        .unwrap()
        .to_string()
}

#[test]
fn null_and_nonsense_are_refused_with_a_message() {
    let mut scene = null_mut();
    let mut results = null_mut();
    let text = CString::new("kind = 'plane_stretch'").unwrap();
    // SAFETY: NULL is allowed to be given everywhere.
    unsafe {
        assert_eq!(
            brinell_scene_load(null(), null(), 0, &raw mut scene),
            BRINELL_INPUT
        );
        assert!(message().contains("NULL"));
        assert_eq!(
            brinell_scene_load(c"/no/such".as_ptr(), null(), 0, &raw mut scene),
            BRINELL_IO
        );
        assert_eq!(
            brinell_scene_load(c"/no/such".as_ptr(), null(), 3, &raw mut scene),
            BRINELL_INPUT
        );
        assert_eq!(
            brinell_scene_parse(text.as_ptr(), &raw mut scene),
            BRINELL_INPUT
        );
        assert!(message().contains("plane_stretch"), "{}", message());
        assert_eq!(brinell_scene_parse(c"".as_ptr(), null_mut()), BRINELL_INPUT);
        assert!(scene.is_null());
        assert_eq!(
            brinell_run(null(), null(), None, null_mut(), &raw mut results),
            BRINELL_INPUT
        );
        assert_eq!(brinell_results_n_states(null()), 0);
        assert!(brinell_results_state_name(null(), 0).is_null());
        assert_eq!(brinell_results_write(null(), null()), BRINELL_INPUT);
        brinell_scene_free(null_mut());
        brinell_results_free(null_mut());
        brinell_structure_free(null_mut());
    }
}

/// As the program's exit code 7: results there are, and they say that they are not to be trusted.
#[test]
fn lost_accuracy_has_a_status() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/floating_body.toml"
    );
    let path = CString::new(path).unwrap();
    for (gap, expected) in [("0.01", BRINELL_OK), ("1e8", BRINELL_INACCURATE)] {
        let set = CString::new(format!("contact.0.gap={gap}")).unwrap();
        let (mut scene, mut results) = (null_mut(), null_mut());
        // SAFETY: texts and places live through the calls, handles are freed once.
        unsafe {
            let loaded = brinell_scene_load(path.as_ptr(), [set.as_ptr()].as_ptr(), 1, &mut scene);
            assert_eq!(loaded, BRINELL_OK, "{}", message());
            let status = brinell_run(scene, null(), None, null_mut(), &mut results);
            assert_eq!(status, expected, "gap {gap}");
            assert!(!results.is_null());
            brinell_results_free(results);
            brinell_scene_free(scene);
        }
    }
    assert!(message().contains("equilibrium"), "{}", message());
}

#[test]
fn a_structure_of_another_size_is_older_newer_or_refused() {
    let mut options = brinell_options {
        size: size_of::<usize>(),
        backend: 99,
    };
    // SAFETY: as long as it says.
    unsafe {
        // An older caller does not know `backend`: it is not read.
        assert!(super::options::backend(&raw const options).is_ok());
        options.size = size_of::<brinell_options>();
        assert!(super::options::backend(&raw const options).is_err());
        for size in [0, 1, 1 << 40] {
            options.size = size;
            let error = super::options::backend(&raw const options).unwrap_err();
            assert!(error.message().contains("sizeof"), "{error}");
        }
        // A newer caller has more.
        #[repr(C)]
        struct Newer {
            options: brinell_options,
            more: [u64; 4],
        }
        let newer = Newer {
            options: brinell_options {
                size: size_of::<Newer>(),
                backend: BRINELL_BACKEND_DENSE,
            },
            more: [7; 4],
        };
        let backend = super::options::backend((&raw const newer).cast()).unwrap();
        assert_eq!((backend, newer.more[0]), (crate::linalg::Backend::Dense, 7));
    }
}

#[test]
fn a_panic_becomes_a_status() {
    let status = super::border::guarded(|| panic!("on purpose"));
    assert_eq!(status, BRINELL_INTERNAL);
    assert!(message().contains("on purpose"));
}

#[test]
fn a_damaged_matrix_is_refused() {
    let (starts, rows, values) = ([0i64, 1, 2], [0i64, 1], [1.0, 1.0]);
    let good = brinell_matrix {
        size: size_of::<brinell_matrix>(),
        n: 2,
        column_starts: starts.as_ptr(),
        rows: rows.as_ptr(),
        values: values.as_ptr(),
        triangle: BRINELL_TRIANGLE_UPPER,
    };
    let new = |matrix: brinell_matrix| {
        let mut structure = null_mut();
        // SAFETY: arrays as long as the matrix says, but for those that the test sets to be refused before they are read.
        let status =
            unsafe { brinell_structure_new(&raw const matrix, null(), null(), &raw mut structure) };
        // SAFETY: handed out or NULL.
        unsafe { brinell_structure_free(structure) };
        status
    };
    assert_eq!(new(good), BRINELL_OK);
    let (falling, outside, nan) = ([0i64, 2, 1], [0i64, 5], [1.0, f64::NAN]);
    let lower_in_upper = [1i64, 1];
    for bad in [
        brinell_matrix {
            column_starts: falling.as_ptr(),
            ..good
        },
        brinell_matrix {
            rows: outside.as_ptr(),
            ..good
        },
        brinell_matrix {
            rows: lower_in_upper.as_ptr(),
            ..good
        },
        brinell_matrix {
            values: nan.as_ptr(),
            ..good
        },
        brinell_matrix {
            values: null(),
            ..good
        },
        brinell_matrix {
            triangle: 7,
            ..good
        },
        brinell_matrix { size: 3, ..good },
    ] {
        assert_eq!(new(bad), BRINELL_INPUT, "{bad:?}");
        assert!(!message().is_empty());
    }
}
