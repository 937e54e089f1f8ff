//! Nodes and elements of a `.frd` file.

use super::text;
use crate::mesh::{Mesh, Shape};
use crate::model::Model;
use std::io::{self, Write};

/// Largest number of nodes in a line.
const NODES_PER_LINE: usize = 10;

/// Nodes and elements in the ascending order of their numbers.
pub(super) struct Numbered {
    pub(super) nodes: Vec<usize>,
    elements: Vec<usize>,
    labels: Vec<u64>,
}

impl Numbered {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let labels: Vec<u64> = (0..mesh.n_nodes())
            .map(|node| mesh.node_label(node))
            .collect();
        let mut nodes: Vec<usize> = (0..mesh.n_nodes()).collect();
        nodes.sort_by_key(|&node| labels[node]);
        let mut elements: Vec<usize> = (0..mesh.n_elements()).collect();
        elements.sort_by_key(|&element| mesh.element_label(element));
        Numbered {
            nodes,
            elements,
            labels,
        }
    }

    /// Returns the number of a node.
    pub(super) fn label(&self, node: usize) -> u64 {
        self.labels[node]
    }
}

/// Returns the type of an element, and its nodes in the order of the file. In hexahedra and prisms
/// the mid-side nodes of the edges between base and top come before those of the top.
fn element_type(shape: Shape) -> (usize, &'static [usize]) {
    const IN_ORDER: [usize; 12] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
    const HEXAHEDRON: [usize; 20] = [
        0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15,
    ];
    const PRISM: [usize; 15] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11];
    let number = match shape {
        Shape::Hex8 => 1,
        Shape::Prism6 => 2,
        Shape::Tet4 => 3,
        Shape::Hex20 => 4,
        Shape::Prism15 => 5,
        Shape::Tet10 => 6,
        Shape::Tri3 => 7,
        Shape::Tri6 => 8,
        Shape::Quad4 => 9,
        Shape::Quad8 => 10,
    };
    match shape {
        Shape::Hex20 => (number, &HEXAHEDRON),
        Shape::Prism15 => (number, &PRISM),
        _ => (number, &IN_ORDER[..shape.n_nodes()]),
    }
}

/// Writes the mesh; `materials` are numbered from 1.
pub(super) fn write(
    out: &mut impl Write,
    model: &Model,
    numbered: &Numbered,
    materials: &[String],
) -> io::Result<()> {
    let mesh = &model.mesh;
    writeln!(out, "    2C{:30}{:38}", mesh.n_nodes(), 1)?;
    let mut line = String::new();
    for &node in &numbered.nodes {
        line.clear();
        mesh.point(node)
            .iter()
            .for_each(|x| text::number(*x, &mut line));
        writeln!(out, " -1{:10}{line}", numbered.label(node))?;
    }
    writeln!(out, " -3")?;
    writeln!(out, "    3C{:30}{:38}", mesh.n_elements(), 1)?;
    let of_bodies: Vec<usize> = (mesh.bodies.iter())
        .map(|body| material(model, body, materials))
        .collect();
    for &element in &numbered.elements {
        let (kind, order) = element_type(mesh.shapes[element]);
        let material = of_bodies[mesh.element_body[element] as usize];
        let label = mesh.element_label(element);
        writeln!(out, " -1{label:10}{kind:5}{:5}{material:5}", 0)?;
        let nodes = mesh.nodes(element);
        for some in order.chunks(NODES_PER_LINE) {
            write!(out, " -2")?;
            for &k in some {
                write!(out, "{:10}", numbered.label(nodes[k] as usize))?;
            }
            writeln!(out)?;
        }
    }
    writeln!(out, " -3")
}

/// Returns the number of a body's material.
fn material(model: &Model, body: &str, materials: &[String]) -> usize {
    let Some(body) = model.scene.bodies.get(body) else {
        return 1;
    };
    let is_it = |name: &String| name.eq_ignore_ascii_case(&body.material);
    materials.iter().position(is_it).unwrap_or(0) + 1
}
