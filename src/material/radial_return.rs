//! Radial return in plane strain, axisymmetric and three-dimensional space.
//!
//! Let `s(d)` be the trial deviator (minus the back stress) plus the back stress that fades over
//! the increment `d` of equivalent plastic strain (see [`super::back_stresses`]),
//! `q = sqrt(3/2 s:s)`, `n = s/|s|`, `K(d)` the gain of the back stresses and `s' = ds/dd`:
//!
//! ```text
//! q(d) - 3 G d - K(d) = sigma_y(eps + d)            one scalar equation for d
//! eps_p += d (3/2) s/q
//! R = 3G + K' + H - sqrt(3/2) n:s'
//! D - D_ep = 2G (3 G d/q) I_dev + 2G (3G/R - 3 G d/q) n n' + 2G (3 G d/q) sqrt(3/2)/R t n'
//! t = s' - (n:s') n
//! ```
//!
//! No back stress exceeds `C/gamma`, so that `sqrt(3/2) |s'| <= K' - C_linear`: the left-hand side
//! falls by at least `3 G d`, which brackets the solution. Without fading back stresses `s` is
//! constant, and the equation is linear on each segment of the hardening curve. The last term of
//! `D - D_ep`, the only unsymmetric one, vanishes if flow is along the back stress.
//!
//! # Source
//! Simo and Hughes (1998), boxes 3.1 and 3.2; one equation for several back stresses: M. Kobayashi,
//! N. Ohno (2002), doi:10.1002/nme.428, with their implicit rule for each back stress replaced by
//! its closed form.

use super::tensor::{double_dot, von_mises};
use super::{Hardening, Lame, Material, Past, PlasticState, Softening, Update, flow_to_root};

/// Plastic flow of one increment.
pub(super) struct PlasticFlow<const S: usize> {
    /// Plastic state at the end of the flow.
    pub state: PlasticState<S>,
    /// Relative stress `s(d)`.
    s: [f64; S],
    /// Von Mises stress `q` of `s(d)`.
    q: f64,
    d: f64,
    /// Slope `H` of the hardening curve at the end of the flow.
    slope: f64,
}

impl<const S: usize> PlasticFlow<S> {
    /// An increment without any flow.
    pub fn none(state: PlasticState<S>) -> Self {
        PlasticFlow {
            state,
            s: [0.0; S],
            q: 0.0,
            d: 0.0,
            slope: 0.0,
        }
    }

    /// Direction of flow as a stress of size 1; `None` if there is no flow.
    pub fn normal(&self) -> Option<[f64; S]> {
        let norm = double_dot(&self.s, &self.s).sqrt();
        (norm > 0.0).then(|| self.s.map(|s| s / norm))
    }

    /// Ratio `(3/2) d/q` of the plastic strain to the trial stress, for a trial stress across the
    /// flow.
    pub fn across(&self) -> f64 {
        if self.d > 0.0 {
            1.5 * self.d / self.q
        } else {
            0.0
        }
    }
}

pub(super) fn flow<const S: usize>(
    material: &Material,
    hardening: &Hardening,
    trial: &[f64; S],
    old: &Past<S>,
) -> PlasticFlow<S> {
    let g = material.shear_modulus();
    let laws = &material.back_stresses;
    let start = deviator(trial);
    let equivalent = old.state.equivalent;
    let (d, slope, s, q) = if laws.n_stored() == 0 {
        let q = von_mises(&start);
        let (d, slope) = hardening.solve(q - old.harder, 3.0 * g + laws.linear(), equivalent);
        (d, slope, start, q)
    } else {
        let at = |d: f64| {
            let forgotten = laws.forgotten(old.back, d);
            std::array::from_fn(|k| start[k] + forgotten[k])
        };
        let excess = |d: f64| {
            von_mises(&at(d)) - 3.0 * g * d - laws.gain(d) - old.yield_stress(hardening, d)
        };
        let d = flow_to_root(excess, 3.0 * g, old.yield_stress(hardening, 0.0));
        let s = at(d);
        (d, hardening.slope(equivalent + d), s, von_mises(&s))
    };
    let multiplier = 1.5 * d / q;
    let mut state = *old.state;
    state.equivalent += d;
    for i in 0..S {
        // The stored strains have engineering shear.
        let doubled = if i < 3 { 1.0 } else { 2.0 };
        state.strain[i] += doubled * multiplier * s[i];
    }
    PlasticFlow {
        state,
        s,
        q,
        d,
        slope,
    }
}

pub(super) fn integrate<const S: usize>(
    material: &Material,
    hardening: &Hardening,
    trial: &[f64; S],
    old: &Past<S>,
) -> Update<S> {
    let PlasticFlow {
        state, s, d, slope, ..
    } = flow(material, hardening, trial, old);
    let g = material.shear_modulus();
    let laws = &material.back_stresses;
    let norm = double_dot(&s, &s).sqrt();
    let q = 1.5f64.sqrt() * norm;
    let normal = s.map(|s| s / norm);
    let forgetting = laws.forgetting(old.back, d);
    let along_flow = double_dot(&normal, &forgetting);
    let resistance = 3.0 * g + laws.modulus(d) + slope - 1.5f64.sqrt() * along_flow;
    let shrink = 3.0 * g * d / q;
    let turn = 2.0 * g * shrink * 1.5f64.sqrt() / resistance;
    Update {
        state,
        softening: Softening {
            isotropic: Lame::of_deviator(2.0 * g * shrink),
            along: 2.0 * g * (3.0 * g / resistance - shrink),
            normal,
        },
        turn: std::array::from_fn(|k| turn * (forgetting[k] - along_flow * normal[k])),
        yields: true,
    }
}

fn deviator<const S: usize>(stress: &[f64; S]) -> [f64; S] {
    let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    let mut out = *stress;
    out[..3].iter_mut().for_each(|s| *s -= mean);
    out
}
