//! Kinematic hardening: the back stresses that move the centre of the yield surface.
//!
//! The centre is the sum of `2/3 C_i z_i`. Each `z_i` follows the plastic strain and fades with the
//! equivalent plastic strain p (P. J. Armstrong, C. O. Frederick; several back stresses: J. L.
//! Chaboche):
//!
//! ```text
//! dz_i = deps_p - gamma_i z_i dp,    z_i = eps_p where gamma_i = 0 (W. Prager): stored nowhere
//! ```
//!
//! Over an increment the direction of flow is that at its end, as everywhere in the implicit rule.
//! For a constant direction the law has a closed form: with `d` the increment of p
//!
//! ```text
//! z_i <- e_i z_i + (1 - e_i)/(gamma_i d) deps_p,      e_i = exp(-gamma_i d)
//! ```
//!
//! A path in one direction is therefore exact however long its increments are. In the norm
//! `sqrt(2/3 z:z)` no `z_i` exceeds `1/gamma_i`.
//!
//! # Source
//! W. Prager, *Proc. Inst. Mech. Eng.* 169 (1955) 41; P. J. Armstrong, C. O. Frederick, CEGB report
//! RD/B/N 731 (1966), reprinted in doi:10.3184/096034007X207589; J. L. Chaboche (1989),
//! doi:10.1016/0749-6419(89)90015-6.

use super::history::PlasticState;
use super::tensor::{double_dot, tensor_of};
use serde::{Deserialize, Serialize};

/// Back stresses of a material, linear (Prager) and fading ones.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BackStresses {
    /// Sum of the moduli of the back stresses that do not fade.
    linear: f64,
    /// Modulus C and rate gamma > 0 of each fading back stress, rates ascending.
    fading: Vec<[f64; 2]>,
}

impl BackStresses {
    /// Builds back stresses from moduli and rates `[C, gamma]`.
    pub fn new(laws: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut out = BackStresses::default();
        for [modulus, rate] in laws {
            if rate == 0.0 {
                out.linear += modulus;
            } else if modulus != 0.0 {
                out.fading.push([modulus, rate]);
            }
        }
        // Sorted, however they are listed, because the stored strains are assigned by position.
        out.fading
            .sort_by(|a, b| a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0])));
        out
    }

    /// Whether there are no back stresses.
    pub fn is_none(&self) -> bool {
        self.linear == 0.0 && self.fading.is_empty()
    }

    /// Modulus of the part of kinematic hardening that does not fade.
    pub fn linear(&self) -> f64 {
        self.linear
    }

    /// Number of fading back stresses, each of which is stored at every point.
    pub fn n_stored(&self) -> usize {
        self.fading.len()
    }

    /// Rates gamma of the fading back stresses, ascending.
    pub(crate) fn rates(&self) -> impl Iterator<Item = f64> {
        self.fading.iter().map(|[_, rate]| *rate)
    }

    /// Distance that the centre moves from zero if flow goes on in one direction over `d`:
    /// `C d + sum C_i (1 - e_i)/gamma_i`.
    pub(super) fn gain(&self, d: f64) -> f64 {
        let fading = self.fading.iter();
        let gains = fading.map(|[modulus, rate]| modulus * lost(*rate, d) / rate);
        self.linear * d + gains.sum::<f64>()
    }

    /// Derivative of [`BackStresses::gain`] with respect to `d`.
    pub(super) fn modulus(&self, d: f64) -> f64 {
        let moduli = (self.fading.iter()).map(|[modulus, rate]| modulus * (-rate * d).exp());
        self.linear + moduli.sum::<f64>()
    }

    /// Subtracts the back stress from a stress.
    #[inline]
    pub(super) fn take_off<const S: usize>(
        &self,
        stress: &mut [f64; S],
        plastic: &[f64; S],
        stored: &[[f64; S]],
    ) {
        if self.linear != 0.0 {
            add(stress, -self.linear, plastic);
        }
        for ([modulus, _], strain) in self.fading.iter().zip(stored) {
            add(stress, -modulus, strain);
        }
    }

    /// Back stress that fades over `d`: `sum (1 - e_i) 2/3 C_i z_i`.
    pub(super) fn forgotten<const S: usize>(&self, stored: &[[f64; S]], d: f64) -> [f64; S] {
        self.sum(stored, |rate| lost(rate, d))
    }

    /// Derivative of [`BackStresses::forgotten`] with respect to `d`.
    pub(super) fn forgetting<const S: usize>(&self, stored: &[[f64; S]], d: f64) -> [f64; S] {
        self.sum(stored, |rate| rate * (-rate * d).exp())
    }

    fn sum<const S: usize>(&self, stored: &[[f64; S]], share: impl Fn(f64) -> f64) -> [f64; S] {
        let mut out = [0.0; S];
        for ([modulus, rate], strain) in self.fading.iter().zip(stored) {
            add(&mut out, modulus * share(*rate), strain);
        }
        out
    }

    /// Carries the stored strains from one plastic state to the next. Returns the work per volume
    /// that is lost with the part that fades, `sum 2/3 C_i gamma_i int z_i:z_i dp`.
    pub fn carry<const S: usize>(
        &self,
        stored: &mut [[f64; S]],
        from: &PlasticState<S>,
        to: &PlasticState<S>,
    ) -> f64 {
        let d = to.equivalent - from.equivalent;
        if d <= 0.0 {
            return 0.0;
        }
        let mut work = 0.0;
        for ([modulus, rate], strain) in self.fading.iter().zip(stored) {
            // Limit to which the flow leads, and distance of the strain from it: z = limit + e off.
            let limit: [f64; S] =
                std::array::from_fn(|k| (to.strain[k] - from.strain[k]) / (rate * d));
            let off: [f64; S] = std::array::from_fn(|k| strain[k] - limit[k]);
            let dot = |a: &[f64; S], b: &[f64; S]| double_dot(&tensor_of(a), &tensor_of(b));
            let integral = 0.5 * lost(2.0 * rate, d) * dot(&off, &off)
                + 2.0 * lost(*rate, d) * dot(&off, &limit)
                + rate * d * dot(&limit, &limit);
            work += 2.0 / 3.0 * modulus * integral;
            for (k, strain) in strain.iter_mut().enumerate() {
                *strain -= lost(*rate, d) * off[k];
            }
        }
        work
    }

    /// Work per volume that the back stresses store: `sum C_i/3 z_i:z_i`.
    pub(super) fn held<const S: usize>(&self, plastic: &[f64; S], stored: &[[f64; S]]) -> f64 {
        let square = |strain: &[f64; S]| {
            let strain = tensor_of(strain);
            double_dot(&strain, &strain)
        };
        let fading = self.fading.iter().zip(stored);
        let held = fading.map(|([modulus, _], strain)| modulus * square(strain));
        (self.linear * square(plastic) + held.sum::<f64>()) / 3.0
    }
}

/// Share that fades over `d`: `1 - exp(-rate d)`.
fn lost(rate: f64, d: f64) -> f64 {
    -(-rate * d).exp_m1()
}

/// Adds the back stress `2/3 modulus strain` of a stored strain to a stress.
#[inline]
fn add<const S: usize>(stress: &mut [f64; S], modulus: f64, strain: &[f64; S]) {
    for (stress, tensor) in stress.iter_mut().zip(tensor_of(strain)) {
        *stress += 2.0 / 3.0 * modulus * tensor;
    }
}
