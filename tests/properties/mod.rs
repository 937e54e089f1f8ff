//! Properties: the complementarity solver on any problem, and states that do not depend on the
//! steps.

mod complementarity;
mod path;
mod steps;
mod targets;
