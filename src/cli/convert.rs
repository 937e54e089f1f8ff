//! `brinell convert`: converts a deck to a scene with its mesh.

use super::fresh;
use super::streams::print;
use crate::deck::{self, Deck, Options};
use crate::error::{Error, Result};
use crate::mesh::{gmsh, inp};
use crate::scene::Field;
use clap::Args;
use std::path::{Path, PathBuf};

/// Arguments of `brinell convert`.
#[derive(Debug, Args)]
pub(super) struct ConvertArguments {
    /// The deck (.inp)
    #[arg(value_name = "DECK")]
    pub deck: PathBuf,
    /// File for the scene; its mesh gets the same name with the ending .msh
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Convert steps that ask for NLGEOM with small strains and displacements, instead of refusing
    /// them
    #[arg(long)]
    pub small_strain: bool,
    /// Override a value of the scene, as for `run`
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
}

/// Writes scene and mesh, and prints their paths.
pub(super) fn run(arguments: &ConvertArguments) -> Result<()> {
    let path = &arguments.deck;
    if !deck::is_deck(path) {
        return Err(Error::input(format!(
            "{}: a deck has the ending .inp",
            path.display()
        )));
    }
    let options = Options {
        small_strain: arguments.small_strain,
        ..Options::default()
    };
    let read = Deck::read(path)?;
    let conversion = read.convert(options)?;
    let name = path.display().to_string();
    let mut scene = conversion.finish(&name, &arguments.overrides)?;
    let mesh = inp::mesh(&read)?;
    let mesh_path = arguments.out.with_extension("msh");
    let name = mesh_path.file_name().map(PathBuf::from);
    let mut of_mesh = Vec::new();
    let failed = |cause| Error::io("write", &mesh_path, cause);
    gmsh::write(&mesh, &mut of_mesh).map_err(failed)?;
    scene.mesh.file.clone_from(&name);
    // Temperatures of the deck's nodes go into the file of the mesh.
    let mut is_heated = false;
    for load in &mut scene.load {
        if let Some(Field::Nodal(of)) = &mut load.temperature {
            of.file = name.clone().unwrap_or_default();
            is_heated = true;
        }
    }
    if is_heated {
        let values = deck::largest_changes(&read)?;
        gmsh::node_data::write("temperature", &values, &mut of_mesh).map_err(failed)?;
    }
    let mut text = format!("# Made from {} by brinell convert.\n", file_name(path));
    for note in &conversion.account.taken {
        text.push_str(&format!("# {note}\n"));
    }
    text.push('\n');
    text.push_str(&scene.to_toml()?);
    fresh::write(&[(&mesh_path, &of_mesh), (&arguments.out, text.as_bytes())])?;
    let (out, mesh) = (arguments.out.display(), mesh_path.display());
    print(&format!("{out}, its mesh {mesh}\n"))
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    crate::text::shown_in_line(&name.to_string_lossy()).into_owned()
}
