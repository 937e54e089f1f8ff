//! Thick cylinder under internal pressure, plane strain, elastic-perfectly plastic.
//!
//! Source: R. Hill, The Mathematical Theory of Plasticity (1950), chapter V (exact for nu = 1/2);
//! Lame.

use crate::support::{load, run_as_far_as_it_goes, run_file, run_with_model, yield_load};
use crate::verification::{close, radial_displacement};
use brinell::ErrorKind;
use brinell::analysis::Analysis;
use brinell::analytical::ElastoplasticCylinder;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use std::f64::consts::PI;

#[test]
fn yields_first_at_the_bore() {
    for (nu, exact) in [("0.3", 103.750), ("0.4999", 103.9230)] {
        let results = yield_load(&load(
            "thick_cylinder",
            &[&format!("materials.steel.poissons_ratio={nu}")],
        ));
        // Quadratic elements of 1/40 of the wall at the bore: stress there to (1/16)^2/2 of its
        // curvature.
        close(results.first_yield.unwrap().alpha, exact, 2e-3);
    }
}

/// The tube cut into triangles, nodes inside the wall moved by up to a share of the shortest side
/// there.
fn triangles(n: usize, moved: f64) -> Model {
    let scene = load(
        "thick_cylinder",
        &[
            "mesh.parts.0.element=tri3",
            &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
            "program.targets=[{ yield = true }]",
        ],
    );
    let mut mesh = Model::new(&scene).unwrap().continuum.mesh;
    let mut shortest = vec![f64::INFINITY; mesh.n_nodes()];
    for element in 0..mesh.n_elements() {
        let nodes = mesh.nodes(element);
        for k in 0..3 {
            let ends = [nodes[k], nodes[(k + 1) % 3]].map(|n| n as usize);
            let [p, q] = ends.map(|n| mesh.point(n));
            let length = (p[0] - q[0]).hypot(p[1] - q[1]);
            for node in ends {
                shortest[node] = shortest[node].min(length);
            }
        }
    }
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    for (node, shortest) in shortest.iter().enumerate() {
        let [x, y] = mesh.in_plane(node);
        let inside = x.hypot(y) - 100.0 > 1e-6 && 200.0 - x.hypot(y) > 1e-6;
        if inside && x > 1e-6 && y > 1e-6 {
            mesh.coordinates[2 * node] += moved * random() * shortest;
            mesh.coordinates[2 * node + 1] += moved * random() * shortest;
        }
    }
    Model::from_mesh(&scene, mesh).unwrap()
}

/// The stress of a linear triangle is of first order, what is recovered from the displacements
/// around of second, on irregular meshes too.
#[test]
fn linear_triangles_find_first_yield_to_second_order() {
    for moved in [0.0, 1.0 / 7.0] {
        let [coarse, fine, finer] = [16, 32, 64].map(|n| {
            let mut analysis = Analysis::new(triangles(n, moved), Backend::default()).unwrap();
            let found = analysis.yield_load(&mut Silent).unwrap();
            (found.first_yield.unwrap().alpha / 103.750 - 1.0).abs()
        });
        let errors = format!("moved by {moved:.2}: {coarse:.2e} {fine:.2e} {finer:.2e}");
        println!("{errors}");
        // Halved elements: a quarter of the error, a third where the next order still counts.
        assert!(fine <= coarse / 3.0 && finer <= fine / 3.0, "{errors}");
        // The displacement falls with the radius, its third derivative is 6 of it over the radius
        // cubed: a fit over two elements of a 64th of the wall, which is a radius thick, leaves a
        // 6th of that times (2/64)^2 of the strain, and the three strains at the bore add up.
        assert!(finer <= 4e-3, "{errors}");
    }
}

#[test]
fn nearly_incompressible_flow_converges_to_hill() {
    let exact = ElastoplasticCylinder::new(100.0, 200.0, 210e3, 240.0).unwrap();
    let error = |n: usize| {
        let scene = load(
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
    // The front is a kink inside an element: between first and second order. nu = 0.4999 is off by
    // 2e-4 itself.
    assert!(fine <= 2e-3, "{coarse:.2e} {fine:.2e}");
    assert!(
        fine <= coarse / 1.5 || fine <= 4e-4,
        "{coarse:.2e} {fine:.2e}"
    );
}

/// Size of the plastic zone and work on plastic strains of the whole tube. Of nu = 1/2: the ring up
/// to the front `c`, and with strains `A / r^2`, elastic ones `k / 2G`, work
/// `2 k (k / 2G) (c^2 / r^2 - 1)` at the radius `r`, hence
/// `2 pi (k^2 / G) (c^2 ln(c/a) - (c^2 - a^2) / 2)`.
#[test]
fn the_plastic_ring_and_the_work_in_it_converge_to_hill() {
    let (a, young, y, pressure) = (100.0, 210e3, 240.0, 170.0);
    let exact = ElastoplasticCylinder::new(a, 200.0, young, y).unwrap();
    let front = exact.plastic_front(pressure).unwrap();
    let area = PI * (front * front - a * a);
    let factor = 2.0 * PI * (y * y / 3.0) / (young / 3.0);
    let work = factor * (front * front * (front / a).ln() - area / (2.0 * PI));
    for n in [8, 16, 32] {
        let results = run_file(
            "thick_cylinder",
            &[
                "symmetry=4",
                "materials.steel.poissons_ratio=0.4999",
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                "mesh.parts.0.ring.bias=1.0",
                &format!("program.targets=[{{load_factor={pressure}}}]"),
            ],
        );
        let state = &results.states[0];
        let h = 100.0 / f64::from(n);
        let off = (state.plastic_zone_size - area).abs();
        // An element has two rings of Gauss points, which yield as wholes.
        let ring = 2.0 * PI * front * h / 2.0;
        println!(
            "{n}: area off by {:.2} rings, work {:.2e}",
            off / ring,
            state.plastic_work / work - 1.0
        );
        assert!(off <= ring, "{n}: {off} of {area}, a ring is {ring}");
        // The work has a kink at the front, where its slope falls by twice the factor: two Gauss
        // points miss at most an eighth of that times h^2, the stresses as much; nu is off by 2e-4.
        let most = factor * h * h / 2.0 + 1e-3 * work;
        let off = (state.plastic_work - work).abs();
        assert!(off <= most, "{n}: {off} of {work}, allowed {most}");
    }
}

#[test]
fn collapse_is_bracketed_and_named() {
    let scene = load(
        "thick_cylinder",
        &[
            "mesh.parts.0.ring.elements=[6,2]",
            "program.targets=[{load_factor=185.0},{load_factor=200.0}]",
        ],
    );
    let results = run_as_far_as_it_goes(&scene, Backend::default());
    assert_eq!(results.ending().kind(), Some(ErrorKind::Collapse));
    let held = results.history.last().unwrap().alpha;
    // 2k ln(b/a) = 192.09; finite elements of displacement type lie above the limit load: six
    // quadratic ones by less than 1 %.
    assert!(held > 0.995 * 192.09 && held < 1.01 * 192.09, "{held}");
}

/// Largest error of the hoop stress at the nodes, over the pressure, by Lame.
fn error_at_nodes(element: &str, n: usize) -> f64 {
    let scene = load(
        "thick_cylinder",
        &[
            &format!("mesh.parts.0.element={element}"),
            &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
            "program.targets=[{ load_factor = 50.0 }]",
            "reference=[]",
        ],
    );
    let (model, results) = run_with_model(&scene);
    let mesh = &model.mesh;
    let fields = results.states[0].fields.as_ref().unwrap();
    let mut worst = 0.0f64;
    for (node, stress) in fields.nodal_stress.chunks(4).enumerate() {
        let [x, y] = mesh.in_plane(node);
        let square = x * x + y * y;
        // Stress along the circle: t' sigma t with t = (-y, x)/r.
        let [xx, yy, _, xy] = [stress[0], stress[1], stress[2], stress[3]];
        let hoop = (xx * y * y - 2.0 * xy * x * y + yy * x * x) / square;
        let exact = 50.0 * 100.0f64.powi(2) / (200.0f64.powi(2) - 100.0f64.powi(2))
            * (1.0 + 200.0f64.powi(2) / square);
        worst = worst.max((hoop - exact).abs() / 50.0);
    }
    worst
}

/// Stresses at the nodes, of the bore and of corners too, are of the order that the recovery has:
/// h^2 with linear elements, h^3 with quadratic ones.
#[test]
fn stresses_at_nodes_converge_up_to_the_surface() {
    for (element, order) in [("quad4", 1.7), ("quad8", 2.5), ("tri6", 2.5)] {
        let errors = [8, 16, 32].map(|n| error_at_nodes(element, n));
        let observed = (errors[1] / errors[2]).log2();
        assert!(observed > order, "{element}: {errors:?} {observed}");
    }
}
