//! Validation of the load program, the settings and the reference values.

use super::Checks;
use crate::number::exact;
use crate::scene::{
    Field, History, LEAST_PATH_ERROR, PlaceQuantity, Reference, Scene, Target, TargetFigure, Unit,
};
use std::collections::{BTreeMap, BTreeSet};

/// Bounds on the size of results: each increment adds a row to the history, and each target a state
/// with all its contact pairs.
const MOST_STEPS: usize = 10_000_000;
const MOST_TARGETS: usize = 10_000;
const MOST_CYCLES: usize = 1_000_000;

impl Checks {
    /// Requires the targets of a cycle to be load factors, at least two of them different.
    fn cycle(&mut self, targets: &[Target]) {
        let factors: Vec<Option<f64>> = targets.iter().map(|target| target.load_factor).collect();
        for (index, _) in factors.iter().enumerate().filter(|(_, f)| f.is_none()) {
            self.problem(
                format!("program.targets.{index}"),
                "a target of `cycles` must be a load_factor: it is met again in each",
            );
        }
        self.require(
            factors.iter().any(|factor| *factor != factors[0]) || factors.contains(&None),
            "program.cycles",
            "all targets are the same load factor: a cycle needs at least two, its ends",
        );
    }

    pub(super) fn program(&mut self, scene: &Scene) {
        let program = &scene.program;
        self.require(
            program.gamma > 0.0 && program.gamma <= 0.5,
            "program.gamma",
            format!(
                "{} must be greater than 0 and at most 0.5",
                exact(program.gamma)
            ),
        );
        self.require(
            program.path_error >= LEAST_PATH_ERROR && program.path_error <= 0.1,
            "program.path_error",
            format!(
                "{} must be at least {LEAST_PATH_ERROR:e} and at most 0.1",
                exact(program.path_error)
            ),
        );
        self.count("program.max_increments", program.max_increments, 1);
        self.count("program.steps", program.steps, 1);
        self.at_most("program.steps", program.steps, MOST_STEPS);
        self.at_most("program.targets", program.targets.len(), MOST_TARGETS);
        self.require(
            !program.targets.is_empty(),
            "program.targets",
            "is empty; give at least one, for instance { load_factor = 1 }",
        );
        self.count("program.cycles", program.cycles, 1);
        self.at_most("program.cycles", program.cycles, MOST_CYCLES);
        self.require(
            program.steady > 0.0 && program.steady < 1.0,
            "program.steady",
            format!("{} must lie between 0 and 1", exact(program.steady)),
        );
        if program.cycles > 1 {
            self.cycle(&program.targets);
        }
        self.unit(scene);
        self.growing(&program.targets);
        self.followed_sets(&program.history);
        self.targets(scene);
        self.loaded(scene);
        let settings = &scene.analysis;
        self.require(
            settings.tolerance > 1e-15 && settings.tolerance < 1e-2,
            "analysis.tolerance",
            format!("{:e} must lie between 1e-15 and 1e-2", settings.tolerance),
        );
        self.count("analysis.max_iterations", settings.max_iterations, 1);
    }

    /// Checks what the load factors of the program count in.
    fn unit(&mut self, scene: &Scene) {
        let program = &scene.program;
        if let Some(until) = program.interference_until {
            self.positive("program.interference_until", until);
            self.require(
                program.unit == Unit::Load,
                "program.interference_until",
                "counts in load factors of the loads as given; use `unit = \"load\"`",
            );
        }
        if program.unit == Unit::Yield {
            self.needs_yield("program.unit", "\"yield\"", scene);
            for (index, load) in scene.load.iter().enumerate() {
                self.require(
                    !matches!(load.history, History::Table(_)),
                    format!("load.{index}.history"),
                    "is a table over the load factor, but `unit = \"yield\"` counts in the yield \
                     load, which the table itself would change; use `unit = \"load\"`",
                );
            }
        }
    }

    /// Checks the names of the sets that the history follows.
    fn followed_sets(&mut self, history: &[String]) {
        let mut followed = BTreeSet::new();
        for (index, name) in history.iter().enumerate() {
            let key = format!("program.history.{index}");
            self.require(
                !name.is_empty(),
                key.as_str(),
                "is empty; name a set of the mesh",
            );
            let is_new = followed.insert(name.as_str());
            self.require(is_new, key, format!("\"{name}\" is there twice"));
        }
    }

    /// Checks the names and the conditions of all targets.
    fn targets(&mut self, scene: &Scene) {
        let mut names = BTreeSet::new();
        for (index, target) in scene.program.targets.iter().enumerate() {
            let key = format!("program.targets.{index}");
            if let Some(name) = &target.name {
                self.require(!name.is_empty(), format!("{key}.name"), "is empty");
                self.require(
                    names.insert(name.as_str()),
                    format!("{key}.name"),
                    format!("\"{name}\" is the name of an earlier target too"),
                );
            }
            self.target(&key, target, scene);
        }
    }

    fn target(&mut self, key: &str, target: &Target, scene: &Scene) {
        let mut conditions = vec![
            ("yield", target.first_yield),
            ("load_factor", target.load_factor.is_some()),
            ("half_width", target.half_width.is_some()),
            ("displacement", target.displacement.is_some()),
        ];
        let asked = |figure: TargetFigure| (figure.key(), target.value_of(figure).is_some());
        conditions.extend(TargetFigure::ALL.map(asked));
        self.exactly_one(key, "target condition", &conditions);
        if target.first_yield {
            self.needs_yield(&format!("{key}.yield"), "true", scene);
        }
        if let Some(half_width) = target.half_width {
            let key = format!("{key}.half_width");
            self.positive(key.as_str(), half_width);
            self.require(
                !scene.contact.is_empty(),
                key.as_str(),
                "the scene has no contact; add a [[contact]] or choose another target",
            );
            self.needs_yield(&key, "a multiple of the half width at first yield", scene);
        }
        self.target_figure(key, target, scene);
        if let Some(displacement) = &target.displacement {
            self.require(
                !displacement.on.is_empty(),
                format!("{key}.displacement.on"),
                "is empty; name a surface or node set of the mesh",
            );
            self.require(
                scene.any_load_varies(),
                format!("{key}.displacement"),
                "no load changes with the load factor, so nothing moves",
            );
        }
    }

    /// Checks what a target that prescribes a figure needs.
    fn target_figure(&mut self, key: &str, target: &Target, scene: &Scene) {
        let given: Vec<_> = target.figures().collect();
        for &(figure, value) in &given {
            let key = format!("{key}.{}", figure.key());
            self.positive(key.as_str(), value);
            self.require(
                !scene.contact.is_empty() || !figure.needs_contact(),
                key.as_str(),
                "the scene has no contact; add a [[contact]] or choose another target",
            );
            if figure.stays() {
                self.needs_yield(&key, "what yielding leaves", scene);
            }
            self.require(
                scene.any_load_varies(),
                key.as_str(),
                "no load changes with the load factor, so it stays as it is",
            );
        }
        let any = |holds: fn(TargetFigure) -> bool| given.iter().any(|(figure, _)| holds(*figure));
        if let Some(body) = &target.body {
            let key = format!("{key}.body");
            self.require(
                any(|figure| figure == TargetFigure::ResidualDepth),
                key.as_str(),
                "belongs to `residual_depth`, which is not given",
            );
            let known: Vec<&str> = scene.bodies.keys().map(String::as_str).collect();
            self.require(
                known.contains(&body.as_str()),
                key.as_str(),
                format!(
                    "the scene has no body \"{body}\"; it has {}",
                    known.join(", ")
                ),
            );
        }
        if let Some(number) = target.contact {
            let key = format!("{key}.contact");
            self.require(
                any(TargetFigure::is_of_contact),
                key.as_str(),
                "belongs to `contact_force`, `contact_area` or `max_pressure`, none of which is \
                 given",
            );
            self.require(
                (1..=scene.contact.len()).contains(&number),
                key.as_str(),
                format!(
                    "{number}: contacts count from 1, and the scene has {}",
                    scene.contact.len()
                ),
            );
        }
    }

    /// Requires targets for a figure that unloading does not reduce not to decrease from one target
    /// to the next.
    fn growing(&mut self, targets: &[Target]) {
        let mut largest: BTreeMap<(&str, Option<&str>), f64> = BTreeMap::new();
        for (index, target) in targets.iter().enumerate() {
            for (figure, value) in target.figures().filter(|(figure, _)| figure.stays()) {
                let of = (figure.key(), target.body.as_deref());
                let before = largest.entry(of).or_insert(value);
                self.require(
                    value >= *before,
                    format!("program.targets.{index}.{}", figure.key()),
                    format!(
                        "{} is less than the {} of an earlier target, and no load takes it back",
                        exact(value),
                        exact(*before)
                    ),
                );
                *before = before.max(value);
            }
        }
    }

    /// Requires a body that can yield and a load that varies, for a key that refers to first yield.
    fn needs_yield(&mut self, key: &str, what: &str, scene: &Scene) {
        self.require(
            super::may_yield(scene),
            key,
            format!(
                "{what}, but no body can yield: give a material a yield_stress, \
                 and take plastic = false off its body"
            ),
        );
        self.require(
            scene.any_load_varies(),
            key,
            format!("{what}, but no load changes with the load factor: add a proportional load"),
        );
    }

    fn loaded(&mut self, scene: &Scene) {
        let shrunk = scene
            .contact
            .iter()
            .any(|contact| contact.interference != Field::default() || contact.overlap)
            || (scene.mesh.disc_in_plate.as_ref()).is_some_and(|disc| disc.interference != 0.0);
        let mut bodies = scene.bodies.values();
        let brought_along = bodies.any(|body| body.brought_along().next().is_some());
        self.require(
            !scene.load.is_empty() || shrunk || brought_along || scene.start_from.is_some(),
            "load",
            "there is no load, no interference and no initial stress: nothing happens; add a \
             [[load]]",
        );
    }

    pub(super) fn references(&mut self, scene: &Scene) {
        for (index, reference) in scene.reference.iter().enumerate() {
            let key = format!("reference.{index}");
            self.exactly_one(
                key.as_str(),
                "reference",
                &[
                    ("hertz_line", reference.hertz_line.is_some()),
                    ("hertz_point", reference.hertz_point.is_some()),
                    ("hertz_ellipse", reference.hertz_ellipse.is_some()),
                    ("disc_in_plate", reference.disc_in_plate.is_some()),
                    (
                        "quantity (with value and source)",
                        reference.quantity.is_some(),
                    ),
                ],
            );
            self.place(&key, reference, scene);
            let single = reference.quantity.is_some();
            for (name, given) in [
                ("value", reference.value.is_some()),
                ("source", reference.source.is_some()),
            ] {
                self.require(
                    given == single,
                    format!("{key}.{name}"),
                    if single {
                        format!(
                            "is missing: a single value needs quantity, value and source, and \
                             `{name}` is not given"
                        )
                    } else {
                        "belongs to a `quantity`, which is not given".to_string()
                    },
                );
            }
            for (name, circle, axisymmetric) in [
                ("hertz_line", reference.hertz_line, false),
                ("hertz_point", reference.hertz_point, true),
            ] {
                let Some(circle) = circle else { continue };
                self.positive(format!("{key}.{name}.radius"), circle.radius);
                self.require(
                    scene.kind.is_axisymmetric() == axisymmetric,
                    format!("{key}.{name}"),
                    if axisymmetric {
                        "point contact needs kind = \"axisymmetric\""
                    } else {
                        "line contact needs a plane model, this one is axisymmetric"
                    },
                );
                self.needs_yield(&format!("{key}.{name}"), "values at first yield", scene);
            }
            if reference.hertz_ellipse.is_some() {
                let key = format!("{key}.hertz_ellipse");
                self.require(
                    scene.kind.is_solid(),
                    key.as_str(),
                    "elliptical contact needs kind = \"solid\"",
                );
                self.needs_yield(&key, "values at first yield", scene);
            }
            self.require(
                reference.disc_in_plate.is_none()
                    || !(scene.kind.is_axisymmetric() || scene.kind.is_solid()),
                format!("{key}.disc_in_plate"),
                "is the solution of a plane model, this one is not",
            );
        }
    }

    /// Requires coordinates for a quantity at a point, and refuses them for any other quantity.
    fn place(&mut self, key: &str, reference: &Reference, scene: &Scene) {
        let path = reference.quantity.as_deref();
        let of_place = path.is_some_and(|path| PlaceQuantity::of(path, scene.kind).is_some());
        let n = scene.kind.dimension();
        match (&reference.at, of_place) {
            (Some(at), true) => self.require(
                at.len() == n,
                format!("{key}.at"),
                format!("needs {n} coordinates, {} are given", at.len()),
            ),
            (None, true) => self.problem(
                format!("{key}.quantity"),
                "is one of a place: give its coordinates, `at = [...]`",
            ),
            (Some(_), false) => self.problem(
                format!("{key}.at"),
                format!(
                    "belongs to a quantity of a place: states.NAME.pressure, .displacement_x, ..., \
                     .stress_{}, ...",
                    scene.kind.components()[0]
                ),
            ),
            (None, false) => {}
        }
        if let Some(body) = &reference.body {
            self.require(
                scene.bodies.contains_key(body),
                format!("{key}.body"),
                format!("there is no body `{body}`"),
            );
        }
    }
}
