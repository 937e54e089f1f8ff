//! Pairs and the faces between them.

use crate::model::ContactSurface;
use crate::space::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// Which pairs of a contact share faces.
pub(super) struct Topology<'m> {
    pub(super) start: usize,
    pub(super) faces: &'m [Vec<usize>],
    /// What is covered of faces that are covered in part.
    pub(super) covered: &'m BTreeMap<usize, Vec<Vec<Vector>>>,
    /// Pairs beside pieces that have too few of their own, and what is covered of these.
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

    /// Pairs that share a face with a pair, itself included.
    pub(super) fn around(&self, k: usize) -> impl Iterator<Item = usize> + '_ {
        let faces = self.at[k - self.start].iter();
        faces.flat_map(|&face| self.faces[face as usize].iter().copied())
    }

    /// The connected sets of some pairs.
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
