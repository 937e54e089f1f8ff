//! Which charts a run has, and their curves.

use super::chart::{Chart, Curve, Pen};
use super::fields::chosen;
use super::units::{Units, labelled};
use crate::model::Model;
use crate::results::{HistoryRow, PairState, PathPoint, Results, State, Status};
use crate::scene::Unit;
use plotters::prelude::SeriesLabelPosition;

/// Most states in a chart of profiles.
const MOST_PROFILES: usize = 8;

/// A chart with its words.
pub(super) struct Titled {
    /// Short name, for the file.
    pub name: String,
    /// Heading.
    pub title: String,
    /// What is seen.
    pub caption: String,
    /// The chart.
    pub chart: Chart,
}

/// All charts of a run, those about the load first.
pub(super) fn charts(model: &Model, results: &Results, units: &Units) -> Vec<Titled> {
    let mut out = Vec::new();
    if !model.pairs.is_empty() {
        out.extend(against_load(
            results,
            units,
            Figure {
                name: "pressure",
                title: "Maximum contact pressure",
                label: labelled("maximum pressure", units.stress()),
                at_zero: AtZero::Proportional,
            },
            |row| row.max_pressure,
            |point| point.max_pressure,
            |y| y.max_pressure,
        ));
        out.extend(against_load(
            results,
            units,
            Figure {
                name: "half_width",
                title: "Contact half width",
                label: labelled("half width", units.length()),
                at_zero: AtZero::Constant,
            },
            |row| row.half_width,
            |point| point.half_width,
            |y| y.half_width,
        ));
        // Of solids pressure is no curve.
        let contacts = model.contacts.iter().enumerate();
        for (index, contact) in contacts.filter(|_| !model.kind.is_solid()) {
            out.extend(pressure_profiles(
                model,
                results,
                units,
                index,
                &contact.names,
            ));
        }
        out.extend(residual_depth(results, units));
        let plane = Some(model.contacts.len()).filter(|_| !model.kind.is_solid());
        for index in 0..plane.unwrap_or(0) {
            out.extend(dent_profile(model, results, units, index));
        }
    } else {
        out.extend(displacement(results, units));
    }
    out.extend(plastic_strain(results, units));
    out
}

fn load_label(units: &Units) -> String {
    labelled("load", units.load())
}

/// What becomes of a figure as the load goes to zero within an increment, in which statuses do not
/// change and all contact forces are therefore in proportion to the load.
#[derive(Clone, Copy, PartialEq, Eq)]
enum AtZero {
    /// It does, too: a pressure.
    Proportional,
    /// It stays as it is until nothing is pressed any more: an extent.
    Constant,
}

impl AtZero {
    /// The points of a path, and where the figure jumps.
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

/// What is drawn against the load.
struct Figure<'t> {
    name: &'t str,
    title: &'t str,
    label: String,
    at_zero: AtZero,
}

/// A figure of the history against the load, way there and way back, with first yield and the
/// states.
fn against_load(
    results: &Results,
    units: &Units,
    figure: Figure,
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
                // Both are in the order of the run.
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
        // Without load nothing is closed, unless an interference or a preload presses.
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
        caption: "Every accepted increment of the load program, in its order, and the way from \
                  one to the next, contact forces changing evenly."
            .to_string(),
        chart: Chart {
            labels: [load_label(units), figure.label],
            curves,
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

fn curve(label: &str, color: usize, pen: Pen, points: Vec<[f64; 2]>) -> Curve {
    Curve {
        label: label.to_string(),
        color: Some(color),
        pen,
        points,
    }
}

/// Place along a contact: an angle from the middle of its axis where the surface is a circle, else
/// the length of arc.
struct Along {
    label: String,
    of_pair: Vec<f64>,
}

impl Along {
    fn new(model: &Model, units: &Units, contact: usize) -> Self {
        let surface = &model.contacts[contact];
        let pairs = &model.pairs[surface.range.clone()];
        let circle = surface.circle.filter(|(center, radius)| {
            // On a small part of a large circle lengths say more.
            let angle = |p: [f64; 2]| (p[1] - center[1]).atan2(p[0] - center[0]);
            let ends = [pairs.first(), pairs.last()]
                .map(|p| p.map_or(0.0, |p| angle(model.mesh.in_plane(p.second))));
            *radius > 0.0 && (ends[1] - ends[0]).abs() > 20f64.to_radians()
        });
        match circle {
            Some((center, _)) => Along {
                label: "angle on the contact circle [°]".to_string(),
                of_pair: pairs
                    .iter()
                    .map(|pair| {
                        let [x, y] = model.mesh.in_plane(pair.second);
                        (y - center[1]).atan2(x - center[0]).to_degrees()
                    })
                    .collect(),
            },
            None => {
                let begin = pairs.iter().map(|p| p.arc).fold(f64::INFINITY, f64::min);
                // From the side on which the surfaces are closest, which is where contact begins.
                let turned = pairs
                    .first()
                    .zip(pairs.last())
                    .is_some_and(|(a, b)| b.gap < a.gap);
                let end = pairs.iter().map(|p| p.arc).fold(0.0, f64::max);
                Along {
                    label: labelled("distance along the contact surface", units.length()),
                    of_pair: pairs
                        .iter()
                        .map(|p| if turned { end - p.arc } else { p.arc - begin })
                        .collect(),
                }
            }
        }
    }

    /// A value of the pairs of a state along the contact, in order.
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

/// Pressure along a contact at the states, as far as anything was closed (and a little beyond).
fn pressure_profiles(
    model: &Model,
    results: &Results,
    units: &Units,
    contact: usize,
    names: &[String; 2],
) -> Option<Titled> {
    let along = Along::new(model, units, contact);
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
    let mut curves: Vec<Curve> = states
        .iter()
        .enumerate()
        .map(|(i, state)| {
            let points = along.curve(model, contact, &state.pairs, |pair| pair.pressure);
            // The way back in dashes.
            let pen = if i > top { Pen::Dashed } else { Pen::Dotted };
            curve(&state.name, i, pen, points)
        })
        .collect();
    // Where nothing is pressed in any state there is nothing to see, but for one point on each
    // side.
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
    let several = model.contacts.len() > 1;
    let of = if several {
        format!(", {} on {}", names[0], names[1])
    } else {
        String::new()
    };
    Some(Titled {
        name: numbered("pressure_distribution", contact, several),
        title: format!("Contact pressure at the states{of}"),
        caption: "A dot for each pair of nodes; dashed: after the largest load.".to_string(),
        chart: Chart {
            labels: [along.label, labelled("pressure", units.stress())],
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

/// The dent against the load at which it was made.
fn residual_depth(results: &Results, units: &Units) -> Option<Titled> {
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
        caption: "The dent that the plastic strains of each state leave when all load is taken off: the largest opening of the \
                  unloaded surfaces beyond their first shape, both bodies together. The states in their order."
            .to_string(),
        chart: Chart {
            labels: [load_label(units), labelled("residual depth", units.length())],
            curves: vec![curve("", 0, Pen::Dotted, points.collect())],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// The shape of the dent, where a state without contact force shows it.
fn dent_profile(model: &Model, results: &Results, units: &Units, contact: usize) -> Option<Titled> {
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
    let along = Along::new(model, units, contact);
    let mut points = along.curve(model, contact, &free.pairs, |pair| {
        pair.gap - model.pairs[pair.pair].gap
    });
    // The pair that was farthest apart did not take part: what it shows is rigid motion.
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
            "Change of the gap in state \u{201c}{}\u{201d}, without load, downwards; both bodies together.",
            free.name
        ),
        chart: Chart {
            labels: [along.label, labelled("change of shape", units.length())],
            curves: vec![curve("", 0, Pen::Dotted, points)],
            from_zero: [false, true],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// Without contact: displacement of the loaded surface against load.
fn displacement(results: &Results, units: &Units) -> Option<Titled> {
    if results.states.len() < 2 || results.states.iter().all(|s| s.approach == 0.0) {
        return None;
    }
    let points = results.states.iter().map(|s| [s.approach, s.load]);
    Some(Titled {
        name: "displacement".to_string(),
        title: "Load against displacement".to_string(),
        caption: "Mean displacement of the loaded surface in the direction of the load; the states in their order."
            .to_string(),
        chart: Chart {
            labels: [labelled("displacement", units.length()), load_label(units)],
            curves: vec![curve(
                "",
                0,
                Pen::Dotted,
                points.collect(),
            )],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// Largest plastic strain against the load factor.
fn plastic_strain(results: &Results, units: &Units) -> Option<Titled> {
    // A prescribed displacement without contact has a load at the states only.
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
        load_label(units)
    } else {
        "load factor".to_string()
    };
    if points.iter().all(|p| p[1] == 0.0) {
        return None;
    }
    Some(Titled {
        name: "plastic_strain".to_string(),
        title: "Largest equivalent plastic strain against load".to_string(),
        caption: "Every accepted increment of the load program, in its order.".to_string(),
        chart: Chart {
            labels: [label, "largest equivalent plastic strain".to_string()],
            curves: vec![curve("", 0, Pen::Line, points)],
            from_zero: [true; 2],
            widened: 0.0,
            legend: SeriesLabelPosition::LowerRight,
        },
    })
}

/// What a load factor of 1 is, in words.
pub(super) fn factor_unit(unit: Unit) -> &'static str {
    match unit {
        Unit::Load => "a multiple of the scene's loads",
        Unit::Yield => "a multiple of the yield load",
    }
}

#[cfg(test)]
mod tests;
