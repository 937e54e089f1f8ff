//! What the digits are worth and what they cost: every number with its error, every error with its price.
//!
//! | file | what |
//! |---|---|
//! | `refinement` | the same scene on a finer or coarser mesh of its family |
//! | `quantities` | the quantities a run reports |
//! | `extrapolation` | the error of a value from those on other meshes |
//! | `estimate` | discretisation, path and algebraic error of every quantity of a run |
//! | `path` | the error of increments and tolerances |
//! | `demand`, `refusal` | the cheapest settings that reach a demanded accuracy; what cannot be reached |
//! | `ladder` | the meshes on the way to a demand |
//! | `grading`, `pilot` | resolution where it counts: which part of a mesh the errors come from |
//! | `knobs`, `meter`, `study`, `verdict` | a study: what to turn, what it takes, the runs, what they say |
//!
//! Three errors stand beside each other:
//!
//! - **discretisation**: the scene is run again on two other meshes of its family and each quantity extrapolated
//!   ([`extrapolate`]): with elements 2 and 8/3 times as large; where the mesh is coarse itself, with elements 3/2 and 2/3
//!   or 2/3 and 1/2 times as large, because what is coarser than coarse tells nothing. The difference is that of
//!   the quantity itself: contact edges, yielding and the way there are in it. The energy norm of the recovered
//!   stress error ([`crate::results::State::energy_error`], per element in the VTU files) says *where* the mesh is too coarse; it
//!   stands in as a rough figure where a mesh from a file is too large to be subdivided in passing.
//!   The stated error takes the estimate [`SAFETY`] times, [`SAFETY_OF_LAW`] times where three meshes follow a power law.
//! - **path**: the coarsest of these meshes is run with twice the increments, and with other tolerances of the plastic iteration
//!   and of contact events; see `path`.
//! - **algebraic**: backward error, equilibrium and complementarity of the state, relative to the largest size of the quantity.

mod demand;
mod estimate;
mod extrapolation;
mod grading;
mod knobs;
mod ladder;
mod meter;
mod path;
mod pilot;
mod quantities;
mod refinement;
mod refusal;
mod study;
mod verdict;

pub use demand::{Reached, reach};
pub use estimate::{Extent, SAFETY, SAFETY_OF_LAW, estimate};
pub use extrapolation::{Extrapolation, extrapolate};
pub use knobs::{Knob, Setting, settings};
pub use meter::{Forecast, Meter, Pace, PhaseUsage, Usage, available_memory, forecast, work};
pub use quantities::{Quantity, quantities, value_of};
pub use refinement::{Level, coarser, companions, largest_order, refined};
pub use study::{Grading, Plan, Study, StudyRun, study};
pub use verdict::{Price, QuantityStudy, StudyReference, foremost, judge};
