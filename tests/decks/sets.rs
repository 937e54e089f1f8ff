//! Sets, surfaces and bodies of a deck as those of its mesh.

use brinell::analysis::Analysis;
use brinell::deck::Deck;
use brinell::linalg::Backend;
use brinell::mesh::{self, Facet, inp};
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::scene::Scene;
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

/// As meshio writes solids with facets and lines: types of its own choice, sets without sections.
#[test]
fn facets_and_lines_of_meshio_are_surfaces() {
    let text = "\
*HEADING
Abaqus DataFile Version 6.14
written by meshio v5.3.5
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8RH
1,1,2,3,4,5,6,7,8
*ELEMENT, TYPE=CAX4P
2,1,4,8,5
3,2,3,7,6
*ELEMENT, TYPE=R3D3
4,1,2,3
*ELEMENT, TYPE=B31H
5,1,2
*ELSET, ELSET=BAR
1
*ELSET, ELSET=ENDS
2,3
*NSET, NSET=LEFT
1,4,8,5
";
    let mesh = inp::mesh(&Deck::parse(text.as_bytes(), "meshio.inp").unwrap()).unwrap();
    mesh::validate(&mesh).unwrap();
    assert_eq!(mesh.bodies, ["BAR"]);
    assert_eq!(mesh.n_elements(), 1);
    assert_eq!(mesh.node_sets["LEFT"], [0, 3, 4, 7]);
    let ends = &mesh.surfaces["ENDS"].facets;
    assert_eq!(ends.len(), 2);
    assert!(ends.iter().all(|facet| facet.element == 0));
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

/// Two unit blocks, one upon the other, whose sets are of both.
const BLOCKS_MSH: &str = "\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
6
0 6 \"corner\"
1 3 \"between\"
1 4 \"left\"
1 5 \"ends\"
2 1 \"low\"
2 2 \"high\"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 1 0
6 1 1 0
7 1 2 0
8 0 2 0
$EndNodes
$Elements
10
1 1 2 3 3 3 4
2 1 2 3 3 5 6
3 1 2 4 4 4 1
4 1 2 4 4 8 5
5 1 2 5 5 1 2
6 1 2 5 5 7 8
7 3 2 1 1 1 2 3 4
8 3 2 2 2 5 6 7 8
9 15 2 6 6 7
10 15 2 6 6 2
$EndElements
";

const BLOCKS_INP: &str = "\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 0., 1.
6, 1., 1.
7, 1., 2.
8, 0., 2.
*ELEMENT, TYPE=CPE4, ELSET=low
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=high
2, 5, 6, 7, 8
*NSET, NSET=left
1, 4, 5, 8
*NSET, NSET=corner
2, 7
*SURFACE, NAME=between
1, S3
2, S1
*SURFACE, NAME=ends
1, S1
2, S3
";

/// A scene on them that names the parts of each body.
fn on_blocks(file: &str) -> String {
    format!(
        r#"
kind = "plane_strain"
mesh.file = "{file}"
materials.steel = {{ youngs_modulus = 210000.0, poissons_ratio = 0.3 }}
bodies.low.material = "steel"
bodies.high.material = "steel"
contact = [{{ first = "high.between", second = "low.between" }}]
support = [
    {{ on = "low.ends", fix = ["y"] }},
    {{ on = "low.left", fix = ["x"] }},
    {{ on = "high.left", fix = ["x"] }},
]
load = [{{ on = "high.ends", pressure = 100.0 }}]
[program]
targets = [{{ displacement = {{ on = "high.corner", direction = "y", value = -1e-3 }} }}]
history = ["low.corner", "high.corner", "low.left"]
"#
    )
}

/// Both files, beside a scene on each; its text and the names in it are changed.
fn on_both(change: impl Fn(&str) -> String, see: impl Fn(&str, brinell::Result<(Model, Results)>)) {
    let folder = tempfile::tempdir().unwrap();
    for (file, text) in [("blocks.msh", BLOCKS_MSH), ("blocks.inp", BLOCKS_INP)] {
        std::fs::write(folder.path().join(file), text).unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, change(&on_blocks(file))).unwrap();
        let run = || {
            let model = Model::new(&Scene::load(&path)?)?;
            let results = Analysis::new(model.clone(), Backend::default())?.run(&mut Silent)?;
            Ok((model, results))
        };
        see(file, run());
    }
}

/// Wherever a scene names a set, `body.set` is what the set has of the body.
#[test]
fn a_scene_names_sets_of_bodies() {
    on_both(str::to_string, |file, done| {
        let (model, results) = done.unwrap();
        assert_eq!(model.pairs.len(), 2, "{file}");
        // Under plane strain both blocks shorten by p (1 - nu^2)/E together 2 of that.
        let p = 100.0 * results.states[0].alpha;
        let expected = -2.0 * p * (1.0 - 0.09) / 210_000.0;
        assert!((expected + 1e-3).abs() < 1e-12, "{file}: {expected}");
        let followed: Vec<&str> = results.history_columns.iter().map(String::as_str).collect();
        let last = &results.history.last().unwrap().measured;
        for set in ["low.corner", "high.corner", "low.left"] {
            assert!(
                followed.iter().any(|column| column.contains(set)),
                "{file}: {followed:?}"
            );
        }
        assert_eq!(last.len(), followed.len(), "{file}");
    });
}

/// A set that the body has nothing of, and one that there is not.
#[test]
fn sets_of_bodies_that_there_are_not_are_told_with_what_is_near() {
    for (name, expected) in [
        ("high.corners", "no such set, did you mean `high.corner`?"),
        ("hgh.corner", "no such set, did you mean `"),
        ("low.middle", "the mesh has no such set"),
    ] {
        let change = |text: &str| text.replace("on = \"high.corner\"", &format!("on = \"{name}\""));
        on_both(change, |file, done| {
            let error = done.err().unwrap().to_string();
            assert!(
                error.contains(name) && error.contains(expected),
                "{file}: {error}"
            );
        });
    }
    let change = |text: &str| text.replace("first = \"high.between\"", "first = \"high.corner\"");
    on_both(change, |file, done| {
        let error = done.err().unwrap().to_string();
        let expected = "contact 1 surface `high.corner`: `corner` is a set of nodes, not a surface";
        assert!(error.contains(expected), "{file}: {error}");
    });
}
