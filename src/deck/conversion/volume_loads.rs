//! Loads on the volumes of bodies: weight, rotation, and change of temperature.

use super::super::bodies::{Bodies, unsupported};
use super::super::data::{ConditionKind, VolumeLoad};
use super::super::history::histories;
use super::super::source::LinePlace;
use super::super::temperature::OfBody;
use super::draft::Draft;
use crate::error::Result;
use crate::number::significant;
use crate::scene::{Field, Load, NodalField, Rotation};
use crate::space::Space;
use std::f64::consts::PI;

/// Tolerance for the direction of a unit vector, given with the digits of a deck.
const ALIGNED: f64 = 1e-6;

/// Loads on the bodies of a deck.
pub(super) struct BodyLoads<'b> {
    pub(super) space: Space,
    pub(super) bodies: &'b Bodies,
}

impl BodyLoads<'_> {
    /// Adds weight and rotation.
    pub(super) fn add_volume_loads(&self, draft: &mut Draft) -> Result<()> {
        for ((body, index), entry) in histories(draft.deck, ConditionKind::Volume)? {
            if entry.series.is_zero() {
                continue;
            }
            let on = self.bodies.names[body as usize].clone();
            let largest = entry.series.largest();
            let is_rotation = matches!(
                draft.deck.program.volume_loads[index as usize],
                VolumeLoad::Rotation(_)
            );
            if let Some([_, square]) = entry.series.rows().iter().find(|row| row[1] < 0.0)
                && is_rotation
            {
                let message = format!(
                    "CENTRIF: the square of the speed becomes {}; it must not be negative: \
                     check the *AMPLITUDE",
                    significant(*square, 6)
                );
                return Err(draft.deck.error(entry.place, "DLOAD", message));
            }
            let load = match draft.deck.program.volume_loads[index as usize] {
                VolumeLoad::Acceleration(way) => Load {
                    on,
                    acceleration: Some(draft.components(way.map(|x| x * largest))),
                    ..Load::default()
                },
                VolumeLoad::Rotation(axis) => Load {
                    on,
                    rotation: Some(self.rotation(draft, axis, (largest, entry.place))?),
                    ..Load::default()
                },
            };
            draft.add_load("volume", load, entry.series, entry.place);
        }
        Ok(())
    }

    /// A load by rotation; the axis must be perpendicular to a plane model, and the model's own
    /// axis if it is axisymmetric.
    fn rotation(
        &self,
        draft: &Draft,
        [point, way]: [[f64; 3]; 2],
        (square, place): (f64, LinePlace),
    ) -> Result<Rotation> {
        let is_along = |axis: usize| way[axis].abs() > 1.0 - ALIGNED;
        let space = self.space;
        let fits = match space {
            Space::Solid => true,
            Space::Axisymmetric => is_along(1) && point[0] == 0.0,
            Space::PlaneStrain | Space::PlaneStress => is_along(2),
        };
        if !fits {
            let message = "CENTRIF turns plane models about an axis along z, axisymmetric ones \
                           about their own, y";
            return Err(unsupported(draft.deck.error(place, "DLOAD", message)));
        }
        let is_axisymmetric = space == Space::Axisymmetric;
        Ok(Rotation {
            rpm: 30.0 / PI * square.sqrt(),
            center: (!is_axisymmetric).then(|| draft.components(point)),
            axis: space.is_solid().then_some(way),
        })
    }

    /// Adds temperature loads on bodies that expand. Temperatures of other bodies have no effect,
    /// which is noted.
    ///
    /// # Errors
    /// `Input` if temperatures without effect are the only loads.
    pub(super) fn add_temperatures(
        &self,
        draft: &mut Draft,
        temperatures: Vec<OfBody>,
    ) -> Result<()> {
        let mut idle = None;
        let (deck, bodies) = (draft.deck, self.bodies);
        let properties = &deck.properties;
        let of_bodies = bodies.names.iter().zip(&bodies.sections).zip(temperatures);
        for ((name, section), of_body) in of_bodies {
            let section = &properties.sections[section.unwrap_or(0)];
            let material = properties.materials.get(&section.material);
            let expands = material.is_some_and(|m| m.expansion.is_some());
            let Some(place) = of_body.place else { continue };
            if expands && !of_body.change.is_zero() {
                let field = match of_body.is_uniform {
                    true => Field::Uniform(of_body.change.largest()),
                    false => Field::Nodal(NodalField {
                        file: deck.file_name(),
                    }),
                };
                let load = Load {
                    on: name.clone(),
                    temperature: Some(field),
                    ..Load::default()
                };
                draft.add_load("temperature", load, of_body.change, place);
            } else if !of_body.change.is_zero() {
                let name = &section.material;
                let text = format!("material {name} has no *EXPANSION: temperatures do nothing");
                draft.remark(place, "TEMPERATURE", &text);
                idle = Some((place, text));
            }
        }
        match idle {
            Some((place, text)) if draft.loads.is_empty() && properties.contacts.is_empty() => {
                let message = format!("{text}, and nothing else loads the bodies; give it one");
                Err(deck.error(place, "TEMPERATURE", message))
            }
            _ => Ok(()),
        }
    }
}
