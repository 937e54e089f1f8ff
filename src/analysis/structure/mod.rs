//! The factored structure with its loads and its state, and its response to loads.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `factored` | the factored structure, its zone, its loads at factor 1 | 3.7, 3.8 |
//! | `solver` | the structure in its current state | |
//! | `state` | a committed state, to be kept and restored | |
//! | `record` | the structure under load in checkpoints | |
//! | `response` | displacements, gaps and forces for loads and initial loads | 4.2, 4.6, 4.7 |
//! | `equilibrium` | states of equilibrium and changes of state, which may be added | 4.2, 4.4 |
//! | `load_point` | points of the load path | 4.3 |
//! | `driving_force` | the force that drives a prescribed displacement | |
//! | `loose` | bodies that no contact force holds | |
//! | `starting` | the state in the material that an earlier run left, or that this run leaves | |
//! | `flow` | where flow began, and how long increments may be | |
//! | `factored_tangent` | a factor of the tangent | |
//! | `round_off` | bounds on the imbalance of a state | |
//! | `cost` | counts of the work done so far | |

mod cost;
mod driving_force;
pub(super) mod equilibrium;
pub(super) mod factored;
pub(super) mod factored_tangent;
pub(super) mod flow;
pub(super) mod load_point;
pub(super) mod loose;
pub(super) mod record;
mod response;
pub(super) mod round_off;
pub(super) mod solver;
pub(super) mod starting;
pub(super) mod state;
