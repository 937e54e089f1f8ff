//! Finds what CHOLMOD needs and writes the bindings that `suitesparse_sys` does not have: the
//! configuration functions of OpenBLAS (`ffi/openblas.h`) and of the OpenMP runtime
//! (`ffi/openmp.h`).
//!
//! `OPENBLAS_LIBRARY_DIR` names another place for it than the usual ones. SuiteSparse itself is
//! found by `suitesparse_sys`, whose build comes before this one.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=ffi/openblas.h");
    println!("cargo:rerun-if-changed=ffi/openmp.h");
    println!("cargo:rustc-check-cfg=cfg(openblas)");
    println!("cargo:rustc-check-cfg=cfg(openmp)");
    #[cfg(feature = "guide")]
    if let Err(cause) = guide::write() {
        eprintln!("error: the guide cannot be written as documentation: {cause}");
        std::process::exit(1);
    }
    #[cfg(feature = "mumps")]
    if let Err(message) = mumps::build() {
        eprintln!("error: {message}");
        std::process::exit(1);
    }
    #[cfg(feature = "cholmod")]
    if let Err(message) = native::configure() {
        eprintln!("error: {message}");
        std::process::exit(1);
    }
}

/// The pages of `data/guide` as modules, their links as those of documentation.
#[cfg(feature = "guide")]
mod guide {
    use std::fmt::Write;
    use std::path::{Path, PathBuf};
    use std::{env, fs, io};

    const PAGES: &str = "data/guide";
    /// The page that has the others in a list.
    const CONTENTS: &str = "README";

    pub fn write() -> io::Result<()> {
        println!("cargo:rerun-if-changed={PAGES}");
        let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
        let mut names = Vec::new();
        for entry in fs::read_dir(PAGES)? {
            let path = entry?.path();
            let stem = path.file_stem().and_then(|stem| stem.to_str());
            names.extend(stem.map(str::to_string));
        }
        names.sort();
        let mut modules = String::new();
        for name in &names {
            let text = fs::read_to_string(Path::new(PAGES).join(name).with_extension("md"))?;
            let file = out.join(format!("guide_{}.md", module(name)));
            fs::write(&file, linked(&text, &names))?;
            if name != CONTENTS {
                let file = file.display();
                let name = module(name);
                let _ = writeln!(
                    modules,
                    "#[doc = include_str!({:?})]\npub mod {name} {{}}",
                    file.to_string()
                );
            }
        }
        fs::write(out.join("guide.rs"), modules)
    }

    fn module(name: &str) -> String {
        name.to_lowercase().replace('-', "_")
    }

    /// Links to pages lead to modules; other files are named in the text.
    fn linked(text: &str, names: &[String]) -> String {
        let mut out = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("](") {
            out.push_str(before);
            let Some((target, later)) = after.split_once(')') else {
                break;
            };
            let page = target
                .strip_suffix(".md")
                .filter(|page| names.iter().any(|n| n == page));
            if page == Some(CONTENTS) {
                out.push_str("](mod@crate::guide)");
            } else if let Some(page) = page {
                let _ = write!(out, "](mod@crate::guide::{})", module(page));
            } else if target.starts_with("../") {
                if let Some(open) = out.rfind('[') {
                    out.remove(open);
                }
                let _ = write!(out, " (`{}`)", target.trim_start_matches("../"));
            } else {
                let _ = write!(out, "]({target})");
            }
            rest = later;
        }
        out + rest
    }
}

/// The part in C, compiled as programs of MPI are.
#[cfg(feature = "mumps")]
mod mumps {
    use std::process::Command;

    const SHIM: &str = "src/linalg/mumps/shim.c";
    const REMEDY: &str = "install MUMPS and OpenMPI (Debian, Ubuntu: `make setup-mpi`), or build \
                          without the feature `mumps`";

    pub fn build() -> Result<(), String> {
        println!("cargo:rerun-if-changed={SHIM}");
        let mut shim = cc::Build::new();
        shim.file(SHIM).warnings(true);
        for flag in flags("--showme:incdirs")? {
            shim.include(flag);
        }
        shim.try_compile("brinell_mumps")
            .map_err(|cause| format!("{SHIM} does not compile ({cause}): {REMEDY}"))?;
        for directory in flags("--showme:libdirs")? {
            println!("cargo:rustc-link-search=native={directory}");
        }
        println!("cargo:rustc-link-lib=dylib=dmumps");
        println!("cargo:rustc-link-lib=dylib=mpi");
        Ok(())
    }

    /// What OpenMPI's compiler adds.
    fn flags(question: &str) -> Result<Vec<String>, String> {
        let answer = Command::new("mpicc").arg(question).output();
        let answer = answer
            .ok()
            .filter(|answer| answer.status.success())
            .ok_or_else(|| format!("there is no `mpicc` of OpenMPI: {REMEDY}"))?;
        let words = String::from_utf8_lossy(&answer.stdout).into_owned();
        Ok(words.split_whitespace().map(str::to_string).collect())
    }
}

#[cfg(feature = "cholmod")]
mod native {
    use std::env;
    use std::path::{Path, PathBuf};
    use std::process::Command;

    /// What to install, in the words of the reader's package manager.
    const REMEDY: &str = "install SuiteSparse, OpenBLAS and libclang (Debian, Ubuntu: `apt-get \
                          install libsuitesparse-dev libopenblas-dev libclang-dev`), or build \
                          without CHOLMOD, in Rust alone: `cargo build --release \
                          --no-default-features --features faer,cli`";

    pub fn configure() -> Result<(), String> {
        println!("cargo:rerun-if-env-changed=OPENBLAS_LIBRARY_DIR");
        write_bindings("openblas", "openblas_.*|dpotrf_")?;
        write_bindings("openmp", "omp_.*")?;
        match openblas_directory() {
            Some(directory) => {
                // Linked directly it comes before the libblas that CHOLMOD asks for, so its
                // kernels are used whatever BLAS the system's alternatives point to.
                println!("cargo:rustc-link-search=native={}", directory.display());
                println!("cargo:rustc-link-lib=dylib=openblas");
                println!("cargo:rustc-cfg=openblas");
            }
            None => println!(
                "cargo:warning=no OpenBLAS found: CHOLMOD uses the system's BLAS, which may be \
                 several times slower (Debian: libopenblas-dev; elsewhere set OPENBLAS_LIBRARY_DIR)"
            ),
        }
        // The runtime that CHOLMOD itself was linked with, as every GNU compiler has it.
        if has_openmp_runtime() {
            println!("cargo:rustc-link-lib=dylib=gomp");
            println!("cargo:rustc-cfg=openmp");
        }
        Ok(())
    }

    /// Asked for a library that it does not have, the compiler answers with the bare name.
    fn has_openmp_runtime() -> bool {
        Command::new("cc")
            .arg("-print-file-name=libgomp.so")
            .output()
            .is_ok_and(|answer| {
                let path = String::from_utf8_lossy(&answer.stdout).trim().to_owned();
                let path = Path::new(&path);
                path.is_absolute() && path.exists()
            })
    }

    /// bindgen panics where it finds no libclang: the panic becomes the message.
    fn write_bindings(name: &str, functions: &str) -> Result<(), String> {
        let out = env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: build with cargo")?;
        let path = PathBuf::from(out).join(format!("{name}.rs"));
        let header = format!("ffi/{name}.h");
        let generated = std::panic::catch_unwind(|| {
            bindgen::Builder::default()
                .header(&header)
                .allowlist_function(functions)
                .rust_target(bindgen::RustTarget::stable(89, 0).unwrap_or_default())
                .rust_edition(bindgen::RustEdition::Edition2024)
                .generate()
        })
        .map_err(|_| format!("bindgen found no libclang: {REMEDY}"))?
        .map_err(|e| format!("bindgen failed on {header} ({e}): {REMEDY}"))?;
        generated
            .write_to_file(&path)
            .map_err(|e| format!("cannot write {}: {e}", path.display()))
    }

    fn openblas_directory() -> Option<PathBuf> {
        if let Some(directory) = env::var_os("OPENBLAS_LIBRARY_DIR") {
            return Some(directory.into());
        }
        let architecture = env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
        let multiarch = format!("/usr/lib/{architecture}-linux-gnu");
        let name = match env::var("CARGO_CFG_TARGET_OS").as_deref() {
            Ok("macos") => "libopenblas.dylib",
            Ok("windows") => "libopenblas.dll.a",
            _ => "libopenblas.so",
        };
        [
            multiarch.as_str(),
            "/usr/lib",
            "/usr/lib64",
            "/usr/local/lib",
            "/opt/homebrew/opt/openblas/lib",
            "/usr/local/opt/openblas/lib",
        ]
        .into_iter()
        .map(PathBuf::from)
        .find(|directory| directory.join(name).exists())
    }
}
