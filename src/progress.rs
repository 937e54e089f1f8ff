//! Progress reports of a run to its caller. The library never prints: it calls an [`Observer`].

/// Answer of an observer: whether the run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// The run goes on.
    Continue,
    /// Stop after this increment; the results so far are returned, marked as incomplete.
    Stop,
}

/// Receiver of progress reports. Every method has a default that does nothing.
pub trait Observer: Send {
    /// A phase (`"assembly"`, `"factorisation"`, ...) begins.
    fn phase(&mut self, _name: &str) {}
    /// A phase begins whose duration in seconds is roughly known.
    fn phase_of(&mut self, name: &str, _seconds: f64) {
        self.phase(name);
    }
    /// Reports the size of the model for the next phases.
    fn model(&mut self, _freedoms: usize, _contact_pairs: usize) {}
    /// An increment was accepted; `fraction` of the load program is done.
    fn increment(&mut self, _row: &crate::results::HistoryRow, _fraction: f64) -> Flow {
        Flow::Continue
    }
    /// Reports something that the user should know but that does not stop the run.
    fn warning(&mut self, _message: &str) {}
    /// Called between iterations: true stops the run at the last accepted increment.
    fn stop_requested(&self) -> bool {
        false
    }
}

/// An observer that does nothing.
pub struct Silent;
impl Observer for Silent {}
