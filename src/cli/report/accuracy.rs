//! The estimated errors, as one table: a row per state, a column per quantity.

use super::super::table::{ColumnAlignment::*, Table};
use super::Report;
use crate::output::ending::in_words;
use crate::output::stated_errors::StatedErrors;
use crate::results::Accuracy;

impl Report {
    /// Adds the stated errors relative to the largest size of each quantity, and below them the
    /// largest of each kind of error.
    pub(super) fn accuracy(&mut self, accuracy: &Accuracy) {
        if let Some(stated) = StatedErrors::of(accuracy, &self.labels) {
            self.stated_errors(&stated);
        }
        if let Some(demand) = &accuracy.demand {
            self.list(&in_words(demand), &demand.choices);
        }
        self.list("Error estimate", &accuracy.notes);
    }

    fn stated_errors(&mut self, stated: &StatedErrors) {
        let mut columns = vec![(Text, "may be wrong by [%]")];
        columns.extend(stated.columns.iter().map(|heading| (Number, *heading)));
        let mut table = Table::new(&columns);
        for (name, errors) in &stated.states {
            table.row([vec![name.clone()], errors.clone()].concat());
        }
        for (index, (kind, largest)) in stated.kinds.iter().enumerate() {
            let name = match index {
                0 => format!("estimated, at most: {kind}"),
                _ => kind.to_string(),
            };
            table.row([vec![format!("{name:>24}")], largest.clone()].concat());
        }
        self.section(
            "Estimated errors (% of the largest size that the quantity has in this run)",
            &table,
        );
        self.lines(&format!("  {}", stated.method));
        if let Some(parts) = &stated.parts {
            self.lines(&format!("  {parts}"));
        }
    }
}
