//! Strain path of a material without fading back stresses: everything except the return to the
//! yield surface is linear, so deviators of the stress minus the back stress suffice.
//!
//! ```text
//! s(x) = s + x 2 G dev(de)              on the way, before flow
//! q - (3 G + H_kin) d = sigma_y(p + d)     one return, q = sqrt(3/2 s:s)
//! s -= (3 G + H_kin) d/q s,    eps_p += (3/2) d/q s
//! ```
//!
//! The parts of the path and the extrapolation are those of [`super::parts::StrainPath`]; with
//! deviators they take a fourth of the operations.

use super::super::tensor::von_mises_product;
use super::super::{Hardening, PlasticState};
use super::parts::{Across, PARTS, StrainPath, Turn};

/// State of a point on the way along the path.
#[derive(Clone, Copy)]
struct OnTheWay<const S: usize> {
    /// Deviator of the stress minus the back stress.
    stress: [f64; S],
    /// Plastic strains since the start of the path, as a tensor.
    plastic: [f64; S],
    equivalent: f64,
    across: Across,
}

/// Law of the return mapping, and change of the deviator over the path.
pub(super) struct Deviators<'a, const S: usize> {
    hardening: &'a Hardening,
    harder: f64,
    /// Slope of the resistance without isotropic hardening, `3 G + H_kin`.
    stiffness: f64,
    /// Moduli: `2 G`, and the modulus of the back stresses.
    moduli: [f64; 2],
    change: [f64; S],
}

impl<'a, const S: usize> Deviators<'a, S> {
    pub(super) fn new(path: &StrainPath<'a, S>, hardening: &'a Hardening) -> Self {
        let material = path.material;
        let (g, linear) = (material.shear_modulus(), material.back_stresses.linear());
        let strain: [f64; S] = std::array::from_fn(|k| path.end[k] - path.begin[k]);
        // Shear strains are doubled.
        let change = deviator(&strain).map(|e| g * e);
        Deviators {
            hardening,
            harder: path.harder,
            stiffness: 3.0 * g + linear,
            moduli: [2.0 * g, 2.0 / 3.0 * linear],
            change: std::array::from_fn(|k| if k < 3 { 2.0 * change[k] } else { change[k] }),
        }
    }

    /// Integrates from the share of the path at which flow begins, with the stress `begin` (minus
    /// the back stress) there. Returns the state at the end, the share of stiffness that flow takes
    /// off strains across it, and the direction of flow there; `None` if the direction does not
    /// turn.
    pub(super) fn integrate(
        &self,
        begin: &[f64; S],
        mut share: f64,
        old: &PlasticState<S>,
        least_turn: f64,
    ) -> Option<(PlasticState<S>, f64, Option<[f64; S]>)> {
        let mut here = OnTheWay {
            stress: self.after(&deviator(begin), share),
            plastic: [0.0; S],
            equivalent: old.equivalent,
            across: Across {
                stress: share,
                lost: 0.0,
            },
        };
        let mut normal = [0.0; S];
        for left in (1..=PARTS).rev() {
            let end = self.after(&here.stress, 1.0 - share);
            let turn = Turn::between(&here.stress, &end);
            if left == PARTS && turn.angle < least_turn {
                return None;
            }
            let next = match left {
                1 => 1.0,
                _ => share + turn.share_of_angle(1.0 / f64::from(left)) * (1.0 - share),
            };
            (here, normal) = self.twice(&here, next - share);
            share = next;
        }
        let (end, _) = self.step(&here, 0.0);
        let mut state = *old;
        state.equivalent = end.equivalent;
        for (k, (own, flowed)) in state.strain.iter_mut().zip(&end.plastic).enumerate() {
            // The stored strains have engineering shear.
            *own += if k < 3 { *flowed } else { 2.0 * flowed };
        }
        let size = (2.0 / 3.0 * von_mises_product(&normal, &normal)).sqrt();
        let normal = (size > 0.0).then(|| normal.map(|s| s / size));
        Some((state, here.across.lost.clamp(0.0, 1.0), normal))
    }

    fn after(&self, stress: &[f64; S], share: f64) -> [f64; S] {
        std::array::from_fn(|k| stress[k] + share * self.change[k])
    }

    /// Integrates a part of the path in one step and in two, and extrapolates. Also returns the
    /// stress along which the last step flows, zero if it does not flow.
    fn twice(&self, from: &OnTheWay<S>, share: f64) -> (OnTheWay<S>, [f64; S]) {
        let (one, _) = self.step(from, share);
        let (half, _) = self.step(from, 0.5 * share);
        let (two, flow) = self.step(&half, 0.5 * share);
        let out = OnTheWay {
            stress: std::array::from_fn(|k| 2.0 * two.stress[k] - one.stress[k]),
            plastic: std::array::from_fn(|k| 2.0 * two.plastic[k] - one.plastic[k]),
            // Apart from round-off, finer steps do not shorten the path of flow.
            equivalent: (2.0 * two.equivalent - one.equivalent).max(two.equivalent),
            across: Across {
                stress: 2.0 * two.across.stress - one.across.stress,
                lost: 2.0 * two.across.lost - one.across.lost,
            },
        };
        (out, flow)
    }

    /// Takes a share of the path by the implicit rule in one step; also returns the stress along
    /// which it flows.
    fn step(&self, from: &OnTheWay<S>, share: f64) -> (OnTheWay<S>, [f64; S]) {
        let trial = self.after(&from.stress, share);
        let q = von_mises_product(&trial, &trial).sqrt();
        let size = self.hardening.yield_stress(from.equivalent) + self.harder;
        let mut out = OnTheWay {
            stress: trial,
            ..*from
        };
        if q <= size {
            out.across = from.across.after(share, 0.0, self.moduli);
            return (out, [0.0; S]);
        }
        let (d, _) = (self.hardening).solve(q - self.harder, self.stiffness, from.equivalent);
        let across = 1.5 * d / q;
        let kept = 1.0 - self.stiffness * d / q;
        out.equivalent += d;
        out.across = from.across.after(share, across, self.moduli);
        for k in 0..S {
            out.plastic[k] += across * trial[k];
            out.stress[k] *= kept;
        }
        (out, trial)
    }
}

fn deviator<const S: usize>(stress: &[f64; S]) -> [f64; S] {
    let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    std::array::from_fn(|k| if k < 3 { stress[k] - mean } else { stress[k] })
}

#[cfg(test)]
mod tests {
    use super::super::{LEAST_TURN, Memory};
    use super::*;
    use crate::material::{BackStresses, Material, Past, von_mises};
    use crate::space::Space;
    use proptest::prelude::*;

    proptest! {
        /// Deviators give the same result as full stresses and strains, up to round-off: linear
        /// kinematic and isotropic hardening, from a state with plastic strains.
        #[test]
        fn deviators_give_what_full_stresses_give(
            first in prop::array::uniform6(-0.01f64..0.01),
            change in prop::array::uniform6(-0.02f64..0.02),
            kinematic in 0.0f64..5e3,
            slope in 0.0f64..5e3,
        ) {
            let material = Material {
                name: "m".to_string(),
                youngs_modulus: 200e3,
                poissons_ratio: 0.3,
                hardening: Some(Hardening::linear(250.0, slope)),
                back_stresses: BackStresses::new([[kinematic, 0.0]]),
                space: Space::Solid,
            };
            let law = material.lame();
            let fresh = PlasticState::<6>::default();
            let past = |state| Past { state, back: &[], harder: 10.0 };
            let begin = first;
            let end = std::array::from_fn(|k| first[k] + change[k]);
            let old = material.integrate(&law, &begin, &past(&fresh)).state;
            let whole = material.integrate(&law, &end, &past(&old));
            prop_assume!(whole.yields);
            let path = StrainPath {
                material: &material,
                law: &law,
                begin: &begin,
                end: &end,
                harder: 10.0,
            };
            let (mut strains, mut between) = (Vec::new(), Vec::new());
            let mut memory = Memory {
                strains: &mut strains,
                between: &mut between,
                lost_work: 0.0,
            };
            let full = path.integrate(&past(&old), &whole.state, &mut memory);
            let hardening = material.hardening.as_ref().unwrap();
            let stress = path.relative(&begin, &past(&old));
            let share = path.begin_of_flow(&past(&old));
            let own = Deviators::new(&path, hardening).integrate(&stress, share, &old, LEAST_TURN);
            prop_assert_eq!(own.is_some(), full.is_some());
            if let (Some(own), Some(full)) = (own, full) {
                for k in 0..6 {
                    prop_assert!((own.0.strain[k] - full.0.strain[k]).abs() < 1e-14);
                    let normals = [own.2, full.2].map(|n| n.map_or(0.0, |n| n[k]));
                    prop_assert!((normals[0] - normals[1]).abs() < 1e-9);
                }
                prop_assert!((own.0.equivalent - full.0.equivalent).abs() < 1e-14);
                prop_assert!((own.1 - full.1).abs() < 1e-10);
                prop_assert!(von_mises(&stress) > 0.0);
            }
        }
    }
}
