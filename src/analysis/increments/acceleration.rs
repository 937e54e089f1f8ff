//! Anderson acceleration of the initial-load iteration.
//!
//! The plain iteration maps initial loads `J` to `J(u(J))`. Anderson acceleration takes the
//! combination of the last few iterates whose combined residual is smallest.
//!
//! # Source
//! H. F. Walker, P. Ni, *Anderson acceleration for fixed-point iterations* (2011),
//! doi:10.1137/10078356X.

use crate::substructure::Trailing;
use nalgebra::{DMatrix, DVector};

/// Number of residual differences kept.
const DEPTH: usize = 8;

/// Differences of the last iterates and residuals.
#[derive(Debug, Default)]
pub struct Anderson {
    last: Option<(Trailing, Trailing)>,
    iterates: Vec<Trailing>,
    residuals: Vec<Trailing>,
}

impl Anderson {
    /// Forgets all iterates, because the map has changed (statuses, load).
    pub fn restart(&mut self) {
        *self = Anderson::default();
    }

    /// The change of initial loads for the iterate `initial` with the residual `J(u) - J`.
    pub fn change(&mut self, initial: &Trailing, residual: &Trailing) -> Trailing {
        if let Some((x, r)) = &self.last {
            let difference = |a: &Trailing, b: &Trailing| {
                let mut d = a.clone();
                d.add(-1.0, b);
                d
            };
            if self.iterates.len() == DEPTH {
                self.iterates.remove(0);
                self.residuals.remove(0);
            }
            self.iterates.push(difference(initial, x));
            self.residuals.push(difference(residual, r));
        }
        self.last = Some((initial.clone(), residual.clone()));
        let m = self.residuals.len();
        let mut change = residual.clone();
        if m == 0 {
            return change;
        }
        let gram = DMatrix::from_fn(m, m, |i, j| self.residuals[i].dot(&self.residuals[j]));
        let right = DVector::from_fn(m, |i, _| self.residuals[i].dot(residual));
        let floor = 1e-12 * gram.diagonal().max();
        let regular = gram + DMatrix::identity(m, m) * floor;
        let Some(weights) = regular.cholesky().map(|c| c.solve(&right)) else {
            self.restart();
            return change;
        };
        for (i, w) in weights.iter().enumerate() {
            change.add(-w, &self.residuals[i]);
            change.add(-w, &self.iterates[i]);
        }
        change
    }
}
