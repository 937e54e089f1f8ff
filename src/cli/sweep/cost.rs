//! The predicted cost of a sweep, without running it.

use super::arguments::SweepArguments;
use crate::analysis;
use crate::cli::streams::{json, print};
use crate::cli::table::{ColumnAlignment, Table, page_width};
use crate::deck::{self, Options};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::number::{bytes, seconds};
use crate::output::sweep::{Sweep, SweepPoint};
use serde_json::json;

/// The predicted cost of a point.
struct PointCost {
    freedoms: usize,
    seconds: f64,
    bytes: f64,
    available: Option<f64>,
}

/// Prints the cost of each point and of the whole; finished points cost nothing.
///
/// # Errors
/// Errors of the model of a point; `Input` if the points that run at a time do not fit into memory.
pub(super) fn predict(arguments: &SweepArguments, sweep: &Sweep) -> Result<()> {
    let costs = sweep.points.iter().map(|point| match point.is_finished() {
        true => Ok(None),
        false => of_point(arguments, sweep, point).map(Some),
    });
    let costs = costs.collect::<Result<Vec<_>>>()?;
    let to_run = || costs.iter().flatten();
    let total: f64 = to_run().map(|cost| cost.seconds).sum();
    let most = to_run().map(|cost| cost.bytes).fold(0.0, f64::max);
    let jobs = usize::from(arguments.jobs).min(to_run().count()).max(1) as f64;
    print(&match arguments.common.json {
        true => json(&json!({
            "points": points(sweep, &costs),
            "to_run": to_run().count(),
            "predicted_run_seconds": total,
            "memory_bytes": jobs * most,
        }))?,
        false => format!(
            "{}\n{} of {} points to run: about {} of runs without their error estimates, {} at a \
             time, and {} of memory.\n",
            table(sweep, &costs).render(page_width()),
            to_run().count(),
            sweep.points.len(),
            seconds(total),
            jobs,
            bytes(jobs * most)
        ),
    })?;
    let available = to_run().filter_map(|cost| cost.available).reduce(f64::min);
    match available {
        Some(available) if jobs * most > available => Err(Error::input(format!(
            "{} are available: run fewer points at a time (--jobs), or a coarser mesh",
            bytes(available)
        ))),
        _ => Ok(()),
    }
}

fn of_point(arguments: &SweepArguments, sweep: &Sweep, point: &SweepPoint) -> Result<PointCost> {
    let common = &arguments.common;
    let options = Options {
        small_strain: common.small_strain,
        ..Options::default()
    };
    let changes = arguments.overrides(&sweep.keys, &point.values);
    let scene = deck::load_with(&common.scene, &changes, options)?;
    let within = |error: Error| error.within(&point.folder);
    let model = Model::new(&scene).map_err(within)?;
    let check = analysis::check(&model, common.solver.into()).map_err(within)?;
    Ok(PointCost {
        freedoms: model.freedoms.n,
        seconds: check.predicted_run_seconds,
        bytes: check.prediction.memory_bytes,
        available: check.available_bytes,
    })
}

fn points(sweep: &Sweep, costs: &[Option<PointCost>]) -> Vec<serde_json::Value> {
    let each = sweep.points.iter().zip(costs);
    let point = |(point, cost): (&SweepPoint, &Option<PointCost>)| {
        json!({
            "folder": point.folder,
            "finished": cost.is_none(),
            "freedoms": cost.as_ref().map(|cost| cost.freedoms),
            "predicted_run_seconds": cost.as_ref().map(|cost| cost.seconds),
            "memory_bytes": cost.as_ref().map(|cost| cost.bytes),
        })
    };
    each.map(point).collect()
}

fn table(sweep: &Sweep, costs: &[Option<PointCost>]) -> Table {
    let mut table = Table::new(&[
        (ColumnAlignment::Text, "point"),
        (ColumnAlignment::Number, "freedoms"),
        (ColumnAlignment::Number, "time"),
        (ColumnAlignment::Number, "memory"),
    ]);
    for (point, cost) in sweep.points.iter().zip(costs) {
        let figures = match cost {
            None => ["-".to_string(), "finished".to_string(), "-".to_string()],
            Some(cost) => [
                cost.freedoms.to_string(),
                seconds(cost.seconds),
                bytes(cost.bytes),
            ],
        };
        table.row(std::iter::once(point.folder.clone()).chain(figures));
    }
    table
}
