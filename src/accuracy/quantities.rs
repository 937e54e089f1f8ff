//! The quantities that a run reports, by their paths in `summary.json`.

use crate::results::{self, EdgeReading, Estimated, QUANTITIES, Results, Scope, State};
use std::collections::BTreeMap;

/// A reported quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// `yield.KEY`, `states.NAME.KEY`, or of a part of a state `states.NAME.PART.KEY`.
    pub path: String,
    /// Name of the state; `None` for first yield.
    pub state: Option<String>,
    /// What the quantity is: KEY, or for a part what it is of the part, such as `"body dent"`.
    pub kind: &'static str,
    /// Value of the quantity in the unit of the run.
    pub value: f64,
    /// The largest size of quantities of this kind in the run, against which the error is measured.
    pub scale: f64,
    /// Error of reading half widths and areas off the pressures; 0 for other quantities.
    pub reading: f64,
    /// Least error of the quantity: one layer of Gauss points for plastic zones, the part between
    /// the outermost points and the surface for plastic strains, 0 for others.
    pub least: f64,
}

impl Quantity {
    /// Whether it is a figure of a part of a state.
    pub fn is_of_part(&self) -> bool {
        PARTS.contains(&self.kind)
    }
}

/// Kinds of figures of the parts of a state: of bodies, contacts, patches, sets and places.
const PARTS: [&str; 12] = [
    BODY_DENT,
    CONTACT_FORCE,
    CONTACT_APPROACH,
    CONTACT_AREA,
    PATCH_FORCE,
    PATCH_PRESSURE,
    PATCH_HALF_AXIS,
    PLACE_DISPLACEMENT,
    PLACE_PRESSURE,
    PLACE_STRESS,
    SET_DISPLACEMENT,
    SET_FORCE,
];
const BODY_DENT: &str = "body dent";
pub(super) const CONTACT_FORCE: &str = "contact force";
const CONTACT_APPROACH: &str = "contact approach";
const CONTACT_AREA: &str = "contact area";
const PATCH_FORCE: &str = "patch force";
const PATCH_PRESSURE: &str = "patch pressure";
const PATCH_HALF_AXIS: &str = "patch half axis";
const PLACE_DISPLACEMENT: &str = "displacement at a place";
const PLACE_PRESSURE: &str = "pressure at a place";
const PLACE_STRESS: &str = "stress at a place";
const SET_DISPLACEMENT: &str = "set displacement";
const SET_FORCE: &str = "set force";

/// How the error of the quantities of a key is estimated.
fn estimated(key: &str) -> Option<Estimated> {
    results::Quantity::of(key)?.estimated
}

/// Whether a demand on all quantities holds for those of this kind.
pub(super) fn is_demanded_with_all(kind: &str) -> bool {
    estimated(kind).is_none_or(|estimated| estimated.in_all)
}

/// Formal order of convergence. The displacements have the degree of the elements plus one (G.
/// Strang, G. J. Fix, *An Analysis of the Finite Element Method*, Prentice-Hall 1973, chapter 3).
/// Values at single Gauss points are of first order, since the nearest point lies a share of an
/// element away from the place sought.
pub(super) fn formal_order(key: &str, degree: usize) -> f64 {
    match estimated(key) {
        Some(estimated) if estimated.is_of_points => 1.0,
        _ => degree.max(1) as f64 + 1.0,
    }
}

/// Error that the reading of a contact's edge leaves in a quantity: in the half width, and in the
/// area, which grows at most with the square of the half width.
fn read_with(key: &str, value: f64, (width, reading): (f64, &EdgeReading)) -> f64 {
    match key {
        "half_width" => reading.error,
        "contact_area" if width > 0.0 => 2.0 * value * reading.error / width,
        _ => 0.0,
    }
}

/// All quantities of a run whose error is estimated, as far as the scene has contact and yields:
/// the quantities at first yield, then those of each state.
pub fn quantities(results: &Results) -> Vec<Quantity> {
    let contact = results.sizes.contact_pairs > 0;
    let plastic = results.states.iter().any(|s| s.plastic_points > 0);
    let known = |scope: Scope| {
        let of_scope = QUANTITIES.iter().filter(move |q| q.scope == scope);
        of_scope.filter(|quantity| quantity.estimated.is_some())
    };
    let scopes = Scope::ALL.into_iter();
    let known: Vec<_> = (scopes.filter(|scope| scope.holds(contact, plastic)))
        .flat_map(known)
        .collect();
    let mut out: Vec<Quantity> = Vec::new();
    let mut add =
        |state: Option<&str>, key: &'static str, value: f64, [reading, least]: [f64; 2]| {
            if value.is_finite() {
                out.push(Quantity {
                    path: match state {
                        Some(state) => format!("states.{state}.{key}"),
                        None => format!("yield.{key}"),
                    },
                    state: state.map(str::to_string),
                    kind: key,
                    value,
                    scale: 0.0,
                    reading,
                    least,
                });
            }
        };
    for quantity in &known {
        if let (Some(first), Some(field)) = (&results.first_yield, quantity.at_yield) {
            let value = (field.get)(first);
            let width = (first.half_width, &first.half_width_reading);
            let reading = read_with(quantity.key, value, width);
            add(None, quantity.key, value, [reading, 0.0]);
        }
    }
    for state in &results.states {
        // What the scene gives has no error.
        let is_open = |quantity: &&&results::Quantity| match quantity.key {
            "load" => !state.load_is_given,
            "approach" => !state.approach_is_given,
            _ => true,
        };
        for quantity in known.iter().filter(is_open) {
            let value = (quantity.in_state.get)(state);
            let least = match quantity.key {
                "plastic_zone_size" => state.plastic_zone_layer,
                "max_equivalent_plastic_strain" => state.plastic_strain_reading,
                _ => 0.0,
            };
            let width = (state.half_width, &state.half_width_reading);
            let reading = read_with(quantity.key, value, width);
            add(Some(&state.name), quantity.key, value, [reading, least]);
        }
    }
    out.extend(
        results
            .states
            .iter()
            .flat_map(|state| of_parts(state, results)),
    );
    out.extend(at_places(results));
    let mut scales: BTreeMap<&str, f64> = BTreeMap::new();
    for quantity in &out {
        let scale = scales.entry(quantity.kind).or_insert(0.0);
        *scale = scale.max(quantity.value.abs());
    }
    for quantity in &mut out {
        quantity.scale = scales[quantity.kind];
    }
    out
}

/// Figures of the parts of a state: the dents of bodies if several bodies have one, the forces of
/// contacts if there are several, the patches of a solid (the strongest first), and the columns
/// that the scene adds to the history.
fn of_parts(state: &State, results: &Results) -> Vec<Quantity> {
    let mut out: Vec<Quantity> = Vec::new();
    let mut add = |part: String, kind: &'static str, value: f64| {
        if value.is_finite() {
            out.push(Quantity {
                path: format!("states.{}.{part}", state.name),
                state: Some(state.name.clone()),
                kind,
                value,
                scale: 0.0,
                reading: 0.0,
                least: 0.0,
            });
        }
    };
    let dents = &state.residual_depth_by_body;
    if dents.iter().filter(|dent| **dent != 0.0).count() > 1 {
        for (body, &dent) in results.bodies.iter().zip(dents) {
            add(format!("residual_depth_by_body.{body}"), BODY_DENT, dent);
        }
    }
    let mut forces: BTreeMap<usize, f64> = BTreeMap::new();
    for pair in &state.pairs {
        *forces.entry(pair.contact).or_insert(0.0) += pair.force;
    }
    let all: f64 = forces.values().sum();
    if forces.len() > 1 && all > 0.0 {
        for (contact, force) in forces {
            let force = state.contact_force * force / all;
            add(
                format!("contact_{}.force", contact + 1),
                CONTACT_FORCE,
                force,
            );
        }
    }
    for (number, patch) in state.patches.iter().enumerate() {
        let of = format!("patches.{}", number + 1);
        add(format!("{of}.force"), PATCH_FORCE, patch.force);
        add(
            format!("{of}.max_pressure"),
            PATCH_PRESSURE,
            patch.max_pressure,
        );
        for (axis, half) in patch.semi_axes.into_iter().enumerate() {
            add(
                format!("{of}.semi_axes.{}", axis + 1),
                PATCH_HALF_AXIS,
                half,
            );
        }
    }
    let last = state.increments.checked_sub(1);
    let row = last.and_then(|last| results.history.get(last));
    let columns = results.history_columns.iter();
    for (column, &value) in columns.zip(row.iter().flat_map(|row| &row.measured)) {
        if let Some(kind) = kind_of_column(column) {
            add(format!("history.{column}"), kind, value);
        }
    }
    out
}

/// Values at the places of the scene's reference values.
fn at_places(results: &Results) -> Vec<Quantity> {
    let rows = (1..).zip(&results.reference);
    let known = rows.filter_map(|(number, row)| {
        let (state, key) = row.quantity.strip_prefix("states.")?.rsplit_once('.')?;
        let kind = match key {
            "pressure" => PLACE_PRESSURE,
            _ if key.starts_with("displacement_") => PLACE_DISPLACEMENT,
            _ if key.starts_with("stress_") => PLACE_STRESS,
            _ => return None,
        };
        Some(Quantity {
            path: format!("reference.{number}.{}", row.quantity),
            state: Some(state.to_string()),
            kind,
            value: row.computed,
            scale: 0.0,
            reading: 0.0,
            least: 0.0,
        })
    });
    known
        .filter(|quantity| quantity.value.is_finite())
        .collect()
}

/// The kind of a column of the history; `None` for the approach of the loads and for forces of
/// contacts, which are figures of the state already.
fn kind_of_column(column: &str) -> Option<&'static str> {
    let (_, key) = column.rsplit_once('.')?;
    let key = key.trim_end_matches(['x', 'y', 'z']).trim_end_matches('_');
    match (key, column.starts_with("contact_")) {
        ("displacement", _) => Some(SET_DISPLACEMENT),
        ("approach", true) => Some(CONTACT_APPROACH),
        ("area", true) => Some(CONTACT_AREA),
        ("force", false) => Some(SET_FORCE),
        _ => None,
    }
}

/// The value of a quantity by its path.
pub fn value_of(quantities: &[Quantity], path: &str) -> Option<f64> {
    quantities.iter().find(|q| q.path == path).map(|q| q.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PairState, Status, YieldPoint};

    #[test]
    fn parts_of_a_state_are_quantities() {
        let pair = |contact: usize, force: f64| PairState {
            pair: contact,
            contact,
            position: [0.0; 3],
            gap: 0.0,
            force,
            area: 1.0,
            pressure: force,
            status: Status::Closed,
        };
        let results = Results {
            bodies: vec!["low".into(), "high".into()],
            states: vec![State {
                name: "a.b".into(),
                contact_force: 8.0,
                residual_depth_by_body: vec![0.3, 0.1],
                pairs: vec![pair(0, 1.0), pair(1, 3.0)],
                ..State::default()
            }],
            ..Results::default()
        };
        let parts: Vec<Quantity> = quantities(&results)
            .into_iter()
            .filter(Quantity::is_of_part)
            .collect();
        let found: Vec<(&str, f64, f64)> = parts
            .iter()
            .map(|q| (q.path.as_str(), q.value, q.scale))
            .collect();
        // The pairs are those of a quarter of the whole, whose force the state has.
        assert_eq!(
            found,
            [
                ("states.a.b.residual_depth_by_body.low", 0.3, 0.3),
                ("states.a.b.residual_depth_by_body.high", 0.1, 0.3),
                ("states.a.b.contact_1.force", 2.0, 6.0),
                ("states.a.b.contact_2.force", 6.0, 6.0),
            ]
        );
        assert!(parts.iter().all(|q| q.state.as_deref() == Some("a.b")));
    }

    #[test]
    fn quantities_follow_what_the_scene_has() {
        let mut results = Results {
            first_yield: Some(YieldPoint {
                alpha: 1.0,
                load: 5.0,
                max_pressure: 2.0,
                half_width: 0.1,
                half_width_reading: EdgeReading {
                    error: 0.01,
                    pairs: 5,
                },
                location: [0.0; 3],
                body: 0,
            }),
            states: vec![State {
                name: "pressed".into(),
                load: -10.0,
                max_pressure: f64::NAN,
                ..State::default()
            }],
            ..Results::default()
        };
        let paths =
            |r: &Results| -> Vec<String> { quantities(r).into_iter().map(|q| q.path).collect() };
        assert_eq!(
            paths(&results),
            [
                "yield.load",
                "states.pressed.load",
                "states.pressed.approach"
            ]
        );
        let all = quantities(&results);
        assert_eq!((all[0].value, all[0].scale), (5.0, 10.0));
        results.sizes.contact_pairs = 3;
        results.states[0].plastic_points = 1;
        results.states[0].half_width = 0.3;
        // A pressure that is not a number is no quantity.
        let all = quantities(&results);
        assert_eq!(all.len(), 3 + 9);
        let width = all.iter().find(|q| q.path == "yield.half_width").unwrap();
        assert_eq!((width.reading, width.scale), (0.01, 0.3));
        assert!(all.iter().filter(|q| q.reading > 0.0).count() == 1);
    }
}
