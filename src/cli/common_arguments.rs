//! Arguments that several commands take.

use crate::accuracy::Effort;
use crate::linalg::Backend;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

const SET_HELP: &str = "\
Put a value over the scene's; may be repeated, later ones win.
KEY is the path of keys; entries of [[...]] lists go by number from 0 or by their name:
  --set kind=plane_stress
  --set mesh.cylinder_on_half_plane.resolution=32
  --set contact.0.interference=0.01
  --set load.press.history=constant
  --set 'program.targets=[{ yield = true }, { load_factor = 2.0 }]'
VALUE is TOML, or else taken as a string. A table is merged with the one in the scene, key by key;
a list replaces the list. KEY= without a value removes the key:
  --set 'materials.steel={ tangent_modulus = 2000.0 }' --set materials.steel.plastic_modulus=";

#[derive(Debug, Args)]
pub(super) struct CommonArguments {
    /// The scene file, or a deck of Abaqus or CalculiX (.inp)
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// The solver that factors the stiffness matrix
    #[arg(long, value_enum, value_name = "SOLVER", default_value_t)]
    pub solver: BackendName,
    /// Number of threads, at most 16 for each processor (or 64); by default as many as there are
    /// processors
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<u16>,
    /// Print one JSON object (the content of summary.json) instead of tables
    #[arg(long)]
    pub json: bool,
    /// Accept the results of steps with NLGEOM, which are computed with small strains and
    /// displacements, even if the run finds them not to be small
    #[arg(long)]
    pub small_strain: bool,
    #[arg(
        long = "set",
        value_name = "KEY=VALUE",
        help = "Put a value over the scene's (see --help)",
        long_help = SET_HELP
    )]
    pub overrides: Vec<String>,
}

/// Limit of the number of threads: the first number times the number of processors, or the second
/// number if that is larger. More threads would only wait for each other.
const MOST_THREADS: [usize; 2] = [16, 64];

fn threads(text: &str) -> Result<u16, String> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let most = (MOST_THREADS[0] * processors).max(MOST_THREADS[1]);
    match text.parse::<u16>() {
        Ok(threads) if (1..=most).contains(&usize::from(threads)) => Ok(threads),
        _ => Err(format!(
            "give a whole number from 1 to {most} (this machine has {processors} processors)"
        )),
    }
}

/// Options that limit the cost of the estimate of errors.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct EstimateArguments {
    /// How much the estimate of the errors may cost
    #[arg(long, value_enum, value_name = "EFFORT", default_value = "quick")]
    pub estimate: Estimate,
    /// Estimate no errors: --estimate none
    #[arg(long, conflicts_with = "estimate")]
    pub no_estimate: bool,
}

impl EstimateArguments {
    pub fn effort(self) -> Effort {
        match self.estimate {
            _ if self.no_estimate => Effort::None,
            Estimate::Quick => Effort::Quick,
            Estimate::Full => Effort::Full,
            Estimate::None => Effort::None,
        }
    }
}

/// Names of an [`Effort`] on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Estimate {
    /// No more time than the run itself
    Quick,
    /// The time that two meshes take on which every figure of the run can be read
    Full,
    /// Nothing: the errors are not estimated
    None,
}

/// A backend, by the name that users know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum BackendName {
    /// Sparse Cholesky of SuiteSparse
    Cholmod,
    /// Sparse Cholesky in Rust
    Faer,
    /// MUMPS over MPI: mpirun -n 4 brinell run SCENE --solver mumps
    Mumps,
    /// Dense matrices, by the textbook: a reference for small models
    Dense,
}

impl Default for BackendName {
    fn default() -> Self {
        match Backend::default() {
            Backend::Cholmod => BackendName::Cholmod,
            Backend::Faer => BackendName::Faer,
            Backend::Mumps => BackendName::Mumps,
            Backend::Dense => BackendName::Dense,
        }
    }
}

impl From<BackendName> for Backend {
    fn from(solver: BackendName) -> Self {
        match solver {
            BackendName::Cholmod => Backend::Cholmod,
            BackendName::Faer => Backend::Faer,
            BackendName::Mumps => Backend::Mumps,
            BackendName::Dense => Backend::Dense,
        }
    }
}
