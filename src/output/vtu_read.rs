//! Fields read back from the `.vtu` files that [`super::vtu`] writes. Not a reader of VTK files in
//! general.

use super::fields;
use crate::error::{Error, Result};
use crate::files;
use crate::mesh::Mesh;
use crate::results::Fields;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;
use std::path::Path;

/// Beginning of the binary part.
const APPENDED: &[u8] = b"<AppendedData";
/// Bytes of a block's length.
const LENGTH_BYTES: usize = 8;

/// Reads the fields of a state on a mesh.
///
/// # Errors
/// `Io` where the file cannot be read, `Input` naming it where it is damaged or belongs to another
/// mesh.
pub(super) fn read(path: &Path, mesh: &Mesh) -> Result<Fields> {
    let bytes = files::read("read", path, None)?;
    let damaged = |what: String| Error::input(format!("{}: {what}", path.display()));
    let file = Blocks::new(&bytes).map_err(damaged)?;
    let numbers = |name: &str| file.numbers(name).map_err(damaged);
    let tensors = |name: &str| -> Result<Vec<f64>> {
        let values = numbers(name)?;
        let of = |s: &[f64; 9]| [s[0], s[4], s[8], s[1], s[5], s[2]];
        Ok(match mesh.is_solid() {
            true => values.as_chunks::<9>().0.iter().flat_map(of).collect(),
            false => values,
        })
    };
    let fields = Fields {
        displacement: numbers("displacement")?
            .as_chunks::<3>()
            .0
            .iter()
            .flat_map(|vector| &vector[..mesh.dimension])
            .copied()
            .collect(),
        stress: tensors("stress")?,
        nodal_stress: match file.has("nodal_stress") {
            true => tensors("nodal_stress")?,
            false => Vec::new(),
        },
        von_mises: numbers("von_mises")?,
        plastic_strain: numbers("equivalent_plastic_strain")?,
        yielded: file.bytes("yielded").map_err(damaged)?.to_vec(),
        error: numbers("discretisation_error")?,
        contact_pressure: numbers("contact_pressure")?,
        gap: numbers("gap")?,
        force: Vec::new(),
    };
    fields::check(mesh, &fields).map_err(|error| {
        damaged(format!(
            "the file does not fit the mesh: {}",
            error.message()
        ))
    })?;
    Ok(fields)
}

/// The blocks of a file by the name of their array: where they begin.
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
        let mut reader = Reader::from_str(head);
        loop {
            let event = reader
                .read_event()
                .map_err(|cause| format!("the head of the file is not XML: {cause}"))?;
            match event {
                Event::Empty(element) if element.name().as_ref() == "DataArray" => {
                    let offset = attribute(&element, "offset")
                        .and_then(|text| text.parse().ok())
                        .ok_or("an array of the file has no offset")?;
                    if let Some(name) = attribute(&element, "Name") {
                        offsets.insert(name, offset);
                    }
                }
                Event::Eof => break,
                _ => {}
            }
        }
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

    fn numbers(&self, name: &str) -> std::result::Result<Vec<f64>, String> {
        let (values, _) = self.bytes(name)?.as_chunks::<8>();
        Ok(values.iter().map(|v| f64::from_le_bytes(*v)).collect())
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
    use crate::output::vtu::{self, DataArray, Grid, Values};

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
        // The first bytes of a number spell the mark: only the offset counts.
        let underscore = f64::from_le_bytes(*b"_<Append");
        let (u, one, four) = (
            [0.1, -2.0, 1e-300, 4.0, underscore, 6.0],
            [7.5],
            [1.0, 2.0, 3.0, 4.0],
        );
        let of_nodes = [0.5, f64::NAN, 1.5];
        let grid = Grid {
            mesh: &mesh,
            point_data: vec![
                DataArray::new("displacement", Values::Planar(&u)),
                DataArray::new("contact_pressure", Values::Float64(&of_nodes)),
                DataArray::new("gap", Values::Float64(&of_nodes)),
            ],
            cell_data: vec![
                DataArray::named("stress", &["xx", "yy", "zz", "xy"], Values::Float64(&four)),
                DataArray::new("von_mises", Values::Float64(&one)),
                DataArray::new("equivalent_plastic_strain", Values::Float64(&one)),
                DataArray::new("yielded", Values::UInt8(&[1])),
                DataArray::new("discretisation_error", Values::Float64(&one)),
            ],
        };
        let mut bytes = Vec::new();
        vtu::write(&mut bytes, &grid).unwrap();
        std::fs::write(&path, &bytes).unwrap();
        let fields = read(&path, &mesh).unwrap();
        assert_eq!(fields.displacement, u);
        assert_eq!((fields.stress, fields.yielded), (four.to_vec(), vec![1]));
        // Everything up to the last array that is read; what follows is the mesh.
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
