//! Gmsh meshes: `.msh` 2.2 and 4.1, as text and binary in both orders of bytes.
//!
//! In a plane mesh physical surfaces are bodies, physical curves are surfaces, and physical points
//! are node sets. A mesh with volumes is a solid one: physical volumes are bodies, physical
//! surfaces are surfaces, and physical curves and points are node sets. An unnamed group is named
//! by its number. A physical curve on the edge between two bodies belongs to the body whose name
//! begins the curve's name (`shaft.contact` to `shaft`), otherwise to the element on its left.
//! Nodes that belong to no element of a body (centres of circles, for instance) are dropped, and
//! elements given clockwise are reversed. The partitions of a mesh are joined; a file that holds
//! only some of them is refused.
//!
//! # Source
//! Gmsh reference manual, chapter "Gmsh file formats", "MSH file format" (version 4.1) and
//! "Legacy formats" (version 2.2), <https://gmsh.info/doc/texinfo/gmsh.html>.

mod assemble;
mod content;
mod cursor;
mod encoding;
mod entities;
mod kind;
pub(crate) mod node_data;
#[cfg(test)]
mod tests;
mod version2;
mod version4;
mod write;

pub use write::write;

use super::Mesh;
use crate::files;
use crate::{Error, ErrorKind, Result};
use content::Content;
use cursor::Cursor;
use encoding::Encoding;
use entities::Entities;
use std::path::Path;

/// Reads a mesh file.
///
/// # Errors
/// An I/O error if the file cannot be read, and the errors of [`parse`].
pub fn read(path: &Path) -> Result<Mesh> {
    let text = files::read("read the mesh file", path, None)?;
    parse(&text, &path.display().to_string())
}

/// Reads a mesh from the bytes of a file; `name` is the file's name for messages.
///
/// # Errors
/// Input errors with file name and line number (for a binary file the byte) for anything that is
/// not a complete, consistent file of version 2.2 or 4.1; unsupported errors for element types that
/// brinell does not have.
pub fn parse(text: &[u8], name: &str) -> Result<Mesh> {
    let mut cursor = Cursor::new(text, name);
    let mut sections = Sections::default();
    loop {
        cursor.section = "the file";
        cursor.skip_lines();
        let at = cursor.at();
        if sections.version.is_none() && !is_beginning(&text[at..]) {
            return Err(cursor.error(
                "this is not a Gmsh mesh: it should begin with $MeshFormat \
                 (a .geo file must be meshed and exported as .msh first)",
            ));
        }
        let Some(section) = cursor.section_start()? else {
            break;
        };
        sections.read(section, at, &mut cursor)?;
    }
    for (there, section) in [
        (sections.has_nodes, "$Nodes"),
        (sections.has_elements, "$Elements"),
    ] {
        if !there {
            return Err(cursor.error(format!(
                "the file ends without a section {section}: is it truncated?"
            )));
        }
    }
    assemble::assemble(sections.content, &cursor)
}

/// Data of the sections read so far.
#[derive(Default)]
struct Sections {
    version: Option<Version>,
    content: Content,
    entities: Entities,
    has_nodes: bool,
    has_elements: bool,
}

impl Sections {
    /// Reads a section, of which the cursor has read the head at byte `at`.
    fn read(&mut self, section: &[u8], at: usize, cursor: &mut Cursor) -> Result<()> {
        let content = &mut self.content;
        match (section, self.version) {
            (b"$MeshFormat", None) => {
                cursor.section = "$MeshFormat";
                self.version = Some(read_format(cursor)?);
                cursor.section_end("$EndMeshFormat")
            }
            (b"$PhysicalNames", Some(_)) => {
                cursor.section = "$PhysicalNames";
                cursor.in_text(|cursor| content.read_names(cursor))?;
                cursor.section_end("$EndPhysicalNames")
            }
            (b"$Entities", Some(Version::V4)) => {
                cursor.section = "$Entities";
                self.entities.read(cursor)?;
                cursor.section_end("$EndEntities")
            }
            (b"$PartitionedEntities", Some(Version::V4)) => {
                cursor.section = "$PartitionedEntities";
                self.entities.read_partitioned(cursor)?;
                cursor.section_end("$EndPartitionedEntities")
            }
            (b"$Nodes" | b"$ParametricNodes", Some(_)) if self.has_nodes => {
                Err(cursor.error_at(at, "a second section $Nodes"))
            }
            (b"$ParametricNodes", Some(Version::V2)) => {
                cursor.section = "$ParametricNodes";
                self.has_nodes = true;
                version2::read_nodes(content, cursor, true)?;
                cursor.section_end("$EndParametricNodes")
            }
            (b"$Nodes", Some(version)) => {
                cursor.section = "$Nodes";
                self.has_nodes = true;
                match version {
                    Version::V2 => version2::read_nodes(content, cursor, false)?,
                    Version::V4 => version4::read_nodes(content, cursor)?,
                }
                cursor.section_end("$EndNodes")
            }
            (b"$Elements", Some(_)) if !self.has_nodes => {
                Err(cursor.error_at(at, "$Elements comes before $Nodes"))
            }
            (b"$Elements", Some(_)) if self.has_elements => {
                Err(cursor.error_at(at, "a second section $Elements"))
            }
            (b"$Elements", Some(version)) => {
                cursor.section = "$Elements";
                self.has_elements = true;
                match version {
                    Version::V2 => version2::read_elements(content, cursor)?,
                    Version::V4 => version4::read_elements(content, cursor, &self.entities)?,
                }
                cursor.section_end("$EndElements")
            }
            (other, _) => cursor.skip_section(other),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    V2,
    V4,
}

/// Whether the text is the beginning of a Gmsh file: only a comment may precede the format.
fn is_beginning(text: &[u8]) -> bool {
    text.starts_with(b"$MeshFormat") || text.starts_with(b"$Comments")
}

/// Reads `$MeshFormat`: the version, and the encoding of numbers for the cursor.
fn read_format(cursor: &mut Cursor) -> Result<Version> {
    let at = cursor.at();
    let number = cursor.float("the version")?;
    let version = if (2.0..3.0).contains(&number) {
        Version::V2
    } else if number == 4.1 {
        Version::V4
    } else {
        let place = cursor.error_at(
            at,
            format!("version {number} of the format; export the mesh as version 4.1 or 2.2"),
        );
        return Err(Error::new(ErrorKind::Unsupported, place.message()));
    };
    let encoding = read_encoding(cursor, version == Version::V4)?;
    cursor.set_encoding(encoding);
    Ok(version)
}

/// Reads what follows the version in `$MeshFormat`: whether the file is binary, the size of a
/// number, and in a binary file the number one, which shows the byte order.
///
/// # Errors
/// `Unsupported` for numbers of any size other than eight bytes; `Input` for an unknown file
/// type, or if the number one cannot be recognised.
fn read_encoding(cursor: &mut Cursor, is_version_4: bool) -> Result<Encoding> {
    let at = cursor.at();
    let file_type = cursor.unsigned("the file type")?;
    let size = cursor.unsigned("the size of a number")?;
    cursor.end_line()?;
    match file_type {
        0 => return Ok(Encoding::Text),
        1 if size == 8 => {}
        1 => {
            let place = cursor.error_at(
                at,
                format!("binary numbers of {size} bytes; brinell reads those of 8"),
            );
            return Err(Error::new(ErrorKind::Unsupported, place.message()));
        }
        other => {
            let message = format!("the file type is {other}; 0 is text and 1 binary");
            return Err(cursor.error_at(at, message));
        }
    }
    let at = cursor.at();
    let one = i32::from_ne_bytes(cursor.bytes("the number one")?);
    let swapped = match (one, one.swap_bytes()) {
        (1, _) => false,
        (_, 1) => true,
        _ => {
            let message = format!(
                "the number one, which tells the order of bytes, reads as {one}: is the file \
                 damaged, or was it changed as if it were text?"
            );
            return Err(cursor.error_at(at, message));
        }
    };
    Ok(Encoding::Binary {
        swapped,
        wide: is_version_4,
    })
}
