//! Tests of the stress between the sampling points, and of the search for its maximum.

use super::*;
use crate::analysis::Analysis;
use crate::analysis::program::position::Purpose;
use crate::analysis::program::run::Run;
use crate::linalg::Backend;
use crate::progress::Silent;
use crate::scene::Scene;

fn plane(recovery: Option<&mut Recovery>) -> &mut RecoveryOf<2, 4, 4, 8> {
    match recovery {
        Some(Recovery::Plane(recovery)) => recovery,
        _ => panic!("no recovery in the plane"),
    }
}

/// Far below yield the peak is the largest sample with its own place: the first of equal samples
/// whatever their round-off, and none if there is no stress.
#[test]
fn far_below_yield_the_first_of_the_largest_samples_is_the_peak() {
    let scene = Scene::load("data/scenes/thick_cylinder.toml").unwrap();
    let analysis = Analysis::new(Model::new(&scene).unwrap(), Backend::Dense).unwrap();
    let (model, mut observer) = (analysis.model(), Silent);
    let mut run = Run::new(&analysis, Purpose::Program, None, &mut observer).unwrap();
    let recovery = plane(run.zone.recovery(&run.solver, Watched::Recovered));
    let n = recovery.positions.len();
    let yield_stress = recovery.materials[0].0.yield_stress();
    let pulled = |shares: &dyn Fn(usize) -> f64| -> Samples {
        let stress = |i| [shares(i) * yield_stress, 0.0, 0.0, 0.0];
        (0..n).flat_map(stress).collect()
    };
    assert!(n > 100);
    assert_eq!(recovery.peak(model, &pulled(&|_| 0.0)), None);
    let equal = pulled(&|i| 0.5 + 1e-14 * i as f64);
    let peak = recovery.peak(model, &equal).unwrap();
    assert_eq!(peak.location, in_space(recovery.positions[0]));
    assert!((peak.ratio - 0.5).abs() < 1e-9);
    for largest in [1, 2, n / 2 + 1, n - 1] {
        let samples = pulled(&|i| if i == largest { 0.6 } else { 0.5 });
        let peak = recovery.peak(model, &samples).unwrap();
        assert_eq!(peak.location, in_space(recovery.positions[largest]));
        assert!((peak.ratio - 0.6).abs() < 1e-12);
    }
}

/// Looser searches miss no more than [`left_of_search`] reports, and need fewer values. The field
/// has its highest point between the samples.
#[test]
fn a_looser_search_misses_no_more_than_it_says() {
    let coarse = "mesh.parts.0.ring.elements=[10,10]".to_string();
    let mut scene = Scene::load_with("data/scenes/thick_cylinder.toml", &[coarse]).unwrap();
    let mut found = Vec::new();
    for gamma in [1e-2, 1e-4, 1e-8, 1e-300] {
        scene.program.gamma = gamma;
        let analysis = Analysis::new(Model::new(&scene).unwrap(), Backend::Dense).unwrap();
        let (model, mut observer) = (analysis.model(), Silent);
        let mut run = Run::new(&analysis, Purpose::Program, None, &mut observer).unwrap();
        let recovery = plane(run.zone.recovery(&run.solver, Watched::Recovered));
        let yield_stress = recovery.materials[0].0.yield_stress();
        let hill = |[x, y]: [f64; 2]| {
            let (x, y) = ((x - 93.0) / 60.0, (y - 87.0) / 70.0);
            yield_stress * (-x * x - y * y - 0.3 * x * y).exp()
        };
        let samples = recovery
            .positions
            .iter()
            .flat_map(|x| [hill(*x), 0.0, 0.0, 0.0]);
        let samples = samples.collect();
        let ratio = recovery.peak(model, &samples).unwrap().ratio;
        let kept: usize = recovery.patches.values().map(Patch::n_kept).sum();
        found.push((left_of_search(gamma), ratio, kept));
    }
    let (_, highest, _) = found[3];
    for (left, ratio, _) in &found {
        assert!(
            highest - ratio <= *left && *ratio <= highest * (1.0 + left),
            "{found:?}"
        );
    }
    assert!(found[0].2 < found[2].2 && found[2] == found[3], "{found:?}");
    assert!(found[0].0 <= 1e-2 && found[1].0 <= 1e-4 && found[2].0 <= 1e-8);
}
