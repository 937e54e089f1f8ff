//! The estimated errors, as one table: a row per state, a column per quantity.

use super::super::number::significant;
use super::super::table::{Column::*, Table};
use super::Report;
use crate::results::{Accuracy, EstimateMethod, QuantityError};

/// Columns: key and heading.
const KEYS: [(&str, &str); 6] = [
    ("load", "load"),
    ("max_pressure", "max\npressure"),
    ("half_width", "half\nwidth"),
    ("approach", "approach"),
    ("residual_depth", "residual\ndepth"),
    ("plastic_zone_size", "plastic\nzone"),
];

impl Report {
    /// Stated errors relative to the largest size of each quantity, and the largest of each kind of error below them.
    pub(super) fn accuracy(&mut self, accuracy: &Accuracy) {
        if accuracy.method != EstimateMethod::None {
            self.stated_errors(accuracy);
        }
        if let Some(demand) = &accuracy.demand {
            let heading = format!(
                "Demanded accuracy {} %: {}, the largest stated error is {} %",
                significant(100.0 * demand.accuracy, 2),
                if demand.reached {
                    "reached"
                } else {
                    "NOT reached"
                },
                significant(100.0 * demand.stated, 2)
            );
            self.list(&heading, &demand.choices);
        }
        self.list("Error estimate", &accuracy.notes);
    }

    fn stated_errors(&mut self, accuracy: &Accuracy) {
        let of = |prefix: &str, key: &str| {
            let path = format!("{prefix}.{key}");
            accuracy.quantities.iter().find(|q| q.quantity == path)
        };
        let mut prefixes: Vec<&str> = Vec::new();
        for quantity in &accuracy.quantities {
            if let Some((prefix, _)) = quantity.quantity.rsplit_once('.')
                && !prefixes.contains(&prefix)
            {
                prefixes.push(prefix);
            }
        }
        let keys: Vec<_> = KEYS
            .iter()
            .filter(|(key, _)| prefixes.iter().any(|p| of(p, key).is_some()))
            .collect();
        let mut columns = vec![(Text, "may be wrong by")];
        columns.extend(keys.iter().map(|(_, heading)| (Number, *heading)));
        let mut table = Table::new(&columns);
        for prefix in &prefixes {
            let name = match *prefix {
                "yield" => "first yield",
                state => state.strip_prefix("states.").unwrap_or(state),
            };
            let mut cells = vec![name.to_string()];
            cells.extend(
                keys.iter()
                    .map(|(key, _)| percent(of(prefix, key).and_then(|q| q.relative_error))),
            );
            table.row(cells);
        }
        type Part = fn(&QuantityError) -> Option<f64>;
        let parts: [(&str, Part); 3] = [
            ("estimated, at most: mesh", |q| q.discretisation),
            ("path", |q| q.path),
            ("algebra", |q| Some(q.algebraic)),
        ];
        for (name, part) in parts {
            let mut cells = vec![format!("{name:>24}")];
            cells.extend(keys.iter().map(|(key, _)| {
                let relative = prefixes.iter().filter_map(|p| {
                    let quantity = of(p, key)?;
                    // The scale is that of the stated error.
                    let scale = quantity.error? / quantity.relative_error?;
                    Some(part(quantity)? / scale)
                });
                percent(relative.filter(|r| r.is_finite()).reduce(f64::max))
            }));
            table.row(cells);
        }
        let ratios: Vec<String> = accuracy
            .companions
            .iter()
            .map(|c| significant(c.ratio, 3))
            .collect();
        self.section(
            "Estimated errors (% of the largest size that the quantity has in this run)",
            &table,
        );
        self.lines(&match accuracy.method {
            EstimateMethod::CoarserMeshes => format!(
                "  The mesh's part is extrapolated from runs with elements {} times as large; it counts twice.",
                ratios.join(" and ")
            ),
            _ => "  The mesh's part is the energy norm of the stress error, a rough figure: this mesh cannot be made coarser. \
                  `brinell accuracy` refines it."
                .to_string(),
        });
    }
}

/// A share in per cent, two digits.
fn percent(share: Option<f64>) -> String {
    match share {
        Some(0.0) => "0".to_string(),
        Some(share) => significant(100.0 * share, 2),
        None => "-".to_string(),
    }
}
