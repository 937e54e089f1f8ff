//! What is known before anything is solved.
//!
//! | file | what |
//! |---|---|
//! | `effects` | effects that a scene calls for, and what a run costs |
//! | `seconds` | how long it takes |

pub(super) mod effects;
pub(super) mod seconds;
