//! Many cycles.

use crate::support::{close, healthy, load, run, same_contact};
use brinell::results::State;
use brinell::scene::{Scene, Target};

/// Sums of increments drift: a thousand cycles of rounding, or of an equilibrium that is only
/// nearly one, add up. Here displacements, gaps and forces are total, history is committed with an
/// increment: after shakedown the states of each cycle repeat to round-off.
#[test]
fn a_thousand_cycles_do_not_drift() {
    let mut scene = load("hard/cyclic", &[]);
    let cycle: Vec<Target> = scene.program.targets[scene.program.targets.len() - 2..].to_vec();
    let kept = |name: String, target: &Target, fields| Target {
        name: Some(name),
        fields,
        ..target.clone()
    };
    for k in 6..=1000 {
        for target in &cycle {
            let side = target.name.as_deref().unwrap().split(' ').next().unwrap();
            scene
                .program
                .targets
                .push(kept(format!("{side} {k}"), target, false));
        }
    }
    for target in &mut scene.program.targets {
        target.fields = false;
    }
    let results = run(&scene);
    healthy(&results);
    let n = results.states.len();
    assert!(n >= 2000);
    // From the sixth cycle on.
    for side in 0..2 {
        let (early, late) = (
            &results.states[n - 1990 + side],
            &results.states[n - 2 + side],
        );
        same_contact(&late.name, early, late, 1e-10);
        let strain = early.max_equivalent_plastic_strain;
        let drift = (late.max_equivalent_plastic_strain - strain).abs();
        assert!(drift <= 1e-10 * strain, "{}: {drift:e}", late.name);
    }
}

/// A constant stress `s` along y, the strain along x cycled by `+-e` (`E = 2e5`, `Y = 200`,
/// `s = 100`, `e = 0.003`). At yield the stress along x is `s/2 +- q` with `q^2 = Y^2 - 3/4 s^2`,
/// where it stays while a perfectly plastic material flows by `p = 2 e - 2 q / E` along x, and by
/// `(2 s - sx)/(2 sx - s)` of that along y: `3 s p / (2 q)` in each cycle, for ever.
#[test]
fn a_perfectly_plastic_sheet_ratchets_by_the_same_amount_in_each_of_a_thousand_cycles() {
    let (modulus, y, s, e) = (2e5f64, 200.0f64, 100.0f64, 0.003f64);
    let mut scene = load("hard/ratchet", &[]);
    cycle_to(&mut scene, 1000);
    let results = run(&scene);
    let q = (y * y - 0.75 * s * s).sqrt();
    let p = 2.0 * e - 2.0 * q / modulus;
    let equivalent = p * y / q;
    let outward: Vec<_> = results.states.iter().step_by(2).collect();
    assert_eq!(outward.len(), 1000);
    // Displacement along y of the last node, a corner of the top.
    let length = |state: &State| *state.fields.as_ref().unwrap().displacement.last().unwrap();
    let (mut worst, mut drift) = (0.0f64, 0.0f64);
    for (k, pair) in outward.windows(2).enumerate() {
        let grown = length(pair[1]) - length(pair[0]);
        let total = length(outward[k + 1]) - length(outward[0]);
        worst = worst.max((grown / (1.5 * s * p / q) - 1.0).abs());
        drift = drift.max((total / ((k + 1) as f64 * 1.5 * s * p / q) - 1.0).abs());
        let strain = pair[1].max_equivalent_plastic_strain - pair[0].max_equivalent_plastic_strain;
        worst = worst.max((strain / (2.0 * equivalent) - 1.0).abs());
    }
    // Forces balance to 1e-10 of the largest; a strain without stiffness behind it is worth (E/H =
    // infinite) more than that, but the total is measured against strains 1e3 times the elastic
    // ones.
    assert!(worst <= 1e-7, "{worst:e}");
    assert!(drift <= 1e-8, "{drift:e}");
}

/// The same with isotropic hardening: the yield surface grows until the cycle is elastic,
/// `q = E e`, and then nothing moves any more. What tells one from the other is the growth from
/// cycle to cycle: the same for ever, or shrinking geometrically.
#[test]
fn a_hardening_sheet_shakes_down() {
    let (modulus, y, s, e, h) = (2e5f64, 200.0f64, 100.0f64, 0.003f64, 5000.0);
    let mut scene = load("hard/ratchet", &["materials.metal.plastic_modulus=5000"]);
    cycle_to(&mut scene, 300);
    let results = run(&scene);
    let grown: Vec<f64> = results
        .states
        .windows(2)
        .map(|pair| pair[1].max_equivalent_plastic_strain - pair[0].max_equivalent_plastic_strain)
        .collect();
    for pair in grown.windows(2).skip(1) {
        assert!(pair[1] <= pair[0] * (1.0 + 1e-9) + 1e-12, "{pair:?}");
    }
    assert!(
        grown[1] > 1e-4 && grown[grown.len() - 1] <= 1e-9 * grown[1],
        "{grown:?}"
    );
    let last = results.states.last().unwrap().max_equivalent_plastic_strain;
    let at_rest = ((modulus * e).powi(2) + 0.75 * s * s).sqrt();
    close(
        "plastic strain",
        last,
        (at_rest - y) / h,
        (at_rest - y) / h,
        1e-8,
    );
}

/// Goes on with the last two targets of a scene, `n` cycles in all.
fn cycle_to(scene: &mut Scene, n: usize) {
    let targets = &mut scene.program.targets;
    let cycle: Vec<Target> = targets[targets.len() - 2..].to_vec();
    for k in targets.len() / 2 + 1..=n {
        for target in &cycle {
            let name = target.name.as_deref().unwrap();
            let side = name.split(' ').next().unwrap();
            targets.push(Target {
                name: Some(format!("{side} {k}")),
                ..target.clone()
            });
        }
    }
}
