//! Curves against the load where contact starts and ends.

use super::*;

/// Two blocks: one increment to first yield, one further, and back to zero. Without a change of
/// contact the width of contact is that of the blocks for any load, and pressures are proportional
/// to the load.
#[test]
fn an_extent_does_not_grow_with_the_load_from_zero() {
    let row = |load: f64, half_width: f64, max_pressure: f64| HistoryRow {
        load,
        half_width,
        max_pressure,
        ..HistoryRow::default()
    };
    let results = Results {
        history: vec![
            row(500.0, 2.0, 50.0),
            row(600.0, 2.0, 60.0),
            row(100.0, 1.5, 20.0),
            row(0.0, 0.0, 0.0),
        ],
        ..Results::default()
    };
    let root = env!("CARGO_MANIFEST_DIR");
    let scene = format!("{root}/data/scenes/contact_patch.toml");
    let scene = crate::scene::Scene::load(scene).unwrap();
    let labels = Labels::of(&Model::new(&scene).unwrap());
    let points = |at_zero: AtZero, value: fn(&HistoryRow) -> f64| -> Vec<Vec<[f64; 2]>> {
        let figure = LoadFigure {
            name: "",
            title: "",
            label: String::new(),
            at_zero,
        };
        let found = against_load(&results, &labels, figure, value, |p| p.half_width, |_| 0.0);
        let curves = found.unwrap().chart.curves;
        curves.into_iter().map(|curve| curve.points).collect()
    };
    assert_eq!(
        points(AtZero::Constant, |row| row.half_width),
        [
            vec![[0.0, 0.0], [0.0, 2.0], [500.0, 2.0], [600.0, 2.0]],
            vec![[600.0, 2.0], [100.0, 1.5], [0.0, 1.5], [0.0, 0.0]],
        ]
    );
    assert_eq!(
        points(AtZero::Proportional, |row| row.max_pressure),
        [
            vec![[0.0, 0.0], [500.0, 50.0], [600.0, 60.0]],
            vec![[600.0, 60.0], [100.0, 20.0], [0.0, 0.0]],
        ]
    );
}

/// A curve that bends between two increments is drawn through the points of the path there.
#[test]
fn a_curve_goes_through_the_points_between_increments() {
    let root = env!("CARGO_MANIFEST_DIR");
    let scene = format!("{root}/data/scenes/disc_in_plate.toml");
    let coarse = "mesh.disc_in_plate.resolution=8".to_string();
    let scene = crate::scene::Scene::load_with(scene, &[coarse]).unwrap();
    let model = Model::new(&scene).unwrap();
    let labels = Labels::of(&model);
    let mut analysis =
        crate::analysis::Analysis::new(model, crate::linalg::Backend::default()).unwrap();
    let results = analysis.run(&mut crate::progress::Silent).unwrap();
    assert!(!results.path.is_empty());
    // Points lie between their rows in `alpha` and `load`, in order.
    for point in &results.path {
        let [from, to] = [point.increment - 2, point.increment - 1].map(|i| &results.history[i]);
        let within = |value: f64, a: f64, b: f64| {
            let room = 1e-9 * a.abs().max(b.abs());
            (a.min(b) - room..=a.max(b) + room).contains(&value)
        };
        assert!(within(point.alpha, from.alpha, to.alpha), "{point:?}");
        assert!(within(point.load, from.load, to.load), "{point:?}");
    }
    assert!(results.path.is_sorted_by_key(|point| point.increment));
    for chart in &charts(analysis.model(), &results, &labels, None)[..2] {
        let drawn: usize = chart.chart.curves[..2].iter().map(|c| c.points.len()).sum();
        let rows = results.history.len();
        assert!(
            drawn >= rows + results.path.len(),
            "{}: {drawn}",
            chart.name
        );
    }
}
