//! Hertz's contact on meshes of different size, against meshes that match.

use crate::support::meshes::joined;
use crate::support::{either, load, run_on};
use brinell::model::Model;
use brinell::results::Results;
use brinell::scene::Scene;
use std::f64::consts::PI;

/// Runs a scene of the generator `key` with the two bodies meshed differently.
pub fn at_ratio(
    name: &str,
    key: &str,
    extra: &[String],
    [first, second]: [usize; 2],
    slave: &str,
) -> (Scene, Results) {
    let scene = |resolution: usize| {
        let mut overrides = vec![
            format!("mesh.{key}.resolution={resolution}"),
            format!("contact.0.slave={slave}"),
            "program.targets=[{yield=true}]".to_string(),
        ];
        overrides.extend_from_slice(extra);
        let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
        load(name, &overrides)
    };
    let [a, b] = [first, second].map(|n| Model::new(&scene(n)).unwrap().continuum.mesh);
    let mesh = joined(&a, &b);
    let results = run_on(&scene(first), mesh);
    (scene(first), results)
}

const RADIUS: f64 = 10.0;
/// `E / (2 (1 - nu^2))`
const MODULUS: f64 = 210e3 / (2.0 * 0.91);

/// Half width and peak pressure for a load.
fn line(load: f64) -> [f64; 2] {
    let b = (4.0 * load * RADIUS / (PI * MODULUS)).sqrt();
    [b, 2.0 * load / (PI * b)]
}

fn point(load: f64) -> [f64; 2] {
    let a = (0.75 * load * RADIUS / MODULUS).cbrt();
    [a, 1.5 * load / (PI * a * a)]
}

/// Largest pressure over the exact one less 1, and the root of the mean square deviation from the
/// ellipse over the inner nine tenths of the width, as a share of the peak.
fn deviations(results: &Results, [b, p0]: [f64; 2]) -> [f64; 2] {
    let state = &results.states[0];
    let inner = state.pairs.iter().filter(|pair| {
        let [x, y, z] = pair.position;
        // In the plane y is along the normal.
        let off = if state.patches.is_empty() {
            x
        } else {
            x.hypot(y)
        };
        off <= 0.9 * b && z.abs() < b
    });
    let squares: Vec<f64> = inner
        .map(|pair| {
            let [x, y, _] = pair.position;
            let off = if state.patches.is_empty() {
                x
            } else {
                x.hypot(y)
            };
            (pair.pressure / p0 - (1.0 - (off / b).powi(2)).sqrt()).powi(2)
        })
        .collect();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    [state.max_pressure / p0 - 1.0, rms]
}

/// Mesh ratios 1:1, 2:3, 3:2, 1:3, either side with the slaves.
fn ratios(name: &str, element: &str, exact: fn(f64) -> [f64; 2]) {
    let key = "cylinder_on_half_plane";
    let extra = [format!("mesh.{key}.element={element}")];
    let at = |cells, slave| {
        let (_, results) = at_ratio(name, key, &extra, cells, slave);
        let load = results.states[0].load;
        deviations(&results, exact(load))
    };
    // That of meshes that match with the coarser one's elements.
    let matching = at([8, 8], "auto");
    println!("{name} {element} matching: {matching:.4?}");
    for cells in [[8, 12], [12, 8], [8, 24], [24, 8]] {
        // Every side at ratios of two to three, at one to three that which is chosen.
        let every = &["first", "second", "auto"][..];
        let some = either(&["auto"][..], every);
        for &slave in if cells.contains(&24) { some } else { every } {
            // Quadratic balls that float on the axis are said not to be held where they have the
            // slaves, on some meshes, matching ones too.
            if name == "ball_on_half_space"
                && element == "quad8"
                && cells[0] == 24
                && slave != "second"
            {
                continue;
            }
            let found = at(cells, slave);
            println!("{name} {element} {cells:?} {slave}: {found:.4?}");
            // Fine slaves see the kinks between linear facets three times as long: the scatter is
            // four times that of matching meshes, and left to who asks for it.
            let finer = if cells[0] > cells[1] {
                "first"
            } else {
                "second"
            };
            let sees_kinks = element == "quad4" && cells.contains(&24) && slave == finer;
            let (peak, scatter) = if sees_kinks { (0.02, 5.0) } else { (0.01, 1.5) };
            assert!(
                found[0].abs() < peak && found[1] < scatter * matching[1],
                "{name} {element} {cells:?} {slave}: {found:.4?} {matching:.4?}"
            );
        }
    }
}

#[test]
fn line_contact() {
    ratios("cylinder_on_half_plane", "quad4", line);
    ratios("cylinder_on_half_plane", "quad8", line);
}

#[test]
fn point_contact() {
    ratios("ball_on_half_space", "quad4", point);
    ratios("ball_on_half_space", "quad8", point);
}

/// Four elements face six over the half width, and the same twice (thorough: four times) as
/// fine. Where the
/// contact ends within an element is not resolved, so that pressures near it are off in proportion
/// to its size: the scatter falls with the first order of it at least.
fn orders(name: &str, element: &str, exact: fn(f64) -> [f64; 2]) {
    let key = "cylinder_on_half_plane";
    let extra = [format!("mesh.{key}.element={element}")];
    let times = either(&[1, 2][..], &[1, 2, 4]);
    let scatter = times.iter().map(|k| {
        let (_, results) = at_ratio(name, key, &extra, [4 * k, 6 * k], "auto");
        let found = deviations(&results, exact(results.states[0].load));
        println!("{name} {element} {}: {found:.5?}", 4 * k);
        found[1]
    });
    let scatter: Vec<f64> = scatter.collect();
    for (found, times) in scatter.iter().zip(times).skip(1) {
        assert!(*found < scatter[0] / *times as f64, "{scatter:?}");
    }
}

#[test]
fn observed_orders() {
    for element in ["quad4", "quad8"] {
        orders("cylinder_on_half_plane", element, line);
        orders("ball_on_half_space", element, point);
    }
}
