//! Sets, surfaces and bodies of a deck as those of its mesh.

use brinell::deck::Deck;
use brinell::mesh::{self, Facet, inp};
use std::path::Path;

#[test]
fn sets_and_surfaces_are_those_of_the_mesh() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let deck = Deck::read(&root.join("tests/fuzz/seeds/every_keyword.inp")).unwrap();
    let mesh = inp::mesh(&deck).unwrap();
    mesh::validate(&mesh).unwrap();
    assert_eq!(mesh.bodies, ["LOW", "HIGH"]);
    // The free faces of the upper body, and the one face between the nodes of a surface of nodes.
    assert_eq!(mesh.surfaces["FREE"].facets.len(), 4);
    let under = Facet {
        element: 1,
        local: 0,
    };
    assert_eq!(mesh.surfaces["UNDER"].facets, [under]);
    assert_eq!(mesh.node_sets["SIDE"], [0, 1, 2, 3]);
    assert_eq!(mesh.node_sets["BASE"], [0, 1]);
}

/// Without sections the sets of elements are the bodies: a deck may be a mesh alone.
#[test]
fn a_deck_may_be_a_mesh_alone() {
    let text = "\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
9, 5., 5.
*ELEMENT, TYPE=CPE3, ELSET=PLATE
1, 1, 2, 3
2, 1, 3, 4
*NSET, NSET=SIDE
1, 4, 9
";
    let mesh = inp::mesh(&Deck::parse(text.as_bytes(), "mesh.inp").unwrap()).unwrap();
    mesh::validate(&mesh).unwrap();
    assert_eq!(mesh.bodies, ["PLATE"]);
    // Node 9 belongs to no element.
    assert_eq!(mesh.node_labels, [1, 2, 3, 4]);
    assert_eq!(mesh.node_sets["SIDE"], [0, 3]);
    // Nodes out of the plane are told by their line.
    let error = inp::mesh(
        &Deck::parse(
            text.replace("3, 1., 1.", "3, 1., 1., 0.5").as_bytes(),
            "m.inp",
        )
        .unwrap(),
    );
    let error = error.unwrap_err().to_string();
    assert!(
        error.starts_with("m.inp, line 4: *NODE: node 3 lies at z = 0.5"),
        "{error}"
    );
}
