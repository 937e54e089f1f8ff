//! State of a structure under a load, and the piece of a load path that starts there.

use crate::contact::Path;
use nalgebra::DVector;
use std::sync::Arc;

/// Load of a state with its gaps and forces.
#[derive(Clone)]
pub(super) struct LoadedState {
    pub(super) load: Vec<f64>,
    /// Load condensed on the contact freedoms.
    pub(super) condensed: DVector<f64>,
    pub(super) gap: Arc<Vec<f64>>,
    pub(super) force: Arc<Vec<f64>>,
}

/// A piece of the load path, with the state at its start.
pub(super) struct Way {
    pub(super) path: Path,
    pub(super) start: LoadedState,
    pub(super) rate: Vec<f64>,
    pub(super) condensed_rate: DVector<f64>,
    /// Whether the path stands at an event whose statuses have not been settled yet.
    pub(super) at_event: bool,
}
