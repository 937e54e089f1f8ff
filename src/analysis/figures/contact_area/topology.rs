//! The pairs of a contact, and the faces between them.

use crate::model::ContactSurface;
use crate::space::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// The relation between the pairs of a contact and their faces.
pub(super) struct Topology<'m> {
    pub(super) start: usize,
    pub(super) faces: &'m [Vec<usize>],
    /// Covered parts of the faces that are covered only in part.
    pub(super) covered: &'m BTreeMap<usize, Vec<Vec<Vector>>>,
    /// Pieces with too few pairs of their own: the pairs next to them, and their covered parts.
    pub(super) slivers: &'m [(Vec<usize>, Vec<Vec<Vector>>)],
    /// Faces at each pair.
    pub(super) at: Vec<Vec<u32>>,
}

impl<'m> Topology<'m> {
    pub(super) fn new(surface: &'m ContactSurface) -> Self {
        let (range, faces) = (&surface.range, &surface.faces);
        let mut at = vec![Vec::new(); range.len()];
        for (face, corners) in faces.iter().enumerate() {
            for &k in corners {
                at[k - range.start].push(face as u32);
            }
        }
        Topology {
            start: range.start,
            faces,
            covered: &surface.covered,
            slivers: &surface.slivers,
            at,
        }
    }

    /// Pairs that share a face with pair `k`, itself included.
    pub(super) fn around(&self, k: usize) -> impl Iterator<Item = usize> + '_ {
        let faces = self.at[k - self.start].iter();
        faces.flat_map(|&face| self.faces[face as usize].iter().copied())
    }

    /// Splits a set of pairs into connected sets.
    pub(super) fn connected(&self, closed: &BTreeSet<usize>) -> Vec<BTreeSet<usize>> {
        let mut left = closed.clone();
        let mut out = Vec::new();
        while let Some(first) = left.pop_first() {
            let mut members = BTreeSet::from([first]);
            let mut edge = vec![first];
            while let Some(k) = edge.pop() {
                for other in self.around(k) {
                    if left.remove(&other) {
                        members.insert(other);
                        edge.push(other);
                    }
                }
            }
            out.push(members);
        }
        out
    }
}
