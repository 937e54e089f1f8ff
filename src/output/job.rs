//! The files that a run leaves beside a deck NAME.inp, in the forms of CalculiX.
//!
//! | file | what |
//! |---|---|
//! | NAME.frd | results at nodes ([`super::write_frd`]) |
//! | NAME.dat | tables ([`super::write_prints`]) |
//! | NAME.sta | a row per increment |
//! | NAME.cvg | a row per increment: iterations, closed contact pairs, residual |

use super::atomic;
use super::dat::fortran;
use super::{write_frd, write_prints};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::{Results, State, Status};
use crate::scene::Moment;
use std::io;
use std::path::{Path, PathBuf};

const STATUS_HEAD: &str = "SUMMARY OF JOB INFORMATION
  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME
";
// The spelling (C0NVERGENCE) is that of CalculiX.
const CONVERGENCE_HEAD: &str = "SUMMARY OF C0NVERGENCE INFORMATION
  STEP   INC  ATT   ITER     CONT.   RESID.        CORR.      RESID.      CORR.
                              EL.    FORCE         DISP       FLUX        TEMP.
                              (#)     (%)           (%)        (%)         (%)
";

/// The files of a deck, by the name of the deck without its ending.
#[derive(Debug, Clone)]
pub struct JobFiles {
    name: PathBuf,
}

impl JobFiles {
    /// Returns the files of the deck `NAME.inp`.
    pub fn new(name: &Path) -> Self {
        JobFiles {
            name: name.to_path_buf(),
        }
    }

    fn path(&self, ending: &str) -> PathBuf {
        let mut path = self.name.as_os_str().to_owned();
        path.push(".");
        path.push(ending);
        path.into()
    }

    /// Empties the files and removes NAME.frd, so that no results of an earlier run are taken for
    /// those of this one.
    ///
    /// # Errors
    /// `Io` naming the file.
    pub fn begin(&self) -> Result<()> {
        for (ending, text) in [("dat", ""), ("sta", STATUS_HEAD), ("cvg", CONVERGENCE_HEAD)] {
            atomic::replace(&self.path(ending), text.as_bytes())?;
        }
        let results = self.path("frd");
        match std::fs::remove_file(&results) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => {
                Err(Error::io("remove", &results, cause))
            }
            _ => Ok(()),
        }
    }

    /// Writes the files of a run, each whole or not at all.
    ///
    /// # Errors
    /// `Io` naming the file.
    pub fn write(&self, model: &Model, results: &Results) -> Result<()> {
        write_prints(&self.path("dat"), model, results)?;
        let (mut status, mut convergence) = (STATUS_HEAD.to_string(), CONVERGENCE_HEAD.to_string());
        for row in rows(model, results) {
            status.push_str(&row.status());
            convergence.push_str(&row.convergence());
        }
        atomic::replace(&self.path("sta"), status.as_bytes())?;
        atomic::replace(&self.path("cvg"), convergence.as_bytes())?;
        write_frd(&self.path("frd"), model, results)
    }
}

/// An increment of the deck: the part of the path from one state to the next.
struct DeckIncrement {
    step: usize,
    increment: usize,
    iterations: usize,
    /// Total time, time within the step, and length of the increment.
    times: [f64; 3],
    closed: usize,
    residual: f64,
}

/// Returns the increments of a run. The increments that brinell took within each are added up.
fn rows(model: &Model, results: &Results) -> Vec<DeckIncrement> {
    let moments = &model.scene.requests.moments;
    let mut behind = 0;
    let mut before = (0, 0.0);
    let states = results.states.iter().zip(moments);
    let row = |(state, moment): (&State, &Moment)| {
        let own = results.history.get(behind..state.increments);
        let own = own.unwrap_or_default();
        behind = state.increments;
        let from = if before.0 == moment.step {
            before.1
        } else {
            0.0
        };
        before = (moment.step, moment.step_time);
        let closed = state.pairs.iter();
        DeckIncrement {
            step: moment.step,
            increment: moment.increment,
            iterations: own.iter().map(|row| row.iterations).sum::<usize>().max(1),
            times: [
                moment.time.unwrap_or(state.alpha),
                moment.step_time,
                moment.step_time - from,
            ],
            closed: closed.filter(|pair| pair.status == Status::Closed).count(),
            residual: own.last().map_or(0.0, |row| row.residual),
        }
    };
    states.map(row).collect()
}

impl DeckIncrement {
    fn status(&self) -> String {
        let [total, of_step, of_increment] = self.times.map(short);
        let (step, increment, iterations) = (self.step, self.increment, self.iterations);
        format!(
            " {step:5} {increment:10} {:5} {iterations:5}  {total}  {of_step}  {of_increment}\n",
            1
        )
    }

    fn convergence(&self) -> String {
        let (step, increment, iterations) = (self.step, self.increment, self.iterations);
        let (closed, zero) = (self.closed, four(0.0));
        let residual = four(100.0 * self.residual);
        format!(
            " {step:5} {increment:5} {:5} {iterations:5} {closed:8}  {residual}  {zero}  {zero}  \
             {zero}\n",
            1
        )
    }
}

/// Formats a number with six digits after a leading zero.
fn short(value: f64) -> String {
    let text = format!("{value:.5E}");
    fortran(text.parse().unwrap_or(value)).replacen("0E", "E", 1)
}

/// Formats a number with four digits after a leading zero.
fn four(value: f64) -> String {
    let text = format!("{value:.3E}");
    fortran(text.parse().unwrap_or(value)).replacen("000E", "E", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected rows are those of ccx 2.20 for the same increment.
    #[test]
    fn rows_are_those_of_calculix() {
        let row = DeckIncrement {
            step: 1,
            increment: 2,
            iterations: 3,
            times: [0.01, 0.01, 0.005],
            closed: 112,
            residual: 0.0,
        };
        assert_eq!(
            row.status(),
            "     1          2     1     3  0.100000E-01  0.100000E-01  0.500000E-02\n"
        );
        assert_eq!(
            row.convergence(),
            "     1     2     1     3      112  0.0000E+00  0.0000E+00  0.0000E+00  0.0000E+00\n"
        );
    }
}
