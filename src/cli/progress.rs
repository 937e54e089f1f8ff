//! Progress on standard error: a bar on a terminal, a line now and then elsewhere, or JSON lines.
//!
//! Each JSON line is an object with `event` and `seconds` since the start:
//!
//! | `event` | further keys |
//! |---|---|
//! | `phase` | `name` |
//! | `increment` | `fraction` of the load program done, `seconds_left` (predicted; null at first), `row` (a row of `history.csv`) |
//! | `warning` | `message` |

use super::arguments::Shown as Wish;
use super::interrupt;
use super::number::significant;
use crate::progress::{Flow, Observer};
use crate::results::HistoryRow;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Value, json};
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Between two lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(5);
/// Resolution of the bar.
const PARTS: u64 = 1000;

/// Shows what an analysis does, and passes on the user's wish to stop it.
pub(super) struct Progress {
    shown: Shown,
    quiet: bool,
    started: Instant,
    /// When the first increment was accepted and how much of the program then lay behind.
    first: Option<(Instant, f64)>,
}

enum Shown {
    Nothing,
    Bar(ProgressBar),
    Lines { last: Instant },
    Json,
}

impl Progress {
    pub fn new(quiet: bool, wish: Wish) -> Self {
        let now = Instant::now();
        let bar_wanted = match wish {
            Wish::Auto => io::stderr().is_terminal(),
            wish => wish == Wish::Bar,
        };
        let shown = if quiet {
            Shown::Nothing
        } else if wish == Wish::Json {
            Shown::Json
        } else if bar_wanted {
            Shown::Bar(bar())
        } else {
            Shown::Lines { last: now }
        };
        Progress {
            shown,
            quiet,
            started: now,
            first: None,
        }
    }

    /// Shows what is being done now.
    pub fn start(&mut self, phase: &str) {
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bar(bar) => bar.set_message(phase.to_string()),
            Shown::Lines { .. } => self.line(phase),
            Shown::Json => self.json("phase", json!({ "name": phase })),
        }
    }

    /// Seconds until the program is done if the rest goes like what lies behind.
    fn seconds_left(&mut self, fraction: f64) -> Option<f64> {
        let (begin, done) = *self.first.get_or_insert((Instant::now(), fraction));
        let progress = fraction - done;
        (progress > 0.0)
            .then(|| begin.elapsed().as_secs_f64() * (1.0 - fraction).max(0.0) / progress)
    }

    /// Writes an event as a line of its own.
    fn json(&self, event: &str, content: Value) {
        let seconds = self.started.elapsed().as_secs_f64();
        let mut line = json!({ "event": event, "seconds": seconds });
        if let (Value::Object(line), Value::Object(content)) = (&mut line, content) {
            line.extend(content);
        }
        let _ = writeln!(io::stderr(), "{line}");
    }

    /// Takes the bar away.
    pub fn finish(&mut self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }

    /// A failed write of progress is no reason to stop.
    fn line(&self, text: &str) {
        let seconds = self.started.elapsed().as_secs_f64();
        let _ = writeln!(io::stderr(), "[{seconds:7.1} s] {text}");
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Observer for Progress {
    fn phase(&mut self, name: &str) {
        self.start(name);
    }

    fn increment(&mut self, row: &HistoryRow, fraction: f64) -> Flow {
        let left = self.seconds_left(fraction);
        let text = || match left {
            Some(left) => format!("{}, about {} left", describe(row), rough(left)),
            None => describe(row),
        };
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bar(bar) => {
                bar.set_position((fraction.clamp(0.0, 1.0) * PARTS as f64) as u64);
                bar.set_message(text());
            }
            Shown::Lines { last } if last.elapsed() >= PAUSE => {
                *last = Instant::now();
                self.line(&format!("{:3.0} %  {}", 100.0 * fraction, text()));
            }
            Shown::Lines { .. } => {}
            Shown::Json => self.json(
                "increment",
                json!({ "fraction": fraction, "seconds_left": left, "row": row }),
            ),
        }
        if interrupt::requested() {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }

    fn warning(&mut self, message: &str) {
        if self.quiet {
            return;
        }
        let write = || {
            let _ = writeln!(io::stderr(), "warning: {message}");
        };
        match &self.shown {
            Shown::Bar(bar) => bar.suspend(write),
            Shown::Json => self.json("warning", json!({ "message": message })),
            _ => write(),
        }
    }

    fn stop_requested(&self) -> bool {
        interrupt::requested()
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(PARTS);
    if let Ok(style) =
        ProgressStyle::with_template("{spinner} {elapsed:>4} [{bar:24}] {percent:>3} %  {msg}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// Seconds as far as a prediction is worth saying.
fn rough(seconds: f64) -> String {
    match seconds {
        s if s < 99.5 => format!("{:.0} s", s.ceil()),
        s if s < 5940.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

fn describe(row: &HistoryRow) -> String {
    format!(
        "increment {}, load factor {}, {} pairs closed, {} plastic points, {}",
        row.increment,
        significant(row.alpha, 5),
        row.closed_pairs,
        row.plastic_points,
        row.event
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_increment_is_described_in_one_line() {
        let row = HistoryRow {
            increment: 7,
            alpha: 1.25,
            closed_pairs: 12,
            plastic_points: 90,
            event: "closes: pair 12".into(),
            ..HistoryRow::default()
        };
        assert_eq!(
            describe(&row),
            "increment 7, load factor 1.2500, 12 pairs closed, 90 plastic points, closes: pair 12"
        );
    }

    #[test]
    fn predictions_are_rounded() {
        for (seconds, text) in [
            (0.2, "1 s"),
            (59.0, "59 s"),
            (150.0, "2 min"),
            (9000.0, "2.5 h"),
        ] {
            assert_eq!(rough(seconds), text);
        }
    }

    #[test]
    fn nothing_stops_a_run_that_nobody_stopped() {
        let mut progress = Progress::new(true, Wish::Auto);
        progress.phase("factorisation");
        let flow = progress.increment(&HistoryRow::default(), 0.5);
        assert_eq!(flow, Flow::Continue);
        assert!(!progress.stop_requested());
    }
}
