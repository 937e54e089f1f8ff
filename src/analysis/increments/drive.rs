//! Moving along a straight piece of the load path, one increment at a time, until its end, a
//! measured value or first yield.

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
    /// Contact changes alone.
    Elastic(Box<ElasticDrive>),
    /// The material may yield.
    Plastic(PlasticDrive),
}

impl Drive {
    /// The next increment, or the end of the drive. `recovery` is looked at for first yield where
    /// the drive is watched for that.
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

    /// Whether first yield ends it.
    pub fn watches_yield(&self) -> bool {
        matches!(self, Drive::Elastic(drive) if drive.watches_yield)
    }

    /// Fixed increments that were taken on the piece.
    pub fn taken(&self) -> usize {
        match self {
            Drive::Elastic(_) => 0,
            Drive::Plastic(drive) => drive.taken,
        }
    }

    /// The monitored quantity at the last increment.
    pub fn monitored(&self) -> Option<f64> {
        match self {
            Drive::Elastic(drive) => drive.monitored,
            Drive::Plastic(drive) => drive.monitored,
        }
    }
}
