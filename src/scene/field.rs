//! A quantity as a function of position.

use crate::space::{Space, Vector};
use exmex::{Express, FlatEx};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A number, a formula of the position, or values at nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Field {
    /// The same everywhere.
    Uniform(f64),
    /// A formula of `x`, `y` (of a solid `z`) and of `r`, the distance from the origin, in a solid
    /// from the z axis; of an axisymmetric model of `r` and `z`, its two coordinates.
    Formula(String),
    /// Values at the nodes of the mesh, from a file.
    Nodal(NodalField),
}

/// Values at nodes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodalField {
    /// A Gmsh file with one section `$NodeData`, relative to the scene file.
    pub file: PathBuf,
}

impl JsonSchema for Field {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Field".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, or a formula of the position such as `\"20 * log(r / 50)\"`: \
                            x, y, of a solid z, and r = sqrt(x^2 + y^2); of an axisymmetric model \
                            r and z. exp, log (natural), sqrt, sin, cos, abs, ^ and the like. Or \
                            `{ file = \"heat.msh\" }`: values at nodes, the one section \
                            $NodeData of a Gmsh file beside the scene.",
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
    /// The field as a function.
    ///
    /// # Errors
    /// What is wrong with the formula, in words; values at nodes are no function of the position.
    pub fn function(&self, space: Space) -> Result<impl Fn(Vector) -> f64, String> {
        let formula = match self {
            Field::Uniform(value) => Err(*value),
            Field::Nodal(_) => return Err("has values at nodes only".to_string()),
            Field::Formula(text) => {
                let formula = FlatEx::<f64>::parse(text)
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
                // Names and number of values are those of the formula.
                formula.eval(&values).unwrap_or(f64::NAN)
            }
        })
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
        let Field::Uniform(20.0) = Field::Uniform(20.0) else {
            panic!()
        };
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
