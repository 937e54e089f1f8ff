//! A model from arrays: its folder says by itself where it comes from.

use crate::output::report::content;
use brinell::ErrorKind;
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::mesh::Shape;
use brinell::model::{Model, ModelBuilder, NodePair};
use brinell::output::{RunHeader, read, write_report, write_with_report};
use brinell::progress::Silent;
use brinell::scene::{Body, Contact, Direction, History, Kind, Material, Support};

/// Two blocks from arrays, with what no scene can say: pairs with gaps and normals of their own,
/// forces node by node, names that no Gmsh file holds.
fn blocks() -> brinell::Result<Model> {
    let mut builder = ModelBuilder::new(Kind::PlaneStrain);
    let n = 4_u32;
    for (body, base) in [("lower", 0.0), ("the \"upper\" one", 1.01)] {
        let first = builder.n_nodes();
        for row in 0..=n {
            for column in 0..=n {
                let [x, y] = [column, row].map(|k| f64::from(k) / f64::from(n));
                builder.nodes(&[x, base + y])?;
            }
        }
        let across = n as usize + 1;
        for k in (0..n as usize).flat_map(|row| (0..n as usize).map(move |c| row * across + c)) {
            let corner = first + k;
            let nodes = [corner, corner + 1, corner + across + 1, corner + across];
            builder.elements(Shape::Quad4, body, &nodes)?;
        }
        let material = "steel".to_string();
        let own = Body {
            material,
            ..Body::default()
        };
        builder.body(body, own)?;
    }
    let steel = Material {
        youngs_modulus: 210e3,
        poissons_ratio: 0.3,
        yield_stress: Some(8.0),
        plastic_modulus: Some(1000.0),
        ..Material::default()
    };
    let pairs: Vec<NodePair> = (0..5)
        .map(|k| NodePair {
            first: 25 + k,
            second: 20 + k,
            normal: Some([0.0, 1.0, 0.0]),
            gap: Some(0.001),
        })
        .collect();
    let contact = Contact {
        first: "above".into(),
        second: "below".into(),
        ..Contact::default()
    };
    let hold = |on: &str, fix: Direction| Support {
        on: on.into(),
        fix: vec![fix],
        ..Support::default()
    };
    builder
        .title("Arrays")
        .material("steel", steel)?
        .surface_of_nodes("below", &[20, 21, 22, 23, 24])?
        .surface_of_nodes("above", &[25, 26, 27, 28, 29])?
        .node_set("floor", &[0, 1, 2, 3, 4])?
        .node_set("left \"side\"", &[0, 5, 10, 15, 20, 25, 30, 35, 40, 45])?
        .contact_pairs(contact, &pairs)?
        .support(hold("floor", Direction::Y))
        .support(hold("left \"side\"", Direction::X))
        .nodal_load(
            "push",
            &[45, 47, 49],
            &[[0.0, -2.0, 0.0], [0.0, -5.0, 0.0], [0.5, -2.0, 0.0]],
            History::default(),
        )?;
    builder.build()
}

/// A model from arrays has no scene file: its folder holds all that its report needs.
#[test]
fn the_folder_of_a_model_from_arrays_makes_its_report_again() {
    let temporary = tempfile::tempdir().unwrap();
    let dir = temporary.path().join("out");
    let mut analysis = Analysis::new(blocks().unwrap(), Backend::default()).unwrap();
    let results = analysis.run(&mut Silent).unwrap();
    assert!(results.states[0].plastic_points > 0 && results.states[0].max_pressure > 0.0);
    let header = RunHeader::new(analysis.model(), Backend::default(), 0.25);
    write_with_report(&dir, &header, analysis.model(), &results).unwrap();
    let before = content(&dir);
    for name in before.keys().filter(|n| n.starts_with("report")) {
        std::fs::remove_file(dir.join(name)).unwrap();
    }
    write_report(&dir).unwrap();
    let after = content(&dir);
    assert!(before.keys().eq(after.keys()), "{:?}", after.keys());
    for (name, bytes) in &before {
        assert!(after[name] == *bytes, "{name} differs");
    }
    let recorded = read(&dir).unwrap();
    assert_eq!(recorded.results.history, results.history);
    let gaps = |model: &Model| -> Vec<f64> { model.pairs.iter().map(|p| p.gap).collect() };
    assert_eq!(gaps(&recorded.model), gaps(analysis.model()));
    // Damage is refused by the name of the file.
    let good = String::from_utf8(before["model_as_run.json"].clone()).unwrap();
    for (from, to) in [
        ("\"connectivity\":[0,", "\"connectivity\":[99,"),
        ("[45,[0.0,-2.0,0.0]]", "[450,[0.0,-2.0,0.0]]"),
        ("\"first\":25", "\"first\":50"),
        ("\"youngs_modulus\":210000.0", "\"youngs_modulus\":-1.0"),
        ("\"given\"", "\"taken\""),
        ("}", ""),
    ] {
        assert!(good.contains(from), "{from}: {good}");
        std::fs::write(dir.join("model_as_run.json"), good.replacen(from, to, 1)).unwrap();
        let error = write_report(&dir).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input, "{from}: {error}");
        assert!(error.to_string().contains("model_as_run.json"), "{error}");
    }
}
