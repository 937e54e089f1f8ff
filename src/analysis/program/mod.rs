//! The load program: preload, first yield, target after target, with its checkpoints.
//!
//! | file | what | paper |
//! |---|---|---|
//! | `stopwatch` | how the time of a run was spent | |
//! | `cycles` | the flow of each cycle, and whether the next cycle would be like the last | |
//! | `position` | the position of the program between two steps | |
//! | `path` | the path between increments | |
//! | `checkpoints` | the contents of a checkpoint | |
//! | `unloading` | the state that unloading would leave | |
//! | `leg_targets` | the targets of a leg | |
//! | `awaited` | figures that a target waits for | |
//! | `target_search` | the load factor at which a target is met | |
//! | `run` | a structure on its way through the program | 5.1 |
//! | `zone_changes` | the zone follows the load | |
//! | `first_yield` | the load and place of first yield | 3.13, 3.14 |
//! | `targets` | from the current load to the next target | |
//! | `finish` | the results of a run at its end | |
//! | `execution` | the program, event by event | |
//! | `legs` | a program in which supports change | |
//! | `restart` | resuming from a checkpoint | |
//! | `assembled` | a model with its assembled system | 3.1 |
//! | `scout` | the elastic stress from a coarser mesh | |
//! | `entry` | what a caller runs | |

pub(super) mod assembled;
mod awaited;
mod checkpoints;
mod cycles;
mod entry;
mod execution;
mod finish;
mod first_yield;
mod leg_targets;
mod legs;
mod path;
pub(super) mod position;
mod restart;
pub(super) mod run;
mod scout;
mod stopwatch;
mod target_search;
mod targets;
mod unloading;
mod zone_changes;

#[cfg(test)]
mod tests;
