//! What finer grading of a generated mesh would buy: errors and operations over the elements at the
//! contact and the growth away from it, data/accuracy/grading.md.

use super::support::families::{on_flat, run_extent};
use brinell::accuracy::{Extent, quantities, work};
use brinell::results::Results;
use brinell::scene::Scene;
use std::collections::BTreeMap;
use std::fmt::Write;

const ELEMENTS: [usize; 6] = [6, 8, 12, 16, 24, 32];
const GROWTHS: [f64; 7] = [1.05, 1.1, 1.15, 1.2, 1.3, 1.5, 1.75];
/// Elements and growth of the mesh that errors are measured against.
const REFERENCE: (usize, f64) = (64, 1.05);
/// The member of the family from which growth goes to its root, and its growth.
const OWN: (usize, f64) = (16, 1.15);
const KEYS: [&str; 5] = [
    "load",
    "max_pressure",
    "half_width",
    "approach",
    "residual_depth",
];
const DEMANDS: [f64; 4] = [0.01, 0.003, 0.001, 0.0003];

fn scene(n: usize, growth: f64) -> Scene {
    let growth = format!("mesh.cylinder_on_half_plane.growth={growth}");
    let program = "program.targets=[{ yield = true }, { name = \"pressed\", load_factor = 3.0 }, \
                   { name = \"off\", load_factor = 0.0 }]";
    on_flat(
        "cylinder_on_half_plane",
        n,
        &[&growth, "program.unit=\"yield\"", program],
    )
}

/// Largest error of each kind of figure relative to the largest such figure.
fn errors(results: &Results, truth: &Results) -> BTreeMap<String, f64> {
    let mut out = BTreeMap::new();
    for (own, exact) in quantities(results).iter().zip(&quantities(truth)) {
        assert_eq!(own.path, exact.path);
        if exact.scale > 0.0 {
            let error = (own.value - exact.value).abs() / exact.scale;
            let most: &mut f64 = out.entry(own.kind.to_string()).or_default();
            *most = most.max(error);
        }
    }
    out
}

/// The page.
pub fn page() -> String {
    let of = |n: usize, growth: f64| run_extent(&scene(n, growth), Extent::Program).unwrap();
    let truth = of(REFERENCE.0, REFERENCE.1);
    let measured = |n: usize, growth: f64| {
        eprintln!("{n} elements, growth {growth}");
        let results = of(n, growth);
        (n, growth, work(&results), errors(&results, &truth))
    };
    let all = ELEMENTS
        .iter()
        .flat_map(|&n| GROWTHS.map(|growth| measured(n, growth)));
    let grid: Vec<_> = all.collect();
    let rooted = |n: usize| OWN.1.powf(OWN.0 as f64 / n as f64);
    let family: Vec<_> = ELEMENTS.iter().map(|&n| measured(n, rooted(n))).collect();
    let mut out = String::from(
        "# What finer grading would buy\n\n`cargo run --release --example claims -- grading` \
         writes this page: a cylinder on a half plane, loaded to three times the load at first \
         yield and unloaded, on every combination of elements over the contact half width and \
         growth of elements away from it, compared with 64 elements and growth 1.05. The table \
         has the cheapest of these meshes on which all figures of a kind are within a demand, \
         next to the cheapest of the series that demands go through (growth to its root), in \
         floating point operations.\n\n\
         | figure | demand | any: elements, growth | operations | series: elements, growth | \
         operations | ratio |\n|---|---|---|---|---|---|---|\n",
    );
    for key in KEYS {
        for demand in DEMANDS {
            let cheapest = |of: &[(usize, f64, f64, BTreeMap<String, f64>)]| {
                let within = of.iter().filter(|(.., errors)| errors[key] <= demand);
                let least = within.min_by(|a, b| a.2.total_cmp(&b.2));
                least.map(|(n, growth, work, _)| (*n, *growth, *work))
            };
            let both = grid.iter().chain(&family).cloned().collect::<Vec<_>>();
            let (any, own) = (cheapest(&both), cheapest(&family));
            let shown = |found: Option<(usize, f64, f64)>| match found {
                Some((n, growth, work)) => format!("{n}, {growth:.3} | {work:.1e}"),
                None => "- | -".to_string(),
            };
            let ratio = match (any, own) {
                (Some(any), Some(own)) => format!("{:.1}", own.2 / any.2),
                _ => "-".to_string(),
            };
            let percent = 100.0 * demand;
            let (any, own) = (shown(any), shown(own));
            writeln!(out, "| `{key}` | {percent} % | {any} | {own} | {ratio} |").unwrap();
        }
    }
    out
}
