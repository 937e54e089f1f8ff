//! What a run reports to its caller while it works. The library never prints: it calls an
//! [`Observer`].

/// Whether the run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// The run goes on.
    Continue,
    /// Stop after this increment; what was computed so far is returned, marked as incomplete.
    Stop,
}

/// Receives progress. Every method has a default that does nothing.
pub trait Observer: Send {
    /// A phase (`"assembly"`, `"factorisation"`, ...) begins.
    fn phase(&mut self, _name: &str) {}
    /// A phase begins whose time is known, roughly.
    fn phase_of(&mut self, name: &str, _seconds: f64) {
        self.phase(name);
    }
    /// The size of the model that the next phases are about.
    fn model(&mut self, _freedoms: usize, _contact_pairs: usize) {}
    /// An increment was accepted. `fraction` of the load program lies behind.
    fn increment(&mut self, _row: &crate::results::HistoryRow, _fraction: f64) -> Flow {
        Flow::Continue
    }
    /// Something the user should know but that does not stop the run.
    fn warning(&mut self, _message: &str) {}
    /// Asked between iterations: true stops the run at the last accepted increment.
    fn stop_requested(&self) -> bool {
        false
    }
}

/// The observer that does nothing.
pub struct Silent;
impl Observer for Silent {}
