//! `brinell example`: the commented scenes of the project, built into the program.

use super::streams::print;
use super::table::{ColumnAlignment, Table, page_width};
use crate::error::{Error, Result};
use clap::Args;

/// Arguments of `brinell example`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: brinell example ball_on_half_space > ball.toml && brinell run ball.toml"
)]
pub(super) struct ExampleArguments {
    /// Name of the example; without it the examples are listed
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
}

/// Name and text of an example.
type Example = (&'static str, &'static str);

macro_rules! examples {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../data/scenes/", $name, ".toml")))),*]
    };
}

/// All scenes of `data/scenes` that need no other file.
const EXAMPLES: &[Example] = examples![
    "ball_in_groove",
    "ball_on_flat_3d",
    "ball_on_half_space",
    "contact_patch",
    "crossed_cylinders",
    "cylinder_on_half_plane",
    "disc_in_plate",
    "fit_by_heat",
    "flat_punch",
    "nafems_cb1",
    "pin_in_hole",
    "shrink_fit",
    "square_punch",
    "thick_cylinder",
    "thick_sphere",
    "three_bodies",
];

/// Prints an example or the list of examples.
pub(super) fn run(arguments: &ExampleArguments) -> Result<()> {
    let Some(name) = &arguments.name else {
        let mut table = Table::new(&[
            (ColumnAlignment::Text, "example"),
            (ColumnAlignment::Text, "what"),
        ]);
        for (name, text) in EXAMPLES {
            table.row([name.to_string(), title(text).to_string()]);
        }
        return print(&table.render(page_width()));
    };
    match EXAMPLES.iter().find(|(known, _)| known == name) {
        Some((_, text)) => print(text),
        None => {
            let known: Vec<&str> = EXAMPLES.iter().map(|(name, _)| *name).collect();
            Err(Error::input(format!(
                "there is no example `{name}`; there are {}",
                known.join(", ")
            )))
        }
    }
}

/// Returns the title of a scene.
fn title(text: &str) -> &str {
    let line = text.lines().find_map(|l| l.strip_prefix("title = \""));
    line.and_then(|rest| rest.strip_suffix('"'))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn every_scene_that_stands_alone_is_an_example_and_reads() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .filter(|path| !std::fs::read_to_string(path).unwrap().contains("\nfile = "))
            .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        names.sort();
        let known: Vec<&str> = EXAMPLES.iter().map(|(name, _)| *name).collect();
        assert_eq!(known, names);
        for (name, text) in EXAMPLES {
            let scene = Scene::parse(text, name).unwrap();
            assert_eq!(scene.title, title(text), "{name}");
        }
    }
}
