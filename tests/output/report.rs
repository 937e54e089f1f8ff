//! `report.html` and its figures: complete, self-contained, well formed, the same from run to run.

use crate::support::program::{program, stderr, succeeds, summary};
use crate::support::svg::{self, Picture};
use crate::support::{limit, scene_file};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Scenes of every kind, small: contact, none, axisymmetric, elastic, interference, several bodies,
/// quadratic elements.
pub const SCENES: [(&str, &[&str]); 6] = [
    (
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=4"],
    ),
    (
        "ball_on_half_space",
        &["mesh.cylinder_on_half_plane.resolution=4"],
    ),
    ("disc_in_plate", &["mesh.disc_in_plate.resolution=30"]),
    ("thick_cylinder", &[]),
    ("three_bodies", &[]),
    ("contact_patch", &[]),
];

pub fn write_report_of(scene: &str, overrides: &[&str], out: &Path) {
    let mut command = program();
    command.args(["run", "-q", "--out"]).arg(out);
    command.arg(scene_file(scene));
    for value in overrides {
        command.args(["--set", value]);
    }
    succeeds(&mut command);
}

fn figures(dir: &Path) -> BTreeMap<String, String> {
    std::fs::read_dir(dir)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "svg"))
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, std::fs::read_to_string(path).unwrap())
        })
        .collect()
}

/// The drawings inside a page.
pub fn drawings(page: &str) -> Vec<&str> {
    page.match_indices("<svg ")
        .map(|(at, _)| &page[at..at + page[at..].find("</svg>").unwrap() + "</svg>".len()])
        .collect()
}

/// Values of an attribute.
fn attributes<'p>(page: &'p str, name: &str) -> Vec<&'p str> {
    let key = format!(" {name}=\"");
    page.match_indices(&key)
        .map(|(at, _)| page[at + key.len()..].split('"').next().unwrap())
        .collect()
}

#[test]
fn every_kind_of_scene_has_a_self_contained_well_formed_report() {
    let temporary = tempfile::tempdir().unwrap();
    for (scene, overrides) in SCENES {
        let dir = temporary.path().join(scene);
        write_report_of(scene, overrides, &dir);
        let page = std::fs::read_to_string(dir.join("report.html")).unwrap();
        let summary = summary(&dir);

        // Nothing is fetched: addresses are anchors, files beside the page, or data.
        for address in attributes(&page, "href")
            .into_iter()
            .chain(attributes(&page, "src"))
        {
            let inside = address.starts_with('#') || address.starts_with("data:");
            assert!(inside || dir.join(address).exists(), "{scene}: {address}");
        }
        for word in ["<script", "@import", "url(", "javascript:"] {
            assert!(!page.contains(word), "{scene}: {word}");
        }

        // Every colour by name is defined, every anchor is there once.
        let defined: BTreeSet<&str> = page
            .split("--")
            .skip(1)
            .filter_map(|t| t.split_once(':'))
            .map(|(n, _)| n)
            .collect();
        for used in page.split("var(--").skip(1) {
            let used = used.split(')').next().unwrap();
            assert!(defined.contains(used), "{scene}: {used}");
        }
        let ids = attributes(&page, "id");
        let unique: BTreeSet<&&str> = ids.iter().collect();
        assert_eq!(ids.len(), unique.len(), "{scene}: {ids:?}");
        for anchor in attributes(&page, "href")
            .into_iter()
            .filter_map(|a| a.strip_prefix('#'))
        {
            assert!(ids.contains(&anchor), "{scene}: #{anchor}");
        }

        // As many figures in the page as files, all of them XML without images; each can be
        // enlarged.
        let files = figures(&dir);
        let (films, inline): (Vec<&str>, Vec<&str>) = drawings(&page)
            .into_iter()
            .partition(|drawing| drawing.contains("class=\"film"));
        assert_eq!(files.len(), inline.len(), "{scene}");
        // Films show pictures of the page again, each state in its turn.
        let of_states = |what: &str| files.keys().filter(|name| name.ends_with(what)).count();
        let states = of_states("_von_mises.svg");
        assert_eq!(films.is_empty(), states < 2, "{scene}");
        for film in films.iter().filter(|film| film.contains("_von_mises")) {
            assert_eq!(film.matches("<use ").count(), states, "{scene}");
            assert!(film.contains(&format!("film-{states}\"")), "{scene}");
        }
        for name in files.keys() {
            let name = name.trim_start_matches("report_").trim_end_matches(".svg");
            let link = format!("href=\"#fig-{name}\"");
            assert!(
                page.contains(&link) && ids.contains(&format!("fig-{name}").as_str()),
                "{name}"
            );
        }
        assert!(files.len() >= 4, "{scene}: {:?}", files.keys());
        for (name, text) in &files {
            assert!(name.starts_with("report_"), "{scene}: {name}");
            let xml =
                roxmltree::Document::parse(text).unwrap_or_else(|e| panic!("{scene} {name}: {e}"));
            assert!(!text.contains("var("), "{scene} {name}");
            assert!(
                !text.contains("<image") && !text.contains("base64"),
                "{scene} {name}"
            );
            let values = xml.descendants().flat_map(|n| n.attributes());
            for value in values.filter(|a| a.name() != "href") {
                let lost = value.value().contains("NaN") || value.value().contains("inf");
                assert!(!lost, "{scene} {name}: {value:?}");
            }
        }
        for text in inline {
            let xml = roxmltree::Document::parse(text).unwrap_or_else(|e| panic!("{scene}: {e}"));
            assert!(
                xml.root_element()
                    .attribute("aria-label")
                    .is_some_and(|l| !l.is_empty())
            );
        }

        // The mesh is there on demand, the scene at once.
        let (before, details) = page.split_once("<details>").expect(scene);
        assert!(before.contains("The whole model"), "{scene}");
        let details = details.split("</details>").next().unwrap();
        assert!(
            details.contains("<summary>Show the mesh") && details.contains("<svg "),
            "{scene}"
        );
        assert!(files.keys().any(|n| n.ends_with("_mesh.svg")), "{scene}");

        // Quality and what the numbers may be wrong by.
        for word in [
            "adhesion",
            "Condition of the factored matrix",
            "may be wrong by",
        ] {
            assert!(page.contains(word), "{scene}: {word}");
        }

        // What the summary says stands in the page.
        for state in summary["states"].as_array().unwrap() {
            assert!(
                page.contains(state["name"].as_str().unwrap()),
                "{scene}: {state}"
            );
        }
        for effect in summary["effects"].as_object().unwrap().keys() {
            assert!(page.contains(effect.as_str()), "{scene}: {effect}");
        }
        for row in summary["reference"].as_array().unwrap() {
            assert!(page.contains(row["quantity"].as_str().unwrap()), "{scene}");
        }
        assert_eq!(
            page.contains("Contact pressure at the states"),
            summary["contact_pairs"] != 0,
            "{scene}"
        );
        assert_eq!(
            page.contains("Yield load"),
            !summary["yield"].is_null(),
            "{scene}"
        );
        assert_eq!(
            files.keys().any(|n| n.contains("plastic_zone")),
            summary["states"]
                .as_array()
                .unwrap()
                .iter()
                .any(|s| s["plastic_points"] != 0),
            "{scene}"
        );
    }
}

/// Bands of colour are closed, each on the one below; the scale of colours rises; the ring is at
/// the element with the largest value and says it.
#[test]
fn pictures_are_bands_in_order_with_the_largest_value_marked() {
    let temporary = tempfile::tempdir().unwrap();
    let dir = temporary.path().join("out");
    let (scene, overrides) = SCENES[0];
    write_report_of(scene, overrides, &dir);
    let recorded = brinell::output::read(&dir).unwrap();
    let mesh = &recorded.model.mesh;
    let (mut n_pictures, mut n_magnified) = (0, 0);
    for (name, text) in figures(&dir) {
        let Some(rest) = name.strip_prefix("report_state_") else {
            continue;
        };
        if rest.contains("magnified") {
            check_magnified(&recorded, rest, &text);
            n_magnified += 1;
            continue;
        }
        // Each band says from where to where it is, where a pointer rests on it.
        let titles = text.matches("<title>").count();
        let bands = text.matches(" to ").count();
        // Nothing has yielded at first.
        let is_empty = rest.contains("plastic_zone") && titles == 0;
        assert!(
            is_empty || (titles > 2 && bands >= titles),
            "{name}: {titles}"
        );
        n_pictures += 1;
        let picture = Picture::read(&text);
        picture.check_bands(&name);
        let legend = picture.legend();
        assert!(
            legend.len() > 2 && legend.is_sorted_by(|a, b| a < b),
            "{name}: {legend:?}"
        );
        // One scale for both axes, to a unit over the numbers' distance.
        let [across, up] = [0, 1].map(|axis| picture.scale(axis)[0]);
        assert!((across / -up - 1.0).abs() < 0.01, "{name}: {across} {up}");
        if !rest.contains("von_mises") {
            continue;
        }
        let index: usize = rest[..2].parse().unwrap();
        let fields = recorded.results.states[index - 1].fields.as_ref().unwrap();
        let values = &fields.von_mises;
        let top = (0..values.len())
            .max_by(|&a, &b| values[a].total_cmp(&values[b]))
            .unwrap();
        let nodes = mesh.nodes(top).iter().map(|&node| node as usize);
        let share = 1.0 / nodes.len() as f64;
        let middle = nodes.fold([0.0; 2], |sum, node| {
            let x = mesh.in_plane(node);
            [0, 1].map(|d| sum[d] + share * (x[d] + fields.displacement[2 * node + d]))
        });
        // Three digits; places to a unit of the drawing for mark and numbers each.
        assert!(
            (picture.marked() / values[top] - 1.0).abs() < 5e-3,
            "{name}"
        );
        let found = picture.place(picture.mark.unwrap());
        for d in 0..2 {
            let off = (found[d] - middle[d]).abs() * across;
            assert!(
                off < 3.0,
                "{name}: marked at {found:?}, largest at {middle:?}"
            );
        }
    }
    assert!(
        n_pictures >= 9 && n_magnified >= 3,
        "{n_pictures}, {n_magnified}"
    );
    // Points of a chart tell both values: the pressure of first yield is one of them.
    let chart = std::fs::read_to_string(dir.join("report_pressure.svg")).unwrap();
    let first = recorded.results.first_yield.as_ref().unwrap();
    let told = format!("maximum pressure [MPa]: {:.2}", first.max_pressure);
    assert!(chart.contains(&told), "{told}");
}

/// The magnified contour is not that at true scale, and the page says how many times.
fn check_magnified(recorded: &brinell::output::Recorded, rest: &str, text: &str) {
    let index: usize = rest[..2].parse().unwrap();
    let picture = Picture::read(text);
    assert_eq!(picture.areas.len(), 1, "{rest}");
    assert!(recorded.results.states[index - 1].fields.is_some());
    // The undeformed contour in grey, the deformed one on top.
    let strokes = text.matches("stroke-linejoin=\"round\"").count();
    assert!(strokes >= 2, "{rest}: {strokes}");
}

/// A ring between two circles, drawn as four of its quarter, has its area in the picture: sides of
/// chords of 90/32 degrees take off 4e-4 of it, the pressure moves its bore by 1e-3 of the radius,
/// and points are off by a unit.
#[test]
fn the_areas_of_a_picture_are_those_of_the_section() {
    let temporary = tempfile::tempdir().unwrap();
    let dir = temporary.path().join("out");
    write_report_of("thick_cylinder", &[], &dir);
    let ring = std::f64::consts::PI * (200.0f64.powi(2) - 100.0f64.powi(2));
    let mut n_pictures = 0;
    for (name, text) in figures(&dir)
        .iter()
        .filter(|(name, _)| name.contains("_von_mises"))
    {
        let picture = Picture::read(text);
        let found = picture.check_bands(name);
        let scale = picture.scale(0)[0];
        assert_eq!(picture.areas[0].1.len(), 2, "{name}: a ring and its hole");
        let off = 4e-4 + 4e-3 + 2.0 * svg::length(&picture.areas[0].1) / found;
        let ratio = found / scale.powi(2) / ring;
        assert!((ratio - 1.0).abs() < off, "{name}: {ratio}, within {off}");
        n_pictures += 1;
    }
    assert!(n_pictures >= 4, "{n_pictures}");
}

/// No time, place or order of threads in a figure.
#[test]
fn figures_are_the_same_for_any_number_of_threads() {
    let temporary = tempfile::tempdir().unwrap();
    let mut runs = Vec::new();
    for threads in ["1", "3"] {
        let dir = temporary.path().join(threads);
        succeeds(
            program()
                .args(["run", "-q", "--threads", threads, "--out"])
                .arg(&dir)
                .arg(scene_file("three_bodies")),
        );
        runs.push(figures(&dir));
    }
    assert!(runs[0] == runs[1]);
}

#[test]
fn a_report_can_be_left_out_and_goes_with_its_result() {
    let temporary = tempfile::tempdir().unwrap();
    let dir = temporary.path().join("out");
    write_report_of("contact_patch", &[], &dir);
    assert!(dir.join("report.html").exists() && dir.join("report_scene.svg").exists());
    std::fs::write(dir.join("mine.svg"), "mine").unwrap();
    succeeds(
        program()
            .args(["run", "-q", "--no-report", "--out"])
            .args([&dir, &scene_file("contact_patch")]),
    );
    assert!(!dir.join("report.html").exists() && !dir.join("report_scene.svg").exists());
    assert!(dir.join("mine.svg").exists() && dir.join("summary.json").exists());
}

/// The report made anew from the directory is the one that the run wrote, whatever made the mesh,
/// also where the run wrote none.
#[test]
fn a_report_is_made_anew_from_its_directory_to_the_byte() {
    let temporary = tempfile::tempdir().unwrap();
    let view = |dir: &Path| limit::output(program().arg("view").arg(dir));
    for (scene, overrides) in [
        (
            "gmsh_blocks",
            &["materials.steel.yield_stress=200"] as &[&str],
        ),
        (
            "ball_on_half_space",
            &["mesh.cylinder_on_half_plane.resolution=4"],
        ),
        ("thick_cylinder", &["mesh.parts.0.ring.elements=[4, 4]"]),
        // A point on the axis that is no pair.
        ("hard/axis_of_quadratic_elements", &[]),
        ("shrink_fit", &[]),
    ] {
        let dir = temporary.path().join(scene);
        write_report_of(scene, overrides, &dir);
        let before = content(&dir);
        for name in before.keys().filter(|n| n.starts_with("report")) {
            std::fs::remove_file(dir.join(name)).unwrap();
        }
        std::fs::write(dir.join("report_of_something_else.svg"), "stale").unwrap();
        let shown = view(&dir);
        let error = stderr(&shown);
        assert!(shown.status.success(), "{scene}: {error}");
        let printed = String::from_utf8(shown.stdout).unwrap();
        assert_eq!(Path::new(printed.trim()), dir.join("report.html"));
        // What was read for it is what was written, all of it.
        let recorded = brinell::output::read(&dir).unwrap();
        let mut again = brinell::output::summary(&recorded.header, &recorded.results);
        let mut written: Value = serde_json::from_slice(&before["summary.json"]).unwrap();
        for summary in [&mut again, &mut written] {
            summary["peak_memory_bytes"].take();
        }
        assert_eq!(again.to_string(), written.to_string(), "{scene}");
        let after = content(&dir);
        assert!(
            before.keys().eq(after.keys()),
            "{scene}: {:?}",
            after.keys()
        );
        for (name, bytes) in &before {
            assert!(after[name] == *bytes, "{scene}: {name} differs");
        }
    }
    // What does not belong together, is damaged or is not there is refused by name, and the page
    // stays.
    let dir = temporary.path().join("shrink_fit");
    let page = std::fs::read(dir.join("report.html")).unwrap();
    let scene = std::fs::read_to_string(dir.join("scene_as_run.toml")).unwrap();
    let history = std::fs::read_to_string(dir.join("history.csv")).unwrap();
    let contact = std::fs::read_to_string(dir.join("contact.csv")).unwrap();
    let field = std::fs::read_dir(&dir)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .find(|n| n.ends_with(".vtu"))
        .unwrap();
    for (file, damage) in [
        (
            "scene_as_run.toml",
            scene.replacen("elements = 16", "elements = 8", 1),
        ),
        (
            "history.csv",
            history.replacen("contact_force", "something", 1),
        ),
        ("history.csv", history.replacen("\n1,", "\n1.5,", 1)),
        ("contact.csv", contact.replacen(",closed,", ",shut,", 1)),
        (field.as_str(), "cut off".to_string()),
    ] {
        let good = std::fs::read(dir.join(file)).unwrap();
        std::fs::write(dir.join(file), damage).unwrap();
        let refused = view(&dir);
        assert_eq!(refused.status.code(), Some(2), "{file}");
        let error = stderr(&refused);
        assert!(
            error.contains(file) || error.contains("summary.json"),
            "{error}"
        );
        std::fs::write(dir.join(file), good).unwrap();
    }
    std::fs::remove_file(dir.join("scene_as_run.toml")).unwrap();
    assert_eq!(view(&dir).status.code(), Some(2));
    assert!(std::fs::read(dir.join("report.html")).unwrap() == page);
}

/// Names and contents of the files of a directory.
pub fn content(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = std::fs::read_dir(dir).unwrap();
    files
        .map(|entry| entry.unwrap().path())
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, std::fs::read(path).unwrap())
        })
        .collect()
}

/// What stands in a scene is text on the page, whatever it looks like.
#[test]
fn names_are_escaped() {
    let temporary = tempfile::tempdir().unwrap();
    let dir = temporary.path().join("out");
    let title = "title=<b>\"bold\" & 'risky'</b><script>alert(1)</script>";
    write_report_of(
        "contact_patch",
        &[
            title,
            "program.targets=[{ load_factor = 1.0, name = \"<i>&\\\"\" }]",
        ],
        &dir,
    );
    let page = std::fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(!page.contains("<script") && !page.contains("<i>&"));
    assert!(page.contains("&lt;script&gt;"));
    for text in figures(&dir)
        .values()
        .map(String::as_str)
        .chain(drawings(&page))
    {
        roxmltree::Document::parse(text).unwrap();
    }
}
