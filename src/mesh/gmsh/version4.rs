//! Reading of nodes and elements in version 4.1.

use super::content::Content;
use super::cursor::Cursor;
use super::entities::Entities;
use crate::Result;

/// Reads `$Nodes`, which has blocks of node numbers, each followed by the coordinates.
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

/// Reads `$Elements`, which has blocks of elements of one entity and one type.
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
        if kind.element.dimension() != dimension {
            return Err(cursor.error_at(
                at,
                format!(
                    "elements of type {element_type} cannot belong to an entity of dimension \
                     {dimension}"
                ),
            ));
        }
        let groups = entities.groups(dimension, entity);
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
