//! Published cases with known answers, run through the library: one case per file, its source at
//! the head.

mod back_stresses;
mod body_forces;
mod by_position;
mod by_position_refused;
mod circular_punch;
mod contact_edges;
mod contact_patch;
mod cycles;
mod cyclic_element;
mod disc_in_plate;
mod driving_force;
mod equations;
mod figures;
mod flat_punch;
mod followed;
mod gap_load;
mod heat;
mod hertz_line;
mod hertz_line_history;
mod hertz_point;
mod initial_state;
mod local_refinement;
mod nafems_cb1;
mod over_temperature;
mod pin_in_hole;
mod planes_of_symmetry;
mod published;
mod quality;
mod rigid_refused;
mod rigid_solids;
mod rigid_surfaces;
mod shakedown;
mod shrink_fit;
mod ssnv104;
mod start_from;
mod supports_in_time;
mod thick_cylinder;
mod thick_sphere;
mod yield_depth;
mod yield_load;

use crate::support::run_with_model;
use brinell::scene::Scene;

/// Mean radial displacement of a circular surface about the origin in the first state.
pub fn radial_displacement(scene: &Scene, surface: &str) -> f64 {
    let (model, results) = run_with_model(scene);
    let mesh = &model.mesh;
    let displacement = &results.states[0].fields.as_ref().unwrap().displacement;
    let nodes = mesh.set_nodes(surface).unwrap();
    let radial = |&n: &usize| {
        let x = mesh.point(n);
        (x[0] * displacement[2 * n] + x[1] * displacement[2 * n + 1]) / x[0].hypot(x[1])
    };
    nodes.iter().map(radial).sum::<f64>() / nodes.len() as f64
}

/// Panics unless `value` is within `tolerance` (relative) of `exact`.
#[track_caller]
pub fn close(value: f64, exact: f64, tolerance: f64) {
    let error = (value / exact - 1.0).abs();
    assert!(
        error <= tolerance,
        "{value} against {exact}: off by {error:.3e}, more than {tolerance:.1e}"
    );
}
