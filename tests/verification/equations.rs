//! Linear equations between displacements: a lever, an inclined roller, a surface held plane.

use crate::support::run_with_model;
use crate::verification::close;
use brinell::model::Model;
use brinell::results::Results;
use brinell::scene::{Direction, Equation, EquationTerm, Scene};

const E: f64 = 200_000.0;

/// Two bars along x in plane stress, 4 long and 2 wide, on rollers at their left ends. The
/// equations hold the right ends plane and couple them by `lever`.
fn bars(equations: &str, loads: &str) -> Scene {
    try_bars(equations, loads).unwrap()
}

fn model_of(equations: &str, loads: &str) -> brinell::Result<Model> {
    Model::new(&try_bars(equations, loads)?)
}

fn try_bars(equations: &str, loads: &str) -> brinell::Result<Scene> {
    let bar = |name: &str, y: f64| {
        format!(
            "{{ body = \"{name}\", element = \"quad4\", block = {{ x = [0.0, 4.0], y = [{y:?}, \
             {:?}], elements = [4, 2] }} }}",
            y + 2.0
        )
    };
    let text = format!(
        r#"
kind = "plane_stress"
mesh.parts = [{}, {}]
support = [{{ on = "a.left", fix = ["x"] }}, {{ on = "a.bottom_left", fix = ["y"] }},
    {{ on = "b.left", fix = ["x"] }}, {{ on = "b.bottom_left", fix = ["y"] }}]
equation = [{equations}]
load = [{loads}]
[materials.stiff]
youngs_modulus = {E:?}
poissons_ratio = 0.3
[materials.soft]
youngs_modulus = {:?}
poissons_ratio = 0.3
[bodies.a]
material = "stiff"
[bodies.b]
material = "soft"
[program]
targets = [{{ load_factor = 1.0 }}]
"#,
        bar("a", 0.0),
        bar("b", 5.0),
        E / 4.0,
    );
    Scene::parse(&text, "test")
}

fn term(on: &str, direction: &str, coefficient: f64) -> String {
    format!("{{ on = \"{on}\", direction = \"{direction}\", coefficient = {coefficient:?} }}")
}

fn equation(terms: &[String]) -> String {
    format!("{{ terms = [{}] }}", terms.join(", "))
}

/// Displacement of the node at a place.
fn at(model: &Model, results: &Results, x: [f64; 2]) -> [f64; 2] {
    let mesh = &model.mesh;
    let near = |node: &usize| (0..2).all(|d| (mesh.point(*node)[d] - x[d]).abs() < 1e-9);
    let node = (0..mesh.n_nodes()).find(near).unwrap();
    let u = &results.states[0].fields.as_ref().unwrap().displacement;
    [u[2 * node], u[2 * node + 1]]
}

/// Displacements of two bars of stiffness `k = E A / L` whose ends are plane and `u_a + 2 u_b = 0`:
/// `F = (k_a + k_b / 4) u_a`, exactly so in bilinear elements. The end of `a` follows its corner,
/// which follows that of `b`.
#[test]
fn a_lever_couples_two_bars() {
    let plane = |bar: &str| {
        let corner = format!("{bar}.bottom_right");
        equation(&[
            term(&format!("{bar}.right"), "x", 1.0),
            term(&corner, "x", -1.0),
        ])
    };
    let lever = equation(&[
        term("a.bottom_right", "x", 1.0),
        term("b.bottom_right", "x", 2.0),
    ]);
    let loads = r#"{ on = "a.right", traction = [10.0, 0.0] }"#;
    let k = |e: f64| e * 2.0 / 4.0;
    let u = 20.0 / (k(E) + k(E / 4.0) / 4.0);
    for order in [[0, 1, 2], [2, 1, 0]] {
        let all = [plane("a"), plane("b"), lever.clone()];
        let equations = order.map(|i| all[i].clone()).join(", ");
        let (model, results) = run_with_model(&bars(&equations, loads));
        for y in [0.0, 1.0, 2.0] {
            close(at(&model, &results, [4.0, y])[0], u, 1e-12);
            close(at(&model, &results, [4.0, 5.0 + y])[0], -0.5 * u, 1e-12);
        }
    }
}

/// A prescribed difference: the right end of one bar moves by `d` more than twice that of the
/// other, which a traction stretches. With `u_a = 2 u_b + d` the work of all forces gives
/// `(4 k_a + k_b) u_b = F - 2 k_a d`, and the force that keeps up the difference is `k_a u_a`.
#[test]
fn a_prescribed_difference_of_two_bars() {
    let plane = |bar: &str| {
        let corner = format!("{bar}.bottom_right");
        equation(&[
            term(&format!("{bar}.right"), "x", 1.0),
            term(&corner, "x", -1.0),
        ])
    };
    let d = 1e-3;
    let apart = format!(
        "{{ name = \"apart\", on = \"a.bottom_right\", relative = {{ direction = \"x\", \
         value = {d:?}, terms = [{}] }}, history = [[0.0, 0.0], [0.5, 3.0], [1.0, 1.0]] }}",
        term("b.bottom_right", "x", 2.0)
    );
    let pull = r#"{ on = "b.right", traction = [10.0, 0.0] }"#;
    let equations = [plane("a"), plane("b")].join(", ");
    let scene = bars(&equations, &format!("{pull}, {apart}"));
    let (model, results) = run_with_model(&scene);
    let k = |e: f64| e * 2.0 / 4.0;
    let [ka, kb] = [k(E), k(E / 4.0)];
    let ub = (20.0 - 2.0 * ka * d) / (4.0 * ka + kb);
    let ua = 2.0 * ub + d;
    for y in [0.0, 1.0, 2.0] {
        close(at(&model, &results, [4.0, y])[0], ua, 1e-12);
        close(at(&model, &results, [4.0, 5.0 + y])[0], ub, 1e-12);
    }
    let fields = results.states[0].fields.as_ref().unwrap();
    let along_x = |set: &str| -> f64 {
        let nodes = model.mesh.set_nodes(set).unwrap();
        nodes.into_iter().map(|node| fields.force[2 * node]).sum()
    };
    close(along_x("a.right"), ka * ua, 1e-12);
    close(along_x("b.right"), kb * ub, 1e-12);
    close(along_x("a.left"), -ka * ua, 1e-12);
    for (bad, words) in [
        (
            apart.replace("\"a.bottom_right\"", "\"a.left\""),
            "cannot follow others",
        ),
        (apart.replace("b.bottom_right", "nowhere"), "nowhere"),
        (
            apart.replace("direction = \"x\", value", "direction = \"z\", value"),
            "no direction",
        ),
        (
            apart.replace("value = 0.001", "value = nan"),
            "load.1.relative.value",
        ),
    ] {
        let error = model_of(&equations, &format!("{pull}, {bad}")).unwrap_err();
        assert!(error.message().contains(words), "{bad}: {error}");
    }
}

/// A node that moves along a slope and is drawn off it by a given distance: `u . n = d`.
#[test]
fn a_node_is_moved_along_a_slope() {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let off = |d: f64| {
        format!(
            "{{ on = \"a.bottom_right\", relative = {{ direction = \"y\", value = {:?}, \
             terms = [{}] }} }}",
            d / cos,
            term("a.bottom_right", "x", sin / cos)
        )
    };
    let pull = r#"{ on = "a.top", traction = [3.0, -10.0] }"#;
    for d in [0.0, 2e-3] {
        let (model, results) = run_with_model(&bars("", &format!("{pull}, {}", off(d))));
        let [x, y] = at(&model, &results, [4.0, 0.0]);
        let found = cos * y - sin * x;
        assert!((found - d).abs() < 1e-14, "{found} for {d}");
    }
}

/// A roller at an angle is `sin u_x - cos u_y = 0`.
#[test]
fn an_equation_at_one_node_is_a_roller_at_an_angle() {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let loads = r#"{ on = "a.top", traction = [3.0, -10.0] }"#;
    let roller = equation(&[
        term("a.bottom_right", "y", cos),
        term("a.bottom_right", "x", -sin),
    ]);
    let (model, by_equation) = run_with_model(&bars(&roller, loads));
    let mut scene = bars("", loads);
    scene.support.push(brinell::scene::Support {
        on: "a.bottom_right".into(),
        direction: Some([-sin, cos].into()),
        ..Default::default()
    });
    let (_, by_support) = run_with_model(&scene);
    let fields = |results: &Results| results.states[0].fields.clone().unwrap();
    let (a, b) = (fields(&by_equation), fields(&by_support));
    let scale = |of: &[f64]| of.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let off: Vec<f64> = (a.displacement.iter().zip(&b.displacement))
        .map(|(a, b)| a - b)
        .collect();
    assert!(
        scale(&off) < 1e-12 * scale(&b.displacement),
        "{}",
        scale(&off)
    );
    // And it moves along the roller.
    let [x, y] = at(&model, &by_equation, [4.0, 0.0]);
    assert!(x.abs() > 1e-6 && (sin * x - cos * y).abs() < 1e-15);
}

/// Surfaces of cells that repeat: opposite nodes move alike but for a common stretch, that of the
/// corner. Under a force on it the stress is uniform, also where the cell yields.
#[test]
fn opposite_sides_of_a_cell_move_alike() {
    let sides = equation(&[term("a.right", "y", 1.0), term("a.left", "y", -1.0)]);
    let plane = equation(&[term("a.right", "x", 1.0), term("a.bottom_right", "x", -1.0)]);
    let mut scene = bars(
        &[sides, plane].join(", "),
        r#"{ on = "a.bottom_right", force = [500.0, 0.0] }"#,
    );
    let steel = scene.materials.get_mut("stiff").unwrap();
    steel.yield_stress = Some(200.0);
    steel.plastic_modulus = Some(E / 9.0);
    // Tangent modulus E / 10: 250 = 200 + 50.
    let (model, results) = run_with_model(&scene);
    let strain = 200.0 / E + 50.0 / (E / 10.0);
    for y in [0.0, 1.0, 2.0] {
        close(at(&model, &results, [4.0, y])[0], 4.0 * strain, 1e-9);
    }
    let fields = results.states[0].fields.as_ref().unwrap();
    assert!(fields.stress.iter().all(|s| *s < 250.0 * (1.0 + 1e-9)));
}

/// What an equation cannot say is named with the equation, the node and what to do.
#[test]
fn what_cannot_follow_is_named() {
    let cases = [
        (
            equation(&[
                term("a.right", "x", 1.0),
                term("b.left", "x", 1.0),
                term("b.top", "x", 1.0),
            ]),
            "equation 1: term 3 is on the 5 nodes of `b.top`, the first on 3 of `a.right`",
        ),
        (
            equation(&[term("a.left", "x", 1.0), term("b.bottom_right", "x", 1.0)]),
            "equation 1: the displacement of node 1 along x cannot follow others",
        ),
        (
            [
                equation(&[
                    term("a.bottom_right", "x", 1.0),
                    term("b.bottom_right", "x", 1.0),
                ]),
                equation(&[
                    term("b.bottom_right", "x", 1.0),
                    term("a.bottom_right", "x", 1.0),
                ]),
            ]
            .join(", "),
            "go in a circle",
        ),
        (
            equation(&[term("a.bottom_right", "x", 0.0), term("b.left", "x", 1.0)]),
            "coefficient",
        ),
        (
            equation(&[term("a.bottom_right", "x", 1.0)]),
            "at least two terms",
        ),
        (
            equation(&[term("a.bottom_right", "z", 1.0), term("b.left", "x", 1.0)]),
            "direction",
        ),
        (
            equation(&[term("a.nowhere", "x", 1.0), term("b.left", "x", 1.0)]),
            "a.nowhere",
        ),
        (
            equation(&[
                term("a.bottom_right", "x", 1.0),
                term("a.bottom_right", "x", 1.0),
            ]),
            "it is among the others too",
        ),
    ];
    let loads = r#"{ on = "a.right", traction = [10.0, 0.0] }"#;
    for (equations, part) in cases {
        let error = model_of(&equations, loads).unwrap_err().to_string();
        assert!(error.contains(part), "{error}\nlacks: {part}");
    }
}

/// A body that only an equation holds is held; one that no equation holds is not.
#[test]
fn what_equations_hold_is_held() {
    let mut scene = bars("", r#"{ on = "a.right", traction = [10.0, 0.0] }"#);
    scene.support.retain(|support| support.on != "a.left");
    let error = Model::new(&scene).unwrap_err();
    assert_eq!(error.kind(), brinell::ErrorKind::Unheld);
    for corner in ["bottom_right", "top_right"] {
        let terms = [("a", 1.0), ("b", -1.0)].map(|(bar, coefficient)| EquationTerm {
            on: format!("{bar}.{corner}"),
            direction: Direction::X,
            coefficient,
        });
        scene.equation.push(Equation {
            terms: terms.into(),
        });
    }
    let (model, results) = run_with_model(&scene);
    // All of the force goes through `b`, at its corners.
    let ends = [5.0, 7.0].map(|y| at(&model, &results, [4.0, y])[0]);
    close(ends[1], ends[0], 1e-12);
    // A bar is the softer the less evenly it is pulled.
    assert!(ends[0] > 20.0 / (E / 4.0 * 2.0 / 4.0), "{ends:?}");
}
