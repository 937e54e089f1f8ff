//! What only the MUMPS backend must do; the rest stands in `linalg::sparse::tests`.

use super::*;
use crate::linalg::sparse::tests::Way;

/// MUMPS on one rank.
pub(in crate::linalg) fn ways() -> Vec<Way> {
    vec![Way {
        name: "mumps",
        is_chosen: true,
        condense,
    }]
}
