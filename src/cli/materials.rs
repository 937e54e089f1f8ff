//! `brinell materials`: steels and alloys that a scene can refer to by name, with their sources.

use super::streams::print;
use super::table::{ColumnAlignment, Table, page_width};
use crate::error::{Error, Result};
use crate::number::{exact, trimmed};
use crate::scene::{Listed, Published, closest, materials};
use clap::Args;

/// Arguments of `brinell materials`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  brinell materials
  brinell materials S355
  brinell new ball-on-flat --material 100Cr6 --second-material S355 --load 100")]
pub(super) struct MaterialsArguments {
    /// Name of the material; without it all materials are listed
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
}

/// Prints the list, or a material's numbers with their sources.
pub(super) fn run(arguments: &MaterialsArguments) -> Result<()> {
    match &arguments.name {
        None => print(&list()),
        Some(name) => print(&details(name, of_list(name)?)),
    }
}

/// Returns the material of a name.
///
/// # Errors
/// `Input` with the names of the list, if it has no such material.
pub(super) fn of_list(name: &str) -> Result<&'static Listed> {
    Listed::of(name).ok_or_else(|| {
        let known: Vec<&str> = materials().iter().map(|(name, _)| name.as_str()).collect();
        let meant = closest(name, &known);
        let meant = meant.map_or(".".to_string(), |k| format!(", did you mean \"{k}\"?"));
        let known = known.join(", ");
        Error::input(format!(
            "there is no material \"{name}\" in the list{meant} There are {known}"
        ))
    })
}

fn list() -> String {
    let mut table = Table::new(&[
        (ColumnAlignment::Text, "material"),
        (ColumnAlignment::Number, "E\n[MPa]"),
        (ColumnAlignment::Number, "nu"),
        (ColumnAlignment::Number, "yield\nstress\n[MPa]"),
        (ColumnAlignment::Number, "tangent\nmodulus\n[MPa]"),
        (ColumnAlignment::Text, "what"),
    ]);
    for (name, listed) in materials() {
        let cell = |figure: Option<&Published>| match figure {
            Some(Published(value, _)) => trimmed(*value, 6),
            None => "-".to_string(),
        };
        table.row([
            name.clone(),
            cell(Some(&listed.youngs_modulus)),
            cell(Some(&listed.poissons_ratio)),
            cell(listed.yield_stress.as_ref()),
            cell(listed.tangent_modulus.as_ref()),
            listed.what.clone(),
        ]);
    }
    format!(
        "{}\nA scene takes one by its name, material = \"S355\"; `brinell materials NAME` has the \
         sources.\n",
        table.render(page_width())
    )
}

/// Returns the material as a table of a scene in N, mm and MPa would have it, except for the
/// density, and the sources.
fn details(name: &str, listed: &Listed) -> String {
    let mut text = format!("{name}: {}\n\n", listed.what);
    let mut table = Table::new(&[
        (ColumnAlignment::Text, "key"),
        (ColumnAlignment::Number, "value"),
        (ColumnAlignment::Text, "unit"),
        (ColumnAlignment::Text, "source"),
    ]);
    for (key, unit, Published(value, source)) in listed.figures() {
        table.row([
            key.to_string(),
            exact(*value),
            unit.to_string(),
            source.clone(),
        ]);
    }
    text.push_str(&table.render(page_width()));
    text
}
