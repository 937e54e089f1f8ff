//! Reading of nodes, elements, sets and surfaces.

use super::block::BlockReader;
use crate::deck::boundary::{BoundaryElements, nodes_of_boundary};
use crate::deck::data::{EntitySelection, Member, Members, Named, Sets, SurfacePart};
use crate::deck::element_type::ElementType;
use crate::deck::fields::LineFields;
use crate::deck::mesh::{DeckMesh, Nodes};
use crate::deck::source::LinePlace;
use crate::error::{Error, ErrorKind, Result};
use crate::shape::MAX_NODES;

/// Reads the nodes of a deck.
pub(super) fn nodes(
    block: &mut BlockReader,
    nodes: &mut Nodes,
    sets: &mut Named<Members>,
) -> Result<()> {
    let keyword = block.keyword;
    block.allow("NSET")?;
    let first = nodes.labels.len();
    read_nodes(block, nodes)?;
    let last = nodes.labels.len();
    if let Some(name) = keyword.get("NSET") {
        let set = sets.entry(name);
        set.push((Member::Rows(first, last), keyword.place));
    }
    Ok(())
}

/// Reads elements, or boundary elements, by their type.
pub(super) fn elements(
    block: &mut BlockReader,
    mesh: &mut DeckMesh,
    boundary: &mut BoundaryElements,
    sets: &mut Named<Members>,
) -> Result<()> {
    let keyword = block.keyword;
    block.allow("TYPE ELSET")?;
    let name = block.require("TYPE")?;
    if let Some(n) = nodes_of_boundary(name) {
        return boundary_elements(block, n, boundary, sets);
    }
    let element_type = ElementType::from_name(name).map_err(|why| {
        let error = block.error(why);
        Error::new(ErrorKind::Unsupported, error.message())
    })?;
    let first = mesh.elements.labels.len();
    read_elements(block, element_type, mesh)?;
    let last = mesh.elements.labels.len();
    if let Some(name) = keyword.get("ELSET") {
        let set = sets.entry(name);
        set.push((Member::Rows(first, last), keyword.place));
    }
    if let Some(note) = element_type.note {
        let how = format!("TYPE={name}: {note}");
        block.take(&how);
    }
    Ok(())
}

/// Reads boundary elements, which are lines or shells, with `n` nodes each.
fn boundary_elements(
    block: &mut BlockReader,
    n: usize,
    boundary: &mut BoundaryElements,
    sets: &mut Named<Members>,
) -> Result<()> {
    let keyword = block.keyword;
    let name = block.require("TYPE")?;
    boundary.note_type(name, keyword.place);
    while let Some((place, mut fields)) = block.row()? {
        let label = fields.label("the element number")?;
        let mut nodes = Vec::with_capacity(n);
        for _ in 0..n {
            nodes.push(fields.label("a node number")?);
        }
        // Beams may have an additional node that orients the cross-section.
        if !fields.is_at_end() {
            fields.label("a node number")?;
        }
        fields.end()?;
        boundary.add(label, nodes);
        if let Some(set) = keyword.get("ELSET") {
            let set = sets.entry(set);
            set.push((Member::Of(EntitySelection::Label(label)), place));
        }
    }
    let how = format!("TYPE={name}: without stiffness; sets of them are surfaces");
    block.take(&how);
    Ok(())
}

/// Reads a set of nodes or elements.
pub(super) fn set(block: &mut BlockReader, key: &str, sets: &mut Sets) -> Result<()> {
    let keyword = block.keyword;
    let known = match key {
        "NSET" => "NSET GENERATE ELSET UNSORTED INTERNAL",
        _ => "ELSET GENERATE INTERNAL",
    };
    block.allow(known)?;
    let name = block.require(key)?;
    let set = match key {
        "NSET" => sets.nodes.entry(name),
        _ => sets.elements.entry(name),
    };
    if let Some(of) = keyword.get("ELSET").filter(|_| key == "NSET") {
        set.push((Member::NodesOf(of.to_string()), keyword.place));
        return block.skip();
    }
    while let Some((place, mut fields)) = block.row()? {
        if keyword.has("GENERATE") {
            set.push((range(&mut fields)?, place));
            continue;
        }
        while !fields.is_at_end() {
            set.push((Member::Of(target(&mut fields)?), place));
        }
    }
    Ok(())
}

/// Reads a surface.
pub(super) fn surface(
    block: &mut BlockReader,
    surfaces: &mut Named<Vec<(SurfacePart, LinePlace)>>,
) -> Result<()> {
    block.allow("NAME TYPE INTERNAL")?;
    let name = block.require("NAME")?;
    let of_nodes = block.choice("TYPE", &["ELEMENT", "NODE"])? == "NODE";
    if surfaces.get(name).is_some() {
        return Err(block.error(format!("a second surface {name}; rename one of them")));
    }
    let surface = surfaces.entry(name);
    while let Some((place, mut fields)) = block.row()? {
        let on = target(&mut fields)?;
        let part = if of_nodes {
            // A weight may follow, which is not used.
            SurfacePart::OfNodes(on)
        } else if fields.is_at_end() {
            SurfacePart::Free(on)
        } else {
            SurfacePart::Face(on, face(&mut fields, b'S')?)
        };
        surface.push((part, place));
    }
    Ok(())
}

/// Reads a number, or the name of a set.
pub(super) fn target(fields: &mut LineFields) -> Result<EntitySelection> {
    let mut ahead = *fields;
    let word = ahead.written();
    // Names may begin with a digit; in quotes they may consist of digits alone.
    let is_name = word.iter().any(u8::is_ascii_alphabetic);
    if word.first().is_some_and(u8::is_ascii_digit) && !is_name {
        return Ok(EntitySelection::Label(fields.label("the number")?));
    }
    Ok(EntitySelection::Set(
        fields.text("a number or the name of a set")?,
    ))
}

/// Reads the number of a face, as in `S3` or `P3`.
pub(super) fn face(fields: &mut LineFields, letter: u8) -> Result<usize> {
    let word = fields.text("a face")?;
    let number = match word.as_bytes() {
        [first, rest @ ..] if first.eq_ignore_ascii_case(&letter) => {
            let text = std::str::from_utf8(rest).unwrap_or_default();
            text.parse().ok().filter(|number| (1..=6).contains(number))
        }
        _ => None,
    };
    number.ok_or_else(|| {
        let letter = char::from(letter);
        fields.place.error(format!(
            "the face is `{word}`; give {letter}1 to {letter}6 as far as the element has faces"
        ))
    })
}

/// Reads first number, last number and step of `GENERATE`.
fn range(fields: &mut LineFields) -> Result<Member> {
    let first = fields.label("the first number")?;
    let last = fields.label("the last number")?;
    let step = match fields.is_at_end() {
        true => 1,
        false => fields.label("the step")?,
    };
    fields.end()?;
    if step == 0 || last < first {
        return Err(fields.place.error(format!(
            "GENERATE from {first} to {last} by {step} gives nothing; the last number must not be \
             less than the first, the step at least 1"
        )));
    }
    Ok(Member::Range(first, last, step))
}

/// Reads node numbers and coordinates.
fn read_nodes(block: &mut BlockReader, nodes: &mut Nodes) -> Result<()> {
    while let Some((place, mut fields)) = block.row()? {
        let label = fields.label("the node number")?;
        let mut x = [0.0; 3];
        for (x, what) in x.iter_mut().zip(["x", "y", "z"]) {
            if fields.is_at_end() {
                break;
            }
            *x = fields.number_or(what, 0.0)?;
        }
        fields.end()?;
        nodes.labels.push(label);
        nodes.coordinates.extend_from_slice(&x);
        nodes.places.push(place);
    }
    Ok(())
}

/// Reads element numbers and their nodes, which continue in the next line if a line ends with a
/// comma.
fn read_elements(
    block: &mut BlockReader,
    element_type: ElementType,
    mesh: &mut DeckMesh,
) -> Result<()> {
    let (elements, instances) = (&mut mesh.elements, &mesh.instances);
    let n = element_type.shape.n_nodes();
    if elements.offsets.is_empty() {
        elements.offsets.push(0);
    }
    while let Some((place, mut row)) = block.row()? {
        let mut nodes = [0; MAX_NODES];
        let label = row.label("the element number")?;
        let mut read = 0;
        loop {
            while read < n && !row.is_at_end() {
                nodes[read] = row.label("a node number")?;
                read += 1;
            }
            row.end()?;
            if read == n {
                break;
            }
            let label = instances.shown(label);
            let why = format!("element {label} has {read} nodes, {n} of them are needed");
            let error = row.place.error(why);
            if !row.ends_with_comma() {
                return Err(error);
            }
            (_, row) = block.row()?.ok_or(error)?;
        }
        elements.labels.push(label);
        elements.types.push(element_type);
        elements.nodes.extend_from_slice(&nodes[..n]);
        elements.offsets.push(elements.nodes.len());
        elements.places.push(place);
    }
    Ok(())
}
