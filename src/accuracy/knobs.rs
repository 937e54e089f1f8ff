//! What a user may turn, and the settings that a study tries.
//!
//! A study turns one knob at a time from the scene's own settings, but for the mesh, which is refined with every element shape
//! and once more with loose tolerances: work and precision both come from the mesh first.

use super::refinement::{factors, governing_count, refined};
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::mesh::Shape;
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
/// Tolerance and gamma of the series of meshes with loose tolerances.
const LOOSE: f64 = 1e-4;

/// A thing to turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Knob {
    /// Mesh resolution of a generator.
    Resolution,
    /// Element shape, over all resolutions.
    Element,
    /// Graded meshes over all resolutions: each part as fine as its share of the error asks for.
    Grading,
    /// From event to event, or `n` steps.
    Stepping,
    /// Tolerance of the plastic iteration.
    Tolerance,
    /// Tolerance of contact events.
    Gamma,
    /// Acceleration of the plastic iteration.
    Algorithm,
    /// What factors the stiffness.
    Backend,
}

impl Knob {
    /// All of them.
    pub const ALL: [Knob; 8] = [
        Knob::Resolution,
        Knob::Element,
        Knob::Grading,
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
            Knob::Grading => "grading",
            Knob::Stepping => "stepping",
            Knob::Tolerance => "tolerance",
            Knob::Gamma => "gamma",
            Knob::Algorithm => "algorithm",
            Knob::Backend => "backend",
        }
    }

    /// The knob of a name.
    ///
    /// # Errors
    /// `Input`, listing the names.
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
    /// The curve it belongs to: `quad4`, `quad4, loose`, `steps`, ...
    pub series: String,
    /// What is turned.
    pub knob: Knob,
    /// To what, in words: what `--set` takes where there is such a key.
    pub value: String,
    /// Element size over that of the scene.
    pub ratio: f64,
    /// The scene so set.
    pub scene: Scene,
    /// The backend.
    pub backend: Backend,
}

/// The settings of a study: `levels` meshes in a series, the finest twice as fine as the scene's. The other knobs are turned on the
/// scene's own mesh.
pub fn settings(scene: &Scene, backend: Backend, knobs: &[Knob], levels: usize) -> Vec<Setting> {
    // Up to first yield nothing flows: there is no iteration and no path to turn anything in.
    let plastic = scene.any_can_yield() && scene.program.targets.iter().any(|t| !t.first_yield);
    let mut out = Vec::new();
    let own = element(scene);
    let name = |shape: Option<Shape>| shape.map_or("mesh", shape_name);
    let meshes =
        |scene: &Scene, knob: Knob, series: &str, finest: usize, out: &mut Vec<Setting>| {
            for factor in factors(scene, FINEST, STEP, levels)
                .into_iter()
                .skip(finest)
            {
                // The scene itself belongs to every series, file or not.
                let made = match (factor - 1.0).abs() < 1e-9 {
                    true => Some((scene.clone(), 1.0)),
                    false => refined(scene, factor).map(|l| (l.scene, l.ratio)),
                };
                let Some((scene, ratio)) = made else { continue };
                if out
                    .iter()
                    .any(|s| s.series == series && (s.ratio - ratio).abs() < 1e-9)
                {
                    continue;
                }
                out.push(Setting {
                    series: series.to_string(),
                    knob,
                    value: resolution(&scene, ratio),
                    ratio,
                    scene,
                    backend,
                });
            }
        };
    let base = |knob: Knob, series: &str, value: String, scene: Scene, backend: Backend| Setting {
        series: series.to_string(),
        knob,
        value,
        ratio: 1.0,
        scene,
        backend,
    };
    if knobs.contains(&Knob::Resolution) {
        meshes(scene, Knob::Resolution, name(own), 0, &mut out);
        if plastic {
            let mut loose = scene.clone();
            loose.analysis.tolerance = loose.analysis.tolerance.max(LOOSE);
            loose.program.gamma = loose.program.gamma.max(LOOSE);
            let series = format!("{}, tolerances {LOOSE:e}", name(own));
            meshes(&loose, Knob::Resolution, &series, 0, &mut out);
        }
    } else {
        out.push(base(
            Knob::Resolution,
            name(own),
            resolution(scene, 1.0),
            scene.clone(),
            backend,
        ));
    }
    if knobs.contains(&Knob::Element) && own.is_some() {
        for shape in [Shape::Quad4, Shape::Quad8, Shape::Tri3, Shape::Tri6] {
            if own != Some(shape) {
                let mut other = scene.clone();
                set_element(&mut other, shape);
                // Quadratic elements bring three times the freedoms: the finest level is left out.
                let finest = usize::from(shape.n_nodes() > shape.n_corners()) * 2;
                meshes(&other, Knob::Element, shape_name(shape), finest, &mut out);
            }
        }
    }
    let mut turn = |knob: Knob, value: String, change: &dyn Fn(&mut Scene)| {
        if knobs.contains(&knob) && plastic {
            let mut other = scene.clone();
            change(&mut other);
            out.push(base(knob, knob.name(), value, other, backend));
        }
    };
    for tolerance in TOLERANCES {
        turn(Knob::Tolerance, format!("{tolerance:e}"), &|s| {
            s.analysis.tolerance = tolerance
        });
    }
    if !scene.contact.is_empty() {
        for gamma in GAMMAS {
            turn(Knob::Gamma, format!("{gamma:e}"), &|s| {
                s.program.gamma = gamma
            });
        }
    }
    for steps in STEPS {
        turn(Knob::Stepping, format!("{steps} steps"), &|s| {
            s.program.stepping = Stepping::Steps;
            s.program.steps = steps;
        });
    }
    if scene.program.stepping == Stepping::Steps {
        turn(Knob::Stepping, "events".to_string(), &|s| {
            s.program.stepping = Stepping::Events
        });
    }
    for (value, algorithm) in [
        ("newton", PlasticIteration::Newton),
        ("anderson", PlasticIteration::Anderson),
        ("plain", PlasticIteration::Plain),
    ] {
        if algorithm != scene.analysis.plastic_iteration {
            turn(Knob::Algorithm, value.to_string(), &|s| {
                s.analysis.plastic_iteration = algorithm
            });
        }
    }
    if knobs.contains(&Knob::Backend) {
        let other = match backend {
            Backend::Cholmod => Some(Backend::Dense),
            Backend::Dense if cfg!(feature = "cholmod") => Some(Backend::Cholmod),
            Backend::Dense => None,
        };
        if let Some(other) = other {
            let series = Knob::Backend.name();
            out.push(base(
                Knob::Backend,
                series,
                other.name().to_string(),
                scene.clone(),
                other,
            ));
        }
    }
    out
}

/// The series of graded meshes: `shaped` as fine, coarse and finer, as those of the scene's own series.
pub(super) fn graded(
    scene: &Scene,
    shaped: &Scene,
    backend: Backend,
    levels: usize,
) -> Vec<Setting> {
    let name = element(scene).map_or("mesh", shape_name);
    let fineness = |s: &Scene| governing_count(&s.mesh);
    let Some(lead) = fineness(scene).zip(fineness(shaped)).map(|(a, b)| a / b) else {
        return Vec::new();
    };
    let mut out: Vec<Setting> = Vec::new();
    for level in 0..levels.max(1) {
        let Some(made) = refined(shaped, lead * FINEST / STEP.powi(level as i32)) else {
            continue;
        };
        let ratio = lead * made.ratio;
        if out.iter().any(|s| (s.ratio - ratio).abs() < 1e-9) {
            continue;
        }
        out.push(Setting {
            series: format!("{name}, graded"),
            knob: Knob::Grading,
            value: resolution(&made.scene, ratio),
            ratio,
            scene: made.scene,
            backend,
        });
    }
    out
}

/// The element shape of a generated mesh.
fn element(scene: &Scene) -> Option<Shape> {
    let mesh = &scene.mesh;
    (mesh.cylinder_on_half_plane.as_ref().map(|p| p.element))
        .or(mesh.disc_in_plate.as_ref().map(|p| p.element))
        .or(mesh
            .parts
            .as_ref()
            .and_then(|p| p.first())
            .map(|p| p.element))
}

fn set_element(scene: &mut Scene, shape: Shape) {
    let mesh = &mut scene.mesh;
    if let Some(p) = &mut mesh.cylinder_on_half_plane {
        p.element = shape;
    }
    if let Some(p) = &mut mesh.disc_in_plate {
        p.element = shape;
    }
    for part in mesh.parts.iter_mut().flatten() {
        part.element = shape;
    }
}

fn shape_name(shape: Shape) -> &'static str {
    match shape {
        Shape::Tri3 => "tri3",
        Shape::Tri6 => "tri6",
        Shape::Quad4 => "quad4",
        Shape::Quad8 => "quad8",
    }
}

/// The mesh in the generator's own words.
pub(super) fn resolution(scene: &Scene, ratio: f64) -> String {
    let mesh = &scene.mesh;
    let rising = |far: Option<f64>| far.map_or(String::new(), |g| format!(", far_growth {g:.4}"));
    if let Some(p) = &mesh.cylinder_on_half_plane {
        let far = rising(p.far_growth);
        format!("resolution {}, growth {:.4}{far}", p.resolution, p.growth)
    } else if let Some(p) = &mesh.disc_in_plate {
        let far = rising(p.far_growth);
        format!("resolution {}, growth {:.4}{far}", p.resolution, p.growth)
    } else if let Some(parts) = &mesh.parts {
        let counts: Vec<String> = parts
            .iter()
            .map(|p| match (&p.block, &p.ring, &p.disc) {
                (Some(b), _, _) => format!("{} x {}", b.elements[0], b.elements[1]),
                (_, Some(r), _) => format!("{} x {}", r.elements[0], r.elements[1]),
                (_, _, Some(d)) => d.elements.to_string(),
                _ => "?".to_string(),
            })
            .collect();
        format!("elements {}", counts.join(", "))
    } else {
        format!(
            "subdivisions {}, element size {ratio:.3}",
            mesh.subdivisions
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::grading::risen;
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
        let shaped = risen(&scene);
        let graded = graded(&scene, &shaped, Backend::Dense, 4);
        assert!(graded.iter().map(|s| s.ratio).eq(ratios));
        let mut seen: Vec<Knob> = all.iter().chain(&graded).map(|s| s.knob).collect();
        seen.dedup();
        assert!(
            Knob::ALL
                .iter()
                .all(|k| *k == Knob::Backend && !cfg!(feature = "cholmod") || seen.contains(k))
        );
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
