//! Contact that comes and goes: lift-off, ties, grazing, conforming surfaces, separation.

use crate::support::random::Random;
use crate::support::{close, healthy, parse, run, run_file, same_contact, state};
use brinell::results::Status;

/// Codes that keep a list of "active" nodes forget the ones that left, or start the second contact
/// with the first one's forces. The path is elastic: the same displacement gives the same state.
#[test]
fn a_body_that_lifts_off_comes_back_to_the_same_state() {
    let results = run_file("hard/lift_off", &[]);
    healthy(&results);
    let up = state(&results, "up");
    assert_eq!(up.contact_force, 0.0);
    assert!(up.pairs.iter().all(|p| p.status == Status::Open));
    let (down, again) = (state(&results, "down"), state(&results, "down again"));
    assert!(down.contact_force > 0.0);
    same_contact("down again", down, again, 1e-10);
}

/// Up to a thousand pairs reach zero at the same load up to round-off. Codes that change one pair
/// at a time see a thousand increments of length zero, or chatter. The strip is in uniaxial stress:
/// opening at displacement 0, and p = E u / h.
#[test]
fn a_thousand_pairs_open_and_close_as_one() {
    together(&[], 301);
    let sizes = (0..2).flat_map(|i| {
        [
            format!("mesh.parts.{i}.block.elements=[1000, 1]"),
            format!("mesh.parts.{i}.block.x=[0.0, 100.0]"),
        ]
    });
    let sizes: Vec<String> = sizes.collect();
    let sizes: Vec<&str> = sizes.iter().map(String::as_str).collect();
    together(&sizes, 1001);
}

fn together(overrides: &[&str], n: usize) {
    let results = run_file("hard/ties", overrides);
    healthy(&results);
    for name in ["pressed", "pressed again"] {
        let s = state(&results, name);
        assert_eq!(s.pairs.len(), n);
        for p in &s.pairs {
            assert_eq!(p.status, Status::Closed);
            // Round-off of a strip hundreds of elements long.
            close("pressure", p.pressure, 105.0, 105.0, 1e-9);
        }
    }
    assert!(
        state(&results, "apart")
            .pairs
            .iter()
            .all(|p| p.status == Status::Open)
    );
    // All or none, at each end of an increment.
    for row in &results.history {
        assert!([0, n].contains(&row.closed_pairs), "{row:?}");
    }
    let events: Vec<_> = results
        .history
        .iter()
        .filter(|row| row.event.contains("opens") || row.event.contains("closes"))
        .collect();
    assert!(events.len() <= 2, "{events:?}");
    assert_eq!(results.counts.contact_changes % n, 0);
    for (row, alpha) in events.iter().zip([1.5, 2.5]) {
        close("event", row.alpha, alpha, 1.0, 1e-9);
    }
}

/// A gap that just closes at the end of a step: "g <= 0" and "r > 0" are both undecided, and codes
/// flip the pair for ever. At the target neither gap nor force is left, and beyond it the pressure
/// is E times the strain.
#[test]
fn grazing_contact_is_neither_missed_nor_repeated() {
    let results = run_file("hard/grazing", &[]);
    healthy(&results);
    for name in ["graze", "graze again", "graze on the way up"] {
        let s = state(&results, name);
        close("force", s.contact_force, 0.0, 2.0 * 52.5, 1e-9);
        for p in &s.pairs {
            close("gap", p.gap, 0.0, 0.25, 1e-12);
        }
    }
    for p in &state(&results, "away").pairs {
        close("gap", p.gap, 0.125, 0.25, 1e-12);
    }
    for p in &state(&results, "press").pairs {
        // The strain is the 1/500 of a displacement that is more than the gap: 500 times its
        // round-off.
        close("pressure", p.pressure, 52.5, 52.5, 1e-10);
    }
    for p in &state(&results, "start").pairs {
        close("gap", p.gap, 0.25, 0.25, 1e-12);
    }
    assert!(results.history.len() <= 12, "{}", results.history.len());
}

/// Without a gap every change of contact happens at load 0+: an event algorithm that starts at "all
/// closed" or "all open" never leaves it. Statuses and p / S do not depend on the load over twelve
/// orders of magnitude. Two solves of 25 pairs differ by eps times the pairs and the condition of
/// the condensed stiffness of their surface, an operator of first order: about their number again.
#[test]
fn conforming_contact_does_not_depend_on_the_size_of_the_load() {
    let results = run_file("hard/zero_gap_conforming", &[]);
    healthy(&results);
    let one = state(&results, "one");
    let largest = one.max_pressure;
    let n = one.pairs.len() as f64;
    let round_off = 2.0 * n * n * f64::EPSILON;
    assert!(round_off < 1e-12);
    for (name, factor) in [("tiny", 1e-6), ("huge", 1e6), ("back", 1.0)] {
        let s = state(&results, name);
        for (a, b) in one.pairs.iter().zip(&s.pairs) {
            assert_eq!(a.status, b.status, "{name}");
            close(
                name,
                factor * a.pressure,
                b.pressure,
                factor * largest,
                round_off,
            );
        }
    }
    assert_eq!(state(&results, "unloaded").contact_force, 0.0);
}

/// Exact: 19.625 degrees. The contact ends between its last closed node and the next: from the
/// nodes alone it is known to half their distance, and the forces must not make that worse on any
/// mesh.
#[test]
fn conforming_contact_ends_where_it_should() {
    for n in [24, 48, 96] {
        let resolution = format!("mesh.disc_in_plate.resolution={n}");
        let targets = "program.targets=[{ name = \"one\", load_factor = 1.0 }]";
        let results = run_file("hard/zero_gap_conforming", &[&resolution, targets]);
        let [from, to] = state(&results, "one").contact_arc.unwrap();
        assert_eq!(from, 0.0);
        close("half angle", to, 19.625, 0.5 * 90.0 / n as f64, 1.0);
    }
}

/// The last pair opens at load 0 exactly, and then nothing holds the cylinder: the end of the path
/// is singular. What is left is no force and a dent.
#[test]
fn complete_separation_at_no_load_leaves_the_dent() {
    let results = run_file("hard/separation", &[]);
    healthy(&results);
    let (loaded, unloaded) = (&results.states[1], state(&results, "unloaded"));
    close(
        "force",
        unloaded.contact_force,
        0.0,
        loaded.contact_force,
        1e-10,
    );
    assert!(unloaded.max_equivalent_plastic_strain >= loaded.max_equivalent_plastic_strain);
    assert!(loaded.plastic_points > 0);
    assert!(unloaded.residual_depth.abs() > 0.0);
}

/// The state before anything acts is the one that the scene describes, not the round-off of finding
/// it: its quality is no ratio of two of these.
#[test]
fn where_nothing_acts_nothing_moves() {
    let results = run_file(
        "hard/one_pair",
        &["program.targets=[{ load_factor = 0.0 }]"],
    );
    healthy(&results);
    let [state] = &results.states[..] else {
        panic!("one state")
    };
    assert_eq!(
        (state.load, state.contact_force, state.approach),
        (0.0, 0.0, 0.0)
    );
    assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
}

/// Changes of contact that follow one another within 1e-9 of the load, in a tube with a fiftieth of
/// its stiffness left: codes that take the last increment's rates for the next stretch its
/// round-off by as much, and lose equilibrium or the way.
#[test]
fn contact_that_comes_nearly_at_once_keeps_its_equilibrium() {
    let results = run_file("hard/nearly_at_once", &[]);
    healthy(&results);
    let other = run_file(
        "hard/nearly_at_once",
        &[
            "analysis.plastic_iteration=anderson",
            "analysis.tolerance=1e-8",
        ],
    );
    for name in ["alpha 60", "alpha 150", "off"] {
        let (newton, anderson) = (state(&results, name), state(&other, name));
        let force = newton.contact_force;
        close(name, force, anderson.contact_force, force, 1e-6);
    }
}

/// Blocks that fit, on unlike meshes, at places that no number of sixteen digits meets: the gaps of
/// the mesh are round-off. Codes that take them for gaps close pair after pair under a load of
/// nothing, and lose the body as it comes off; here all close at once, and open at once.
#[test]
fn surfaces_that_fit_have_no_gaps() {
    let mut random = Random::new(7);
    for case in 0..24 {
        let is_solid = case % 3 == 0;
        let [low, middle, high] =
            [0.1, random.within(0.3, 0.7), 1.1].map(|y| y * random.within(1.0, 1.0 + 1e-9));
        let from = random.within(-30.0, 30.0);
        let to = from + random.within(0.7, 1.9);
        let mut body = |name: &str, [bottom, top]: [f64; 2], cells: usize| {
            let (element, up) = match is_solid {
                true => (random.one_of(&["hex8", "hex20"]), "z"),
                false => (random.one_of(&["quad4", "quad8", "tri3", "tri6"]), "y"),
            };
            let across = match is_solid {
                true => format!("y = [{from}, {to}], "),
                false => String::new(),
            };
            let elements = match is_solid {
                true => format!("[{cells}, {}, 2]", cells + 1),
                false => format!("[{cells}, 2]"),
            };
            let shape = if is_solid { "brick" } else { "block" };
            format!(
                "{{ body = \"{name}\", element = \"{element}\", {shape} = {{ x = [{from}, {to}], \
                 {across}{up} = [{bottom}, {top}], elements = {elements} }} }}"
            )
        };
        let cells = 2 + case % 4;
        let parts = [
            body("low", [low, middle], cells),
            body("upp", [middle, high], cells + 1),
        ];
        let (kind, up, more) = match is_solid {
            true => (
                "solid",
                "z",
                ", { on = \"low.front\", fix = [\"y\"] }, { on = \"upp.front\", fix = [\"y\"] }",
            ),
            false => ("plane_strain", "y", ""),
        };
        let text = format!(
            r#"kind = "{kind}"
mesh.parts = [{}]
materials.m = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
bodies = {{ low.material = "m", upp.material = "m" }}
contact = [{{ first = "upp.bottom", second = "low.top" }}]
support = [{{ on = "low.bottom", fix = ["{up}"] }}, {{ on = "low.left", fix = ["x"] }},
           {{ on = "upp.left", fix = ["x"] }}{more}]
load = [{{ on = "upp.top", pressure = 50.0 }}]
program.targets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
"#,
            parts.join(", ")
        );
        let results = run(&parse(&text));
        healthy(&results);
        assert_eq!(results.history.len(), 2, "{text}");
        // The surfaces are as large as each other.
        let area = (to - from) * if is_solid { to - from } else { 1.0 };
        let found = results.states[0].contact_force;
        close(&text, found, 50.0 * area, 50.0 * area, 1e-9);
        assert_eq!(results.states[1].contact_force, 0.0, "{text}");
    }
}

/// A contact that no state closes is named with what is left of its gap: surfaces that look the
/// wrong way, or a load that does not reach.
#[test]
fn a_contact_that_never_closes_is_named() {
    let warning = |down: f64| {
        let text = r#"
kind = "plane_strain"
mesh.parts = [
    { body = "a", element = "quad4", block = { x = [0, 2], y = [0, 1], elements = [2, 1] } },
    { body = "b", element = "quad4", block = { x = [0, 2], y = [2, 3], elements = [2, 1] } },
]
materials.s = { youngs_modulus = 210e3, poissons_ratio = 0.3 }
bodies = { a.material = "s", b.material = "s" }
contact = [{ first = "b.bottom", second = "a.top" }]
support = [{ on = "a.bottom", fix = ["x", "y"] }, { on = "b.top", fix = ["x"] }]
load = [{ on = "b.top", displacement = { y = DOWN } }]
program.targets = [{ load_factor = 1.0 }, { load_factor = 0.0 }]
"#;
        let results = run(&parse(&text.replace("DOWN", &format!("{:?}", -down))));
        let mut warnings = results.warnings.into_iter();
        warnings.find(|text| text.contains("is open in every state"))
    };
    assert_eq!(warning(1.01), None);
    let text = warning(0.75).expect("a warning");
    assert!(
        text.contains("its smallest gap is 0.2500, in state `alpha 1`"),
        "{text}"
    );
}

/// Two blocks side by side on a finer one: the node under the joint would be the slave of both
/// contacts. Each passes its own pressure on.
#[test]
fn blocks_side_by_side_share_an_edge() {
    let text = r#"
kind = "plane_strain"
mesh.parts = [
    { body = "a", element = "quad4", block = { x = [0, 2], y = [0, 1], elements = [16, 4] } },
    { body = "b", element = "quad4", block = { x = [0, 1], y = [1, 2], elements = [5, 3] } },
    { body = "c", element = "quad4", block = { x = [1, 2], y = [1, 2], elements = [3, 3] } },
]
materials.s = { youngs_modulus = 210e3, poissons_ratio = 0.0 }
bodies = { a.material = "s", b.material = "s", c.material = "s" }
contact = [{ first = "b.bottom", second = "a.top" }, { first = "c.bottom", second = "a.top" }]
support = [
    { on = "a.bottom", fix = ["x", "y"] },
    { on = "b.left", fix = ["x"] }, { on = "c.right", fix = ["x"] },
]
load = [{ on = "b.top", pressure = 10.0 }, { on = "c.top", pressure = 10.0 }]
program.targets = [{ load_factor = 1.0 }]
"#;
    let results = run(&parse(text));
    healthy(&results);
    let state = &results.states[0];
    close("force", state.contact_force, 20.0, 20.0, 1e-12);
    for pair in &state.pairs {
        close("pressure", pair.pressure, 10.0, 10.0, 1e-10);
    }
}
