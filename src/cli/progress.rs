//! Progress on standard error: a bar per phase on a terminal, otherwise a line now and then, or
//! JSON lines.
//!
//! Each JSON line is an object with `event` and `seconds` since the start:
//!
//! | `event` | further keys |
//! |---|---|
//! | `phase` | `name`, `predicted_seconds` (rough: by the size of the model and the phases so far) |
//! | `increment` | `fraction` of the load program done, `seconds_left` of it (predicted), `row` (a row of `history.csv`) |
//! | `note`, `warning` | `message` |
//! | `stopping` | `message`: Ctrl-C or another signal was heard |
//! | `error` | `message`, `exit_code`: the last line of a run that failed |

use super::forecast::TimeForecast;
use super::interrupt;
use super::remaining::Remaining;
use super::streams::json_line;
use crate::number::{duration, significant};
use crate::progress::{Flow, Observer};
use crate::results::HistoryRow;
use crate::scene::Scene;
use crate::text::{shown, shown_in_line};
use clap::ValueEnum;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use serde_json::{Value, json};
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum ProgressKind {
    /// Bars on a terminal, lines elsewhere
    #[default]
    Auto,
    /// A bar per phase with elapsed time and time left
    Bar,
    /// A line per phase and every few seconds
    Plain,
    /// A JSON object per line: phases, increments, warnings, Ctrl-C, and the error at the end
    Json,
}

/// Time between two lines if there is no terminal.
const PAUSE: Duration = Duration::from_secs(5);
/// Number of steps of a bar, and its width in characters.
const PARTS: u64 = 1000;
const WIDTH: usize = 24;
/// Shows the progress of an analysis, and passes on the user's request to stop it.
pub(super) struct Progress {
    shown: Shown,
    quiet: bool,
    started: Instant,
    phase: Option<Phase>,
    forecast: TimeForecast,
}

/// The current phase.
struct Phase {
    name: String,
    clock: Clock,
}

/// The start of a phase and its remaining time; shared with a bar, which draws itself from its own
/// thread.
#[derive(Clone)]
struct Clock {
    started: Instant,
    remaining: Arc<Mutex<Remaining>>,
}

impl Clock {
    fn new(predicted: f64) -> Self {
        Clock {
            started: Instant::now(),
            remaining: Arc::new(Mutex::new(Remaining::new(predicted))),
        }
    }

    fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    fn remaining(&self) -> MutexGuard<'_, Remaining> {
        self.remaining.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn left(&self) -> f64 {
        self.remaining().at(self.seconds())
    }
}

enum Shown {
    Nothing,
    Bars {
        all: MultiProgress,
        bar: Option<ProgressBar>,
    },
    Lines {
        last: Instant,
    },
    Json,
}

impl Progress {
    /// Creates the progress display of a run that began at `started`.
    pub fn new(quiet: bool, wish: ProgressKind, started: Instant) -> Self {
        let bars_wanted = match wish {
            ProgressKind::Auto => io::stderr().is_terminal(),
            wish => wish == ProgressKind::Bar,
        };
        let shown = if quiet {
            Shown::Nothing
        } else if wish == ProgressKind::Json {
            Shown::Json
        } else if bars_wanted {
            Shown::bars(ProgressDrawTarget::stderr())
        } else {
            Shown::Lines { last: started }
        };
        Progress {
            shown,
            quiet,
            started,
            phase: None,
            forecast: TimeForecast::new(started),
        }
    }

    /// Takes the number of targets of the scene's load program, for the predictions.
    pub fn scene(&mut self, scene: &Scene) {
        self.forecast.program(scene.program.targets.len());
    }

    /// Starts a new phase and shows its name.
    pub fn start(&mut self, phase: &str) {
        self.end_phase();
        let predicted = self.forecast.seconds(phase);
        self.show(phase, predicted);
    }

    /// Ends the current phase; its duration improves the prediction of the next ones.
    fn end_phase(&mut self) {
        if let Some(last) = self.phase.take() {
            self.forecast.learn(&last.name, last.clock.seconds());
        }
    }

    fn show(&mut self, phase: &str, predicted: f64) {
        let clock = Clock::new(predicted);
        self.phase = Some(Phase {
            name: phase.to_string(),
            clock: clock.clone(),
        });
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bars { all, bar } => {
                if let Some(last) = bar.take() {
                    last.finish_with_message("");
                }
                let next = all.add(new_bar(&shown_in_line(phase), predicted, clock));
                next.enable_steady_tick(Duration::from_millis(100));
                *bar = Some(next);
            }
            // For a phase that takes too little time no prediction is printed.
            Shown::Lines { .. } if predicted < GRAIN => self.line(phase),
            Shown::Lines { .. } => self.line(&format!("{phase}, about {}", rough(predicted))),
            Shown::Json => self.json(
                "phase",
                json!({ "name": phase, "predicted_seconds": predicted }),
            ),
        }
    }

    /// Returns the seconds until the program is complete, of which the share `fraction` is done.
    fn seconds_left(&self, fraction: f64) -> f64 {
        self.phase.as_ref().map_or(0.0, |Phase { clock, .. }| {
            clock.remaining().update(clock.seconds(), fraction);
            clock.left()
        })
    }

    /// Writes an event as a line of JSON.
    fn json(&self, event: &str, content: Value) {
        json_line(self.started, event, content);
    }

    /// Removes the bars.
    pub fn finish(&mut self) {
        if let Shown::Bars { all, bar } = &mut self.shown {
            if let Some(bar) = bar.take() {
                bar.finish();
            }
            // Bars that cannot be cleared stay visible.
            let _ = all.clear();
        }
    }

    /// Prints a message that is neither a phase nor a warning.
    pub fn note(&self, text: &str) {
        match &self.shown {
            Shown::Nothing => {}
            Shown::Bars { all, .. } => all.suspend(|| self.line(text)),
            Shown::Lines { .. } => self.line(text),
            Shown::Json => self.json("note", json!({ "message": text })),
        }
    }

    /// Writes a line; a failure to write it does not stop the run.
    fn line(&self, text: &str) {
        let seconds = self.started.elapsed().as_secs_f64();
        let _ = writeln!(io::stderr(), "[{seconds:7.1} s] {}", shown(text));
    }
}

/// Formats the completed share in whole per cent, rounded down: 100 only when everything is
/// complete.
fn per_cent(fraction: f64) -> String {
    format!("{:3.0}", (100.0 * fraction).floor())
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

    fn phase_of(&mut self, name: &str, seconds: f64) {
        self.end_phase();
        self.show(name, seconds);
    }

    fn model(&mut self, freedoms: usize, pairs: usize) {
        self.forecast.model(freedoms, pairs);
    }

    fn increment(&mut self, row: &HistoryRow, fraction: f64) -> Flow {
        let left = self.seconds_left(fraction);
        let text = || format!("{}, about {} left", describe(row), rough(left));
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bars { bar, .. } => {
                if let Some(bar) = bar {
                    bar.set_position((fraction.clamp(0.0, 1.0) * PARTS as f64) as u64);
                    bar.set_message(shown_in_line(&describe(row)).into_owned());
                }
            }
            Shown::Lines { last } if last.elapsed() >= PAUSE => {
                *last = Instant::now();
                self.line(&format!("{} %  {}", per_cent(fraction), text()));
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
            let _ = writeln!(io::stderr(), "warning: {}", shown(message));
        };
        match &self.shown {
            Shown::Bars { all, .. } => all.suspend(write),
            Shown::Json => self.json("warning", json!({ "message": message })),
            _ => write(),
        }
    }

    fn stop_requested(&self) -> bool {
        interrupt::requested()
    }
}

impl Shown {
    fn bars(target: ProgressDrawTarget) -> Self {
        Shown::Bars {
            all: MultiProgress::with_draw_target(target),
            bar: None,
        }
    }
}

/// Creates the bar of a phase: name, completed share, time, time left. The share is that of the
/// load program if increments report it, else the share of the predicted time, of which the last
/// part is only filled at the end.
fn new_bar(phase: &str, predicted: f64, clock: Clock) -> ProgressBar {
    let done = move |state: &ProgressState| match (state.is_finished(), state.pos()) {
        (true, _) => 1.0,
        (_, 1..) => f64::from(state.fraction()),
        (_, 0) => (state.elapsed().as_secs_f64() / predicted).min(0.97),
    };
    let gauge = move |state: &ProgressState, out: &mut dyn fmt::Write| {
        let filled = (done(state) * WIDTH as f64) as usize;
        let rest = WIDTH - filled.min(WIDTH);
        let _ = write!(out, "{}{}", "=".repeat(WIDTH - rest), " ".repeat(rest));
    };
    let left = move |state: &ProgressState, out: &mut dyn fmt::Write| {
        if !state.is_finished() {
            let _ = write!(out, "about {} left", rough(clock.left()));
        }
    };
    let bar = ProgressBar::with_draw_target(Some(PARTS), ProgressDrawTarget::hidden());
    let template = "{spinner} {prefix:34} [{gauge}] {elapsed:>4}  {left}  {wide_msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.with_key("gauge", gauge).with_key("left", left));
    }
    bar.with_prefix(phase.to_string())
}

/// Seconds below which a predicted time is not worth stating.
const GRAIN: f64 = 0.5;

/// Formats a predicted time, as far as it is worth stating.
fn rough(seconds: f64) -> String {
    duration(seconds.max(GRAIN))
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

    /// A terminal that keeps the text written to it.
    #[derive(Debug, Clone, Default)]
    struct Terminal(std::sync::Arc<std::sync::Mutex<String>>);

    impl indicatif::TermLike for Terminal {
        fn width(&self) -> u16 {
            120
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, text: &str) -> io::Result<()> {
            self.write_str(&format!("{text}\n"))
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            self.0.lock().unwrap().push_str(text);
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn each_phase_has_a_bar_with_elapsed_and_predicted_time() {
        let terminal = Terminal::default();
        let mut progress = Progress::new(false, ProgressKind::Bar, Instant::now());
        let target = ProgressDrawTarget::term_like_with_hz(Box::new(terminal.clone()), 255);
        progress.shown = Shown::bars(target);
        progress.start("mesh and model");
        progress.model(40_000_000, 0);
        progress.start("assembly");
        std::thread::sleep(Duration::from_millis(30));
        progress.start("factorisation");
        std::thread::sleep(Duration::from_millis(250));
        // A small model, whose load program is predicted to end at once.
        progress.model(100, 0);
        progress.start("load program");
        std::thread::sleep(Duration::from_millis(50));
        progress.increment(&HistoryRow::default(), 0.5);
        std::thread::sleep(Duration::from_millis(250));
        progress.finish();
        let text = terminal.0.lock().unwrap().clone();
        let line = |phase: &str, holds: &str| {
            text.split(['\n', '\r'])
                .any(|l| l.contains(phase) && l.contains(holds))
        };
        for phase in [
            "mesh and model",
            "assembly",
            "factorisation",
            "load program",
        ] {
            assert!(line(phase, "["), "{phase}: {text}");
            assert!(line(phase, "left"), "{phase}: {text}");
        }
        // The prediction follows from the size, corrected by the assembly: 0.3 of 732 s.
        assert!(line("factorisation", "about 3.7 min left"), "{text}");
        assert!(line("load program", "============            "), "{text}");
        assert!(line("load program", "about 0.50 s left"), "{text}");
    }

    #[test]
    fn all_is_done_at_the_end_only() {
        let text = [0.0, 0.2999, 0.9999, 1.0].map(per_cent);
        assert_eq!(text, ["  0", " 29", " 99", "100"]);
    }

    #[test]
    fn nothing_stops_a_run_that_nobody_stopped() {
        let mut progress = Progress::new(true, ProgressKind::Auto, Instant::now());
        progress.phase("factorisation");
        let flow = progress.increment(&HistoryRow::default(), 0.5);
        assert_eq!(flow, Flow::Continue);
        assert!(!progress.stop_requested());
    }
}
