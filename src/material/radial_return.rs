//! Radial return: plane strain and axisymmetric.
//!
//! With the trial deviator `s` (less the back stress), `q = sqrt(3/2 s:s)` and `n = s/|s|`:
//!
//! ```text
//! q - (3 G + C) d = sigma_y(eps + d)        increment d of equivalent plastic strain
//! eps_p += d (3/2) s/q
//! D - D_ep = 2G (3 G d/q) I_dev + 2G (1/(1 + (H + C)/3G) - 3 G d/q) n n'
//! ```
//!
//! # Source
//! Simo and Hughes (1998), boxes 3.1 and 3.2.

use super::{Hardening, Lame, Material, PlasticState, Softening, Update};

pub(super) fn integrate<const S: usize>(
    material: &Material,
    hardening: &Hardening,
    trial: &[f64; S],
    old: &PlasticState<S>,
) -> Update<S> {
    let g = material.shear_modulus();
    let mean = (trial[0] + trial[1] + trial[2]) / 3.0;
    let mut s = *trial;
    s[..3].iter_mut().for_each(|s| *s -= mean);
    let normal: f64 = s[..3].iter().map(|s| s * s).sum();
    let shear: f64 = s[3..].iter().map(|s| s * s).sum();
    let norm = (normal + 2.0 * shear).sqrt();
    let q = 1.5f64.sqrt() * norm;
    let kinematic = material.kinematic_modulus;
    let (d, slope) = hardening.solve(q, 3.0 * g + kinematic, old.equivalent);
    let multiplier = 1.5 * d / q;
    let mut state = *old;
    state.equivalent += d;
    for (i, (strain, s)) in state.strain.iter_mut().zip(&s).enumerate() {
        // Shear strains are engineering strains.
        *strain += if i < 3 {
            multiplier * s
        } else {
            2.0 * multiplier * s
        };
    }
    let shrink = 3.0 * g * d / q;
    Update {
        state,
        softening: Softening {
            isotropic: Lame::of_deviator(2.0 * g * shrink),
            along: 2.0 * g * (1.0 / (1.0 + (slope + kinematic) / (3.0 * g)) - shrink),
            normal: s.map(|s| s / norm),
        },
        yields: true,
    }
}
