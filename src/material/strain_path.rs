//! The flow rule along the strain path of an increment, which is straight.
//!
//! The implicit rule lets the whole of an increment flow in the direction that flow has at its end.
//! That is exact while the direction does not turn, and wrong by half the angle where it does: of
//! first order in the increments. Here the path is cut into [`PARTS`] in which the direction of
//! flow turns by the same angle, a few tenths at most, and each part is integrated twice by the
//! implicit rule, in one step and in two halves: twice the second less the first is of second order
//! (Richardson), and where the material loses most of its stiffness it stays as stable as the rule
//! itself. What comes out changes smoothly with the end of the path, so that iterations converge.
//!
//! In plane stress the strain across the plane turns a path that is straight in the plane where
//! flow begins, also of a bar that is pulled: the implicit rule, exact for stresses in proportion,
//! stays.
//!
//! # Source
//! L. F. Richardson (1911), doi:10.1098/rsta.1911.0009; substeps along strain paths: S. W.
//! Sloan (1987), doi:10.1002/nme.1620240505.

mod deviators;

use self::deviators::Deviators;
use super::{Lame, Material, Past, PlasticState, Update, sum, von_mises_product};
use crate::space::Space;

/// Parts of a path. Flow goes outwards, so that none turns by more than a fourth of a right angle.
const PARTS: u32 = 4;
/// Below this angle, in radians, the implicit rule is as good, and parts of equal angle are lost in
/// round-off. The rule's stress is off by half the angle across the flow: where a path goes from
/// one to the other the stress jumps by as much, which must stay far below what equilibrium asks.
const LEAST_TURN: f64 = 1e-12;

/// What back stresses that fade remember on the path: empty where there are none.
pub struct Memory<'a, const S: usize> {
    /// At the end of what is integrated so far.
    pub strains: &'a mut [[f64; S]],
    /// In the middle of a part.
    pub between: &'a mut [[f64; S]],
    /// Work per volume that was lost since the begin of the path.
    pub lost_work: f64,
}

/// A straight strain path, and the law of the material.
struct StrainPath<'a, const S: usize> {
    material: &'a Material,
    law: &'a Lame,
    begin: &'a [f64; S],
    end: &'a [f64; S],
    harder: f64,
}

impl Material {
    /// Integrates the flow rule along the straight path from the total strain that belongs to the
    /// history `old` to another, by the implicit rule in one step where the first is not known;
    /// `memory` is left at its end where the point yields.
    ///
    /// The tangent is that of the implicit rule over the whole path, but for its normal, that of
    /// the end, and for what flow takes off strains across it, that of the path while flow does not
    /// turn: [`Across`]. One step takes off `3 G d/q = x/(1 + x)` where the path takes `1 - (1 -
    /// exp(-x))/x`: a difference that would be the pace of iterations. Where back stresses fade it
    /// is that of one step.
    pub(crate) fn integrate_along<const S: usize>(
        &self,
        law: &Lame,
        (begin, end): (Option<&[f64; S]>, &[f64; S]),
        old: &Past<S>,
        memory: &mut Memory<S>,
    ) -> Update<S> {
        let whole = self.integrate(law, end, old);
        if !whole.yields {
            return whole;
        }
        memory.strains.copy_from_slice(old.back);
        memory.lost_work = 0.0;
        let path = StrainPath {
            material: self,
            law,
            begin: begin.unwrap_or(end),
            end,
            harder: old.harder,
        };
        if begin.is_none() || self.space == Space::PlaneStress {
            path.carry(old.state, &whole.state, memory);
            return whole;
        }
        let integrated = match (&self.hardening, self.back_stresses.n_stored()) {
            (Some(hardening), 0) => {
                let share = path.begin_of_flow(old);
                let begin = path.relative(path.begin, old);
                Deviators::new(&path, hardening).integrate(&begin, share, old.state, LEAST_TURN)
            }
            _ => path.integrate(old, &whole.state, memory),
        };
        let Some((state, lost, normal)) = integrated else {
            return whole;
        };
        let mut update = Update { state, ..whole };
        if self.back_stresses.n_stored() == 0 {
            let softening = &mut update.softening;
            let isotropic = Lame::of_deviator(2.0 * self.shear_modulus() * lost);
            softening.along += 2.0 * (softening.isotropic.mu - isotropic.mu);
            softening.isotropic = isotropic;
            softening.normal = normal.unwrap_or(softening.normal);
        }
        update
    }
}

/// What a small strain across the flow, spread over the path as the strain is, has become on the
/// way, over `2 G` times it: a stress less the back stress, and what plastic strains took off it.
#[derive(Debug, Clone, Copy)]
struct Across {
    stress: f64,
    lost: f64,
}

impl Across {
    /// After a share of the path along which flow makes `across` of a trial stress
    /// ([`super::radial_return::Flow::across`]); `moduli` are `2 G` and that of the back stresses.
    fn after(self, share: f64, across: f64, moduli: [f64; 2]) -> Self {
        let trial = self.stress + share;
        Across {
            stress: trial * (1.0 - across * (moduli[0] + moduli[1])),
            lost: self.lost + trial * across * moduli[0],
        }
    }
}

impl<const S: usize> StrainPath<'_, S> {
    /// The strain at a share of the path.
    fn at(&self, share: f64) -> [f64; S] {
        sum(1.0 - share, self.begin, share, self.end)
    }

    /// The stress less the back stress of a strain.
    fn relative(&self, strain: &[f64; S], past: &Past<S>) -> [f64; S] {
        self.material.relative_stress(self.law, strain, past)
    }

    /// The state at the end, the share that flow takes off strains across it, and its direction
    /// there; `None` where it is `whole`, that of the implicit rule in one step.
    fn integrate(
        &self,
        old: &Past<S>,
        whole: &PlasticState<S>,
        memory: &mut Memory<S>,
    ) -> Option<(PlasticState<S>, f64, Option<[f64; S]>)> {
        let mut state = *old.state;
        let mut share = self.begin_of_flow(old);
        let mut across = Across {
            stress: share,
            lost: 0.0,
        };
        let mut normal = None;
        for left in (1..=PARTS).rev() {
            let past = Past {
                state: &state,
                back: memory.strains,
                harder: self.harder,
            };
            let here = self.relative(&self.at(share), &past);
            let turn = Turn::between(&here, &self.relative(self.end, &past));
            if left == PARTS && turn.angle < LEAST_TURN {
                self.carry(old.state, whole, memory);
                return None;
            }
            let next = match left {
                1 => 1.0,
                _ => share + turn.share_of_angle(1.0 / f64::from(left)) * (1.0 - share),
            };
            (state, across, normal) = self.twice((&state, across), [share, next], memory);
            share = next;
        }
        let state = self.onto_the_yield_surface(state, memory);
        Some((state, across.lost.clamp(0.0, 1.0), normal))
    }

    /// The share of the path at which the yield surface is reached.
    fn begin_of_flow(&self, old: &Past<S>) -> f64 {
        let Some(hardening) = &self.material.hardening else {
            return 1.0;
        };
        let size = old.yield_stress(hardening, 0.0);
        let start = self.relative(self.begin, old);
        let end = self.relative(self.end, old);
        let change = sum(1.0, &end, -1.0, &start);
        // a x^2 + 2 b x = inside has one root from 0 on, as the begin is inside to round-off.
        let inside = (size * size - von_mises_product(&start, &start)).max(0.0);
        let a = von_mises_product(&change, &change);
        let b = von_mises_product(&start, &change);
        let root = (b * b + a * inside).sqrt();
        let share = match b > 0.0 {
            true => inside / (b + root),
            false => (root - b) / a,
        };
        // A path of no length is 0 / 0.
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    /// A part of the path in one step and in two, extrapolated; and the direction of flow in the
    /// last: of the stress itself round-off is all that is left where strains are large.
    fn twice(
        &self,
        (from, across): (&PlasticState<S>, Across),
        [begin, end]: [f64; 2],
        memory: &mut Memory<S>,
    ) -> (PlasticState<S>, Across, Option<[f64; S]>) {
        let to = self.at(end);
        let step = |strain: &[f64; S], state: &PlasticState<S>, back: &[[f64; S]]| {
            let past = Past {
                state,
                back,
                harder: self.harder,
            };
            self.material.flow(self.law, strain, &past)
        };
        let laws = &self.material.back_stresses;
        let moduli = [
            2.0 * self.material.shear_modulus(),
            2.0 / 3.0 * laws.linear(),
        ];
        let one = step(&to, from, memory.strains);
        let across_one = across.after(end - begin, one.across(), moduli);
        let half = step(&self.at(0.5 * (begin + end)), from, memory.strains);
        let across_half = across.after(0.5 * (end - begin), half.across(), moduli);
        let (one, half) = (one.state, half.state);
        memory.between.copy_from_slice(memory.strains);
        let mut lost = 2.0 * laws.carry(memory.between, from, &half);
        let two = step(&to, &half, memory.between);
        let across_two = across_half.after(0.5 * (end - begin), two.across(), moduli);
        let (two, normal) = (two.state, two.normal());
        lost += 2.0 * laws.carry(memory.between, &half, &two);
        lost -= laws.carry(memory.strains, from, &one);
        memory.lost_work += lost;
        for (own, fine) in memory.strains.iter_mut().zip(memory.between.iter()) {
            *own = sum(2.0, fine, -1.0, own);
        }
        let state = PlasticState {
            strain: sum(2.0, &two.strain, -1.0, &one.strain),
            // Flow that turns is no shorter for being followed more closely, but for round-off.
            equivalent: (2.0 * two.equivalent - one.equivalent).max(two.equivalent),
        };
        let across = Across {
            stress: 2.0 * across_two.stress - across_one.stress,
            lost: 2.0 * across_two.lost - across_one.lost,
        };
        (state, across, normal)
    }

    /// What extrapolation leaves beyond the yield surface flows off. It leaves nothing inside: the
    /// surface is convex, and the stress goes on from one point of it beyond another.
    fn onto_the_yield_surface(
        &self,
        state: PlasticState<S>,
        memory: &mut Memory<S>,
    ) -> PlasticState<S> {
        let past = Past {
            state: &state,
            back: memory.strains,
            harder: self.harder,
        };
        let flowed = self.material.flow(self.law, self.end, &past).state;
        self.carry(&state, &flowed, memory);
        flowed
    }

    fn carry(&self, from: &PlasticState<S>, to: &PlasticState<S>, memory: &mut Memory<S>) {
        let laws = &self.material.back_stresses;
        memory.lost_work += laws.carry(memory.strains, from, to);
    }
}

/// From one stress to another, as deviators in the plane of both.
struct Turn {
    size: f64,
    along: f64,
    across: f64,
    angle: f64,
}

impl Turn {
    fn between<const S: usize>(from: &[f64; S], to: &[f64; S]) -> Self {
        let size = von_mises_product(from, from).sqrt();
        let along = von_mises_product(from, to) / size;
        // What is left of the other without its part along the first: no difference of squares.
        let off = sum(1.0, to, -along / size, from);
        let across = von_mises_product(&off, &off).sqrt();
        Turn {
            size,
            along,
            across,
            angle: across.atan2(along),
        }
    }

    /// The share of the straight path at which a share of the angle has been turned:
    /// `x across / (size + x (along - size))` is its tangent.
    fn share_of_angle(&self, share: f64) -> f64 {
        let tangent = (share * self.angle).tan();
        self.size * tangent / (self.across - (self.along - self.size) * tangent)
    }
}
