//! Progress along a straight piece of the load path, increment by increment.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `step` | settings and results of a step of a drive | |
//! | `outcome` | how an increment may end, and the result of the search for one | |
//! | `outgrown` | contact that reaches the end of its candidates | |
//! | `acceptance` | acceptance of increments and changes of contact | |
//! | `yield_load` | the load at first yield | 3.13, 3.14 |
//! | `elastic` | pieces on which contact alone changes | 3.9, 3.10 |
//! | `stretch` | stretches of an elastoplastic drive on which nothing yields | |
//! | `step_length` | the share of an increment that contact allows | 4.8 to 4.16, 4.19 to 4.21 |
//! | `search` | equilibrium and length at once, or one after the other | |
//! | `line_search` | the length of a step along a Newton direction | |
//! | `tangent` | the elastoplastic tangent, solved with the elastic factor | |
//! | `tangent_by_factor` | the tangent, solved with a factor of its own | |
//! | `acceleration` | Anderson's acceleration of the initial loads | |
//! | `prediction` | the rates from which an increment is predicted | 4.5 |
//! | `settling` | contact at the end of an increment whose end is given | 4.8, 4.9 |
//! | `collapse` | limit load, or an iteration that did not converge | |
//! | `increment` | one elastoplastic increment, scaled to the next change of contact | 4.17, 4.18, 4.22, 4.23 |
//! | `stepping` | correction of wrong statuses, and increments that do not converge | |
//! | `landing` | repetition of the last increment, up to the zero of a quantity | |
//! | `plastic` | elastoplastic drives | |
//! | `drive` | a drive of either kind | |

mod acceleration;
mod acceptance;
mod collapse;
pub(super) mod drive;
pub(super) mod elastic;
mod increment;
mod landing;
mod line_search;
mod outcome;
mod outgrown;
pub(super) mod plastic;
mod prediction;
mod search;
mod settling;
pub(super) mod step;
mod step_length;
mod stepping;
mod stretch;
pub(super) mod tangent;
mod tangent_by_factor;
pub(super) mod yield_load;
