//! Isotropic hardening: yield stress against equivalent plastic strain.

use crate::scene;
use serde::{Deserialize, Serialize};

/// A piecewise linear hardening curve, continued with a constant slope.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hardening {
    /// Points (equivalent plastic strain, yield stress), the first at strain 0.
    points: Vec<[f64; 2]>,
    /// Slope of the curve after the last point.
    slope: f64,
}

impl Hardening {
    /// Builds linear hardening `sigma_y = yield_stress + plastic_modulus * eps_p`; modulus 0 is
    /// perfect plasticity.
    pub fn linear(yield_stress: f64, plastic_modulus: f64) -> Self {
        Hardening {
            points: vec![[0.0, yield_stress]],
            slope: plastic_modulus,
        }
    }

    /// Builds the curve from a table; the curve is flat after the last row.
    pub fn table(points: &[[f64; 2]]) -> Self {
        Hardening {
            points: points.to_vec(),
            slope: 0.0,
        }
    }

    /// Reads the curve of a scene's (validated) material; `None` if it has no yield stress.
    pub(crate) fn from_scene(data: &scene::Material) -> Option<Self> {
        match data.hardening_curve() {
            Some(curve) => Some(Self::table(&curve)),
            None => Some(Self::linear(
                data.yield_stress?,
                data.plastic_modulus_resolved()?,
            )),
        }
    }

    /// Yield stress at an equivalent plastic strain.
    pub fn yield_stress(&self, strain: f64) -> f64 {
        let (start, slope) = self.segment(strain);
        start[1] + slope * (strain - start[0])
    }

    /// Slope `d sigma_y / d eps_p` to the right of an equivalent plastic strain.
    pub fn slope(&self, strain: f64) -> f64 {
        self.segment(strain).1
    }

    /// Work on plastic strains per volume up to an equivalent plastic strain, which is the area
    /// below the curve: `int_0^strain sigma_y d eps_p`.
    pub fn work(&self, strain: f64) -> f64 {
        let reached = self.points.iter().take_while(|point| point[0] < strain);
        let ends = (self.points.iter().skip(1).map(|point| point[0])).chain([f64::INFINITY]);
        let pieces = reached.zip(ends).map(|(start, end)| {
            let end = end.min(strain);
            0.5 * (start[1] + self.yield_stress(end)) * (end - start[0])
        });
        pieces.sum()
    }

    /// Solves `q - c d = sigma_y(strain + d)` for `d >= 0` with `c > 0`, exactly, segment by
    /// segment. Returns `d` and the slope of the segment in which the solution lies.
    pub fn solve(&self, q: f64, c: f64, strain: f64) -> (f64, f64) {
        for pair in self.points.windows(2) {
            if pair[1][0] <= strain {
                continue;
            }
            let end = pair[1][0] - strain;
            if q - c * end <= pair[1][1] {
                return self.solve_on(pair[0], slope_between(pair), q, c, strain);
            }
        }
        let last = self.points[self.points.len() - 1];
        self.solve_on(last, self.slope, q, c, strain)
    }

    fn solve_on(&self, start: [f64; 2], slope: f64, q: f64, c: f64, strain: f64) -> (f64, f64) {
        let now = start[1] + slope * (strain - start[0]);
        ((q - now) / (c + slope), slope)
    }

    fn segment(&self, strain: f64) -> ([f64; 2], f64) {
        let next = self.points.partition_point(|p| p[0] <= strain);
        let start = self.points[next.max(1) - 1];
        match self.points.get(next.max(1)) {
            Some(_) => (
                start,
                slope_between(&self.points[next.max(1) - 1..=next.max(1)]),
            ),
            None => (start, self.slope),
        }
    }
}

fn slope_between(pair: &[[f64; 2]]) -> f64 {
    (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])
}
