//! Figures that others published, beside what is computed: the scenes of `data/validation`.

use crate::verification::run::run;
use brinell::model::Model;
use brinell::reference;
use brinell::results::ReferenceRow;
use brinell::scene::Scene;

fn rows(name: &str) -> Vec<ReferenceRow> {
    let path = format!("{}/data/validation/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let scene = Scene::load(path).unwrap();
    let mut results = run(&scene);
    reference::compare(&Model::new(&scene).unwrap(), &mut results);
    results.reference
}

fn agree(name: &str, n: usize, tolerance: f64) {
    let rows = rows(name);
    assert_eq!(rows.len(), n);
    for row in rows {
        let off = (row.ratio - 1.0).abs();
        assert!(
            off <= tolerance,
            "{name}: {}, {}: {}",
            row.quantity,
            row.source,
            row.ratio
        );
    }
}

/// Formulas fitted to finite elements of their time, which their authors hold to be good to some
/// per cent.
#[test]
fn spheres_on_a_rigid_flat_are_those_of_the_literature() {
    agree("sphere_on_rigid_flat", 17, 0.05);
    agree("sphere_bilinear", 1, 0.05);
}

/// A circle where Hertz has a parabola, `(a/R)^2/4`; a far side at a finite distance.
#[test]
fn two_spheres_are_those_of_moose() {
    agree("two_spheres", 2, 0.005);
}

/// Elements of order 2, 16 over each wall: `h^2`, some 1/256.
#[test]
fn two_rings_are_those_of_code_aster() {
    agree("rings", 1, 0.004);
}
