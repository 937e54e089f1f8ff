//! Dense backend: static condensation by the textbook formulas, in pure Rust.
//!
//! ```text
//!     S   = K_tt - K_ti K_ii^-1 K_it          t = zone and contact, i = interior
//!     C   = S_cc - S_cz S_zz^-1 S_zc
//! ```
//!
//! This backend is the reference against which the sparse backends are tested; it shares only the
//! trait with them.
//!
//! # Source
//! R. J. Guyan, *Reduction of stiffness and mass matrices*, AIAA Journal 3 (2), 1965, p. 380,
//! doi:10.2514/3.2874 (static condensation); G. H. Golub, C. F. Van Loan, *Matrix Computations*,
//! 4th ed., 2013, algorithm 4.2.7 (blocked Cholesky).

use super::{
    Condensed, ContactBlock, ContactStiffness, NotDefinite, Partition, Pivot, Prediction,
    SymmetricCsc, check, smallest_pivot_ratio,
};
use crate::error::{Error, Result};
use crate::memory;
use nalgebra::{DMatrix, DVector};

/// Largest number of freedoms that this backend takes: 6000 need 0.6 GB and about ten seconds.
pub const LARGEST: usize = 6000;

/// A matrix that is condensed with dense factors.
pub struct DenseCondensed {
    partition: Partition,
    interior: Vec<usize>,
    /// Matrix `K` with both triangles, on all freedoms.
    matrix: DMatrix<f64>,
    /// Lower Cholesky factor of `K_ii`.
    factor_ii: DMatrix<f64>,
    /// Lower Cholesky factor of `S_zz`.
    factor_zz: DMatrix<f64>,
    s_cz: DMatrix<f64>,
    contact_stiffness: DMatrix<f64>,
    weakest: Pivot,
}

impl DenseCondensed {
    /// Factors and condenses `matrix + diag(shift)`.
    ///
    /// # Errors
    /// Errors of [`super::condense`]; `Input` for more than [`LARGEST`] freedoms.
    pub fn new(matrix: &SymmetricCsc, partition: &Partition, shift: &[f64]) -> Result<Self> {
        check::arguments(matrix, partition, shift)?;
        refuse_large(partition.n)?;
        let what = format!("dense factorisation of {} freedoms", partition.n);
        memory::require(&what, prediction(partition).memory_bytes)?;
        let k = full(matrix);
        let (zone, contact) = (&partition.zone, &partition.contact);
        let mut kept = vec![true; partition.n];
        for &freedom in zone.iter().chain(contact) {
            kept[freedom] = false;
        }
        let interior: Vec<usize> = (0..partition.n).filter(|&freedom| kept[freedom]).collect();

        let mut pivots = Pivots::new(partition.n);
        let factor_ii = pivots.factor(block(&k, &interior, &interior), &interior, |j| {
            k[(interior[j], interior[j])]
        })?;
        // S = K_tt - W' W with W = L_ii^-1 K_it.
        let trailing: Vec<usize> = zone.iter().chain(contact).copied().collect();
        let mut w = block(&k, &interior, &trailing);
        factor_ii.solve_lower_triangular_mut(&mut w);
        let s = block(&k, &trailing, &trailing) - w.tr_mul(&w);

        let (n_z, n_c) = (zone.len(), contact.len());
        let s_zz = s.view((0, 0), (n_z, n_z)).into_owned();
        let s_cz = s.view((n_z, 0), (n_c, n_z)).into_owned();
        let factor_zz = pivots.factor(s_zz, zone, |j| k[(zone[j], zone[j])])?;
        let mut v = s_cz.transpose();
        factor_zz.solve_lower_triangular_mut(&mut v);
        let mut c = s.view((n_z, n_z), (n_c, n_c)) - v.tr_mul(&v);
        // Products of rows with themselves may differ in the last bit across the diagonal.
        c.fill_upper_triangle_with_lower_triangle();

        // C itself may be singular; C + diag(shift) must not be.
        let mut shifted = c.clone();
        for (j, &d) in shift.iter().enumerate() {
            shifted[(j, j)] += d;
        }
        pivots.factor(shifted, contact, |j| {
            k[(contact[j], contact[j])] + shift.get(j).copied().unwrap_or(0.0)
        })?;

        Ok(DenseCondensed {
            partition: partition.clone(),
            interior,
            matrix: k,
            factor_ii,
            factor_zz,
            s_cz,
            contact_stiffness: c,
            weakest: pivots.weakest,
        })
    }

    /// Condensed load `f_t = b_t - K_ti K_ii^-1 b_i`.
    fn condensed(&self, b: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let x_i = self.solve_ii(pick(b, &self.interior));
        let part =
            |list: &[usize]| pick(b, list) - block(&self.matrix, list, &self.interior) * &x_i;
        (part(&self.partition.zone), part(&self.partition.contact))
    }

    /// Solves on the interior: `K_ii^-1 b`.
    fn solve_ii(&self, mut b: DVector<f64>) -> DVector<f64> {
        self.factor_ii.solve_lower_triangular_mut(&mut b);
        self.factor_ii.tr_solve_lower_triangular_mut(&mut b);
        b
    }

    /// Solves on the zone: `S_zz^-1 b`.
    fn solve_zz(&self, mut b: DVector<f64>) -> DVector<f64> {
        self.factor_zz.solve_lower_triangular_mut(&mut b);
        self.factor_zz.tr_solve_lower_triangular_mut(&mut b);
        b
    }
}

impl Condensed for DenseCondensed {
    fn contact_stiffness(&self) -> ContactStiffness {
        let freedoms = (0..self.partition.contact.len()).collect();
        let matrix = self.contact_stiffness.clone();
        ContactStiffness::new(vec![ContactBlock { freedoms, matrix }])
    }

    fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>> {
        let zone = &self.partition.zone;
        Ok(check::contains(zone, wanted).then(|| zone.clone()))
    }

    fn reduce_load(&self, load: &[f64]) -> Result<Vec<f64>> {
        check::length("load", load.len(), self.partition.n)?;
        Ok(load.to_vec())
    }

    fn condense_load(&self, load: &[f64], zone: &mut [f64], contact: &mut [f64]) -> Result<()> {
        check::length("reduced load", load.len(), self.partition.n)?;
        check::length("zone load", zone.len(), self.partition.zone.len())?;
        check::length("contact load", contact.len(), self.partition.contact.len())?;
        let (f_z, f_c) = self.condensed(&DVector::from_column_slice(load));
        zone.copy_from_slice(f_z.as_slice());
        contact.copy_from_slice(f_c.as_slice());
        Ok(())
    }

    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]) {
        let x_z = self.solve_zz(DVector::from_column_slice(zone));
        let f_c = DVector::from_column_slice(contact) - &self.s_cz * &x_z;
        zone.copy_from_slice(x_z.as_slice());
        contact.copy_from_slice(f_c.as_slice());
    }

    fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]) {
        let u_c = DVector::from_column_slice(u_contact);
        let u_z = DVector::from_column_slice(zone) - self.solve_zz(self.s_cz.tr_mul(&u_c));
        zone.copy_from_slice(u_z.as_slice());
    }

    fn recover_all(&self, load: &[f64], zone: &[f64], contact: &[f64]) -> Result<Vec<f64>> {
        let partition = &self.partition;
        check::length("reduced load", load.len(), partition.n)?;
        check::length("zone displacement", zone.len(), partition.zone.len())?;
        check::length(
            "contact displacement",
            contact.len(),
            partition.contact.len(),
        )?;
        let given = [(&partition.zone, zone), (&partition.contact, contact)];
        let mut f_i = pick(&DVector::from_column_slice(load), &self.interior);
        for (list, u) in given {
            f_i -= block(&self.matrix, &self.interior, list) * DVector::from_column_slice(u);
        }
        let u_i = self.solve_ii(f_i);
        let mut u = vec![0.0; partition.n];
        for (list, part) in given.into_iter().chain([(&self.interior, u_i.as_slice())]) {
            for (&freedom, &value) in list.iter().zip(part) {
                u[freedom] = value;
            }
        }
        Ok(u)
    }

    fn cost(&self) -> Prediction {
        prediction(&self.partition)
    }

    fn weakest_pivot(&self) -> Pivot {
        self.weakest
    }
}

/// Predicts the cost of [`DenseCondensed::new`].
///
/// # Errors
/// `Input` for more than [`LARGEST`] freedoms.
pub fn predict(partition: &Partition) -> Result<Prediction> {
    refuse_large(partition.n)?;
    Ok(prediction(partition))
}

fn prediction(partition: &Partition) -> Prediction {
    let n = partition.n as f64;
    let trailing = (partition.zone.len() + partition.contact.len()) as f64;
    Prediction {
        ordering: "dense".into(),
        factor_nonzeros: n * (n + 1.0) / 2.0,
        flops: n * n * n / 3.0,
        trailing_nonzeros: trailing * (trailing + 1.0) / 2.0,
        // K, its blocks (together the same size), and W and S with their products.
        memory_bytes: 8.0 * (2.0 * n * n + 2.0 * trailing * n),
        memory_by_rank: Vec::new(),
    }
}

fn refuse_large(n: usize) -> Result<()> {
    if n <= LARGEST {
        return Ok(());
    }
    Err(Error::input(format!(
        "{n} freedoms are too many for the dense solver, which takes at most {LARGEST}: use \
         `--solver cholmod` or `--solver faer` (a build with the feature of that name) or a \
         coarser mesh"
    )))
}

/// Pivots of several factorisations that together form a factorisation of the whole matrix.
struct Pivots {
    smallest: f64,
    weakest: Pivot,
}

impl Pivots {
    fn new(n: usize) -> Self {
        Pivots {
            smallest: smallest_pivot_ratio(n),
            weakest: Pivot {
                freedom: 0,
                ratio: f64::INFINITY,
            },
        }
    }

    /// Returns the lower Cholesky factor of `a`, of which only the lower triangle is read. Row `j`
    /// is the freedom `freedoms[j]`, with the entry `diagonal(j)` in the matrix before
    /// condensation.
    fn factor(
        &mut self,
        mut a: DMatrix<f64>,
        freedoms: &[usize],
        diagonal: impl Fn(usize) -> f64,
    ) -> Result<DMatrix<f64>> {
        // Number of columns that are updated together, by one matrix product.
        const BLOCK: usize = 64;
        let n = a.nrows();
        for start in (0..n).step_by(BLOCK) {
            let end = (start + BLOCK).min(n);
            let (done, mut rest) = a.columns_range_pair_mut(..start, start..end);
            rest.rows_mut(start, n - start).gemm(
                -1.0,
                &done.rows(start, n - start),
                &done.rows(start, end - start).transpose(),
                1.0,
            );
            for j in start..end {
                let (left, mut column) = a.columns_range_pair_mut(start..j, j..j + 1);
                let mut column = column.column_mut(0);
                for left in left.column_iter() {
                    let l = left[j];
                    column
                        .rows_mut(j, n - j)
                        .axpy(-l, &left.rows(j, n - j), 1.0);
                }
                let (freedom, pivot) = (freedoms[j], column[j]);
                let ratio = pivot / diagonal(j);
                // Written so that a NaN pivot fails as well.
                if !(pivot > 0.0 && ratio > self.smallest) {
                    return Err(NotDefinite { freedom }.into());
                }
                if ratio < self.weakest.ratio {
                    self.weakest = Pivot { freedom, ratio };
                }
                column.rows_mut(j, n - j).scale_mut(1.0 / pivot.sqrt());
                a.view_mut((0, j), (j, 1)).fill(0.0);
            }
        }
        Ok(a)
    }
}

/// Dense matrix with both triangles of a symmetric one.
fn full(matrix: &SymmetricCsc) -> DMatrix<f64> {
    let n = matrix.rows();
    let mut k = DMatrix::zeros(n, n);
    for (j, column) in matrix.outer_iterator().enumerate() {
        for (i, &a) in column.iter() {
            k[(i, j)] = a;
            k[(j, i)] = a;
        }
    }
    k
}

fn block(k: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| k[(rows[i], columns[j])])
}

fn pick(x: &DVector<f64>, list: &[usize]) -> DVector<f64> {
    DVector::from_iterator(list.len(), list.iter().map(|&freedom| x[freedom]))
}
