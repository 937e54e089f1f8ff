//! The elements that may yield: what is known of their points, and their initial loads.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `elements` | the zone of a model of either dimension | 4.1 |
//! | `points` | the points: strains, flow rule, initial loads | 4.1 |
//! | `softening` | what flow takes off the stiffness of elements | |
//! | `history` | what the points went through | |
//! | `yielding` | which points yielded last, for checkpoints | |
//! | `gather` | where elements find displacements and leave forces | |
//! | `free_strain` | strains of temperature and such as bodies bring along | |
//! | `local_yield` | yield stresses from place to place, and how near stresses come | 3.11, 3.12 |
//! | `border` | how finely the size of what has yielded is measured | |
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
pub(super) mod yielding;
