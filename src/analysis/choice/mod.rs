//! Which elements may yield in a run.
//!
//! | file | what |
//! |---|---|
//! | `zone_choice` | first guess, prediction from elastic stress, growth |
//! | `zone_fit` | the zone at hand, and what it is chosen by |

pub(super) mod zone_choice;
pub(super) mod zone_fit;
