//! Nodes and elements of version 2.2.

use super::content::Content;
use super::cursor::Cursor;
use crate::Result;

/// Reads `$Nodes`: `number x y z` per line.
pub(super) fn read_nodes(content: &mut Content, cursor: &mut Cursor) -> Result<()> {
    let n = cursor.count("the number of nodes")?;
    cursor.end_line()?;
    content.node_labels.reserve(n);
    content.coordinates.reserve(3 * n);
    for _ in 0..n {
        content.node_labels.push(cursor.unsigned("a node number")?);
        for _ in 0..3 {
            content.coordinates.push(cursor.float("a coordinate")?);
        }
        cursor.end_line()?;
    }
    content.index_nodes(cursor)
}

/// Reads `$Elements`: `number type n_tags physical elementary ... nodes` per line.
pub(super) fn read_elements(content: &mut Content, cursor: &mut Cursor) -> Result<()> {
    let n = cursor.count("the number of elements")?;
    cursor.end_line()?;
    content.elements.reserve(n);
    content.connectivity.reserve(4 * n);
    for _ in 0..n {
        let at = cursor.at();
        let label = cursor.unsigned("an element number")?;
        let element_type = cursor.unsigned("an element type")?;
        let kind = Content::kind(cursor, at, element_type)?;
        let n_tags = cursor.count("the number of tags")?;
        let mut physical = 0;
        for k in 0..n_tags {
            // Negative for a surface that is turned round; the group is the same.
            let tag = cursor.signed("a tag")?.unsigned_abs();
            if k == 0 {
                physical = tag;
            }
        }
        let group = [physical];
        let groups = if physical == 0 { &[][..] } else { &group };
        content.read_element(cursor, kind, label, groups, at)?;
    }
    Ok(())
}
