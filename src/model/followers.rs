//! Displacements that follow others: those of slave nodes in ties, and those of equations.
//!
//! A row `j` of a tie states `R_j = D_j u_j - sum_k M_jk u_k = 0` for all directions. The row
//! expresses the displacement of a slave along each of its axes as a sum of other displacements,
//! and assembly eliminates the displacement of the slave. If something else acts in a direction `n`
//! of a slave `h` (a support, a prescribed displacement, a contact normal), it takes precedence,
//! and `n . R_h` is added to the rows of the slave's neighbours:
//!
//! ```text
//!     R_j + sum_h c_jh n n' R_h = 0,    c_jh = D_j / sum_j D_j
//! ```
//!
//! so that the remaining multipliers still add up to any uniform traction.
//!
//! # Source
//! Held nodes, and nodes of two interfaces: B. Wohlmuth, *Discretization methods and iterative
//! solvers based on domain decomposition*, Springer 2001, section 1.2.

use super::contact_basis::ContactBasis;
use super::following::Following;
use super::freedoms::{Freedoms, Slot};
use super::pairs::Pair;
use super::pairs::resolved_tie::ResolvedTie;
use super::prescribed::FollowingMiddle;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::space::{Vector, along, dot, in_words};
use std::collections::{BTreeMap, BTreeSet};

/// Size up to which a coefficient counts as zero, relative to coefficients of 1.
const ROUND_OFF: f64 = 16.0 * f64::EPSILON;
/// Squared cosine above which a direction lies in the free directions of a node.
const FREE: f64 = 1.0 - 1e-6;

/// A node and the number of one of its axes.
type Axis = (usize, usize);

/// Displacements that follow others, by ties and equations.
#[derive(Debug, Clone, Default)]
pub(super) struct Followers {
    /// Number of each follower, by its axis.
    place: BTreeMap<Axis, usize>,
    /// Sum `sum v . q` of control points for each follower.
    terms: Vec<Vec<(usize, Vector)>>,
    /// Prescribed values that are added to the sums of followers.
    moved: BTreeMap<usize, Vec<u32>>,
    /// Number of followers by ties, which come first.
    of_ties: usize,
}

/// Uses of nodes' axes by other conditions than supports and prescribed displacements.
pub(super) struct Others<'a> {
    /// Whether an axis belongs to a surface that is held plane.
    pub plane: &'a dyn Fn(Axis) -> bool,
    /// Contact pairs, which use the normals of their slaves.
    pub pairs: &'a [Pair],
}

impl Followers {
    /// Makes the slaves of ties follow.
    ///
    /// # Errors
    /// A slave whose neighbours are all held in a direction in which its masters are not.
    pub(super) fn of_ties(
        freedoms: &mut Freedoms,
        mesh: &Mesh,
        ties: &[ResolvedTie],
        others: &Others,
    ) -> Result<Self> {
        let mut followers = Followers::default();
        if ties.is_empty() {
            return Ok(followers);
        }
        let in_contact: BTreeSet<usize> = others.pairs.iter().map(|pair| pair.slave).collect();
        let is_free: BTreeMap<usize, [bool; 3]> = (ties.iter().flat_map(|tie| &tie.rows))
            .map(|row| {
                let node = row.slave;
                let free = std::array::from_fn(|i| {
                    matches!(freedoms.slots[node][i], Slot::Free(_))
                        && !(others.plane)((node, i))
                        && !(i == 0 && in_contact.contains(&node))
                });
                (node, free)
            })
            .collect();
        for row in ties.iter().flat_map(|tie| &tie.rows) {
            for (i, axis) in freedoms.local(row.slave).into_iter().enumerate() {
                if is_free[&row.slave][i] {
                    let terms = on_masters(&freedoms.basis, row, axis, 1.0);
                    followers.add((row.slave, i), terms);
                }
            }
        }
        for (&(node, i), &k) in &followers.place {
            freedoms.slots[node][i] = Slot::Sum(k as u32);
        }
        for tie in ties {
            let neighbours = neighbours(mesh, tie);
            let near = |row: &Pair| neighbours.get(&row.slave).map_or(&[][..], Vec::as_slice);
            for row in &tie.rows {
                for i in (0..freedoms.per_node).filter(|&i| !is_free[&row.slave][i]) {
                    followers.hand_on(freedoms, mesh, tie, (row, i), near(row))?;
                }
            }
            for row in &tie.elsewhere {
                for i in 0..freedoms.per_node {
                    followers.hand_on(freedoms, mesh, tie, (row, i), near(row))?;
                }
            }
        }
        followers.of_ties = followers.terms.len();
        Ok(followers)
    }

    /// Adds a follower. Returns its number.
    fn add(&mut self, axis: Axis, terms: Vec<(usize, Vector)>) -> usize {
        let k = self.terms.len();
        self.place.insert(axis, k);
        self.terms.push(terms);
        k
    }

    /// Adds a follower by an equation, whose `terms` and prescribed values move the node.
    fn add_equation(
        &mut self,
        freedoms: &mut Freedoms,
        (node, axis): Axis,
        terms: Vec<(usize, Vector)>,
        moved: impl Iterator<Item = (usize, f64)>,
    ) {
        let direction = freedoms.local(node)[axis];
        let terms = freedoms.basis.at_control_point(node, direction, terms);
        let k = self.add((node, axis), terms);
        let numbers: Vec<u32> = moved
            .map(|(load, value)| freedoms.add_prescribed(load, value))
            .collect();
        if !numbers.is_empty() {
            self.moved.insert(k, numbers);
        }
        freedoms.slots[node][axis] = Slot::Sum(k as u32);
    }

    /// Lets middles of edges whose displacement is given follow the ends of the edge: with the
    /// given displacement `u`, the control point moves by `(u - sum w_e q_e) / w`.
    pub(super) fn add_middles(&mut self, freedoms: &mut Freedoms, middles: &[FollowingMiddle]) {
        for middle in middles {
            let weight = freedoms.basis.own_weight(middle.node);
            let moved = middle.moved.iter();
            let moved = moved.map(|&(load, value)| (load, value / weight));
            self.add_equation(freedoms, (middle.node, middle.axis), Vec::new(), moved);
        }
    }

    /// Makes displacements follow others by equations.
    ///
    /// # Errors
    /// Input errors: a displacement that is held otherwise; a node that a tie moves as well.
    pub(super) fn add_equations(
        &mut self,
        freedoms: &mut Freedoms,
        scene: &Scene,
        mesh: &Mesh,
        equations: &[Following],
        others: &Others,
    ) -> Result<()> {
        let in_contact: BTreeSet<usize> = others.pairs.iter().map(|pair| pair.slave).collect();
        let of_ties = self.terms.iter().flatten();
        let in_tie: BTreeSet<usize> = of_ties.map(|term| term.0).collect();
        for equation in equations {
            // Nodes of ties are moved to where they follow without strain, which equations may not
            // allow.
            let is_taken = |(node, i): Axis| {
                (others.plane)((node, i))
                    || i == 0 && in_contact.contains(&node)
                    || in_tie.contains(&node)
            };
            let (axis, sense) = equation.axis(scene, mesh, freedoms, is_taken)?;
            let terms = equation.terms.iter();
            let terms = terms.map(|&(node, v)| (node, v.map(|v| sense * v)));
            let weight = sense / freedoms.basis.own_weight(equation.node);
            let moved = equation.moved.iter();
            let moved = moved.map(|&(load, value)| (load, weight * value));
            self.add_equation(freedoms, (equation.node, axis), terms.collect(), moved);
        }
        freedoms.n_followers_of_ties = self.of_ties;
        Ok(())
    }

    /// Adds the tie row of a slave to the rows of the slave's neighbours. This is done along an
    /// axis `i` that another condition of the slave already uses.
    fn hand_on(
        &mut self,
        freedoms: &Freedoms,
        mesh: &Mesh,
        tie: &ResolvedTie,
        (row, i): (&Pair, usize),
        near: &[(usize, f64)],
    ) -> Result<()> {
        let normal = freedoms.local(row.slave)[i];
        let shares = |node: usize| {
            let axes = freedoms.local(node).into_iter().enumerate();
            let free = axes.filter(|&(l, _)| self.place.contains_key(&(node, l)));
            let shares: Vec<(usize, f64)> = free.map(|(l, axis)| (l, dot(axis, normal))).collect();
            shares
        };
        let takers: Vec<(usize, f64)> = (near.iter().copied())
            .filter(|&(node, _)| shares(node).iter().map(|s| s.1 * s.1).sum::<f64>() > FREE)
            .collect();
        let total: f64 = takers.iter().map(|taker| taker.1).sum();
        if takers.is_empty() {
            let masters = on_masters(&freedoms.basis, row, normal, 1.0);
            return match masters
                .into_iter()
                .all(|(node, v)| !moves(freedoms, node, v))
            {
                true => Ok(()),
                false => Err(Error::input(format!(
                    "{}: node {} of `{}` and those beside it are held along {}, by supports, loads \
                     or a contact, but the nodes that they would follow can move: make the other \
                     surface the slave (`slave`)",
                    tie.what,
                    mesh.node_label(row.slave),
                    tie.slaves,
                    in_words(normal, mesh.dimension),
                ))),
            };
        }
        let mut additions = Vec::new();
        for &(node, _) in &takers {
            for (l, share) in shares(node) {
                let factor = share * row.area / total;
                if factor.abs() > ROUND_OFF {
                    let mut terms = on_masters(&freedoms.basis, row, normal, factor);
                    terms.push((row.slave, normal.map(|n| -factor * n)));
                    additions.push((self.place[&(node, l)], terms));
                }
            }
        }
        for (k, terms) in additions {
            self.terms[k].extend(terms);
        }
        Ok(())
    }

    /// Expresses followers by numbered freedoms, and moves their nodes to where they follow without
    /// strain: `x_j = sum w_jk x_k`, so that rigid motions of the bodies satisfy the equations.
    /// Returns whether any node moved by more than round-off.
    ///
    /// # Errors
    /// Ties and equations that form a circle.
    pub(super) fn settle(&self, freedoms: &mut Freedoms, mesh: &mut Mesh) -> Result<bool> {
        if self.terms.is_empty() {
            return Ok(false);
        }
        let mut expansion = FollowerExpansion {
            freedoms,
            mesh,
            followers: self,
            of: vec![Expanded::No; self.terms.len()],
        };
        for &k in self.place.values() {
            expansion.expand(k)?;
        }
        let expanded: Vec<FollowedSum> = (expansion.of.into_iter())
            .map(|of| match of {
                Expanded::To(sum) => sum,
                _ => FollowedSum::default(),
            })
            .collect();
        let moved = self.place_nodes(freedoms, mesh, &expanded);
        freedoms.follower_values = expanded.iter().map(|sum| sum.moved.clone()).collect();
        let axes = |terms: Vec<(Axis, f64)>| {
            let terms = terms.into_iter();
            terms
                .map(|((node, i), c)| (node as u32, i as u8, c))
                .collect()
        };
        freedoms.followers = expanded.into_iter().map(|sum| axes(sum.axes)).collect();
        Ok(moved)
    }

    fn place_nodes(&self, freedoms: &Freedoms, mesh: &mut Mesh, expanded: &[FollowedSum]) -> bool {
        let control = |node: usize| freedoms.basis.at_control(node, |node| mesh.point(node));
        let mut step: BTreeMap<usize, Vector> = BTreeMap::new();
        let mut moved = false;
        let of_ties = self.place.iter().filter(|of| *of.1 < self.of_ties);
        for (&(node, i), &k) in of_ties {
            let (axis, x) = (freedoms.local(node)[i], control(node));
            let terms = expanded[k].axes.iter();
            let at: f64 = terms
                .map(|&((n, l), c)| c * dot(freedoms.local(n)[l], control(n)))
                .sum();
            let off = at - dot(axis, x);
            moved |= off.abs() > 1e-12 * x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let sum = step.entry(node).or_default();
            *sum = along(*sum, off, axis);
        }
        let at = |node: usize| {
            let x = control(node);
            step.get(&node).map_or(x, |step| along(x, 1.0, *step))
        };
        let nodes: BTreeSet<usize> = (step.keys().copied())
            .chain(freedoms.basis.edges().filter_map(|(node, ends)| {
                let moves = |n: &usize| step.contains_key(n);
                (moves(&node) || ends.iter().any(moves)).then_some(node)
            }))
            .collect();
        let places: Vec<(usize, Vector)> = nodes
            .into_iter()
            .map(|node| (node, freedoms.basis.at_node(node, at)))
            .collect();
        for (node, x) in places {
            let d = mesh.dimension;
            mesh.coordinates[d * node..d * (node + 1)].copy_from_slice(&x[..d]);
        }
        moved
    }
}

/// Terms `scale v . sum w_k u_k` of the masters on control points.
fn on_masters(basis: &ContactBasis, row: &Pair, v: Vector, scale: f64) -> Vec<(usize, Vector)> {
    let terms = row.masters.iter();
    let terms = terms.map(|&(node, w)| (node, v.map(|v| scale * w * v)));
    basis.share_of(terms.collect())
}

/// Whether a control point can move along a direction.
fn moves(freedoms: &Freedoms, node: usize, v: Vector) -> bool {
    let axes = freedoms.of_node(node).iter().zip(freedoms.local(node));
    axes.filter(|(_, axis)| dot(v, *axis).abs() > ROUND_OFF)
        .any(|(slot, _)| matches!(slot, Slot::Free(_) | Slot::Sum(_)))
}

/// For each slave node the nodes that share a facet of the slave surface with it, with weights.
fn neighbours(mesh: &Mesh, tie: &ResolvedTie) -> BTreeMap<usize, Vec<(usize, f64)>> {
    let weight: BTreeMap<usize, f64> = (tie.rows.iter()).map(|row| (row.slave, row.area)).collect();
    let mut out: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for &facet in mesh
        .surfaces
        .get(&tie.slaves)
        .map_or(&[][..], |s| &s.facets)
    {
        for node in mesh.facet_nodes(facet) {
            let others = mesh
                .facet_nodes(facet)
                .filter(|n| *n != node && weight.contains_key(n));
            out.entry(node).or_default().extend(others);
        }
    }
    let weigh = |nodes: BTreeSet<usize>| nodes.into_iter().map(|n| (n, weight[&n])).collect();
    out.into_iter()
        .map(|(node, near)| (node, weigh(near)))
        .collect()
}

/// A sum of displacements along axes that follow nothing, and of prescribed values.
#[derive(Debug, Clone, Default)]
struct FollowedSum {
    axes: Vec<(Axis, f64)>,
    /// Numbers of prescribed values, and coefficients.
    moved: Vec<(u32, f64)>,
}

#[derive(Clone)]
enum Expanded {
    No,
    InProgress,
    To(FollowedSum),
}

/// Expands followers into axes that follow nothing.
struct FollowerExpansion<'a> {
    freedoms: &'a Freedoms,
    mesh: &'a Mesh,
    followers: &'a Followers,
    of: Vec<Expanded>,
}

impl FollowerExpansion<'_> {
    fn expand(&mut self, k: usize) -> Result<()> {
        match &self.of[k] {
            Expanded::To(_) => return Ok(()),
            Expanded::InProgress => {
                let at = self.followers.terms[k].first().map_or(0, |term| term.0);
                return Err(Error::input(format!(
                    "the ties and equations at node {} go in a circle: let the other surface of a \
                     tie follow (`slave`), or put another term of an equation first",
                    self.mesh.node_label(at)
                )));
            }
            Expanded::No => self.of[k] = Expanded::InProgress,
        }
        let mut sums: BTreeMap<Axis, f64> = BTreeMap::new();
        let mut moved: BTreeMap<u32, f64> = BTreeMap::new();
        let (freedoms, followers) = (self.freedoms, self.followers);
        let own = followers.moved.get(&k).into_iter().flatten();
        moved.extend(own.map(|&p| (p, 1.0)));
        for &(node, v) in &followers.terms[k] {
            let axes = freedoms.local(node).into_iter().zip(freedoms.slots[node]);
            for (l, (axis, slot)) in axes.enumerate() {
                let share = dot(v, axis);
                if share.abs() <= ROUND_OFF {
                    continue;
                }
                match slot {
                    Slot::Sum(other) => {
                        self.expand(other as usize)?;
                        if let Expanded::To(sum) = &self.of[other as usize] {
                            for &(axis, c) in &sum.axes {
                                *sums.entry(axis).or_default() += share * c;
                            }
                            for &(p, c) in &sum.moved {
                                *moved.entry(p).or_default() += share * c;
                            }
                        }
                    }
                    _ => *sums.entry((node, l)).or_default() += share,
                }
            }
        }
        self.of[k] = Expanded::To(FollowedSum {
            axes: sums.into_iter().collect(),
            moved: moved.into_iter().collect(),
        });
        Ok(())
    }
}
