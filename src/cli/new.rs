//! `brinell new`: a commented scene for a common problem from a few numbers. The other values that
//! a scene needs (the extent of the fine mesh, which states to write) are set from closed forms.

mod asked;
mod fit;
mod hardness;
mod iso76;
mod materials;
mod pressed;
mod profile;
mod punch;
mod raceways;
mod size;
mod solid;
mod text;

use super::convert::{self, ConvertArguments};
use super::fresh;
use super::streams::print;
use crate::error::{Error, Result};
use crate::mesh::gmsh;
use crate::scene::Scene;
use clap::{Args, Subcommand};
use std::path::{Path, PathBuf};
use text::Started;

/// Arguments of `brinell new`.
#[derive(Debug, Args)]
pub(super) struct NewArguments {
    #[command(subcommand)]
    pub problem: Option<ContactProblem>,
    /// A deck of Abaqus or CalculiX (.inp) to start from, in place of a problem: writes scene and
    /// mesh like `brinell convert`
    #[arg(long, value_name = "DECK")]
    pub from: Option<PathBuf>,
    /// File for the scene; without it the scene is printed
    #[arg(long, short, global = true, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// The problems. Units are N, mm and MPa.
#[derive(Debug, Subcommand)]
pub(super) enum ContactProblem {
    /// A ball is pressed on a flat and unloaded (axisymmetric)
    #[command(
        after_help = "Example: brinell new ball-on-flat --radius 5 --load 20 --out ball.toml && \
                      brinell run ball.toml"
    )]
    BallOnFlat(pressed::Ball),
    /// A ball is pressed into the groove of a race and unloaded (three dimensions)
    BallInGroove(solid::Groove),
    /// Two cylinders are pressed together at right angles and unloaded (three dimensions)
    CrossedCylinders(solid::Crossed),
    /// A roller is pressed on a flat and unloaded (plane strain; the load is per mm of length)
    #[command(
        after_help = "Example: brinell new roller-on-flat --radius 5 --load 400 --out roller.toml \
                      && brinell run roller.toml"
    )]
    RollerOnFlat(pressed::Pressed),
    /// A shaft in a bore: an interference fit, or with clearance and a load (plane stress)
    ShaftInBore(fit::Fit),
    /// A roller is pressed between the raceways of two rings and unloaded (plane strain; the load
    /// is per mm of length)
    #[command(
        after_help = "Example: brinell new roller-between-raceways --diameter 10 --inner-radius 20 \
                      --out bearing.toml && brinell run bearing.toml"
    )]
    RollerBetweenRaceways(raceways::Bearing),
    /// A flat rigid punch is pressed into a block (plane strain)
    Punch(punch::Punch),
    /// The load that leaves a dent of 1e-4 of the rolling element's diameter, as ISO 76 asks: a
    /// ball on a flat or in a groove, or a roller (its load is per mm of length)
    Iso76(iso76::StaticLoad),
    /// A ball is pressed into a flat and unloaded: a hardness test, by load or by depth
    /// (axisymmetric); `brinell hardness` reads its results
    Hardness(hardness::Hardness),
}

/// Writes the scene of a problem.
pub(super) fn run(arguments: &NewArguments) -> Result<()> {
    let problem = match (&arguments.problem, &arguments.from) {
        (Some(problem), None) => problem,
        (None, Some(deck)) => return from_deck(deck, arguments.out.as_ref()),
        _ => {
            return Err(Error::input(
                "give either a problem (brinell new --help lists them) or a deck (--from DECK)",
            ));
        }
    };
    let started = start(problem, arguments.out.as_deref())?;
    match &arguments.out {
        None => print(&started.text),
        Some(path) => print(&format!(
            "{0} written; run it with: brinell run {0}\n{1}",
            path.display(),
            started.note
        )),
    }
}

/// Makes the scene of a problem, written to the file `out` if there is one; a mesh is written next
/// to it.
///
/// # Errors
/// `Input` if the numbers make no scene; `Io` if a file exists already or cannot be written.
pub(super) fn start(problem: &ContactProblem, out: Option<&Path>) -> Result<Started> {
    let mesh_path = out.map(|out| out.with_extension("msh"));
    let started: Started = match problem {
        ContactProblem::RollerBetweenRaceways(bearing) => {
            let name = mesh_path.as_deref().and_then(Path::file_name);
            let name = name.and_then(|name| name.to_str()).ok_or_else(|| {
                Error::input("a mesh belongs to this scene: give --out FILE, it goes beside it")
            })?;
            raceways::scene(bearing, name)?
        }
        ContactProblem::BallOnFlat(ball) if ball.three_dimensional => {
            solid::ball_on_flat(&ball.pressed)?.into()
        }
        ContactProblem::BallOnFlat(ball) => pressed::scene(&ball.pressed, true)?.into(),
        ContactProblem::BallInGroove(groove) => solid::ball_in_groove(groove)?.into(),
        ContactProblem::CrossedCylinders(crossed) => solid::crossed_cylinders(crossed)?.into(),
        ContactProblem::RollerOnFlat(pressed) => pressed::scene(pressed, false)?.into(),
        ContactProblem::ShaftInBore(fit) => fit::scene(fit)?.into(),
        ContactProblem::Punch(given) => punch::scene(given)?.into(),
        ContactProblem::Iso76(asked) => iso76::scene(asked)?,
        ContactProblem::Hardness(test) => hardness::scene(test)?.into(),
    };
    Scene::parse(&started.text, "the new scene")?;
    if let Some(out) = out {
        let mut of_mesh = Vec::new();
        let mut files = vec![(out, started.text.as_bytes())];
        if let (Some(mesh), Some(path)) = (&started.mesh, &mesh_path) {
            gmsh::write(mesh, &mut of_mesh).map_err(|cause| Error::io("write", path, cause))?;
            files.push((path, &of_mesh));
        }
        fresh::write(&files)?;
    }
    Ok(started)
}

/// Writes the scene and mesh of a deck, and prints how to proceed.
fn from_deck(deck: &Path, out: Option<&PathBuf>) -> Result<()> {
    let out = out.map_or_else(|| deck.with_extension("toml"), PathBuf::clone);
    convert::run(&ConvertArguments {
        deck: deck.to_path_buf(),
        out: out.clone(),
        small_strain: false,
        overrides: Vec::new(),
    })?;
    print(&format!("run it with: brinell run {}\n", out.display()))
}
