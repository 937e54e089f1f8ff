//! Three dimensions through the C interface.

use super::*;

/// The mesh of a scene is handed over as arrays, with everything else that the scene says: a
/// plastic history of a solid agrees to the last bit, with its patches, and with supports in any
/// direction.
#[test]
fn a_plastic_history_of_a_solid_from_arrays_is_the_scene_s() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/square_punch.toml");
    let path = CString::new(path).unwrap();
    let sets = [
        c"mesh.parts.0.brick.elements=[2,2,2]".as_ptr(),
        c"mesh.parts.1.brick.elements=[6,6,4]".as_ptr(),
        c"materials.metal.tangent_modulus=".as_ptr(),
        c"materials.metal.plastic_modulus=2000.0".as_ptr(),
    ];
    // SAFETY: texts, arrays and places live through the calls, handles are freed once.
    unsafe {
        let ok = |status: i32| assert_eq!(status, BRINELL_OK, "{}", message());
        let (mut scene, mut results) = (null_mut(), null_mut());
        ok(brinell_scene_load(
            path.as_ptr(),
            sets.as_ptr(),
            sets.len(),
            &mut scene,
        ));
        ok(brinell_run(scene, null(), None, null_mut(), &mut results));
        let mut mesh: brinell_mesh = std::mem::zeroed();
        mesh.size = size_of::<brinell_mesh>();
        ok(brinell_results_mesh(results, &mut mesh));
        let model = punch(&mesh);
        let mut other = null_mut();
        ok(brinell_model_run(
            model,
            null(),
            None,
            null_mut(),
            &mut other,
        ));
        brinell_model_free(model);

        assert_eq!(brinell_results_n_states(results), 2);
        assert_eq!(brinell_results_n_states(other), 2);
        let [a, b] = [results, other].map(|results| &(*results).results);
        assert!(a.states[0].plastic_points > 0);
        assert_eq!(format!("{:?}", a.history), format!("{:?}", b.history));
        assert_eq!(format!("{:?}", a.states), format!("{:?}", b.states));

        let (mut z, mut n) = (std::ptr::null(), 0);
        ok(brinell_results_pairs(
            other,
            0,
            BRINELL_PAIR_Z,
            &mut z,
            &mut n,
        ));
        let z = std::slice::from_raw_parts(z, n);
        assert!(n == 9 && z.iter().all(|z| *z == 0.0), "{z:?}");
        assert_eq!(brinell_results_n_patches(other, 0), 1);
        assert_eq!(brinell_results_n_patches(other, 1), 0);
        assert_eq!(brinell_results_n_patches(other, 7), 0);
        let mut patch: brinell_patch = std::mem::zeroed();
        patch.size = size_of::<brinell_patch>();
        ok(brinell_results_patch(other, 0, 0, &mut patch));
        let found = &a.states[0].patches[0];
        assert_eq!(
            (patch.area, patch.semi_axes, patch.force),
            (found.area, found.semi_axes, found.force)
        );
        assert!((patch.force / a.states[0].contact_force - 1.0).abs() < 1e-9);
        assert_eq!(
            brinell_results_patch(other, 1, 0, &mut patch),
            BRINELL_INPUT
        );
        assert!(message().contains("there is no patch 0"), "{}", message());
        brinell_results_free(other);
        brinell_results_free(results);
        brinell_scene_free(scene);
    }
}

/// All of the punch on its block but the mesh.
const TABLES: &CStr = c"
    materials.hard = { youngs_modulus = 2.1e6, poissons_ratio = 0.3 }
    bodies.punch = { material = 'hard' }
    bodies.block = { material = 'metal' }
    contact = [{ first = 'punch.bottom', second = 'block.top' }]
    support = [
        { on = 'punch.left', fix = ['x'] },
        { on = 'block.left', fix = ['x'] },
        { on = 'punch.front', direction = [0, 1, 0] },
        { on = 'block.front', direction = [0, 1, 0] },
        { on = 'block.bottom', fix = ['z'] },
    ]
    load = [{ name = 'press', on = 'punch.top',
        plane_force = { direction = 'z', total = -3600.0 } }]
    program.targets = [
        { name = 'alpha 1', load_factor = 1.0 },
        { name = 'unloaded', load_factor = 0.0 },
    ]
    [materials.metal]
    youngs_modulus = 2.1e5
    poissons_ratio = 0.3
    yield_stress = 300.0
    plastic_modulus = 2000.0
";

/// Builds the punch on its block from the arrays of the scene's mesh, with the rest as text.
///
/// # Safety
/// The arrays of the mesh live.
unsafe fn punch(mesh: &brinell_mesh) -> *mut brinell_model {
    let mut model = null_mut();
    // SAFETY: as vouched for by the caller; texts, arrays and places live through the calls.
    unsafe {
        let ok = |status: i32| assert_eq!(status, BRINELL_OK, "{}", message());
        ok(brinell_model_new(BRINELL_SOLID, 4, &mut model));
        ok(brinell_model_nodes(model, mesh.coordinates, mesh.n_nodes));
        let of_element = std::slice::from_raw_parts(mesh.element_body, mesh.n_elements);
        let nodes = std::slice::from_raw_parts(mesh.connectivity, 8 * mesh.n_elements);
        let bodies = [c"punch", c"block"];
        for (number, body) in bodies.into_iter().enumerate() {
            let own = (0..mesh.n_elements).filter(|&e| of_element[e] as usize == number);
            let own: Vec<i64> = own
                .flat_map(|e| nodes[8 * e..8 * e + 8].iter().map(|&n| i64::from(n)))
                .collect();
            let (shape, n) = (BRINELL_SHAPE_HEX8, own.len() / 8);
            ok(brinell_model_elements(
                model,
                body.as_ptr(),
                shape,
                own.as_ptr(),
                n,
            ));
        }
        let x = std::slice::from_raw_parts(mesh.coordinates, 3 * mesh.n_nodes);
        // The nodes of the punch come first.
        let n_punch = nodes
            .chunks(8)
            .zip(of_element)
            .filter(|(_, body)| **body == 0);
        let n_punch = 1 + n_punch.flat_map(|(nodes, _)| nodes).max().unwrap();
        let side = |body: usize, axis: usize, at: f64| -> Vec<i64> {
            (0..mesh.n_nodes)
                .filter(|&n| usize::from(n >= n_punch as usize) == body && x[3 * n + axis] == at)
                .map(|n| n as i64)
                .collect()
        };
        for (name, nodes) in [
            (c"punch.bottom", side(0, 2, 0.0)),
            (c"punch.top", side(0, 2, 1.0)),
            (c"block.top", side(1, 2, 0.0)),
            (c"block.bottom", side(1, 2, -3.0)),
            (c"punch.left", side(0, 0, 0.0)),
            (c"block.left", side(1, 0, 0.0)),
            (c"punch.front", side(0, 1, 0.0)),
            (c"block.front", side(1, 1, 0.0)),
        ] {
            let n = nodes.len();
            ok(brinell_model_surface_of_nodes(
                model,
                name.as_ptr(),
                nodes.as_ptr(),
                n,
            ));
        }
        ok(brinell_model_tables(model, TABLES.as_ptr()));
        let wrong = brinell_model_tables(model, c"materials.metal = 3".as_ptr());
        assert_eq!(wrong, BRINELL_INPUT);
        assert!(message().contains("line 1"), "{}", message());
        model
    }
}
