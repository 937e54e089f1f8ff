//! Charts with their titles, and helpers that all their curves share.

use super::chart::{Chart, ChartCurve, Pen};
use crate::output::labels::{Labels, labelled};

/// A chart with its title and caption.
pub(super) struct Titled {
    /// Short name, for the file.
    pub name: String,
    /// Heading above the chart.
    pub title: String,
    /// Caption that says what the chart shows.
    pub caption: String,
    /// The chart itself.
    pub chart: Chart,
}

/// Returns the label of an axis of loads.
pub(super) fn load_label(labels: &Labels) -> String {
    labelled("load", labels.load())
}

/// Returns a curve in one of the colours.
pub(super) fn curve(label: &str, color: usize, pen: Pen, points: Vec<[f64; 2]>) -> ChartCurve {
    ChartCurve {
        label: label.to_string(),
        color: Some(color),
        pen,
        points,
    }
}
