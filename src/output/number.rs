//! Numbers for readers.

/// `value` with `digits` significant digits: plain between 1e-4 and 1e7, else with an exponent.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    // Rust writes the exponent after rounding: 9.9999 is 1.000e1 with four digits.
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

/// Six significant digits: what the tables show; of what there is not, that.
#[cfg(feature = "report")]
pub(crate) fn number(value: f64) -> String {
    if value.is_nan() {
        return "none".to_string();
    }
    significant(value, 6)
}

/// Six significant digits of a ratio; where there is none, as of 0 to 0, that.
#[cfg(feature = "report")]
pub(crate) fn ratio(value: f64) -> String {
    if value.is_finite() {
        number(value)
    } else {
        "none".to_string()
    }
}

/// Bytes in the unit that fits.
#[cfg(feature = "report")]
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

#[cfg(feature = "report")]
fn significant_integer(value: f64) -> String {
    if value >= 9.95 || value == value.trunc() {
        format!("{value:.0}")
    } else {
        format!("{value:.1}")
    }
}

/// Seconds, to the millisecond where that matters.
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
        assert_eq!(ratio(0.25), "0.250000");
        for there_is_none in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(ratio(there_is_none), "none");
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
}
