//! The charts of a run, and their curves.

use super::along_contact::{dent_profile, pressure_profiles};
use super::chart::{Chart, Pen};
use super::contact_frame::ContactFrame;
use super::followed;
use super::profile;
use super::titled::{Titled, curve, load_label};
use crate::model::Model;
use crate::output::labels::{Labels, capitalised, labelled};
use crate::results::{HistoryRow, PathPoint, Results};
use plotters::prelude::SeriesLabelPosition;

/// Returns all charts of a run, those about the load first.
pub(super) fn charts(
    model: &Model,
    results: &Results,
    labels: &Labels,
    frame: Option<&ContactFrame>,
) -> Vec<Titled> {
    let mut out = Vec::new();
    if !model.pairs.is_empty() {
        out.extend(against_load(
            results,
            labels,
            LoadFigure {
                name: "pressure",
                title: "Maximum contact pressure",
                label: labelled("maximum pressure", labels.stress()),
                at_zero: AtZero::Proportional,
            },
            |row| row.max_pressure,
            |point| point.max_pressure,
            |y| y.max_pressure,
        ));
        out.extend(against_load(
            results,
            labels,
            LoadFigure {
                name: "half_width",
                title: &capitalised(labels.half_width()),
                label: labelled(labels.half_width(), labels.length()),
                at_zero: AtZero::Constant,
            },
            |row| row.half_width,
            |point| point.half_width,
            |y| y.half_width,
        ));
        // The pressure of solids is not a curve.
        let contacts = model.contacts.iter().enumerate();
        for (index, contact) in contacts.filter(|_| !model.kind.is_solid()) {
            out.extend(pressure_profiles(
                model,
                results,
                labels,
                index,
                &contact.names,
            ));
        }
        out.extend(residual_depth(results, labels));
        let plane = Some(model.contacts.len()).filter(|_| !model.kind.is_solid());
        for index in 0..plane.unwrap_or(0) {
            out.extend(dent_profile(model, results, labels, index));
        }
        out.extend(profile::chart(model, results, labels, frame));
    }
    out.extend(displacement(results, labels, !model.pairs.is_empty()));
    out.extend(followed::charts(results, labels));
    out.extend(plastic_strain(results, labels));
    out
}

/// Behaviour of a figure as the load goes to zero within an increment, in which statuses do not
/// change and all contact forces are therefore proportional to the load.
#[derive(Clone, Copy, PartialEq, Eq)]
enum AtZero {
    /// A figure that goes to zero with the load, such as a pressure.
    Proportional,
    /// A figure that stays constant until nothing is pressed any more, such as an extent.
    Constant,
}

impl AtZero {
    /// Returns the points of a path, with the jumps of the figure.
    fn path(self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut out: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
        for pair in points.windows(2) {
            let [[from, before], [to, after]] = [pair[0], pair[1]];
            match (self, before > 0.0, after > 0.0) {
                (AtZero::Constant, false, true) => out.push([from, after]),
                (AtZero::Constant, true, false) => out.push([to, before]),
                _ => {}
            }
            out.push([to, after]);
        }
        out
    }
}

/// A figure that is drawn over the load.
struct LoadFigure<'t> {
    name: &'t str,
    title: &'t str,
    label: String,
    at_zero: AtZero,
}

/// Draws a figure of the history over the load, in loading and unloading, with first yield and the
/// states.
fn against_load(
    results: &Results,
    labels: &Labels,
    figure: LoadFigure,
    value: impl Fn(&HistoryRow) -> f64,
    between: impl Fn(&PathPoint) -> f64,
    at_yield: impl Fn(&crate::results::YieldPoint) -> f64,
) -> Option<Titled> {
    let history = &results.history;
    if history.is_empty() {
        return None;
    }
    let top = (0..history.len()).max_by(|&a, &b| history[a].load.total_cmp(&history[b].load))?;
    let points = |rows: &[HistoryRow]| -> Vec<[f64; 2]> {
        let mut out = Vec::new();
        for (index, row) in rows.iter().enumerate() {
            if index > 0 {
                // The history and the path are both in the order of the run.
                let first = results
                    .path
                    .partition_point(|p| p.increment < row.increment);
                let on_the_way = results.path[first..].iter();
                let on_the_way = on_the_way.take_while(|p| p.increment == row.increment);
                out.extend(on_the_way.map(|p| [p.load, between(p)]));
            }
            out.push([row.load, value(row)]);
        }
        out
    };
    let mut loading = points(&history[..=top]);
    if history[0].load > 0.0 && results.states.iter().all(|s| s.alpha >= 0.0) {
        // Without load no pair is closed, unless an interference or a preload presses.
        let pressed = results
            .effects
            .iter()
            .any(|e| e.on && matches!(e.name.as_str(), "interference" | "preload"));
        if !pressed {
            loading.insert(0, [0.0, 0.0]);
        }
    }
    let loading = figure.at_zero.path(&loading);
    let mut curves = vec![curve("loading", 0, Pen::Line, loading)];
    if top + 1 < history.len() {
        let label = match history[top..].windows(2).all(|p| p[1].load <= p[0].load) {
            true => "unloading",
            false => "after the largest load",
        };
        let back = figure.at_zero.path(&points(&history[top..]));
        curves.push(curve(label, 1, Pen::Line, back));
    }
    if let Some(first) = &results.first_yield {
        curves.push(curve(
            "first yield",
            3,
            Pen::Dots,
            vec![[first.load, at_yield(first)]],
        ));
    }
    Some(Titled {
        name: figure.name.to_string(),
        title: format!("{} against load", figure.title),
        caption: "Every accepted increment of the load program, in order, and the way from \
                  one to the next, contact forces changing evenly."
            .to_string(),
        chart: Chart {
            labels: [load_label(labels), figure.label],
            curves,
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// Draws the depth of the dent over the load that made it.
fn residual_depth(results: &Results, labels: &Labels) -> Option<Titled> {
    let deepest = results
        .states
        .iter()
        .fold(0.0f64, |m, s| m.max(s.residual_depth));
    if deepest <= 0.0 {
        return None;
    }
    let points = results.states.iter().map(|s| [s.load, s.residual_depth]);
    Some(Titled {
        name: "residual_depth".to_string(),
        title: "Residual depth".to_string(),
        caption: "The dent that the plastic strains of each state leave when all load is taken \
                  off: the largest opening of the unloaded surfaces beyond their first shape, both \
                  bodies together. The states in order."
            .to_string(),
        chart: Chart {
            labels: [
                load_label(labels),
                labelled("residual depth", labels.length()),
            ],
            curves: vec![curve("", 0, Pen::Dotted, points.collect())],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// Draws the load over the approach of the bodies, or without contact over the displacement of the
/// loaded surface, which shows the stiffness.
fn displacement(results: &Results, labels: &Labels, has_contact: bool) -> Option<Titled> {
    if results.states.len() < 2 || results.states.iter().all(|s| s.approach == 0.0) {
        return None;
    }
    let points = results.states.iter().map(|s| [s.approach, s.load]);
    let (name, title, caption) = match has_contact {
        true => (
            "approach",
            "Load against approach",
            "How far the loads move the bodies towards each other; the states in order.",
        ),
        false => (
            "displacement",
            "Load against displacement",
            "Mean displacement of the loaded surface in the direction of the load; the states in \
             their order.",
        ),
    };
    Some(Titled {
        name: name.to_string(),
        title: title.to_string(),
        caption: caption.to_string(),
        chart: Chart {
            labels: [labelled(name, labels.length()), load_label(labels)],
            curves: vec![curve("", 0, Pen::Dotted, points.collect())],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// Draws the largest plastic strain over the load factor.
fn plastic_strain(results: &Results, labels: &Labels) -> Option<Titled> {
    // With a prescribed displacement without contact the load is known at the states only.
    let known = results.history.iter().all(|row| row.load.is_finite());
    let points: Vec<[f64; 2]> = results
        .history
        .iter()
        .map(|row| {
            let load = if known { row.load } else { row.alpha };
            [load, row.max_equivalent_plastic_strain]
        })
        .collect();
    let label = if known {
        load_label(labels)
    } else {
        "load factor".to_string()
    };
    if points.iter().all(|p| p[1] == 0.0) {
        return None;
    }
    Some(Titled {
        name: "plastic_strain".to_string(),
        title: "Largest equivalent plastic strain against load".to_string(),
        caption: "Every accepted increment of the load program, in order.".to_string(),
        chart: Chart {
            labels: [label, "largest equivalent plastic strain".to_string()],
            curves: vec![curve("", 0, Pen::Line, points)],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

#[cfg(test)]
mod tests;
