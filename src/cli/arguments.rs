//! The arguments of the command line.

use super::common_arguments::CommonArguments;
use super::run_arguments::{CheckArguments, ProgramArguments, RunArguments};
use super::study::StudyArguments;
use clap::{Parser, Subcommand};

const AFTER_HELP: &str = "\
Examples:
  brinell check data/scenes/cylinder_on_half_plane.toml
  brinell run data/scenes/cylinder_on_half_plane.toml
  brinell run long.toml --checkpoint=10 --resume
  brinell run press.toml --out results --set materials.steel.yield_stress=400 --set program.steps=40
  brinell yield press.toml --json
  brinell new ball-on-flat --radius 5 --load 20 > ball.toml
  brinell sweep ball.toml --vary materials.steel.yield_stress=400,500,600 --jobs 2
  brinell hertz --radius 5 --load 100 --material 100Cr6
  brinell view press.out
  brinell check press.inp

Exit codes:
    0  done
    2  the command line, the scene or the mesh is wrong, or asks for an effect
       that brinell does not have
    3  a file could not be read or written
    4  a body is not held: it can move freely
    5  the analysis failed: a solve did not converge, a target was not reached,
       or the memory did not suffice
    6  the load passed the limit load of the bodies
    7  inaccurate, the results are written: a state's quality misses its
       tolerance (do not trust it), a contact presses that a load has opened
       far, displacements are not small although NLGEOM asks for large ones,
       or a demanded accuracy was not reached; or a selftest failed
    8  contact reached the end of its candidates although the bodies go on there;
       what was computed before is written
   70  internal error, please report
  130  stopped by Ctrl-C, 143 by SIGTERM, 129 by SIGHUP (128 and the number of
       the signal); what was computed so far is written";

/// Presses elastic-plastic bodies together without friction and unloads them: where they touch, how
/// hard, where the material yields, and what dent stays.
///
/// A scene file (TOML) says what is pressed on what; see data/scenes for commented examples. The
/// scene chooses the units.
#[derive(Debug, Parser)]
#[command(name = "brinell", version, after_help = AFTER_HELP, max_term_width = 110)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run the load program: yield load, states at the targets, fields
    ///
    /// Writes summary.json, history.csv (a row per increment), contact.csv (a row per state and
    /// contact pair) and fields.pvd with .vtu files (for ParaView) to the output directory, and
    /// prints a summary. Ctrl-C ends the run after the current increment and writes the results up
    /// to then; a second Ctrl-C ends it at once.
    #[command(after_help = "Example: brinell run data/scenes/disc_in_plate.toml --out disc")]
    Run(ProgramArguments),
    /// Compute the yield load only: the load at which the material first yields
    ///
    /// Elastic, hence fast: no plastic increment is computed. Writes files only with --out.
    #[command(
        after_help = "Example: brinell yield data/scenes/cylinder_on_half_plane.toml --set \
                      mesh.cylinder_on_half_plane.resolution=32"
    )]
    Yield(RunArguments),
    /// Check the scene and predict what a run will cost, without running it
    ///
    /// Reads the scene, builds the mesh and the model, and prints which effects the run will
    /// simulate and why, its size, and the time and memory of the factorisation, predicted from the
    /// pattern of the matrix. For a deck it also prints what was understood, taken otherwise and
    /// ignored, and why.
    #[command(after_help = "Example: brinell check data/scenes/disc_in_plate.toml")]
    Check(CheckArguments),
    /// Write the scene and the mesh that a deck of Abaqus or CalculiX describes
    ///
    /// The scene (TOML) and its mesh (Gmsh) next to it can be edited and run: the results are those
    /// of the deck.
    #[command(
        after_help = "Example: brinell convert press.inp --out press.toml && brinell run press.toml"
    )]
    Convert(super::convert::ConvertArguments),
    /// Run a deck in the place of CalculiX's program ccx, for FreeCAD, PrePoMax and others
    ///
    /// Reads NAME.inp, leaves NAME.frd, NAME.dat, NAME.sta and NAME.cvg next to it, prints to
    /// standard output only. The exit code is 201 if there is an error, as with ccx.
    #[command(after_help = "Example: brinell ccx -i press")]
    Ccx(super::ccx::CcxArguments),
    /// Run hard cases on this machine and build: worst figure of each family, its bound, pass or
    /// fail
    ///
    /// Takes less than a minute. The exit code is 7 if a family fails.
    Selftest(super::selftest::SelftestArguments),
    /// Show what accuracy costs: the error and the run time of other meshes, elements, increments,
    /// tolerances and algorithms
    ///
    /// Runs the scene with many settings, cheapest first, and writes accuracy.json, accuracy.csv
    /// and log-log plots of error over time. Errors are measured against the closed form if the
    /// scene names one, else against the values extrapolated from the finest meshes. Ctrl-C ends
    /// the study and keeps the runs done so far.
    #[command(
        after_help = "Example: brinell accuracy data/scenes/thick_cylinder.toml --budget 60s"
    )]
    Accuracy(StudyArguments),
    /// Run the scene with other values of some keys: a table, a CSV file and charts
    ///
    /// Every point is a run with a directory of its own. Ctrl-C ends the sweep and keeps the points
    /// done so far; the same command continues where it stopped.
    Sweep(super::sweep::SweepArguments),
    /// Carry out the runs requested on standard input, one after the other, for `brinell sweep`
    #[command(hide = true)]
    Runs,
    /// List steels and alloys that a scene can refer to by name, with the sources of their numbers
    Materials(super::materials::MaterialsArguments),
    /// Print Hertz's closed forms for two bodies: pressure, half axes, approach, stresses below the
    /// surface, first yield
    ///
    /// For elastic bodies that touch in a point or along a line, given by their radii; no mesh, no
    /// run.
    Hertz(super::hertz::HertzArguments),
    /// Read an indentation by a ball from a result directory: Brinell hardness, mean pressure,
    /// pile-up, unloading stiffness and the modulus that follows from it
    #[command(
        after_help = "Example: brinell new hardness --load 3000 --out test.toml && brinell \
                            run test.toml && brinell hardness test.out"
    )]
    Hardness(super::hardness::HardnessArguments),
    /// Print a commented scene to start from, or list the available ones
    Example(super::example::ExampleArguments),
    /// Write a commented scene for a common problem from a few numbers
    New(super::new::NewArguments),
    /// Print the JSON schema of scenes, for editors that complete and check them
    Schema(super::schema::SchemaArguments),
    /// Write the report of a result directory again, or plot its main figures in the terminal
    ///
    /// Writes report.html and its figures from the contents of the directory, without running
    /// anything; prints the path of the report. Starts no server and opens no window.
    View(super::view::ViewArguments),
    /// Print completions for a shell
    #[command(after_help = "Example: brinell completions bash > \
                            ~/.local/share/bash-completion/completions/brinell")]
    Completions(super::completions::CompletionsArguments),
    /// Print the manual page (roff)
    #[command(after_help = "Example: brinell man | man -l -")]
    Man,
}

impl Command {
    /// Returns the arguments of a command that computes in this process.
    pub(super) fn common(&self) -> Option<&CommonArguments> {
        match self {
            Command::Run(program) => Some(&program.run.common),
            Command::Yield(run) => Some(&run.common),
            Command::Check(check) => Some(&check.common),
            Command::Accuracy(study) => Some(&study.common),
            _ => None,
        }
    }

    /// Whether only JSON lines may go to standard error.
    pub(super) fn progress_is_json(&self) -> bool {
        match self {
            Command::Run(program) => program.run.progress_is_json(),
            Command::Yield(run) => run.progress_is_json(),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Backend;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn the_exit_codes_of_the_help_are_those_of_the_error_kinds() {
        use crate::ErrorKind::*;
        let listed: Vec<u8> = AFTER_HELP
            .lines()
            .filter_map(|line| line.split_whitespace().next()?.parse().ok())
            .collect();
        // The text is no wider than the help without a terminal.
        assert!(AFTER_HELP.lines().all(|line| line.len() <= 100));
        for kind in [
            Input,
            Io,
            Unsupported,
            Unheld,
            Analysis,
            Collapse,
            Inaccurate,
            Stopped,
            Internal,
        ] {
            assert!(listed.contains(&kind.exit_code()), "{kind:?}");
        }
    }

    #[test]
    fn options_are_understood() {
        let line = "brinell run a.toml --solver dense --threads 2 --set a=1 --set b=2 -q --json";
        let arguments = Arguments::try_parse_from(line.split(' ')).unwrap();
        let Command::Run(ProgramArguments { run, restart }) = arguments.command else {
            panic!("not a run: {arguments:?}");
        };
        assert!(restart.checkpoint.is_none() && !restart.resume);
        assert_eq!(Backend::from(run.common.solver), Backend::Dense);
        assert_eq!(run.common.threads, Some(2));
        assert_eq!(run.common.overrides, ["a=1", "b=2"]);
        assert!(run.quiet && run.common.json && run.out.is_none());
        assert!(Arguments::try_parse_from(["brinell", "run", "a", "--threads", "0"]).is_err());
    }
}
