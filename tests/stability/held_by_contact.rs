//! Bodies that nothing but contact holds.

use crate::support::random::Random;
use crate::support::{self, close, either, healthy, largest, parse, run_file, same_contact, state};
use brinell::results::Status;
use brinell::scene::Scene;
use std::f64::consts::PI;

/// With every pair open the structure is singular: codes stop at a zero pivot, or add springs that
/// carry part of the load. Here the contact carries all of it, uniformly: 10 MPa on 2 mm.
#[test]
fn a_floating_body_falls_through_its_gap_and_is_held() {
    let results = run_file("hard/floating_body", &[]);
    healthy(&results);
    for (s, pressure) in results.states.iter().zip([10.0, 2.5, 10.0]) {
        // Round-off of gaps 1000 times as large as the elastic displacements.
        close(
            "force",
            s.contact_force,
            2.0 * pressure,
            2.0 * pressure,
            1e-10,
        );
        for pair in &s.pairs {
            assert_eq!(pair.status, Status::Closed);
            close("pressure", pair.pressure, pressure, pressure, 1e-10);
        }
    }
    same_contact("reloaded", &results.states[0], &results.states[2], 1e-10);
}

/// The pin crosses its clearance at every change of the load's sign, before and after first yield,
/// whether nodes face each other or not. Bottom and top are alike: what the first push does to the
/// plate below, the first pull does above, but for the little that the dent below has changed.
#[test]
fn a_pin_with_clearance_is_pushed_and_pulled() {
    let elements = |pin: usize, plate: [usize; 2]| {
        let pin = format!("mesh.parts.0.disc.elements={pin}");
        [pin, format!("mesh.parts.1.ring.elements={plate:?}")]
    };
    let meshes = [
        (elements(48, [24, 48]), "events"),
        (elements(48, [96, 48]), "events"),
        (elements(24, [24, 48]), "events"),
        (elements(24, [24, 48]), "steps"),
    ];
    for (mesh, stepping) in meshes {
        let stepping = format!("program.stepping={stepping}");
        let small = format!("load.0.force={:?}", [0.0, -300.0]);
        for (load, plastic) in [(None, true), (Some(small), false)] {
            let set = mesh.iter().chain([&stepping]).chain(&load);
            let set: Vec<&str> = set.map(String::as_str).collect();
            let results = run_file("hard/to_and_fro", &set);
            healthy(&results);
            let [pushed, pulled, again] = [0, 1, 2].map(|i| &results.states[i]);
            assert_eq!(pushed.max_equivalent_plastic_strain > 0.0, plastic);
            let (force, allowed) = (pushed.contact_force, if plastic { 1e-3 } else { 1e-8 });
            close("force above", pulled.contact_force, force, force, allowed);
            let pressure = pushed.max_pressure;
            close("above", pulled.max_pressure, pressure, pressure, allowed);
            close("again", again.contact_force, force, force, allowed);
            // Half of the pairs at most carry anything, those of one side each time.
            let sides = pushed.pairs.iter().zip(&pulled.pairs);
            assert!(sides.clone().all(|(a, b)| a.force == 0.0 || b.force == 0.0));
            assert!(sides.clone().any(|(a, _)| a.force > 0.0));
        }
    }
}

/// A pin free to move in all directions is pushed down, let go, and pushed sideways: from where it
/// was left it rolls round the hole, and is held there as it was below.
#[test]
fn a_pin_let_go_is_pushed_sideways() {
    let load = |direction: [f64; 2], history: &str| {
        format!("{{ on = \"pin.center\", force = {direction:?}, history = {history} }}")
    };
    let down = load([0.0, -3000.0], "[[0, 0], [1, 1], [2, 0], [3, 0]]");
    let aside = load([3000.0, 0.0], "[[0, 0], [2, 0], [3, 1]]");
    let mut results = run_file(
        "hard/to_and_fro",
        &[
            "symmetry=1",
            "mesh.parts.0.disc.angle=[0.0, 360.0]",
            "mesh.parts.1.ring.angle=[0.0, 360.0]",
            "mesh.parts.1.ring.elements=[24, 96]",
            "support=[{ on = \"plate.outer\", fix = [\"x\", \"y\"] }]",
            &format!("load=[{down}, {aside}]"),
            "program.targets=[{ load_factor = 1 }, { load_factor = 2 }, { load_factor = 3 }]",
        ],
    );
    // Let go, what pairs carry is round-off of either sign.
    let free = results.states.remove(1);
    healthy(&results);
    let [below, beside] = [0, 1].map(|i| &results.states[i]);
    assert!(below.contact_force > 3000.0);
    for pair in &free.pairs {
        close("let go", pair.force, 0.0, below.contact_force, 1e-12);
    }
    let (force, pressure) = (below.contact_force, below.max_pressure);
    close("beside", beside.contact_force, force, force, 1e-8);
    close("pressure", beside.max_pressure, pressure, pressure, 1e-8);
}

/// Two floating bodies on top of each other: the middle one is held by two contacts, one of which
/// opens in part. Each contact carries the whole load, and without gaps the state is proportional
/// to it.
#[test]
fn three_bodies_in_a_row_pass_the_load_on() {
    let results = run_file("hard/three_in_a_row", &[]);
    healthy(&results);
    let [full, half] = [&results.states[0], state(&results, "half")];
    for contact in 0..2 {
        let sum = |s: &brinell::results::State| -> f64 {
            let of_contact = s.pairs.iter().filter(|p| p.contact == contact);
            of_contact.map(|p| p.force).sum()
        };
        close("force", sum(full), 100.0, 100.0, 1e-10);
        close("force", sum(half), 50.0, 50.0, 1e-10);
    }
    assert!(full.pairs.iter().any(|p| p.status == Status::Open));
    assert!(full.pairs.iter().any(|p| p.status == Status::Closed));
    let scale = largest(full.pairs.iter().map(|p| p.force));
    for (a, b) in full.pairs.iter().zip(&half.pairs) {
        assert_eq!(a.status, b.status);
        close("proportional", a.force, 2.0 * b.force, scale, 1e-10);
    }
}

/// One pair holds the cylinder: the contact problem has one closed row, and the next pair closes
/// only after a million times the load. Codes that want several active pairs, or compare forces
/// with an absolute tolerance, lose it.
#[test]
fn one_closed_pair_holds_a_body() {
    let results = run_file("hard/one_pair", &[]);
    healthy(&results);
    let [touch, press, again] = &results.states[..] else {
        panic!("three states")
    };
    for s in [touch, again] {
        let closed: Vec<_> = s
            .pairs
            .iter()
            .filter(|p| p.status == Status::Closed)
            .collect();
        assert_eq!(closed.len(), 1);
        close("force", closed[0].force, 1e-3, 1e-3, 1e-9);
    }
    let sum: f64 = press.pairs.iter().map(|p| p.force).sum();
    close("force", sum, 1e3, 1e3, 1e-10);
    assert!(
        press
            .pairs
            .iter()
            .filter(|p| p.status == Status::Closed)
            .count()
            > 2
    );
    same_contact("back", touch, again, 1e-9);
}

/// A beam that contact holds at its end is a millionth as stiff without: whoever holds it by soft
/// springs meanwhile, or takes its pivots for zero, gets another share of the load. Propped
/// cantilever; shear adds (h/L)^2 = 1e-4 times a small number, and where on the edge's element the
/// force acts (half an element, 0.5 % of the length) as much of it.
#[test]
fn a_nearly_floating_body_is_held_by_its_own_stiffness() {
    let results = run_file("hard/nearly_floating", &[]);
    healthy(&results);
    let (l, x, q) = (100.0f64, 99.0f64, 0.01);
    let exact = q * (6.0 * l * l - 4.0 * l * x + x * x) / (8.0 * x);
    let (laid, again) = (state(&results, "laid"), state(&results, "laid again"));
    close("reaction", laid.contact_force, exact, exact, 6e-3);
    assert_eq!(state(&results, "lifted").contact_force, 0.0);
    same_contact("laid again", laid, again, 1e-10);
    // What the beam's length costs is said, in every run.
    assert!(results.condition > 1e4, "{:e}", results.condition);
    assert!(results.inaccurate.is_empty());
}

/// A ball that nothing holds but its flat, with gaps along its own normals, which turn along the
/// surface: whatever the mesh, the first bit of load finds the pair that carries it. (Before what
/// is rigid was put into the contact matrix exactly, one of these meshes was driven off by
/// round-off.) The two ways to take the gaps differ by the slope of the ball at the edge, 0.011.
#[test]
fn a_ball_is_held_by_whichever_pair_comes_first() {
    let mesh = "mesh.cylinder_on_half_plane";
    for element in ["quad4", "quad8"] {
        for resolution in 4..=9 {
            let yields = ["first", "second"].map(|slave| {
                let scene = support::load(
                    "ball_on_half_space",
                    &[
                        &format!("{mesh}.element=\"{element}\""),
                        &format!("{mesh}.resolution={resolution}"),
                        &format!("contact.0.slave=\"{slave}\""),
                    ],
                );
                support::yield_load(&scene).first_yield.unwrap().alpha
            });
            let change = yields[0] / yields[1] - 1.0;
            assert!(change.abs() < 0.011, "{element} {resolution}: {yields:?}");
        }
    }
}

/// A block on another, held by contact alone, under a pressure on its top.
fn block_on_block(kind: &str, of_low: &str, rest: &str, random: &mut Random) -> Scene {
    let n: [usize; 5] = std::array::from_fn(|_| 1 + random.below(6));
    let solid = kind == "solid";
    let part = |body: &str, end: f64, [from, to]: [f64; 2], [a, b]: [usize; 2]| match solid {
        true => format!(
            "{{ body = \"{body}\", brick = {{ x = [0, {end:?}], y = [0, 1], \
             z = [{from:?}, {to:?}], elements = [{a}, 1, {b}] }} }}"
        ),
        false => format!(
            "{{ body = \"{body}\", block = {{ x = [0, {end:?}], y = [{from:?}, {to:?}], \
             elements = [{a}, {b}] }} }}"
        ),
    };
    let along = if solid { "z" } else { "y" };
    let sides = match solid {
        true => "{ on = \"low.front\", fix = [\"y\"] }, { on = \"up.front\", fix = [\"y\"] },",
        false => "",
    };
    let left = "{ on = \"low.left\", fix = [\"x\"] }, { on = \"up.left\", fix = [\"x\"] }";
    let [low, up] = [
        part("low", 4.0, [0.0, 2.0], [2 * n[0], n[1]]),
        part(
            "up",
            2.0,
            [2.0, 2.0 + random.within(0.5, 2.0)],
            [n[2], n[3]],
        ),
    ];
    parse(&format!(
        "kind = \"{kind}\"\nmesh.parts = [{low}, {up}]\n\
         contact = [{{ first = \"up.bottom\", second = \"low.top\" }}]\n\
         support = [{{ on = \"low.bottom\", fix = [\"{along}\"] }}, {sides} {left}]\n\
         bodies = {{ low = {{ material = \"m\"{of_low} }}, up.material = \"m\" }}\n\
         [materials.m]\nyoungs_modulus = 2e5\npoissons_ratio = 0.3\nthermal_expansion = 1.2e-5\n\
         [[load]]\non = \"up.top\"\npressure = 100.0\n{rest}\n\
         [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
    ))
}

/// Heat and residual stresses push no body away, whatever round-off leaves of them: a block that
/// lies on them is there before the load comes, and carries all of it.
#[test]
fn strains_drive_no_loose_body_away() {
    for seed in 1..=either(120, 1000) {
        let mut random = Random::new(seed);
        let random = &mut random;
        let kind = random.one_of(&["plane_strain", "plane_stress", "axisymmetric", "solid"]);
        let heat = format!(
            "[[load]]\non = \"low\"\ntemperature = {:?}\nhistory = \"constant\"\n",
            random.within(-500.0, 500.0)
        );
        let [x, y, z] = std::array::from_fn(|_| random.within(-300.0, 300.0));
        let z = if kind == "plane_stress" { 0.0 } else { z };
        let (rest, of_low) = match random.below(3) {
            0 => (heat, String::new()),
            1 => (
                String::new(),
                format!(", initial_stress = [[0.0, {x:?}, {y:?}, {z:?}]]"),
            ),
            _ => (
                heat,
                ", initial_plastic_strain = [[0.0, 0.001, 0.0, 0.002]]".into(),
            ),
        };
        let mut scene = block_on_block(kind, &of_low, &rest, random);
        scene.title = format!("seed {seed}");
        let results = support::run(&scene);
        let area = if kind == "axisymmetric" {
            PI * 4.0
        } else {
            2.0
        };
        let force = results.states[0].contact_force;
        close(&scene.title, force, 100.0 * area, 100.0 * area, 1e-8);
    }
}
