//! All scenes of `data/scenes`, and what two solvers make of them.

use serde_json::Value;

/// Names of the scenes: `NAME` and `hard/NAME`.
pub fn all() -> Vec<String> {
    let of_folder = |folder: &str| {
        let path = format!("{}/data/scenes/{folder}", env!("CARGO_MANIFEST_DIR"));
        let files = std::fs::read_dir(path).unwrap();
        let paths = files.map(|entry| entry.unwrap().path());
        let scenes = paths.filter(|path| path.extension().is_some_and(|end| end == "toml"));
        let name = |path: std::path::PathBuf| {
            format!("{folder}{}", path.file_stem().unwrap().to_str().unwrap())
        };
        let mut names: Vec<String> = scenes.map(name).collect();
        names.sort();
        names
    };
    let names = [of_folder(""), of_folder("hard/")].concat();
    assert!(names.len() > 40, "{names:?}");
    names
}

/// What makes a scene small enough to be run many times: large solids are coarser.
pub fn smaller(name: &str) -> &'static [&'static str] {
    let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    if text.contains("[mesh.curved_bodies]") {
        &["mesh.curved_bodies.resolution=3"]
    } else if name == "hard/slender_elements" {
        &[
            "mesh.parts.0.block.elements=[300,2]",
            "mesh.parts.1.block.elements=[300,2]",
        ]
    } else if name == "square_punch" {
        &super::SMALL_PUNCH
    } else {
        &[]
    }
}

/// How far the figures of two solvers may lie apart. Of bodies that hardly anything holds, or whose
/// elements are slivers, displacements have the digits that their condition leaves; else the
/// plastic iteration ends at 1e-10 of the forces, from whichever side.
pub fn agreement(name: &str) -> f64 {
    match ["hard/nearly_floating", "hard/slivers"].contains(&name) {
        true => 1e-6,
        false => 1e-8,
    }
}

/// The largest difference of the figures of all states, each over the largest size that it has.
pub fn difference(found: &Value, expected: &Value) -> f64 {
    let [own, other] = [found, expected].map(|s| s["states"].as_array().unwrap());
    assert_eq!(own.len(), other.len());
    let figures = [
        "load",
        "max_pressure",
        "half_width",
        "residual_depth",
        "approach",
    ];
    let of = |figure: &str| {
        let value = |state: &Value| state[figure].as_f64();
        let pairs = || own.iter().zip(other).map(|(a, b)| (value(a), value(b)));
        for (a, b) in pairs() {
            assert_eq!(a.is_some(), b.is_some(), "{figure}");
        }
        let both = || pairs().filter_map(|(a, b)| Some((a?, b?)));
        let largest = both().fold(0.0f64, |m, (_, b)| m.max(b.abs()));
        let off = both().fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        off / largest.max(f64::MIN_POSITIVE)
    };
    figures.into_iter().map(of).fold(0.0, f64::max)
}
