//! Programs in C and C++ against the installed library print what the Rust program prints, also
//! under valgrind.

use super::done;
use crate::support::program::{program, stderr};
use crate::support::{root, tools};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

fn words(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stdout);
    text.split_whitespace().map(String::from).collect()
}

/// Features of this build: what is asked for with them is there already.
fn features() -> Vec<String> {
    let built = [
        ("capi", cfg!(feature = "capi")),
        ("cholmod", cfg!(feature = "cholmod")),
        ("faer", cfg!(feature = "faer")),
        ("mumps", cfg!(feature = "mumps")),
    ];
    let named: Vec<_> = built
        .iter()
        .filter(|(_, has)| *has)
        .map(|(name, _)| *name)
        .collect();
    let all = format!("cli,{}", named.join(","));
    // Named as the defaults they are part of, the crates below have the same identity.
    match cfg!(feature = "cholmod") {
        true => vec!["--features".into(), all],
        false => vec!["--no-default-features".into(), "--features".into(), all],
    }
}

/// The folder of what this build makes of `ffi`, from the library that the tests are linked to: C
/// library, Python package, examples.
pub fn borders() -> &'static Path {
    static BUILT: LazyLock<PathBuf> = LazyLock::new(|| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.current_dir(root()).args(["build", "-q"]);
        cargo.args(["--workspace", "--lib", "--example", "indentation"]);
        done(cargo.args(features()));
        let program = Path::new(env!("CARGO_BIN_EXE_brinell"));
        program.parent().unwrap().to_path_buf()
    });
    &BUILT
}

/// The Rust example on a scene.
pub fn rust_example(scene: &Path) -> Command {
    let mut example = Command::new(borders().join("examples/indentation"));
    example.arg(scene);
    example
}

/// Installs program, libraries and what belongs to them.
fn install(prefix: &Path) {
    done(
        Command::new("make")
            .current_dir(root())
            .arg("install")
            .arg(format!("PREFIX={}", prefix.display()))
            .arg(format!("PROGRAM={}", env!("CARGO_BIN_EXE_brinell")))
            .arg(format!("LIBRARIES={}", borders().display())),
    );
}

#[test]
fn programs_against_the_installed_library_print_the_same_digits() {
    for program in ["make", "cc", "c++", "pkg-config"] {
        if !tools::has(program) {
            return;
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let prefix = folder.path().join("installed");
    install(&prefix);
    the_program_is_installed(&prefix);
    let lib = prefix.join("lib");
    for file in [
        "libbrinell.so",
        "libbrinell.so.0",
        "libbrinell.a",
        "pkgconfig/brinell.pc",
    ] {
        assert!(lib.join(file).exists(), "{file}");
    }
    // A small scene: valgrind takes fifty times as long.
    let scene = folder.path().join("scene.toml");
    done(
        program()
            .args(["new", "ball-on-flat", "--resolution", "4", "--out"])
            .arg(&scene),
    );

    let package = |flags: &[&str]| -> Vec<String> {
        let mut command = Command::new("pkg-config");
        command
            .env("PKG_CONFIG_PATH", lib.join("pkgconfig"))
            .args(flags)
            .arg("brinell");
        words(&done(&mut command))
    };
    let build = |compiler: &str, flags: &[&str], source: &str, libraries: &[String]| -> PathBuf {
        let out = folder.path().join(format!("{source}.{}", libraries.len()));
        let mut command = Command::new(compiler);
        command
            .args(flags)
            .args(["-Wall", "-Wextra", "-Werror", "-O1", "-g", "-pthread", "-o"])
            .arg(&out);
        command
            .arg(root().join("ffi/examples").join(source))
            .args(package(&["--cflags"]))
            .args(libraries);
        done(&mut command);
        out
    };
    let shared = package(&["--libs"]);
    let c = build("cc", &["-std=c11"], "indentation.c", &shared);
    let cpp = build("c++", &["-std=c++17"], "indentation.cpp", &shared);
    let run = |program: &Path| -> String {
        let output = done(
            Command::new(program)
                .arg(&scene)
                .env("LD_LIBRARY_PATH", &lib),
        );
        assert!(
            output.stderr.is_empty(),
            "the library prints: {}",
            stderr(&output)
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let printed = run(&c);
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines[0], lines[1], "two threads");
    assert!(
        lines[2].starts_with("stopped with status 130 after 3 increments"),
        "{printed}"
    );
    assert!(
        printed.contains("refused with status 2: scene:1:"),
        "{printed}"
    );
    assert!(
        printed.contains("row 0 closes at t = 3.33333333333333"),
        "{printed}"
    );
    assert_eq!(printed, run(&cpp));

    let rust = done(&mut rust_example(&scene));
    assert_eq!(printed, String::from_utf8(rust.stdout).unwrap());

    let by_cmake = built_by_cmake(&prefix, folder.path());
    if let Some(program) = &by_cmake {
        assert_eq!(printed, run(program));
    }

    // The archive: all of the library inside the program.
    let mut inside = vec![lib.join("libbrinell.a").display().to_string()];
    inside.extend(
        package(&["--static", "--libs-only-l"])
            .into_iter()
            .filter(|l| {
                l != "-lbrinell"
                    && (cfg!(feature = "cholmod")
                        || !["-lcholmod", "-lklu", "-lcamd", "-lsuitesparseconfig"]
                            .contains(&l.as_str()))
            }),
    );
    if cfg!(feature = "mumps") {
        inside.extend(["-ldmumps", "-lmpi"].map(String::from));
    }
    assert_eq!(
        printed,
        run(&build("cc", &["-std=c11"], "indentation.c", &inside))
    );

    if tools::has("valgrind") {
        let memory = [
            "-q",
            "--error-exitcode=9",
            "--leak-check=full",
            "--show-leak-kinds=definite",
            "--errors-for-leak-kinds=definite",
        ];
        done(
            Command::new("valgrind")
                .args(memory)
                .arg(&c)
                .arg(&scene)
                .env("LD_LIBRARY_PATH", &lib)
                // One thread of BLAS and CHOLMOD: valgrind runs one at a time anyway.
                .env("OPENBLAS_NUM_THREADS", "1")
                .env("OMP_NUM_THREADS", "1"),
        );
    }
    everything_goes_again(&prefix);
}

/// The program runs from where it is, its manual page and completions are those it prints.
fn the_program_is_installed(prefix: &Path) {
    let program = prefix.join("bin/brinell");
    let version = done(Command::new(&program).arg("--version"));
    assert_eq!(words(&version), ["brinell", env!("CARGO_PKG_VERSION")]);
    // In the place of CalculiX's program.
    let version = done(Command::new(prefix.join("bin/brinell-ccx")).arg("-v"));
    assert_eq!(words(&version)[..3], ["This", "is", "Version"]);
    for (file, arguments) in [
        ("share/man/man1/brinell.1", &["man"][..]),
        (
            "share/bash-completion/completions/brinell",
            &["completions", "bash"],
        ),
        ("share/zsh/site-functions/_brinell", &["completions", "zsh"]),
        (
            "share/fish/vendor_completions.d/brinell.fish",
            &["completions", "fish"],
        ),
    ] {
        let printed = done(Command::new(&program).args(arguments)).stdout;
        assert_eq!(std::fs::read(prefix.join(file)).unwrap(), printed, "{file}");
    }
}

/// The C example by `find_package(brinell)`; `None` where there is no CMake.
fn built_by_cmake(prefix: &Path, folder: &Path) -> Option<PathBuf> {
    if !tools::has("cmake") {
        return None;
    }
    let (source, build) = (folder.join("cmake"), folder.join("cmake-build"));
    std::fs::create_dir(&source).unwrap();
    let example = root().join("ffi/examples/indentation.c");
    let version = env!("CARGO_PKG_VERSION");
    let project = format!(
        "cmake_minimum_required(VERSION 3.16)
project(indentation C)
find_package(Threads REQUIRED)
find_package(brinell {version} REQUIRED)
add_executable(indentation {})
target_link_libraries(indentation PRIVATE brinell::brinell Threads::Threads)
",
        example.display()
    );
    std::fs::write(source.join("CMakeLists.txt"), project).unwrap();
    let prefix = format!("-DCMAKE_PREFIX_PATH={}", prefix.display());
    done(
        Command::new("cmake")
            .arg("-S")
            .arg(&source)
            .arg("-B")
            .arg(&build)
            .arg(&prefix),
    );
    done(Command::new("cmake").arg("--build").arg(&build));
    // A version that is not there is not found.
    let newer = std::fs::read_to_string(source.join("CMakeLists.txt")).unwrap();
    let newer = newer.replace(&format!("brinell {version}"), "brinell 99.0");
    std::fs::write(source.join("CMakeLists.txt"), newer).unwrap();
    let refused = Command::new("cmake")
        .arg("-S")
        .arg(&source)
        .arg("-B")
        .arg(folder.join("cmake-newer"))
        .arg(&prefix)
        .output()
        .unwrap();
    assert!(!refused.status.success());
    Some(build.join("indentation"))
}

/// No file is left by `make uninstall`, and nothing that is not brinell's is touched.
fn everything_goes_again(prefix: &Path) {
    let other = prefix.join("bin/other");
    std::fs::write(&other, "mine").unwrap();
    let prefix_is = format!("PREFIX={}", prefix.display());
    done(
        Command::new("make")
            .current_dir(root())
            .arg("uninstall")
            .arg(prefix_is),
    );
    let mut left = Vec::new();
    let mut folders = vec![prefix.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            match entry.file_type().unwrap().is_dir() {
                true => folders.push(entry.path()),
                false => left.push(entry.path()),
            }
        }
    }
    assert_eq!(left, [other]);
}
