//! Conversion of a deck into a scene on the deck's mesh.

mod along_axes;
mod conditions;
mod contact;
mod contact_changes;
mod draft;
mod geometry;
mod held_planes;
mod in_steps;
mod loose;
mod outputs;
mod system;
mod volume_loads;

pub(crate) use geometry::Geometry;

use super::Deck;
use super::adjust::any_interference;
use super::bodies::{Bodies, unsupported};
use super::data::{Account, Note, Section};
use super::element_type::has_two_rules;
use super::series::are_alike;
use super::temperature::{self, OfBody};
use crate::error::{Error, ErrorKind, Result};
use crate::interpolation::interpolate;
use crate::number::exact;
use crate::scene::{Body, History, Scene, Stepping, Support, Target};
use crate::shape::Integration;
use crate::space::Space;
use conditions::DeckConditions;
use contact::ScenePairs;
use draft::Draft;
use outputs::requests;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use volume_loads::BodyLoads;

/// Options for the conversion of a deck.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Options {
    /// Whether steps with `NLGEOM` are computed with small strains and displacements without
    /// measuring whether they are small.
    pub small_strain: bool,
    /// Whether a step leaves a state not only at its end but at each increment for which it
    /// requests results: at increments of a fixed size and at `TIME POINTS`. If nothing yields and
    /// nothing touches, a step has one increment, as in CalculiX.
    pub increments: bool,
}

/// A deck converted into a scene, whose mesh is the deck itself.
#[derive(Debug, Clone)]
pub struct Conversion {
    /// The scene; its `mesh.file` is the deck.
    pub scene: Scene,
    /// Which lines were understood, interpreted differently, or ignored.
    pub account: Account,
    pub(crate) geometry: Geometry,
    /// Lines of the deck that the keys of the scene come from.
    pub(super) places: BTreeMap<String, String>,
}

impl Deck {
    /// Converts the deck into the scene that it describes.
    ///
    /// # Errors
    /// `Unsupported` with all lines that ask for effects that brinell does not have; `Input` with
    /// file, line and keyword for inconsistent data.
    pub fn convert(&self, options: Options) -> Result<Conversion> {
        let mut account = self.account.clone();
        let large = self.judge_nlgeom(options, &mut account);
        if !account.refused.is_empty() {
            let lines: Vec<String> = account.refused.iter().map(Note::to_string).collect();
            return Err(Error::new(ErrorKind::Unsupported, lines.join("\n")));
        }
        if self.program.steps.is_empty() {
            return Err(self.error(
                self.end,
                "STEP",
                "the deck has no step; give it one, with its loads",
            ));
        }
        let space = self.space()?;
        let bodies = Bodies::of(self)?;
        if let Some(section) = bodies.sections.iter().position(Option::is_none) {
            let message = format!("body {} has no section", bodies.names[section]);
            return Err(self.error(self.end, "SOLID SECTION", message));
        }
        let geometry = Geometry::of(self)?;
        for (name, place) in &geometry.left_out {
            let text = format!("{name} contains both sides of a face and is used for results only");
            account.ignore(&self.files, *place, "SURFACE", &text);
        }
        let thickness = self.thickness(space, &mut account)?;
        let mut draft = Draft::new(self, account, geometry, thickness);
        let loose = DeckConditions::convert(&mut draft)?;
        let mut pairs = ScenePairs::default();
        pairs.add_contacts(&mut draft)?;
        pairs.add_changes(&mut draft)?;
        pairs.add_ties(&mut draft)?;
        let loads = BodyLoads {
            space,
            bodies: &bodies,
        };
        loads.add_volume_loads(&mut draft)?;
        let temperatures = temperature::of_bodies(self, &bodies)?;
        let mut scene = self.empty_scene(space);
        self.add_bodies(&bodies, &temperatures, &mut scene, &mut draft.places)?;
        self.add_integration(&bodies, &mut scene, &mut draft.account);
        loads.add_temperatures(&mut draft, temperatures)?;
        let of_plane = (space, draft.thickness);
        scene.requests = requests(self, of_plane, options.increments, &mut draft.account)?;
        scene.requests.large = large;
        scene.requests.loose = Arc::new(loose);
        self.add_loads(&mut draft, &mut scene);
        self.choose_stepping(&mut scene);
        (scene.support, scene.equation) = (draft.supports, draft.equations);
        (scene.contact, scene.tie) = (pairs.contacts, pairs.ties);
        Ok(Conversion {
            scene,
            account: draft.account,
            geometry: draft.geometry,
            places: draft.places,
        })
    }

    /// Notes that `NLGEOM` is computed with small displacements. Whether displacements are small is
    /// measured at the end of the run, unless the user has asked for small strains. Returns the
    /// place of the keyword if they are to be measured.
    fn judge_nlgeom(&self, options: Options, account: &mut Account) -> Option<String> {
        let place = self.nlgeom?;
        let text = match options.small_strain {
            true => "NLGEOM: strains and displacements are taken to be small all the same",
            false => {
                "NLGEOM: strains and displacements are taken to be small; the run measures them"
            }
        };
        account.take(&self.files, place, "STEP", text);
        (!options.small_strain).then(|| self.files.show(place))
    }

    /// The thickness of a plane model, which all sections must share: forces of the scene are per
    /// unit thickness.
    fn thickness(&self, space: Space, account: &mut Account) -> Result<f64> {
        if !matches!(space, Space::PlaneStrain | Space::PlaneStress) {
            return Ok(1.0);
        }
        let sections = &self.properties.sections;
        let of = |section: &Section| section.thickness.unwrap_or(1.0);
        let first = sections.first().map_or(1.0, of);
        if let Some(other) = sections.iter().find(|section| of(section) != first) {
            let message = format!(
                "the thickness is {}, but {} in another section: all sections of a plane model \
                 must have the same",
                exact(of(other)),
                exact(first)
            );
            return Err(unsupported(self.error(
                other.place,
                "SOLID SECTION",
                message,
            )));
        }
        if let Some(section) = sections.first().filter(|_| first != 1.0) {
            let text = format!(
                "forces are per unit thickness: those of the deck over {}",
                exact(first)
            );
            account.take(&self.files, section.place, "SOLID SECTION", &text);
        }
        Ok(first)
    }

    /// A scene with only a title and a mesh file.
    fn empty_scene(&self, space: Space) -> Scene {
        let name = self.file_name();
        let file = || name.to_string_lossy().into_owned();
        let title = self.heading.first().cloned().unwrap_or_else(file);
        let mut scene = Scene::of(space);
        scene.title = title;
        scene.mesh.file = Some(name);
        scene
    }

    /// The name of the deck's file, in whose directory the scene lies.
    fn file_name(&self) -> PathBuf {
        let file = Path::new(self.files.first());
        file.file_name().unwrap_or_default().into()
    }

    fn add_bodies(
        &self,
        bodies: &Bodies,
        temperatures: &[OfBody],
        scene: &mut Scene,
        places: &mut BTreeMap<String, String>,
    ) -> Result<()> {
        let materials = &self.properties.materials;
        let of_bodies = bodies.names.iter().zip(&bodies.sections).zip(temperatures);
        for ((name, section), of_body) in of_bodies {
            let section = &self.properties.sections[section.unwrap_or(0)];
            let Some(data) = materials.get(&section.material) else {
                let message = format!("there is no *MATERIAL {}", section.material);
                return Err(self.error(section.place, "SOLID SECTION", message));
            };
            let Some(of_material) = data.material() else {
                let message = format!("{} has no *ELASTIC; give it one", section.material);
                return Err(self.error(data.place, "MATERIAL", message));
            };
            let material = materials
                .written(&section.material)
                .unwrap_or_default()
                .to_string();
            let varies = !of_material.over_temperature.is_empty();
            let (temperature, is_uniform) = of_body.initial;
            if varies && !(is_uniform && of_body.change.is_zero()) {
                let message = format!(
                    "{material} depends on temperature, and body {name} has several: moduli and \
                     yield stresses are those of one temperature of a body; give one line to each \
                     table, or one temperature to the body"
                );
                let place = of_body.place.unwrap_or(data.place);
                return Err(unsupported(self.error(place, "TEMPERATURE", message)));
            }
            places.insert(format!("materials.{material}"), self.files.show(data.place));
            places.insert(format!("bodies.{name}"), self.files.show(section.place));
            scene.materials.insert(material.clone(), of_material);
            let body = Body {
                material,
                temperature: varies.then_some(temperature),
                ..Body::default()
            };
            scene.bodies.insert(name.clone(), body);
        }
        Ok(())
    }

    /// Sets the integration of bodies: a body with any fully integrated element is fully integrated
    /// as a whole.
    fn add_integration(&self, bodies: &Bodies, scene: &mut Scene, account: &mut Account) {
        let types = &self.mesh.elements.types;
        let is_full = |element: usize| types[element].integration == Integration::Full;
        for (element, &body) in bodies.of_element.iter().enumerate() {
            if let Some(body) = scene.bodies.get_mut(&bodies.names[body as usize])
                && is_full(element)
            {
                body.integration = Integration::Full;
            }
        }
        // The first element with a different integration is noted for each such body.
        let mut is_said = vec![false; bodies.names.len()];
        for (element, &body) in bodies.of_element.iter().enumerate() {
            let name = &bodies.names[body as usize];
            let is_mixed = has_two_rules(types[element].shape)
                && !is_full(element)
                && (scene.bodies.get(name)).is_some_and(|body| !body.integration.is_reduced());
            if is_mixed && !std::mem::replace(&mut is_said[body as usize], true) {
                let label = self.mesh.element_name(element);
                let text = format!(
                    "element {label}: its type has reduced integration, brinell integrates it \
                     fully, as others in body {name}: give it a section of its own"
                );
                let place = self.mesh.elements.places[element];
                account.take(&self.files, place, "ELEMENT", &text);
            }
        }
    }

    /// Chooses equal increments if there is no contact, and hence no event at which an increment
    /// could end. Each step gets at least as many increments as its first increment in the deck
    /// suggests.
    fn choose_stepping(&self, scene: &mut Scene) {
        if self.properties.contacts.is_empty() && scene.any_can_yield() {
            let steps = self.program.steps.iter().enumerate();
            let each = steps.map(|(number, step)| {
                let moments = scene.requests.moments.iter();
                let targets = moments.filter(|moment| moment.step == number + 1).count();
                step.increments.div_ceil(targets.max(1))
            });
            let least = each.max().unwrap_or(1);
            let program = &mut scene.program;
            program.stepping = Stepping::Steps;
            let targets = program
                .targets
                .len()
                .div_ceil(self.program.steps.len().max(1));
            program.steps = least.max(program.steps.div_ceil(targets.max(1)));
        }
    }

    /// Adds loads with their histories, and a target for each moment. If all loads that vary are
    /// proportional to each other and change only from step end to step end, load factors are
    /// multiples of the loads; otherwise they are times.
    fn add_loads(&self, draft: &mut Draft, scene: &mut Scene) {
        let ends = self.program.step_ends();
        let shapes: Vec<_> = draft
            .loads
            .iter()
            .map(|(_, series)| series.shape())
            .collect();
        let is_constant = |shape: &&Vec<[f64; 2]>| shape.iter().all(|row| row[1] == 1.0);
        let mut varying = shapes.iter().filter(|shape| !is_constant(shape));
        let first = varying.next();
        let from_step_to_step = |shape: &&Vec<[f64; 2]>| {
            let [start, rest @ ..] = &shape[..] else {
                return false;
            };
            start[1] == 0.0 && rest.iter().all(|row| ends.contains(&row[0]))
        };
        // An interference grows over the first step and stays.
        let interferes = any_interference(self);
        if interferes {
            scene.program.interference_until = ends.first().copied();
        }
        let spans = draft.supports.iter().map(Support::span);
        let of_loads = draft.loads.iter().map(|(load, _)| load.span());
        let changes = spans.chain(of_loads).any(|span| !span.is_whole());
        let is_counted_in_time = interferes || changes;
        let common = first.filter(|shape| !is_counted_in_time && from_step_to_step(shape));
        let common = common.filter(|first| varying.all(|shape| are_alike(shape, first)));
        let factor = |time: f64| match common {
            Some(shape) => interpolate(shape, time),
            None => time,
        };
        let moments = &scene.requests.moments;
        for (number, moment) in moments.iter().enumerate() {
            let place = self.files.show(self.program.steps[moment.step - 1].place);
            draft
                .places
                .insert(format!("program.targets.{number}"), place);
            let is_last = (moments.get(number + 1)).is_none_or(|next| next.step > moment.step);
            let (step, increment) = (moment.step, moment.increment);
            scene.program.targets.push(Target {
                name: Some(match is_last {
                    true => format!("step-{step}"),
                    false => format!("step-{step} increment {increment}"),
                }),
                load_factor: moment.time.map(factor),
                fields: true,
                ..Target::default()
            });
        }
        let loads = std::mem::take(&mut draft.loads).into_iter().zip(&shapes);
        for ((mut load, _), shape) in loads {
            load.history = match common {
                // A displacement that stays where it is has no rows.
                _ if shape.is_empty() => History::Constant,
                _ if is_constant(&shape) && load.span().is_whole() => History::Constant,
                Some(_) => History::Proportional,
                None => History::Table(shape.clone()),
            };
            scene.load.push(load);
        }
    }
}
