//! Text of others (titles, names, paths, what a file holds), made fit to be shown.

use std::borrow::Cow;
use std::fmt::Write;

/// `text` with each character that a terminal, an SVG or a page would obey instead of showing written out, as `\u{1b}`: control
/// characters but line breaks and tabs, changes of the direction of writing, and what XML forbids.
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    written_out(text, |c, out| {
        let _ = write!(out, "{}", c.escape_unicode());
    })
}

/// As [`shown`] for JSON, whose own form this is: what reads it gets the character back. All such characters lie within 16 bits.
pub(crate) fn shown_json(text: &str) -> Cow<'_, str> {
    written_out(text, |c, out| {
        let _ = write!(out, "\\u{:04x}", u32::from(c));
    })
}

/// A number as it was given, to the last digit, but with an exponent where that is shorter: `1e300` has no 300 zeros.
pub(crate) fn exact(value: f64) -> String {
    let plain = value.to_string();
    let scientific = format!("{value:e}");
    if plain.len() > scientific.len().max(LONGEST_PLAIN) {
        scientific
    } else {
        plain
    }
}

/// Digits that read well without an exponent.
const LONGEST_PLAIN: usize = 12;

fn written_out(text: &str, write: impl Fn(char, &mut String)) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_obeyed(c) {
            write(c, &mut out);
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Whether a character is obeyed and not shown.
fn is_obeyed(c: char) -> bool {
    let is_control = c.is_control() && c != '\n' && c != '\t';
    is_control
        || matches!(
            c,
            '\u{61c}'
                | '\u{200e}'
                | '\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2066}'..='\u{2069}'
                | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}'
                | '\u{fffe}'
                | '\u{ffff}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_written_out() {
        for (text, expected) in [
            ("b* = 2 µm\n\tβ", "b* = 2 µm\n\tβ"),
            ("\u{1b}[31mred", "\\u{1b}[31mred"),
            ("\u{1b}]0;title\u{7}", "\\u{1b}]0;title\\u{7}"),
            ("\u{9b}2J\r", "\\u{9b}2J\\u{d}"),
            ("\u{202e}abc\u{2069}", "\\u{202e}abc\\u{2069}"),
            ("\u{0}\u{7f}\u{ffff}", "\\u{0}\\u{7f}\\u{ffff}"),
        ] {
            assert_eq!(shown(text), expected);
        }
    }

    #[test]
    fn numbers_are_exact_and_short() {
        for (value, text) in [
            (0.0, "0"),
            (210_000.0, "210000"),
            (-0.25, "-0.25"),
            (1e300, "1e300"),
            (-1.5e-300, "-1.5e-300"),
            (0.1 + 0.2, "0.30000000000000004"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(exact(value), text);
        }
    }

    #[test]
    fn json_stays_json_and_means_the_same() {
        let text = "\u{9b}31m\u{7f}\u{202e}";
        let json = serde_json::to_string(text).unwrap();
        let escaped = shown_json(&json);
        assert_eq!(escaped, r#""\u009b31m\u007f\u202e""#);
        assert_eq!(serde_json::from_str::<String>(&escaped).unwrap(), text);
    }
}
