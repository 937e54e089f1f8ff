//! Conditions on a scene that its types cannot express, as far as they can be checked without the
//! mesh.

mod boundary;
mod geometry;
mod material;
mod parts;
mod problems;
mod program;
mod reference;
mod rigid;
mod spans;

use self::problems::{Problem, Problems};
use super::Scene;
use super::document::join;
use crate::error::{Error, Result};
use crate::space::Space;

impl Scene {
    /// Checks values and references. [`Scene::load`], [`Scene::parse`] and
    /// [`crate::model::ModelBuilder`] do so themselves, the first two with line and column. Call
    /// this method for a scene that was changed in code.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Input`], one line per problem: key path, value and how to correct it.
    pub fn validate(&self) -> Result<()> {
        self.report(all_problems(self))
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
}

/// Describes why a number of copies cannot make the whole of a model of this kind; `None` if it
/// can.
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
pub(super) fn all_problems(scene: &Scene) -> Vec<Problem> {
    found(scene, geometry::check)
}

/// All problems of a scene except those of its entry `mesh`.
fn problems_without_mesh(scene: &Scene) -> Vec<Problem> {
    found(scene, |_, _| {})
}

fn found(scene: &Scene, check_mesh: impl Fn(&mut Problems, &Scene)) -> Vec<Problem> {
    let mut problems = Problems::default();
    check_finite(&mut problems, scene);
    // With NaN, the other checks would only repeat the problem in different words.
    if problems.number() > 0 {
        return problems.into_vec();
    }
    check_symmetry(&mut problems, scene);
    check_units(&mut problems, scene);
    check_mesh(&mut problems, scene);
    material::check(&mut problems, scene);
    boundary::check(&mut problems, scene);
    rigid::check(&mut problems, scene);
    program::check(&mut problems, scene);
    spans::check(&mut problems, scene);
    reference::check(&mut problems, scene);
    problems.require(
        scene.start_from.is_none() || scene.accuracy.is_none(),
        "start_from",
        "a state belongs to one mesh, and `accuracy` asks for others: leave one of them out",
    );
    problems.into_vec()
}

/// Checks `symmetry` against the planes of symmetry that the kind of model can have: two axes
/// in the plane, one plane for a body of revolution, three planes for a solid.
fn check_symmetry(problems: &mut Problems, scene: &Scene) {
    if let Some(message) = symmetry_problem(scene.kind, scene.symmetry) {
        problems.problem("symmetry", message);
    }
}

/// Requires the unit of stress to be a force over a length squared.
fn check_units(problems: &mut Problems, scene: &Scene) {
    let Some(units) = &scene.units else {
        return;
    };
    if let Some(ratio) = units.mismatch() {
        problems.problem(
            "units.stress",
            format!(
                "\"{}\" is not force over length squared: 1 {} on 1 {} squared is {ratio:.4e} \
                 {}; are moduli and loads in the same units?",
                units.stress, units.force, units.length, units.stress
            ),
        );
    }
}

/// Requires all numbers of the scene to be finite. Numbers from a file always are; numbers set by a
/// caller may not be.
fn check_finite(problems: &mut Problems, scene: &Scene) {
    match toml::Value::try_from(scene) {
        Ok(value) => check_finite_value(problems, "", &value),
        Err(error) => problems.problem("", format!("the scene is not plain data: {error}")),
    }
}

fn check_finite_value(problems: &mut Problems, key: &str, value: &toml::Value) {
    match value {
        toml::Value::Float(number) => problems.require(
            number.is_finite(),
            key,
            format!("{number} is not a finite number; give a finite one"),
        ),
        toml::Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                check_finite_value(problems, &join(key, &index.to_string()), item);
            }
        }
        toml::Value::Table(table) => {
            for (name, item) in table {
                check_finite_value(problems, &join(key, name), item);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests;
