//! The field files, read by the libraries that users read them with.

use crate::output::fixture;
use crate::support::program::stderr;
use brinell::output::write;
use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// Prints each array as the hexadecimal digits of its little-endian bytes.
const MESHIO: &str = r#"
import sys, numpy, meshio
def show(name, values, kind):
    print(name, numpy.ascontiguousarray(values, dtype=kind).tobytes().hex())
mesh = meshio.read(sys.argv[1])
show("points", mesh.points, "<f8")
for block in mesh.cells:
    show(block.type, block.data, "<i8")
show("displacement", mesh.point_data["displacement"], "<f8")
for name in ("stress", "von_mises", "equivalent_plastic_strain"):
    show(name, numpy.concatenate(mesh.cell_data[name]), "<f8")
show("yielded", numpy.concatenate(mesh.cell_data["yielded"]), "u1")
show("body", numpy.concatenate(mesh.cell_data["body"]), "<i4")
"#;

/// What VTK reads of a file, by the reader that its ending asks for, without an error or a warning.
const GRID: &str = r#"
import sys, numpy, vtk
from vtk.util.numpy_support import vtk_to_numpy
failures = []
in_pieces = sys.argv[1].endswith(".pvtu")
reader = vtk.vtkXMLPUnstructuredGridReader() if in_pieces else vtk.vtkXMLUnstructuredGridReader()
reader.AddObserver("ErrorEvent", lambda *_: failures.append("error"))
reader.AddObserver("WarningEvent", lambda *_: failures.append("warning"))
reader.SetFileName(sys.argv[1])
reader.Update()
assert not failures, failures
grid = reader.GetOutput()
"#;

const VTK: &str = r#"
def show(name, values, kind):
    print(name, numpy.ascontiguousarray(values, dtype=kind).tobytes().hex())
show("points", vtk_to_numpy(grid.GetPoints().GetData()), "<f8")
names = {5: "triangle", 22: "triangle6", 9: "quad", 23: "quad8"}
for i in range(grid.GetNumberOfCells()):
    cell = grid.GetCell(i)
    show(names[cell.GetCellType()],
    [cell.GetPointId(j) for j in range(cell.GetNumberOfPoints())], "<i8")
show("displacement", vtk_to_numpy(grid.GetPointData().GetArray("displacement")), "<f8")
data = grid.GetCellData()
for name in ("stress", "von_mises", "equivalent_plastic_strain"):
    show(name, vtk_to_numpy(data.GetArray(name)), "<f8")
show("yielded", vtk_to_numpy(data.GetArray("yielded")), "u1")
show("body", vtk_to_numpy(data.GetArray("body")), "<i4")
stress = data.GetArray("stress")
assert [stress.GetComponentName(i) for i in range(4)] == ["xx", "yy", "zz", "xy"]
"#;

/// The pieces of a state, as ParaView's servers read them.
const PIECES: &str = r#"
ids = vtk_to_numpy(grid.GetPointData().GetGlobalIds())
moved = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
print(sorted(set(ids.tolist())))
for i in sorted(range(len(ids)), key=lambda i: ids[i]):
    print(ids[i], *(float(x) for x in moved[i]))
print(vtk_to_numpy(grid.GetCellData().GetGlobalIds()).tolist())
"#;

#[test]
fn vtk_reads_the_pieces_of_a_state() {
    let python = crate::support::interpreter::with(&["numpy", "vtk"]);
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let results = fixture::results_of_ranks(&mesh, 8);
    write(&dir, &fixture::header(), &mesh, &results).unwrap();
    let file = dir.join("state_03_released.pvtu");
    let read = printed_by(python.as_os_str(), &[GRID, PIECES].concat(), &file);
    let mut lines = read.lines();
    let nodes: Vec<usize> = (0..mesh.n_nodes()).collect();
    assert_eq!(lines.next(), Some(format!("{nodes:?}").as_str()));
    let moved = &results.states[2].fields.as_ref().unwrap().displacement;
    let (points, cells): (Vec<&str>, Vec<&str>) = lines.partition(|line| !line.starts_with('['));
    for point in points {
        let values: Vec<f64> = point.split(' ').map(|x| x.parse().unwrap()).collect();
        let node = values[0] as usize;
        assert_eq!(values[1..], [moved[2 * node], moved[2 * node + 1], 0.0]);
    }
    let cells = cells[0].trim_matches(['[', ']']).split(", ");
    let mut cells: Vec<usize> = cells.map(|id| id.parse().unwrap()).collect();
    cells.sort_unstable();
    assert_eq!(cells, (0..mesh.n_elements()).collect::<Vec<_>>());
}

#[test]
fn meshio_reads_the_fields() {
    reads_the_fields("meshio", MESHIO);
}

#[test]
fn vtk_reads_the_fields() {
    reads_the_fields("vtk", &[GRID, VTK].concat());
}

fn reads_the_fields(library: &str, script: &str) {
    let python = crate::support::interpreter::with(&["numpy", library]);
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let results = fixture::results(&mesh);
    write(&dir, &fixture::header(), &mesh, &results).unwrap();
    let fields = results.states[2].fields.as_ref().unwrap();

    let nodes = |element: usize| {
        let nodes = mesh.nodes(element).iter();
        nodes.flat_map(|&n| u64::from(n).to_le_bytes()).collect()
    };
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let in_space = |values: &[f64]| {
        let points = values.chunks(2).map(|v| [v[0], v[1], 0.0]);
        points.flatten().flat_map(f64::to_le_bytes).collect()
    };
    let expected: [(&str, Vec<u8>); 11] = [
        ("points", in_space(&mesh.coordinates)),
        ("triangle", nodes(0)),
        ("quad", nodes(1)),
        ("quad8", nodes(2)),
        ("triangle6", nodes(3)),
        ("displacement", in_space(&fields.displacement)),
        ("stress", doubles(&fields.stress)),
        ("von_mises", doubles(&fields.von_mises)),
        ("equivalent_plastic_strain", doubles(&fields.plastic_strain)),
        ("yielded", fields.yielded.clone()),
        (
            "body",
            [0i32, 0, 1, 1]
                .iter()
                .flat_map(|b| b.to_le_bytes())
                .collect(),
        ),
    ];
    let expected: String = expected
        .iter()
        .map(|(name, bytes)| format!("{name} {}\n", hexadecimal(bytes)))
        .collect();
    let read = printed_by(
        python.as_os_str(),
        script,
        &dir.join("state_03_released.vtu"),
    );
    assert_eq!(read, expected);
}

fn printed_by(python: &OsStr, script: &str, file: &Path) -> String {
    let output = Command::new(python)
        .args(["-c", script])
        .arg(file)
        .output()
        .unwrap();
    let errors = stderr(&output);
    assert!(output.status.success(), "{errors}");
    String::from_utf8(output.stdout).unwrap().replace('\r', "")
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
