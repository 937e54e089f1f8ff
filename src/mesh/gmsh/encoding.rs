//! Encoding of numbers in a file: text, or the bytes of the machine that wrote the file.

/// Text, or binary numbers in one of two byte orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Numbers written as decimal digits.
    Text,
    /// Numbers written as bytes; numbers of nodes and elements have eight bytes in version 4.1 and
    /// four in 2.2.
    Binary {
        /// Whether the byte order is the reverse of this machine's.
        swapped: bool,
        /// Whether numbers of nodes and elements have eight bytes.
        wide: bool,
    },
}

impl Encoding {
    /// Whether numbers of nodes and elements have eight bytes.
    pub(super) fn is_wide(self) -> bool {
        matches!(self, Encoding::Binary { wide: true, .. })
    }

    /// Returns the bytes of a number in the byte order of this machine.
    pub(super) fn ordered<const N: usize>(self, mut bytes: [u8; N]) -> [u8; N] {
        if matches!(self, Encoding::Binary { swapped: true, .. }) {
            bytes.reverse();
        }
        bytes
    }
}
