//! Plastic history of a point, before and after an increment.

use super::hardening::Hardening;
use super::lame::Softening;
use super::tensor::resized;
use serde::{Deserialize, Serialize};

/// Plastic history at a Gauss point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "[f64; S]: Serialize",
    deserialize = "[f64; S]: Deserialize<'de>"
))]
pub struct PlasticState<const S: usize = 4> {
    /// Plastic strain, trace 0.
    pub strain: [f64; S],
    /// Equivalent plastic strain, the time integral of `sqrt(2/3 deps_p : deps_p)`.
    pub equivalent: f64,
}

impl<const S: usize> Default for PlasticState<S> {
    fn default() -> Self {
        PlasticState {
            strain: [0.0; S],
            equivalent: 0.0,
        }
    }
}

impl<const S: usize> PlasticState<S> {
    /// Converts to another number of components; components that are missing become zero.
    pub(crate) fn resized<const T: usize>(&self) -> PlasticState<T> {
        PlasticState {
            strain: resized(&self.strain),
            equivalent: self.equivalent,
        }
    }
}

/// History of a point before an increment.
#[derive(Debug, Clone, Copy)]
pub struct Past<'a, const S: usize> {
    /// Plastic history of the point.
    pub state: &'a PlasticState<S>,
    /// Strains of the fading back stresses, in the order of the material's: engineering shear,
    /// trace 0.
    pub back: &'a [[f64; S]],
    /// Yield stress at the point minus that of the material.
    pub harder: f64,
}

impl<const S: usize> Past<'_, S> {
    /// Yield stress after an increment `d` of equivalent plastic strain.
    #[inline]
    pub(super) fn yield_stress(&self, hardening: &Hardening, d: f64) -> f64 {
        hardening.yield_stress(self.state.equivalent + d) + self.harder
    }
}

/// Result of integrating the flow rule over an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update<const S: usize> {
    /// Plastic history at the end of the increment.
    pub state: PlasticState<S>,
    /// Reduction `D - D_ep` of the elastic stiffness by plastic flow; zero if elastic.
    pub softening: Softening<S>,
    /// Remaining part of `D - D_ep`, as the dyad of this stress and the softening's normal: the
    /// direction of flow turns as back stresses fade. Zero without fading back stresses.
    pub turn: [f64; S],
    /// Whether plastic flow took place.
    pub yields: bool,
}
