//! The backends that factor and condense.

#[cfg(feature = "cholmod")]
use super::cholmod;
#[cfg(feature = "faer")]
use super::faer;
#[cfg(feature = "mumps")]
use super::mumps;
use super::{Condensed, Partition, Prediction, SymmetricCsc, check, dense};
use crate::error::{Error, Result};

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

    /// Name of the backend on the command line and in results. The cargo feature that builds a
    /// sparse backend in has the same name; `dense` needs no feature.
    pub fn name(self) -> &'static str {
        match self {
            Backend::Cholmod => "cholmod",
            Backend::Faer => "faer",
            Backend::Mumps => "mumps",
            Backend::Dense => "dense",
        }
    }

    /// Finds the backend called `name`.
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
    /// does not report it.
    pub fn kernels(self) -> Option<String> {
        match self {
            #[cfg(feature = "cholmod")]
            Backend::Cholmod | Backend::Mumps => cholmod::kernels(),
            _ => None,
        }
    }

    /// Number of threads that a factorisation uses; `None` if the BLAS does not report it.
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
/// [`crate::ErrorKind::Internal`] if the matrix is not positive definite to working precision
/// (`smallest_pivot_ratio`), or if the arguments do not fit together; `Input` if the backend is not
/// built in or the model is too large for it; `Analysis` if the memory does not suffice. The
/// message about a matrix that is not definite names `freedom I`. The cause of that error is a
/// [`crate::linalg::NotDefinite`], from which callers find body, node and direction.
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

/// Warning if the BLAS uses slower instructions than the processor has, with the environment
/// setting that corrects this; `None` otherwise. The Rust crate and the Python module log the
/// warning once per process; the program `brinell` restarts itself with the setting instead.
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
