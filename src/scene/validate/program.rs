//! Validation of the load program and the settings.

use super::boundary::check_axis;
use super::problems::Problems;
use crate::number::exact;
use crate::scene::{Field, History, LEAST_PATH_ERROR, Scene, Target, TargetFigure, Unit};
use std::collections::{BTreeMap, BTreeSet};

/// Bounds on the size of results: each increment adds a row to the history, and each target a state
/// with all its contact pairs.
const MOST_STEPS: usize = 10_000_000;
const MOST_TARGETS: usize = 10_000;
const MOST_CYCLES: usize = 1_000_000;

pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    let program = &scene.program;
    problems.must(
        program.gamma > 0.0 && program.gamma <= 0.5,
        "program.gamma",
        program.gamma,
        "be greater than 0 and at most 0.5",
    );
    problems.require(
        program.path_error >= LEAST_PATH_ERROR && program.path_error <= 0.1,
        "program.path_error",
        format!(
            "{} must be at least {LEAST_PATH_ERROR:e} and at most 0.1",
            exact(program.path_error)
        ),
    );
    problems.count("program.max_increments", program.max_increments, 1);
    problems.count("program.steps", program.steps, 1);
    problems.at_most("program.steps", program.steps, MOST_STEPS);
    problems.at_most("program.targets", program.targets.len(), MOST_TARGETS);
    problems.require(
        !program.targets.is_empty(),
        "program.targets",
        "is empty; give at least one, for instance { load_factor = 1 }",
    );
    problems.count("program.cycles", program.cycles, 1);
    problems.at_most("program.cycles", program.cycles, MOST_CYCLES);
    problems.must(
        program.steady > 0.0 && program.steady < 1.0,
        "program.steady",
        program.steady,
        "lie between 0 and 1",
    );
    if program.cycles > 1 {
        check_cycle(problems, &program.targets);
    }
    check_unit(problems, scene);
    check_growing(problems, &program.targets);
    check_followed_sets(problems, &program.history);
    check_targets(problems, scene);
    check_loaded(problems, scene);
    let settings = &scene.analysis;
    problems.require(
        settings.tolerance > 1e-15 && settings.tolerance < 1e-2,
        "analysis.tolerance",
        format!("{:e} must lie between 1e-15 and 1e-2", settings.tolerance),
    );
    problems.count("analysis.max_iterations", settings.max_iterations, 1);
}

/// Requires the targets of a cycle to be load factors, at least two of them different.
fn check_cycle(problems: &mut Problems, targets: &[Target]) {
    let factors: Vec<Option<f64>> = targets.iter().map(|target| target.load_factor).collect();
    for (index, _) in factors.iter().enumerate().filter(|(_, f)| f.is_none()) {
        problems.problem(
            format!("program.targets.{index}"),
            "a target of `cycles` must be a load_factor: it is met again in each",
        );
    }
    problems.require(
        factors.iter().any(|factor| *factor != factors[0]) || factors.contains(&None),
        "program.cycles",
        "all targets are the same load factor: a cycle needs at least two, its ends",
    );
}

/// Checks the unit of the program's load factors, and the keys that depend on it.
fn check_unit(problems: &mut Problems, scene: &Scene) {
    let program = &scene.program;
    if let Some(until) = program.interference_until {
        problems.positive("program.interference_until", until);
        problems.require(
            program.unit == Unit::Load,
            "program.interference_until",
            "counts in load factors of the loads as given; use `unit = \"load\"`",
        );
    }
    if program.unit == Unit::Yield {
        check_yield_known(problems, "program.unit", "\"yield\"", scene);
        for (index, load) in scene.load.iter().enumerate() {
            problems.require(
                !matches!(load.history, History::Table(_)),
                format!("load.{index}.history"),
                "is a table over the load factor, but `unit = \"yield\"` counts in the yield \
                 load, which the table itself would change; use `unit = \"load\"`",
            );
        }
    }
}

/// Checks the names of the sets that the history follows.
fn check_followed_sets(problems: &mut Problems, history: &[String]) {
    let mut followed = BTreeSet::new();
    for (index, name) in history.iter().enumerate() {
        let key = format!("program.history.{index}");
        problems.require(
            !name.is_empty(),
            key.as_str(),
            "is empty; name a set of the mesh",
        );
        let is_new = followed.insert(name.as_str());
        problems.require(is_new, key, format!("\"{name}\" is there twice"));
    }
}

/// Checks the names and the conditions of all targets.
fn check_targets(problems: &mut Problems, scene: &Scene) {
    let mut names = BTreeSet::new();
    for (index, target) in scene.program.targets.iter().enumerate() {
        let key = format!("program.targets.{index}");
        if let Some(name) = &target.name {
            problems.require(!name.is_empty(), format!("{key}.name"), "is empty");
            problems.require(
                names.insert(name.as_str()),
                format!("{key}.name"),
                format!("\"{name}\" is the name of an earlier target too"),
            );
        }
        check_target(problems, &key, target, scene);
    }
}

fn check_target(problems: &mut Problems, key: &str, target: &Target, scene: &Scene) {
    let mut conditions = vec![
        ("yield", target.first_yield),
        ("load_factor", target.load_factor.is_some()),
        ("half_width", target.half_width.is_some()),
        ("displacement", target.displacement.is_some()),
    ];
    let asked = |figure: TargetFigure| (figure.key(), target.value_of(figure).is_some());
    conditions.extend(TargetFigure::ALL.map(asked));
    problems.exactly_one(key, "target condition", &conditions);
    if target.first_yield {
        check_yield_known(problems, &format!("{key}.yield"), "true", scene);
    }
    if let Some(half_width) = target.half_width {
        let key = format!("{key}.half_width");
        problems.positive(key.as_str(), half_width);
        problems.require(
            !scene.contact.is_empty(),
            key.as_str(),
            "the scene has no contact; add a [[contact]] or choose another target",
        );
        check_yield_known(
            problems,
            &key,
            "a multiple of the half width at first yield",
            scene,
        );
    }
    check_target_figure(problems, key, target, scene);
    if let Some(displacement) = &target.displacement {
        problems.require(
            !displacement.on.is_empty(),
            format!("{key}.displacement.on"),
            "is empty; name a surface or node set of the mesh",
        );
        let direction = format!("{key}.displacement.direction");
        check_axis(problems, &direction, displacement.direction, scene.kind);
        problems.require(
            scene.any_load_varies(),
            format!("{key}.displacement"),
            "no load changes with the load factor, so nothing moves",
        );
    }
}

/// Checks what a target that prescribes a figure needs.
fn check_target_figure(problems: &mut Problems, key: &str, target: &Target, scene: &Scene) {
    let given: Vec<_> = target.figures().collect();
    for &(figure, value) in &given {
        let key = format!("{key}.{}", figure.key());
        problems.positive(key.as_str(), value);
        problems.require(
            !scene.contact.is_empty() || !figure.needs_contact(),
            key.as_str(),
            "the scene has no contact; add a [[contact]] or choose another target",
        );
        if figure.stays() {
            check_yield_known(problems, &key, "what yielding leaves", scene);
        }
        problems.require(
            scene.any_load_varies(),
            key.as_str(),
            "no load changes with the load factor, so it stays as it is",
        );
    }
    let any = |holds: fn(TargetFigure) -> bool| given.iter().any(|(figure, _)| holds(*figure));
    if let Some(body) = &target.body {
        let key = format!("{key}.body");
        problems.require(
            any(|figure| figure == TargetFigure::ResidualDepth),
            key.as_str(),
            "belongs to `residual_depth`, which is not given",
        );
        let known: Vec<&str> = scene.bodies.keys().map(String::as_str).collect();
        problems.require(
            known.contains(&body.as_str()),
            key.as_str(),
            format!(
                "the scene has no body \"{body}\"; it has {}",
                known.join(", ")
            ),
        );
    }
    if let Some(number) = target.contact {
        let key = format!("{key}.contact");
        problems.require(
            any(TargetFigure::is_of_contact),
            key.as_str(),
            "belongs to `contact_force`, `contact_area` or `max_pressure`, none of which is \
             given",
        );
        problems.require(
            (1..=scene.contact.len()).contains(&number),
            key.as_str(),
            format!(
                "{number}: contacts count from 1, and the scene has {}",
                scene.contact.len()
            ),
        );
    }
}

/// Requires, for each figure that unloading does not reduce, that no target is less than an earlier
/// one.
fn check_growing(problems: &mut Problems, targets: &[Target]) {
    let mut largest: BTreeMap<(&str, Option<&str>), f64> = BTreeMap::new();
    for (index, target) in targets.iter().enumerate() {
        for (figure, value) in target.figures().filter(|(figure, _)| figure.stays()) {
            let of = (figure.key(), target.body.as_deref());
            let before = largest.entry(of).or_insert(value);
            problems.require(
                value >= *before,
                format!("program.targets.{index}.{}", figure.key()),
                format!(
                    "{} is less than the {} of an earlier target, and unloading does not reduce it",
                    exact(value),
                    exact(*before)
                ),
            );
            *before = before.max(value);
        }
    }
}

/// Requires a body that can yield and a load that varies, for a key that refers to first yield.
pub(super) fn check_yield_known(problems: &mut Problems, key: &str, what: &str, scene: &Scene) {
    problems.require(
        scene.may_yield(),
        key,
        format!(
            "{what}, but no body can yield: give a material a yield_stress, \
             and take plastic = false off its body"
        ),
    );
    problems.require(
        scene.any_load_varies(),
        key,
        format!("{what}, but no load changes with the load factor: add a proportional load"),
    );
}

fn check_loaded(problems: &mut Problems, scene: &Scene) {
    let shrunk = scene
        .contact
        .iter()
        .any(|contact| contact.interference != Field::default() || contact.overlap)
        || (scene.mesh.disc_in_plate.as_ref()).is_some_and(|disc| disc.interference != 0.0);
    let mut bodies = scene.bodies.values();
    let brought_along = bodies.any(|body| body.brought_along().next().is_some());
    problems.require(
        !scene.load.is_empty() || shrunk || brought_along || scene.start_from.is_some(),
        "load",
        "there is no load, no interference and no initial stress: nothing happens; add a \
         [[load]]",
    );
}
