//! Nothing is allocated where the time goes: in a solve with the trailing factor, and for elements,
//! points or pairs, one by one.

use crate::support::{load, sparse};
use allocation_counter::{AllocationInfo, measure};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::substructure::Substructure;

/// What the closure allocates, on one thread: only the calling thread is counted.
fn counted(closure: impl FnOnce() + Send) -> AllocationInfo {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    pool.install(|| {
        let mut info = AllocationInfo::default();
        rayon::scope(|_| info = measure(closure));
        info
    })
}

#[test]
fn a_trailing_solve_allocates_nothing_for_the_zone() {
    for backend in sparse() {
        assert_solves_allocate_nothing(backend);
    }
}

fn assert_solves_allocate_nothing(backend: Backend) {
    let mut counts = Vec::new();
    for resolution in [3, 8] {
        let scene = load(
            "cylinder_on_half_plane",
            &[&format!(
                "mesh.cylinder_on_half_plane.resolution={resolution}"
            )],
        );
        let model = Model::new(&scene).unwrap();
        let system = brinell::assembly::assemble(&model, Backend::default()).unwrap();
        let contact: Vec<usize> = model
            .pairs
            .iter()
            .flat_map(|pair| pair.nodes().collect::<Vec<_>>())
            .filter_map(|node| model.freedoms.normal_freedom(node))
            .collect();
        let zone: Vec<usize> = (0..model.freedoms.n)
            .step_by(3)
            .filter(|freedom| !contact.contains(freedom))
            .collect();
        let structure = Substructure::new(&model, &system, zone, backend).unwrap();
        let (mut load, n) = (structure.zeros(), model.pairs.len());
        let (mut forces, slip) = (vec![0.0; n], vec![0.0; n]);
        let mut solve = || {
            load.fill(1.0);
            structure.eliminate(&mut load, &mut forces);
            structure.recover(&mut load, &slip);
        };
        solve();
        let info = counted(solve);
        // What is left are vectors on the pairs.
        assert!(
            info.bytes_max <= 8 * 16 * n as u64,
            "{resolution}: {info:?} for {n} pairs"
        );
        counts.push(info.count_total);
    }
    assert_eq!(counts[0], counts[1], "allocations grow with the mesh");
}

#[test]
fn plastic_iterations_allocate_as_often_on_any_mesh() {
    for backend in sparse() {
        assert_iterations_allocate_as_often(backend);
    }
}

fn assert_iterations_allocate_as_often(backend: Backend) {
    // The paper's plain iteration to two tolerances: what the tighter one takes more, per
    // iteration. A vector for each element, point or pair would show as many allocations.
    let per_iteration: Vec<f64> = [4, 8]
        .into_iter()
        .map(|resolution| {
            let cost = |tolerance: &str| {
                let scene = load(
                    "cylinder_on_half_plane",
                    &[
                        &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
                        &format!("analysis.tolerance={tolerance}"),
                        "analysis.plastic_iteration=plain",
                        "program.stepping=steps",
                        "program.steps=2",
                    ],
                );
                let model = Model::new(&scene).unwrap();
                let mut analysis = Analysis::new(model, backend).unwrap();
                let mut iterations = 0;
                let info = counted(|| {
                    iterations = analysis.run(&mut Silent).unwrap().counts.plastic_iterations;
                });
                (info.count_total as f64, iterations as f64)
            };
            let (coarse, fine) = (cost("1e-4"), cost("1e-11"));
            assert!(fine.1 > coarse.1 + 50.0);
            (fine.0 - coarse.0) / (fine.1 - coarse.1)
        })
        .collect();
    for count in &per_iteration {
        assert!(*count < 40.0, "{per_iteration:?}");
    }
}
