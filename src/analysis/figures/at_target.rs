//! The report of the state at a target: figures, and fields on the whole mesh.

use super::dent::Dent;
use super::measure::{ContactFigures, pair_states, total_load_size};
use super::reactions;
use super::reading::Reading;
use crate::analysis::stress::element_stresses::ShownStresses;
use crate::analysis::stress::stresses::Stresses;
use crate::error::Result;
use crate::model::Model;
use crate::results::{Fields, PairState, State};
use crate::space::Vector;
use std::collections::BTreeMap;
use std::time::Instant;

/// Figures of a state for the results.
pub struct Figures {
    /// State in the form of the results.
    pub state: State,
    /// Elements outside the zone with stress beyond yield: the zone was too small for this state.
    pub beyond_yield_outside: Vec<usize>,
    /// Whether a Gauss point of the zone carries more than its initial yield stress.
    pub beyond_yield_inside: bool,
    /// Seconds spent on the stresses of all elements: forces, fields, error indicator.
    pub stress_seconds: f64,
    /// Displacements of all nodes without the rigid body motions of floating bodies.
    pub deformation: Vec<Vector>,
}

impl Reading<'_, '_> {
    /// Reads the figures of the current state and its quality, with fields if asked for. Costs half
    /// a full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn figures(&mut self, name: &str, with_fields: bool) -> Result<Figures> {
        let displacements = self.displacements()?;
        let u = &displacements.total;
        let begun = Instant::now();
        let stresses = self.stresses(displacements.deformation(), with_fields)?;
        let stress_seconds = begun.elapsed().as_secs_f64();
        let figures = ContactFigures::of(self.solver);
        let dent = Dent::of(self.solver);
        let arc = figures
            .patch
            .and_then(|patch| contact_arc(self.solver.structure.model, figures.contact, patch));
        let load = total_load_size(self.solver);
        let Stresses {
            internal,
            nodal,
            reactions,
            beyond_yield_outside,
            beyond_yield_inside,
            shown,
            plastic_points,
            plastic_volume,
            plastic_layer,
            plastic_work,
            plastic_depth,
            plastic_strain,
            corner_strain,
        } = stresses;
        let quality = self.quality(&displacements, internal, &reactions);
        let pairs = self.states_of_pairs(u);
        let model = self.solver.structure.model;
        let factors = &self.solver.at.factors;
        let deformation = model.nodal(displacements.deformation(), factors);
        let shown = shown.map(|shown| self.fields(shown, u, nodal, &pairs));
        let (errors, fields) = shown.unzip();
        let [energy_error, local_energy_error] = errors.unwrap_or_default();
        let state = State {
            name: name.to_string(),
            alpha: self.solver.at.alpha,
            load,
            increments: 0,
            is_loaded: factors.iter().any(|factor| *factor != 0.0),
            load_is_given: false,
            approach_is_given: false,
            contact_force: figures.force * self.solver.structure.model.symmetry,
            closed_pairs: self.solver.closed_pairs(),
            max_pressure: figures.max_pressure,
            pole_pressure: figures.pole_pressure,
            half_width: figures.half_width,
            half_width_reading: figures.half_width_reading,
            contact_area: figures.area,
            contact_arc: arc,
            residual_depth: dent.depth,
            residual_depth_by_body: dent.by_body,
            rim_height: dent.rim,
            plastic_points: plastic_points.iter().sum(),
            plastic_points_by_body: plastic_points,
            max_equivalent_plastic_strain: plastic_strain,
            plastic_strain_reading: (corner_strain - plastic_strain).max(0.0),
            plastic_zone_size: plastic_volume * self.solver.structure.model.symmetry,
            plastic_zone_layer: plastic_layer * self.solver.structure.model.symmetry,
            plastic_work: plastic_work * self.solver.structure.model.symmetry,
            plastic_depth,
            energy_error,
            local_energy_error,
            approach: self.approach(u),
            patches: figures.patches,
            pairs,
            fields,
            quality,
        };
        Ok(Figures {
            state,
            beyond_yield_outside,
            beyond_yield_inside,
            stress_seconds,
            deformation,
        })
    }

    /// State of each contact pair, and of the points on the axis, under the displacements `u` of
    /// all freedoms.
    fn states_of_pairs(&self, u: &[f64]) -> Vec<PairState> {
        pair_states(
            self.solver.structure.model,
            &self.solver.now.gap,
            &self.solver.contact_forces(),
            self.solver.tableau.open(),
            |axis| self.distance_on_axis(axis, u),
        )
    }

    /// Fields with the estimated errors of the stresses. Given are the displacements of all
    /// freedoms, the stresses to be shown, and the forces of the stresses on the nodes.
    fn fields(
        &self,
        shown: ShownStresses,
        u: &[f64],
        nodal: Vec<Vector>,
        pairs: &[PairState],
    ) -> ([Option<f64>; 2], Fields) {
        let model = self.solver.structure.model;
        let moved = model.nodal(u, &self.solver.at.factors);
        let (errors, mut fields) = fields(model, moved, shown, pairs);
        on_nodes(model, pairs, &mut fields);
        fields.force = reactions::on_nodes(model, nodal, &self.solver.contact_forces());
        (errors, fields)
    }
}

/// The estimated errors of the stresses (of the whole model, and of the elements in contact or
/// yielding), and the fields on the whole mesh, for the given nodal displacements and stresses.
fn fields(
    model: &Model,
    nodal: Vec<Vector>,
    shown: ShownStresses,
    pairs: &[PairState],
) -> ([Option<f64>; 2], Fields) {
    let dimension = model.mesh.dimension;
    let mut touches = vec![false; model.mesh.n_nodes()];
    for state in pairs.iter().filter(|state| state.pressure > 0.0) {
        for node in model
            .pairs
            .get(state.pair)
            .iter()
            .flat_map(|pair| pair.nodes())
        {
            touches[node] = true;
        }
    }
    let local = shown.recovered.error_of(|e| {
        let nodes = model.mesh.nodes(e);
        shown.plastic_strain[e] > 0.0 || nodes.iter().any(|node| touches[*node as usize])
    });
    let errors = shown.recovered.indicator(2 * dimension);
    let yielded = shown.plastic_strain.iter().map(|p| u8::from(*p > 0.0));
    let fields = Fields {
        displacement: (nodal.iter().flat_map(|u| &u[..dimension]))
            .copied()
            .collect(),
        stress: shown.stress,
        von_mises: shown.von_mises,
        yielded: yielded.collect(),
        plastic_strain: shown.plastic_strain,
        error: errors.by_element,
        nodal_stress: errors.nodal_stress,
        contact_pressure: Vec::new(),
        gap: Vec::new(),
        force: Vec::new(),
        points: shown.points,
    };
    ([Some(errors.total), local], fields)
}

/// Enters the pressure and gap of each pair on the slave and on the node that faces it. Other
/// master nodes get the mean of the pressures that act on them, by the areas of the slaves times
/// their weights. Negative weights, which shape functions of second order have, are left out, so
/// that the mean lies between the pressures.
fn on_nodes(model: &Model, pairs: &[PairState], fields: &mut Fields) {
    let n = model.mesh.n_nodes();
    fields.contact_pressure = vec![0.0; n];
    fields.gap = vec![f64::NAN; n];
    let mut forces: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    for state in pairs {
        let Some(pair) = model.shown_pair(state.contact, state.pair) else {
            continue;
        };
        for node in pair.faced().into_iter().chain([pair.slave]) {
            fields.contact_pressure[node] = state.pressure;
            fields.gap[node] = state.gap;
        }
        if pair.faced().is_none() {
            for &(node, weight) in pair.masters.iter().filter(|master| master.1 > 0.0) {
                let [force, area] = forces.entry(node).or_insert([0.0; 2]);
                *force += weight * state.force;
                *area += weight * state.area;
            }
        }
    }
    for (node, [force, area]) in forces {
        if area > 0.0 && fields.gap[node].is_nan() {
            fields.contact_pressure[node] = (force / area).max(0.0);
        }
    }
}

/// Start and end of a patch, in degrees about the centre of a circular surface. Angles are measured
/// from the symmetry plane at the nearer end of the surface, or from the middle of the patch if
/// there is no such plane.
fn contact_arc(model: &Model, contact: usize, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
    let surface = &model.contacts[contact];
    let (center, _) = surface.circle?;
    if let Some(turn) = surface.turn {
        let half = 180.0 * (to - from) / turn;
        return Some([-half, half]);
    }
    let pairs = &model.pairs[surface.range.clone()];
    let angle_of = |k: usize| {
        let x = model.mesh.in_plane(pairs[k].slave);
        (x[1] - center[1]).atan2(x[0] - center[0]).to_degrees()
    };
    let angle_at = |arc: f64| {
        let next = pairs
            .partition_point(|p| p.arc <= arc)
            .clamp(1, pairs.len().max(2) - 1);
        let (a, b) = (angle_of(next - 1), angle_of(next.min(pairs.len() - 1)));
        let length = pairs[next.min(pairs.len() - 1)].arc - pairs[next - 1].arc;
        let turn = (b - a + 540.0).rem_euclid(360.0) - 180.0;
        if length > 0.0 {
            a + turn * (arc - pairs[next - 1].arc) / length
        } else {
            a
        }
    };
    let extent = ((angle_at(to) - angle_at(from) + 540.0).rem_euclid(360.0) - 180.0).abs();
    let last = pairs.len() - 1;
    if from <= pairs[0].arc || to >= pairs[last].arc {
        return Some([0.0, extent]);
    }
    // A patch that has left the symmetry plane is still measured from this plane; from the nearer
    // one if both ends of the surface lie on a symmetry plane.
    let on_symmetry = |k: usize| {
        let x = model.mesh.point(pairs[k].slave);
        surface.mirrors_at(x).next().is_some()
    };
    let near_begin = from - pairs[0].arc <= pairs[last].arc - to;
    let pole = if near_begin { 0 } else { last };
    if !on_symmetry(pole) {
        return Some([-0.5 * extent, 0.5 * extent]);
    }
    let off = |arc: f64| ((angle_at(arc) - angle_of(pole) + 540.0).rem_euclid(360.0) - 180.0).abs();
    Some(if near_begin {
        [off(from), off(to)]
    } else {
        [off(to), off(from)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn disc(overrides: &[&str]) -> Model {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/disc_in_plate.toml"
        );
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        Model::new(&Scene::load_with(path, &overrides).unwrap()).unwrap()
    }

    /// Angle between the radii to two pairs, in degrees.
    fn between(model: &Model, a: usize, b: usize) -> f64 {
        let (center, radius) = model.contacts[0].circle.unwrap();
        let radii = [a, b].map(|k| {
            let x = model.mesh.in_plane(model.pairs[k].slave);
            [x[0] - center[0], x[1] - center[1]]
        });
        let [p, q] = radii;
        let sine = (p[0] * q[1] - p[1] * q[0]).abs() / (radius * radius);
        sine.asin().to_degrees()
    }

    /// A contact that has left the symmetry planes is measured from the nearer plane.
    #[test]
    fn an_arc_off_the_symmetry_plane_is_measured_from_there() {
        let model = disc(&["mesh.disc_in_plate.resolution=24"]);
        let last = model.pairs.len() - 1;
        let arc = |k: usize| model.pairs[k].arc;
        let close = |found: Option<[f64; 2]>, expected: [f64; 2]| {
            for (a, b) in found.unwrap().iter().zip(expected) {
                assert!((a - b).abs() < 1e-9, "{found:?} {expected:?}");
            }
        };
        let near_first = contact_arc(&model, 0, [arc(2), arc(7)]);
        close(near_first, [between(&model, 0, 2), between(&model, 0, 7)]);
        let near_last = contact_arc(&model, 0, [arc(last - 7), arc(last - 3)]);
        let expected = [
            between(&model, last, last - 3),
            between(&model, last, last - 7),
        ];
        close(near_last, expected);
        // A contact that reaches the symmetry plane starts at zero.
        let at_first = contact_arc(&model, 0, [arc(0), arc(5)]);
        close(at_first, [0.0, between(&model, 0, 5)]);
    }

    /// If there is no symmetry plane at the nearer end of its surface, an arc is measured from its
    /// own middle.
    #[test]
    fn an_arc_without_a_symmetry_plane_is_told_from_its_middle() {
        let mut model = disc(&["mesh.disc_in_plate.resolution=24"]);
        model.contacts[0].mirrors.clear();
        let found = contact_arc(&model, 0, [2, 7].map(|k| model.pairs[k].arc)).unwrap();
        let half = 0.5 * between(&model, 2, 7);
        assert!((found[0] + half).abs() < 1e-9 && (found[1] - half).abs() < 1e-9);
    }
}
