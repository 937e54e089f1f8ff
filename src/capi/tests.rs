//! Misuse of the C interface: the result is a status and a message, never anything worse. Correct
//! use is shown by the programs in `ffi/examples`.

mod arrival;
mod quantities;
mod rigid;
mod solid;

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
    // SAFETY: NULL is allowed for every argument.
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

/// Like exit code 7 of the program: results exist, and they say that they are not to be trusted.
#[test]
fn lost_accuracy_has_a_status() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/unload_reload.toml"
    );
    let path = CString::new(path).unwrap();
    // The run is iterated to forces that are a hundredth out of balance.
    for (tolerance, expected) in [("1e-9", BRINELL_OK), ("0.0099", BRINELL_INACCURATE)] {
        let tolerance = CString::new(format!("analysis.tolerance={tolerance}")).unwrap();
        let sets = [
            c"analysis.plastic_iteration=plain".as_ptr(),
            tolerance.as_ptr(),
        ];
        let (mut scene, mut results) = (null_mut(), null_mut());
        // SAFETY: texts and places live through the calls, handles are freed once.
        unsafe {
            let loaded = brinell_scene_load(path.as_ptr(), sets.as_ptr(), 2, &mut scene);
            assert_eq!(loaded, BRINELL_OK, "{}", message());
            let status = brinell_run(scene, null(), None, null_mut(), &mut results);
            assert_eq!(status, expected, "{tolerance:?}");
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
        // An older caller does not know `backend`: this field is not read.
        assert!(super::options::backend(&raw const options).is_ok());
        options.size = size_of::<brinell_options>();
        assert!(super::options::backend(&raw const options).is_err());
        for size in [0, 1, 1 << 40] {
            options.size = size;
            let error = super::options::backend(&raw const options).unwrap_err();
            assert!(error.message().contains("sizeof"), "{error}");
        }
        // A newer caller has a longer structure.
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
        // SAFETY: arrays as long as the matrix says, but for those that the test sets to be refused
        // before they are read.
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

/// Two blocks from a scene, and the mesh of its results handed back as arrays, give the same bits.
#[test]
fn a_model_from_arrays_gives_the_bits_of_the_scene() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/floating_body.toml"
    );
    let path = CString::new(path).unwrap();
    let sets = [
        c"materials.steel.yield_stress=8",
        c"materials.steel.plastic_modulus=1000",
        // The elements are not square: in square ones every point of the uniform stress field would
        // be a place of first yield.
        c"mesh.parts.0.block.elements=[8, 5]",
    ];
    let sets = sets.map(|s| s.as_ptr());
    // SAFETY: texts, arrays and places live through the calls, handles are freed once.
    unsafe {
        let (mut scene, mut expected) = (null_mut(), null_mut());
        let loaded = brinell_scene_load(path.as_ptr(), sets.as_ptr(), 3, &mut scene);
        assert_eq!(loaded, BRINELL_OK, "{}", message());
        let status = brinell_run(scene, null(), None, null_mut(), &mut expected);
        assert_eq!(status, BRINELL_OK, "{}", message());
        let mut mesh: brinell_mesh = std::mem::zeroed();
        mesh.size = size_of::<brinell_mesh>();
        assert_eq!(brinell_results_mesh(expected, &mut mesh), BRINELL_OK);
        let model = two_blocks(&mesh);
        let mut found = null_mut();
        let status = brinell_model_run(model, null(), None, null_mut(), &mut found);
        assert_eq!(status, BRINELL_OK, "{}", message());
        // The fields of first yield are those of the library.
        let mut point: brinell_yield = std::mem::zeroed();
        point.size = size_of::<brinell_yield>();
        assert_eq!(brinell_results_yield(expected, &mut point), BRINELL_OK);
        let own = (*expected).results.first_yield.unwrap();
        assert_eq!([point.x, point.y, point.z], own.location);
        assert!(point.x != point.y, "a place that tells x from y");
        assert_eq!(
            [
                point.alpha,
                point.load,
                point.max_pressure,
                point.half_width
            ],
            [own.alpha, own.load, own.max_pressure, own.half_width]
        );
        assert_eq!(point.body, own.body as u64);
        let (expected_bits, found_bits) = (all_bits(expected), all_bits(found));
        assert!(expected_bits.iter().any(|b| *b != 0));
        assert!(expected_bits == found_bits);
        brinell_results_free(found);
        brinell_results_free(expected);
        brinell_model_free(model);
        brinell_scene_free(scene);
    }
}

/// Builds the model of the scene `floating_body` by calls.
///
/// # Safety
/// The conditions of [`blocks_without_contact`].
unsafe fn two_blocks(mesh: &brinell_mesh) -> *mut brinell_model {
    let contact = c"contact = [{ first = 'opposite', second = 'face' }]";
    // SAFETY: as vouched for by the caller; the text lives through the call.
    unsafe {
        let model = blocks_without_contact(mesh);
        let status = brinell_model_tables(model, contact.as_ptr());
        assert_eq!(status, BRINELL_OK, "{}", message());
        model
    }
}

/// Builds the model of the scene `floating_body` without its contact.
///
/// # Safety
/// The mesh is as the results handed it out.
unsafe fn blocks_without_contact(mesh: &brinell_mesh) -> *mut brinell_model {
    let mut model = null_mut();
    // SAFETY: as vouched for by the caller; texts, arrays and places live through the calls.
    unsafe {
        let ok = |status: i32| assert_eq!(status, BRINELL_OK, "{}", message());
        ok(brinell_model_new(BRINELL_PLANE_STRAIN, 1, &mut model));
        ok(brinell_model_nodes(model, mesh.coordinates, mesh.n_nodes));
        let bodies = std::slice::from_raw_parts(mesh.element_body, mesh.n_elements);
        let nodes = std::slice::from_raw_parts(mesh.connectivity, 4 * mesh.n_elements);
        for (element, &body) in bodies.iter().enumerate() {
            let body = [c"lower", c"upper"][body as usize];
            let nodes = [0, 1, 2, 3].map(|k| i64::from(nodes[4 * element + k]));
            let shape = BRINELL_SHAPE_QUAD4;
            ok(brinell_model_elements(
                model,
                body.as_ptr(),
                shape,
                nodes.as_ptr(),
                1,
            ));
        }
        let xy = std::slice::from_raw_parts(mesh.coordinates, 2 * mesh.n_nodes);
        let nodes_where = |holds: &dyn Fn(f64, f64) -> bool| -> Vec<i64> {
            let all = 0..mesh.n_nodes;
            let chosen = all.filter(|&i| holds(xy[2 * i], xy[2 * i + 1]));
            chosen.map(|i| i as i64).collect()
        };
        let surface = |name: &CStr, holds: &dyn Fn(f64, f64) -> bool| {
            let nodes = nodes_where(holds);
            ok(brinell_model_surface_of_nodes(
                model,
                name.as_ptr(),
                nodes.as_ptr(),
                nodes.len(),
            ));
        };
        surface(c"floor", &|_, y| y == 0.0);
        surface(c"face", &|_, y| y == 1.0);
        surface(c"opposite", &|_, y| y == 1.01);
        surface(c"top", &|_, y| y == 2.01);
        let left = nodes_where(&|x, _| x == 0.0);
        ok(brinell_model_node_set(
            model,
            c"left".as_ptr(),
            left.as_ptr(),
            left.len(),
        ));
        ok(brinell_model_tables(model, TABLES.as_ptr()));
    }
    model
}

/// The parts of the two blocks other than their mesh and contact.
const TABLES: &CStr = c"
    bodies = { lower = { material = 'steel' }, upper = { material = 'steel' } }
    support = [{ on = 'floor', fix = ['y'] }, { on = 'left', fix = ['x'] }]
    load = [{ on = 'top', pressure = 10.0 }]
    program.targets = [{ load_factor = 1.0 }, { load_factor = 0.25 }, { load_factor = 1.0 }]
    [materials.steel]
    youngs_modulus = 210000.0
    poissons_ratio = 0.3
    yield_stress = 8.0
    plastic_modulus = 1000.0
";

/// Returns all arrays of results, bit by bit.
///
/// # Safety
/// A living handle.
unsafe fn all_bits(results: *const brinell_results) -> Vec<u64> {
    let mut bits = Vec::new();
    let (mut data, mut n) = (null(), 0);
    let mut keep = |status: i32, data: *const f64, n: usize| {
        assert_eq!(status, BRINELL_OK, "{}", message());
        // SAFETY: handed out by the library, valid as long as the results.
        let values = unsafe { std::slice::from_raw_parts(data, n) };
        bits.extend(values.iter().map(|v| v.to_bits()));
    };
    // SAFETY: as vouched for by the caller.
    unsafe {
        for which in 0..7 {
            let status = brinell_results_history(results, which, &mut data, &mut n);
            keep(status, data, n);
        }
        for state in 0..brinell_results_n_states(results) {
            for which in 0..7 {
                let status = brinell_results_pairs(results, state, which, &mut data, &mut n);
                keep(status, data, n);
            }
            for which in 0..4 {
                let status = brinell_results_field(results, state, which, &mut data, &mut n);
                keep(status, data, n);
            }
        }
    }
    bits
}

#[test]
fn a_kind_or_symmetry_that_there_is_not_makes_no_model() {
    let mut model = null_mut();
    // SAFETY: the place lives through the calls.
    unsafe {
        assert_eq!(brinell_model_new(4, 1, &mut model), BRINELL_INPUT);
        for (kind, symmetry) in [
            (BRINELL_PLANE_STRAIN, 0),
            (BRINELL_PLANE_STRESS, 3),
            (BRINELL_AXISYMMETRIC, 4),
        ] {
            assert_eq!(brinell_model_new(kind, symmetry, &mut model), BRINELL_INPUT);
            let named = format!("symmetry: {symmetry} must be 1");
            assert!(
                message().contains(&named) && model.is_null(),
                "{}",
                message()
            );
        }
    }
}

/// Asserts that a call was refused with a message that contains all words.
fn refused(status: i32, words: &[&str]) {
    assert_eq!(status, BRINELL_INPUT);
    for word in words {
        assert!(message().contains(word), "{} lacks {word}", message());
    }
}

#[test]
fn bad_arrays_are_refused_by_index_and_leave_the_model_as_it_was() {
    let mut model = null_mut();
    // SAFETY: texts, arrays and places live through the calls, the handle is freed once.
    unsafe {
        assert_eq!(
            brinell_model_new(BRINELL_AXISYMMETRIC, 1, &mut model),
            BRINELL_OK
        );
        let square = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
        let nan = [0.0, f64::NAN];
        refused(
            brinell_model_nodes(model, nan.as_ptr(), 1),
            &["node 0", "NaN"],
        );
        refused(brinell_model_nodes(model, null(), 1), &["NULL"]);
        refused(
            brinell_model_nodes(null_mut(), square.as_ptr(), 4),
            &["NULL"],
        );
        assert_eq!(brinell_model_nodes(model, square.as_ptr(), 4), BRINELL_OK);
        let body = c"body".as_ptr();
        let elements = |nodes: [i64; 4], shape: i32| {
            brinell_model_elements(model, body, shape, nodes.as_ptr(), 1)
        };
        refused(
            elements([0, 1, 2, -1], BRINELL_SHAPE_QUAD4),
            &["node 3 is -1"],
        );
        refused(
            elements([0, 1, 2, 4], BRINELL_SHAPE_QUAD4),
            &["element 0", "is 4"],
        );
        refused(elements([0, 1, 2, 3], 10), &["shape 10"]);
        assert_eq!(elements([0, 1, 2, 3], BRINELL_SHAPE_QUAD4), BRINELL_OK);
        let text = c"support = [{ on = 'body', fix = ['w'] }]";
        refused(
            brinell_model_tables(model, text.as_ptr()),
            &["line 1", "unknown variant `w`"],
        );
        refused(brinell_model_tables(model, null()), &["NULL"]);
        let nodal = |load: &CStr, n: usize| {
            brinell_model_nodal_load(model, load.as_ptr(), n, null(), null())
        };
        refused(nodal(c"name = 'more'", 3), &["NULL", "3"]);
        refused(nodal(c"name = 'more'", usize::MAX), &["NULL"]);
        refused(nodal(c"history = 'constant'", 0), &["the load", "name"]);
        let pairs = |contact: &CStr, nodes: [i64; 2]| {
            let [a, b] = &nodes;
            brinell_model_contact_pairs(model, contact.as_ptr(), 1, a, b, null(), null())
        };
        let both = c"first = 'a'\nsecond = 'b'";
        refused(pairs(both, [0, 7]), &["pair 0", "7"]);
        refused(pairs(c"first = 'a'", [0, 1]), &["the contact", "second"]);
        refused(
            brinell_model_nodes(model, square.as_ptr(), usize::MAX / 2),
            &["exceed any memory"],
        );
        let mut results = null_mut();
        refused(
            brinell_model_run(model, null(), None, null_mut(), &mut results),
            &["bodies"],
        );
        assert!(results.is_null());
        brinell_model_free(model);
    }
}
