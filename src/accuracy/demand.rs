//! `accuracy = "1 %"`: the settings that reach a demanded accuracy, chosen from coarse runs, checked afterwards.
//!
//! Everything follows from the one number `x`:
//!
//! | setting | chosen so that |
//! |---|---|
//! | mesh, its grading | the stated error of every governing quantity is at most `x` of its largest size in the run |
//! | `gamma` | `x / 300`: below a hundredth of `x` it is not seen beside the mesh (measured: `data/accuracy`) |
//! | plastic tolerance | `x / 1000`, at most 1e-4; 1e-6 where a half width is a target, which would be missed |
//! | increments | the path's part of the stated error is at most `x / 3`; fixed steps where events, of which finer meshes have more, leave fewer |
//!
//! What is reported of a quantity is its value on the mesh or, where that is known better, the one that this and the coarser meshes lead to (`limit`); profiles,
//! fields and history are always the mesh's.
//!
//! A pilot run on a coarse mesh states its error and its order, and a second one which part of the mesh it comes from (`grading`):
//! from them the next mesh is aimed at, graded so that the demand costs the fewest elements, at most [`STRIDE`] times finer, until one
//! reaches the demand. A mesh from a file is subdivided, once, twice, ..., and judged by the file and its subdivisions before. Memory
//! and time of a mesh are predicted from those run before it, and where that leaves doubt from its symbolic factorisation: what does not fit
//! is refused with its price.
//!
//! A quantity whose error could not be estimated, because coarser meshes do not have it, counts as not reached: finer meshes are tried, and if none
//! mends that it is named in [`Demand::unknown`].

use super::edge::well_read;
use super::estimate::{Extent, analyse, estimate_on};
use super::grading::{balanced, risen};
use super::knobs::resolution;
use super::ladder::{Ladder, fineness, foot, is_small, once_subdivided, spacings};
use super::limit::{Limits, report};
use super::meter::{Pace, forecast, work};
use super::outcome::{AIM, LEAST_STEP, Outcome, PATH_SHARE, Trial, told};
use super::pilot::pilot;
use super::refinement::{largest_order, refined};
use super::refusal::{Cost, in_doubt, percent, refuse_beyond_memory, refuse_round_off};
use super::stall::{BEYOND_BEST, Best};
use crate::analysis::Analysis;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{Demand, Results};
use crate::scene::{Scene, Stepping};
use std::time::Instant;

/// The tolerance of contact events is this share of the demand.
const GAMMA_SHARE: f64 = 1.0 / 300.0;
/// That of the plastic iteration this one: with 1e-4 the limit load of the punch is 1 % off on its finest mesh, the more the finer it is.
const TOLERANCE_SHARE: f64 = 1e-3;
/// Tightest tolerance that is chosen: the scene's default.
const TIGHTEST: f64 = 1e-10;
/// Loosest tolerance of the plastic iteration that is chosen.
const LOOSEST: f64 = 1e-4;
/// The same where a half width is a target, which is read off a state that must not scatter: with 1e-4 one was missed.
const LOOSEST_READ_OFF: f64 = 1e-6;
/// A mesh is at most this many times finer than the one it is aimed from: beyond, an observed order is a guess. Each
/// is judged by the two before it, which cost nothing again, so that all together cost about 1.5 times the last.
const STRIDE: f64 = 1.9;
/// Elements up to which a mesh is run without asking what it takes: a tenth of a second, and well below 100 MB.
const SMALL: usize = 5000;
/// The lowest mesh may have so many times the elements of the foot of the ladder: rounded to what can be made.
const AT_FOOT: f64 = 0.9;
/// The next mesh is finer than the last by at least this.
const BARELY_FINER: f64 = 1.0 + 1e-9;
/// By how much a mesh is made finer until one can be made that is fine enough.
const FINER: [f64; 7] = [1.0, 1.03, 1.06, 1.1, 1.25, 1.5, 2.0];
/// The next mesh has at least this share of the fineness aimed at: one rounded down misses the demand by a little, and its run is wasted.
const NEARLY: f64 = 0.995;
/// A coarse mesh says about half of how much finer the last one will be (cylinder and ball at 1 and 0.3 %: with fixed increments from the first mesh on they took 1.5 to 2.5 times the time).
const MORE_THAN_SAID: f64 = 2.0;
/// Runs before the demand is given up.
const ROUNDS: usize = 12;
/// Rounds from which on the prediction of the mesh that will do is believed.
const TRUSTED: usize = 4;

/// A run that was made to a demand.
pub struct Reached {
    /// The scene with the settings that were chosen.
    pub scene: Scene,
    /// Its analysis, for the model and the mesh.
    pub analysis: Analysis,
    /// Its results with their errors.
    pub results: Results,
}

/// Runs a scene to its demanded accuracy.
///
/// # Errors
/// `Input` where the scene demands none, where its mesh cannot be refined, and with the price where the demand lies below
/// round-off or beyond the memory; else those of the runs. A demand that was not reached within the rounds, or
/// that refinement does not bring nearer, is no error: [`Demand::reached`] says so.
pub fn reach(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    observer: &mut dyn Observer,
) -> Result<Reached> {
    let Some(demand) = scene.accuracy.map(|a| a.relative()) else {
        return Err(Error::input("the scene demands no accuracy"));
    };
    let foot = foot(scene, extent);
    let first = once_subdivided(scene).or_else(|| spacings(scene).map(|count| foot / count));
    let Some(mut factor) = first else {
        return Err(Error::input(
            "`accuracy`: the mesh of this scene cannot be refined; take the key out",
        ));
    };
    let mut wanted = risen(&with_tolerances(scene, demand));
    let mut choices = vec![format!(
        "tolerance {:.1e} and gamma {:.1e}: from the demand",
        wanted.analysis.tolerance, wanted.program.gamma
    )];
    let mut pace = Pace::default();
    let mut costs: Vec<Cost> = Vec::new();
    let mut spent = 0.0;
    let mut ladder = Ladder::default();
    let mut last: Option<(Scene, f64)> = None;
    let mut as_fine = spacings(scene).map_or([0.0; 2], |_| [AT_FOOT * foot; 2]);
    let mut best = Best::default();
    let mut limits = Limits::default();
    let mut so_far = String::new();
    for round in 1..=ROUNDS {
        let coarser = last.as_ref().map(|(scene, width)| (scene, *width));
        let (level, model) = nearest(&wanted, factor, demand, coarser, as_fine)?;
        let settings = resolution(&level, 1.0 / factor);
        observer.phase(&format!("accuracy {}{so_far}: {settings}", percent(demand)));
        let fine = fineness(&level).unwrap_or(factor);
        if model.mesh.n_elements() > SMALL && in_doubt(fine, &costs) {
            let cost = forecast(&level, backend)?;
            costs.push(Cost {
                fineness: fine,
                memory: cost.factor.memory_bytes,
                forecast: cost.seconds,
            });
            refuse_beyond_memory(demand, fine, &costs, &pace)?;
            costs.pop();
        }
        let begun = Instant::now();
        let rungs = ladder.rungs(&level);
        let beside: Vec<Scene> = match is_small(&level) {
            true => rungs.iter().map(|rung| rung.scene.clone()).collect(),
            false => Vec::new(),
        };
        let (run, of_rungs) = ladder.beside(&beside, backend, extent, observer, |observer| {
            let found = analyse(model, backend, extent, observer);
            (found, begun.elapsed().as_secs_f64())
        });
        let (found, own_seconds) = run;
        let (analysis, mut results) = found?;
        spent += of_rungs;
        let estimate = estimate_on(
            rungs,
            &mut ladder,
            &level,
            backend,
            &results,
            extent,
            observer,
        );
        let (mut found, reported, new) = estimate.extrapolated(&results, &limits);
        limits = new;
        ladder.keep(&level, &results, own_seconds);
        let seconds = begun.elapsed().as_secs_f64();
        spent += work(&results) + found.work;
        let cost = Cost::of(fine, &results);
        pace.learn(cost.forecast, seconds);
        costs.push(cost);
        let trial = Trial {
            results: &results,
            found: &found,
            demand,
            order: largest_order(scene),
        };
        let outcome = Outcome::of(&trial);
        so_far = format!(", {} so far", told(&outcome));
        choices.push(format!(
            "{settings}: stated error {} in {seconds:.2} s",
            told(&outcome)
        ));
        let within = outcome.within(demand);
        let stalled = !within && best.is_no_longer_bettered(outcome.stated, fine);
        if stalled {
            choices.push(format!(
                "no better than on a mesh {BEYOND_BEST:.0} times coarser: refinement does not bring {} nearer",
                outcome.worst.as_deref().unwrap_or("it")
            ));
        }
        let stop = within
            || stalled
            || round == ROUNDS
            || observer.stop_requested()
            || results.incomplete.is_some()
            || found.companions.is_empty();
        if stop {
            found.demand = Some(Demand {
                accuracy: demand,
                reached: within,
                unknown: match results.incomplete {
                    None => outcome.unknown,
                    Some(_) => Vec::new(),
                },
                stated: outcome.stated,
                choices,
                work: spent,
            });
            results.accuracy = Some(found);
            report(&reported, &mut results);
            analysis.refer(&mut results);
            return Ok(Reached {
                scene: level,
                analysis,
                results,
            });
        }
        refuse_round_off(demand, outcome.algebraic)?;
        let mut finer = outcome.refinement.max(1.0);
        // Another shape begins a ladder of its own: worth it only where more than a rung lies ahead.
        if round == 1
            && finer > STRIDE
            && let Some(pilot) = pilot(&level, backend, extent, &results, &found, observer)
        {
            spent += pilot.work;
            let aim = AIM * outcome.mesh_share * demand;
            if let Some((shaped, needed)) = balanced(&level, &pilot.shares(aim), STRIDE) {
                let shape = resolution(&shaped, 1.0);
                if shape != settings {
                    choices.push(format!(
                        "near and far parts so fine that the error costs the fewest elements: {shape}"
                    ));
                }
                wanted = shaped;
                finer = needed.max(LEAST_STEP);
            }
        }
        // Where increments end at events they become as many times more as pairs do: fixed ones, with a ladder of their own, are dearer.
        let ends_at_pairs =
            wanted.program.stepping == Stepping::Events && !wanted.contact.is_empty();
        let more_pairs = if ends_at_pairs {
            MORE_THAN_SAID * finer
        } else {
            1.0
        };
        if outcome.path > PATH_SHARE * demand * more_pairs {
            let steps = more_steps(&mut wanted, &results, outcome.path / (PATH_SHARE * demand));
            choices.push(format!(
                "{steps} increments for each target: those at hand leave {} of error",
                percent(outcome.path)
            ));
        }
        let step = stride(&wanted, finer);
        // What a coarse mesh says of a fine one is a guess: at first only what no order of convergence could reach is refused.
        let certain = match round < TRUSTED {
            true => outcome.least.max(step),
            false => finer,
        };
        refuse_beyond_memory(demand, fine * certain, &costs, &pace)?;
        // From the mesh that was made, which rounding may have made another than was wanted.
        let made = fineness(&wanted).map_or(factor, |count| fine / count);
        factor = made * step;
        let width = results.first_yield.as_ref().map_or(0.0, |y| y.half_width);
        last = Some((level, width));
        as_fine = [BARELY_FINER, BARELY_FINER.max(NEARLY * step)].map(|more| fine * more);
    }
    Err(Error::internal("the rounds of a demand end in the loop"))
}

/// How much finer the next mesh is made on the way to one that is `finer`: equal strides, none longer than [`STRIDE`]; a mesh from a
/// file is cut in halves.
fn stride(scene: &Scene, finer: f64) -> f64 {
    if scene.mesh.file.is_some() {
        return 2.0;
    }
    let strides = (finer.ln() / STRIDE.ln()).ceil().max(1.0);
    finer.powf(1.0 / strides)
}

/// The member of the family nearest to `factor` that can be made, with its model: as fine as is aimed at or, where there is none, as the least. That its contact is
/// read well may cost it some of the aim.
fn nearest(
    scene: &Scene,
    factor: f64,
    demand: f64,
    last: Option<(&Scene, f64)>,
    [least, aim]: [f64; 2],
) -> Result<(Scene, Model)> {
    let is_as_fine = |scene: &Scene, as_that: f64| fineness(scene).is_none_or(|n| n >= as_that);
    for enough in [aim, least] {
        for more in FINER {
            let level = refined(scene, factor * more);
            let Some(level) = level.filter(|level| is_as_fine(&level.scene, enough)) else {
                continue;
            };
            let level = well_read(&level.scene, demand, last);
            if is_as_fine(&level, least)
                && let Ok(model) = Model::new(&level)
            {
                return Ok((level, model));
            }
        }
    }
    let own = refined(scene, 1.0).filter(|level| is_as_fine(&level.scene, least));
    match own {
        Some(level) => Model::new(&level.scene).map(|model| (level.scene, model)),
        None => Err(Error::input(
            "`accuracy`: the mesh of this scene has no finer members of its family",
        )),
    }
}

fn with_tolerances(scene: &Scene, demand: f64) -> Scene {
    let mut out = scene.clone();
    let read_off = out.program.targets.iter().any(|t| t.half_width.is_some());
    let loosest = if read_off { LOOSEST_READ_OFF } else { LOOSEST };
    out.analysis.tolerance = (TOLERANCE_SHARE * demand).clamp(TIGHTEST, loosest);
    out.program.gamma = (GAMMA_SHARE * demand).max(TIGHTEST);
    out
}

/// Turns to fixed steps, `factor` times as many as were taken from target to target.
fn more_steps(scene: &mut Scene, results: &Results, factor: f64) -> usize {
    let targets = scene.program.targets.len().max(1);
    let taken = match scene.program.stepping {
        Stepping::Steps => scene.program.steps,
        Stepping::Events => results.history.len().div_ceil(targets),
    };
    scene.program.stepping = Stepping::Steps;
    scene.program.steps = (taken as f64 * factor.max(1.0)).ceil().min(1e6) as usize;
    scene.program.steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strides_are_equal_and_none_too_long() {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        for (finer, wanted) in [(1.5, 1.5), (2.25, 1.5), (1.0, 1.0)] {
            assert!((stride(&scene, finer) - wanted).abs() < 1e-12);
        }
        let text = include_str!("../../data/scenes/gmsh_blocks.toml");
        let file = Scene::parse(text, "scene.toml").unwrap();
        assert_eq!(stride(&file, 1.5), 2.0);
    }
}
