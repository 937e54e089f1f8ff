//! Displacements of the contact rows in rigid motions of floating bodies, which take no force.

use super::rows::Rows;
use super::trace::Trace;
use nalgebra::{DMatrix, DVector};

/// Displacement of the rows in a rigid motion, one of an orthonormal set.
pub(super) struct RigidSlip {
    pub(super) values: DVector<f64>,
    pub(super) of_motion: DVector<f64>,
}

/// Enforces `T s = 0` exactly for every rigid `s`. Elimination leaves an error of the order of its
/// round-off times the condition. This error would let a body drift away that nothing but the first
/// bit of load holds. The matrix is scaled to a unit diagonal meanwhile, so that soft rows keep
/// their digits.
pub(super) fn take_rigid_slips(matrix: &mut DMatrix<f64>, slips: &[RigidSlip]) {
    if slips.is_empty() {
        return;
    }
    let scale = matrix
        .diagonal()
        .map(|d| if d > 0.0 { d.sqrt() } else { 1.0 });
    let columns: Vec<_> = slips
        .iter()
        .map(|s| s.values.component_mul(&scale))
        .collect();
    let rigid = DMatrix::from_columns(&columns).qr().q();
    scale_rows_and_columns(matrix, &scale.map(|d| 1.0 / d));
    let forces = &*matrix * &rigid;
    let energy = rigid.transpose() * &forces;
    // (1 - Q Q') T (1 - Q Q') = T - Q (F - Q E/2)' - (F - Q E/2) Q', with F = T Q, E = Q' T Q
    let half = forces - &rigid * (0.5 * energy);
    matrix.gemm(-1.0, &rigid, &half.transpose(), 1.0);
    matrix.gemm(-1.0, &half, &rigid.transpose(), 1.0);
    scale_rows_and_columns(matrix, &scale);
    matrix.fill_upper_triangle_with_lower_triangle();
}

fn scale_rows_and_columns(matrix: &mut DMatrix<f64>, factors: &DVector<f64>) {
    for (mut column, own) in matrix.column_iter_mut().zip(factors.iter()) {
        column.component_mul_assign(factors);
        column *= *own;
    }
}

/// Returns an orthonormal basis of the displacements of the rows in rigid motions.
pub(super) fn rigid_slips(rigid: &[Trace], rows: &Rows) -> Vec<RigidSlip> {
    let mut out: Vec<RigidSlip> = Vec::new();
    for trace in rigid {
        let mut values = rows.slip(&trace.values);
        let mut of_motion = trace.of_motion.clone();
        let size = values.norm();
        for _ in 0..2 {
            for other in &out {
                let along = other.values.dot(&values);
                values.axpy(-along, &other.values, 1.0);
                of_motion.axpy(-along, &other.of_motion, 1.0);
            }
        }
        let left = values.norm();
        if left > 1e-6 * size {
            out.push(RigidSlip {
                values: values / left,
                of_motion: of_motion / left,
            });
        }
    }
    out
}
