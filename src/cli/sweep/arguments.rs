//! The arguments of a sweep.

use super::points::{Shard, Varied, varied};
use crate::cli::common_arguments::{CommonArguments, EstimateArguments};
use clap::Args;
use std::path::PathBuf;

const VARY_HELP: &str = "\
Values of a key of the scene, separated by commas; may be repeated: all combinations are run.
KEY is as of --set, values with commas of their own stand in brackets, braces or quotes:
  --vary materials.steel.yield_stress=400,500,600
  --vary 'load.0.force=[0.0, -10.0],[0.0, -20.0]'";

/// Arguments of `brinell sweep`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: brinell sweep ball.toml --vary materials.steel.yield_stress=400,500,600 \
                  --vary mesh.cylinder_on_half_plane.radius=5,10 --jobs 2"
)]
pub(in crate::cli) struct SweepArguments {
    #[command(flatten)]
    pub common: CommonArguments,
    #[arg(
        long,
        value_name = "KEY=A,B,...",
        required_unless_present = "points",
        value_parser = varied,
        help = "Values of a key, separated by commas (see --help)",
        long_help = VARY_HELP
    )]
    pub vary: Vec<Varied>,
    /// CSV file whose first line has keys of the scene: each line below it is a point, combined
    /// with all that --vary says
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
    /// Take the values of all --vary together, the first with the first, in place of all
    /// combinations
    #[arg(long, requires = "vary")]
    pub zip: bool,
    /// Run only the I-th of N shares of the points, for job arrays. Each share writes a record of
    /// its own; the same command without --shard gathers them all
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Run nothing: predict the time and the memory of each point and of the whole
    #[arg(long)]
    pub check: bool,
    /// Number of points that run at the same time; each takes its share of the threads
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = clap::value_parser!(u16).range(1..=256)
    )]
    pub jobs: u16,
    /// Directory for the points, the table (sweep.csv) and the charts; if it is not given, SCENE
    /// with the ending .sweep. Points that are finished in this directory are not run again
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Figures that the table and the charts show, such as yield.load or
    /// states.pressed.max_pressure; sweep.csv has all figures
    #[arg(long, value_name = "PATH,...", value_delimiter = ',')]
    pub show: Vec<String>,
    /// Accuracy to reach in each point, as for `brinell run`
    #[arg(long, value_name = "DEMAND")]
    pub accuracy: Option<String>,
    #[command(flatten)]
    pub estimate: EstimateArguments,
    /// Write no reports
    #[arg(long)]
    pub no_report: bool,
    /// No progress, only the table and errors
    #[arg(long, short)]
    pub quiet: bool,
}

impl SweepArguments {
    /// The scene's overrides, followed by those of a point.
    pub(super) fn overrides(&self, keys: &[String], values: &[String]) -> Vec<String> {
        let common = &self.common;
        let of_point = keys.iter().zip(values);
        let of_point = of_point.map(|(key, value)| format!("{key}={value}"));
        common.overrides.iter().cloned().chain(of_point).collect()
    }
}
