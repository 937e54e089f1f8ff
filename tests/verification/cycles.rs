//! Programs of cycles: Bree's problem, and a line contact pressed again and again.
//!
//! Source: J. Bree, Elastic-plastic behaviour of thin tubes subjected to internal pressure and
//! intermittent high-heat fluxes, J. Strain Analysis 2 (1967) 226, doi:10.1243/03093247V023226: a
//! wall under a constant stress `sigma_p` whose temperature changes linearly across it in each
//! cycle, by elastic stresses of `+-sigma_t` at its faces; perfectly plastic, uniaxial.

use crate::support::{parse, run, run_file, run_text};
use crate::verification::close;
use crate::verification::start_from::run_into;
use brinell::results::{CycleOutcome, Results};

const E: f64 = 200_000.0;
const Y: f64 = 200.0;

/// A wall of thickness 1 that stays straight, stresses over the yield stress.
fn wall(primary: f64, thermal: f64, layers: usize, cycles: usize) -> Results {
    let alpha = 1e-5;
    let text = format!(
        r#"
kind = "plane_stress"
support = [{{ on = "wall.left", fix = ["x"] }}, {{ on = "wall.bottom_left", fix = ["y"] }}]
[[load]]
on = "wall.right"
plane_force = {{ direction = "x", total = {:?} }}
history = "constant"
[[load]]
on = "wall"
temperature = "{:?} * (2*y - 1)"
[[mesh.parts]]
body = "wall"
element = "quad8"
block = {{ x = [0.0, 1.0], y = [0.0, 1.0], elements = [1, {layers}] }}
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
yield_stress = {Y:?}
thermal_expansion = {alpha:?}
[bodies.wall]
material = "metal"
[program]
targets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
cycles = {cycles}
"#,
        primary * Y,
        thermal * Y / (E * alpha)
    );
    run_text(&text)
}

/// Bree's regions: elastic below X + Y = 1, shakedown, plastic cycling beyond Y = 2 where X Y < 1,
/// ratchetting beyond X + Y/4 = 1.
#[test]
fn a_wall_shakes_down_where_bree_says() {
    for (primary, thermal, outcome) in [
        (0.3, 0.6, CycleOutcome::Elastic),
        (0.3, 1.2, CycleOutcome::ElasticShakedown),
        (0.6, 1.5, CycleOutcome::ElasticShakedown),
        (0.0, 1.9, CycleOutcome::ElasticShakedown),
        (0.0, 2.2, CycleOutcome::PlasticShakedown),
        (0.2, 3.0, CycleOutcome::PlasticShakedown),
        (0.7, 1.4, CycleOutcome::Ratchetting),
        (0.8, 1.6, CycleOutcome::Ratchetting),
    ] {
        let results = wall(primary, thermal, 16, 200);
        let cycles = results.cycles.as_ref().unwrap();
        let words = format!("{primary} {thermal}: {:?}", cycles.rows);
        assert_eq!(cycles.outcome, outcome, "{words}");
        assert!(cycles.rows.len() < 100, "{words}");
        // The states are those of the last cycle.
        assert_eq!(results.states.len(), 2);
        assert_eq!(results.states[0].alpha, 1.0);
        let grows = outcome == CycleOutcome::Ratchetting;
        assert_eq!(grows, cycles.last().growth > 1e-5, "{words}");
    }
}

/// Between the limits of shakedown and ratchetting the wall grows in each cycle by
/// `2 sigma_t/E (1 - 2 sqrt((Y - sigma_p)/sigma_t))`.
#[test]
fn a_wall_ratchets_at_brees_rate() {
    for (primary, thermal) in [(0.7, 1.6), (0.8, 1.6)] {
        let exact = 2.0 * thermal * Y / E * (1.0 - 2.0 * ((1.0 - primary) / thermal).sqrt());
        let errors: Vec<f64> = [8, 32]
            .map(|layers| {
                let results = wall(primary, thermal, layers, 60);
                let cycles = results.cycles.unwrap();
                assert_eq!(cycles.outcome, CycleOutcome::Ratchetting);
                assert_eq!(cycles.body.as_deref(), Some("wall"));
                cycles.last().growth / exact - 1.0
            })
            .to_vec();
        assert!(errors[1].abs() < 0.02, "{errors:?} of {exact}");
        assert!(errors[1].abs() < 0.6 * errors[0].abs() + 2e-3, "{errors:?}");
    }
}

/// A cycle that was not like the next when the number ran out says so, and is no shakedown.
#[test]
fn too_few_cycles_are_not_steady() {
    let cycles = wall(0.8, 1.6, 8, 2).cycles.unwrap();
    assert_eq!(cycles.outcome, CycleOutcome::NotSteady);
    assert_eq!(cycles.rows.len(), 2);
}

/// A hardening line contact pressed again and again: it shakes down, and the states of the last
/// cycle are those of the program written out.
#[test]
fn a_contact_shakes_down_and_is_what_the_cycles_written_out_give() {
    let coarse = "mesh.cylinder_on_half_plane.resolution=4";
    let pair = "{ load_factor = 1.6 }, { load_factor = 0.2 }";
    let cycles = run_file(
        "hard/cyclic",
        &[
            coarse,
            "program.cycles=30",
            &format!("program.targets=[{pair}]"),
        ],
    );
    let found = cycles.cycles.as_ref().unwrap();
    assert_eq!(
        found.outcome,
        CycleOutcome::ElasticShakedown,
        "{:?}",
        found.rows
    );
    let n = found.rows.len();
    assert!(n < 30, "{n}");
    let all = vec![pair; n].join(", ");
    let written_out = run_file(
        "hard/cyclic",
        &[coarse, &format!("program.targets=[{all}]")],
    );
    assert_eq!(written_out.history, cycles.history);
    assert_eq!(written_out.counts, cycles.counts);
    for (cycle, other) in cycles.states.iter().zip(&written_out.states[2 * n - 2..]) {
        close(cycle.max_pressure, other.max_pressure, 1e-14);
        assert_eq!(cycle.plastic_points, other.plastic_points);
    }
}

/// Beside the limit of ratchetting a wall grows by a thousandth of its first flow in each cycle:
/// that is no shakedown, however little it is.
#[test]
fn slow_ratchetting_is_no_shakedown() {
    for (thermal, outcome) in [
        (1.18, CycleOutcome::ElasticShakedown),
        (1.21, CycleOutcome::Ratchetting),
    ] {
        let cycles = wall(0.7, thermal, 16, 200).cycles.unwrap();
        assert_eq!(cycles.outcome, outcome, "{thermal}: {:?}", cycles.rows);
        let ratio = cycles.last().growth / cycles.rows[0].flow;
        let grows = outcome == CycleOutcome::Ratchetting;
        assert!(
            ratio < if grows { 0.02 } else { 1e-3 },
            "{thermal}: {ratio}"
        );
    }
}

/// A sheet that was pulled before: its cycles are its own, and what the earlier run left is none.
#[test]
fn cycles_after_an_earlier_run_do_not_count_what_that_left() {
    let text = |load: &str, program: &str| {
        format!(
            "kind = \"plane_stress\"\n{load}\n\
             support = [{{ on = \"b.bottom\", fix = [\"y\"] }}, \
             {{ on = \"b.left\", fix = [\"x\"] }}]\n\
             [[mesh.parts]]\nbody = \"b\"\n\
             block = {{ x = [0, 1], y = [0, 1], elements = [2, 1] }}\n\
             [materials.m]\nyoungs_modulus = 200000.0\npoissons_ratio = 0.3\n\
             yield_stress = 200.0\n\
             back_stresses = [[20000.0, 100.0]]\n[bodies.b]\nmaterial = \"m\"\n\
             [program]\nstepping = \"steps\"\nsteps = 20\n{program}\n"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("pulled");
    let pulled = text(
        "load = [{ on = \"b.top\", displacement = { y = 0.3 } }]",
        "targets = [{ load_factor = 1.0 }, { load_factor = 0.99 }]",
    );
    run_into(&parse(&pulled), &dir);
    let cycled = text(
        "load = [{ on = \"b.top\", traction = [0.0, 1.0] }]",
        "cycles = 300\ntargets = [{ load_factor = 260.0 }, { load_factor = -255.0 }]",
    );
    let virgin = parse(&cycled);
    let mut after = virgin.clone();
    after.start_from = Some(dir);
    let [virgin, after] = [virgin, after].map(|scene| run(&scene).cycles.unwrap());
    for cycles in [&virgin, &after] {
        assert_eq!(
            cycles.outcome,
            CycleOutcome::Ratchetting,
            "{:?}",
            cycles.rows
        );
    }
    // The rate depends on the law and on the stresses alone.
    close(after.last().growth, virgin.last().growth, 1e-2);
    assert!(
        after.rows[0].flow < 0.1,
        "the sheet was pulled by 0.3 before"
    );
}
