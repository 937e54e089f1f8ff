//! How wrong the figures of a run may be, and what accuracy costs.
//!
//! | file | what |
//! |---|---|
//! | `companions` | the same scene on other meshes of its family ([`crate::mesh::generate::Family`]) |
//! | `quantities` | the quantities that a run reports |
//! | `extrapolation` | the uncertainty of a value from those on other meshes |
//! | `path` | the error of increments and tolerances |
//! | `runs`, `estimate` | runs, each made once; discretisation, path and algebraic error of every quantity |
//! | `effort`, `next_digit` | what an estimate may take; what a tenth of the error would |
//! | `demand`, `outcome`, `graded` | finer and finer meshes until a demanded accuracy is reached; what a mesh states about it; smaller elements around contacts |
//! | `knobs`, `meter`, `record`, `study` | a study: what to turn, what a run takes, the runs |
//! | `verdict`, `advice` | what the runs of a study show, and the same in words |
//!
//! The stated error is the sum of three:
//!
//! - **discretisation**: the scene is run again on two other meshes of its family, with elements
//!   3/2 and twice as large if the run resolves its contacts well enough for that, otherwise finer
//!   ones; the uncertainty follows from how each quantity changes (L. Eca, M. Hoekstra 2014, see
//!   [`extrapolate`]). The quantities themselves are compared, so the estimate includes contact
//!   edges, yielding and the path to the state. A half width also has an error of its reading,
//!   found on each run by reading the same pressures in another way
//!   ([`crate::results::EdgeReading`]). The energy norm of the recovered stress error
//!   ([`crate::results::State::energy_error`], per element in the VTU files) shows *where* the mesh
//!   is too coarse.
//! - **path**: the coarsest mesh on which everything yields that yields in the run is run with
//!   other tolerances and with twice the increments (half of them in a quick estimate).
//! - **algebraic**: backward error, equilibrium and complementarity of the state, relative to the
//!   largest size of the quantity; at first yield also the part of the largest stress that `gamma`
//!   leaves.
//!
//! Nothing here knows a generator, a closed form or a benchmark: a mesh from a file is judged by
//! its subdivisions in the same way. A goal-oriented estimate (dual-weighted residuals) was built
//! and measured before. Its products cancel for pressure and stress at a point, which are too
//! local, and none of them contains the reading of a contact's edge.

mod advice;
mod companions;
mod demand;
mod effort;
mod estimate;
mod extrapolation;
mod graded;
mod knobs;
mod meter;
mod next_digit;
mod outcome;
mod path;
mod quantities;
mod quantity_study;
mod record;
mod runs;
mod study;
mod unresolved;
mod verdict;

pub use crate::memory::available as available_memory;
pub use companions::{Companions, Level, companions, member, planned};
pub use demand::{Reached, reach};
pub use effort::Effort;
pub use estimate::estimate;
pub use extrapolation::{Extrapolation, extrapolate};
pub use knobs::{Knob, Setting, settings};
pub use meter::{Forecast, Meter, Pace, Usage, forecast, work};
pub use next_digit::{NextDigit, for_a_tenth};
pub use quantities::{Quantity, quantities, value_of};
pub use quantity_study::{Price, QuantityStudy, StudyReference};
pub use record::StudyRun;
pub use runs::Extent;
pub use study::{Plan, Study, study};
pub use verdict::{assess, foremost};
