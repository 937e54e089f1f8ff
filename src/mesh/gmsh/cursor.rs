//! Reads numbers and words directly from the bytes of a file.

use super::encoding::Encoding;
use crate::{Error, Result};

/// A position in the text of a file.
pub(super) struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
    /// Name of the file, for messages.
    name: &'a str,
    /// The section being read, for messages.
    pub section: &'static str,
    /// Encoding of the numbers in the file.
    encoding: Encoding,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(text: &'a [u8], name: &'a str) -> Self {
        Cursor {
            text,
            at: 0,
            name,
            section: "the file",
            encoding: Encoding::Text,
        }
    }

    /// Sets the encoding of all numbers from here on.
    pub(super) fn set_encoding(&mut self, encoding: Encoding) {
        self.encoding = encoding;
    }

    /// Whether numbers are stored as bytes of the machine that wrote the file.
    pub(super) fn is_binary(&self) -> bool {
        self.encoding != Encoding::Text
    }

    /// Reads a part that is text even in a binary file.
    pub(super) fn in_text<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let encoding = std::mem::replace(&mut self.encoding, Encoding::Text);
        let found = read(self);
        self.encoding = encoding;
        found
    }

    /// Reads the next `N` bytes.
    pub(super) fn bytes<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let Some(bytes) = self.text[self.at..].first_chunk::<N>() else {
            return Err(self.error(format!(
                "the file ends inside {} where {what} should be: is it truncated?",
                self.section
            )));
        };
        self.at += N;
        Ok(*bytes)
    }

    /// Reads the next binary number, of eight bytes if `wide` and otherwise of four, which must not
    /// be negative.
    fn binary(&mut self, what: &str, encoding: Encoding, wide: bool) -> Result<u64> {
        let start = self.at;
        let value = match wide {
            true => i64::from_ne_bytes(encoding.ordered(self.bytes(what)?)),
            false => i64::from(i32::from_ne_bytes(encoding.ordered(self.bytes(what)?))),
        };
        u64::try_from(value)
            .map_err(|_| self.error_at(start, format!("expected {what}, found {value}")))
    }

    /// The current byte offset, for [`Cursor::error_at`].
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Number of bytes not yet read: an upper bound for everything that the rest of the file can
    /// hold.
    pub(super) fn remaining(&self) -> usize {
        self.text.len() - self.at
    }

    /// An error at the current byte offset.
    pub(super) fn error(&self, message: impl std::fmt::Display) -> Error {
        self.error_at(self.at, message)
    }

    /// An error at a byte offset: the file and the line number (for a binary file the byte) precede
    /// the message. Lines are counted only here, so that reading does not pay for it.
    pub(super) fn error_at(&self, at: usize, message: impl std::fmt::Display) -> Error {
        if self.is_binary() {
            return Error::input(format!("{}, byte {at}: {message}", self.name));
        }
        let before = &self.text[..at.min(self.text.len())];
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        Error::input(format!("{}, line {line}: {message}", self.name))
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    /// Skips blanks within the line.
    pub(super) fn skip_blanks(&mut self) {
        while let Some(b' ' | b'\t' | b'\r') = self.peek() {
            self.at += 1;
        }
    }

    /// Skips blanks and line ends.
    pub(super) fn skip_lines(&mut self) {
        while let Some(b' ' | b'\t' | b'\r' | b'\n') = self.peek() {
            self.at += 1;
        }
    }

    /// Whether the end of the text is reached.
    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.text.len()
    }

    /// Whether nothing but blanks is left on the line.
    pub(super) fn is_at_line_end(&mut self) -> bool {
        self.skip_blanks();
        matches!(self.peek(), None | Some(b'\n'))
    }

    /// Returns the rest of the line without trailing blanks, and moves to the next line.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.text[self.at..];
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        rest[..length].trim_ascii_end()
    }

    /// Requires the line to end here and moves to the next; does nothing in a binary file, which
    /// has no lines.
    pub(super) fn end_line(&mut self) -> Result<()> {
        if self.is_binary() {
            return Ok(());
        }
        if !self.is_at_line_end() {
            let word = self.word_ahead();
            return Err(self.error(format!("expected the end of the line, found `{word}`")));
        }
        self.at = (self.at + 1).min(self.text.len());
        Ok(())
    }

    /// The next word of the line, shortened for use in messages.
    fn word_ahead(&self) -> String {
        const LONGEST: usize = 40;
        let rest = &self.text[self.at.min(self.text.len())..];
        let length = rest
            .iter()
            .take(LONGEST)
            .position(|b| b.is_ascii_whitespace())
            .unwrap_or(rest.len().min(LONGEST));
        String::from_utf8_lossy(&rest[..length]).into_owned()
    }

    fn expected(&self, what: &str) -> Error {
        match self.peek() {
            None => self.error(format!(
                "the file ends inside {} where {what} should be: is it truncated?",
                self.section
            )),
            Some(b'\n') => self.error(format!("the line ends where {what} should be")),
            Some(_) => self.error(format!("expected {what}, found `{}`", self.word_ahead())),
        }
    }

    /// Reads the next word of the line.
    fn word(&mut self, what: &str) -> Result<&'a [u8]> {
        self.skip_blanks();
        let rest = &self.text[self.at..];
        let length = rest
            .iter()
            .position(|b| b.is_ascii_whitespace())
            .unwrap_or(rest.len());
        if length == 0 {
            return Err(self.expected(what));
        }
        self.at += length;
        Ok(&rest[..length])
    }

    /// Reads the next number without a sign. In a binary file the number is as wide as the format
    /// version stores numbers of nodes and elements.
    pub(super) fn unsigned(&mut self, what: &str) -> Result<u64> {
        match self.encoding {
            Encoding::Text => self.digits(what),
            binary => self.binary(what, binary, binary.is_wide()),
        }
    }

    /// Reads the next number without a sign; in a binary file it has four bytes.
    pub(super) fn small(&mut self, what: &str) -> Result<u64> {
        match self.encoding {
            Encoding::Text => self.digits(what),
            binary => self.binary(what, binary, false),
        }
    }

    fn digits(&mut self, what: &str) -> Result<u64> {
        self.skip_blanks();
        let start = self.at;
        let mut value: u64 = 0;
        while let Some(digit @ b'0'..=b'9') = self.peek() {
            let next = value
                .checked_mul(10)
                .and_then(|v| v.checked_add(u64::from(digit - b'0')));
            let Some(next) = next else {
                self.at = start;
                return Err(self.error(format!(
                    "{what}: `{}` is too large a number",
                    self.word_ahead()
                )));
            };
            value = next;
            self.at += 1;
        }
        let ended = matches!(self.peek(), None | Some(b' ' | b'\t' | b'\r' | b'\n'));
        if self.at == start || !ended {
            self.at = start;
            return Err(self.expected(what));
        }
        Ok(value)
    }

    /// Reads the next number, with or without a sign; in a binary file it has four bytes.
    pub(super) fn signed(&mut self, what: &str) -> Result<i64> {
        if self.is_binary() {
            let bytes = self.bytes(what)?;
            return Ok(i64::from(i32::from_ne_bytes(self.encoding.ordered(bytes))));
        }
        self.skip_blanks();
        let start = self.at;
        let negative = self.peek() == Some(b'-');
        if negative {
            self.at += 1;
        }
        let value = if matches!(self.peek(), Some(b'0'..=b'9')) {
            i64::try_from(self.digits(what)?).ok()
        } else {
            None
        };
        match value {
            Some(value) => Ok(if negative { -value } else { value }),
            None => {
                self.at = start;
                Err(self.expected(what))
            }
        }
    }

    /// Reads a count, and refuses it if it exceeds the number of bytes left, because the file then
    /// cannot hold what is counted.
    pub(super) fn count(&mut self, what: &str) -> Result<usize> {
        let start = self.at;
        let value = self.unsigned(what)?;
        if value > self.remaining() as u64 {
            return Err(self.error_at(
                start,
                format!(
                    "{what} is {value}, more than the {} bytes left in the file can hold: is it \
                     truncated?",
                    self.remaining()
                ),
            ));
        }
        Ok(value as usize)
    }

    /// Reads the next floating point number.
    pub(super) fn float(&mut self, what: &str) -> Result<f64> {
        if self.is_binary() {
            let bytes = self.bytes(what)?;
            return Ok(f64::from_ne_bytes(self.encoding.ordered(bytes)));
        }
        self.skip_blanks();
        let start = self.at;
        let word = self.word(what)?;
        let value = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        match value {
            Some(value) => Ok(value),
            None => {
                self.at = start;
                Err(self.expected(what))
            }
        }
    }

    /// Reads a name in double quotes.
    pub(super) fn quoted(&mut self, what: &str) -> Result<String> {
        self.skip_blanks();
        let start = self.at;
        let line = self.rest_of_line();
        match line {
            [b'"', name @ .., b'"'] if !name.contains(&b'"') => {
                let Ok(name) = std::str::from_utf8(name) else {
                    return Err(self.error_at(start, format!("{what} is not UTF-8")));
                };
                Ok(name.to_string())
            }
            _ => {
                self.at = start;
                Err(self.expected(&format!("{what} in double quotes")))
            }
        }
    }

    /// Reads the name of the section that begins here, as `$Name`; `None` at the end of the file.
    pub(super) fn section_start(&mut self) -> Result<Option<&'a [u8]>> {
        self.skip_lines();
        if self.is_at_end() {
            return Ok(None);
        }
        if self.peek() != Some(b'$') {
            return Err(self.expected("the beginning of a section, such as $Nodes"));
        }
        let name = self.rest_of_line();
        Ok(Some(name))
    }

    /// Requires the line that ends a section.
    pub(super) fn section_end(&mut self, end: &str) -> Result<()> {
        self.skip_lines();
        let start = self.at;
        if self.rest_of_line() == end.as_bytes() {
            return Ok(());
        }
        self.at = start;
        Err(self.expected(end))
    }

    /// Skips a section that is not needed.
    pub(super) fn skip_section(&mut self, start: &[u8]) -> Result<()> {
        let name = start.strip_prefix(b"$").unwrap_or(start);
        if self.is_binary() {
            // In a binary file line ends are bytes like any others.
            let end = [b"$End", name].concat();
            let mut ahead = self.text[self.at..].windows(end.len());
            if let Some(length) = ahead.position(|bytes| bytes == end) {
                self.at += length;
                self.rest_of_line();
                return Ok(());
            }
            self.at = self.text.len();
        }
        while !self.is_at_end() {
            self.skip_blanks();
            let line = self.rest_of_line();
            if line.strip_prefix(b"$End") == Some(name) {
                return Ok(());
            }
        }
        Err(self.error(format!(
            "the file ends inside {}: is it truncated?",
            String::from_utf8_lossy(start)
        )))
    }
}
