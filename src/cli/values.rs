//! Numbers and times on the command line, with the range that each must lie in.

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

/// Reads a duration in seconds: `60`, `60s`, `2min` or `1h`.
pub(super) fn duration(text: &str) -> std::result::Result<f64, String> {
    let wanted = "give a positive time, such as 60s or 10min";
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match &text[digits.len()..] {
        "" | "s" => 1.0,
        "min" | "m" => 60.0,
        "h" => 3600.0,
        _ if digits.is_empty() => return Err(wanted.to_string()),
        other => return Err(format!("unknown unit `{other}`; give s, min or h")),
    };
    match digits.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value * unit),
        _ => Err(wanted.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_units() {
        assert_eq!(duration("60"), Ok(60.0));
        assert_eq!(duration("90s"), Ok(90.0));
        assert_eq!(duration("1.5min"), Ok(90.0));
        assert_eq!(duration("2h"), Ok(7200.0));
        for wrong in ["", "s", "-3s", "3 weeks", "infs", "0s"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }
}
