//! Sets named by a body and a set of it: `body.set`.

use super::{Facet, Mesh, Surface};

impl Mesh {
    /// Defines the sets that the given names of the form `body.set` refer to: the part of an
    /// existing set or surface `set` that belongs to elements of the body `body`. Existing names
    /// are not changed; names that cannot be resolved are skipped, and are reported when they are
    /// looked up.
    pub(crate) fn name_parts<'n>(&mut self, names: impl IntoIterator<Item = &'n str>) {
        for name in names {
            if self.has_set(name) {
                continue;
            }
            let Some((body, set)) = self.body_and_set(name) else {
                continue;
            };
            if let Some(surface) = self.surfaces.get(set) {
                let is_own = |facet: &&Facet| self.element_body[facet.element] as usize == body;
                let facets: Vec<Facet> = surface.facets.iter().filter(is_own).copied().collect();
                if !facets.is_empty() {
                    let curve = surface.curve;
                    let part = Surface { facets, curve };
                    self.surfaces.insert(name.to_string(), part);
                }
            } else if let Some(nodes) = self.node_sets.get(set) {
                let is_own = self.nodes_of_body(body);
                let nodes: Vec<usize> = nodes.iter().copied().filter(|&n| is_own[n]).collect();
                if !nodes.is_empty() {
                    self.node_sets.insert(name.to_string(), nodes);
                }
            }
        }
    }

    /// Splits a name `body.set` into its body and set, if both exist.
    pub(crate) fn body_and_set<'n>(&self, name: &'n str) -> Option<(usize, &'n str)> {
        let mut bodies = self.bodies.iter().enumerate();
        bodies.find_map(|(index, body)| {
            let set = name.strip_prefix(body.as_str())?.strip_prefix('.')?;
            self.has_set(set).then_some((index, set))
        })
    }

    /// Names of the bodies of which a set or surface contains a part.
    pub(crate) fn bodies_of_set(&self, set: &str) -> Vec<&str> {
        let has_some = |body: usize| match self.surfaces.get(set) {
            Some(surface) => {
                let mut facets = surface.facets.iter();
                facets.any(|facet| self.element_body[facet.element] as usize == body)
            }
            None => {
                let is_own = self.nodes_of_body(body);
                let nodes = self.node_sets.get(set);
                nodes.is_some_and(|nodes| nodes.iter().any(|&node| is_own[node]))
            }
        };
        let bodies = self.bodies.iter().enumerate();
        let found = bodies.filter(|(body, _)| has_some(*body));
        found.map(|(_, name)| name.as_str()).collect()
    }

    fn has_set(&self, name: &str) -> bool {
        self.node_sets.contains_key(name) || self.surfaces.contains_key(name)
    }

    /// For each node, whether it belongs to an element of the body.
    fn nodes_of_body(&self, body: usize) -> Vec<bool> {
        let mut is_own = vec![false; self.n_nodes()];
        let own = (0..self.n_elements()).filter(|&e| self.element_body[e] as usize == body);
        for node in own.flat_map(|e| self.nodes(e)) {
            is_own[*node as usize] = true;
        }
        is_own
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    /// Two squares one above the other that share an edge, with a surface and a set that extend
    /// over both.
    fn mesh() -> Mesh {
        let mut mesh = Mesh {
            dimension: 2,
            coordinates: vec![0., 0., 1., 0., 1., 1., 0., 1., 1., 2., 0., 2.],
            bodies: vec!["low".to_string(), "low.er".to_string()],
            ..Mesh::default()
        };
        mesh.push_element(Shape::Quad4, 0, &[0, 1, 2, 3]);
        mesh.push_element(Shape::Quad4, 1, &[3, 2, 4, 5]);
        let side = |element| Facet { element, local: 1 };
        let both = vec![side(0), side(1)];
        let surface = |facets| Surface {
            facets,
            curve: None,
        };
        mesh.surfaces.insert("side".to_string(), surface(both));
        mesh.surfaces
            .insert("er.side".to_string(), surface(vec![side(0)]));
        mesh.node_sets.insert("left".to_string(), vec![0, 3, 5]);
        mesh.node_sets.insert("top".to_string(), vec![4, 5]);
        mesh.node_sets.insert("low.top".to_string(), vec![1]);
        mesh
    }

    #[test]
    fn a_set_of_a_body_is_its_part_in_that_body() {
        let mut mesh = mesh();
        let names = ["low.side", "low.er.side", "low.left", "low.er.left"];
        mesh.name_parts(names.into_iter().chain(["low.top", "low.er.top", "top"]));
        let elements = |name: &str| -> Vec<usize> {
            let facets = mesh.surfaces[name].facets.iter();
            facets.map(|facet| facet.element).collect()
        };
        assert_eq!(elements("low.side"), [0]);
        // If a name can be split in several ways, the first body counts.
        assert_eq!(elements("low.er.side"), [0]);
        assert_eq!(mesh.node_sets["low.left"], [0, 3]);
        assert_eq!(mesh.node_sets["low.er.left"], [3, 5]);
        // A set of the file with this full name takes precedence.
        assert_eq!(mesh.node_sets["low.top"], [1]);
        assert_eq!(mesh.node_sets["low.er.top"], [4, 5]);
        assert_eq!(mesh.node_sets.len(), 6);
    }

    #[test]
    fn what_there_is_not_stays_unknown() {
        let mut mesh = mesh();
        let before = mesh.set_names().len();
        mesh.name_parts(["upper.side", "low.sides", "low", "low.", ".side", ""]);
        assert_eq!(mesh.set_names().len(), before);
        mesh.node_sets.insert("tip".to_string(), vec![5]);
        mesh.name_parts(["low.tip"]);
        assert!(mesh.set_nodes("low.tip").is_none());
        assert_eq!(mesh.bodies_of_set("tip"), ["low.er"]);
        assert_eq!(mesh.bodies_of_set("side"), ["low", "low.er"]);
    }
}
