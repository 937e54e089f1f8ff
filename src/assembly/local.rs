//! Element matrices in the local axes of their nodes.

use crate::element::packed;
use crate::model::Model;

/// Puts an element's stiffness (packed lower triangle in global axes) in terms of the control
/// points of its nodes ([`crate::model::ContactBasis`]): `K <- B' K B`.
pub(super) fn share_stiffness(model: &Model, element: usize, stiffness: &mut [f64]) {
    let nodes = model.mesh.nodes(element);
    let blends = model.freedoms.basis.of_element(nodes);
    if blends.is_empty() {
        return;
    }
    let per = model.freedoms.per_node;
    let n = per * nodes.len();
    let mut matrix = vec![0.0; n * n];
    // `B' K`, and then `B'` times its transpose.
    for pass in 0..2 {
        let was = matrix.clone();
        for i in 0..n {
            for j in 0..n {
                matrix[i * n + j] = match pass {
                    0 => stiffness[packed(i, j)],
                    _ => was[j * n + i],
                };
            }
        }
        for blend in &blends {
            blend.share_rows(per, n, &mut matrix);
        }
    }
    for i in 0..n {
        for j in 0..=i {
            stiffness[packed(i, j)] = matrix[i * n + j];
        }
    }
}

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

/// Adds rows for what displacements of an element follow ([`crate::model::Followed`]): of
/// `u_i = sum c_ik v_k` the stiffness `C' K C` on the `v`, and `C' K` beside the rest.
pub(super) fn follow_stiffness(model: &Model, element: usize, stiffness: &mut [f64]) {
    let followed = model.followed_by(element);
    let own = model.freedoms.per_node * model.mesh.nodes(element).len();
    let rows = followed.slots.len();
    // `C' K` on all of the element's own displacements.
    let mut shared = vec![0.0; rows * own];
    for &(i, k, c) in &followed.parts {
        for j in 0..own {
            shared[k * own + j] += c * stiffness[packed(i, j)];
        }
    }
    for k in 0..rows {
        for j in 0..own {
            stiffness[packed(own + k, j)] = shared[k * own + j];
        }
        for l in 0..=k {
            stiffness[packed(own + k, own + l)] = 0.0;
        }
    }
    for &(i, l, c) in &followed.parts {
        for k in l..rows {
            stiffness[packed(own + k, own + l)] += c * shared[k * own + i];
        }
    }
}
