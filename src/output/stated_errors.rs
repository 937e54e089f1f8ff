//! The stated errors as rows and columns, for terminal and report alike: a row per state, a column
//! per quantity.

use super::Labels;
use crate::number::{rough_percentage, significant};
use crate::results::{Accuracy, EstimateMethod, QUANTITIES, Quantity, QuantityError};
use std::collections::BTreeMap;

/// The table of the stated errors, relative to the largest size of each quantity in the run.
pub(crate) struct StatedErrors {
    /// The heading of each column, in lines.
    pub columns: Vec<&'static str>,
    /// A row per state: its name and the stated errors, ready to print, in per cent.
    pub states: Vec<(String, Vec<String>)>,
    /// A row per kind of error (mesh, path, algebra): its name and the largest error of this kind
    /// in each column, before the kinds are added.
    pub kinds: Vec<(&'static str, Vec<String>)>,
    /// Method by which the discretisation error was estimated.
    pub method: String,
    /// The largest errors of figures of bodies, contacts and patches, in words.
    pub parts: Option<String>,
}

impl StatedErrors {
    /// The table of an estimate; `None` if nothing was estimated.
    pub(crate) fn of(accuracy: &Accuracy, labels: &Labels) -> Option<Self> {
        if accuracy.method == EstimateMethod::None {
            return None;
        }
        let mut of_prefix: BTreeMap<&str, BTreeMap<&str, &QuantityError>> = BTreeMap::new();
        let mut prefixes: Vec<&str> = Vec::new();
        let whole = |quantity: &&QuantityError| quantity.of_part().is_none();
        for quantity in accuracy.quantities.iter().filter(whole) {
            if let Some((prefix, key)) = quantity.quantity.rsplit_once('.') {
                let keys = of_prefix.entry(prefix).or_insert_with(|| {
                    prefixes.push(prefix);
                    BTreeMap::new()
                });
                keys.entry(key).or_insert(quantity);
            }
        }
        let find = |prefix: &str, key: &str| of_prefix.get(prefix)?.get(key).copied();
        let keys: Vec<&Quantity> = QUANTITIES
            .iter()
            .filter(|quantity| prefixes.iter().any(|p| find(p, quantity.key).is_some()))
            .collect();
        let states = prefixes.iter().map(|prefix| {
            let name = match *prefix {
                "yield" => "first yield",
                state => state.strip_prefix("states.").unwrap_or(state),
            };
            let errors = keys
                .iter()
                .map(|quantity| find(prefix, quantity.key).and_then(|q| q.relative_error))
                .map(figure);
            (name.to_string(), errors.collect())
        });
        type Part = fn(&QuantityError) -> Option<f64>;
        let parts: [(&str, Part); 3] = [
            ("mesh", |q| q.discretisation),
            ("path", |q| q.path),
            ("algebra", |q| Some(q.algebraic)),
        ];
        let kinds = parts.into_iter().map(|(name, part)| {
            let largest = keys.iter().map(|Quantity { key, .. }| {
                let relative = prefixes.iter().filter_map(|p| {
                    let quantity = find(p, key)?;
                    // Every kind of error is relative to the same size as the stated error.
                    let scale = quantity.error? / quantity.relative_error?;
                    Some(part(quantity)? / scale)
                });
                figure(relative.filter(|r| r.is_finite()).reduce(f64::max))
            });
            (name, largest.collect())
        });
        Some(StatedErrors {
            columns: keys
                .iter()
                .map(|quantity| labels.heading(quantity))
                .collect(),
            states: states.collect(),
            kinds: kinds.collect(),
            method: method(accuracy),
            parts: of_parts(accuracy),
        })
    }
}

/// The largest stated errors of figures of bodies, contacts and patches, in words; `None` if there
/// are none.
fn of_parts(accuracy: &Accuracy) -> Option<String> {
    let mut largest: Vec<(&str, Option<f64>)> = Vec::new();
    for quantity in &accuracy.quantities {
        let Some(part) = quantity.of_part() else {
            continue;
        };
        let error = quantity.relative_error;
        match largest.iter_mut().find(|(known, _)| *known == part) {
            Some((_, most)) => *most = most.zip(error).map(|(a, b)| a.max(b)),
            None => largest.push((part, error)),
        }
    }
    let each = largest.into_iter().map(|(part, error)| match error {
        Some(error) => format!("{part} {} %", rough_percentage(error)),
        None => format!("{part} unknown"),
    });
    let all: Vec<String> = each.collect();
    (!all.is_empty()).then(|| format!("Parts, at most: {}.", all.join(", ")))
}

fn method(accuracy: &Accuracy) -> String {
    let ratios = accuracy.companions.iter().map(|c| significant(c.ratio, 3));
    match accuracy.method {
        EstimateMethod::CoarserMeshes => format!(
            "The mesh's part follows from runs with elements {} times as large, factor of safety \
             included.",
            ratios.collect::<Vec<_>>().join(" and "),
        ),
        _ => "The mesh's part is the energy norm of the stress error, a rough figure: no other \
              mesh could be run."
            .to_string(),
    }
}

fn figure(share: Option<f64>) -> String {
    share.map_or_else(|| "-".to_string(), rough_percentage)
}
