//! A matrix that is factored and condensed onto its trailing freedoms: what every backend offers.

use super::{ChangedFactor, ContactStiffness, Prediction, ZonePart};
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
    /// the contact freedoms. `None` if the backend cannot make one, or if the memory does not
    /// suffice.
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

    /// The predicted cost of this factorisation; nothing is measured.
    fn cost(&self) -> Prediction;

    /// Pivot that lost the most digits to cancellation. If its ratio is close to
    /// `smallest_pivot_ratio`, the model is barely held at that freedom.
    fn weakest_pivot(&self) -> Pivot;
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
/// The computed factor is that of `A + E` with `|E_ij| <= (m + 1) eps sqrt(a_ii a_jj)`, where `m`
/// is the number of nonzeros in a row of `L`. For a singular `A` with null vector `v` the last
/// pivot is `v' E v / v_j^2`; the terms of the sum have either sign and stay below `n eps a_jj`.
///
/// # Source
/// N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., SIAM 2002, theorem
/// 10.3, doi:10.1137/1.9780898718027.
pub(crate) fn smallest_pivot_ratio(n: usize) -> f64 {
    n as f64 * f64::EPSILON
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
