//! The figures that are read from a state.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `measure` | pressure, half width, arc | 5 |
//! | `contact_edge` | the edge of a plane contact | |
//! | `contact_patch` | a run of closed pairs | |
//! | `contact_area` | patches of contact between solids | |
//! | `reading` | stresses and approach of the current state | |
//! | `dent` | the shape that plastic strains leave in the surfaces | 5.1 |
//! | `approaches` | the approach of the bodies of each contact | |
//! | `reactions` | external force on each node | |
//! | `gauges` | additional columns of the history | |
//! | `quality` | deviation of a state from equilibrium and from its contact conditions | |
//! | `at_target` | figures and fields of the state at a target | |
//! | `deformation` | whether strains and rotations are small | |

mod approaches;
mod at_target;
mod contact_area;
mod contact_edge;
mod contact_patch;
pub(super) mod deformation;
pub(super) mod dent;
pub(super) mod gauges;
pub(super) mod measure;
pub(super) mod quality;
mod reactions;
pub(super) mod reading;
