//! A plane strain model and the same drawn out along z between planes of symmetry.

use crate::support::{parse, run, same_figures};
use brinell::results::{State, Status};
use brinell::scene::Scene;

/// Two blocks, the upper one narrower and harder; `up` is the axis from the lower to the upper one.
fn two_blocks(kind: &str, up: &str, parts: &str, across: &str) -> Scene {
    let text = format!(
        r#"
title = "Punch"
kind = "{kind}"
mesh.parts = [{parts}]
support = [
    {{ on = "punch.left", fix = ["x"] }},
    {{ on = "block.left", fix = ["x"] }},
    {{ on = "block.bottom", fix = ["{up}"] }},
    {across}
]
contact = [{{ first = "punch.bottom", second = "block.top" }}]

[materials.hard]
youngs_modulus = 600000.0
poissons_ratio = 0.3
[materials.steel]
youngs_modulus = 210000.0
poissons_ratio = 0.3
yield_stress = 300.0
tangent_modulus = 5000.0
[bodies.punch]
material = "hard"
[bodies.block]
material = "steel"

[[load]]
on = "punch.top"
plane_force = {{ direction = "{up}", total = -900.0 }}

[program]
stepping = "steps"
steps = 12
targets = [{{ load_factor = 0.6 }}, {{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
"#
    );
    parse(&text)
}

/// hex8 with its mean dilatation over a prism is quad4 with its own: the histories are one, but for
/// strain paths that begin where the recovered stress yields, which layers of elements change.
#[test]
fn a_block_drawn_out_is_in_plane_strain() {
    let plane = two_blocks(
        "plane_strain",
        "y",
        r#"{ body = "punch", block = { x = [0, 2], y = [0, 2], elements = [
                   4, 4], bias = [1.0, 2.0] } },
           { body = "block", block = { x = [0, 6], y = [-6, 0], elements = [
                   12, 10], bias = [1.0, 0.2] } }"#,
        "",
    );
    let solid = two_blocks(
        "solid",
        "z",
        r#"{ body = "punch", brick = { x = [0, 2], y = [0, 1], z = [0, 2], elements = [
                   4, 2, 4], bias = [1.0, 1.0, 2.0] } },
           { body = "block", brick = { x = [0, 6], y = [0, 1], z = [-6, 0], elements = [
                   12, 2, 10], bias = [1.0, 1.0, 0.2] } }"#,
        r#"{ on = "punch.front", fix = ["y"] }, { on = "punch.back", fix = ["y"] },
    { on = "block.front", fix = ["y"] }, { on = "block.back", fix = ["y"] },"#,
    );
    let (plane, solid) = (run(&plane), run(&solid));
    let closed = |s: &State| {
        s.pairs
            .iter()
            .filter(|p| p.status == Status::Closed)
            .count()
    };
    for (a, b) in plane.states.iter().zip(&solid.states) {
        let largest = &plane.states[1];
        same_figures(a, b, 1.0, largest, 1e-6);
        let [x, y] = [a, b].map(|state| state.plastic_zone_size);
        let off = (x - y).abs();
        assert!(
            off < 1e-6 * largest.plastic_zone_size,
            "{}: {x} {y}",
            a.name
        );
        // Every pair of the plane model stands for a row of three.
        assert_eq!(closed(b), 3 * closed(a), "{}", a.name);
    }
    assert!(plane.states[1].plastic_points > 20);
}
