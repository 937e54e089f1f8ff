//! What `accuracy = x` costs beside the cheapest setting that a user could have picked by hand, and graded meshes beside uniform ones:
//! in floating point operations, which no busy machine disturbs.
//!
//! The cheapest is that of the uniform meshes of the study from which on all are as accurate; one that is so by chance, and the graded ones, which no hand
//! picks, are told beside it, and so is the time. The hand knows the true error and needs one run; the program has to run coarser meshes to know its own, but reports what
//! all of them lead to together, which is better than the finest of them. All demands keep to twice the cheapest.

use crate::effectivity::run_to;
use crate::running;
use brinell::accuracy::{
    Extent, Knob, Meter, Plan, Setting, Study, StudyRun, reach, settings, study,
};
use brinell::linalg::Backend;
use brinell::progress::Silent;
use brinell::scene::{AccuracyDemand, Scene};

/// What a demand may cost over the cheapest uniform mesh that is as accurate: twice, and a little for orderings that differ from machine to machine.
const MOST: f64 = 2.1;

/// Seconds below which times are the median of so many pairs of runs.
const SHORT: f64 = 0.1;
const PAIRS: usize = 5;

/// A reference scene, where closed forms tell the true error.
struct Case {
    name: &'static str,
    scene: Scene,
    extent: Extent,
    quantities: &'static [&'static str],
    demands: &'static [f64],
    /// Meshes in a series.
    levels: usize,
    /// What graded meshes may cost over uniform ones of the same error; `None` where the generator has none.
    graded: Option<f64>,
}

const CONTACT: &[&str] = &["yield.load", "yield.max_pressure", "yield.half_width"];

fn cases() -> Vec<Case> {
    let yielding = "program.targets=[{ yield = true }]";
    let contact = |name: &str, resolution: usize, far: &str| {
        let growth = 1.2048f64.powf(12.0 / resolution as f64);
        running::load(
            name,
            &[
                yielding,
                "materials.steel.yield_stress=50.0",
                &format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
                &format!("mesh.cylinder_on_half_plane.growth={growth}"),
                far,
            ],
        )
    };
    vec![
        Case {
            name: "Hertz line",
            scene: contact(
                "cylinder_on_half_plane",
                12,
                "mesh.cylinder_on_half_plane.far_size=20000.0",
            ),
            extent: Extent::Yield,
            quantities: CONTACT,
            demands: &[0.1, 0.03, 0.01, 0.003],
            levels: 5,
            graded: Some(0.56),
        },
        Case {
            name: "Hertz point",
            scene: contact(
                "ball_on_half_space",
                17,
                "mesh.cylinder_on_half_plane.far_size=2000.0",
            ),
            extent: Extent::Yield,
            quantities: CONTACT,
            demands: &[0.1, 0.03, 0.01, 0.003],
            levels: 6,
            graded: Some(0.4),
        },
        Case {
            name: "disc in a plate",
            scene: running::load(
                "disc_in_plate",
                &[
                    yielding,
                    "mesh.disc_in_plate.resolution=44",
                    "mesh.disc_in_plate.growth=1.10",
                ],
            ),
            extent: Extent::Yield,
            quantities: &["yield.load", "yield.half_width"],
            demands: &[0.1, 0.03, 0.01, 0.003],
            levels: 5,
            graded: Some(1.0),
        },
        Case {
            name: "thick cylinder",
            scene: running::load("thick_cylinder", &[yielding]),
            extent: Extent::Yield,
            quantities: &["yield.alpha"],
            demands: &[0.1, 0.03, 0.01, 0.003],
            levels: 5,
            graded: Some(1.3),
        },
        Case {
            name: "flat punch, limit load",
            scene: running::load("flat_punch", &[]),
            extent: Extent::Program,
            quantities: &["states.flow.load"],
            demands: &[0.1, 0.03, 0.01, 0.003],
            levels: 6,
            graded: None,
        },
    ]
}

/// Errors of the runs of a series, coarse to fine, with what they cost.
fn series<'s>(found: &'s Study, case: &Case, knob: Knob) -> Vec<(f64, f64, &'s StudyRun)> {
    let error = |run: usize| {
        let errors = case.quantities.iter().map(|name| {
            let quantity = found.quantities.iter().find(|q| q.quantity == *name);
            quantity.unwrap().errors[run].unwrap()
        });
        errors.fold(0.0, f64::max)
    };
    let runs = found
        .runs
        .iter()
        .enumerate()
        .filter(|(_, r)| r.knob == knob);
    let mut out: Vec<(f64, f64, &StudyRun)> = runs.map(|(i, r)| (error(i), r.work, r)).collect();
    out.sort_by(|a, b| b.2.ratio.total_cmp(&a.2.ratio));
    for (error, work, run) in &out {
        println!(
            "  {} {}: {} freedoms, {work:.2e} operations, error {error:.2e}",
            run.series, run.value, run.freedoms
        );
    }
    out
}

/// The coarsest run that is as accurate, be it by chance: an error that crosses zero, an edge that falls well.
fn luckiest(runs: &[(f64, f64, &StudyRun)], accuracy: f64) -> Option<f64> {
    runs.iter().find(|r| r.0 <= accuracy).map(|r| r.1)
}

/// The coarsest run from which on all are as accurate: not by chance.
fn cheapest<'s>(
    runs: &[(f64, f64, &'s StudyRun)],
    accuracy: f64,
) -> Option<(f64, f64, &'s StudyRun)> {
    let missed = runs.iter().rposition(|r| r.0 > accuracy);
    runs.get(missed.map_or(0, |i| i + 1)).copied()
}

/// What came of something, and the seconds it took.
fn timed<T>(what: impl FnOnce() -> T) -> (T, f64) {
    let meter = Meter::start();
    let out = what();
    (out, meter.stop().undisturbed_seconds())
}

/// Seconds of a run of the study, made again.
fn run_again(case: &Case, run: &StudyRun) -> f64 {
    let made = settings(
        &case.scene,
        Backend::default(),
        &[Knob::Resolution],
        case.levels,
    );
    let same = |s: &&Setting| s.series == run.series && s.value == run.value;
    let scene = &made.iter().find(same).unwrap().scene;
    timed(|| run_to(scene, case.extent)).1
}

/// The median of the ratio of the second time to the first.
fn in_pairs(first: &dyn Fn() -> f64, second: &dyn Fn() -> f64) -> f64 {
    let mut ratios = [0.0; PAIRS].map(|_: f64| {
        let first = first();
        second() / first
    });
    ratios.sort_by(f64::total_cmp);
    ratios[PAIRS / 2]
}

/// Operations from which on a series stays below an error, between its runs along a power law; those of its first run where all do.
fn price(runs: &[(f64, f64, &StudyRun)], error: f64) -> Option<f64> {
    let Some(above) = runs.iter().rposition(|r| r.0 > error) else {
        return Some(runs.first()?.1);
    };
    let [last, next] = [runs[above], *runs.get(above + 1)?];
    let share = (last.0 / error).ln() / (last.0 / next.0).ln();
    Some(last.1 * (next.1 / last.1).powf(share))
}

#[test]
fn a_demand_costs_little_more_than_the_cheapest_setting_picked_by_hand() {
    let mut ratios: Vec<f64> = Vec::new();
    let mut missed: Vec<String> = Vec::new();
    let mut table = "| scene | accuracy | over the cheapest | over one by chance | over the graded | in time |\n".to_string();
    for case in cases() {
        println!("{}", case.name);
        let plan = Plan {
            knobs: match case.graded {
                Some(_) => vec![Knob::Resolution, Knob::Grading],
                None => vec![Knob::Resolution],
            },
            levels: case.levels,
            budget: None,
        };
        let found = study(&case.scene, Backend::default(), &plan, &mut Silent).unwrap();
        let uniform = series(&found, &case, Knob::Resolution);
        let graded = series(&found, &case, Knob::Grading);
        println!("  {:?}", found.grading);
        if case.graded.is_some() {
            assert_eq!(graded.len(), uniform.len(), "{}", case.name);
            assert!(found.grading.as_ref().unwrap().work < uniform.last().unwrap().1);
        }
        for run in &found.runs {
            let names: Vec<&str> = run.phases.iter().map(|p| p.phase.as_str()).collect();
            assert!(
                names.starts_with(&["assembly", "factorisation"]),
                "{names:?}"
            );
            let wall: f64 = run.phases.iter().map(|p| p.wall_seconds).sum();
            assert!(wall > 0.0 && wall <= run.usage.wall_seconds);
        }
        for &accuracy in case.demands {
            let mut scene = case.scene.clone();
            scene.accuracy = Some(AccuracyDemand::new(accuracy).unwrap());
            let demanded = || reach(&scene, Backend::default(), case.extent, &mut Silent).unwrap();
            let (reached, seconds) = timed(demanded);
            let demand = reached.results.accuracy.unwrap().demand.unwrap();
            let rows = reached.results.reference.iter();
            let actual = rows
                .filter(|r| case.quantities.contains(&r.quantity.as_str()))
                .map(|r| (r.ratio - 1.0).abs())
                .fold(0.0, f64::max);
            // No mesh of the study may be so accurate.
            let hand = cheapest(&uniform, accuracy);
            let in_time = hand.map_or(f64::NAN, |(.., run)| match seconds {
                0.0..SHORT => in_pairs(&|| run_again(&case, run), &|| timed(demanded).1),
                _ => seconds / run.usage.undisturbed_seconds(),
            });
            let by_hand = hand.map_or(f64::NAN, |h| h.1);
            let graded_by_hand = cheapest(&graded, accuracy).map_or(f64::NAN, |h| h.1);
            let ratio = demand.work / by_hand;
            let lucky = demand.work / luckiest(&uniform, accuracy).unwrap_or(f64::NAN);
            println!(
                "  {accuracy}: stated {:.2e}, true {actual:.2e}, {:.2e} operations, {ratio:.2} of {by_hand:.2e} ({lucky:.2} of one by chance), \
                 {:.2} of the graded {graded_by_hand:.2e}, {in_time:.2} in time, {seconds:.3} s\n  {:#?}",
                demand.stated,
                demand.work,
                demand.work / graded_by_hand,
                demand.choices
            );
            table += &format!(
                "| {} | {} % | {ratio:.2} | {lucky:.2} | {:.2} | {in_time:.2} |\n",
                case.name,
                100.0 * accuracy,
                demand.work / graded_by_hand
            );
            if !(demand.reached && actual <= accuracy) {
                missed.push(format!("{} {accuracy}: true {actual}", case.name));
            }
            if ratio > MOST {
                missed.push(format!("{} {accuracy}: {ratio}", case.name));
            }
            ratios.push(ratio);
        }
        // Where the grading pays, and that it never costs much: at the errors of the uniform meshes, the one in the middle.
        let prices = uniform.iter().filter_map(|run| {
            let share = price(&graded, run.0)? / price(&uniform, run.0)?;
            println!("  graded for {:.2e}: {share:.2} of the operations", run.0);
            Some(share)
        });
        let mut prices: Vec<f64> = prices.collect();
        prices.sort_by(f64::total_cmp);
        if let Some(most) = case.graded {
            let middle = prices[prices.len() / 2];
            println!("  in the middle {middle:.2}");
            if middle > most {
                missed.push(format!("{} graded: {middle}", case.name));
            }
        }
    }
    ratios.retain(|r| !r.is_nan());
    let kept = ratios.iter().filter(|r| **r <= 2.0).count();
    println!(
        "{table}{kept} of {} cost at most twice the cheapest",
        ratios.len()
    );
    assert!(ratios.len() >= 18, "{table}");
    assert!(missed.is_empty(), "{missed:#?}");
}
