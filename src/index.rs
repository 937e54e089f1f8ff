//! Indices of any width in arrays of other programs, read without a copy.

use std::fmt::Display;

/// A whole number that may be an index, of any width, signed or unsigned. Functions take slices of
/// such numbers, so that a caller's arrays (32 bit in most sparse matrices, 64 bit in most meshes)
/// need not be converted.
pub trait Index: Copy + Display + TryInto<usize> {
    /// Converts to an index if it is in `0..n`.
    fn below(self, n: usize) -> Option<usize> {
        self.try_into().ok().filter(|index| *index < n)
    }
}

impl<T: Copy + Display + TryInto<usize>> Index for T {}
