//! The dent: the shape that plastic strains leave in the surfaces after loads and contact forces
//! have vanished.

use super::measure::on_axis;
use crate::analysis::structure::solver::Solver;
use crate::mesh::Mesh;
use crate::model::{ContactSurface, Pair};

/// The dent of a state.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::analysis) struct Dent {
    /// Depth of both surfaces together at the deepest place; negative if they have moved towards
    /// each other everywhere.
    pub depth: f64,
    /// Each body's share at the deepest place of a contact; of several contacts the largest.
    pub by_body: Vec<f64>,
    /// Largest height to which a surface rises above its undeformed shape.
    pub rim: f64,
}

/// Displacements of the two surfaces of a contact into their own bodies, at one place.
type Sunk = [f64; 2];

impl Dent {
    /// Computes the dent of the current plastic strains: displacements under their initial loads
    /// alone, with every pair open, minus the rigid body motion of each body's far boundary. Costs
    /// half a trailing solve if there are plastic strains.
    pub(in crate::analysis) fn of(solver: &mut Solver) -> Dent {
        let mut dent = Dent {
            depth: 0.0,
            by_body: vec![0.0; solver.structure.model.mesh.bodies.len()],
            rim: 0.0,
        };
        if solver.now.initial.load.largest() == 0.0 || solver.now.gap.is_empty() {
            return dent;
        }
        let model = solver.structure.model;
        let sunk = sunk(solver);
        let mut largest = None;
        let mut deepest_of = vec![None; dent.by_body.len()];
        for contact in &model.contacts {
            let places = places_of(contact, &sunk, |side| {
                let values: Vec<f64> = sunk.iter().map(|sunk| sunk[side]).collect();
                on_axis(model, contact, &values)
            });
            let deepest = places
                .iter()
                .max_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
            let Some(&deepest) = deepest else { continue };
            let depth = deepest[0] + deepest[1];
            largest = Some(largest.map_or(depth, |other: f64| other.max(depth)));
            for (name, share) in contact.names.iter().zip(deepest) {
                if let Some(body) = body_of(&model.mesh, name) {
                    let known = &mut deepest_of[body];
                    *known = Some(known.map_or(share, |other: f64| other.max(share)));
                }
            }
            dent.rim = places
                .iter()
                .flatten()
                .fold(dent.rim, |m, sunk| m.max(-sunk));
        }
        dent.depth = largest.unwrap_or(0.0);
        for (depth, deepest) in dent.by_body.iter_mut().zip(deepest_of) {
            *depth = deepest.unwrap_or(0.0);
        }
        dent
    }
}

/// Depths to which the two sides of each pair have sunk into their bodies, without any load.
fn sunk(solver: &mut Solver) -> Vec<Sunk> {
    let forces = &solver.now.initial.forces;
    let n = forces.len();
    let mut unloaded = solver.structure.sub.tableau();
    unloaded.reset(&vec![true; n]);
    let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
    unloaded.solve(forces, &mut gap, &mut force);
    // Pairs that hold the rigid body motion of a floating body stay closed. They carry nothing,
    // since initial loads are self-equilibrated.
    let slip: Vec<f64> = gap.iter().map(|g| -g).collect();
    let mut u = solver.now.initial.eliminated.clone();
    solver.structure.sub.recover(&mut u, &slip);
    solver.cost.count_half();
    let mut normal = u.contact.clone();
    let structure = &solver.structure;
    let motions = structure.model.floating.motions.iter();
    for (motion, far) in motions.zip(&structure.loads.far) {
        let amplitude = far.dot(&u);
        for (value, &freedom) in normal.iter_mut().zip(&structure.sub.partition.contact) {
            *value -= amplitude * motion.at(freedom);
        }
    }
    let model = structure.model;
    let of_pair = |(k, pair): (usize, &Pair)| {
        // The normal points from the slave's body to the master's body.
        let [faced, slave] = model.rows.both_sides(k, &normal);
        match model.contacts[pair.contact].slave {
            0 => [-slave, faced],
            _ => [faced, -slave],
        }
    };
    model.pairs.iter().enumerate().map(of_pair).collect()
}

/// The places of a contact at which dents are read: its pairs, and the axis of revolution if no
/// pair lies on it.
fn places_of(
    contact: &ContactSurface,
    sunk: &[Sunk],
    axis: impl Fn(usize) -> Option<f64>,
) -> Vec<Sunk> {
    let mut places = sunk[contact.range.clone()].to_vec();
    if let (Some(first), Some(second)) = (axis(0), axis(1)) {
        places.push([first, second]);
    }
    places
}

/// The body to which a surface belongs.
pub(super) fn body_of(mesh: &Mesh, surface: &str) -> Option<usize> {
    let facet = mesh.surfaces.get(surface)?.facets.first()?;
    Some(mesh.element_body[facet.element] as usize)
}
