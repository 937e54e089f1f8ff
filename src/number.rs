//! Numbers for readers: the only place where numbers are formatted.

/// Formats a number exactly as it was given, but with an exponent if that is shorter: `1e300`
/// without 300 zeros.
pub(crate) fn exact(value: f64) -> String {
    let plain = value.to_string();
    let scientific = format!("{value:e}");
    if plain.len() > scientific.len().max(LONGEST_PLAIN) {
        scientific
    } else {
        plain
    }
}

/// Largest number of characters that is shown without an exponent.
const LONGEST_PLAIN: usize = 12;

/// Formats `value` with `digits` significant digits: plain from 1e-4 to 1e7, else with an exponent.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    // Rust determines the exponent after rounding: 9.9999 is 1.000e1 with four digits.
    let exponent = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent) if (-4..7).contains(&exponent) => {
            let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

/// Formats as [`significant`] does, without trailing zeros of the fraction.
#[cfg(feature = "report")]
pub(crate) fn trimmed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let at = text.find('e').unwrap_or(text.len());
    let (mantissa, exponent) = text.split_at(at);
    if !mantissa.contains('.') {
        return text;
    }
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    format!("{mantissa}{exponent}")
}

/// Formats with six significant digits for tables; `none` if the value is not finite.
#[cfg(feature = "report")]
pub(crate) fn number(value: f64) -> String {
    if value.is_finite() {
        significant(value, 6)
    } else {
        "none".to_string()
    }
}

/// Appends the unit to a number, if there is a unit.
#[cfg(feature = "report")]
pub(crate) fn with_unit(number: &str, unit: &str) -> String {
    format!("{number} {unit}").trim_end().to_string()
}

/// Formats a share in per cent with two digits.
pub(crate) fn percent(share: f64) -> String {
    if share.is_finite() {
        format!("{} %", percentage(share))
    } else {
        "of unknown size".to_string()
    }
}

/// Formats as [`percent`] does, without the per cent sign, for sentences that contain the sign.
pub(crate) fn percentage(share: f64) -> String {
    significant(100.0 * share, 2)
}

/// Formats as [`percentage`] does, for tables: negligible shares are shown as `< 0.01`.
#[cfg(feature = "report")]
pub(crate) fn rough_percentage(share: f64) -> String {
    match share {
        s if s > 0.0 && s < 1e-4 => "< 0.01".to_string(),
        s => percentage(s),
    }
}

/// Formats a number of bytes in a suitable unit.
pub(crate) fn bytes(count: f64) -> String {
    let mut value = count;
    for unit in ["B", "kB", "MB", "GB"] {
        if value < 999.5 {
            return format!("{} {unit}", significant_integer(value));
        }
        value /= 1000.0;
    }
    format!("{} TB", significant_integer(value))
}

fn significant_integer(value: f64) -> String {
    if value >= 9.95 || value == value.trunc() {
        format!("{value:.0}")
    } else {
        format!("{value:.1}")
    }
}

/// Formats seconds, to the millisecond for short times.
#[cfg(feature = "report")]
pub(crate) fn seconds(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0} s")
    } else if value >= 10.0 {
        format!("{value:.1} s")
    } else {
        format!("{value:.3} s")
    }
}

/// Formats a time in a suitable unit with two digits.
pub(crate) fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 0.1 => (1e3 * s, "ms"),
        s if s < 99.5 => (s, "s"),
        s if s < 5970.0 => (s / 60.0, "min"),
        s if s < 172_800.0 => (s / 3600.0, "h"),
        s => (s / 86400.0, "days"),
    };
    format!("{} {unit}", significant(value, 2))
}

#[cfg(all(test, feature = "report"))]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_counted_after_rounding() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.000"),
            (-1.0515, "-1.052"),
            (9.9996, "10.00"),
            (1234.56, "1235"),
            (1234567.0, "1234567"),
            (12345678.0, "1.235e7"),
            (0.00012344, "0.0001234"),
            (0.000012344, "1.234e-5"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(significant(value, 4), text);
        }
    }

    #[test]
    fn a_ratio_to_nothing_is_none() {
        assert_eq!(number(0.25), "0.250000");
        for there_is_none in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(number(there_is_none), "none");
        }
    }

    #[test]
    fn bytes_and_seconds_have_fitting_units() {
        assert_eq!(bytes(0.0), "0 B");
        assert_eq!(bytes(999.0), "999 B");
        assert_eq!(bytes(999.7), "1.0 kB");
        assert_eq!(bytes(1.5e6), "1.5 MB");
        assert_eq!(bytes(24.3e9), "24 GB");
        assert_eq!(bytes(3e15), "3000 TB");
        assert_eq!(seconds(0.01234), "0.012 s");
        assert_eq!(seconds(12.34), "12.3 s");
        assert_eq!(seconds(123.4), "123 s");
    }

    #[test]
    fn zeros_at_the_end_are_cut() {
        for (value, text) in [
            (210_000.0, "210000"),
            (0.25, "0.25"),
            (-1.5e11, "-1.5e11"),
            (0.0, "0"),
            (1e-5, "1e-5"),
        ] {
            assert_eq!(trimmed(value, 5), text);
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
    fn shares_and_times_have_readable_units() {
        for (share, text) in [
            (0.003, "0.30 %"),
            (0.0999, "10 %"),
            (1e-8, "1.0e-6 %"),
            (0.0, "0 %"),
            (f64::NAN, "of unknown size"),
        ] {
            assert_eq!(percent(share), text);
        }
        for (share, text) in [
            (0.0, "0"),
            (5.1e-13, "< 0.01"),
            (1e-4, "0.010"),
            (0.1, "10"),
        ] {
            assert_eq!(rough_percentage(share), text);
        }
        for (seconds, text) in [
            (0.0123, "12 ms"),
            (0.7, "0.70 s"),
            (90.0, "90 s"),
            (150.0, "2.5 min"),
            (10_800.0, "3.0 h"),
            (864_000.0, "10 days"),
        ] {
            assert_eq!(duration(seconds), text);
        }
    }
}
