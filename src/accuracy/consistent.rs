//! What goes with extrapolated values, so that what is reported still agrees with itself.
//!
//! | reported | so that it is |
//! |---|---|
//! | contact force, load factor | extrapolated by the law of the load |
//! | load at a prescribed multiple of first yield's | that multiple of the reported one, with its error |
//! | multiple of first yield's load at which a target is reached | that of the two reported loads |
//! | pressure at the pole | the same share of the largest one as on the mesh: never above it |

use super::estimate::Estimate;
use super::extrapolation::extrapolate;
use super::limit::Limit;
use super::quantities::{Quantity, with_loads};
use crate::results::{OfMesh, QuantityError, Results, State};
use std::collections::BTreeMap;

/// Values that are not those of the mesh, by path.
pub(super) type Reported = BTreeMap<String, f64>;

/// Values closer than this share are the same but for round-off.
const SAME: f64 = 1e-9;

impl Estimate {
    /// What goes with a load that is replaced, by the same law. What the scene prescribes, and so is the same on all meshes, stays as it is.
    pub(super) fn add_what_goes_with(
        &self,
        results: &Results,
        load: &str,
        limit: Option<&Limit>,
        reported: &mut Reported,
    ) {
        let Some(prefix) = load.strip_suffix("load") else {
            return;
        };
        let others: Vec<_> = (self.others.iter())
            .map(|(ratio, other)| (*ratio, with_loads(other)))
            .collect();
        for key in ["alpha", "contact_force"] {
            let path = format!("{prefix}{key}");
            let Some(&own) = with_loads(results).get(&path) else {
                continue;
            };
            let mut values = vec![(1.0, own)];
            values.extend(
                (others.iter()).filter_map(|(ratio, other)| Some((*ratio, *other.get(&path)?))),
            );
            let of_mesh = match limit {
                Some(limit) if values.len() == others.len() + 1 => {
                    extrapolate(&values, [limit.order; 2]).map(|e| e.limit)
                }
                _ => None,
            };
            let increments = self.path.of(&path).unwrap_or_default().increments;
            let value = of_mesh.unwrap_or(own) + increments;
            set(reported, path, value, own);
        }
    }

    /// Lets loads that are counted in that of first yield agree with it, and pressures at the pole with the largest.
    pub(super) fn reconcile(
        &self,
        results: &Results,
        quantities: &[Quantity],
        rows: &mut [QuantityError],
        reported: &mut Reported,
    ) {
        for state in &results.states {
            self.reconcile_load(results, state, quantities, rows, reported);
            let path = |key: &str| format!("states.{}.{key}", state.name);
            if let Some(largest) = reported.get(&path("max_pressure"))
                && state.max_pressure > 0.0
            {
                // The share first: where the pole has the largest pressure it is one, to the last digit.
                let pole = state.pole_pressure / state.max_pressure * largest;
                let path = path("pole_pressure");
                if let Some(row) = rows.iter_mut().find(|row| row.quantity == path) {
                    move_to(row, pole);
                }
                reported.insert(path, pole);
            }
        }
    }

    fn reconcile_load(
        &self,
        results: &Results,
        state: &State,
        quantities: &[Quantity],
        rows: &mut [QuantityError],
        reported: &mut Reported,
    ) {
        let Some((unit, prescribed)) = self.counted(results, state) else {
            return;
        };
        let path = |key: &str| format!("states.{}.{key}", state.name);
        let find = |path: &str| quantities.iter().position(|q| q.path == path);
        let (Some(first), Some(at)) = (find("yield.load"), find(&path("load"))) else {
            return;
        };
        let scale = quantities[at].scale;
        let first = rows[first].clone();
        let row = &mut rows[at];
        if !prescribed {
            let alpha = row.value / (unit * first.value);
            set(reported, path("alpha"), alpha, state.alpha);
            return;
        }
        let times = unit * state.alpha;
        let (Some(error), Some(discretisation)) = (row.error, row.discretisation) else {
            return;
        };
        let value = match times * first.value {
            value if same(value, state.load) => state.load,
            value => value,
        };
        let force = path("contact_force");
        let now = reported.get(&force).unwrap_or(&state.contact_force);
        let now = now * (value / row.value);
        reported.insert(row.quantity.clone(), value);
        set(reported, force, now, state.contact_force);
        let own = row.of_mesh.unwrap_or(OfMesh {
            value: row.value,
            error,
            discretisation,
        });
        row.value = value;
        row.of_mesh = first.of_mesh.map(|_| own);
        // That of first yield, but for the algebra of the state.
        row.discretisation = first.discretisation.map(|d| times.abs() * d);
        row.path = first.path.map(|p| times.abs() * p);
        row.error =
            (first.error).map(|e| times.abs() * (e - first.algebraic).max(0.0) + row.algebraic);
        row.relative_error = row.error.map(|error| error / scale);
    }

    /// The load of a state over its factor times that of first yield, where it is so on every mesh: the program counts in loads of first yield; and
    /// whether the factor is prescribed, the same on every mesh.
    fn counted(&self, results: &Results, state: &State) -> Option<(f64, bool)> {
        let unit = |results: &Results, state: &State| {
            let unit = state.load / (state.alpha * results.first_yield?.load);
            (unit.is_finite() && unit != 0.0).then_some(unit)
        };
        let own = unit(results, state)?;
        let mut prescribed = true;
        for (_, other) in &self.others {
            let found = other.states.iter().find(|s| s.name == state.name)?;
            if !same(unit(other, found)?, own) {
                return None;
            }
            prescribed &= same(found.alpha, state.alpha);
        }
        (!self.others.is_empty()).then_some((own, prescribed))
    }
}

/// Reports a value in the place of the mesh's `own`, unless it is the same.
fn set(reported: &mut Reported, path: String, value: f64, own: f64) {
    match same(value, own) {
        true => reported.remove(&path),
        false => reported.insert(path, value),
    };
}

/// Whether two values are the same but for round-off.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// Reports a value in the place of the mesh's: its error is at most that of the mesh's and the
/// distance between the two.
fn move_to(row: &mut QuantityError, value: f64) {
    if let (Some(error), Some(discretisation)) = (row.error, row.discretisation) {
        row.of_mesh = Some(OfMesh {
            value: row.value,
            error,
            discretisation,
        });
        let moved = error + (value - row.value).abs();
        row.relative_error =
            (row.relative_error.filter(|_| error > 0.0)).map(|r| r * moved / error);
        row.error = Some(moved);
    }
    row.value = value;
}
