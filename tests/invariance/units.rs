//! Units and scales: with lengths times L and stresses times S every length is times L, pressure times S, force per thickness times L S.

use crate::running::{close, largest, load, run};
use brinell::results::Results;

const ELASTIC: &str = "program.targets=[{ yield = true }, { load_factor = 0.5 }, { load_factor = 0.9 }, { load_factor = 0.0 }]";
const PLASTIC: &str = "program.targets=[{ yield = true }, { load_factor = 1.8 }, { load_factor = 0.5 }, { load_factor = 0.0 }]";

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

/// `scaled` is `base` in other units, to `tolerance` of the largest value of each kind.
fn equivariant(base: &Results, scaled: &Results, l: f64, s: f64, tolerance: f64) {
    let (a, b) = (base.first_yield.unwrap(), scaled.first_yield.unwrap());
    for (what, x, y) in [
        ("yield load", a.load * l * s, b.load),
        ("yield pressure", a.max_pressure * s, b.max_pressure),
        ("yield half width", a.half_width * l, b.half_width),
        ("yield depth", a.location[1] * l, b.location[1]),
    ] {
        close(what, y, x, x, tolerance);
    }
    assert_eq!(base.states.len(), scaled.states.len());
    let all = |f: fn(&brinell::results::PairState) -> f64| {
        largest(base.states.iter().flat_map(|s| &s.pairs).map(f))
    };
    let (gap, force, pressure) = (all(|p| p.gap), all(|p| p.force), all(|p| p.pressure));
    // A depth is a difference of displacements and has their round-off.
    let depth = largest(base.states.iter().map(|s| s.approach));
    let width = largest(base.states.iter().map(|s| s.half_width));
    for (a, b) in base.states.iter().zip(&scaled.states) {
        close("alpha", b.alpha, a.alpha, 1.0, tolerance);
        close(
            "half width",
            b.half_width,
            a.half_width * l,
            width * l,
            tolerance,
        );
        close(
            "depth",
            b.residual_depth,
            a.residual_depth * l,
            depth * l,
            tolerance,
        );
        close(
            "strain",
            b.max_equivalent_plastic_strain,
            a.max_equivalent_plastic_strain,
            1e-3,
            tolerance,
        );
        assert_eq!(a.plastic_points, b.plastic_points);
        for (p, q) in a.pairs.iter().zip(&b.pairs) {
            close("gap", q.gap, p.gap * l, gap * l, tolerance);
            close("force", q.force, p.force * l * s, force * l * s, tolerance);
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

/// Elastoplastic: what the elastic results keep is kept, if forces balance better than that. With the default of 1e-10 two roundings of one
/// increment may stop at iterates that differ by a share of it.
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

/// A power of two in stresses or lengths changes no mantissa: the results are the same to the last bit, so that no absolute tolerance
/// is left anywhere on the way.
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
