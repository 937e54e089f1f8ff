//! How finely a mesh resolves the size of a plastic zone: to the volumes of its Gauss points.
//!
//! The border of the plastic zone lies between points that have yielded and points that have not.
//! In an element with `n` points in `D` dimensions, one layer of points takes up the share
//! `n^(-1/D)` of the volume. If the border passes from one layer to the next, the size of the zone
//! changes by the volume of this layer along the whole border. Two meshes that agree more closely
//! do so by accident.

use crate::mesh::{Facet, Mesh};
use crate::model::Model;
use std::collections::BTreeMap;

/// An element in which points have yielded.
pub(in crate::analysis) struct Yielded {
    pub(in crate::analysis) element: usize,
    /// Whether all points of the element have yielded.
    pub(super) wholly: bool,
    /// Volume of one layer of the element's points.
    pub(in crate::analysis) layer: f64,
}

impl Yielded {
    /// An element of the given volume, with `yielded` of its `points` in `dimension` dimensions
    /// beyond yield.
    pub(in crate::analysis) fn new(
        element: usize,
        volume: f64,
        dimension: usize,
        [yielded, points]: [usize; 2],
    ) -> Self {
        Yielded {
            element,
            wholly: yielded == points,
            layer: volume * (points as f64).powf(-1.0 / dimension as f64),
        }
    }
}

/// Returns the volume of one layer of points along the border of the zone (its elements ascending).
/// Two sorts of elements count: those that have yielded in part, and those that have yielded wholly
/// but share a facet with an element that may yield and has not.
pub(in crate::analysis) fn layer(model: &Model, zone: &[Yielded]) -> f64 {
    let mesh = &model.mesh;
    let mut nodes = vec![false; mesh.n_nodes()];
    let mut at_facet: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    for (place, yielded) in zone
        .iter()
        .enumerate()
        .filter(|(_, yielded)| yielded.wholly)
    {
        for facet in facets(mesh, yielded.element) {
            facet.iter().for_each(|&node| nodes[node] = true);
            at_facet.insert(facet, place);
        }
    }
    let mut at_border: Vec<bool> = zone.iter().map(|yielded| !yielded.wholly).collect();
    for element in 0..mesh.n_elements() {
        let is_near = || mesh.nodes(element).iter().any(|&node| nodes[node as usize]);
        let has_yielded = || zone.binary_search_by_key(&element, |of| of.element).is_ok();
        if !model.may_yield[mesh.element_body[element] as usize] || !is_near() || has_yielded() {
            continue;
        }
        for facet in facets(mesh, element) {
            if let Some(&place) = at_facet.get(&facet) {
                at_border[place] = true;
            }
        }
    }
    let border = zone
        .iter()
        .zip(at_border)
        .filter(|(_, is_border)| *is_border);
    border.map(|(yielded, _)| yielded.layer).sum()
}

/// The facets of an element, each as its nodes in ascending order.
fn facets(mesh: &Mesh, element: usize) -> impl Iterator<Item = Vec<usize>> + '_ {
    (0..mesh.shapes[element].n_facets()).map(move |local| {
        let mut nodes: Vec<usize> = mesh.facet_nodes(Facet { element, local }).collect();
        nodes.sort_unstable();
        nodes
    })
}
