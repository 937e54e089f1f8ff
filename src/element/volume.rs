//! Integration over the volume of elements: body forces.

use crate::shape::{Integration, MAX_NODES, Shape};
use crate::space::{Space, Vector};
use nalgebra::Matrix3;

/// An integration point in an element.
#[derive(Debug, Clone, Copy)]
pub struct VolumePoint {
    /// Values of the shape functions of the element's nodes.
    pub values: [f64; MAX_NODES],
    /// Quadrature weight times volume (area in the plane), times circumference if axisymmetric.
    pub weight: f64,
    /// Coordinates of the point.
    pub position: Vector,
}

/// Returns the Gauss points of an element with the given nodes and integration.
pub fn volume_points(
    space: Space,
    (shape, integration): (Shape, Integration),
    nodes: &[Vector],
) -> impl Iterator<Item = VolumePoint> {
    shape.rule(integration).iter().map(move |&(place, weight)| {
        let at = shape.functions(place);
        let mut position = [0.0; 3];
        let mut jacobian = Matrix3::<f64>::zeros();
        for ((value, slopes), x) in at.values.iter().zip(&at.gradients).zip(nodes) {
            for d in 0..3 {
                position[d] += value * x[d];
                (0..3).for_each(|k| jacobian[(k, d)] += slopes[k] * x[d]);
            }
        }
        if shape.dimension() == 2 {
            jacobian[(2, 2)] = 1.0;
        }
        VolumePoint {
            values: at.values,
            weight: weight * jacobian.determinant() * space.measure(position[0]),
            position,
        }
    })
}
