//! What an effect costs is paid by the scenes that ask for it.

use crate::support::{close, largest, load, run_file, run_on, run_text, try_run};
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::results::{Counts, Effect, Results};
use brinell::scene::{History, Load};

const CYLINDER: [&str; 2] = [
    "mesh.cylinder_on_half_plane.resolution=6",
    "program.targets=[{ yield = true }, { load_factor = 1.5 }, { load_factor = 0.0 }]",
];

fn run_cylinder(changes: &[&str]) -> Results {
    run_file("cylinder_on_half_plane", &[&CYLINDER[..], changes].concat())
}

fn effect<'r>(results: &'r Results, name: &str) -> &'r Effect {
    let mut effects = results.effects.iter();
    effects.find(|effect| effect.name == name).unwrap()
}

/// Counts, bytes of the zone, and what came of it.
fn cost(results: &Results) -> (Counts, u64, usize) {
    let zone = effect(results, "plasticity").memory_bytes;
    (results.counts, zone, results.history.len())
}

/// Back stresses that are none, and those that follow the plastic strain, need no memory; each that
/// fades has six numbers at each point of a solid zone, four of a plane one, the work that is lost
/// with them is one more, and the tangent has a stress more.
#[test]
fn back_stresses_are_stored_where_they_fade() {
    let plain = run_cylinder(&[]);
    assert!(!effect(&plain, "kinematic hardening").on);
    for none in ["back_stresses=[[0.0, 0.0]]", "kinematic_modulus=0.0"] {
        let results = run_cylinder(&[&format!("materials.steel.{none}")]);
        assert_eq!(cost(&results), cost(&plain), "{none}");
        let effect = effect(&results, "kinematic hardening");
        assert!(!effect.on && effect.why.contains("no material that may yield"));
    }
    let bytes = |laws: &str| {
        let results = run_cylinder(&[&format!("materials.steel.back_stresses={laws}")]);
        assert!(effect(&results, "kinematic hardening").on);
        effect(&results, "plasticity").memory_bytes
    };
    let linear = bytes("[[20000.0, 0.0]]");
    let [one, two] = [
        "[[20000.0, 50.0]]",
        "[[20000.0, 50.0], [9000.0, 200.0], [1000.0, 0.0]]",
    ]
    .map(bytes);
    let each = two - one;
    // A strain as it is, at the end of the increment that is looked for, and on the way there; of
    // all of them a stress of the tangent and, twice, the work that is lost.
    assert_eq!(one - linear, each + each / 2, "{linear} {one} {two}");
    let of_point = 3 * 4 * size_of::<f64>() as u64;
    assert!(each / of_point > 100 && each % of_point == 0);
    // The zone follows the load, which hardening changes: only its size may differ.
    let size = |bytes: u64| bytes as f64 / effect(&plain, "plasticity").memory_bytes as f64;
    assert!((size(linear) - 1.0).abs() < 0.2, "{}", size(linear));
}

/// A profile that is the material's yield stress everywhere is nothing; any other is a number at
/// each point of the zone.
#[test]
fn yield_stresses_by_depth_are_stored_where_there_are_any() {
    let plain = run_cylinder(&[]);
    let profile = |rows: &str| run_cylinder(&[&format!("bodies.half_plane.yield_by_depth={rows}")]);
    let none = profile("[[0.0, 500.0], [1.0, 500.0]]");
    assert_eq!(cost(&none), cost(&plain));
    let found = effect(&none, "yield stress by depth");
    assert!(!found.on && found.why.contains("no body that may yield"));
    // Harder far below all that yields: the same path, and the same cost but for the numbers.
    let deep = profile("[[0.0, 500.0], [30.0, 500.0], [40.0, 900.0]]");
    assert!(effect(&deep, "yield stress by depth").on);
    assert_eq!(deep.counts, plain.counts);
    let bytes = |results| effect(results, "plasticity").memory_bytes;
    let more = bytes(&deep) - bytes(&plain);
    assert!(
        more > 100 * 8 && more % 8 == 0 && more < bytes(&plain) / 20,
        "{more}"
    );
}

/// Loads by temperature and on volumes that are nothing cost what a scene without them costs.
#[test]
fn loads_that_are_nothing_are_off_and_cost_nothing() {
    let plain = run_cylinder(&[]);
    let with = |effect_name: &str, material: &str, load: &str, why: &str| {
        let mut scene = load_of(load);
        let steel = scene.materials.get_mut("steel").unwrap();
        match material {
            "density" => steel.density = Some(7.85e-9),
            _ => steel.thermal_expansion = Some(1.2e-5),
        }
        let results = try_run(&scene, Backend::default()).unwrap();
        let found = effect(&results, effect_name);
        assert!(
            !found.on && found.why.contains(why),
            "{effect_name}: {}",
            found.why
        );
        assert_eq!(cost(&results), cost(&plain), "{effect_name}");
    };
    with(
        "temperature",
        "thermal_expansion",
        "temperature = 0.0",
        "no temperature changes",
    );
    // Constant, and nothing: the program is as proportional as it was.
    with(
        "temperature",
        "thermal_expansion",
        "temperature = 0.0\nhistory = \"constant\"",
        "no temperature changes",
    );
    with(
        "forces on volumes",
        "density",
        "acceleration = [0.0, 0.0]",
        "are zero",
    );
}

/// A temperature that no material depends on, and one at which it is what it is anyway.
#[test]
fn a_temperature_that_changes_no_material_is_off_and_costs_nothing() {
    let plain = run_cylinder(&[]);
    let name = "materials over temperature";
    assert!(!effect(&plain, name).on && !effect(&plain, name).asked);
    let bodies = [
        "bodies.half_plane.temperature=80.0",
        "bodies.cylinder.temperature=20.0",
    ];
    let none = run_cylinder(&bodies);
    let found = effect(&none, name);
    assert!(
        !found.on && found.why.contains("no material"),
        "{}",
        found.why
    );
    assert_eq!(cost(&none), cost(&plain));
    let rows = "materials.steel.over_temperature=[{ temperature = 20.0, poissons_ratio = 0.3 }]";
    let same = run_cylinder(&[bodies[0], bodies[1], rows]);
    assert!(effect(&same, name).on);
    assert_eq!(cost(&same), cost(&plain));
}

/// What is brought along and is zero is no load; a run that no one starts from leaves no more work.
#[test]
fn an_initial_state_that_is_nothing_is_off_and_costs_nothing() {
    let plain = run_cylinder(&[]);
    assert!(!effect(&plain, "initial state").on && !effect(&plain, "earlier run").on);
    let zero = run_cylinder(&["bodies.half_plane.initial_stress=[[0.0, 0.0, 0.0, 0.0]]"]);
    let found = effect(&zero, "initial state");
    assert!(!found.on && found.why.contains("is zero"), "{}", found.why);
    assert_eq!(cost(&zero), cost(&plain));
    let some = run_cylinder(&[
        "bodies.half_plane.initial_stress=[[0.0, -5.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]",
    ]);
    assert!(effect(&some, "initial state").on);
    assert_eq!(some.counts.factorizations, plain.counts.factorizations);
}

/// Loads at load factor 0 that are nothing are no preload, displacements of zero hold as supports
/// do, and a program that is gone through once has no cycles.
#[test]
fn preloads_and_prescribed_displacements_of_nothing_are_off() {
    let text = |held: &str, more: &str, end: &str| {
        format!(
            "kind = \"plane_strain\"\n\
             mesh.parts = [{{ body = \"b\", block = {{ x = [0, 1], y = [0, 1], \
             elements = [2, 2] }} }}]\nbodies.b.material = \"m\"\n\
             support = [{{ on = \"b.left\", fix = {held} }}]\n\
             load = [{{ on = \"b.right\", traction = [1.0, 0.0] }}{more}]\n\
             [materials.m]\nyoungs_modulus = 1.0\npoissons_ratio = 0.3\nyield_stress = 0.5\n\
             plastic_modulus = 0.5\nthermal_expansion = 1.0\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]\n{end}"
        )
    };
    let plain = run_text(&text("[\"x\", \"y\"]", "", ""));
    let nothing = run_text(&text(
        "[\"x\"]",
        ", { on = \"b.left\", displacement = { y = 0.0 } }, \
         { on = \"b\", temperature = 0.0, history = \"constant\" }",
        "",
    ));
    let all = run_text(&text(
        "[\"x\"]",
        ", { on = \"b.left\", displacement = { y = 0.1 } }, \
         { on = \"b\", temperature = 0.1, history = \"constant\" }",
        "cycles = 2\n",
    ));
    let names = ["preload", "prescribed displacements", "cycles"];
    for name in names {
        let on = [&plain, &nothing, &all].map(|results| effect(results, name).on);
        assert_eq!(on, [false, false, true], "{name}");
    }
    let asked = [&plain, &nothing].map(|results| effect(results, names[1]).asked);
    assert_eq!(asked, [false, true]);
    let alpha = |results: &Results| results.first_yield.as_ref().unwrap().alpha;
    assert!((alpha(&plain) / alpha(&nothing) - 1.0).abs() < 1e-12);
}

/// The cylinder with another load on its half plane.
fn load_of(load: &str) -> brinell::scene::Scene {
    let path = crate::support::scene_file("cylinder_on_half_plane");
    let text = std::fs::read_to_string(path).unwrap();
    let more = format!("[[load]]\non = \"half_plane\"\n{load}\n\n[program]");
    let text = text.replacen("[program]", &more, 1);
    let changes: Vec<String> = CYLINDER.iter().map(|change| change.to_string()).collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, text).unwrap();
    brinell::scene::Scene::load_with(file, &changes).unwrap()
}

/// Loads of one history act as one: forces on forty nodes cost one solve beside that of the load
/// which is reported, those of two histories cost two, and they do the same where these agree.
#[test]
fn loads_that_change_alike_are_solved_for_together() {
    let scene = load(
        "thick_cylinder",
        &[
            "mesh.parts.0.ring.elements=[6, 20]",
            "bodies.tube.plastic=false",
            "program.targets=[{ load_factor = 1.0 }]",
            "reference=[]",
        ],
    );
    let mut mesh = Model::new(&scene).unwrap().mesh.clone();
    let nodes: Vec<usize> = (0..mesh.n_nodes()).step_by(3).take(40).collect();
    for &node in &nodes {
        mesh.node_sets.insert(format!("n{node}"), vec![node]);
    }
    let with = |histories: &[History]| {
        let mut scene = scene.clone();
        for (k, history) in (0..40).zip(histories.iter().cycle()) {
            scene.load.push(Load {
                on: format!("n{}", nodes[k]),
                force: Some([0.01 * k as f64, -0.02].into()),
                history: history.clone(),
                ..Load::default()
            });
        }
        run_on(&scene, mesh.clone())
    };
    let plain = run_on(&scene, mesh.clone());
    let table = History::Table(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]);
    let [one, two] = [
        with(&[History::Proportional]),
        with(&[History::Proportional, table]),
    ];
    let solves = [&plain, &one, &two].map(|results| results.counts.full_solves);
    assert_eq!(solves, [0, 1, 2].map(|more| solves[0] + more));
    let [one, two] = [&one, &two].map(|r| &r.states[0].fields.as_ref().unwrap().displacement);
    let scale = largest(one.iter().copied());
    for (a, b) in one.iter().zip(two) {
        // Backward errors of two solutions, at a condition of some thousand.
        close("displacement", *a, *b, scale, 1e-11);
    }
}
