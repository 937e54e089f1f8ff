//! A rigid surface by its heights: `y = h(x)` in plane models, `z = h(x, y)` in solids, `z = h(r)`
//! in axisymmetric ones, given at the points of a grid.
//!
//! Between the points Hermite's cubics are used, in one direction after the other, with the slopes
//! of the parabolas through three neighbours (at the ends of the line, the first and last three).
//! Values and slopes are continuous, and a paraboloid is reproduced exactly.
//!
//! At the point `(u, v, h)` closest to `x` the difference from `x` is at right angles to both
//! tangents. Newton's method finds this point. Its steps omit the curvature if that makes the
//! matrix indefinite, and are halved until the point gets closer:
//!
//! ```text
//!     T = [1 0 h,u; 0 1 h,v],    T (x - (u, v, h)) = 0
//!     (T T' - (x_up - h) [h,uu h,uv; h,uv h,vv]) d(u, v) = T (x - (u, v, h))
//! ```

use crate::error::{Error, Result};
use crate::files;
use crate::number::exact;
use crate::space::{Vector, difference, direction, dot, length};
use std::collections::BTreeMap;
use std::path::Path;

/// Largest number of steps to the closest point. Newton steps need a handful, steps without the
/// curvature some dozens.
const STEPS: usize = 100;
/// Largest number of halvings of a step that leads away.
const HALVINGS: usize = 40;
/// Error allowed in a closest point, as a fraction of the largest coordinate.
const EXACT: f64 = 1e-13;

/// Heights of a rigid surface on a grid.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct Heights {
    /// Grid coordinates along x and y, ascending; in the plane a single one along y.
    places: [Vec<f64>; 2],
    /// Heights, x varying fastest.
    values: Vec<f64>,
    /// Number of the axis along which heights are measured.
    up: usize,
    /// Whether the line starts on an axis, beyond which it continues as its mirror image.
    is_mirrored: bool,
    /// Side of the rigid body: 1 if it is above, -1 if below.
    side: f64,
}

impl Heights {
    /// Reads a file with a line of column names and then one point per line, in any order: `x,y` in
    /// plane models, `x,y,z` in solids.
    ///
    /// # Errors
    /// `Io`; `Input`, naming line or point: no number, a point with two heights or none, a grid of
    /// fewer than three points along an axis.
    pub fn read(path: &Path, dimension: usize, axisymmetric: bool, above: bool) -> Result<Self> {
        let text = files::read_text("read the heights", path, None)?;
        let parsed = parse(&text, dimension).and_then(|points| grid(&points, dimension - 1));
        let (places, values) = parsed.map_err(|error| error.within(path.display()))?;
        Ok(Heights {
            is_mirrored: axisymmetric && places[0][0] == 0.0,
            places,
            values,
            up: dimension - 1,
            side: if above { 1.0 } else { -1.0 },
        })
    }

    /// Distance and normal as for [`super::Form::near`]; `None` also if the closest point is off
    /// the grid.
    pub fn near(&self, x: Vector) -> Option<(f64, Vector)> {
        let flat = self.up == 1;
        let scale = x.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let scale = self.values.iter().fold(scale, |most, h| most.max(h.abs()));
        // The search starts on the grid. If a step at the border leads beyond the grid, there is no
        // closest point.
        let mut place = self.within([x[0], if flat { 0.0 } else { x[1] }]);
        for _ in 0..STEPS {
            let [h, of_u, of_v, uu, uv, vv] = self.at(place)?;
            let rest = x[self.up] - h;
            let b = [
                x[0] - place[0] + of_u * rest,
                if flat {
                    0.0
                } else {
                    x[1] - place[1] + of_v * rest
                },
            ];
            let tangents = [1.0 + of_u * of_u, of_u * of_v, 1.0 + of_v * of_v];
            let curved = [uu, uv, vv].map(|second| rest * second);
            let [a, c, d]: [f64; 3] = std::array::from_fn(|k| tangents[k] - curved[k]);
            let step = match a > 0.0 && a * d > c * c {
                true => solve([a, c, d], b),
                false => solve(tangents, b),
            };
            if step[0].hypot(step[1]) <= EXACT * scale {
                return self.seen_from(x, place);
            }
            let off = |place| self.distance(x, place);
            let here = off(place)? * (1.0 + f64::EPSILON);
            let ways = std::iter::successors(Some(1.0), |share| Some(0.5 * share));
            let gone = |share: f64| [0, 1].map(|axis| place[axis] + share * step[axis]);
            let mut tried = ways.take(HALVINGS).map(|share| self.within(gone(share)));
            let next = tried.find(|next| off(*next).is_some_and(|there| there <= here));
            match next {
                Some(next) if next != place => place = next,
                // The point is at the border, and the step leads beyond it.
                _ if self.within(gone(1.0)) != gone(1.0) => return None,
                _ => return self.seen_from(x, place),
            }
        }
        None
    }

    /// Distance of a point from the surface point above a place of the grid.
    fn distance(&self, x: Vector, place: [f64; 2]) -> Option<f64> {
        Some(length(difference(x, self.foot(place, self.at(place)?[0]))))
    }

    fn foot(&self, [u, v]: [f64; 2], h: f64) -> Vector {
        let mut foot = [u, v, 0.0];
        foot[self.up] = h;
        foot
    }

    /// The place itself, or the closest one on the border of the grid.
    fn within(&self, place: [f64; 2]) -> [f64; 2] {
        let [low, high] = [0, 1].map(|end| {
            let ends = self.places.each_ref();
            ends.map(|x| x[end * (x.len() - 1)])
        });
        let low = [if self.is_mirrored { -high[0] } else { low[0] }, low[1]];
        [0, 1].map(|axis| place[axis].clamp(low[axis], high[axis]))
    }

    /// Distance and normal with the closest point above a place of the grid.
    fn seen_from(&self, x: Vector, place: [f64; 2]) -> Option<(f64, Vector)> {
        let [h, of_u, of_v, ..] = self.at(place)?;
        let mut normal = [of_u, of_v, 0.0];
        normal[self.up] = -1.0;
        let normal = direction(normal).map(|n| self.side * n);
        Some((dot(difference(x, self.foot(place, h)), normal), normal))
    }

    /// Height, slopes and second derivatives `uu`, `uv`, `vv`; `None` beyond the grid.
    fn at(&self, [u, v]: [f64; 2]) -> Option<[f64; 6]> {
        let [xs, ys] = &self.places;
        let is_image = self.is_mirrored && u < 0.0;
        let turned = if is_image { -1.0 } else { 1.0 };
        let along = GridLine::of(xs, turned * u, self.is_mirrored)?;
        let row = |j: usize| along.values(|i| self.values[j * xs.len() + i]);
        if ys.len() == 1 {
            let [h, of_u, uu] = row(0);
            return Some([h, turned * of_u, 0.0, uu, 0.0, 0.0]);
        }
        let across = GridLine::of(ys, v, false)?;
        let [h, of_v, vv] = across.values(|j| row(j)[0]);
        let [of_u, uv, _] = across.values(|j| row(j)[1]);
        let [uu, ..] = across.values(|j| row(j)[2]);
        Some([h, turned * of_u, of_v, uu, turned * uv, vv])
    }
}

/// Solves the symmetric system `[a c; c d] x = b`.
fn solve([a, c, d]: [f64; 3], b: [f64; 2]) -> [f64; 2] {
    let det = a * d - c * c;
    [(d * b[0] - c * b[1]) / det, (a * b[1] - c * b[0]) / det]
}

/// A position on a line of the grid: value and first two derivatives there are weighted sums over
/// four grid points.
struct GridLine {
    first: usize,
    weights: [[f64; 4]; 3],
}

impl GridLine {
    /// Finds the position `at`; `None` beyond the ends of the line.
    fn of(x: &[f64], at: f64, is_mirrored: bool) -> Option<Self> {
        let n = x.len();
        let round_off = 1e-12 * (x[n - 1] - x[0]);
        if !(at >= x[0] - round_off && at <= x[n - 1] + round_off) {
            return None;
        }
        let k = x.partition_point(|x| *x <= at).clamp(1, n - 1) - 1;
        let first = k.saturating_sub(1).min(n.saturating_sub(4));
        let h = x[k + 1] - x[k];
        let t = (at - x[k]) / h;
        // Hermite's polynomials and their derivatives: factors of the values and of the slopes at
        // both ends.
        let of_ends = [
            [(1.0 + 2.0 * t) * (1.0 - t).powi(2), t * t * (3.0 - 2.0 * t)],
            [-6.0 * t * (1.0 - t) / h, 6.0 * t * (1.0 - t) / h],
            [(12.0 * t - 6.0) / (h * h), (6.0 - 12.0 * t) / (h * h)],
        ];
        let of_slopes = [
            [h * t * (1.0 - t).powi(2), h * t * t * (t - 1.0)],
            [(1.0 - t) * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)],
            [(6.0 * t - 4.0) / h, (6.0 * t - 2.0) / h],
        ];
        let mut weights = [[0.0; 4]; 3];
        for ((weights, of_ends), of_slopes) in weights.iter_mut().zip(of_ends).zip(of_slopes) {
            for end in 0..2 {
                let node = k + end;
                weights[node - first] += of_ends[end];
                if node == 0 && is_mirrored {
                    continue;
                }
                for (i, weight) in slope(x, node) {
                    weights[i - first] += of_slopes[end] * weight;
                }
            }
        }
        Some(GridLine { first, weights })
    }

    fn values(&self, of: impl Fn(usize) -> f64) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for i in 0..4 {
            let weights = self.weights.map(|weights| weights[i]);
            if weights.iter().any(|weight| *weight != 0.0) {
                let value = of(self.first + i);
                for (sum, weight) in sums.iter_mut().zip(weights) {
                    *sum += weight * value;
                }
            }
        }
        sums
    }
}

/// Slope at a point of the parabola through three neighbouring points, as a weighted sum over their
/// values.
fn slope(x: &[f64], at: usize) -> [(usize, f64); 3] {
    let middle = at.clamp(1, x.len() - 2);
    let p = [middle - 1, middle, middle + 1];
    let weight = |i: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [xi, xa, xb] = [x[p[i]], x[p[a]], x[p[b]]];
        (2.0 * x[at] - xa - xb) / ((xi - xa) * (xi - xb))
    };
    [0, 1, 2].map(|i| (p[i], weight(i)))
}

/// Reads the points of a file, with their line numbers.
fn parse(text: &str, dimension: usize) -> Result<Vec<(usize, Vector)>> {
    let mut points = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let numbers: Option<Vec<f64>> = cells.iter().map(|cell| cell.parse().ok()).collect();
        let number = index + 1;
        match numbers {
            _ if line.is_empty() || line.starts_with('#') => {}
            Some(numbers)
                if numbers.len() == dimension && numbers.iter().all(|x| x.is_finite()) =>
            {
                let mut point = [0.0; 3];
                point[..dimension].copy_from_slice(&numbers);
                points.push((number, point));
            }
            None if points.is_empty() && cells.iter().all(|cell| cell.parse::<f64>().is_err()) => {}
            _ => {
                return Err(Error::input(format!(
                    "line {number}: `{line}` is not {dimension} finite numbers with commas between"
                )));
            }
        }
    }
    Ok(points)
}

/// Sorts points into a grid: coordinates along each axis, and heights.
fn grid(points: &[(usize, Vector)], axes: usize) -> Result<([Vec<f64>; 2], Vec<f64>)> {
    let mut places = [Vec::new(), vec![0.0]];
    for (axis, places) in places.iter_mut().enumerate().take(axes) {
        *places = points.iter().map(|(_, x)| x[axis]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        if places.len() < 3 {
            return Err(Error::input(format!(
                "{} different values of {}: a grid has at least 3",
                places.len(),
                ["x", "y"][axis]
            )));
        }
    }
    let [xs, ys] = &places;
    let key = |x: f64, y: f64| [x, y].map(|x| (x + 0.0).to_bits());
    let mut known: BTreeMap<[u64; 2], f64> = BTreeMap::new();
    for &(line, x) in points {
        let [y, height] = if axes == 1 { [0.0, x[1]] } else { [x[1], x[2]] };
        if known.insert(key(x[0], y), height).is_some() {
            return Err(Error::input(format!(
                "line {line}: a place that has a height already"
            )));
        }
    }
    let mut values = Vec::with_capacity(xs.len() * ys.len());
    for &y in ys {
        for &x in xs {
            let Some(&height) = known.get(&key(x, y)) else {
                return Err(Error::input(format!(
                    "no height at x = {}, y = {}: a grid of {} by {} places has one at each, this \
                     file has {} of {}; fill the holes",
                    exact(x),
                    exact(y),
                    xs.len(),
                    ys.len(),
                    points.len(),
                    xs.len() * ys.len()
                )));
            };
            values.push(height);
        }
    }
    Ok((places, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, dimension: usize) -> Result<Heights> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("heights.csv");
        std::fs::write(&path, text).unwrap();
        Heights::read(&path, dimension, false, true)
    }

    #[test]
    fn a_paraboloid_on_an_uneven_grid_is_met_exactly() {
        let height = |x: f64, y: f64| 0.5 + 0.1 * x * x - 0.05 * x * y + 0.02 * y * y;
        let mut text = "x,y,z\n".to_string();
        for x in [-2.0, -1.2, -0.3, 0.4, 1.5, 2.5] {
            for y in [-1.0, 0.0, 0.7, 2.0] {
                text += &format!("{x},{y},{}\n", height(x, y));
            }
        }
        let heights = read(&text, 3).unwrap();
        for (x, y) in [(0.1, 0.2), (-1.9, 1.9), (2.2, -0.9), (-0.3, 0.7)] {
            let [h, of_x, of_y, xx, xy, yy] = heights.at([x, y]).unwrap();
            assert!((h - height(x, y)).abs() < 1e-14);
            assert!((of_x - (0.2 * x - 0.05 * y)).abs() < 1e-13);
            assert!((of_y - (0.04 * y - 0.05 * x)).abs() < 1e-13);
            for (found, exact) in [(xx, 0.2), (xy, -0.05), (yy, 0.04)] {
                assert!((found - exact).abs() < 1e-12, "{found} for {exact}");
            }
            // From a point below the surface, along the normal, back to the surface.
            let normal = direction([of_x, of_y, -1.0]);
            let from = crate::space::along([x, y, h], 0.3, normal);
            if let Some((distance, found)) = heights.near(from) {
                assert!((distance - 0.3).abs() < 1e-12, "{distance}");
                assert!(length(difference(found, normal)) < 1e-11);
            }
        }
        // Points beyond the grid have no closest point.
        assert_eq!(heights.near([9.0, 0.0, 0.0]), None);
    }

    /// Sharp tips, seen from a distance beyond their radius of curvature: plain Newton steps
    /// diverge.
    #[test]
    fn a_sharp_tip_is_seen_from_afar() {
        let sharp = |x: f64, y: f64| 20.0 * x * x + 5.0 * x * y + 10.0 * y * y;
        let places = || (-6..=6).map(|k| 0.1 * f64::from(k));
        let points = places().flat_map(|x| places().map(move |y| (x, y)));
        let text: String = points
            .map(|(x, y)| format!("{x},{y},{}\n", sharp(x, y)))
            .collect();
        let heights = read(&text, 3).unwrap();
        for (x, y) in [(0.0, 0.0), (0.1, 0.05), (-0.2, 0.3), (0.35, -0.25)] {
            let normal = direction([40.0 * x + 5.0 * y, 5.0 * x + 20.0 * y, -1.0]);
            for away in [0.01, 0.3, 5.0] {
                let from = crate::space::along([x, y, sharp(x, y)], away, normal);
                let (distance, found) = heights.near(from).unwrap();
                assert!(
                    (distance - away).abs() < 1e-12 * away.max(1.0),
                    "{distance}"
                );
                assert!(length(difference(found, normal)) < 1e-9, "{found:?}");
            }
        }
    }

    #[test]
    fn holes_and_other_faults_are_named() {
        let refused = |text: &str, dimension, fragment: &str| {
            let error = read(text, dimension).unwrap_err().to_string();
            assert!(error.contains(fragment), "{error}");
        };
        let mut grid = String::new();
        for x in 0..3 {
            for y in 0..3 {
                grid += &format!("{x},{y},0.5\n");
            }
        }
        assert!(read(&grid, 3).is_ok());
        refused(
            &grid.replace("1,2,0.5\n", ""),
            3,
            "no height at x = 1, y = 2",
        );
        refused(&format!("{grid}1,1,0.4\n"), 3, "line 10");
        refused(&grid.replace("1,2,0.5", "1,2,none"), 3, "line 6");
        refused(&grid.replace("1,2,0.5", "1,2,nan"), 3, "line 6");
        refused("0,1\n1,1\n", 2, "at least 3");
        refused(&grid, 2, "line 1");
    }
}
