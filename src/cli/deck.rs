//! A report of how a deck was converted.

use super::table::{ColumnAlignment, Table, page_width, wrap};
use crate::deck::{Deck, Note};

/// Lists the keywords that were understood, and those that were taken otherwise, ignored or
/// refused.
pub(super) fn account(deck: &Deck) -> String {
    let account = deck.account();
    let mut table = Table::new(&[
        (ColumnAlignment::Text, "understood"),
        (ColumnAlignment::Number, "times"),
        (ColumnAlignment::Text, "first at"),
    ]);
    for (keyword, (times, place)) in &account.understood {
        table.row([format!("*{keyword}"), times.to_string(), place.clone()]);
    }
    let mut text = format!(
        "Deck      {} nodes, {} elements\n\n{}\n",
        deck.n_nodes(),
        deck.n_elements(),
        table.render(page_width())
    );
    for (heading, notes) in [
        ("Taken otherwise", &account.taken),
        ("Ignored", &account.ignored),
        ("Refused", &account.refused),
    ] {
        list(heading, notes, &mut text);
    }
    text
}

fn list(heading: &str, notes: &[Note], text: &mut String) {
    if notes.is_empty() {
        return;
    }
    text.push_str(heading);
    text.push('\n');
    for note in notes {
        for (index, line) in wrap(&note.to_string(), page_width() - 4).iter().enumerate() {
            let mark = if index == 0 { "  - " } else { "    " };
            text.push_str(&format!("{mark}{line}\n"));
        }
    }
    text.push('\n');
}
