//! Arrays that are given in addition to scene text arrive at their places in the model.

use super::*;
use crate::scene::History;

/// Given pairs arrive with their contact, and forces on nodes with their history.
#[test]
fn pairs_and_nodal_forces_arrive() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/hard/floating_body.toml"
    );
    let path = CString::new(path).unwrap();
    // SAFETY: texts, arrays and places live through the calls, handles are freed once.
    unsafe {
        let ok = |status: i32| assert_eq!(status, BRINELL_OK, "{}", message());
        let (mut scene, mut results) = (null_mut(), null_mut());
        ok(brinell_scene_load(path.as_ptr(), null(), 0, &mut scene));
        ok(brinell_run(scene, null(), None, null_mut(), &mut results));
        let mut mesh: brinell_mesh = std::mem::zeroed();
        mesh.size = size_of::<brinell_mesh>();
        ok(brinell_results_mesh(results, &mut mesh));
        let xy = std::slice::from_raw_parts(mesh.coordinates, 2 * mesh.n_nodes);
        let at_height = |height: f64| -> Vec<i64> {
            let nodes = (0..mesh.n_nodes).filter(|node| xy[2 * node + 1] == height);
            nodes.map(|node| node as i64).collect()
        };
        let (first, second) = (at_height(1.01), at_height(1.0));
        let model = blocks_without_contact(&mesh);
        let contact = c"first = 'opposite'\nsecond = 'face'\ninterference = 0.25";
        let (normals, gaps) = ([0.0, 2.0, 0.0, 1.0], [0.5, 0.75]);
        ok(brinell_model_contact_pairs(
            model,
            contact.as_ptr(),
            2,
            first.as_ptr(),
            second.as_ptr(),
            normals.as_ptr(),
            gaps.as_ptr(),
        ));
        let load = c"name = 'more'\nhistory = [[0.0, 0.5], [2.0, 3.0]]";
        let (nodes, forces) = ([first[0], first[1]], [1.0, 2.0, 3.0, 4.0]);
        ok(brinell_model_nodal_load(
            model,
            load.as_ptr(),
            2,
            nodes.as_ptr(),
            forces.as_ptr(),
        ));
        let built = (*model).builder.build().unwrap();
        assert_eq!(built.pairs.len(), 2);
        for k in 0..2 {
            let mut pairs = built.pairs.iter();
            let pair = pairs.find(|pair| pair.slave == second[k] as usize).unwrap();
            assert_eq!(pair.faced(), Some(first[k] as usize));
            assert_eq!(pair.normal, [0.0, 1.0, 0.0]);
            assert_eq!((pair.gap, pair.interference), (gaps[k], 0.25));
        }
        let load = built.loads.last().unwrap();
        assert_eq!(load.name, "more");
        assert_eq!(load.history, History::Table(vec![[0.0, 0.5], [2.0, 3.0]]));
        let given = &built.scene.load.last().unwrap().force;
        assert_eq!(given.unwrap().vector(), [4.0, 6.0, 0.0]);
        brinell_model_free(model);
        brinell_results_free(results);
        brinell_scene_free(scene);
    }
}
