use super::*;
use crate::mesh::Surface;

/// A 2 x 2 grid of squares of side 1, with nodes 0..9 row by row.
fn grid() -> Mesh {
    let mut mesh = Mesh {
        dimension: 2,
        bodies: vec!["plate".to_string()],
        ..Mesh::default()
    };
    for j in 0..3 {
        for i in 0..3 {
            mesh.coordinates.extend([f64::from(i), f64::from(j)]);
        }
    }
    for first in [0, 1, 3, 4] {
        mesh.push_element(Shape::Quad4, 0, &[first, first + 1, first + 4, first + 3]);
    }
    mesh.node_sets.insert("corner".to_string(), vec![0]);
    mesh.surfaces.insert(
        "bottom".to_string(),
        Surface {
            facets: vec![
                Facet {
                    element: 0,
                    local: 0,
                },
                Facet {
                    element: 1,
                    local: 0,
                },
            ],
            curve: None,
        },
    );
    mesh
}

#[test]
fn a_good_mesh_passes() {
    validate(&grid()).unwrap();
}

fn refused(change: impl Fn(&mut Mesh), expected: &[&str]) {
    let mut mesh = grid();
    change(&mut mesh);
    let error = validate(&mesh).unwrap_err();
    for text in expected {
        assert!(error.message().contains(text), "{error} lacks `{text}`");
    }
}

#[test]
fn each_fault_of_nodes_bodies_and_elements_is_named() {
    refused(
        |m| {
            *m = Mesh {
                dimension: 2,
                ..Mesh::default()
            }
        },
        &["no elements"],
    );
    refused(|m| m.dimension = 3, &["element 1 is a quad4 in 3D"]);
    refused(|m| m.dimension = 4, &["dimension is 4"]);
    refused(|m| m.coordinates[9] = f64::NAN, &["node 5", "y is NaN"]);
    refused(
        |m| m.coordinates[0] = f64::INFINITY,
        &["node 1", "x is inf"],
    );
    refused(
        |m| m.coordinates.extend([7.0, 7.0]),
        &["1 nodes belong to no element: 10"],
    );
    refused(
        |m| m.bodies.push("ghost".into()),
        &["body `ghost` has no elements"],
    );
    refused(
        |m| {
            m.bodies.push("plate".into());
            m.element_body[3] = 1;
        },
        &["two bodies are named `plate`"],
    );
    refused(
        |m| m.connectivity[2] = 0,
        &["element 1 (quad4, body `plate`)", "node 1 twice"],
    );
    refused(
        |m| m.push_element(Shape::Quad4, 0, &[1, 4, 3, 0]),
        &["element 1 ", "element 5 ", "same corners"],
    );
}

#[test]
fn each_fault_of_sets_and_labels_is_named() {
    refused(
        |m| {
            m.node_sets.insert("none".into(), vec![]);
        },
        &["node set `none` is empty"],
    );
    refused(
        |m| {
            m.node_sets.insert("twice".into(), vec![3, 3]);
        },
        &["`twice`"],
    );
    refused(
        |m| {
            m.surfaces.insert("none".into(), Surface::default());
        },
        &["surface `none` is empty"],
    );
    refused(
        |m| {
            m.node_sets.insert("bottom".into(), vec![0]);
        },
        &["`bottom` is both"],
    );
    refused(
        |m| {
            let surface = m.surfaces.get_mut("bottom").unwrap();
            surface.facets.push(surface.facets[1]);
        },
        &["surface `bottom`", "element 2 twice"],
    );
    refused(
        |m| m.node_labels = vec![4; 9],
        &["node number 4 is given twice"],
    );
    refused(
        |m| m.element_labels = vec![1, 2, 3, 2],
        &["element number 2 is given twice"],
    );
    refused(|m| m.element_labels = vec![1], &["1 element labels for 4"]);
}

#[test]
fn broken_arrays_are_refused_before_they_are_indexed() {
    refused(|m| m.coordinates.truncate(17), &["17 coordinates"]);
    refused(
        |m| m.coordinates.truncate(16),
        &["node index 8 with 8 nodes"],
    );
    refused(|m| m.offsets[1] = 3, &["offsets"]);
    refused(|m| m.offsets.truncate(2), &["2 offsets"]);
    refused(|m| m.element_body[0] = 7, &["body index 7"]);
    refused(
        |m| {
            m.node_sets.insert("far".into(), vec![99]);
        },
        &["node index 99 in set `far`"],
    );
    refused(
        |m| m.surfaces.get_mut("bottom").unwrap().facets[0].local = 4,
        &["surface `bottom`"],
    );
    refused(
        |m| m.surfaces.get_mut("bottom").unwrap().facets[0].element = 4,
        &["surface `bottom`"],
    );
}

#[test]
fn bad_shapes_are_named_by_the_users_number() {
    let mut mesh = grid();
    mesh.element_labels = vec![11, 12, 13, 14];
    mesh.connectivity[4..8].reverse();
    let error = validate(&mesh).unwrap_err().to_string();
    assert!(
        error.contains("element 12 (quad4, body `plate`)"),
        "{error}"
    );
    assert!(
        error.contains("inverted") && error.contains("-1.000e0"),
        "{error}"
    );
    // A quadrilateral with a reentrant corner has a negative Jacobian only at this corner.
    refused(
        |m| {
            m.coordinates[8] = 0.1;
            m.coordinates[9] = 0.1;
        },
        &["element 1 ", "distorted"],
    );
}

#[test]
fn slivers_are_refused_from_the_aspect_ratio_at_which_double_precision_ends() {
    let flattened = |height: f64| {
        let mut mesh = grid();
        for node in 0..9 {
            mesh.coordinates[2 * node + 1] *= height;
        }
        validate(&mesh)
    };
    flattened(1e-7).unwrap();
    let error = flattened(1e-8).unwrap_err();
    assert!(error.message().contains("is flat"), "{error}");
}

/// With a mid-side node at x along a side, the Jacobian is negative at the corner once x is beyond
/// the quarter point; at the integration points it is 2 x along the side.
#[test]
fn a_mid_side_node_past_the_quarter_point_is_warned_of_until_it_folds_what_is_integrated() {
    let with_mid_side = |x: f64| {
        let mut mesh = Mesh {
            dimension: 2,
            coordinates: vec![0., 0., 1., 0., 0., 1., x, 0., 0.5, 0.5, 0., 0.5],
            bodies: vec!["a".to_string()],
            ..Mesh::default()
        };
        mesh.push_element(Shape::Tri6, 0, &[0, 1, 2, 3, 4, 5]);
        validate(&mesh).map(|()| warning_of_folds(&mesh))
    };
    assert_eq!(with_mid_side(0.3).unwrap(), None);
    let warning = with_mid_side(0.2).unwrap().unwrap();
    assert!(warning.contains("element 1 (tri6, body `a`)"), "{warning}");
    let error = with_mid_side(-0.01).unwrap_err();
    assert!(error.message().contains("distorted"), "{error}");
}

#[test]
fn elements_that_overlap_or_do_not_fit_are_refused() {
    // A triangle on the inner side of the edge 0-1 of element 1.
    refused(
        |m| {
            m.coordinates.extend([0.5, 0.3]);
            m.push_element(Shape::Tri3, 0, &[0, 1, 9]);
        },
        &["element 1 ", "element 5 ", "overlap", "nodes 1 and 2"],
    );
    // A third element at the edge between elements 1 and 2.
    refused(
        |m| {
            m.coordinates.extend([0.5, 0.3]);
            m.push_element(Shape::Tri3, 0, &[1, 4, 9]);
        },
        &["element 5 ", "overlap"],
    );
    // A quadratic triangle next to a linear quadrilateral.
    refused(
        |m| {
            m.coordinates
                .extend([2.5, 0.5, 2.0, 0.5, 2.3, 0.8, 2.3, 0.2]);
            m.push_element(Shape::Tri6, 0, &[2, 9, 5, 12, 11, 10]);
        },
        &[
            "only one has a mid-side node",
            "element 2 (body `plate`) (quad4)",
            "(tri6)",
        ],
    );
    // Two quadratic triangles, each with its own node in the middle of their common edge.
    refused(
        |m| {
            *m = Mesh {
                dimension: 2,
                bodies: vec!["plate".to_string()],
                ..Mesh::default()
            };
            m.coordinates = [
                [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.5, 0.5],
                [0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0, 0.5, 0.5],
            ]
            .concat();
            m.push_element(Shape::Tri6, 0, &[0, 1, 2, 3, 4, 5]);
            m.push_element(Shape::Tri6, 0, &[1, 6, 2, 7, 8, 9]);
        },
        &[
            "nodes 2 and 3",
            "different mid-side nodes 5 and 10",
            "merge them",
        ],
    );
}

#[test]
fn a_hanging_node_is_found_on_edges_in_any_direction() {
    for (c, s) in [
        (1.0, 0.0),
        (0.0, 1.0),
        (0.8, 0.6),
        (-0.6, 0.8),
        (0.5257, -0.8507),
    ] {
        // A square of side 2 on top of two squares of side 1: node 8 (index 7) hangs on its edge.
        let mut mesh = grid();
        mesh.coordinates.extend([0.0, 4.0, 2.0, 4.0]);
        mesh.push_element(Shape::Quad4, 0, &[6, 8, 10, 9]);
        for node in 0..mesh.n_nodes() {
            let [x, y] = mesh.in_plane(node);
            mesh.coordinates[2 * node] = c * x - s * y;
            mesh.coordinates[2 * node + 1] = s * x + c * y;
        }
        let error = validate(&mesh).unwrap_err();
        assert!(error.message().contains("node 8 hangs"), "{error}");
        assert!(error.message().contains("element 5 "), "{error}");
        // In a body of its own, the square is in contact or is a mistake of the scene, not of the
        // mesh.
        mesh.bodies.push("cover".to_string());
        mesh.element_body[4] = 1;
        validate(&mesh).unwrap();
    }
}

#[test]
fn bodies_may_share_nodes_when_bonded() {
    let mut mesh = grid();
    mesh.bodies.push("other".to_string());
    mesh.element_body[2] = 1;
    mesh.element_body[3] = 1;
    validate(&mesh).unwrap();
}

/// A second grid beside the first one is accepted as another body. As a part of the first body it
/// is refused, unless a body in between joins the two.
#[test]
fn a_body_in_several_pieces_is_named() {
    let two = |bodies: &[&str], of: [usize; 3]| {
        let mut mesh = Mesh {
            dimension: 2,
            bodies: bodies.iter().map(|b| b.to_string()).collect(),
            ..Mesh::default()
        };
        for (k, body) in of.into_iter().enumerate() {
            let (low, first) = (2.0 * k as f64, 4 * k as u32);
            mesh.coordinates
                .extend([low, 0.0, low + 1.0, 0.0, low + 1.0, 1.0, low, 1.0]);
            mesh.push_element(
                Shape::Quad4,
                body,
                &[first, first + 1, first + 2, first + 3],
            );
        }
        mesh
    };
    validate(&two(&["a", "b", "c"], [0, 1, 2])).unwrap();
    let error = validate(&two(&["a", "b"], [0, 1, 0])).unwrap_err();
    for text in [
        "body `a` is in several pieces",
        "node 1 at (0, 0)",
        "node 9 at (4, 0)",
    ] {
        assert!(error.message().contains(text), "{error}");
    }
    let mut joined = two(&["a", "b"], [0, 1, 0]);
    joined.push_element(Shape::Quad4, 1, &[1, 4, 7, 2]);
    joined.push_element(Shape::Quad4, 1, &[5, 8, 11, 6]);
    validate(&joined).unwrap();
}

/// A surface that contains the edge between two elements from both sides.
#[test]
fn a_surface_that_looks_both_ways_is_named() {
    refused(
        |m| {
            let inside = [(0, 1), (1, 3)].map(|(element, local)| Facet { element, local });
            m.surfaces.entry("inside".into()).or_default().facets = inside.to_vec();
        },
        &["surface `inside` contains both sides of the face between elements 1 and 2"],
    );
}
