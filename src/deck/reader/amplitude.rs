//! Reading of amplitudes.

use super::{Reader, fields};
use crate::deck::bodies::unsupported;
use crate::deck::data::Amplitude;
use crate::deck::keyword::Keyword;
use crate::deck::source::Files;
use crate::error::Result;
use crate::number::exact;

impl Reader<'_> {
    pub(super) fn amplitude(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let known = [
            "NAME",
            "TIME",
            "DEFINITION",
            "VALUE",
            "FIXEDINTERVAL",
            "BEGIN",
            "SHIFTX",
            "SHIFTY",
        ];
        keyword.allow(files, &known)?;
        let name = keyword.require(files, "NAME")?;
        let definitions = ["TABULAR", "EQUALLY SPACED", "SMOOTH STEP"];
        let definition = keyword.choice(files, "DEFINITION", &definitions)?;
        if definition == "SMOOTH STEP" {
            let message = "DEFINITION=SMOOTH STEP: amplitudes go straight from row to row here; \
                           give the curve as a table: from (t0, a0) to (t1, a1) it is \
                           a0 + (a1 - a0) s^3 (10 - 15 s + 6 s^2), with s = (t - t0)/(t1 - t0)";
            return Err(unsupported(keyword.error(files, message)));
        }
        let spacing = match definition == "EQUALLY SPACED" {
            true => Some(spacing(keyword, files)?),
            false => {
                for key in ["FIXEDINTERVAL", "BEGIN"] {
                    if keyword.has(key) {
                        let message = format!("{key} belongs to DEFINITION=EQUALLY SPACED");
                        return Err(keyword.error(files, message));
                    }
                }
                None
            }
        };
        let is_absolute = keyword.choice(files, "VALUE", &["RELATIVE", "ABSOLUTE"])? == "ABSOLUTE";
        let times = ["STEP TIME", "TOTAL TIME"];
        let is_total = keyword.choice(files, "TIME", &times)? == "TOTAL TIME";
        let shift = |key| keyword.number(files, key).map(Option::unwrap_or_default);
        let [shift_time, shift_value] = [shift("SHIFTX")?, shift("SHIFTY")?];
        let mut rows: Vec<[f64; 2]> = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            while !row.is_at_end() {
                let time = match spacing {
                    Some([begin, by]) => begin + by * rows.len() as f64,
                    None => row.number("the time")?,
                };
                let value = row.number("the value")?;
                let last = rows.last().map(|last| last[0]);
                if last.is_some_and(|last| time <= last) {
                    return Err(row.place.error(format!(
                        "time {} must be greater than {} before it",
                        exact(time),
                        exact(last.unwrap_or_default())
                    )));
                }
                rows.push([time, value]);
            }
        }
        if rows.is_empty() {
            let message = "lines with times and values should follow; give them";
            return Err(keyword.error(&self.source.files, message));
        }
        for row in &mut rows {
            *row = [row[0] + shift_time, row[1] + shift_value];
        }
        let amplitude = self.deck.program.amplitudes.entry(name);
        *amplitude = Amplitude {
            rows,
            is_total,
            is_absolute,
        };
        Ok(())
    }
}

/// The first time and the interval of an amplitude whose values alone are given.
fn spacing(keyword: &Keyword, files: &Files) -> Result<[f64; 2]> {
    keyword.require(files, "FIXEDINTERVAL")?;
    let by = keyword.number(files, "FIXEDINTERVAL")?.unwrap_or(0.0);
    if by <= 0.0 {
        let message = format!("FIXED INTERVAL={} must be positive", exact(by));
        return Err(keyword.error(files, message));
    }
    Ok([keyword.number(files, "BEGIN")?.unwrap_or(0.0), by])
}
