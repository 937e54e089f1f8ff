//! Isotropic tensors: the elastic law, and its reduction by plastic flow.

use super::tensor::{resized, sum};
use serde::{Deserialize, Serialize};

/// Isotropic law `lambda 1 1' + 2 mu I` for strain vectors with engineering shear:
///
/// ```text
/// sigma_i = lambda tr(eps) + 2 mu eps_i   (i = xx, yy, zz),      tau = mu gamma
/// ```
///
/// In plane stress `zz` is left out of the trace and has no stress: `across` is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lame {
    /// First Lamé constant, the factor of the trace.
    pub lambda: f64,
    /// Second Lamé constant, the shear modulus.
    pub mu: f64,
    /// Factor of the `zz` terms: 1, or 0 in plane stress.
    pub across: f64,
}

impl Lame {
    /// The law without any stiffness.
    pub const NONE: Lame = Lame {
        lambda: 0.0,
        mu: 0.0,
        across: 0.0,
    };

    /// The law `a I_dev`, which gives `a` times the deviator of a strain.
    pub(crate) fn of_deviator(a: f64) -> Self {
        Lame {
            lambda: -a / 3.0,
            mu: 0.5 * a,
            across: 1.0,
        }
    }

    /// The bulk modulus `lambda + 2/3 mu`.
    pub(crate) fn bulk(&self) -> f64 {
        self.lambda + 2.0 / 3.0 * self.mu
    }

    /// Stress for an elastic strain.
    #[inline]
    pub fn times<const S: usize>(&self, strain: &[f64; S]) -> [f64; S] {
        let mut out = *strain;
        for stress in &mut out {
            *stress *= self.mu;
        }
        let volume = self.lambda * (strain[0] + strain[1] + self.across * strain[2]);
        for stress in &mut out[..3] {
            *stress = 2.0 * *stress + volume;
        }
        out[2] *= self.across;
        out
    }

    /// Stress for a total strain and its plastic part.
    #[inline]
    pub fn stress<const S: usize>(&self, strain: &[f64; S], plastic: &[f64; S]) -> [f64; S] {
        self.times(&sum(1.0, strain, -1.0, plastic))
    }
}

/// Reduction `D - D_ep` of the stiffness by plastic flow, as an isotropic tensor and a dyad:
/// `lambda 1 1' + 2 mu I + along n n'`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "[f64; S]: Serialize",
    deserialize = "[f64; S]: Deserialize<'de>"
))]
pub struct Softening<const S: usize = 4> {
    /// Isotropic part of the reduction.
    pub isotropic: Lame,
    /// Factor of the dyad `n n'` of `normal`.
    pub along: f64,
    /// Flow direction `n` as a stress.
    pub normal: [f64; S],
}

impl<const S: usize> Softening<S> {
    /// Softening of an elastic point, which is zero.
    pub const NONE: Self = Softening {
        isotropic: Lame::NONE,
        along: 0.0,
        normal: [0.0; S],
    };

    /// Converts to another number of components; components that are missing become zero.
    pub(crate) fn resized<const T: usize>(&self) -> Softening<T> {
        Softening {
            isotropic: self.isotropic,
            along: self.along,
            normal: resized(&self.normal),
        }
    }

    /// Amount of flow for a strain increment: its product with the normal `n`.
    #[inline]
    pub fn flow(&self, strain: &[f64; S]) -> f64 {
        let terms = self.normal.iter().zip(strain);
        terms.map(|(n, e)| n * e).sum()
    }

    /// Stress that flow takes off the elastic stress of a strain increment.
    #[inline]
    pub fn times(&self, strain: &[f64; S]) -> [f64; S] {
        let mut out = self.isotropic.times(strain);
        let share = self.along * self.flow(strain);
        for (out, n) in out.iter_mut().zip(&self.normal) {
            *out += share * n;
        }
        out
    }
}
