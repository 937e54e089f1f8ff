//! How much of the way to a target lies behind.

/// What the way to a target is measured by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Aim {
    /// There is no target yet.
    Nothing,
    /// From one load factor to another; changes of contact lie evenly in its power `power`.
    Factor { from: f64, to: f64, power: f64 },
    /// A monitored quantity is to vanish; its size at the beginning, once it is known.
    Monitored { at_first: Option<f64> },
}

impl Aim {
    /// Share of the way that lies behind, at a load factor and a value of the monitored quantity.
    pub(super) fn share(self, alpha: f64, monitored: f64) -> f64 {
        let share = match self {
            Aim::Factor { from, to, power } if from != to => {
                let [alpha, from, to] =
                    [alpha, from, to].map(|factor| factor.abs().powf(power).copysign(factor));
                (alpha - from) / (to - from)
            }
            Aim::Factor { .. } => 1.0,
            Aim::Monitored {
                at_first: Some(first),
            } if first > 0.0 => 1.0 - monitored.abs() / first,
            _ => 0.0,
        };
        if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Aim;

    #[test]
    fn the_share_of_the_way_runs_from_0_to_1_and_is_a_number_whatever_comes() {
        let factor = |from: f64, to: f64, power: f64| Aim::Factor { from, to, power };
        let up = factor(1.0, 3.0, 1.0);
        assert_eq!(
            [1.0, 2.0, 3.0].map(|alpha| up.share(alpha, f64::NAN)),
            [0.0, 0.5, 1.0]
        );
        assert_eq!(factor(2.0, 0.0, 1.0).share(0.5, 0.0), 0.75);
        // Half of the pairs of a line contact are still to open at a quarter of the load.
        assert_eq!(factor(1.0, 0.0, 0.5).share(0.25, 0.0), 0.5);
        assert_eq!(factor(1.0, -1.0, 0.5).share(-0.25, 0.0), 0.75);
        let monitored = Aim::Monitored {
            at_first: Some(0.5),
        };
        assert_eq!(
            [0.5, -0.25, 0.0, 9.0].map(|m| monitored.share(1.0, m)),
            [0.0, 0.5, 1.0, 0.0]
        );
        for aim in [
            Aim::Nothing,
            Aim::Monitored { at_first: None },
            up,
            monitored,
        ] {
            let share = aim.share(f64::NAN, f64::NAN);
            assert!((0.0..=1.0).contains(&share), "{aim:?}: {share}");
        }
        assert_eq!(factor(1.0, 1.0, 0.5).share(1.0, 0.0), 1.0);
    }
}
