//! Loss of accuracy is noticed: figures of quality mean something in every state.

use crate::support::program::{program, stderr};
use crate::support::{close, run_file, state};

/// Relative to what little is left after unloading, round-off looks like an error of 100 %, and
/// users learn to overlook the figure. Relative to the largest load and displacement of the run, an
/// unloaded state is as good as a loaded one.
#[test]
fn an_unloaded_floating_state_is_as_good_as_a_loaded_one() {
    for (name, last) in [
        ("hard/all_closed", "unloaded"),
        ("hard/separation", "unloaded"),
    ] {
        let results = run_file(name, &[]);
        let q = state(&results, last).quality;
        // Gaps are hit within gamma = 1e-8, forces balance to 1e-10 (analysis.tolerance).
        for (figure, value, bound) in [
            ("backward error", q.backward_error, 1e-14),
            ("equilibrium", q.equilibrium, 1e-9),
            ("complementarity", q.complementarity, 1e-9),
            ("penetration", q.penetration, 1e-8),
            ("adhesion", q.adhesion, 1e-9),
        ] {
            assert!(value <= bound, "{name}, {figure}: {value:e} > {bound:e}");
        }
    }
}

/// A body falls through a gap: its rigid motion costs nothing, so the contact force knows nothing
/// of the gap. Codes that take it from stiffness times displacement lose a digit for each factor of
/// ten.
#[test]
fn the_contact_force_does_not_know_the_gap() {
    for gap in ["1e-6", "1.0", "1e4", "1e8"] {
        let results = run_file("hard/floating_body", &[&format!("contact.0.gap={gap}")]);
        for (s, force) in results.states.iter().zip([20.0, 5.0, 20.0]) {
            close("force", s.contact_force, force, force, 1e-12);
        }
    }
}

/// Nor do the stresses: what a body falls through, or is lifted by, is no part of what deforms it.
/// Codes that take strains from the whole displacement hold four digits of them where it is 1e12
/// times the deformation, and none at 1e16.
#[test]
fn stresses_do_not_know_the_gap() {
    for key in ["gap", "interference"] {
        for size in ["1e4", "1e8", "1e10", "1e12", "1e15"] {
            let results = run_file("contact_patch", &[&format!("contact.0.{key}={size}")]);
            assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
            let s = &results.states[0];
            let stress = &s.fields.as_ref().unwrap().stress;
            assert!(!stress.is_empty());
            for of_element in stress.chunks(4) {
                close(&format!("{key} {size}"), of_element[1], -10.0, 10.0, 1e-11);
            }
            let q = s.quality;
            assert!(q.equilibrium > 0.0 && q.equilibrium <= 1e-13, "{q:?}");
            // Moved by so much, surfaces are where they should be to half a digit of it.
            assert!(q.penetration <= f64::EPSILON, "{q:?}");
        }
    }
}

/// The zone's strains are those of the whole model: what yields below a body that fell far is what
/// yields below one that did not.
#[test]
fn plastic_flow_does_not_know_the_gap() {
    let flow = |gap: &str| {
        let set = format!("contact.0.gap={gap}");
        let results = run_file("hard/all_closed", &[&set]);
        assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
        // Of strains of a tenth, and of nothing else.
        let mut warnings = results.warnings.iter();
        assert!(
            warnings.all(|w| w.contains("taken for small")),
            "{:?}",
            results.warnings
        );
        let plastic = state(&results, "plastic");
        assert!(plastic.plastic_points > 0);
        plastic.max_equivalent_plastic_strain
    };
    let touching = flow("0.0");
    for gap in ["1.0", "1e8", "1e12"] {
        // Forces balance to 1e-10, strains to 6e-8 of 600 / 1000.
        close(gap, flow(gap), touching, 0.6, 1e-9);
    }
}

/// What is iterated too loosely: forces that are a hundredth out of balance.
const LOOSE: [&str; 2] = [
    "analysis.plastic_iteration=plain",
    "analysis.tolerance=0.0099",
];

/// No result with a bad residual looks like a good one: a warning, `inaccurate` in the summary, and
/// an exit code of its own; none of that with a good one.
#[test]
fn lost_accuracy_has_a_warning_and_an_exit_code() {
    let folder = std::env::temp_dir().join(format!("brinell-inaccurate-{}", std::process::id()));
    let tight = [LOOSE[0], "analysis.tolerance=1e-9"];
    for (set, code) in [(tight, 0), (LOOSE, 7)] {
        let mut command = program();
        command
            .args(["run", "-q", "--json", "--no-estimate"])
            .args(["--set", set[0], "--set", set[1]])
            .arg("--out")
            .arg(&folder)
            .arg(crate::support::scene_file("hard/unload_reload"));
        let output = crate::support::limit::output(&mut command);
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let inaccurate = summary["inaccurate"].as_array().unwrap();
        let warnings = summary["warnings"].as_array().unwrap();
        assert_eq!(inaccurate.is_empty(), code == 0, "{inaccurate:?}");
        assert!(inaccurate.iter().all(|i| warnings.contains(i)));
        let told = stderr(&output).contains("equilibrium");
        assert_eq!(told, code != 0);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// Whoever loosens the iteration to one in a hundred must not be told that one in a hundred is
/// good: figures have a tolerance that no setting moves.
#[test]
fn a_loose_iteration_does_not_loosen_what_counts_as_good() {
    let loose = run_file("hard/unload_reload", &LOOSE);
    assert!(loose.quality.equilibrium > 1e-3, "{:?}", loose.quality);
    assert!(!loose.inaccurate.is_empty());
    assert!(
        loose
            .inaccurate
            .iter()
            .all(|i| i.contains("allowed 1.0e-3")),
        "{:?}",
        loose.inaccurate
    );
    let tight = run_file("hard/unload_reload", &[LOOSE[0], "analysis.tolerance=1e-9"]);
    assert!(tight.inaccurate.is_empty(), "{:?}", tight.inaccurate);
}

/// Every run says at least how badly its matrix is conditioned and how well each row of it was
/// solved, for the price of a pass over the matrix. The condition is estimated where the user asks
/// for it and where accuracy is in doubt, and not paid for elsewhere.
#[test]
fn the_condition_is_estimated_where_it_matters() {
    let usual = run_file("hard/three_in_a_row", &[]);
    assert_eq!(usual.condition_estimate, None);
    // A factor solves each row to a few rounding errors for each of its entries (18), and of those
    // of the factor's row.
    for q in usual
        .states
        .iter()
        .map(|s| s.quality)
        .chain([usual.quality])
    {
        let omega = q.componentwise_error.unwrap();
        assert!(omega > 0.0 && omega <= 1e-13, "{q:?}");
    }
    let asked = run_file("hard/three_in_a_row", &["analysis.condition=true"]);
    let estimate = asked.condition_estimate.unwrap();
    assert!(
        estimate >= asked.condition && estimate < 1e8,
        "{estimate:e} {:e}",
        asked.condition
    );
    // Two bodies float, and a row of slivers is worse by the square of their aspect.
    let slivers = run_file("hard/slivers", &["analysis.condition=true"])
        .condition_estimate
        .unwrap();
    assert!(slivers > 1e3 * estimate, "{slivers:e} {estimate:e}");
    let doubtful = run_file("hard/unload_reload", &LOOSE);
    assert!(!doubtful.inaccurate.is_empty() && doubtful.condition_estimate.is_some());
}

/// A yield load is a result like any other: `brinell yield` judges the state that it was taken
/// from, and says so where that is bad.
#[test]
fn a_yield_load_has_its_quality_too() {
    let quality = |overrides: &[&str]| {
        let scene = crate::support::load("hard/unload_reload", overrides);
        let results = crate::support::yield_load(&scene);
        assert!(results.first_yield.is_some());
        (results.quality, results.inaccurate)
    };
    let (good, inaccurate) = quality(&[]);
    assert!(
        good.backward_error > 0.0 && good.backward_error <= 1e-14,
        "{good:?}"
    );
    assert!(
        good.equilibrium > 0.0 && good.equilibrium <= 1e-9,
        "{good:?}"
    );
    assert!(
        good.componentwise_error
            .is_some_and(|w| w > 0.0 && w <= 1e-12),
        "{good:?}"
    );
    assert!(inaccurate.is_empty(), "{inaccurate:?}");
}
