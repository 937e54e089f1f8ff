//! Round surfaces, which slide along themselves if their body turns about their centre.

use super::Pair;
use super::motions::{FREE, Mode, Motions};
use super::pairs::mortar::roundness::true_shape;
use crate::mesh::{Curve, Mesh, Surface};
use crate::space::{Vector, along, difference, direction, length};
use std::collections::BTreeSet;

/// The surfaces of a mesh that are round.
pub(super) struct RoundSurfaces {
    surfaces: Vec<RoundSurface>,
}

struct RoundSurface {
    /// Nodes, each with the direction away from the surface's centre.
    nodes: Vec<(usize, Vector)>,
    /// Largest deviation of a facet from the round shape, over the radius.
    deviation: f64,
}

impl RoundSurfaces {
    pub(super) fn of(mesh: &Mesh) -> Self {
        let surfaces = mesh
            .surfaces
            .values()
            .filter_map(|surface| RoundSurface::of(mesh, surface, &true_shape(mesh, surface)?));
        RoundSurfaces {
            surfaces: surfaces.collect(),
        }
    }

    /// Largest work of a load on a mode, over the size of the load, that facets may cause because
    /// they are not exactly round: a load that is spread over them does not act exactly through the
    /// centre. Zero if no round surface slides along itself in the mode, to within the fraction
    /// `off` of the mode's largest entry.
    pub(super) fn work_of_facets(&self, motions: &Motions, mode: &Mode, off: f64) -> f64 {
        let sliding = self.sliding(motions, mode, off).into_iter();
        sliding.map(|s| s.deviation).fold(0.0, f64::max)
    }

    /// Whether all pairs whose gaps a mode changes are on round surfaces that slide along
    /// themselves in the mode, to within the fraction `off` of its largest entry. If these surfaces
    /// were round in every node and facet, nothing would hold the mode.
    pub(super) fn carry(&self, motions: &Motions, mode: &Mode, pairs: &[Pair], off: f64) -> bool {
        let sliding = self.sliding(motions, mode, off).into_iter();
        let nodes: BTreeSet<usize> = sliding.flat_map(|s| s.nodes.iter().map(|n| n.0)).collect();
        let mut holding = pairs
            .iter()
            .filter(|pair| motions.opening(mode, pair).abs() > FREE * mode.largest());
        !nodes.is_empty() && holding.all(|pair| pair.nodes().any(|node| nodes.contains(&node)))
    }

    /// The round surfaces that slide along themselves in a mode, to within the fraction `off` of
    /// its largest entry.
    fn sliding(&self, motions: &Motions, mode: &Mode, off: f64) -> Vec<&RoundSurface> {
        let moved = motions.moved(mode);
        let slides = |surface: &&RoundSurface| {
            surface.nodes.iter().all(|&(node, out)| {
                moved.contains(&motions.group_of_node[node])
                    && motions.along(mode, node, out, 0.0).abs() <= off * mode.largest()
            })
        };
        self.surfaces.iter().filter(slides).collect()
    }
}

impl RoundSurface {
    /// `None` for lines, planes and surfaces without facets.
    fn of(mesh: &Mesh, surface: &Surface, curve: &Curve) -> Option<Self> {
        let (mut nodes, mut deviation) = (Vec::new(), 0.0f64);
        for &facet in &surface.facets {
            let points: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
            let sum = points.iter().fold([0.0; 3], |sum, x| along(sum, 1.0, *x));
            let middle = sum.map(|s| s / points.len() as f64);
            let (_, radius, _) = curve.spine(middle)?;
            let reach = points.iter().map(|x| length(difference(*x, middle)));
            let half = reach.fold(0.0, f64::max) / radius;
            // A chord of half length `half`, in units of the radius, lies `half^2 / 2` below the
            // arc; a parabola through the middle node leaves about the square of this.
            let order = if mesh.shapes[facet.element].is_quadratic() {
                2
            } else {
                1
            };
            deviation = deviation.max((half * half / 2.0).powi(order));
            for node in mesh.facet_nodes(facet) {
                let x = mesh.point(node);
                let (center, ..) = curve.spine(x)?;
                nodes.push((node, direction(difference(x, center))));
            }
        }
        (!nodes.is_empty()).then_some(RoundSurface { nodes, deviation })
    }
}
