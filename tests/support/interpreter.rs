//! The Python that tests use.

use std::path::{Path, PathBuf};
use std::process::Command;

/// An interpreter that has the modules: `BRINELL_PYTHON`, else the environment that `make
/// python-tests` sets up in the target directory, else `python3`. A test that needs it does not
/// pass without it.
pub fn with(modules: &[&str]) -> PathBuf {
    let target = option_env!("CARGO_TARGET_TMPDIR").and_then(|folder| Path::new(folder).parent());
    let made = target.map(|target| target.join("python/bin/python"));
    let python = std::env::var_os("BRINELL_PYTHON")
        .map(PathBuf::from)
        .or(made.filter(|made| made.exists()))
        .unwrap_or_else(|| "python3".into());
    let script = format!("import {}", modules.join(", "));
    let imported = Command::new(&python).args(["-c", &script]).output();
    let why = match imported {
        Ok(output) if output.status.success() => return python,
        Ok(output) => String::from_utf8_lossy(&output.stderr).into_owned(),
        Err(error) => error.to_string(),
    };
    panic!(
        "{} cannot `{script}`: `make python-tests` installs what is missing, or set BRINELL_PYTHON \
         to an interpreter that has it\n{why}",
        python.display()
    );
}
