//! The analysis: yield load, then the load program, increment by increment.
//!
//! The analysis has eight modules (rooms), listed here from the bottom up. Each imports only from
//! modules above it in this table, and no two files use each other; a test checks both. The
//! documentation of each module lists its files.
//!
//! | room | what | paper |
//! |---|---|---|
//! | `zone` | elements that may yield, their points and initial loads | 4.1 |
//! | `structure` | the factored structure and its response to loads | 3.7, 3.8, 4.1 to 4.7 |
//! | `stress` | stresses of a state, their recovery between points, their error | 3.11, 3.12 |
//! | `figures` | what is read off a state: contact, dent, forces, quality | 5 |
//! | `choice` | which elements may yield in a run | |
//! | `increments` | along a straight piece of the load path: first yield, elastic and elastoplastic increments | 3.9 to 3.14, 4.3 to 4.23 |
//! | `check` | effects, cost and time before a run | |
//! | `program` | the load program step by step, its checkpoints, and what a caller runs | 5.1, 5.2 |

mod zone;

mod structure;

mod stress;

mod figures;

mod choice;

mod increments;

mod check;

mod program;

pub use check::effects::{Check, check};
pub(crate) use check::seconds::RunSize;
pub use program::assembled::Analysis;
pub use stress::piece::evaluate;
pub(crate) use stress::recovery::left_of_search;
