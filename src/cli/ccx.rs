//! `brinell ccx`: a replacement of CalculiX's program `ccx` for programs that start it.
//!
//! The command takes the arguments of ccx, leaves the files of ccx next to the deck, prints to
//! standard output only, and ends with the exit codes of ccx: 0, or 201 if there is an error, which
//! is printed in a line that begins with ` *ERROR`.

use super::streams::print;
use super::threads::start_threads;
use crate::analysis::Analysis;
use crate::deck::{Deck, Note, Options};
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::output::{self, JobFiles};
use crate::progress::{Flow, Observer};
use crate::results::{HistoryRow, Results};
use crate::scene::Formulation;
use clap::Args;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The exit code of ccx if there is an error.
const FAILED: u8 = 201;
/// Version of ccx whose command line and files are imitated.
const LIKE: &str = "2.20";

/// Arguments of `brinell ccx`.
#[derive(Debug, Args)]
pub(super) struct CcxArguments {
    /// The arguments of ccx: `-i NAME` or NAME, for the deck NAME.inp; `-v` for the version;
    /// `--small-strain` as for `run`
    #[arg(
        value_name = "ARGUMENTS",
        trailing_var_arg = true,
        allow_hyphen_values = true
    )]
    pub words: Vec<OsString>,
}

/// The task that a command line asks for.
enum CcxTask {
    Usage,
    Version,
    Job(Job),
}

/// A deck that is to be run.
struct Job {
    /// The path of the deck without its ending.
    name: PathBuf,
    options: Options,
}

impl CcxTask {
    /// Reads the arguments; some programs write a blank after `-i`.
    fn new(words: &[OsString]) -> CcxTask {
        let mut options = Options {
            increments: true,
            ..Options::default()
        };
        let (mut name, mut named) = (None, None);
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match word.to_string_lossy().trim() {
                "-v" => return CcxTask::Version,
                "-i" => named = words.next(),
                "--small-strain" => options.small_strain = true,
                "" => {}
                _ => name = name.or(Some(word)),
            }
        }
        let Some(name) = named.or(name) else {
            return CcxTask::Usage;
        };
        let mut name = PathBuf::from(name);
        if crate::deck::is_deck(&name) {
            name.set_extension("");
        }
        CcxTask::Job(Job { name, options })
    }
}

/// Whether the file name of a path to this program ends with `ccx` or `-ccx`, ignoring case and
/// file extension.
pub(super) fn is_its_name(path: &OsStr) -> bool {
    let name = Path::new(path).file_stem().unwrap_or_default();
    let name = name.to_string_lossy().to_lowercase();
    name == "ccx" || name.ends_with("-ccx")
}

/// Does what ccx would do and returns the exit code.
pub(super) fn run(arguments: &CcxArguments, start: Instant) -> u8 {
    let done = match CcxTask::new(&arguments.words) {
        CcxTask::Usage => {
            let _ = print("Usage: CalculiX.exe -i jobname\n");
            return FAILED;
        }
        CcxTask::Version => print(&format!(
            "\nThis is Version {LIKE} as brinell {} takes its place\n\n",
            env!("CARGO_PKG_VERSION")
        )),
        CcxTask::Job(job) => job.run(start),
    };
    match done {
        Ok(()) => 0,
        Err(error) => {
            let _ = print(&lines_of(&error));
            FAILED
        }
    }
}

impl Job {
    fn run(&self, start: Instant) -> Result<()> {
        let stars = "*".repeat(60);
        print(&format!(
            "\n{stars}\n\nbrinell {} in the place of CalculiX Version {LIKE}\n\n{stars}\n\n",
            env!("CARGO_PKG_VERSION")
        ))?;
        let files = JobFiles::new(&self.name);
        files.begin()?;
        let model = self.model()?;
        warn(&model.warnings)?;
        let mut analysis = Analysis::new(model, Backend::default())?;
        let results = analysis.run(&mut Increments)?;
        files.write(analysis.model(), &results)?;
        warn(&new_warnings(&results, analysis.model()))?;
        output::ending(&results)?;
        let line = "_".repeat(40);
        print(&format!(
            "\n Job finished\n\n{line}\n\nTotal CalculiX Time: {:.6}\n{line}\n",
            start.elapsed().as_secs_f64()
        ))
    }

    /// Returns the model of the deck. Its elements are fully integrated, as in ccx, if ccx
    /// integrates all linear elements of the deck fully.
    fn model(&self) -> Result<Model> {
        let path = with_ending(&self.name, "inp");
        let deck = Deck::read(&path)?;
        let conversion = deck.convert(self.options)?;
        let account = &conversion.account;
        let mut scene = conversion.finish(&path.display().to_string(), &[])?;
        warn_of(&account.taken)?;
        warn_of(&account.ignored)?;
        scene.file = Some(path);
        if deck.is_fully_integrated() {
            scene.mesh.formulation = Formulation::Full;
        }
        scene.warnings.clear();
        let threads = std::env::var("OMP_NUM_THREADS").ok();
        let threads = threads.and_then(|text| text.trim().parse::<usize>().ok());
        start_threads(threads.filter(|n| (1..=64).contains(n)))?;
        Model::new(&scene)
    }
}

/// Appends an ending to a path, after the whole name.
fn with_ending(name: &Path, ending: &str) -> PathBuf {
    let mut path = name.as_os_str().to_owned();
    path.push(".");
    path.push(ending);
    path.into()
}

/// Returns the warnings that the run added to those of the model.
fn new_warnings(results: &Results, model: &Model) -> Vec<String> {
    let known = |text: &&String| !model.warnings.contains(*text);
    results.warnings.iter().filter(known).cloned().collect()
}

fn warn(texts: &[String]) -> Result<()> {
    let lines = texts.iter().map(|text| message("WARNING in brinell", text));
    print(&lines.collect::<String>())
}

fn warn_of(notes: &[Note]) -> Result<()> {
    let line = |note: &Note| {
        let Note {
            place,
            keyword,
            text,
        } = note;
        message(
            &format!("WARNING reading *{keyword}"),
            &format!("{place}: {text}"),
        )
    };
    print(&notes.iter().map(line).collect::<String>())
}

/// Formats a message as ccx writes it: further lines are indented.
fn message(head: &str, text: &str) -> String {
    let text = text.replace('\n', "\n        ");
    format!(" *{head}: {text}\n\n")
}

/// Formats an error as ccx writes it; each refused keyword is an error of its own.
fn lines_of(error: &Error) -> String {
    let text = error.to_string();
    let mut out = String::new();
    let each: Vec<&str> = match error.kind() {
        ErrorKind::Unsupported => text.lines().collect(),
        _ => vec![&text],
    };
    for text in each {
        out.push_str(&match of_keyword(text) {
            Some((place, keyword, text)) => message(
                &format!("ERROR reading *{keyword}"),
                &format!("{place}: {text}"),
            ),
            None => message("ERROR in brinell", text),
        });
    }
    for cause in error.causes() {
        out.push_str(&format!("        caused by: {cause}\n"));
    }
    out
}

/// Splits a message `PLACE: *KEYWORD: TEXT` into place, keyword and text.
fn of_keyword(text: &str) -> Option<(&str, &str, &str)> {
    let (place, rest) = text.split_once(": *")?;
    let (keyword, text) = rest.split_once(": ")?;
    Some((place, keyword, text))
}

/// Prints each increment.
struct Increments;

impl Observer for Increments {
    fn increment(&mut self, row: &HistoryRow, _fraction: f64) -> Flow {
        let (increment, alpha, event) = (row.increment, row.alpha, &row.event);
        let _ = print(&format!(
            " increment {increment} attempt 1 \n load factor= {alpha:.6e} ({event})\n \
             iterations= {}\n\n",
            row.iterations
        ));
        Flow::Continue
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(words: &[&str]) -> Option<String> {
        let words: Vec<OsString> = words.iter().map(OsString::from).collect();
        match CcxTask::new(&words) {
            CcxTask::Job(job) => Some(job.name.display().to_string()),
            _ => None,
        }
    }

    #[test]
    fn the_command_line_is_that_of_ccx() {
        for words in [
            &["-i", "a/beam"][..],
            &["-i ", "a/beam"],
            &["a/beam"],
            &["a/beam.inp"],
            &["-i", "a/beam.inp", "-o", "exo"],
        ] {
            assert_eq!(name(words).as_deref(), Some("a/beam"), "{words:?}");
        }
        assert_eq!(name(&["-i", "v1.5"]).as_deref(), Some("v1.5"));
        for words in [&[][..], &["-i"], &["-v"], &["-i", "x", "-v"]] {
            assert_eq!(name(words), None, "{words:?}");
        }
    }

    #[test]
    fn the_program_is_known_by_its_name() {
        for path in ["ccx", "/usr/bin/brinell-ccx", "x/Brinell-CCX.exe"] {
            assert!(is_its_name(OsStr::new(path)), "{path}");
        }
        for path in ["brinell", "/opt/ccx/brinell", "accx", ""] {
            assert!(!is_its_name(OsStr::new(path)), "{path}");
        }
    }

    #[test]
    fn each_refused_keyword_is_an_error_of_its_own() {
        let text = "a.inp, line 3: *FRICTION: no\na.inp, line 9: *SHELL SECTION: none";
        let lines = lines_of(&Error::new(ErrorKind::Unsupported, text));
        let expected = " *ERROR reading *FRICTION: a.inp, line 3: no\n\n \
                        *ERROR reading *SHELL SECTION: a.inp, line 9: none\n\n";
        assert_eq!(lines, expected);
        let lines = lines_of(&Error::input("first\nsecond"));
        assert_eq!(lines, " *ERROR in brinell: first\n        second\n\n");
    }
}
