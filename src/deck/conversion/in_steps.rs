//! Supports that begin or end in a later step: `*BOUNDARY` from a later step on, `FIXED`, and
//! `OP=NEW`, which releases what it does not repeat.
//!
//! Conditions on reference nodes and along the axes of a `*TRANSFORM` become conditions on sums of
//! displacements.

use super::super::Deck;
use super::super::bodies::unsupported;
use super::super::constraints::LocalAxes;
use super::super::facets::Key;
use super::super::history::KeyHistory;
use super::super::linear::{FreedomCoefficients, Reduced};
use super::super::series::Series;
use super::draft::{Draft, made};
use crate::error::Result;
use crate::scene::span::Span;
use crate::scene::{Direction, EquationTerm, Load, Relative, Support};
use std::collections::{BTreeMap, BTreeSet};

/// Largest coefficient, such as a component of an axis, that counts as zero.
const ROUND_OFF: f64 = 1e-12;

/// Bits of the load factors of a span, as a key.
type SpanBits = [Option<[u64; 2]>; 2];

/// Key of a condition on nodes over some steps: axis, span, whether the nodes stay where they are,
/// and the values over time.
type Done = (u8, SpanBits, bool, Vec<u64>);

fn bits(span: Span) -> SpanBits {
    let since = span.since.map(|since| [since.to_bits(); 2]);
    [since, span.until.map(|until| until.map(f64::to_bits))]
}

/// The condition that a sum of displacements along x, y and z has a value over some steps.
struct SumInSteps {
    terms: FreedomCoefficients,
    entry: KeyHistory,
}

/// Displacements that are given in some steps only.
pub(super) struct InSteps {
    /// Displacements of nodes with elements, along x, y or z or an axis of the node.
    single: Vec<(Key, KeyHistory)>,
    sums: Vec<SumInSteps>,
}

impl InSteps {
    /// Separates the conditions in steps into conditions on a single displacement along x, y or z,
    /// and conditions on sums: for nodes without elements, displacements that follow others, and
    /// displacements along axes of nodes.
    ///
    /// # Errors
    /// `Unsupported` for a displacement that follows nodes without elements, or that other
    /// conditions determine already.
    pub(super) fn of(
        in_steps: Vec<(Key, KeyHistory)>,
        reduced: &Reduced,
        axes: &LocalAxes,
        draft: &Draft,
    ) -> Result<Self> {
        let geometry = &draft.geometry;
        let is_moved = |entry: &KeyHistory| !entry.stays && !is_at_rest(entry);
        let moved = in_steps.iter().filter(|(_, entry)| is_moved(entry));
        let moved: BTreeSet<u32> = moved.map(|(key, _)| key.0).collect();
        let (mut single, mut sums) = (Vec::new(), Vec::new());
        for (key, entry) in in_steps {
            let mut all = reduced.loose.iter().chain(&reduced.others);
            let of = match all.find(|follows| follows.key == key) {
                Some(follows) => follows.of.clone(),
                None if !geometry.uses(key.0) => continue,
                None => FreedomCoefficients::from([(key, 1.0)]),
            };
            let is_alone = of.len() == 1;
            let turned = of.keys().any(|key| axes.contains_key(&key.0));
            match of.iter().next() {
                Some((to, share)) if is_alone && !turned => {
                    let mut entry = entry;
                    entry.series = entry.series.multiplied(1.0 / share);
                    single.push((*to, entry));
                }
                // A node that only keeps its position along its own axes gets supports.
                Some((to, _)) if is_alone && *to == key && !moved.contains(&key.0) => {
                    single.push((key, entry));
                }
                _ => {
                    if of.is_empty() || of.keys().any(|key| !geometry.uses(key.0)) {
                        return Err(coupled(draft.deck, key, &entry));
                    }
                    let mut terms = FreedomCoefficients::new();
                    for ((node, axis), c) in of {
                        let own = axes.get(&node).map(|axes| axes[axis as usize]);
                        let own = own.unwrap_or_else(|| crate::space::unit(axis as usize));
                        for (global, share) in own.into_iter().enumerate() {
                            *terms.entry((node, global as u8)).or_default() += c * share;
                        }
                    }
                    terms.retain(|_, c| c.abs() > ROUND_OFF);
                    sums.push(SumInSteps { terms, entry });
                }
            }
        }
        Ok(InSteps { single, sums })
    }

    /// Nodes that occur in the sums of displacements whose values are given.
    pub(super) fn nodes_of_sums(&self) -> impl Iterator<Item = u32> {
        let keys = self.sums.iter().flat_map(|sum| sum.terms.keys());
        keys.map(|key| key.0)
    }

    /// Turns the conditions into supports and prescribed displacements.
    pub(super) fn prescribe(self, draft: &mut Draft, axes: &LocalAxes) {
        let mut groups: BTreeMap<Done, (Vec<u32>, KeyHistory)> = BTreeMap::new();
        for ((node, axis), entry) in self.single {
            if let Some(axes) = axes.get(&node) {
                let on = draft.set_of_node(node);
                let support = Support {
                    direction: Some(draft.components(axes[axis as usize])),
                    ..Support::over(on, entry.span)
                };
                draft.add_support(support, entry.place);
                continue;
            }
            let key = (axis, bits(entry.span), entry.stays, entry.series.bits());
            let (nodes, _) = groups.entry(key).or_insert((Vec::new(), entry));
            nodes.push(node);
        }
        for ((axis, ..), (nodes, entry)) in groups {
            let name = made("boundary", entry.place);
            let on = draft.geometry.add_nodes(&name, nodes);
            if entry.stays || is_at_rest(&entry) {
                let support = Support {
                    fix: vec![Direction::ALL[axis as usize]],
                    ..Support::over(on, entry.span)
                };
                draft.add_support(support, entry.place);
            } else {
                draft.displace(on, axis, entry);
            }
        }
        for sum in self.sums {
            sum.relate(draft);
        }
    }
}

impl SumInSteps {
    /// Adds a sum as a prescribed difference between the displacement that has the largest
    /// coefficient and the others.
    fn relate(self, draft: &mut Draft) {
        let terms = self.terms.iter();
        let largest = terms.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((&pivot, &c)) = largest else { return };
        let others = self.terms.into_iter().filter(|(key, _)| *key != pivot);
        let terms = others.map(|((node, axis), own)| EquationTerm {
            on: draft.set_of_node(node),
            direction: Direction::ALL[axis as usize],
            coefficient: -own / c,
        });
        let terms = terms.collect();
        let entry = self.entry;
        // A displacement that stays where it is has no values over time.
        let series = match entry.stays {
            true => Series::default(),
            false => entry.series,
        };
        let load = Load {
            on: draft.set_of_node(pivot.0),
            relative: Some(Relative {
                direction: Direction::ALL[pivot.1 as usize],
                value: series.largest() / c,
                terms,
            }),
            since: entry.span.since,
            until: entry.span.until,
            ..Load::default()
        };
        draft.add_load("relative", load, series, entry.place);
    }
}

fn coupled(deck: &Deck, key: Key, entry: &KeyHistory) -> crate::Error {
    let node = deck.mesh.node_name(key.0 as usize);
    let message = format!(
        "node {node} is held along {} only in some steps, and is coupled to nodes without \
         elements that are held otherwise: hold it in all steps",
        key.1 + 1
    );
    unsupported(deck.error(entry.place, "BOUNDARY", message))
}

/// Whether a node is held from the start, where it is in the mesh.
fn is_at_rest(entry: &KeyHistory) -> bool {
    entry.span.since.is_none() && entry.series.is_zero()
}
