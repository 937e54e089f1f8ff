//! The Python package, built into an environment of its own: its tests, and the example against the Rust one.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(output: &Output) -> String {
    format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    )
}

/// Output where the command ends well, else what it printed.
fn attempt(command: &mut Command) -> Result<Output, String> {
    let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    match output.status.success() {
        true => Ok(output),
        false => Err(format!("{command:?}\n{}", text(&output))),
    }
}

fn done(command: &mut Command) -> Output {
    attempt(command).unwrap_or_else(|why| panic!("{why}"))
}

/// An environment with what the package is built and tested with, or why there is none. What the system has is used, the rest is
/// fetched.
fn environment(folder: &Path) -> Result<PathBuf, String> {
    attempt(Command::new("python3").args([
        "-c",
        "import sys; assert sys.version_info >= (3, 9), 'Python 3.9 or later is needed'",
    ]))?;
    let venv = folder.join("venv");
    attempt(
        Command::new("python3")
            .args(["-m", "venv", "--system-site-packages"])
            .arg(&venv),
    )?;
    let python = venv.join("bin").join("python");
    let absent: Vec<&str> = ["numpy", "scipy", "pytest"]
        .into_iter()
        .filter(|name| {
            attempt(Command::new(&python).args(["-c", &format!("import {name}")])).is_err()
        })
        .chain(["maturin>=1.9,<2"])
        .collect();
    attempt(
        Command::new(&python)
            .args(["-m", "pip", "install", "-q", "--disable-pip-version-check"])
            .args(["--retries", "1", "--timeout", "30"])
            .args(absent),
    )?;
    Ok(python)
}

/// Fetches the crates of the package; only a lock file that is behind is a fault.
fn crates() -> Result<(), String> {
    let manifest = root().join("ffi/python/Cargo.toml");
    let mut fetch = Command::new(env!("CARGO"));
    fetch
        .args(["fetch", "--locked", "--manifest-path"])
        .arg(manifest);
    let fetched = attempt(&mut fetch).map(drop);
    if let Err(why) = &fetched {
        assert!(
            !why.contains("--locked was passed"),
            "ffi/python/Cargo.lock is behind (cargo update --workspace --manifest-path ffi/python/Cargo.toml): {why}"
        );
    }
    fetched
}

#[test]
fn the_python_package_passes_its_tests_and_prints_the_same_digits() {
    let folder = tempfile::tempdir().unwrap();
    let python = match environment(folder.path()).and_then(|python| crates().map(|()| python)) {
        Ok(python) => python,
        Err(why) => {
            println!("skipped: the Python package cannot be built here: {why}");
            return;
        }
    };
    let bin = python.parent().unwrap();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(
        std::iter::once(bin.to_path_buf()).chain(std::env::split_paths(&path)),
    )
    .unwrap();
    // Dependencies that this build has compiled are taken from its target directory.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let mut arguments = "--profile dev".to_string();
    if !cfg!(feature = "cholmod") {
        arguments.push_str(" --no-default-features");
    }
    done(
        Command::new(&python)
            .args(["-m", "pip", "install", "-q", "--disable-pip-version-check"])
            .args(["--no-build-isolation", "--no-deps", "--no-index"])
            .arg(root().join("ffi/python"))
            .env("PATH", path)
            .env("CARGO_TARGET_DIR", target)
            .env("CARGO_NET_OFFLINE", "true")
            .env("MATURIN_PEP517_ARGS", arguments),
    );

    let tests = Command::new(&python)
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
        .arg(root().join("ffi/python/tests"))
        .current_dir(folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    assert!(tests.status.success(), "{}", text(&tests));

    let scene = folder.path().join("scene.toml");
    done(
        Command::new(env!("CARGO_BIN_EXE_brinell"))
            .args(["new", "ball-on-flat", "--resolution", "4", "--out"])
            .arg(&scene),
    );
    let example = root().join("ffi/examples/indentation.py");
    let printed = done(Command::new(&python).arg(example).arg(&scene));
    assert!(printed.stderr.is_empty(), "{}", text(&printed));
    let rust = done(&mut super::install::rust_example(&scene));
    assert_eq!(text(&printed), text(&rust));
}
