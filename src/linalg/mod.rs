//! Linear algebra that knows no mechanics: a symmetric positive definite matrix is factored once
//! and condensed onto its trailing freedoms.
//!
//! The freedoms fall into three groups, `[ interior | zone | contact ]`. The trailing system is
//!
//! ```text
//!     [ S_zz S_zc ] [ u_z ]   [ f_z ]
//!     [ S_cz S_cc ] [ u_c ] = [ f_c ]      S = K_tt - K_ti K_ii^-1 K_it,  t = z + c
//! ```
//!
//! and everything the analysis needs is: the fully condensed contact stiffness
//! `C = S_cc - S_cz S_zz^-1 S_zc`, static condensation of a load onto (z, c), the elimination of
//! the zone for given (f_z, f_c), its recovery for given u_c, and the recovery of all freedoms.
//!
//! | backend | how | for |
//! |---|---|---|
//! | `cholmod` | one sparse Cholesky factor whose trailing block *is* the factor of `S` | everything |
//! | `faer` | the same, in Rust alone | everything, without libraries of the system |
//! | `mumps` | the interior by MUMPS over MPI, the rest by CHOLMOD | factors on several machines |
//! | [`dense`] | the formulas above, term by term | reference, small models |

pub(crate) mod blocked;
mod changed;
mod check;
#[cfg(feature = "cholmod")]
pub mod cholmod;
mod condition;
mod contact_stiffness;
pub mod dense;
#[cfg(feature = "faer")]
pub mod faer;
#[cfg(feature = "mumps")]
pub mod mumps;
mod refinement;
mod residual;
#[cfg(any(feature = "cholmod", feature = "faer"))]
mod sparse;
mod symmetric;
#[cfg(test)]
pub(crate) mod tests;
mod whole;

pub use changed::ChangedFactor;
pub use condition::condition;
pub use contact_stiffness::{ContactBlock, ContactStiffness};
pub use refinement::{Refinement, componentwise_backward_error, refine, twofold_residual};
pub(crate) use residual::largest;
pub use residual::{Recovered, multiply, norm, recover_refined};
pub use symmetric::Symmetric;
pub use whole::solve_whole;

pub use crate::results::Prediction;

use crate::error::{Error, Result};

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

/// A matrix `K + diag(shift)` factored and condensed. `shift` acts on contact freedoms only (one
/// value for each, in the order of [`Partition::contact`], or none at all) and is taken off again:
/// every result is that of `K` itself, so `K` may be singular as long as fixing its contact
/// freedoms makes it definite.
pub trait Condensed: Send + Sync {
    /// `C = S_cc - S_cz S_zz^-1 S_zc` of `K` (the shift taken off), `n_contact x n_contact`,
    /// symmetric; formed anew at each call.
    fn contact_stiffness(&self) -> ContactStiffness;

    /// Makes a part of the factored zone the zone: the freedoms `wanted` (ascending) and those that
    /// the backend cannot do without. Returns the zone freedoms from now on, the order of all zone
    /// vectors, or `None` where one of those wanted was not factored as zone. The rest of the zone
    /// joins the interior; it can come back.
    ///
    /// # Errors
    /// `Analysis` where the memory does not suffice.
    fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>>;

    /// Reduces a load on all freedoms (`n`) to what [`Condensed::condense_load`] and
    /// [`Condensed::recover_all`] need of it for whichever zone is chosen, linear in the load
    /// (`n`). Costs about half a full solve.
    ///
    /// # Errors
    /// As [`Condensed::recover_all`].
    fn reduce_load(&self, load: &[f64]) -> Result<Vec<f64>>;

    /// Static condensation of a reduced load onto zone and contact freedoms:
    /// `f_t = load_t - K_ti K_ii^-1 load_i`. Costs the zone, not the mesh.
    ///
    /// # Errors
    /// `Internal` where a vector has the wrong length.
    fn condense_load(&self, reduced: &[f64], zone: &mut [f64], contact: &mut [f64]) -> Result<()>;

    /// Eliminates the zone: on entry (f_z, f_c); on return `contact` is `f_c - S_cz S_zz^-1 f_z`
    /// and `zone` holds what [`Condensed::recover_zone`] needs.
    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]);

    /// Recovers the zone: `zone` as left by [`Condensed::eliminate_zone`], on return
    /// `u_z = S_zz^-1 (f_z - S_zc u_c)`.
    fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]);

    /// The part of the zone that the marked zone freedoms are in.
    fn part_of_zone(&self, _marked: &[bool]) -> ZonePart {
        ZonePart::default()
    }

    /// As [`Condensed::recover_zone`] where only the displacements in a part of the zone are asked
    /// for; what the others are is left open.
    fn recover_part(&self, _part: &ZonePart, zone: &mut [f64], u_contact: &[f64]) {
        self.recover_zone(zone, u_contact);
    }

    /// A second factor, of the condensed matrix with other values in the chosen zone and on the
    /// contact freedoms. `None` where the backend has none, or the memory does not suffice.
    fn changed(&self) -> Option<Box<dyn ChangedFactor>> {
        None
    }

    /// All freedoms for a reduced load, given the displacements of zone and contact freedoms (loads
    /// on these have no part in it): `u_i = K_ii^-1 (load_i - K_it u_t)`. Costs about half a full
    /// solve.
    ///
    /// # Errors
    /// `Analysis` where the memory does not suffice, `Internal` where a vector has the wrong
    /// length.
    fn recover_all(&self, reduced: &[f64], zone: &[f64], contact: &[f64]) -> Result<Vec<f64>>;

    /// What the factorisation cost (the same figures that were predicted).
    fn cost(&self) -> Prediction;

    /// The pivot that lost most to cancellation. Near `smallest_pivot_ratio` the model is
    /// barely held at that freedom.
    fn weakest_pivot(&self) -> Pivot;
}

/// What a backend must go through to recover some of the zone freedoms; by default all of them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ZonePart {
    /// Which blocks of the backend's own; empty for all.
    blocks: Vec<bool>,
}

#[cfg(any(feature = "cholmod", feature = "faer"))]
impl ZonePart {
    fn has(&self, block: usize) -> bool {
        self.blocks.is_empty() || self.blocks[block]
    }
}

/// A pivot of the factorisation of `A = K + diag(shift)`, relative to its diagonal entry: in (0,
/// 1], small where the freedom is held only weakly by those eliminated before it and its supports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pivot {
    /// Freedom (row of the matrix as given).
    pub freedom: usize,
    /// `l_jj^2 / a_jj`.
    pub ratio: f64,
}

/// The pivot ratio that round-off alone produces on a singular matrix of `n` freedoms, `n eps`: a
/// factorisation with a smaller one is refused as not definite, since its sign means nothing.
///
/// The computed factor is that of `A + E` with `|E_ij| <= (m + 1) eps sqrt(a_ii a_jj)`, m the
/// nonzeros in a row of `L`. For a singular `A` with null vector `v` the last pivot is
/// `v' E v / v_j^2`; the terms of the sum have either sign and stay below `n eps a_jj`.
///
/// # Source
/// N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., SIAM 2002, theorem
/// 10.3, doi:10.1137/1.9780898718027.
pub(crate) fn smallest_pivot_ratio(n: usize) -> f64 {
    n as f64 * f64::EPSILON
}

/// The backend that factors and condenses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backend {
    /// CHOLMOD with a constrained order.
    Cholmod,
    /// faer, sparse and in Rust.
    Faer,
    /// MUMPS over MPI for the interior, CHOLMOD for the rest.
    Mumps,
    /// Dense, by the textbook, in Rust.
    Dense,
}

impl Backend {
    /// All of them; the first that is built in is the default.
    pub const ALL: [Backend; 4] = [
        Backend::Cholmod,
        Backend::Faer,
        Backend::Mumps,
        Backend::Dense,
    ];

    /// The name used on the command line, in results, and of the cargo feature that builds it in.
    pub fn name(self) -> &'static str {
        match self {
            Backend::Cholmod => "cholmod",
            Backend::Faer => "faer",
            Backend::Mumps => "mumps",
            Backend::Dense => "dense",
        }
    }

    /// The backend of this name.
    ///
    /// # Errors
    /// `Input` with the names that there are.
    pub fn from_name(name: &str) -> Result<Self> {
        let found = Backend::ALL.into_iter().find(|b| b.name() == name);
        found.ok_or_else(|| {
            let names = Backend::ALL.map(|b| format!("`{}`", b.name())).join(", ");
            Error::input(format!("there is no solver `{name}`: there are {names}"))
        })
    }

    /// Whether this build has it.
    pub(crate) fn is_built_in(self) -> bool {
        match self {
            Backend::Cholmod => cfg!(feature = "cholmod"),
            Backend::Faer => cfg!(feature = "faer"),
            Backend::Mumps => cfg!(feature = "mumps"),
            Backend::Dense => true,
        }
    }

    /// The backends of this build, the default first.
    pub fn built_in() -> Vec<Backend> {
        let all = Backend::ALL.into_iter();
        all.filter(|backend| backend.is_built_in()).collect()
    }

    /// Who does the dense arithmetic of a factorisation, in words.
    pub fn arithmetic(self) -> String {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::blas_name(),
            Backend::Faer => "none (faer, in Rust)".to_string(),
            _ => "none (dense backend in Rust)".to_string(),
        }
    }

    /// The processor whose kernels the BLAS uses (`Haswell`); `None` where there is no BLAS or it
    /// cannot be asked.
    pub fn kernels(self) -> Option<String> {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::kernels(),
            _ => None,
        }
    }

    /// Threads of a factorisation; `None` where it cannot be asked.
    pub(crate) fn threads(self) -> Option<usize> {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::blas_threads(),
            _ => Some(1),
        }
    }

    /// Message where a backend is asked for that this build does not have.
    #[cfg_attr(
        all(feature = "cholmod", feature = "faer", feature = "mumps"),
        allow(dead_code)
    )]
    fn not_built_in(self) -> Error {
        let name = self.name();
        Error::input(format!(
            "this build has no solver `{name}`: use --solver {} or build with the cargo feature \
             `{name}`",
            Backend::default().name()
        ))
    }
}

impl Default for Backend {
    fn default() -> Self {
        let first = Backend::ALL.into_iter().find(|b| b.is_built_in());
        first.unwrap_or(Backend::Dense)
    }
}

/// Factors `K + diag(shift on contact freedoms)` and condenses it.
///
/// # Errors
/// [`crate::ErrorKind::Internal`] naming the freedom as `freedom I` where the matrix is not
/// positive definite, to working precision (`smallest_pivot_ratio`; callers map it back to body,
/// node and direction through [`NotDefinite`] as cause), or where the arguments do not fit
/// together; `Input` where the backend is not built in or the model is too large for it; `Analysis`
/// where the memory does not suffice.
pub fn condense(
    backend: Backend,
    matrix: &SymmetricCsc,
    partition: &Partition,
    shift: &[f64],
) -> Result<Box<dyn Condensed>> {
    check::arguments(matrix, partition, shift)?;
    match backend {
        Backend::Dense => Ok(Box::new(dense::DenseCondensed::new(
            matrix, partition, shift,
        )?)),
        #[cfg(feature = "cholmod")]
        Backend::Cholmod => cholmod::condense(matrix, partition, shift),
        #[cfg(feature = "faer")]
        Backend::Faer => faer::condense(matrix, partition, shift),
        #[cfg(feature = "mumps")]
        Backend::Mumps => mumps::condense(matrix, partition, shift),
        #[cfg(not(all(feature = "cholmod", feature = "faer", feature = "mumps")))]
        _ => Err(backend.not_built_in()),
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
    check::arguments(matrix, partition, &[])?;
    match backend {
        Backend::Dense => dense::predict(partition),
        #[cfg(feature = "cholmod")]
        Backend::Cholmod => cholmod::predict(matrix, partition),
        #[cfg(feature = "faer")]
        Backend::Faer => faer::predict(matrix, partition),
        #[cfg(feature = "mumps")]
        Backend::Mumps => mumps::predict(matrix, partition),
        #[cfg(not(all(feature = "cholmod", feature = "faer", feature = "mumps")))]
        _ => Err(backend.not_built_in()),
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

impl From<NotDefinite> for Error {
    fn from(cause: NotDefinite) -> Self {
        Error::internal(cause.to_string()).because(cause)
    }
}

/// What to tell a user where the BLAS computes with less than the processor has, and with which
/// setting of the environment it would not; `None` where all is well. Libraries say it once,
/// through their log; the program `brinell` begins anew with the setting.
pub fn slow_kernels() -> Option<String> {
    #[cfg(feature = "cholmod")]
    return cholmod::slow_kernels();
    #[cfg(not(feature = "cholmod"))]
    None
}

/// The BLAS that the default backend uses, in words.
pub fn blas_name() -> String {
    Backend::default().arithmetic()
}
