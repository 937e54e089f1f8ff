//! The order in which points are run: the points that yield furthest first.

use crate::output::sweep::SweepPoint;
use crate::scene::{Load, LoadAction, NodeAction, Scene};
use crate::space::length;

/// Returns the largest size of a load (force, pressure or displacement) over the least yield
/// stress; 0 if either is not known. Only the order of the runs depends on this value.
pub(super) fn of(scene: &Scene) -> f64 {
    let bodies = scene.bodies.values();
    let yields = bodies.filter_map(|body| {
        let material = scene.materials.get(&body.material)?;
        let curve = material.hardening_curve();
        (material.yield_stress).or_else(|| Some(curve?.first()?[1]))
    });
    let least = yields.fold(f64::INFINITY, f64::min);
    scene.load.iter().map(size).fold(0.0, f64::max) / least
}

fn size(load: &Load) -> f64 {
    let Some(LoadAction::OnNodes(action)) = load.action() else {
        return 0.0;
    };
    match action {
        NodeAction::Force(force) => length(force.vector()),
        NodeAction::PlaneForce(plane) => plane.total.abs(),
        NodeAction::Pressure(pressure) => pressure.uniform().map_or(0.0, f64::abs),
        NodeAction::Displacement(displacement) => {
            let components = displacement.components().into_iter().flatten();
            let numbers = components.filter_map(|of| of.uniform());
            numbers.fold(0.0, |most: f64, u| most.max(u.abs()))
        }
        NodeAction::Relative(relative) => relative.value.abs(),
        NodeAction::Traction(_) | NodeAction::Kirsch(_) | NodeAction::Gap(_) => 0.0,
    }
}

/// Returns the indices of the points, the largest demand first; points of equal demand keep their
/// order.
pub(super) fn order(points: &[SweepPoint]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[b].demand.total_cmp(&points[a].demand));
    order
}
