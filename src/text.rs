//! Makes foreign text (titles, names, paths, contents of files) fit to be shown.

use std::borrow::Cow;
use std::fmt::Write;

/// Escapes each character of `text` that a terminal, an SVG or a page would obey or hide, as
/// `\u{1b}`: control characters except line breaks and tabs, changes of writing direction,
/// characters of no width, and characters that XML forbids. Long numbers are shortened ([`short`]).
#[cfg(feature = "report")]
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    match written_out(text, is_obeyed, escape) {
        Cow::Borrowed(text) => short(text),
        Cow::Owned(text) => Cow::Owned(short(&text).into_owned()),
    }
}

/// Escapes as [`shown`] does, for a name or title of one line: line breaks and tabs are escaped
/// too. Numbers are not shortened.
pub(crate) fn shown_in_line(text: &str) -> Cow<'_, str> {
    written_out(text, |c| is_obeyed(c) || matches!(c, '\n' | '\t'), escape)
}

/// Escapes as [`shown`] does, in the notation of JSON, so that a reader of the JSON text gets the
/// characters back. Numbers are not shortened.
#[cfg(feature = "cli")]
pub(crate) fn shown_json(text: &str) -> Cow<'_, str> {
    written_out(text, is_obeyed, |c, out| {
        for unit in c.encode_utf16(&mut [0; 2]) {
            let _ = write!(out, "\\u{unit:04x}");
        }
    })
}

/// Shortens numbers in `text` that were written with very many digits, as messages of other
/// libraries do, to the form of [`crate::number::exact`]. Text that only resembles such a number (a
/// file name) stays: its digits are not those of a floating-point number.
pub(crate) fn short(text: &str) -> Cow<'_, str> {
    let belongs = |b: u8| b.is_ascii_alphanumeric() || b == b'.' || b == b'_';
    let mut out = String::new();
    let (mut copied, mut from) = (0, 0);
    for word in text.as_bytes().chunk_by(|a, b| belongs(*a) == belongs(*b)) {
        let range = from..from + word.len();
        from = range.end;
        // A trailing dot may end the sentence.
        let digits = text[range.clone()].trim_end_matches('.');
        if let Some(shorter) = shortened(digits) {
            out.push_str(&text[copied..range.start]);
            out.push_str(&shorter);
            copied = range.start + digits.len();
        }
    }
    if copied == 0 {
        return Cow::Borrowed(text);
    }
    out.push_str(&text[copied..]);
    Cow::Owned(out)
}

/// Converts a number of many digits to exponent form; `None` if `digits` is not such a number.
fn shortened(digits: &str) -> Option<String> {
    let is_digit = |b: u8| b.is_ascii_digit() || b == b'.';
    if digits.len() <= MOST_DIGITS || !digits.bytes().all(is_digit) {
        return None;
    }
    let value: f64 = digits
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite())?;
    let decimals = digits
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    let written = format!("{value:.decimals$}") == digits || format!("{value:?}") == digits;
    (written || whole_part(digits) == value.to_string()).then(|| format!("{value:e}"))
}

/// Removes a fraction of zero (`.0`) from the digits of a number.
fn whole_part(digits: &str) -> &str {
    digits.strip_suffix(".0").unwrap_or(digits)
}

/// Number of characters of the longest number between 1e-4 and 1e16 with all its digits. Longer
/// numbers contain zeros or digits that no floating-point number has.
const MOST_DIGITS: usize = 22;

fn escape(c: char, out: &mut String) {
    let _ = write!(out, "{}", c.escape_unicode());
}

fn written_out(
    text: &str,
    is_obeyed: impl Fn(char) -> bool,
    write: impl Fn(char, &mut String),
) -> Cow<'_, str> {
    if !text.contains(&is_obeyed) {
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

/// Whether a character is obeyed or hidden instead of shown: all characters that the standard
/// library does not count as printable, except spaces with a width.
fn is_obeyed(c: char) -> bool {
    if c.is_ascii() {
        return c.is_ascii_control() && c != '\n' && c != '\t';
    }
    match c {
        '\u{2028}' | '\u{2029}' => true,
        space if space.is_whitespace() && !space.is_control() => false,
        // Combining accents are printable if a character stands before them.
        _ => {
            let mut text = String::from("a");
            text.push(c);
            text.escape_debug().nth(2).is_some()
        }
    }
}

#[cfg(all(test, feature = "cli"))]
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
            ("no\u{200b}width\u{2060}", "no\\u{200b}width\\u{2060}"),
            ("soft\u{ad}hyphen\u{e0041}", "soft\\u{ad}hyphen\\u{e0041}"),
            ("\u{2028}\u{85}", "\\u{2028}\\u{85}"),
            // Letters, accents, spaces and pictographs of all kinds.
            (
                "e\u{301} \u{a0}\u{202f}\u{3000}\u{1f600} \u{4e2d}",
                "e\u{301} \u{a0}\u{202f}\u{3000}\u{1f600} \u{4e2d}",
            ),
        ] {
            assert_eq!(shown(text), expected);
        }
    }

    #[test]
    fn names_stay_in_their_line() {
        assert_eq!(shown_in_line("a\nb\t\u{200b}c"), "a\\u{a}b\\u{9}\\u{200b}c");
        assert!(matches!(shown_in_line("größe Ω"), Cow::Borrowed(_)));
    }

    /// Numbers as `toml` and `{}` write them, within sentences.
    #[test]
    fn numbers_of_many_digits_are_shortened_wherever_they_stand() {
        for (value, exponent) in [
            (1e300, "1e300"),
            (3.5e-200, "3.5e-200"),
            (5f64.powi(60), "8.673617379884035e41"),
            (1.0 / 3.0 * 1e25, "3.3333333333333333e24"),
        ] {
            for (text, expected) in [
                (
                    format!("number `{value}`, expected"),
                    format!("number `{exponent}`, expected"),
                ),
                (format!("-{value}."), format!("-{exponent}.")),
                (
                    format!("[{value}, {value}]"),
                    format!("[{exponent}, {exponent}]"),
                ),
            ] {
                assert_eq!(short(&text), expected);
            }
        }
        assert_eq!(
            short(&format!("`{:?}`, {:.1}", 1e20, 1e200)),
            "`1e20`, 1e200"
        );
        assert_eq!(short(&format!("{}.0 {:.9}", 1e300, 2e40)), "1e300 2e40");
        for kept in [
            "20261123055350000000000000000001.msh",
            "20261123055350000000000000000001 20261123055350000000000000000001",
            "v1000000000000000000000000000000000000000000000000",
            "0.30000000000000004 1.2.3 12345678901234567890",
        ] {
            assert!(matches!(short(kept), Cow::Borrowed(_)), "{kept}");
        }
    }

    #[test]
    fn json_stays_json_and_means_the_same() {
        let text = "\u{9b}31m\u{7f}\u{202e}\u{e0041}";
        let json = serde_json::to_string(text).unwrap();
        let escaped = shown_json(&json);
        assert_eq!(escaped, r#""\u009b31m\u007f\u202e\udb40\udc41""#);
        assert_eq!(serde_json::from_str::<String>(&escaped).unwrap(), text);
    }
}
