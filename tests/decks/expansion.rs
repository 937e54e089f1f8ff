//! Expansion by temperature, against closed forms.

use super::{run_text, with_text};

/// Secant coefficients at 0 and 300, straight between, from 20.
fn strain(temperature: f64) -> f64 {
    (1e-5 + 1e-5 * temperature / 300.0) * (temperature - 20.0)
}

/// A deck with the temperature `20 + 60 s` along an axis, and no support that presses.
fn heated(name: &str, axis: usize) -> String {
    let text = std::fs::read_to_string(super::deck_path(name)).unwrap();
    let (before, rest) = text.split_once("*TEMPERATURE\n").unwrap();
    let (_, after) = rest.split_once("*NODE PRINT").unwrap();
    let (_, nodes) = before.split_once("NSET=NALL\n").unwrap();
    let nodes = nodes.lines().take_while(|line| !line.starts_with('*'));
    let rows = nodes.map(|line| {
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        let s: f64 = words[1 + axis].parse().unwrap();
        format!("{}, {}\n", words[0], 20.0 + 60.0 * s)
    });
    let rows: String = rows.collect();
    format!("{before}*TEMPERATURE\n{rows}*NODE PRINT{after}")
}

/// Nothing loads the body: the mean stress vanishes, and the mean strain is the mean free strain,
/// whatever the mesh. So the mean distance of two ends grows by the integral of the strain, which
/// Simpson's rule has exactly.
#[test]
fn ends_move_apart_by_the_integral_of_the_strain() {
    for (name, axis, length) in [("expanding_bar", 0, 2.0), ("expanding_ring", 1, 0.5)] {
        let (model, results) = run_text(&heated(name, axis));
        let mesh = &model.mesh;
        let d = mesh.dimension;
        let u = &results.states[0].fields.as_ref().unwrap().displacement;
        // Means over an end: by the areas of its nodes, of a ring those on the circle.
        let mean = |place: f64| {
            let (mut sum, mut area) = (0.0, 0.0);
            for element in 0..mesh.n_elements() {
                for local in 0..2 * d {
                    let facet = brinell::mesh::Facet { element, local };
                    let nodes: Vec<usize> = mesh.facet_nodes(facet).collect();
                    let is_on = |n: &usize| (mesh.point(*n)[axis] - place).abs() < 1e-12;
                    if !nodes.iter().all(is_on) {
                        continue;
                    }
                    let of_ends = |n: usize| mesh.point(n)[0];
                    let weights: Vec<f64> = match nodes.len() {
                        // Simpson, whose weights are exact times the radius.
                        3 => [1.0, 1.0, 4.0]
                            .iter()
                            .zip(&nodes)
                            .map(|(w, n)| w * of_ends(*n))
                            .collect(),
                        _ => [-1.0, -1.0, -1.0, -1.0, 4.0, 4.0, 4.0, 4.0].to_vec(),
                    };
                    for (node, weight) in nodes.iter().zip(weights) {
                        sum += weight * u[d * node + axis];
                        area += weight;
                    }
                }
            }
            sum / area
        };
        let grown = mean(length) - mean(0.0);
        let [low, middle, high] = [0.0, 0.5, 1.0].map(|s| strain(20.0 + 60.0 * s * length));
        let exact = length / 6.0 * (low + 4.0 * middle + high);
        assert!(
            (grown / exact - 1.0).abs() < 1e-9,
            "{name}: {grown} {exact}"
        );
    }
}

/// Temperatures of materials without an expansion do nothing, and that is said; a deck that has
/// nothing else is told what it lacks.
#[test]
fn temperatures_without_an_expansion_do_nothing() {
    let text = std::fs::read_to_string(super::deck_path("expanding_ring")).unwrap();
    let (before, rest) = text.split_once("*EXPANSION").unwrap();
    let (_, after) = rest.split_once("*SOLID SECTION").unwrap();
    let without = format!("{before}*SOLID SECTION{after}");
    let said = "material M has no *EXPANSION: temperatures do nothing";
    let error = with_text(&without, Ok).err().unwrap().to_string();
    assert!(
        error.contains("*TEMPERATURE: ") && error.contains(said),
        "{error}"
    );
    // With another load it runs.
    let loaded = without.replace("*TEMPERATURE", "*CLOAD\n1, 1, 10.\n*TEMPERATURE");
    let scene = with_text(&loaded, Ok).unwrap();
    let is_said = scene.warnings.iter().any(|text| text.contains(said));
    assert!(is_said, "{:?}", scene.warnings);
    let (_, results) = run_text(&loaded);
    assert!(results.states[0].fields.as_ref().unwrap().displacement[0] > 0.0);
}
