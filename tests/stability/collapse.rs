//! Limit loads, and iterations that do not converge: the one is not taken for the other.

use crate::support::{close, load, run, run_as_far_as_it_goes, run_file, sparse};
use brinell::ErrorKind;
use brinell::linalg::Backend;
use brinell::results::Results;
use brinell::scene::Scene;

/// The kind of the end, the last load factor that was held, and why the run ended.
fn end_of(scene: &Scene) -> (Option<ErrorKind>, f64, String) {
    let results = run_as_far_as_it_goes(scene, Backend::default());
    let held = results.history.last().unwrap().alpha;
    (
        results.ending().kind(),
        held,
        results.incomplete.map_or_else(String::new, |end| end.why),
    )
}

/// The blocks of the scene with square elements.
const SQUARE: [&str; 2] = [
    "mesh.parts.0.block.elements=[8,4]",
    "mesh.parts.1.block.elements=[8,4]",
];

/// Elements 75 times as high as wide: their displacements are so large beside the strains of an
/// element that forces cannot be balanced to 1e-10 in double precision. That is no limit load: the
/// state is that of square elements, and the run reports what it was balanced to. Forces off by
/// 1e-8 move strains by that over the tangent's share of the elastic stiffness, 4e-3.
#[test]
fn slender_elements_are_balanced_to_their_round_off() {
    let square = run_file("hard/slender_elements", &SQUARE);
    assert!(square.warnings.is_empty(), "{:?}", square.warnings);
    let slender = run_file("hard/slender_elements", &[]);
    assert!(slender.inaccurate.is_empty(), "{:?}", slender.inaccurate);
    let reported = slender.warnings.iter().find(|w| w.contains("round-off"));
    let reported = reported.expect("what it was balanced to");
    assert!(
        reported.contains("analysis.tolerance = 1.0e-10"),
        "{reported}"
    );
    let (a, b) = (&slender.states[0], &square.states[0]);
    assert!(a.quality.equilibrium > 1e-10, "{:?}", a.quality);
    assert!(Some(a.quality.equilibrium) <= a.quality.round_off);
    for pair in &a.pairs {
        close("pressure", pair.pressure, 400.0, 400.0, 1e-8);
    }
    let strain = b.max_equivalent_plastic_strain;
    close(
        "strain",
        a.max_equivalent_plastic_strain,
        strain,
        strain,
        1e-8 / 4e-3,
    );
}

/// Any tolerance that may be asked for is reached, or as much of it as round-off allows.
#[test]
fn a_tolerance_below_round_off_is_no_obstacle() {
    let loose = run_file("hard/slender_elements", &SQUARE);
    let [a, b] = SQUARE;
    let tight = run_file("hard/slender_elements", &[a, b, "analysis.tolerance=2e-15"]);
    assert!(tight.warnings.iter().any(|w| w.contains("round-off")));
    let strain = |r: &Results| r.states[0].max_equivalent_plastic_strain;
    close(
        "strain",
        strain(&tight),
        strain(&loose),
        strain(&loose),
        1e-10 / 4e-3,
    );
}

/// An iteration that may not iterate finds nothing anywhere, least of all a limit load: the
/// material hardens, or is far from its limit.
#[test]
fn an_iteration_that_is_cut_short_is_no_limit_load() {
    for (name, overrides) in [
        (
            "hard/nearly_incompressible",
            vec!["analysis.max_iterations=1"],
        ),
        (
            "hard/nearly_incompressible",
            vec![
                "analysis.max_iterations=1",
                "materials.steel.poissons_ratio=0.3",
            ],
        ),
    ] {
        let (kind, held, why) = end_of(&load(name, &overrides));
        assert_eq!(kind, Some(ErrorKind::Analysis), "{name}: {why}");
        assert!(held < 150.0, "{name}: {held}");
        for said in [
            "not converged",
            "no limit load",
            "analysis.max_iterations =",
            "analysis.tolerance",
            "round-off",
            "Raise analysis.max_iterations",
        ] {
            assert!(why.contains(said), "{name}: {said}: {why}");
        }
    }
}

/// A slope of 1 MPa, a millionth of the elastic stiffness, is still a slope: the load is held.
/// Strains are 100 in a bar whose theory ends at a hundredth, but there is equilibrium.
#[test]
fn the_least_hardening_has_no_limit_load() {
    let modulus = 1.0;
    let set = ["materials.steel.tangent_modulus=1.0"];
    let results = run(&load("hard/limit_load", &set));
    let plastic = 1.0 / (1.0 / modulus - 1.0 / 210_000.0);
    let strain = 250.0 / plastic;
    let found = results.states[1].max_equivalent_plastic_strain;
    // The forces balance to 1e-10 of 750, strains to that over the slope.
    close("strain", found, strain, 750.0 / plastic, 1e-9);
}

/// What has no stiffness left has collapsed, whichever iteration found it, on slender elements too,
/// and where hardening ends: at the same load as ever, the last one that equilibrium holds.
#[test]
fn a_limit_load_is_one_however_it_is_reached() {
    let slender = [0, 1].map(|i| format!("mesh.parts.{i}.block.elements=[150,1]"));
    let flat = "materials.steel.hardening_table=[[0.0,500.0],[0.01,600.0],[0.02,600.0]]";
    let short = "analysis.max_iterations=2";
    for (overrides, limit) in [
        (vec![slender[0].as_str(), slender[1].as_str()], 1.0),
        (vec![flat], 1.2),
        (vec!["analysis.plastic_iteration=plain", short], 1.0),
        (vec!["analysis.plastic_iteration=anderson", short], 1.0),
        (vec!["program.stepping=steps", "program.steps=3"], 1.0),
    ] {
        let (kind, held, why) = end_of(&load("hard/limit_load", &overrides));
        assert_eq!(kind, Some(ErrorKind::Collapse), "{overrides:?}: {why}");
        assert!(why.contains("of the elastic stiffness is left"), "{why}");
        // Increments are cut to a millionth of the load step; four times that is the last that was
        // not.
        close(&format!("{overrides:?}"), held, limit, 1.0, 4e-6);
    }
}

/// Near a limit load tangents have little stiffness left, and beyond it none. They are factored
/// where conjugate gradients on the elastic factor take long, by the sparse backends and not by the
/// dense one: the path and its end are the same. Increments beyond the limit are given up when the
/// structure flows away, after a few iterations: searched to their end they took 100,000 solves.
#[test]
fn tangents_are_factored_where_little_stiffness_is_left() {
    let set = [
        "mesh.parts.0.ring.elements=[6,4]",
        "mesh.parts.0.element=tri6",
    ];
    let scene = load("hard/nearly_incompressible", &set);
    let dense = run_as_far_as_it_goes(&scene, Backend::Dense);
    assert_eq!(dense.counts.zone_factorizations, 0);
    assert!(dense.counts.trailing_solves < 3000, "{:?}", dense.counts);
    for backend in sparse() {
        let factored = run_as_far_as_it_goes(&scene, backend);
        let [a, b] = [&factored, &dense].map(|results| {
            assert_eq!(results.ending().kind(), Some(ErrorKind::Collapse));
            results.history.last().unwrap().alpha
        });
        // Both bracket the limit within the smallest increment, 1e-6 of the last piece of 15, and
        // what the cuts by four leave of that.
        close("limit load", a, b, 15.0, 8e-6);
        let [a, b] = [&factored, &dense].map(|r| r.states[1].max_equivalent_plastic_strain);
        close("strain", a, b, b, 1e-7);
        let counts = &factored.counts;
        assert_eq!(counts.factorizations, 1);
        assert!((1..60).contains(&counts.zone_factorizations), "{counts:?}");
        let solves = dense.counts.trailing_solves as f64;
        assert!(
            (counts.trailing_solves as f64) < 0.85 * solves,
            "{counts:?}, {solves}"
        );
    }
}

/// A tube that flows before it meets its sleeve: the load lies three times beyond its own limit,
/// and what holds it is contact that closes on the way. The wall carries `2 k ln(b/a)`, as always
/// in plane strain (R. Hill, The Mathematical Theory of Plasticity, chapter V), the sleeve the
/// rest.
#[test]
fn a_tube_is_expanded_into_its_sleeve() {
    let text = |stepping: &str| {
        let ring = |body: &str, radii: &str| {
            format!(
                "[[mesh.parts]]\nbody = \"{body}\"\nelement = \"quad4\"\n\
                 ring = {{ radius = {radii}, elements = [8, 8] }}\n\
                 [[support]]\non = \"{body}.start\"\nfix = [\"y\"]\n\
                 [[support]]\non = \"{body}.end\"\nfix = [\"x\"]\n"
            )
        };
        format!(
            "kind = \"plane_strain\"\n\
             materials.hard = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}\n\
             materials.tube.youngs_modulus = 210e3\n\
             materials.tube.poissons_ratio = 0.3\n\
             materials.tube.yield_stress = 240.0\n\
             bodies = {{ tube.material = \"tube\", sleeve.material = \"hard\" }}\n\
             contact = [{{ first = \"tube.outer\", second = \"sleeve.inner\", gap = 0.5 }}]\n\
             load = [{{ on = \"tube.inner\", pressure = 1.0 }}]\n\
             program.stepping = \"{stepping}\"\nprogram.steps = 8\n\
             program.targets = [{{ load_factor = 45.0 }}, {{ load_factor = 150.0 }}]\n{}{}",
            ring("tube", "[100.0, 120.0]"),
            ring("sleeve", "[120.0, 200.0]")
        )
    };
    for stepping in ["auto", "events", "steps"] {
        let results = run(&crate::support::parse(&text(stepping)));
        let wall = 2.0 / 3.0f64.sqrt() * 240.0 * 1.2f64.ln();
        let state = &results.states[1];
        // Elements of a sixteenth of a right angle and an eighth of the wall: of second order.
        let expected = 150.0 - wall;
        close(stepping, state.max_pressure, expected, expected, 0.02);
        assert!(state.pairs.iter().all(|pair| pair.pressure > 0.0));
    }
}
