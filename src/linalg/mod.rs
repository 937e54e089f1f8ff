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
//! The analysis needs the fully condensed contact stiffness `C = S_cc - S_cz S_zz^-1 S_zc`, static
//! condensation of a load onto (z, c), the elimination of the zone for given (f_z, f_c), its
//! recovery for given u_c, and the recovery of all freedoms.
//!
//! | backend | how | for |
//! |---|---|---|
//! | `cholmod` | one sparse Cholesky factor whose trailing block *is* the factor of `S` | everything |
//! | `faer` | the same, in pure Rust | everything, without libraries of the system |
//! | `mumps` | the interior by MUMPS over MPI, the rest by CHOLMOD | factors on several machines |
//! | [`dense`] | the formulas above, term by term | reference, small models |

mod backend;
pub(crate) mod blocked;
mod changed;
mod check;
#[cfg(feature = "cholmod")]
pub mod cholmod;
mod condensed;
mod condition;
mod contact_stiffness;
pub mod dense;
#[cfg(feature = "faer")]
pub mod faer;
#[cfg(feature = "mumps")]
pub mod mumps;
mod refinement;
mod residual;
mod row_sums;
#[cfg(any(feature = "cholmod", feature = "faer"))]
mod sparse;
mod symmetric;
#[cfg(test)]
pub(crate) mod tests;
mod whole;
mod zone_part;

pub use backend::{Backend, blas_name, condense, predict, slow_kernels};
pub use changed::ChangedFactor;
pub(crate) use condensed::smallest_pivot_ratio;
pub use condensed::{Condensed, NotDefinite, Partition, Pivot, SymmetricCsc};
pub use condition::condition;
pub use contact_stiffness::{ContactBlock, ContactStiffness};
pub use refinement::{Refinement, componentwise_backward_error, refine, twofold_residual};
pub use residual::{Recovered, recover_refined};
pub(crate) use row_sums::largest;
pub use row_sums::{multiply, norm};
pub use symmetric::Symmetric;
pub use whole::solve_whole;
pub use zone_part::ZonePart;

pub use crate::results::Prediction;
