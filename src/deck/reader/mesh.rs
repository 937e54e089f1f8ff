//! Reading of nodes, elements, sets and surfaces.

use super::{Reader, fields};
use crate::deck::boundary::nodes_of_boundary;
use crate::deck::data::{EntitySelection, Member, SurfacePart};
use crate::deck::element_type::ElementType;
use crate::deck::fields::LineFields;
use crate::deck::instances::Instances;
use crate::deck::keyword::Keyword;
use crate::deck::mesh::{DeckElements, Nodes};
use crate::deck::source::{DeckLines, Line};
use crate::error::{Error, ErrorKind, Result};
use crate::shape::MAX_NODES;

impl Reader<'_> {
    pub(super) fn nodes(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &["NSET"])?;
        let nodes = &mut self.deck.mesh.nodes;
        let first = nodes.labels.len();
        read_nodes(&mut self.source, keyword, nodes)?;
        let last = nodes.labels.len();
        if let Some(name) = keyword.get("NSET") {
            let set = self.deck.sets.nodes.entry(name);
            set.push((Member::Rows(first, last), keyword.place));
        }
        Ok(())
    }

    pub(super) fn elements(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["TYPE", "ELSET"])?;
        let name = keyword.require(files, "TYPE")?;
        if let Some(n) = nodes_of_boundary(name) {
            return self.boundary_elements(keyword, n);
        }
        let element_type = ElementType::from_name(name).map_err(|why| {
            let error = keyword.error(files, why);
            Error::new(ErrorKind::Unsupported, error.message())
        })?;
        let elements = &mut self.deck.mesh.elements;
        let first = elements.labels.len();
        let instances = &self.deck.mesh.instances;
        read_elements(&mut self.source, keyword, element_type, elements, instances)?;
        let last = elements.labels.len();
        if let Some(name) = keyword.get("ELSET") {
            let set = self.deck.sets.elements.entry(name);
            set.push((Member::Rows(first, last), keyword.place));
        }
        if let Some(note) = element_type.note {
            let how = format!("TYPE={name}: {note}");
            self.take(keyword, keyword.place, &how);
        }
        Ok(())
    }

    /// Reads boundary elements, which are lines or shells, with `n` nodes each.
    fn boundary_elements(&mut self, keyword: &Keyword, n: usize) -> Result<()> {
        let name = keyword.require(&self.source.files, "TYPE")?;
        self.deck.boundary.note_type(name, keyword.place);
        while let Some(line) = self.source.next_data()? {
            let mut fields = fields(&self.source, keyword, line);
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
            self.deck.boundary.add(label, nodes);
            if let Some(set) = keyword.get("ELSET") {
                let set = self.deck.sets.elements.entry(set);
                set.push((Member::Of(EntitySelection::Label(label)), line.place));
            }
        }
        let how = format!("TYPE={name}: without stiffness; sets of them are surfaces");
        self.take(keyword, keyword.place, &how);
        Ok(())
    }

    /// Reads a set of nodes or elements.
    pub(super) fn set(&mut self, keyword: &Keyword, key: &str) -> Result<()> {
        let known: &[&str] = match key {
            "NSET" => &["NSET", "GENERATE", "ELSET", "UNSORTED", "INTERNAL"],
            _ => &["ELSET", "GENERATE", "INTERNAL"],
        };
        keyword.allow(&self.source.files, known)?;
        let name = keyword.require(&self.source.files, key)?;
        let set = match key {
            "NSET" => self.deck.sets.nodes.entry(name),
            _ => self.deck.sets.elements.entry(name),
        };
        if let Some(of) = keyword.get("ELSET").filter(|_| key == "NSET") {
            set.push((Member::NodesOf(of.to_string()), keyword.place));
            return self.skip();
        }
        while let Some(line) = self.source.next_data()? {
            let mut fields = fields(&self.source, keyword, line);
            if keyword.has("GENERATE") {
                set.push((range(&mut fields)?, line.place));
                continue;
            }
            while !fields.is_at_end() {
                set.push((Member::Of(target(&mut fields)?), line.place));
            }
        }
        Ok(())
    }

    pub(super) fn surface(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["NAME", "TYPE", "INTERNAL"])?;
        let name = keyword.require(files, "NAME")?;
        let of_nodes = keyword.choice(files, "TYPE", &["ELEMENT", "NODE"])? == "NODE";
        if self.deck.sets.surfaces.get(name).is_some() {
            return Err(keyword.error(
                files,
                format!("a second surface {name}; rename one of them"),
            ));
        }
        let surface = self.deck.sets.surfaces.entry(name);
        while let Some(line) = self.source.next_data()? {
            let mut fields = fields(&self.source, keyword, line);
            let on = target(&mut fields)?;
            let part = if of_nodes {
                // A weight may follow, which is not used.
                SurfacePart::OfNodes(on)
            } else if fields.is_at_end() {
                SurfacePart::Free(on)
            } else {
                SurfacePart::Face(on, face(&mut fields, b'S')?)
            };
            surface.push((part, line.place));
        }
        Ok(())
    }
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
fn read_nodes(source: &mut DeckLines, keyword: &Keyword, nodes: &mut Nodes) -> Result<()> {
    while let Some(line) = source.next_data()? {
        let mut fields = fields(source, keyword, line);
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
        nodes.places.push(line.place);
    }
    Ok(())
}

/// Reads element numbers and their nodes, which continue in the next line if a line ends with a
/// comma.
fn read_elements(
    source: &mut DeckLines,
    keyword: &Keyword,
    element_type: ElementType,
    elements: &mut DeckElements,
    instances: &Instances,
) -> Result<()> {
    let n = element_type.shape.n_nodes();
    if elements.offsets.is_empty() {
        elements.offsets.push(0);
    }
    while let Some(line) = source.next_data()? {
        let mut nodes = [0; MAX_NODES];
        let mut at: Line = line;
        let mut of_line = fields(source, keyword, at);
        let label = of_line.label("the element number")?;
        let mut read = 0;
        loop {
            while read < n && !of_line.is_at_end() {
                nodes[read] = of_line.label("a node number")?;
                read += 1;
            }
            of_line.end()?;
            if read == n {
                break;
            }
            let label = instances.shown(label);
            let why = format!("element {label} has {read} nodes, {n} of them are needed");
            let error = of_line.place.error(why);
            if !of_line.ends_with_comma() {
                return Err(error);
            }
            at = source.next_data()?.ok_or(error)?;
            of_line = fields(source, keyword, at);
        }
        elements.labels.push(label);
        elements.types.push(element_type);
        elements.nodes.extend_from_slice(&nodes[..n]);
        elements.offsets.push(elements.nodes.len());
        elements.places.push(line.place);
    }
    Ok(())
}
