//! Progress on standard error: a bar per phase on a terminal, a line now and then elsewhere, or JSON lines.
//!
//! Each JSON line is an object with `event` and `seconds` since the start:
//!
//! | `event` | further keys |
//! |---|---|
//! | `phase` | `name`, `predicted_seconds` (null where nothing is known to predict it from) |
//! | `increment` | `fraction` of the load program done, `seconds_left` (predicted; null at first), `row` (a row of `history.csv`) |
//! | `warning` | `message` |
//! | `stopping` | `message`: Ctrl-C was heard |
//! | `error` | `message`, `exit_code`: the last line of a run that failed |

use super::arguments::Shown as Wish;
use super::interrupt;
use super::number::significant;
use crate::progress::{Flow, Observer};
use crate::results::HistoryRow;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use serde_json::{Value, json};
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Between two lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(5);
/// Resolution of a bar, and its width.
const PARTS: u64 = 1000;
const WIDTH: usize = 24;
/// Seconds of assembly per freedom, and of ordering, factorisation and condensation per freedom and per power 3/2 of the freedoms (the
/// growth of nested dissection in the plane), on a processor of 2020. What the assembly takes here corrects the rest.
const ASSEMBLY: f64 = 1.3e-6;
const FACTORISATION: [f64; 2] = [2.5e-6, 7.75e-9];
/// Share of the run's own time that the estimate of its errors takes.
const ESTIMATE: f64 = 0.4;

/// Shows what an analysis does, and passes on the user's wish to stop it.
pub(super) struct Progress {
    shown: Shown,
    quiet: bool,
    started: Instant,
    /// When the first increment was accepted and how much of the program then lay behind.
    first: Option<(Instant, f64)>,
    /// The phase at hand and when it began.
    phase: Option<(String, Instant)>,
    /// Size of the model, once it is known.
    freedoms: f64,
    /// How much slower than expected this machine is.
    slower: f64,
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
    /// Progress of a run that began at `started`.
    pub fn new(quiet: bool, wish: Wish, started: Instant) -> Self {
        let bars_wanted = match wish {
            Wish::Auto => io::stderr().is_terminal(),
            wish => wish == Wish::Bar,
        };
        let shown = if quiet {
            Shown::Nothing
        } else if wish == Wish::Json {
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
            first: None,
            phase: None,
            freedoms: 0.0,
            slower: 1.0,
        }
    }

    /// The number of freedoms: phases are predicted from it.
    pub fn size(&mut self, freedoms: usize) {
        self.freedoms = freedoms as f64;
    }

    /// Shows what is being done now.
    pub fn start(&mut self, phase: &str) {
        if let Some((last, began)) = &self.phase
            && last == "assembly"
            && self.freedoms > 0.0
        {
            // Of a very small model only the clock's grain would be seen.
            let ratio = began.elapsed().as_secs_f64() / (ASSEMBLY * self.freedoms);
            self.slower = ratio.clamp(0.3, 10.0);
        }
        self.phase = Some((phase.to_string(), Instant::now()));
        let predicted = self.predicted(phase);
        match &mut self.shown {
            Shown::Nothing => {}
            Shown::Bars { all, bar } => {
                if let Some(last) = bar.take() {
                    last.finish_with_message("");
                }
                let next = all.add(new_bar(phase, predicted));
                next.enable_steady_tick(Duration::from_millis(100));
                *bar = Some(next);
            }
            Shown::Lines { .. } => {
                let about = predicted.filter(|s| *s >= 1.0);
                let about = about.map_or(String::new(), |s| format!(", about {}", rough(s)));
                self.line(&format!("{phase}{about}"));
            }
            Shown::Json => self.json(
                "phase",
                json!({ "name": phase, "predicted_seconds": predicted }),
            ),
        }
    }

    /// Seconds that a phase will take, where something is known to say so.
    fn predicted(&self, phase: &str) -> Option<f64> {
        let n = self.freedoms;
        match phase {
            _ if n == 0.0 => None,
            "assembly" => Some(ASSEMBLY * n),
            "factorisation" => {
                Some(self.slower * (FACTORISATION[0] * n + FACTORISATION[1] * n.powf(1.5)))
            }
            // The estimate has several phases of about one length.
            phase if phase.starts_with("error estimate") => {
                Some(0.25 * ESTIMATE * self.started.elapsed().as_secs_f64())
            }
            _ => None,
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
        json_line(self.started, event, content);
    }

    /// Takes the bars away.
    pub fn finish(&mut self) {
        if let Shown::Bars { all, bar } = &mut self.shown {
            if let Some(bar) = bar.take() {
                bar.finish();
            }
            // What cannot be cleared stays to be seen.
            let _ = all.clear();
        }
    }

    /// A failed write of progress is no reason to stop.
    fn line(&self, text: &str) {
        let seconds = self.started.elapsed().as_secs_f64();
        let _ = writeln!(io::stderr(), "[{seconds:7.1} s] {text}");
    }
}

/// Writes an event to standard error as a line of its own.
pub(super) fn json_line(started: Instant, event: &str, content: Value) {
    let seconds = started.elapsed().as_secs_f64();
    let mut line = json!({ "event": event, "seconds": seconds });
    if let (Value::Object(line), Value::Object(content)) = (&mut line, content) {
        line.extend(content);
    }
    let _ = writeln!(io::stderr(), "{line}");
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
            Shown::Bars { bar, .. } => {
                if let Some(bar) = bar {
                    bar.set_position((fraction.clamp(0.0, 1.0) * PARTS as f64) as u64);
                    bar.set_message(describe(row));
                }
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

/// The bar of a phase: name, what is done, time, time that is left. What is done is the share of the load program where
/// increments tell it, else the share of the predicted time, of which the last bit is only filled by the end.
fn new_bar(phase: &str, predicted: Option<f64>) -> ProgressBar {
    let done = move |state: &ProgressState| match (state.is_finished(), state.pos(), predicted) {
        (true, ..) => Some(1.0),
        (_, 1.., _) => Some(f64::from(state.fraction())),
        (_, 0, Some(predicted)) => Some((state.elapsed().as_secs_f64() / predicted).min(0.97)),
        _ => None,
    };
    let gauge = move |state: &ProgressState, out: &mut dyn fmt::Write| {
        let filled = done(state).map_or(0, |done| (done * WIDTH as f64) as usize);
        let rest = WIDTH - filled.min(WIDTH);
        let _ = write!(out, "{}{}", "=".repeat(WIDTH - rest), " ".repeat(rest));
    };
    let left = move |state: &ProgressState, out: &mut dyn fmt::Write| {
        let elapsed = state.elapsed().as_secs_f64();
        let left = match (state.is_finished(), state.pos(), predicted) {
            (true, ..) => None,
            (_, 1.., _) => {
                let done = f64::from(state.fraction());
                Some(elapsed * (1.0 - done) / done)
            }
            (_, 0, predicted) => predicted.map(|all| (all - elapsed).max(0.0)),
        };
        let _ = match left {
            Some(left) => write!(out, "about {} left", rough(left)),
            None => Ok(()),
        };
    };
    let bar = ProgressBar::with_draw_target(Some(PARTS), ProgressDrawTarget::hidden());
    let template = "{spinner} {prefix:34} [{gauge}] {elapsed:>4}  {left}  {wide_msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.with_key("gauge", gauge).with_key("left", left));
    }
    bar.with_prefix(phase.to_string())
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

    /// A terminal that keeps what is written to it.
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
        let mut progress = Progress::new(false, Wish::Bar, Instant::now());
        let target = ProgressDrawTarget::term_like_with_hz(Box::new(terminal.clone()), 255);
        progress.shown = Shown::bars(target);
        progress.start("mesh and model");
        progress.size(40_000_000);
        progress.start("assembly");
        std::thread::sleep(Duration::from_millis(30));
        progress.start("factorisation");
        std::thread::sleep(Duration::from_millis(250));
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
        }
        // Predicted by size, corrected by the assembly: 0.3 of 2060 s.
        assert!(line("factorisation", "about 10 min left"), "{text}");
        assert!(line("load program", "============            "), "{text}");
        assert!(line("load program", "about 1 s left"), "{text}");
    }

    #[test]
    fn nothing_stops_a_run_that_nobody_stopped() {
        let mut progress = Progress::new(true, Wish::Auto, Instant::now());
        progress.phase("factorisation");
        let flow = progress.increment(&HistoryRow::default(), 0.5);
        assert_eq!(flow, Flow::Continue);
        assert!(!progress.stop_requested());
    }
}
