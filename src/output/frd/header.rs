//! The lines in front of the mesh: title, date, program, materials.

use crate::model::Model;
use crate::scene::Scene;
use std::io::{self, Write};
use std::time::{SystemTime, UNIX_EPOCH};

const MONTHS: [&str; 12] = [
    "january",
    "february",
    "march",
    "april",
    "may",
    "june",
    "july",
    "august",
    "september",
    "october",
    "november",
    "december",
];

/// Returns the names of the materials, which elements refer to by numbers from 1: the names of the
/// deck, or else of the scene.
pub(super) fn materials(model: &Model) -> Vec<String> {
    let of_deck = &model.scene.requests.materials;
    if !of_deck.is_empty() {
        return of_deck.clone();
    }
    let mut out: Vec<String> = Vec::new();
    for body in &model.mesh.bodies {
        let name = model.scene.bodies.get(body).map(|body| &body.material);
        if let Some(name) = name.filter(|name| !out.contains(name)) {
            out.push(name.clone());
        }
    }
    out
}

/// Writes the lines of the header.
pub(super) fn write(out: &mut impl Write, scene: &Scene, materials: &[String]) -> io::Result<()> {
    writeln!(out, "    1C")?;
    let title = std::slice::from_ref(&scene.title);
    let heading = match scene.requests.is_of_deck() {
        true => &scene.requests.heading[..],
        false => title,
    };
    for line in heading.iter().filter(|line| !line.is_empty()) {
        let line: String = line.chars().take(66).collect();
        writeln!(out, "    1U{line:<66}")?;
    }
    let (date, time) = now();
    let version = concat!("Version ", env!("CARGO_PKG_VERSION"));
    for (key, value, width) in [
        ("USER", "", 48),
        ("DATE", &*date, 48),
        ("TIME", &*time, 48),
        ("HOST", "", 48),
        ("PGM", "brinell", 48),
        ("VERSION", version, 41),
        ("COMPILETIME", "", 49),
        ("DIR", "", 48),
        ("DBN", "", 48),
    ] {
        writeln!(out, "    1U{key:<18}{value:<width$}")?;
    }
    for (index, name) in materials.iter().enumerate() {
        let name: String = name.chars().take(58).collect();
        writeln!(out, "    1UMAT{:5}{name:<58}", index + 1)?;
    }
    Ok(())
}

/// Returns date and time of day in UTC.
fn now() -> (String, String) {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let seconds = since.map_or(0, |since| since.as_secs());
    let (days, of_day) = (seconds / 86_400, seconds % 86_400);
    let [year, month, day] = date(days);
    let month = MONTHS[month as usize - 1];
    let (hour, minute, second) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
    (
        format!("{day:02}.{month}.{year}"),
        format!("{hour:02}:{minute:02}:{second:02}"),
    )
}

/// Converts a number of days since 1970 to year, month and day.
///
/// # Source
/// H. Hinnant, *chrono-Compatible Low-Level Date Algorithms* (2013), `civil_from_days`: years begin
/// in March, so that the leap day is the last of a year.
fn date(days: u64) -> [u64; 3] {
    // Days since 1 March of the year 0, split into eras of 400 years.
    let days = days + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = year + 400 * era + u64::from(month <= 2);
    [year, month, day]
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn days_are_dates() {
        for (days, expected) in [
            (0, [1970, 1, 1]),
            (11_016, [2000, 2, 29]),
            (11_017, [2000, 3, 1]),
            (20_784, [2026, 11, 27]),
        ] {
            assert_eq!(date(days), expected);
        }
    }
}
