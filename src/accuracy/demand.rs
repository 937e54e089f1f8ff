//! `accuracy = "1 %"`: the settings that reach a demanded accuracy, chosen from coarse runs, checked afterwards.
//!
//! Everything follows from the one number `x`:
//!
//! | setting | chosen so that |
//! |---|---|
//! | mesh | the stated error of every governing quantity is at most `x` of its largest size in the run |
//! | `gamma` | `x / 300`: below a hundredth of `x` it is not seen beside the mesh (measured: `data/accuracy`) |
//! | plastic tolerance | `x / 300`, at most 1e-6: looser ones save little and miss targets that are read off the state |
//! | increments | the path's part of the stated error is at most `x / 3`; fixed steps where events leave fewer |
//!
//! A pilot run on a coarse mesh states its error and its order; from them the next mesh is aimed at, at most [`STRIDE`] times finer,
//! until one reaches the demand. Memory and time of a mesh are predicted from the symbolic factorisation before it is run: what
//! does not fit is refused with its price.

use super::estimate::{Extent, SAFETY, estimate};
use super::knobs::resolution;
use super::meter::{Pace, available_memory, forecast};
use super::quantities::quantities;
use super::refinement::{FEWEST, governing_count, largest_order, refined};
use crate::analysis::Analysis;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Observer;
use crate::results::{Accuracy, Demand, Results};
use crate::scene::{Scene, Stepping};
use std::time::Instant;

/// The tolerances are this share of the demand.
const TOLERANCE_SHARE: f64 = 1.0 / 300.0;
/// Tightest tolerance that is chosen: the scene's default.
const TIGHTEST: f64 = 1e-10;
/// Loosest tolerance of the plastic iteration that is chosen. A half width as target is read off a state that must not
/// scatter: with 1e-4 a target was missed.
const LOOSEST: f64 = 1e-6;
/// Share of the demand that the path may take.
const PATH_SHARE: f64 = 1.0 / 3.0;
/// Elements over what governs, in the first pilot run.
const PILOT: f64 = 1.2 * FEWEST;
/// A mesh is at most this many times finer than the one it is aimed from: beyond, an observed order is a guess.
const STRIDE: f64 = 2.0;
/// What is aimed at, of what is demanded: the error of a contact edge scatters.
const AIM: f64 = 0.8;
/// Runs before the demand is given up.
const ROUNDS: usize = 8;
/// Rounds from which on the prediction of the mesh that will do is believed.
const TRUSTED: usize = 3;
/// Share of the free memory that a run may take.
const MEMORY_SHARE: f64 = 0.9;
/// Bytes of the results, mesh and assembly per byte of the factor at its peak.
const BESIDE_FACTOR: f64 = 2.0;

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
/// round-off or beyond the memory; else those of the runs. A demand that was not reached within the rounds is no
/// error: [`Demand::reached`] says so.
pub fn reach(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    observer: &mut dyn Observer,
) -> Result<Reached> {
    let Some(demand) = scene.accuracy.map(|a| a.relative()) else {
        return Err(Error::input("the scene demands no accuracy"));
    };
    let Some(count) = governing_count(&scene.mesh) else {
        return Err(Error::input(
            "`accuracy`: the mesh comes from a file and cannot be refined; take the key out, or use a generator",
        ));
    };
    let mut wanted = with_tolerances(scene, demand);
    let mut choices = vec![format!(
        "tolerance {:.1e} and gamma {:.1e}: a 300th of the demand, the former at most {LOOSEST:e}",
        wanted.analysis.tolerance, wanted.program.gamma
    )];
    let mut factor = PILOT / count;
    let mut pace = Pace::default();
    let mut costs: Vec<Cost> = Vec::new();
    for round in 1..=ROUNDS {
        let level = nearest(&wanted, factor)?;
        let settings = resolution(&level, 1.0);
        observer.phase(&format!("accuracy {}: {settings}", percent(demand)));
        let cost = forecast(&level, backend)?;
        let begun = Instant::now();
        let mut analysis = Analysis::new(Model::new(&level)?, backend)?;
        let mut results = match extent {
            Extent::Yield => analysis.yield_load(observer)?,
            Extent::Program => analysis.run(observer)?,
        };
        let mut found = estimate(&level, backend, &results, extent, observer);
        let seconds = begun.elapsed().as_secs_f64();
        pace.learn(cost.seconds, seconds);
        costs.push(Cost {
            factor,
            memory: cost.factor.memory_bytes,
            forecast: cost.seconds,
        });
        let outcome = Outcome::of(&results, &found, demand, largest_order(scene));
        choices.push(format!(
            "{settings}: stated error {} in {seconds:.2} s{}",
            percent(outcome.stated),
            outcome
                .worst
                .as_ref()
                .map_or(String::new(), |w| format!(" ({w})"))
        ));
        let reached = outcome.stated <= demand;
        let stop = reached
            || round == ROUNDS
            || observer.stop_requested()
            || results.incomplete.is_some()
            || !outcome.stated.is_finite();
        if stop {
            found.demand = Some(Demand {
                accuracy: demand,
                reached,
                stated: outcome.stated,
                choices,
            });
            results.accuracy = Some(found);
            return Ok(Reached {
                scene: level,
                analysis,
                results,
            });
        }
        refuse_round_off(demand, &outcome)?;
        if outcome.path > PATH_SHARE * demand {
            let steps = more_steps(&mut wanted, &results, outcome.path / (PATH_SHARE * demand));
            choices.push(format!(
                "{steps} increments for each target: those at hand leave {} of error",
                percent(outcome.path)
            ));
        }
        let finer = outcome.refinement.max(1.0);
        // What a coarse mesh says of a fine one is a guess: at first only what no order of convergence could reach is refused.
        let certain = match round < TRUSTED {
            true => outcome.least.max(finer.min(STRIDE)),
            false => finer,
        };
        refuse_beyond_memory(demand, factor * certain, &costs, &pace)?;
        factor *= finer.min(STRIDE);
    }
    Err(Error::internal("the rounds of a demand end in the loop"))
}

/// What a run says about the next.
struct Outcome {
    /// Largest stated relative error of the governing quantities; NaN where none is known.
    stated: f64,
    /// Which quantity has it.
    worst: Option<String>,
    /// Largest part of the path.
    path: f64,
    /// Largest part of the algebra.
    algebraic: f64,
    /// How many times finer the mesh must be.
    refinement: f64,
    /// The same with the highest order and the safety factor left out.
    least: f64,
}

impl Outcome {
    fn of(results: &Results, found: &Accuracy, demand: f64, highest: f64) -> Self {
        let mut out = Outcome {
            stated: f64::NAN,
            worst: None,
            path: 0.0,
            algebraic: 0.0,
            refinement: 1.0,
            least: 1.0,
        };
        for (quantity, errors) in quantities(results).iter().zip(&found.quantities) {
            let Some(relative) = errors.relative_error.filter(|_| quantity.governs) else {
                continue;
            };
            if out.stated.is_nan() || relative > out.stated {
                out.stated = relative;
                out.worst = Some(errors.quantity.clone());
            }
            out.path = out.path.max(errors.path.unwrap_or(0.0) / quantity.scale);
            out.algebraic = out.algebraic.max(errors.algebraic / quantity.scale);
            let mesh = SAFETY * errors.discretisation.unwrap_or(0.0) / quantity.scale;
            let needed = mesh
                / (AIM * (1.0 - PATH_SHARE * f64::from(u8::from(errors.path.is_some()))) * demand);
            if relative > demand {
                let least = errors.discretisation.unwrap_or(0.0) / quantity.scale / demand;
                out.least = out.least.max(least.powf(1.0 / highest));
                out.refinement = out
                    .refinement
                    .max(needed.powf(1.0 / errors.order.unwrap_or(1.0)));
            }
        }
        // A mesh that is not finer says nothing new.
        if out.stated > demand {
            out.refinement = out.refinement.max(1.2);
        }
        out
    }
}

/// Predicted cost of a mesh.
struct Cost {
    factor: f64,
    memory: f64,
    forecast: f64,
}

/// The member of the family nearest to `factor` that can be made.
fn nearest(scene: &Scene, factor: f64) -> Result<Scene> {
    let tries = [1.0, 1.1, 1.25, 1.5, 2.0];
    tries
        .iter()
        .find_map(|more| {
            let level = refined(scene, factor * more)?;
            Model::new(&level.scene).is_ok().then_some(level.scene)
        })
        .or_else(|| refined(scene, 1.0).map(|l| l.scene))
        .ok_or_else(|| {
            Error::input("`accuracy`: the mesh of this scene has no finer members of its family")
        })
}

fn with_tolerances(scene: &Scene, demand: f64) -> Scene {
    let mut out = scene.clone();
    let share = (TOLERANCE_SHARE * demand).max(TIGHTEST);
    out.analysis.tolerance = share.min(LOOSEST);
    out.program.gamma = share;
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

fn refuse_round_off(demand: f64, outcome: &Outcome) -> Result<()> {
    if outcome.algebraic <= demand {
        return Ok(());
    }
    Err(Error::input(format!(
        "an accuracy of {} is below round-off: the algebra alone leaves {}, however fine the mesh; demand no less",
        percent(demand),
        percent(outcome.algebraic)
    )))
}

/// Memory and time of a mesh as a power of its fineness, from those predicted so far (two unknowns of the plane's factor: it
/// fills a little faster than the mesh).
fn refuse_beyond_memory(demand: f64, factor: f64, costs: &[Cost], pace: &Pace) -> Result<()> {
    let Some(last) = costs.last() else {
        return Ok(());
    };
    let power = |f: &dyn Fn(&Cost) -> f64, low: f64, high: f64| match costs.first() {
        Some(first) if last.factor > 1.3 * first.factor => {
            ((f(last) / f(first)).ln() / (last.factor / first.factor).ln()).clamp(low, high)
        }
        _ => high,
    };
    let finer = (factor / last.factor).max(1.0);
    let memory = BESIDE_FACTOR * last.memory * finer.powf(power(&|c| c.memory, 2.0, 2.4));
    let seconds = pace.seconds(last.forecast * finer.powf(power(&|c| c.forecast, 2.0, 3.2)));
    match available_memory() {
        Some(free) if memory > MEMORY_SHARE * free => Err(Error::new(
            ErrorKind::Input,
            format!(
                "{} would take about {} and {:.0} GB, and {:.0} GB are free: the mesh would have to be {finer:.0} times finer than the \
                 last one tried; demand less, or name fewer targets",
                percent(demand),
                duration(seconds),
                memory / 1e9,
                free / 1e9
            ),
        )),
        _ => Ok(()),
    }
}

fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value {
        v if !v.is_finite() => "of unknown size".to_string(),
        v if v != 0.0 && v.abs() < 1e-3 => format!("{v:.1e} %"),
        v => {
            let digits = (1 - v.abs().max(1e-300).log10().floor() as i32).clamp(0, 6) as usize;
            format!("{v:.digits$} %")
        }
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.1e} days", s / 86400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_is_told_in_readable_units() {
        assert_eq!(percent(0.003), "0.30 %");
        assert_eq!(percent(0.1), "10 %");
        assert_eq!(percent(1e-8), "1.0e-6 %");
        assert_eq!(duration(10_800.0), "3 h");
        assert_eq!(duration(90.0), "90 s");
    }

    #[test]
    fn what_does_not_fit_is_refused_with_its_price() {
        let cost = |factor: f64| Cost {
            factor,
            memory: 1e9 * factor * factor,
            forecast: factor.powi(3),
        };
        let costs = [cost(1.0), cost(2.0)];
        let pace = Pace::default();
        assert!(refuse_beyond_memory(0.01, 2.0, &costs[..1], &pace).is_ok());
        if available_memory().is_some() {
            let error = refuse_beyond_memory(1e-5, 2e4, &costs, &pace).unwrap_err();
            assert!(
                error.message().starts_with("0.0010 % would take about"),
                "{error}"
            );
            assert!(error.message().contains(" GB"), "{error}");
        }
    }
}
