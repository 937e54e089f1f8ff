//! Entities, nodes and elements of version 4.1.

use super::content::Content;
use super::cursor::Cursor;
use crate::Result;
use std::collections::HashMap;

/// Physical tags by entity (dimension, tag).
pub(super) type Entities = HashMap<(u64, i64), Vec<u64>>;

/// Reads `$Entities`: which physical groups a point, curve or surface is in.
pub(super) fn read_entities(cursor: &mut Cursor) -> Result<Entities> {
    let mut counts = [0; 4];
    for (count, what) in counts.iter_mut().zip([
        "the number of points",
        "the number of curves",
        "the number of surfaces",
        "the number of volumes",
    ]) {
        *count = cursor.count(what)?;
    }
    cursor.end_line()?;
    let mut entities = Entities::new();
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = cursor.signed("the tag of an entity")?;
            // A point has its position, everything else a bounding box.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                cursor.float("a coordinate of an entity")?;
            }
            let n = cursor.count("the number of physical tags")?;
            let mut tags = Vec::new();
            for _ in 0..n {
                let tag = cursor.signed("a physical tag")?.unsigned_abs();
                if !tags.contains(&tag) {
                    tags.push(tag);
                }
            }
            // The bounding entities that follow are of no use here.
            if !cursor.is_binary() {
                cursor.rest_of_line();
            } else if dimension > 0 {
                for _ in 0..cursor.count("the number of bounding entities")? {
                    cursor.signed("a bounding entity")?;
                }
            }
            entities.insert((dimension as u64, tag), tags);
        }
    }
    Ok(entities)
}

/// Reads `$Nodes`: blocks of node numbers, then their coordinates.
pub(super) fn read_nodes(content: &mut Content, cursor: &mut Cursor) -> Result<()> {
    let header = cursor.at();
    let n_blocks = cursor.count("the number of entity blocks")?;
    let n_nodes = cursor.count("the number of nodes")?;
    cursor.unsigned("the smallest node number")?;
    cursor.unsigned("the largest node number")?;
    cursor.end_line()?;
    content.node_labels.reserve(n_nodes);
    content.coordinates.reserve(3 * n_nodes);
    for _ in 0..n_blocks {
        let dimension = cursor.small("the dimension of an entity")?;
        cursor.signed("the tag of an entity")?;
        let parametric = cursor.small("the parametric flag")? != 0;
        let n = cursor.count("the number of nodes in a block")?;
        cursor.end_line()?;
        for _ in 0..n {
            content.node_labels.push(cursor.unsigned("a node number")?);
            cursor.end_line()?;
        }
        for _ in 0..n {
            for _ in 0..3 {
                content.coordinates.push(cursor.float("a coordinate")?);
            }
            if !parametric {
                cursor.end_line()?;
            } else if cursor.is_binary() {
                for _ in 0..dimension {
                    cursor.float("a parameter of a node")?;
                }
            } else {
                cursor.rest_of_line();
            }
        }
    }
    check_total(cursor, header, "nodes", content.node_labels.len(), n_nodes)?;
    content.index_nodes(cursor)
}

/// Reads `$Elements`: blocks of elements of one entity and one type.
pub(super) fn read_elements(
    content: &mut Content,
    cursor: &mut Cursor,
    entities: &Entities,
) -> Result<()> {
    let header = cursor.at();
    let n_blocks = cursor.count("the number of entity blocks")?;
    let n_elements = cursor.count("the number of elements")?;
    cursor.unsigned("the smallest element number")?;
    cursor.unsigned("the largest element number")?;
    cursor.end_line()?;
    content.elements.reserve(n_elements);
    content.connectivity.reserve(4 * n_elements);
    let mut read = 0;
    for _ in 0..n_blocks {
        let at = cursor.at();
        let dimension = cursor.small("the dimension of an entity")?;
        let entity = cursor.signed("the tag of an entity")?;
        let element_type = cursor.small("an element type")?;
        let kind = Content::kind(cursor, at, element_type)?;
        let n = cursor.count("the number of elements in a block")?;
        cursor.end_line()?;
        if kind.dimension() != dimension {
            return Err(cursor.error_at(
                at,
                format!(
                    "elements of type {element_type} cannot belong to an entity of dimension \
                     {dimension}"
                ),
            ));
        }
        let groups = entities
            .get(&(dimension, entity))
            .map_or(&[][..], Vec::as_slice);
        for _ in 0..n {
            let at = cursor.at();
            let label = cursor.unsigned("an element number")?;
            content.read_element(cursor, kind, label, groups, at)?;
        }
        read += n;
    }
    check_total(cursor, header, "elements", read, n_elements)
}

fn check_total(
    cursor: &Cursor,
    header: usize,
    what: &str,
    read: usize,
    announced: usize,
) -> Result<()> {
    if read == announced {
        return Ok(());
    }
    Err(cursor.error_at(
        header,
        format!("{announced} {what} are announced, but the blocks hold {read}"),
    ))
}
