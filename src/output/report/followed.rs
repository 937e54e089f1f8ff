//! Charts of the additional columns of the history: the load over the approach in every increment,
//! with the initial unloading stiffness, and the force on each set over its displacement.

use super::chart::{Chart, Pen};
use super::titled::{Titled, curve, load_label};
use crate::number::significant;
use crate::output::labels::{Labels, labelled};
use crate::results::Results;
use plotters::prelude::SeriesLabelPosition;

/// Fraction of the largest load below which a force is round-off, or a force that only keeps a body
/// in place.
const ROUND_OFF: f64 = 1e-6;

/// Returns the charts of a run; none if its history has no additional columns.
pub(super) fn charts(results: &Results, labels: &Labels) -> Vec<Titled> {
    let columns = &results.history_columns;
    let column = |name: &str| columns.iter().position(|column| column == name);
    let mut out = Vec::new();
    if let Some(approach) = column("approach") {
        let rows = results.history.iter();
        let points: Vec<[f64; 2]> = rows.map(|row| [row.measured[approach], row.load]).collect();
        let stiffness = results
            .unloading_stiffness()
            .map_or(String::new(), |stiffness| {
                let unit = match (labels.load(), labels.length()) {
                    ("", _) | (_, "") => String::new(),
                    (load, length) => format!(" {load}/{length}"),
                };
                let stiffness = significant(stiffness, 6);
                format!(" Unloading begins with a stiffness of {stiffness}{unit}.")
            });
        out.push(titled(
            "load_against_approach".to_string(),
            "Load against approach, increment by increment".to_string(),
            format!("How far the loads move the bodies towards each other.{stiffness}"),
            [labelled("approach", labels.length()), load_label(labels)],
            points,
        ));
    }
    out.extend(of_contacts(results, labels));
    let loads = results.history.iter().map(|row| row.load.abs());
    let largest = loads.fold(0.0, f64::max);
    for (number, name) in sets(columns).into_iter().enumerate() {
        for axis in ["x", "y", "z"] {
            let both = ["displacement", "force"].map(|key| column(&format!("{name}.{key}_{axis}")));
            let [Some(moved), Some(force)] = both else {
                continue;
            };
            let rows = results.history.iter();
            let points: Vec<[f64; 2]> = rows
                .map(|row| [row.measured[moved], row.measured[force]])
                .collect();
            // A set that is held or free along an axis shows only round-off there.
            let size = |k: usize| points.iter().fold(0.0f64, |m, p| m.max(p[k].abs()));
            if size(0) == 0.0 || size(1) <= ROUND_OFF * largest {
                continue;
            }
            out.push(titled(
                format!("followed_{}_{axis}", number + 1),
                format!("Force on {name} against its displacement along {axis}"),
                "Sum over the nodes of the set, and their mean, increment by increment."
                    .to_string(),
                [
                    labelled("mean displacement", labels.length()),
                    labelled("force", labels.load()),
                ],
                points,
            ));
        }
    }
    out
}

/// Draws the force of each of several contacts over its approach; a single contact carries the
/// whole load.
fn of_contacts(results: &Results, labels: &Labels) -> Vec<Titled> {
    let columns = &results.history_columns;
    let column = |name: String| columns.iter().position(|column| *column == name);
    let both = |n: usize| {
        let [approach, force] = ["approach", "force"].map(|key| format!("contact_{n}.{key}"));
        Some((n, column(approach)?, column(force)?))
    };
    let contacts: Vec<(usize, usize, usize)> = (1..).map_while(both).collect();
    if contacts.len() < 2 {
        return Vec::new();
    }
    let chart = |(n, approach, force): (usize, usize, usize)| {
        let rows = results.history.iter();
        let points = rows.map(|row| [row.measured[approach], row.measured[force]]);
        // A contact whose normals cancel has no approach.
        let points: Vec<[f64; 2]> = points.filter(|p| p[0].is_finite()).collect();
        (!points.is_empty()).then(|| {
            titled(
                format!("contact_{n}_against_approach"),
                format!("Force of contact {n} against its approach"),
                "How far its two bodies have come together as wholes, increment by increment."
                    .to_string(),
                [
                    labelled("approach", labels.length()),
                    labelled("force", labels.load()),
                ],
                points,
            )
        })
    };
    contacts.into_iter().filter_map(chart).collect()
}

/// Returns the names of the sets among the columns, in order.
fn sets(columns: &[String]) -> Vec<&str> {
    let names = columns.iter();
    names
        .filter_map(|column| column.strip_suffix(".displacement_x"))
        .collect()
}

fn titled(
    name: String,
    title: String,
    caption: String,
    labels: [String; 2],
    points: Vec<[f64; 2]>,
) -> Titled {
    Titled {
        name,
        title,
        caption,
        chart: Chart {
            labels,
            curves: vec![curve("", 0, Pen::Line, points)],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    }
}
