//! Element matrices in the local axes of their nodes.

use crate::element::packed;
use crate::model::Model;

/// Turns an element's stiffness (packed lower triangle in global axes) into the local axes of its
/// nodes: `K <- R' K R`, the columns of `R` the axes.
pub(super) fn turn_stiffness(model: &Model, element: usize, stiffness: &mut [f64]) {
    let per = model.freedoms.per_node;
    let nodes = model.mesh.nodes(element);
    for (i, &node) in nodes.iter().enumerate() {
        if !model.freedoms.is_turned(node as usize) {
            continue;
        }
        let axes = model.freedoms.local(node as usize);
        let own = per * i..per * (i + 1);
        for k in (0..per * nodes.len()).filter(|k| !own.contains(k)) {
            let mut turned = [0.0; 3];
            for (turned, axis) in turned.iter_mut().zip(&axes).take(per) {
                let terms = own.clone().zip(axis);
                *turned = terms.map(|(row, a)| a * stiffness[packed(row, k)]).sum();
            }
            for (row, turned) in own.clone().zip(turned) {
                stiffness[packed(row, k)] = turned;
            }
        }
        let mut block = [[0.0; 3]; 3];
        for a in 0..per {
            for b in 0..per {
                block[a][b] = stiffness[packed(own.start + a, own.start + b)];
            }
        }
        for a in 0..per {
            for b in 0..=a {
                let along = |row: &[f64; 3]| -> f64 {
                    row.iter()
                        .zip(axes[a])
                        .take(per)
                        .map(|(k, axis)| k * axis)
                        .sum()
                };
                let terms = block.iter().zip(axes[b]).take(per);
                stiffness[packed(own.start + a, own.start + b)] =
                    terms.map(|(row, axis)| axis * along(row)).sum();
            }
        }
    }
}
