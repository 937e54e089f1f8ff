//! What the README and the guide show is what the program does.

#[cfg(any(feature = "cholmod", feature = "faer"))]
use super::succeeds;
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn page(name: &str) -> String {
    std::fs::read_to_string(format!("{ROOT}/{name}")).unwrap()
}

/// The section of the README under a heading.
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn section(heading: &str) -> String {
    let text = page("README.md");
    let from = text
        .find(&format!("\n## {heading}\n"))
        .unwrap_or_else(|| panic!("there is no section {heading:?}"));
    let rest = &text[from + 4..];
    rest[..rest.find("\n## ").unwrap_or(rest.len())].to_string()
}

/// The bearing ball: the table is what its commands give, to the last digit.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_bearing_ball_dents_its_race_as_the_table_says() {
    let text = page("data/guide/bearing.md");
    let command = text
        .lines()
        .find(|l| l.starts_with("brinell new "))
        .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("race.toml");
    let scene = scene.to_str().unwrap();
    let arguments: Vec<&str> = command
        .split_whitespace()
        .skip(1)
        .map(|word| if word == "race.toml" { scene } else { word })
        .collect();
    succeeds(&arguments);
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|l| l.starts_with("| ") && l[2..].starts_with(|c: char| c.is_ascii_digit()))
        .map(|l| l.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), 3);
    for row in rows {
        let stress = format!("materials.steel.yield_stress={}", row[0]);
        let out = folder.path().join(row[0]);
        let run = succeeds(&[
            "run",
            scene,
            "--set",
            &stress,
            "-q",
            "--no-estimate",
            "--no-report",
            "--json",
            "--out",
            out.to_str().unwrap(),
        ]);
        let summary: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
        let states = summary["states"].as_array().unwrap();
        let pressed = states.iter().find(|s| s["name"] == "pressed").unwrap();
        let unloaded = states.last().unwrap();
        assert_eq!(unloaded["load"], 0.0);
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        let computed = [
            format!("{:.0}", number(&summary["yield"]["load"])),
            format!("{:.0}", number(&pressed["max_pressure"])),
            format!("{:.2}", 1e3 * number(&unloaded["residual_depth"])),
        ];
        assert_eq!(row[1..], computed, "yield stress {}", row[0]);
    }
}

/// The ten lines are a whole scene, and its table is what the program prints.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn the_ten_lines_print_what_is_shown() {
    let text = section("First run");
    let block = |language: &str| {
        let after = text.split(&format!("```{language}\n")).nth(1).unwrap();
        after.split("```").next().unwrap().to_string()
    };
    let scene = block("toml");
    assert!(scene.lines().count() <= 10);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ball.toml");
    std::fs::write(&file, scene).unwrap();
    let file = file.to_str().unwrap();
    let run = succeeds(&["run", file, "-q", "--no-estimate", "--no-report"]);
    let printed = String::from_utf8(run.stdout).unwrap();
    let shown = block("text");
    assert_eq!(shown.lines().count(), 7);
    // Figures to five digits: the sixth is of the machine's arithmetic.
    let words = |line: &str| -> Vec<String> {
        let rounded = |word: &str| match word.parse::<f64>() {
            Ok(number) => format!("{number:.4e}"),
            Err(_) => word.to_string(),
        };
        line.split_whitespace().map(rounded).collect()
    };
    for line in shown.lines() {
        let is_there = printed.lines().any(|other| words(other) == words(line));
        assert!(is_there, "{line}\n{printed}");
    }
}

/// Every link of the README and the guide leads to a file of this repository.
#[test]
fn links_lead_somewhere() {
    let guide = std::fs::read_dir(format!("{ROOT}/data/guide")).unwrap();
    let guide = guide.map(|entry| {
        let name = entry.unwrap().file_name().into_string().unwrap();
        format!("data/guide/{name}")
    });
    let mut links = 0;
    for name in guide.chain(["README.md".to_string(), "ffi/README.md".to_string()]) {
        let folder = std::path::Path::new(ROOT).join(&name);
        let folder = folder.parent().unwrap();
        for link in page(&name).split("](").skip(1) {
            let link = link.split(')').next().unwrap();
            if link.contains("://") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let linked = match file {
                "" => std::path::Path::new(ROOT).join(&name),
                _ => folder.join(file),
            };
            assert!(linked.exists(), "{name}: {link}");
            links += usize::from(!file.is_empty());
            if !heading.is_empty() {
                let page = std::fs::read_to_string(linked).unwrap().to_lowercase();
                let mut headings = page.lines().filter_map(|line| line.strip_prefix("## "));
                let is_there = headings.any(|text| text.replace(' ', "-") == heading);
                assert!(is_there, "{name}: {link}");
            }
        }
    }
    assert!(links > 40, "{links}");
}

/// Without features nothing in another language is compiled or linked.
#[test]
fn a_build_without_features_is_pure_rust() {
    let tree = |features: &[&str]| -> Vec<String> {
        let output = Command::new(env!("CARGO"))
            .current_dir(ROOT)
            .args(["tree", "-e", "normal,build", "--prefix", "none", "--locked"])
            .args(features)
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let text = String::from_utf8(output.stdout).unwrap();
        let names = text.lines().filter_map(|line| line.split(' ').next());
        names.map(str::to_string).collect()
    };
    let foreign = |name: &&String| {
        ["bindgen", "cc", "cmake", "pkg-config"].contains(&name.as_str())
            || name.starts_with("suitesparse")
            || name.ends_with("-sys")
    };
    for features in ["cli", "faer,cli"] {
        let without = tree(&["--no-default-features", "--features", features]);
        assert!(without.len() > 20, "{without:?}");
        // Of the kernel's and the terminal's own interface there are declarations only.
        let declared = |name: &String| ["linux-raw-sys", "windows-sys"].contains(&name.as_str());
        let found: Vec<&String> = without
            .iter()
            .filter(foreign)
            .filter(|n| !declared(n))
            .collect();
        assert!(found.is_empty(), "{found:?}");
    }
    assert!(
        tree(&[]).iter().any(|n| foreign(&n)),
        "the default has CHOLMOD"
    );
    // Who links the library has nothing of the program.
    let library = tree(&["--no-default-features", "--features", "cholmod"]);
    for of_program in [
        "clap",
        "ctrlc",
        "indicatif",
        "maud",
        "plotters",
        "signal-hook",
    ] {
        let is_there = |names: &[String]| names.iter().any(|name| name == of_program);
        assert!(!is_there(&library), "{of_program}");
    }
}
