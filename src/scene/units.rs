//! Names of units, for readers of results.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Known units of stress, in pascals.
pub(super) const STRESSES: [(&str, f64); 9] = [
    ("MPa", 1e6),
    ("N/mm^2", 1e6),
    ("N/mm2", 1e6),
    ("N/mm\u{b2}", 1e6),
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("GPa", 1e9),
    ("psi", POUND / (INCH * INCH)),
    ("ksi", 1e3 * POUND / (INCH * INCH)),
];
/// Known units of length, in metres.
const LENGTHS: [(&str, f64); 5] = [
    ("mm", 1e-3),
    ("m", 1.0),
    ("cm", 1e-2),
    ("in", INCH),
    ("\u{b5}m", 1e-6),
];
/// Known units of force, in newtons.
const FORCES: [(&str, f64); 6] = [
    ("N", 1.0),
    ("kN", 1e3),
    ("MN", 1e6),
    ("mN", 1e-3),
    ("lbf", POUND),
    ("kip", 1e3 * POUND),
];
/// A pound-force in newtons: 0.45359237 kg by 9.80665 m/s^2, exact by definition, like the inch.
const POUND: f64 = 0.45359237 * 9.80665;
const INCH: f64 = 0.0254;

/// Names of the units of the scene's numbers. brinell computes in whatever consistent units the
/// scene uses (N, mm and MPa; N, m and Pa; ...) and converts only the materials of its own list.
/// The names appear next to numbers in tables and plots.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Unit of lengths and displacements, such as `"mm"`.
    pub length: String,
    /// Unit of forces, such as `"N"`.
    pub force: String,
    /// Unit of stresses, moduli and pressures: force over length squared, such as `"MPa"`.
    pub stress: String,
}

impl Units {
    /// The unit of stress in pascals, if its name is known.
    pub(crate) fn pascals(&self) -> Option<f64> {
        known(&STRESSES, &self.stress)
    }

    /// The unit of length in metres, if its name is known.
    pub(super) fn metres(&self) -> Option<f64> {
        known(&LENGTHS, &self.length)
    }

    /// Force over length squared, expressed in the unit of stress, if this is not 1. `None` if the
    /// units are consistent or one of the three is not known.
    pub(crate) fn mismatch(&self) -> Option<f64> {
        let force = known(&FORCES, &self.force)?;
        let ratio = force / self.metres()?.powi(2) / self.pascals()?;
        // The tolerance covers products and quotients of a few rounded numbers.
        ((ratio - 1.0).abs() > 1e-12).then_some(ratio)
    }
}

fn known(units: &[(&str, f64)], name: &str) -> Option<f64> {
    let found = units.iter().find(|(known, _)| *known == name);
    found.map(|(_, size)| *size)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The usual systems of units, the one of micromechanics among them, and some inconsistent
    /// ones.
    #[test]
    fn a_stress_is_a_force_over_a_length_squared() {
        let ratio = |[length, force, stress]: [&str; 3]| {
            let [length, force, stress] = [length, force, stress].map(String::from);
            let units = Units {
                length,
                force,
                stress,
            };
            units.mismatch()
        };
        for system in [
            ["mm", "N", "MPa"],
            ["mm", "N", "N/mm2"],
            ["mm", "kN", "GPa"],
            ["m", "N", "Pa"],
            ["m", "kN", "kPa"],
            ["m", "MN", "MPa"],
            ["in", "lbf", "psi"],
            ["in", "kip", "ksi"],
            ["\u{b5}m", "mN", "GPa"],
            ["furlong", "N", "Pa"],
        ] {
            assert_eq!(ratio(system), None, "{system:?}");
        }
        let near = |system: [&str; 3], right: f64| {
            let found = ratio(system).unwrap_or(1.0);
            assert!((found / right - 1.0).abs() < 1e-12, "{system:?}: {found}");
        };
        near(["mm", "N", "Pa"], 1e6);
        near(["m", "N", "MPa"], 1e-6);
        near(["mm", "kN", "MPa"], 1e3);
        near(["in", "lbf", "ksi"], 1e-3);
    }
}
