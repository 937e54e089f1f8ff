//! Linear algebra that knows no mechanics: a symmetric positive definite matrix is factored once and
//! condensed onto its trailing freedoms.
//!
//! The freedoms fall into three groups, `[ interior | zone | contact ]`. The trailing system is
//!
//! ```text
//!     [ S_zz S_zc ] [ u_z ]   [ f_z ]
//!     [ S_cz S_cc ] [ u_c ] = [ f_c ]      S = K_tt - K_ti K_ii^-1 K_it,  t = z + c
//! ```
//!
//! and everything the analysis needs is: the fully condensed contact stiffness
//! `C = S_cc - S_cz S_zz^-1 S_zc`, static condensation of a load onto (z, c), the elimination of the
//! zone for given (f_z, f_c), its recovery for given u_c, and the recovery of all freedoms.

#[cfg(feature = "cholmod")]
pub mod cholmod;
pub mod dense;

use crate::error::Result;
use nalgebra::DMatrix;

/// Upper triangle (row <= column) of a symmetric matrix, compressed by column, rows sorted.
pub type SymmetricCsc = sprs::CsMatI<f64, i64>;

/// Which freedoms are eliminated first (interior), second (zone), and kept (contact).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Partition {
    /// Number of freedoms.
    pub n: usize,
    /// Freedoms of the zone, ascending. Zone vectors are in this order.
    pub zone: Vec<usize>,
    /// Contact freedoms. Contact vectors and matrices are in this order.
    pub contact: Vec<usize>,
}

/// What a factorisation will cost, from the symbolic analysis alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prediction {
    /// Name of the ordering chosen.
    pub ordering: &'static str,
    /// Nonzeros of the factor.
    pub factor_nonzeros: f64,
    /// Floating point operations of the factorisation.
    pub flops: f64,
    /// Nonzeros of the factor's columns that belong to zone and contact freedoms.
    pub trailing_nonzeros: f64,
    /// Bytes needed at the peak.
    pub memory_bytes: f64,
}

/// A matrix `K + diag(shift)` factored and condensed. `shift` acts on contact freedoms only and is
/// taken off again: every result is that of `K` itself, so `K` may be singular as long as fixing its contact
/// freedoms makes it definite.
pub trait Condensed: Send + Sync {
    /// `C = S_cc - S_cz S_zz^-1 S_zc` of `K` (the shift taken off), `n_contact x n_contact`, symmetric.
    fn contact_stiffness(&self) -> &DMatrix<f64>;

    /// Static condensation of a load on all freedoms (`n`) onto the trailing ones:
    /// `f_t = load_t - K_ti K_ii^-1 load_i`. Costs about one full solve.
    fn condense_load(&self, load: &[f64], zone: &mut [f64], contact: &mut [f64]) -> Result<()>;

    /// Eliminates the zone: on entry (f_z, f_c); on return `contact` is `f_c - S_cz S_zz^-1 f_z` and
    /// `zone` holds what [`Condensed::recover_zone`] needs.
    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]);

    /// Recovers the zone: `zone` as left by [`Condensed::eliminate_zone`], on return
    /// `u_z = S_zz^-1 (f_z - S_zc u_c)`.
    fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]);

    /// All freedoms for a load that includes the contact forces, given the contact displacements:
    /// on entry `x` is the load (`n`), on return the solution `u` of `K u = load`. One full solve; a
    /// step of iterative refinement is taken where it lowers the residual.
    fn recover_all(&self, x: &mut [f64], u_contact: &[f64]) -> Result<()>;

    /// Normwise backward error of the last [`Condensed::recover_all`]:
    /// `|K u - f| / (|K| |u| + |f|)`, infinity norms.
    fn backward_error(&self) -> f64;

    /// What the factorisation cost (the same figures that were predicted).
    fn cost(&self) -> Prediction;
}

/// The backend that factors and condenses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backend {
    /// CHOLMOD with a constrained order.
    Cholmod,
    /// Dense, by the textbook, in Rust.
    Dense,
}

impl Default for Backend {
    fn default() -> Self {
        if cfg!(feature = "cholmod") {
            Backend::Cholmod
        } else {
            Backend::Dense
        }
    }
}

/// Factors `K + diag(shift on contact freedoms)` and condenses it.
///
/// # Errors
/// [`crate::ErrorKind::Internal`] naming the freedom as `freedom I` where the matrix is not positive definite
/// (callers map it back to body, node and direction through [`NotDefinite`] as cause); `Input` where the backend
/// is not built in or the model is too large for it.
pub fn condense(
    backend: Backend,
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    match backend {
        Backend::Dense => Ok(Box::new(dense::DenseCondensed::new(
            matrix, partition, shift,
        )?)),
        #[cfg(feature = "cholmod")]
        Backend::Cholmod => Ok(Box::new(cholmod::CholmodCondensed::new(
            matrix, partition, shift,
        )?)),
        #[cfg(not(feature = "cholmod"))]
        Backend::Cholmod => Err(crate::Error::input(
            "this build has no CHOLMOD; use --solver dense or build with the feature `cholmod`",
        )),
    }
}

/// Predicts the cost of [`condense`] from the pattern alone.
///
/// # Errors
/// As [`condense`], without those of the numerical factorisation.
pub fn predict(
    backend: Backend,
    matrix: &SymmetricCsc,
    partition: &Partition,
) -> Result<Prediction> {
    match backend {
        Backend::Dense => dense::predict(partition),
        #[cfg(feature = "cholmod")]
        Backend::Cholmod => cholmod::predict(matrix, partition),
        #[cfg(not(feature = "cholmod"))]
        Backend::Cholmod => {
            let _ = matrix;
            Err(crate::Error::input("this build has no CHOLMOD"))
        }
    }
}

/// Cause of a failed factorisation: the freedom whose pivot was not positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotDefinite {
    /// Freedom (row of the matrix as given, not permuted).
    pub freedom: usize,
}

impl std::fmt::Display for NotDefinite {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the matrix is not positive definite at freedom {}",
            self.freedom
        )
    }
}

impl std::error::Error for NotDefinite {}

/// `y = K x` for the stored upper triangle.
pub fn multiply(matrix: &SymmetricCsc, x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for (j, column) in matrix.outer_iterator().enumerate() {
        let mut sum = 0.0;
        for (i, &a) in column.iter() {
            let i = i as usize;
            sum += a * x[i];
            if i != j {
                y[i] += a * x[j];
            }
        }
        y[j] += sum;
    }
}
