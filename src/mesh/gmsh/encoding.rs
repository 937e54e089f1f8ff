//! How a file writes numbers: as text, or as the bytes of the machine that wrote it.

use super::cursor::Cursor;
use crate::{Error, ErrorKind, Result};

/// Text, or bytes in one of two orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Decimal digits.
    Text,
    /// Bytes; the numbers of nodes and elements have eight in version 4.1 and four in 2.2.
    Binary {
        /// Whether the bytes of a number stand the other way round than here.
        swapped: bool,
        /// Whether numbers of nodes and elements have eight bytes.
        wide: bool,
    },
}

impl Encoding {
    /// Reads what follows the version in `$MeshFormat`: whether the file is binary, the size of a
    /// number, and of a binary file the number one.
    ///
    /// # Errors
    /// Numbers of other sizes than brinell reads; a number one that is none.
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

    /// The bytes of a number in the order of this machine.
    pub(super) fn ordered<const N: usize>(self, mut bytes: [u8; N]) -> [u8; N] {
        if matches!(self, Encoding::Binary { swapped: true, .. }) {
            bytes.reverse();
        }
        bytes
    }
}
