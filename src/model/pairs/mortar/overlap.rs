//! Common part of two facets, seen along a direction, and points to integrate over it.

use crate::shape::FacetReference;

/// Coordinates in a plane; in plane models the second is 0.
pub(super) type Point = [f64; 2];

/// Gauss' five points on `[-1, 1]`, exact to degree 9 (M. Abramowitz, I. A. Stegun, *Handbook of
/// Mathematical Functions*, table 25.4).
const LINE: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Sixteen points of a triangle, exact to degree 8: orbits by two of their area coordinates, and
/// the weight of each point over the area (D. A. Dunavant, Int. J. Numer. Methods Engrg. 21 (1985)
/// 1129).
const ORBITS: [([f64; 2], f64); 5] = [
    ([1.0 / 3.0, 1.0 / 3.0], 0.144_315_607_677_787),
    (
        [0.081_414_823_414_554, 0.459_292_588_292_723],
        0.095_091_634_267_285,
    ),
    (
        [0.658_861_384_496_480, 0.170_569_307_751_760],
        0.103_217_370_534_718,
    ),
    (
        [0.898_905_543_365_938, 0.050_547_228_317_031],
        0.032_458_497_623_198,
    ),
    (
        [0.008_394_777_409_958, 0.263_112_829_634_638],
        0.027_230_314_174_435,
    ),
];

/// Rule of sixteen points on the triangle of area 1/2, for quadratic facets.
fn sixteen() -> Vec<([f64; 2], f64)> {
    let mut out = Vec::with_capacity(16);
    for ([a, b], weight) in ORBITS {
        let c = 1.0 - a - b;
        let mut orbit: Vec<[f64; 2]> = vec![[a, b], [b, c], [c, a], [b, a], [c, b], [a, c]];
        if (b - c).abs() < 1e-9 {
            orbit.truncate(if (a - b).abs() < 1e-9 { 1 } else { 3 });
        }
        out.extend(orbit.into_iter().map(|at| (at, 0.5 * weight)));
    }
    out
}

/// Rule of seven points for linear facets, exact to degree 5.
fn seven() -> Vec<([f64; 2], f64)> {
    let rule = FacetReference::triangle().rule.iter();
    rule.map(|&([x, y, _], weight)| ([x, y], weight)).collect()
}

/// Common part of two pieces of facets: a polygon, or the ends of a line; empty if they have
/// nothing in common.
pub(super) fn common(a: &[Point], b: &[Point]) -> Vec<Point> {
    match (a, b) {
        (&[a, b], &[c, d]) => {
            let low = a[0].min(b[0]).max(c[0].min(d[0]));
            let high = a[0].max(b[0]).min(c[0].max(d[0]));
            match high > low {
                true => vec![[low, 0.0], [high, 0.0]],
                false => Vec::new(),
            }
        }
        _ => {
            let corners = clipped(b, a);
            match corners.len() < 3 {
                true => Vec::new(),
                false => corners,
            }
        }
    }
}

/// Integration points and weights on the common part of two pieces of facets; quadratic facets get
/// more points.
pub(super) fn points(common: &[Point], are_quadratic: bool) -> Vec<(Point, f64)> {
    match common {
        [] => Vec::new(),
        &[from, to] => on_line(from[0], to[0]),
        corners => on_polygon(corners, &if are_quadratic { sixteen() } else { seven() }),
    }
}

fn on_line(low: f64, high: f64) -> Vec<(Point, f64)> {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let point = |(x, w): (f64, f64)| ([middle + half * x, 0.0], half * w);
    LINE.into_iter().map(point).collect()
}

/// Integrates over a fan of triangles around the mean of the corners.
fn on_polygon(corners: &[Point], rule: &[(Point, f64)]) -> Vec<(Point, f64)> {
    let n = corners.len();
    let mean: Point = [0, 1].map(|d| corners.iter().map(|c| c[d]).sum::<f64>() / n as f64);
    let triangles: Vec<[Point; 3]> = match n {
        3 => vec![[corners[0], corners[1], corners[2]]],
        _ => (0..n)
            .map(|k| [mean, corners[k], corners[(k + 1) % n]])
            .collect(),
    };
    let mut out = Vec::with_capacity(rule.len() * triangles.len());
    for [a, b, c] in triangles {
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if twice <= 0.0 {
            continue;
        }
        out.extend(rule.iter().map(|&([x, y], weight)| {
            let at = |d: usize| a[d] + x * (b[d] - a[d]) + y * (c[d] - a[d]);
            ([at(0), at(1)], weight * twice)
        }));
    }
    out
}

/// Clips a convex polygon to another (I. E. Sutherland, G. W. Hodgman, Commun. ACM 17 (1974) 32);
/// both run counter-clockwise.
fn clipped(subject: &[Point], by: &[Point]) -> Vec<Point> {
    let mut left = subject.to_vec();
    for (k, &a) in by.iter().enumerate() {
        let b = by[(k + 1) % by.len()];
        let inside = |p: Point| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let mut next = Vec::with_capacity(left.len() + 1);
        for (i, &p) in left.iter().enumerate() {
            let q = left[(i + 1) % left.len()];
            let (here, there) = (inside(p), inside(q));
            if here >= 0.0 {
                next.push(p);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let share = here / (here - there);
                next.push([0, 1].map(|d| p[d] + share * (q[d] - p[d])));
            }
        }
        left = next;
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn area(a: &[Point], b: &[Point]) -> f64 {
        let common = common(a, b);
        let areas =
            [false, true].map(|more| points(&common, more).iter().map(|p| p.1).sum::<f64>());
        assert!((areas[0] - areas[1]).abs() < 1e-14);
        areas[0]
    }

    #[test]
    fn polygons_are_cut_to_what_they_have_in_common() {
        let moved = SQUARE.map(|[x, y]| [x + 0.5, y + 0.25]);
        assert!((area(&SQUARE, &moved) - 0.375).abs() < 1e-15);
        assert!((area(&SQUARE, &SQUARE) - 1.0).abs() < 1e-15);
        let apart = SQUARE.map(|[x, y]| [x + 1.0, y]);
        assert_eq!(area(&SQUARE, &apart), 0.0);
        // A diamond over the middle of the square: its corners are cut off, which leaves an
        // octagon.
        let diamond = [[0.5, -0.25], [1.25, 0.5], [0.5, 1.25], [-0.25, 0.5]];
        assert!((area(&SQUARE, &diamond) - 0.875).abs() < 1e-15);
        let triangle = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        assert!((area(&SQUARE, &triangle) - 1.0).abs() < 1e-15);
    }

    /// Rules are exact to degree 5 or 8 in the plane, to 9 on a line.
    #[test]
    fn rules_are_exact() {
        for (more, m, n) in [(false, 3, 2), (true, 3, 2), (true, 4, 4), (true, 7, 1)] {
            let points = points(&common(&SQUARE, &SQUARE), more);
            let sum: f64 = points
                .iter()
                .map(|([x, y], w)| w * x.powi(m) * y.powi(n))
                .sum();
            let exact = 1.0 / f64::from((m + 1) * (n + 1));
            assert!((sum - exact).abs() < 1e-14, "{m} {n}: {sum} {exact}");
        }
        let line = common(&[[0.0, 0.0], [2.0, 0.0]], &[[3.0, 0.0], [1.0, 0.0]]);
        let line = points(&line, false);
        let sum: f64 = line.iter().map(|([x, _], w)| w * x.powi(9)).sum();
        assert!((sum - (2f64.powi(10) - 1.0) / 10.0).abs() < 1e-12);
    }
}
