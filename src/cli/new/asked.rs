//! What a new scene asks of its bodies.

/// The load, what the head of the scene states about it, and what the program goes through.
pub(super) struct Asked {
    /// Comment lines of the head.
    pub about: String,
    /// Load whose load factor is 1.
    pub load: f64,
    /// The program, with its comments.
    pub program: String,
}
