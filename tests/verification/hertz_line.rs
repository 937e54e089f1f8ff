//! First yield of a cylinder on a half plane, the paper's Table I.
//!
//! Source: N. Endahl, section 5.1; K. L. Johnson, Contact Mechanics (1985), sections 4.2 and 6.1.

use crate::support::{load, run_file, yield_load};
use crate::verification::close;
use brinell::results::YieldPoint;

/// Ratios to the exact values: load, pressure, half width, depth.
fn ratios(point: &YieldPoint) -> [f64; 4] {
    let (r, y, e) = (10.0, 500.0, 210000.0 / (2.0 * (1.0 - 0.09)));
    let b = 3.58745 * r * y / e;
    [
        point.load / (10.1072 * r * y * y / e),
        point.max_pressure / (1.79367 * y),
        point.half_width / b,
        -point.location[1] / (0.70428 * b),
    ]
}

fn at(resolution: usize, far_size: f64) -> YieldPoint {
    let overrides = [
        format!("mesh.cylinder_on_half_plane.resolution={resolution}"),
        format!("mesh.cylinder_on_half_plane.far_size={far_size:.1}"),
    ];
    let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
    yield_load(&load("cylinder_on_half_plane", &overrides))
        .first_yield
        .unwrap()
}

#[test]
fn table_one_converges_to_the_exact_values() {
    let by_mesh: Vec<[f64; 4]> = [4, 8, 16, 32]
        .iter()
        .map(|&n| ratios(&at(n, 20000.0)))
        .collect();
    let error = |mesh: usize, k: usize| (by_mesh[mesh][k] - 1.0).abs();
    for k in 0..4 {
        assert!(error(2, k) <= 0.01, "quantity {k} at 16: {by_mesh:?}");
        assert!(error(3, k) <= 0.003, "quantity {k} at 32: {by_mesh:?}");
    }
    // Load and pressure change from mesh to mesh by its error, of order h^2: 16 times less between
    // meshes that are four times as fine, an eighth and more is gone. They end at the remainder of
    // size (b/W) and curvature (b/R = 0.016, of which the load shows 0.08 %).
    let change = |mesh: usize, k: usize| (by_mesh[mesh][k] - by_mesh[mesh + 1][k]).abs();
    for k in 0..2 {
        assert!(
            change(2, k) <= change(0, k) / 8.0 && error(3, k) <= 1e-3,
            "quantity {k}: {by_mesh:?}"
        );
    }
}

#[test]
fn size_of_the_bodies_matters_less_than_the_mesh() {
    let (coarse, fine) = (at(8, 20000.0), at(16, 20000.0));
    let larger = at(8, 40000.0);
    for k in 0..2 {
        let mesh = (ratios(&coarse)[k] - ratios(&fine)[k]).abs();
        let size = (ratios(&coarse)[k] - ratios(&larger)[k]).abs();
        assert!(
            size < mesh,
            "quantity {k}: size {size:.1e}, mesh {mesh:.1e}"
        );
    }
}

#[test]
fn pressure_and_width_grow_like_the_root_of_the_load() {
    let results = run_file(
        "cylinder_on_half_plane",
        &["program.targets=[{load_factor=0.25},{load_factor=0.5},{yield=true}]"],
    );
    let at_yield = results.first_yield.unwrap();
    for (state, alpha) in results.states.iter().zip([0.25f64, 0.5, 1.0]) {
        // At 0.25 eight elements lie over the half width: pressure 0.2 % low there (Table I at 8),
        // width within a tenth of an element, 1/80.
        close(
            state.max_pressure / at_yield.max_pressure,
            alpha.sqrt(),
            0.003,
        );
        close(
            state.half_width / at_yield.half_width,
            alpha.sqrt(),
            0.1 / (16.0 * alpha.sqrt()),
        );
        assert_eq!(state.plastic_points, 0);
    }
}
