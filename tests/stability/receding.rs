//! Receding contact: surfaces that conform before the load lose contact with the first bit of it.

use crate::support::{close, healthy, load, run, run_file, same_contact};
use brinell::results::{Results, State, Status};

/// The disc in the plate under S along x and `ratio` S along y, at loads from 1e-6 to 1e6.
fn biaxial(ratio: f64) -> Results {
    let kirsch = format!(
        "load.tension.kirsch={{ stress_x = 100.0, stress_y = {}, radius = 10.0 }}",
        100.0 * ratio
    );
    run(&load(
        "hard/zero_gap_conforming",
        &[&kirsch, "materials.steel.youngs_modulus=200000.0"],
    ))
}

fn closed(state: &State) -> usize {
    state
        .pairs
        .iter()
        .filter(|p| p.status == Status::Closed)
        .count()
}

/// Which nodes touch is decided at infinitesimal load, where all gaps and forces are zero: codes
/// that start from "all closed" iterate on statuses whose violations are round-off, and the answer
/// depends on the size of the load. The extent shrinks as the second tension grows, and vanishes
/// where the hole's radial displacement (1 + l) + 2 (1 - l) cos 2 theta (Kirsch) is positive all
/// round: l = 1/3.
#[test]
fn biaxial_loads_from_shear_to_the_one_at_which_contact_vanishes() {
    let mut before = usize::MAX;
    for ratio in [-0.9, -0.5, 0.0, 0.2, 0.3] {
        let results = biaxial(ratio);
        healthy(&results);
        let one = &results.states[1];
        let count = closed(one);
        assert!(
            count > 0 && count <= before,
            "ratio {ratio}: {count} closed, before {before}"
        );
        before = count;
        for (s, factor) in results.states.iter().zip([1e-6, 1.0, 1e6, 1.0]) {
            assert_eq!(closed(s), count, "ratio {ratio}, load {factor}");
            for (a, b) in one.pairs.iter().zip(&s.pairs) {
                close(
                    "pressure over load",
                    b.pressure / factor,
                    a.pressure,
                    one.max_pressure,
                    1e-12,
                );
            }
        }
    }
    for ratio in [0.4, 1.0, 2.0] {
        let results = biaxial(ratio);
        healthy(&results);
        for s in &results.states {
            assert_eq!(
                (closed(s), s.contact_force),
                (0, 0.0),
                "ratio {ratio}, {}",
                s.name
            );
        }
    }
}

/// A load applied in one step: codes that search for partners in the deformed state leave part of a
/// surface unpaired (Kratos: pressure spikes), penalty codes report convergence with pressures ten
/// times too large (CalculiX). The path is elastic: one step and the path from event to event end
/// in the same state.
#[test]
fn one_step_ends_where_the_path_does() {
    for name in [
        "hard/zero_gap_conforming",
        "hard/one_pair",
        "hard/unload_reload",
        "hard/interference",
    ] {
        let elastic = |extra: &[&str]| {
            let mut scene = load(name, extra);
            for body in scene.bodies.values_mut() {
                body.plastic = brinell::scene::Plastic::No;
            }
            scene.program.unit = brinell::scene::Unit::Load;
            scene
                .program
                .targets
                .retain(|t| t.load_factor.is_some_and(|f| f != 0.0));
            let last = scene.program.targets.len() - 1;
            scene.program.targets.swap(0, last);
            run(&scene)
        };
        let path = elastic(&[]);
        let step = elastic(&["program.stepping=steps", "program.steps=1"]);
        for (a, b) in path.states.iter().zip(&step.states) {
            same_contact(name, a, b, 1e-10);
        }
    }
}

/// From one touching node to a patch in one step: no pair is left out (the pressure falls from the
/// pole to the edge, whole surface), and it is the state that the path from event to event ends in.
#[test]
fn a_load_in_one_step_pairs_the_whole_surface() {
    let step = run_file("hard/one_step", &[]);
    healthy(&step);
    let pressed = &step.states[0];
    assert!(closed(pressed) >= 10, "{}", closed(pressed));
    for pair in pressed.pairs.windows(2) {
        // The pole is the last.
        assert!(pair[0].pressure <= pair[1].pressure, "{pair:?}");
    }
    let path = run_file("hard/one_step", &["program.stepping=events"]);
    assert!(path.history.len() >= 10);
    same_contact("one step", &path.states[0], pressed, 1e-10);
}

/// The extent hardly depends on the load: the one at first yield is there already when it is asked
/// for. (Once the load went down to nothing in search of it.)
#[test]
fn a_half_width_that_is_there_already_needs_no_way() {
    let results = run(&load(
        "disc_in_plate",
        &[
            "mesh.disc_in_plate.resolution=12",
            "program.targets=[{ yield = true }, { half_width = 1.0 }]",
        ],
    ));
    healthy(&results);
    let [at_yield, there] = &results.states[..] else {
        panic!("two states")
    };
    close("load", there.load, at_yield.load, at_yield.load, 1e-9);
}
