//! Radial return: plane strain and axisymmetric.
//!
//! With the trial deviator `s`, `q = sqrt(3/2 s:s)` and `n = s/|s|`:
//!
//! ```text
//! q - 3 G d = sigma_y(eps + d)              increment d of equivalent plastic strain
//! eps_p += d (3/2) s/q
//! D - D_ep = 2G (3 G d/q) I_dev + 2G (1/(1 + H/3G) - 3 G d/q) n n'
//! ```
//!
//! # Source
//! Simo and Hughes (1998), boxes 3.1 and 3.2.

use super::{Hardening, Material, PlasticState, Update};

pub(super) fn integrate(
    material: &Material,
    hardening: &Hardening,
    trial: &[f64; 4],
    old: &PlasticState,
) -> Update {
    let g = material.shear_modulus();
    let mean = (trial[0] + trial[1] + trial[2]) / 3.0;
    let s = [trial[0] - mean, trial[1] - mean, trial[2] - mean, trial[3]];
    let norm = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * s[3] * s[3]).sqrt();
    let q = 1.5f64.sqrt() * norm;
    let (d, slope) = hardening.solve(q, 3.0 * g, old.equivalent);
    let flow = 1.5 * d / q;
    let mut state = *old;
    state.equivalent += d;
    for i in 0..3 {
        state.strain[i] += flow * s[i];
    }
    state.strain[3] += 2.0 * flow * s[3];

    let shrink = 3.0 * g * d / q;
    let along = 1.0 / (1.0 + slope / (3.0 * g)) - shrink;
    let n = [s[0] / norm, s[1] / norm, s[2] / norm, s[3] / norm];
    let mut softening = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            let deviator = match (i, j) {
                (3, 3) => 0.5,
                (3, _) | (_, 3) => 0.0,
                _ if i == j => 2.0 / 3.0,
                _ => -1.0 / 3.0,
            };
            softening[i][j] = 2.0 * g * (shrink * deviator + along * n[i] * n[j]);
        }
    }
    Update {
        state,
        softening,
        flows: true,
    }
}
