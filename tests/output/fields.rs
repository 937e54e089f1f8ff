//! The field files, read back bit by bit by a reader of our own.

use crate::{fixture, vtu};
use brinell::output::{RunHeader, write};
use brinell::results::{Results, State};

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
