//! The stresses of a state: their values at points, their recovery in between, and their error.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `stress_field` | the stresses of an element | 3.11 |
//! | `recovery` | stress between superconvergent points, and its maximum | 3.11 to 3.13 |
//! | `maximum` | the highest point of a smooth function | |
//! | `patch_fit` | the weighted polynomial around an element | |
//! | `patch` | recovered stresses around a point | |
//! | `fitted` | strains of linear triangles and tetrahedra | |
//! | `layers` | samples across a body that is one element thick | |
//! | `neighbours` | elements that share a node | |
//! | `element_stresses` | nodal forces and fields from the stresses of elements | |
//! | `at_corners` | corner values of a field known at integration points | |
//! | `stresses` | the forces that stresses exert, and the extent of yielding | |
//! | `point_values` | stresses and strains at integration points, for results | |
//! | `piece` | the stresses of a state, computed by all ranks | |
//! | `indicator` | the estimated error of stresses, element by element | |

mod at_corners;
pub(super) mod element_stresses;
mod fitted;
mod indicator;
mod layers;
mod maximum;
mod neighbours;
mod patch;
pub(super) mod patch_fit;
pub(super) mod piece;
mod point_values;
pub(super) mod recovery;
pub(super) mod stress_field;
pub(super) mod stresses;
