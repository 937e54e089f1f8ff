//! `brinell completions` and `brinell man`, made from the same definitions as the help.

use super::streams::print;
use crate::error::{Error, Result};
use clap::{Args, Command};
use clap_complete::Shell;

/// Arguments of `brinell completions`.
#[derive(Debug, Args)]
pub(super) struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Prints completions for the definition of the program.
pub(super) fn run(arguments: &CompletionsArguments, mut program: Command) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "brinell", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Prints the manual page: the program, then each command.
pub(super) fn man(mut program: Command) -> Result<()> {
    let failed = |cause| Error::internal("the manual page cannot be made").because(cause);
    program.build();
    let mut text = Vec::new();
    clap_mangen::Man::new(program.clone())
        .render(&mut text)
        .map_err(failed)?;
    for command in program.get_subcommands().filter(|c| c.get_name() != "help") {
        let man = clap_mangen::Man::new(command.clone());
        let heading = format!(".SH \"COMMAND {}\"\n", command.get_name().to_uppercase());
        text.extend(heading.into_bytes());
        man.render_synopsis_section(&mut text).map_err(failed)?;
        man.render_description_section(&mut text).map_err(failed)?;
        man.render_options_section(&mut text).map_err(failed)?;
    }
    print(&String::from_utf8_lossy(&text))
}
