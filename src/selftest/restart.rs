//! Continuing from checkpoints.

use super::cases::{CaseFamily, Cases, scene};
use crate::analysis::Analysis;
use crate::checkpoint::Checkpoints;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::{Flow, Observer, Silent};
use crate::results::{HistoryRow, Results};
use crate::scene::Scene;

pub(super) const FAMILIES: &[CaseFamily] = &[CaseFamily {
    name: "checkpoint and restart",
    figure: "runs stopped at an increment whose rest differs in a bit",
    bound: 0.0,
    source: "the same operations on the same numbers",
    cases: stopped_and_resumed,
}];

/// Stops a run after the given increment.
struct StopAfter(usize);

impl Observer for StopAfter {
    fn increment(&mut self, row: &HistoryRow, _fraction: f64) -> Flow {
        if row.increment >= self.0 {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }
}

fn stopped_and_resumed(cases: &mut Cases) -> Result<()> {
    for text in [
        include_str!("../../data/scenes/hard/unload_reload.toml"),
        include_str!("../../data/scenes/hard/lift_off.toml"),
    ] {
        let scene = scene(text)?;
        let whole = analysis(&scene)?.run(&mut Silent)?;
        for increment in (1..whole.history.len()).step_by(4) {
            let resumed = resumed_after(&scene, increment)?;
            let differs = text_of(&whole) != text_of(&resumed);
            cases.add(f64::from(u8::from(differs)));
        }
    }
    Ok(())
}

fn resumed_after(scene: &Scene, increment: usize) -> Result<Results> {
    let folder =
        tempfile::tempdir().map_err(|cause| Error::io("write", &std::env::temp_dir(), cause))?;
    let checkpoints = Checkpoints::new(folder.path());
    analysis(scene)?.run_with_checkpoints(&checkpoints, &mut StopAfter(increment))?;
    if checkpoints.exist() {
        analysis(scene)?.resume(&checkpoints, &mut Silent)
    } else {
        // The run was stopped before the first checkpoint was written.
        analysis(scene)?.run(&mut Silent)
    }
}

fn analysis(scene: &Scene) -> Result<Analysis> {
    Analysis::new(Model::new(scene)?, Backend::default())
}

/// Formats every number as the shortest text that is read back as the same number.
fn text_of(results: &Results) -> String {
    format!(
        "{:?} {:?} {:?}",
        results.first_yield, results.history, results.states
    )
}
