//! The report's pictures read back from their SVG: filled paths, words, marks, and what their axes
//! say of a place.

use roxmltree::{Document, Node};

type Point = [f64; 2];

/// A picture under axes.
pub struct Picture {
    /// Filled paths in the order in which they are painted: colour, closed lines.
    pub areas: Vec<(String, Vec<Vec<Point>>)>,
    /// Words with their places.
    words: Vec<(Point, String)>,
    /// The ring round the largest value.
    pub mark: Option<Point>,
    /// Smallest and largest coordinates of what is shown.
    pub frame: [Point; 2],
    /// Units of the drawing per pixel.
    pub fine: f64,
}

/// Margins of a picture in pixels: left, top, right (with a scale of colours), bottom.
const MARGINS: [f64; 4] = [66.0, 12.0, 82.0, 46.0];

impl Picture {
    /// Reads a figure's file; panics where it is none.
    pub fn read(text: &str) -> Self {
        let xml = Document::parse(text).unwrap();
        let root = xml.root_element();
        let number =
            |node: Node, name: &str| -> f64 { node.attribute(name).unwrap().parse().unwrap() };
        let view: Vec<f64> = (root.attribute("viewBox").unwrap().split(' '))
            .map(|n| n.parse().unwrap())
            .collect();
        let fine = view[2] / number(root, "width");
        let [left, top, right, bottom] = MARGINS.map(|m| m * fine);
        let filled =
            |node: &Node| node.has_tag_name("path") && node.attribute("fill") != Some("none");
        let areas = (xml.descendants().filter(filled))
            .map(|node| {
                (
                    node.attribute("fill").unwrap().to_string(),
                    rings(node.attribute("d").unwrap()),
                )
            })
            .collect();
        let texts = xml.descendants().filter(|node| node.has_tag_name("text"));
        let words = texts.map(|node| {
            let words = node.text().unwrap_or("").trim().replace('\u{2212}', "-");
            ([number(node, "x"), number(node, "y")], words)
        });
        let mark = xml.descendants().find(|node| node.has_tag_name("circle"));
        Picture {
            areas,
            words: words.collect(),
            mark: mark.map(|node| [number(node, "cx"), number(node, "cy")]),
            frame: [[left, top], [view[2] - right, view[3] - bottom]],
            fine,
        }
    }

    /// The numbers of the scale of colours, from below up.
    pub fn legend(&self) -> Vec<f64> {
        let beside = self.words.iter().filter(|(at, _)| at[0] > self.frame[1][0]);
        let mut numbers: Vec<(f64, f64)> = beside
            .filter_map(|(at, words)| Some((-at[1], words.parse().ok()?)))
            .collect();
        numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
        numbers.into_iter().map(|(_, number)| number).collect()
    }

    /// The value beside the mark.
    pub fn marked(&self) -> f64 {
        let mark = self.mark.unwrap();
        let off = |at: &Point| (at[0] - mark[0]).hypot(at[1] - mark[1]);
        let numbers = self
            .words
            .iter()
            .filter(|(_, words)| words.parse::<f64>().is_ok());
        let nearest = numbers.min_by(|a, b| off(&a.0).total_cmp(&off(&b.0)));
        nearest.unwrap().1.parse().unwrap()
    }

    /// Units of the drawing per unit of length, and where 0 is, by the numbers of an axis that are
    /// farthest apart: across (0) or up (1).
    pub fn scale(&self, axis: usize) -> [f64; 2] {
        let [low, high] = self.frame;
        let is_of = |at: &Point| match axis {
            0 => at[1] > high[1] && at[0] < high[0] + 1.0,
            _ => at[0] < low[0],
        };
        let of_axis = self.words.iter().filter(|(at, _)| is_of(at));
        let mut ticks: Vec<(f64, f64)> = of_axis
            .filter_map(|(at, words)| Some((words.parse().ok()?, at[axis])))
            .collect();
        ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
        let scale = (last.1 - first.1) / (last.0 - first.0);
        [scale, first.1 - scale * first.0]
    }

    /// The place of a point of the drawing on the axes.
    pub fn place(&self, point: Point) -> Point {
        [0, 1].map(|axis| {
            let [scale, zero] = self.scale(axis);
            (point[axis] - zero) / scale
        })
    }

    /// The colours of a scale lie one on the other, each within the one below: areas do not grow.
    /// Returns that of the lowest. `round_off` is what rounding to whole units may change of one.
    pub fn check_bands(&self, name: &str) -> f64 {
        let [low, high] = self.frame;
        let mut last = f64::INFINITY;
        for (color, rings) in &self.areas {
            assert!(!rings.is_empty(), "{name} {color}");
            for p in rings.iter().flatten() {
                let inside = |d: usize| p[d] >= low[d] - 1.0 && p[d] <= high[d] + self.fine;
                assert!(
                    inside(0) && inside(1),
                    "{name} {color}: {p:?} outside {:?}",
                    self.frame
                );
            }
            let found = area(rings);
            // Points move by a unit at most.
            let round_off = 2.0 * length(rings);
            assert!(
                found <= last + round_off,
                "{name} {color}: {found} on {last}"
            );
            last = found;
        }
        area(&self.areas[0].1)
    }
}

/// The closed lines of a path.
pub fn rings(data: &str) -> Vec<Vec<Point>> {
    let closed = data.split('z').filter(|ring| !ring.is_empty());
    assert!(
        data.ends_with('z') && data.matches('M').count() == data.matches('z').count(),
        "{data}"
    );
    closed
        .map(|ring| {
            let spaced = ring.replace(['M', 'l'], " ").replace('-', " -");
            let numbers: Vec<f64> = spaced
                .split_whitespace()
                .map(|n| n.parse().unwrap())
                .collect();
            assert!(
                numbers.len() >= 6 && numbers.len().is_multiple_of(2),
                "{ring}"
            );
            let mut at = [0.0; 2];
            let step = |way: &[f64]| {
                at = [at[0] + way[0], at[1] + way[1]];
                at
            };
            numbers.chunks(2).map(step).collect()
        })
        .collect()
}

/// Area inside closed lines, holes taken off.
pub fn area(rings: &[Vec<Point>]) -> f64 {
    let of = |ring: &Vec<Point>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        let cross = |(p, q): (&Point, &Point)| 0.5 * (p[0] * q[1] - q[0] * p[1]);
        ring.iter().zip(next).map(cross).sum()
    };
    rings.iter().map(of).sum::<f64>().abs()
}

/// Length of closed lines.
pub fn length(rings: &[Vec<Point>]) -> f64 {
    let of = |ring: &Vec<Point>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter()
            .zip(next)
            .map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1]))
            .sum()
    };
    rings.iter().map(of).sum()
}
