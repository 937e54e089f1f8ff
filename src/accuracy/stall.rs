//! An error that refinement does not bring down: a peak that grows with the mesh, as at a re-entrant corner or the edge of a dent, has no limit.

/// The error has fallen where it is this share of the least before; refinement is given up on a mesh that is so many times finer than the
/// last one on which it had, unless the error falls with this order from the largest since then on: small by chance, as where it changes its sign on
/// coarse meshes, the least says nothing.
const FALLEN: f64 = 0.8;
pub(super) const BEYOND_BEST: f64 = 3.0;
const LEAST_ORDER: f64 = 0.25;

/// An error stated on the way to a demand, and how fine the mesh was.
#[derive(Clone, Copy)]
struct Stated {
    error: f64,
    fine: f64,
}

/// The least error on the way to a demand, and the largest since.
#[derive(Default)]
pub(super) struct Best(Option<[Stated; 2]>);

impl Best {
    /// Whether the error does not fall any more.
    pub(super) fn is_no_longer_bettered(&mut self, error: f64, fine: f64) -> bool {
        if error.is_nan() {
            return false;
        }
        let now = Stated { error, fine };
        let Some([least, largest]) = self
            .0
            .as_mut()
            .filter(|[least, _]| error >= FALLEN * least.error)
        else {
            self.0 = Some([now; 2]);
            return false;
        };
        if error > largest.error {
            *largest = now;
        }
        let falls = error * (fine / largest.fine).powf(LEAST_ORDER) < largest.error;
        fine >= BEYOND_BEST * least.fine && !falls
    }
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
            // It falls and rises again: from a mesh three times finer on, where it has risen or is too fine to have fallen.
            let expected = fine >= BEYOND_BEST && (k % 2 == 1 || k >= 6);
            assert_eq!(stalled, expected, "{k}");
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
}
