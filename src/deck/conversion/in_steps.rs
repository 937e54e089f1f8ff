//! Supports that begin or end in a later step: `*BOUNDARY` from a later step on, `FIXED`, and
//! `OP=NEW`, which releases what it does not repeat.

use super::super::bodies::unsupported;
use super::super::history::{Entry, Key};
use super::super::linear::Reduced;
use super::Draft;
use super::conditions::made;
use crate::error::Result;
use crate::scene::span::Span;
use crate::scene::{Direction, Support};
use std::collections::BTreeMap;

/// What is done to nodes over the same steps, as a key: axis, node with axes of its own, span,
/// whether the nodes stay where they are, and the values over time.
type Done = (u8, Option<u32>, [Option<[u64; 2]>; 2], bool, Vec<u64>);

impl Draft<'_> {
    /// Passes conditions on nodes without elements, and on displacements that follow another one,
    /// on to the displacement to which they are coupled.
    ///
    /// # Errors
    /// `Unsupported` for a displacement that is coupled to several others.
    pub(super) fn pass_on_in_steps(
        &self,
        reduced: &Reduced,
        in_steps: &mut [(Key, Entry)],
    ) -> Result<()> {
        for (key, entry) in in_steps {
            let mut all = reduced.loose.iter().chain(&reduced.others);
            let Some(follows) = all.find(|follows| follows.key == *key) else {
                continue;
            };
            let mut of = follows.of.iter();
            let (Some((to, share)), None) = (of.next(), of.next()) else {
                let node = self.deck.node_name(key.0 as usize);
                let message = format!(
                    "node {node} is held along {} only in some steps, and equations or a rigid \
                     body couple it to several displacements: hold one of these, or the node in \
                     all steps",
                    key.1 + 1
                );
                return Err(unsupported(self.deck.error(
                    entry.place,
                    "BOUNDARY",
                    message,
                )));
            };
            entry.series = entry.series.multiplied(1.0 / share);
            *key = *to;
        }
        Ok(())
    }

    /// Turns conditions that begin or end in a later step into supports and prescribed
    /// displacements.
    ///
    /// # Errors
    /// `Unsupported` for a displacement along axes of a `*TRANSFORM` that has a value.
    pub(super) fn boundary_in_steps(&mut self, in_steps: Vec<(Key, Entry)>) -> Result<()> {
        let axes = self.deck.local_axes()?;
        let mut groups: BTreeMap<Done, (Vec<u32>, Entry)> = BTreeMap::new();
        for ((node, axis), entry) in in_steps {
            if !self.geometry.uses(node) {
                continue;
            }
            let bits = |span: Span| {
                let since = span.since.map(|since| [since.to_bits(); 2]);
                [since, span.until.map(|until| until.map(f64::to_bits))]
            };
            // Supports of nodes with axes of their own are made node by node.
            let own = axes.get(&node).map(|_| node);
            let key = (
                axis,
                own,
                bits(entry.span),
                entry.stays,
                entry.series.bits(),
            );
            groups
                .entry(key)
                .or_insert((Vec::new(), entry))
                .0
                .push(node);
        }
        for ((axis, own, ..), (nodes, entry)) in groups {
            let on = self
                .geometry
                .add_nodes(&made("boundary", entry.place), nodes);
            let is_at_rest = entry.span.since.is_none() && entry.series.is_zero();
            match own.and_then(|node| axes.get(&node)) {
                Some(axes) if entry.stays || is_at_rest => {
                    let support = Support {
                        direction: Some(self.components(axes[axis as usize])),
                        ..Support::over(on, entry.span)
                    };
                    self.add_support(support, entry.place);
                }
                Some(_) => {
                    let node = self.deck.node_name(own.unwrap_or(0) as usize);
                    let message = format!(
                        "node {node} has axes of its own, and is moved along {} only in some \
                         steps: move it in all steps, or along x, y and z",
                        axis + 1
                    );
                    return Err(unsupported(self.deck.error(
                        entry.place,
                        "BOUNDARY",
                        message,
                    )));
                }
                None if entry.stays || is_at_rest => {
                    let support = Support {
                        fix: vec![Direction::ALL[axis as usize]],
                        ..Support::over(on, entry.span)
                    };
                    self.add_support(support, entry.place);
                }
                None => self.displace(on, axis, entry),
            }
        }
        Ok(())
    }
}
