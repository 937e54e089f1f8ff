//! `brinell schema`.

use super::print;
use crate::error::{Error, Result};
use crate::{output, scene};
use clap::Args;

const AFTER_HELP: &str = "\
An editor with a TOML language server (taplo, Even Better TOML) takes it from the first line \
of a scene:
  #:schema ./scene.schema.json
Example: brinell schema > scene.schema.json";

/// What `brinell schema` takes.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(super) struct SchemaArguments {
    /// The schema of summary.json instead
    #[arg(long)]
    pub summary: bool,
}

/// Prints a schema.
pub(super) fn run(arguments: &SchemaArguments) -> Result<()> {
    if arguments.summary {
        return print(output::SUMMARY_SCHEMA);
    }
    let text = serde_json::to_string_pretty(&scene::schema())
        .map_err(|cause| Error::internal("the schema is not plain data").because(cause))?;
    print(&(text + "\n"))
}
