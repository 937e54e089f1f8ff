//! The plastic history of the points of a zone, and the strains that fading back stresses keep.

use super::packed;
use crate::material::{Memory, PlasticState, resized};
use crate::results::EndState;
use rayon::iter::Either;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The history of Gauss points. In a plane model, the two shear components out of the plane are
/// zero.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PointHistory {
    /// Plastic history of each point.
    #[serde(with = "packed::history")]
    pub points: Vec<PlasticState<6>>,
    /// Strains that the back stresses keep at each point.
    pub back: BackStrains<6>,
}

impl From<&EndState> for PointHistory {
    fn from(state: &EndState) -> Self {
        let points = state.strains.iter().zip(&state.equivalent);
        PointHistory {
            points: points
                .map(|(strain, equivalent)| PlasticState {
                    strain: *strain,
                    equivalent: *equivalent,
                })
                .collect(),
            back: BackStrains {
                each: state.back_strains.len() / state.strains.len().max(1),
                strains: state.back_strains.clone(),
                lost_work: state.lost_work.clone(),
            },
        }
    }
}

impl PointHistory {
    /// Returns the plastic state of the given elements, whose points the history must hold element
    /// by element. Elements without plastic strain are left out.
    pub fn end_state(&self, elements: &[usize]) -> EndState {
        let mut out = EndState::default();
        let stride = self.points.len() / elements.len().max(1);
        let (each, back) = (self.back.each, &self.back);
        for (i, &element) in elements.iter().enumerate() {
            let points = i * stride..(i + 1) * stride;
            let own = &self.points[points.clone()];
            if own.iter().all(|state| state.equivalent == 0.0) {
                continue;
            }
            out.elements.push(element);
            out.strains.extend(own.iter().map(|state| state.strain));
            out.equivalent
                .extend(own.iter().map(|state| state.equivalent));
            out.back_strains
                .extend(&back.strains[each * points.start..each * points.end]);
            if !back.is_none() {
                out.lost_work.extend(&back.lost_work[points]);
            }
        }
        out
    }

    /// Whether the history has `n_points` points.
    pub fn is_of(&self, n_points: usize) -> bool {
        self.points.len() == n_points && self.back.is_of(n_points)
    }
}

/// The strains of fading back stresses, point by point, and the work lost as they fade. Empty if no
/// material has such a back stress.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(bound(
    serialize = "[f64; S]: Serialize",
    deserialize = "[f64; S]: Deserialize<'de>"
))]
pub struct BackStrains<const S: usize> {
    /// Number of fading back stresses at each point.
    each: usize,
    strains: Vec<[f64; S]>,
    /// Work lost at each point, per volume.
    lost_work: Vec<f64>,
}

impl<const S: usize> BackStrains<S> {
    /// Zero strains for `each` back stresses at `n_points` points.
    pub fn new(each: usize, n_points: usize) -> Self {
        BackStrains {
            each,
            strains: vec![[0.0; S]; each * n_points],
            lost_work: vec![0.0; if each > 0 { n_points } else { 0 }],
        }
    }

    /// Whether there are no fading back stresses.
    pub fn is_none(&self) -> bool {
        self.each == 0
    }

    /// Bytes of heap held.
    pub fn bytes(&self) -> usize {
        self.strains.capacity() * size_of::<[f64; S]>()
            + self.lost_work.capacity() * size_of::<f64>()
    }

    fn is_of(&self, n_points: usize) -> bool {
        let n = if self.is_none() { 0 } else { n_points };
        self.strains.len() == self.each * n_points && self.lost_work.len() == n
    }

    /// Strains of the back stresses of a point.
    #[inline]
    pub fn of(&self, point: usize) -> &[[f64; S]] {
        &self.strains[self.each * point..][..self.each]
    }

    /// The work lost at a point, per volume.
    pub fn lost_work(&self, point: usize) -> f64 {
        self.lost_work.get(point).copied().unwrap_or(0.0)
    }

    /// Takes over the back strains of a point at the last evaluated state, and adds the work that
    /// was lost on the way there.
    pub fn take(&mut self, point: usize, trial: &PathEnds<S>) {
        if !self.is_none() {
            let own = &mut self.strains[self.each * point..][..self.each];
            own.copy_from_slice(&trial.strains[2 * self.each * point..][..self.each]);
            self.lost_work[point] += trial.lost_work[point];
        }
    }

    /// Returns the back strains of all points with another number of components.
    pub fn resized<const T: usize>(&self) -> BackStrains<T> {
        BackStrains {
            each: self.each,
            strains: self.strains.iter().map(resized).collect(),
            lost_work: self.lost_work.clone(),
        }
    }

    /// Overwrites the back strains and lost work of some points with those of `other`, from its
    /// point `from` on.
    pub fn put(&mut self, points: Range<usize>, other: &BackStrains<6>, from: usize) {
        if self.is_none() {
            return;
        }
        let n = self.each * points.len();
        let known = &other.strains[self.each * from..][..n];
        let own = &mut self.strains[self.each * points.start..][..n];
        for (own, known) in own.iter_mut().zip(known) {
            *own = resized(known);
        }
        let lost = &other.lost_work[from..][..points.len()];
        self.lost_work[points].copy_from_slice(lost);
    }

    /// Sets the back strains and the lost work of some points to zero.
    pub fn clear(&mut self, points: Range<usize>) {
        if !self.is_none() {
            self.strains[self.each * points.start..self.each * points.end].fill([0.0; S]);
            self.lost_work[points].fill(0.0);
        }
    }
}

/// Back strains at the end of the strain paths of a trial increment. The plastic states at these
/// ends are stored elsewhere.
pub struct PathEnds<const S: usize> {
    each: usize,
    /// Per point: its `each` strains, then work space for `each` strains.
    strains: Vec<[f64; S]>,
    lost_work: Vec<f64>,
}

/// Path ends of the points of one element.
pub struct PathEndsOf<'a, const S: usize> {
    each: usize,
    strains: &'a mut [[f64; S]],
    lost_work: &'a mut [f64],
}

impl<const S: usize> PathEnds<S> {
    /// Path ends of `n_points` points with `each` fading back stresses.
    pub fn new(each: usize, n_points: usize) -> Self {
        PathEnds {
            each,
            strains: vec![[0.0; S]; 2 * each * n_points],
            lost_work: vec![0.0; if each > 0 { n_points } else { 0 }],
        }
    }

    /// Bytes of heap held.
    pub fn bytes(&self) -> usize {
        self.strains.capacity() * size_of::<[f64; S]>()
            + self.lost_work.capacity() * size_of::<f64>()
    }

    /// Splits the path ends into those of `n` elements with `stride` points each.
    pub fn par_chunks_mut(
        &mut self,
        stride: usize,
        n: usize,
    ) -> impl IndexedParallelIterator<Item = PathEndsOf<'_, S>> {
        let each = self.each;
        chunks_or_none(&mut self.strains, 2 * each * stride, n)
            .zip(chunks_or_none(&mut self.lost_work, stride, n))
            .map(move |(strains, lost_work)| PathEndsOf {
                each,
                strains,
                lost_work,
            })
    }
}

impl<const S: usize> PathEndsOf<'_, S> {
    /// The places for the back strains of a point, and its work space.
    #[inline]
    pub fn memory_of(&mut self, point: usize) -> Memory<'_, S> {
        let own = &mut self.strains[2 * self.each * point..][..2 * self.each];
        let (strains, between) = own.split_at_mut(self.each);
        Memory {
            strains,
            between,
            lost_work: 0.0,
        }
    }

    /// Stores the work lost at a point.
    #[inline]
    pub fn keep_lost_work(&mut self, point: usize, work: f64) {
        if let Some(own) = self.lost_work.get_mut(point) {
            *own = work;
        }
    }
}

/// Splits values into pieces of `size`; without any values, returns `n` empty pieces.
pub(super) fn chunks_or_none<T: Send>(
    values: &mut [T],
    size: usize,
    n: usize,
) -> impl IndexedParallelIterator<Item = &mut [T]> {
    match values.is_empty() {
        true => Either::Left((0..n).into_par_iter().map(|_| &mut [][..])),
        false => Either::Right(values.par_chunks_mut(size)),
    }
}
