//! States of a contact: pairs, and in a solid model patches.

use super::number::number;
use crate::space::Vector;
use serde::{Deserialize, Deserializer, Serialize};

/// A connected patch of contact in a solid model: closed pairs, neighbours if they share a face of
/// the slave surface. If the patch ends on planes of symmetry, its figures are those of the whole
/// patch, mirror images included.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ContactPatch {
    /// Contact (scene entry) index, from 0; `summary.json` counts from 1.
    #[serde(with = "from_one")]
    pub contact: usize,
    /// Force that the patch carries.
    #[serde(deserialize_with = "number")]
    pub force: f64,
    /// Area, projected on the plane perpendicular to the mean normal; for a patch that closes round
    /// a body the area of its surface.
    #[serde(deserialize_with = "number")]
    pub area: f64,
    /// Largest pressure of a pair.
    #[serde(deserialize_with = "number")]
    pub max_pressure: f64,
    /// Force over area.
    #[serde(deserialize_with = "number")]
    pub mean_pressure: f64,
    /// Half axes, the larger first, of the ellipse with the patch's second moments of area; if the
    /// patch is an ellipse, they are its own half axes. For a patch between two parallel planes of
    /// symmetry, a strip without end: infinity and half its width.
    #[serde(deserialize_with = "numbers")]
    pub semi_axes: [f64; 2],
    /// Centroid of the area.
    #[serde(with = "by_axis")]
    pub centroid: Vector,
    /// Direction of the larger half axis.
    #[serde(with = "by_axis")]
    pub direction: Vector,
}

fn numbers<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
    #[derive(Deserialize)]
    struct Number(#[serde(deserialize_with = "number")] f64);
    Ok(<[Number; 2]>::deserialize(from)?.map(|n| n.0))
}

/// Writes an index from 0 as a number from 1.
mod from_one {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(index: &usize, to: S) -> Result<S::Ok, S::Error> {
        (index + 1).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<usize, D::Error> {
        Ok(usize::deserialize(from)?.saturating_sub(1))
    }
}

/// Writes a vector as components by name.
mod by_axis {
    use super::{Vector, number};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct AxisComponents {
        #[serde(deserialize_with = "number")]
        x: f64,
        #[serde(deserialize_with = "number")]
        y: f64,
        #[serde(deserialize_with = "number")]
        z: f64,
    }

    pub fn serialize<S: Serializer>(vector: &Vector, to: S) -> Result<S::Ok, S::Error> {
        let [x, y, z] = *vector;
        AxisComponents { x, y, z }.serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vector, D::Error> {
        let AxisComponents { x, y, z } = AxisComponents::deserialize(from)?;
        Ok([x, y, z])
    }
}

/// A contact pair's state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PairState {
    /// Pair index, from 0; events, messages and `contact.csv` count from 1.
    pub pair: usize,
    /// Contact (scene entry) index, from 0; `contact.csv` counts from 1.
    pub contact: usize,
    /// Position (on the second surface, undeformed).
    pub position: Vector,
    /// Gap. It is negative only where the surfaces overlap: in soft contact, and on the axis of
    /// revolution, where quadratic elements have no pair.
    pub gap: f64,
    /// Force, compressive positive.
    pub force: f64,
    /// Area (length times thickness 1; axisymmetric: area of the annulus) that belongs to the pair.
    pub area: f64,
    /// Pressure, compressive positive.
    pub pressure: f64,
    /// Open or closed.
    pub status: Status,
}

/// Status of a contact pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The surfaces are apart (or touch without force).
    Open,
    /// The surfaces touch.
    Closed,
}
