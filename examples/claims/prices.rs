//! What demands cost beside the cheapest uniform mesh that is as accurate, found by trial.

use super::support::families::{Family, run_extent};
use brinell::accuracy::{Extent, Quantity, member, quantities, reach, work};
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::scene::{AccuracyDemand, Scene};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::time::Instant;

pub const HEAD: &str = "\n## What a demand costs\n\nAll runs of a demand together, over the one \
                        run of the cheapest uniform mesh from which on every mesh is as accurate, \
                        found by trial with the true errors known, in floating point operations. \
                        The scene is the family's mesh of medium size; what is demanded are the \
                        quantities that are known and that a demand on all asks for. The true \
                        error is that of the demand's last mesh; `-`: no mesh down to 0.4 of the \
                        scene's element size (in space 0.7) is as accurate.\n\n| scene | demand | \
                        true error | outcome | seconds | operations over the cheapest \
                        |\n|---|---|---|---|---|---|\n";

/// Element sizes of the meshes among which the cheapest is sought, over the scene's: in the plane,
/// and in space, where the time grows with the sixth power of the fineness.
const SOUGHT: [[f64; 2]; 2] = [[4.0, 0.4], [4.0, 0.7]];
const STEP: f64 = 1.2;
/// Seconds for a demand.
const BUDGET: f64 = 40.0;
const DEMANDS: [f64; 2] = [0.1, 0.01];
/// Values at a point or counted in Gauss points: a demand on all does not hold for them.
const POINTWISE: [&str; 3] = [
    "pole_pressure",
    "plastic_zone_size",
    "max_equivalent_plastic_strain",
];

/// The rows of a family, of which these values are known.
pub fn of(family: &Family, known: &BTreeMap<String, f64>) -> String {
    let scene = &family.meshes[family.meshes.len() / 2].1;
    let has =
        run_extent(scene, family.extent).map_or_else(Vec::new, |results| quantities(&results));
    let demanded = |q: &&Quantity| !q.is_of_part() && !POINTWISE.contains(&q.kind);
    let (mut asked, mut keys) = (BTreeMap::new(), BTreeSet::new());
    for quantity in has.iter().filter(demanded) {
        if let Some(value) = known.get(&quantity.path) {
            asked.insert(quantity.path.clone(), *value);
            keys.insert(quantity.kind);
        }
    }
    let tried = meshes_by_trial(scene, family.extent, &asked);
    let mut out = String::new();
    for demand in DEMANDS {
        let all: Vec<String> = keys.iter().map(|key| format!("{key} = {demand}")).collect();
        let mut demanded = scene.clone();
        demanded.accuracy = Some(AccuracyDemand::try_from(all.join(", ")).unwrap());
        let (backend, begun) = (Backend::default(), Instant::now());
        let found = reach(&demanded, backend, family.extent, Some(BUDGET), &mut Silent);
        let results = match found {
            Ok(found) => found.results,
            Err(error) => {
                writeln!(
                    out,
                    "| {} | {} % | - | {error} | - | - |",
                    family.name,
                    100.0 * demand
                )
                .unwrap();
                continue;
            }
        };
        let reached = results.accuracy.as_ref().and_then(|a| a.demand.as_ref());
        let reached = reached.unwrap();
        let enough = tried
            .iter()
            .take_while(|(error, _)| *error <= demand)
            .last();
        let price = enough.map_or("-".to_string(), |(_, of)| {
            format!("{:.1}", reached.work / of)
        });
        let seconds = begun.elapsed().as_secs_f64();
        let outcome = reached.reason.as_deref().unwrap_or("reached");
        writeln!(
            out,
            "| {} | {} % | {:.2} % | {outcome} | {seconds:.1} | {price} |",
            family.name,
            100.0 * demand,
            100.0 * error(&results, &asked),
        )
        .unwrap();
        eprintln!("    {demand}: {price}, {outcome}");
    }
    out
}

/// Uniform meshes, fine to coarse: the error on each, and its operations.
fn meshes_by_trial(
    scene: &Scene,
    extent: Extent,
    asked: &BTreeMap<String, f64>,
) -> Vec<(f64, f64)> {
    let [coarsest, finest] = SOUGHT[usize::from(scene.kind.is_solid())];
    let n = (coarsest / finest).ln() / STEP.ln();
    let sizes = (0..=n as i32).map(|i| finest * STEP.powi(i));
    let mut levels: Vec<_> = sizes
        .filter_map(|ratio| member(scene, ratio).ok())
        .collect();
    levels.dedup_by(|a, b| a.ratio == b.ratio);
    let ran = levels
        .iter()
        .filter_map(|level| run_extent(&level.scene, extent));
    ran.map(|results| (error(&results, asked), work(&results)))
        .collect()
}

/// Largest relative error of what is asked for.
fn error(results: &Results, asked: &BTreeMap<String, f64>) -> f64 {
    let all = quantities(results).into_iter();
    let errors = all.filter_map(|q| {
        let exact = asked.get(&q.path)?;
        (q.scale > 0.0).then(|| (q.value - exact).abs() / q.scale)
    });
    errors.fold(0.0, f64::max)
}
