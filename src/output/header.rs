//! The head of the outputs of a run.

use super::Labels;
use crate::linalg::Backend;
use crate::model::Model;
use crate::space::Space;

/// Facts about a run that the output states in addition to its results.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunHeader {
    /// Title of the scene.
    pub scene_title: String,
    /// The file that the scene was read from; `None` if it came from no file.
    pub scene_file: Option<String>,
    /// `plane_strain`, `plane_stress`, `axisymmetric` or `solid`, as in the scene.
    pub kind: String,
    /// The backend that factored the stiffness: `cholmod`, `faer`, `mumps` or `dense`.
    pub solver: String,
    /// The processor for which the kernels of the backend's BLAS are written (`Haswell`); `None`
    /// for a backend without such kernels.
    pub kernels: Option<String>,
    /// Wall time of the whole run in seconds.
    pub wall_seconds: f64,
    /// Body names, in the order of the mesh.
    pub bodies: Vec<String>,
    /// Names of the quantities and of their units.
    pub labels: Labels,
}

impl RunHeader {
    /// The header of a run of `model`.
    pub fn new(model: &Model, backend: Backend, wall_seconds: f64) -> Self {
        RunHeader {
            scene_title: model.scene.title.clone(),
            scene_file: (model.scene.file.as_ref()).map(|file| file.display().to_string()),
            kind: model.kind.name().to_string(),
            solver: backend.name().to_string(),
            kernels: backend.kernels(),
            wall_seconds,
            bodies: model.mesh.bodies.clone(),
            labels: Labels::of(model),
        }
    }

    /// Returns the number of coordinates.
    pub(super) fn dimension(&self) -> usize {
        if self.kind == Space::Solid.name() {
            3
        } else {
            2
        }
    }

    /// Returns the name of a body by its index.
    pub(super) fn body(&self, index: usize) -> String {
        match self.bodies.get(index) {
            Some(name) => name.clone(),
            None => format!("body {}", index + 1),
        }
    }
}
