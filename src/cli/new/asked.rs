//! The loads and the program of a new scene.

/// The load, the comment on it at the head of the scene, and the load program.
pub(super) struct Asked {
    /// Comment lines at the head of the scene.
    pub about: String,
    /// Load at load factor 1.
    pub load: f64,
    /// The program, with its comments.
    pub program: String,
}
