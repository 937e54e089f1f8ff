//! The load at first yield (paper, chapter 3).
//!
//! Exact: along the piecewise linear path of contact events the stress at any point is linear
//! between two events, von Mises' stress convex; the first event with a ratio above 1 brackets the
//! yield load, found there to round-off. Secant: the paper's (3.14), each iterate a contact problem
//! solved from scratch, with a bracket.

use super::load_point::LoadPoint;
use super::recovery::{Peak, Recovery, Samples};
use super::solver::Solver;
use crate::contact;
use crate::error::{Error, Result};
use std::convert::Infallible;

/// Relative accuracy of the yield load.
const ACCURACY: f64 = 1e-14;
/// Share by which a ratio may be below 1 and still be that of first yield: far above [`ACCURACY`],
/// far below any jump.
const BEFORE: f64 = 1e-9;
/// Most iterations of a bracketed root search.
const MOST: usize = 200;
/// Steps of such a search that may leave more than half of the bracket before it is halved.
const PATIENCE: usize = 3;

/// Finds `s` in `[0, 1]` with a recovered stress ratio of 1 between two sampled stress fields,
/// linear in between. The ratio is at most 1 at `s = 0`, at least 1 at `s = 1`.
pub fn yield_share(
    solver: &Solver,
    recovery: &mut Recovery,
    from: &Samples,
    to: &Samples,
) -> (f64, Option<Peak>) {
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
        // On a coarse mesh the recovered maximum may jump where another place is searched: what
        // yields is what lies beyond the jump.
        if peak.is_some_and(|p| p.ratio >= 1.0 - BEFORE) {
            found = peak;
        }
        peak.map_or(-1.0, |p| p.ratio - 1.0)
    };
    let ends = [0.0, 1.0].map(|s| (s, beyond(s)));
    let Ok(share) = bracketed_root(ends[0], ends[1], ACCURACY, |s| {
        Ok::<_, Infallible>(beyond(s))
    });
    (share, found)
}

/// The root between two places (with the values there) of a function that is negative at the first
/// and positive at the second: by inverse quadratic interpolation, halving where that is slow.
/// Returns an end whose value has not the sign it should have.
///
/// # Errors
/// The first of the function's own.
///
/// # Source
/// R. P. Brent, *Algorithms for Minimization Without Derivatives* (1973), chapter 4.
pub fn bracketed_root<E>(
    (mut a, mut fa): (f64, f64),
    (mut b, mut fb): (f64, f64),
    accuracy: f64,
    mut f: impl FnMut(f64) -> std::result::Result<f64, E>,
) -> std::result::Result<f64, E> {
    if fa >= 0.0 {
        return Ok(a);
    }
    if fb <= 0.0 {
        return Ok(b);
    }
    // The end before last, and how many steps have not halved the bracket.
    let (mut c, mut fc) = (b, fb);
    let mut slow = 0;
    for _ in 0..MOST {
        let width = b - a;
        let mut x = if fc != fa && fc != fb {
            a * fb / (fa - fb) * fc / (fa - fc)
                + b * fa / (fb - fa) * fc / (fb - fc)
                + c * fa / (fc - fa) * fb / (fc - fb)
        } else {
            b - fb * width / (fb - fa)
        };
        if slow == PATIENCE || !(x > a && x < b) {
            x = 0.5 * (a + b);
        }
        let y = f(x)?;
        if y.abs() <= accuracy || width <= accuracy * b.abs().max(a.abs()) {
            return Ok(x);
        }
        if y < 0.0 {
            (c, fc) = (a, fa);
            (a, fa) = (x, y);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (x, y);
        }
        slow = if b - a <= 0.5 * width || slow == PATIENCE {
            0
        } else {
            slow + 1
        };
    }
    Ok(0.5 * (a + b))
}

impl Solver<'_> {
    /// Solves contact for the load point from scratch, elastic, and makes it the current state
    /// (paper 3.7 to 3.10).
    ///
    /// # Errors
    /// A load that drives a body away from every contact.
    pub fn solve_contact_at(&mut self, point: &LoadPoint) -> Result<()> {
        let mut q = self.structure.closed_forces(point);
        for (q, t) in q.iter_mut().zip(&self.now.initial.forces) {
            *q += t;
        }
        let n = q.len();
        let (mut gap, mut force) = (vec![0.0; n], vec![0.0; n]);
        let outcome = contact::solve(&mut self.tableau, &q, &mut gap, &mut force);
        let certificate = outcome.map_err(|u| self.structure.unbounded(u.pair, point.alpha))?;
        self.cost.counts.contact_changes += certificate.changes;
        self.at = point.clone();
        self.now.gap = gap;
        self.now.force = force;
        self.border.clear();
        self.fresh = false;
        self.refresh();
        Ok(())
    }

    /// The recovered stress peak of the current (elastic) state.
    pub fn peak(&mut self, recovery: &mut Recovery) -> Option<Peak> {
        let samples = recovery.sample_here(self);
        recovery.peak(self.structure.model, &samples)
    }

    /// The yield load by the paper's secant (3.14), bracketed. The state at yield becomes the
    /// current one.
    ///
    /// # Errors
    /// Where the stress does not grow with the load.
    pub fn secant_yield_load(&mut self, recovery: &mut Recovery) -> Result<(f64, Peak)> {
        let mut evaluate = |solver: &mut Self, alpha: f64| -> Result<(f64, Option<Peak>)> {
            let point = solver.structure.point(alpha);
            solver.solve_contact_at(&point)?;
            let peak = solver.peak(recovery);
            Ok((peak.map_or(-1.0, |p| p.ratio - 1.0), peak))
        };
        let mut previous = 1.0;
        let (mut phi_previous, _) = evaluate(self, previous)?;
        let mut alpha = if phi_previous > -1.0 {
            previous / (1.0 + phi_previous)
        } else {
            2.0
        };
        let (mut low, mut high) = (0.0, f64::INFINITY);
        if phi_previous < 0.0 {
            low = previous
        } else {
            high = previous
        }
        for _ in 0..MOST {
            let (phi, peak) = evaluate(self, alpha)?;
            if phi < 0.0 {
                low = f64::max(low, alpha)
            } else {
                high = f64::min(high, alpha)
            }
            if let Some(peak) = peak.filter(|_| phi.abs() <= 1e-13 || high - low <= ACCURACY * high)
            {
                return Ok((alpha, peak));
            }
            // Equal phi would divide by zero: the step is then taken from the bracket.
            let secant = alpha - phi / (phi - phi_previous) * (alpha - previous);
            (previous, phi_previous) = (alpha, phi);
            alpha = if secant.is_finite() && secant > low && secant < high {
                secant
            } else if high.is_finite() {
                0.5 * (low + high)
            } else {
                2.0 * low
            };
            if alpha > 1e100 {
                break;
            }
        }
        Err(Error::analysis(
            "the yield load was not found: the stress does not grow with the load",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::bracketed_root;
    use std::convert::Infallible;

    #[test]
    fn root_of_a_kinked_function() {
        let f = |x: f64| if x < 0.3 { x - 0.5 } else { 20.0 * (x - 0.31) };
        let root = |f: &dyn Fn(f64) -> f64| {
            let mut calls = 0;
            let counted = |x| {
                calls += 1;
                Ok::<_, Infallible>(f(x))
            };
            let Ok(x) = bracketed_root((0.0, f(0.0)), (1.0, f(1.0)), 1e-15, counted);
            (x, calls)
        };
        assert!((root(&f).0 - 0.31).abs() < 1e-14);
        assert_eq!(root(&|x| x), (0.0, 0));
        assert_eq!(root(&|x| x - 2.0), (1.0, 0));
        // Few calls where the function is smooth, and no more than halving takes four times over
        // where it jumps.
        let (x, calls) = root(&|x: f64| x.exp() - 1.5);
        assert!((x - 1.5f64.ln()).abs() < 1e-14 && calls <= 7, "{x} {calls}");
        let (x, calls) = root(&|x: f64| if x < 0.31 { -1e-3 } else { 1.0 });
        assert!((x - 0.31).abs() < 1e-14 && calls <= 200, "{x} {calls}");
    }
}
