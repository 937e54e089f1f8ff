//! Contact without friction as a dense linear complementarity problem.
//!
//! In terms of the gaps `g` and the contact forces `r` (compressive positive) of the pairs, the
//! condensed structure is
//!
//! ```text
//!     r = q + T g,     g >= 0,  r >= 0,  g . r = 0
//! ```
//!
//! `T` (`n_pairs x n_pairs`, symmetric, positive semidefinite) is the stiffness of the structure
//! against opening the pairs; `q` holds the forces the pairs would carry if all were closed. This
//! module knows neither meshes nor bodies. Groups of pairs that do not influence one another are
//! blocks of `T` ([`PairMatrix`]).
//!
//! * [`Tableau`]: the matrix with a set of pairs opened, updated by principal pivots in O(n^2),
//!   where n is the number of pairs of the group;
//! * [`solve`]: statuses for a given `q` (paper, eqs. 3.7 to 3.10), finite for every semidefinite
//!   `T`;
//! * [`Path`]: statuses for `q` moving along a line, from one change of contact to the next (paper,
//!   eqs. 4.10 to 4.22, exact without plastic flow);
//! * `loose`: positions to which the first bit of load moves bodies that nothing holds yet;
//! * `springs`: weak springs that hold bodies in the directions that no load drives.

mod complementarity;
pub(crate) mod loose;
mod matrix;
mod path;
pub(crate) mod springs;
mod swept;
mod tableau;

pub use complementarity::{Certificate, Unbounded, solve};
pub use matrix::{PairBlock, PairMatrix};
pub use path::{Change, Path, PathEnd};
pub use tableau::{Tableau, TableauRecord};

#[cfg(test)]
mod tests;
