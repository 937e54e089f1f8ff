//! What a user reads off a state: pressure, contact half width, contact arc, dent, approach.

use super::engine::Engine;
use crate::model::{Magnitude, Model};
use crate::results::{PairState, Status};

/// Contact pressures and extents at the current state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactFigures {
    /// Largest pressure of a pair.
    pub max_pressure: f64,
    /// Half width of the largest contact patch.
    pub half_width: f64,
    /// Sum of the contact forces of the model.
    pub force: f64,
    /// Pressure at the middle of the largest patch (its symmetry plane, where it has one).
    pub pole_pressure: f64,
    /// Begin and end of the patch along the surface.
    pub patch: Option<[f64; 2]>,
    /// Contact the patch belongs to.
    pub contact: usize,
}

/// Pressure of each pair. Where a pair has no area (the axis of a quadratic axisymmetric mesh) the pressure is the even
/// continuation of its neighbours'.
pub fn pressures(model: &Model, force: &[f64]) -> Vec<f64> {
    let mut out: Vec<f64> = vec![0.0; force.len()];
    for contact in &model.contacts {
        let range = contact.range.clone();
        let largest = model.pairs[range.clone()]
            .iter()
            .fold(0.0f64, |m, p| m.max(p.area));
        let has_area = |k: usize| model.pairs[k].area > 1e-9 * largest;
        for k in range.clone().filter(|&k| has_area(k)) {
            out[k] = force[k] / model.pairs[k].area;
        }
        for k in range.clone().filter(|&k| !has_area(k)) {
            let inward: [usize; 2] = if k == range.start {
                [k + 1, k + 2]
            } else {
                [k.wrapping_sub(1), k.wrapping_sub(2)]
            };
            if inward.iter().all(|i| range.contains(i)) {
                let at = |i: usize| (model.pairs[i].arc - model.pairs[k].arc).powi(2);
                let (a, b) = (at(inward[0]), at(inward[1]));
                out[k] = ((b * out[inward[0]] - a * out[inward[1]]) / (b - a)).max(0.0);
            }
        }
    }
    out
}

/// Pairs with what they carry.
pub fn pair_states(model: &Model, gap: &[f64], force: &[f64], open: &[bool]) -> Vec<PairState> {
    let pressure = pressures(model, force);
    (0..gap.len())
        .map(|k| PairState {
            pair: k,
            contact: model.pairs[k].contact,
            position: model.mesh.point(model.pairs[k].second),
            gap: gap[k],
            force: force[k],
            area: model.pairs[k].area,
            pressure: pressure[k],
            status: if open[k] || force[k] <= 0.0 {
                Status::Open
            } else {
                Status::Closed
            },
        })
        .collect()
}

/// Figures of the largest contact patch.
pub fn contact_figures(model: &Model, force: &[f64]) -> ContactFigures {
    let pressure = pressures(model, force);
    let mut out = ContactFigures {
        max_pressure: pressure.iter().fold(0.0, |m, p| m.max(*p)),
        force: force.iter().sum(),
        ..ContactFigures::default()
    };
    let mut largest = 0.0;
    for (index, contact) in model.contacts.iter().enumerate() {
        let range = contact.range.clone();
        let mut k = range.start;
        while k < range.end {
            if force[k] <= 0.0 {
                k += 1;
                continue;
            }
            let begin = k;
            while k < range.end && force[k] > 0.0 {
                k += 1;
            }
            let sum: f64 = force[begin..k].iter().sum();
            if sum > largest {
                largest = sum;
                let patch = Patch {
                    model,
                    pressure: &pressure,
                    range: range.clone(),
                    begin,
                    end: k,
                };
                let (from, to) = (patch.edge(begin, -1), patch.edge(k - 1, 1));
                out.patch = Some([from, to]);
                out.contact = index;
                let (at_begin, at_end) = (patch.is_symmetric(begin), patch.is_symmetric(k - 1));
                out.half_width = if at_begin || at_end {
                    to - from
                } else {
                    0.5 * (to - from)
                };
                out.pole_pressure = match (at_begin, at_end) {
                    (true, _) => pressure[begin],
                    (_, true) => pressure[k - 1],
                    _ => patch.pressure_at(0.5 * (from + to)),
                };
            }
        }
    }
    out
}

/// A run of closed pairs `begin..end` of a contact.
struct Patch<'a> {
    model: &'a Model,
    pressure: &'a [f64],
    range: std::ops::Range<usize>,
    begin: usize,
    end: usize,
}

impl Patch<'_> {
    /// Whether a pair ends its surface on a symmetry plane (both nodes are held along the surface).
    fn is_symmetric(&self, k: usize) -> bool {
        let pair = &self.model.pairs[k];
        (k == self.range.start || k + 1 == self.range.end)
            && [pair.first, pair.second]
                .iter()
                .all(|&node| self.model.freedoms.slots[node][1] == crate::model::Slot::Fixed)
    }

    /// Where contact ends beyond pair `last`, along the surface in direction `way`: near the edge of a smooth contact the
    /// pressure squared falls linearly to zero, so it is extrapolated from the three pairs before the last;
    /// the edge lies between the last closed and the first open pair.
    fn edge(&self, last: usize, way: isize) -> f64 {
        let arc = |k: usize| self.model.pairs[k].arc;
        let neighbour = |k: usize, step: isize| {
            k.checked_add_signed(step)
                .filter(|i| self.range.contains(i))
        };
        let Some(beyond) = neighbour(last, way) else {
            return arc(last);
        };
        let inner: Vec<usize> = (1..=3)
            .filter_map(|i| neighbour(last, -i * way))
            .filter(|k| (self.begin..self.end).contains(k))
            .collect();
        let points: Vec<(f64, f64)> = inner
            .iter()
            .map(|&k| (arc(k), self.pressure[k].powi(2)))
            .collect();
        let (low, high) = (arc(last).min(arc(beyond)), arc(last).max(arc(beyond)));
        match falling_line_zero(&points, way as f64) {
            // One pair of slack inwards: the last closed pair may carry the rest of a partly covered facet.
            Some(zero) => zero.clamp(low - 0.5 * (high - low), high),
            None => 0.5 * (low + high),
        }
    }

    /// Pressure between pairs, linear.
    fn pressure_at(&self, arc: f64) -> f64 {
        let pairs = &self.model.pairs[self.begin..self.end];
        let next = pairs
            .partition_point(|p| p.arc <= arc)
            .clamp(1, pairs.len().max(2) - 1);
        match (pairs.get(next - 1), pairs.get(next)) {
            (Some(a), Some(b)) => {
                let t = ((arc - a.arc) / (b.arc - a.arc)).clamp(0.0, 1.0);
                self.pressure[self.begin + next - 1] * (1.0 - t)
                    + self.pressure[self.begin + next] * t
            }
            _ => self.pressure[self.begin],
        }
    }
}

/// Zero of the least-squares line through the points, if it falls in direction `way`.
fn falling_line_zero(points: &[(f64, f64)], way: f64) -> Option<f64> {
    if points.len() < 2 {
        return None;
    }
    let n = points.len() as f64;
    let (mx, my) = (
        points.iter().map(|p| p.0).sum::<f64>() / n,
        points.iter().map(|p| p.1).sum::<f64>() / n,
    );
    let sxx: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    let sxy: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    let slope = sxy / sxx;
    (slope * way < 0.0).then(|| mx - my / slope)
}

impl Engine<'_> {
    /// Contact figures of the current state.
    pub fn contact_figures(&self) -> ContactFigures {
        contact_figures(self.model, &self.now.force)
    }

    /// The total load of the current state: size of the first load that varies, times its factor; of a force the
    /// whole's.
    pub fn total_load_size(&self) -> f64 {
        let loads = &self.model.loads;
        let leading = loads.iter().position(|l| {
            !matches!(l.history, crate::scene::History::Constant)
                && l.measures != Magnitude::Displacement
        });
        match leading {
            Some(i) => self.at.factors[i].abs() * loads[i].magnitude,
            None => self.now.force.iter().sum::<f64>() * self.model.symmetry,
        }
    }

    /// Mean displacement of the first varying load's nodes along the load, for displacements of the whole model.
    pub fn approach(&self, u: &[f64]) -> f64 {
        let Some(load) = self
            .model
            .loads
            .iter()
            .find(|l| !matches!(l.history, crate::scene::History::Constant))
            .or(self.model.loads.first())
        else {
            return 0.0;
        };
        let along: f64 = load
            .nodes
            .iter()
            .map(|&node| {
                let d = self.model.freedoms.displacement(node, u, &self.at.factors);
                d[0] * load.direction[0] + d[1] * load.direction[1]
            })
            .sum();
        along / load.nodes.len().max(1) as f64
    }

    /// The dent that the plastic strains alone leave: largest opening of a pair under the initial loads with all contact
    /// taken away, relative to the outermost pair where a body is held by contact alone.
    pub fn residual_depth(&mut self) -> f64 {
        if self.now.initial.largest() == 0.0 || self.now.gap.is_empty() {
            return 0.0;
        }
        let initial = self.now.initial.clone();
        let forces = self.initial_forces(&initial);
        let mut unloaded = self.sub.tableau();
        unloaded.reset(&vec![true; forces.len()]);
        let (mut gap, mut force) = (vec![0.0; forces.len()], vec![0.0; forces.len()]);
        unloaded.solve(&forces, &mut gap, &mut force);
        gap.iter().fold(0.0, |m, g| m.max(*g))
    }
}
