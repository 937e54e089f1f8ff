//! `brinell convert`: a deck as a scene with its mesh.

use super::print;
use crate::deck::{self, Deck, Options};
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::{gmsh, inp};
use crate::scene::Field;
use clap::Args;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What `brinell convert` takes.
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
    /// Put a value over the scene's, as for `run`
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
}

/// Writes scene and mesh, and says where.
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
    };
    let read = Deck::read(path)?;
    let conversion = read.convert(options)?;
    let name = path.display().to_string();
    let mut scene = conversion.finish(&name, &arguments.overrides)?;
    let mesh = inp::mesh(&read)?;
    let mesh_path = arguments.out.with_extension("msh");
    let mut of_mesh = create(&mesh_path)?;
    let mut of_scene = create(&arguments.out)?;
    gmsh::write(&mesh, &mut of_mesh).map_err(|cause| failed(&mesh_path, cause))?;
    scene.mesh.file = mesh_path.file_name().map(PathBuf::from);
    // Temperatures of the deck's nodes go into the file of the mesh.
    let fields = scene
        .load
        .iter_mut()
        .filter_map(|load| load.temperature.as_mut());
    let mut nodal = fields
        .filter_map(|field| match field {
            Field::Nodal(of) => Some(&mut of.file),
            _ => None,
        })
        .peekable();
    if nodal.peek().is_some() {
        let values = read.node_temperatures()?;
        gmsh::node_data::write("temperature", &values, &mut of_mesh)
            .map_err(|cause| failed(&mesh_path, cause))?;
    }
    nodal.for_each(|file| *file = mesh_path.file_name().map(PathBuf::from).unwrap_or_default());
    let mut text = format!("# Made from {} by brinell convert.\n", file_name(path));
    for note in &conversion.account.taken {
        text.push_str(&format!("# {note}\n"));
    }
    text.push('\n');
    text.push_str(&scene.to_toml()?);
    of_scene
        .write_all(text.as_bytes())
        .map_err(|cause| failed(&arguments.out, cause))?;
    let (out, mesh) = (arguments.out.display(), mesh_path.display());
    print(&format!("{out}, its mesh {mesh}\n"))
}

/// A new file: one that is there is left as it is.
pub(super) fn create(path: &Path) -> Result<File> {
    File::create_new(path).map_err(|cause| match cause.kind() {
        std::io::ErrorKind::AlreadyExists => Error::new(
            ErrorKind::Io,
            format!(
                "{} exists and is left as it is: choose another name",
                path.display()
            ),
        ),
        _ => failed(path, cause),
    })
}

fn failed(path: &Path, cause: std::io::Error) -> Error {
    Error::io("write", path, cause)
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    crate::text::shown_in_line(&name.to_string_lossy()).into_owned()
}
