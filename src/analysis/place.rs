//! Where a run is on its way, as data: a run that goes on takes each routine's part of it in place
//! of its begin.

use super::drive::IncrementReport;
use super::elastic::{ElasticPiece, Following};
use super::engine::Engine;
use crate::error::Result;
use serde::{Deserialize, Serialize};

/// What a drive tells its caller.
pub trait Watcher {
    /// An increment was accepted; false stops the drive.
    ///
    /// # Errors
    /// Ends the drive.
    fn increment(&mut self, engine: &mut Engine, report: &IncrementReport) -> Result<bool>;

    /// The drive may go on from here in another process: all that it depends on is the engine and
    /// what `leg` returns.
    ///
    /// # Errors
    /// Ends the drive.
    fn resumable(&mut self, _engine: &Engine, _leg: &dyn Fn() -> Leg) -> Result<()> {
        Ok(())
    }
}

impl<F: FnMut(&mut Engine, &IncrementReport) -> Result<bool>> Watcher for F {
    fn increment(&mut self, engine: &mut Engine, report: &IncrementReport) -> Result<bool> {
        self(engine, report)
    }
}

/// Where a drive is between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum Leg {
    /// On an elastic drive.
    Elastic {
        /// The piece with its contact path.
        piece: Box<ElasticPiece>,
        /// What the monitor said last.
        watched: Option<f64>,
    },
    /// On an elastoplastic drive.
    Plastic(PlasticLeg),
}

/// Where an elastoplastic drive is between two increments.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PlasticLeg {
    /// Distance to the end at the begin.
    pub whole: f64,
    /// Distance that the next increment is trusted with.
    pub trust: f64,
    /// What the monitor said last.
    pub watched: Option<f64>,
    /// Where it follows a stretch on which nothing flows.
    pub following: Option<Box<Following>>,
}

/// A search for a load factor at which a quantity has its target value.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Search {
    /// Load factor that the way at hand leads to.
    pub end: f64,
    /// Ways taken so far.
    pub rounds: usize,
    /// Whether the load factor grows.
    pub upward: bool,
    /// Size that the quantity is measured against.
    pub scale: f64,
}

/// Where a run is between two increments, apart from its engine.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Place {
    /// Whether constant loads are still being applied.
    pub preload: bool,
    /// Zones that were tried for the target at hand.
    pub attempt: usize,
    /// The search for the target at hand, where it is one.
    pub search: Option<Search>,
    /// Ends of the straight pieces ahead, that of the piece at hand first.
    pub stops: Vec<f64>,
    /// The drive along that piece.
    pub drive: Option<DrivePlace>,
}

/// Where a drive is.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct DrivePlace {
    /// Whether it is watched for first yield.
    pub watch_yield: bool,
    /// Fixed increments taken.
    pub taken: usize,
    /// Between which increments.
    pub leg: Leg,
}
