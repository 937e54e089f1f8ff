//! The structure that the project means to keep: module order, where `unsafe` lives, sizes, schema,
//! scenes.

mod house;
mod imports;
mod paper;

use crate::support::program::{program, succeeds, summary};
use crate::support::{root, scene_file};
use brinell::scene::Scene;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folders of Rust code.
const CODE: [&str; 5] = ["src", "tests", "benches", "examples", "ffi/examples"];

/// All files below `folder` with this ending, sorted.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    fn walk(folder: &Path, ending: &str, out: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, ending, out);
            } else if path.extension().is_some_and(|e| e == ending) {
                out.push(path);
            }
        }
    }
    let mut out = Vec::new();
    walk(&root().join(folder), ending, &mut out);
    out.sort();
    assert!(!out.is_empty(), "no .{ending} in {folder}");
    out
}

/// The path below the root, with `/`.
fn name(path: &Path) -> String {
    let below = path.strip_prefix(root()).unwrap();
    below.to_string_lossy().replace('\\', "/")
}

/// The code of a file without comments (a `//` inside a string ends the line too: that hides code,
/// it adds none).
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().map(|l| l.split("//").next().unwrap_or(""));
    lines.collect::<Vec<_>>().join("\n")
}

fn is_test(name: &str) -> bool {
    name.contains("/tests/") || name.ends_with("tests.rs")
}

/// The module a file belongs to: `src/mesh/gmsh/mod.rs` to `mesh`.
fn module(name: &str) -> &str {
    let below = name.strip_prefix("src/").unwrap();
    let end = below.find('/').unwrap_or(below.len() - ".rs".len());
    &below[..end]
}

/// First path segments that follow `crate::` in some code; of `crate::{a, b::c}` both.
fn imports(code: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String {
        let word = text.trim_start();
        let end = word
            .find(|c: char| !(c.is_alphanumeric() || c == '_'))
            .unwrap_or(word.len());
        word[..end].to_string()
    };
    let mut out = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let Some(list) = rest.strip_prefix('{') else {
            out.insert(word(rest));
            continue;
        };
        let mut depth = 0;
        let mut item = String::new();
        for c in list.chars() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    out.insert(word(&item));
                    item.clear();
                    continue;
                }
                _ => {}
            }
            item.push(c);
        }
        out.insert(word(&item));
    }
    out.remove("");
    out
}

#[test]
fn imports_are_found_in_every_form() {
    let found = imports("use crate::a::B; use crate::{c::{D, E}, f, G}; let x = crate::h::i();");
    let expected = ["a", "c", "f", "G", "h"].map(String::from);
    assert_eq!(found, BTreeSet::from(expected));
}

/// A module imports only from itself and from modules declared above it in `lib.rs`.
#[test]
fn modules_import_from_above_only() {
    let order: Vec<String> = code(&root().join("src/lib.rs"))
        .lines()
        .filter_map(|l| {
            let line = l.trim();
            let declared = line.trim_start_matches("pub ");
            let declared = declared.trim_start_matches("pub(crate) ");
            let name = declared.strip_prefix("mod ")?.strip_suffix(';')?;
            Some(name.to_string())
        })
        .collect();
    assert!(order.len() > 10, "{order:?}");
    let mut wrong = Vec::new();
    for path in files("src", "rs") {
        let name = name(&path);
        if ["src/lib.rs", "src/main.rs"].contains(&name.as_str()) {
            continue;
        }
        let own = order.iter().position(|m| m == module(&name));
        let own = own.unwrap_or_else(|| panic!("{name} belongs to no module of lib.rs"));
        for import in imports(&code(&path)) {
            // `Error`, `ErrorKind` and `Result` stand at the root, for `error`.
            if let Some(place) = order.iter().position(|m| *m == import)
                && place > own
            {
                wrong.push(format!("{name} imports from `{import}`, declared below"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Closed forms give sizes to generated meshes and to new scenes, a load, and what a scene is
/// compared with. What computes, estimates or reports knows none.
#[test]
fn closed_forms_stay_out_of_what_computes() {
    let allowed = |name: &str| {
        let module = module(name);
        ["analytical", "reference", "selftest", "cli", "scene"].contains(&module)
            || name.starts_with("src/mesh/generate/")
            // The traction of Kirsch's plate, which a scene may ask for as a load.
            || name == "src/model/loads.rs"
    };
    for path in files("src", "rs") {
        let name = name(&path);
        if name == "src/lib.rs" || name == "src/main.rs" || allowed(&name) {
            continue;
        }
        let text = code(&path);
        let text = text.split("#[cfg(test)]").next().unwrap_or("");
        let uses = imports(text).contains("analytical") && !is_test(&name);
        assert!(!uses, "{name} uses a closed form");
    }
}

#[test]
fn unsafe_is_at_home_in_one_place() {
    for path in files("src", "rs") {
        let name = name(&path);
        let text = code(&path);
        let uses = text
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .any(|word| word == "unsafe");
        let home = ["src/linalg/cholmod/", "src/linalg/mumps/", "src/capi"]
            .iter()
            .any(|folder| name.starts_with(folder))
            // Kernels for wide registers, and advice to the system on memory.
            || ["panel", "pages"].iter().any(|f| name == format!("src/linalg/sparse/{f}.rs"))
            // The allocator of the program.
            || name == "src/main.rs";
        assert!(home || !uses, "{name} has `unsafe`");
    }
}

#[test]
fn the_library_never_prints() {
    for path in files("src", "rs") {
        let name = name(&path);
        if name.starts_with("src/cli/") || name == "src/main.rs" || is_test(&name) {
            continue;
        }
        // What a file tests of itself stands at its end.
        let text = code(&path);
        let text = text.split("#[cfg(test)]").next().unwrap_or("");
        for macro_name in [
            "println!",
            "eprintln!",
            "print!",
            "eprint!",
            "dbg!",
            "todo!",
            "unimplemented!",
        ] {
            assert!(!text.contains(macro_name), "{name} has {macro_name}");
        }
    }
}

#[test]
fn files_have_at_most_500_lines() {
    let long: Vec<String> = CODE
        .iter()
        .flat_map(|folder| files(folder, "rs"))
        .map(|path| {
            (
                name(&path),
                std::fs::read_to_string(&path).unwrap().lines().count(),
            )
        })
        .filter(|(_, lines)| *lines > 500)
        .map(|(name, lines)| format!("{name}: {lines}"))
        .collect();
    assert!(long.is_empty(), "{long:#?}");
}

/// Rows of tables, which Markdown has in one line, and addresses are as long as they are.
#[test]
fn lines_have_at_most_100_columns() {
    let excused = |line: &str| {
        let text = line.trim_start().trim_start_matches(['/', '!']);
        text.trim_start().starts_with('|') || line.contains("://")
    };
    let mut long = Vec::new();
    let paths = CODE.map(|folder| files(folder, "rs"));
    for path in paths.concat() {
        let text = std::fs::read_to_string(&path).unwrap();
        for (number, line) in text.lines().enumerate() {
            if line.chars().count() > 100 && !excused(line) {
                long.push(format!("{}:{}", name(&path), number + 1));
            }
        }
    }
    assert!(long.is_empty(), "{long:#?}");
}

#[test]
fn every_scene_parses() {
    for path in files("data/scenes", "toml") {
        let scene = Scene::load(&path).unwrap_or_else(|e| panic!("{}: {e}", name(&path)));
        assert!(!scene.title.is_empty(), "{} has no title", name(&path));
    }
}

/// Every key that the program writes is in the schema, and every key of the schema is written.
#[test]
fn the_schema_has_the_keys_that_the_program_writes() {
    let out = tempfile::tempdir().unwrap();
    let dir = out.path().join("results");
    let mut run = program();
    run.args(["run", "-q", "--out"])
        .arg(&dir)
        .arg(scene_file("hard/interference"))
        // With yield, reference values and the angle of contact: an object of each kind.
        .args(["--set", "materials.steel.yield_stress=200"])
        .args(["--set", "materials.steel.plastic_modulus=20000"])
        .args(["--set", "program.targets=[{ load_factor = 10.0 }]"])
        .args([
            "--set",
            "reference=[{ quantity = \"states.0.load\", value = 1.0, source = \"none\" }]",
        ]);
    succeeds(&mut run);
    let found = summary(&dir);
    let schema: Value = serde_json::from_str(brinell::output::SUMMARY_SCHEMA).unwrap();
    let on_disk = std::fs::read_to_string(root().join("data/schema/summary.schema.json")).unwrap();
    assert_eq!(on_disk, brinell::output::SUMMARY_SCHEMA);
    if let Err(error) = jsonschema::validate(&schema, &found) {
        panic!("{error}");
    }
    let mut compared = 0;
    same_keys(&schema, &schema, &found, "summary", &mut compared);
    assert!(compared >= 8, "only {compared} objects compared");
    // What only solids have.
    succeeds(
        program()
            .args(["run", "-q", "--no-estimate", "--no-report", "--out"])
            .arg(&dir)
            .arg(scene_file("blocks_tet10")),
    );
    let solid = summary(&dir);
    if let Err(error) = jsonschema::validate(&schema, &solid) {
        panic!("{error}");
    }
    let parts = [
        ("yield", &solid["yield"], &schema["properties"]["yield"]),
        ("state", &solid["states"][0], &schema["$defs"]["state"]),
    ];
    for (path, value, described) in parts {
        same_keys(&schema, described, value, path, &mut compared);
    }
}

/// Keys of solids, which a plane run does not write.
const OF_SOLIDS: [&str; 2] = ["patches", "z"];

/// Follows `$ref` and the object among the alternatives of a nullable value.
fn resolve<'s>(root: &'s Value, schema: &'s Value) -> &'s Value {
    if let Some(reference) = schema["$ref"].as_str() {
        let pointer = reference.strip_prefix('#').unwrap();
        return resolve(root, root.pointer(pointer).unwrap());
    }
    for alternatives in ["anyOf", "oneOf"] {
        if let Some(list) = schema[alternatives].as_array() {
            let inner = list.iter().map(|s| resolve(root, s));
            if let Some(object) = inner.into_iter().find(|s| s["properties"].is_object()) {
                return object;
            }
        }
    }
    schema
}

fn same_keys(root: &Value, schema: &Value, value: &Value, path: &str, compared: &mut usize) {
    let schema = resolve(root, schema);
    match value {
        Value::Object(object) => {
            // Objects with free keys (bodies, phases) have no properties.
            let Some(known) = schema["properties"].as_object() else {
                return;
            };
            *compared += 1;
            let written: BTreeSet<&String> = object.keys().collect();
            let applies =
                |key: &&String| object.contains_key(*key) || !OF_SOLIDS.contains(&key.as_str());
            let described: BTreeSet<&String> = known.keys().filter(applies).collect();
            assert_eq!(written, described, "keys of {path}");
            for (key, value) in object {
                same_keys(root, &known[key], value, &format!("{path}.{key}"), compared);
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                same_keys(
                    root,
                    &schema["items"],
                    item,
                    &format!("{path}.{index}"),
                    compared,
                );
            }
        }
        _ => {}
    }
}
