//! The fast part of the stability suite, on the user's own machine and build: hard cases by family,
//! with the worst figure measured, its bound and the source of the bound.
//!
//! | file | what |
//! |---|---|
//! | `cases` | families and cases: how a case is run and measured |
//! | `contact` | floating and conforming bodies, ties, events, complementarity, spreading contact, dents |
//! | `numbers` | stiffness ratios, slivers, units, backends |
//! | `flow` | incompressible flow, limit loads, cycles, ratchetting, the axis of quadratic elements |
//! | `peers` | cases on which other codes were seen to fail silently |
//! | `restart` | going on from checkpoints |
//! | `foreign` | models as they come: few elements, punches on larger bases, stacks, loose bodies |
//! | `solids` | three dimensions: Hertz, extruded plane strain, bodies of any stiffness, slivers |

mod cases;
mod contact;
mod flow;
mod foreign;
mod numbers;
mod peers;
mod restart;
mod solids;

use crate::linalg;
use crate::progress::Observer;
use cases::Cases;

/// The outcome of a family of hard cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the family.
    pub family: &'static str,
    /// Description of the figure that was measured.
    pub figure: &'static str,
    /// Number of cases.
    pub cases: usize,
    /// The worst figure; infinite if a case did not run.
    pub worst: f64,
    /// Largest figure that is allowed.
    pub bound: f64,
    /// Derivation of the bound.
    pub source: &'static str,
    /// The case that did not run, and the reason.
    pub failure: Option<String>,
}

impl Row {
    /// Whether the worst figure is within the bound.
    pub fn passed(&self) -> bool {
        self.failure.is_none() && self.worst <= self.bound
    }
}

/// Runs all families; `observer` receives the name of each as a phase, and may stop the run.
pub fn run(observer: &mut dyn Observer) -> Vec<Row> {
    let families = contact::FAMILIES
        .iter()
        .chain(numbers::FAMILIES)
        .chain(flow::FAMILIES)
        .chain(peers::FAMILIES)
        .chain(restart::FAMILIES)
        .chain(solids::FAMILIES)
        .chain(foreign::FAMILIES);
    let mut rows = Vec::new();
    for family in families {
        if observer.stop_requested() {
            break;
        }
        observer.phase(family.name);
        let mut cases = Cases::default();
        let outcome = (family.cases)(&mut cases);
        rows.push(Row {
            family: family.name,
            figure: family.figure,
            cases: cases.count,
            worst: if outcome.is_ok() {
                cases.worst
            } else {
                f64::INFINITY
            },
            bound: family.bound,
            source: family.source,
            failure: outcome.err().map(|e| e.message().to_string()),
        });
    }
    rows
}

/// Returns the rows as a page in Markdown, with the build with which they were measured.
pub fn page(rows: &[Row]) -> String {
    let mut text = format!(
        "# Hard cases, measured\n\nWritten by `brinell selftest --markdown`: brinell {}, BLAS: {}. \
         The whole suite is `cargo test --test all stability properties invariance`; its \
         scenes are in [data/scenes/hard](scenes/hard).\n\n| family | figure | cases | worst | \
         bound | where the bound comes from | |\n|---|---|---|---|---|---|---|\n",
        env!("CARGO_PKG_VERSION"),
        linalg::blas_name()
    );
    for row in rows {
        text += &format!(
            "| {} | {} | {} | {:.1e} | {:.1e} | {} | {} |\n",
            row.family,
            row.figure,
            row.cases,
            row.worst,
            row.bound,
            row.source,
            match &row.failure {
                None if row.passed() => "pass".to_string(),
                None => "FAIL".to_string(),
                Some(why) => format!("FAIL: {why}"),
            }
        );
    }
    text + &beside_others()
}

/// Returns the results of another program for the cases of `data/peers`: the part of that page
/// under the heading, as it was measured.
fn beside_others() -> String {
    const PAGE: &str = include_str!("../../data/peers/README.md");
    const HEADING: &str = "## Where contact codes fail silently";
    let part = PAGE.find(HEADING).map_or("", |at| &PAGE[at..]);
    // The links of that page are relative to its folder.
    format!("\n{}", part.replace("](", "](peers/"))
}
