//! Refusals of programs, settings and references.

use super::*;

fn by_figure(set: impl Fn(&mut Target)) -> Target {
    let mut target = Target::default();
    set(&mut target);
    target
}

fn target(scene: &mut Scene, target: Target) {
    scene.program.targets = vec![target];
}

#[test]
fn programs_and_settings() {
    refused(
        good,
        &[
            (|s| s.program.targets.clear(), "program.targets: is empty"),
            (|s| s.program.gamma = 0.0, "program.gamma: 0 must be"),
            (|s| s.program.gamma = 0.6, "program.gamma: 0.6 must be"),
            (|s| s.program.steps = 0, "program.steps: 0 must be"),
            (
                |s| s.analysis.tolerance = 1e-2,
                "analysis.tolerance: 1e-2 must lie",
            ),
            (
                |s| s.analysis.tolerance = 1e-15,
                "analysis.tolerance: 1e-15 must lie",
            ),
            (
                |s| s.analysis.max_iterations = 0,
                "analysis.max_iterations: 0",
            ),
            (
                |s| target(s, Target::default()),
                "program.targets.0: no target condition",
            ),
            (
                |s| {
                    let both = Target {
                        first_yield: true,
                        load_factor: Some(1.0),
                        ..Target::default()
                    };
                    target(s, both);
                },
                "2 of target condition given (yield, load_factor)",
            ),
            (
                |s| s.program.targets[1].name = Some("yield".into()),
                "program.targets.1.name: \"yield\" is the name of an earlier target",
            ),
            (
                |s| s.program.targets[4].half_width = Some(0.0),
                "program.targets.4.half_width: 0 must be greater",
            ),
        ],
    );
}

#[test]
fn targets_by_a_figure() {
    refused(
        good,
        &[
            (
                |s| {
                    let both = Target {
                        residual_depth: Some(1e-3),
                        approach: Some(1.0),
                        ..Target::default()
                    };
                    target(s, both);
                },
                "2 of target condition given (residual_depth, approach)",
            ),
            (
                |s| target(s, by_figure(|t| t.contact_force = Some(-5.0))),
                "program.targets.0.contact_force: -5 must be greater",
            ),
            (
                |s| {
                    let named = |t: &mut Target| {
                        (t.residual_depth, t.body) = (Some(1.0), Some("roller".into()));
                    };
                    target(s, by_figure(named));
                },
                "targets.0.body: the scene has no body \"roller\"; it has cylinder, half_plane",
            ),
            (
                |s| {
                    let numbered = |t: &mut Target| {
                        (t.max_pressure, t.contact) = (Some(1.0), Some(2));
                    };
                    target(s, by_figure(numbered));
                },
                "program.targets.0.contact: 2: contacts count from 1, and the scene has 1",
            ),
            (
                |s| {
                    let of_contact = |t: &mut Target| {
                        (t.approach, t.contact) = (Some(1.0), Some(1));
                    };
                    target(s, by_figure(of_contact));
                },
                "program.targets.0.contact: belongs to `contact_force`",
            ),
            (
                |s| {
                    let of_body = |t: &mut Target| {
                        (t.approach, t.body) = (Some(1.0), Some("cylinder".into()));
                    };
                    target(s, by_figure(of_body));
                },
                "program.targets.0.body: belongs to `residual_depth`",
            ),
            (
                |s| {
                    target(s, by_figure(|t| t.residual_depth = Some(2.0)));
                    let less = by_figure(|t| t.residual_depth = Some(1.0));
                    s.program.targets.push(less);
                },
                "program.targets.1.residual_depth: 1 is less than the 2 of an earlier target",
            ),
            (
                |s| {
                    target(
                        s,
                        by_figure(|t| t.max_equivalent_plastic_strain = Some(0.1)),
                    );
                    s.bodies.values_mut().for_each(|b| b.plastic = Plastic::No);
                },
                "max_equivalent_plastic_strain: what yielding leaves, but no body",
            ),
        ],
    );
}

#[test]
fn targets_that_need_contact_yielding_or_a_load() {
    refused(
        good,
        &[
            (
                |s| s.contact.clear(),
                "half_width: the scene has no contact",
            ),
            (
                |s| s.bodies.values_mut().for_each(|b| b.plastic = Plastic::No),
                "program.unit: \"yield\", but no body can yield",
            ),
            (
                |s| s.load[0].history = History::Constant,
                "program.unit: \"yield\", but no load changes with the load factor",
            ),
            (
                |s| s.load[0].history = History::Table(vec![[0.0, 0.0], [1.0, 1.0]]),
                "load.0.history: is a table over the load factor, but `unit = \"yield\"`",
            ),
            (
                |s| {
                    s.program.unit = Unit::Load;
                    s.load[0].history = History::Constant;
                    let moved = Target {
                        displacement: Some(DisplacementTarget {
                            on: "cylinder.top".into(),
                            direction: Direction::Y,
                            value: -0.1,
                        }),
                        ..Target::default()
                    };
                    target(s, moved);
                },
                "program.targets.0.displacement: no load changes",
            ),
        ],
    );
}

#[test]
fn references() {
    refused(
        good,
        &[
            (
                |s| s.kind = Kind::Axisymmetric,
                "reference.0.hertz_line: line contact needs",
            ),
            (
                |s| s.reference[0].value = Some(1.0),
                "reference.0.value: belongs to a `quantity`",
            ),
            (
                |s| s.reference[0].hertz_line = None,
                "reference.0: no reference",
            ),
            (
                |s| {
                    s.reference[0].hertz_line = None;
                    s.reference[0].quantity = Some("yield.load".into());
                    s.reference[0].value = Some(1.0);
                },
                "reference.0.source: is missing",
            ),
        ],
    );
    let mut scene = good();
    scene.reference.push(Reference {
        hertz_line: None,
        hertz_point: None,
        hertz_ellipse: None,
        disc_in_plate: None,
        quantity: Some("yield.load".into()),
        at: None,
        body: None,
        value: Some(1.0),
        source: Some("hand".into()),
    });
    scene.validate().unwrap();
    // A quantity at a point needs coordinates, any other quantity must have none.
    let bad = |change: &dyn Fn(&mut Reference)| {
        let mut scene = scene.clone();
        change(scene.reference.last_mut().unwrap());
        scene.validate().unwrap_err().to_string()
    };
    let named = bad(&|r| r.quantity = Some("states.a.stress_xx".into()));
    assert!(named.contains("is one of a place"), "{named}");
    let named = bad(&|r| r.at = Some(vec![0.0, 0.0]));
    assert!(
        named.contains("belongs to a quantity of a place"),
        "{named}"
    );
    let place = |r: &mut Reference| {
        r.quantity = Some("states.a.pressure".into());
        r.at = Some(vec![0.0]);
        r.body = Some("nobody".into());
    };
    let named = bad(&place);
    assert!(
        named.contains("needs 2 coordinates, 1 are given"),
        "{named}"
    );
    assert!(named.contains("there is no body `nobody`"), "{named}");
}
