//! The Python package, built into a folder of its own: its tests, and the example against the Rust
//! one.

use crate::support::either;
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

/// Fetches the crates of the package: it is built without the network.
fn fetch_crates() {
    let manifest = root().join("ffi/python/Cargo.toml");
    let mut fetch = Command::new(env!("CARGO"));
    fetch
        .args(["fetch", "--locked", "--manifest-path"])
        .arg(manifest);
    if let Err(why) = attempt(&mut fetch) {
        panic!(
            "the crates of ffi/python cannot be fetched (is Cargo.lock behind? \
             cargo update --workspace --manifest-path ffi/python/Cargo.toml): {why}"
        );
    }
}

/// Where the programs of an interpreter's packages are.
fn scripts(python: &Path) -> PathBuf {
    let script = "import sysconfig; print(sysconfig.get_path('scripts'))";
    let printed = done(Command::new(python).args(["-c", script]));
    PathBuf::from(text(&printed).trim())
}

#[test]
fn the_python_package_passes_its_tests_and_prints_the_same_digits() {
    let folder = tempfile::tempdir().unwrap();
    let python = crate::support::interpreter::with(&["numpy", "scipy", "pytest", "maturin"]);
    fetch_crates();
    let bin = scripts(&python);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path =
        std::env::join_paths(std::iter::once(bin).chain(std::env::split_paths(&path))).unwrap();
    let package = folder.path().join("package");
    // Dependencies that this build has compiled are taken from its target directory.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let mut arguments = "--profile dev".to_string();
    if !cfg!(feature = "cholmod") {
        arguments.push_str(" --no-default-features");
    }
    // Nothing at the border depends on faer, and compiling it takes a minute.
    if cfg!(feature = "faer") && either(false, true) {
        arguments.push_str(" --features faer");
    }
    done(
        Command::new(&python)
            .args(["-m", "pip", "install", "-q", "--disable-pip-version-check"])
            .args(["--no-build-isolation", "--no-deps", "--no-index"])
            .arg("--target")
            .arg(&package)
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
        .env("PYTHONPATH", &package)
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
    let printed = done(
        Command::new(&python)
            .arg(example)
            .arg(&scene)
            .env("PYTHONPATH", &package),
    );
    assert!(printed.stderr.is_empty(), "{}", text(&printed));
    let rust = done(&mut super::install::rust_example(&scene));
    assert_eq!(text(&printed), text(&rust));
}
