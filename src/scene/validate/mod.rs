//! Conditions on a scene that its types cannot express, as far as they can be checked without the
//! mesh.

mod boundary;
mod geometry;
mod material;
mod parts;
mod program;
mod rigid;
mod spans;

use super::{History, Scene};
use crate::error::{Error, Result};
use crate::number::exact;
use crate::space::Space;
use std::fmt;

impl Scene {
    /// Checks values and references. [`Scene::load`], [`Scene::parse`] and
    /// [`crate::model::ModelBuilder`] do so themselves, the first two with line and column. Call
    /// this method for a scene that was changed in code.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Input`], one line per problem: key path, value and how to correct it.
    pub fn validate(&self) -> Result<()> {
        self.report(problems(self))
    }

    /// Checks a scene like [`Scene::validate`] if its mesh is provided separately: the entry `mesh`
    /// is ignored.
    ///
    /// # Errors
    /// As for [`Scene::validate`].
    pub fn validate_without_mesh(&self) -> Result<()> {
        self.report(problems_without_mesh(self))
    }

    fn report(&self, problems: Vec<Problem>) -> Result<()> {
        if problems.is_empty() {
            return Ok(());
        }
        let lines: Vec<String> = problems.iter().map(Problem::to_string).collect();
        let error = Error::input(lines.join("\n"));
        Err(match &self.file {
            Some(file) => error.within(file.display()),
            None => error,
        })
    }

    /// Whether this body can yield: its material has a yield stress, and the scene does not declare
    /// the body elastic. False for a body that the scene does not have.
    pub fn can_yield(&self, body: &str) -> bool {
        let of = self.bodies.get(body).zip(self.material_of(body));
        of.is_some_and(|(body, material)| {
            body.plastic != super::Plastic::No && material.first_yield_stress().is_some()
        })
    }

    /// Whether any body can yield.
    pub fn any_can_yield(&self) -> bool {
        self.bodies.keys().any(|body| self.can_yield(body))
    }

    /// Whether any load changes with the load factor.
    pub fn any_load_varies(&self) -> bool {
        self.load.iter().any(|load| match &load.history {
            History::Proportional => true,
            History::Constant => false,
            History::Table(rows) => rows.windows(2).any(|pair| pair[0][1] != pair[1][1]),
        })
    }
}

/// Bound of sizes, stresses and slopes: values beyond it, or below its inverse, overflow or vanish
/// when multiplied together.
const LARGEST: f64 = 1e100;

/// Something wrong with the value at a key path.
pub(super) struct Problem {
    /// Key path of the value, such as `contact.0.gap`.
    pub key: String,
    message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.key.is_empty() {
            f.write_str(&self.message)
        } else {
            write!(f, "{}: {}", self.key, self.message)
        }
    }
}

/// The problem with a number of copies that make the whole, if there is one.
fn symmetry_problem(kind: Space, copies: usize) -> Option<String> {
    let (allowed, words): (&[usize], _) = match kind {
        Space::Axisymmetric => (
            &[1, 2],
            "1 (all of it is meshed) or 2 (half of it, above or below a plane of symmetry)",
        ),
        Space::PlaneStrain | Space::PlaneStress => (
            &[1, 2, 4],
            "1 (all of it is meshed), 2 (a half) or 4 (a quarter)",
        ),
        Space::Solid => (
            &[1, 2, 4, 8],
            "1 (all of it is meshed), 2 (a half), 4 (a quarter) or 8 (an eighth)",
        ),
    };
    (!allowed.contains(&copies)).then(|| format!("{copies} must be {words}"))
}

#[cfg(feature = "capi")]
impl Space {
    /// Checks whether this number of copies of a model of this kind can make the whole.
    ///
    /// # Errors
    /// `Input` naming the value and the possible values.
    pub(crate) fn check_symmetry(self, copies: usize) -> Result<()> {
        match symmetry_problem(self, copies) {
            Some(message) => Err(Error::input(format!("symmetry: {message}"))),
            None => Ok(()),
        }
    }
}

/// All problems of a scene.
pub(super) fn problems(scene: &Scene) -> Vec<Problem> {
    Checks::of(scene, Checks::geometry)
}

/// All problems of a scene except those of its entry `mesh`.
fn problems_without_mesh(scene: &Scene) -> Vec<Problem> {
    Checks::of(scene, |_, _| {})
}

/// Whether any body can yield, as far as is known. An undefined material counts as able to yield:
/// it is reported once, not again by every check that needs it.
fn may_yield(scene: &Scene) -> bool {
    let mut bodies = scene.bodies.values();
    scene.any_can_yield() || bodies.any(|body| !scene.materials.contains_key(&body.material))
}

/// Collects the problems of a scene.
#[derive(Default)]
struct Checks {
    problems: Vec<Problem>,
}

impl Checks {
    fn of(scene: &Scene, geometry: impl Fn(&mut Checks, &Scene)) -> Vec<Problem> {
        let mut checks = Checks::default();
        checks.finite(scene);
        // With NaN, the other checks would only repeat the problem in different words.
        if checks.problems.is_empty() {
            checks.symmetry(scene);
            checks.units(scene);
            geometry(&mut checks, scene);
            checks.materials(scene);
            checks.boundary(scene);
            checks.rigid(scene);
            checks.program(scene);
            checks.spans(scene);
            checks.references(scene);
            checks.require(
                scene.start_from.is_none() || scene.accuracy.is_none(),
                "start_from",
                "a state belongs to one mesh, and `accuracy` asks for others: leave one of them \
                 out",
            );
        }
        checks.problems
    }

    fn problem(&mut self, key: impl Into<String>, message: impl Into<String>) {
        self.problems.push(Problem {
            key: key.into(),
            message: message.into(),
        });
    }

    /// Reports `message` at `key` unless `holds`.
    fn require(&mut self, holds: bool, key: impl Into<String>, message: impl Into<String>) {
        if !holds {
            self.problem(key, message);
        }
    }

    fn positive(&mut self, key: impl Into<String>, value: f64) {
        self.require(
            value > 0.0,
            key,
            format!("{} must be greater than zero", exact(value)),
        );
    }

    /// Requires a stress or a modulus to be positive, and of a size whose products do not overflow.
    fn stress(&mut self, key: impl Into<String>, value: f64) {
        let range = 1.0 / LARGEST..=LARGEST;
        self.require(
            range.contains(&value),
            key,
            if value > 0.0 {
                let value = exact(value);
                format!(
                    "{value} must lie between {:e} and {LARGEST:e}",
                    1.0 / LARGEST
                )
            } else {
                format!("{} must be greater than zero", exact(value))
            },
        );
    }

    /// Requires a slope that was computed from values of `key` to be small enough not to overflow.
    fn slope(&mut self, key: impl Into<String>, what: &str, slope: f64) {
        self.require(
            slope.abs() <= LARGEST,
            key,
            format!(
                "{what} is {}, beyond {LARGEST:e}: it would overflow",
                exact(slope)
            ),
        );
    }

    fn at_least(&mut self, key: impl Into<String>, value: f64, least: f64) {
        self.require(
            value >= least,
            key,
            format!("{} must be at least {}", exact(value), exact(least)),
        );
    }

    fn count(&mut self, key: impl Into<String>, value: usize, least: usize) {
        self.require(
            value >= least,
            key,
            format!("{value} must be at least {least}"),
        );
    }

    fn at_most(&mut self, key: impl Into<String>, value: usize, most: usize) {
        self.require(
            value <= most,
            key,
            format!("{value} is too many: at most {most}"),
        );
    }

    /// Reports a problem unless exactly one of `choices` (name, given) is given.
    fn exactly_one(&mut self, key: impl Into<String>, what: &str, choices: &[(&str, bool)]) {
        let names = |given_only: bool| -> String {
            let names: Vec<&str> = choices
                .iter()
                .filter(|(_, given)| *given || !given_only)
                .map(|(name, _)| *name)
                .collect();
            names.join(", ")
        };
        match choices.iter().filter(|(_, given)| *given).count() {
            1 => {}
            0 => self.problem(
                key,
                format!("no {what}; give exactly one of {}", names(false)),
            ),
            n => self.problem(
                key,
                format!("{n} of {what} given ({}); keep exactly one", names(true)),
            ),
        }
    }

    /// Checks `symmetry` against the planes of symmetry that the kind of model can have: two axes
    /// in the plane, one plane for a body of revolution, three planes for a solid.
    fn symmetry(&mut self, scene: &Scene) {
        let problem = symmetry_problem(scene.kind, scene.symmetry);
        self.problems.extend(problem.map(|message| Problem {
            key: "symmetry".to_string(),
            message,
        }));
    }

    /// Requires the unit of stress to be a force over a length squared.
    fn units(&mut self, scene: &Scene) {
        let Some(units) = &scene.units else {
            return;
        };
        if let Some(ratio) = units.mismatch() {
            self.problem(
                "units.stress",
                format!(
                    "\"{}\" is not force over length squared: 1 {} on 1 {} squared is {ratio:.4e} \
                     {}; are moduli and loads in the same units?",
                    units.stress, units.force, units.length, units.stress
                ),
            );
        }
    }

    /// Requires all numbers of the scene to be finite. Numbers from a file always are, numbers set
    /// by a caller may not be.
    fn finite(&mut self, scene: &Scene) {
        match toml::Value::try_from(scene) {
            Ok(value) => self.finite_value("", &value),
            Err(error) => self.problem("", format!("the scene is not plain data: {error}")),
        }
    }

    fn finite_value(&mut self, key: &str, value: &toml::Value) {
        match value {
            toml::Value::Float(number) => self.require(
                number.is_finite(),
                key,
                format!("{number} is not a finite number; give a finite one"),
            ),
            toml::Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    self.finite_value(&super::document::join(key, &index.to_string()), item);
                }
            }
            toml::Value::Table(table) => {
                for (name, item) in table {
                    self.finite_value(&super::document::join(key, name), item);
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests;
