//! Isotropic tensors: the elastic law, and what plastic flow takes off it.

use super::sum;
use serde::{Deserialize, Serialize};

/// `lambda 1 1' + 2 mu I` acting on strain vectors with engineering shear:
///
/// ```text
/// sigma_i = lambda tr(eps) + 2 mu eps_i   (i = xx, yy, zz),      tau = mu gamma
/// ```
///
/// In plane stress `zz` neither counts in the trace nor has a stress: `across` is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lame {
    /// Times the trace.
    pub lambda: f64,
    /// The shear modulus.
    pub mu: f64,
    /// 1, or 0 in plane stress.
    pub across: f64,
}

impl Lame {
    /// The law without any stiffness.
    pub const NONE: Lame = Lame {
        lambda: 0.0,
        mu: 0.0,
        across: 0.0,
    };

    /// `a I_dev`: a times the deviator of a strain.
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

    /// The stress of an elastic strain.
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

    /// The stress of a total strain with a plastic part.
    #[inline]
    pub fn stress<const S: usize>(&self, strain: &[f64; S], plastic: &[f64; S]) -> [f64; S] {
        self.times(&sum(1.0, strain, -1.0, plastic))
    }
}

/// `D - D_ep`, an isotropic tensor and a dyad: `lambda 1 1' + 2 mu I + along n n'`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "[f64; S]: Serialize",
    deserialize = "[f64; S]: Deserialize<'de>"
))]
pub struct Softening<const S: usize = 4> {
    /// The isotropic part.
    pub isotropic: Lame,
    /// Times the dyad of `normal`.
    pub along: f64,
    /// A stress vector along the flow.
    pub normal: [f64; S],
}

impl<const S: usize> Softening<S> {
    /// Softening of an elastic point: none.
    pub const NONE: Self = Softening {
        isotropic: Lame::NONE,
        along: 0.0,
        normal: [0.0; S],
    };

    /// Softening with another number of components: zeros for the components it has not.
    pub(crate) fn resized<const T: usize>(&self) -> Softening<T> {
        Softening {
            isotropic: self.isotropic,
            along: self.along,
            normal: super::resized(&self.normal),
        }
    }

    /// Amount of flow that a strain increment makes: what it adds to the stress along the normal.
    #[inline]
    pub fn flow(&self, strain: &[f64; S]) -> f64 {
        let terms = self.normal.iter().zip(strain);
        terms.map(|(n, e)| n * e).sum()
    }

    /// What is lost of the stress of a strain increment.
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
