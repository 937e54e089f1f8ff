//! Refusals of effects: back stresses, yield stress by depth, cycles, supports that change.

use super::*;

fn steel(scene: &mut Scene) -> &mut crate::scene::Material {
    scene.materials.get_mut("steel").unwrap()
}

#[test]
fn back_stresses() {
    refused(
        good,
        &[
            (
                |s| steel(s).kinematic_modulus = Some(-1.0),
                "kinematic_modulus: -1 must be at least 0",
            ),
            (
                |s| steel(s).back_stresses = Some(vec![]),
                "back_stresses: is empty; give rows of",
            ),
            (
                |s| steel(s).back_stresses = Some(vec![[5.0, 0.0], [-5.0, 3.0]]),
                "back_stresses.1: [-5, 3]: modulus C and rate gamma must be at least 0",
            ),
            (
                |s| steel(s).back_stresses = Some(vec![[5.0, -3.0]]),
                "back_stresses.0: [5, -3]: modulus C and rate gamma must be at least 0",
            ),
            (
                |s| steel(s).back_stresses = Some(vec![[0.0, 3.0]]),
                "back_stresses.0: [0, 3] is a rate gamma without a modulus C",
            ),
            (
                |s| steel(s).back_stresses = Some(vec![[5.0, 1e101]]),
                "back_stresses.0: the rate is",
            ),
            (
                |s| {
                    steel(s).plastic_modulus = None;
                    steel(s).yield_stress = None;
                    steel(s).back_stresses = Some(vec![[5.0, 3.0]]);
                },
                "back_stresses: needs a yield_stress",
            ),
        ],
    );
}

#[test]
fn yield_stress_by_depth() {
    fn cylinder(scene: &mut Scene) -> &mut crate::scene::Body {
        let body = scene.bodies.get_mut("cylinder").unwrap();
        body.yield_by_depth = Some(vec![[0.0, 900.0], [1.0, 500.0]]);
        body
    }
    refused(
        good,
        &[
            (
                |s| cylinder(s).yield_by_depth = Some(vec![]),
                "bodies.cylinder.yield_by_depth: is empty; give rows of [depth, yield stress]",
            ),
            (
                |s| cylinder(s).yield_by_depth = Some(vec![[-1.0, 500.0]]),
                "yield_by_depth.0: depth -1 must be at least 0",
            ),
            (
                |s| cylinder(s).yield_by_depth = Some(vec![[0.0, 900.0], [0.0, 500.0]]),
                "yield_by_depth.1: depth 0 must be greater than 0 of the row before",
            ),
            (
                |s| cylinder(s).yield_by_depth = Some(vec![[0.0, -900.0]]),
                "yield_by_depth.0: -900 must be greater than zero",
            ),
            (
                |s| {
                    cylinder(s);
                    steel(s).plastic_modulus = None;
                    steel(s).yield_stress = None;
                },
                "yield_by_depth: the material \"steel\" has no yield stress",
            ),
            (
                |s| {
                    cylinder(s).depth_from = Some("cylinder.top".into());
                    cylinder(s).yield_by_depth = None;
                },
                "bodies.cylinder.depth_from: without yield_by_depth",
            ),
        ],
    );
}

#[test]
fn cycles() {
    fn load_factors(scene: &mut Scene, factors: &[f64]) {
        let target = |factor: &f64| Target {
            load_factor: Some(*factor),
            ..Target::default()
        };
        scene.program.targets = factors.iter().map(target).collect();
        scene.program.cycles = 10;
    }
    let mut scene = good();
    load_factors(&mut scene, &[1.0, 0.0]);
    scene.validate().unwrap();
    refused(
        good,
        &[
            (
                |s| s.program.steady = 0.0,
                "program.steady: 0 must lie between 0 and 1",
            ),
            (
                |s| s.program.cycles = 0,
                "program.cycles: 0 must be at least 1",
            ),
            (|s| s.program.cycles = 2_000_000, "program.cycles: 2000000"),
            (
                |s| s.program.cycles = 2,
                "program.targets.0: a target of `cycles` must be a load_factor",
            ),
            (
                |s| load_factors(s, &[1.0, 1.0]),
                "program.cycles: all targets are the same load factor",
            ),
        ],
    );
}

/// A scene whose first support may begin at load factor 1, with targets at 1 and 2.
fn in_legs() -> Scene {
    let mut scene = good();
    let program = &mut scene.program;
    program.unit = Unit::Load;
    program.targets = [1.0, 2.0]
        .map(|factor| Target {
            load_factor: Some(factor),
            ..Target::default()
        })
        .to_vec();
    scene.support[0].since = Some(1.0);
    scene
}

fn displaced(scene: &mut Scene) -> &mut crate::scene::Load {
    scene.load[0].plane_force = None;
    scene.load[0].displacement = Some(Displacement {
        y: Some((-1.0).into()),
        ..Displacement::default()
    });
    &mut scene.load[0]
}

#[test]
fn supports_that_change() {
    in_legs().validate().unwrap();
    refused(
        in_legs,
        &[
            (
                |s| s.support[0].since = Some(-1.0),
                "support.0.since: -1 must be greater than zero",
            ),
            (
                |s| s.support[0].since = Some(1.5),
                "support.0.since: 1.5 must be the load factor of a target",
            ),
            (
                |s| s.support[0].since = Some(2.0),
                "support.0.since: 2 must be the load factor of a target, and not of the last",
            ),
            (
                |s| s.support[0].until = Some([1.0, 2.0]),
                "support.0.until: must ascend, and begin beyond `since`",
            ),
            (
                |s| {
                    s.support[0].since = None;
                    s.support[0].until = Some([1.0, 0.5]);
                },
                "support.0.until: must ascend",
            ),
            (
                |s| {
                    s.support[0].since = None;
                    s.support[0].until = Some([1.0, 1.5]);
                    s.support[1].until = Some([1.0, 2.0]);
                },
                "support.1.until: is free at 2, others that end at 1 at 1.5",
            ),
            (
                |s| s.load[0].since = Some(1.0),
                "load.0.since: is for a prescribed `displacement`",
            ),
            (
                |s| displaced(s).since = Some(1.0),
                "load.0.history: must be a table with a row beyond `since`",
            ),
            (
                |s| {
                    displaced(s).since = Some(1.0);
                    s.load[0].history = History::Table(vec![[0.0, 0.0], [1.0, 1.0]]);
                },
                "load.0.history: must be a table with a row beyond `since`",
            ),
            (
                |s| s.program.targets[1].load_factor = Some(0.5),
                "support.0: begins or ends within the program, whose targets must be load factors",
            ),
            (
                |s| s.program.unit = Unit::Yield,
                "support.0: begins or ends within the program, which needs `unit",
            ),
            (
                |s| {
                    let plane = crate::scene::RigidPlane {
                        point: [0.0, 5.0].into(),
                        normal: [0.0, -1.0].into(),
                    };
                    let surface = crate::scene::RigidSurface {
                        plane: Some(plane),
                        ..Default::default()
                    };
                    s.rigid.insert("tool".into(), surface);
                },
                "support.0: begins or ends within the program, which is not for scenes with",
            ),
            (
                |s| s.program.cycles = 2,
                "support.0: begins or ends within the program, which needs `unit",
            ),
        ],
    );
}
