//! Reading of nodes and elements in version 2.2.

use super::content::Content;
use super::cursor::Cursor;
use super::entities::Partitions;
use super::kind::TypeInFile;
use crate::Result;

/// Reads `$Nodes`, with `number x y z` per line.
///
/// In `$ParametricNodes` each node is followed by the dimension and number of its entity, and by as
/// many parameters as a curve or a surface has.
pub(super) fn read_nodes(
    content: &mut Content,
    cursor: &mut Cursor,
    parametric: bool,
) -> Result<()> {
    let n = count_line(cursor, "the number of nodes")?;
    content.node_labels.reserve(n);
    content.coordinates.reserve(3 * n);
    for _ in 0..n {
        content.node_labels.push(cursor.unsigned("a node number")?);
        for _ in 0..3 {
            content.coordinates.push(cursor.float("a coordinate")?);
        }
        match parametric {
            true if cursor.is_binary() => {
                let dimension = cursor.small("the dimension of an entity")?;
                cursor.signed("the tag of an entity")?;
                for _ in 0..if dimension < 3 { dimension } else { 0 } {
                    cursor.float("a parameter of a node")?;
                }
            }
            true => drop(cursor.rest_of_line()),
            false => cursor.end_line()?,
        }
    }
    content.index_nodes(cursor)
}

/// Reads `$Elements`, with `number type n_tags physical elementary ... nodes` per line. In a binary
/// file, the elements of one type follow a header `type n_elements n_tags`, each as
/// `number physical ... nodes`.
pub(super) fn read_elements(content: &mut Content, cursor: &mut Cursor) -> Result<()> {
    let header = cursor.at();
    let mut partitions = Partitions::default();
    let n = count_line(cursor, "the number of elements")?;
    content.elements.reserve(n);
    content.connectivity.reserve(4 * n);
    let mut read = 0;
    while read < n {
        let at = cursor.at();
        if cursor.is_binary() {
            let element_type = cursor.unsigned("an element type")?;
            let kind = Content::kind(cursor, at, element_type)?;
            let n_alike = cursor.count("the number of elements of a type")?;
            let n_tags = cursor.count("the number of tags")?;
            if n_alike == 0 || n_alike > n - read {
                let message = format!("{n_alike} elements of a type, where {} are left", n - read);
                return Err(cursor.error_at(at, message));
            }
            for _ in 0..n_alike {
                let at = cursor.at();
                let label = cursor.unsigned("an element number")?;
                let element = (kind, label, at);
                partitions.add(read_tags_and_nodes(content, cursor, element, n_tags)?);
            }
            read += n_alike;
        } else {
            let label = cursor.unsigned("an element number")?;
            let element_type = cursor.unsigned("an element type")?;
            let kind = Content::kind(cursor, at, element_type)?;
            let n_tags = cursor.count("the number of tags")?;
            let element = (kind, label, at);
            partitions.add(read_tags_and_nodes(content, cursor, element, n_tags)?);
            read += 1;
        }
    }
    partitions.require_all(0, cursor, header)
}

/// Reads an element. The first tag is the physical group. The fourth tag is the partition, which is
/// returned; 0 if there is none.
fn read_tags_and_nodes(
    content: &mut Content,
    cursor: &mut Cursor,
    (kind, label, at): (TypeInFile, u64, usize),
    n_tags: usize,
) -> Result<u64> {
    let [mut physical, mut partition] = [0; 2];
    for k in 0..n_tags {
        // The tag is negative if the orientation of the surface is reversed; the group is the same.
        let tag = cursor.signed("a tag")?.unsigned_abs();
        match k {
            0 => physical = tag,
            3 => partition = tag,
            _ => {}
        }
    }
    let group = [physical];
    let groups = if physical == 0 { &[][..] } else { &group };
    content.read_element(cursor, kind, label, groups, at)?;
    Ok(partition)
}

/// Reads a count on a line of its own, which is text even in a binary file.
fn count_line(cursor: &mut Cursor, what: &str) -> Result<usize> {
    cursor.in_text(|cursor| {
        let n = cursor.count(what)?;
        cursor.end_line()?;
        Ok(n)
    })
}
