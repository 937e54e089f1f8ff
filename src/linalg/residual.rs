//! How well a solution solves, and the step of refinement that makes it better.

use super::{Condensed, Partition, SymmetricCsc};
use crate::error::Result;

/// A refinement step is tried where the backward error is above this: a few rounding errors per freedom
/// are the best that a solve in double precision does.
pub(super) const REFINE_ABOVE: f64 = 4.0 * f64::EPSILON;

/// `y = K x` for the stored upper triangle.
pub fn multiply(matrix: &SymmetricCsc, x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for (j, column) in matrix.outer_iterator().enumerate() {
        let mut sum = 0.0;
        for (i, &a) in column.iter() {
            sum += a * x[i];
            if i != j {
                y[i] += a * x[j];
            }
        }
        y[j] += sum;
    }
}

/// `|K|` in the infinity norm: the largest sum of absolute values of a row.
pub fn norm(matrix: &SymmetricCsc) -> f64 {
    let mut rows = vec![0.0f64; matrix.rows()];
    for (j, column) in matrix.outer_iterator().enumerate() {
        for (i, &a) in column.iter() {
            rows[i] += a.abs();
            if i != j {
                rows[j] += a.abs();
            }
        }
    }
    largest(&rows)
}

/// Largest absolute value; NaN where there is one.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |m, v| {
        if v.abs() > m || v.is_nan() {
            v.abs()
        } else {
            m
        }
    })
}

/// What one pass over `K` tells of a solution `u` of `K u = f`.
pub(super) struct Rows {
    /// `f - K u`.
    pub residual: Vec<f64>,
    /// `|K| |u|` of each row.
    pub terms: Vec<f64>,
    /// `|K|` summed over each row.
    pub stiffness: Vec<f64>,
}

impl Rows {
    pub(super) fn new(matrix: &SymmetricCsc, f: &[f64], u: &[f64]) -> Self {
        let mut rows = Rows {
            residual: f.to_vec(),
            terms: vec![0.0; u.len()],
            stiffness: vec![0.0; u.len()],
        };
        for (j, column) in matrix.outer_iterator().enumerate() {
            let (mut sum, mut terms, mut stiffness) = (0.0, 0.0, 0.0);
            for (i, &a) in column.iter() {
                let (product, size) = (a * u[i], a.abs());
                sum += product;
                terms += product.abs();
                stiffness += size;
                if i != j {
                    let product = a * u[j];
                    rows.residual[i] -= product;
                    rows.terms[i] += product.abs();
                    rows.stiffness[i] += size;
                }
            }
            rows.residual[j] -= sum;
            rows.terms[j] += terms;
            rows.stiffness[j] += stiffness;
        }
        rows
    }

    /// The componentwise backward error: the largest of a row's `|f - K u|` over its `|K| |u| + |f|`. Rows in which nothing acts and next to
    /// nothing moves are measured against their own stiffness times the largest displacement (Arioli, Demmel, Duff 1989).
    pub(super) fn componentwise_error(&self, f: &[f64], u: &[f64]) -> f64 {
        let moved = largest(u);
        let tiny = 1000.0 * u.len() as f64 * f64::EPSILON;
        (0..u.len()).fold(0.0f64, |worst, i| {
            let own = self.terms[i] + f[i].abs();
            let scale = if own > tiny * (self.stiffness[i] * moved + f[i].abs()) {
                own
            } else {
                self.terms[i] + self.stiffness[i] * moved
            };
            match self.residual[i].abs() {
                r if r.is_nan() => f64::NAN,
                0.0 => worst,
                r => worst.max(r / scale),
            }
        })
    }
}

/// What a full solve found.
#[derive(Debug, Clone)]
pub struct Recovered {
    /// Displacements.
    pub u: Vec<f64>,
    /// `|f - K u|` in the infinity norm.
    pub residual: f64,
    /// `|f - K u| / (|K| |u| + |f|)` in infinity norms; zero where all are zero, NaN where one is.
    pub backward_error: f64,
    /// Componentwise backward error ([`super::componentwise_backward_error`]), with the residual in working precision: its own round-off, a
    /// rounding error for each entry of a row, counts as an error of the solution.
    pub componentwise_error: f64,
}

impl Recovered {
    fn new(matrix: &SymmetricCsc, norm: f64, f: &[f64], u: Vec<f64>) -> (Self, Vec<f64>) {
        let rows = Rows::new(matrix, f, &u);
        let residual = largest(&rows.residual);
        let backward_error = if residual == 0.0 {
            0.0
        } else {
            residual / (norm * largest(&u) + largest(f))
        };
        let found = Recovered {
            residual,
            backward_error,
            componentwise_error: rows.componentwise_error(f, &u),
            u,
        };
        (found, rows.residual)
    }
}

/// [`Condensed::recover_all`] with its residual for the load `f` on all freedoms (contact forces included), and a step of iterative
/// refinement of interior and zone where that lowers it. `norm` is that of `matrix` ([`norm`]).
///
/// # Errors
/// Those of [`Condensed::recover_all`].
pub fn recover_refined(
    condensed: &dyn Condensed,
    matrix: &SymmetricCsc,
    norm: f64,
    f: &[f64],
    [reduced, zone, contact]: [&[f64]; 3],
    partition: &Partition,
) -> Result<Recovered> {
    let u = condensed.recover_all(reduced, zone, contact)?;
    let (found, mut r) = Recovered::new(matrix, norm, f, u);
    // What is not a number is not refined either.
    if found.backward_error.is_nan() || found.backward_error <= REFINE_ABOVE {
        return Ok(found);
    }
    // The contact displacements are given: the step leaves them alone.
    for &freedom in &partition.contact {
        r[freedom] = 0.0;
    }
    let reduced = condensed.reduce_load(&r)?;
    let (mut step_zone, mut step_contact) = (vec![0.0; zone.len()], vec![0.0; contact.len()]);
    condensed.condense_load(&reduced, &mut step_zone, &mut step_contact)?;
    condensed.eliminate_zone(&mut step_zone, &mut step_contact);
    step_contact.fill(0.0);
    condensed.recover_zone(&mut step_zone, &step_contact);
    let mut refined = condensed.recover_all(&reduced, &step_zone, &step_contact)?;
    for (u, old) in refined.iter_mut().zip(&found.u) {
        *u += old;
    }
    let (refined, _) = Recovered::new(matrix, norm, f, refined);
    Ok(if refined.backward_error < found.backward_error {
        refined
    } else {
        found
    })
}
