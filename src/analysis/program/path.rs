//! Points of the path between two rows of the history, where the curves of its figures bend.
//!
//! From one change of contact to the next, forces change linearly if nothing yields, and nearly so
//! otherwise. Maximum pressure and half width follow from the forces, but not linearly: the largest
//! force may pass from one pair to another, and the edge of the contact moves within an element.
//! Their values between two rows cost no solve.

use crate::analysis::figures::measure::contact_figures;
use crate::analysis::structure::solver::Solver;
use crate::results::{HistoryRow, PathPoint};
use serde::{Deserialize, Serialize};

/// The last row of the history, and the contact forces at that row.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct PathSampler {
    row: HistoryRow,
    forces: Vec<f64>,
}

/// Fraction of a figure within which its path counts as straight.
const STRAIGHT: f64 = 1e-3;
/// Number of times that a quarter of the way may be halved.
const HALVINGS: usize = 3;

/// Figures at a point of the path: share of the way covered, maximum pressure, half width, and the
/// error of reading the half width in space (0 in the plane), which may exceed a bend of the path.
type PathFigures = [f64; 4];

impl PathSampler {
    /// Takes over the next row, which belongs to the solver's current state. Returns the points on
    /// the way to it that a curve needs.
    pub(super) fn advance(&mut self, solver: &Solver, row: &HistoryRow) -> Vec<PathPoint> {
        if solver.structure.model.pairs.is_empty() {
            return Vec::new();
        }
        let forces = solver.contact_forces().into_owned();
        let from = std::mem::replace(
            self,
            PathSampler {
                row: row.clone(),
                forces,
            },
        );
        let pressed = |forces: &[f64]| forces.iter().any(|force| *force > 0.0);
        // If no pair carries a force at one end, all forces are proportional to the load. After
        // rows were taken back, the forces at the start of the way to the first new row are not
        // known.
        let follows = from.row.increment + 1 == row.increment;
        if !follows || !pressed(&from.forces) || !pressed(&self.forces) {
            return Vec::new();
        }
        let between = |a: f64, b: f64, share: f64| a + share * (b - a);
        let figures = |share: f64| -> PathFigures {
            let ends = from.forces.iter().zip(&self.forces);
            let forces: Vec<f64> = ends.map(|(a, b)| between(*a, *b, share)).collect();
            let found = contact_figures(solver.structure.model, &forces, solver.scales.force);
            let wavers = match solver.structure.model.kind.is_solid() {
                true => found.half_width_reading.error,
                false => 0.0,
            };
            [share, found.max_pressure, found.half_width, wavers]
        };
        let ends = [
            [0.0, from.row.max_pressure, from.row.half_width, 0.0],
            [1.0, row.max_pressure, row.half_width, 0.0],
        ];
        let points = bends(ends, &figures).into_iter();
        let points = points.map(|[share, max_pressure, half_width, _]| PathPoint {
            increment: row.increment,
            alpha: between(from.row.alpha, row.alpha, share),
            load: between(from.row.load, row.load, share),
            max_pressure,
            half_width,
        });
        points.collect()
    }
}

/// The points between two ends that a curve through them needs.
fn bends(ends: [PathFigures; 2], figures: &impl Fn(f64) -> PathFigures) -> Vec<PathFigures> {
    let quarters = [0.25, 0.5, 0.75].map(figures);
    if quarters.iter().all(|point| is_straight(ends, *point)) {
        return Vec::new();
    }
    let mut out = vec![ends[0]];
    for point in quarters.into_iter().chain([ends[1]]) {
        let last = out[out.len() - 1];
        halve([last, point], figures, HALVINGS, &mut out);
        out.push(point);
    }
    out.pop();
    out.remove(0);
    out
}

/// Adds the points between two ends that lie off the line between them, in up to `halvings`
/// halvings.
fn halve(
    ends: [PathFigures; 2],
    figures: &impl Fn(f64) -> PathFigures,
    halvings: usize,
    out: &mut Vec<PathFigures>,
) {
    if halvings == 0 {
        return;
    }
    let middle = figures(0.5 * (ends[0][0] + ends[1][0]));
    if is_straight(ends, middle) {
        return;
    }
    halve([ends[0], middle], figures, halvings - 1, out);
    out.push(middle);
    halve([middle, ends[1]], figures, halvings - 1, out);
}

/// Whether a point lies on the line between two points.
fn is_straight([from, to]: [PathFigures; 2], point: PathFigures) -> bool {
    let share = (point[0] - from[0]) / (to[0] - from[0]);
    [(1, 0.0), (2, point[3])].into_iter().all(|(k, wavers)| {
        let on_line = from[k] + share * (to[k] - from[k]);
        let near = STRAIGHT * from[k].abs().max(to[k].abs());
        (point[k] - on_line).abs() <= near.max(wavers)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_has_the_points_that_it_needs() {
        let even = |t: f64| [t, 2.0 + t, 1.0, 0.0];
        // The path bends by 0.02, which may be an error of the reading.
        let wavering = |t: f64| [t, 2.0 + t, 1.0 + 0.08 * t * (1.0 - t), 0.03];
        assert!(bends([wavering(0.0), wavering(1.0)], &wavering).is_empty());
        assert!(bends([even(0.0), even(1.0)], &even).is_empty());
        // One path has a kink, the other is a curve.
        let kink = |t: f64| [t, (t - 0.3).abs(), 1.0, 0.0];
        let curve = |t: f64| [t, 1.0, t.sqrt(), 0.0];
        for path in [&kink as &dyn Fn(f64) -> PathFigures, &curve] {
            let ends = [path(0.0), path(1.0)];
            let mut points = vec![ends[0]];
            points.extend(bends(ends, &path));
            points.push(ends[1]);
            assert!(points.windows(2).all(|p| p[0][0] < p[1][0]), "{points:?}");
            assert!((5..=33).contains(&points.len()), "{}", points.len());
            for pair in points.windows(2).skip(1) {
                let middle = path(0.5 * (pair[0][0] + pair[1][0]));
                for k in 1..3 {
                    let off = middle[k] - 0.5 * (pair[0][k] + pair[1][k]);
                    assert!(off.abs() < 0.02, "{pair:?}");
                }
            }
        }
    }
}
