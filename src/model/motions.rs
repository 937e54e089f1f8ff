//! Rigid motions of the bodies, and which of them supports and pairs leave free.

use super::contact_basis::ContactBasis;
use super::gram::Gram;
use super::{Freedoms, LoadCase, Pair, Slot};
use crate::classes::Classes;
use crate::mesh::Mesh;
use crate::space::{self, Space, Vector, unit};
use nalgebra::DVector;
use std::collections::{BTreeMap, BTreeSet};

/// Singular values below this fraction of the largest belong to free motions.
pub(super) const FREE: f64 = 1e-7;
/// Fraction of the largest entry by which a block is shifted: a block that is still definite has no
/// free motion. It lies well above the square of [`FREE`] and above the round-off of a
/// factorisation of some thousand rows.
const HELD: f64 = 1e-11;

/// Rigid motions of groups; a group is a set of bodies that share nodes and move together.
pub(super) struct Motions<'a> {
    pub(super) space: Space,
    pub(super) mesh: &'a Mesh,
    basis: ContactBasis,
    /// Number of the group of each node.
    pub(super) group_of_node: Vec<usize>,
    /// Middle of the box around each group.
    pub(super) center: Vec<Vector>,
    /// Diagonal of the box around each group.
    pub(super) size: Vec<f64>,
    /// Names of the bodies of each group.
    pub(super) names: Vec<Vec<String>>,
    /// Nodes of each group, ascending.
    nodes: Vec<Vec<usize>>,
}

/// A rigid motion of some groups. Its storage depends on these groups alone, not on how many other
/// bodies there are.
#[derive(Clone)]
pub(super) struct Mode {
    /// Group and rigid motion as `per_group * group + motion`, ascending; groups are complete.
    rows: Vec<usize>,
    values: DVector<f64>,
}

impl Mode {
    /// Entry of a row; 0 if the group of the row does not move.
    pub(super) fn at(&self, row: usize) -> f64 {
        let place = self.rows.binary_search(&row);
        place.map_or(0.0, |k| self.values[k])
    }

    /// Largest absolute value of the entries of the motion.
    pub(super) fn largest(&self) -> f64 {
        self.values.amax()
    }
}

/// Nodal forces of all loads, by the group on which they act.
pub(super) struct Forces {
    /// Load number, node and force, for each group.
    of_group: Vec<Vec<(usize, usize, Vector)>>,
}

impl<'a> Motions<'a> {
    pub(super) fn new(space: Space, mesh: &'a Mesh, basis: ContactBasis) -> Self {
        let n_bodies = mesh.bodies.len();
        let mut classes = Classes::new(n_bodies);
        let mut body_of_node = vec![usize::MAX; mesh.n_nodes()];
        for e in 0..mesh.n_elements() {
            let body = mesh.element_body[e] as usize;
            for &node in mesh.nodes(e) {
                let other = body_of_node[node as usize];
                if other == usize::MAX {
                    body_of_node[node as usize] = body;
                } else if other != body {
                    classes.join(other, body);
                }
            }
        }
        let roots = classes.firsts();
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
        let mut low = vec![[f64::INFINITY; 3]; names.len()];
        let mut high = vec![[f64::NEG_INFINITY; 3]; names.len()];
        for (node, &group) in group_of_node.iter().enumerate() {
            for (d, x) in mesh.point(node).into_iter().enumerate() {
                low[group][d] = low[group][d].min(x);
                high[group][d] = high[group][d].max(x);
            }
        }
        let boxes = || low.iter().zip(&high);
        let center = boxes()
            .map(|(l, h)| std::array::from_fn(|d| 0.5 * (l[d] + h[d])))
            .collect();
        let size = boxes()
            .map(|(l, h)| space::length(std::array::from_fn(|d| h[d] - l[d])))
            .collect();
        let mut nodes = vec![Vec::new(); names.len()];
        for (node, &group) in group_of_node.iter().enumerate() {
            nodes[group].push(node);
        }
        Motions {
            space,
            mesh,
            basis,
            group_of_node,
            center,
            size,
            names,
            nodes,
        }
    }

    /// Number of rigid motions of a group.
    pub(super) fn per_group(&self) -> usize {
        self.space.rigid_motions().len()
    }

    /// Displacement of a node along `axis` in each rigid motion of its group. Rotations are about
    /// the group's centre, scaled to its size.
    fn row(&self, node: usize, axis: Vector) -> Vec<f64> {
        let group = self.group_of_node[node];
        let x = self.basis.at_control(node, |node| self.mesh.point(node));
        let (c, s) = (self.center[group], 2.0 / self.size[group]);
        let arm: Vector = std::array::from_fn(|d| s * (x[d] - c[d]));
        let motions = self.space.rigid_motions().iter();
        motions
            .map(|motion| space::dot(motion.displacement(arm), axis))
            .collect()
    }

    /// Finds the motions that supports and (bilateral) pairs leave free, as unit vectors with one
    /// entry per rigid motion of each group in a block that these conditions couple.
    pub(super) fn free(&self, freedoms: &Freedoms, pairs: &[Pair]) -> Vec<Mode> {
        self.held_by_less(freedoms, pairs, FREE)
    }

    /// Finds the motions whose singular value in the conditions that supports and (bilateral) pairs
    /// impose is below a fraction of the largest, as [`Motions::free`] does.
    pub(super) fn held_by_less(
        &self,
        freedoms: &Freedoms,
        pairs: &[Pair],
        fraction: f64,
    ) -> Vec<Mode> {
        let per = self.per_group();
        let gram = self.gram(freedoms, pairs);
        let largest = gram.largest_diagonal().max(1.0);
        let mut free: Vec<Plain> = Vec::new();
        for block in gram.uncoupled(per) {
            // Most blocks are held, and a single factorisation is enough to show this.
            let limit = fraction * fraction;
            if !gram.is_definite(&block, HELD.max(2.0 * limit) * largest) {
                let (rows, vectors) = gram.null_vectors(&block, limit * largest);
                free.extend(plain(&rows, vectors, per));
            }
        }
        free.sort_by_key(|motion| (motion.pivot % per, std::cmp::Reverse(motion.pivot)));
        free.into_iter().map(|motion| motion.mode).collect()
    }

    /// Gram matrix of all conditions that supports and pairs impose on the motions.
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
            for (slot, axis) in slots
                .iter()
                .zip(freedoms.local(node))
                .take(freedoms.per_node)
            {
                let row = || -> Vec<(usize, f64)> {
                    let values = self.row(node, axis);
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
                    Slot::Sum(_) => {
                        let mut difference = row();
                        freedoms.each(*slot, |slot, c| {
                            if let Slot::Free(f) = slot {
                                let (node, local) = freedoms.owners[f as usize];
                                let (node, local) = (node as usize, local as usize);
                                let values = self.row(node, freedoms.local(node)[local]);
                                let first = per * self.group_of_node[node];
                                let values = values.into_iter().enumerate();
                                difference.extend(values.map(|(m, v)| (first + m, -c * v)));
                            }
                        });
                        gram.add(&difference);
                    }
                    Slot::Fixed | Slot::Prescribed(_) => gram.add(&row()),
                }
            }
        }
        for pair in pairs {
            gram.add(&self.row_of_pair(pair, &|_| pair.normal));
        }
        gram
    }

    /// Motion of a pair's masters less its slave, each along its normal, in each rigid motion of
    /// their groups.
    fn row_of_pair(&self, pair: &Pair, normal: &dyn Fn(usize) -> Vector) -> Vec<(usize, f64)> {
        let per = self.per_group();
        let masters = pair.masters.iter().copied();
        let nodes = masters.chain([(pair.slave, -1.0)]);
        let of_node = nodes.flat_map(|(node, share)| {
            let first = per * self.group_of_node[node];
            let values = self.row(node, normal(node)).into_iter().enumerate();
            values.map(move |(m, v)| (first + m, share * v))
        });
        of_node.collect()
    }

    /// Change of a pair's gap in a mode, each node moving along its own normal.
    pub(super) fn opening(
        &self,
        mode: &Mode,
        pair: &Pair,
        normal: &dyn Fn(usize) -> Vector,
    ) -> f64 {
        let row = self.row_of_pair(pair, normal).into_iter();
        row.map(|(at, value)| value * mode.at(at)).sum()
    }

    /// Numbers of the groups that move in a mode, ascending.
    pub(super) fn moved(&self, mode: &Mode) -> Vec<usize> {
        let per = self.per_group();
        let round_off = 1e-6 * mode.largest();
        let entries = mode.rows.iter().zip(&mode.values);
        let moving = entries.filter(|(_, value)| value.abs() > round_off);
        let mut groups: Vec<usize> = moving.map(|(row, _)| row / per).collect();
        groups.dedup();
        groups
    }

    /// Number of the part to which each group belongs; groups that a free motion moves together, or
    /// that ties or equations join, form one part.
    pub(super) fn parts(&self, modes: &[Mode], freedoms: &Freedoms) -> Vec<usize> {
        let mut classes = Classes::new(self.names.len());
        for (node, &group) in self.group_of_node.iter().enumerate() {
            for slot in freedoms.of_node(node) {
                let Slot::Sum(k) = *slot else { continue };
                for &(followed, ..) in freedoms.followed_axes(k) {
                    classes.join(group, self.group_of_node[followed as usize]);
                }
            }
        }
        for mode in modes {
            for pair in self.moved(mode).windows(2) {
                classes.join(pair[0], pair[1]);
            }
        }
        classes.firsts()
    }

    /// Displacement of a node along `axis` in a mode, without the rigid motions whose shares in the
    /// mode are at most `round_off`.
    pub(super) fn along(&self, mode: &Mode, node: usize, axis: Vector, round_off: f64) -> f64 {
        let group = self.group_of_node[node];
        let row = self.row(node, axis);
        let shares = row
            .iter()
            .enumerate()
            .map(|(m, v)| (v, mode.at(row.len() * group + m)));
        shares
            .filter(|(_, share)| share.abs() > round_off)
            .map(|(v, share)| v * share)
            .sum()
    }

    /// Nodes of the groups for which a mode has entries, ascending.
    fn nodes_of(&self, mode: &Mode) -> Vec<usize> {
        let groups = mode.rows.iter().step_by(self.per_group());
        let nodes = groups.flat_map(|row| &self.nodes[row / self.per_group()]);
        let mut nodes: Vec<usize> = nodes.copied().collect();
        nodes.sort_unstable();
        nodes
    }

    /// Displacements of a mode on the free freedoms. `owned` are the freedoms that each node owns,
    /// with their local axes ([`owned`]).
    pub(super) fn on_freedoms(
        &self,
        mode: &Mode,
        freedoms: &Freedoms,
        owned: &[Vec<(u32, u8)>],
    ) -> Vec<(u32, f64)> {
        let round_off = 1e-12 * mode.largest();
        let mut values = Vec::new();
        for node in self.nodes_of(mode) {
            for &(freedom, local) in &owned[node] {
                let axis = freedoms.local(node)[local as usize];
                let value = self.along(mode, node, axis, round_off);
                if value != 0.0 {
                    values.push((freedom, value));
                }
            }
        }
        values.sort_unstable_by_key(|&(freedom, _)| freedom);
        values
    }

    /// Sorts the nodal forces of the loads by groups.
    pub(super) fn forces(&self, loads: &[LoadCase]) -> Forces {
        let mut of_group = vec![Vec::new(); self.names.len()];
        for (load, case) in loads.iter().enumerate() {
            for &(node, force) in case.nodal() {
                of_group[self.group_of_node[node]].push((load, node, force));
            }
        }
        Forces { of_group }
    }

    /// Sum of the absolute values of a load's components on the groups of a mode.
    pub(super) fn size(&self, mode: &Mode, forces: &Forces, load: usize) -> f64 {
        let per = self.per_group();
        let groups = mode.rows.iter().step_by(per).map(|row| row / per);
        let own = groups.flat_map(|group| &forces.of_group[group]);
        let own = own.filter(|(of, ..)| *of == load);
        own.flat_map(|(.., force)| force).map(|f| f.abs()).sum()
    }

    /// Work of each load with forces on the groups of a mode, by load number.
    pub(super) fn work(&self, mode: &Mode, forces: &Forces) -> BTreeMap<usize, f64> {
        let per = self.per_group();
        let mut work = BTreeMap::new();
        for group in mode.rows.iter().step_by(per).map(|row| row / per) {
            for &(load, node, force) in &forces.of_group[group] {
                let motion = |axis| self.along(mode, node, axis, 0.0);
                let own: &mut f64 = work.entry(load).or_default();
                for (axis, force) in force.iter().enumerate().take(self.space.dimension()) {
                    *own += force * motion(unit(axis));
                }
            }
        }
        work
    }

    /// The free freedom that moves most in a mode, apart from contact normals (at the nodes in
    /// `contact`).
    pub(super) fn largest(
        &self,
        mode: &Mode,
        freedoms: &Freedoms,
        contact: &BTreeSet<usize>,
    ) -> Option<usize> {
        let mut best = None;
        for node in self.nodes_of(mode) {
            for (local, slot) in freedoms.slots[node].iter().enumerate() {
                let Slot::Free(f) = slot else { continue };
                if local == 0 && contact.contains(&node) {
                    continue;
                }
                let motion = self.along(mode, node, freedoms.local(node)[local], 0.0);
                if best.is_none_or(|(b, _)| motion.abs() > b) {
                    best = Some((motion.abs(), *f as usize));
                }
            }
        }
        best.filter(|(b, _)| *b > 0.0).map(|(_, f)| f)
    }
}

/// A motion of a basis that can be described in words.
struct Plain {
    /// Row in which this motion alone, of all motions of the basis, is not zero.
    pivot: usize,
    mode: Mode,
}

/// Transforms motions to a basis of the same space that can be described in words: rotations are
/// eliminated from all but as few vectors as possible, then translations along z (in solids), y and
/// x in turn (reduced echelon form).
fn plain(rows: &[usize], mut motions: Vec<DVector<f64>>, per: usize) -> Vec<Plain> {
    let mut pivots = Vec::new();
    for kind in (0..per).rev() {
        for row in (kind..rows.len()).step_by(per) {
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
            pivots.push(rows[row]);
        }
    }
    let named = pivots.into_iter().zip(motions);
    named
        .map(|(pivot, motion)| Plain {
            pivot,
            mode: Mode {
                rows: rows.to_vec(),
                values: motion.normalize(),
            },
        })
        .collect()
}

/// Free freedoms that each node owns, with the number of the local axis of each.
pub(super) fn owned(freedoms: &Freedoms, n_nodes: usize) -> Vec<Vec<(u32, u8)>> {
    let mut owned = vec![Vec::new(); n_nodes];
    let of_nodes = freedoms.n - freedoms.springs.len();
    for (freedom, &(node, local)) in freedoms.owners[..of_nodes].iter().enumerate() {
        owned[node as usize].push((freedom as u32, local));
    }
    owned
}
