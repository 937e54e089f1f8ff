//! Which bodies are held, and by what: supports, contact alone, or nothing.
//!
//! Rigid motions of all bodies together are tested against the supports and, bilaterally, the contact
//! pairs. A motion that both leave free is an error that names the body and the motion, unless
//! no load does work on it: then one freedom is pinned, which changes nothing but the free motion.

use super::{Freedoms, LoadCase, Pair, Slot};
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::Mesh;
use crate::scene::Kind;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Bodies that supports alone do not hold.
#[derive(Debug, Clone, Default)]
pub struct FloatingBodies {
    /// For each contact pair: whether its first and its second node belong to a floating body.
    pub of_pair: Vec<[bool; 2]>,
    /// Names of the floating bodies.
    pub bodies: Vec<String>,
    /// Motions that were pinned.
    pub pins: Vec<Pin>,
}

/// A freedom that was held because nothing else held it and no load works on its motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// The motion, in words.
    pub motion: String,
    /// Node that was pinned.
    pub node: usize,
}

/// Singular values below this, relative to the largest, are free motions.
const FREE: f64 = 1e-7;
/// Work of a load on a motion below this, relative to the sum of its parts, is none.
const NO_WORK: f64 = 1e-9;

/// Groups of bodies that share nodes move together: rigid motions are counted per group.
struct Motions<'a> {
    kind: Kind,
    mesh: &'a Mesh,
    group_of_node: Vec<usize>,
    center: Vec<[f64; 2]>,
    size: Vec<f64>,
    names: Vec<Vec<String>>,
}

pub(super) fn resolve(
    kind: Kind,
    mesh: &Mesh,
    freedoms: &mut Freedoms,
    pairs: &[Pair],
    loads: &[LoadCase],
    warnings: &mut Vec<String>,
) -> Result<FloatingBodies> {
    let motions = Motions::new(kind, mesh);
    let mut floating = FloatingBodies::default();
    let supports_only = motions.free(freedoms, &[]);
    let mut is_floating = vec![false; motions.names.len()];
    for mode in &supports_only {
        for group in motions.moved(mode) {
            is_floating[group] = true;
        }
    }
    for _ in 0..3 * motions.names.len() {
        let free = motions.free(freedoms, pairs);
        let Some(mode) = free.first() else { break };
        let motion = motions.describe(mode);
        for load in loads {
            let (work, parts) = motions.work(mode, load);
            if work.abs() > NO_WORK * parts {
                return Err(Error::new(
                    ErrorKind::Unheld,
                    format!(
                        "{motion}: neither supports nor contact hold this motion, and load `{}` drives it; add a support or a \
                         contact",
                        load.name
                    ),
                ));
            }
        }
        let freedom = motions.largest(mode, freedoms, pairs).ok_or_else(|| {
            Error::new(
                ErrorKind::Unheld,
                format!("{motion}: nothing holds this motion"),
            )
        })?;
        let node = freedoms.owners[freedom].0 as usize;
        warnings.push(format!(
            "{motion}: nothing holds this motion and no load drives it; it is held at node {}",
            mesh.node_label(node)
        ));
        floating.pins.push(Pin { motion, node });
        freedoms.pin(freedom);
    }
    floating.of_pair = pairs
        .iter()
        .map(|p| [p.first, p.second].map(|node| is_floating[motions.group_of_node[node]]))
        .collect();
    floating.bodies = motions
        .names
        .iter()
        .zip(&is_floating)
        .filter(|(_, floats)| **floats)
        .flat_map(|(names, _)| names.iter().cloned())
        .collect();
    Ok(floating)
}

impl<'a> Motions<'a> {
    fn new(kind: Kind, mesh: &'a Mesh) -> Self {
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
    fn free(&self, freedoms: &Freedoms, pairs: &[Pair]) -> Vec<DVector<f64>> {
        let per = self.per_group();
        let n = per * self.names.len();
        let mut gram = DMatrix::<f64>::zeros(n, n);
        let mut add = |row: &[(usize, f64)]| {
            for &(i, a) in row {
                for &(j, b) in row {
                    gram[(i, j)] += a * b;
                }
            }
        };
        let mut tied: std::collections::BTreeMap<u32, Vec<(usize, f64)>> =
            std::collections::BTreeMap::new();
        let mut owners = vec![0u8; freedoms.n];
        for slot in freedoms.slots.iter().flatten() {
            if let Slot::Free(f) = slot {
                owners[*f as usize] = owners[*f as usize].saturating_add(1);
            }
        }
        for (node, slots) in freedoms.slots.iter().enumerate() {
            let group = self.group_of_node[node];
            for (slot, axis) in slots.iter().zip(freedoms.local(node)) {
                let row: Vec<(usize, f64)> = self
                    .row(group, self.mesh.point(node), axis)
                    .into_iter()
                    .enumerate()
                    .map(|(m, v)| (per * group + m, v))
                    .collect();
                match slot {
                    Slot::Free(f) if owners[*f as usize] > 1 => match tied.get(f) {
                        None => {
                            tied.insert(*f, row);
                        }
                        Some(first) => {
                            let difference: Vec<(usize, f64)> = row
                                .iter()
                                .copied()
                                .chain(first.iter().map(|&(i, v)| (i, -v)))
                                .collect();
                            add(&difference);
                        }
                    },
                    Slot::Free(_) => {}
                    Slot::Fixed | Slot::Prescribed(_) => add(&row),
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
            add(&row);
        }
        let largest = gram.diagonal().max().max(1.0);
        let eigen = SymmetricEigen::new(gram);
        let motions = (0..n)
            .filter(|&k| eigen.eigenvalues[k] < FREE * FREE * largest)
            .map(|k| eigen.eigenvectors.column(k).into_owned())
            .collect();
        plain(motions, per)
    }

    fn moved(&self, mode: &DVector<f64>) -> Vec<usize> {
        let per = self.per_group();
        let largest = mode.amax();
        (0..self.names.len())
            .filter(|&g| (0..per).any(|m| mode[per * g + m].abs() > 1e-6 * largest))
            .collect()
    }

    fn work(&self, mode: &DVector<f64>, load: &LoadCase) -> (f64, f64) {
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
    fn largest(&self, mode: &DVector<f64>, freedoms: &Freedoms, pairs: &[Pair]) -> Option<usize> {
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

    fn describe(&self, mode: &DVector<f64>) -> String {
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

/// The same motions by a basis that can be told in words: rotations are taken out of all vectors but as many as it takes, then
/// motions along y, then along x (reduced echelon form). Motions without rotation come first.
fn plain(mut motions: Vec<DVector<f64>>, per: usize) -> Vec<DVector<f64>> {
    let n = motions.first().map_or(0, DVector::len);
    let mut done = 0;
    for kind in (0..per).rev() {
        for row in (kind..n).step_by(per) {
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
            done += 1;
        }
    }
    motions.reverse();
    motions.iter().map(|m| m / m.norm()).collect()
}

fn root(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}
