//! The values of a data line, which are separated by commas.

use crate::error::{Error, Result};

/// Place of a line, for messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Where<'t> {
    pub(super) file: &'t str,
    pub(super) line: u32,
    /// Keyword as written in the deck, without the asterisk.
    pub(super) keyword: &'t str,
}

impl Where<'_> {
    /// An error as `FILE, line N: *KEYWORD: message`.
    pub(super) fn error(&self, message: impl std::fmt::Display) -> Error {
        let Where {
            file,
            line,
            keyword,
        } = self;
        Error::input(format!("{file}, line {line}: *{keyword}: {message}"))
    }
}

/// The values of a line, read one after the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct LineFields<'t> {
    rest: &'t [u8],
    /// Whether the last value was followed by a comma, or no value has been read yet.
    goes_on: bool,
    pub(super) place: Where<'t>,
}

impl<'t> LineFields<'t> {
    pub(super) fn new(line: &'t [u8], place: Where<'t>) -> Self {
        LineFields {
            rest: line,
            goes_on: !line.is_empty(),
            place,
        }
    }

    /// Whether there are no more values. A comma at the end of a line is not followed by a value.
    pub(super) fn is_at_end(&self) -> bool {
        !self.goes_on || self.rest.is_empty()
    }

    /// Whether the line ends with a comma.
    pub(super) fn ends_with_comma(&self) -> bool {
        self.goes_on && self.rest.is_empty()
    }

    /// Reads the next value as written, without blanks and quotes; empty if it is left out.
    pub(super) fn word(&mut self) -> &'t [u8] {
        match self.written() {
            [b'"', inner @ .., b'"'] => inner,
            word => word,
        }
    }

    /// Reads the next value as written, without blanks but with quotes.
    pub(super) fn written(&mut self) -> &'t [u8] {
        let length = comma(self.rest);
        let word = &self.rest[..length.unwrap_or(self.rest.len())];
        self.goes_on = length.is_some();
        self.rest = length.map_or(&[][..], |length| self.rest[length + 1..].trim_ascii_start());
        word.trim_ascii()
    }

    /// The part of the line that has not been read.
    pub(super) fn rest(&self) -> &'t [u8] {
        self.rest
    }

    /// Reads the next value as text.
    pub(super) fn text(&mut self, what: &str) -> Result<String> {
        let word = self.word();
        if word.is_empty() {
            return Err(self.missing(what));
        }
        match std::str::from_utf8(word) {
            Ok(text) => Ok(text.to_string()),
            Err(_) => Err(self.place.error(format!("{what} is not UTF-8 text"))),
        }
    }

    /// Reads the next value, which must be a number.
    #[inline]
    pub(super) fn number(&mut self, what: &str) -> Result<f64> {
        match self.number_or(what, f64::NAN)? {
            number if number.is_nan() => Err(self.missing(what)),
            number => Ok(number),
        }
    }

    /// Reads the next value, a number; returns `default` if it is left out.
    #[inline]
    pub(super) fn number_or(&mut self, what: &str, default: f64) -> Result<f64> {
        if let Some((value, length)) = plain_number(self.rest)
            && self.ends_after(length)
        {
            return Ok(value);
        }
        let word = self.word();
        if word.is_empty() {
            return Ok(default);
        }
        let text = std::str::from_utf8(word).unwrap_or("?");
        // FORTRAN writes exponents of double precision with a D, or without a letter if they have
        // three digits, and reads such numbers.
        let parsed = match text.parse::<f64>() {
            Ok(value) => Some(value),
            Err(_) => (text.replace(['d', 'D'], "e").parse().ok()).or_else(|| {
                let sign = text.get(1..)?.rfind(['+', '-'])? + 1;
                let (digits, power) = text.split_at(sign);
                let is_number = digits.ends_with(|c: char| c.is_ascii_digit() || c == '.');
                is_number.then(|| format!("{digits}e{power}").parse().ok())?
            }),
        };
        parsed.filter(|value| value.is_finite()).ok_or_else(|| {
            let shown = shown(word);
            self.place
                .error(format!("{what} is `{shown}`; give a finite number"))
        })
    }

    /// Reads the next value, which must be a whole number.
    #[inline]
    pub(super) fn label(&mut self, what: &str) -> Result<u64> {
        let digits = self.rest.iter().take_while(|b| b.is_ascii_digit()).count();
        // Up to eighteen digits fit into 64 bits.
        if (1..=18).contains(&digits) {
            let of_digit = |value, b: &u8| 10 * value + u64::from(b - b'0');
            let value = self.rest[..digits].iter().fold(0, of_digit);
            if self.ends_after(digits) {
                return Ok(value);
            }
        }
        let word = self.word();
        if word.is_empty() {
            return Err(self.missing(what));
        }
        let text = std::str::from_utf8(word).unwrap_or("?");
        text.parse().map_err(|_| {
            let shown = shown(word);
            self.place
                .error(format!("{what} is `{shown}`; give a whole number"))
        })
    }

    /// Whether a value of `length` bytes is followed by a comma or the end of the line; skips the
    /// value if so.
    #[inline]
    fn ends_after(&mut self, length: usize) -> bool {
        let mut after = &self.rest[length..];
        while let [b' ' | b'\t', rest @ ..] = after {
            after = rest;
        }
        match after {
            [] => self.goes_on = false,
            [b',', rest @ ..] => {
                after = rest;
                while let [b' ' | b'\t', rest @ ..] = after {
                    after = rest;
                }
                self.goes_on = true;
            }
            _ => return false,
        }
        self.rest = after;
        true
    }

    /// Requires that no value follows, apart from zeros, which cannot change anything.
    pub(super) fn end(&mut self) -> Result<()> {
        while !self.is_at_end() {
            let word = self.word();
            if !word.is_empty() && !is_zero(word) {
                let shown = shown(word);
                return Err(self.place.error(format!(
                    "`{shown}` is one value too many on the line; take it out"
                )));
            }
        }
        Ok(())
    }

    fn missing(&self, what: &str) -> Error {
        self.place
            .error(format!("the line ends where {what} should be; give it"))
    }
}

/// Position of the first comma outside of quotes.
pub(super) fn comma(bytes: &[u8]) -> Option<usize> {
    let first = bytes.iter().position(|&b| b == b',')?;
    if !bytes[..first].contains(&b'"') {
        return Some(first);
    }
    let mut is_quoted = false;
    let found = bytes.iter().position(|&b| {
        is_quoted ^= b == b'"';
        b == b',' && !is_quoted
    });
    // After a quote that is never closed, all commas count.
    if is_quoted { Some(first) } else { found }
}

/// Whether a word is a zero. Several digits without a point may be the end of a number with commas
/// between its thousands.
fn is_zero(word: &[u8]) -> bool {
    plain_number(word) == Some((0.0, word.len())) && (word.len() == 1 || word.contains(&b'.'))
}

/// A word for messages, shortened.
pub(super) fn shown(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    String::from_utf8_lossy(&word[..word.len().min(LONGEST)]).into_owned()
}

/// Powers of ten that a double represents exactly.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Reads a number at the front of some bytes, with its length, provided that its digits and its
/// power of ten are exact doubles. A single operation then rounds once, and the value is the one
/// that the standard library gives (W. D. Clinger, *How to read floating point numbers accurately*,
/// 1990). `None` for all other numbers.
#[inline]
fn plain_number(bytes: &[u8]) -> Option<(f64, usize)> {
    let is_negative = bytes.first() == Some(&b'-');
    let mut at = usize::from(is_negative || bytes.first() == Some(&b'+'));
    let (mut digits, mut n_digits, mut exponent) = (0u64, 0u32, 0i32);
    let mut has_point = false;
    loop {
        match bytes.get(at) {
            Some(&b) if b.is_ascii_digit() => {
                // Wraps beyond 19 digits; such numbers are rejected below.
                digits = digits.wrapping_mul(10).wrapping_add(u64::from(b - b'0'));
                n_digits += 1;
                exponent -= i32::from(has_point);
            }
            Some(b'.') if !has_point => has_point = true,
            _ => break,
        }
        at += 1;
    }
    if n_digits == 0 || n_digits > 19 || digits > 1 << 53 {
        return None;
    }
    if let Some(b'e' | b'E' | b'd' | b'D') = bytes.get(at) {
        let sign = bytes.get(at + 1);
        let start = at + 1 + usize::from(matches!(sign, Some(b'+' | b'-')));
        let power = bytes[start.min(bytes.len())..].iter();
        let power: Digits = power.take_while(|b| b.is_ascii_digit()).take(4).collect();
        if power.length == 0 || power.length > 3 {
            return None;
        }
        exponent += if sign == Some(&b'-') {
            -power.value
        } else {
            power.value
        };
        at = start + power.length;
    }
    let size = match exponent {
        0..=22 => digits as f64 * EXACT_POWERS[exponent as usize],
        -22..0 => digits as f64 / EXACT_POWERS[-exponent as usize],
        _ => return None,
    };
    Some((if is_negative { -size } else { size }, at))
}

/// A whole number of up to four digits.
struct Digits {
    value: i32,
    length: usize,
}

impl<'b> FromIterator<&'b u8> for Digits {
    fn from_iter<I: IntoIterator<Item = &'b u8>>(digits: I) -> Self {
        let none = Digits {
            value: 0,
            length: 0,
        };
        digits.into_iter().fold(none, |so_far, digit| Digits {
            value: 10 * so_far.value + i32::from(digit - b'0'),
            length: so_far.length + 1,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: Where<'static> = Where {
        file: "a.inp",
        line: 7,
        keyword: "NODE",
    };

    /// The fast method and the standard library agree to the last bit.
    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let mut state = 1u64;
        for _ in 0..200_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let bits = f64::from_bits(state);
            let small = (state >> 40) as f64 * 1e-7;
            for value in [bits, small, -small] {
                let value = if value.is_finite() { value } else { 0.5 };
                for text in [
                    format!("{value:?}"),
                    format!("{value:e}"),
                    format!("{value:.6e}"),
                ] {
                    let mut fields = LineFields::new(text.as_bytes(), PLACE);
                    let read = fields.number("a number").unwrap();
                    assert_eq!(
                        read.to_bits(),
                        text.parse::<f64>().unwrap().to_bits(),
                        "{text}"
                    );
                }
            }
        }
    }

    #[test]
    fn values_are_separated_by_commas_and_may_be_left_out() {
        let mut names = LineFields::new(b"\"a, b\", \"c, d", PLACE);
        for word in ["a, b", "\"c", "d"] {
            assert_eq!(names.text("a name").unwrap(), word);
        }
        let mut fields = LineFields::new(b"1.5-2, -2.+101, 3, 0., 0", PLACE);
        assert_eq!(fields.number("x").unwrap(), 0.015);
        assert_eq!(fields.number("x").unwrap(), -2e101);
        assert_eq!(fields.number("x").unwrap(), 3.0);
        fields.end().unwrap();
        for surplus in ["0., 0.5", "000", "1"] {
            let end = LineFields::new(surplus.as_bytes(), PLACE).end();
            assert!(end.is_err(), "{surplus}");
        }
        let mut fields = LineFields::new(b"12, 1.5D+2 ,, -.5 , \"my set\",", PLACE);
        assert_eq!(fields.label("a number").unwrap(), 12);
        assert_eq!(fields.number("x").unwrap(), 150.0);
        assert_eq!(fields.number_or("y", 3.0).unwrap(), 3.0);
        assert_eq!(fields.number("z").unwrap(), -0.5);
        assert_eq!(fields.text("a name").unwrap(), "my set");
        assert!(fields.is_at_end() && fields.ends_with_comma());
        fields.end().unwrap();
        for (line, message) in [
            ("x", "the node is `x`; give a whole number"),
            ("", "the line ends where the node should be; give it"),
            ("1.5", "the node is `1.5`; give a whole number"),
            ("99999999999999999999", "the node is `99999999999999999999`"),
        ] {
            let error = LineFields::new(line.as_bytes(), PLACE).label("the node");
            let error = error.unwrap_err().to_string();
            let start = format!("a.inp, line 7: *NODE: {message}");
            assert!(error.starts_with(&start), "{error}");
        }
        for line in [
            "nan", "inf", "1e999", "1,5e", "--1", "1e", "1-", "+-1", "1--2", "1e-2-3",
        ] {
            let mut fields = LineFields::new(line.as_bytes(), PLACE);
            let first = fields.number("x");
            assert!(first.is_err() || fields.number("y").is_err(), "{line}");
        }
    }
}
