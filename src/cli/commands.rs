//! The commands of the user.

use super::arguments::{Arguments, Command};
use super::streams::print;
use super::{
    completions, compute, convert, example, hardness, hertz, materials, new, runs, schema,
    selftest, study, sweep, view,
};
use crate::error::Result;
use crate::output;
use clap::CommandFactory;
use std::time::Instant;

/// Executes the command of the user.
pub(super) fn execute(arguments: &Arguments, start: Instant) -> Result<()> {
    match &arguments.command {
        Command::Run(program) => {
            let (text, results) = compute::run(program, start)?;
            print(&text)?;
            output::ending(&results)
        }
        Command::Yield(run) => {
            let (text, results) = compute::yield_load(run, start)?;
            print(&text)?;
            output::ending(&results)
        }
        Command::Check(check) => compute::check(check),
        Command::Convert(convert) => convert::run(convert),
        Command::Selftest(selftest) => selftest::execute(selftest),
        Command::Accuracy(arguments) => study::execute(arguments),
        Command::Sweep(sweep) => sweep::execute(sweep),
        Command::Runs => runs::serve(),
        Command::Materials(materials) => materials::run(materials),
        Command::Hertz(hertz) => hertz::run(hertz),
        Command::Hardness(hardness) => hardness::run(hardness),
        Command::Example(example) => example::run(example),
        Command::New(new) => new::run(new),
        Command::Schema(schema) => schema::run(schema),
        Command::View(view) => view::run(view),
        Command::Completions(completions) => completions::run(completions, Arguments::command()),
        Command::Man => completions::man(Arguments::command()),
        // The command `ccx` has its own exit codes and is run elsewhere.
        Command::Ccx(_) => Ok(()),
    }
}
