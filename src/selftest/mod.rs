//! The fast part of the stability suite, on the user's own machine and build: hard cases by family,
//! with the worst figure measured, its bound and the source of the bound.
//!
//! | file | what |
//! |---|---|
//! | `contact` | floating and conforming bodies, ties, events, complementarity, spreading contact, dents |
//! | `numbers` | stiffness ratios, slivers, units, backends |
//! | `flow` | incompressible flow, limit loads, cycles, ratchetting, the axis of quadratic elements |
//! | `peers` | cases on which other codes were seen to fail without a word |
//! | `restart` | going on from checkpoints |
//! | `foreign` | models as they come: few elements, punches on larger bases, stacks, loose bodies |
//! | `solids` | three dimensions: Hertz, plane strain drawn out, bodies of all stiffnesses, slivers |

mod contact;
mod flow;
mod foreign;
mod numbers;
mod peers;
mod restart;
mod solids;

use crate::analysis::Analysis;
use crate::error::{Error, Result};
use crate::linalg::{self, Backend};
use crate::model::Model;
use crate::progress::{Observer, Silent};
use crate::results::{Results, State};
use crate::scene::Scene;

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

/// A family of cases, each of which gives a figure.
struct Family {
    name: &'static str,
    figure: &'static str,
    bound: f64,
    source: &'static str,
    cases: fn(&mut Cases) -> Result<()>,
}

/// The collected figures of a family.
#[derive(Default)]
struct Cases {
    count: usize,
    worst: f64,
}

impl Cases {
    /// Adds a case with its figure (an error, zero at best).
    fn add(&mut self, figure: f64) {
        self.count += 1;
        if figure.is_nan() || figure.abs() > self.worst {
            self.worst = if figure.is_nan() {
                f64::INFINITY
            } else {
                figure.abs()
            };
        }
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

/// Parses a scene of the suite.
fn scene(text: &str) -> Result<Scene> {
    Scene::parse(text, "selftest")
}

/// Runs a scene without fields; a limit load or another early end is recorded in the results.
fn results(scene: &Scene) -> Result<Results> {
    results_by(scene, Backend::default())
}

fn results_by(scene: &Scene, backend: Backend) -> Result<Results> {
    let mut scene = scene.clone();
    for target in &mut scene.program.targets {
        target.fields = false;
    }
    Analysis::new(Model::new(&scene)?, backend)?.run(&mut Silent)
}

fn state<'r>(results: &'r Results, name: &str) -> Result<&'r State> {
    let found = results.states.iter().find(|s| s.name == name);
    found.ok_or_else(|| {
        let why = results.incomplete.as_ref().map_or("", |i| i.why.as_str());
        Error::analysis(format!("state `{name}` was not reached: {why}"))
    })
}

/// Returns the largest difference of a figure between the pairs of two states, over the largest
/// value of the first state.
fn difference(a: &State, b: &State, figure: fn(&crate::results::PairState) -> f64) -> f64 {
    if a.pairs.len() != b.pairs.len() {
        return f64::INFINITY;
    }
    let scale = a.pairs.iter().fold(0.0f64, |m, p| m.max(figure(p).abs()));
    let pairs = a.pairs.iter().zip(&b.pairs);
    pairs.fold(0.0f64, |m, (p, q)| m.max((figure(p) - figure(q)).abs())) / scale
}

/// Returns the worst algebraic figure of all states.
fn worst_quality(results: &Results) -> f64 {
    let q = &results.quality;
    [
        q.backward_error,
        q.equilibrium,
        q.complementarity,
        q.penetration,
        q.adhesion,
    ]
    .into_iter()
    .fold(0.0, |m, v| if v.is_nan() { f64::NAN } else { v.max(m) })
}

#[cfg(test)]
mod tests {
    use super::Cases;

    #[test]
    fn what_is_not_a_number_is_the_worst_of_all() {
        let mut cases = Cases::default();
        cases.add(-1e-3);
        cases.add(1e-4);
        assert_eq!((cases.count, cases.worst), (2, 1e-3));
        cases.add(f64::NAN);
        cases.add(1.0);
        assert_eq!((cases.count, cases.worst), (4, f64::INFINITY));
    }
}
