//! Loads: what they sum up to, how they follow the load factor; prescribed displacements: the force
//! that they take, of the whole, and axes that are turned against x and y.

use crate::support::{close, parse, run, state};

const E: f64 = 1000.0;
const NU: f64 = 0.3;
/// Width and height of the block, and how far its top is moved.
const WIDTH: f64 = 1.25;
const HEIGHT: f64 = 2.0;
const MOVED: f64 = -0.001;

/// A block in plane strain whose top is moved, free or held on its right side.
fn block(symmetry: usize, supports: &str) -> String {
    format!(
        r#"
title = "block"
kind = "plane_strain"
symmetry = {symmetry}
[[mesh.parts]]
body = "block"
block = {{ x = [0.0, {WIDTH:.2}], y = [0.0, {HEIGHT:.1}], elements = [3, 4] }}
[materials.steel]
youngs_modulus = {E:.1}
poissons_ratio = {NU:.1}
[bodies.block]
material = "steel"
[[support]]
on = "block.bottom"
fix = ["y"]
[[support]]
on = "block.left"
fix = ["x"]
{supports}
[[load]]
on = "block.top"
displacement = {{ y = {MOVED:.4} }}
[program]
targets = [{{ name = "moved", load_factor = 1.0 }}, {{ name = "back", load_factor = -0.5 }}]
"#
    )
}

/// With free sides `sigma = E/(1 - nu^2) eps`, on the width of the whole: twice that of the half
/// model.
#[test]
fn the_force_of_a_displacement_is_that_of_the_whole() {
    let strain = MOVED.abs() / HEIGHT;
    for symmetry in [1, 2] {
        let results = run(&parse(&block(symmetry, "")));
        let force = symmetry as f64 * WIDTH * E / (1.0 - NU * NU) * strain;
        close("moved", state(&results, "moved").load, force, force, 1e-12);
        let half = 0.5 * force;
        close("back", state(&results, "back").load, half, force, 1e-12);
    }
}

/// The axes of a contact's nodes are its normal, here y, and a quarter turn from it, -x: what is
/// moved along x moves along x.
#[test]
fn a_node_with_turned_axes_moves_as_it_is_told() {
    let text = r#"
title = "sheared block under another"
kind = "plane_strain"
[[mesh.parts]]
body = "lower"
block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [3, 3] }
[[mesh.parts]]
body = "upper"
block = { x = [0.0, 1.0], y = [1.0, 2.0], elements = [3, 3] }
[materials.steel]
youngs_modulus = 1000.0
poissons_ratio = 0.3
[bodies]
lower = { material = "steel" }
upper = { material = "steel" }
[[contact]]
first = "upper.bottom"
second = "lower.top"
[[support]]
on = "lower.bottom"
fix = ["x", "y"]
[[support]]
on = "upper.left"
fix = ["x"]
[[load]]
on = "upper.top"
pressure = 1.0
[[load]]
on = "lower.top"
displacement = { x = 0.001 }
[program]
targets = [{ name = "sheared", load_factor = 1.0 }]
"#;
    let scene = parse(text);
    let model = brinell::model::Model::new(&scene).unwrap();
    let top = model.mesh.set_nodes("lower.top").unwrap();
    assert!(top.iter().all(|&n| model.freedoms.local(n)[1][0] < 0.0));
    let results = run(&scene);
    let u = &results.states[0].fields.as_ref().unwrap().displacement;
    for &node in &top {
        close("moved", u[2 * node], 0.001, 0.001, 4.0 * f64::EPSILON);
    }
}

/// The mean over a surface takes each node with its part of the length: at the ends of the bore
/// half as much as between. Along the bore's resultant, (1, 1)/sqrt 2 of a quarter.
#[test]
fn the_approach_is_the_mean_over_the_surface() {
    let scene = crate::support::load(
        "thick_cylinder",
        &[
            "mesh.parts.0.element=quad4",
            "mesh.parts.0.ring.elements=[3,4]",
            "program.targets=[{ load_factor = 10.0 }]",
        ],
    );
    let model = brinell::model::Model::new(&scene).unwrap();
    let results = run(&scene);
    let u = &results.states[0].fields.as_ref().unwrap().displacement;
    let mut nodes = model.mesh.set_nodes("tube.inner").unwrap();
    nodes.sort_by(|&a, &b| model.mesh.point(b)[0].total_cmp(&model.mesh.point(a)[0]));
    assert_eq!(nodes.len(), 5);
    let mean: f64 = nodes
        .iter()
        .zip([0.125, 0.25, 0.25, 0.25, 0.125])
        .map(|(&n, share)| share * (u[2 * n] + u[2 * n + 1]) / 2f64.sqrt())
        .sum();
    close("approach", results.states[0].approach, mean, mean, 1e-12);
}

/// A table's factors between its rows are linear, outside it those of its ends; only its rows are
/// kinks.
#[test]
fn a_history_is_linear_between_its_rows_and_holds_its_ends() {
    let table = "history = [[0.5, 2.0], [1.0, 3.0], [2.0, -1.0]]\n[program]";
    let text = block(1, "").replace("[program]", table);
    let model = brinell::model::Model::new(&parse(&text)).unwrap();
    let load = &model.loads[0];
    for (alpha, factor) in [
        (-1.0, 2.0),
        (0.0, 2.0),
        (0.5, 2.0),
        (0.75, 2.5),
        (1.0, 3.0),
        (1.5, 1.0),
        (2.0, -1.0),
        (5.0, -1.0),
    ] {
        // What a load factor of 1 stands for is nothing to a table.
        assert_eq!(load.factor(alpha, 7.0), factor, "{alpha}");
    }
    assert_eq!(load.kinks().collect::<Vec<_>>(), [0.5, 1.0, 2.0]);
    let text = block(1, "").replace("[program]", "history = \"constant\"\n[program]");
    let model = brinell::model::Model::new(&parse(&text)).unwrap();
    assert_eq!(model.loads[0].factor(0.3, 7.0), 1.0);
    let model = brinell::model::Model::new(&parse(&block(1, ""))).unwrap();
    assert_eq!(model.loads[0].factor(0.3, 7.0), 0.3 * 7.0);
}

/// Forces are those of the whole: a model of one of two halves carries half of them, however they
/// are spread. Stresses act on what is there, a side of the model.
#[test]
fn loads_sum_up_to_what_was_asked_for() {
    for symmetry in [1, 2] {
        let of_model = 6.0 / symmetry as f64;
        for (on, load, expected) in [
            ("block.top", "force = [0.0, -6.0]", -of_model),
            ("corner", "force = [0.0, -6.0]", -of_model),
            (
                "block.top",
                "plane_force = { direction = \"y\", total = -6.0 }",
                -of_model,
            ),
            ("block.top", "pressure = 6.0", -6.0 * WIDTH),
            ("block.top", "traction = [0.0, 6.0]", 6.0 * WIDTH),
        ] {
            let text = block(symmetry, "").replace(
                &format!("on = \"block.top\"\ndisplacement = {{ y = {MOVED:.4} }}"),
                &format!("on = \"{on}\"\n{load}"),
            );
            let text = text.replace("corner", "block.top_right");
            let model = match brinell::model::Model::new(&parse(&text)) {
                Ok(model) => model,
                Err(error) => panic!("{load} on {on}: {error}"),
            };
            let sum: f64 = model.loads[0].forces.iter().map(|(_, f)| f).sum();
            close(load, sum, expected, expected, 1e-14);
        }
    }
}

/// Every displacement is given, as people test a material: nothing is left to solve, and the state
/// follows from the strains. A strain `e` along one axis and `-e/2` across is deviatoric: von
/// Mises' stress is `3 G e` up to `Y`, then `p = (3 G e - Y)/(3 G + H)` is plastic.
#[test]
fn a_model_whose_displacements_are_all_given_has_a_state() {
    let (modulus, yield_stress, strain, hardening) = (200e3, 200.0, 0.004, 1000.0);
    let text = format!(
        r#"kind = "solid"
mesh.parts = [{{ body = "b",
               brick = {{ x = [0, 1], y = [0, 1], z = [0, 1], elements = [1, 1, 1] }} }}]
materials.m = {{ youngs_modulus = {modulus}, poissons_ratio = 0.3, yield_stress = {yield_stress},
                plastic_modulus = {hardening} }}
bodies.b.material = "m"
support = [{{ on = "b.left", fix = ["x"] }}, {{ on = "b.front", fix = ["y"] }},
           {{ on = "b.bottom", fix = ["z"] }}]
load = [{{ on = "b.right", displacement = {{ x = {strain} }} }},
        {{ on = "b.back", displacement = {{ y = {} }} }},
        {{ on = "b.top", displacement = {{ z = {} }} }}]
program.targets = [{{ name = "on", load_factor = 1.0 }}]
"#,
        -0.5 * strain,
        -0.5 * strain
    );
    let results = run(&parse(&text));
    let three_g = 3.0 * modulus / 2.6;
    let alpha = yield_stress / (three_g * strain);
    close(
        "first yield",
        results.first_yield.unwrap().alpha,
        alpha,
        alpha,
        1e-9,
    );
    let plastic = (three_g * strain - yield_stress) / (three_g + hardening);
    let on = state(&results, "on");
    close(
        "plastic strain",
        on.max_equivalent_plastic_strain,
        plastic,
        plastic,
        1e-9,
    );
    // Along x two thirds of von Mises' stress, on an area of 1.
    let force = 2.0 / 3.0 * (yield_stress + hardening * plastic);
    close("force", on.load, force, force, 1e-9);
}
