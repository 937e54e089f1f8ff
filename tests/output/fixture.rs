//! A small mesh with every element shape and results in which every optional thing is present.

use brinell::mesh::{Mesh, Shape};
use brinell::output::RunHeader;
use brinell::results::{
    Accuracy, Companion, Counts, CycleOutcome, CycleRow, Cycles, Demand, Effect, EstimateMethod,
    Fields, HistoryRow, Incomplete, PairState, PathPoint, Quality, QuantityError, Ranks,
    ReferenceRow, Results, Sizes, State, Status, YieldPoint,
};

pub fn header() -> RunHeader {
    RunHeader {
        scene_title: "cylinder \"on\" <plane> & more".into(),
        scene_file: Some("scenes/cylinder.toml".into()),
        kind: "plane_strain".into(),
        solver: "dense".into(),
        wall_seconds: 1.25,
        bodies: vec!["cylinder".into(), "half_plane".into()],
        ..RunHeader::default()
    }
}

/// A tri3, a quad4, a quad8 and a tri6, on shared edges where they fit. The shape of the elements
/// is of no concern here, the order of their nodes is.
pub fn mesh() -> Mesh {
    let mut mesh = Mesh {
        dimension: 2,
        coordinates: (0..15)
            .flat_map(|i| [f64::from(i) / 3.0, -f64::from(i * i) / 7.0])
            .collect(),
        bodies: header().bodies,
        ..Mesh::default()
    };
    mesh.push_element(Shape::Tri3, 0, &[0, 1, 2]);
    mesh.push_element(Shape::Quad4, 0, &[1, 3, 4, 2]);
    mesh.push_element(Shape::Quad8, 1, &[3, 5, 6, 4, 7, 8, 9, 10]);
    mesh.push_element(Shape::Tri6, 1, &[5, 11, 6, 12, 13, 14]);
    mesh
}

/// Fields whose every value is different and has a full mantissa; `seed` tells states apart.
pub fn fields(mesh: &Mesh, seed: f64) -> Fields {
    let values = |n: usize, phase: f64| -> Vec<f64> {
        (0..n)
            .map(|i| (seed + phase + 0.1 * i as f64).sin() * 1e3)
            .collect()
    };
    let elements = mesh.n_elements();
    Fields {
        displacement: values(2 * mesh.n_nodes(), 0.0),
        stress: values(4 * elements, 0.3),
        nodal_stress: values(4 * mesh.n_nodes(), 0.4),
        von_mises: values(elements, 0.5),
        plastic_strain: values(elements, 0.7),
        yielded: (0..elements).map(|i| (i % 2) as u8).collect(),
        error: values(elements, 0.9),
        contact_pressure: values(mesh.n_nodes(), 0.1),
        gap: values(mesh.n_nodes(), 0.2),
        force: Vec::new(),
        points: None,
    }
}

pub fn pair(pair: usize, status: Status) -> PairState {
    PairState {
        pair,
        contact: 0,
        position: [0.1 * pair as f64, -0.0, 0.0],
        gap: 1e-17,
        force: 12.5,
        area: 0.25,
        pressure: 50.0,
        status,
    }
}

pub fn results(mesh: &Mesh) -> Results {
    let quality = Quality {
        backward_error: 1e-16,
        componentwise_error: Some(2e-16),
        round_off: Some(3e-14),
        equilibrium: 2e-12,
        complementarity: 0.0,
        penetration: 3e-17,
        adhesion: 4e-17,
    };
    let pressed = State {
        closed_pairs: 1,
        name: "b = 1.5 b*".into(),
        increments: 0,
        alpha: 2.0635,
        load: 123.456,
        contact_force: 123.4,
        max_pressure: 300.0,
        pole_pressure: 299.0,
        half_width: 1.5,
        half_width_reading: Default::default(),
        contact_area: 3.0,
        contact_arc: Some([-19.625, 19.625]),
        residual_depth: 0.01,
        residual_depth_by_body: vec![0.006, 0.004],
        rim_height: 0.001,
        plastic_points: 7,
        plastic_points_by_body: vec![3, 4],
        max_equivalent_plastic_strain: 0.02,
        plastic_zone_size: 0.004,
        plastic_zone_layer: 0.0,
        plastic_strain_reading: 0.0,
        is_loaded: true,
        load_is_given: false,
        approach_is_given: false,
        plastic_work: 0.7,
        plastic_depth: 0.0123,
        energy_error: Some(0.05),
        local_energy_error: None,
        approach: 0.3,
        patches: Vec::new(),
        pairs: vec![pair(0, Status::Closed), pair(1, Status::Open)],
        fields: Some(fields(mesh, 1.0)),
        quality,
    };
    let without_fields = State {
        name: "between".into(),
        fields: None,
        contact_arc: None,
        ..pressed.clone()
    };
    let released = State {
        name: "released".into(),
        fields: Some(fields(mesh, 2.0)),
        ..pressed.clone()
    };
    Results {
        bodies: vec!["low".into(), "high".into()],
        ranks: None,
        cycles: Some(Cycles {
            outcome: CycleOutcome::Ratchetting,
            body: Some("block".into()),
            rows: vec![CycleRow {
                cycle: 1,
                flow: 2e-3,
                growth: 1e-3,
            }],
        }),
        sizes: Sizes {
            freedoms: 27,
            nodes: mesh.n_nodes(),
            elements: mesh.n_elements(),
            contact_pairs: 2,
            zone_freedoms: 9,
            zone_elements: 2,
            ..Sizes::default()
        },
        effects: vec![Effect {
            asked: true,
            name: "contact".into(),
            on: true,
            why: "2 pairs may touch".into(),
            seconds: 0.5,
            memory_bytes: 4096,
        }],
        first_yield: Some(YieldPoint {
            alpha: 1.0,
            load: 60.0,
            max_pressure: 179.37,
            half_width: 1.0,
            half_width_reading: Default::default(),
            location: [0.0, -0.7, 0.0],
            body: 1,
        }),
        states: vec![pressed, without_fields, released],
        history_columns: Vec::new(),
        path: vec![PathPoint {
            increment: 2,
            alpha: 0.2,
            load: 30.0,
            max_pressure: 100.0,
            half_width: 2.0 / 3.0,
        }],
        history: vec![
            HistoryRow {
                increment: 1,
                alpha: 0.1,
                residual: f64::NAN,
                event: "target: \"a, b\"".into(),
                ..HistoryRow::default()
            },
            HistoryRow {
                increment: 2,
                alpha: 1.0 / 3.0,
                max_equivalent_plastic_strain: 1e-300,
                event: "closes: pair 1".into(),
                ..HistoryRow::default()
            },
        ],
        timings: vec![
            ("assembly".into(), 0.25),
            ("factorisation".into(), 0.5),
            ("assembly".into(), 0.125),
        ],
        counts: Counts {
            factorizations: 1,
            zone_factorizations: 2,
            trailing_solves: 40,
            full_solves: 3,
            plastic_iterations: 12,
            contact_changes: 2,
            hard_increments: 1,
        },
        quality,
        condition: 1e4,
        condition_estimate: Some(3e4),
        inaccurate: vec!["state `released` is inaccurate".into()],
        factor: brinell::linalg::Prediction {
            ordering: "CAMD".into(),
            factor_nonzeros: 1234.0,
            flops: 5e20,
            trailing_nonzeros: 99.0,
            memory_bytes: 65536.0,
            memory_by_rank: vec![65536.5, 4096.5],
        },
        reference: vec![ReferenceRow {
            quantity: "yield.load".into(),
            reference: 61.0,
            computed: 60.0,
            ratio: 60.0 / 61.0,
            published_ratio: None,
            source: "Johnson, Contact Mechanics, p. 155".into(),
        }],
        accuracy: Some(Accuracy {
            method: EstimateMethod::CoarserMeshes,
            companions: vec![Companion {
                ratio: 2.0,
                freedoms: 9,
                seconds: 0.25,
            }],
            quantities: vec![QuantityError {
                quantity: "yield.load".into(),
                value: 60.0,
                error: Some(0.5),
                relative_error: Some(0.005),
                discretisation: Some(0.4),
                path: Some(0.09),
                algebraic: 0.01,
                order: None,
                extrapolated: Some(60.2),
            }],
            demand: Some(Demand {
                accuracy: 0.01,
                demanded: "1 %".into(),
                reached: false,
                reason: Some("time".into()),
                unknown: vec!["states.s.load".into()],
                stated: 0.005,
                worst: Some("yield.load".into()),
                choices: vec!["resolution 16".into()],
                work: 3e9,
            }),
            seconds: 0.5,
            work: 1e9,
            notes: vec!["a mesh failed".into()],
        }),
        warnings: vec!["tri3 elements lock where they yield".into()],
        resumed: 2,
        end_state: None,
        incomplete: Some(Incomplete {
            kind: brinell::ErrorKind::Stopped,
            why: "stopped on request".into(),
        }),
    }
}

/// The same of a run on so many ranks.
pub fn results_of_ranks(mesh: &Mesh, count: usize) -> Results {
    Results {
        ranks: Some(Ranks {
            count,
            requests: 15,
            bytes: 4096,
            peak_memory_bytes: vec![Some(1 << 20), None],
        }),
        ..results(mesh)
    }
}
