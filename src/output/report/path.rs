//! Lines and areas as the text of SVG paths: cut to a rectangle, without points that would not be
//! visible.

use super::window::Window;
use std::fmt::Write as _;

/// A position in a drawing: right and down.
pub(super) type Spot = [f64; 2];

/// Largest distance between a path and the curve that it represents, in units of a drawing.
const OFF: f64 = 0.8;

/// Returns the data of a path round closed lines, cut to a rectangle.
pub(super) fn area(rings: &[Vec<Spot>], within: Window) -> String {
    let mut out = String::new();
    for ring in rings {
        let mut ring = ring.clone();
        for d in 0..2 {
            ring = cut(&ring, d, within.low[d], 1.0);
            ring = cut(&ring, d, within.high[d], -1.0);
        }
        let mut points = whole(&simplified_ring(&ring));
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() > 2 {
            write_line(&mut out, &points);
            out.push('z');
        }
    }
    out
}

/// Returns the data of a path along lines, cut to a rectangle.
pub(super) fn line(lines: &[Vec<Spot>], within: Window) -> String {
    let mut out = String::new();
    for piece in lines.iter().flat_map(|line| inside(line, within)) {
        let points = whole(&simplified(&piece));
        if points.len() > 1 {
            write_line(&mut out, &points);
        }
    }
    out
}

/// Returns a ring as a line that ends at its first point.
pub(super) fn closed(mut ring: Vec<Spot>) -> Vec<Spot> {
    ring.extend(ring.first().copied());
    ring
}

/// Rounds points to whole units; repeated points are dropped.
fn whole(points: &[Spot]) -> Vec<[i64; 2]> {
    let mut out: Vec<[i64; 2]> = points.iter().map(|p| p.map(|x| x.round() as i64)).collect();
    out.dedup();
    out
}

/// Writes the first point, then the steps from each point to the next, as briefly as SVG allows.
fn write_line(out: &mut String, points: &[[i64; 2]]) {
    let mut last = [0; 2];
    for (index, point) in points.iter().enumerate() {
        let [x, y] = [point[0] - last[0], point[1] - last[1]];
        let head = match index {
            0 => "M",
            1 => "l",
            _ if x < 0 => "",
            _ => " ",
        };
        let space = if y < 0 { "" } else { " " };
        // Writing to a string does not fail.
        let _ = write!(out, "{head}{x}{space}{y}");
        last = *point;
    }
}

/// Returns the part of a ring on one side of a bound of a coordinate (I. Sutherland, G. Hodgman
/// 1974).
fn cut(ring: &[Spot], d: usize, bound: f64, sign: f64) -> Vec<Spot> {
    let is_in = |p: &Spot| sign * (p[d] - bound) >= 0.0;
    let mut out = Vec::with_capacity(ring.len());
    for (index, to) in ring.iter().enumerate() {
        let from = &ring[(index + ring.len() - 1) % ring.len()];
        if is_in(from) != is_in(to) {
            let share = (bound - from[d]) / (to[d] - from[d]);
            let mut at = [0, 1].map(|k| from[k] + share * (to[k] - from[k]));
            at[d] = bound;
            out.push(at);
        }
        if is_in(to) {
            out.push(*to);
        }
    }
    out
}

/// Returns the pieces of a line in a rectangle (Y.-D. Liang, B. Barsky 1984).
fn inside(line: &[Spot], within: Window) -> Vec<Vec<Spot>> {
    let mut out: Vec<Vec<Spot>> = Vec::new();
    for ends in line.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let mut shares = [0.0f64, 1.0];
        for d in 0..2 {
            let way = to[d] - from[d];
            let bounds = [within.low[d] - from[d], within.high[d] - from[d]];
            if way == 0.0 || !way.is_finite() {
                // The segment is parallel to the bounds, so it lies entirely inside or outside; a
                // value that is not a number is outside.
                if bounds[0] > 0.0 || bounds[1] < 0.0 || !way.is_finite() {
                    shares = [1.0, 0.0];
                }
                continue;
            }
            let [a, b] = bounds.map(|bound| bound / way);
            shares = [shares[0].max(a.min(b)), shares[1].min(a.max(b))];
        }
        if shares[0] > shares[1] {
            continue;
        }
        let at = |share: f64| [0, 1].map(|d| from[d] + share * (to[d] - from[d]));
        match out.last_mut().filter(|piece| piece.last() == Some(&from)) {
            Some(piece) if shares[0] == 0.0 => piece.push(at(shares[1])),
            _ => out.push(shares.map(at).to_vec()),
        }
    }
    out
}

fn simplified_ring(ring: &[Spot]) -> Vec<Spot> {
    let ring = closed(ring.to_vec());
    let Some(first) = ring.first() else {
        return ring;
    };
    let far = |p: &Spot| (p[0] - first[0]).hypot(p[1] - first[1]);
    let by_distance = |&a: &usize, &b: &usize| far(&ring[a]).total_cmp(&far(&ring[b]));
    let half = (0..ring.len()).max_by(by_distance).unwrap_or(0);
    let mut out = simplified(&ring[..=half]);
    out.pop();
    out.extend(simplified(&ring[half..]));
    out
}

/// Returns a line without the points that deviate by less than [`OFF`] from the line through the
/// rest; the ends stay (D. Douglas, T. Peucker 1973).
fn simplified(line: &[Spot]) -> Vec<Spot> {
    let mut keep = vec![false; line.len()];
    if let [first, .., last] = &mut keep[..] {
        (*first, *last) = (true, true);
    } else {
        return line.to_vec();
    }
    let mut open = vec![(0, line.len().saturating_sub(1))];
    while let Some((from, to)) = open.pop() {
        let off = |&k: &usize| distance(line[k], line[from], line[to]);
        let farthest = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(k) = farthest.filter(|k| off(k) > OFF) {
            keep[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    let kept = line.iter().zip(keep).filter(|(_, keep)| *keep);
    kept.map(|(point, _)| *point).collect()
}

/// Returns the distance of a point from the segment between two others.
fn distance(p: Spot, a: Spot, b: Spot) -> f64 {
    let way = [b[0] - a[0], b[1] - a[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    let along = (p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1];
    let share = if square > 0.0 {
        (along / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p[0] - a[0] - share * way[0]).hypot(p[1] - a[1] - share * way[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Window = Window {
        low: [0.0; 2],
        high: [100.0; 2],
    };

    #[test]
    fn an_area_is_cut_to_the_rectangle_and_closed() {
        let ring = vec![[-50.0, 20.0], [150.0, 20.0], [150.0, 60.0], [-50.0, 60.0]];
        assert_eq!(area(&[ring], UNIT), "M0 20l100 0 0 40-100 0z");
        let beside = vec![[200.0, 20.0], [250.0, 20.0], [250.0, 60.0]];
        assert_eq!(area(&[beside], UNIT), "");
    }

    #[test]
    fn a_line_is_cut_in_pieces() {
        let zigzag = vec![
            [-50.0, 50.0],
            [50.0, 50.0],
            [50.0, 150.0],
            [80.0, 150.0],
            [80.0, 90.0],
        ];
        assert_eq!(line(&[zigzag], UNIT), "M0 50l50 0 0 50M80 100l0-10");
        assert_eq!(line(&[vec![[f64::NAN, 1.0], [5.0, 5.0]]], UNIT), "");
        assert_eq!(line(&[vec![], vec![[1.0, 1.0]]], UNIT), "");
    }

    /// A circle of many points keeps the visible ones: a chord of a circle of radius r is off by
    /// `r (1 - cos(t/2))`, so that [`OFF`] allows some `pi sqrt(r/(2 OFF))` of them.
    #[test]
    fn points_on_the_way_are_left_out() {
        let many = 10_000;
        let at = |k: usize| {
            let (s, c) = (2.0 * std::f64::consts::PI * k as f64 / many as f64).sin_cos();
            [50.0 + 40.0 * c, 50.0 + 40.0 * s]
        };
        let circle: Vec<Spot> = (0..many).map(at).collect();
        let kept = simplified_ring(&circle);
        let least = std::f64::consts::PI * (40.0 / (2.0 * OFF)).sqrt();
        assert!(
            kept.len() as f64 > least && (kept.len() as f64) < 3.0 * least,
            "{}",
            kept.len()
        );
        for p in &circle {
            let off = kept
                .windows(2)
                .map(|w| distance(*p, w[0], w[1]))
                .fold(f64::MAX, f64::min);
            assert!(off <= OFF, "{off}");
        }
    }
}
