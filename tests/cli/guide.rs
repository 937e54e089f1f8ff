//! The tutorials of the guide do what they say: their commands run, their numbers are what comes
//! out.

use super::{brinell, stdout, succeeds};
use serde_json::Value;
use std::path::Path;

fn page(name: &str) -> String {
    let path = format!("{}/data/guide/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

/// The blocks of a language.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let fence = format!("```{language}\n");
    let blocks = text.split(&fence).skip(1);
    blocks
        .map(|block| block.split("```").next().unwrap())
        .collect()
}

/// The words of a command, those in single quotes together.
fn words_of(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '\'' => quoted = !quoted,
            c if c.is_whitespace() && !quoted => words.push(String::new()),
            c => words.last_mut().unwrap().push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Runs the commands of a page in a folder; the summaries of what was run, by scene.
fn follow(text: &str, folder: &Path) -> Vec<(String, Value)> {
    let mut summaries = Vec::new();
    let lines = blocks(text, "sh").into_iter().flat_map(str::lines);
    for line in lines.filter_map(|line| line.strip_prefix("brinell ")) {
        let words: Vec<String> = words_of(line.split('#').next().unwrap())
            .into_iter()
            .map(|word| {
                match [".toml", ".csv", ".out"]
                    .iter()
                    .any(|end| word.ends_with(end))
                {
                    // A directory to start from lies beside the scene.
                    true if !word.contains('=') => folder.join(word).display().to_string(),
                    _ => word,
                }
            })
            .collect();
        let mut arguments: Vec<&str> = words.iter().map(String::as_str).collect();
        // Neither changes the numbers.
        if arguments[0] == "run" {
            arguments.extend(["--quiet", "--json", "--no-estimate", "--no-report"]);
        }
        let done = succeeds(&arguments);
        if arguments[0] == "run" {
            let summary = serde_json::from_str(&stdout(&done)).unwrap();
            summaries.push((arguments[1].to_string(), summary));
        }
    }
    summaries
}

/// A figure of a summary: states go by their name.
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn figure(summary: &Value, path: &str) -> Option<f64> {
    let mut at = summary;
    for part in path.split('.') {
        at = match at.as_array() {
            Some(states) => states.iter().find(|state| state["name"] == part)?,
            None => at.get(part)?,
        };
    }
    at.as_f64()
}

/// Paths and values of every row `| ... | unit | \`path\` | value |`.
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn rows(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.lines().filter_map(|line| {
        let cells: Vec<&str> = line.strip_prefix("| ")?.split('|').map(str::trim).collect();
        let path = cells.get(2)?.strip_prefix('`')?.strip_suffix('`')?;
        Some((path, *cells.get(3)?))
    })
}

/// Every row is what the runs above it give, to its digits.
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn check_rows(text: &str, summaries: &[(String, Value)]) -> usize {
    let mut checked = 0;
    for (path, value) in rows(text) {
        let digits = value
            .split_once('.')
            .map_or(0, |(_, decimals)| decimals.len());
        let computed = summaries
            .iter()
            .find_map(|(_, summary)| figure(summary, path));
        let computed = computed.unwrap_or_else(|| panic!("no run has {path}"));
        assert_eq!(format!("{computed:.digits$}"), value, "{path}");
        checked += 1;
    }
    checked
}

/// The meshes are beyond what the dense backend takes.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_roller_and_the_shaft_are_as_their_pages_say() {
    let folder = tempfile::tempdir().unwrap();
    for (name, rows) in [("roller.md", 9), ("shaft.md", 4)] {
        let text = page(name);
        let mut checked = 0;
        // A part of the page has runs and numbers of its own.
        for part in text.split("\n## ") {
            let summaries = follow(part, folder.path());
            checked += check_rows(part, &summaries);
        }
        assert_eq!(checked, rows, "{name}");
    }
}

/// The page of ISO 76, but for its groove, which takes long; and the loads by Hertz that are told.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_loads_of_iso_76_are_as_their_page_says() {
    let folder = tempfile::tempdir().unwrap();
    let text = page("iso76.md");
    let is_groove = |line: &&str| line.starts_with("brinell ") && line.contains("groove.toml");
    let lines = text.lines().filter(|line| !is_groove(line));
    let text = lines.map(|line| format!("{line}\n")).collect::<String>();
    let mut checked = 0;
    for part in text.split("\n## ") {
        let summaries = follow(part, folder.path());
        checked += check_rows(part, &summaries);
    }
    assert_eq!(checked, 8);
    for (scene, loads) in [
        ("c0", &["332.0", "732.8", "962.8"][..]),
        ("rolled", &["1415", "1759"]),
    ] {
        let made = folder.path().join(format!("{scene}.toml"));
        let made = std::fs::read_to_string(made).unwrap();
        for load in loads {
            assert!(made.contains(&format!("at {load} N")), "{load}: {made}");
            assert!(text.contains(&format!("| {load} |")), "{load}");
        }
    }
}

/// The figures that `brinell hardness` prints are those of its page: a thousandth, since the
/// stiffness is a ratio of small differences.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_hardness_test_is_as_its_page_says() {
    let folder = tempfile::tempdir().unwrap();
    let text = page("hardness.md");
    follow(&text, folder.path());
    let results = folder.path().join("test.out");
    let sheet = brinell(&["hardness", results.to_str().unwrap(), "--json"]);
    let sheet: Value = serde_json::from_str(&stdout(&sheet)).unwrap();
    for (key, value) in rows(&text) {
        let (found, value) = (figure(&sheet, key).unwrap(), value.parse::<f64>().unwrap());
        assert!((found / value - 1.0).abs() < 1e-3, "{key}: {found} {value}");
    }
    assert_eq!(rows(&text).count(), 13);
}

/// The commands of the first page run, on a coarser mesh.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_first_ball_rolls_as_its_page_says() {
    let text = page("first-ball.md").replace("--load 20", "--load 20 --resolution 4");
    let folder = tempfile::tempdir().unwrap();
    let summaries = follow(&text, folder.path());
    assert_eq!(summaries.len(), 3);
    let [usual, heavier, harder] = [0, 1, 2].map(|k| &summaries[k].1);
    let figure = |summary, path| figure(summary, path).unwrap();
    let load = |summary| figure(summary, "states.pressed.load");
    assert!((load(heavier) - 2.0 * load(usual)).abs() < 1e-9 * load(usual));
    let yields = |summary| figure(summary, "yield.load");
    assert!(yields(harder) > yields(usual));
}

/// The tensile test of the page, as a scene has it and from a file.
#[test]
fn the_tensile_test_is_taken_as_its_page_says() {
    let text = page("tensile-test.md");
    let folder = tempfile::tempdir().unwrap();
    let material: toml::Table = blocks(&text, "toml")[0].parse().unwrap();
    let rows = material["materials"]["steel"]["tensile_test"]
        .as_array()
        .unwrap();
    let number = |value: &toml::Value| value.as_float().unwrap();
    let line = |row: &toml::Value| {
        let row = row.as_array().unwrap();
        format!("{},{}\n", number(&row[0]), number(&row[1]))
    };
    let csv: String = rows.iter().map(line).collect();
    std::fs::write(folder.path().join("bar.csv"), csv).unwrap();
    follow(&text, folder.path());
    let scene = brinell::scene::Scene::load(folder.path().join("ball.toml")).unwrap();
    let steel = &scene.materials["steel"];
    let curve = steel.hardening_curve().unwrap();
    // The second row lies on the line of 210000 MPa but for the change of the section: the curve
    // begins there, and ends with the last row.
    assert!((curve[0][1] - 315.0 * 1.0015).abs() < 1.0, "{curve:?}");
    assert!(
        (curve.last().unwrap()[1] - 540.0 * 1.08).abs() < 1e-9,
        "{curve:?}"
    );
}

/// The sweep of the page, on a coarser mesh.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_sweep_runs_as_its_page_says() {
    let text = page("sweep.md").replace("--resolution 8", "--resolution 4");
    let text = text.replace("--resolution 6", "--resolution 4");
    let text = text.replace("--jobs 2", "--jobs 2 --no-estimate --no-report");
    let folder = tempfile::tempdir().unwrap();
    follow(&text, folder.path());
    let table = std::fs::read_to_string(folder.path().join("ball.sweep/sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 4, "{table}");
    // The softer the deeper.
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let column = rows.headers().unwrap().iter();
    let column = column.collect::<Vec<_>>();
    let dent = column
        .iter()
        .position(|c| *c == "states.unloaded.residual_depth")
        .unwrap();
    let depths: Vec<f64> = rows
        .records()
        .map(|r| r.unwrap()[dent].parse().unwrap())
        .collect();
    assert!(depths.is_sorted_by(|a, b| a > b), "{depths:?}");
    // "Three points, one factorisation".
    let mut rows = csv::Reader::from_path(folder.path().join("shared.sweep/sweep.csv")).unwrap();
    let column = rows
        .headers()
        .unwrap()
        .iter()
        .position(|c| c == "factorizations")
        .unwrap();
    let made = rows
        .records()
        .map(|r| r.unwrap()[column].parse::<usize>().unwrap());
    assert_eq!(made.collect::<Vec<_>>(), [1, 0, 0]);
}

/// The words of the page on ParaView are the names in the files.
#[test]
fn the_arrays_of_the_paraview_page_are_those_of_the_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = super::scene_path("contact_patch");
    succeeds(&[
        "run",
        &scene,
        "-q",
        "--no-report",
        "--out",
        out.to_str().unwrap(),
    ]);
    let fields = std::fs::read_dir(&out).unwrap().flatten();
    let fields = fields
        .map(|e| e.path())
        .find(|p| p.extension().is_some_and(|e| e == "vtu"));
    let bytes = std::fs::read(fields.unwrap()).unwrap();
    let file = String::from_utf8_lossy(&bytes);
    for array in [
        "displacement",
        "contact_pressure",
        "gap",
        "nodal_stress",
        "stress",
        "von_mises",
        "equivalent_plastic_strain",
        "yielded",
        "discretisation_error",
        "body",
    ] {
        assert!(file.contains(&format!("Name=\"{array}\"")), "{array}");
        assert!(
            page("outputs.md").contains(&format!("`{array}`")),
            "{array}"
        );
    }
    for array in [
        "von_mises",
        "equivalent_plastic_strain",
        "yielded",
        "displacement",
        "body",
    ] {
        assert!(
            page("paraview.md").contains(&format!("`{array}`")),
            "{array}"
        );
    }
}

/// Whether the keys of a part of a scene are those of the schema, whatever else it leaves out.
fn known(value: &toml::Value, schema: &Value, root: &Value) -> Result<(), String> {
    if let Some(name) = schema["$ref"].as_str() {
        return known(
            value,
            &root["$defs"][name.rsplit('/').next().unwrap()],
            root,
        );
    }
    for kind in ["anyOf", "oneOf", "allOf"] {
        if let Some(alternatives) = schema[kind].as_array() {
            let tried = alternatives.iter().map(|one| known(value, one, root));
            return tried.reduce(|a, b| if a.is_ok() { a } else { b }).unwrap();
        }
    }
    match value {
        toml::Value::Table(table) => {
            for (key, inner) in table {
                let below = match (&schema["properties"][key], &schema["additionalProperties"]) {
                    (Value::Null, Value::Null | Value::Bool(_)) => return Err(key.clone()),
                    (Value::Null, others) => others,
                    (own, _) => own,
                };
                known(inner, below, root).map_err(|why| format!("{key}.{why}"))?;
            }
            Ok(())
        }
        toml::Value::Array(items) => {
            let each = items.iter().map(|item| known(item, &schema["items"], root));
            each.collect()
        }
        _ => Ok(()),
    }
}

/// What the pages show of scenes has keys that scenes have.
#[test]
fn the_scenes_of_the_pages_have_known_keys() {
    let path = format!(
        "{}/data/schema/scene.schema.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let folder = format!("{}/data/guide", env!("CARGO_MANIFEST_DIR"));
    let mut checked = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let text = page(&name);
        for block in blocks(&text, "toml") {
            let scene: toml::Value =
                toml::from_str(block).unwrap_or_else(|why| panic!("{name}: {why}\n{block}"));
            known(&scene, &schema, &schema)
                .unwrap_or_else(|key| panic!("{name}: no scene has {key}:\n{block}"));
            checked += 1;
        }
    }
    assert!(checked > 15, "{checked}");
    let wrong = toml::from_str("load = [{ presure = 1.0 }]").unwrap();
    assert_eq!(known(&wrong, &schema, &schema), Err("load.presure".into()));
}
