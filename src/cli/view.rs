//! `brinell view`: writes the report of a result directory again, or plots its main figures in the
//! terminal.

use super::below;
use super::report::states_table;
use super::streams::{print, warn};
use super::table::{page_width, wrap};
use crate::error::Result;
use crate::number::{number, significant, with_unit};
use crate::output::labels::{Labels, in_line, labelled};
use crate::output::{self, rows};
use crate::results::{HistoryRow, QUANTITIES, Results};
use crate::space::Space;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `brinell view`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  brinell view data/scenes/cylinder_on_half_plane.out
  brinell view data/scenes/cylinder_on_half_plane.out --terminal
  brinell view data/scenes/cylinder_on_half_plane.out --below below.csv")]
pub(super) struct ViewArguments {
    /// A directory that `brinell run` wrote
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Print the main plots instead; writes no files
    #[arg(long)]
    pub terminal: bool,
    /// Write the stresses below the centre of the contact to a CSV file instead: a row for each
    /// state with fields and each node on the line x = 0 (in solids x = y = 0)
    #[arg(long, value_name = "FILE", conflicts_with = "terminal")]
    pub below: Option<PathBuf>,
    /// Columns of tables and plots; by default those of the terminal, at most 110
    #[arg(
        long,
        value_name = "N",
        requires = "terminal",
        value_parser = clap::value_parser!(u16).range(20..=400)
    )]
    pub width: Option<u16>,
}

/// Writes the report again from the contents of the directory, or prints the plots.
pub(super) fn run(arguments: &ViewArguments) -> Result<()> {
    if let Some(why) = output::stale(&arguments.dir) {
        warn(&why);
    }
    if arguments.terminal {
        return terminal(arguments);
    }
    if let Some(file) = &arguments.below {
        return below::write(&arguments.dir, file);
    }
    let page = output::write_report(&arguments.dir)?;
    print(&format!("{}\n", page.display()))
}

/// Prints the contents of a result directory, as far as a terminal can show them.
fn terminal(arguments: &ViewArguments) -> Result<()> {
    let dir = &arguments.dir;
    let summary = rows::summary(&dir.join("summary.json"))?;
    let history: Vec<HistoryRow> = rows::rows(&dir.join("history.csv"))?;
    let (space, labels) = (summary.space(), summary.labels());
    let columns = arguments
        .width
        .map_or_else(|| page_width().min(WIDEST), usize::from);
    let mut text = wrapped(&summary.scene, columns);
    text.push_str(&headlines(&summary.results(&[]), &labels, space, columns));
    // With a prescribed displacement without contact the history has no load.
    let (against, load): (_, fn(&HistoryRow) -> f64) =
        match history.iter().any(|row| row.load.is_finite()) {
            true => (labelled("load", labels.load()), |row| row.load),
            false => ("load factor".to_string(), |row| row.alpha),
        };
    for quantity in QUANTITIES
        .iter()
        .filter(|q| q.estimated.is_some() && q.key != "load")
    {
        let Some(field) = quantity.in_history else {
            continue;
        };
        let points: Vec<[f64; 2]> = history.iter().map(|r| [load(r), (field.get)(r)]).collect();
        if points.iter().any(|p| p[1] > 0.0) {
            let name = labels.name(quantity);
            let plot = plot(&points, columns);
            text.push_str(&format!("\n{name} against {against}\n{plot}"));
        }
    }
    print(&text)
}

/// Wraps a text to lines of at most `columns` characters.
fn wrapped(text: &str, columns: usize) -> String {
    wrap(text, columns).join("\n") + "\n"
}

fn headlines(results: &Results, labels: &Labels, space: Space, columns: usize) -> String {
    let mut text = String::new();
    if let Some(incomplete) = &results.incomplete {
        text.push_str(&wrapped(
            &format!("INCOMPLETE: {}", incomplete.why),
            columns,
        ));
    }
    let contact = results.sizes.contact_pairs > 0;
    if let Some(first) = &results.first_yield {
        let figures = QUANTITIES.iter().filter(|q| q.scope.holds(contact, true));
        let figures = figures.filter_map(|quantity| {
            let value = (quantity.at_yield?.get)(first);
            let name = in_line(labels.heading(quantity));
            let value = value.is_finite().then(|| number(value))?;
            Some(with_unit(
                &format!("{name} {value}"),
                &labels.unit(quantity.unit),
            ))
        });
        let figures: Vec<String> = figures.collect();
        let figures = format!("First yield at {}", figures.join(", "));
        text.push_str(&wrapped(&figures, columns));
    }
    if !results.states.is_empty() {
        text.push_str(&states_table(&results.states, labels, space, contact).render(columns));
    }
    text
}

/// Largest width of a plot in a wide terminal.
const WIDEST: usize = 110;
/// Number of lines of a plot without axes.
const LINES: usize = 12;

/// Plots points joined by lines, with 2 x 4 dots in each character (Unicode braille).
fn plot(points: &[[f64; 2]], columns: usize) -> String {
    let largest = |k: usize| {
        let finite = points.iter().map(|p| p[k]).filter(|v| v.is_finite());
        finite.fold(0.0, f64::max)
    };
    let top = [largest(0), largest(1)].map(|v| if v > 0.0 { v } else { 1.0 });
    let label = 11;
    let width = columns.saturating_sub(label + 2).max(8);
    let mut cells = vec![0u8; width * LINES];
    let mut dot = |x: f64, y: f64| {
        if !(x >= 0.0 && y >= 0.0) {
            return;
        }
        let right = ((x * (2 * width - 1) as f64).round() as usize).min(2 * width - 1);
        let down = ((1.0 - y.min(1.0)) * (4 * LINES - 1) as f64).round() as usize;
        // In a braille character dots 1 2 3 7 run down the left, dots 4 5 6 8 down the right.
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        cells[down / 4 * width + right / 2] |= BITS[down % 4][right % 2];
    };
    for pair in points.windows(2) {
        let [p, q] = [pair[0], pair[1]].map(|p| [p[0] / top[0], p[1] / top[1]]);
        let steps = 4 * (width + LINES);
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            dot(p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]));
        }
    }
    let mut text = String::new();
    for (line, row) in cells.chunks(width).enumerate() {
        let at = match line {
            0 => significant(top[1], 4),
            l if l + 1 == LINES => "0".to_string(),
            _ => String::new(),
        };
        let row: String = row
            .iter()
            .filter_map(|&bits| char::from_u32(0x2800 + u32::from(bits)))
            .collect();
        text.push_str(&format!("{at:>label$} │{row}\n"));
    }
    let end = significant(top[0], 4);
    text.push_str(&format!("{:>label$} └{}\n", "", "─".repeat(width)));
    let room = width.saturating_sub(end.len() + 1);
    text.push_str(&format!("{:>label$}  0{:room$}{end}\n", "", ""));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rising_line_goes_from_corner_to_corner() {
        let text = plot(&[[0.0, 0.0], [2.0, 5.0]], 40);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), LINES + 2);
        assert!(lines[0].contains("5.000 │") && lines[0].trim_end().ends_with(|c| c > '\u{2800}'));
        let bottom = lines[LINES - 1].split('│').nth(1).unwrap();
        assert!(bottom.starts_with(|c| c > '\u{2800}'), "{bottom}");
        assert!(lines[LINES + 1].ends_with("2.000"));
        assert!(lines.iter().all(|l| l.chars().count() <= 40));
    }

    #[test]
    fn what_is_no_number_is_left_out() {
        let text = plot(&[[f64::NAN, 1.0], [1.0, f64::INFINITY], [0.0, 0.0]], 20);
        assert!(text.lines().count() == LINES + 2);
        assert!(plot(&[], 30).lines().count() == LINES + 2);
    }
}
