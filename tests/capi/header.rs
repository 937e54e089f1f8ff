//! The header in the repository is the one that the source says.

use crate::support::program::stderr;
use crate::support::root;
use std::path::Path;

const TOP: &str = "\
/* The C interface of brinell: elastoplastic contact without friction.
 *
 * Generated from src/capi by cbindgen; do not edit. To write it anew:
 *     BRINELL_WRITE_HEADER=1 cargo test --test all header
 *
 * Every function returns BRINELL_OK or a status; brinell_last_error() then states why, in the
 * thread that called. Handles are opaque and freed by their own function. Set the size of a
 * structure (sizeof) before handing it over. Handles may be used in different threads at once,
 * one handle by one thread at a time. See ffi/README.md.
 */";

fn generated() -> String {
    let config = cbindgen::Config {
        language: cbindgen::Language::C,
        header: Some(TOP.to_string()),
        include_guard: Some("BRINELL_H".to_string()),
        cpp_compat: true,
        documentation_style: cbindgen::DocumentationStyle::C99,
        style: cbindgen::Style::Both,
        usize_is_size_t: true,
        line_length: 110,
        ..cbindgen::Config::default()
    };
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in [
        "border",
        "options",
        "scene",
        "model",
        "conditions",
        "run",
        "results",
        "quantities",
        "patches",
        "structure",
    ] {
        builder = builder.with_src(root().join(format!("src/capi/{file}.rs")));
    }
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    // What Rust callers must hold to is said in words in the header's own terms.
    let text = String::from_utf8(text).unwrap();
    let mut lines: Vec<&str> = Vec::new();
    let mut in_safety = false;
    for line in text.lines() {
        let comment = line.trim_start().starts_with("//");
        if comment && line.contains("# Safety") {
            in_safety = true;
            while lines.last().is_some_and(|l| l.trim() == "//") {
                lines.pop();
            }
        }
        in_safety = in_safety && comment;
        if !in_safety {
            lines.push(line.trim_end());
        }
    }
    lines.join("\n") + "\n"
}

#[test]
fn the_header_is_the_one_that_the_source_says() {
    let path = root().join("ffi/include/brinell.h");
    let generated = generated();
    if std::env::var_os("BRINELL_WRITE_HEADER").is_some() {
        std::fs::write(&path, &generated).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == generated,
        "{} is not what src/capi says; write it anew: BRINELL_WRITE_HEADER=1 cargo test --test \
         all header",
        Path::new("ffi/include/brinell.h").display()
    );
    // Every exported function of the source stands in it.
    for file in std::fs::read_dir(root().join("src/capi")).unwrap() {
        let path = file.unwrap().path();
        if path.is_dir() {
            continue;
        }
        let text = std::fs::read_to_string(path).unwrap();
        for name in text.split("extern \"C\" fn ").skip(1) {
            let name: String = name
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect();
            assert!(
                name.is_empty() || generated.contains(&format!("{name}(")),
                "{name}"
            );
        }
    }
}

/// The lines of `ffi/README.md` are C that the header knows.
#[test]
fn the_lines_of_the_readme_compile() {
    let readme = std::fs::read_to_string(root().join("ffi/README.md")).unwrap();
    let lines = readme.split("```c\n").nth(1).unwrap();
    let lines = lines.split("```").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("readme.c");
    let program = format!("#include <brinell.h>\nint main(void) {{\n{lines}return dent > 0; }}\n");
    std::fs::write(&file, program).unwrap();
    let compiled = std::process::Command::new("cc")
        .args(["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I"])
        .arg(root().join("ffi/include"))
        .arg(&file)
        .output()
        .unwrap();
    let why = stderr(&compiled);
    assert!(compiled.status.success(), "{why}");
}
