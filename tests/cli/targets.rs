//! Targets that cannot be met, and how that is told.

use super::refusals::refused_with;

#[test]
fn targets_that_are_never_reached() {
    refused_with(
        "thick_cylinder",
        &[
            "mesh.parts.0.ring.elements=[2,2]",
            "materials.steel.plastic_modulus=1000.0",
            "program.targets=[{name=\"far\",\
             displacement={on=\"tube.inner\",direction=\"x\",value=-5.0}}]",
        ],
        &[],
        5,
        &["target `far` was never reached"],
    );
}

/// Targets by a figure: what can be known before the run is refused there, what shows on the way
/// ends as that does.
#[test]
fn targets_by_figures_that_cannot_be_met() {
    let ball = [
        "mesh.cylinder_on_half_plane.resolution=3",
        "mesh.cylinder_on_half_plane.far_size=30",
    ];
    for (targets, code, fragment) in [
        (
            "{residual_depth=-1}",
            2,
            "residual_depth: -1 must be greater than zero",
        ),
        ("{contact_force=1,approach=1}", 2, "keep exactly one"),
        ("{residual_dept=1}", 2, "did you mean `residual_depth`?"),
        (
            "{residual_depth=1,body=\"bal\"}",
            2,
            "no body \"bal\"; it has cylinder, half_plane",
        ),
        (
            "{contact_force=1,contact=0}",
            2,
            "contacts count from 1, and the scene has 1",
        ),
    ] {
        let targets = format!("program.targets=[{targets}]");
        refused_with(
            "ball_on_half_space",
            &[ball[0], ball[1], &targets],
            &[],
            code,
            &[fragment, "program.targets"],
        );
    }
}

/// A set that the history is to follow and the mesh does not have, and one that is there twice.
#[test]
fn sets_that_no_history_can_follow() {
    for (history, fragment) in [
        (
            "\"upper.lop\"",
            "history 1 `upper.lop`: the mesh has no such set, did you mean `upper.top`?",
        ),
        (
            "\"upper.top\", \"upper.top\"",
            "program.history.1: \"upper.top\" is there twice",
        ),
    ] {
        let history = format!("program.history=[{history}]");
        refused_with("contact_patch", &[&history], &[], 2, &[fragment]);
    }
}
