//! Parts of a straight strain path in which the direction of flow turns by the same angle.

use super::super::tensor::{sum, von_mises_product};
use super::super::{Lame, Material, Past, PlasticState};

/// Number of parts of a path. Flow goes outwards, so that no part turns by more than a fourth of a
/// right angle.
pub(super) const PARTS: u32 = 4;
/// Angle in radians below which the implicit rule is used: there it is as accurate, and parts of
/// equal angle are lost in round-off. The stress of the implicit rule is off by half the angle
/// across the flow. Where the method changes, the stress jumps by that much, which must stay far
/// below the tolerance of equilibrium.
pub(super) const LEAST_TURN: f64 = 1e-12;

/// Strains of fading back stresses along the path; empty if the material has none.
pub struct Memory<'a, const S: usize> {
    /// Strains at the end of the part integrated so far.
    pub strains: &'a mut [[f64; S]],
    /// Strains in the middle of a part.
    pub between: &'a mut [[f64; S]],
    /// Work per volume lost since the start of the path.
    pub lost_work: f64,
}

/// A straight strain path with the law of the material.
pub(super) struct StrainPath<'a, const S: usize> {
    pub(super) material: &'a Material,
    pub(super) law: &'a Lame,
    pub(super) begin: &'a [f64; S],
    pub(super) end: &'a [f64; S],
    pub(super) harder: f64,
}

/// Response to a small additional strain perpendicular to the direction of plastic flow that grows
/// evenly along the path. Both numbers are divided by `2 G` times that strain: `stress` is the
/// change of the stress minus the back stress, `lost` the stress that plastic strains have taken
/// off.
#[derive(Debug, Clone, Copy)]
pub(super) struct Across {
    pub(super) stress: f64,
    pub(super) lost: f64,
}

impl Across {
    /// Continues over a share of the path in which flow gives the ratio `across` of plastic strain
    /// to trial stress ([`crate::material::radial_return::PlasticFlow::across`]); `moduli` are `2
    /// G` and the modulus of the back stresses.
    pub(super) fn after(self, share: f64, across: f64, moduli: [f64; 2]) -> Self {
        let trial = self.stress + share;
        Across {
            stress: trial * (1.0 - across * (moduli[0] + moduli[1])),
            lost: self.lost + trial * across * moduli[0],
        }
    }
}

impl<const S: usize> StrainPath<'_, S> {
    /// Strain at a share of the path.
    fn at(&self, share: f64) -> [f64; S] {
        sum(1.0 - share, self.begin, share, self.end)
    }

    /// Stress for a strain, minus the back stress.
    pub(super) fn relative(&self, strain: &[f64; S], past: &Past<S>) -> [f64; S] {
        self.material.relative_stress(self.law, strain, past)
    }

    /// Returns the state at the end, the share of stiffness that flow takes off strains across it,
    /// and the direction of flow there; `None` if the state is `whole`, the result of the implicit
    /// rule in one step.
    pub(super) fn integrate(
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

    /// Share of the path at which the yield surface is reached.
    pub(super) fn begin_of_flow(&self, old: &Past<S>) -> f64 {
        let Some(hardening) = &self.material.hardening else {
            return 1.0;
        };
        let size = old.yield_stress(hardening, 0.0);
        let start = self.relative(self.begin, old);
        let end = self.relative(self.end, old);
        let change = sum(1.0, &end, -1.0, &start);
        // a x^2 + 2 b x = inside has one root x >= 0, since the start is inside up to round-off.
        let inside = (size * size - von_mises_product(&start, &start)).max(0.0);
        let a = von_mises_product(&change, &change);
        let b = von_mises_product(&start, &change);
        let root = (b * b + a * inside).sqrt();
        let share = match b > 0.0 {
            true => inside / (b + root),
            false => (root - b) / a,
        };
        // For a path of zero length the share is 0 / 0.
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    /// Integrates a part of the path in one step and in two, and extrapolates. Also returns the
    /// direction of flow in the last step, because the stress itself is nothing but round-off if
    /// strains are large.
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
            // Apart from round-off, finer steps do not shorten the path of flow.
            equivalent: (2.0 * two.equivalent - one.equivalent).max(two.equivalent),
        };
        let across = Across {
            stress: 2.0 * across_two.stress - across_one.stress,
            lost: 2.0 * across_two.lost - across_one.lost,
        };
        (state, across, normal)
    }

    /// Lets the stress flow back to the yield surface where extrapolation leaves it outside.
    /// Extrapolation never leaves it inside: the surface is convex, and extrapolation continues
    /// from one point of the surface through another.
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

    pub(super) fn carry(
        &self,
        from: &PlasticState<S>,
        to: &PlasticState<S>,
        memory: &mut Memory<S>,
    ) {
        let laws = &self.material.back_stresses;
        memory.lost_work += laws.carry(memory.strains, from, to);
    }
}

/// Change from one stress to another, as deviators in the plane of both.
pub(super) struct Turn {
    pub(super) size: f64,
    pub(super) along: f64,
    pub(super) across: f64,
    pub(super) angle: f64,
}

impl Turn {
    pub(super) fn between<const S: usize>(from: &[f64; S], to: &[f64; S]) -> Self {
        let size = von_mises_product(from, from).sqrt();
        let along = von_mises_product(from, to) / size;
        // The other stress without its part along the first, computed without a difference of
        // squares.
        let off = sum(1.0, to, -along / size, from);
        let across = von_mises_product(&off, &off).sqrt();
        Turn {
            size,
            along,
            across,
            angle: across.atan2(along),
        }
    }

    /// Share of the straight path at which a share of the angle has been turned. The tangent of the
    /// angle turned at the share `x` is `x across / (size + x (along - size))`.
    pub(super) fn share_of_angle(&self, share: f64) -> f64 {
        let tangent = (share * self.angle).tan();
        self.size * tangent / (self.across - (self.along - self.size) * tangent)
    }
}
