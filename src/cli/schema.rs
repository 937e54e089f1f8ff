//! `brinell schema`: the JSON schemas of scenes and of summaries.

mod page;

use super::streams::print;
use crate::error::{Error, Result};
use crate::{output, scene};
use clap::Args;

const AFTER_HELP: &str = "\
An editor with a TOML language server (taplo, Even Better TOML) takes it from the first line \
of a scene:
  #:schema ./scene.schema.json
Example: brinell schema > scene.schema.json";

/// Arguments of `brinell schema`.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(super) struct SchemaArguments {
    /// Print the schema of summary.json instead
    #[arg(long)]
    pub summary: bool,
    /// Print a page for readers instead, as in data/guide/scene.md
    #[arg(long)]
    pub markdown: bool,
}

const ABOUT_SCENES: &str = "\
Every key of a scene file, made from the types that read it by `brinell schema --markdown`. A key
that is not here causes an error with a suggestion. Units are the scene's own, any consistent
ones.";
const ABOUT_SUMMARIES: &str = "\
Every key of `summary.json`, made from its schema by `brinell schema --summary --markdown`. Numbers
are in the scene's units; one that is not finite is null. Keys keep their names once published.";

/// Prints a schema.
pub(super) fn run(arguments: &SchemaArguments) -> Result<()> {
    let not_plain = |cause| Error::internal("the schema is not plain data").because(cause);
    match (arguments.summary, arguments.markdown) {
        (true, false) => print(output::SUMMARY_SCHEMA),
        (true, true) => {
            let schema = serde_json::from_str(output::SUMMARY_SCHEMA).map_err(not_plain)?;
            print(&page::page(
                &schema,
                "Keys of summary.json",
                ABOUT_SUMMARIES,
            ))
        }
        (false, true) => print(&page::page(
            &scene::schema(),
            "Scene reference",
            ABOUT_SCENES,
        )),
        (false, false) => {
            let text = serde_json::to_string_pretty(&scene::schema()).map_err(not_plain)?;
            print(&(text + "\n"))
        }
    }
}
