//! The Python package, built into a folder of its own: its tests, and the example against the Rust
//! one.

use super::done;
use crate::support::program::{program, stderr};
use crate::support::root;
use std::path::PathBuf;
use std::process::{Command, Output};

fn text(output: &Output) -> String {
    format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        stderr(output)
    )
}

/// The Python package in a folder, as a wheel puts it there.
fn package(folder: PathBuf) -> PathBuf {
    let module = folder.join("brinell");
    std::fs::create_dir_all(&module).unwrap();
    for entry in std::fs::read_dir(root().join("ffi/python/brinell")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            std::fs::copy(&path, module.join(path.file_name().unwrap())).unwrap();
        }
    }
    let built = super::install::borders().join("lib_brinell.so");
    std::fs::copy(built, module.join("_brinell.abi3.so")).unwrap();
    folder
}

#[test]
fn the_python_package_passes_its_tests_and_prints_the_same_digits() {
    let folder = tempfile::tempdir().unwrap();
    let python = crate::support::interpreter::with(&["numpy", "scipy", "pytest"]);
    let package = package(folder.path().join("package"));
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
        program()
            .args(["new", "ball-on-flat", "--resolution", "4", "--out"])
            .arg(&scene),
    );
    let example = root().join("ffi/examples/indentation.py");
    // Where OpenBLAS does not know the processor, the library would warn of its kernels.
    let printed = done(crate::support::tools::with_these_kernels(
        Command::new(&python)
            .arg(example)
            .arg(&scene)
            .env("PYTHONPATH", &package),
    ));
    assert!(printed.stderr.is_empty(), "{}", text(&printed));
    let rust = done(&mut super::install::rust_example(&scene));
    assert_eq!(text(&printed), text(&rust));
}
