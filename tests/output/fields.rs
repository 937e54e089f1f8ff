//! The field files, read back bit by bit by a reader of our own.

use super::{fixture, vtu};
use crate::support::{load, run_with_model};
use brinell::linalg::Backend;
use brinell::output::{RunHeader, read, write, write_without_report};
use brinell::results::{Ranks, Results, State};
use std::fs;

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// `n x 2` as `n x 3`.
fn in_space(values: &[f64]) -> Vec<u64> {
    values
        .chunks(2)
        .flat_map(|v| [v[0].to_bits(), v[1].to_bits(), 0])
        .collect()
}

#[test]
fn grid_and_fields_read_back_bit_exactly() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let mut results = fixture::results(&mesh);
    // Whatever the solver computed is in the file, as it was.
    let fields = results.states[0].fields.as_mut().unwrap();
    fields.displacement[0] = f64::NAN;
    fields.displacement[1] = -0.0;
    fields.stress[2] = f64::MIN_POSITIVE / 2.0;
    write(&dir, &fixture::header(), &mesh, &results).unwrap();

    for (state, file) in [(0, "state_01_b___1.5_b_.vtu"), (2, "state_03_released.vtu")] {
        let grid = vtu::read(&dir.join(file));
        let fields = results.states[state].fields.as_ref().unwrap();
        assert_eq!((grid.n_points, grid.n_cells), (15, 4));
        assert_eq!(
            grid.arrays.keys().collect::<Vec<_>>(),
            [
                "CellData/body",
                "CellData/discretisation_error",
                "CellData/equivalent_plastic_strain",
                "CellData/stress",
                "CellData/von_mises",
                "CellData/yielded",
                "Cells/connectivity",
                "Cells/offsets",
                "Cells/types",
                "PointData/contact_pressure",
                "PointData/displacement",
                "PointData/gap",
                "PointData/nodal_stress",
                "Points/points"
            ]
        );
        let doubles = |path: &str| bits(&grid.array(path).f64s());
        assert_eq!(doubles("Points/points"), in_space(&mesh.coordinates));
        let displacement = in_space(&fields.displacement);
        assert_eq!(doubles("PointData/displacement"), displacement);
        assert_eq!(
            doubles("PointData/contact_pressure"),
            bits(&fields.contact_pressure)
        );
        assert_eq!(doubles("PointData/gap"), bits(&fields.gap));
        assert_eq!(doubles("CellData/stress"), bits(&fields.stress));
        assert_eq!(
            doubles("PointData/nodal_stress"),
            bits(&fields.nodal_stress)
        );
        assert_eq!(doubles("CellData/von_mises"), bits(&fields.von_mises));
        let plastic = bits(&fields.plastic_strain);
        assert_eq!(doubles("CellData/equivalent_plastic_strain"), plastic);
        assert_eq!(grid.array("CellData/yielded").u8s(), fields.yielded);
        assert_eq!(
            doubles("CellData/discretisation_error"),
            bits(&fields.error)
        );
        assert_eq!(grid.array("CellData/body").i32s(), [0, 0, 1, 1]);

        assert_eq!(
            grid.array("Cells/connectivity").i64s(),
            [
                0, 1, 2, 1, 3, 4, 2, 3, 5, 6, 4, 7, 8, 9, 10, 5, 11, 6, 12, 13, 14
            ]
        );
        assert_eq!(grid.array("Cells/offsets").i64s(), [3, 7, 15, 21]);
        assert_eq!(grid.array("Cells/types").u8s(), [5, 9, 23, 22]);

        assert_eq!(grid.array("Points/points").components, 3);
        assert_eq!(grid.array("PointData/displacement").components, 3);
        assert_eq!(grid.array("CellData/von_mises").components, 1);
        let stress = grid.array("CellData/stress");
        assert_eq!(stress.components, 4);
        assert_eq!(stress.component_names, ["xx", "yy", "zz", "xy"]);
    }
}

#[test]
fn axisymmetric_stress_is_named_in_cylindrical_axes() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let header = RunHeader {
        kind: "axisymmetric".into(),
        ..fixture::header()
    };
    write(&dir, &header, &mesh, &fixture::results(&mesh)).unwrap();
    let grid = vtu::read(&dir.join("state_03_released.vtu"));
    let names = &grid.array("CellData/stress").component_names;
    assert_eq!(names, &["rr", "zz", "tt", "rz"]);
}

/// More items than are encoded in one go, and not a multiple of them.
#[test]
fn long_arrays_read_back_bit_exactly() {
    let n = 10_007;
    let mut mesh = brinell::mesh::Mesh {
        dimension: 2,
        coordinates: (0..2 * n).map(|i| (i as f64).sqrt()).collect(),
        ..Default::default()
    };
    for i in 0..n as u32 - 2 {
        mesh.push_element(brinell::mesh::Shape::Tri3, 0, &[i, i + 1, i + 2]);
    }
    let fields = fixture::fields(&mesh, 0.0);
    let results = Results {
        states: vec![State {
            fields: Some(fields.clone()),
            ..State::default()
        }],
        ..Results::default()
    };
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    write(&dir, &fixture::header(), &mesh, &results).unwrap();
    let grid = vtu::read(&dir.join("state_01.vtu"));
    let doubles = |path: &str| bits(&grid.array(path).f64s());
    assert_eq!(doubles("Points/points"), in_space(&mesh.coordinates));
    let displacement = in_space(&fields.displacement);
    assert_eq!(doubles("PointData/displacement"), displacement);
    assert_eq!(doubles("CellData/stress"), bits(&fields.stress));
    let connectivity: Vec<i64> = mesh.connectivity.iter().map(|&i| i.into()).collect();
    assert_eq!(grid.array("Cells/connectivity").i64s(), connectivity);
    assert_eq!(grid.array("Cells/types").u8s(), vec![5; n - 2]);
}

#[test]
fn collection_lists_the_states_with_fields() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    write(&dir, &fixture::header(), &mesh, &fixture::results(&mesh)).unwrap();
    let text = std::fs::read_to_string(dir.join("fields.pvd")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    assert_eq!(
        document.root_element().attribute("type"),
        Some("Collection")
    );
    let listed: Vec<_> = document
        .descendants()
        .filter(|n| n.has_tag_name("DataSet"))
        .map(|n| {
            let file = n.attribute("file").unwrap();
            assert!(dir.join(file).is_file(), "{file} is not there");
            (n.attribute("timestep").unwrap(), file)
        })
        .collect();
    let [(first, name), (last, released)] = listed[..] else {
        panic!("{listed:?}");
    };
    assert_eq!(
        [name, released],
        ["state_01_b___1.5_b_.vtu", "state_03_released.vtu"]
    );
    // All states of the fixture have one load factor.
    let [first, last] = [first, last].map(|time| time.parse::<f64>().unwrap());
    assert!(first == 2.0635 && last > first && last < first + 1e-12);
}

/// A run on several ranks has its fields in pieces: parts of the mesh that make up the whole, each
/// with the values of the whole, and a file that names them.
#[test]
fn pieces_make_up_the_whole() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let results = fixture::results_of_ranks(&mesh, 8);
    write(&dir, &fixture::header(), &mesh, &results).unwrap();
    let fields = results.states[2].fields.as_ref().unwrap();

    let text = fs::read_to_string(dir.join("state_03_released.pvtu")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let declared = |section: &str| -> Vec<String> {
        let section = document.descendants().find(|n| n.has_tag_name(section));
        let arrays = section.unwrap().children();
        let names = arrays.filter_map(|n| n.attribute("Name"));
        names.map(str::to_string).collect()
    };
    let pieces = document.descendants().filter(|n| n.has_tag_name("Piece"));
    let pieces: Vec<&str> = pieces.filter_map(|n| n.attribute("Source")).collect();
    assert!(pieces.len() > 1);
    for (number, name) in (1..).zip(&pieces) {
        assert_eq!(*name, format!("state_03_released_part_{number}.vtu"));
    }
    let (mut nodes, mut elements) = (vec![0; mesh.n_nodes()], vec![0; mesh.n_elements()]);
    for piece in pieces {
        let grid = vtu::read(&dir.join(piece));
        for (section, parallel) in [("PointData/", "PPointData"), ("CellData/", "PCellData")] {
            let mut names = declared(parallel);
            names.sort();
            let here = grid
                .arrays
                .keys()
                .filter_map(|name| name.strip_prefix(section));
            assert_eq!(here.collect::<Vec<_>>(), names);
        }
        let ids = |path: &str| -> Vec<usize> {
            let ids = grid.array(path).i64s().into_iter();
            ids.map(|id| id as usize).collect()
        };
        let own_nodes = ids("PointData/GlobalNodeIds");
        let own_elements = ids("CellData/GlobalElementIds");
        assert_eq!(
            [grid.n_points, grid.n_cells],
            [own_nodes.len(), own_elements.len()]
        );
        let doubles = |path: &str| grid.array(path).f64s();
        let (points, moved) = (doubles("Points/points"), doubles("PointData/displacement"));
        for (i, &node) in own_nodes.iter().enumerate() {
            nodes[node] += 1;
            assert_eq!(points[3 * i..][..2], mesh.in_plane(node));
            assert_eq!(moved[3 * i..][..2], fields.displacement[2 * node..][..2]);
        }
        let stress = grid.array("CellData/stress").f64s();
        let (connectivity, ends) = (ids("Cells/connectivity"), ids("Cells/offsets"));
        for (i, &element) in own_elements.iter().enumerate() {
            elements[element] += 1;
            assert_eq!(stress[4 * i..][..4], fields.stress[4 * element..][..4]);
            let first = if i == 0 { 0 } else { ends[i - 1] };
            let around = connectivity[first..ends[i]]
                .iter()
                .map(|&n| own_nodes[n] as u32);
            assert_eq!(around.collect::<Vec<_>>(), mesh.nodes(element));
        }
    }
    assert_eq!(elements, vec![1; mesh.n_elements()]);
    assert!(nodes.iter().all(|n| *n > 0));
}

/// A directory with pieces is read back like any other, to the bit.
#[test]
fn pieces_are_read_back() {
    for (scene, count) in [
        ("contact_patch", 3),
        ("blocks_tet10", 2),
        ("thick_sphere", 5),
    ] {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        let results = run_on_ranks(scene, count, &dir);
        let again = read(&dir).unwrap().results;
        let mut n = 0;
        for (found, state) in again.states.iter().zip(&results.states) {
            let Some(state) = &state.fields else { continue };
            let found = found.fields.as_ref().unwrap();
            for (found, state) in [
                (&found.displacement, &state.displacement),
                (&found.stress, &state.stress),
                (&found.von_mises, &state.von_mises),
                (&found.plastic_strain, &state.plastic_strain),
                (&found.error, &state.error),
                (&found.nodal_stress, &state.nodal_stress),
                (&found.contact_pressure, &state.contact_pressure),
                (&found.gap, &state.gap),
            ] {
                assert_eq!(bits(found), bits(state));
            }
            assert_eq!(found.yielded, state.yielded);
            n += 1;
        }
        assert!(n > 0, "{scene}");
    }
}

/// A piece that is absent, damaged or in the place of another is told by its name.
#[test]
fn pieces_that_do_not_make_up_the_whole_are_refused() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    run_on_ranks("contact_patch", 2, &dir);
    let of = |end: &str| {
        let names = fs::read_dir(&dir)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        let mut names = names.filter(|path| path.to_string_lossy().ends_with(end));
        names.next().unwrap()
    };
    let [first, second, all] = ["_part_1.vtu", "_part_2.vtu", ".pvtu"].map(of);
    let [own, named] = [&second, &all].map(|path| fs::read(path).unwrap());
    let told = || read(&dir).unwrap_err().to_string();
    let name = |path: &std::path::Path| path.file_name().unwrap().to_string_lossy().into_owned();

    fs::copy(&first, &second).unwrap();
    assert!(told().contains("no piece has a value of"), "{}", told());
    fs::write(&second, &own[..own.len() / 2]).unwrap();
    assert!(told().contains(&name(&second)), "{}", told());
    fs::remove_file(&second).unwrap();
    assert!(told().contains(&name(&second)), "{}", told());
    fs::write(&second, &own).unwrap();
    assert!(read(&dir).is_ok());
    fs::write(&all, &named[..named.len() / 4]).unwrap();
    assert!(told().contains(&name(&all)), "{}", told());
}

/// Runs a scene here and writes it as a run on so many ranks would.
fn run_on_ranks(scene: &str, count: usize, dir: &std::path::Path) -> Results {
    let (model, mut results) = run_with_model(&load(scene, &[]));
    results.ranks = Some(Ranks {
        count,
        ..Ranks::default()
    });
    let header = RunHeader::new(&model, Backend::default(), 0.0);
    write_without_report(dir, &header, &model, &results).unwrap();
    results
}
