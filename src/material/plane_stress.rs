//! Return mapping in plane stress, which keeps the stress in the plane.
//!
//! With `P = [[2, -1, 0], [-1, 2, 0], [0, 0, 6]]/3`, the stress `xi = sigma - alpha` relative to
//! the plane stress `alpha` whose deviator is the back stress, and `eps_p += (3/2) d P u`,
//! `u = xi/sigma_y`, everything decouples in the eigenvectors (1, 1, 0), (1, -1, 0) and (0, 0, 1)
//! that `D` and `P` share, `D P` having the eigenvalues `m = E/(3 (1 - nu))` and `2 G`. Let `x(d)`
//! be the trial stress plus the back stress that fades over the increment `d` of equivalent plastic
//! strain (see [`super::back_stresses`]), and `K(d)` the gain of the back stresses:
//!
//! ```text
//! b_j(d) = sigma_y(eps + d) + K(d) + (3/2) m_j d,        u_j = x_j(d)/b_j(d)
//! (3/2) u' P u = u_1^2 + 3 u_2^2 + 3 u_3^2 = 1                   one scalar equation for d
//! w = D B^-1 P u,   r = u' P B^-1 (B' u - x'),   k = sigma_y + K - d (H + K')
//! D - D_ep = (3/2) d D P B^-1 D + (3/2)/r (k w + d D P B^-1 x') w'
//! ```
//!
//! No back stress exceeds `C/gamma`: at `d = (q - sigma_y)/(3/2 m)`, with q of the trial stress and
//! `m` the smaller eigenvalue, the left-hand side is at most 1, which brackets the solution.
//!
//! # Source
//! Simo and Hughes (1998), section 3.4, box 3.3; J. C. Simo, R. L. Taylor (1986),
//! doi:10.1002/nme.1620220310.

use super::{Hardening, Lame, Material, Past, Softening, Update, flow_to_root};

pub(super) fn integrate<const S: usize>(
    material: &Material,
    hardening: &Hardening,
    trial: &[f64; S],
    old: &Past<S>,
) -> Update<S> {
    let g = material.shear_modulus();
    let (e, nu) = (material.youngs_modulus, material.poissons_ratio);
    let laws = &material.back_stresses;
    let moduli = [e / (3.0 * (1.0 - nu)), 2.0 * g, 2.0 * g];
    let start = in_plane(trial);
    let divisors = |d: f64| {
        let size = old.yield_stress(hardening, d) + laws.gain(d);
        moduli.map(|m| size + 1.5 * m * d)
    };
    let relative = |d: f64| {
        let b = divisors(d);
        let forgotten = in_plane(&laws.forgotten(old.back, d));
        let u: [f64; 3] = std::array::from_fn(|j| (start[j] + forgotten[j]) / b[j]);
        u
    };
    // The excess is multiplied by the yield stress, so that it is a stress as in other spaces.
    let scale = old.yield_stress(hardening, 0.0);
    let excess = |d: f64| scale * (product(&relative(d), &relative(d)).sqrt() - 1.0);
    let d = flow_to_root(excess, 1.5 * moduli[0].min(moduli[1]), scale);

    let (u, b) = (relative(d), divisors(d));
    let mut state = *old.state;
    state.equivalent += d;
    state.strain[0] += 1.5 * d * (u[0] / 3.0 + u[1]);
    state.strain[1] += 1.5 * d * (u[0] / 3.0 - u[1]);
    state.strain[2] -= d * u[0];
    state.strain[3] += 3.0 * d * u[2];

    let (size, slope) = (
        old.yield_stress(hardening, d) + laws.gain(d),
        hardening.slope(state.equivalent) + laws.modulus(d),
    );
    let forgetting = in_plane(&laws.forgetting(old.back, d));
    // Parts of x' along the flow and across it.
    let along_flow = product(&u, &forgetting);
    let beside: [f64; 3] = std::array::from_fn(|j| forgetting[j] - along_flow * u[j]);
    // Applies D P B^-1 to a vector.
    let of = |v: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|j| v[j] * moduli[j] / b[j]) };
    let rate: [f64; 3] =
        std::array::from_fn(|j| ((slope + 1.5 * moduli[j]) * u[j] - forgetting[j]) / b[j]);
    let resistance = product(&u, &rate);
    // The product D P B^-1 D for the sum and the difference of the normal strains.
    let lost_sum = 1.5 * d * moduli[0] / b[0] * e / (1.0 - nu);
    let lost_difference = 1.5 * d * moduli[1] / b[1] * 2.0 * g;
    let turn = 2.25 * d / resistance;
    Update {
        state,
        softening: Softening {
            isotropic: Lame {
                lambda: 0.5 * (lost_sum - lost_difference),
                mu: 0.5 * lost_difference,
                across: 0.0,
            },
            along: 2.25 * (size - d * (slope - along_flow)) / resistance,
            normal: components(&of(&u)),
        },
        turn: components(&of(&beside).map(|v| turn * v)),
        yields: true,
    }
}

/// Half sum and half difference of the normal stresses, and the shear stress, of the plane stress
/// that has the same deviator as the given stress.
fn in_plane<const S: usize>(stress: &[f64; S]) -> [f64; 3] {
    let half_sum = 0.5 * (stress[0] + stress[1]) - stress[2];
    [half_sum, 0.5 * (stress[0] - stress[1]), stress[3]]
}

/// Stress vector for given half sum, half difference and shear stress.
fn components<const S: usize>([sum, difference, shear]: &[f64; 3]) -> [f64; S] {
    let mut out = [0.0; S];
    out[0] = sum + difference;
    out[1] = sum - difference;
    out[3] = *shear;
    out
}

/// Scalar product `3/2 a' P b`.
fn product(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + 3.0 * (a[1] * b[1] + a[2] * b[2])
}
