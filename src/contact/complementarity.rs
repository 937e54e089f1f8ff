//! Contact statuses for a given load, from any starting statuses (the total form of contact).
//!
//! Block pivoting flips every pair that violates its condition. Block pivoting is fast but may
//! cycle, so it is given up when the number of violations has not fallen for a while. Then the
//! symmetric principal pivoting method of Dantzig and Cottle takes over: the energy
//! `1/2 g'Tg + q'g` falls strictly from one set of open pairs to the next, so no set can return,
//! and there are finitely many sets. Round-off can break this argument (a body that rests on
//! nothing but round-off is handed from pair to pair while the energy falls by 1e-30). Therefore a
//! pair that would be opened twice from the same set of open pairs stays closed from then on, which
//! happens at most n times.
//!
//! # Source
//! Cottle, Pang, Stone (1992), section 4.2; J. J. Júdice, F. M. Pires (1994),
//! doi:10.1016/0305-0548(94)90106-6.

use super::Tableau;
use std::collections::BTreeSet;

/// Record of how a solution was found, as evidence that the solve terminated by construction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Certificate {
    /// Number of rounds of block pivoting.
    pub rounds: usize,
    /// Number of single pivots of the fallback; 0 if block pivoting found the solution.
    pub fallback_pivots: usize,
    /// Number of pairs whose status differs from their status at the start.
    pub changes: usize,
}

/// Error of a contact problem without a solution: the forces push some pairs apart for ever.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unbounded {
    /// A pair whose opening nothing stops.
    pub pair: usize,
}

/// Fraction of the largest violation above which another violation counts as equally large. Of
/// equally large violations the first is taken, since round-off decides which of them is the
/// largest.
const ALIKE: f64 = 1.0 - 1e-9;
/// Number of rounds without progress after which block pivoting is given up.
const PATIENCE: usize = 8;

/// Finds statuses, gaps and forces with `r = q + T g`, `g >= 0`, `r >= 0`, `g . r = 0`. The search
/// starts from the statuses in the tableau and leaves the statuses of the solution there.
///
/// # Errors
/// [`Unbounded`] if no solution exists (`T` singular and `q` does work on its null space).
pub fn solve(
    tableau: &mut Tableau,
    q: &[f64],
    gap: &mut [f64],
    force: &mut [f64],
) -> Result<Certificate, Unbounded> {
    let before = tableau.open().to_vec();
    let mut certificate = Certificate::default();
    if !block_pivoting(tableau, q, gap, force, &mut certificate) {
        principal_pivoting(tableau, q, gap, force, &mut certificate)?;
    }
    certificate.changes = before
        .iter()
        .zip(tableau.open())
        .filter(|(a, b)| a != b)
        .count();
    Ok(certificate)
}

fn block_pivoting(
    tableau: &mut Tableau,
    q: &[f64],
    gap: &mut [f64],
    force: &mut [f64],
    out: &mut Certificate,
) -> bool {
    let mut fewest = usize::MAX;
    let mut patience = PATIENCE;
    loop {
        out.rounds += 1;
        tableau.solve_safely(q, gap, force);
        let r_tol = tableau.force_tolerance(q, gap);
        let g_tol = tableau.gap_tolerance(r_tol);
        let violated: Vec<usize> = (0..tableau.len())
            .filter(|&k| {
                if tableau.open()[k] {
                    gap[k] < -g_tol
                } else {
                    force[k] < -r_tol
                }
            })
            .collect();
        if violated.is_empty() {
            clip(gap, force);
            return true;
        }
        if violated.len() < fewest {
            fewest = violated.len();
            patience = PATIENCE;
        } else if patience == 0 {
            return false;
        } else {
            patience -= 1;
        }
        // Pairs are closed first: the fewer pairs are open, the further is the stiffness of the
        // open pairs from singular.
        let (closing, opening): (Vec<usize>, Vec<usize>) =
            violated.into_iter().partition(|&k| tableau.open()[k]);
        for k in closing {
            tableau.flip(k);
        }
        for k in opening {
            if !tableau.flip(k) {
                return false;
            }
        }
    }
}

fn principal_pivoting(
    tableau: &mut Tableau,
    q: &[f64],
    gap: &mut [f64],
    force: &mut [f64],
    out: &mut Certificate,
) -> Result<(), Unbounded> {
    let n = tableau.len();
    tableau.reset(&vec![false; n]);
    gap.fill(0.0);
    // Pairs whose tension is only round-off. Opening such a pair could repeat a set of open pairs
    // without lowering the energy.
    let mut settled = vec![false; n];
    let mut entered: BTreeSet<(usize, Vec<bool>)> = BTreeSet::new();
    let mut column: Vec<(usize, f64)> = Vec::new();
    loop {
        tableau.solve_safely(q, gap, force);
        for g in gap.iter_mut() {
            *g = g.max(0.0);
        }
        let r_tol = tableau.force_tolerance(q, gap);
        let violated =
            || (0..n).filter(|&k| !tableau.open()[k] && !settled[k] && force[k] < -r_tol);
        let most = violated().map(|k| force[k]).fold(0.0, f64::min);
        let Some(k) = violated().find(|&k| force[k] <= ALIKE * most) else {
            clip(gap, force);
            return Ok(());
        };
        if !entered.insert((k, tableau.open().to_vec())) {
            settled[k] = true;
            continue;
        }
        let mut blocked_at_once = 0;
        loop {
            out.fallback_pivots += 1;
            let curvature = tableau.swept(k, k);
            let free = tableau.would_free(k);
            let full = if free {
                f64::INFINITY
            } else {
                -force[k] / curvature
            };
            column.clear();
            column.extend(tableau.swept_column(k));
            let blocking = column
                .iter()
                .filter(|&&(j, entry)| tableau.open()[j] && entry > 0.0)
                .map(|&(j, entry)| (gap[j] / entry, j))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            match blocking {
                Some((step, j)) if step < full => {
                    for &(i, entry) in column.iter().filter(|(i, _)| tableau.open()[*i]) {
                        gap[i] = (gap[i] - step * entry).max(0.0);
                    }
                    gap[k] += step;
                    gap[j] = 0.0;
                    force[k] += step * curvature.max(0.0);
                    tableau.flip(j);
                    blocked_at_once = if step == 0.0 { blocked_at_once + 1 } else { 0 };
                    if blocked_at_once > n {
                        settled[k] = true;
                        break;
                    }
                }
                _ if free => return Err(Unbounded { pair: k }),
                _ => {
                    tableau.flip(k);
                    break;
                }
            }
        }
    }
}

/// Sets to zero the gaps and forces that round-off left negative.
fn clip(gap: &mut [f64], force: &mut [f64]) {
    for v in gap.iter_mut().chain(force) {
        *v = v.max(0.0);
    }
}
