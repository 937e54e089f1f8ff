//! The choice of the elements that may yield in a run.
//!
//! | file | what |
//! |---|---|
//! | `zone_choice` | first guess, prediction from elastic stress, growth |
//! | `zone_fit` | the current zone, and the data from which it is chosen |

pub(super) mod zone_choice;
pub(super) mod zone_fit;
