//! Plane and axisymmetric scenes drawn out to solids.

use crate::support::{either, parse, run, same_figures};
use brinell::results::{Results, Status};
use brinell::scene::Scene;

/// A cylinder or ball on a flat body, plane or drawn out; `more` are keys of the mesh, `planes`
/// supports beside that of the base.
fn cylinder_on_flat(kind: &str, more: &str, planes: &[(&str, &str)], force: f64) -> Scene {
    let supports: Vec<String> = ["cylinder", "half_plane"]
        .iter()
        .flat_map(|body| planes.iter().map(move |(on, axis)| (body, on, axis)))
        .map(|(body, on, axis)| format!("{{ on = \"{body}.{on}\", fix = [\"{axis}\"] }},"))
        .collect();
    let text = format!(
        r#"
title = "Drawn out"
kind = "{kind}"
support = [{{ on = "half_plane.bottom", fix = ["y"] }}, {}]
contact = [{{ first = "cylinder.contact", second = "half_plane.contact" }}]

[mesh]
{more}
[mesh.cylinder_on_half_plane]
radius = 10.0
resolution = 4
far_size = 20.0
contact_width = 2.0

[materials.steel]
youngs_modulus = 210000.0
poissons_ratio = 0.3
yield_stress = 500.0
tangent_modulus = 2100.0
[bodies]
cylinder = {{ material = "steel" }}
half_plane = {{ material = "steel" }}

[[load]]
on = "cylinder.top"
plane_force = {{ direction = "y", total = {} }}

[program]
stepping = "steps"
steps = 12
targets = [{{ load_factor = 1.0 }}, {{ load_factor = 2.0 }}, {{ load_factor = 0.0 }}]
"#,
        supports.concat(),
        -force,
    );
    parse(&text)
}

/// Figures of parts against those of the whole: both are iterated to 1e-10 of the forces.
const SAME: f64 = 1e-7;

/// The paper's cylinder, drawn out between planes of symmetry, has the plane model's history, twice
/// its first yield and back; its contact is a strip. Increments begin where the recovered stress
/// yields, which layers of elements change: strain paths are not the same to round-off.
#[test]
fn an_extruded_cylinder_is_that_of_plane_strain() {
    let depth = 0.25;
    let plane = run(&cylinder_on_flat(
        "plane_strain",
        "",
        &[("symmetry", "x")],
        110.0,
    ));
    let extrude = format!("extrude = {{ depth = {depth}, elements = 2 }}");
    let planes = [("symmetry", "x"), ("front", "z"), ("back", "z")];
    let solid = run(&cylinder_on_flat("solid", &extrude, &planes, 110.0 * depth));
    let closed = |s: &brinell::results::State| {
        let closed = s.pairs.iter().filter(|p| p.status == Status::Closed);
        closed.count()
    };
    for (a, b) in plane.states.iter().zip(&solid.states) {
        same_figures(a, b, 1.0 / depth, &plane.states[1], 1e-5);
        assert_eq!(closed(b), 3 * closed(a));
    }
    assert!(plane.states[1].plastic_points > 20);
    // In space the edge is read off to half an element.
    let patch = &solid.states[1].patches[0];
    let state = &plane.states[1];
    let element = state.pairs[1].position[0] - state.pairs[0].position[0];
    assert!(patch.semi_axes[0].is_infinite());
    let off = (patch.semi_axes[1] - state.half_width).abs();
    assert!(off < 0.5 * element.abs(), "{off} {element}");
    // Recovery in three variables and in two.
    let load = |results: &Results| results.first_yield.as_ref().unwrap().load;
    assert!((load(&solid) / depth / load(&plane) - 1.0).abs() < 1e-3);
}

/// A quarter of a ball by revolution comes to the axisymmetric one with the square of the angle of
/// its elements.
#[test]
fn a_revolved_ball_is_the_axisymmetric_one() {
    let force = 20.0;
    let whole = run(&cylinder_on_flat(
        "axisymmetric",
        "",
        &[("symmetry", "x")],
        force,
    ));
    let sector = |n: usize| {
        let revolve = format!("revolve = {{ angle = 90, elements = {n} }}");
        let planes = [("front", "z"), ("back", "x")];
        run(&cylinder_on_flat("solid", &revolve, &planes, 0.25 * force))
    };
    let sectors = either([3, 6, 12], [4, 8, 16]).map(sector);
    for (state, name) in [(0, "elastic"), (1, "plastic")] {
        let approach = |r: &Results| r.states[state].approach;
        let [a, b, c] = sectors.each_ref().map(approach);
        let order = ((a - b) / (b - c)).log2();
        assert!((1.6..2.6).contains(&order), "{name}: {order}");
        // What is left is the difference between the axisymmetric quad4's shear and hex8's, h^2/10.
        let limit = c + (c - b) / 3.0;
        let off = limit / approach(&whole) - 1.0;
        assert!(off.abs() < 0.1 / 16.0, "{name}: {off}");
        let per_quarter = sectors[2].states[state].contact_force / (0.25 * force);
        assert!((per_quarter - [1.0, 2.0][state]).abs() < 1e-9);
    }
    let dent = |r: &Results| r.states[2].residual_depth;
    let off = dent(&sectors[2]) / dent(&whole) - 1.0;
    assert!(off.abs() < 0.05, "{off}");
}

/// Sectors of 45 and 60 degrees between planes of symmetry have the history of the quarter with
/// elements of the same angle: every sector is a part of the whole. They begin to yield as above.
#[test]
fn sectors_between_planes_at_an_angle_are_parts_of_the_quarter() {
    let force = 20.0;
    let sector = |angle: usize, elements: usize| {
        let revolve = format!("revolve = {{ angle = {angle}, elements = {elements} }}");
        let planes = [("front", "z"), ("back", "x")];
        let share = force * angle as f64 / 360.0;
        let mut scene = cylinder_on_flat("solid", &revolve, &planes, share);
        let (sin, cos) = (angle as f64).to_radians().sin_cos();
        for support in &mut scene.support {
            if support.on.ends_with(".back") {
                support.fix.clear();
                support.direction = Some([-sin, 0.0, cos].into());
            }
        }
        run(&scene)
    };
    for (angle, elements, of_quarter) in [(45, 2, 4), (60, 2, 3)] {
        let (part, quarter) = (sector(angle, elements), sector(90, of_quarter));
        let times = 90.0 / angle as f64;
        for (a, b) in quarter.states.iter().zip(&part.states) {
            same_figures(a, b, times, &quarter.states[1], 1e-8);
        }
        assert!(quarter.states[1].plastic_points > 20);
        let first_yield = |results: &Results| results.first_yield.as_ref().unwrap().load;
        let ratio = times * first_yield(&part) / first_yield(&quarter);
        assert!((ratio - 1.0).abs() < SAME, "{angle}: {ratio}");
        for (a, b) in quarter.states.iter().zip(&part.states).take(2) {
            let figures = |state: &brinell::results::State| {
                let patch = &state.patches[0];
                let [a, b] = patch.semi_axes;
                [
                    patch.area,
                    a,
                    b,
                    patch.mean_pressure,
                    patch.force,
                    state.half_width,
                ]
            };
            for (x, y) in figures(a).into_iter().zip(figures(b)) {
                // The unit of the fit's coordinates is a mean over the faces of the part.
                assert!((x - y).abs() < 3e-3 * x, "{angle} {}: {x} {y}", a.name);
            }
        }
    }
}
