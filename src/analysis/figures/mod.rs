//! What is read off a state.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `measure` | pressure, half width, arc | 5 |
//! | `contact_edge` | where a plane contact ends | |
//! | `contact_patch` | a run of closed pairs | |
//! | `contact_area` | patches of contact between solids | |
//! | `reading` | stresses and approach of the current state | |
//! | `dent` | what plastic strains leave of the surfaces | 5.1 |
//! | `approaches` | how far the bodies of each contact have come together | |
//! | `reactions` | what acts on each node from outside | |
//! | `gauges` | what rows of the history have besides | |
//! | `quality` | how far a state is from equilibrium and from its contact conditions | |
//! | `at_target` | figures and fields of the state at a target | |
//! | `deformation` | whether strains and rotations are small | |

mod approaches;
mod at_target;
mod contact_area;
mod contact_edge;
mod contact_patch;
pub(super) mod deformation;
mod dent;
pub(super) mod gauges;
pub(super) mod measure;
pub(super) mod quality;
mod reactions;
mod reading;
