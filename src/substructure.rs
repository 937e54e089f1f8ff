//! Substructure.
