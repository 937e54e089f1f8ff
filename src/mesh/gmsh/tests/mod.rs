//! Tests with files of both versions, round trips, and every refusal.

mod binary;
mod damage;
mod partitions;
mod refusals;
mod round_trip;
mod solid;

use super::*;
use crate::mesh::{Shape, surface, validate};

/// Version 2.2: a quadrilateral and two triangles in two bonded bodies, with one triangle
/// clockwise, a shared interface, the centre of a circle that no element uses, and widely spread
/// numbers.
pub(super) const V2: &str = r#"$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
0 1 "pole"
1 2 "soft.interface"
1 3 "bottom"
2 4 "hard body"
2 5 "soft"
$EndPhysicalNames
$Nodes
7
10 0 0 0.5
20 1 0 0.5
30 1 1.0e0 0.5
40 0 1 0.5
900000000000 2 0 0.5
60 2 1 0.5
70 -3.25 1e3 7
$EndNodes
$Elements
7
1 15 2 1 10 40
2 1 2 2 7 20 30
3 1 2 3 8 10 20
4 1 2 3 9 20 900000000000
100 3 2 4 1 10 20 30 40
101 2 2 5 2 20 900000000000 60
102 2 2 5 2 20 30 60
$EndElements
"#;

/// Version 4.1, as Gmsh writes it: second order, with an unnamed curve, a parametric node block,
/// and sections that are not needed.
pub(super) const V4: &str = r#"$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 "base"
2 1 "plate"
$EndPhysicalNames
$Entities
1 2 1 0
1 0 0 0 1 3 
5 0 0 0 1 0 0 2 7 8 2 1 -2 
6 0 0 0 1 0 0 0 0 
9 0 0 0 1 1 0 1 1 3 5 6 7 
$EndEntities
$Nodes
3 6 1 6
0 1 0 1
1
0 0 0
1 5 1 2
2
4
1 0 0 1
0.5 -0.0625 0 0.5
2 9 0 3
3
5
6
0 1 0
0.5 0.5 0
0 0.5 0
$EndNodes
$Elements
3 3 1 3
0 1 15 1
1 1 
1 5 8 1
2 1 2 4 
2 9 9 1
3 1 2 3 4 5 6 
$EndElements
$Periodic
0
$EndPeriodic
"#;

pub(super) fn parsed(text: &str) -> Mesh {
    let mesh = parse(text.as_bytes(), "test.msh").unwrap();
    validate(&mesh).unwrap();
    mesh
}

#[test]
fn version_2_bodies_surfaces_and_points() {
    let mesh = parsed(V2);
    assert_eq!(mesh.bodies, ["hard body", "soft"]);
    assert_eq!(mesh.node_labels, [10, 20, 30, 40, 900_000_000_000, 60]);
    assert_eq!(mesh.element_labels, [100, 101, 102]);
    assert_eq!(mesh.shapes, [Shape::Quad4, Shape::Tri3, Shape::Tri3]);
    assert_eq!(mesh.element_body, [0, 1, 1]);
    assert_eq!(mesh.nodes(1), [1, 4, 5]);
    assert_eq!(mesh.nodes(2), [1, 5, 2], "turned counter-clockwise");
    assert_eq!(mesh.in_plane(4), [2.0, 0.0]);
    assert_eq!(mesh.node_sets["pole"], [3]);
    assert_eq!(mesh.set_nodes("bottom").unwrap(), [0, 1, 4]);
    // The line has the hard body on its left, but the name of the surface assigns it to the soft
    // body.
    let interface = &mesh.surfaces["soft.interface"];
    assert_eq!(interface.facets.len(), 1);
    assert_eq!(mesh.element_body[interface.facets[0].element], 1);
    assert_eq!(
        surface::normals(&mesh, interface, &[1, 2]),
        [[-1.0, 0.0, 0.0]; 2]
    );
}

#[test]
fn an_edge_between_two_bodies_goes_to_the_element_on_the_left_of_the_line() {
    for (line, body) in [("20 30", 0), ("30 20", 1)] {
        let text = V2
            .replace("soft.interface", "interface")
            .replace("2 1 2 2 7 20 30", &format!("2 1 2 2 7 {line}"));
        let mesh = parsed(&text);
        let facet = mesh.surfaces["interface"].facets[0];
        assert_eq!(mesh.element_body[facet.element], body);
    }
}

#[test]
fn version_4_with_second_order_and_unnamed_groups() {
    let mesh = parsed(V4);
    assert_eq!(mesh.bodies, ["plate"]);
    assert_eq!(mesh.shapes, [Shape::Tri6]);
    let points: Vec<[f64; 2]> = mesh
        .nodes(0)
        .iter()
        .map(|&n| mesh.in_plane(n as usize))
        .collect();
    assert_eq!(
        points,
        [
            [0., 0.],
            [1., 0.],
            [0., 1.],
            [0.5, -0.0625],
            [0.5, 0.5],
            [0., 0.5]
        ]
    );
    assert_eq!(mesh.element_labels, [3]);
    assert_eq!(
        mesh.surfaces["base"], mesh.surfaces["8"],
        "one curve in two groups"
    );
    assert_eq!(mesh.surfaces["base"].facets.len(), 1);
    assert_eq!(mesh.node_sets["3"], [0]);
}

#[test]
fn groups_without_names_go_by_their_numbers() {
    let start = V2.find("$PhysicalNames").unwrap();
    let end = V2.find("$Nodes").unwrap();
    let mesh = parsed(&format!("{}{}", &V2[..start], &V2[end..]));
    assert_eq!(mesh.bodies, ["4", "5"]);
    assert_eq!(mesh.set_names(), ["1", "2", "3"]);
}

#[test]
fn line_ends_comments_and_a_missing_last_line_end_do_not_matter() {
    let plain = parsed(V2);
    let crlf = V2.replace('\n', "\r\n");
    let commented = format!(
        "$Comments\nanything $Nodes\n$EndComments\n\n{}",
        V2.trim_end()
    );
    for text in [crlf, commented, format!("\n\n{V2}\n \n")] {
        let mesh = parsed(&text);
        assert_eq!(mesh.connectivity, plain.connectivity);
        assert_eq!(mesh.coordinates, plain.coordinates);
        assert_eq!(mesh.bodies, plain.bodies);
        assert_eq!(mesh.surfaces, plain.surfaces);
    }
}

#[test]
fn bodies_of_one_name_are_one_body() {
    let mesh = parsed(&V2.replace("hard body", "soft"));
    assert_eq!(mesh.bodies, ["soft"]);
    assert_eq!(mesh.element_body, [0, 0, 0]);
}

#[test]
fn parametric_nodes_are_nodes() {
    let mut text = V2.replace("$Nodes", "$ParametricNodes");
    text = text.replace("$EndNodes", "$EndParametricNodes");
    for (node, parameters) in [
        ("10 0 0 0.5\n", "10 0 0 0.5 0 1\n"),
        ("20 1 0 0.5\n", "20 1 0 0.5 1 3 0.25\n"),
        ("30 1 1.0e0 0.5\n", "30 1 1.0e0 0.5 2 7 0.25 0.75\n"),
    ] {
        text = text.replace(node, parameters);
    }
    assert_eq!(format!("{:?}", parsed(&text)), format!("{:?}", parsed(V2)));
}

#[test]
fn a_negative_physical_tag_is_the_same_group() {
    let mesh = parsed(&V2.replace("100 3 2 4 1", "100 3 2 -4 1"));
    assert_eq!(mesh.bodies, ["hard body", "soft"]);
}

#[test]
fn clockwise_elements_of_every_shape_are_turned_round() {
    for shape in Shape::PLANE {
        let n = shape.n_corners();
        let corners = [[0., 0.], [2., 0.], [2.5, 2.], [0., 1.]];
        let mut points: Vec<[f64; 2]> = corners[..n].to_vec();
        for k in 0..n {
            let (p, q) = (corners[k], corners[(k + 1) % n]);
            points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
        }
        points.truncate(shape.n_nodes());
        // The same polygon from corner 0, in the opposite direction.
        let mut reversed: Vec<usize> = (0..n).map(|k| (n - k) % n).collect();
        if shape.is_quadratic() {
            reversed.extend((0..n).map(|k| n + (n - 1 - k)));
        }
        let given: Vec<u32> = reversed.iter().map(|&k| k as u32).collect();
        let mut mesh = Mesh {
            dimension: 2,
            coordinates: points.concat(),
            bodies: vec!["b".to_string()],
            ..Mesh::default()
        };
        mesh.push_element(shape, 0, &given);
        assert!(validate(&mesh).is_err(), "clockwise as written");
        let mut text = Vec::new();
        write(&mesh, &mut text).unwrap();
        let read = parse(&text, "test.msh").unwrap();
        validate(&read).unwrap();
        let expected: Vec<u32> = (0..shape.n_nodes() as u32).collect();
        assert_eq!(read.nodes(0), expected, "{shape:?}");
    }
}

#[test]
fn the_example_mesh_can_be_computed_with() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/meshes/two_blocks.msh");
    let mesh = read(&file).unwrap();
    validate(&mesh).unwrap();
    assert_eq!(mesh.bodies, ["lower", "upper"]);
    assert_eq!((mesh.n_nodes(), mesh.n_elements()), (30, 16));
    assert_eq!(mesh.node_sets.len(), 2);
    assert_eq!(mesh.surfaces.len(), 8);
    for (name, height) in [
        ("lower.contact", 0.0),
        ("upper.contact", 0.0),
        ("upper.top", 2.0),
        ("lower.bottom", -2.0),
    ] {
        let nodes = surface::ordered_nodes(&mesh, &mesh.surfaces[name]).unwrap();
        assert_eq!(nodes.len(), 5, "{name}");
        assert!(
            nodes.iter().all(|&n| mesh.in_plane(n)[1] == height),
            "{name}"
        );
    }
    let lower = mesh.set_nodes("lower.contact").unwrap();
    let upper = mesh.set_nodes("upper.contact").unwrap();
    assert!(lower.iter().all(|n| !upper.contains(n)));
    let corner = mesh.node_sets["upper.top_left"][0];
    assert_eq!(mesh.in_plane(corner), [0.0, 2.0]);
}

#[test]
fn a_missing_file_is_an_io_error_with_its_path() {
    let error = read(Path::new("does/not/exist.msh")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Io);
    assert!(error.message().contains("does/not/exist.msh"), "{error}");
}
