//! What is said through the interface is what the model has.

use super::*;

/// Every value of a load, a target and a program arrives in its own place.
#[test]
fn what_a_load_a_target_and_a_program_say_arrives() {
    use crate::scene::{self, Direction, Displacement, DisplacementTarget, History, Kirsch};
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
        let table = [0.0, 0.5, 2.0, 3.0];
        let last = |kind: i32, directions: i32, history: i32| {
            let model = two_blocks(&mesh);
            let mut load: brinell_load = std::mem::zeroed();
            load.size = size_of::<brinell_load>();
            (load.kind, load.directions, load.history) = (kind, directions, history);
            (load.name, load.on) = (c"more".as_ptr(), c"top".as_ptr());
            load.values = [2.0, 3.0, 5.0];
            if kind == BRINELL_LOAD_DISPLACEMENT {
                // The top's left end is held along x.
                let node = (mesh.n_nodes - 1) as i64;
                ok(brinell_model_node_set(model, c"end".as_ptr(), &node, 1));
                load.on = c"end".as_ptr();
            }
            (load.table, load.n_table) = (table.as_ptr(), 2);
            ok(brinell_model_load(model, &load));
            let loads = (*model).builder.build().unwrap().scene.load;
            brinell_model_free(model);
            loads.last().unwrap().clone()
        };
        let expected = |change: &dyn Fn(&mut scene::Load)| {
            let mut load = scene::Load {
                name: "more".into(),
                on: "top".into(),
                ..scene::Load::default()
            };
            change(&mut load);
            load
        };
        let both = BRINELL_X | BRINELL_Y;
        let moved = |x: Option<f64>, y: Option<f64>| {
            expected(&move |load| {
                load.on = "end".into();
                load.displacement = Some(Displacement { x, y, z: None });
            })
        };
        let displaced = |directions: i32| last(BRINELL_LOAD_DISPLACEMENT, directions, 0);
        assert_eq!(displaced(BRINELL_X), moved(Some(2.0), None));
        assert_eq!(displaced(BRINELL_Y), moved(None, Some(3.0)));
        assert_eq!(displaced(both), moved(Some(2.0), Some(3.0)));
        assert_eq!(
            last(BRINELL_LOAD_FORCE, 0, BRINELL_CONSTANT),
            expected(&|load| {
                load.force = Some([2.0, 3.0].into());
                load.history = History::Constant;
            })
        );
        assert_eq!(
            last(BRINELL_LOAD_TRACTION, 0, BRINELL_TABLE),
            expected(&|load| {
                load.traction = Some([2.0, 3.0].into());
                load.history = History::Table(vec![[0.0, 0.5], [2.0, 3.0]]);
            })
        );
        assert_eq!(
            last(BRINELL_LOAD_KIRSCH, 0, 0),
            expected(&|load| {
                load.kirsch = Some(Kirsch {
                    stress_x: 2.0,
                    stress_y: 3.0,
                    radius: 5.0,
                });
            })
        );

        let model = two_blocks(&mesh);
        for (which, direction) in [(BRINELL_X, Direction::X), (BRINELL_Y, Direction::Y)] {
            let mut target: brinell_target = std::mem::zeroed();
            target.size = size_of::<brinell_target>();
            (target.kind, target.direction) = (BRINELL_TARGET_DISPLACEMENT, which);
            (target.on, target.value) = (c"top".as_ptr(), 0.25);
            ok(brinell_model_target(model, &target));
            let arrived = &(*model).program.targets.last().unwrap().displacement;
            let expected = DisplacementTarget {
                on: "top".into(),
                direction,
                value: 0.25,
            };
            assert_eq!(arrived.as_ref(), Some(&expected));
        }
        let mut program: brinell_program = std::mem::zeroed();
        program.size = size_of::<brinell_program>();
        (program.unit, program.stepping, program.steps) = (1, 1, 7);
        (program.gamma, program.tolerance, program.max_iterations) = (1e-5, 1e-7, 33);
        (program.yield_load, program.plastic_iteration) = (1, 2);
        ok(brinell_model_program(model, &program));
        let arrived = &(*model).program;
        assert_eq!(
            (arrived.unit, arrived.stepping, arrived.steps, arrived.gamma),
            (scene::Unit::Yield, scene::Stepping::Steps, 7, 1e-5)
        );
        let settings = (*model).builder.build().unwrap().scene.analysis;
        assert_eq!(settings.yield_load, scene::YieldMethod::Secant);
        assert_eq!(settings.plastic_iteration, scene::PlasticIteration::Plain);
        assert_eq!((settings.tolerance, settings.max_iterations), (1e-7, 33));
        brinell_model_free(model);
        brinell_results_free(results);
        brinell_scene_free(scene);
    }
}
