//! Soft contact: the overlap of each pair as a freedom of its own.
//!
//! ```text
//!     s_j = u_slave . n - sum_k w_k u_k . n - e_j <= delta_j,     e_j = r_j / (k A_j)
//! ```
//!
//! With `e_j` the condition on gap and force is `g_j + r_j / (k A_j) >= 0`. The freedom belongs to
//! no node and has the stiffness `k A_j` alone, so that for all later steps soft contact is hard
//! contact on springs.

use super::freedoms::Freedoms;
use super::pairs::{ContactSurface, Pair};

/// Overlap of a pair, as a freedom with a stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Number of the pair; `None` for the dummy freedom of a model without any other.
    pub pair: Option<usize>,
    /// Free freedom of the overlap.
    pub freedom: usize,
    /// Stiffness `k A`, as force over overlap.
    pub stiffness: f64,
}

/// Number among a node's axes that denotes the overlap of its pair.
const OVERLAP: u8 = 3;

impl Freedoms {
    /// Adds the overlaps of soft contacts after all other freedoms. A model in which every
    /// displacement is prescribed gets a freedom that moves nothing, so that its state follows from
    /// the loads in the same way as that of any other model.
    pub(super) fn add_springs(&mut self, pairs: &[Pair], contacts: &[ContactSurface]) {
        for (k, pair) in pairs.iter().enumerate() {
            if let Some(stiffness) = contacts[pair.contact].stiffness {
                self.springs.push(Spring {
                    pair: Some(k),
                    freedom: self.n,
                    stiffness: stiffness * pair.area,
                });
                self.owners.push((pair.slave as u32, OVERLAP));
                self.n += 1;
            }
        }
        if self.n == 0 && pairs.is_empty() {
            self.springs.push(Spring {
                pair: None,
                freedom: 0,
                stiffness: 1.0,
            });
            self.owners.push((0, OVERLAP));
            self.n = 1;
        }
    }
}
