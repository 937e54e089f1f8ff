//! The report of a run in three dimensions.

use crate::support::svg::{Picture, area, rings};
use crate::support::{load, run_with_model};
use brinell::linalg::Backend;
use brinell::output::{RunHeader, write_with_report};
use brinell::results::Results;
use std::path::Path;

fn report_of_a_ball(dir: &Path) -> Results {
    let scene = load("ball_on_flat_3d", &["mesh.curved_bodies.resolution=3"]);
    let (model, results) = run_with_model(&scene);
    let header = RunHeader::new(&model, Backend::default(), 1.0);
    write_with_report(dir, &header, &model, &results).unwrap();
    results
}

/// Each state in contact has a map of its pressure, with the ellipse of its half axes; each state
/// shown two sections with its stresses; and the scene is drawn.
#[test]
fn a_solid_has_maps_of_pressure_sections_and_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("out");
    let results = report_of_a_ball(&dir);
    let read = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap();
    let named = |part: &str| -> Vec<String> {
        let mut names: Vec<String> = (std::fs::read_dir(&dir).unwrap())
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.contains(part))
            .collect();
        names.sort();
        names
    };
    let state =
        |name: &str| -> usize { name["report_state_".len()..][..2].parse::<usize>().unwrap() - 1 };

    // Four states of five are shown, the one without load among them.
    let maps = named("contact_pressure");
    assert_eq!((maps.len(), results.states.len()), (3, 5), "{maps:?}");
    for name in &maps {
        let state = &results.states[state(name)];
        let picture = Picture::read(&read(name));
        let touching = picture.check_bands(name);
        assert!(
            (picture.marked() / state.max_pressure - 1.0).abs() < 5e-3,
            "{name}"
        );
        let legend = picture.legend();
        assert!(legend.is_sorted_by(|a, b| a < b), "{name}: {legend:?}");
        // The whole patch: the map goes linearly to 0 at the first open pairs, less than an element
        // (a third of the radius at first yield) beyond the edge between them and the last closed
        // ones.
        let scale = picture.scale(0)[0];
        let radius = (touching / std::f64::consts::PI).sqrt() / scale;
        let element = results.states[0].half_width / 3.0;
        let expected = (state.patches[0].area / std::f64::consts::PI).sqrt();
        assert!(
            (radius - expected).abs() < element,
            "{name}: {radius} for {expected}"
        );
        assert!(read(name).contains("x [mm]"), "{name}");
    }

    assert_eq!(named("_magnified_section_").len(), 8);
    let sections = named("_von_mises_section_");
    assert_eq!(sections.len(), 8, "{sections:?}");
    for name in &sections {
        let state = &results.states[state(name)];
        let text = read(name);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
        let picture = Picture::read(&text);
        let shown = picture.check_bands(name);
        assert!(picture.legend().is_sorted_by(|a, b| a < b), "{name}");
        // Both bodies from one border of the picture to the other, but for the gap between them.
        let [low, high] = picture.frame;
        let all = (high[0] - low[0]) * (high[1] - low[1]);
        assert!(
            shown > 0.9 * all && shown < 1.01 * all,
            "{name}: {shown} of {all}"
        );
        assert!(text.contains(if name.contains("section_1") {
            "x [mm]"
        } else {
            "y [mm]"
        }));
        // The border of the plastic zone is a light line in a dark one.
        let zone = text.contains("fill=\"none\" stroke=\"#FFFFFE\"")
            && text.contains("stroke-width=\"10.4\"");
        assert_eq!(zone, state.plastic_points > 0, "{name}");
        // At first yield the largest stress is that at the point of first yield: to an element.
        if name.contains("state_01") {
            let first = results.first_yield.unwrap();
            let element = first.half_width / 3.0;
            let [across, up] = picture.place(picture.mark.unwrap());
            assert!(across.abs() < element, "{name}: {across}");
            assert!(
                (up.abs() - first.location[2].abs()).abs() < element,
                "{name}: {up}"
            );
        }
    }

    let page = read("report.html");
    for words in [
        "Contact pressure, load",
        "ellipse of the half axes",
        "in the section along y",
        "The whole model",
        "Near the contact",
        "Stress below the centre of the contact",
        "Load against approach",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

/// The bodies are two boxes one on the other: of each the faces turned to the eye are painted, the
/// upper ones last, without overlap: each body's area is that of its silhouette.
#[test]
fn the_scene_is_painted_from_the_back_to_the_front() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("out");
    report_of_a_ball(&dir);
    let text = std::fs::read_to_string(dir.join("report_scene.svg")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let painted: Vec<(&str, f64)> = xml
        .descendants()
        .filter(|node| node.has_tag_name("path") && node.attribute("fill") != Some("none"))
        .map(|node| {
            (
                node.attribute("fill").unwrap(),
                area(&rings(node.attribute("d").unwrap())),
            )
        })
        .collect();
    // Blue above, green below.
    let is_blue = |color: &str| {
        let channel = |k: usize| u8::from_str_radix(&color[k..k + 2], 16).unwrap();
        channel(5) > channel(3)
    };
    let first_blue = painted
        .iter()
        .position(|(color, _)| is_blue(color))
        .unwrap();
    assert!(
        painted[first_blue..]
            .iter()
            .all(|(color, _)| is_blue(color))
    );
    assert!(first_blue > 0 && painted.len() > 6);
    // The boxes are alike: areas differ by the perspective and by the gap only.
    let sum = |blue: bool| -> f64 {
        painted
            .iter()
            .filter(|(color, _)| is_blue(color) == blue)
            .map(|(_, area)| area)
            .sum()
    };
    let ratio = sum(true) / sum(false);
    assert!((0.7..1.4).contains(&ratio), "{ratio}");
}
