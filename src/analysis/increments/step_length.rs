//! The step length: the share of an increment that contact allows.
//!
//! For pair `k` let `v` be the value that must stay positive: the gap of an open pair or the force
//! of a closed one. Over the increment it changes from `v` to `v + dv`. The paper's ratios are
//! `psi_u = max_k |dv/v|` over the open pairs whose gap falls (4.16), and `psi_R`, the
//! corresponding maximum over the closed pairs (4.20). The increment is scaled by `1/psi`, with
//! `psi` the larger of the two (4.17, 4.22). It has the right length when `psi` is 1 to within
//! `gamma` (4.18, 4.23).

/// The limit that contact sets to an increment.
#[derive(Debug, Clone, PartialEq)]
pub struct StepLimit {
    /// `1/psi`: the share of the increment at which the first pair changes; infinite if none would
    /// (4.12, 4.13).
    pub share: f64,
    /// The pairs that change at this share; ties change together.
    pub pairs: Vec<usize>,
}

impl StepLimit {
    /// The limit if no pair changes.
    pub fn none() -> Self {
        StepLimit {
            share: f64::INFINITY,
            pairs: Vec::new(),
        }
    }
}

/// Pairs change together if their shares differ by less than this, relative to the smallest.
const TIE: f64 = 1e-7;

/// The values that must stay positive: gaps of open pairs (4.8), forces of closed ones (4.9).
pub fn positive_values(open: &[bool], gap: &[f64], force: &[f64]) -> Vec<f64> {
    let pairs = open.iter().zip(gap.iter().zip(force));
    pairs
        .map(|(open, (gap, force))| if *open { *gap } else { *force })
        .collect()
}

/// Share of the increment up to the first change. `before` and `after` are the values `v` and
/// `v + dv`. Pairs in `border` are at zero already and are left out.
pub fn step_limit(open: &[bool], before: &[f64], after: &[f64], border: &[usize]) -> StepLimit {
    // Falling gaps (4.14) and falling forces (4.19) are zero at this share (4.15, 4.21).
    let share = |k: usize| {
        if after[k] < before[k] && !border.contains(&k) {
            before[k] / (before[k] - after[k])
        } else {
            f64::INFINITY
        }
    };
    let least_of = |status: bool| {
        let pairs = (0..before.len()).filter(|&k| open[k] == status);
        pairs.map(share).fold(f64::INFINITY, f64::min)
    };
    // The values 1/psi_u of the open pairs (4.16) and 1/psi_R of the closed ones (4.20).
    let [inverse_psi_u, inverse_psi_r] = [true, false].map(least_of);
    let smallest = inverse_psi_u.min(inverse_psi_r);
    if smallest.is_infinite() {
        return StepLimit::none();
    }
    StepLimit {
        share: smallest,
        pairs: (0..before.len())
            .filter(|&k| share(k) <= smallest * (1.0 + TIE))
            .collect(),
    }
}

/// The search for the length of an increment: the iteration `t <- goal(t)` of the paper
/// (4.17, 4.22), relaxed if it would oscillate about its solution.
///
/// The goal is computed as if the response were linear. If yielding spreads, it is not: with the
/// slope `s` of the goal, the error of `t` is multiplied by `s` in each step, and `s` approaches -1
/// and passes it as the material loses its stiffness. The secant through the last two goals
/// estimates `s`; the share `1/(1 - s)` of the way leads to the solution of `t = goal(t)`.
///
/// # Source
/// B. M. Irons, R. C. Tuck (1969), A version of the Aitken accelerator for computer iteration,
/// doi:10.1002/nme.1620010306.
#[derive(Debug, Clone, Copy)]
pub struct LengthSearch {
    last: Option<[f64; 2]>,
    /// The longest length that was too short, and the shortest that was too long.
    bounds: [f64; 2],
}

impl Default for LengthSearch {
    fn default() -> Self {
        LengthSearch {
            last: None,
            bounds: [0.0, f64::INFINITY],
        }
    }
}

/// Least share of the way to the goal that an iteration takes. If the goal jumps, its slope means
/// nothing.
const LEAST_RELAXATION: f64 = 0.1;

impl LengthSearch {
    /// The share of the way from `t` to `goal` to be taken; 1 as long as the goal does not
    /// oscillate.
    pub fn relaxation(&mut self, t: f64, goal: f64) -> f64 {
        let slope = match self.last.replace([t, goal]) {
            Some([t0, goal0]) if t != t0 => (goal - goal0) / (t - t0),
            _ => 0.0,
        };
        (1.0 / (1.0 - slope.min(0.0))).max(LEAST_RELAXATION)
    }

    /// The length to be tried after `t`, at which equilibrium showed `goal`. The secant is
    /// followed, inside the bounds of lengths known to be too short and too long. After the first
    /// length that is too long, `shortest` is tried.
    pub fn between(&mut self, t: f64, goal: f64, shortest: f64) -> f64 {
        self.bounds[usize::from(goal < t)] = t;
        let next = t + self.relaxation(t, goal) * (goal - t);
        match self.bounds {
            [0.0, long] if long.is_finite() => shortest,
            [short, long] if short < next && next < long => next,
            [short, long] => 0.5 * (short + long),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_that_swings_is_met_and_one_that_does_not_is_followed() {
        // goal(t) = 1 + s (t - 1): the plain iteration diverges for s < -1.
        for slope in [-0.9, -1.0, -3.0] {
            let mut search = LengthSearch::default();
            let mut t = 0.8;
            for _ in 0..3 {
                let goal = 1.0 + slope * (t - 1.0);
                t += search.relaxation(t, goal) * (goal - t);
            }
            assert!((t - 1.0).abs() < 1e-14, "{slope}: {t}");
        }
        let mut search = LengthSearch::default();
        assert_eq!(search.relaxation(0.5, 0.7), 1.0);
        assert_eq!(search.relaxation(0.7, 0.8), 1.0);
    }

    /// The goal falls steeply beyond the change of contact, as it does when a body loses its
    /// stiffness.
    #[test]
    fn a_length_is_found_between_bounds() {
        let goal = |t: f64| {
            if t < 0.3 {
                0.9 - 2.0 * t
            } else {
                0.3 * (1.0 - t).powi(5)
            }
        };
        let mut search = LengthSearch::default();
        let mut t = 1.0 - 1e-3;
        for _ in 0..60 {
            t = search.between(t, goal(t), 1e-9);
            assert!((0.0..1.0).contains(&t));
        }
        assert!((t - 0.3).abs() < 1e-12, "{t}");
    }

    /// Changes within 1e-7 of a step of each other, the accuracy to which they are known, are a
    /// tie; others are not.
    #[test]
    fn changes_one_after_the_other_are_no_tie() {
        for (apart, together) in [(1e-8, 2), (1e-6, 1), (1e-5, 1)] {
            let limit = step_limit(
                &[true, false],
                &[1.0, 1.0 + apart],
                &[-1.0, -1.0 + apart],
                &[],
            );
            assert_eq!(limit.pairs.len(), together, "{apart}");
        }
    }

    #[test]
    fn first_change_and_its_ties() {
        let limit = step_limit(
            &[true, false, true, false],
            &[1.0, 2.0, 0.5, 0.0],
            &[0.5, 0.0, 0.375, -1.0],
            &[3],
        );
        assert_eq!(limit.share, 1.0);
        assert_eq!(limit.pairs, vec![1]);
        let tie = step_limit(&[true, false], &[1.0, 2.0], &[-1.0, -2.0], &[]);
        assert_eq!((tie.share, tie.pairs.len()), (0.5, 2));
        assert_eq!(
            step_limit(&[true], &[1.0], &[1.0], &[]).share,
            f64::INFINITY
        );
    }
}
