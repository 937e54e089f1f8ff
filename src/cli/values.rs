//! Numbers on the command line, with the range that each must lie in.

/// Reads a number greater than 0.
pub(super) fn positive(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| v > 0.0, "greater than 0")
}

/// Reads a number other than 0.
pub(super) fn not_zero(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| v != 0.0, "other than 0")
}

/// Reads a number not less than 0.
pub(super) fn not_negative(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| v >= 0.0, "not less than 0")
}

/// Reads a Poisson's ratio.
pub(super) fn poissons_ratio(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| -1.0 < v && v < 0.5, "between -1 and 0.5")
}

/// Reads a finite number for which `holds` is true.
fn within(
    text: &str,
    holds: impl Fn(f64) -> bool,
    range: &str,
) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && holds(value) => Ok(value),
        _ => Err(format!("a number {range} is wanted")),
    }
}
