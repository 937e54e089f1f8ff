//! VTK XML unstructured grids (`.vtu`) with appended raw binary data, the files that join pieces to
//! one grid (`.pvtu`), and collections (`.pvd`).
//!
//! The head is XML; each array is a block of the appended section, at a byte offset counted from
//! the byte after its leading `_`:
//!
//! ```text
//! <AppendedData encoding="raw">_ [n: u64][n bytes] [n: u64][n bytes] ... </AppendedData>
//! ```
//!
//! All numbers are little endian. No value is formatted, so writing costs about as much as a copy
//! in memory.
//!
//! # Source
//! VTK file formats, <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>.

use crate::mesh::{Mesh, Shape};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use std::io::{self, Write};

/// Number of items that are encoded between two writes.
const CHUNK: usize = 2048;
/// Number of bytes that hold the length of a block.
const LENGTH_BYTES: u64 = 8;
/// The array of a piece with the numbers of its points in the whole mesh, from 0.
pub(super) const NODE_IDS: &str = "GlobalNodeIds";
/// The array of a piece with the numbers of its cells in the whole mesh, from 0.
pub(super) const ELEMENT_IDS: &str = "GlobalElementIds";

/// A mesh with data on it.
pub(super) struct UnstructuredGrid<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) point_data: Vec<DataArray<'a>>,
    pub(super) cell_data: Vec<DataArray<'a>>,
}

/// A named array of values on nodes or elements.
pub(super) struct DataArray<'a> {
    name: &'static str,
    components: usize,
    component_names: &'a [&'a str],
    values: ArrayValues<'a>,
}

impl<'a> DataArray<'a> {
    /// Creates an array with the number of components that follows from its values.
    pub(super) fn new(name: &'static str, values: ArrayValues<'a>) -> Self {
        let components = match values {
            ArrayValues::Planar(_) | ArrayValues::Spatial(_) => 3,
            ArrayValues::Tensors(_) => 9,
            _ => 1,
        };
        DataArray {
            name,
            components,
            component_names: &[],
            values,
        }
    }

    /// Creates an array with one component per name.
    pub(super) fn named(name: &'static str, names: &'a [&'a str], values: ArrayValues<'a>) -> Self {
        DataArray {
            name,
            components: names.len(),
            component_names: names,
            values,
        }
    }
}

/// The values of an array as they lie in memory; the variant determines how they are written.
pub(super) enum ArrayValues<'a> {
    /// Numbers, written as they are.
    Float64(&'a [f64]),
    /// `n x 2`, written as `n x 3` with 0 for the third component.
    Planar(&'a [f64]),
    /// `n x 3`, written as they are.
    Spatial(&'a [f64]),
    /// Symmetric, `n x [xx yy zz xy yz zx]`, written as `n x 9`, row by row.
    Tensors(&'a [f64]),
    /// Bytes, written as they are.
    UInt8(&'a [u8]),
    /// Small numbers, such as those of bodies.
    Int32(&'a [u32]),
    /// Numbers of nodes or elements, from 0.
    Int64(&'a [u32]),
    /// For each element, the index behind its last node in the connectivity.
    Offsets(&'a [usize]),
    /// VTK cell types.
    CellTypes(&'a [Shape]),
}

impl<'a> ArrayValues<'a> {
    /// Vectors of as many components as a mesh has coordinates.
    pub(super) fn vectors(mesh: &Mesh, values: &'a [f64]) -> Self {
        match mesh.is_solid() {
            true => ArrayValues::Spatial(values),
            false => ArrayValues::Planar(values),
        }
    }

    fn type_name(&self) -> &'static str {
        match self {
            ArrayValues::Float64(_)
            | ArrayValues::Planar(_)
            | ArrayValues::Spatial(_)
            | ArrayValues::Tensors(_) => "Float64",
            ArrayValues::UInt8(_) | ArrayValues::CellTypes(_) => "UInt8",
            ArrayValues::Int32(_) => "Int32",
            ArrayValues::Int64(_) | ArrayValues::Offsets(_) => "Int64",
        }
    }

    /// Returns the number of bytes that are written, without the length in front.
    fn n_bytes(&self) -> u64 {
        let n = match self {
            ArrayValues::Float64(values) | ArrayValues::Spatial(values) => 8 * values.len(),
            ArrayValues::Tensors(values) => 72 * (values.len() / 6),
            ArrayValues::Planar(values) => 24 * (values.len() / 2),
            ArrayValues::UInt8(values) => values.len(),
            ArrayValues::Int32(values) => 4 * values.len(),
            ArrayValues::Int64(values) => 8 * values.len(),
            ArrayValues::Offsets(values) => 8 * values.len(),
            ArrayValues::CellTypes(values) => values.len(),
        };
        n as u64
    }

    /// Writes the block: length, then values.
    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.n_bytes().to_le_bytes())?;
        match self {
            ArrayValues::Float64(values) | ArrayValues::Spatial(values) => {
                encode(out, values, |v| v.to_le_bytes())
            }
            ArrayValues::Tensors(values) => encode(out, values.as_chunks::<6>().0, tensor),
            ArrayValues::Planar(values) => encode(out, values.as_chunks::<2>().0, planar),
            ArrayValues::UInt8(values) => out.write_all(values),
            ArrayValues::Int32(values) => encode(out, values, |v| v.to_le_bytes()),
            ArrayValues::Int64(values) => encode(out, values, |v| u64::from(v).to_le_bytes()),
            ArrayValues::Offsets(values) => encode(out, values, |v| (v as u64).to_le_bytes()),
            ArrayValues::CellTypes(values) => encode(out, values, |shape| [shape.reference().vtk]),
        }
    }
}

/// Returns the bytes of a plane vector, written in three dimensions.
fn planar(v: [f64; 2]) -> [u8; 24] {
    let mut bytes = [0; 24];
    bytes[..8].copy_from_slice(&v[0].to_le_bytes());
    bytes[8..16].copy_from_slice(&v[1].to_le_bytes());
    bytes
}

/// Returns the bytes of a symmetric tensor `[xx yy zz xy yz zx]`, row by row.
fn tensor([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> [u8; 72] {
    let mut bytes = [0; 72];
    let rows = [xx, xy, zx, xy, yy, yz, zx, yz, zz];
    for (place, entry) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(rows) {
        *place = entry.to_le_bytes();
    }
    bytes
}

/// Writes the bytes of `items`, a chunk at a time.
fn encode<Item: Copy, const BYTES: usize>(
    out: &mut impl Write,
    items: &[Item],
    bytes: impl Fn(Item) -> [u8; BYTES],
) -> io::Result<()> {
    let mut buffer = vec![[0; BYTES]; CHUNK.min(items.len())];
    for chunk in items.chunks(CHUNK) {
        let encoded = &mut buffer[..chunk.len()];
        for (slot, &item) in encoded.iter_mut().zip(chunk) {
            *slot = bytes(item);
        }
        out.write_all(encoded.as_flattened())?;
    }
    Ok(())
}

/// Writes a grid.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write(out: &mut impl Write, grid: &UnstructuredGrid<'_>) -> io::Result<()> {
    let mesh = grid.mesh;
    let points = [DataArray::new(
        "points",
        ArrayValues::vectors(mesh, &mesh.coordinates),
    )];
    let cells = [
        DataArray::new("connectivity", ArrayValues::Int64(&mesh.connectivity)),
        DataArray::new(
            "offsets",
            ArrayValues::Offsets(mesh.offsets.get(1..).unwrap_or_default()),
        ),
        DataArray::new("types", ArrayValues::CellTypes(&mesh.shapes)),
    ];
    let sections = [
        ("PointData", grid.point_data.as_slice()),
        ("CellData", grid.cell_data.as_slice()),
        ("Points", points.as_slice()),
        ("Cells", cells.as_slice()),
    ];

    let mut xml = Writer::new_with_indent(out, b' ', 2);
    open_file(&mut xml, "UnstructuredGrid")?;
    open(&mut xml, "UnstructuredGrid", &[])?;
    let size = [
        ("NumberOfPoints", mesh.n_nodes().to_string()),
        ("NumberOfCells", mesh.n_elements().to_string()),
    ];
    open(&mut xml, "Piece", &size)?;
    let mut offset = 0;
    for (section, arrays) in sections {
        open(&mut xml, section, &ids_of(arrays))?;
        for array in arrays {
            let place = [
                ("format", "appended".to_owned()),
                ("offset", offset.to_string()),
            ];
            declare(&mut xml, "DataArray", array, &place)?;
            offset += LENGTH_BYTES + array.values.n_bytes();
        }
        close(&mut xml, section)?;
    }
    close(&mut xml, "Piece")?;
    close(&mut xml, "UnstructuredGrid")?;
    open(&mut xml, "AppendedData", &[("encoding", "raw".to_owned())])?;
    xml.write_event(Event::Text(BytesText::new("_")))?;
    for array in sections.iter().flat_map(|(_, arrays)| arrays.iter()) {
        array.values.write(xml.get_mut())?;
    }
    xml.get_mut().write_all(b"\n")?;
    close(&mut xml, "AppendedData")?;
    close_file(&mut xml)
}

/// Writes the file which says that other files in the same directory are the pieces of a grid with
/// these arrays.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write_pieces(
    out: &mut impl Write,
    grid: &UnstructuredGrid<'_>,
    files: &[String],
) -> io::Result<()> {
    let points = [DataArray::new(
        "points",
        ArrayValues::vectors(grid.mesh, &grid.mesh.coordinates),
    )];
    let mut xml = Writer::new_with_indent(out, b' ', 2);
    open_file(&mut xml, "PUnstructuredGrid")?;
    let overlap = [("GhostLevel", "0".to_owned())];
    open(&mut xml, "PUnstructuredGrid", &overlap)?;
    for (section, arrays) in [
        ("PPointData", grid.point_data.as_slice()),
        ("PCellData", grid.cell_data.as_slice()),
        ("PPoints", points.as_slice()),
    ] {
        open(&mut xml, section, &ids_of(arrays))?;
        for array in arrays {
            declare(&mut xml, "PDataArray", array, &[])?;
        }
        close(&mut xml, section)?;
    }
    for file in files {
        let source = [("Source", file.clone())];
        xml.write_event(Event::Empty(element("Piece", &source)))?;
    }
    close(&mut xml, "PUnstructuredGrid")?;
    close_file(&mut xml)
}

/// Writes a collection of files, each with its time.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write_collection(out: &mut impl Write, files: &[(f64, String)]) -> io::Result<()> {
    let mut xml = Writer::new_with_indent(out, b' ', 2);
    open_file(&mut xml, "Collection")?;
    open(&mut xml, "Collection", &[])?;
    for (time, file) in files {
        let attributes = [
            ("timestep", time.to_string()),
            ("group", String::new()),
            ("part", "0".to_owned()),
            ("file", file.clone()),
        ];
        let element = element("DataSet", &attributes);
        xml.write_event(Event::Empty(element))?;
    }
    close(&mut xml, "Collection")?;
    close_file(&mut xml)
}

type Attributes<'a> = [(&'a str, String)];

fn open_file<W: Write>(xml: &mut Writer<W>, kind: &str) -> io::Result<()> {
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let attributes = [
        ("type", kind.to_owned()),
        ("version", "1.0".to_owned()),
        ("byte_order", "LittleEndian".to_owned()),
        ("header_type", "UInt64".to_owned()),
    ];
    open(xml, "VTKFile", &attributes)
}

fn close_file<W: Write>(xml: &mut Writer<W>) -> io::Result<()> {
    close(xml, "VTKFile")?;
    xml.get_mut().write_all(b"\n")
}

fn open<W: Write>(xml: &mut Writer<W>, name: &str, attributes: &Attributes<'_>) -> io::Result<()> {
    xml.write_event(Event::Start(element(name, attributes)))
}

fn close<W: Write>(xml: &mut Writer<W>, name: &str) -> io::Result<()> {
    xml.write_event(Event::End(BytesEnd::new(name)))
}

/// Returns the attribute that names a section's array of global numbers, if any.
fn ids_of(arrays: &[DataArray<'_>]) -> Vec<(&'static str, String)> {
    let is_ids = |array: &&DataArray| [NODE_IDS, ELEMENT_IDS].contains(&array.name);
    let ids = arrays.iter().filter(is_ids);
    ids.map(|array| ("GlobalIds", array.name.to_owned()))
        .collect()
}

/// Declares an array; `place` says where its values are stored.
fn declare<W: Write>(
    xml: &mut Writer<W>,
    kind: &str,
    array: &DataArray<'_>,
    place: &Attributes<'_>,
) -> io::Result<()> {
    let attributes = [
        ("type", array.values.type_name().to_owned()),
        ("Name", array.name.to_owned()),
        ("NumberOfComponents", array.components.to_string()),
    ];
    let mut start = element(kind, &attributes);
    for (key, value) in place {
        start.push_attribute((*key, value.as_str()));
    }
    for (i, name) in array.component_names.iter().enumerate() {
        start.push_attribute((format!("ComponentName{i}").as_str(), *name));
    }
    xml.write_event(Event::Empty(start))
}

fn element<'a>(name: &'a str, attributes: &'a Attributes<'_>) -> BytesStart<'a> {
    BytesStart::new(name).with_attributes(attributes.iter().map(|(k, v)| (*k, v.as_str())))
}
