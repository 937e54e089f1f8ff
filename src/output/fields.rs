//! Fields on the mesh for ParaView, meshio and pyvista: one `.vtu` file per state, and
//! `fields.pvd`, which joins them to a time series. The time of a state is the load factor while
//! the load factor grows; where the load factor falls, the time increases by the same amount,
//! because readers sort states by time.
//!
//! In a run on several ranks a state is a `.pvtu` file with a `.vtu` file for the part of space of
//! each rank, so that programs that display it can share the work too.
//!
//! | array | on | type | components |
//! |---|---|---|---|
//! | `displacement` | points | Float64 | x, y, 0; of a solid x, y, z |
//! | `contact_pressure` | points | Float64 | 1, zero where there is no pair |
//! | `gap` | points | Float64 | 1, NaN where there is no pair |
//! | `nodal_stress` | points | Float64 | recovered, components as of `stress` |
//! | `stress` | cells | Float64 | xx, yy, zz, xy; axisymmetric: rr, zz, tt, rz; of a solid the tensor row by row, 9 |
//! | `von_mises` | cells | Float64 | 1 |
//! | `equivalent_plastic_strain` | cells | Float64 | 1 |
//! | `yielded` | cells | UInt8 | 1 |
//! | `discretisation_error` | cells | Float64 | 1, see [`Fields::error`] |
//! | `body` | cells | Int32 | 1 |

use super::RunHeader;
use super::atomic::Staging;
use super::names::COLLECTION_FILE;
use super::vtu::{self, ArrayValues, DataArray, UnstructuredGrid};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::results::{Fields, Results, State};
use crate::space::Space;
use rayon::prelude::*;
use std::path::Path;

/// Beginning of the name of a state's file.
const FILE_PREFIX: &str = "state_";
/// End of the name of a file with a mesh.
const FILE_SUFFIX: &str = ".vtu";
/// End of the name of a state's file whose mesh is in pieces.
const PIECES_SUFFIX: &str = ".pvtu";
/// Largest number of characters of a state's name in its file name.
const NAME_LENGTH: usize = 60;

/// Writes the fields of all states that have them, several files at a time.
///
/// # Errors
/// `Internal` if fields do not fit the mesh, `Io` naming the file.
pub(super) fn write(
    staging: &Staging,
    header: &RunHeader,
    mesh: &Mesh,
    results: &Results,
) -> Result<()> {
    let states = &results.states;
    let (times, parts) = (times(states), MeshPart::all(mesh, n_pieces(results)));
    let file = |(i, state): (usize, &State)| -> Result<Option<(f64, String)>> {
        let Some(fields) = &state.fields else {
            return Ok(None);
        };
        check(mesh, fields).map_err(|e| e.within(format!("state `{}`", state.name)))?;
        let name = file_name(i, results);
        if parts.is_empty() {
            let grid = grid(header, mesh, fields);
            staging.file(&name, |out| vtu::write(out, &grid))?;
        } else {
            write_pieces(staging, header, (mesh, &parts, fields), &name)?;
        }
        Ok(Some((times[i], name)))
    };
    let files: Vec<Result<Option<(f64, String)>>> =
        states.par_iter().enumerate().map(file).collect();
    let mut series = Vec::new();
    for file in files {
        series.extend(file?);
    }
    if series.is_empty() {
        return Ok(());
    }
    staging.file(COLLECTION_FILE, |out| vtu::write_collection(out, &series))
}

/// Writes a state in pieces, and the file `name`, which lists the pieces.
fn write_pieces(
    staging: &Staging,
    header: &RunHeader,
    (mesh, parts, fields): (&Mesh, &[MeshPart], &Fields),
    name: &str,
) -> Result<()> {
    let stem = name.strip_suffix(PIECES_SUFFIX).unwrap_or(name);
    let files: Vec<String> = (1..=parts.len())
        .map(|number| format!("{stem}_part_{number}{FILE_SUFFIX}"))
        .collect();
    let piece = |(part, file): (&MeshPart, &String)| -> Result<()> {
        let fields = part.of(fields);
        let grid = grid(header, &part.mesh, &fields);
        let grid = with_ids(grid, &part.nodes, &part.elements);
        staging.file(file, |out| vtu::write(out, &grid))
    };
    let pieces = parts.par_iter().zip(&files).map(piece);
    pieces.collect::<Result<()>>()?;
    let arrays = with_ids(grid(header, mesh, fields), &[], &[]);
    staging.file(name, |out| vtu::write_pieces(out, &arrays, &files))
}

/// Adds to the grid of a part the numbers of its nodes and elements in the whole mesh.
fn with_ids<'a>(
    mut grid: UnstructuredGrid<'a>,
    nodes: &'a [u32],
    elements: &'a [u32],
) -> UnstructuredGrid<'a> {
    let ids = |name, ids| DataArray::new(name, ArrayValues::Int64(ids));
    grid.point_data.push(ids(vtu::NODE_IDS, nodes));
    grid.cell_data.push(ids(vtu::ELEMENT_IDS, elements));
    grid
}

/// A part of the mesh that goes into a file of its own.
struct MeshPart {
    mesh: Mesh,
    /// Numbers of the nodes of the part in the whole mesh; `elements` likewise.
    nodes: Vec<u32>,
    elements: Vec<u32>,
}

impl MeshPart {
    /// Returns the parts of a mesh that is written in `n` pieces; none if `n` is one.
    fn all(mesh: &Mesh, n: usize) -> Vec<MeshPart> {
        if n < 2 {
            return Vec::new();
        }
        let parts = mesh.elements_among(n.min(mesh.n_elements())).into_iter();
        let part = |elements: Vec<usize>| {
            let (part, nodes) = mesh.part(&elements);
            MeshPart {
                mesh: part,
                nodes,
                elements: elements.iter().map(|&e| e as u32).collect(),
            }
        };
        let some = parts.filter(|elements| !elements.is_empty());
        some.map(part).collect()
    }

    /// Returns the values of the part, taken from fields on the whole mesh.
    fn of(&self, whole: &Fields) -> Fields {
        let (dimension, components) = (self.mesh.dimension, 2 * self.mesh.dimension);
        Fields {
            displacement: some(&whole.displacement, &self.nodes, dimension),
            stress: some(&whole.stress, &self.elements, components),
            von_mises: some(&whole.von_mises, &self.elements, 1),
            plastic_strain: some(&whole.plastic_strain, &self.elements, 1),
            yielded: some(&whole.yielded, &self.elements, 1),
            error: some(&whole.error, &self.elements, 1),
            nodal_stress: match whole.nodal_stress.is_empty() {
                true => Vec::new(),
                false => some(&whole.nodal_stress, &self.nodes, components),
            },
            contact_pressure: some(&whole.contact_pressure, &self.nodes, 1),
            gap: some(&whole.gap, &self.nodes, 1),
            force: Vec::new(),
            points: None,
        }
    }
}

/// Returns some of the items of an array, each of `size` values.
fn some<T: Copy>(all: &[T], items: &[u32], size: usize) -> Vec<T> {
    let each = items
        .iter()
        .flat_map(|&i| &all[size * i as usize..][..size]);
    each.copied().collect()
}

/// Whether a file of this name holds a state or a piece of a state.
pub(super) fn is_file(name: &str) -> bool {
    let suffixes = [FILE_SUFFIX, PIECES_SUFFIX];
    name.starts_with(FILE_PREFIX) && suffixes.iter().any(|suffix| name.ends_with(suffix))
}

/// Whether a file only lists the pieces of a state.
pub(super) fn is_in_pieces(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    name.is_some_and(|name| name.ends_with(PIECES_SUFFIX))
}

/// The number of pieces in which a state of these results is written: one for each rank.
fn n_pieces(results: &Results) -> usize {
    results.ranks.as_ref().map_or(1, |ranks| ranks.count.max(1))
}

/// The times of the states: the changes of the load factor up to each state, added up. A later
/// state at the same load factor gets the next larger number as its time.
fn times(states: &[State]) -> Vec<f64> {
    let (mut time, mut alpha) = (0.0f64, 0.0);
    let each = states.iter().enumerate().map(|(i, state)| {
        let next = time + (state.alpha - alpha).abs();
        time = if i > 0 && next <= time {
            time.next_up()
        } else {
            next
        };
        alpha = state.alpha;
        time
    });
    each.collect()
}

/// Returns the name of the file of the state `index`: `state_01_NAME.vtu`, or `.pvtu` if it is in
/// pieces. The number keeps names distinct and in order, whatever remains of the state's name, of
/// which only ASCII letters, digits, `.`, `-` and `_` are safe everywhere.
pub(super) fn file_name(index: usize, results: &Results) -> String {
    let mut name = stem(index, results.states.len(), &results.states[index].name);
    name.push_str(match n_pieces(results) {
        1 => FILE_SUFFIX,
        _ => PIECES_SUFFIX,
    });
    name
}

fn stem(index: usize, n_states: usize, state: &str) -> String {
    let width = n_states.to_string().len().max(2);
    let mut name = format!("{FILE_PREFIX}{:0width$}", index + 1);
    if !state.is_empty() {
        name.push('_');
    }
    name.extend(state.chars().take(NAME_LENGTH).map(|c| match c {
        'a'..='z' | 'A'..='Z' | '0'..='9' | '.' | '-' | '_' => c,
        _ => '_',
    }));
    name
}

/// Returns mesh and fields as arrays of a grid.
fn grid<'a>(header: &RunHeader, mesh: &'a Mesh, fields: &'a Fields) -> UnstructuredGrid<'a> {
    // In axisymmetric models the second axis is z: calling it y would make `zz` the hoop stress.
    let space = Space::ALL
        .into_iter()
        .find(|space| space.name() == header.kind);
    let stress_names = space.unwrap_or(Space::PlaneStrain).components();
    let tensors = |name: &'static str, values: &'a [f64]| match mesh.is_solid() {
        true => DataArray::new(name, ArrayValues::Tensors(values)),
        false => DataArray::named(name, stress_names, ArrayValues::Float64(values)),
    };
    let mut point_data = vec![
        DataArray::new(
            "displacement",
            ArrayValues::vectors(mesh, &fields.displacement),
        ),
        DataArray::new(
            "contact_pressure",
            ArrayValues::Float64(&fields.contact_pressure),
        ),
        DataArray::new("gap", ArrayValues::Float64(&fields.gap)),
    ];
    if !fields.nodal_stress.is_empty() {
        point_data.push(tensors("nodal_stress", &fields.nodal_stress));
    }
    UnstructuredGrid {
        mesh,
        point_data,
        cell_data: vec![
            tensors("stress", &fields.stress),
            DataArray::new("von_mises", ArrayValues::Float64(&fields.von_mises)),
            DataArray::new(
                "equivalent_plastic_strain",
                ArrayValues::Float64(&fields.plastic_strain),
            ),
            DataArray::new("yielded", ArrayValues::UInt8(&fields.yielded)),
            DataArray::new("discretisation_error", ArrayValues::Float64(&fields.error)),
            DataArray::new("body", ArrayValues::Int32(&mesh.element_body)),
        ],
    }
}

/// Checks the length of every array: a reader would take a file with a short one for damaged.
pub(super) fn check(mesh: &Mesh, fields: &Fields) -> Result<()> {
    let (nodes, elements) = (mesh.n_nodes(), mesh.n_elements());
    let dimension = mesh.dimension;
    let lengths = [
        ("coordinates", mesh.coordinates.len(), dimension * nodes),
        ("element bodies", mesh.element_body.len(), elements),
        ("displacement", fields.displacement.len(), dimension * nodes),
        ("contact pressure", fields.contact_pressure.len(), nodes),
        ("gap", fields.gap.len(), nodes),
        ("stress", fields.stress.len(), 2 * dimension * elements),
        ("von Mises stress", fields.von_mises.len(), elements),
        ("plastic strain", fields.plastic_strain.len(), elements),
        ("yield flag", fields.yielded.len(), elements),
        ("discretisation error", fields.error.len(), elements),
    ];
    let nodal = fields.nodal_stress.len();
    let nodal = (nodal > 0).then_some(("nodal stress", nodal, 2 * dimension * nodes));
    for (what, found, expected) in lengths.into_iter().chain(nodal) {
        if found != expected {
            return Err(Error::internal(format!(
                "the {what} array has {found} values where the mesh of {nodes} nodes and \
                 {elements} elements needs {expected}"
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_load_factors_that_never_fall() {
        let states = [0.0, 1.0, 1.5, 0.5, 0.5].map(|alpha| State {
            alpha,
            ..State::default()
        });
        let times = times(&states);
        assert_eq!(times[..4], [0.0, 1.0, 1.5, 2.5]);
        assert!(times[4] > 2.5 && times[4] < 2.5 + 1e-12);
    }

    #[test]
    fn file_names_are_safe_and_ordered() {
        assert_eq!(stem(0, 3, "b = 1.5 b*"), "state_01_b___1.5_b_");
        assert_eq!(stem(1, 3, ""), "state_02");
        assert_eq!(stem(4, 120, "../up"), "state_005_.._up");
        assert_eq!(stem(0, 1, "größe/Ω"), "state_01_gr__e__");
        assert_eq!(stem(0, 1, &"x".repeat(500)).len(), 9 + 60);
    }
}
