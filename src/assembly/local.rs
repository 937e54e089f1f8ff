//! Element matrices in the local axes of their nodes.

use crate::element::packed;
use crate::model::Model;

/// Turns an element's stiffness (packed lower triangle in global axes) into the local axes of its
/// nodes: `K <- R' K R`, the columns of `R` the axes.
pub(super) fn turn_stiffness(model: &Model, element: usize, stiffness: &mut [f64]) {
    let nodes = model.mesh.nodes(element);
    for (i, &node) in nodes.iter().enumerate() {
        let [a, b] = model.freedoms.local(node as usize);
        if a == [1.0, 0.0] {
            continue;
        }
        let (x, y) = (2 * i, 2 * i + 1);
        for k in (0..2 * nodes.len()).filter(|k| *k != x && *k != y) {
            let (at_x, at_y) = (packed(x, k), packed(y, k));
            let (along_x, along_y) = (stiffness[at_x], stiffness[at_y]);
            stiffness[at_x] = a[0] * along_x + a[1] * along_y;
            stiffness[at_y] = b[0] * along_x + b[1] * along_y;
        }
        let at = [packed(x, x), packed(x, y), packed(y, y)];
        let [xx, xy, yy] = at.map(|at| stiffness[at]);
        let product = |p: [f64; 2], q: [f64; 2]| {
            p[0] * (xx * q[0] + xy * q[1]) + p[1] * (xy * q[0] + yy * q[1])
        };
        stiffness[at[0]] = product(a, a);
        stiffness[at[1]] = product(a, b);
        stiffness[at[2]] = product(b, b);
    }
}
