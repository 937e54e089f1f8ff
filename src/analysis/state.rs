//! The state at a target: fields on the whole mesh and figures.

use super::engine::Engine;
use super::indicator::{Indicator, PointStresses, indicator};
use super::measure::pair_states;
use crate::assembly::local_element;
use crate::element::{MAX_FREEDOMS, MAX_POINTS};
use crate::error::Result;
use crate::material::{PlasticState, stress, von_mises};
use crate::model::{Magnitude, Model, Slot};
use crate::results::{Fields, State};
use crate::scene::History;
use rayon::prelude::*;

/// Share by which a stress must be beyond yield to count: the accuracy of the equilibrium iteration.
const BEYOND: f64 = 1e-8;

/// Stress figures and nodal forces of an element.
pub(super) struct ElementState {
    /// Forces on the element's freedoms.
    pub(super) force: [f64; MAX_FREEDOMS],
    stress: [f64; 4],
    von_mises: f64,
    plastic_strain: f64,
    plastic_points: usize,
    /// Volume of the Gauss points that have flowed.
    plastic_volume: f64,
    /// Stress at the Gauss points.
    points: PointStresses,
}

impl Engine<'_> {
    /// The current state with its quality; fields where asked for. Costs one full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn state(&mut self, name: &str, with_fields: bool) -> Result<State> {
        let displacements = self.displacements()?;
        let elements = self.element_states(displacements.deformation());
        self.beyond_yield_outside = self.outside_beyond_yield(&elements);
        let figures = self.contact_figures();
        let residual_depth = self.residual_depth();
        let mut by_body = vec![0; self.model.mesh.bodies.len()];
        let (mut largest, mut plastic_volume) = (0.0f64, 0.0);
        for (e, element) in elements.iter().enumerate() {
            plastic_volume += element.plastic_volume;
            by_body[self.model.mesh.element_body[e] as usize] += element.plastic_points;
            largest = largest.max(element.plastic_strain);
        }
        let quality = self.quality(&displacements, &elements);
        let u = &displacements.total;
        let arc = figures
            .patch
            .and_then(|patch| contact_arc(self.model, figures.contact, patch));
        let errors = with_fields.then(|| indicator(self.model, |e| &elements[e].points));
        Ok(State {
            name: name.to_string(),
            alpha: self.at.alpha,
            load: self
                .reaction(&elements)
                .unwrap_or_else(|| self.total_load_size()),
            contact_force: figures.force * self.model.symmetry,
            max_pressure: figures.max_pressure,
            pole_pressure: figures.pole_pressure,
            half_width: figures.half_width,
            contact_arc: arc,
            residual_depth,
            plastic_points: by_body.iter().sum(),
            plastic_points_by_body: by_body,
            max_equivalent_plastic_strain: largest,
            plastic_zone_size: plastic_volume * self.model.symmetry,
            energy_error: errors.as_ref().map(|i| i.total),
            approach: self.approach(u),
            pairs: pair_states(
                self.model,
                &self.now.gap,
                &self.contact_forces(),
                self.tableau.open(),
            ),
            fields: errors.map(|errors| self.fields(u, &elements, errors)),
            quality,
        })
    }

    /// Stresses of all elements for displacements of the whole model and the committed history.
    fn element_states(&self, u: &[f64]) -> Vec<ElementState> {
        let model = self.model;
        let elastic: Vec<_> = model.materials.iter().map(|m| m.elastic_matrix()).collect();
        let mut history: Vec<&[PlasticState]> = vec![&[]; model.mesh.n_elements()];
        for (element, states) in self.zone.history_by_element() {
            history[element] = states;
        }
        (0..model.mesh.n_elements())
            .into_par_iter()
            .with_min_len(256)
            .map(|e| {
                let local = local_element(model, e);
                let mut displacement = [0.0; MAX_FREEDOMS];
                for (d, slot) in displacement.iter_mut().zip(&local.slots) {
                    *d = model.freedoms.value(*slot, u, &self.at.factors);
                }
                let mut out = ElementState {
                    force: [0.0; MAX_FREEDOMS],
                    stress: [0.0; 4],
                    von_mises: 0.0,
                    plastic_strain: 0.0,
                    plastic_points: 0,
                    plastic_volume: 0.0,
                    points: [[0.0; 4]; MAX_POINTS],
                };
                let volume: f64 = local.points.iter().map(|p| p.weight).sum();
                for (g, point) in local.points.iter().enumerate() {
                    let past = history[e].get(g).copied().unwrap_or_default();
                    let strain = point.strain(&displacement[..local.points.n_freedoms]);
                    let sigma = stress(
                        &elastic[model.mesh.element_body[e] as usize],
                        &strain,
                        &past.strain,
                    );
                    point.add_force(&sigma, &mut out.force);
                    for (mean, s) in out.stress.iter_mut().zip(sigma) {
                        *mean += point.weight / volume * s;
                    }
                    out.von_mises = out.von_mises.max(von_mises(&sigma));
                    out.plastic_strain = out.plastic_strain.max(past.equivalent);
                    out.points[g] = sigma;
                    if past.equivalent > 0.0 {
                        out.plastic_points += 1;
                        out.plastic_volume += point.weight;
                    }
                }
                out
            })
            .collect()
    }

    /// Where the loads that vary are prescribed displacements only and nothing touches: the force that holds the first of
    /// them, along its displacement, of the whole.
    fn reaction(&self, elements: &[ElementState]) -> Option<f64> {
        let model = self.model;
        let mut varying = model
            .loads
            .iter()
            .enumerate()
            .filter(|(_, l)| !matches!(l.history, History::Constant));
        if varying
            .clone()
            .any(|(_, l)| l.measures != Magnitude::Displacement)
            || !model.pairs.is_empty()
        {
            return None;
        }
        let (leading, _) = varying.next()?;
        let mut sum = 0.0;
        for (e, element) in elements.iter().enumerate() {
            for (i, &node) in model.mesh.nodes(e).iter().enumerate() {
                for (d, slot) in model.freedoms.slots[node as usize].iter().enumerate() {
                    if let Slot::Prescribed(p) = slot {
                        let prescribed = &model.freedoms.prescribed[*p as usize];
                        if prescribed.load == leading {
                            sum += element.force[2 * i + d] * prescribed.value.signum();
                        }
                    }
                }
            }
        }
        Some(sum * self.at.factors[leading].signum() * model.symmetry)
    }

    /// Elements that may yield, are not in the zone and carry more than the yield stress.
    fn outside_beyond_yield(&self, elements: &[ElementState]) -> Vec<usize> {
        let model = self.model;
        (0..elements.len())
            .filter(|&e| {
                let body = model.mesh.element_body[e] as usize;
                model.may_yield[body]
                    && elements[e].von_mises > model.materials[body].yield_stress() * (1.0 + BEYOND)
                    && self.elements.binary_search(&e).is_err()
            })
            .collect()
    }

    fn fields(&self, u: &[f64], elements: &[ElementState], errors: Indicator) -> Fields {
        let model = self.model;
        Fields {
            displacement: (0..model.mesh.n_nodes())
                .flat_map(|node| model.freedoms.displacement(node, u, &self.at.factors))
                .collect(),
            stress: elements.iter().flat_map(|e| e.stress).collect(),
            von_mises: elements.iter().map(|e| e.von_mises).collect(),
            plastic_strain: elements.iter().map(|e| e.plastic_strain).collect(),
            yielded: elements
                .iter()
                .map(|e| u8::from(e.plastic_points > 0))
                .collect(),
            error: errors.by_element,
        }
    }
}

/// Begin and end of a patch in degrees about the centre of a circular surface: from the symmetry plane at the surface's
/// nearer end, or from its middle where there is none.
fn contact_arc(model: &Model, contact: usize, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
    let surface = &model.contacts[contact];
    let (center, _) = surface.circle?;
    let pairs = &model.pairs[surface.range.clone()];
    let angle_of = |k: usize| {
        let x = model.mesh.point(pairs[k].second);
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
    // A patch that has left the symmetry plane is still measured from there, the nearer one if both ends lie on one.
    let on_symmetry = |k: usize| {
        let nodes = [pairs[k].first, pairs[k].second];
        nodes
            .iter()
            .all(|&node| model.freedoms.slots[node][1] == Slot::Fixed)
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
