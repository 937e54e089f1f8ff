//! Soft contact: the overlap of each pair as a freedom of its own.
//!
//! ```text
//!     s_j = u_slave . n - sum_k w_k u_k . n - e_j <= delta_j,     e_j = r_j / (k A_j)
//! ```
//!
//! With `e_j` the condition on gap and force is `g_j + r_j / (k A_j) >= 0`. The freedom belongs to
//! no node and has the stiffness `k A_j` alone, so that for all later steps soft contact is hard
//! contact on springs.

use super::freedoms::{Freedoms, Spring};
use super::pairs::{ContactSurface, Pair};

/// Number among a node's axes that denotes the overlap of its pair.
const OVERLAP: u8 = 3;

/// Adds the overlaps of soft contacts after all other freedoms. A model in which every
/// displacement is prescribed gets a freedom that moves nothing, so that its state follows from
/// the loads in the same way as that of any other model.
pub(super) fn add(freedoms: &mut Freedoms, pairs: &[Pair], contacts: &[ContactSurface]) {
    for (k, pair) in pairs.iter().enumerate() {
        if let Some(stiffness) = contacts[pair.contact].stiffness {
            freedoms.springs.push(Spring {
                pair: Some(k),
                freedom: freedoms.n,
                stiffness: stiffness * pair.area,
            });
            freedoms.owners.push((pair.slave as u32, OVERLAP));
            freedoms.n += 1;
        }
    }
    if freedoms.n == 0 && pairs.is_empty() {
        freedoms.springs.push(Spring {
            pair: None,
            freedom: 0,
            stiffness: 1.0,
        });
        freedoms.owners.push((0, OVERLAP));
        freedoms.n = 1;
    }
}
