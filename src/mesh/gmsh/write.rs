//! Writing in version 2.2: one line per node and element, which all tools can read.

use super::kind::ElementUse;
use crate::mesh::Mesh;
use std::collections::BTreeSet;
use std::io::{Error, ErrorKind, Result, Write};

/// Writes a mesh as Gmsh `.msh` 2.2 ASCII. Bodies, surfaces and node sets become physical groups.
/// Nodes and elements have the numbers that the user knows, and coordinates can be read back bit
/// for bit. The exact [`Curve`](crate::mesh::Curve) of a surface has no place in the format and is
/// lost.
///
/// # Errors
/// The errors of `out`, and `InvalidInput` for a name with a double quote or a line end, which the
/// format cannot hold.
pub fn write(mesh: &Mesh, out: &mut dyn Write) -> Result<()> {
    let mut out = std::io::BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat")?;
    write_names(mesh, &mut out)?;
    writeln!(out, "$Nodes\n{}", mesh.n_nodes())?;
    for node in 0..mesh.n_nodes() {
        let [x, y, z] = mesh.point(node);
        write!(out, "{} {x:?} {y:?} ", mesh.node_label(node))?;
        match mesh.is_solid() {
            true => writeln!(out, "{z:?}")?,
            false => writeln!(out, "0")?,
        }
    }
    writeln!(out, "$EndNodes")?;
    write_elements(mesh, &mut out)?;
    out.flush()
}

fn write_names(mesh: &Mesh, out: &mut dyn Write) -> Result<()> {
    let n = mesh.bodies.len() + mesh.surfaces.len() + mesh.node_sets.len();
    writeln!(out, "$PhysicalNames\n{n}")?;
    let sets = mesh
        .node_sets
        .keys()
        .enumerate()
        .map(|(k, name)| (0, k, name));
    let surfaces = mesh
        .surfaces
        .keys()
        .enumerate()
        .map(|(k, name)| (mesh.dimension - 1, k, name));
    let bodies = mesh.bodies.iter().enumerate();
    let bodies = bodies.map(|(k, name)| (mesh.dimension, k, name));
    for (dimension, k, name) in sets.chain(surfaces).chain(bodies) {
        if name.contains(['"', '\n', '\r']) {
            return Err(Error::new(
                ErrorKind::InvalidInput,
                format!("the name {name:?} cannot be written to a Gmsh file: rename it"),
            ));
        }
        writeln!(out, "{dimension} {} \"{name}\"", k + 1)?;
    }
    writeln!(out, "$EndPhysicalNames")
}

fn write_elements(mesh: &Mesh, out: &mut dyn Write) -> Result<()> {
    let n_elements = mesh.n_elements();
    let n_lines: usize = mesh.surfaces.values().map(|s| s.facets.len()).sum();
    let n_points: usize = mesh.node_sets.values().map(Vec::len).sum();
    writeln!(out, "$Elements\n{}", n_elements + n_lines + n_points)?;
    let mut largest = 0u64;
    for element in 0..n_elements {
        let label = mesh.element_label(element);
        largest = largest.max(label);
        let kind = ElementUse::Element(mesh.shapes[element]);
        let group = mesh.element_body[element] + 1;
        write!(out, "{label} {} 2 {group} {group}", kind.type_number())?;
        let own = mesh.nodes(element);
        let order = mesh.shapes[element].reference().gmsh_order;
        for place in 0..own.len() {
            // The element's node at this position in Gmsh's order.
            let node = order.iter().position(|&p| p == place).map_or(0, |k| own[k]);
            write!(out, " {}", mesh.node_label(node as usize))?;
        }
        writeln!(out)?;
    }
    // Facets and points get numbers above the largest element number, or numbers that no element
    // uses if the range above is too small.
    let needed = (n_lines + n_points) as u64;
    let mut numbers: Box<dyn Iterator<Item = u64>> = match largest.checked_add(needed) {
        Some(last) => Box::new(largest + 1..=last),
        None => {
            let taken: BTreeSet<u64> = (0..n_elements).map(|e| mesh.element_label(e)).collect();
            Box::new((1..u64::MAX).filter(move |number| !taken.contains(number)))
        }
    };
    let mut next = || numbers.next().unwrap_or(u64::MAX);
    for (group, surface) in (1..).zip(mesh.surfaces.values()) {
        for &facet in &surface.facets {
            let number = next();
            let kind = ElementUse::Line(mesh.facet_reference(facet));
            write!(out, "{number} {} 2 {group} {group}", kind.type_number())?;
            for node in mesh.facet_nodes(facet) {
                write!(out, " {}", mesh.node_label(node))?;
            }
            writeln!(out)?;
        }
    }
    for (group, nodes) in (1..).zip(mesh.node_sets.values()) {
        for &node in nodes {
            let number = next();
            let kind = ElementUse::Point.type_number();
            writeln!(
                out,
                "{number} {kind} 2 {group} {group} {}",
                mesh.node_label(node)
            )?;
        }
    }
    writeln!(out, "$EndElements")
}
