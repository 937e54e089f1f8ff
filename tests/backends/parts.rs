//! A part of the zone recovered by itself: what the search directions of a tangent are made of.

use crate::support::load;
use crate::support::sparse;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::substructure::Substructure;

#[test]
fn a_part_of_the_zone_moves_as_in_the_whole() {
    for backend in sparse() {
        assert_a_part_moves_as_in_the_whole(backend);
    }
}

fn assert_a_part_moves_as_in_the_whole(backend: Backend) {
    let scene = load(
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=8"],
    );
    let model = Model::new(&scene).unwrap();
    let system = brinell::assembly::assemble(&model, Backend::default()).unwrap();
    let pairs = model
        .pairs
        .iter()
        .flat_map(|pair| pair.nodes().collect::<Vec<_>>());
    let contact: Vec<usize> = pairs
        .filter_map(|node| model.freedoms.normal_freedom(node))
        .collect();
    let zone: Vec<usize> = (0..model.freedoms.n)
        .filter(|freedom| !contact.contains(freedom))
        .collect();
    let structure = Substructure::new(&model, &system, zone.clone(), backend).unwrap();
    let mut eliminated = structure.zeros();
    for (i, value) in eliminated.iter_mut().enumerate() {
        *value = ((i * 7919) % 1013) as f64 / 1013.0 - 0.5;
    }
    let n = model.pairs.len();
    let mut forces = vec![0.0; n];
    structure.eliminate(&mut eliminated, &mut forces);
    let slip: Vec<f64> = (0..n).map(|k| 1e-3 * (k % 5) as f64).collect();
    let mut whole = eliminated.clone();
    structure.recover(&mut whole, &slip);
    for marked in [1, 5, zone.len() / 3] {
        let marks: Vec<bool> = (0..zone.len())
            .map(|k| k % (zone.len() / marked) == 0)
            .collect();
        let part = structure.part_of_zone(&marks);
        let mut some = eliminated.clone();
        structure.recover_part(&part, &mut some, &slip);
        assert_eq!(some.contact, whole.contact);
        let (mut left_out, mut elsewhere) = (0, 0);
        for (k, (u, expected)) in some.zone.iter().zip(&whole.zone).enumerate() {
            if marks[k] {
                assert_eq!(u.to_bits(), expected.to_bits(), "{marked}: freedom {k}");
            } else {
                elsewhere += 1;
                left_out += usize::from(*u == 0.0);
            }
        }
        assert!(
            marked > 5 || 2 * left_out > elsewhere,
            "{marked}: {left_out} of {elsewhere} left out"
        );
    }
}
