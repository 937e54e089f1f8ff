//! The elements that may yield: the state of their Gauss points, and the initial loads.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `elements` | the zone of a model of either dimension | 4.1 |
//! | `points` | the points: strains, flow rule, initial loads | 4.1 |
//! | `trial_points` | the points of an element at the state that is evaluated | |
//! | `softening` | the part of the elements' stiffness lost to plastic flow | |
//! | `history` | plastic history of the points | |
//! | `yielding` | which points yielded last, for checkpoints | |
//! | `gather` | where elements find displacements and leave forces | |
//! | `free_strain` | free strains: of temperature, and those that bodies bring along | |
//! | `local_yield` | yield stresses that vary within a body, and the ratio of stress to yield stress | 3.11, 3.12 |
//! | `border` | how finely the mesh resolves the size of the yielded zone | |
//! | `packed` | compact forms for checkpoints | |
//! | `region` | the surroundings of a contact in which yielding is looked for | |

pub(super) mod border;
pub(super) mod elements;
pub(super) mod free_strain;
pub(super) mod gather;
pub(super) mod history;
pub(super) mod local_yield;
pub(super) mod packed;
pub(super) mod points;
pub(super) mod region;
mod softening;
mod trial_points;
pub(super) mod yielding;
