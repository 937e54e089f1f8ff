//! Validation of supports and prescribed displacements that begin or end within the program.

use super::problems::Problems;
use crate::number::exact;
use crate::scene::span::Span;
use crate::scene::{Load, Scene, Unit};
use std::collections::BTreeMap;

/// Checks where supports and prescribed displacements begin and end, and what the program must
/// be for that.
pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    for (index, load) in scene.load.iter().enumerate() {
        check_span_of_load(problems, &format!("load.{index}"), load);
    }
    let changing: Vec<(String, Span)> = (scene.spans())
        .filter(|(_, span)| !span.is_whole())
        .collect();
    for (key, span) in &changing {
        check_span(problems, key, *span, scene);
    }
    let mut ends: BTreeMap<u64, f64> = BTreeMap::new();
    for (key, span) in &changing {
        if let Some([until, gone]) = span.until {
            let first = *ends.entry(until.to_bits()).or_insert(gone);
            problems.require(
                first == gone,
                format!("{key}.until"),
                format!(
                    "is free at {}, others that end at {} at {}: give one for all",
                    exact(gone),
                    exact(until),
                    exact(first)
                ),
            );
        }
    }
    if let Some((key, _)) = changing.first() {
        check_program(problems, key, scene);
    }
}

fn check_span_of_load(problems: &mut Problems, key: &str, load: &Load) {
    let given = [
        ("since", load.since.is_some()),
        ("until", load.until.is_some()),
    ];
    for (name, _) in given.into_iter().filter(|(_, is_given)| *is_given) {
        problems.require(
            load.displacement.is_some() || load.relative.is_some(),
            format!("{key}.{name}"),
            "is for a prescribed `displacement` or `relative`; other loads begin and end by \
             their `history`",
        );
    }
    if load.since.is_some() {
        problems.require(
            load.arrives().is_some() || load.stays(),
            format!("{key}.history"),
            "must be a table with a row beyond `since`, whose value the nodes then reach, or \
             \"constant\" for what stays as it is",
        );
    }
}

fn check_span(problems: &mut Problems, key: &str, span: Span, scene: &Scene) {
    let targets = &scene.program.targets;
    let last = targets.last().and_then(|target| target.load_factor);
    let at_target = |at: f64| {
        let factors = || targets.iter().filter_map(|target| target.load_factor);
        factors().any(|factor| factor == at) && last.is_some_and(|last| at < last)
    };
    let hint = "must be the load factor of a target, and not of the last: the program goes on \
                with other supports from a state that it has reached";
    if let Some(since) = span.since {
        let key = format!("{key}.since");
        problems.positive(key.as_str(), since);
        problems.require(at_target(since), key, format!("{} {hint}", exact(since)));
    }
    if let Some([until, gone]) = span.until {
        let key = format!("{key}.until");
        problems.positive(key.as_str(), until);
        problems.require(
            at_target(until),
            key.as_str(),
            format!("{} {hint}", exact(until)),
        );
        problems.require(
            gone > until && span.since.is_none_or(|since| since < until),
            key,
            "must ascend, and begin beyond `since`: [held up to, free at]",
        );
    }
}

fn check_program(problems: &mut Problems, key: &str, scene: &Scene) {
    let program = &scene.program;
    problems.require(
        program.unit == Unit::Load && program.cycles == 1,
        key,
        "begins or ends within the program, which needs `unit = \"load\"` and no `cycles`",
    );
    problems.require(
        scene.rigid.is_empty(),
        key,
        "begins or ends within the program, which is not for scenes with [rigid] surfaces: \
         give the tool a mesh, or let its load fall by its `history`",
    );
    let factors: Vec<Option<f64>> = program.targets.iter().map(|t| t.load_factor).collect();
    let ascend = factors.windows(2).all(|pair| pair[0] <= pair[1]);
    problems.require(
        ascend && factors.first().is_some_and(|first| *first >= Some(0.0)),
        key,
        "begins or ends within the program, whose targets must be load factors that do not \
         fall: let loads fall by their `history`",
    );
}
