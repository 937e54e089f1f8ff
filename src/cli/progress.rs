//! Progress on standard error: a bar on a terminal, a line now and then elsewhere.

use super::interrupt;
use super::number::significant;
use crate::progress::{Flow, Observer};
use crate::results::HistoryRow;
use indicatif::{ProgressBar, ProgressStyle};
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
}

enum Shown {
    Nothing,
    Bar(ProgressBar),
    Lines { last: Instant },
}

impl Progress {
    pub fn new(quiet: bool) -> Self {
        let now = Instant::now();
        let shown = if quiet {
            Shown::Nothing
        } else if io::stderr().is_terminal() {
            Shown::Bar(bar())
        } else {
            Shown::Lines { last: now }
        };
        Progress {
            shown,
            quiet,
            started: now,
        }
    }

    /// Shows what is being done now.
    pub fn start(&mut self, phase: &str) {
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bar(bar) => bar.set_message(phase.to_string()),
            Shown::Lines { .. } => self.line(phase),
        }
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
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bar(bar) => {
                bar.set_position((fraction.clamp(0.0, 1.0) * PARTS as f64) as u64);
                bar.set_message(describe(row));
            }
            Shown::Lines { last } if last.elapsed() >= PAUSE => {
                *last = Instant::now();
                self.line(&format!("{:3.0} %  {}", 100.0 * fraction, describe(row)));
            }
            Shown::Lines { .. } => {}
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
    fn nothing_stops_a_run_that_nobody_stopped() {
        let mut progress = Progress::new(true);
        progress.phase("factorisation");
        let flow = progress.increment(&HistoryRow::default(), 0.5);
        assert_eq!(flow, Flow::Continue);
        assert!(!progress.stop_requested());
    }
}
