//! Rigid surfaces without a mesh: a cylinder, a sphere and others on blocks.
//!
//! Source: K. L. Johnson, Contact Mechanics (1985), sections 4.2 and 5.1: with one body rigid
//! `1/E* = (1 - nu^2)/E` of the other.

use crate::support::{parse, run_text};
use brinell::model::Model;
use brinell::results::{Results, State};

const UP: [f64; 3] = [0.0, 1.0, 0.0];

/// A block under a rigid surface, whose lines follow; half of it, refined towards the corner.
pub fn block(kind: &str, element: &str, n: usize, lines: &str) -> String {
    format!(
        r#"kind = "{kind}"
symmetry = {symmetry}
[[mesh.parts]]
body = "block"
element = "{element}"
block = {{ x = [0.0, 4.0], y = [-4.0, 0.0], elements = [{n}, {n}], bias = [20.0, 0.05] }}
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies]
block = {{ material = "steel" }}
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
targets = [{{ load_factor = 1.0 }}]
{lines}
"#,
        symmetry = if kind == "axisymmetric" { 1 } else { 2 },
    )
}

/// A circle of radius 10 above the origin, and what pushes it.
pub fn ball(push: &str) -> String {
    format!(
        r#"[rigid.ball]
sphere = {{ center = [0.0, 10.0], radius = 10.0 }}
[[contact]]
first = "ball"
second = "block.top"
[[load]]
on = "ball"
{push}
"#
    )
}

pub fn only(results: &Results) -> &State {
    results.states.last().unwrap()
}

pub fn near(a: f64, b: f64, share: f64) {
    assert!((a - b).abs() <= share * b.abs(), "{a} {b}");
}

#[test]
fn a_rigid_cylinder_and_a_rigid_sphere_press_as_hertz_says() {
    let modulus = 210e3 / (1.0 - 0.09);
    let load = 1500.0;
    for (kind, peak, width) in [
        (
            "plane_strain",
            (load * modulus / (std::f64::consts::PI * 10.0)).sqrt(),
            (40.0 * load / (std::f64::consts::PI * modulus)).sqrt(),
        ),
        (
            "axisymmetric",
            (6.0 * load * modulus * modulus / (std::f64::consts::PI.powi(3) * 100.0)).cbrt(),
            (7.5 * load / modulus).cbrt(),
        ),
    ] {
        let errors = [16, 32].map(|n| {
            let results = run_text(&block(kind, "quad4", n, &ball("force = [0.0, -1500.0]")));
            let state = only(&results);
            near(state.load, load, 1e-12);
            [
                state.max_pressure / peak - 1.0,
                state.half_width / width - 1.0,
            ]
        });
        assert!(
            errors[1].iter().all(|e| e.abs() < 0.02),
            "{kind}: {errors:?}"
        );
    }
}

/// The same state: figures that a change of what is stated must not change.
pub fn same(a: &Results, b: &Results, share: f64) {
    let [a, b] = [only(a), only(b)];
    near(a.load, b.load, share);
    near(a.max_pressure, b.max_pressure, share);
    near(a.approach, b.approach, share);
    assert_eq!(a.pairs.len(), b.pairs.len());
    near(a.contact_force, b.contact_force, share);
}

#[test]
fn the_approach_gives_the_force_and_the_force_the_approach() {
    for kind in ["plane_strain", "plane_stress", "axisymmetric"] {
        let by = |push: &str| run_text(&block(kind, "quad8", 8, &ball(push)));
        let pushed = by("force = [0.0, -1500.0]");
        let depth = only(&pushed).approach;
        assert!(depth > 0.0, "{kind}: {depth}");
        let moved = by(&format!("displacement = {{ y = {} }}", -depth));
        same(&moved, &pushed, 1e-9);
        let plane = by("plane_force = { direction = \"y\", total = -1500.0 }");
        same(&plane, &pushed, 1e-12);
    }
}

#[test]
fn either_side_of_a_contact_may_be_rigid() {
    let text = block("plane_strain", "quad4", 8, &ball("force = [0.0, -1500.0]"));
    let other = text.replace(
        "first = \"ball\"\nsecond = \"block.top\"",
        "first = \"block.top\"\nsecond = \"ball\"",
    );
    assert_ne!(text, other);
    same(&run_text(&text), &run_text(&other), 1e-13);
}

/// Half of a block and all of it; the whole moved, turned by a right angle and mirrored.
#[test]
fn where_and_how_the_scene_stands_changes_nothing() {
    let whole = |turn: &dyn Fn([f64; 2]) -> [f64; 2], [across, depth]: [&str; 2]| {
        let [x, y] = [turn([-4.0, -4.0]), turn([4.0, 0.0])];
        let span = |d: usize| format!("[{:?}, {:?}]", x[d].min(y[d]), x[d].max(y[d]));
        let center = turn([0.0, 10.0]);
        let origin = turn([0.0, 0.0]);
        let push: Vec<f64> = (0..2).map(|d| 150.0 * (origin[d] - center[d])).collect();
        let sides = match depth {
            "top" => "bottom",
            "left" => "right",
            _ => "top",
        };
        format!(
            r#"kind = "plane_strain"
[[mesh.parts]]
body = "block"
block = {{ x = {}, y = {}, elements = [10, 10] }}
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies]
block = {{ material = "steel" }}
[[support]]
on = "block.{sides}"
fix = ["x", "y"]
[rigid.ball]
sphere = {{ center = {center:?}, radius = 10.0 }}
[[contact]]
first = "ball"
second = "block.{depth}"
[[load]]
on = "ball"
force = {push:?}
[program]
targets = [{{ load_factor = 1.0 }}]
# {across}
"#,
            span(0),
            span(1),
        )
    };
    let upright = run_text(&whole(&|x| x, ["x", "top"]));
    for (turn, surface) in [
        (
            Box::new(|[x, y]: [f64; 2]| [x + 7.0, y - 3.0]) as Box<dyn Fn([f64; 2]) -> [f64; 2]>,
            "top",
        ),
        (Box::new(|[x, y]: [f64; 2]| [-y, x]), "left"),
        (Box::new(|[x, y]: [f64; 2]| [x, -y]), "bottom"),
    ] {
        same(&run_text(&whole(&*turn, ["", surface])), &upright, 1e-9);
    }
    let text = whole(&|x| x, ["x", "top"]);
    let half = text
        .replace("kind", "symmetry = 2\nkind")
        .replace("x = [-4.0, 4.0]", "x = [0.0, 4.0]")
        .replace("elements = [10, 10]", "elements = [5, 10]")
        .replace(
            "[rigid",
            "[[support]]\non = \"block.left\"\nfix = [\"x\"]\n[rigid",
        );
    let half = run_text(&half);
    let [a, b] = [only(&half), only(&upright)];
    near(a.load, b.load, 1e-12);
    near(a.max_pressure, b.max_pressure, 1e-9);
    near(a.approach, b.approach, 1e-9);
}

/// The force of all pairs of a scene's state along a direction, on the rigid surface.
pub fn along(text: &str, state: &State, direction: [f64; 3]) -> f64 {
    let model = Model::new(&parse(text)).unwrap();
    let dot = |n: [f64; 3]| (0..3).map(|d| n[d] * direction[d]).sum::<f64>();
    let pairs = state.pairs.iter();
    pairs
        .map(|pair| pair.force * dot(model.pairs[pair.pair].normal))
        .sum()
}

/// Uniaxial strain under a plane that covers all of the block; an edge with a fillet, a blunt cone,
/// a ring and heights balance what pushes them.
#[test]
fn what_pushes_a_rigid_surface_is_what_its_pairs_carry() {
    let cover = "plane = { point = [0.0, 0.5], normal = [0.0, -1.0] }";
    let text_of = |kind: &str, surface: &str, push: &str| {
        let lines = ball(push).replace("sphere = { center = [0.0, 10.0], radius = 10.0 }", surface);
        block(kind, "quad4", 10, &lines)
    };
    for (kind, area) in [
        ("plane_strain", 8.0),
        ("axisymmetric", 16.0 * std::f64::consts::PI),
    ] {
        let text = block(
            kind,
            "quad4",
            4,
            &ball(&format!("force = [0.0, {}]", -100.0 * area)),
        );
        let text = text
            .replace("sphere = { center = [0.0, 10.0], radius = 10.0 }", cover)
            .replace("fix = [\"x\", \"y\"]", "fix = [\"y\"]");
        let results = run_text(&format!(
            "{text}\n[[support]]\non = \"block.right\"\nfix = [\"x\"]\n"
        ));
        for pair in &only(&results).pairs {
            near(pair.pressure, 100.0, 1e-10);
        }
        let stiffness = 210e3 * 0.7 / (1.3 * 0.4);
        near(
            only(&results).approach,
            0.5 + 4.0 * 100.0 / stiffness,
            1e-10,
        );
    }
    let copies = 2.0;
    for (kind, form, copies) in [
        (
            "plane_strain",
            "punch = { center = [0.0, 0.0], axis = [0.0, 1.0], radius = 1.0, fillet = 0.3 }",
            copies,
        ),
        (
            "axisymmetric",
            "punch = { center = [0.0, 0.0], axis = [0.0, 1.0], radius = 1.0, fillet = 0.3 }",
            1.0,
        ),
        (
            "axisymmetric",
            "cone = { tip = [0.0, 0.0], axis = [0.0, 1.0], half_angle = 85.0, rounding = 2.0 }",
            1.0,
        ),
        (
            "axisymmetric",
            "torus = { center = [0.0, 2.0], ring_radius = 1.0, radius = 2.0 }",
            1.0,
        ),
    ] {
        let by_force = text_of(kind, form, "force = [0.0, -2000.0]");
        let pushed = run_text(&by_force);
        near(copies * along(&by_force, only(&pushed), UP), 2000.0, 1e-10);
        near(only(&pushed).load, 2000.0, 1e-12);
        let way = format!("displacement = {{ y = {} }}", -only(&pushed).approach);
        let by_way = text_of(kind, form, &way);
        let moved = run_text(&by_way);
        same(&moved, &pushed, 1e-9);
        let force = copies * along(&by_way, only(&moved), UP);
        near(force, only(&moved).load, 1e-12);
    }
}

/// A wall that nothing pushes is held, and a block that only it holds is pressed onto it.
#[test]
fn a_wall_is_held() {
    let lines = r#"[rigid.wall]
plane = { point = [0.0, 0.25], normal = [0.0, -1.0] }
[[contact]]
first = "block.top"
second = "wall"
[[load]]
on = "block.bottom"
pressure = 50.0
"#;
    let text = block("plane_strain", "quad4", 4, lines);
    let text = text.replace(
        "on = \"block.bottom\"\nfix = [\"x\", \"y\"]",
        "on = \"block.right\"\nfix = [\"x\"]",
    );
    let results = run_text(&text);
    for pair in &only(&results).pairs {
        near(pair.pressure, 50.0, 1e-9);
    }
}

/// A meshed indenter that is a million times as stiff presses as a rigid one does.
#[test]
fn a_rigid_surface_is_the_limit_of_stiff_ones() {
    let lines = ball("plane_force = { direction = \"y\", total = -1500.0 }");
    let text = block("plane_strain", "quad4", 16, &lines);
    let rigid = run_text(&text);
    let stiff = r#"[[mesh.parts]]
body = "ball"
disc = { center = [0.0, 10.0], radius = 10.0, angle = [270.0, 360.0], elements = 48 }
[materials.stiff]
youngs_modulus = 210e9
poissons_ratio = 0.3
[[support]]
on = "ball.start"
fix = ["x"]
"#;
    let sphere = "[rigid.ball]\nsphere = { center = [0.0, 10.0], radius = 10.0 }\n";
    let meshed = text
        .replace(sphere, stiff)
        .replace(
            "first = \"ball\"",
            "first = \"ball.outer\"\nslave = \"second\"",
        )
        .replace("[bodies]\n", "[bodies]\nball = { material = \"stiff\" }\n")
        .replace("on = \"ball\"\nplane", "on = \"ball.end\"\nplane");
    let meshed = run_text(&meshed);
    let [a, b] = [only(&rigid), only(&meshed)];
    // Weighted gaps of the mortar rows differ from those at nodes by the square of the element.
    near(a.load, b.load, 1e-9);
    near(a.max_pressure, b.max_pressure, 0.02);
    near(a.approach, b.approach, 0.02);
}

/// Pressed in until the block flows, by force and by way, and let go.
#[test]
fn an_indentation_stays_when_the_ball_is_taken_off() {
    let by = |push: &str| {
        let text = block("axisymmetric", "quad4", 10, &ball(push));
        let soft = "poissons_ratio = 0.3\nyield_stress = 500.0\n";
        let back =
            "{ load_factor = 1.0 }, { load_factor = 0.0 }]\nstepping = \"steps\"\nsteps = 100";
        text.replace("poissons_ratio = 0.3\n", soft)
            .replace("{ load_factor = 1.0 }]", back)
    };
    let by_force = by("force = [0.0, -3000.0]");
    let pushed = run_text(&by_force);
    let depth = pushed.states[0].approach;
    let by_way = by(&format!("displacement = {{ y = {} }}", -depth));
    let moved = run_text(&by_way);
    // A hundred steps of first order each: between 60 and 200 of them the difference falls from 5 %
    // to half a percent.
    near(moved.states[0].load, 3000.0, 0.03);
    near(
        moved.states[0].residual_depth,
        pushed.states[0].residual_depth,
        0.01,
    );
    for (results, text) in [(&pushed, &by_force), (&moved, &by_way)] {
        let [loaded, free] = [&results.states[0], &results.states[1]];
        near(along(text, loaded, UP), loaded.load, 1e-9);
        assert_eq!(free.contact_force, 0.0);
        assert!(free.residual_depth > 0.005, "{}", free.residual_depth);
        let [block, ball] = free.residual_depth_by_body[..] else {
            panic!()
        };
        assert!(ball.abs() < 1e-15, "{ball}");
        near(block, free.residual_depth, 1e-12);
    }
}

/// Metres and pascals instead of millimetres and megapascals.
#[test]
fn units_are_the_users() {
    let text = block("axisymmetric", "quad4", 8, &ball("force = [0.0, -1500.0]"));
    let other = text
        .replace("[0.0, 4.0]", "[0.0, 0.004]")
        .replace("[-4.0, 0.0]", "[-0.004, 0.0]")
        .replace("210e3", "210e9")
        .replace("[0.0, 10.0], radius = 10.0", "[0.0, 0.01], radius = 0.01");
    let [a, b] = [run_text(&text), run_text(&other)];
    let [a, b] = [only(&a), only(&b)];
    near(b.load, a.load, 1e-12);
    near(1e-6 * b.max_pressure, a.max_pressure, 1e-9);
    near(1e3 * b.approach, a.approach, 1e-9);
}

/// Heights of a circle press as the circle does; cubics of a tenth of the contact are off it by
/// less than `h^4 / (384 R^3)`.
#[test]
fn heights_press_as_the_surface_that_they_are_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("circle.csv");
    let height = |x: f64| 10.0 - (100.0 - x * x).sqrt();
    let lines = (-100..=100).map(|k| f64::from(k) / 20.0);
    let lines: Vec<String> = lines.map(|x| format!("{x},{}", height(x))).collect();
    std::fs::write(&path, format!("x,y\n{}\n", lines.join("\n"))).unwrap();
    let text = block("plane_strain", "quad4", 8, &ball("force = [0.0, -1500.0]"));
    let heights = text.replace(
        "sphere = { center = [0.0, 10.0], radius = 10.0 }",
        &format!("heights = {{ file = {:?} }}", path.to_str().unwrap()),
    );
    same(&run_text(&heights), &run_text(&text), 1e-5);
}

/// Guided along a slope, a ball is carried by more than half of what pushes it: the wall of the
/// guide takes the rest.
#[test]
fn a_push_may_have_any_direction() {
    let text = block(
        "plane_strain",
        "quad4",
        8,
        &ball("force = [1500.0, -1500.0]"),
    );
    let text = text.replace("symmetry = 2", "symmetry = 1");
    let results = run_text(&text);
    let slope = 0.5f64.sqrt();
    let state = only(&results);
    near(
        along(&text, state, [-slope, slope, 0.0]),
        1500.0 / slope,
        1e-10,
    );
    near(state.load, 1500.0 / slope, 1e-12);
    let way = state.approach * slope;
    let push = format!("displacement = {{ x = {way}, y = {} }}", -way);
    let moved = text.replace("force = [1500.0, -1500.0]", &push);
    same(&run_text(&moved), &results, 1e-8);
}

/// A held plane that starts inside the block, and one that a soft layer lies on.
#[test]
fn interference_and_soft_contact_are_those_of_meshed_surfaces() {
    let text = |contact: &str, load: &str| {
        let lines = format!(
            r#"[rigid.wall]
plane = {{ point = [0.0, -0.004], normal = [0.0, -1.0] }}
[[contact]]
first = "block.top"
second = "wall"
overlap = true
{contact}
{load}
"#
        );
        let text = block("plane_strain", "quad4", 4, &lines);
        let text = text.replace("fix = [\"x\", \"y\"]", "fix = [\"y\"]");
        format!("{text}\n[[support]]\non = \"block.right\"\nfix = [\"x\"]\n")
    };
    let own = 210e3 * 0.7 / (1.3 * 0.4) / 4.0;
    let load = "[[load]]\non = \"wall\"\ngap = -0.002";
    for (contact, stiffness) in [("", own), ("stiffness = 1e4", own * 1e4 / (own + 1e4))] {
        let results = run_text(&text(contact, load));
        for pair in &only(&results).pairs {
            near(pair.pressure, 0.006 * stiffness, 1e-9);
        }
    }
}
