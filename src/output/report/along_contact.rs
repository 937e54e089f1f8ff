//! Charts along a contact of a plane model: pressures at the states, and the shape of the dent.

use super::chart::{Chart, ChartCurve, Pen};
use super::fields::chosen;
use super::titled::{Titled, curve};
use super::window::mirrors;
use crate::model::Model;
use crate::output::labels::{Labels, labelled};
use crate::reference::hertz_pressure;
use crate::results::{PairState, Results, State, Status};
use plotters::prelude::SeriesLabelPosition;

/// Largest number of states in a chart of profiles.
const MOST_PROFILES: usize = 8;
/// Number of straight pieces in the curve of a reference solution.
const PIECES: usize = 60;

/// Positions along a contact: the angle from the middle of its axis if the surface is a circle,
/// else the arc length.
struct Along {
    label: String,
    is_angle: bool,
    of_pair: Vec<f64>,
}

impl Along {
    fn new(model: &Model, labels: &Labels, contact: usize) -> Self {
        let surface = &model.contacts[contact];
        let pairs = &model.pairs[surface.range.clone()];
        let circle = surface.circle.filter(|(center, radius)| {
            // On a small part of a large circle the arc length is more useful than the angle.
            let angle = |p: [f64; 2]| (p[1] - center[1]).atan2(p[0] - center[0]);
            let ends = [pairs.first(), pairs.last()]
                .map(|p| p.map_or(0.0, |p| angle(model.mesh.in_plane(p.slave))));
            *radius > 0.0 && (ends[1] - ends[0]).abs() > 20f64.to_radians()
        });
        match circle {
            Some((center, _)) => Along {
                is_angle: true,
                label: "angle on the contact circle [°]".to_string(),
                of_pair: pairs
                    .iter()
                    .map(|pair| {
                        let [x, y] = model.mesh.in_plane(pair.slave);
                        (y - center[1]).atan2(x - center[0]).to_degrees()
                    })
                    .collect(),
            },
            None => {
                let begin = pairs.iter().map(|p| p.arc).fold(f64::INFINITY, f64::min);
                // The arc length counts from the side on which the surfaces are closest, because
                // contact begins there.
                let turned = pairs
                    .first()
                    .zip(pairs.last())
                    .is_some_and(|(a, b)| b.gap < a.gap);
                let end = pairs.iter().map(|p| p.arc).fold(0.0, f64::max);
                Along {
                    is_angle: false,
                    label: labelled("distance along the contact surface", labels.length()),
                    of_pair: pairs
                        .iter()
                        .map(|p| if turned { end - p.arc } else { p.arc - begin })
                        .collect(),
                }
            }
        }
    }

    /// Returns a value of the pairs of a state along the contact, in order.
    fn curve(
        &self,
        model: &Model,
        contact: usize,
        pairs: &[PairState],
        value: impl Fn(&PairState) -> f64,
    ) -> Vec<[f64; 2]> {
        let range = model.contacts[contact].range.clone();
        let mut points: Vec<[f64; 2]> = pairs
            .iter()
            .filter(|pair| range.contains(&pair.pair))
            .map(|pair| [self.of_pair[pair.pair - range.start], value(pair)])
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }
}

/// Draws the pressure along a contact at the states, over the range in which any pair was closed
/// (and a little beyond).
pub(super) fn pressure_profiles(
    model: &Model,
    results: &Results,
    labels: &Labels,
    contact: usize,
    names: &[String; 2],
) -> Option<Titled> {
    let along = Along::new(model, labels, contact);
    let closed = |state: &State| {
        state
            .pairs
            .iter()
            .any(|p| p.contact == contact && p.status == Status::Closed)
    };
    let of_interest = |state: &State| closed(state);
    let shown = chosen(&results.states, MOST_PROFILES, of_interest);
    let states: Vec<&State> = shown.iter().map(|&i| &results.states[i]).collect();
    let top = (0..states.len()).max_by(|&a, &b| states[a].load.total_cmp(&states[b].load))?;
    let mut curves: Vec<ChartCurve> = states
        .iter()
        .enumerate()
        .map(|(i, state)| {
            let points = along.curve(model, contact, &state.pairs, |pair| pair.pressure);
            // Unloading is drawn dashed.
            let pen = if i > top { Pen::Dashed } else { Pen::Dotted };
            curve(&state.name, i, pen, points)
        })
        .collect();
    // The chart shows the range in which pairs press in any state, with a margin on either side;
    // the rest is left out.
    let pressed: Vec<f64> = curves
        .iter()
        .flat_map(|c| &c.points)
        .filter(|p| p[1] > 0.0)
        .map(|p| p[0])
        .collect();
    let low = pressed.iter().copied().fold(f64::INFINITY, f64::min);
    let high = pressed.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let room = 0.15 * (high - low);
    for curve in &mut curves {
        curve
            .points
            .retain(|p| p[0] >= low - room && p[0] <= high + room);
    }
    let elastic = states
        .iter()
        .rev()
        .find_map(|state| Some((state, elastic_pressure(model, state)?)));
    let mut caption = "A dot for each pair of nodes; dashed: after the largest load.".to_string();
    if let Some((state, points)) = elastic.filter(|_| !along.is_angle) {
        caption.push_str(&format!(
            " The grey line is Hertz\u{2019}s pressure under the load of \u{201c}{}\u{201d}.",
            state.name
        ));
        curves.push(ChartCurve {
            label: "Hertz".to_string(),
            color: None,
            pen: Pen::Line,
            points,
        });
    }
    let several = model.contacts.len() > 1;
    let of = if several {
        format!(", {} on {}", names[0], names[1])
    } else {
        String::new()
    };
    Some(Titled {
        name: numbered("pressure_distribution", contact, several),
        title: format!("Contact pressure at the states{of}"),
        caption,
        chart: Chart {
            labels: [along.label, labelled("pressure", labels.stress())],
            widened: if curves.len() > 3 { 0.4 } else { 0.2 },
            curves,
            from_zero: [false, true],
            legend: SeriesLabelPosition::UpperRight,
        },
    })
}

fn numbered(name: &str, contact: usize, several: bool) -> String {
    if several {
        format!("{name}_{}", contact + 1)
    } else {
        name.to_string()
    }
}

/// Draws the shape of the dent if a state without contact force shows it.
pub(super) fn dent_profile(
    model: &Model,
    results: &Results,
    labels: &Labels,
    contact: usize,
) -> Option<Titled> {
    let largest = results
        .states
        .iter()
        .fold(0.0f64, |m, s| m.max(s.contact_force));
    let free = results
        .states
        .iter()
        .rev()
        .find(|state| state.residual_depth > 0.0 && state.contact_force <= 1e-9 * largest)?;
    let range = model.contacts[contact].range.clone();
    let pairs = &model.pairs[range.clone()];
    if pairs.iter().any(|p| p.interference != 0.0) {
        return None;
    }
    let along = Along::new(model, labels, contact);
    let mut points = along.curve(model, contact, &free.pairs, |pair| {
        pair.gap - model.pairs[pair.pair].gap
    });
    // The pair with the largest initial gap took no part in the contact: its change of gap is rigid
    // motion.
    let outermost = range
        .clone()
        .max_by(|&a, &b| model.pairs[a].gap.total_cmp(&model.pairs[b].gap))?;
    let outermost = free.pairs.iter().find(|p| p.pair == outermost)?;
    let level = outermost.gap - model.pairs[outermost.pair].gap;
    for p in &mut points {
        p[1] = level - p[1];
    }
    let several = model.contacts.len() > 1;
    Some(Titled {
        name: numbered("dent", contact, several),
        title: "Shape of the dent".to_string(),
        caption: format!(
            "Change of the gap in state \u{201c}{}\u{201d}, without load, downwards; both bodies \
             together.",
            free.name
        ),
        chart: Chart {
            labels: [along.label, labelled("change of shape", labels.length())],
            curves: vec![curve("", 0, Pen::Dotted, points)],
            from_zero: [false, true],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// Returns Hertz's pressure for a state in which nothing has yielded, if the model is a half model
/// with one contact.
fn elastic_pressure(model: &Model, state: &State) -> Option<Vec<[f64; 2]>> {
    let is_alone = model.contacts.len() == 1 && model.materials.len() == 2;
    let compares = state.plastic_points == 0 && is_alone && mirrors(model)[0];
    compares.then(|| hertz_pressure(model, state.contact_force, PIECES))?
}
