//! The flow rule along the straight way of strain of an increment.
//!
//! The implicit rule lets the whole of an increment flow in the direction that flow has at its end.
//! That is exact while the direction does not turn, and wrong by half the angle where it does: of
//! first order in the increments. Here the way is cut where the direction of flow has turned by
//! [`MOST_TURN`], and each part is integrated twice by the implicit rule, in one step and in two
//! halves: twice the second less the first is of second order (Richardson), and where the material
//! loses most of its stiffness it stays as stable as the rule itself.
//!
//! # Source
//! L. F. Richardson (1911), doi:10.1098/rsta.1911.0009; substeps of a straight way of strain: J. C.
//! J. Schreyer, R. F. Kulak, J. M. Kramer (1979), doi:10.1115/1.3454607.

use super::{Lame, Material, Past, PlasticState, Update, von_mises_product};

/// The angle, in radians, that the direction of flow may turn by in one part of the way.
const MOST_TURN: f64 = 0.2;
/// Below this angle the implicit rule is as good: the square of it is round-off beside its effect.
const LEAST_TURN: f64 = 1e-4;
/// Parts of a way at most; the last takes what is left.
const MOST_PARTS: usize = 40;

/// What back stresses that fade remember on the way: empty where there are none.
pub struct Memory<'a, const S: usize> {
    /// At the end of what is integrated so far.
    pub strains: &'a mut [[f64; S]],
    /// In the middle of a part.
    pub between: &'a mut [[f64; S]],
    /// Work per volume that was lost since the begin of the way.
    pub lost_work: f64,
}

/// A way of strain: its ends, and the law of the material.
struct Way<'a, const S: usize> {
    material: &'a Material,
    law: &'a Lame,
    begin: &'a [f64; S],
    end: &'a [f64; S],
    harder: f64,
}

impl Material {
    /// Integrates the flow rule along the straight way from the total strain that belongs to the
    /// history `old` to another, by the implicit rule in one step where the first is not known;
    /// `memory` is left at its end where the point yields. The tangent is that of the implicit rule
    /// over the whole way.
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
        let way = Way {
            material: self,
            law,
            begin: begin.unwrap_or(end),
            end,
            harder: old.harder,
        };
        if begin.is_none() {
            way.carry(old.state, &whole.state, memory);
            return whole;
        }
        let state = way.integrate(old, &whole.state, memory);
        Update { state, ..whole }
    }
}

impl<const S: usize> Way<'_, S> {
    /// The strain at a share of the way.
    fn at(&self, share: f64) -> [f64; S] {
        std::array::from_fn(|k| self.begin[k] + share * (self.end[k] - self.begin[k]))
    }

    /// The stress less the back stress of a strain.
    fn relative(&self, strain: &[f64; S], past: &Past<S>) -> [f64; S] {
        self.material.relative_stress(self.law, strain, past)
    }

    /// The state at the end; `whole` is that of the implicit rule in one step.
    fn integrate(
        &self,
        old: &Past<S>,
        whole: &PlasticState<S>,
        memory: &mut Memory<S>,
    ) -> PlasticState<S> {
        let mut state = *old.state;
        let mut share = self.begin_of_flow(old);
        for part in 0..MOST_PARTS {
            let past = Past {
                state: &state,
                back: memory.strains,
                harder: self.harder,
            };
            let here = self.relative(&self.at(share), &past);
            let there = self.relative(self.end, &past);
            let (turn, most) = turn(&here, &there);
            if part == 0 && turn < LEAST_TURN {
                self.carry(old.state, whole, memory);
                return *whole;
            }
            let is_last = turn <= MOST_TURN || part + 1 == MOST_PARTS;
            let next = if is_last {
                1.0
            } else {
                share + most * (1.0 - share)
            };
            let coarse = (part == 0 && is_last).then_some(whole);
            state = self.twice(&state, [share, next], coarse, memory);
            if is_last {
                break;
            }
            share = next;
        }
        self.onto_the_yield_surface(state, memory)
    }

    /// The share of the way at which the yield surface is reached.
    fn begin_of_flow(&self, old: &Past<S>) -> f64 {
        let Some(hardening) = &self.material.hardening else {
            return 1.0;
        };
        let size = old.yield_stress(hardening, 0.0);
        let start = self.relative(self.begin, old);
        let end = self.relative(self.end, old);
        let change: [f64; S] = std::array::from_fn(|k| end[k] - start[k]);
        let inside = size * size - von_mises_product(&start, &start);
        let (b, a) = (
            von_mises_product(&start, &change),
            von_mises_product(&change, &change),
        );
        // a x^2 + 2 b x = inside, the larger root; none of it where flow goes on.
        if inside <= 0.0 && b >= 0.0 {
            return 0.0;
        }
        let root = (b * b + a * inside.max(0.0)).sqrt();
        let share = if b > 0.0 {
            inside / (b + root)
        } else {
            (root - b) / a
        };
        if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// A part of the way in one step and in two, extrapolated.
    fn twice(
        &self,
        from: &PlasticState<S>,
        [begin, end]: [f64; 2],
        coarse: Option<&PlasticState<S>>,
        memory: &mut Memory<S>,
    ) -> PlasticState<S> {
        let to = self.at(end);
        let step = |strain: &[f64; S], state: &PlasticState<S>, back: &[[f64; S]]| {
            let past = Past {
                state,
                back,
                harder: self.harder,
            };
            self.material.integrate(self.law, strain, &past).state
        };
        let one = match coarse {
            Some(coarse) => *coarse,
            None => step(&to, from, memory.strains),
        };
        let half = step(&self.at(0.5 * (begin + end)), from, memory.strains);
        memory.between.copy_from_slice(memory.strains);
        let laws = &self.material.back_stresses;
        let mut lost = 2.0 * laws.carry(memory.between, from, &half);
        let two = step(&to, &half, memory.between);
        lost += 2.0 * laws.carry(memory.between, &half, &two);
        lost -= laws.carry(memory.strains, from, &one);
        memory.lost_work += lost;
        for (own, fine) in memory.strains.iter_mut().zip(memory.between.iter()) {
            *own = std::array::from_fn(|k| 2.0 * fine[k] - own[k]);
        }
        PlasticState {
            strain: std::array::from_fn(|k| 2.0 * two.strain[k] - one.strain[k]),
            // Flow that turns is no shorter for being followed more closely, but for round-off.
            equivalent: (2.0 * two.equivalent - one.equivalent).max(two.equivalent),
        }
    }

    /// What extrapolation leaves beyond the yield surface flows off.
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
        let update = self.material.integrate(self.law, self.end, &past);
        if update.yields {
            self.carry(&state, &update.state, memory);
        }
        update.state
    }

    fn carry(&self, from: &PlasticState<S>, to: &PlasticState<S>, memory: &mut Memory<S>) {
        let laws = &self.material.back_stresses;
        memory.lost_work += laws.carry(memory.strains, from, to);
    }
}

/// The angle between the deviators of two stresses, and the share of the way from one to the other
/// at which it is [`MOST_TURN`].
fn turn<const S: usize>(from: &[f64; S], to: &[f64; S]) -> (f64, f64) {
    let size = von_mises_product(from, from).sqrt();
    let along = von_mises_product(from, to) / size;
    let across = (von_mises_product(to, to) - along * along).max(0.0).sqrt();
    let angle = across.atan2(along);
    let tangent = MOST_TURN.tan();
    // from + x (to - from): x across / (size + x (along - size)) is the tangent of the angle.
    let share = size * tangent / (across - (along - size) * tangent);
    (angle, share.clamp(0.0, 1.0))
}
