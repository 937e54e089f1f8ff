//! What demands cost beside the cheapest uniform mesh that is as accurate, found by trial.

use super::held_out_fourth::refined;
use super::support::families::{Family, Truth, run_extent};
use brinell::accuracy::{Extent, Quantity, member, quantities, reach, work};
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::scene::{AccuracyDemand, Scene};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::time::Instant;

pub const HEAD: &str = "\n## What a demand costs\n\nCost of all runs of a demand divided by that \
                       of one run on the cheapest mesh found by trial, in floating point \
                       operations, and cost of the last run of the demand divided by the \
                       same. Meshes by trial are uniform ones and, where bodies touch on less \
                       than an element, the same with \
                       elements refined around the contact, each 1.2 times coarser than the one \
                       before; the cheapest is the coarsest from which on every mesh is as \
                       accurate, with the true errors known. Each demand is made on the family's \
                       scene with its mesh of medium size. It covers the quantities whose true \
                       value is known and that belong to a demand on all quantities ([how \
                       accurate](../guide/accuracy.md)). The true error is that of the demand's \
                       last mesh; `-`: no mesh down to 0.4 of the scene's element size (in space \
                       0.7) is as accurate.\n\n| scene | demand | true error | outcome | seconds \
                       | operations over the cheapest | the last run's \
                       |\n|---|---|---|---|---|---|---|\n";

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

/// A demand on a scene, as it ended.
pub struct Priced {
    scene: String,
    demand: f64,
    ended: Result<Ended, String>,
}

/// What a demand ended with.
struct Ended {
    truth: f64,
    /// Why it was not reached.
    reason: Option<String>,
    seconds: f64,
    /// Operations of all runs and of the last one over those of the cheapest mesh.
    prices: Option<[f64; 2]>,
}

impl Priced {
    pub fn row(&self) -> String {
        let Priced { scene, demand, .. } = self;
        let demand = 100.0 * demand;
        match &self.ended {
            Err(why) => format!("| {scene} | {demand} % | - | {why} | - | - | - |\n"),
            Ok(ended) => {
                let reason = ended.reason.as_deref().unwrap_or("reached");
                let [all, last] = match ended.prices {
                    Some(prices) => prices.map(|price| format!("{price:.1}")),
                    None => ["-", "-"].map(str::to_string),
                };
                format!(
                    "| {scene} | {demand} % | {:.2} % | {reason} | {:.1} | {all} | {last} |\n",
                    100.0 * ended.truth,
                    ended.seconds
                )
            }
        }
    }
}

/// What all demands of a size came to, in a sentence for each size.
pub fn summary(all: &[Priced]) -> String {
    let mut out = String::new();
    for demand in DEMANDS {
        let of: Vec<&Priced> = all.iter().filter(|p| p.demand == demand).collect();
        let ended = of.iter().filter_map(|p| p.ended.as_ref().ok());
        let reached: Vec<&Ended> = ended.filter(|e| e.reason.is_none()).collect();
        let kept = reached.iter().filter(|e| e.truth <= demand).count();
        let median = |which: usize| {
            let mut of: Vec<f64> = (reached.iter())
                .filter_map(|e| Some(e.prices?[which]))
                .collect();
            of.sort_by(f64::total_cmp);
            let worst = of.last().copied().unwrap_or(f64::NAN);
            // The mean of both in the middle of an even number.
            let middle = of
                .get(of.len().saturating_sub(1) / 2)
                .zip(of.get(of.len() / 2));
            let median = middle.map_or(f64::NAN, |(a, b)| 0.5 * (a + b));
            (median, worst, of.len())
        };
        let ((price, worst, n), (last, _, _)) = (median(0), median(1));
        write!(
            out,
            "\n{} %: {} of {} reached, the true error within the demand in {kept} of them; price \
             in the median of {n} {price:.1}, at most {worst:.1}, of the last run alone {last:.1} \
             in the median.\n",
            100.0 * demand,
            reached.len(),
            of.len(),
        )
        .unwrap();
    }
    out
}

/// The demands on a family, of which these values are known.
pub fn of(family: &Family, known: &BTreeMap<String, f64>) -> Vec<Priced> {
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
    let mut tried = vec![meshes_by_trial(scene, family.extent, &asked)];
    for refined in refined_by_trial(scene, &family.truth) {
        tried.push(meshes_by_trial(&refined, family.extent, &asked));
    }
    let priced = DEMANDS.map(|demand| {
        let all: Vec<String> = keys.iter().map(|key| format!("{key} = {demand}")).collect();
        let mut demanded = scene.clone();
        demanded.accuracy = Some(AccuracyDemand::try_from(all.join(", ")).unwrap());
        let ended = ended(&demanded, family.extent, &asked, cheapest(&tried, demand));
        let scene = family.name.clone();
        Priced {
            scene,
            demand,
            ended,
        }
    });
    priced.into()
}

/// Runs a demand; `cheapest` are the operations of the cheapest mesh that is as accurate.
fn ended(
    demanded: &Scene,
    extent: Extent,
    asked: &BTreeMap<String, f64>,
    cheapest: Option<f64>,
) -> Result<Ended, String> {
    let (backend, begun) = (Backend::default(), Instant::now());
    let found = reach(demanded, backend, extent, Some(BUDGET), &mut Silent);
    let results = found.map_err(|error| error.to_string())?.results;
    let reached = results.accuracy.as_ref().and_then(|a| a.demand.as_ref());
    let reached = reached.unwrap();
    Ok(Ended {
        truth: error(&results, asked),
        reason: reached.reason.clone(),
        seconds: begun.elapsed().as_secs_f64(),
        prices: cheapest.map(|of| [reached.work / of, work(&results) / of]),
    })
}

/// Operations of the cheapest of the meshes by trial, sequences from fine to coarse, from which on
/// every mesh of its sequence is within the demand.
fn cheapest(tried: &[Vec<(f64, f64)>], demand: f64) -> Option<f64> {
    let coarsest = tried.iter().filter_map(|sequence| {
        let within = sequence.iter().take_while(|(error, _)| *error <= demand);
        within.last().map(|(_, of)| *of)
    });
    coarsest.reduce(f64::min)
}

/// The scene with a mesh refined around the contact as the truth's, but fewer times.
fn refined_by_trial(scene: &Scene, truth: &Truth) -> Vec<Scene> {
    let Truth::Finer(truth) = truth else {
        return Vec::new();
    };
    let Some(last) = truth.mesh.refine.last() else {
        return Vec::new();
    };
    let times = (2..=last.times).step_by(2);
    times
        .map(|times| refined(scene.clone(), last.at, last.radius, times))
        .collect()
}

/// Meshes of a family, fine to coarse: the error on each, and its operations.
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
