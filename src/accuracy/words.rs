//! Shares and times as a reader wants them.

/// A share in per cent, two digits.
pub(crate) fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value {
        v if !v.is_finite() => "of unknown size".to_string(),
        0.0 => "0 %".to_string(),
        v if v.abs() < 1e-3 => format!("{v:.1e} %"),
        v => {
            let digits = (1 - v.abs().max(1e-300).log10().floor() as i32).clamp(0, 6) as usize;
            format!("{v:.digits$} %")
        }
    }
}

/// A time in the unit that suits it.
pub(super) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{:.2} ms", 1e3 * s),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.1e} days", s / 86400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_times_have_readable_units() {
        assert_eq!(percent(0.003), "0.30 %");
        assert_eq!(percent(0.1), "10 %");
        assert_eq!(percent(1e-8), "1.0e-6 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(duration(10_800.0), "3 h");
        assert_eq!(duration(90.0), "90.0 s");
        assert_eq!(duration(0.0123), "12.30 ms");
    }
}
