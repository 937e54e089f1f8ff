//! What is known about a run before anything is solved.
//!
//! | file | what |
//! |---|---|
//! | `effects` | effects that a scene calls for, and the cost of a run |
//! | `seconds` | rough time of a run |

pub(super) mod effects;
pub(super) mod seconds;
