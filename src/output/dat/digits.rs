//! Numbers in the forms in which CalculiX writes them.

/// Formats the numbers of a row.
pub(super) fn row(values: &[f64]) -> String {
    let each = values
        .iter()
        .map(|&value| format!(" {:>13}", scientific(value)));
    each.collect()
}

/// Formats a number with seven digits and an exponent of two digits, as C prints it.
fn scientific(value: f64) -> String {
    let text = format!("{value:.6E}");
    let Some((digits, exponent)) = text.split_once('E') else {
        return text;
    };
    match exponent.strip_prefix('-') {
        Some(exponent) => format!("{digits}E-{exponent:0>2}"),
        None => format!("{digits}E+{exponent:0>2}"),
    }
}

/// Formats a number with seven digits after a leading zero and an exponent of two digits, as
/// FORTRAN prints it.
pub(in crate::output) fn fortran(value: f64) -> String {
    let text = format!("{value:.6E}");
    let Some((digits, exponent)) = text.split_once('E') else {
        return text;
    };
    let exponent = match (exponent.parse::<i32>(), value == 0.0) {
        (Ok(exponent), false) => exponent + 1,
        _ => 0,
    };
    let sign = if exponent < 0 { '-' } else { '+' };
    let (minus, digits) = match digits.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", digits),
    };
    let digits = digits.replace('.', "");
    format!("{minus}0.{digits}E{sign}{:02}", exponent.abs())
}

#[cfg(test)]
mod tests {
    use super::{fortran, scientific};

    #[test]
    fn numbers_are_written_as_c_does() {
        for (value, text) in [
            (0.0, "0.000000E+00"),
            (-1.5e-7, "-1.500000E-07"),
            (2.0, "2.000000E+00"),
            (1e120, "1.000000E+120"),
        ] {
            assert_eq!(scientific(value), text);
        }
    }

    #[test]
    fn times_are_written_as_fortran_does() {
        for (value, text) in [
            (0.0, "0.0000000E+00"),
            (1.0, "0.1000000E+01"),
            (126.5, "0.1265000E+03"),
            (-0.0025, "-0.2500000E-02"),
        ] {
            assert_eq!(fortran(value), text);
        }
    }
}
