//! What the bodies are made of.

use super::{MaterialRow, tensile_test};
use crate::shape::Integration;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;

/// A material: linear elastic, and von Mises plastic where a yield stress is given.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus, E > 0.
    pub youngs_modulus: f64,
    /// Poisson's ratio, -1 < nu < 0.5.
    pub poissons_ratio: f64,
    /// Mass per volume, of which loads by acceleration and rotation are made: force times time
    /// squared per length to the fourth (N, mm, s: t/mm^3, steel 7.85e-9).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Strain per change of temperature, of which loads by `temperature` are made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thermal_expansion: Option<f64>,
    /// Tensile yield stress; without it, a table or a tensile test the material is elastic.
    pub yield_stress: Option<f64>,
    /// d(yield stress)/d(equivalent plastic strain) of linear hardening.
    pub plastic_modulus: Option<f64>,
    /// d(stress)/d(total strain) of a bar beyond yield; `H = E Et/(E - Et)`.
    pub tangent_modulus: Option<f64>,
    /// Modulus C of linear kinematic hardening, alone or with any of the isotropic laws: a bar
    /// hardens with `H + C`, and yields that much earlier the other way. Short for a row `[C, 0]`
    /// of `back_stresses`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematic_modulus: Option<f64>,
    /// Back stresses that fade (Armstrong and Frederick, Chaboche), rows of modulus C and rate
    /// gamma: `da = 2/3 C deps_p - gamma a dp`, of a bar at most `C/gamma` each.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_stresses: Option<Vec<[f64; 2]>>,
    /// Table of (equivalent plastic strain, yield stress), first strain 0, flat after the last row.
    /// Its first stress is the yield stress.
    pub hardening_table: Option<Vec<[f64; 2]>>,
    /// Tensile test in place of a table: rows of (engineering strain, engineering stress), turned
    /// into true stress against plastic strain, `s (1 + e)` and `ln(1 + e) - s (1 + e)/E`. The
    /// material yields at `yield_stress` (true) where one is given, else where the plastic strain
    /// becomes positive. Flat after the last row, which is not beyond the largest load.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tensile_test: Option<Vec<[f64; 2]>>,
    /// What depends on the temperature, rows with ascending temperatures: in place of what stands
    /// here, linear between the rows that give a property and constant beyond them. Bodies of this
    /// material then need a `temperature`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub over_temperature: Vec<MaterialRow>,
}

impl Material {
    /// Modulus and rate of each back stress.
    pub(crate) fn back_stresses(&self) -> Vec<[f64; 2]> {
        let linear = self.kinematic_modulus.map(|modulus| [modulus, 0.0]);
        let rows = self.back_stresses.iter().flatten().copied();
        linear.into_iter().chain(rows).collect()
    }

    /// Points of (equivalent plastic strain, yield stress), the first at strain 0, of the table or
    /// the tensile test; `None` where the material is elastic or hardens linearly.
    pub fn hardening_curve(&self) -> Option<Vec<[f64; 2]>> {
        if let Some(test) = &self.tensile_test {
            return tensile_test::curve(test, self);
        }
        self.hardening_table
            .clone()
            .filter(|table| !table.is_empty())
    }

    /// The stress at which it first yields: the yield stress as given, else that at the start of
    /// the table or the tensile test. `None` where the material is elastic.
    pub fn first_yield_stress(&self) -> Option<f64> {
        let from_curve = || Some(self.hardening_curve()?.first()?[1]);
        self.yield_stress.or_else(from_curve)
    }

    /// Slope `H = d(yield stress)/d(equivalent plastic strain)` of linear hardening: the plastic
    /// modulus as given, `E Et/(E - Et)` from a tangent modulus, 0 for a yield stress alone
    /// (perfectly plastic). `None` where the material is elastic or hardens by a table.
    pub fn plastic_modulus_resolved(&self) -> Option<f64> {
        if self.yield_stress.is_none() || self.hardening_curve().is_some() {
            return None;
        }
        let from_tangent = self
            .tangent_modulus
            .map(|tangent| self.youngs_modulus * tangent / (self.youngs_modulus - tangent));
        Some(self.plastic_modulus.or(from_tangent).unwrap_or(0.0))
    }
}

/// What a body is made of and whether it may yield.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name of the material: one of `materials`, or of the list that `brinell materials` prints,
    /// which is turned into the scene's `units`.
    pub material: String,
    /// May this body yield?
    #[serde(default)]
    pub plastic: Plastic,
    /// Integration of the body's quadratic quadrilaterals, hexahedra and prisms.
    #[serde(default, skip_serializing_if = "Integration::is_reduced")]
    pub integration: Integration,
    /// Temperature of the body throughout the run, at which the rows `over_temperature` of its
    /// material are read. Loads by `temperature` add strains to it, and change no modulus.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
    /// Yield stress by depth below the surface (case hardening), rows of depth and yield stress,
    /// depths ascending, straight between them and constant beyond: in place of the material's,
    /// whose hardening adds to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_by_depth: Option<Vec<[f64; 2]>>,
    /// The surface of the body from which depths count; without it those that may touch others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_from: Option<String>,
    /// Residual stress that the body brings along, before anything is loaded: rows of depth and
    /// components in the order of stresses in the results (`xx, yy, zz`, then `xy`, or `xy, yz,
    /// zx` of a solid, which may be left out), straight between the rows and constant beyond; one
    /// row is a uniform stress. What of it is not in equilibrium relaxes. Depths count as those of
    /// `yield_by_depth` do. No plastic flow is part of it: what it hardened is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_stress: Option<Vec<Vec<f64>>>,
    /// Plastic strain that the body brings along, of what made it before (rolled, peened, case
    /// hardened), in rows as `initial_stress` has, with engineering shear. Its trace need not be
    /// zero: growth of a case is given so too. It does not harden.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_plastic_strain: Option<Vec<Vec<f64>>>,
}

impl Body {
    /// Stresses and strains that the body brings along, by key.
    pub(crate) fn brought_along(&self) -> impl Iterator<Item = (&'static str, &Vec<Vec<f64>>)> {
        let given = [
            ("initial_stress", &self.initial_stress),
            ("initial_plastic_strain", &self.initial_plastic_strain),
        ];
        given
            .into_iter()
            .filter_map(|(key, rows)| Some((key, rows.as_ref()?)))
    }

    /// The largest initial yield stress in it.
    pub(crate) fn largest_yield_stress(&self, material: &Material) -> Option<f64> {
        let rows = self.yield_by_depth.iter().flatten();
        let largest = rows.map(|row| row[1]).reduce(f64::max);
        material.first_yield_stress().map(|y| largest.unwrap_or(y))
    }
}

/// May a body yield?
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Plastic {
    /// If its material can and the loads make it (default).
    #[default]
    Auto,
    /// Yes: an error if its material has no yield stress.
    Yes,
    /// No: treated as elastic whatever its stress.
    No,
}

impl JsonSchema for Plastic {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Plastic".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "May a body yield? `\"auto\"` (the default): if its material can and \
                            the loads make it.",
            "enum": [true, false, "auto"],
        })
    }
}

impl Serialize for Plastic {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Plastic::Auto => serializer.serialize_str("auto"),
            Plastic::Yes => serializer.serialize_bool(true),
            Plastic::No => serializer.serialize_bool(false),
        }
    }
}

impl<'de> Deserialize<'de> for Plastic {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PlasticVisitor;
        impl Visitor<'_> for PlasticVisitor {
            type Value = Plastic;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true, false or \"auto\"")
            }

            fn visit_bool<E: de::Error>(self, may_yield: bool) -> Result<Plastic, E> {
                Ok(if may_yield { Plastic::Yes } else { Plastic::No })
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Plastic, E> {
                match text {
                    "auto" => Ok(Plastic::Auto),
                    _ => Err(E::invalid_value(de::Unexpected::Str(text), &self)),
                }
            }
        }
        deserializer.deserialize_any(PlasticVisitor)
    }
}
