//! Nodes, elements, node sets and surfaces from arrays.

use super::ModelBuilder;
use crate::error::{Error, Result};
use crate::index::Index;
use crate::mesh::{Curve, Facet, Shape, Surface};
use crate::shape::MAX_NODES;
use crate::space::{Vector, difference, in_words, length};
use std::collections::BTreeMap;

impl ModelBuilder {
    /// Number of coordinates of each node.
    pub fn dimension(&self) -> usize {
        self.mesh.dimension
    }

    /// Number of nodes added so far.
    pub fn n_nodes(&self) -> usize {
        self.mesh.n_nodes()
    }

    /// Number of elements added so far.
    pub fn n_elements(&self) -> usize {
        self.mesh.n_elements()
    }

    /// Nodes of a set or surface with their coordinates; empty if there is no such name.
    pub fn set_nodes(&self, name: &str) -> Vec<(usize, Vector)> {
        let nodes = self.mesh.set_nodes(name).unwrap_or_default();
        let placed = nodes.into_iter().map(|node| (node, self.mesh.point(node)));
        placed.collect()
    }

    /// Checks that a node exists and returns its index; `what` names it in a message.
    ///
    /// # Errors
    /// An index of no node.
    pub fn node<I: Index>(&self, what: impl Fn() -> String, node: I) -> Result<usize> {
        let n = self.n_nodes();
        node.below(n).ok_or_else(|| {
            Error::input(format!(
                "{} is node {node}, but there are {n} nodes (0 to {}); give the nodes first",
                what(),
                n.saturating_sub(1)
            ))
        })
    }

    /// Adds nodes by their coordinates, node by node: `n x 2` values, or `n x 3` for a solid; (r,
    /// z) in an axisymmetric model.
    ///
    /// # Errors
    /// A number of values that is not a multiple of the dimension; a value that is not finite, by
    /// node.
    pub fn nodes(&mut self, coordinates: &[f64]) -> Result<&mut Self> {
        let each = self.mesh.dimension;
        if !coordinates.len().is_multiple_of(each) {
            return Err(Error::input(format!(
                "{} coordinates were given: {} for each node are needed",
                coordinates.len(),
                if each == 2 { "two" } else { "three" }
            )));
        }
        let before = self.n_nodes();
        if let Some(at) = coordinates.iter().position(|c| !c.is_finite()) {
            return Err(Error::input(format!(
                "node {}: coordinate {} is {}",
                before + at / each,
                ["x", "y", "z"][at % each],
                coordinates[at]
            )));
        }
        if u32::try_from(before + coordinates.len() / each).is_err() {
            return Err(Error::input(format!(
                "{} nodes are more than can be numbered",
                before + coordinates.len() / each
            )));
        }
        self.mesh.coordinates.extend_from_slice(coordinates);
        Ok(self)
    }

    /// Adds elements of one shape and body, given by the nodes of one element after the other, in
    /// the order of [`Shape`].
    ///
    /// # Errors
    /// A number of indices that is not a multiple of the shape's nodes; an index of no node, by
    /// element.
    pub fn elements<I: Index>(
        &mut self,
        shape: Shape,
        body: &str,
        connectivity: &[I],
    ) -> Result<&mut Self> {
        let (each, n_nodes) = (shape.n_nodes(), self.n_nodes());
        if shape.dimension() != self.mesh.dimension {
            return Err(Error::input(format!(
                "body `{body}`: a {} is no element of a {} model",
                shape.name(),
                self.scene.kind.name()
            )));
        }
        if !connectivity.len().is_multiple_of(each) {
            return Err(Error::input(format!(
                "body `{body}`: {} node indices are no multiple of the {each} nodes of a {}",
                connectivity.len(),
                shape.name()
            )));
        }
        if let Some(at) = connectivity.iter().position(|n| n.below(n_nodes).is_none()) {
            return Err(Error::input(format!(
                "element {} (body `{body}`): node {} is {}, but there are {n_nodes} nodes (0 to \
                 {}); give the nodes first",
                self.n_elements() + at / each,
                at % each,
                connectivity[at],
                n_nodes.saturating_sub(1)
            )));
        }
        let number = match self.mesh.bodies.iter().position(|b| b == body) {
            Some(number) => number,
            None => {
                self.mesh.bodies.push(body.to_string());
                self.mesh.bodies.len() - 1
            }
        };
        for nodes in connectivity.chunks_exact(each) {
            let mut own = [0u32; MAX_NODES];
            for (own, &node) in own.iter_mut().zip(nodes) {
                // The index is below the number of nodes, which `nodes` keeps within u32.
                *own = node.below(n_nodes).unwrap_or_default() as u32;
            }
            self.mesh.push_element(shape, number, &own[..each]);
        }
        Ok(self)
    }

    /// Adds a named set of nodes.
    ///
    /// # Errors
    /// An empty set, an index of no node, a name that is already taken.
    pub fn node_set<I: Index>(&mut self, name: &str, nodes: &[I]) -> Result<&mut Self> {
        self.is_new(name)?;
        let mut sorted = self.known_nodes(name, nodes)?;
        sorted.sort_unstable();
        sorted.dedup();
        self.mesh.node_sets.insert(name.to_string(), sorted);
        Ok(self)
    }

    /// Adds a named surface by the element and the local number of each facet ([`Shape::facet`]):
    /// in the plane, facet k lies between corners k and k + 1.
    ///
    /// # Errors
    /// An empty surface, a facet of no element, a name that is already taken.
    pub fn surface<I: Index>(
        &mut self,
        name: &str,
        facets: impl IntoIterator<Item = (I, I)>,
    ) -> Result<&mut Self> {
        self.is_new(name)?;
        let n_elements = self.n_elements();
        let mut out = Vec::new();
        for (k, (element, local)) in facets.into_iter().enumerate() {
            let known = element.below(n_elements).ok_or_else(|| {
                Error::input(format!(
                    "surface `{name}`: facet {k} is of element {element}, but there are \
                     {n_elements} elements; give the elements first"
                ))
            })?;
            let shape = self.mesh.shapes[known];
            let local = local.below(shape.n_facets()).ok_or_else(|| {
                Error::input(format!(
                    "surface `{name}`: facet {k} is facet {local} of element {element}, a {}: it \
                     has {}",
                    shape.name(),
                    shape.n_facets()
                ))
            })?;
            out.push(Facet {
                element: known,
                local,
            });
        }
        self.keep_surface(name, out)
    }

    /// Adds a named surface by its nodes, mid-side nodes included. The surface consists of all
    /// boundary facets that have no other nodes than the given ones.
    ///
    /// # Errors
    /// A node that belongs to no such facet, an index of no node, a name that is already taken.
    pub fn surface_of_nodes<I: Index>(&mut self, name: &str, nodes: &[I]) -> Result<&mut Self> {
        self.is_new(name)?;
        let nodes = self.known_nodes(name, nodes)?;
        let mut among = vec![false; self.n_nodes()];
        for &node in &nodes {
            among[node] = true;
        }
        // A facet between two elements is found twice.
        let mut found: BTreeMap<Vec<usize>, Option<Facet>> = BTreeMap::new();
        for element in 0..self.n_elements() {
            for local in 0..self.mesh.shapes[element].n_facets() {
                let facet = Facet { element, local };
                if !self.mesh.facet_nodes(facet).all(|n| among[n]) {
                    continue;
                }
                let n = self.mesh.facet_corners(facet);
                let mut corners: Vec<usize> = self.mesh.facet_nodes(facet).take(n).collect();
                corners.sort_unstable();
                found
                    .entry(corners)
                    .and_modify(|kept| *kept = None)
                    .or_insert(Some(facet));
            }
        }
        let facets: Vec<Facet> = found.into_values().flatten().collect();
        for &facet in &facets {
            for node in self.mesh.facet_nodes(facet) {
                among[node] = false;
            }
        }
        if let Some(node) = nodes.into_iter().find(|&n| among[n]) {
            return Err(Error::input(format!(
                "surface `{name}`: node {node} belongs to no {} of the boundary whose nodes are \
                 all given; give {} of each and its mid-side nodes where it has some",
                if self.mesh.is_solid() { "face" } else { "edge" },
                if self.mesh.is_solid() {
                    "the corners"
                } else {
                    "both ends"
                },
            )));
        }
        self.keep_surface(name, facets)
    }

    /// Sets the exact shape of a surface, so that normals are exact at every node.
    ///
    /// # Errors
    /// No such surface; a node of the surface that is off a round shape by more than 1e-6 of its
    /// radius.
    pub fn curve(&mut self, surface: &str, curve: Curve) -> Result<&mut Self> {
        let nodes = self.mesh.set_nodes(surface).unwrap_or_default();
        for node in nodes {
            let x = self.mesh.point(node);
            let (Some((_, off)), Some((from, radius, _))) = (curve.nearest(x), curve.spine(x))
            else {
                continue;
            };
            if off.is_nan() || off > 1e-6 * radius {
                return Err(Error::input(format!(
                    "surface `{surface}`: node {node} is {} from {}, not {radius}",
                    length(difference(x, from)),
                    in_words(from, self.mesh.dimension)
                )));
            }
        }
        match self.mesh.surfaces.get_mut(surface) {
            Some(kept) => kept.curve = Some(curve),
            None => return Err(Error::input(format!("there is no surface `{surface}`"))),
        }
        Ok(self)
    }

    fn is_new(&self, name: &str) -> Result<()> {
        if self.mesh.node_sets.contains_key(name) || self.mesh.surfaces.contains_key(name) {
            return Err(Error::input(format!(
                "`{name}` is the name of a node set or surface already"
            )));
        }
        Ok(())
    }

    pub(super) fn known_nodes<I: Index>(&self, name: &str, nodes: &[I]) -> Result<Vec<usize>> {
        if nodes.is_empty() {
            return Err(Error::input(format!("`{name}` has no nodes")));
        }
        let nodes = nodes.iter().enumerate();
        nodes
            .map(|(at, &node)| self.node(|| format!("`{name}`: entry {at}"), node))
            .collect()
    }

    fn keep_surface(&mut self, name: &str, facets: Vec<Facet>) -> Result<&mut Self> {
        if facets.is_empty() {
            return Err(Error::input(format!("surface `{name}` has no facets")));
        }
        let surface = Surface {
            facets,
            curve: None,
        };
        self.mesh.surfaces.insert(name.to_string(), surface);
        Ok(self)
    }
}
