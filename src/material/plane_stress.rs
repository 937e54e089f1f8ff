//! Return mapping that keeps the stress in the plane.
//!
//! With `P = [[2, -1, 0], [-1, 2, 0], [0, 0, 6]]/3`, the stress `xi = sigma - alpha` relative to a
//! back stress of the plane with `P alpha = 2/3 C eps_p`, `q^2 = 3/2 xi' P xi`, `eps_p += c P xi`
//! and `alpha += 2/3 C c xi`, the trial stress decouples in the eigenvectors that `D` and `P`
//! share. With `h = 1 + 2/3 C c`:
//!
//! ```text
//! q(c)^2 = a^2/(2 (h + c E/(3 (1 - nu)))^2) + (3/2 b^2 + 3 t^2)/(h + 2 G c)^2
//! a = (sxx + syy)/sqrt 2,  b = (syy - sxx)/sqrt 2,  t = sxy          (trial xi)
//! q(c) = sigma_y(eps + 2/3 c q(c))                                   one scalar equation for c
//! ```
//!
//! # Source
//! Simo and Hughes (1998), section 3.4, box 3.3; J. C. Simo, R. L. Taylor (1986),
//! doi:10.1002/nme.1620220310.

use super::{Hardening, Lame, Material, PlasticState, Softening, Update};
use crate::root::{self, Accuracy};

pub(super) fn integrate<const S: usize>(
    material: &Material,
    hardening: &Hardening,
    trial: &[f64; S],
    old: &PlasticState<S>,
) -> Update<S> {
    let g = material.shear_modulus();
    let e = material.youngs_modulus;
    let nu = material.poissons_ratio;
    let biaxial = e / (3.0 * (1.0 - nu));
    let kinematic = 2.0 / 3.0 * material.kinematic_modulus;
    // What the trial holds is `sigma - P alpha` with its component across the plane: the relative
    // stress of the plane differs from it by that.
    let across = trial[2];
    let half_sum = 0.5 * (trial[0] + trial[1]) - across;
    let half_difference = 0.5 * (trial[0] - trial[1]);
    // q^2 = sum part / (h + c biaxial)^2 + deviator part / (h + 2 G c)^2
    let sum_part = half_sum * half_sum;
    let deviator_part = 3.0 * (half_difference * half_difference + trial[3] * trial[3]);
    let shrunk = |c: f64| {
        let h = 1.0 + kinematic * c;
        (h + c * biaxial, h + 2.0 * g * c)
    };
    let equivalent_stress = |c: f64| {
        let (a, b) = shrunk(c);
        (sum_part / (a * a) + deviator_part / (b * b)).sqrt()
    };
    let stiffness = 2.0 * g + kinematic;
    let c = solve_multiplier(hardening, old.equivalent, equivalent_stress, stiffness);

    let (a, b) = shrunk(c);
    let (sum, difference, shear) = (half_sum / a, half_difference / b, trial[3] / b);
    let xi = [sum + difference, sum - difference, shear];
    let q = equivalent_stress(c);
    let d = 2.0 / 3.0 * c * q;
    let p_xi = [
        (2.0 * xi[0] - xi[1]) / 3.0,
        (2.0 * xi[1] - xi[0]) / 3.0,
        2.0 * xi[2],
    ];
    let mut state = *old;
    state.equivalent += d;
    state.strain[0] += c * p_xi[0];
    state.strain[1] += c * p_xi[1];
    state.strain[2] -= c * (p_xi[0] + p_xi[1]);
    state.strain[3] += c * p_xi[2];

    // D_ep = Xi - w w'/(..), w = Xi P xi; Xi = (D^-1 + c/h P)^-1 in the eigenvectors that it
    // shares with D: (1,1,0)/sqrt2, (1,-1,0)/sqrt2, (0,0,1).
    let h = 1.0 + kinematic * c;
    let (a, b) = (a / h, b / h);
    let of_sum = e / (1.0 - nu);
    let half_w = [
        0.5 * (p_xi[0] + p_xi[1]) * of_sum / a,
        0.5 * (p_xi[0] - p_xi[1]) * 2.0 * g / b,
    ];
    let mut normal = [0.0; S];
    normal[0] = half_w[0] + half_w[1];
    normal[1] = half_w[0] - half_w[1];
    normal[3] = p_xi[2] * g / b;
    let slope = hardening.slope(state.equivalent);
    let p_xi_p = p_xi[0] * normal[0] + p_xi[1] * normal[1] + p_xi[2] * normal[3];
    let xi_p_xi = 2.0 / 3.0 * q * q;
    let isotropic = 2.0 / 3.0 * slope / (1.0 - 2.0 / 3.0 * slope * c);
    let resistance = h * xi_p_xi * (kinematic + h * isotropic);
    // D - Xi: what is lost of the sum and of the difference of the normal stresses.
    let lost_sum = of_sum * (1.0 - 1.0 / a);
    let lost_difference = 2.0 * g * (1.0 - 1.0 / b);
    Update {
        state,
        softening: Softening {
            isotropic: Lame {
                lambda: 0.5 * (lost_sum - lost_difference),
                mu: 0.5 * lost_difference,
                across: 0.0,
            },
            along: 1.0 / (p_xi_p + resistance),
            normal,
        },
        yields: true,
    }
}

/// Solves `q(c) = sigma_y(strain + 2/3 c q(c))`: the left side falls, the right side does not, so
/// that there is a bracket.
fn solve_multiplier(
    hardening: &Hardening,
    strain: f64,
    q: impl Fn(f64) -> f64,
    stiffness: f64,
) -> f64 {
    let excess = |c: f64| {
        let q = q(c);
        q - hardening.yield_stress(strain + 2.0 / 3.0 * c * q)
    };
    let (mut low, mut f_low) = (0.0, excess(0.0));
    let scale = hardening.yield_stress(strain);
    let mut high = f_low / (scale * stiffness);
    let mut f_high = excess(high);
    while f_high > 0.0 {
        (low, f_low) = (high, f_high);
        high *= 2.0;
        f_high = excess(high);
    }
    let accuracy = Accuracy {
        value: 4.0 * f64::EPSILON * scale,
        place: f64::EPSILON,
    };
    root::between([(low, f_low), (high, f_high)], accuracy, excess)
}
