use super::*;
use crate::mesh::generate::disc_in_plate;
use crate::scene::DiscInPlate;
use std::f64::consts::{FRAC_PI_2, PI};

const RADIUS: f64 = 3.0;

pub(super) fn example(resolution: usize, element: Shape) -> DiscInPlate {
    DiscInPlate {
        names: ["disc", "plate"].map(String::from),
        radius: RADIUS,
        interference: 0.0,
        resolution,
        far_radius: 20.0,
        growth: 1.05,
        far_growth: None,
        element,
    }
}

/// Area of a sector of `angle` bounded by a polygon (or a chain of parabolas) with `n` sides on a
/// circle.
pub(super) fn sector_area(radius: f64, angle: f64, n: usize, shape: Shape) -> f64 {
    let half = 0.5 * angle / n as f64;
    let triangles = radius * radius * half.sin() * half.cos();
    let caps = 2.0 / 3.0 * 2.0 * radius * half.sin() * radius * (1.0 - half.cos());
    n as f64 * (triangles + if shape.is_quadratic() { caps } else { 0.0 })
}

#[test]
fn all_shapes_and_resolutions_are_valid_with_the_polygon_area() {
    for shape in Shape::PLANE {
        for resolution in [2, 4, 6, 10, 32] {
            let p = example(resolution, shape);
            let mesh = disc_in_plate(&p).unwrap();
            check_common(&mesh);
            let inner = sector_area(RADIUS, FRAC_PI_2, resolution, shape);
            let outer = sector_area(20.0 * RADIUS, FRAC_PI_2, resolution, shape);
            let (disc, plate) = (area(&mesh, "disc"), area(&mesh, "plate"));
            assert!(
                (disc / inner - 1.0).abs() < 1e-13,
                "{shape:?} {disc} {inner}"
            );
            assert!((plate / (outer - inner) - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn the_area_converges_with_the_order_of_the_sides() {
    for shape in Shape::PLANE {
        let error = |n: usize| {
            let mesh = disc_in_plate(&example(n, shape)).unwrap();
            (area(&mesh, "disc") / (0.25 * PI * RADIUS * RADIUS) - 1.0).abs()
        };
        let order = (error(8) / error(16)).log2();
        let expected = if shape.is_quadratic() { 4.0 } else { 2.0 };
        // The next term of the series is (h/R)^2, about 1 percent here.
        assert!((order - expected).abs() < 0.02, "{shape:?} {order}");
    }
}

#[test]
fn contact_nodes_coincide_and_lie_at_equal_angles() {
    for shape in Shape::PLANE {
        let n = 12;
        let mesh = disc_in_plate(&example(n, shape)).unwrap();
        let on = |name: &str| surface::ordered_nodes(&mesh, &mesh.surfaces[name]).unwrap();
        let disc = on("disc.contact");
        let mut plate = on("plate.contact");
        plate.reverse();
        assert_eq!(disc.len(), nodes_on(n, shape));
        assert_eq!(plate.len(), disc.len());
        for (k, (&d, &p)) in disc.iter().zip(&plate).enumerate() {
            assert_ne!(d, p);
            assert_eq!(mesh.in_plane(d), mesh.in_plane(p));
            let [x, y] = mesh.in_plane(d);
            let angle = y.atan2(x) - FRAC_PI_2 * k as f64 / (disc.len() - 1) as f64;
            assert!(angle.abs() < 4.0 * f64::EPSILON);
        }
        let at = |name: &str| mesh.in_plane(mesh.node_sets[name][0]);
        assert_eq!(at("disc.pole"), [0.0, RADIUS]);
        assert_eq!(at("plate.pole"), [0.0, RADIUS]);
        assert_eq!(at("disc.center"), [0.0, 0.0]);
        assert_ne!(mesh.node_sets["disc.pole"], mesh.node_sets["plate.pole"]);
        let normals = surface::normals(&mesh, &mesh.surfaces["plate.contact"], &plate);
        for (normal, &node) in normals.iter().zip(&plate) {
            let [x, y] = mesh.in_plane(node);
            // The outward normal of the plate points into the hole.
            assert!((normal[0] + x / RADIUS).abs() < 4.0 * f64::EPSILON);
            assert!((normal[1] + y / RADIUS).abs() < 4.0 * f64::EPSILON);
        }
    }
}

#[test]
fn symmetry_lines_are_exact_and_the_disc_is_its_own_mirror_image() {
    for shape in Shape::PLANE {
        let mesh = disc_in_plate(&example(6, shape)).unwrap();
        for body in ["disc", "plate"] {
            for node in mesh.set_nodes(&format!("{body}.symmetry_x")).unwrap() {
                assert_eq!(mesh.in_plane(node)[0], 0.0);
            }
            for node in mesh.set_nodes(&format!("{body}.symmetry_y")).unwrap() {
                assert_eq!(mesh.in_plane(node)[1], 0.0);
            }
        }
        let near = |x: f64, y: f64| {
            (0..mesh.n_nodes()).any(|n| {
                let [a, b] = mesh.in_plane(n);
                (a - x).hypot(b - y) < 16.0 * f64::EPSILON * 20.0 * RADIUS
            })
        };
        for node in 0..mesh.n_nodes() {
            let [x, y] = mesh.in_plane(node);
            assert!(near(y, x), "({x}, {y})");
        }
        // Every node on a symmetry line belongs to a symmetry surface.
        let on_x = (0..mesh.n_nodes())
            .filter(|&n| mesh.in_plane(n)[0] == 0.0)
            .count();
        let named =
            ["disc", "plate"].map(|b| mesh.set_nodes(&format!("{b}.symmetry_x")).unwrap().len());
        assert_eq!(on_x, named[0] + named[1]);
    }
}

#[test]
fn elements_near_the_contact_are_about_as_deep_as_wide() {
    let n = 32;
    let mesh = disc_in_plate(&example(n, Shape::Quad4)).unwrap();
    let spacing = FRAC_PI_2 * RADIUS / n as f64;
    for (name, tolerance) in [("disc.contact", 0.35), ("plate.contact", 0.05)] {
        for &facet in &mesh.surfaces[name].facets {
            let nodes = mesh.nodes(facet.element);
            let radii: Vec<f64> = nodes
                .iter()
                .map(|&k| {
                    let [x, y] = mesh.in_plane(k as usize);
                    x.hypot(y)
                })
                .collect();
            let depth = radii.iter().fold(0.0f64, |a, &b| a.max(b))
                - radii.iter().fold(f64::MAX, |a, &b| a.min(b));
            assert!(
                (depth / spacing - 1.0).abs() < tolerance,
                "{name} {}",
                depth / spacing
            );
        }
    }
}

#[test]
fn interference_does_not_move_nodes() {
    let mut p = example(8, Shape::Quad8);
    let without = disc_in_plate(&p).unwrap();
    p.interference = 0.01;
    assert_eq!(disc_in_plate(&p).unwrap().coordinates, without.coordinates);
}

#[test]
fn refusals_name_key_and_value() {
    type Change = fn(&mut DiscInPlate);
    let cases: [(Change, &[&str]); 11] = [
        (|p| p.radius = -2.0, &["radius = -2"]),
        (|p| p.radius = f64::NAN, &["radius = NaN"]),
        (|p| p.interference = f64::NAN, &["interference = NaN"]),
        (|p| p.resolution = 0, &["resolution = 0"]),
        (|p| p.resolution = 7, &["resolution = 7", "even", "8"]),
        (|p| p.resolution = usize::MAX, &["resolution", "even"]),
        (
            |p| p.resolution = usize::MAX - 1,
            &["resolution", "elements"],
        ),
        (|p| p.far_radius = 1.0, &["far_radius", "more than 1"]),
        (|p| p.far_radius = f64::NAN, &["far_radius = NaN"]),
        (|p| p.growth = 0.0, &["growth = 0"]),
        (|p| p.far_growth = Some(1.0), &["far_growth = 1:"]),
    ];
    for (change, parts) in cases {
        let mut p = example(8, Shape::Quad4);
        change(&mut p);
        let error = disc_in_plate(&p).unwrap_err();
        assert_eq!(error.kind(), crate::ErrorKind::Input);
        assert!(error.message().contains("mesh.disc_in_plate."), "{error}");
        for part in parts {
            assert!(error.message().contains(part), "{error} lacks {part}");
        }
    }
}
