//! Comparing two runs.

use crate::running::{close, largest, try_run};
use brinell::linalg::Backend;
use brinell::results::{HistoryRow, Results, State};
use brinell::scene::Scene;

/// Relative agreement asked for by the project: far above round-off times the condition of these models, far below any
/// tolerance of the analysis except the plastic one, which both runs stop at in the same iteration.
pub const AGREEMENT: f64 = 1e-10;

/// Runs the scene with both backends: both agree or both refuse for the same reason.
#[track_caller]
pub fn both(scene: &Scene) -> Option<Results> {
    let sparse = try_run(scene, Backend::Cholmod);
    let dense = try_run(scene, Backend::Dense);
    match (sparse, dense) {
        (Ok(a), Ok(b)) => {
            agree(&a, &b);
            Some(a)
        }
        (Err(a), Err(b)) => {
            assert_eq!(a.kind(), b.kind(), "cholmod: {a}\ndense: {b}");
            None
        }
        (a, b) => panic!(
            "one refuses: cholmod {:?}, dense {:?}",
            a.err().map(|e| e.to_string()),
            b.err().map(|e| e.to_string())
        ),
    }
}

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

#[track_caller]
pub fn agree(a: &Results, b: &Results) {
    let events = |r: &Results| {
        r.history
            .iter()
            .map(|h| h.event.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(events(a), events(b));
    for (name, value) in COLUMNS {
        let floor = match name {
            "max_pressure" | "contact_force" => largest(a.history.iter().map(|r| r.load)),
            _ => 0.0,
        };
        let scale = largest(a.history.iter().map(value)).max(floor);
        let most = largest(a.history.iter().map(|r| r.contact_force));
        for (row, other) in a.history.iter().zip(&b.history) {
            // Under a vanishing force (a floating body that just touches) the extent of the contact is one of round-off.
            if name == "half_width" && row.contact_force <= 1e-6 * most {
                continue;
            }
            let what = format!("{name} of increment {}", row.increment);
            close(&what, value(row), value(other), scale, AGREEMENT);
            assert_eq!(row.closed_pairs, other.closed_pairs, "{what}");
            assert_eq!(row.plastic_points, other.plastic_points, "{what}");
        }
    }
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
        // Over all states. Where a figure vanishes in exact arithmetic its size is that of what it is a difference of: gaps,
        // movements, strains times the size of the model (about 1); for pressures the load.
        let gaps = a.states.iter().flat_map(|s| &s.pairs).map(|p| p.gap);
        let of = |f: fn(&State) -> f64| largest(a.states.iter().map(f));
        let floor = match name {
            "residual_depth" | "approach" => largest(gaps)
                .max(of(|s| s.approach))
                .max(of(|s| s.max_equivalent_plastic_strain)),
            "max_pressure" => of(|s| s.load),
            _ => 0.0,
        };
        let scale = largest(a.states.iter().map(value)).max(floor);
        for (s, t) in a.states.iter().zip(&b.states) {
            close(
                &format!("{name} of state {}", s.name),
                value(s),
                value(t),
                scale,
                AGREEMENT,
            );
        }
    }
    let pairs = |r: &Results| {
        r.states
            .iter()
            .flat_map(|s| s.pairs.clone())
            .collect::<Vec<_>>()
    };
    let (p, q) = (pairs(a), pairs(b));
    let load = largest(a.history.iter().map(|r| r.load));
    let moved = largest(a.states.iter().map(|s| s.approach));
    let (gap, force) = (
        largest(p.iter().map(|p| p.gap)).max(moved),
        largest(p.iter().map(|p| p.force)).max(load),
    );
    for (p, q) in p.iter().zip(&q) {
        close(
            &format!("gap of pair {}", p.pair),
            p.gap,
            q.gap,
            gap,
            AGREEMENT,
        );
        close(
            &format!("force of pair {}", p.pair),
            p.force,
            q.force,
            force,
            AGREEMENT,
        );
    }
}
