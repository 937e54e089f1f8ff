//! What carries a contact: pairs, and in a solid model patches.

use crate::space::Vector;
use serde::{Deserialize, Serialize};

/// A patch of contact of a solid model: pairs that touch, joined by faces of the second surface. It is
/// that of the whole where it reaches planes of symmetry.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ContactPatch {
    /// Contact (scene entry) index, from 0.
    pub contact: usize,
    /// Area, on the plane across the mean normal.
    pub area: f64,
    /// Centroid of the area.
    pub centroid: Vector,
    /// Half axes, the larger first, of the ellipse with the patch's area moments of second order:
    /// those of the patch itself where it is an ellipse.
    pub semi_axes: [f64; 2],
    /// Direction of the larger half axis.
    pub direction: Vector,
    /// Largest pressure of a pair.
    pub max_pressure: f64,
    /// Force over area.
    pub mean_pressure: f64,
    /// Force.
    pub force: f64,
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
    /// Gap, >= 0; on the axis of revolution, where quadratic elements have no pair, negative where
    /// the surfaces overlap.
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
