//! Loads on the volumes of bodies: weight, rotation, and change of temperature.

use super::super::bodies::{Bodies, unsupported};
use super::super::data::{Account, ConditionKind, VolumeLoad};
use super::super::source::LinePlace;
use super::super::temperature::OfBody;
use super::Draft;
use crate::error::Result;
use crate::scene::{Field, Load, NodalField, Rotation};
use crate::space::Space;
use std::f64::consts::PI;

/// Tolerance for the direction of a unit vector, given with the digits of a deck.
const ALIGNED: f64 = 1e-6;

impl Draft<'_> {
    pub(super) fn volume_loads(&mut self, space: Space, bodies: &Bodies) -> Result<()> {
        for ((body, index), entry) in self.deck.histories(ConditionKind::Volume)? {
            if entry.series.is_zero() {
                continue;
            }
            let on = bodies.names[body as usize].clone();
            let largest = entry.series.largest();
            let load = match self.deck.program.volume_loads[index as usize] {
                VolumeLoad::Acceleration(way) => Load {
                    on,
                    acceleration: Some(self.components(way.map(|x| x * largest))),
                    ..Load::default()
                },
                VolumeLoad::Rotation(axis) => Load {
                    on,
                    rotation: Some(self.rotation(space, axis, largest, entry.place)?),
                    ..Load::default()
                },
            };
            self.add_load("volume", load, entry.series, entry.place);
        }
        Ok(())
    }

    /// A load by rotation; the axis must be perpendicular to a plane model, and the model's own
    /// axis if it is axisymmetric.
    fn rotation(
        &self,
        space: Space,
        [point, way]: [[f64; 3]; 2],
        square: f64,
        place: LinePlace,
    ) -> Result<Rotation> {
        let is_along = |axis: usize| way[axis].abs() > 1.0 - ALIGNED;
        let fits = match space {
            Space::Solid => true,
            Space::Axisymmetric => is_along(1) && point[0] == 0.0,
            Space::PlaneStrain | Space::PlaneStress => is_along(2),
        };
        if !fits {
            let message = "CENTRIF turns plane models about an axis along z, axisymmetric ones \
                           about their own, y";
            return Err(unsupported(self.deck.error(place, "DLOAD", message)));
        }
        let is_axisymmetric = space == Space::Axisymmetric;
        Ok(Rotation {
            rpm: 30.0 / PI * square.sqrt(),
            center: (!is_axisymmetric).then(|| self.components(point)),
            axis: space.is_solid().then_some(way),
        })
    }

    /// Adds temperature loads on bodies that expand. Temperatures of other bodies have no effect,
    /// which is noted.
    ///
    /// # Errors
    /// `Input` if temperatures without effect are the only loads.
    pub(super) fn temperatures(
        &mut self,
        bodies: &Bodies,
        temperatures: Vec<OfBody>,
        account: &mut Account,
    ) -> Result<()> {
        let mut idle = None;
        let properties = &self.deck.properties;
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
                        file: self.deck.file_name(),
                    }),
                };
                let load = Load {
                    on: name.clone(),
                    temperature: Some(field),
                    ..Load::default()
                };
                self.add_load("temperature", load, of_body.change, place);
            } else if !of_body.change.is_zero() {
                let name = &section.material;
                let text = format!("material {name} has no *EXPANSION: temperatures do nothing");
                let list = &mut account.taken;
                Account::add(list, &self.deck.files, place, "TEMPERATURE", &text);
                idle = Some((place, text));
            }
        }
        match idle {
            Some((place, text)) if self.loads.is_empty() && self.contacts.is_empty() => {
                let message = format!("{text}, and nothing else loads the bodies; give it one");
                Err(self.deck.error(place, "TEMPERATURE", message))
            }
            _ => Ok(()),
        }
    }
}
