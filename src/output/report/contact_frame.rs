//! The position of the contact of solids, and the axes along which it is viewed.

use super::window::Window;
use crate::model::{Model, Pair};
use crate::output::labels::{Labels, labelled};
use crate::results::State;
use crate::space::{Vector, along, cross, direction, dot, unit};

/// The contact that carries the largest force: its middle, normal and axes.
pub(super) struct ContactFrame {
    /// Index of the contact.
    pub contact: usize,
    /// Middle of the patch.
    pub center: Vector,
    /// Mean normal, from the second body to the first.
    pub normal: Vector,
    /// The normal or its opposite, whichever has a positive largest component.
    pub up: Vector,
    /// Directions across the normal: those of the patch's half axes.
    pub axes: [Vector; 2],
    /// Largest half axes of all states along `axes`.
    pub reach: [f64; 2],
}

/// Relative difference of the half axes above which their directions are meaningful.
const ROUND: f64 = 0.05;
/// Ratio of length to width that is assumed for a patch without end.
const ENDLESS: f64 = 2.0;

impl ContactFrame {
    /// Returns the frame of the contact over some states; `None` if no patch carries force.
    pub(super) fn new(model: &Model, states: &[State]) -> Option<Self> {
        let patches = || states.iter().flat_map(|state| &state.patches);
        let strongest = patches().max_by(|a, b| a.force.total_cmp(&b.force))?;
        let contact = strongest.contact;
        let pairs = &model.pairs[model.contacts.get(contact)?.range.clone()];
        let sum = |sum, pair: &Pair| along(sum, pair.area, pair.normal);
        let normal = direction(pairs.iter().fold([0.0; 3], sum));
        // The axis is the global one that lies most nearly in the plane, unless the patch has a
        // direction of its own.
        let [long, short] = strongest.semi_axes;
        let global = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))?;
        let first = match long - short > ROUND * long {
            true => strongest.direction,
            false => unit(global),
        };
        let first = positive(direction(along(first, -dot(first, normal), normal)));
        let axes = [first, positive(cross(normal, first))];
        let reach =
            patches()
                .filter(|patch| patch.contact == contact)
                .fold([0.0f64; 2], |reach, patch| {
                    let [long, short] = patch.semi_axes;
                    let long = long.min(ENDLESS * short);
                    // Half the extent of a rotated ellipse along an axis.
                    [0, 1].map(|d| {
                        let (c, s) = (
                            dot(axes[d], patch.direction),
                            dot(axes[d], cross(normal, patch.direction)),
                        );
                        reach[d].max((long * c).hypot(short * s))
                    })
                });
        Some(ContactFrame {
            contact,
            center: strongest.centroid,
            normal,
            up: positive(normal),
            axes,
            reach,
        })
    }

    /// Returns the surroundings of the contact in the plane of one of the axes and the normal.
    pub(super) fn window(&self, model: &Model, axis: usize, mirror: [bool; 2]) -> Option<Window> {
        let axes = [self.axes[axis], self.up];
        let mesh = &model.mesh;
        let in_plane = |x: Vector| axes.map(|axis| dot(axis, x));
        let all = Window::round((0..mesh.n_nodes()).map(|n| in_plane(mesh.point(n))))?;
        let ends = [-1.0, 1.0].map(|s| in_plane(along(self.center, s * self.reach[axis], axes[0])));
        let patch = Window::round(ends.into_iter())?;
        Some(patch.surroundings(
            all.mirrored(mirror),
            model.contacts[self.contact].facet_length,
        ))
    }

    /// Returns the label of an axis: the name of the global axis if it is one.
    pub(super) fn label(axis: Vector, labels: &Labels) -> String {
        labelled(
            global(axis).map_or("along the contact", |d| ["x", "y", "z"][d]),
            labels.length(),
        )
    }
}

/// Returns the coordinate axis along which a direction points; `None` if there is none.
pub(super) fn global(axis: Vector) -> Option<usize> {
    (0..3).find(|&d| dot(axis, unit(d)).abs() > 1.0 - 1e-9)
}

/// Returns the direction or its opposite, whichever has a positive largest component, rounded to a
/// coordinate axis if it points along one.
fn positive(axis: Vector) -> Vector {
    if let Some(d) = global(axis) {
        return unit(d);
    }
    let largest = axis
        .iter()
        .fold(0.0f64, |m, a| if a.abs() > m.abs() { *a } else { m });
    axis.map(|a| a * largest.signum())
}
