//! Runs of one scene and its relatives, each made once.

use crate::analysis::Analysis;
use crate::error::Result;
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::{Flow, Observer};
use crate::reference;
use crate::results::{HistoryRow, Results};
use crate::scene::Scene;
use std::time::Instant;

/// How far a run goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// The yield load only.
    Yield,
    /// The whole load program.
    Program,
}

/// A finished run, without its fields.
#[derive(Clone)]
pub(super) struct Finished {
    pub scene: Scene,
    pub results: Results,
    pub seconds: f64,
}

impl Finished {
    /// A run that was made elsewhere.
    pub(super) fn of(scene: &Scene, results: &Results) -> Self {
        let mut results = results.clone();
        for state in &mut results.states {
            state.fields = None;
        }
        Finished {
            scene: scene.clone(),
            results,
            seconds: 0.0,
        }
    }
}

/// Finished runs, to be used again.
pub(super) struct Runs {
    backend: Backend,
    extent: Extent,
    finished: Vec<Finished>,
}

impl Runs {
    pub(super) fn new(backend: Backend, extent: Extent) -> Self {
        Runs {
            backend,
            extent,
            finished: Vec::new(),
        }
    }

    /// Keeps a run that was made elsewhere.
    pub(super) fn keep(&mut self, scene: &Scene, results: &Results, seconds: f64) {
        let run = Finished::of(scene, results);
        self.finished.push(Finished { seconds, ..run });
    }

    /// Returns the run of a scene, and whether the run was made by this call.
    ///
    /// # Errors
    /// Errors of the run; a run that ended before its program did counts as an error.
    pub(super) fn of(
        &mut self,
        scene: &Scene,
        observer: &mut dyn Observer,
    ) -> Result<(Finished, bool)> {
        if let Some(known) = self.finished.iter().find(|known| known.scene == *scene) {
            return Ok((known.clone(), false));
        }
        let started = Instant::now();
        let quiet = &mut Quiet(observer);
        let results = run(scene, self.backend, self.extent, quiet)?;
        let new = Finished {
            scene: scene.clone(),
            results,
            seconds: started.elapsed().as_secs_f64(),
        };
        self.finished.push(new.clone());
        Ok((new, true))
    }
}

/// Runs a scene without fields, unless it names places whose values are read from them.
///
/// # Errors
/// Errors of the run; a run that ended before its program did counts as an error.
pub(super) fn run(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    observer: &mut dyn Observer,
) -> Result<Results> {
    let mut bare = scene.clone();
    let has_places = scene.reference.iter().any(|entry| entry.at.is_some());
    for target in &mut bare.program.targets {
        target.fields &= has_places;
    }
    let (_, results) = analyse(Model::new(&bare)?, backend, extent, observer)?;
    match &results.incomplete {
        None => Ok(results),
        Some(incomplete) => Err(incomplete.to_error()),
    }
}

/// Analyses a model to the given extent (first yield or the whole load program) and compares the
/// results with the reference values given in its scene.
pub(super) fn analyse(
    model: Model,
    backend: Backend,
    extent: Extent,
    observer: &mut dyn Observer,
) -> Result<(Analysis, Results)> {
    let mut analysis = Analysis::new(model, backend)?;
    let mut results = match extent {
        Extent::Yield => analysis.yield_load(observer)?,
        Extent::Program => analysis.run(observer)?,
    };
    reference::compare(analysis.model(), &mut results);
    Ok((analysis, results))
}

/// Observer that passes on only the request to stop: phases, increments and warnings of another run
/// would be taken for those of the run itself.
pub(super) struct Quiet<'o>(pub &'o mut dyn Observer);

impl Observer for Quiet<'_> {
    fn increment(&mut self, _: &HistoryRow, _: f64) -> Flow {
        if self.0.stop_requested() {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }

    fn stop_requested(&self) -> bool {
        self.0.stop_requested()
    }
}
