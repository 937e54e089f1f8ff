//! Members of families of meshes.

use super::*;
use crate::scene::Scene;

fn scene(mesh: &str) -> Scene {
    let text = format!(
        "kind = \"plane_strain\"\n{mesh}\n[materials.m]\nyoungs_modulus = 1.0\npoissons_ratio = \
         0.3\n[bodies]\nb = {{ material = \"m\" }}\n[[load]]\non = \"b.top\"\npressure = \
         1.0\n[program]\ntargets = [{{ load_factor = 1.0 }}]\n"
    );
    Scene::parse(&text, "test.toml").unwrap()
}

fn blocks(blocks: &[&str]) -> Vec<Part> {
    let part = |block: &&str| format!("[[mesh.parts]]\nbody = \"b\"\n{block}\n");
    let text: String = blocks.iter().map(part).collect();
    scene(&text).mesh.parts.unwrap()
}

fn all_counts(parts: &[Part]) -> Vec<usize> {
    parts.iter().flat_map(counts).collect()
}

#[test]
fn a_member_has_all_elements_larger_by_one_ratio() {
    let text = include_str!("../../../../data/scenes/cylinder_on_half_plane.toml");
    let mesh = Scene::parse(text, "scene.toml").unwrap().mesh;
    let own = mesh.cylinder_on_half_plane.clone().unwrap();
    let (member, ratio) = mesh.member(0.5).unwrap();
    let p = member.cylinder_on_half_plane.unwrap();
    assert_eq!((p.resolution, ratio), (2 * own.resolution, 0.5));
    assert!((p.growth.powi(2) / own.growth - 1.0).abs() < 1e-14);
}

/// Surfaces that face each other node by node continue to do so, because all counts have one ratio.
#[test]
fn parts_are_scaled_together() {
    let text = include_str!("../../../../data/scenes/pin_in_hole.toml");
    let mesh = Scene::parse(text, "scene.toml").unwrap().mesh;
    assert_eq!(all_counts(mesh.parts.as_ref().unwrap()), [32, 40, 64]);
    for (wanted, counts) in [
        (2.0, [16, 20, 32]),
        (1.5, [20, 25, 40]),
        (0.3, [108, 135, 216]),
    ] {
        let (member, ratio) = mesh.member(wanted).unwrap();
        assert_eq!(all_counts(&member.parts.unwrap()), counts);
        assert_eq!(ratio, 32.0 / counts[0] as f64);
    }
}

/// The sizes along a biased line are one function of the position, sampled with more elements.
#[test]
fn a_bias_samples_the_same_sizes() {
    let parts = blocks(&[
        "block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [8, 8], bias = [9.0, 1.0] }",
    ]);
    let (member, ratio) = parts.member(0.5).unwrap();
    let of = |parts: &[Part]| {
        let block = parts[0].block.clone().unwrap();
        let n = block.elements[0];
        crate::mesh::generate::grading::biased("x", 0.0, 1.0, n, block.bias[0]).unwrap()
    };
    let (coarse, fine) = (of(&parts), of(&member));
    assert_eq!(ratio, 0.5);
    // Corner nodes are every second position, and every second corner of the finer mesh is a corner
    // of the coarser one.
    for (i, x) in coarse.iter().enumerate().step_by(2) {
        assert!((fine[2 * i] - x).abs() < 1e-14, "{i}");
    }
}

#[test]
fn a_piece_of_a_block_keeps_its_length() {
    let piece = "{ name = \"p\", side = \"top\", from = 0.0, to = 1.0 }";
    let block = format!(
        "block = {{ x = [0.0, 5.0], y = [0.0, 1.0], elements = [40, 40], pieces = [{piece}] }}"
    );
    let parts = blocks(&[&block]);
    for (wanted, n) in [(2.5, 15), (2.0, 20), (0.33, 120)] {
        let (member, ratio) = parts.member(wanted).unwrap();
        assert_eq!(all_counts(&member), [n, n], "{wanted}");
        assert_eq!(ratio, 40.0 / n as f64);
    }
    let between = blocks(&[&block.replace("to = 1.0", "to = 1.7")]);
    let error = between.member(0.5).unwrap_err();
    assert!(error.contains("`b`"), "{error}");
}

/// Counts without a common divisor are rounded one by one, provided that this hardly distorts the
/// mesh.
#[test]
fn counts_are_rounded_where_they_have_to_be() {
    let parts = blocks(&["block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [31, 45] }"]);
    let (member, ratio) = parts.member(1.5).unwrap();
    assert_eq!(all_counts(&member), [21, 30]);
    assert_eq!(ratio, 1.5);
    let ring = blocks(&["ring = { radius = [1.0, 2.0], elements = [1, 16] }"]);
    // The nearest member is the ring itself.
    assert_eq!(ring.member(2.0).unwrap().1, 1.0);
    assert_eq!(all_counts(&ring.member(0.5).unwrap().0), [2, 32]);
}

#[test]
fn a_file_has_its_subdivisions() {
    let mut mesh = scene("[mesh]\nfile = \"a.msh\"").mesh;
    assert_eq!(mesh.member(0.3).unwrap().0.subdivisions, 2);
    assert!(mesh.member(2.0).is_err());
    mesh.subdivisions = 2;
    let (coarser, ratio) = mesh.member(2.0).unwrap();
    assert_eq!((coarser.subdivisions, ratio), (1, 2.0));
    assert_eq!(mesh.shape(), None);
}
