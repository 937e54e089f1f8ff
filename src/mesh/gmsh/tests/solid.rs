//! Tests of solid meshes, with volumes.

use super::*;
use crate::mesh::Facet;

/// One element of a shape with nodes near its reference positions, mid-side nodes halfway between
/// corners, and all its facets in one surface.
fn one(shape: Shape) -> Mesh {
    let row = shape.reference();
    let corner = |k: usize| {
        let [x, y, z] = row.nodes[k];
        [x + 0.1 * y, y, z + 0.05 * x * y]
    };
    let mut coordinates: Vec<f64> = (0..row.n_corners).flat_map(corner).collect();
    for &[a, b] in row.edges.iter().take(row.nodes.len() - row.n_corners) {
        let (a, b) = (corner(a), corner(b));
        coordinates.extend([0, 1, 2].map(|d| 0.5 * (a[d] + b[d])));
    }
    let mut mesh = Mesh {
        dimension: 3,
        coordinates,
        bodies: vec!["body".into()],
        ..Mesh::default()
    };
    let nodes: Vec<u32> = (0..row.nodes.len() as u32).collect();
    mesh.push_element(shape, 0, &nodes);
    let facets = (0..shape.n_facets()).map(|local| Facet { element: 0, local });
    mesh.surfaces.entry("skin".into()).or_default().facets = facets.collect();
    mesh.node_sets.insert("foot".into(), vec![0, 1]);
    mesh
}

fn written(mesh: &Mesh) -> String {
    let mut text = Vec::new();
    write(mesh, &mut text).unwrap();
    String::from_utf8(text).unwrap()
}

#[test]
fn solid_elements_come_back_as_they_were() {
    for shape in Shape::SOLID {
        let mesh = one(shape);
        let read = parsed(&written(&mesh));
        validate(&read).unwrap();
        assert_eq!(read.dimension, 3);
        assert_eq!(read.coordinates, mesh.coordinates);
        assert_eq!(read.connectivity, mesh.connectivity);
        assert_eq!(read.shapes, mesh.shapes);
        assert_eq!(read.bodies, mesh.bodies);
        assert_eq!(read.node_sets, mesh.node_sets);
        assert_eq!(read.surfaces, mesh.surfaces);
    }
}

/// Gmsh puts nodes at centres of faces and elements last, unless it is told to leave them out.
#[test]
fn nodes_at_centers_are_left_out() {
    for (shape, complete, n_centers) in [(Shape::Hex20, 12, 7), (Shape::Prism15, 13, 3)] {
        let mesh = one(shape);
        let incomplete = shape.reference().gmsh;
        let line = |text: &str| {
            let is_body = |line: &&str| line.split(' ').nth(1) == Some(&incomplete.to_string());
            text.lines().find(is_body).unwrap().to_string()
        };
        let text = written(&mesh);
        let old = line(&text);
        let centers: Vec<String> = (0..n_centers).map(|k| (1 + k).to_string()).collect();
        let new = old.replacen(&format!(" {incomplete} "), &format!(" {complete} "), 1);
        let text = text.replace(&old, &format!("{new} {}", centers.join(" ")));
        let read = parsed(&text);
        assert_eq!(read.connectivity, mesh.connectivity);
        assert_eq!((read.shapes, read.surfaces), (mesh.shapes, mesh.surfaces));
        assert!(read.notes[0].contains("centres"), "{:?}", read.notes);
        // A line that ends before its last node is still refused.
        let text = text.replace(&format!(" {}", centers.join(" ")), "");
        assert!(parse(text.as_bytes(), "solid.msh").is_err());
    }
}

/// The two corners of the edge of each mid-side node in the file, as numbered in the manual of Gmsh
/// ("Node ordering").
#[test]
fn middle_nodes_stand_where_the_manual_puts_them() {
    const TETRAHEDRON: &[[usize; 2]] = &[[0, 1], [1, 2], [0, 2], [0, 3], [2, 3], [1, 3]];
    const HEXAHEDRON: &[[usize; 2]] = &[
        [0, 1],
        [0, 3],
        [0, 4],
        [1, 2],
        [1, 5],
        [2, 3],
        [2, 6],
        [3, 7],
        [4, 5],
        [4, 7],
        [5, 6],
        [6, 7],
    ];
    const PRISM: &[[usize; 2]] = &[
        [0, 1],
        [0, 2],
        [0, 3],
        [1, 2],
        [1, 4],
        [2, 5],
        [3, 4],
        [3, 5],
        [4, 5],
    ];
    for (shape, number, edges) in [
        (Shape::Prism15, 18, PRISM),
        (Shape::Tet10, 11, TETRAHEDRON),
        (Shape::Hex20, 17, HEXAHEDRON),
    ] {
        let mesh = one(shape);
        let text = written(&mesh);
        let start = format!("1 {number} 2 1 1 ");
        let line = text.lines().find_map(|line| line.strip_prefix(&start));
        let nodes: Vec<usize> = (line.unwrap().split(' '))
            .map(|number| number.parse::<usize>().unwrap() - 1)
            .collect();
        let middles = &nodes[shape.n_corners()..];
        for (&middle, &[a, b]) in middles.iter().zip(edges) {
            let [x, a, b] = [middle, nodes[a], nodes[b]].map(|node| mesh.point(node));
            for d in 0..3 {
                assert!((x[d] - 0.5 * (a[d] + b[d])).abs() < 1e-15, "{shape:?}");
            }
        }
    }
}

/// Faces without a group, and lines and points in addition to volumes, do not become bodies. A face
/// of no element and a volume in no group are reported.
#[test]
fn what_a_solid_mesh_must_say() {
    let text = written(&one(Shape::Tet4));
    let with = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}: {text}");
        text.replacen(from, to, 1)
    };
    // A face that Gmsh saved although it is in no group.
    let face = with("$EndElements", "9 2 2 0 7 1 2 3\n$EndElements");
    let more = face.replacen("$Elements\n7", "$Elements\n8", 1);
    assert_eq!(parsed(&more).surfaces, parsed(&text).surfaces);
    let line = with("$EndElements", "9 1 2 5 7 2 4\n$EndElements");
    let line = line.replacen("$Elements\n7", "$Elements\n8", 1);
    assert_eq!(parsed(&line).node_sets["5"], [1, 3]);
    let refused = |text: String, words: &[&str]| {
        let message = parse(text.as_bytes(), "bad.msh").unwrap_err().to_string();
        assert!(words.iter().all(|w| message.contains(w)), "{message}");
    };
    refused(
        with("1 4 2 1 1 ", "1 4 2 0 1 "),
        &["element 1 is in no physical volume"],
    );
    // Another volume in no group is left out, with a note.
    let more = with("$EndElements", "9 4 2 0 7 1 2 3 5\n$EndElements");
    let more = more.replacen("$EndNodes", "5 9 9 9\n$EndNodes", 1);
    let more = more.replacen("$Nodes\n4", "$Nodes\n5", 1);
    let more = parsed(&more.replacen("$Elements\n7", "$Elements\n8", 1));
    assert_eq!((more.n_elements(), more.n_nodes()), (1, 4));
    let told = &more.notes[0];
    assert!(told.contains("in no physical volume are left out, 1 of them, such as element 9"));
    let stray = with("$EndNodes", "5 9 9 9\n$EndNodes");
    let stray = stray.replacen("$Nodes\n4", "$Nodes\n5", 1);
    let stray = stray.replacen("$EndElements", "9 2 2 1 1 1 2 5\n$EndElements", 1);
    let stray = stray.replacen("$Elements\n7", "$Elements\n8", 1);
    refused(
        stray,
        &[
            "the face with the nodes 1, 2, 5",
            "`skin`",
            "Physical Volume",
        ],
    );
    refused(
        with("1 4 2 1 1 ", "1 7 2 1 1 "),
        &["5-node pyramid", "10-node tetrahedra"],
    );
}
