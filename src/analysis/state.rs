//! The state at a target: fields on the whole mesh and figures.

use super::engine::Engine;
use super::indicator::{Indicator, indicator};
use super::measure::pair_states;
use super::stresses::{ElementStress, Stresses};
use crate::error::Result;
use crate::model::{Magnitude, Model, Slot};
use crate::results::{Fields, State};
use crate::scene::History;

impl Engine<'_> {
    /// The current state with its quality; fields where asked for. Costs half a full solve.
    ///
    /// # Errors
    /// Failure of the backend's solve.
    pub fn state(&mut self, name: &str, with_fields: bool) -> Result<State> {
        let displacements = self.displacements()?;
        let nodal = self
            .model
            .nodal(displacements.deformation(), &self.at.factors);
        let stresses = Stresses::new(self.model, &self.zone, &self.elements, &nodal, with_fields);
        self.beyond_yield_outside
            .clone_from(&stresses.beyond_yield_outside);
        let figures = self.contact_figures();
        let residual_depth = self.residual_depth();
        let quality = self.quality(&displacements, &stresses);
        let u = &displacements.total;
        let arc = figures
            .patch
            .and_then(|patch| contact_arc(self.model, figures.contact, patch));
        let errors = with_fields.then(|| indicator(self.model, |e| &stresses.elements[e].points));
        Ok(State {
            name: name.to_string(),
            alpha: self.at.alpha,
            load: self
                .reaction(&stresses.reactions)
                .unwrap_or_else(|| self.total_load_size()),
            contact_force: figures.force * self.model.symmetry,
            max_pressure: figures.max_pressure,
            pole_pressure: figures.pole_pressure,
            half_width: figures.half_width,
            contact_arc: arc,
            residual_depth,
            plastic_points: stresses.plastic_points.iter().sum(),
            plastic_points_by_body: stresses.plastic_points,
            max_equivalent_plastic_strain: stresses.plastic_strain,
            plastic_zone_size: stresses.plastic_volume * self.model.symmetry,
            energy_error: errors.as_ref().map(|i| i.total),
            approach: self.approach(u),
            pairs: pair_states(
                self.model,
                &self.now.gap,
                &self.contact_forces(),
                self.tableau.open(),
            ),
            fields: errors.map(|errors| self.fields(u, &stresses.elements, errors)),
            quality,
        })
    }

    /// Where the loads that vary are prescribed displacements only and nothing touches: the force that holds the first of
    /// them, along its displacement, of the whole.
    fn reaction(&self, reactions: &[f64]) -> Option<f64> {
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
        for (prescribed, force) in model.freedoms.prescribed.iter().zip(reactions) {
            if prescribed.load == leading {
                sum += force * prescribed.value.signum();
            }
        }
        Some(sum * self.at.factors[leading].signum() * model.symmetry)
    }

    fn fields(&self, u: &[f64], elements: &[ElementStress], errors: Indicator) -> Fields {
        let nodal = self.model.nodal(u, &self.at.factors);
        Fields {
            displacement: nodal.into_iter().flatten().collect(),
            stress: elements.iter().flat_map(|e| e.mean).collect(),
            von_mises: elements.iter().map(|e| e.von_mises).collect(),
            plastic_strain: elements.iter().map(|e| e.plastic_strain).collect(),
            yielded: elements
                .iter()
                .map(|e| u8::from(e.plastic_strain > 0.0))
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
