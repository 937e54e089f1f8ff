//! The imbalance that round-off leaves in a state, and the largest imbalance of any state.

/// Round-off of the forces `sum w B' (D (B u))` of elements, divided by the largest `|K| |u|` of a
/// row: displacements, strains, stresses and forces are rounded one after the other, by half of
/// `eps` each (N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., section
/// 3.5). The number of terms in the sums is left out: their roundings have either sign.
pub(in crate::analysis) const ROUND_OFF_OF_FORCES: f64 = 2.0 * f64::EPSILON;

/// Bound on every imbalance that is accepted as round-off or tolerance, whatever the scene sets: a
/// thousandth of the largest force.
pub(in crate::analysis) const LOOSEST: f64 = 1e-3;
