//! An error that refinement does not bring down: a peak that grows with the mesh, as at a re-entrant corner or the edge of a dent, has no limit.

/// The error has fallen where it is this share of the least before.
const FALLEN: f64 = 0.8;
/// Refinement is given up on a mesh that is so many times finer than the last one on which the error had fallen ...
pub(super) const BEYOND_BEST: f64 = 3.0;
/// ... unless on those beyond it falls with this order: least by chance, as where an error changes its sign on coarse meshes, it tells nothing.
const LEAST_ORDER: f64 = 0.25;

/// An error stated on the way to a demand, and how fine the mesh was.
#[derive(Clone, Copy)]
struct Stated {
    error: f64,
    fine: f64,
}

/// The least error on the way to a demand, and those since.
#[derive(Default)]
pub(super) struct Best {
    least: Option<Stated>,
    since: Vec<Stated>,
}

impl Best {
    /// Whether the error does not fall any more.
    pub(super) fn is_no_longer_bettered(&mut self, error: f64, fine: f64) -> bool {
        if error.is_nan() {
            return false;
        }
        let now = Stated { error, fine };
        let Some(least) = self.least.filter(|l| error >= FALLEN * l.error) else {
            self.least = Some(now);
            self.since.clear();
            return false;
        };
        self.since.push(now);
        fine >= BEYOND_BEST * least.fine && order(&self.since).is_none_or(|p| p < LEAST_ORDER)
    }
}

/// The order with which errors fall, by least squares of their logarithms; `None` of fewer than two meshes.
fn order(stated: &[Stated]) -> Option<f64> {
    let logarithms = || stated.iter().map(|s| [s.fine.ln(), s.error.ln()]);
    let n = stated.len() as f64;
    let mean = |i: usize| logarithms().map(|l| l[i]).sum::<f64>() / n;
    let [x, y] = [mean(0), mean(1)];
    let (mut covariance, mut variance) = (0.0, 0.0);
    for [fine, error] in logarithms() {
        covariance += (fine - x) * (error - y);
        variance += (fine - x).powi(2);
    }
    (variance > 0.0).then(|| -covariance / variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_does_not_fall_ends_the_climb() {
        let mut falls = Best::default();
        let mut stalls = Best::default();
        for k in 0..12 {
            let fine = 1.5f64.powi(k);
            // Even slow convergence, of order 0.3, goes on.
            assert!(!falls.is_no_longer_bettered(fine.powf(-0.3), fine));
            let wavers = if k % 2 == 0 { 0.5 } else { 0.7 };
            let stalled = stalls.is_no_longer_bettered(wavers, fine);
            assert_eq!(stalled, fine >= BEYOND_BEST, "{k}");
        }
        assert!(!Best::default().is_no_longer_bettered(f64::NAN, 1.0));
    }

    /// The thick cylinder near collapse: an error that changes its sign between coarse meshes.
    #[test]
    fn an_error_that_is_small_by_chance_does_not_end_the_climb() {
        let mut best = Best::default();
        for (fine, error) in [(4.0, 2.0), (6.0, 1.3), (8.0, 3.5), (13.0, 1.8), (18.0, 1.6)] {
            assert!(!best.is_no_longer_bettered(error, fine), "{fine}");
        }
    }

    /// The disc in the midst of unloading: a peak without a limit.
    #[test]
    fn an_error_that_wavers_ends_the_climb() {
        let mut best = Best::default();
        let on_the_way = [
            (32.0, 59.0),
            (60.0, 37.0),
            (112.0, 17.0),
            (158.0, 21.0),
            (240.0, 36.0),
        ];
        for (fine, error) in on_the_way {
            assert!(!best.is_no_longer_bettered(error, fine), "{fine}");
        }
        assert!(best.is_no_longer_bettered(28.0, 370.0));
    }
}
