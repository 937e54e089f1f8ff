//! Comparing two runs.

use crate::support::{close, largest, sparse, try_run};
use brinell::linalg::Backend;
use brinell::results::{HistoryRow, Results, State};
use brinell::scene::{Field, Scene};

/// Relative agreement asked for by the project: far above round-off times the condition of these
/// models, far below any tolerance of the analysis except the plastic one, which both runs stop at
/// in the same iteration.
pub const AGREEMENT: f64 = 1e-10;

/// Runs the scene with every backend: all agree with the dense one or all refuse for the same
/// reason. Returns the results of the default backend.
#[track_caller]
pub fn all(scene: &Scene) -> Option<Results> {
    let reference = try_run(scene, Backend::Dense);
    let results = sparse().into_iter().map(|backend| {
        let name = backend.name();
        match (try_run(scene, backend), &reference) {
            (Ok(a), Ok(b)) => {
                let force = of_movement(scene);
                if force > 0.0 && scene.contact.len() > 1 {
                    agree_at_targets(&a, b, force);
                } else {
                    agree(&a, b, force);
                }
                Some(a)
            }
            (Err(a), Err(b)) => {
                assert_eq!(a.kind(), b.kind(), "{name}: {a}\ndense: {b}");
                None
            }
            (a, b) => panic!(
                "one refuses: {name} {:?}, dense {:?}",
                a.err().map(|e| e.to_string()),
                b.as_ref().err().map(|e| e.to_string())
            ),
        }
    });
    let results: Vec<_> = results.collect();
    results.into_iter().next().flatten()
}

/// An event lies where a force or gap crosses zero: its place, and all figures there, are off by
/// their round-off over the slope, which may be small. (Once in 11,000 random scenes beyond 1e-10:
/// 3e-10.) The states at the targets know nothing of it.
const ON_THE_WAY: f64 = 1e-8;

type Column = (&'static str, fn(&HistoryRow) -> f64);
const COLUMNS: [Column; 6] = [
    ("alpha", |r| r.alpha),
    ("load", |r| r.load),
    ("max_pressure", |r| r.max_pressure),
    ("half_width", |r| r.half_width),
    ("contact_force", |r| r.contact_force),
    ("plastic strain", |r| r.max_equivalent_plastic_strain),
];

type Figure = (&'static str, fn(&State) -> f64);
const FIGURES: [Figure; 6] = [
    ("load", |s| s.load),
    ("max_pressure", |s| s.max_pressure),
    ("half_width", |s| s.half_width),
    ("residual_depth", |s| s.residual_depth),
    ("approach", |s| s.approach),
    ("plastic strain", |s| s.max_equivalent_plastic_strain),
];

/// The size of the forces that prescribed movements may call up, in bodies of a size of about 1:
/// the sums from which they come hold terms of this size also where nothing is touched and the
/// forces are zero.
fn of_movement(scene: &Scene) -> f64 {
    let stiffest = largest(scene.materials.values().map(|m| m.youngs_modulus));
    let moves = scene
        .load
        .iter()
        .filter_map(|load| load.displacement.as_ref());
    let moves = moves.flat_map(|d| [d.x.as_ref(), d.y.as_ref()]).flatten();
    let moves = moves.filter_map(Field::uniform).map(f64::abs);
    stiffest * largest(moves)
}

/// Compares two runs; forces are compared relative to `force` at least.
#[track_caller]
pub fn agree(a: &Results, b: &Results, force: f64) {
    agree_on_the_way(a, b, force);
    agree_at_targets(a, b, force);
}

/// Compares increment by increment.
#[track_caller]
fn agree_on_the_way(a: &Results, b: &Results, force: f64) {
    let at_least = force;
    // Bodies of a size of about 1: strains are as large as displacements.
    let strain = largest(a.states.iter().map(|s| s.approach));
    let events = |r: &Results| {
        r.history
            .iter()
            .map(|h| h.event.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(events(a), events(b));
    for (name, value) in COLUMNS {
        let floor = match name {
            "max_pressure" | "contact_force" | "load" => {
                largest(a.history.iter().map(|r| r.load)).max(at_least)
            }
            "plastic strain" => strain,
            _ => 0.0,
        };
        let scale = largest(a.history.iter().map(value)).max(floor);
        let most = largest(a.history.iter().map(|r| r.contact_force));
        for (row, other) in a.history.iter().zip(&b.history) {
            // Under a vanishing force (a floating body that just touches) the extent of the contact
            // is one of round-off.
            let untouched = row.contact_force <= (AGREEMENT * at_least).max(1e-6 * most);
            if name == "half_width" && untouched {
                continue;
            }
            let what = format!("{name} of increment {}", row.increment);
            close(&what, value(row), value(other), scale, ON_THE_WAY);
            assert!(
                untouched || row.closed_pairs == other.closed_pairs,
                "{what}"
            );
            // At the very load of first yield a point has flowed, by round-off, or not.
            let flowed = row.max_equivalent_plastic_strain;
            if flowed.max(other.max_equivalent_plastic_strain) > AGREEMENT * strain {
                assert_eq!(row.plastic_points, other.plastic_points, "{what}");
            }
        }
    }
}

/// Compares first yield and the states at the targets. A body that is moved against others with
/// gaps between has no force to go by until all gaps are closed, and none again once they open:
/// which of its pairs closes or opens first, in an instant, is for round-off to say, and so is
/// where in its gaps it is left. What is determined is the same: all forces, all gaps wherever
/// something presses, else the sum of the gaps above each other.
#[track_caller]
pub fn agree_at_targets(a: &Results, b: &Results, force: f64) {
    let at_least = force;
    assert_eq!(a.first_yield.is_some(), b.first_yield.is_some());
    if let (Some(a), Some(b)) = (&a.first_yield, &b.first_yield) {
        for (name, x, y) in [
            ("yield alpha", a.alpha, b.alpha),
            ("yield load", a.load, b.load),
            ("yield pressure", a.max_pressure, b.max_pressure),
            ("yield half width", a.half_width, b.half_width),
        ] {
            close(name, x, y, x, AGREEMENT);
        }
        assert_eq!(a.body, b.body);
    }
    assert_eq!(a.states.len(), b.states.len());
    for (name, value) in FIGURES {
        // Over all states. Where a figure vanishes in exact arithmetic its size is that of what it
        // is a difference of: gaps, movements, strains times the size of the model (about 1); for
        // pressures the load.
        let gaps = a.states.iter().flat_map(|s| &s.pairs).map(|p| p.gap);
        let of = |f: fn(&State) -> f64| largest(a.states.iter().map(f));
        let floor = match name {
            "residual_depth" | "approach" => largest(gaps)
                .max(of(|s| s.approach))
                .max(of(|s| s.max_equivalent_plastic_strain)),
            "max_pressure" | "load" => of(|s| s.load).max(at_least),
            // What is left of all strain, which in bodies of a size of about 1 is as large as the
            // displacements.
            "plastic strain" => of(|s| s.approach),
            _ => 0.0,
        };
        let scale = largest(a.states.iter().map(value)).max(floor);
        for (s, t) in a.states.iter().zip(&b.states) {
            if name == "half_width" && s.contact_force <= AGREEMENT * at_least {
                continue;
            }
            close(
                &format!("{name} of state {}", s.name),
                value(s),
                value(t),
                scale,
                AGREEMENT,
            );
        }
    }
    let load = largest(a.history.iter().map(|r| r.load));
    let moved = largest(a.states.iter().map(|s| s.approach));
    let all = || a.states.iter().flat_map(|s| &s.pairs);
    let gap = largest(all().map(|p| p.gap)).max(moved);
    let force = largest(all().map(|p| p.force)).max(load).max(at_least);
    for (s, t) in a.states.iter().zip(&b.states) {
        let name = &s.name;
        let pressed = largest(s.pairs.iter().map(|p| p.force)) > AGREEMENT * force;
        for (p, q) in s.pairs.iter().zip(&t.pairs) {
            let what = format!("force of pair {} of state {name}", p.pair);
            close(&what, p.force, q.force, force, AGREEMENT);
        }
        let (p, q) = if pressed || at_least == 0.0 {
            let each = |s: &State| s.pairs.iter().map(|p| p.gap).collect::<Vec<_>>();
            (each(s), each(t))
        } else {
            (gaps_above_each_other(s), gaps_above_each_other(t))
        };
        assert_eq!(p.len(), q.len());
        for (k, (p, q)) in p.iter().zip(&q).enumerate() {
            close(&format!("gap {k} of state {name}"), *p, *q, gap, AGREEMENT);
        }
    }
}

/// The sum of the gaps at each distance from the axis.
fn gaps_above_each_other(state: &State) -> Vec<f64> {
    let places: std::collections::BTreeSet<u64> = state
        .pairs
        .iter()
        .map(|p| p.position[0].to_bits())
        .collect();
    let sum_at = |place: u64| {
        let there = state
            .pairs
            .iter()
            .filter(|p| p.position[0].to_bits() == place);
        there.map(|p| p.gap).sum()
    };
    places.into_iter().map(sum_at).collect()
}
