//! Thick cylinder under internal pressure, plane strain, elastic-perfectly plastic.
//!
//! Source: R. Hill, The Mathematical Theory of Plasticity (1950), chapter V (exact for nu = 1/2); Lame.

use crate::run::{close, radial_displacement, run_until_it_ends, scene, yield_load};
use brinell::ErrorKind;
use brinell::analytical::ElastoplasticCylinder;

#[test]
fn yields_first_at_the_bore() {
    for (nu, exact) in [("0.3", 103.750), ("0.4999", 103.9230)] {
        let results = yield_load(&scene(
            "thick_cylinder",
            &[&format!("materials.steel.poissons_ratio={nu}")],
        ));
        // Quadratic elements of 1/40 of the wall at the bore: stress there to (1/16)^2/2 of its curvature.
        close(results.first_yield.unwrap().alpha, exact, 2e-3);
    }
}

/// The stress of a linear triangle is of first order, what is recovered from the displacements around of second.
#[test]
fn linear_triangles_find_first_yield_to_second_order() {
    let error = |n: usize| {
        let results = yield_load(&scene(
            "thick_cylinder",
            &[
                "mesh.parts.0.element=tri3",
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
            ],
        ));
        (results.first_yield.unwrap().alpha / 103.750 - 1.0).abs()
    };
    let [coarse, fine, finer] = [16, 32, 64].map(error);
    // Halved elements: a quarter of the error, and 3 where the next order still counts.
    assert!(
        fine <= coarse / 3.0 && finer <= fine / 3.0,
        "{coarse:.2e} {fine:.2e} {finer:.2e}"
    );
    // Half the square of the element at the bore, a 64th of the wall, times the curvature of the stress there, 6 of it over the wall squared.
    assert!(finer <= 4e-3, "{finer:.2e}");
}

#[test]
fn nearly_incompressible_flow_converges_to_hill() {
    let exact = ElastoplasticCylinder::new(100.0, 200.0, 210e3, 240.0).unwrap();
    let error = |n: usize| {
        let scene = scene(
            "thick_cylinder",
            &[
                "materials.steel.poissons_ratio=0.4999",
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                "program.targets=[{load_factor=170.0}]",
            ],
        );
        (radial_displacement(&scene, "tube.outer") / exact.displacement(200.0, 170.0).unwrap()
            - 1.0)
            .abs()
    };
    let (coarse, fine) = (error(8), error(16));
    // The front is a kink inside an element: between first and second order. nu = 0.4999 is off by 2e-4 itself.
    assert!(fine <= 2e-3, "{coarse:.2e} {fine:.2e}");
    assert!(
        fine <= coarse / 1.5 || fine <= 4e-4,
        "{coarse:.2e} {fine:.2e}"
    );
}

#[test]
fn collapse_is_bracketed_and_named() {
    let scene = scene(
        "thick_cylinder",
        &[
            "mesh.parts.0.ring.elements=[6,2]",
            "program.targets=[{load_factor=185.0},{load_factor=200.0}]",
        ],
    );
    let results = run_until_it_ends(&scene);
    assert_eq!(results.incomplete_kind, Some(ErrorKind::Collapse));
    let held = results.history.last().unwrap().alpha;
    // 2k ln(b/a) = 192.09; finite elements of displacement type lie above the limit load: six quadratic ones by less than 1 %.
    assert!(held > 0.995 * 192.09 && held < 1.01 * 192.09, "{held}");
}
