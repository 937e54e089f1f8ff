//! How patches of contact are read off the pressures, apart from how good these are.

use crate::support::{close, either, parse, run_on};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::scene::Scene;
use std::f64::consts::PI;

/// Hertz' pressure `p0 sqrt(1 - (x/a)^2 - (y/b)^2)` carries `P = 2/3 p0 A`: the area of an elastic
/// patch follows from load and largest pressure of the same run. It is read to order h^2, with four
/// elements over the smaller half axis to 1/16 (thorough: six, 1/36), whether faces are as oblong
/// as the patch (half axes 2:1) or less so (9:1, faces 4:1).
#[test]
fn areas_agree_with_the_load_and_the_largest_pressure() {
    for name in ["crossed_cylinders", "ball_in_groove"] {
        let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let n = either(4, 6);
        let square = 1.0 / (n * n) as f64;
        let changes = [
            format!("mesh.curved_bodies.resolution={n}"),
            "mesh.curved_bodies.far_size=8".to_string(),
            "mesh.curved_bodies.growth=1.7".to_string(),
            "program.targets=[{ load_factor = 1.0 }]".to_string(),
        ];
        let scene = Scene::load_with(&path, &changes).unwrap();
        let mut analysis = Analysis::new(Model::new(&scene).unwrap(), Backend::default()).unwrap();
        let results = analysis.run(&mut Silent).unwrap();
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
    for (supports, times, symmetry) in [
        (corner, [1.0, 1.0], 1),
        (apart, [1.0, 1.0], 1),
        (one, [2.0, 1.0], 2),
        (faces, [2.0, 2.0], 4),
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
    }
}
