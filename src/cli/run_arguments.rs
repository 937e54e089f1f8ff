//! Arguments of the commands that run or check a scene.

use super::common_arguments::{CommonArguments, EstimateArguments};
use super::progress::ProgressKind;
use super::restart::RestartArguments;
use super::values::duration;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct ProgramArguments {
    #[command(flatten)]
    pub run: RunArguments,
    #[command(flatten)]
    pub restart: RestartArguments,
}

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    #[command(flatten)]
    pub common: CommonArguments,
    /// Directory for the results; if it is not given, `run` uses SCENE with the ending .out
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Run finer and finer meshes until the stated errors are within this: 1% for all quantities,
    /// load=0.5%,dent=2% for the named ones; like the scene's key `accuracy`
    #[arg(long, value_name = "DEMAND")]
    pub accuracy: Option<String>,
    /// Time for --accuracy, such as 60s or 10min: a mesh that would not fit is not started
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub budget: Option<f64>,
    #[command(flatten)]
    pub estimate: EstimateArguments,
    /// Do not write report.html or figures
    #[arg(long)]
    pub no_report: bool,
    /// File for tables of displacements, forces and stresses of all sets, as CalculiX prints them
    #[arg(long, value_name = "FILE")]
    pub dat: Option<PathBuf>,
    /// File for displacements, stresses, strains, forces and contact at the nodes, in the format of
    /// CalculiX (.frd); for a deck that asks for results they are also in fields.frd in the result
    /// directory
    #[arg(long, value_name = "FILE")]
    pub frd: Option<PathBuf>,
    /// How progress is shown on standard error
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub progress: ProgressKind,
    /// No progress and no warnings, only results and errors
    #[arg(long, short)]
    pub quiet: bool,
}

impl RunArguments {
    /// Whether only JSON lines may go to standard error.
    pub(super) fn progress_is_json(&self) -> bool {
        self.progress == ProgressKind::Json && !self.quiet
    }
}

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    pub common: CommonArguments,
    /// Also list the effects that are off, each with the reason
    #[arg(long)]
    pub effects: bool,
}
