//! The format of numbers in `.frd` files.

/// Appends a number with six digits in twelve columns, in single precision: `-1.23457E-04`.
pub(super) fn number(value: f64, out: &mut String) {
    let text = format!("{:.5E}", value as f32);
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, size) = match exponent.strip_prefix('-') {
        Some(size) => ('-', size),
        None => ('+', exponent),
    };
    let written = format!("{digits}E{sign}{size:0>2}");
    // A value that is not a number has no exponent.
    let written = if value.is_finite() { &written } else { digits };
    out.push_str(&format!("{written:>12}"));
}

/// Formats a time in at most eleven characters: from 1 to below 1e9 with ten digits, otherwise with
/// six digits and an exponent.
pub(super) fn time(value: f64) -> String {
    let before_point = value.max(1.0).log10().floor() as usize;
    if value >= 1.0 && before_point < 9 {
        return format!("{value:.*}", 9 - before_point);
    }
    let mut out = String::new();
    number(value, &mut out);
    out.trim_start().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_twelve_columns() {
        for (value, text) in [
            (0.0, " 0.00000E+00"),
            (-1.5e-7, "-1.50000E-07"),
            (123456.49, " 1.23456E+05"),
            (-2e30, "-2.00000E+30"),
            (f64::NAN, "         NaN"),
        ] {
            let mut out = String::new();
            number(value, &mut out);
            assert_eq!(out, text);
        }
    }

    #[test]
    fn times_are_as_calculix_writes_them() {
        for (value, text) in [
            (0.0, "0.00000E+00"),
            (0.005, "5.00000E-03"),
            (1.0, "1.000000000"),
            (13.5, "13.50000000"),
            (126.0, "126.0000000"),
        ] {
            assert_eq!(time(value), text);
        }
    }
}
