//! Lines of equal value over triangles, joined to closed lines.

use super::path::Spot;

/// A point on a line: a corner of a triangle (its number twice), or the place between two corners
/// at which the value is reached.
type LinePoint = [u32; 2];

/// Triangles of the plane with a value at each corner; the values are linear in each triangle.
pub(super) struct TriangleSheet<'t> {
    /// Corners of the triangles, all in the same sense of rotation.
    pub triangles: &'t [[u32; 3]],
    /// Sides that belong to only one triangle, each directed as in that triangle's sense of
    /// rotation.
    pub border: &'t [[u32; 2]],
    /// Positions of the corners.
    pub places: Vec<[f64; 2]>,
    /// Values at the corners.
    pub values: Vec<f64>,
}

impl TriangleSheet<'_> {
    /// Returns closed lines round all places at which the value is at least `level`; minus infinity
    /// includes all places.
    ///
    /// Inside, the sides of neighbouring triangles cancel: the lines that remain are the level line
    /// through each triangle and the part of the border above the level.
    pub(super) fn above(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        let is_above = |k: u32| self.values[k as usize] >= level || level == f64::NEG_INFINITY;
        let cut = |a: u32, b: u32| [a.min(b), a.max(b)];
        let mut segments: Vec<(LinePoint, LinePoint)> = Vec::new();
        for corners in self.triangles {
            let (mut enters, mut leaves) = (None, None);
            for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
                match (is_above(a), is_above(b)) {
                    (true, false) => leaves = Some(cut(a, b)),
                    (false, true) => enters = Some(cut(a, b)),
                    _ => {}
                }
            }
            segments.extend(leaves.zip(enters));
        }
        for &[a, b] in self.border {
            match (is_above(a), is_above(b)) {
                (true, true) => segments.push(([a; 2], [b; 2])),
                (true, false) => segments.push(([a; 2], cut(a, b))),
                (false, true) => segments.push((cut(a, b), [b; 2])),
                (false, false) => {}
            }
        }
        let rings = joined(segments);
        let place = |&[a, b]: &LinePoint| {
            let [p, q] = [a, b].map(|k| self.places[k as usize]);
            let [v, w] = [a, b].map(|k| self.values[k as usize]);
            let share = if a == b { 0.0 } else { (level - v) / (w - v) };
            [0, 1].map(|d| p[d] + share * (q[d] - p[d]))
        };
        rings
            .iter()
            .map(|ring| ring.iter().map(place).collect())
            .collect()
    }

    /// Returns the corner with the largest value among the corners in view.
    pub(super) fn largest(&self, seen: impl Fn([f64; 2]) -> bool) -> Option<usize> {
        let shown = (0..self.values.len()).filter(|&k| self.values[k].is_finite());
        shown
            .filter(|&k| seen(self.places[k]))
            .max_by(|&a, &b| self.values[a].total_cmp(&self.values[b]).then(b.cmp(&a)))
    }

    /// Returns the values along the line through a point, as distance from the point and value,
    /// sorted by distance.
    pub(super) fn along(
        &self,
        [from, way]: [Spot; 2],
        is_shown: impl Fn(u32) -> bool,
    ) -> Vec<[f64; 2]> {
        let off = |p: Spot| (p[0] - from[0]) * way[1] - (p[1] - from[1]) * way[0];
        let on = |p: Spot| (p[0] - from[0]) * way[0] + (p[1] - from[1]) * way[1];
        let mut out = Vec::new();
        for corners in self.triangles.iter().filter(|t| is_shown(t[0])) {
            for (a, b) in
                [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i] as usize, corners[j] as usize))
            {
                let [p, q] = [a, b].map(|k| self.places[k]);
                let [u, v] = [off(p), off(q)];
                if (u >= 0.0) == (v >= 0.0) {
                    continue;
                }
                let share = u / (u - v);
                let between = |from: f64, to: f64| from + share * (to - from);
                out.push([
                    between(on(p), on(q)),
                    between(self.values[a], self.values[b]),
                ]);
            }
        }
        out.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // The point on a side is found from the triangles on either side of it: one copy is
        // removed.
        out.dedup();
        out
    }
}

/// Joins segments end to start. The lines are closed if as many segments end at each point as start
/// there. The order of the lines depends on the points alone.
pub(super) fn joined<K: Ord + Copy>(mut segments: Vec<(K, K)>) -> Vec<Vec<K>> {
    segments.sort_unstable();
    let mut used = vec![false; segments.len()];
    let mut out = Vec::new();
    for first in 0..segments.len() {
        if used[first] {
            continue;
        }
        let mut ring = Vec::new();
        let mut next = Some(first);
        while let Some(segment) = next {
            used[segment] = true;
            let (from, to) = segments[segment];
            ring.push(from);
            let start = segments.partition_point(|s| s.0 < to);
            let starting = segments[start..].iter().take_while(|s| s.0 == to).count();
            next = (start..start + starting).find(|&k| !used[k]);
        }
        out.push(ring);
    }
    out
}

/// Returns the sides that belong to only one polygon, each in the sense of its polygon.
pub(super) fn border<K: Ord + Copy>(sides: impl Iterator<Item = (K, K)>) -> Vec<(K, K)> {
    let mut all: Vec<(K, K, bool)> = sides
        .map(|(a, b)| if a < b { (a, b, false) } else { (b, a, true) })
        .collect();
    all.sort_unstable();
    all.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1))
        .filter_map(|same| match same {
            [(a, b, false)] => Some((*a, *b)),
            [(a, b, true)] => Some((*b, *a)),
            _ => None,
        })
        .collect()
}

/// Returns the area inside closed lines, without holes.
#[cfg(test)]
pub(super) fn area(rings: &[Vec<[f64; 2]>]) -> f64 {
    let of = |ring: &Vec<[f64; 2]>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter()
            .zip(next)
            .map(|(p, q)| 0.5 * (p[0] * q[1] - q[0] * p[1]))
            .sum()
    };
    rings.iter().map(of).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of `n` by `n` cells, each cut in two, without the cell in the middle.
    struct Square {
        triangles: Vec<[u32; 3]>,
        border: Vec<[u32; 2]>,
        places: Vec<[f64; 2]>,
    }

    impl Square {
        fn new(n: usize) -> Self {
            let m = n + 1;
            let place = |k: usize| [(k % m) as f64 / n as f64, (k / m) as f64 / n as f64];
            let mut triangles = Vec::new();
            let cells = (0..n * n).map(|k| (k % n, k / n));
            for (i, j) in cells.filter(|cell| *cell != (n / 2, n / 2)) {
                let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]]
                    .map(|[i, j]| (j * m + i) as u32);
                triangles.extend([[a, b, c], [a, c, d]]);
            }
            let sides = triangles.iter();
            let sides = sides.flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
            Square {
                border: border(sides).into_iter().map(|(a, b)| [a, b]).collect(),
                places: (0..m * m).map(place).collect(),
                triangles,
            }
        }

        fn sheet(&self, value: impl Fn([f64; 2]) -> f64) -> TriangleSheet<'_> {
            TriangleSheet {
                triangles: &self.triangles,
                border: &self.border,
                places: self.places.clone(),
                values: self.places.iter().map(|p| value(*p)).collect(),
            }
        }
    }

    /// A linear field is linear on the triangles, so the region above a level is a piece of the
    /// square, to round-off.
    #[test]
    fn areas_above_levels_of_a_linear_field_are_exact() {
        let n = 8;
        let square = Square::new(n);
        let sheet = square.sheet(|p| p[0]);
        let hole = 1.0 / (n * n) as f64;
        let whole = area(&sheet.above(f64::NEG_INFINITY));
        assert!((whole - (1.0 - hole)).abs() < 1e-14, "{whole}");
        assert_eq!(sheet.above(f64::NEG_INFINITY).len(), 2, "border and hole");
        // The levels lie on nodes, between nodes, through the hole, and above all values.
        for (level, expected) in [
            (0.25, 0.75 - hole),
            (0.3, 0.7 - hole),
            (0.5625, 0.4375 - 0.5 * hole),
            (1.5, 0.0),
        ] {
            let found = area(&sheet.above(level));
            assert!(
                (found - expected).abs() < 1e-13,
                "{level}: {found} for {expected}"
            );
        }
        assert_eq!(
            sheet.largest(|p| p[1] < 0.5).map(|k| sheet.places[k]),
            Some([1.0, 0.0])
        );
        let line = sheet.along([[0.0, 0.3], [1.0, 0.0]], |_| true);
        assert!(line.iter().all(|[s, v]| (s - v).abs() < 1e-14), "{line:?}");
        assert!(line.is_sorted_by(|a, b| a[0] < b[0]) && line[0] == [0.0, 0.0]);
    }

    /// The region above a level grows as the level falls, and a bump away from the border is one
    /// closed line.
    #[test]
    fn a_bump_has_one_line_round_it() {
        let bump = |p: [f64; 2]| 1.0 - (p[0] - 0.25).hypot(p[1] - 0.3);
        let square = Square::new(40);
        let sheet = square.sheet(bump);
        let mut last = 0.0;
        for level in [0.95, 0.9, 0.85, 0.8] {
            let rings = sheet.above(level);
            assert_eq!(rings.len(), 1, "{level}");
            let (found, round) = (area(&rings), std::f64::consts::PI * (1.0 - level).powi(2));
            // Chords of a line of curvature 1/r over cells of 1/40 are off by 1/(8 r 40^2) at most,
            // and so is the linear field.
            let off = 2.0 * std::f64::consts::PI * 2.0 / (8.0 * 1600.0) * 2.0;
            assert!(
                (found - round).abs() < off && found > last,
                "{level}: {found} for {round}"
            );
            last = found;
        }
    }
}
