//! Fields read back from the `.vtu` and `.pvtu` files that [`super::vtu`] writes. This is not a
//! reader of VTK files in general.

use super::{fields, vtu};
use crate::error::{Error, Result};
use crate::files;
use crate::mesh::Mesh;
use crate::results::Fields;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Beginning of the binary part of a file.
const APPENDED: &[u8] = b"<AppendedData";
/// Number of bytes that hold the length of a block.
const LENGTH_BYTES: usize = 8;

/// Reads the fields of a state on a mesh, from one piece or several.
///
/// # Errors
/// `Io` if a file cannot be read, `Input` naming the file if it is damaged or belongs to another
/// mesh.
pub(super) fn read(path: &Path, mesh: &Mesh) -> Result<Fields> {
    let bytes = files::read("read", path, None)?;
    let contents = match fields::is_in_pieces(path) {
        true => pieces(path, &bytes)?,
        false => vec![(path.to_path_buf(), bytes)],
    };
    let files = contents.iter().map(|(path, bytes)| {
        let blocks = Blocks::new(bytes).map_err(|what| damaged(path, what))?;
        Ok((path.as_path(), blocks))
    });
    let state = StateFiles(files.collect::<Result<_>>()?);
    let numbers = |name: &str, items: Items, n: usize| -> Result<Vec<f64>> {
        let bytes = state.bytes(name, items, 8 * n)?;
        let (values, _) = bytes.as_chunks::<8>();
        Ok(values.iter().map(|v| f64::from_le_bytes(*v)).collect())
    };
    let tensors = |name: &str, items| -> Result<Vec<f64>> {
        let of = |s: &[f64; 9]| [s[0], s[4], s[8], s[1], s[5], s[2]];
        if mesh.is_solid() {
            let values = numbers(name, items, 9)?;
            return Ok(values.as_chunks::<9>().0.iter().flat_map(of).collect());
        }
        numbers(name, items, 4)
    };
    let nodes = (vtu::NODE_IDS, mesh.n_nodes());
    let elements = (vtu::ELEMENT_IDS, mesh.n_elements());
    let fields = Fields {
        displacement: numbers("displacement", nodes, 3)?
            .as_chunks::<3>()
            .0
            .iter()
            .flat_map(|vector| &vector[..mesh.dimension])
            .copied()
            .collect(),
        stress: tensors("stress", elements)?,
        nodal_stress: match state.has("nodal_stress") {
            true => tensors("nodal_stress", nodes)?,
            false => Vec::new(),
        },
        von_mises: numbers("von_mises", elements, 1)?,
        plastic_strain: numbers("equivalent_plastic_strain", elements, 1)?,
        yielded: state.bytes("yielded", elements, 1)?.into_owned(),
        error: numbers("discretisation_error", elements, 1)?,
        contact_pressure: numbers("contact_pressure", nodes, 1)?,
        gap: numbers("gap", nodes, 1)?,
        force: Vec::new(),
        points: None,
    };
    fields::check(mesh, &fields).map_err(|error| does_not_fit(path, error.message()))?;
    Ok(fields)
}

fn damaged(path: &Path, what: String) -> Error {
    Error::input(format!("{}: {what}", path.display()))
}

fn does_not_fit(path: &Path, why: &str) -> Error {
    damaged(path, format!("the file does not fit the mesh: {why}"))
}

/// Reads the pieces of a state that a file lists, which lie beside it; returns their paths and
/// contents.
fn pieces(path: &Path, bytes: &[u8]) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let damaged = |what: String| damaged(path, what);
    let text =
        std::str::from_utf8(bytes).map_err(|_| damaged("the file is not text".to_string()))?;
    let mut names = Vec::new();
    let each = |element: &BytesStart<'_>| {
        if element.name().as_ref() == "Piece" {
            let name = attribute(element, "Source").ok_or("a piece of the file has no name")?;
            names.push(name);
        }
        Ok(())
    };
    empty_elements(text, each).map_err(damaged)?;
    if names.is_empty() {
        return Err(damaged("the file names no piece".to_string()));
    }
    let piece = |name: String| {
        // Only a file of the same directory is read, whatever path the list gives.
        let piece = path.with_file_name(Path::new(&name).file_name().unwrap_or_default());
        let bytes = files::read("read", &piece, None)?;
        Ok((piece, bytes))
    };
    names.into_iter().map(piece).collect()
}

/// The name of the array with the numbers that a file's nodes or elements have in the whole mesh,
/// and the number of nodes or elements in the whole mesh.
type Items<'a> = (&'a str, usize);

/// The files of a state.
struct StateFiles<'a>(Vec<(&'a Path, Blocks<'a>)>);

impl<'a> StateFiles<'a> {
    fn has(&self, name: &str) -> bool {
        self.0.iter().all(|(_, blocks)| blocks.has(name))
    }

    /// Returns the bytes of an array, `size` for each item. The items of pieces are placed by their
    /// numbers in the whole mesh.
    fn bytes(&self, name: &str, (ids, n): Items, size: usize) -> Result<Cow<'a, [u8]>> {
        if let [(path, blocks)] = self.0.as_slice()
            && !blocks.has(ids)
        {
            let bytes = blocks.bytes(name).map_err(|what| damaged(path, what))?;
            return Ok(Cow::Borrowed(bytes));
        }
        let (mut whole, mut is_there) = (vec![0; size * n], vec![false; n]);
        for (path, blocks) in &self.0 {
            let array = |name| blocks.bytes(name).map_err(|what| damaged(path, what));
            let (bytes, (ids, _)) = (array(name)?, array(ids)?.as_chunks::<8>());
            if size * ids.len() != bytes.len() {
                let why = format!("`{name}` has not {} values", ids.len());
                return Err(does_not_fit(path, &why));
            }
            for (id, item) in ids.iter().zip(bytes.chunks_exact(size)) {
                let number = u64::from_le_bytes(*id);
                let id = usize::try_from(number).ok().filter(|id| *id < n);
                let Some(id) = id else {
                    let why = format!(
                        "`{name}` has a value for item {number}, but the mesh has only {n}"
                    );
                    return Err(does_not_fit(path, &why));
                };
                whole[size * id..][..size].copy_from_slice(item);
                is_there[id] = true;
            }
        }
        match is_there.iter().position(|is_there| !is_there) {
            None => Ok(Cow::Owned(whole)),
            Some(id) => {
                let why = format!("no piece has a value of `{name}` of number {id} of {n}");
                Err(does_not_fit(self.0[0].0, &why))
            }
        }
    }
}

/// Visits the empty elements of an XML text.
fn empty_elements(
    text: &str,
    mut visit: impl FnMut(&BytesStart<'_>) -> std::result::Result<(), String>,
) -> std::result::Result<(), String> {
    let mut reader = Reader::from_str(text);
    loop {
        let event = reader
            .read_event()
            .map_err(|cause| format!("the head of the file is not XML: {cause}"))?;
        match event {
            Event::Empty(element) => visit(&element)?,
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// The blocks of a file: where each begins, by the name of its array.
struct Blocks<'a> {
    appended: &'a [u8],
    offsets: BTreeMap<String, usize>,
}

impl<'a> Blocks<'a> {
    fn new(bytes: &'a [u8]) -> std::result::Result<Self, String> {
        let truncated = || "the file ends before its binary part".to_string();
        let at = bytes
            .windows(APPENDED.len())
            .position(|window| window == APPENDED)
            .ok_or_else(truncated)?;
        let mark = bytes[at..]
            .iter()
            .position(|&byte| byte == b'_')
            .ok_or_else(truncated)?;
        let head = std::str::from_utf8(&bytes[..at])
            .map_err(|_| "the head of the file is not text".to_string())?;
        let mut offsets = BTreeMap::new();
        empty_elements(head, |element| {
            if element.name().as_ref() == "DataArray" {
                let offset = attribute(element, "offset")
                    .and_then(|text| text.parse().ok())
                    .ok_or("an array of the file has no offset")?;
                if let Some(name) = attribute(element, "Name") {
                    offsets.insert(name, offset);
                }
            }
            Ok(())
        })?;
        Ok(Blocks {
            appended: &bytes[at + mark + 1..],
            offsets,
        })
    }

    fn has(&self, name: &str) -> bool {
        self.offsets.contains_key(name)
    }

    /// The bytes of an array.
    fn bytes(&self, name: &str) -> std::result::Result<&'a [u8], String> {
        let truncated = || format!("the array `{name}` is missing or cut off");
        let offset = *self.offsets.get(name).ok_or_else(truncated)?;
        let block = self.appended.get(offset..).ok_or_else(truncated)?;
        let (length, values) = block
            .split_first_chunk::<LENGTH_BYTES>()
            .ok_or_else(truncated)?;
        usize::try_from(u64::from_le_bytes(*length))
            .ok()
            .and_then(|length| values.get(..length))
            .ok_or_else(truncated)
    }
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Option<String> {
    let found = element.try_get_attribute(name).ok()??;
    Some(found.value.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;
    use crate::output::vtu::{ArrayValues, DataArray, UnstructuredGrid};

    fn mesh() -> Mesh {
        let mut mesh = Mesh {
            dimension: 2,
            coordinates: vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0],
            bodies: vec!["a".into()],
            ..Mesh::default()
        };
        mesh.push_element(Shape::Tri3, 0, &[0, 1, 2]);
        mesh
    }

    #[test]
    fn what_was_written_is_read_and_what_is_damaged_is_refused() {
        let mesh = mesh();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.vtu");
        // The first bytes of a number look like the mark of the binary part: only the offset
        // counts.
        let underscore = f64::from_le_bytes(*b"_<Append");
        let (u, one, four) = (
            [0.1, -2.0, 1e-300, 4.0, underscore, 6.0],
            [7.5],
            [1.0, 2.0, 3.0, 4.0],
        );
        let of_nodes = [0.5, f64::NAN, 1.5];
        let grid = UnstructuredGrid {
            mesh: &mesh,
            point_data: vec![
                DataArray::new("displacement", ArrayValues::Planar(&u)),
                DataArray::new("contact_pressure", ArrayValues::Float64(&of_nodes)),
                DataArray::new("gap", ArrayValues::Float64(&of_nodes)),
            ],
            cell_data: vec![
                DataArray::named(
                    "stress",
                    &["xx", "yy", "zz", "xy"],
                    ArrayValues::Float64(&four),
                ),
                DataArray::new("von_mises", ArrayValues::Float64(&one)),
                DataArray::new("equivalent_plastic_strain", ArrayValues::Float64(&one)),
                DataArray::new("yielded", ArrayValues::UInt8(&[1])),
                DataArray::new("discretisation_error", ArrayValues::Float64(&one)),
            ],
        };
        let mut bytes = Vec::new();
        vtu::write(&mut bytes, &grid).unwrap();
        std::fs::write(&path, &bytes).unwrap();
        let fields = read(&path, &mesh).unwrap();
        assert_eq!(fields.displacement, u);
        assert_eq!((fields.stress, fields.yielded), (four.to_vec(), vec![1]));
        // Everything up to the last array that is read is needed; the mesh follows behind it.
        let needed = bytes.len() - 300;
        for length in 0..bytes.len() {
            std::fs::write(&path, &bytes[..length]).unwrap();
            match read(&path, &mesh) {
                Ok(_) => assert!(length >= needed, "{length}"),
                Err(error) => assert!(error.message().contains("state.vtu"), "{error}"),
            }
        }
        std::fs::write(&path, &bytes).unwrap();
        let mut other = mesh.clone();
        other.push_element(Shape::Tri3, 0, &[0, 1, 2]);
        let error = read(&path, &other).unwrap_err();
        assert!(error.message().contains("does not fit"), "{error}");
    }
}
