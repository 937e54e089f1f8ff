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
//! and everything that the analysis needs is: the fully condensed contact stiffness
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

/// Groups of freedoms: eliminated first (interior), eliminated second (zone), kept (contact).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Partition {
    /// Number of all freedoms.
    pub n: usize,
    /// Freedoms of the zone, ascending, which is the order of zone vectors.
    pub zone: Vec<usize>,
    /// Contact freedoms, in the order of contact vectors and matrices.
    pub contact: Vec<usize>,
}

/// A matrix `K + diag(shift)` factored and condensed. `shift` acts on contact freedoms only (one
/// value for each, in the order of [`Partition::contact`], or none at all) and is subtracted again:
/// every result is that of `K` itself. `K` may therefore be singular as long as fixing its contact
/// freedoms makes it definite.
pub trait Condensed: Send + Sync {
    /// Contact stiffness `C = S_cc - S_cz S_zz^-1 S_zc` of `K` (shift subtracted),
    /// `n_contact x n_contact`, symmetric; computed at each call.
    fn contact_stiffness(&self) -> ContactStiffness;

    /// Chooses a part of the factored zone as the zone: the freedoms `wanted` (ascending) and
    /// further ones that the backend cannot do without. Returns the new zone freedoms, which give
    /// the order of all zone vectors; `None` if a wanted freedom was not factored as zone. The
    /// other freedoms of the factored zone join the interior; they can be chosen again later.
    ///
    /// # Errors
    /// `Analysis` if the memory does not suffice.
    fn choose_zone(&mut self, wanted: &[usize]) -> Result<Option<Vec<usize>>>;

    /// Reduces a load on all freedoms (`n`) to what [`Condensed::condense_load`] and
    /// [`Condensed::recover_all`] need, independently of the choice of the zone. The result is
    /// linear in the load and has length `n`. Costs about half a full solve.
    ///
    /// # Errors
    /// Errors of [`Condensed::recover_all`].
    fn reduce_load(&self, load: &[f64]) -> Result<Vec<f64>>;

    /// Condenses a reduced load statically onto zone and contact freedoms:
    /// `f_t = load_t - K_ti K_ii^-1 load_i`. The cost depends on the zone, not on the mesh.
    ///
    /// # Errors
    /// `Internal` if a vector has the wrong length.
    fn condense_load(&self, reduced: &[f64], zone: &mut [f64], contact: &mut [f64]) -> Result<()>;

    /// Eliminates the zone: on entry (f_z, f_c); on return `contact` is `f_c - S_cz S_zz^-1 f_z`,
    /// and `zone` holds the values that [`Condensed::recover_zone`] needs.
    fn eliminate_zone(&self, zone: &mut [f64], contact: &mut [f64]);

    /// Recovers the zone: on entry `zone` as [`Condensed::eliminate_zone`] left it, on return
    /// `u_z = S_zz^-1 (f_z - S_zc u_c)`.
    fn recover_zone(&self, zone: &mut [f64], u_contact: &[f64]);

    /// Part of the zone that contains the marked zone freedoms.
    fn part_of_zone(&self, _marked: &[bool]) -> ZonePart {
        ZonePart::default()
    }

    /// Recovers displacements as [`Condensed::recover_zone`] does, but only in a part of the zone;
    /// the displacements of the rest are undefined.
    fn recover_part(&self, _part: &ZonePart, zone: &mut [f64], u_contact: &[f64]) {
        self.recover_zone(zone, u_contact);
    }

    /// Makes a second factor, of the condensed matrix with changed values in the chosen zone and on
    /// the contact freedoms. `None` if the backend has none, or if the memory does not suffice.
    fn changed(&self) -> Option<Box<dyn ChangedFactor>> {
        None
    }

    /// Recovers all freedoms from a reduced load and the displacements of zone and contact freedoms
    /// (loads on these are ignored): `u_i = K_ii^-1 (load_i - K_it u_t)`. Costs about half a full
    /// solve.
    ///
    /// # Errors
    /// `Analysis` if the memory does not suffice, `Internal` if a vector has the wrong length.
    fn recover_all(&self, reduced: &[f64], zone: &[f64], contact: &[f64]) -> Result<Vec<f64>>;

    /// Cost of the factorisation (the same figures as predicted).
    fn cost(&self) -> Prediction;

    /// Pivot that lost most digits to cancellation. If its ratio is close to
    /// `smallest_pivot_ratio`, the model is barely held at that freedom.
    fn weakest_pivot(&self) -> Pivot;
}

/// Blocks that a backend must visit to recover some zone freedoms; by default all.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ZonePart {
    /// For each block of the backend, whether it is visited; empty for all.
    blocks: Vec<bool>,
}

#[cfg(any(feature = "cholmod", feature = "faer"))]
impl ZonePart {
    fn has(&self, block: usize) -> bool {
        self.blocks.is_empty() || self.blocks[block]
    }
}

/// A pivot of the factorisation of `A = K + diag(shift)`, relative to its diagonal entry. The ratio
/// is in (0, 1] and small if the freedom is held only weakly by its supports and the freedoms
/// eliminated before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pivot {
    /// Freedom of the pivot (row of the matrix as given).
    pub freedom: usize,
    /// Ratio `l_jj^2 / a_jj` of the pivot to the diagonal entry.
    pub ratio: f64,
}

/// Pivot ratio that round-off alone produces on a singular matrix of `n` freedoms, `n eps`. A
/// factorisation with a smaller ratio is refused as not definite, since the pivot's sign has no
/// meaning.
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

/// Backend that factors and condenses the stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backend {
    /// CHOLMOD with a constrained ordering.
    Cholmod,
    /// The sparse solver of faer, in Rust.
    Faer,
    /// MUMPS over MPI for the interior, CHOLMOD for the rest.
    Mumps,
    /// Dense matrices, by the textbook formulas, in Rust.
    Dense,
}

impl Backend {
    /// All backends; the first that is built in is the default.
    pub const ALL: [Backend; 4] = [
        Backend::Cholmod,
        Backend::Faer,
        Backend::Mumps,
        Backend::Dense,
    ];

    /// Name on the command line and in results, and of the cargo feature that builds the backend
    /// in.
    pub fn name(self) -> &'static str {
        match self {
            Backend::Cholmod => "cholmod",
            Backend::Faer => "faer",
            Backend::Mumps => "mumps",
            Backend::Dense => "dense",
        }
    }

    /// Finds the backend with a name.
    ///
    /// # Errors
    /// `Input` with the names that exist.
    pub fn from_name(name: &str) -> Result<Self> {
        let found = Backend::ALL.into_iter().find(|b| b.name() == name);
        found.ok_or_else(|| {
            let names = Backend::ALL.map(|b| format!("`{}`", b.name())).join(", ");
            Error::input(format!("there is no solver `{name}`: there are {names}"))
        })
    }

    /// Whether this build contains the backend.
    pub(crate) fn is_built_in(self) -> bool {
        match self {
            Backend::Cholmod => cfg!(feature = "cholmod"),
            Backend::Faer => cfg!(feature = "faer"),
            Backend::Mumps => cfg!(feature = "mumps"),
            Backend::Dense => true,
        }
    }

    /// Backends of this build, the default first.
    pub fn built_in() -> Vec<Backend> {
        let all = Backend::ALL.into_iter();
        all.filter(|backend| backend.is_built_in()).collect()
    }

    /// Name of the library that does the dense arithmetic of a factorisation.
    pub fn arithmetic(self) -> String {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::blas_name(),
            Backend::Faer => "none (faer, in Rust)".to_string(),
            _ => "none (dense backend in Rust)".to_string(),
        }
    }

    /// Processor whose kernels the BLAS uses (`Haswell`); `None` if there is no BLAS or if the BLAS
    /// cannot be asked.
    pub fn kernels(self) -> Option<String> {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::kernels(),
            _ => None,
        }
    }

    /// Number of threads of a factorisation; `None` if it cannot be asked.
    pub(crate) fn threads(self) -> Option<usize> {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::blas_threads(),
            _ => Some(1),
        }
    }

    /// Error for a backend that this build does not contain.
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
/// [`crate::ErrorKind::Internal`], naming the freedom as `freedom I`, if the matrix is not positive
/// definite to working precision (`smallest_pivot_ratio`; callers map the freedom back to body,
/// node and direction through [`NotDefinite`] as cause), or if the arguments do not fit together;
/// `Input` if the backend is not built in or the model is too large for it; `Analysis` if the
/// memory does not suffice.
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
/// Errors of [`condense`], except those of the numerical factorisation.
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
    /// Freedom of the pivot (row of the matrix as given, not permuted).
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

/// Warning if the BLAS uses slower instructions than the processor has, with the environment
/// setting that corrects this; `None` otherwise. Libraries report it once, through their log; the
/// program `brinell` restarts itself with the setting.
pub fn slow_kernels() -> Option<String> {
    #[cfg(feature = "cholmod")]
    return cholmod::slow_kernels();
    #[cfg(not(feature = "cholmod"))]
    None
}

/// Name of the BLAS that the default backend uses.
pub fn blas_name() -> String {
    Backend::default().arithmetic()
}
