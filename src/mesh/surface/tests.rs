use super::*;
use crate::mesh::{Curve, Shape};

/// Two unit squares side by side, and their outer edges.
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
fn averaged_normals_are_weighted_with_length_and_point_outward() {
    let mut mesh = two_squares();
    // The right square is three times as wide.
    mesh.coordinates[4] = 4.0;
    mesh.coordinates[10] = 4.0;
    let bottom_and_right = surface(&[(0, 0), (1, 0), (1, 1)]);
    let normals = normals(&mesh, &bottom_and_right, &[0, 1, 2, 5, 3]);
    assert_eq!(normals[0], [0.0, -1.0, 0.0]);
    assert_eq!(normals[1], [0.0, -1.0, 0.0]);
    let length = 10f64.sqrt();
    assert!((normals[2][0] - 1.0 / length).abs() < 1e-15);
    assert!((normals[2][1] + 3.0 / length).abs() < 1e-15);
    assert_eq!(normals[3], [1.0, 0.0, 0.0]);
    assert_eq!(normals[4], [0.0; 3], "not on the surface");
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
    // Bottom y = x^2 - 1 over [-1, 1]: slope 2 x.
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

/// The lower face of one hexahedron and the upper one of its neighbour, beside each other.
#[test]
fn faces_that_look_to_different_sides_are_named() {
    let mut mesh = Mesh {
        dimension: 3,
        bodies: vec!["a".to_string()],
        ..Mesh::default()
    };
    // Two layers of two cubes.
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
    // Facet 0 is the lower, facet 1 the upper one: both at z = 1.
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
