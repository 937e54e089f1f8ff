//! Many cycles.

use crate::running::{healthy, load, run, same_contact};
use brinell::scene::Target;

/// Sums of increments drift: a thousand cycles of rounding, or of an equilibrium that is only nearly one, add up. Here displacements,
/// gaps and forces are total, history is committed with an increment: after shakedown the states of each cycle repeat to round-off.
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
