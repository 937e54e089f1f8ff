use super::*;
use crate::mesh::{Curve, Shape};

/// Two unit squares side by side, with surfaces on their outer edges.
fn two_squares() -> Mesh {
    let mut mesh = Mesh {
        dimension: 2,
        coordinates: vec![0., 0., 1., 0., 2., 0., 0., 1., 1., 1., 2., 1.],
        bodies: vec!["a".to_string()],
        ..Mesh::default()
    };
    mesh.push_element(Shape::Quad4, 0, &[0, 1, 4, 3]);
    mesh.push_element(Shape::Quad4, 0, &[1, 2, 5, 4]);
    mesh
}

fn surface(facets: &[(usize, usize)]) -> Surface {
    Surface {
        facets: facets
            .iter()
            .map(|&(element, local)| Facet { element, local })
            .collect(),
        curve: None,
    }
}

#[test]
fn nodes_follow_the_arc_whatever_the_order_of_the_facets() {
    let mesh = two_squares();
    let bottom_and_right = surface(&[(1, 1), (0, 0), (1, 0)]);
    assert_eq!(
        ordered_nodes(&mesh, &bottom_and_right).unwrap(),
        [0, 1, 2, 5]
    );
}

#[test]
fn a_closed_surface_does_not_repeat_its_first_node() {
    let mesh = two_squares();
    let outline = surface(&[(1, 1), (0, 3), (0, 2), (1, 2), (1, 0), (0, 0)]);
    assert_eq!(ordered_nodes(&mesh, &outline).unwrap(), [0, 1, 2, 5, 4, 3]);
}

#[test]
fn pieces_branches_and_empty_surfaces_are_refused_by_name() {
    let mesh = two_squares();
    let error = ordered_nodes(&mesh, &surface(&[(0, 0), (1, 2)])).unwrap_err();
    assert!(
        error.message().contains("several pieces (1 of 2"),
        "{error}"
    );
    assert!(
        error.message().contains("node 1,") && error.message().contains("node 6"),
        "{error}"
    );
    let error = ordered_nodes(&mesh, &surface(&[(0, 0), (1, 0), (0, 1)])).unwrap_err();
    assert!(error.message().contains("branches at node 2"), "{error}");
    let error = ordered_nodes(&mesh, &Surface::default()).unwrap_err();
    assert!(error.message().contains("empty"), "{error}");
}

#[test]
fn a_closed_piece_beside_an_open_one_is_found() {
    let mesh = two_squares();
    let mixed = surface(&[(0, 0), (0, 1), (0, 2), (0, 3), (1, 1)]);
    let error = ordered_nodes(&mesh, &mixed).unwrap_err();
    assert!(error.message().contains("several pieces"), "{error}");
}

#[test]
fn averaged_normals_are_weighted_and_point_outward() {
    let mut mesh = two_squares();
    // The right square becomes three times as wide.
    mesh.coordinates[4] = 4.0;
    mesh.coordinates[10] = 4.0;
    let bottom_and_right = surface(&[(0, 0), (1, 0), (1, 1)]);
    let normals = normals(&mesh, &bottom_and_right, &[0, 1, 2, 5, 3]);
    assert_eq!(normals[0], [0.0, -1.0, 0.0]);
    assert_eq!(normals[1], [0.0, -1.0, 0.0]);
    // The shorter of two edges has more weight; a corner is not taken for a circle to be continued.
    let length = 10f64.sqrt();
    assert!((normals[2][0] - 3.0 / length).abs() < 1e-15);
    assert!((normals[2][1] + 1.0 / length).abs() < 1e-15);
    assert_eq!(normals[3], [1.0, 0.0, 0.0]);
    assert_eq!(normals[4], [0.0; 3], "not on the surface");
}

/// Normals of nodes on a circle and on a sphere, with unequal facets, are those of the circle and
/// the sphere, so a rotation of the body about the centre changes no gap.
#[test]
fn normals_of_round_surfaces_are_those_of_circles_and_spheres() {
    let mut random = [0.31, 0.87, 0.12, 0.66, 0.45, 0.93, 0.28, 0.74]
        .iter()
        .cycle();
    let mut next = |low: f64, high: f64| low + (high - low) * random.next().unwrap();
    let mut mesh = Mesh {
        dimension: 2,
        bodies: vec!["a".to_string()],
        ..Mesh::default()
    };
    // Eight quadrilaterals in a sector of a ring of more than 200 degrees; its inner side is the
    // surface.
    let mut angle = 0.3;
    for _ in 0..=8 {
        for radius in [2.0, 3.0] {
            mesh.coordinates
                .extend([radius * f64::cos(angle), radius * f64::sin(angle)]);
        }
        angle += next(0.2, 0.7);
    }
    for k in 0..8u32 {
        mesh.push_element(Shape::Quad4, 0, &[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2]);
    }
    let inner: Vec<(usize, usize)> = (0..8usize).map(|k| (k, 3)).collect();
    let inner = surface(&inner);
    let nodes: Vec<usize> = (0..=8).map(|k| 2 * k).collect();
    for (&node, normal) in nodes.iter().zip(normals(&mesh, &inner, &nodes)) {
        let [x, y, _] = mesh.point(node);
        let off = length(difference(normal, [-x / 2.0, -y / 2.0, 0.0]));
        assert!(off < 1e-14, "{node}: {off}");
    }

    // A patch of three by three faces on a sphere, the lower side of hexahedra.
    let mut solid = Mesh {
        dimension: 3,
        bodies: vec!["a".to_string()],
        ..Mesh::default()
    };
    let at: [Vec<f64>; 2] = [0, 1].map(|_| {
        (0..4)
            .map(|i| 0.2 * f64::from(i) + next(0.0, 0.1))
            .collect()
    });
    for up in [0.0, 1.0] {
        for x in &at[0] {
            for y in &at[1] {
                let z = -(4.0 - x * x - y * y).sqrt();
                solid
                    .coordinates
                    .extend([*x, *y, if up > 0.0 { 0.0 } else { z }]);
            }
        }
    }
    let node = |i: usize, j: usize, up: usize| 16 * up + 4 * i + j;
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let ring = |up| {
            [
                node(i, j, up),
                node(i + 1, j, up),
                node(i + 1, j + 1, up),
                node(i, j + 1, up),
            ]
        };
        let nodes: Vec<u32> = (ring(0).into_iter().chain(ring(1)))
            .map(|n| n as u32)
            .collect();
        solid.push_element(Shape::Hex8, 0, &nodes);
    }
    let lower: Vec<(usize, usize)> = (0..9).map(|e| (e, 0)).collect();
    for (i, j) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
        let x = solid.point(node(i, j, 0));
        let normal = normals(&solid, &surface(&lower), &[node(i, j, 0)])[0];
        let off = length(difference(normal, x.map(|x| x / 2.0)));
        assert!(off < 1e-14, "{i} {j}: {normal:?} {x:?}");
    }
}

#[test]
fn known_curves_give_exact_normals() {
    let mesh = two_squares();
    let mut bottom = surface(&[(0, 0), (1, 0)]);
    bottom.curve = Some(Curve::Line {
        normal: [0.0, -2.0],
    });
    assert_eq!(normals(&mesh, &bottom, &[0, 2]), [[0.0, -1.0, 0.0]; 2]);
    for outward in [true, false] {
        bottom.curve = Some(Curve::Circle {
            center: [1.0, 0.0],
            radius: 1.0,
            outward,
        });
        let sign = if outward { 1.0 } else { -1.0 };
        assert_eq!(
            normals(&mesh, &bottom, &[2]),
            [[sign, 0.0 * sign, 0.0 * sign]]
        );
    }
}

#[test]
fn a_parabolic_facet_has_its_own_normal_at_each_node() {
    // The bottom is y = x^2 - 1 over [-1, 1], with slope 2 x.
    let mut mesh = Mesh {
        dimension: 2,
        coordinates: vec![-1., 0., 1., 0., 0., 3., 0., -1., 0.5, 1.5, -0.5, 1.5],
        bodies: vec!["a".to_string()],
        ..Mesh::default()
    };
    mesh.push_element(Shape::Tri6, 0, &[0, 1, 2, 3, 4, 5]);
    let bottom = surface(&[(0, 0)]);
    assert_eq!(ordered_nodes(&mesh, &bottom).unwrap(), [0, 3, 1]);
    let computed = normals(&mesh, &bottom, &[0, 3, 1]);
    for (normal, slope) in computed.iter().zip([-2.0, 0.0, 2.0]) {
        let length = f64::hypot(1.0, slope);
        assert!((normal[0] - slope / length).abs() < 1e-15, "{normal:?}");
        assert!((normal[1] + 1.0 / length).abs() < 1e-15, "{normal:?}");
    }
}

/// The lower face of one hexahedron and the upper face of the element next to it.
#[test]
fn faces_that_look_to_different_sides_are_named() {
    let mut mesh = Mesh {
        dimension: 3,
        bodies: vec!["a".to_string()],
        ..Mesh::default()
    };
    // Two layers of two cubes each.
    for k in 0..3 {
        for j in 0..2 {
            for i in 0..3 {
                mesh.coordinates.extend([i, j, k].map(f64::from));
            }
        }
    }
    for first in [0, 1, 6, 7] {
        let below = [first, first + 1, first + 4, first + 3];
        let nodes = [below, below.map(|n| n + 6)].concat();
        mesh.push_element(Shape::Hex8, 0, &nodes);
    }
    // Facet 0 is the lower face and facet 1 the upper one; both lie at z = 1.
    assert!(nodes(&mesh, &surface(&[(0, 1), (1, 1)])).is_ok());
    let error = nodes(&mesh, &surface(&[(0, 1), (3, 0)])).unwrap_err();
    for text in [
        "elements 1 and 4 look to different sides",
        "from node ",
        "one side",
    ] {
        assert!(error.message().contains(text), "{error}");
    }
}
