//! The table of states as a reader sees it, on the terminal and in the report: a column for each
//! quantity that carries information in this run.

use super::Labels;
use crate::number::number;
use crate::results::{QUANTITIES, Quantity, State, Unit};
use crate::space::Space;

/// Relative difference up to which two figures of a state share one column: the table shows six
/// digits.
const SAME: f64 = 1e-6;

/// A column of a table, with a cell for each state.
pub(crate) struct TableColumn {
    /// Heading of the column, in lines.
    pub heading: &'static str,
    /// Name of the unit; empty if there is none.
    pub unit: String,
    /// A cell for each state.
    pub cells: Vec<String>,
}

/// Formats a figure of a quantity.
pub(crate) fn cell(quantity: &Quantity, value: f64) -> String {
    match quantity.is_count {
        true => format!("{value}"),
        false => number(value),
    }
}

/// Returns the columns of states. A narrow table leaves out details. If it shows contact arcs, it
/// also leaves out the half width; if it shows contact arcs or pressures at the pole, it also
/// leaves out the approach.
pub(crate) fn of_states(
    states: &[State],
    labels: &Labels,
    space: Space,
    contact: bool,
    is_narrow: bool,
) -> Vec<TableColumn> {
    let yielding = states.iter().any(|s| s.plastic_points > 0);
    let has_arc = contact && states.iter().any(|s| s.contact_arc.is_some());
    let differs = |a: f64, b: f64| (a - b).abs() > SAME * a.abs().max(b.abs());
    let is_twice = |quantity: &Quantity| {
        let twin = quantity.twin.and_then(Quantity::of);
        twin.is_some_and(|twin| {
            let [a, b] = [quantity, twin].map(|q| q.in_state.get);
            !states.iter().any(|state| differs(a(state), b(state)))
        })
    };
    let says = |quantity: &&Quantity| {
        let shown = !quantity.heading.is_empty() && quantity.scope.holds(contact, yielding);
        shown && !(is_narrow && quantity.is_detail) && !is_twice(quantity)
    };
    let shown: Vec<&Quantity> = QUANTITIES.iter().filter(says).collect();
    let is_crowded = is_narrow && (has_arc || shown.iter().any(|q| q.key == "pole_pressure"));
    let mut out = Vec::new();
    let mut add = |heading, unit, cell: &dyn Fn(&State) -> String| {
        let cells = states.iter().map(cell).collect();
        out.push(TableColumn {
            heading,
            unit: labels.unit(unit),
            cells,
        });
    };
    for quantity in shown {
        let of_state = |state: &State| cell(quantity, (quantity.in_state.get)(state));
        match quantity.key {
            "half_width" => {
                if space.is_solid() {
                    let larger =
                        |state: &State| state.patches.first().map_or(0.0, |p| p.semi_axes[0]);
                    add("larger\nhalf axis", quantity.unit, &|s| number(larger(s)));
                    add(labels.heading(quantity), quantity.unit, &of_state);
                } else if !(is_narrow && has_arc) {
                    add(labels.heading(quantity), quantity.unit, &of_state);
                }
                for (end, heading) in ["arc\nfrom\n[deg]", "arc\nto\n[deg]"]
                    .into_iter()
                    .enumerate()
                {
                    if has_arc {
                        add(heading, Unit::One, &|state| match state.contact_arc {
                            Some(arc) => format!("{:.2}", arc[end] + 0.0),
                            None => "-".to_string(),
                        });
                    }
                }
            }
            "approach" if !contact => add("displace-\nment", quantity.unit, &of_state),
            "approach" if is_crowded => {}
            _ => add(quantity.heading, quantity.unit, &of_state),
        }
    }
    out
}
