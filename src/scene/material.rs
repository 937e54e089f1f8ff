//! Materials of the bodies, and what a scene says of each body.

use super::tensile_test;
use crate::shape::Integration;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;

/// A material: linear elastic, and von Mises plastic if a yield stress is given.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus, E > 0.
    pub youngs_modulus: f64,
    /// Poisson's ratio, -1 < nu < 0.5.
    pub poissons_ratio: f64,
    /// Mass per volume, needed by loads by acceleration and rotation. Its unit is force times time
    /// squared per length to the fourth (with N, mm and s: t/mm^3; steel 7.85e-9).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Strain per change of temperature, needed by loads by `temperature`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thermal_expansion: Option<f64>,
    /// Tensile yield stress. A material without a yield stress, a hardening table or a tensile test
    /// is elastic.
    pub yield_stress: Option<f64>,
    /// d(yield stress)/d(equivalent plastic strain) of linear hardening.
    pub plastic_modulus: Option<f64>,
    /// d(stress)/d(total strain) of a bar beyond yield; gives the plastic modulus
    /// `H = E Et/(E - Et)`.
    pub tangent_modulus: Option<f64>,
    /// Modulus C of linear kinematic hardening, alone or with any of the isotropic laws: a bar
    /// hardens with `H + C`, and after reversal yields correspondingly earlier in the other
    /// direction. Equivalent to a row `[C, 0]` of `back_stresses`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematic_modulus: Option<f64>,
    /// Back stresses with dynamic recovery (Armstrong and Frederick, Chaboche), rows of modulus C
    /// and rate gamma: `da = 2/3 C deps_p - gamma a dp`. In a bar each back stress is at most
    /// `C/gamma`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_stresses: Option<Vec<[f64; 2]>>,
    /// Table of (equivalent plastic strain, yield stress). The first strain is 0 and its stress is
    /// the initial yield stress; the yield stress is constant after the last row.
    pub hardening_table: Option<Vec<[f64; 2]>>,
    /// Tensile test in place of a table: rows of (engineering strain, engineering stress),
    /// converted into true stress `s (1 + e)` against plastic strain `ln(1 + e) - s (1 + e)/E`. The
    /// material yields at `yield_stress` (true stress) if one is given, otherwise where the plastic
    /// strain becomes positive. The yield stress is constant after the last row, which must not lie
    /// beyond the largest load.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tensile_test: Option<Vec<[f64; 2]>>,
    /// Properties that depend on the temperature, in rows of ascending temperatures. They replace
    /// the properties given directly in the material: each is linear between the rows that give it
    /// and constant beyond them. Bodies of this material then need a `temperature`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub over_temperature: Vec<MaterialRow>,
}

impl Material {
    /// Modulus C and rate gamma of each back stress, the linear kinematic law included.
    pub(crate) fn back_stresses(&self) -> Vec<[f64; 2]> {
        let linear = self.kinematic_modulus.map(|modulus| [modulus, 0.0]);
        let rows = self.back_stresses.iter().flatten().copied();
        linear.into_iter().chain(rows).collect()
    }

    /// Points of (equivalent plastic strain, yield stress), the first at strain 0, from the table
    /// or the tensile test. `None` if the material is elastic or hardens linearly.
    pub fn hardening_curve(&self) -> Option<Vec<[f64; 2]>> {
        if let Some(test) = &self.tensile_test {
            return tensile_test::curve(test, self.youngs_modulus, self.yield_stress);
        }
        self.hardening_table
            .clone()
            .filter(|table| !table.is_empty())
    }

    /// The stress at which the material first yields: the given yield stress, otherwise the first
    /// stress of the table or the tensile test. `None` if the material is elastic.
    pub fn first_yield_stress(&self) -> Option<f64> {
        let from_curve = || Some(self.hardening_curve()?.first()?[1]);
        self.yield_stress.or_else(from_curve)
    }

    /// Slope `H = d(yield stress)/d(equivalent plastic strain)` of linear hardening: the given
    /// plastic modulus, `E Et/(E - Et)` from a tangent modulus, or 0 for a yield stress alone
    /// (perfectly plastic). `None` if the material is elastic or hardens by a table.
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

/// Properties of a material at one temperature. A property that a row leaves out is interpolated
/// from the rows that give it, or taken from the material itself if no row gives it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialRow {
    /// The temperature, on the scale of the bodies' `temperature`.
    pub temperature: f64,
    /// Young's modulus, E > 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio, -1 < nu < 0.5.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poissons_ratio: Option<f64>,
    /// Strain per change of temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thermal_expansion: Option<f64>,
    /// Tensile yield stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_stress: Option<f64>,
    /// d(yield stress)/d(equivalent plastic strain) of linear hardening.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plastic_modulus: Option<f64>,
    /// Modulus of linear kinematic hardening.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematic_modulus: Option<f64>,
    /// Table of (equivalent plastic strain, yield stress).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hardening_table: Option<Vec<[f64; 2]>>,
}

impl MaterialRow {
    /// Whether the row gives no property besides its temperature.
    pub(crate) fn is_empty(&self) -> bool {
        let temperature = self.temperature;
        *self
            == MaterialRow {
                temperature,
                ..MaterialRow::default()
            }
    }
}

/// A body: its material, whether it may yield, and the state it begins with.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name of the material: one of `materials`, or one from the list that `brinell materials`
    /// prints, which is converted to the scene's `units`.
    pub material: String,
    /// Whether this body may yield.
    #[serde(default)]
    pub plastic: Plastic,
    /// Integration of the body's quadratic quadrilaterals, hexahedra and prisms.
    #[serde(default, skip_serializing_if = "Integration::is_reduced")]
    pub integration: Integration,
    /// Temperature of the body throughout the run, at which the rows `over_temperature` of its
    /// material are evaluated. Loads by `temperature` add thermal strains and do not change the
    /// material properties.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
    /// Yield stress by depth below the surface (case hardening): rows of depth and yield stress,
    /// depths ascending, linear between the rows and constant beyond them. Replaces the yield
    /// stress of the material, whose hardening is added to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_by_depth: Option<Vec<[f64; 2]>>,
    /// The surface of the body from which depths are measured; by default the surfaces of the body
    /// that may touch others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_from: Option<String>,
    /// Residual stress that the body has before anything is loaded: rows of depth and components in
    /// the order of stresses in the results (`xx, yy, zz`, then `xy`, or `xy, yz, zx` in a solid,
    /// which may be left out), linear between the rows and constant beyond them. One row is a
    /// uniform stress. A part that is not in equilibrium relaxes. Depths are measured as for
    /// `yield_by_depth`. The material begins without hardening, because the plastic flow that made
    /// the stress is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_stress: Option<Vec<Vec<f64>>>,
    /// Plastic strain that the body has before anything is loaded, from its manufacture (rolled,
    /// peened, case hardened), in rows like those of `initial_stress`, with engineering shear
    /// strains. The trace need not be zero, so the growth of a hardened case can be given too. This
    /// strain does not harden the material.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_plastic_strain: Option<Vec<Vec<f64>>>,
}

impl Body {
    /// Initial stresses and initial plastic strains of the body, as far as given, by key.
    pub(crate) fn brought_along(&self) -> impl Iterator<Item = (&'static str, &Vec<Vec<f64>>)> {
        let given = [
            ("initial_stress", &self.initial_stress),
            ("initial_plastic_strain", &self.initial_plastic_strain),
        ];
        given
            .into_iter()
            .filter_map(|(key, rows)| Some((key, rows.as_ref()?)))
    }

    /// The largest initial yield stress in the body; `None` if the material is elastic.
    pub(crate) fn largest_yield_stress(&self, material: &Material) -> Option<f64> {
        let rows = self.yield_by_depth.iter().flatten();
        let largest = rows.map(|row| row[1]).reduce(f64::max);
        material.first_yield_stress().map(|y| largest.unwrap_or(y))
    }
}

/// Whether a body may yield.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Plastic {
    /// Yields if its material can and the loads make it (default).
    #[default]
    Auto,
    /// May yield; an error if its material has no yield stress.
    Yes,
    /// Treated as elastic whatever its stress.
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
