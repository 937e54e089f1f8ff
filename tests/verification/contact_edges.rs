//! Where a contact in the plane ends: between its last closed pair, half of whose share may be
//! free, and its first open one.

use crate::support::random::Random;
use crate::support::{close, either, parse, run, try_run};
use brinell::linalg::Backend;
use brinell::results::{State, Status};
use std::f64::consts::PI;

/// Elastic, and plastic far beyond first yield; every kind and shape.
#[test]
fn a_half_width_ends_between_closed_and_open_pairs() {
    for seed in 0..either(8, 200) {
        let random = &mut Random::new(seed);
        let kind = random.one_of(&["plane_strain", "plane_stress", "axisymmetric"]);
        let element = random.one_of(&["quad4", "quad8", "tri6"]);
        let resolution = 3 + random.below(4);
        let most = match kind {
            "axisymmetric" => random.within(2.0, 60.0),
            _ => random.within(1.5, 4.0),
        };
        let text = format!(
            r#"kind = "{kind}"
materials.steel = {{ youngs_modulus = 2.1e5, poissons_ratio = 0.3, yield_stress = 500.0 }}
bodies = {{ cylinder = {{ material = "steel", plastic = false }}, half_plane.material = "steel" }}
contact = [{{ first = "cylinder.contact", second = "half_plane.contact" }}]
support = [
  {{ on = "cylinder.symmetry", fix = ["x"] }}, {{ on = "half_plane.symmetry", fix = ["x"] }},
  {{ on = "half_plane.bottom", fix = ["y"] }},
]
load = [{{ on = "cylinder.top", plane_force = {{ direction = "y", total = -1.0 }} }}]
program = {{ unit = "yield", targets = [{{ load_factor = 0.5 }}, {{ load_factor = {most:?} }}] }}
[mesh.cylinder_on_half_plane]
radius = 10.0
resolution = {resolution}
far_size = 60.0
element = "{element}"
"#
        );
        let results = try_run(&parse(&text), Backend::default());
        for state in &results.unwrap_or_else(|e| panic!("{e}\n{text}")).states {
            let of = |status: Status| {
                let pairs = state.pairs.iter().filter(move |pair| pair.status == status);
                pairs.map(|pair| pair.position[0])
            };
            let last = of(Status::Closed).fold(0.0, f64::max);
            let first = of(Status::Open)
                .filter(|x| *x > last)
                .fold(f64::INFINITY, f64::min);
            let width = state.half_width;
            let low = last - 0.5 * (first - last);
            // The arc is a little longer than its projection.
            let longer = 1.0 + first * first / 100.0;
            assert!(
                width >= low && width <= first * longer,
                "{seed} {}: {last} {width} {first}\n{text}",
                state.name
            );
        }
    }
}

const PIN: &str = r#"
kind = "plane_strain"
mesh.parts = [
    { body = "in", element = "quad4", disc = { radius = 40, elements = 8, angle = [0, 360] } },
    { body = "out", element = "quad4",
      ring = { radius = [40, 70], elements = [6, 32], angle = [0, 360] } },
]
materials.b = { youngs_modulus = 210e3, poissons_ratio = 0.3, density = 7.85e-9 }
bodies = { in.material = "b", out.material = "b" }
contact = [{ first = "in.outer", second = "out.inner", GAP }]
support = [{ on = "out.outer", fix = ["x", "y"] }]
load = [{ on = "in", acceleration = TO }]
program.targets = [{ load_factor = 1.0 }]
"#;

/// Wherever the list of a ring's nodes begins, a contact across that place is no other.
#[test]
fn contact_goes_on_across_the_seam_of_a_ring() {
    let pushed = |turn: f64| {
        let way = [1e9 * turn.to_radians().cos(), 1e9 * turn.to_radians().sin()];
        let text = PIN
            .replace("GAP", "gap = 0.02")
            .replace("TO", &format!("{way:?}"));
        run(&parse(&text))
    };
    // The first of each crosses the seam; the mesh is the same by quarters and about 45 degrees.
    for turns in [
        [0.0, 90.0, 180.0],
        [11.25, 78.75, 101.25],
        [348.75, 78.75, 168.75],
    ] {
        let [crossing, others @ ..] = turns.map(pushed);
        let expected = &crossing.states[0];
        assert!(expected.half_width > 50.0);
        for results in &others {
            let state = &results.states[0];
            let figures = |s: &State| [s.half_width, s.pole_pressure, s.max_pressure];
            for (found, expected) in figures(state).into_iter().zip(figures(expected)) {
                close(&format!("{turns:?}"), found, expected, expected, 1e-9);
            }
            let arc = |s: &State| s.contact_arc.expect("a circle")[1];
            close("arc", arc(state), arc(expected), 90.0, 1e-9);
        }
    }
}

/// All around: a ring, its half and its quarter.
#[test]
fn a_fit_touches_all_around() {
    let mut widths = Vec::new();
    for (from, to, symmetry) in [(0, 360, 1), (-90, 90, 2), (0, 90, 4)] {
        let cells = (to - from) * 32 / 360;
        let ends = |axis: &str, edge: &str| {
            let of = |body| format!("{{ on = \"{body}.{edge}\", fix = [\"{axis}\"] }}");
            ["in", "out"].map(of).join(", ")
        };
        let held = match symmetry {
            1 => String::new(),
            2 => ends("x", "start") + ", " + &ends("x", "end"),
            _ => ends("y", "start") + ", " + &ends("x", "end"),
        };
        let text = PIN
            .replace("[0, 360]", &format!("[{from}, {to}]"))
            .replace("[6, 32]", &format!("[6, {cells}]"))
            .replace("GAP", "interference = 0.03")
            .replace("{ on = \"out.outer\", fix = [\"x\", \"y\"] }", &held)
            .replace("load = [{ on = \"in\", acceleration = TO }]", "")
            .replace("load_factor = 1.0", "load_factor = 0.0");
        let text = format!("symmetry = {symmetry}\n{text}");
        let results = run(&parse(&text));
        widths.push(results.states[0].half_width);
    }
    // Half the length of 32 chords.
    let half = 32.0 * 40.0 * (PI / 32.0).sin();
    for width in widths {
        close("half width", width, half, half, 1e-12);
    }
}
