//! The nodes at which gaps and pressures of a contact are shown in the files of CalculiX.

use crate::model::Model;
use crate::results::PairState;

/// The nodes of the first surface of each contact, which is the slave surface of a deck.
pub(super) struct Slaves<'a> {
    model: &'a Model,
    firsts: Vec<Vec<usize>>,
    /// Half the diagonal of the model.
    far: f64,
}

impl<'a> Slaves<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let contacts = model.scene.contact.iter();
        let nodes = contacts.map(|contact| model.mesh.set_nodes(&contact.first));
        Slaves {
            model,
            firsts: nodes.map(Option::unwrap_or_default).collect(),
            far: 0.5 * model.mesh.diagonal(),
        }
    }

    /// Returns the gap of a pair, negative if the surfaces overlap. The gap of a pair that a step
    /// switches off (`*MODEL CHANGE`) is 0; in the results of brinell such a pair is apart by more
    /// than half the diagonal of the model.
    pub(super) fn gap(&self, of_pair: &PairState) -> f64 {
        if of_pair.gap > self.far {
            return 0.0;
        }
        of_pair.gap
    }

    /// Whether a node is on the first surface of a contact.
    pub(super) fn is_on_first(&self, node: usize, contact: usize) -> bool {
        let first = self.firsts.get(contact);
        first.is_some_and(|first| first.binary_search(&node).is_ok())
    }

    /// Returns the node of a pair: the node of the first surface if two nodes face each other,
    /// otherwise the slave of the pair.
    pub(super) fn node(&self, of_pair: &PairState) -> Option<usize> {
        let pair = self.model.shown_pair(of_pair.contact, of_pair.pair)?;
        let is_on_first = |node: &usize| self.is_on_first(*node, of_pair.contact);
        Some(pair.faced().filter(is_on_first).unwrap_or(pair.slave))
    }
}
