//! Processes that run the points of a sweep one after the other, so that points of one elastic
//! structure share its factor ([`crate::substructure::sharing_factors`]).
//!
//! A worker receives a line of JSON on its standard input for each run: the words of its command.
//! It answers each with a line of JSON on its standard output: exit code and message. If a worker
//! ends in the middle of a run, the point has failed, and the next point gets another worker.

use crate::cli::interrupt;
use crate::cli::itself::itself;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Interval at which a run is checked.
const PATIENCE: Duration = Duration::from_millis(20);

/// The ending of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct Ended {
    /// Exit code; `None` if a signal ended the process.
    pub exit_code: Option<i32>,
    pub message: String,
}

/// Locks a mutex. Data are consistent even after a panic elsewhere: every change is one assignment.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Asks a process to stop after its current increment.
#[cfg(unix)]
pub(super) fn ask_to_stop(id: u32) {
    let pid = i32::try_from(id)
        .ok()
        .and_then(rustix::process::Pid::from_raw);
    if let Some(pid) = pid {
        // The process may have ended meanwhile.
        let _ = rustix::process::kill_process(pid, rustix::process::Signal::INT);
    }
}

/// Without signals a run cannot be asked to stop, so it runs to its end.
#[cfg(not(unix))]
pub(super) fn ask_to_stop(_: u32) {}

/// A worker, as the sweep sees it.
pub(super) struct Worker {
    child: Child,
    asked: Option<ChildStdin>,
    answers: Receiver<String>,
    said: Arc<Mutex<String>>,
}

impl Worker {
    /// Starts a worker.
    ///
    /// # Errors
    /// `Analysis` if the system cannot start a process.
    pub fn start() -> Result<Self> {
        let failed = || Error::analysis("cannot start a process for the runs of points");
        let mut command =
            itself().map_err(|cause| Error::analysis("cannot find this program").because(cause))?;
        command
            .arg("runs")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        // Ctrl-C in a terminal goes to the process group: with a group of their own the runs
        // receive it only from here, once.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn().map_err(|cause| failed().because(cause))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(asked), Some(stdout), Some(mut stderr)) = pipes else {
            return Err(failed());
        };
        let (tell, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(|line| line.ok()) {
                if tell.send(line).is_err() {
                    break;
                }
            }
        });
        let said: Arc<Mutex<String>> = Arc::default();
        let heard = Arc::clone(&said);
        std::thread::spawn(move || {
            let mut part = [0; 4096];
            while let Ok(n) = stderr.read(&mut part) {
                if n == 0 {
                    break;
                }
                lock(&heard).push_str(&String::from_utf8_lossy(&part[..n]));
            }
        });
        Ok(Worker {
            child,
            asked: Some(asked),
            answers,
            said,
        })
    }

    /// Returns the number of the process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Carries out a run; returns how it ended, and whether the worker can take another.
    ///
    /// # Errors
    /// `Analysis` if the system does not report how the process ended.
    pub fn run(&mut self, words: &[String]) -> Result<(Ended, bool)> {
        lock(&self.said).clear();
        let line = serde_json::to_string(words)
            .map_err(|cause| Error::internal("words are not plain data").because(cause))?;
        // A failed write means that the worker has ended, which its answers show.
        if let Some(asked) = &mut self.asked {
            let _ = writeln!(asked, "{line}").and_then(|()| asked.flush());
        }
        let mut is_asked = false;
        loop {
            match self.answers.recv_timeout(PATIENCE) {
                Ok(answer) => {
                    let ended = serde_json::from_str(&answer).map_err(|cause| {
                        Error::internal("a worker's answer is damaged").because(cause)
                    })?;
                    return Ok((ended, true));
                }
                Err(RecvTimeoutError::Disconnected) => return Ok((self.gone()?, false)),
                Err(RecvTimeoutError::Timeout) => {
                    if interrupt::requested() && !is_asked {
                        is_asked = true;
                        ask_to_stop(self.id());
                    }
                }
            }
        }
    }

    /// Returns how a worker ended that did not answer.
    fn gone(&mut self) -> Result<Ended> {
        let failed = |cause| Error::analysis("cannot tell how a run ended").because(cause);
        let status = self.child.wait().map_err(failed)?;
        let said = lock(&self.said);
        let lines = said.lines().map(str::trim).filter(|line| !line.is_empty());
        let message = lines.collect::<Vec<_>>().join(" ");
        Ok(Ended {
            exit_code: status.code(),
            message: message.trim_start_matches("error: ").to_string(),
        })
    }
}

impl Drop for Worker {
    /// Ends the worker by closing its input.
    fn drop(&mut self) {
        drop(self.asked.take());
        let _ = self.child.wait();
    }
}
