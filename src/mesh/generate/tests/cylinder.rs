use super::*;
use crate::mesh::generate::{ContactSize, contact_size, cylinder_on_half_plane};
use crate::scene::CylinderOnHalfPlane;

const RADIUS: f64 = 100.0;
const HALF_WIDTH: f64 = 1.1;

pub(super) fn example(element: Shape) -> CylinderOnHalfPlane {
    CylinderOnHalfPlane {
        names: ["cylinder", "half_plane"].map(String::from),
        radius: RADIUS,
        resolution: 6,
        half_width: None,
        fine_width: 2.0,
        contact_width: None,
        fine_depth: 1.5,
        far_size: Some(50.0),
        growth: 1.15,
        far_growth: None,
        element,
    }
}

#[test]
fn both_bodies_are_valid_and_match_in_x() {
    for shape in Shape::PLANE {
        let mesh =
            cylinder_on_half_plane(&example(shape), ContactSize::at_yield(HALF_WIDTH)).unwrap();
        check_common(&mesh);
        for piece in ["contact", "outside"] {
            let on = |body: &str| {
                let surface = &mesh.surfaces[&format!("{body}.{piece}")];
                let mut nodes = surface::ordered_nodes(&mesh, surface).unwrap();
                if body == "half_plane" {
                    nodes.reverse();
                }
                nodes
            };
            let (upper, lower) = (on("cylinder"), on("half_plane"));
            assert_eq!(upper.len(), lower.len());
            for (u, l) in upper.iter().zip(&lower) {
                let ([xu, yu], [xl, yl]) = (mesh.in_plane(*u), mesh.in_plane(*l));
                assert_eq!(xu, xl);
                assert_eq!(yl, 0.0);
                let exact = Profile::of_example().height(xu);
                assert!(
                    (yu - exact).abs() <= 4.0 * f64::EPSILON * RADIUS,
                    "{yu} {exact}"
                );
                if piece == "contact" {
                    // Checks the relative accuracy of the small gaps near the pole, which a formula
                    // with cancellation would lose.
                    let small = xu * xu / (2.0 * RADIUS);
                    assert!(yu >= small && yu <= small * (1.0 + 2.0 * (xu / RADIUS).powi(2)));
                }
            }
        }
    }
}

#[test]
fn candidates_end_at_the_fine_width_and_are_even() {
    for shape in Shape::PLANE {
        let p = example(shape);
        let mesh = cylinder_on_half_plane(&p, ContactSize::at_yield(HALF_WIDTH)).unwrap();
        let contact = &mesh.surfaces["cylinder.contact"];
        assert_eq!(contact.facets.len(), 12);
        let nodes = surface::ordered_nodes(&mesh, contact).unwrap();
        assert_eq!(nodes.len(), nodes_on(12, shape));
        let h = 2.0 * HALF_WIDTH / (nodes.len() - 1) as f64;
        for (k, &node) in nodes.iter().enumerate() {
            let error = (mesh.in_plane(node)[0] - k as f64 * h).abs();
            assert!(error <= 4.0 * f64::EPSILON * HALF_WIDTH);
        }
        for body in ["cylinder", "half_plane"] {
            let pole = mesh.node_sets[&format!("{body}.pole")][0];
            assert_eq!(mesh.in_plane(pole), [0.0, 0.0]);
            assert!(
                mesh.set_nodes(&format!("{body}.contact"))
                    .unwrap()
                    .contains(&pole)
            );
            assert!(
                mesh.set_nodes(&format!("{body}.symmetry"))
                    .unwrap()
                    .contains(&pole)
            );
            for node in mesh.set_nodes(&format!("{body}.symmetry")).unwrap() {
                assert_eq!(mesh.in_plane(node)[0], 0.0);
            }
            for node in mesh.set_nodes(&format!("{body}.side")).unwrap() {
                assert_eq!(mesh.in_plane(node)[0], 50.0 * HALF_WIDTH);
            }
        }
        for node in mesh.set_nodes("cylinder.top").unwrap() {
            assert_eq!(mesh.in_plane(node)[1], 50.0 * HALF_WIDTH);
        }
        for node in mesh.set_nodes("half_plane.bottom").unwrap() {
            assert_eq!(mesh.in_plane(node)[1], -50.0 * HALF_WIDTH);
        }
    }
}

/// Beyond the even part the elements of the candidates grow so slowly that a contact of any half
/// width has at least `resolution` elements over it. Within the even part, and without a reach
/// beyond it, nothing changes.
#[test]
fn candidates_reach_as_far_as_the_contact_with_enough_elements_over_any_part_of_them() {
    for shape in Shape::PLANE {
        let p = example(shape);
        let corners = |reach: f64| {
            let size = ContactSize {
                half_width: HALF_WIDTH,
                reach: reach * HALF_WIDTH,
                far_size: 50.0,
            };
            let mesh = cylinder_on_half_plane(&p, size).unwrap();
            check_common(&mesh);
            let contact = &mesh.surfaces["cylinder.contact"];
            let mut x: Vec<f64> = contact
                .facets
                .iter()
                .flat_map(|&f| mesh.facet_nodes(f).take(2).collect::<Vec<_>>())
                .map(|node| mesh.in_plane(node)[0])
                .collect();
            x.sort_by(f64::total_cmp);
            x.dedup();
            x
        };
        assert_eq!(corners(1.9), corners(0.0));
        let x = corners(9.0);
        let last = x[x.len() - 1];
        assert!(
            (9.0 * HALF_WIDTH..11.0 * HALF_WIDTH).contains(&last),
            "{last}"
        );
        for (k, &edge) in x.iter().enumerate().skip(p.resolution) {
            assert!(k >= p.resolution);
            // The ratio of the size at the edge to the distance is at most the one at first yield.
            let size = edge - x[k - 1];
            assert!(
                size <= edge / p.resolution as f64 * (1.0 + 1e-12),
                "{edge} {size}"
            );
        }
        // Twelve even elements, then a geometric series over the rest: the number is logarithmic in
        // the reach.
        let (n, r) = (
            p.resolution as f64,
            p.growth.min(1.0 + 1.0 / p.resolution as f64),
        );
        let expected = 13.0 + (1.0 + (9.0 - 2.0) * n * (r - 1.0) / r).ln() / r.ln();
        let off = (x.len() as f64 - expected).abs();
        assert!(off <= 1.0, "{} {expected}", x.len());
    }
}

/// The surface of the example's cylinder: the circle out to the last candidate at `edge`, an
/// exponential beyond.
struct Profile {
    edge: f64,
    slope: f64,
}

impl Profile {
    fn of_example() -> Profile {
        let edge = 2.0 * HALF_WIDTH;
        let slope = edge / (RADIUS * RADIUS - edge * edge).sqrt();
        Profile { edge, slope }
    }

    fn circle(x: f64) -> f64 {
        RADIUS * (1.0 - (x / RADIUS).asin().cos())
    }

    fn decay(&self, x: f64) -> f64 {
        (-(x - self.edge) / self.edge).exp()
    }

    fn height(&self, x: f64) -> f64 {
        if x <= self.edge {
            return Self::circle(x);
        }
        Self::circle(self.edge) + self.slope * self.edge * (1.0 - self.decay(x))
    }

    /// Integral of the height from 0 to `end`, for `end` beyond the edge.
    fn integral(&self, end: f64) -> f64 {
        let (r, c, s) = (RADIUS, self.edge, self.slope);
        let circle = r * c - 0.5 * (c * (r * r - c * c).sqrt() + r * r * (c / r).asin());
        let level = (Self::circle(c) + s * c) * (end - c);
        circle + level - s * c * c * (1.0 - self.decay(end))
    }

    /// Second and fourth derivative of the height to the right (`outside`) or left of the edge; on
    /// each piece both grow with x.
    fn derivatives(&self, x: f64, outside: bool) -> [f64; 2] {
        if outside {
            let second = -self.slope / self.edge * self.decay(x);
            return [second, second / self.edge.powi(2)];
        }
        let r = RADIUS * RADIUS;
        let u = r - x * x;
        [r * u.powf(-1.5), 3.0 * r * (r + 4.0 * x * x) * u.powf(-3.5)]
    }
}

/// Linear sides give the trapezoidal rule for the area under the surface, parabolic sides Simpson's
/// rule. The errors are `h^3 f^(2)/12` and `h^5 f^(4)/2880` with the derivative at a point of each
/// side, so they lie between the values at the ends of the side.
#[test]
fn areas_are_those_of_the_quadrature_of_the_surface() {
    let size = 50.0 * HALF_WIDTH;
    let profile = Profile::of_example();
    for shape in Shape::PLANE {
        let mesh =
            cylinder_on_half_plane(&example(shape), ContactSize::at_yield(HALF_WIDTH)).unwrap();
        let plane = area(&mesh, "half_plane");
        assert!((plane / (size * size) - 1.0).abs() < 1e-13, "{plane}");
        let round_off = 1e-13 * size * size;
        let (mut least, mut most) = (0.0, 0.0);
        for (piece, outside) in [("cylinder.contact", false), ("cylinder.outside", true)] {
            for &facet in &mesh.surfaces[piece].facets {
                let ends: Vec<f64> = mesh
                    .facet_nodes(facet)
                    .map(|n| mesh.in_plane(n)[0])
                    .collect();
                let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                let error = |x: f64| {
                    let [second, fourth] = profile.derivatives(x, outside);
                    if shape.is_quadratic() {
                        (to - from).powi(5) / 2880.0 * fourth
                    } else {
                        (to - from).powi(3) / 12.0 * second
                    }
                };
                least += error(from);
                most += error(to);
            }
        }
        let under = size * size - area(&mesh, "cylinder") - profile.integral(size);
        assert!(
            least - round_off <= under && under <= most + round_off,
            "{shape:?}: {under} is not between {least} and {most}"
        );
        // The bounds are wider than round-off, so the formulas are really tested.
        assert!(most - least > round_off && least.abs() > round_off);
    }
}

#[test]
fn the_widest_candidates_are_valid() {
    let sizes = [92.0, 155.0, 2000.0];
    for (shape, far_size) in Shape::PLANE.into_iter().flat_map(|s| sizes.map(|w| (s, w))) {
        let mut p = example(shape);
        // Candidates reach up to 0.9 of the radius, where the circle's slope is 2.
        p.fine_width = 90.0;
        p.resolution = 1;
        p.fine_depth = 2.0;
        p.far_size = Some(far_size);
        p.growth = 1.3;
        check_common(&cylinder_on_half_plane(&p, ContactSize::at_yield(1.0)).unwrap());
    }
}

#[test]
fn scaling_all_lengths_scales_the_mesh() {
    let p = example(Shape::Quad8);
    let mesh = cylinder_on_half_plane(&p, ContactSize::at_yield(HALF_WIDTH)).unwrap();
    for power in [-40, 40] {
        let scale = 2f64.powi(power);
        let mut q = p.clone();
        q.radius *= scale;
        let scaled = cylinder_on_half_plane(&q, ContactSize::at_yield(HALF_WIDTH * scale)).unwrap();
        validate(&scaled).unwrap();
        assert_eq!(mesh.connectivity, scaled.connectivity);
        for (a, b) in mesh.coordinates.iter().zip(&scaled.coordinates) {
            assert_eq!(a * scale, *b);
        }
    }
}

#[test]
fn refusals_name_key_and_value() {
    type Change = fn(&mut CylinderOnHalfPlane);
    let cases: [(Change, &[&str]); 16] = [
        (|p| p.radius = 0.0, &["radius = 0"]),
        (|p| p.radius = f64::NAN, &["radius = NaN"]),
        (|p| p.radius = f64::INFINITY, &["radius = inf"]),
        (|p| p.radius = 1e300, &["radius"]),
        (|p| p.resolution = 0, &["resolution = 0"]),
        (|p| p.resolution = usize::MAX, &["resolution", "elements"]),
        (|p| p.fine_width = -1.0, &["fine_width = -1"]),
        (
            |p| p.fine_width = 0.01,
            &["fine_width = 0.01", "at least 0.1666"],
        ),
        (|p| p.fine_depth = f64::NAN, &["fine_depth = NaN"]),
        (
            |p| p.fine_depth = 60.0,
            &["far_size = 50", "fine_depth = 60"],
        ),
        (|p| p.growth = 0.9, &["growth = 0.9"]),
        (|p| p.growth = f64::NAN, &["growth = NaN"]),
        (|p| p.far_growth = Some(1.1), &["far_growth = 1.1", "1.15"]),
        (
            |p| (p.growth, p.far_growth) = (1.0, Some(2.0)),
            &["far_growth = 2", "above 1"],
        ),
        (|p| p.far_size = Some(0.0), &["far_size = 0"]),
        (
            |p| p.fine_width = 90.0,
            &["fine_width = 90", "0.9 of the radius", "at most 81.8"],
        ),
    ];
    for (change, parts) in cases {
        let mut p = example(Shape::Quad4);
        change(&mut p);
        let error = cylinder_on_half_plane(&p, ContactSize::at_yield(HALF_WIDTH)).unwrap_err();
        assert_eq!(error.kind(), crate::ErrorKind::Input);
        assert!(
            error.message().contains("mesh.cylinder_on_half_plane."),
            "{error}"
        );
        for part in parts {
            assert!(error.message().contains(part), "{error} lacks {part}");
        }
    }
    for half_width in [0.0, -1.0, f64::NAN] {
        let error =
            cylinder_on_half_plane(&example(Shape::Quad4), ContactSize::at_yield(half_width))
                .unwrap_err();
        assert!(error.message().contains("half_width ="), "{error}");
    }
}

/// An extruded cylinder of any depth, whole or half, under its share of the force gets the mesh
/// size of the plane model's contact.
#[test]
fn an_extruded_cylinder_is_meshed_for_the_contact_of_the_plane_one() {
    let size = |kind: &str, mesh: &str, total: f64| {
        let text = format!(
            "kind = \"{kind}\"\nsymmetry = 2\n{mesh}\n\
             [mesh.cylinder_on_half_plane]\nradius = 10\nresolution = 4\nhalf_width = 0.2\n\
             [materials.steel]\nyoungs_modulus = 210000\npoissons_ratio = 0.3\nyield_stress = 500\n\
             [bodies]\ncylinder.material = \"steel\"\nhalf_plane.material = \"steel\"\n\
             [[contact]]\nfirst = \"cylinder.contact\"\nsecond = \"half_plane.contact\"\n\
             [[load]]\non = \"cylinder.top\"\n\
             plane_force = {{ direction = \"y\", total = {total} }}\n\
             [program]\ntargets = [{{ load_factor = 1 }}]\n"
        );
        let scene = crate::scene::Scene::parse(&text, "test.toml").unwrap();
        let parameters = scene.mesh.cylinder_on_half_plane.as_ref().unwrap();
        contact_size::of(&scene, parameters).unwrap().reach
    };
    let plane = size("plane_strain", "", -900.0);
    let extruded = size(
        "solid",
        "[mesh]\nextrude = { depth = 3, elements = 2 }",
        -2700.0,
    );
    assert!(plane > 0.2, "{plane}");
    assert!((extruded / plane - 1.0).abs() < 1e-12, "{extruded} {plane}");
}
