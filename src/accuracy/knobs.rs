//! The knobs that a user may turn, and the settings of them that a study tries.
//!
//! A study starts from the scene's own settings and turns one knob at a time. The mesh is an
//! exception: it is refined with every element shape, and once more with loose tolerances, because
//! cost and accuracy depend first of all on the mesh.

use super::companions::{Level, member};
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::mesh::Shape;
use crate::mesh::generate::Family;
use crate::scene::{PlasticIteration, Scene, Stepping};

/// Ratio of neighbouring element sizes in a series of meshes.
const STEP: f64 = std::f64::consts::SQRT_2;
/// The finest mesh has this many times as many elements along a line as the scene's.
const FINEST: f64 = 2.0;
/// Tolerances of the plastic iteration that are tried.
const TOLERANCES: [f64; 4] = [1e-3, 1e-4, 1e-6, 1e-8];
/// Tolerances of contact events that are tried.
const GAMMAS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-6];
/// Numbers of increments per target that are tried.
const STEPS: [usize; 5] = [2, 5, 10, 20, 40];
/// Path errors that are tried with `stepping = "auto"`.
const PATH_ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Tolerance and gamma of the series of meshes with loose tolerances.
const LOOSE: f64 = 1e-4;

/// A setting that a study changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Knob {
    /// Mesh resolution of a generator.
    Resolution,
    /// Element shape, over all resolutions.
    Element,
    /// Increments from event to event, by a path error, or `n` fixed steps.
    Stepping,
    /// Tolerance of the plastic iteration.
    Tolerance,
    /// Tolerance of contact events.
    Gamma,
    /// Acceleration of the plastic iteration.
    Algorithm,
    /// Backend that factors the stiffness.
    Backend,
}

impl Knob {
    /// All knobs of a study.
    pub const ALL: [Knob; 7] = [
        Knob::Resolution,
        Knob::Element,
        Knob::Stepping,
        Knob::Tolerance,
        Knob::Gamma,
        Knob::Algorithm,
        Knob::Backend,
    ];

    /// The name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Knob::Resolution => "resolution",
            Knob::Element => "element",
            Knob::Stepping => "stepping",
            Knob::Tolerance => "tolerance",
            Knob::Gamma => "gamma",
            Knob::Algorithm => "algorithm",
            Knob::Backend => "backend",
        }
    }

    /// Finds the knob with a name.
    ///
    /// # Errors
    /// `Input` with the names that exist.
    pub fn from_name(name: &str) -> Result<Knob> {
        let known = Knob::ALL.map(Knob::name).join(", ");
        Knob::ALL
            .into_iter()
            .find(|k| k.name() == name)
            .ok_or_else(|| Error::input(format!("unknown knob `{name}`; there are {known}")))
    }
}

/// A setting to run.
#[derive(Debug, Clone)]
pub struct Setting {
    /// The curve that the setting belongs to: `quad4`, `quad4, tolerances 1e-4`, `stepping`, ...
    pub series: String,
    /// The knob that is turned.
    pub knob: Knob,
    /// New value of the setting, in words; the value for `--set` if that has such a key.
    pub value: String,
    /// Element size over that of the scene.
    pub ratio: f64,
    /// The scene with this setting.
    pub scene: Scene,
    /// The backend that solves.
    pub backend: Backend,
}

/// The settings of a study: `levels` meshes in a series, the finest twice as fine as the scene's.
/// The other knobs are turned on the scene's own mesh.
pub fn settings(scene: &Scene, backend: Backend, knobs: &[Knob], levels: usize) -> Vec<Setting> {
    let mut out = of_meshes(scene, backend, knobs, levels);
    // Up to first yield there is no plastic iteration and no path, so their settings change
    // nothing.
    if scene.any_can_yield() && scene.program.targets.iter().any(|t| !t.first_yield) {
        out.extend(of_path(scene, backend, knobs));
    }
    let other = match backend {
        Backend::Dense => Backend::default(),
        _ => Backend::Dense,
    };
    if other != backend && knobs.contains(&Knob::Backend) {
        let name = other.name().to_string();
        out.push(turned(Knob::Backend, name, scene.clone(), other));
    }
    out
}

/// Settings of the series of meshes: first the scene's element, then the same element with loose
/// tolerances, then other elements.
fn of_meshes(scene: &Scene, backend: Backend, knobs: &[Knob], levels: usize) -> Vec<Setting> {
    let own = scene.mesh.shape();
    let name = own.map_or("mesh", Shape::name);
    let mut out = Vec::new();
    if knobs.contains(&Knob::Resolution) {
        series(scene, backend, Knob::Resolution, name, levels, &mut out);
        if scene.any_can_yield() {
            let mut loose = scene.clone();
            loose.analysis.tolerance = loose.analysis.tolerance.max(LOOSE);
            loose.program.gamma = loose.program.gamma.max(LOOSE);
            let name = format!("{name}, tolerances {LOOSE:e}");
            series(&loose, backend, Knob::Resolution, &name, levels, &mut out);
        }
    } else {
        out.push(Setting {
            series: name.to_string(),
            value: scene.mesh.words(),
            ..turned(Knob::Resolution, String::new(), scene.clone(), backend)
        });
    }
    if knobs.contains(&Knob::Element) && own.is_some() {
        let others = [Shape::Quad4, Shape::Quad8, Shape::Tri3, Shape::Tri6];
        for shape in others.into_iter().filter(|shape| own != Some(*shape)) {
            let mut other = scene.clone();
            other.mesh.set_shape(shape);
            // Quadratic elements have three times the freedoms: the finest levels are left out.
            let mut all = Vec::new();
            series(
                &other,
                backend,
                Knob::Element,
                shape.name(),
                levels,
                &mut all,
            );
            let finest = if shape.is_quadratic() { 2 } else { 0 };
            out.extend(all.into_iter().skip(finest));
        }
    }
    out
}

/// A series of meshes, finest first.
fn series(
    scene: &Scene,
    backend: Backend,
    knob: Knob,
    name: &str,
    levels: usize,
    out: &mut Vec<Setting>,
) {
    for ratio in ratios(scene, levels) {
        // At ratio 1 the scene itself is taken, unchanged: making a member of its family would
        // round its numbers of elements.
        let level = if (ratio - 1.0).abs() < 1e-9 {
            Ok(Level {
                scene: scene.clone(),
                ratio: 1.0,
            })
        } else {
            member(scene, ratio)
        };
        let Ok(Level { scene, ratio }) = level else {
            continue;
        };
        let is_same = |s: &Setting| s.series == name && (s.ratio - ratio).abs() < 1e-9;
        if !out.iter().any(is_same) {
            let value = scene.mesh.words();
            out.push(Setting {
                series: name.to_string(),
                ratio,
                ..turned(knob, value, scene, backend)
            });
        }
    }
}

/// Element sizes of a series, finest first. A mesh from a file can only be cut in halves; its sizes
/// cover the same range.
fn ratios(scene: &Scene, levels: usize) -> Vec<f64> {
    let last = levels.max(1) as i32 - 1;
    if scene.mesh.file.is_none() {
        return (0..=last).map(|i| STEP.powi(i) / FINEST).collect();
    }
    let range = (f64::from(last) * STEP.log2()).floor() as i32;
    (0..=range).map(|i| 0.5f64.powi(range - i)).collect()
}

/// Settings of tolerances, increments and algorithms.
fn of_path(scene: &Scene, backend: Backend, knobs: &[Knob]) -> Vec<Setting> {
    let mut out = Vec::new();
    let mut turn = |knob: Knob, value: String, change: &dyn Fn(&mut Scene)| {
        if knobs.contains(&knob) {
            let mut other = scene.clone();
            change(&mut other);
            out.push(turned(knob, value, other, backend));
        }
    };
    for tolerance in TOLERANCES {
        turn(Knob::Tolerance, format!("{tolerance:e}"), &|s| {
            s.analysis.tolerance = tolerance
        });
    }
    for gamma in GAMMAS.into_iter().filter(|_| !scene.contact.is_empty()) {
        turn(Knob::Gamma, format!("{gamma:e}"), &|s| {
            s.program.gamma = gamma
        });
    }
    for steps in STEPS {
        turn(Knob::Stepping, format!("{steps} steps"), &|s| {
            s.program.stepping = Stepping::Steps;
            s.program.steps = steps;
        });
    }
    for path_error in PATH_ERRORS {
        turn(Knob::Stepping, format!("path error {path_error:e}"), &|s| {
            s.program.stepping = Stepping::Auto;
            s.program.path_error = path_error;
        });
    }
    if scene.stepping() != Stepping::Events {
        let events = |s: &mut Scene| s.program.stepping = Stepping::Events;
        turn(Knob::Stepping, "events".to_string(), &events);
    }
    for (value, algorithm) in [
        ("newton", PlasticIteration::Newton),
        ("anderson", PlasticIteration::Anderson),
        ("plain", PlasticIteration::Plain),
    ] {
        if algorithm != scene.analysis.plastic_iteration {
            let change = |s: &mut Scene| s.analysis.plastic_iteration = algorithm;
            turn(Knob::Algorithm, value.to_string(), &change);
        }
    }
    out
}

/// A setting on the scene's own mesh.
fn turned(knob: Knob, value: String, scene: Scene, backend: Backend) -> Setting {
    Setting {
        series: knob.name().to_string(),
        knob,
        value,
        ratio: 1.0,
        scene,
        backend,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        Scene::parse(text, "scene.toml").unwrap()
    }

    #[test]
    fn one_knob_is_turned_at_a_time() {
        let scene = scene();
        let all = settings(&scene, Backend::Dense, &Knob::ALL, 4);
        let ratios: Vec<f64> = all
            .iter()
            .filter(|s| s.series == "quad4")
            .map(|s| s.ratio)
            .collect();
        // 32, 22.6, 16 and 11.3 elements, rounded.
        assert_eq!(ratios, [0.5, 16.0 / 23.0, 1.0, 16.0 / 11.0]);
        let mut seen: Vec<Knob> = all.iter().map(|s| s.knob).collect();
        seen.dedup();
        assert!(Knob::ALL.iter().all(|k| *k == Knob::Backend
            && Backend::default() == Backend::Dense
            || seen.contains(k)));
        let gamma = all.iter().find(|s| s.knob == Knob::Gamma).unwrap();
        assert_eq!(gamma.scene.analysis.tolerance, scene.analysis.tolerance);
        assert_eq!((gamma.scene.program.gamma, gamma.ratio), (1e-2, 1.0));
    }

    #[test]
    fn an_elastic_scene_has_no_plastic_knobs() {
        let mut scene = scene();
        for material in scene.materials.values_mut() {
            material.yield_stress = None;
        }
        let all = settings(
            &scene,
            Backend::Dense,
            &[Knob::Tolerance, Knob::Gamma, Knob::Stepping],
            4,
        );
        assert_eq!(all.len(), 1);
    }

    #[test]
    fn knobs_have_names() {
        for knob in Knob::ALL {
            assert_eq!(Knob::from_name(knob.name()).unwrap(), knob);
        }
        let error = Knob::from_name("mesh").unwrap_err();
        assert!(error.message().contains("`mesh`") && error.message().contains("resolution"));
    }
}
