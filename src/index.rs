//! Indices as other programs have them, read where they lie.

use std::fmt::Display;

/// A whole number that may be an index, of any width, signed or not. Arrays of indices are taken as
/// slices of it, so that those of a caller (32 bit in most sparse matrices, 64 bit in most meshes)
/// need not be converted.
pub trait Index: Copy + Display + TryInto<usize> {
    /// The index where it is in `0..n`.
    fn below(self, n: usize) -> Option<usize> {
        self.try_into().ok().filter(|index| *index < n)
    }
}

impl<T: Copy + Display + TryInto<usize>> Index for T {}
