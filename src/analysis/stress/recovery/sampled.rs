//! The points at which the stress of an element is sampled.

use crate::analysis::stress::layers::Layers;
use crate::analysis::stress::neighbours::Neighbours;
use crate::element::{Components, Kernel, Lanes, Sampling};
use crate::model::Model;
use crate::space::Vector;
use serde::{Deserialize, Serialize};

/// Choice of the points at which the stress is watched for first yield.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Watched {
    /// Between superconvergent points, on the polynomials through them.
    #[default]
    Recovered,
    /// At the Gauss points of the elements, where the material yields. On a mesh that is too coarse
    /// for the polynomials, Gauss points may be beyond yield earlier.
    GaussPoints,
}

/// An element with its samples. They lie at its superconvergent points, on either side of the
/// middle across a body that is one element thick, or at its Gauss points.
pub(super) struct Sampled<const D: usize, const S: usize, const P: usize, const N: usize> {
    pub(super) points: Sampling<D, S, P, N>,
    layers: Option<Layers>,
    /// Coordinates of the samples.
    pub(super) positions: Vec<[f64; D]>,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> Sampled<D, S, P, N> {
    /// Samples the element `e` of a list, with the neighbours in that list.
    pub(super) fn new(
        kernel: &Kernel<D, S, P, N>,
        model: &Model,
        (elements, neighbours): (&[usize], &Neighbours),
        e: usize,
        watched: Watched,
    ) -> Self {
        let (shape, nodes) = (model.mesh.shapes[e], model.mesh.element_coordinates(e));
        let places = |at: [Lanes<P>; D], n: usize| -> Vec<[f64; D]> {
            (0..n)
                .map(|g| at.each_ref().map(|lanes| lanes[g]))
                .collect()
        };
        let integration = model.mesh.integration_of(e);
        let gauss = || kernel.at_gauss_points((shape, integration), &nodes);
        let layers = match watched {
            Watched::GaussPoints => None,
            Watched::Recovered => Layers::of((&model.mesh, elements, neighbours), e, || {
                let points = gauss();
                let places = places(points.positions(&nodes), points.n_points());
                places.into_iter().map(in_space).collect()
            }),
        };
        let points = match layers.is_some() || watched == Watched::GaussPoints {
            true => gauss(),
            false => kernel.sampling(shape, &nodes),
        };
        let at = points.positions(&nodes);
        let positions = match &layers {
            Some(layers) => places(layers.means(&at), layers.n_samples()),
            None => places(at, points.n_points()),
        };
        Sampled {
            points,
            layers,
            positions,
        }
    }

    /// Values at the samples, from values at the points.
    pub(super) fn of_points(&self, at_points: &Components<S, P>) -> Components<S, P> {
        match &self.layers {
            Some(layers) => layers.means(at_points),
            None => *at_points,
        }
    }
}

/// A point in space; z = 0 in the plane.
pub(super) fn in_space<const D: usize>(x: [f64; D]) -> Vector {
    std::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0))
}
