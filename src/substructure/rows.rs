//! Contact rows as coordinates of the contact freedoms.
//!
//! A row is a relative displacement `s_j = sum_i b_ji u_i` of contact freedoms: of the two nodes of
//! a pair, or of a node and a point between others. Each row has one freedom of its own that
//! follows; all other freedoms lead:
//!
//! ```text
//!     u_lead = v,     u_follow = G v + H s,     H = B_follow^-1,     G = -H B_lead
//! ```
//!
//! Closed rows (`s = 0`) tie their followers to the leaders. For pairs `G` is one and `H` a sign.

use super::trace::Trace;
use crate::error::{Error, Result};
use nalgebra::{DMatrix, DVector};

/// Sparse row of a matrix: column numbers and coefficients.
pub(crate) type RowEntries = Vec<(usize, f64)>;

/// Factor by which a slave must be stiffer than its masters to lead. For bodies of similar
/// stiffness the paper's choice stands: the slave follows.
const STIFFER: f64 = 4.0;
/// Fraction of a row that elimination leaves at most if the row depends on the others.
const DEPENDENT: f64 = 1e-10;

/// Contact rows with their leaders and followers.
pub(crate) struct Rows {
    /// Matrix `B` by rows: contact freedoms and coefficients.
    pub entries: Vec<RowEntries>,
    /// Contact freedoms that lead, in the order of `v`.
    pub lead: Vec<usize>,
    /// Contact freedom that follows, for each row.
    pub follow: Vec<usize>,
    /// Matrix `G` by rows: numbers of leaders, and weights.
    pub carried: Vec<RowEntries>,
    /// Matrix `H` by rows: numbers of rows, and weights.
    pub of_slip: Vec<RowEntries>,
    /// Matrix `P = [1; G]` by leaders: the contact freedoms that move with each leader, and
    /// weights.
    pub moved: Vec<RowEntries>,
}

impl Rows {
    /// Builds the rows of a model's contact. The last freedom of each row is the slave's; the slave
    /// follows, unless masters are softer by more than [`STIFFER`]. `diagonal` is that of the
    /// condensed stiffness.
    ///
    /// # Errors
    /// Errors of [`Rows::any`].
    pub(crate) fn of_contact(
        entries: Vec<RowEntries>,
        n_contact: usize,
        diagonal: impl Fn(usize) -> f64,
    ) -> Result<Self> {
        let mut rows_at = vec![0usize; n_contact];
        entries.iter().flatten().for_each(|&(i, _)| rows_at[i] += 1);
        let leads = |row: &RowEntries| {
            let [masters @ .., (slave, _)] = row.as_slice() else {
                return false;
            };
            let softer = |&(i, b): &(usize, f64)| diagonal(*slave) * b * b > STIFFER * diagonal(i);
            masters.iter().any(softer)
        };
        let is_pair = |row: &RowEntries| match row.as_slice() {
            // A master that follows others may have another coefficient.
            [(i, b), (j, c)] => [*b, *c] == [-1.0, 1.0] && rows_at[*i] == 1 && rows_at[*j] == 1,
            _ => false,
        };
        if n_contact == 2 * entries.len() && entries.iter().all(is_pair) {
            return Ok(Self::of_pairs(entries, leads));
        }
        let own_slave =
            |row: &RowEntries| row.last().is_some_and(|(slave, _)| rows_at[*slave] == 1);
        if !entries.iter().all(|row| own_slave(row) && !leads(row)) {
            return Self::any(entries, n_contact, diagonal);
        }
        let follow: Vec<usize> = entries
            .iter()
            .filter_map(|row| row.last())
            .map(|e| e.0)
            .collect();
        let mut is_follower = vec![false; n_contact];
        follow.iter().for_each(|&i| is_follower[i] = true);
        let lead: Vec<usize> = (0..n_contact).filter(|&i| !is_follower[i]).collect();
        let mut place = vec![0; n_contact];
        lead.iter().enumerate().for_each(|(k, &i)| place[i] = k);
        let masters = |row: &RowEntries| row.split_last().map(|(_, masters)| masters.to_vec());
        let carried: Vec<RowEntries> = (entries.iter().filter_map(masters))
            .map(|row| row.into_iter().map(|(i, b)| (place[i], -b)).collect())
            .collect();
        Ok(Rows {
            of_slip: (0..follow.len()).map(|k| vec![(k, 1.0)]).collect(),
            moved: moved(&lead, &follow, &carried),
            entries,
            lead,
            follow,
            carried,
        })
    }

    /// Builds rows `u_j - u_i` that share no freedom; `leads` states whether `j` leads.
    fn of_pairs(entries: Vec<RowEntries>, leads: impl Fn(&RowEntries) -> bool) -> Self {
        let ends = |row: &RowEntries| {
            let [i, j] = [row[0].0, row[1].0];
            if leads(row) { (j, i) } else { (i, j) }
        };
        let (lead, follow): (Vec<usize>, Vec<usize>) = entries.iter().map(ends).unzip();
        let sign =
            |(row, follow): (&RowEntries, &usize)| if row[1].0 == *follow { 1.0 } else { -1.0 };
        let signs = entries.iter().zip(&follow).map(sign).enumerate();
        Rows {
            of_slip: signs.map(|entry| vec![entry]).collect(),
            carried: (0..entries.len()).map(|k| vec![(k, 1.0)]).collect(),
            moved: entries
                .iter()
                .map(|row| vec![(row[0].0, 1.0), (row[1].0, 1.0)])
                .collect(),
            entries,
            lead,
            follow,
        }
    }

    /// Builds arbitrary rows on `n_contact` freedoms, with the diagonal of the condensed stiffness.
    /// Elimination with complete pivoting picks the followers: soft freedoms with large
    /// coefficients.
    ///
    /// # Errors
    /// `Input` if the rows depend on each other.
    pub(crate) fn any(
        entries: Vec<RowEntries>,
        n_contact: usize,
        diagonal: impl Fn(usize) -> f64,
    ) -> Result<Self> {
        let n = entries.len();
        let mut b = DMatrix::zeros(n, n_contact);
        for (j, row) in entries.iter().enumerate() {
            for &(freedom, coefficient) in row {
                b[(j, freedom)] += coefficient;
            }
        }
        let follow = followers(&b, diagonal)?;
        let leads = |freedom: &usize| !follow.contains(freedom);
        let lead: Vec<usize> = (0..n_contact).filter(leads).collect();
        let own = b.select_columns(&follow);
        let is_diagonal = (0..n).all(|j| (0..n).all(|i| i == j || own[(i, j)] == 0.0));
        let inverse = if is_diagonal {
            DMatrix::from_diagonal(&own.diagonal().map(f64::recip))
        } else {
            own.try_inverse().ok_or_else(dependent)?
        };
        let carried = sparse(&(-(&inverse * b.select_columns(&lead))));
        Ok(Rows {
            moved: moved(&lead, &follow, &carried),
            of_slip: sparse(&inverse),
            entries,
            lead,
            follow,
            carried,
        })
    }

    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.follow.len()
    }

    /// Slip `B u` of each row for the displacements `u` of the contact freedoms.
    pub(super) fn slip(&self, u: &DVector<f64>) -> DVector<f64> {
        let of = |row: &RowEntries| row.iter().map(|&(freedom, b)| b * u[freedom]).sum();
        DVector::from_iterator(self.len(), self.entries.iter().map(of))
    }

    /// Displacement `H s` of the followers relative to the leaders that carry them.
    pub(super) fn apart(&self, slip: &[f64]) -> DVector<f64> {
        let of = |row: &RowEntries| row.iter().map(|&(k, h)| h * slip[k]).sum();
        DVector::from_iterator(self.len(), self.of_slip.iter().map(of))
    }

    /// Forces of the rows, `H' f`, for the forces `f` of the followers.
    pub(super) fn forces(&self, of_followers: impl Fn(usize) -> f64, forces: &mut [f64]) {
        forces.fill(0.0);
        for (j, row) in self.of_slip.iter().enumerate() {
            let force = of_followers(j);
            for &(k, h) in row {
                forces[k] += h * force;
            }
        }
    }

    /// Transforms a matrix `X` to `H' X H`, in place if `H` is diagonal.
    pub(super) fn congruence(&self, matrix: DMatrix<f64>) -> DMatrix<f64> {
        let single = |(j, row): (usize, &RowEntries)| match row.as_slice() {
            [(k, h)] if *k == j => Some(*h),
            _ => None,
        };
        let diagonal: Option<Vec<f64>> = self.of_slip.iter().enumerate().map(single).collect();
        if let Some(h) = diagonal {
            let mut matrix = matrix;
            for (mut column, factor) in matrix.column_iter_mut().zip(&h) {
                for (entry, other) in column.iter_mut().zip(&h) {
                    *entry *= factor * other;
                }
            }
            return matrix;
        }
        let mut h = DMatrix::zeros(self.len(), self.len());
        for (j, row) in self.of_slip.iter().enumerate() {
            for &(k, weight) in row {
                h[(j, k)] = weight;
            }
        }
        h.tr_mul(&(matrix * &h))
    }

    /// Load on the leaders, `P' f`, for a load `f` on all contact freedoms.
    pub(super) fn on_leaders(&self, contact: &[f64]) -> DVector<f64> {
        let of = |moved: &RowEntries| moved.iter().map(|&(freedom, w)| w * contact[freedom]).sum();
        DVector::from_iterator(self.lead.len(), self.moved.iter().map(of))
    }

    /// Writes the displacements `u` for the leaders' `v` and the followers' relative displacements
    /// `H s`.
    pub(super) fn spread(&self, v: &DVector<f64>, apart: &DVector<f64>, contact: &mut [f64]) {
        for (&freedom, v) in self.lead.iter().zip(v.iter()) {
            contact[freedom] = *v;
        }
        for ((&freedom, carried), apart) in self.follow.iter().zip(&self.carried).zip(apart.iter())
        {
            let along: f64 = carried.iter().map(|&(leader, w)| w * v[leader]).sum();
            contact[freedom] = along + apart;
        }
    }

    /// Returns the displacements of the leaders that give a rigid motion: the motion itself on
    /// leaders of the part, and values that carry the part's followers along. If each leader
    /// carries a single follower, these values are known at once; otherwise they are found by
    /// conjugate gradients, up to round-off.
    pub(super) fn motion_of_leaders(&self, trace: &Trace, part: &[usize]) -> DVector<f64> {
        let n = self.lead.len();
        let mut v = DVector::from_fn(n, |leader, _| self.motion_of_leader(trace, part, leader));
        let own = |freedom: usize| part[freedom] == trace.part;
        let carried: Vec<(usize, &RowEntries)> = (self.follow.iter().copied().zip(&self.carried))
            .filter(|(f, _)| own(*f))
            .collect();
        let product = |v: &DVector<f64>| {
            let of = |(_, row): &(usize, &RowEntries)| row.iter().map(|&(k, w)| w * v[k]).sum();
            DVector::from_iterator(carried.len(), carried.iter().map(of))
        };
        let transposed = |r: &DVector<f64>| {
            let mut out = DVector::zeros(n);
            for ((_, row), r) in carried.iter().zip(r.iter()) {
                row.iter()
                    .filter(|(k, _)| !own(self.lead[*k]))
                    .for_each(|&(k, w)| out[k] += w * r);
            }
            out
        };
        let exact =
            DVector::from_iterator(carried.len(), carried.iter().map(|(f, _)| trace.values[*f]));
        let mut rest = &exact - product(&v);
        let enough = f64::EPSILON * exact.norm();
        let mut gradient = transposed(&rest);
        let mut direction = gradient.clone();
        let mut size = gradient.norm_squared();
        for _ in 0..2 * n {
            if rest.norm() <= enough || size == 0.0 {
                break;
            }
            let change = product(&direction);
            let step = size / change.norm_squared();
            v.axpy(step, &direction, 1.0);
            rest.axpy(-step, &change, 1.0);
            gradient = transposed(&rest);
            let next = gradient.norm_squared();
            direction = &gradient + direction * (next / size);
            size = next;
        }
        v
    }

    /// Returns the motion of a leader: the rigid motion itself if the leader belongs to the part,
    /// otherwise the mean motion of the followers that the leader carries.
    fn motion_of_leader(&self, trace: &Trace, part: &[usize], leader: usize) -> f64 {
        let moved = self.moved[leader].iter();
        let own = |freedom: usize| part[freedom] == trace.part;
        if own(self.lead[leader]) {
            return trace.values[self.lead[leader]];
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for &(freedom, weight) in moved.filter(|(freedom, _)| own(*freedom)) {
            sum += weight * trace.values[freedom];
            weights += weight * weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    }
}

/// Returns the freedoms that move with each leader: the leader itself and its followers.
fn moved(lead: &[usize], follow: &[usize], carried: &[RowEntries]) -> Vec<RowEntries> {
    let mut moved: Vec<RowEntries> = lead.iter().map(|&freedom| vec![(freedom, 1.0)]).collect();
    for (row, &freedom) in carried.iter().zip(follow) {
        for &(leader, weight) in row {
            moved[leader].push((freedom, weight));
        }
    }
    moved
}

/// Chooses the freedom that follows for each row.
fn followers(b: &DMatrix<f64>, diagonal: impl Fn(usize) -> f64) -> Result<Vec<usize>> {
    let (n, m) = b.shape();
    let stiffness = DVector::from_fn(m, |i, _| diagonal(i).max(0.0));
    let least = f64::EPSILON * stiffness.amax();
    let mut rest = b.clone();
    for (mut column, stiffness) in rest.column_iter_mut().zip(stiffness.iter()) {
        if *stiffness > 0.0 || least > 0.0 {
            column /= stiffness.max(least).sqrt();
        }
    }
    // The matrix is transposed so that elimination works along contiguous memory.
    let mut rest = rest.transpose();
    let sizes: Vec<f64> = rest.column_iter().map(|row| row.amax()).collect();
    let mut follow = vec![usize::MAX; n];
    let mut open: Vec<usize> = (0..n).collect();
    let mut largest: Vec<usize> = (0..n).map(|j| rest.column(j).iamax()).collect();
    while !open.is_empty() {
        let mut best = 0;
        for (at, &j) in open.iter().enumerate() {
            let size = |j: usize| rest[(largest[j], j)].abs();
            if size(j) > size(open[best]) {
                best = at;
            }
        }
        let row = open.remove(best);
        let pivot = largest[row];
        if rest[(pivot, row)].abs() <= DEPENDENT * sizes[row] {
            return Err(dependent());
        }
        follow[row] = pivot;
        let own = rest.column(row) / rest[(pivot, row)];
        for &j in &open {
            let share = rest[(pivot, j)];
            if share != 0.0 {
                rest.column_mut(j).axpy(-share, &own, 1.0);
                rest[(pivot, j)] = 0.0;
                largest[j] = rest.column(j).iamax();
            }
        }
    }
    Ok(follow)
}

fn dependent() -> Error {
    Error::input(
        "the contact rows depend on each other: each must restrict a motion that the others leave \
         free",
    )
}

/// Returns the nonzero entries of a matrix, by rows.
fn sparse(matrix: &DMatrix<f64>) -> Vec<RowEntries> {
    let of_row = |j: usize| {
        let row = matrix.row(j);
        let entries = row.iter().copied().enumerate();
        entries.filter(|(_, value)| *value != 0.0).collect()
    };
    (0..matrix.nrows()).map(of_row).collect()
}
