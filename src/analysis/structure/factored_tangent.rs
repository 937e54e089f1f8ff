//! A factor of the tangent of the zone, with the contact matrix and statuses that belong to it.

use super::factored::Structure;
use crate::contact::Tableau;
use crate::linalg::ZonePart;
use crate::substructure::{Softened, Trailing};

/// Ratio of the cost of building and factoring the tangent to the cost of factoring alone. The
/// element matrices and the copy of the stiffness take about as long as the factor.
const WITH_ITS_MATRIX: f64 = 2.0;

/// The factored tangent stiffness of the zone.
pub struct FactoredTangent {
    pub(in crate::analysis) softened: Softened,
    /// Contact matrix and statuses with the tangent stiffness; `None` if there is no factor.
    pub(in crate::analysis) tableau: Option<Tableau>,
    /// Whether factoring a tangent failed in this increment.
    pub(in crate::analysis) is_refused: bool,
    /// Whether the factor is of the tangent at the last evaluated state.
    pub(in crate::analysis) is_fresh: bool,
    /// Fraction of the softening that is subtracted in the factored stiffness.
    pub(in crate::analysis) share: f64,
    /// Number of conjugate gradient steps since the tangent was factored, beyond the steps that a
    /// new factor takes.
    pub(in crate::analysis) spent: f64,
    forces: Vec<f64>,
    gap: Vec<f64>,
    force: Vec<f64>,
}

impl FactoredTangent {
    /// Allocates a tangent without a factor; `None` if the backend cannot factor one.
    pub(in crate::analysis) fn new(structure: &Structure) -> Option<Self> {
        let softened = structure.sub.softened()?;
        let n = structure.n_pairs();
        Some(FactoredTangent {
            softened,
            tableau: None,
            is_refused: false,
            is_fresh: false,
            share: 0.0,
            spent: 0.0,
            forces: vec![0.0; n],
            gap: vec![0.0; n],
            force: vec![0.0; n],
        })
    }

    /// Computes `out = M^-1 load` with the factored tangent stiffness `M`, closed pairs staying
    /// closed. `out` is found on `part` of the zone, by default the whole zone.
    pub(in crate::analysis) fn solve(
        &mut self,
        load: &Trailing,
        part: &ZonePart,
        out: &mut Trailing,
    ) {
        out.copy_from(load);
        self.softened.eliminate(out, &mut self.forces);
        if let Some(tableau) = &mut self.tableau {
            tableau.solve(&self.forces, &mut self.gap, &mut self.force);
        }
        self.gap.iter_mut().for_each(|gap| *gap = -*gap);
        self.softened.recover_part(part, out, &self.gap);
    }

    /// Gives the pairs the statuses `open`. Returns false if there is no factor, or if opening a
    /// pair would free a rigid motion with this stiffness.
    pub(in crate::analysis) fn set_statuses(&mut self, open: &[bool]) -> bool {
        let Some(tableau) = &mut self.tableau else {
            return false;
        };
        (0..open.len()).all(|k| tableau.open()[k] == open[k] || tableau.flip(k))
    }

    /// Whether the steps since the last factor have cost as much as the next factor would.
    pub(in crate::analysis) fn is_paid(&self) -> bool {
        let [factor, solve] = self.softened.flops();
        self.spent * solve >= WITH_ITS_MATRIX * factor
    }
}
