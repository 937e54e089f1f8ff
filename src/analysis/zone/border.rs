//! How finely a plastic zone is measured: by the volumes of Gauss points.
//!
//! The border of what has yielded lies between points that have and points that have not. Of an
//! element with `n` points in `D` dimensions a layer of them takes up the share `n^(-1/D)`. Where
//! the border passes from one layer to the next, the size of the zone changes by the volume of a
//! layer all along it; two meshes that agree better do so by accident.

use crate::mesh::{Facet, Mesh};
use crate::model::Model;
use std::collections::BTreeMap;

/// An element in which points have yielded.
pub(in crate::analysis) struct Yielded {
    pub(in crate::analysis) element: usize,
    /// Whether all its points have.
    pub(super) wholly: bool,
    /// Volume of a layer of its points.
    pub(in crate::analysis) layer: f64,
}

impl Yielded {
    /// An element of a volume, `yielded` of whose `points` in `dimension` dimensions have yielded.
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

/// Volume of a layer of points along the border of the zone, ascending elements given: in elements
/// that it passes through, and in those that have a facet in common with one that may yield and has
/// not.
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

/// The nodes of each facet, ascending.
fn facets(mesh: &Mesh, element: usize) -> impl Iterator<Item = Vec<usize>> + '_ {
    (0..mesh.shapes[element].n_facets()).map(move |local| {
        let mut nodes: Vec<usize> = mesh.facet_nodes(Facet { element, local }).collect();
        nodes.sort_unstable();
        nodes
    })
}
