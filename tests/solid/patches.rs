//! How patches of contact are read off the pressures, apart from how good these are.

use crate::support::random::Random;
use crate::support::{close, either, parse, run_file, run_on, run_text_as_far_as_it_goes};
use brinell::analytical::{HertzEllipse, contact_modulus};
use brinell::model::Model;
use brinell::results::{State, Status};
use std::f64::consts::PI;

/// Hertz's pressure `p0 sqrt(1 - (x/a)^2 - (y/b)^2)` carries `P = 2/3 p0 A`: the area of an elastic
/// patch follows from load and largest pressure of the same run. It is read to order h^2, with four
/// elements over the smaller half axis to 1/16 (thorough: six, 1/36), whether faces are as oblong
/// as the patch (half axes 2:1) or less so (9:1, faces 4:1).
#[test]
fn areas_agree_with_the_load_and_the_largest_pressure() {
    for name in ["crossed_cylinders", "ball_in_groove"] {
        let n = either(4, 6);
        let square = 1.0 / (n * n) as f64;
        let changes = [
            &format!("mesh.curved_bodies.resolution={n}"),
            "mesh.curved_bodies.far_size=8",
            "mesh.curved_bodies.growth=1.7",
            "program.targets=[{ load_factor = 1.0 }]",
        ];
        let results = run_file(name, &changes);
        let [patch] = &results.states[0].patches[..] else {
            panic!("{name}: not one patch");
        };
        let area = 1.5 * patch.force / patch.max_pressure;
        let off = patch.area / area - 1.0;
        assert!(off.abs() < square, "{name}: {off}");
        let [a, b] = patch.semi_axes;
        assert!((PI * a * b / patch.area - 1.0).abs() < square, "{name}");
        let reading = results.states[0].half_width_reading;
        assert_eq!(reading.pairs, n, "{name}");
        assert!(reading.error < b * square, "{name}: {reading:?}");
    }
}

/// A block, `w` by `d`, pressed evenly onto a hard one of the same mesh: the half axes of a
/// rectangle are `w/sqrt(3)` and `d/sqrt(3)` (second moments `w^2/12`), its centroid is its middle.
/// However few nodes keep the block in place, they bound no plane of symmetry; whole faces of both
/// bodies do, and the patch is then that with its mirror images.
#[test]
fn anchors_are_no_planes_of_symmetry() {
    let (w, d) = (4.0, 3.0);
    let depth = d;
    let text = |supports: &str| {
        format!(
            r#"kind = "solid"
mesh.parts = [
  {{ body = "upp", brick = {{ x = [0, {w}], y = [0, {d}], z = [0, 1], elements = [8, 6, 2] }} }},
  {{ body = "low", brick = {{ x = [0, {w}], y = [0, {d}], z = [-1, 0], elements = [8, 6, 2] }} }},
]
materials.soft = {{ youngs_modulus = 1e3, poissons_ratio = 0.0 }}
materials.hard = {{ youngs_modulus = 1e9, poissons_ratio = 0.0 }}
bodies = {{ upp.material = "soft", low.material = "hard" }}
contact = [{{ first = "upp.bottom", second = "low.top" }}]
support = [{{ on = "low.bottom", fix = ["x", "y", "z"] }}, {supports}]
load = [{{ on = "upp.top", pressure = 10.0 }}]
program.targets = [{{ load_factor = 1.0 }}]
"#
        )
    };
    let corner = r#"{ on = "upp.p", fix = ["x", "y"] }, { on = "upp.q", fix = ["y"] }"#;
    let apart = r#"{ on = "upp.p", fix = ["x"] }, { on = "upp.p", fix = ["y"] },
                   { on = "upp.r", fix = ["x"] }"#;
    let faces = r#"{ on = "upp.left", fix = ["x"] }, { on = "upp.front", fix = ["y"] },
                   { on = "low.left", fix = ["x"] }, { on = "low.front", fix = ["y"] }"#;
    let one = r#"{ on = "upp.left", fix = ["x"] }, { on = "low.left", fix = ["x"] },
                 { on = "upp.p", fix = ["y"] }"#;
    let edges = r#"{ on = "upp.e", fix = ["x"] }, { on = "low.e", fix = ["x"] },
                   { on = "upp.p", fix = ["y"] }"#;
    let off = r#"{ on = "upp.left", fix = ["x"] }, { on = "low.left", fix = ["x"] },
                 { on = "upp.q", fix = ["y"] }"#;
    let upper = r#"{ on = "upp.left", fix = ["x"] }, { on = "upp.front", fix = ["y"] }"#;
    for (supports, times, symmetry) in [
        (corner, [1.0, 1.0], 1),
        (apart, [1.0, 1.0], 1),
        (one, [2.0, 1.0], 2),
        (faces, [2.0, 2.0], 4),
        (edges, [1.0, 1.0], 1),
        (upper, [1.0, 1.0], 1),
        (off, [2.0, 1.0], 1),
        (faces, [2.0, 2.0], 1),
    ] {
        let scene = parse(&format!("symmetry = {symmetry}\n{}", text(supports)));
        // The nodes are named on the mesh of a scene without them.
        let mut mesh = Model::new(&parse(&text(faces))).unwrap().mesh.clone();
        let bottom = mesh.set_nodes("upp.bottom").unwrap();
        for (name, x, y) in [("upp.p", 0.0, 0.0), ("upp.q", w, 0.0), ("upp.r", 0.0, d)] {
            let at = |&node: &usize| mesh.point(node)[..2] == [x, y];
            let nodes: Vec<usize> = bottom.iter().copied().filter(at).collect();
            assert_eq!(nodes.len(), 1);
            mesh.node_sets.insert(name.to_string(), nodes);
        }
        for (name, of) in [("upp.e", "upp.bottom"), ("low.e", "low.top")] {
            let nodes = mesh.set_nodes(of).unwrap();
            let edge = nodes.into_iter().filter(|&node| mesh.point(node)[0] == 0.0);
            let edge = edge.collect();
            mesh.node_sets.insert(name.to_string(), edge);
        }
        let results = run_on(&scene, mesh);
        let [patch] = &results.states[0].patches[..] else {
            panic!("not one patch");
        };
        let expected = [times[0] * w, times[1] * d].map(|length| length / 3f64.sqrt());
        for (found, expected) in patch.semi_axes.iter().zip(expected) {
            close(supports, *found, expected, expected, 1e-9);
        }
        let area = w * d * times[0] * times[1];
        close("area", patch.area, area, area, 1e-9);
        close("force", patch.force, 10.0 * area, 10.0 * area, 1e-6);
        let centre = [0, 1].map(|d| {
            if times[d] > 1.0 {
                0.0
            } else {
                0.5 * [w, depth][d]
            }
        });
        for (found, expected) in patch.centroid.iter().zip(centre) {
            close("centroid", *found, expected, w, 1e-9);
        }
    }
}

/// A quarter of two curved bodies pressed together, the lower one of which may yield.
fn pressed(upper: [f64; 2], resolution: usize, more: &str, targets: &str) -> Vec<State> {
    let text = format!(
        r#"kind = "solid"
symmetry = 4
mesh.curved_bodies = {{ upper = {upper:?}, lower = [0.0, 0.0], resolution = {resolution}, {more} }}
materials.steel = {{ youngs_modulus = 2.1e5, poissons_ratio = 0.3, yield_stress = 500.0 }}
bodies = {{ upper = {{ material = "steel", plastic = false }}, lower.material = "steel" }}
contact = [{{ first = "upper.contact", second = "lower.contact" }}]
support = [
  {{ on = "upper.symmetry_x", fix = ["x"] }}, {{ on = "lower.symmetry_x", fix = ["x"] }},
  {{ on = "upper.symmetry_y", fix = ["y"] }}, {{ on = "lower.symmetry_y", fix = ["y"] }},
  {{ on = "lower.bottom", fix = ["z"] }},
]
load = [{{ on = "upper.top", plane_force = {{ direction = "z", total = -1.0 }} }}]
program = {{ unit = "yield", targets = [{targets}] }}
"#
    );
    run_text_as_far_as_it_goes(&text).states
}

/// A round patch ends between its last closed pairs, of which half a face may be free, and its
/// first open ones, elastic or plastic far beyond first yield, where the pressure stays up to the
/// edge. A tenth of a face is how far pairs close beyond an edge or open within it.
#[test]
fn a_round_patch_ends_between_closed_and_open_pairs() {
    for seed in 0..either(3, 40) {
        let random = &mut Random::new(seed);
        let resolution = 2 + random.below(3);
        let most = random.within(4.0, 100.0);
        let targets: Vec<String> = [0.3, 0.9, 0.2 * most, most]
            .map(|factor| format!("{{ load_factor = {factor:?} }}"))
            .to_vec();
        let more = "far_size = 10.0, growth = 1.8, fine_depth = 1.0";
        let states = pressed([10.0; 2], resolution, more, &targets.join(", "));
        for state in &states {
            let [patch] = &state.patches[..] else {
                panic!("{seed} {}: {} patches", state.name, state.patches.len());
            };
            let force = patch.area * patch.mean_pressure;
            close(
                "force",
                force,
                state.contact_force,
                state.contact_force,
                1e-12,
            );
            let off = |status: Status| {
                let pairs = state.pairs.iter().filter(move |pair| pair.status == status);
                pairs.map(|pair| pair.position[0].hypot(pair.position[1]))
            };
            let last = off(Status::Closed).fold(0.0, f64::max);
            let first = off(Status::Open).fold(f64::INFINITY, f64::min);
            let face = state
                .pairs
                .iter()
                .map(|pair| pair.area)
                .fold(0.0, f64::max)
                .sqrt();
            let radius = state.half_width;
            assert!(
                radius > last - (0.5f64.sqrt() + 0.1) * face && radius < first + 0.1 * face,
                "{seed} {}: {last} {radius} {first}, faces {face}",
                state.name
            );
        }
    }
}

/// Half widths of long ellipses, five elements over them, whatever the load: within a fortieth of
/// an element in the root mean square, where pressures of single pairs at the edge put them off by
/// a twentieth.
#[test]
fn half_widths_of_long_ellipses_are_those_of_hertz() {
    for aspect in either(&[5.0][..], &[5.0, 9.0, 13.0, 18.0]) {
        let upper = [10.0, 10.0 * f64::powf(*aspect, 1.5)];
        let targets = "{ load_factor = 0.6 }, { load_factor = 0.65 }, { load_factor = 0.7 }, \
                       { load_factor = 0.8 }, { load_factor = 0.9 }, { load_factor = 0.95 }";
        let states = pressed(upper, 5, "", targets);
        let modulus = contact_modulus(2.1e5, 0.3, 2.1e5, 0.3);
        let radii = HertzEllipse::relative_radii(upper, [0.0; 2]).unwrap();
        let hertz = HertzEllipse::new(radii, modulus).unwrap();
        let off = states.iter().map(|state| {
            let [a, b] = hertz.semi_axes(state.load);
            state.half_width / a.min(b) - 1.0
        });
        let squares: Vec<f64> = off.map(|off| off * off).collect();
        let mean = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        assert!(mean < 0.025 / 5.0, "{aspect}: {mean}");
    }
}
