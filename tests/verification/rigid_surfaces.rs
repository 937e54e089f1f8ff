//! Rigid surfaces without a mesh: a cylinder, a sphere and others on blocks.
//!
//! Source: K. L. Johnson, Contact Mechanics (1985), sections 4.2 and 5.1: with one body rigid
//! `1/E* = (1 - nu^2)/E` of the other.

use crate::support::{parse, try_run};
use brinell::linalg::Backend;
use brinell::results::{Results, State};

/// A block under a rigid surface, whose lines follow; half of it, refined towards the corner.
fn block(kind: &str, element: &str, n: usize, lines: &str) -> String {
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
fn ball(push: &str) -> String {
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

fn run(text: &str) -> Results {
    let scene = parse(text);
    try_run(&scene, Backend::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn only(results: &Results) -> &State {
    results.states.last().unwrap()
}

fn near(a: f64, b: f64, share: f64) {
    assert!((a - b).abs() <= share * b.abs(), "{a} {b}");
}

#[test]
fn a_rigid_cylinder_and_a_rigid_sphere_press_as_hertz_says() {
    let modulus = 210e3 / (1.0 - 0.09);
    let load = 1500.0;
    for (kind, peak) in [
        (
            "plane_strain",
            (load * modulus / (std::f64::consts::PI * 10.0)).sqrt(),
        ),
        (
            "axisymmetric",
            (6.0 * load * modulus * modulus / (std::f64::consts::PI.powi(3) * 100.0)).cbrt(),
        ),
    ] {
        let errors = [16, 32].map(|n| {
            let results = run(&block(kind, "quad4", n, &ball("force = [0.0, -1500.0]")));
            let state = only(&results);
            near(state.load, load, 1e-12);
            state.max_pressure / peak - 1.0
        });
        println!("{kind}: {errors:?}");
        assert!(errors[1].abs() < 0.02, "{kind}: {errors:?}");
    }
}

/// The same state: figures that a change of what is stated must not change.
fn same(a: &Results, b: &Results, share: f64) {
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
        let by = |push: &str| run(&block(kind, "quad8", 8, &ball(push)));
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
    same(&run(&text), &run(&other), 1e-13);
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
    let upright = run(&whole(&|x| x, ["x", "top"]));
    for (turn, surface) in [
        (
            Box::new(|[x, y]: [f64; 2]| [x + 7.0, y - 3.0]) as Box<dyn Fn([f64; 2]) -> [f64; 2]>,
            "top",
        ),
        (Box::new(|[x, y]: [f64; 2]| [-y, x]), "left"),
        (Box::new(|[x, y]: [f64; 2]| [x, -y]), "bottom"),
    ] {
        same(&run(&whole(&*turn, ["", surface])), &upright, 1e-9);
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
    let half = run(&half);
    let [a, b] = [only(&half), only(&upright)];
    near(a.load, b.load, 1e-12);
    near(a.max_pressure, b.max_pressure, 1e-9);
    near(a.approach, b.approach, 1e-9);
}
