//! The quality of a solution of the equations.

use super::number::number;
use serde::{Deserialize, Serialize};

/// The quality of a state: all figures are relative and dimensionless. Loads and displacements are
/// measured against the largest of the run so far. Gaps follow from the displacements, contact
/// forces are the residual forces of the stresses: both are independent of the contact solve, and
/// neither is clipped.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Quality {
    /// Normwise backward error of the full solve: `|f - K u| / (|K| |u| + |f|)`, infinity norms.
    #[serde(deserialize_with = "number")]
    pub backward_error: f64,
    /// Componentwise backward error, the largest ratio of a row's `|f - K u|` to its
    /// `|K| |u| + |f|`; none in results of versions that did not have it. It has no tolerance of
    /// its own: if it is large and the normwise backward error is not, the forces on some freedoms
    /// are close to zero.
    pub componentwise_error: Option<f64>,
    /// Out-of-balance force that round-off alone may cause, over the largest applied or contact
    /// force: `2 eps |K| |u|`, the largest of a row, with `u` free of rigid motions. Storing `u`
    /// and summing the forces of its elements causes as much, whatever solver found `u`, so no
    /// better balance is possible on this mesh. If plastic strains remain, the largest `u` of the
    /// run counts. None in results of versions that did not have it.
    pub round_off: Option<f64>,
    /// Out-of-balance force of the stresses over the largest applied or contact force.
    #[serde(deserialize_with = "number")]
    pub equilibrium: f64,
    /// Largest `gap * force` of a pair over (largest gap or displacement * largest force).
    #[serde(deserialize_with = "number")]
    pub complementarity: f64,
    /// Largest penetration over the largest displacement.
    #[serde(deserialize_with = "number")]
    pub penetration: f64,
    /// Largest tension of a pair over the largest force.
    #[serde(deserialize_with = "number")]
    pub adhesion: f64,
}

/// Tolerances of a state's quality, beyond which its result counts as inaccurate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Tolerance of [`Quality::backward_error`].
    pub backward_error: f64,
    /// Tolerance of [`Quality::equilibrium`].
    pub equilibrium: f64,
    /// Tolerance of [`Quality::complementarity`], [`Quality::penetration`] and
    /// [`Quality::adhesion`].
    pub contact: f64,
    /// Largest value to which [`Quality::round_off`] may raise the tolerances of forces.
    pub loosest: f64,
}

impl Quality {
    /// Returns the worse value of two for each figure; a value that is not a number is the worst.
    pub(crate) fn merge_worst(&self, other: &Quality) -> Quality {
        let worse = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        let either = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(worse);
        Quality {
            backward_error: worse(self.backward_error, other.backward_error),
            componentwise_error: either(self.componentwise_error, other.componentwise_error),
            round_off: either(self.round_off, other.round_off),
            equilibrium: worse(self.equilibrium, other.equilibrium),
            complementarity: worse(self.complementarity, other.complementarity),
            penetration: worse(self.penetration, other.penetration),
            adhesion: worse(self.adhesion, other.adhesion),
        }
    }

    /// Returns the largest figure of forces that is beyond its tolerance but accepted, because
    /// round-off alone may leave as much.
    pub(crate) fn excused(&self, tolerances: &Tolerances) -> Option<f64> {
        let round_off = self.round_off.unwrap_or(0.0).min(tolerances.loosest);
        [
            (self.equilibrium, tolerances.equilibrium),
            (self.complementarity, tolerances.contact),
            (self.adhesion, tolerances.contact),
        ]
        .into_iter()
        .filter(|(value, most)| value > most && *value <= round_off)
        .map(|(value, _)| value)
        .reduce(f64::max)
    }

    /// Returns the figures that miss their tolerance (or are not numbers), each with its name,
    /// value and tolerance. The figures of forces may be as large as the round-off of the mesh.
    pub fn misses(&self, tolerances: &Tolerances) -> Vec<(&'static str, f64, f64)> {
        let round_off = self.round_off.unwrap_or(0.0).min(tolerances.loosest);
        let forces = tolerances.contact.max(round_off);
        [
            (
                "backward_error",
                self.backward_error,
                tolerances.backward_error,
            ),
            (
                "equilibrium",
                self.equilibrium,
                tolerances.equilibrium.max(round_off),
            ),
            ("complementarity", self.complementarity, forces),
            ("penetration", self.penetration, tolerances.contact),
            ("adhesion", self.adhesion, forces),
        ]
        .into_iter()
        .filter(|(_, value, most)| value.is_nan() || value > most)
        .collect()
    }
}
