//! Units and scales: with lengths times L and stresses times S every length is times L, pressure
//! times S, force per thickness times L S, that of a solid times L^2 S.

use crate::support::{SMALL_BALL, close, largest, load, run};
use brinell::results::{QUANTITIES, Results, Unit};

const ELASTIC: &str = "program.targets=[{ yield = true }, { load_factor = 0.5 }, \
                       { load_factor = 0.9 }, { load_factor = 0.0 }]";
const PLASTIC: &str = "program.targets=[{ yield = true }, { load_factor = 1.8 }, \
                       { load_factor = 0.5 }, { load_factor = 0.0 }]";

/// The coarse cylinder in units in which a length is `l` times, a stress `s` times its number.
fn cylinder(l: f64, s: f64, targets: &str) -> Results {
    cylinder_with(l, s, &[targets])
}

fn cylinder_with(l: f64, s: f64, more: &[&str]) -> Results {
    let values = [
        ("mesh.cylinder_on_half_plane.radius", 10.0 * l),
        ("materials.steel.youngs_modulus", 210000.0 * s),
        ("materials.steel.yield_stress", 500.0 * s),
        ("materials.steel.plastic_modulus", 60000.0 * s),
        ("load.press.plane_force.total", -1000.0 * l * s),
    ];
    let mut overrides: Vec<String> = values.iter().map(|(k, v)| format!("{k}={v:?}")).collect();
    overrides.extend(more.iter().map(|o| o.to_string()));
    let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
    run(&load("hard/unload_reload", &overrides))
}

/// A coarse quarter of a ball on a flat.
fn ball(l: f64, s: f64, more: &[&str]) -> Results {
    let values = [
        (
            "mesh.curved_bodies.upper",
            format!("[{0:?}, {0:?}]", 10.0 * l),
        ),
        (
            "materials.steel.youngs_modulus",
            format!("{:?}", 210000.0 * s),
        ),
        ("materials.steel.yield_stress", format!("{:?}", 500.0 * s)),
        (
            "materials.steel.tangent_modulus",
            format!("{:?}", 2100.0 * s),
        ),
        (
            "load.press.plane_force.total",
            format!("{:?}", -1000.0 * l * l * s),
        ),
    ];
    let mut overrides: Vec<String> = values.iter().map(|(k, v)| format!("{k}={v}")).collect();
    overrides.extend(SMALL_BALL.iter().chain(more).map(|o| o.to_string()));
    let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
    run(&load("ball_on_flat_3d", &overrides))
}

/// `scaled` is `base` in other units, to `tolerance` of the largest value of each kind; forces are
/// `f` times as large.
fn equivariant_of(base: &Results, scaled: &Results, [l, s, f]: [f64; 3], tolerance: f64) {
    let (a, b) = (base.first_yield.unwrap(), scaled.first_yield.unwrap());
    // Solids are pressed along z.
    let depth = |[_, y, z]: [f64; 3]| if z == 0.0 { y } else { z };
    for (what, x, y) in [
        ("yield load", a.load * f, b.load),
        ("yield pressure", a.max_pressure * s, b.max_pressure),
        ("yield half width", a.half_width * l, b.half_width),
        ("yield depth", depth(a.location) * l, depth(b.location)),
    ] {
        close(what, y, x, x, tolerance);
    }
    assert_eq!(base.states.len(), scaled.states.len());
    let all = |f: fn(&brinell::results::PairState) -> f64| {
        largest(base.states.iter().flat_map(|s| &s.pairs).map(f))
    };
    let (gap, force, pressure) = (all(|p| p.gap), all(|p| p.force), all(|p| p.pressure));
    let depth = largest(base.states.iter().map(|s| s.approach));
    for (a, b) in base.states.iter().zip(&scaled.states) {
        for quantity in &QUANTITIES {
            let [x, y] = [a, b].map(quantity.in_state.get);
            let (factor, least) = match quantity.unit {
                Unit::One => (1.0, 1e-3),
                // A depth is a difference of displacements and has their round-off.
                Unit::Length => (l, depth),
                Unit::Stress => (s, 0.0),
                Unit::Load => (f, 0.0),
                Unit::Area => (f / s, 0.0),
                Unit::Size => (l * f / s, 0.0),
                Unit::Work => (l * f, 0.0),
            };
            let scale = largest(base.states.iter().map(quantity.in_state.get)).max(least);
            // Without load a pair with neither gap nor force may be called either, and the error of
            // the stresses is that of their round-off.
            let of_round_off = ["closed_pairs", "energy_error"].contains(&quantity.key);
            if of_round_off && tolerance > 0.0 && a.load == 0.0 {
                continue;
            }
            if quantity.is_count || x.is_nan() {
                assert!(x == y || y.is_nan(), "{}: {x} {y}", quantity.key);
            } else {
                close(quantity.key, y, x * factor, scale * factor, tolerance);
            }
        }
        for (p, q) in a.pairs.iter().zip(&b.pairs) {
            close("gap", q.gap, p.gap * l, gap * l, tolerance);
            close("force", q.force, p.force * f, force * f, tolerance);
            close(
                "pressure",
                q.pressure,
                p.pressure * s,
                pressure * s,
                tolerance,
            );
        }
    }
    assert_eq!(base.history.len(), scaled.history.len());
}

fn equivariant(base: &Results, scaled: &Results, l: f64, s: f64, tolerance: f64) {
    equivariant_of(base, scaled, [l, s, l * s], tolerance);
}

const INCH: f64 = 25.4;
const POUND: f64 = 4.448_221_615_260_5;

/// mm and MPa to m and Pa; to inch and psi; stresses and lengths over many orders of magnitude.
const UNITS: [(f64, f64); 7] = [
    (1e-3, 1e6),
    (1.0 / INCH, INCH * INCH / POUND),
    (1.0, 1e12),
    (1.0, 1e-12),
    (1e9, 1.0),
    (1e-9, 1.0),
    (1e9, 1e-12),
];

/// Elastic, piecewise linear: other units are other roundings, times the condition of the model.
#[test]
fn elastic_results_scale_with_the_units() {
    let base = cylinder(1.0, 1.0, ELASTIC);
    for (l, s) in UNITS {
        equivariant(&base, &cylinder(l, s, ELASTIC), l, s, 1e-11);
    }
}

/// Elastoplastic: what the elastic results keep is kept, if forces balance better than that. With
/// the default of 1e-10 two roundings of one increment may stop at iterates that differ by a share
/// of it.
#[test]
fn plastic_results_scale_with_the_units() {
    for (tolerance, allowed) in [(1e-12, 1e-11), (1e-10, 1e-9)] {
        let balance = format!("analysis.tolerance={tolerance:e}");
        let base = cylinder_with(1.0, 1.0, &[PLASTIC, &balance]);
        for (l, s) in UNITS {
            let scaled = cylinder_with(l, s, &[PLASTIC, &balance]);
            equivariant(&base, &scaled, l, s, allowed);
        }
    }
}

/// Solids: elastic and elastoplastic, mm and N to m and N, stresses and lengths over 12 orders.
/// Elastic ones to what the plane model keeps. Where stresses of the size Y = 500 balance to t =
/// 1e-12, plastic strains do to `t Y/H`, of the 1e-3 that they are measured by 236 t with H = 2121.
#[test]
fn solids_scale_with_the_units() {
    for (targets, tolerance) in [(ELASTIC, 1e-11), (PLASTIC, 236e-12)] {
        let more = [targets, "analysis.tolerance=1e-12"];
        let base = ball(1.0, 1.0, &more);
        assert_eq!(targets == PLASTIC, base.states[1].plastic_points > 0);
        for (l, s) in [
            (1e-3, 1e6),
            (1.0, 1e12),
            (1.0, 1e-12),
            (1e12, 1.0),
            (1e-12, 1.0),
        ] {
            equivariant_of(&base, &ball(l, s, &more), [l, s, l * l * s], tolerance);
        }
    }
}

/// A power of two in stresses or lengths changes no mantissa: the results are the same to the last
/// bit, so that no absolute tolerance is left anywhere on the way.
#[test]
fn powers_of_two_change_no_bit() {
    let base = cylinder(1.0, 1.0, PLASTIC);
    for (l, s) in [
        (1.0, 2f64.powi(40)),
        (2f64.powi(-20), 1.0),
        (2f64.powi(30), 2f64.powi(-30)),
    ] {
        equivariant(&base, &cylinder(l, s, PLASTIC), l, s, 0.0);
    }
}

/// Neither is one in the search for the load of a target by a figure of the state.
#[test]
fn targets_by_figures_change_no_bit() {
    let direct = cylinder(1.0, 1.0, PLASTIC);
    let (pressed, off) = (&direct.states[1], &direct.states[3]);
    let targets = |l: f64, s: f64| {
        let figures = [
            ("residual_depth", 0.5 * off.residual_depth * l),
            ("contact_area", 0.9 * pressed.contact_area * l),
            ("max_pressure", 0.95 * pressed.max_pressure * s),
            ("approach", 0.97 * pressed.approach * l),
            ("contact_force", pressed.contact_force * l * s),
        ];
        let figures = figures.map(|(key, value)| format!("{{ {key} = {value:e} }}"));
        format!("program.targets=[{}]", figures.join(", "))
    };
    let base = cylinder(1.0, 1.0, &targets(1.0, 1.0));
    assert_eq!(base.states.len(), 5);
    for (l, s) in [(1.0, 2f64.powi(40)), (2f64.powi(-20), 2f64.powi(30))] {
        equivariant(&base, &cylinder(l, s, &targets(l, s)), l, s, 0.0);
    }
}
