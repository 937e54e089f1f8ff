//! A quantity as a function of position.

use crate::number::exact;
use crate::space::{Components, Space, Vector};
use exmex::{Express, FlatEx, FloatOpsFactory, MatchLiteral};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;

/// A number, a formula of the position, or values at nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "a number, a formula in quotes or { file = \"values.msh\" } is wanted"
)]
pub enum Field {
    /// One value everywhere.
    Uniform(f64),
    /// A formula of the position. Names in a plane model are `x`, `y` and `r`, the distance from
    /// the origin; in a solid `x`, `y`, `z` and `r`, the distance from the z axis; in an
    /// axisymmetric model the two coordinates `r` and `z`.
    Formula(String),
    /// Values at the nodes of the mesh, from a file.
    Nodal(NodalField),
}

/// Values at nodes, read from a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodalField {
    /// A Gmsh file with one section `$NodeData`, relative to the scene file.
    pub file: PathBuf,
}

impl Default for Field {
    fn default() -> Self {
        Field::Uniform(0.0)
    }
}

impl From<f64> for Field {
    fn from(value: f64) -> Self {
        Field::Uniform(value)
    }
}

/// Writes the field for a reader: the number, the formula, or the name of the file.
impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Field::Uniform(value) => f.write_str(&exact(*value)),
            Field::Formula(text) => f.write_str(text),
            Field::Nodal(of) => write!(f, "as in {}", of.file.display()),
        }
    }
}

/// The components of a vector that may depend on the position: two in the plane, three in space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Vec<Field>", into = "Vec<Field>")]
#[schemars(with = "Vec<Field>", extend("minItems" = 2, "maxItems" = 3))]
pub struct VectorField(Vec<Field>);

impl VectorField {
    /// The components, two or three as they were given.
    pub fn iter(&self) -> std::slice::Iter<'_, Field> {
        self.0.iter()
    }

    /// Number of components given.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The vector, if it is the same everywhere.
    pub fn uniform(&self) -> Option<Vector> {
        let mut vector = [0.0; 3];
        for (component, field) in vector.iter_mut().zip(&self.0) {
            *component = field.uniform()?;
        }
        Some(vector)
    }
}

impl From<[f64; 2]> for VectorField {
    fn from(plane: [f64; 2]) -> Self {
        Components::from(plane).into()
    }
}

impl From<Vector> for VectorField {
    fn from(vector: Vector) -> Self {
        Components::from(vector).into()
    }
}

impl From<Components> for VectorField {
    fn from(components: Components) -> Self {
        VectorField(components.iter().map(Field::Uniform).collect())
    }
}

impl TryFrom<Vec<Field>> for VectorField {
    type Error = String;

    fn try_from(given: Vec<Field>) -> Result<Self, String> {
        match given.len() {
            2 | 3 => Ok(VectorField(given)),
            n => Err(format!(
                "{n} components: a vector has 2, in a solid model 3"
            )),
        }
    }
}

impl From<VectorField> for Vec<Field> {
    fn from(vector: VectorField) -> Self {
        vector.0
    }
}

impl JsonSchema for Field {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Field".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, or a formula of the position such as `\"20 * log(r / 50)\"`: \
                            x, y, of a solid z, and r = sqrt(x^2 + y^2); of an axisymmetric model \
                            r and z. exp, log (natural), sqrt, sin, cos, abs, min, max, ^ and the \
                            like. Or \
                            `{ file = \"heat.msh\" }`: values at nodes, read from a Gmsh \
                            file that has exactly one $NodeData section; its path is relative \
                            to the scene file.",
            "anyOf": [
                { "type": "number" },
                { "type": "string" },
                {
                    "type": "object",
                    "properties": { "file": { "type": "string" } },
                    "required": ["file"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

impl Field {
    /// The number, if the field is a number.
    pub fn uniform(&self) -> Option<f64> {
        match self {
            Field::Uniform(value) => Some(*value),
            Field::Formula(_) | Field::Nodal(_) => None,
        }
    }

    /// The field as a function of the position.
    ///
    /// # Errors
    /// A message in words if the formula is wrong, or if the field is given by values at nodes,
    /// which are no function of the position.
    pub fn function(&self, space: Space) -> Result<impl Fn(Vector) -> f64, String> {
        let formula = match self {
            Field::Uniform(value) => Err(*value),
            Field::Nodal(_) => return Err("has values at nodes only".to_string()),
            Field::Formula(text) => {
                let formula = Parsed::parse(text)
                    .map_err(|why| format!("\"{text}\" is no formula: {why}"))?;
                let names: &[&str] = match space {
                    Space::Axisymmetric => &["r", "z"],
                    Space::PlaneStrain | Space::PlaneStress => &["x", "y", "r"],
                    Space::Solid => &["x", "y", "z", "r"],
                };
                let mut used = formula.var_names().iter();
                if let Some(unknown) = used.find(|name| !names.contains(&name.as_str())) {
                    return Err(format!(
                        "\"{text}\" has the unknown name `{unknown}`; there are {}",
                        names.join(", ")
                    ));
                }
                Ok(formula)
            }
        };
        Ok(move |x: Vector| match &formula {
            Err(value) => *value,
            Ok(formula) => {
                let of = |name: &String| match (name.as_str(), space) {
                    ("r", Space::Axisymmetric) | ("x", _) => x[0],
                    ("z", Space::Axisymmetric) | ("y", _) => x[1],
                    ("z", _) => x[2],
                    _ => x[0].hypot(x[1]),
                };
                let values: Vec<f64> = formula.var_names().iter().map(of).collect();
                // Cannot fail: the names, and so the number of values, are taken from the formula
                // itself.
                formula.eval(&values).unwrap_or(f64::NAN)
            }
        })
    }
}

/// A formula that has been parsed.
type Parsed = FlatEx<f64, FloatOpsFactory<f64>, Numbers>;

/// Numbers in formulas: digits, optionally with a decimal point and an exponent.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Numbers;

impl MatchLiteral for Numbers {
    fn is_literal(text: &str) -> Option<&str> {
        let digits = |from: usize| {
            let rest = text.get(from..).unwrap_or_default();
            rest.bytes().take_while(u8::is_ascii_digit).count()
        };
        let whole = digits(0);
        let has_point = text[whole..].starts_with('.');
        let fraction = if has_point { digits(whole + 1) } else { 0 };
        if whole + fraction == 0 {
            return None;
        }
        let end = whole + usize::from(has_point) + fraction;
        let mut exponent = text[end..].bytes();
        if !matches!(exponent.next(), Some(b'e' | b'E')) {
            return Some(&text[..end]);
        }
        let sign = usize::from(matches!(exponent.next(), Some(b'+' | b'-')));
        match digits(end + 1 + sign) {
            0 => Some(&text[..end]),
            n => Some(&text[..end + 1 + sign + n]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str, space: Space, x: Vector) -> f64 {
        Field::Formula(text.into()).function(space).unwrap()(x)
    }

    #[test]
    fn formulas_are_of_the_position() {
        let x = [3.0, 4.0, 7.0];
        assert_eq!(value("2*x + y^2", Space::PlaneStrain, x), 22.0);
        assert_eq!(value("r", Space::PlaneStrain, x), 5.0);
        assert_eq!(value("r - 2*z", Space::Axisymmetric, x), -5.0);
        assert_eq!(value("r + z", Space::Solid, x), 12.0);
        assert!((value("log(exp(x))", Space::Solid, x) - 3.0).abs() < 1e-15);
        let numbers = "1e-3*x + 2.5E2 - 1.e+1 * .5 + exp(0*y)";
        assert_eq!(value(numbers, Space::Solid, x), 0.003 + 250.0 - 5.0 + 1.0);
        assert_eq!(
            value("max(0, 1 - x^2) + min(x, y)", Space::PlaneStrain, x),
            3.0
        );
    }

    #[test]
    fn what_is_no_formula_is_said() {
        for (text, space, part) in [
            ("2 * (x", Space::Solid, "is no formula"),
            (
                "2 * t",
                Space::Solid,
                "unknown name `t`; there are x, y, z, r",
            ),
            ("x", Space::Axisymmetric, "unknown name `x`; there are r, z"),
        ] {
            let error = Field::Formula(text.into()).function(space).err().unwrap();
            assert!(error.contains(part), "{error}");
        }
    }
}
