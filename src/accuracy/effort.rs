//! How much time the error estimate may take, and how much time finer meshes take.

use crate::error::{Error, Result};
use crate::scene::Kind;

/// How much time the error estimate of a run may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Effort {
    /// No more time than the run itself.
    #[default]
    Quick,
    /// The time of two meshes that are fine enough to read every figure of the run, however long.
    Full,
    /// No error estimate.
    None,
}

impl Effort {
    /// Finds the effort with a name.
    ///
    /// # Errors
    /// `Input` for an unknown name.
    pub fn from_name(name: &str) -> Result<Self> {
        let all = [Effort::Quick, Effort::Full, Effort::None];
        let found = all.into_iter().find(|effort| effort.name() == name);
        found.ok_or_else(|| {
            Error::input(format!("estimate = \"{name}\": it is quick, full or none"))
        })
    }

    /// Name of the effort.
    pub fn name(self) -> &'static str {
        match self {
            Effort::Quick => "quick",
            Effort::Full => "full",
            Effort::None => "none",
        }
    }
}

/// Powers of the fineness with which the time of a factorisation grows. With `n` freedoms it grows
/// as `n^(3/2)` in the plane (A. George, Nested dissection of a regular finite element mesh, SIAM
/// J. Numer. Anal. 10 (1973) 345-363, doi:10.1137/0710032) and as `n^2` in space (R. Lipton, D.
/// Rose, R. Tarjan, Generalized nested dissection, SIAM J. Numer. Anal. 16 (1979) 346-358,
/// doi:10.1137/0716027).
const FACTORISATION: [f64; 2] = [3.0, 6.0];

/// Work of the factorisation of a mesh that is finer by a factor, over that of the mesh itself.
pub(super) fn work_of_finer(kind: Kind, factor: f64) -> f64 {
    factor.powf(FACTORISATION[usize::from(kind.is_solid())])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half the size: four and eight times the freedoms, to the powers 3/2 and 2.
    #[test]
    fn work_grows_as_nested_dissection_says() {
        assert_eq!(work_of_finer(Kind::Axisymmetric, 2.0), 8.0);
        assert_eq!(work_of_finer(Kind::Solid, 2.0), 64.0);
    }
}
