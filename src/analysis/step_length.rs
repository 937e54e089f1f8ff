//! The step length: how much of an increment contact allows.
//!
//! For pair `k` let `v` be what must stay positive, the gap of an open pair or the force of a closed one. Over the
//! increment it falls from `v` to `v + dv`; the paper's ratio is `psi = max_k |dv/v|` (4.16, 4.20), and the
//! increment is scaled by `1/psi` (4.17, 4.22).

/// What contact says of an increment.
#[derive(Debug, Clone, PartialEq)]
pub struct StepLimit {
    /// `1/psi`: the share of the increment at which the first pair changes; infinite if none would.
    pub share: f64,
    /// The pairs that change there, ties together.
    pub pairs: Vec<usize>,
}

/// Pairs whose share differs by less than this from the smallest change together.
const TIE: f64 = 1e-7;

/// Share of the increment up to the first change. `before` and `after` are the values `v` and `v + dv`; pairs in
/// `border` are at zero already and are left out.
pub fn step_limit(before: &[f64], after: &[f64], border: &[usize]) -> StepLimit {
    let share = |k: usize| {
        if after[k] < before[k] && !border.contains(&k) {
            before[k] / (before[k] - after[k])
        } else {
            f64::INFINITY
        }
    };
    let smallest = (0..before.len()).map(share).fold(f64::INFINITY, f64::min);
    let pairs = if smallest.is_finite() {
        (0..before.len())
            .filter(|&k| share(k) <= smallest * (1.0 + TIE))
            .collect()
    } else {
        Vec::new()
    };
    StepLimit {
        share: smallest,
        pairs,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_change_and_its_ties() {
        let limit = step_limit(&[1.0, 2.0, 0.5, 0.0], &[0.5, 0.0, 0.375, -1.0], &[3]);
        assert_eq!(limit.share, 1.0);
        assert_eq!(limit.pairs, vec![1]);
        let tie = step_limit(&[1.0, 2.0], &[-1.0, -2.0], &[]);
        assert_eq!((tie.share, tie.pairs.len()), (0.5, 2));
        assert_eq!(step_limit(&[1.0], &[1.0], &[]).share, f64::INFINITY);
    }
}
