//! The load at first yield (paper, chapter 3).
//!
//! The exact method follows the piecewise linear path of contact events. Between two events the
//! stress at any point is linear, and von Mises' stress is convex. The first event with a ratio
//! above 1 brackets the yield load, which is then found to round-off. The secant method is the
//! paper's (3.14) with a bracket; each iterate is a contact problem solved from scratch.

use crate::analysis::stress::recovery::{RecoveredPeak, Recovery, Samples};
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, Result};
use crate::root::{self, RootTolerance};
use std::convert::Infallible;

/// Relative accuracy of the yield load.
const ACCURACY: f64 = 1e-14;
/// Share by which a ratio may be below 1 and still count as first yield: far above [`ACCURACY`],
/// far below any jump.
const BEFORE: f64 = 1e-9;
/// Accuracy of the yield load found by the secant, for which each stress comes from a contact
/// problem of its own.
const SECANT_ACCURACY: RootTolerance = RootTolerance {
    value: 1e-13,
    place: ACCURACY,
};
/// Largest load factor at which a yield load is looked for.
const LARGEST: f64 = 1e100;

/// Finds `s` in `[0, 1]` at which the recovered stress ratio is 1, between two sampled stress
/// fields and linear in between. The ratio must be at most 1 at `s = 0` and at least 1 at `s = 1`.
pub fn yield_share(
    solver: &Solver,
    recovery: &mut Recovery,
    from: &Samples,
    to: &Samples,
) -> (f64, Option<RecoveredPeak>) {
    let mut mixed: Samples = from.clone();
    let mut at = |s: f64| {
        for (m, (a, b)) in mixed.iter_mut().zip(from.iter().zip(to)) {
            *m = a + s * (b - a);
        }
        recovery.peak(solver.structure.model, &mixed)
    };
    let mut found = None;
    let mut beyond = |s: f64| {
        let peak = at(s);
        // On a coarse mesh the recovered maximum may jump when the search moves to another place.
        // The point that yields is the maximum beyond the jump.
        if peak.is_some_and(|p| p.ratio >= 1.0 - BEFORE) {
            found = peak;
        }
        peak.map_or(-1.0, |p| p.ratio - 1.0)
    };
    let ends = [0.0, 1.0].map(|s| (s, beyond(s)));
    let Ok(share) = root::try_between(ends, RootTolerance::both(ACCURACY), |s| {
        Ok::<_, Infallible>(beyond(s))
    });
    (share, found)
}

/// The recovered stress peak of the current (elastic) state.
pub fn peak_here(solver: &mut Solver, recovery: &mut Recovery) -> Option<RecoveredPeak> {
    let samples = recovery.sample_here(solver);
    recovery.peak(solver.structure.model, &samples)
}

/// Finds the yield load: the paper's secant (3.14) up to a load beyond yield, then bracketing
/// between the last two loads. The state at yield becomes the current state.
///
/// # Errors
/// Fails if the stress does not grow with the load.
pub fn secant_yield_load(
    solver: &mut Solver,
    recovery: &mut Recovery,
) -> Result<(f64, RecoveredPeak)> {
    let mut peak = None;
    let mut excess = |alpha: f64| -> Result<f64> {
        let point = solver.structure.point(alpha);
        solver.solve_contact_at(&point)?;
        peak = peak_here(solver, recovery);
        Ok(peak.map_or(-1.0, |p| p.ratio - 1.0))
    };
    let not_found =
        || Error::analysis("the yield load was not found: the stress does not grow with the load");
    let (mut below, mut above) = ((0.0, -1.0), (1.0, excess(1.0)?));
    while above.1 < 0.0 {
        let secant = above.0 - above.1 / (above.1 - below.1) * (above.0 - below.0);
        let alpha = if secant.is_finite() {
            secant.max(2.0 * above.0)
        } else {
            2.0 * above.0
        };
        if alpha > LARGEST {
            return Err(not_found());
        }
        below = above;
        above = (alpha, excess(alpha)?);
    }
    let alpha = root::try_between([below, above], SECANT_ACCURACY, &mut excess)?;
    peak.map(|peak| (alpha, peak)).ok_or_else(not_found)
}
