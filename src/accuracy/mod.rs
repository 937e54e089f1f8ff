//! What the digits are worth and what they cost: every number with its error, every error with its price.
//!
//! | file | what |
//! |---|---|
//! | `refinement` | the same scene on a finer or coarser mesh of its family |
//! | `quantities` | the quantities a run reports |
//! | `extrapolation` | the error of a value from those on other meshes |
//! | `estimate` | discretisation, path and algebraic error of every quantity of a run |
//! | `path` | the error of increments and tolerances |
//! | `limit`, `consistent` | the values that the meshes of a demand lead to, better than those on any of them; what goes with them |
//! | `demand`, `outcome` | the cheapest settings that reach a demanded accuracy; what a trial says |
//! | `refusal`, `stall` | what is beyond the memory or round-off; what refinement does not bring nearer |
//! | `ladder`, `edge` | the meshes on the way to a demand; where in an element a contact ends on them |
//! | `grading`, `pilot` | resolution where it counts: which part of a mesh the errors come from |
//! | `knobs`, `meter`, `study`, `verdict` | a study: what to turn, what it takes, the runs, what they say |
//!
//! Three errors stand beside each other:
//!
//! - **discretisation**: the scene is run again on two other meshes of its family and each quantity extrapolated
//!   ([`extrapolate`]): with elements 2 and 8/3 times as large; where the mesh is coarse itself, with elements 3/2 and 2/3
//!   or 2/3 and 1/2 times as large, because what is coarser than coarse tells nothing; with fewer than 8 over what governs (and a small mesh from a file), it is compared with
//!   where meshes twice and three times (two and four times) as fine lead to, because it tells nothing itself. The difference is that of
//!   the quantity itself: contact edges, yielding and the way there are in it. The energy norm of the recovered
//!   stress error ([`crate::results::State::energy_error`], per element in the VTU files) says *where* the mesh is too coarse; it
//!   stands in as a rough figure where a mesh from a file is too large to be subdivided in passing.
//!   The stated error takes the estimate [`SAFETY`] times, [`SAFETY_OF_LAW`] times where three meshes follow a power law or finer ones alone say it; two meshes state three times
//!   the error of the order of their elements, or 1.25 times that of first order.
//! - **path**: the coarsest mesh that flows as the run does is run with twice the increments, and with other tolerances of the plastic iteration
//!   and of contact events (a mesh from a file without such companions with half the increments); see `path`.
//! - **algebraic**: backward error, equilibrium and complementarity of the state, relative to the largest size of the quantity; at first yield what `gamma`
//!   leaves of the largest stress, too.
//!
//! # Why the goal is extrapolated, and not weighted with a dual solution
//!
//! With the factor at hand the influence function `z` of a goal (of the von Mises stress recovered at the place of first yield, of the largest
//! contact pressure; closed pairs held, open ones free) costs one solve, and the error of the goal is about the sum over elements of the energy
//! product of `sigma* - sigma_h` with the same difference for `z`, `sigma*` the recovered stress of `energy_error` (dual-weighted residuals: R.
//! Becker, R. Rannacher, Acta Numerica 10 (2001) 1-102, doi:10.1017/S0962492901000010). That was built and measured, estimated over true error with
//! 4 to 32 linear elements over what governs, to be compared with 0.5 to 2 of the extrapolation:
//!
//! | | yield load | largest pressure |
//! |---|---|---|
//! | Hertz line | 3.0 falling to 2.0 | 3.8 rising to 19 (`quad8`: -0.15 to 0.01) |
//! | Hertz point | -6, 20, falling to 4.6 | 1.7, 0.5, rising to 0.7 (`quad8`: -0.3 to 0.1) |
//! | thick cylinder | 0.2 rising to 7 (`tri6`: -1.9 to 0.8) | |
//!
//! Both goals are as local as the mesh allows, so their influence functions are singular on its scale and no recovery gets near them. The products
//! cancel: in absolute value they sum up to 10 to 44 times the error of the yield load on Hertz' line and 29 to 86 times on his point, so that
//! an element's share tells little of where that error comes from. And part of the error is in the goal itself: the fit of the stress, the pressure averaged
//! over a node's share of the surface, the contact's end between two nodes change with the mesh and are in no product. The extrapolation sees
//! them all; where refinement pays for a goal is measured by coarsening a part of the mesh (`grading`).

mod consistent;
mod demand;
mod edge;
mod estimate;
mod extrapolation;
mod grading;
mod knobs;
mod ladder;
mod limit;
mod meter;
mod outcome;
mod path;
mod pilot;
mod quantities;
mod refinement;
mod refusal;
mod stall;
mod study;
mod verdict;

pub use crate::memory::available as available_memory;
pub use demand::{Reached, reach};
pub use estimate::{Extent, SAFETY, SAFETY_OF_LAW, estimate};
pub use extrapolation::{Extrapolation, extrapolate};
pub use knobs::{Knob, Setting, settings};
pub use meter::{Forecast, Meter, Pace, PhaseUsage, Usage, forecast, work};
pub use quantities::{Quantity, quantities, value_of};
pub use refinement::{Level, coarser, companions, largest_order, refined};
pub use study::{Grading, Plan, Study, StudyRun, study};
pub use verdict::{Price, QuantityStudy, StudyReference, foremost, judge};
