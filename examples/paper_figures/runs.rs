//! The two scenes of the paper with other targets, hardening or resolution.

use crate::Outcome;
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::{Results, State};
use brinell::scene::{Scene, Target};
use std::path::PathBuf;

/// A place under `data/`.
pub fn data(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join(path)
}

pub fn scene(name: &str) -> Outcome<Scene> {
    Ok(Scene::load(data("scenes").join(name))?)
}

/// The cylinder with linear hardening of slope `ratio * E` and another resolution.
pub fn cylinder(plastic_modulus_over_e: Option<f64>, resolution: Option<usize>) -> Outcome<Scene> {
    let mut scene = scene("cylinder_on_half_plane.toml")?;
    for material in scene.materials.values_mut() {
        if let Some(ratio) = plastic_modulus_over_e {
            (material.tangent_modulus, material.hardening_table) = (None, None);
            material.plastic_modulus = Some(ratio * material.youngs_modulus);
        }
    }
    if let (Some(resolution), Some(mesh)) = (resolution, &mut scene.mesh.cylinder_on_half_plane) {
        mesh.resolution = resolution;
    }
    Ok(scene)
}

pub fn first_yield() -> Target {
    Target {
        first_yield: true,
        ..Target::default()
    }
}

pub fn load_factor(alpha: f64, name: &str) -> Target {
    Target {
        load_factor: Some(alpha),
        name: Some(name.to_string()),
        ..Target::default()
    }
}

pub fn half_width(multiple: f64, name: &str) -> Target {
    Target {
        half_width: Some(multiple),
        name: Some(name.to_string()),
        ..Target::default()
    }
}

pub fn with_fields(target: Target) -> Target {
    Target {
        fields: true,
        ..target
    }
}

/// A finished run.
pub struct Run {
    pub analysis: Analysis,
    pub results: Results,
    /// Maximum pressure and half width at first yield.
    pub yield_pressure: f64,
    pub yield_half_width: f64,
}

impl Run {
    pub fn of(mut scene: Scene, targets: Vec<Target>) -> Outcome<Run> {
        scene.program.targets = targets;
        let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
        let results = analysis.run(&mut Silent)?;
        if let Some(end) = &results.incomplete {
            return Err(format!("{}: {}", scene.title, end.why).into());
        }
        let first = results.first_yield.ok_or("no first yield")?;
        Ok(Run {
            analysis,
            results,
            yield_pressure: first.max_pressure,
            yield_half_width: first.half_width,
        })
    }

    pub fn state(&self, name: &str) -> Outcome<&State> {
        let found = self.results.states.iter().find(|s| s.name == name);
        found.ok_or_else(|| format!("no state `{name}`").into())
    }
}
