//! Reading of amplitudes.

use super::block::BlockReader;
use crate::deck::bodies::unsupported;
use crate::deck::data::{Amplitude, Named};
use crate::error::Result;
use crate::number::exact;

/// Reads a function of time.
pub(super) fn amplitude(block: &mut BlockReader, amplitudes: &mut Named<Amplitude>) -> Result<()> {
    let known = "NAME TIME DEFINITION VALUE FIXEDINTERVAL BEGIN SHIFTX SHIFTY";
    let keyword = block.keyword;
    block.allow(known)?;
    let name = block.require("NAME")?;
    let definitions = ["TABULAR", "EQUALLY SPACED", "SMOOTH STEP"];
    let definition = block.choice("DEFINITION", &definitions)?;
    if definition == "SMOOTH STEP" {
        let message = "DEFINITION=SMOOTH STEP: amplitudes go straight from row to row here; \
                       give the curve as a table: from (t0, a0) to (t1, a1) it is \
                       a0 + (a1 - a0) s^3 (10 - 15 s + 6 s^2), with s = (t - t0)/(t1 - t0)";
        return Err(unsupported(block.error(message)));
    }
    let spacing = match definition == "EQUALLY SPACED" {
        true => Some(spacing(block)?),
        false => {
            for key in ["FIXEDINTERVAL", "BEGIN"] {
                if keyword.has(key) {
                    let message = format!("{key} belongs to DEFINITION=EQUALLY SPACED");
                    return Err(block.error(message));
                }
            }
            None
        }
    };
    let is_absolute = block.choice("VALUE", &["RELATIVE", "ABSOLUTE"])? == "ABSOLUTE";
    let times = ["STEP TIME", "TOTAL TIME"];
    let is_total = block.choice("TIME", &times)? == "TOTAL TIME";
    let shift = |key| block.number(key).map(Option::unwrap_or_default);
    let [shift_time, shift_value] = [shift("SHIFTX")?, shift("SHIFTY")?];
    let mut rows: Vec<[f64; 2]> = Vec::new();
    while let Some((_, mut row)) = block.row()? {
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
        return Err(block.error(message));
    }
    for row in &mut rows {
        *row = [row[0] + shift_time, row[1] + shift_value];
    }
    let amplitude = amplitudes.entry(name);
    *amplitude = Amplitude {
        rows,
        is_total,
        is_absolute,
    };
    Ok(())
}

/// The first time and the interval of an amplitude of which only the values are given.
fn spacing(block: &BlockReader) -> Result<[f64; 2]> {
    block.require("FIXEDINTERVAL")?;
    let by = block.number("FIXEDINTERVAL")?.unwrap_or(0.0);
    if by <= 0.0 {
        let message = format!("FIXED INTERVAL={} must be positive", exact(by));
        return Err(block.error(message));
    }
    Ok([block.number("BEGIN")?.unwrap_or(0.0), by])
}
