//! Fields of a scene on its mesh: numbers, formulas of the position, values at nodes.

use crate::element::FacetPoint;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, node_values};
use crate::number::exact;
use crate::scene::{Field, Scene};
use crate::space::{Vector, in_words};
use std::collections::HashMap;
use std::path::Path;

/// A field together with the mesh on which it is evaluated.
pub(super) struct OnMesh<'a> {
    mesh: &'a Mesh,
    /// Name of the field for messages.
    name: &'static str,
    values: FieldValues<'a>,
}

enum FieldValues<'a> {
    Uniform(f64),
    Formula(Box<dyn Fn(Vector) -> f64 + Send + Sync + 'a>),
    Nodal { path: String, at: Vec<Option<f64>> },
}

impl<'a> OnMesh<'a> {
    /// Reads the field `name` of a scene on its mesh.
    ///
    /// # Errors
    /// `Input` if a formula is invalid, or if a file of values cannot be read or belongs to another
    /// mesh.
    pub fn new(
        field: &'a Field,
        name: &'static str,
        scene: &Scene,
        mesh: &'a Mesh,
    ) -> Result<Self> {
        let values = match field {
            Field::Uniform(value) => FieldValues::Uniform(*value),
            Field::Nodal(of) => {
                let path = scene.beside(&of.file);
                FieldValues::Nodal {
                    at: nodal(&path, name, mesh)?,
                    path: path.display().to_string(),
                }
            }
            Field::Formula(_) => {
                let function = field.function(scene.kind).map_err(Error::input)?;
                FieldValues::Formula(Box::new(function))
            }
        };
        Ok(OnMesh { mesh, name, values })
    }

    /// Value of the field at a node.
    ///
    /// # Errors
    /// `Input` naming the node, if the formula is not finite or the file has no value.
    pub fn at_node(&self, node: usize) -> Result<f64> {
        let label = || {
            let (label, place) = (self.mesh.node_label(node), self.mesh.place(node));
            format!("node {label} at {place}")
        };
        match &self.values {
            FieldValues::Uniform(value) => Ok(*value),
            FieldValues::Formula(of) => self.finite(of(self.mesh.point(node)), label),
            FieldValues::Nodal { path, at } => at[node].ok_or_else(|| {
                Error::input(format!(
                    "{path} has no value of {}: is the file of another mesh?",
                    label()
                ))
            }),
        }
    }

    /// Value of the field at a point of a facet with these nodes: the value of the formula at the
    /// point, or the values at the nodes interpolated by the shape functions.
    ///
    /// # Errors
    /// Errors of [`at_node`](Self::at_node); for a formula the message names the point.
    pub fn at_point(&self, nodes: &[usize], point: &FacetPoint) -> Result<f64> {
        match &self.values {
            FieldValues::Uniform(value) => Ok(*value),
            FieldValues::Formula(of) => self.finite(of(point.position), || {
                let place = in_words(point.position.map(rounded), self.mesh.dimension);
                let label = nodes.first().map_or(0, |node| self.mesh.node_label(*node));
                format!("{place}, a point of the facet of node {label}")
            }),
            FieldValues::Nodal { .. } => {
                let terms = nodes.iter().zip(point.values);
                terms
                    .map(|(node, share)| Ok(share * self.at_node(*node)?))
                    .sum()
            }
        }
    }

    fn finite(&self, value: f64, place: impl Fn() -> String) -> Result<f64> {
        if value.is_finite() {
            return Ok(value);
        }
        let name = self.name;
        Err(Error::input(format!(
            "the {name} at {} is {value}: the formula must be finite there",
            place()
        )))
    }

    /// Value at a node, refused if it is below zero.
    ///
    /// # Errors
    /// `Input` naming the node; `instead` says in the message what to give in place of the value.
    pub fn not_negative(&self, node: usize, instead: &str) -> Result<f64> {
        let value = self.at_node(node)?;
        if value >= 0.0 {
            return Ok(value);
        }
        Err(Error::input(format!(
            "the {} at node {} at {} is {}, which is negative; {instead}",
            self.name,
            self.mesh.node_label(node),
            self.mesh.place(node),
            exact(value)
        )))
    }
}

/// Rounds a coordinate to seven significant digits, which drops its round-off.
fn rounded(coordinate: f64) -> f64 {
    format!("{coordinate:.6e}").parse().unwrap_or(coordinate)
}

/// Reads values by node from a file, refusing nodes that the mesh does not have.
fn nodal(path: &Path, name: &str, mesh: &Mesh) -> Result<Vec<Option<f64>>> {
    let given = node_values::read(path)?;
    let index: HashMap<u64, usize> = (0..mesh.n_nodes())
        .map(|node| (mesh.node_label(node), node))
        .collect();
    let mut out = vec![None; mesh.n_nodes()];
    for (label, value) in given {
        let path = path.display();
        let Some(&node) = index.get(&label) else {
            return Err(Error::input(format!(
                "{path} has a value of node {label}, which is not there: is the file of another \
                 mesh?"
            )));
        };
        if !value.is_finite() {
            return Err(Error::input(format!(
                "{path} has {value} as the {name} of node {label}"
            )));
        }
        out[node] = Some(value);
    }
    Ok(out)
}
