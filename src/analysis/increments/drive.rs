//! Moves along a straight piece of the load path, one increment at a time, until the end of the
//! piece, a value of a measured quantity, or first yield.

use super::elastic::ElasticDrive;
use super::plastic::PlasticDrive;
use super::step::{Monitor, Rules, Step};
use crate::analysis::stress::recovery::Recovery;
use crate::analysis::structure::load_point::LoadPoint;
use crate::analysis::structure::solver::Solver;
use crate::error::Result;
use serde::{Deserialize, Serialize};

/// A drive along a straight piece of the load path, between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum Drive {
    /// Drive on which only contact changes.
    Elastic(Box<ElasticDrive>),
    /// Drive on which the material may yield.
    Plastic(PlasticDrive),
}

impl Drive {
    /// Takes the next increment, or reports the end of the drive. `recovery` is used if the drive
    /// is watched for first yield.
    ///
    /// # Errors
    /// Errors of [`ElasticDrive::step`] and [`PlasticDrive::step`].
    pub fn step(
        &mut self,
        solver: &mut Solver,
        end: &LoadPoint,
        recovery: Option<&mut Recovery>,
        monitor: Option<&Monitor>,
        rules: Rules,
    ) -> Result<Step> {
        match self {
            Drive::Elastic(drive) => drive.step(solver, end, recovery, monitor),
            Drive::Plastic(drive) => drive.step(solver, end, monitor, rules),
        }
    }

    /// Whether first yield ends the drive.
    pub fn watches_yield(&self) -> bool {
        matches!(self, Drive::Elastic(drive) if drive.watches_yield)
    }

    /// Number of fixed increments taken on the piece so far.
    pub fn taken(&self) -> usize {
        match self {
            Drive::Elastic(_) => 0,
            Drive::Plastic(drive) => drive.taken,
        }
    }

    /// The monitored quantity at the end of the last increment.
    pub fn monitored(&self) -> Option<f64> {
        match self {
            Drive::Elastic(drive) => drive.monitored,
            Drive::Plastic(drive) => drive.monitored,
        }
    }
}
