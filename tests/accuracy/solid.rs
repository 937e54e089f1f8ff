//! Errors that runs of solids state of themselves, against a finer mesh of the family.

use crate::accuracy::estimate::estimated;
use crate::support::{self, either};
use brinell::accuracy::{Extent, member, quantities, value_of};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;

/// Of crossed cylinders (oblong faces) with six elements over the smaller half axis, and of a ball:
/// companions are near ones, as coarser ones cannot be read, and what they state covers the change
/// to elements two thirds as large. With errors in proportion to h^2 that is 5/9 of the error
/// itself.
#[test]
fn stated_errors_of_solids_cover_the_way_to_a_finer_mesh() {
    let every = &["crossed_cylinders", "ball_on_flat_3d"][..];
    for &name in either(&every[..1], every) {
        let scene = support::load(name, &["mesh.curved_bodies.far_size=6"]);
        let (_, accuracy) = estimated(&scene, Extent::Yield);
        let ratios: Vec<f64> = accuracy.companions.iter().map(|c| c.ratio).collect();
        assert_eq!(ratios, [1.2, 1.5], "{name}");
        let finer = member(&scene, 2.0 / 3.0).unwrap();
        let mut analysis =
            Analysis::new(Model::new(&finer.scene).unwrap(), Backend::default()).unwrap();
        let finer = quantities(&analysis.yield_load(&mut Silent).unwrap());
        for row in &accuracy.quantities {
            let stated = row.error.unwrap();
            let change = (value_of(&finer, &row.quantity).unwrap() - row.value).abs();
            assert!(
                change <= stated,
                "{name}, {}: {change} of {}, stated {stated}",
                row.quantity,
                row.value
            );
            // Not 25 % of everything, as where no other mesh can be run.
            assert!(
                stated < 0.06 * row.value,
                "{name}, {}: {stated}",
                row.quantity
            );
        }
    }
}
