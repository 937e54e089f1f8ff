//! The outcome of a program of cycles.

use crate::number::number;
use crate::results::{CycleRow, Results};
use maud::{Markup, PreEscaped, html};

/// Number of cycles that are shown at the beginning and at the end of a long list.
const CYCLES: usize = 8;

/// Returns the outcome of the cycles, and the strains of each cycle.
pub(super) fn table(results: &Results) -> Markup {
    let Some(cycles) = &results.cycles else {
        return PreEscaped(String::new());
    };
    let rows = &cycles.rows;
    let (begin, end) = match rows.len() > 2 * CYCLES {
        true => (&rows[..CYCLES], &rows[rows.len() - CYCLES..]),
        false => (&rows[..], &rows[..0]),
    };
    let row = |row: &CycleRow| {
        html! {
            tr {
                th.n scope="row" { (row.cycle) }
                td.n { (number(row.flow)) } td.n { (number(row.growth)) }
            }
        }
    };
    html! {
        p { (cycles.told()) "." }
        div.wide tabindex="0" {
            table {
                thead { tr {
                    th.n scope="col" { "cycle" }
                    th.n scope="col" { "largest plastic strain gained in the cycle" }
                    th.n scope="col" { "largest change of a plastic strain over the cycle" }
                } }
                tbody {
                    @for each in begin { (row(each)) }
                    @if !end.is_empty() { tr { td.n { "..." } td {} td {} } }
                    @for each in end { (row(each)) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{CycleOutcome, Cycles};

    #[test]
    fn long_lists_of_cycles_show_both_ends() {
        let rows = |n: usize| {
            (1..=n).map(|cycle| CycleRow {
                cycle,
                flow: 0.5 / cycle as f64,
                growth: 0.25,
            })
        };
        let page = |n: usize| {
            let results = Results {
                cycles: Some(Cycles {
                    outcome: CycleOutcome::Ratchetting,
                    body: Some("race".into()),
                    rows: rows(n).collect(),
                }),
                ..Results::default()
            };
            table(&results).into_string()
        };
        let short = page(16);
        assert!(
            short.contains("plastic strain of race grows by 0.25"),
            "{short}"
        );
        assert!(!short.contains("..."));
        assert_eq!(short.matches("<tr>").count(), 17);
        let long = page(1000);
        assert_eq!(long.matches("<tr>").count(), 18);
        assert!(long.contains(">8<") && !long.contains(">9<") && long.contains(">993<"));
        assert!(table(&Results::default()).into_string().is_empty());
    }
}
