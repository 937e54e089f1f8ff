//! Encoding of numbers in a file: text, or the bytes of the machine that wrote the file.

use super::cursor::Cursor;
use crate::{Error, ErrorKind, Result};

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
    /// Reads what follows the version in `$MeshFormat`: whether the file is binary, the size of a
    /// number, and in a binary file the number one, which shows the byte order.
    ///
    /// # Errors
    /// `Unsupported` for numbers of any size other than eight bytes; `Input` for an unknown file
    /// type, or if the number one cannot be recognised.
    pub(super) fn read(cursor: &mut Cursor, is_version_4: bool) -> Result<Encoding> {
        let at = cursor.at();
        let file_type = cursor.unsigned("the file type")?;
        let size = cursor.unsigned("the size of a number")?;
        cursor.end_line()?;
        match file_type {
            0 => return Ok(Encoding::Text),
            1 if size == 8 => {}
            1 => {
                let place = cursor.error_at(
                    at,
                    format!("binary numbers of {size} bytes; brinell reads those of 8"),
                );
                return Err(Error::new(ErrorKind::Unsupported, place.message()));
            }
            other => {
                let message = format!("the file type is {other}; 0 is text and 1 binary");
                return Err(cursor.error_at(at, message));
            }
        }
        let at = cursor.at();
        let one = i32::from_ne_bytes(cursor.bytes("the number one")?);
        let swapped = match (one, one.swap_bytes()) {
            (1, _) => false,
            (_, 1) => true,
            _ => {
                let message = format!(
                    "the number one, which tells the order of bytes, reads as {one}: is the file \
                     damaged, or was it changed as if it were text?"
                );
                return Err(cursor.error_at(at, message));
            }
        };
        Ok(Encoding::Binary {
            swapped,
            wide: is_version_4,
        })
    }

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
