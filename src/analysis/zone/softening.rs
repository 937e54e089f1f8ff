//! Softening: the part of the stiffness of the zone's elements that plastic flow takes off.

use super::points::{GRAIN, ZoneOf, at_point, put};
use crate::element::Gradients;
use crate::material::Softening;
use crate::substructure::Trailing;
use rayon::prelude::*;

/// Number of elements whose matrices are held at a time.
const AT_ONCE: usize = 256;

impl<const D: usize, const S: usize, const P: usize, const N: usize> ZoneOf<D, S, P, N> {
    /// Computes `out = sum_g w_g B' (D - D_ep) B v` at the last evaluated state, for a `v` that
    /// vanishes on the prescribed freedoms.
    pub fn softening_times(&mut self, v: &Trailing, out: &mut Trailing) {
        let softening = std::mem::take(&mut self.softening);
        let turn = std::mem::take(&mut self.turn);
        let active = std::mem::take(&mut self.active);
        self.times((&softening, &turn, &active), v, out);
        (self.softening, self.turn, self.active) = (softening, turn, active);
    }

    /// Multiplies `v` by the given softening of the points, its unsymmetric part and the list of
    /// elements that have any.
    fn times(
        &mut self,
        (softening, turn, active): (&[Softening<S>], &[[f64; S]], &[u32]),
        v: &Trailing,
        out: &mut Trailing,
    ) {
        let nodal = self.nodal.variation(v);
        let (elements, gradients, stride) = (&self.elements, &self.gradients, self.stride);
        active
            .par_iter()
            .zip(&mut self.forces[..active.len()])
            .with_min_len(GRAIN)
            .for_each(|(&i, force)| {
                let i = i as usize;
                let gradients = &gradients[i];
                let strains = gradients.strains(&elements.displacements(i, nodal));
                let mut stress = [[0.0; P]; S];
                let points = &softening[i * stride..][..gradients.n_points()];
                for (g, lost) in points.iter().enumerate() {
                    let strain = at_point(&strains, g);
                    let mut out = lost.times(&strain);
                    if let Some(turn) = turn.get(i * stride + g) {
                        let flow = lost.flow(&strain);
                        out = std::array::from_fn(|k| out[k] + flow * turn[k]);
                    }
                    put(&mut stress, g, out);
                }
                *force = gradients.forces(&stress);
            });
        let sums = self.sums.start_sum(None);
        for (&i, force) in active.iter().zip(&self.forces) {
            self.elements.scatter(i as usize, force, sums);
        }
        self.sums.sum_into(out);
    }

    /// Keeps the tangent of the last evaluated state.
    pub fn keep_softening(&mut self) {
        let kept = self.kept.get_or_insert_default();
        kept.softening.clone_from(&self.softening);
        kept.active.clone_from(&self.active);
    }

    /// Forgets the tangent that was kept.
    pub fn forget_softening(&mut self) {
        self.kept = None;
    }

    /// Computes `out = sum_g w_g B' (D - D_ep) B v` with the tangent that was kept; zero if none
    /// was kept.
    pub fn kept_softening_times(&mut self, v: &Trailing, out: &mut Trailing) {
        let Some(kept) = self.kept.take() else {
            out.fill(0.0);
            return;
        };
        self.times((&kept.softening, &[], &kept.active), v, out);
        self.kept = Some(kept);
    }

    /// Marks the zone freedoms of elements in which a point yielded when the tangent was kept.
    pub fn mark_kept(&self, marks: &mut [bool]) {
        for &i in self.kept.iter().flat_map(|kept| &kept.active) {
            self.elements.mark(i as usize, marks);
        }
    }

    /// Passes to `take` a share of the softening `sum_g w_g B' (D - D_ep) B` of each element at the
    /// last evaluated state: the places of the matrix's rows, and the matrix by columns.
    pub fn each_softening(&self, share: f64, mut take: impl FnMut(&[u32], &[f64])) {
        for active in self.active.chunks(AT_ONCE) {
            let matrices: Vec<_> = (active.par_iter())
                .map(|&i| {
                    let i = i as usize;
                    let own = &self.softening[i * self.stride..];
                    let columns = element_softening(&self.gradients[i], own, share);
                    self.elements.spread(i, &columns)
                })
                .collect();
            for (places, matrix) in &matrices {
                take(places, matrix);
            }
        }
    }
}

/// The softening matrix of an element times `share`. Each column holds the forces on the nodes that
/// plastic flow takes off for a unit of one displacement.
fn element_softening<const D: usize, const S: usize, const P: usize, const N: usize>(
    gradients: &Gradients<D, S, P, N>,
    softening: &[Softening<S>],
    share: f64,
) -> Vec<[[f64; D]; N]> {
    let column = |j: usize| {
        let mut u = [[0.0; D]; N];
        u.as_flattened_mut()[j] = share;
        let strains = gradients.strains(&u);
        let mut stress = [[0.0; P]; S];
        for (g, lost) in softening[..gradients.n_points()].iter().enumerate() {
            put(&mut stress, g, lost.times(&at_point(&strains, g)));
        }
        gradients.forces(&stress)
    };
    (0..D * gradients.n_nodes()).map(column).collect()
}
