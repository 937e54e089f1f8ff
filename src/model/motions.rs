//! Rigid motions of the bodies, and which of them supports and pairs leave free.

use super::{Freedoms, LoadCase, Pair, Slot};
use crate::mesh::Mesh;
use crate::scene::Kind;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::collections::BTreeMap;

/// Singular values below this, relative to the largest, are free motions.
const FREE: f64 = 1e-7;
/// A block of the motions that is definite by this much of its largest entry has none that is free: well above the square of
/// [`FREE`] and the round-off of a factorisation of some thousand rows.
const HELD: f64 = 1e-11;

/// Groups of bodies that share nodes move together: rigid motions are counted per group.
pub(super) struct Motions<'a> {
    kind: Kind,
    mesh: &'a Mesh,
    /// Group of each node.
    pub(super) group_of_node: Vec<usize>,
    center: Vec<[f64; 2]>,
    size: Vec<f64>,
    /// Names of the bodies of each group.
    pub(super) names: Vec<Vec<String>>,
}

impl<'a> Motions<'a> {
    pub(super) fn new(kind: Kind, mesh: &'a Mesh) -> Self {
        let n_bodies = mesh.bodies.len();
        let mut parent: Vec<usize> = (0..n_bodies).collect();
        let mut body_of_node = vec![usize::MAX; mesh.n_nodes()];
        for e in 0..mesh.n_elements() {
            let body = mesh.element_body[e] as usize;
            for &node in mesh.nodes(e) {
                let other = body_of_node[node as usize];
                if other == usize::MAX {
                    body_of_node[node as usize] = body;
                } else if other != body {
                    let (a, b) = (root(&mut parent, other), root(&mut parent, body));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
        let roots: Vec<usize> = (0..n_bodies).map(|b| root(&mut parent, b)).collect();
        let mut index = vec![usize::MAX; n_bodies];
        let mut names: Vec<Vec<String>> = Vec::new();
        for body in 0..n_bodies {
            if index[roots[body]] == usize::MAX {
                index[roots[body]] = names.len();
                names.push(Vec::new());
            }
            names[index[roots[body]]].push(mesh.bodies[body].clone());
        }
        let group_of_node: Vec<usize> = body_of_node
            .iter()
            .map(|&b| if b == usize::MAX { 0 } else { index[roots[b]] })
            .collect();
        let mut low = vec![[f64::INFINITY; 2]; names.len()];
        let mut high = vec![[f64::NEG_INFINITY; 2]; names.len()];
        for (node, &group) in group_of_node.iter().enumerate() {
            for d in 0..2 {
                low[group][d] = low[group][d].min(mesh.point(node)[d]);
                high[group][d] = high[group][d].max(mesh.point(node)[d]);
            }
        }
        let center = low
            .iter()
            .zip(&high)
            .map(|(l, h)| [0.5 * (l[0] + h[0]), 0.5 * (l[1] + h[1])])
            .collect();
        let size = low
            .iter()
            .zip(&high)
            .map(|(l, h)| (h[0] - l[0]).hypot(h[1] - l[1]))
            .collect();
        Motions {
            kind,
            mesh,
            group_of_node,
            center,
            size,
            names,
        }
    }

    fn per_group(&self) -> usize {
        if self.kind == Kind::Axisymmetric {
            1
        } else {
            3
        }
    }

    /// Displacement along `axis` at a point of `group`, for each rigid motion of the group: along x, along y,
    /// rotation about the group's centre scaled to its size.
    fn row(&self, group: usize, x: [f64; 2], axis: [f64; 2]) -> Vec<f64> {
        if self.kind == Kind::Axisymmetric {
            return vec![axis[1]];
        }
        let (c, s) = (self.center[group], 2.0 / self.size[group]);
        vec![
            axis[0],
            axis[1],
            s * ((x[0] - c[0]) * axis[1] - (x[1] - c[1]) * axis[0]),
        ]
    }

    /// Motions that supports and (bilateral) pairs leave free: unit vectors, one entry per group and rigid motion.
    pub(super) fn free(&self, freedoms: &Freedoms, pairs: &[Pair]) -> Vec<DVector<f64>> {
        let per = self.per_group();
        let gram = self.gram(freedoms, pairs);
        let largest = gram.largest_diagonal().max(1.0);
        let mut free: Vec<Plain> = Vec::new();
        for block in gram.uncoupled(per) {
            // Most are held: that takes no more than a factorisation.
            if !gram.is_definite(&block, HELD * largest) {
                free.extend(plain(gram.null_vectors(&block, FREE * FREE * largest), per));
            }
        }
        free.sort_by_key(|motion| (motion.pivot % per, std::cmp::Reverse(motion.pivot)));
        free.into_iter().map(|motion| motion.vector).collect()
    }

    /// Sum of the squares of all conditions that supports and pairs put on the motions.
    fn gram(&self, freedoms: &Freedoms, pairs: &[Pair]) -> Gram {
        let per = self.per_group();
        let mut gram = Gram::new(per * self.names.len());
        let mut tied: BTreeMap<u32, Vec<(usize, f64)>> = BTreeMap::new();
        let mut owners = vec![0u8; freedoms.n];
        for slot in freedoms.slots.iter().flatten() {
            if let Slot::Free(f) = slot {
                owners[*f as usize] = owners[*f as usize].saturating_add(1);
            }
        }
        for (node, slots) in freedoms.slots.iter().enumerate() {
            let group = self.group_of_node[node];
            for (slot, axis) in slots.iter().zip(freedoms.local(node)) {
                let row = || -> Vec<(usize, f64)> {
                    let values = self.row(group, self.mesh.point(node), axis);
                    let numbered = values.into_iter().enumerate();
                    numbered.map(|(m, v)| (per * group + m, v)).collect()
                };
                match slot {
                    Slot::Free(f) if owners[*f as usize] > 1 => match tied.get(f) {
                        None => {
                            tied.insert(*f, row());
                        }
                        Some(first) => {
                            let difference: Vec<(usize, f64)> = row()
                                .into_iter()
                                .chain(first.iter().map(|&(i, v)| (i, -v)))
                                .collect();
                            gram.add(&difference);
                        }
                    },
                    Slot::Free(_) => {}
                    Slot::Fixed | Slot::Prescribed(_) => gram.add(&row()),
                }
            }
        }
        for pair in pairs {
            let mut row = Vec::new();
            for (node, sign) in [(pair.first, 1.0), (pair.second, -1.0)] {
                let group = self.group_of_node[node];
                let values = self.row(group, self.mesh.point(node), pair.normal);
                row.extend(
                    values
                        .into_iter()
                        .enumerate()
                        .map(|(m, v)| (per * group + m, sign * v)),
                );
            }
            gram.add(&row);
        }
        gram
    }

    pub(super) fn moved(&self, mode: &DVector<f64>) -> Vec<usize> {
        let per = self.per_group();
        let largest = mode.amax();
        (0..self.names.len())
            .filter(|&g| (0..per).any(|m| mode[per * g + m].abs() > 1e-6 * largest))
            .collect()
    }

    /// The part of the model that each group belongs to: groups that a free motion moves together are one.
    pub(super) fn parts(&self, modes: &[DVector<f64>]) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..self.names.len()).collect();
        for mode in modes {
            for pair in self.moved(mode).windows(2) {
                let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
                parent[a.max(b)] = a.min(b);
            }
        }
        (0..parent.len()).map(|g| root(&mut parent, g)).collect()
    }

    /// A motion on the free freedoms.
    pub(super) fn on_freedoms(&self, mode: &DVector<f64>, freedoms: &Freedoms) -> Vec<(u32, f64)> {
        let per = self.per_group();
        let round_off = 1e-12 * mode.amax();
        let mut values = Vec::new();
        for (freedom, &(node, local)) in freedoms.owners.iter().enumerate() {
            let node = node as usize;
            let group = self.group_of_node[node];
            let axis = freedoms.local(node)[local as usize];
            let row = self.row(group, self.mesh.point(node), axis);
            let value: f64 = row
                .iter()
                .enumerate()
                .map(|(m, v)| (v, mode[per * group + m]))
                .filter(|(_, share)| share.abs() > round_off)
                .map(|(v, share)| v * share)
                .sum();
            if value != 0.0 {
                values.push((freedom as u32, value));
            }
        }
        values
    }

    pub(super) fn work(&self, mode: &DVector<f64>, load: &LoadCase) -> (f64, f64) {
        let per = self.per_group();
        let (mut work, mut parts) = (0.0, 0.0);
        for &(node, force) in load.nodal() {
            let group = self.group_of_node[node];
            for (d, axis) in [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
                let row = self.row(group, self.mesh.point(node), axis);
                let motion: f64 = row
                    .iter()
                    .enumerate()
                    .map(|(m, v)| v * mode[per * group + m])
                    .sum();
                work += force[d] * motion;
                parts += force[d].abs();
            }
        }
        (work, parts * mode.amax())
    }

    /// The free freedom, not of a contact normal, that moves most in a motion.
    pub(super) fn largest(
        &self,
        mode: &DVector<f64>,
        freedoms: &Freedoms,
        pairs: &[Pair],
    ) -> Option<usize> {
        let per = self.per_group();
        let contact: std::collections::BTreeSet<usize> =
            pairs.iter().flat_map(|p| [p.first, p.second]).collect();
        let mut best = None;
        for (node, slots) in freedoms.slots.iter().enumerate() {
            let group = self.group_of_node[node];
            for (local, slot) in slots.iter().enumerate() {
                let Slot::Free(f) = slot else { continue };
                if local == 0 && contact.contains(&node) {
                    continue;
                }
                let row = self.row(group, self.mesh.point(node), freedoms.local(node)[local]);
                let motion: f64 = row
                    .iter()
                    .enumerate()
                    .map(|(m, v)| v * mode[per * group + m])
                    .sum();
                if best.is_none_or(|(b, _)| motion.abs() > b) {
                    best = Some((motion.abs(), *f as usize));
                }
            }
        }
        best.filter(|(b, _)| *b > 0.0).map(|(_, f)| f)
    }

    pub(super) fn describe(&self, mode: &DVector<f64>) -> String {
        let per = self.per_group();
        let groups = self.moved(mode);
        let bodies: Vec<String> = groups
            .iter()
            .flat_map(|&g| self.names[g].iter())
            .map(|n| format!("`{n}`"))
            .collect();
        let first = groups.first().copied().unwrap_or(0);
        let motion = if self.kind == Kind::Axisymmetric {
            "move along the axis".to_string()
        } else {
            let part = |m: usize| mode[per * first + m];
            let (x, y, turn) = (part(0), part(1), part(2));
            if turn.abs() > 1e-6 * mode.amax() {
                let (c, s) = (self.center[first], 2.0 / self.size[first]);
                format!(
                    "rotate about ({:.4}, {:.4})",
                    tidy(c[0] - y / (s * turn), self.size[first]),
                    tidy(c[1] + x / (s * turn), self.size[first])
                )
            } else if y.abs() <= 1e-6 * x.abs() {
                "move along x".to_string()
            } else if x.abs() <= 1e-6 * y.abs() {
                "move along y".to_string()
            } else {
                format!("move along ({x:.3}, {y:.3})")
            }
        };
        let together = if groups.len() > 1 { " together" } else { "" };
        format!(
            "bod{} {} can {motion}{together}",
            if groups.len() > 1 { "ies" } else { "y" },
            bodies.join(" and ")
        )
    }
}

/// A coordinate without the round-off of a body of this size.
fn tidy(coordinate: f64, size: f64) -> f64 {
    if coordinate.abs() < 1e-9 * size {
        0.0
    } else {
        coordinate
    }
}

/// A symmetric matrix by rows, its nonzeros only: bodies are coupled to few others.
struct Gram {
    rows: Vec<BTreeMap<usize, f64>>,
}

impl Gram {
    fn new(n: usize) -> Self {
        Gram {
            rows: vec![BTreeMap::new(); n],
        }
    }

    /// Adds `row row'`.
    fn add(&mut self, row: &[(usize, f64)]) {
        for &(i, a) in row {
            for &(j, b) in row {
                *self.rows[i].entry(j).or_insert(0.0) += a * b;
            }
        }
    }

    fn get(&self, i: usize, j: usize) -> f64 {
        self.rows[i].get(&j).copied().unwrap_or(0.0)
    }

    fn largest_diagonal(&self) -> f64 {
        (0..self.rows.len()).fold(0.0, |m, i| m.max(self.get(i, i)))
    }

    /// The rows of groups (of `per` rows each) that nothing couples with others, ascending. Within a block groups with few
    /// neighbours come first, which keeps the envelope of its factor small.
    fn uncoupled(&self, per: usize) -> Vec<Vec<usize>> {
        let n = self.rows.len() / per;
        let mut parent: Vec<usize> = (0..n).collect();
        let mut neighbours = vec![0; n];
        for (i, row) in self.rows.iter().enumerate() {
            for &j in row.keys() {
                let (a, b) = (root(&mut parent, i / per), root(&mut parent, j / per));
                parent[a.max(b)] = a.min(b);
            }
            neighbours[i / per] += row.len();
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for group in 0..n {
            groups
                .entry(root(&mut parent, group))
                .or_default()
                .push(group);
        }
        let blocks = groups.into_values().map(|mut block| {
            block.sort_by_key(|&group| neighbours[group]);
            let rows = |group: usize| (0..per).map(move |m| per * group + m);
            block.into_iter().flat_map(rows).collect()
        });
        blocks.collect()
    }

    /// Whether a block less `shift` times the identity has a Cholesky factor, which is kept from the first nonzero of each row on.
    fn is_definite(&self, block: &[usize], shift: f64) -> bool {
        let mut place = BTreeMap::new();
        place.extend(block.iter().enumerate().map(|(k, &row)| (row, k)));
        let mut factor: Vec<(usize, Vec<f64>)> = Vec::with_capacity(block.len());
        for (k, &row) in block.iter().enumerate() {
            let mut entries: Vec<(usize, f64)> = self.rows[row]
                .iter()
                .map(|(j, &value)| (place[j], value))
                .filter(|&(j, _)| j <= k)
                .collect();
            entries.push((k, -shift));
            let first = entries.iter().map(|e| e.0).min().unwrap_or(k);
            let mut values = vec![0.0; k - first + 1];
            for (j, value) in entries {
                values[j - first] += value;
            }
            for j in first..k {
                let (start, left) = &factor[j];
                let from = first.max(*start);
                let dot: f64 = (values[from - first..j - first].iter())
                    .zip(&left[from - start..j - start])
                    .map(|(a, b)| a * b)
                    .sum();
                values[j - first] = (values[j - first] - dot) / left[j - start];
            }
            let pivot =
                values[k - first] - (values[..k - first].iter()).map(|v| v * v).sum::<f64>();
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            values[k - first] = pivot.sqrt();
            factor.push((first, values));
        }
        true
    }

    /// Eigenvectors of a block with eigenvalues below `limit`, of the length of the whole.
    fn null_vectors(&self, block: &[usize], limit: f64) -> Vec<DVector<f64>> {
        let n = block.len();
        let matrix = DMatrix::from_fn(n, n, |i, j| self.get(block[i], block[j]));
        let eigen = SymmetricEigen::new(matrix);
        let found = (0..n).filter(|&k| eigen.eigenvalues[k] < limit);
        let whole = found.map(|k| {
            let mut vector = DVector::zeros(self.rows.len());
            for (&row, &value) in block.iter().zip(&eigen.eigenvectors.column(k)) {
                vector[row] = value;
            }
            vector
        });
        whole.collect()
    }
}

/// A motion of a basis that can be told in words.
struct Plain {
    /// The entry that is its own: 0 in all others.
    pivot: usize,
    vector: DVector<f64>,
}

/// The same motions by a basis that can be told in words: rotations are taken out of all vectors but as many as it takes, then
/// motions along y, then along x (reduced echelon form).
fn plain(mut motions: Vec<DVector<f64>>, per: usize) -> Vec<Plain> {
    let n = motions.first().map_or(0, DVector::len);
    let mut pivots = Vec::new();
    for kind in (0..per).rev() {
        for row in (kind..n).step_by(per) {
            let done = pivots.len();
            let Some(pivot) = (done..motions.len())
                .max_by(|&a, &b| motions[a][row].abs().total_cmp(&motions[b][row].abs()))
                .filter(|&k| motions[k][row].abs() > 1e-6)
            else {
                continue;
            };
            motions.swap(done, pivot);
            let vector = &motions[done] / motions[done][row];
            for (k, other) in motions.iter_mut().enumerate() {
                if k != done {
                    *other -= &vector * other[row];
                }
            }
            motions[done] = vector;
            pivots.push(row);
        }
    }
    let named = pivots.into_iter().zip(motions);
    named
        .map(|(pivot, motion)| Plain {
            pivot,
            vector: motion.normalize(),
        })
        .collect()
}

fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}
