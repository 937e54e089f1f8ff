//! How patches of contact are read off the pressures, apart from how good these are.

use crate::support::either;
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
