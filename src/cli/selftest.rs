//! `brinell selftest`: runs hard cases on this machine and build.

use super::interrupt;
use super::progress::{Progress, ProgressKind};
use super::streams::print;
use super::table::{ColumnAlignment::*, Table, page_width};
use crate::error::{Error, ErrorKind, Result};
use crate::linalg;
use crate::selftest;
use clap::Args;

#[derive(Debug, Args)]
pub(super) struct SelftestArguments {
    /// Print the table as Markdown, as in data/stability.md
    #[arg(long)]
    pub markdown: bool,
    /// Show no progress
    #[arg(long, short)]
    pub quiet: bool,
}

/// Runs the hard cases and prints the outcome of each family.
pub(super) fn execute(arguments: &SelftestArguments) -> Result<()> {
    interrupt::listen(None, || {})?;
    let mut progress = Progress::new(
        arguments.quiet,
        ProgressKind::default(),
        std::time::Instant::now(),
    );
    let rows = selftest::run(&mut progress);
    progress.finish();
    let text = if arguments.markdown {
        selftest::page(&rows)
    } else {
        let mut table = Table::new(&[
            (Text, "family"),
            (Text, "figure"),
            (Number, "cases"),
            (Number, "worst"),
            (Number, "bound"),
            (Text, ""),
            (Text, "where the bound comes from"),
        ]);
        for row in &rows {
            table.row([
                row.family.to_string(),
                row.figure.to_string(),
                row.cases.to_string(),
                format!("{:.1e}", row.worst),
                format!("{:.1e}", row.bound),
                if row.passed() { "pass" } else { "FAIL" }.to_string(),
                row.source.to_string(),
            ]);
        }
        format!(
            "brinell {}, BLAS: {}\n\n{}",
            env!("CARGO_PKG_VERSION"),
            linalg::blas_name(),
            table.render(page_width())
        )
    };
    print(&text)?;
    let failed: Vec<&str> = rows
        .iter()
        .filter(|r| !r.passed())
        .map(|r| r.family)
        .collect();
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Error::new(
            ErrorKind::Inaccurate,
            format!("this build fails in: {}", failed.join(", ")),
        ))
    }
}
