//! Tables that show how far to trust the numbers: stated errors, and the quality of the solves.

use super::tables::{numbers, plain, table, text};
use crate::number::significant;
use crate::output::Labels;
use crate::output::ending::in_words;
use crate::output::stated_errors::StatedErrors;
use crate::results::Results;
use maud::{Markup, PreEscaped, html};

/// Returns the table of stated errors.
pub(super) fn errors(results: &Results, labels: &Labels) -> Markup {
    let Some(accuracy) = &results.accuracy else {
        return PreEscaped(String::new());
    };
    let stated = StatedErrors::of(accuracy, labels);
    if stated.is_none() && accuracy.demand.is_none() && accuracy.notes.is_empty() {
        return PreEscaped(String::new());
    }
    html! {
        @if let Some(stated) = &stated {
            p.quiet {
                "In per cent of the largest size that the quantity has in this run. "
                (stated.method)
            }
            (stated_errors(stated))
            @if let Some(parts) = &stated.parts { p.quiet { (parts) } }
        }
        @if let Some(demand) = &accuracy.demand {
            p { (in_words(demand)) "." }
            ul { @for choice in &demand.choices { li { (choice) } } }
        }
        @for note in &accuracy.notes { p.quiet { (note) } }
    }
}

fn stated_errors(stated: &StatedErrors) -> Markup {
    let mut head = vec![text("may be wrong by [%]")];
    head.extend(
        stated
            .columns
            .iter()
            .map(|heading| numbers(heading.replace('\n', " "))),
    );
    let row = |name: String, errors: &[String]| -> Vec<Markup> {
        let mut cells = vec![plain(name)];
        cells.extend(errors.iter().map(plain));
        cells
    };
    let mut rows: Vec<_> = stated
        .states
        .iter()
        .map(|(name, errors)| row(name.clone(), errors))
        .collect();
    rows.extend(
        stated
            .kinds
            .iter()
            .map(|(kind, largest)| row(format!("part of the {kind}, at most"), largest)),
    );
    table(&head, &rows)
}

/// Returns the table of quality: the worst figures of the run, then the figures of each state.
pub(super) fn quality(results: &Results) -> Markup {
    let head = [
        text("state"),
        numbers("backward error"),
        numbers("row by row"),
        numbers("equilibrium"),
        numbers("round-off"),
        numbers("complementarity"),
        numbers("penetration"),
        numbers("adhesion"),
    ];
    let row = |name: &str, q: &crate::results::Quality| -> Vec<Markup> {
        let mut cells = vec![plain(name)];
        let figures = [
            Some(q.backward_error),
            q.componentwise_error,
            Some(q.equilibrium),
            q.round_off,
            Some(q.complementarity),
            Some(q.penetration),
            Some(q.adhesion),
        ];
        let shown = |v: Option<f64>| v.map_or_else(|| "-".to_string(), |v| significant(v, 2));
        cells.extend(figures.map(|v| plain(shown(v))));
        cells
    };
    let mut rows = vec![row("worst of all", &results.quality)];
    rows.extend(results.states.iter().map(|s| row(&s.name, &s.quality)));
    html! {
        p.quiet {
            "Relative and without dimension; 1e-16 is round-off. Backward error of the full solve, \
             of the whole and of the worst row; out-of-balance force of the stresses over the \
             forces that act, and what round-off alone may leave of it on this mesh; gap times \
             force of a pair; penetration over the largest displacement; tension of a pair over \
             the largest force. These say how well the equations were solved, not how fine the \
             mesh is."
        }
        @for text in &results.inaccurate { div.note.bad { b { "Not to be trusted: " } (text) } }
        (table(&head, &rows))
        @if results.condition > 0.0 {
            p.quiet {
                "Condition of the factored matrix: at least " (significant(results.condition, 2))
                @if let Some(estimate) = results.condition_estimate {
                    ", about " (significant(estimate, 2))
                }
                "."
            }
        }
    }
}
