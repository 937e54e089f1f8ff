//! A model with its assembled system.

use crate::analysis::structure::starting;
use crate::assembly::{System, assemble};
use crate::deck::words;
use crate::error::Result;
use crate::linalg::Backend;
use crate::model::Model;
use std::time::Instant;

/// A model with its assembled system, ready to run.
pub struct Analysis {
    pub(super) model: Model,
    pub(super) system: System,
    pub(super) backend: Backend,
    pub(super) timings: Vec<(String, f64)>,
}

impl Analysis {
    /// Assembles the model.
    ///
    /// # Errors
    /// Errors of [`assemble`]; `Input` if the directory that the scene starts from is missing,
    /// damaged, or of another mesh or version.
    pub fn new(mut model: Model, backend: Backend) -> Result<Self> {
        let start = Instant::now();
        if model.start.is_none() {
            model.start = starting::read(&model)?;
        }
        let system = assemble(&model, backend);
        let system = system.map_err(|error| words::of_deck(&model.scene, error))?;
        let timings = vec![("assembly".to_string(), start.elapsed().as_secs_f64())];
        Ok(Analysis {
            model,
            system,
            backend,
            timings,
        })
    }

    /// The model that is analysed.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The assembled system.
    pub fn system(&self) -> &System {
        &self.system
    }
}
