//! An element in the local axes of its nodes.

use crate::element::{MAX_FREEDOMS, Points, gauss_points, sampling};
use crate::model::{Model, Slot};

/// An element's Gauss points with B acting on its nodes' local freedoms, and what stands in each of them.
#[derive(Debug, Clone, Copy)]
pub struct LocalElement {
    /// Gauss points; columns of B in local axes.
    pub points: Points,
    /// Slot of each element freedom.
    pub slots: [Slot; MAX_FREEDOMS],
}

/// The element at its Gauss points.
pub fn local_element(model: &Model, element: usize) -> LocalElement {
    let x = model.element_coordinates(element);
    let shape = model.mesh.shapes[element];
    turned(model, element, gauss_points(model.kind, shape, &x))
}

impl LocalElement {
    /// Gauss points of an element in global axes.
    pub fn points_of(model: &Model, element: usize) -> Points {
        let x = model.element_coordinates(element);
        gauss_points(model.kind, model.mesh.shapes[element], &x)
    }

    /// The points of an element where stress is most accurate, in global axes.
    pub fn samples_of(model: &Model, element: usize) -> Points {
        let x = model.element_coordinates(element);
        sampling(model.kind, model.mesh.shapes[element], &x)
    }

    /// The element at the points where stress is most accurate.
    pub fn sampled(model: &Model, element: usize) -> Self {
        let x = model.element_coordinates(element);
        turned(
            model,
            element,
            sampling(model.kind, model.mesh.shapes[element], &x),
        )
    }
}

fn turned(model: &Model, element: usize, mut points: Points) -> LocalElement {
    let mut slots = [Slot::Fixed; MAX_FREEDOMS];
    for (i, &node) in model.mesh.nodes(element).iter().enumerate() {
        let node = node as usize;
        slots[2 * i..2 * i + 2].copy_from_slice(&model.freedoms.slots[node]);
        let [a, b] = model.freedoms.local(node);
        if a != [1.0, 0.0] {
            points.turn(i, a, b);
        }
    }
    LocalElement { points, slots }
}
