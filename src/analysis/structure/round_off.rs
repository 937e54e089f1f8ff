//! How far from balance round-off leaves a state, and how far any state may be.

/// Round-off of the forces `sum w B' (D (B u))` of elements, over the largest `|K| |u|` of a row:
/// displacements, strains, stresses and forces are rounded one after the other, by half of `eps`
/// each (N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., section 3.5). How
/// many terms are summed up is left out: their roundings have either sign.
pub(in crate::analysis) const ROUND_OFF_OF_FORCES: f64 = 2.0 * f64::EPSILON;

/// What no setting of the scene makes acceptable: a thousandth of the largest force on the wrong
/// side.
pub(in crate::analysis) const LOOSEST: f64 = 1e-3;
