//! Tree of balls that finds the items near a line or nearest to a point.
//!
//! Ball trees: S. M. Omohundro, *Five balltree construction algorithms*, ICSI TR-89-063 (1989). Of
//! the five algorithms, the one used here cuts the longest axis at the median.

use crate::space::{Vector, difference, dot, length};
use serde::{Deserialize, Serialize};

/// Largest number of items of a leaf.
const LEAF: usize = 4;

/// Balls around items, and a tree of larger balls that enclose them.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Balls {
    /// Centre and radius of each item.
    items: Vec<(Vector, f64)>,
    /// Numbers of the items, leaf by leaf.
    order: Vec<usize>,
    /// Balls of the tree, in preorder.
    nodes: Vec<BallNode>,
}

#[derive(Debug, Serialize, Deserialize)]
struct BallNode {
    center: Vector,
    radius: f64,
    /// Items below this ball, as a range in `order`.
    items: std::ops::Range<usize>,
    /// Index of the node that follows all nodes below this one.
    next: usize,
}

impl Balls {
    pub(crate) fn new(items: Vec<(Vector, f64)>) -> Self {
        let mut out = Balls {
            order: (0..items.len()).collect(),
            nodes: Vec::new(),
            items,
        };
        if !out.items.is_empty() {
            out.split(0..out.items.len());
        }
        out
    }

    fn split(&mut self, range: std::ops::Range<usize>) {
        let of_items = self.order[range.clone()].iter().map(|&k| self.items[k]);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (center, radius) in of_items.clone() {
            for d in 0..3 {
                low[d] = low[d].min(center[d] - radius);
                high[d] = high[d].max(center[d] + radius);
            }
        }
        let center: Vector = std::array::from_fn(|d| 0.5 * (low[d] + high[d]));
        let reach = of_items.map(|(c, radius)| length(difference(c, center)) + radius);
        let radius = reach.fold(0.0, f64::max);
        let own = self.nodes.len();
        self.nodes.push(BallNode {
            center,
            radius,
            items: range.clone(),
            next: 0,
        });
        if range.len() > LEAF {
            let width = |d: &usize| high[*d] - low[*d];
            let longest = (0..3).max_by(|a, b| width(a).total_cmp(&width(b)));
            let axis = longest.unwrap_or(0);
            let middle = range.len() / 2;
            let items = &self.items;
            let along = |a: &usize, b: &usize| {
                let place = |k: &usize| items[*k].0[axis];
                place(a).total_cmp(&place(b)).then(a.cmp(b))
            };
            self.order[range.clone()].select_nth_unstable_by(middle, along);
            self.split(range.start..range.start + middle);
            self.split(range.start + middle..range.end);
        }
        self.nodes[own].next = self.nodes.len();
    }

    /// Items of a leaf; empty for other nodes.
    fn of_leaf(&self, node: &BallNode) -> &[usize] {
        match node.items.len() <= LEAF {
            true => &self.order[node.items.clone()],
            false => &[],
        }
    }

    /// Finds the items whose centres lie nearest to a point, with their distances, ascending: at
    /// least `count` of them, if there are that many, and all further items at the distance of the
    /// last one.
    pub(crate) fn nearest_few(&self, point: Vector, count: usize) -> Vec<(f64, usize)> {
        let off = |center: Vector| length(difference(point, center));
        let Some(reach) = self.reach(point, count) else {
            return Vec::new();
        };
        // Equal distances may differ by round-off.
        let reach = reach * (1.0 + 1e-9);
        let mut found = Vec::new();
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if off(node.center) - node.radius > reach {
                at = node.next;
                continue;
            }
            let items = self.of_leaf(node).iter().copied();
            found.extend(items.map(|item| (off(self.items[item].0), item)));
            at += 1;
        }
        found.retain(|(off, _)| *off <= reach);
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some(&(last, _)) = found.get(count.max(1) - 1) {
            found.retain(|(off, _)| *off <= last * (1.0 + 1e-9));
        }
        found
    }

    /// Upper bound of the distance within which `count` items lie (or all, if there are fewer): the
    /// distance of the farthest item in a small ball near the point with at least `count` items.
    fn reach(&self, point: Vector, count: usize) -> Option<f64> {
        let off = |node: &BallNode| length(difference(point, node.center));
        let mut at = 0;
        let mut ball = self.nodes.first()?;
        while ball.items.len() > LEAF {
            let children = [at + 1, self.nodes[at + 1].next];
            let nearer = children
                .into_iter()
                .min_by(|&a, &b| off(&self.nodes[a]).total_cmp(&off(&self.nodes[b])))?;
            if self.nodes[nearer].items.len() < count {
                break;
            }
            (at, ball) = (nearer, &self.nodes[nearer]);
        }
        let items = self.order[ball.items.clone()].iter();
        let offs = items.map(|&item| length(difference(point, self.items[item].0)));
        Some(offs.fold(0.0, f64::max))
    }

    /// Smallest distance of a point from an item, as measured by `distance`; infinite without
    /// items.
    pub(crate) fn nearest(&self, point: Vector, distance: impl Fn(usize) -> f64) -> f64 {
        let (mut least, mut at) = (f64::INFINITY, 0);
        while let Some(node) = self.nodes.get(at) {
            if length(difference(point, node.center)) - node.radius >= least {
                at = node.next;
                continue;
            }
            for &item in self.of_leaf(node) {
                least = least.min(distance(item));
            }
            at += 1;
        }
        least
    }

    /// Finds the items whose balls come within `reach` of the line through `point` along the unit
    /// vector `way`, or just touch it, in ascending order of their numbers.
    pub(crate) fn near(&self, point: Vector, way: Vector, reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        self.visit(point, way, reach, |item| found.push(item));
        found.sort_unstable();
        found
    }

    /// Visits items as [`Balls::near`] does, unsorted; returns the number of balls examined.
    fn visit(&self, point: Vector, way: Vector, reach: f64, mut found: impl FnMut(usize)) -> usize {
        let comes_near = |center: Vector, radius: f64| {
            let off = difference(center, point);
            let along = dot(off, way);
            // The factor keeps items that just touch, in spite of round-off.
            let near = (reach + radius) * (1.0 + 1e-9);
            dot(off, off) - along * along <= near * near
        };
        let (mut at, mut looked_at) = (0, 0);
        while let Some(node) = self.nodes.get(at) {
            looked_at += 1;
            if !comes_near(node.center, node.radius) {
                at = node.next;
                continue;
            }
            for &item in self.of_leaf(node) {
                looked_at += 1;
                let (center, radius) = self.items[item];
                if comes_near(center, radius) {
                    found(item);
                }
            }
            at += 1;
        }
        looked_at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Facets of a surface of `n x n` facets, bent to a bowl.
    fn bowl(n: usize) -> Vec<(Vector, f64)> {
        let at = |k: usize| {
            let [x, y] = [k % n, k / n].map(|i| (i as f64 + 0.5) / n as f64 - 0.5);
            ([x, y, x * x + y * y], 0.8 / n as f64)
        };
        (0..n * n).map(at).collect()
    }

    #[test]
    fn what_is_found_is_what_a_scan_finds() {
        let items = bowl(23);
        let balls = Balls::new(items.clone());
        for k in (0..items.len()).step_by(7) {
            let (x, _) = items[k];
            let way = crate::space::direction([0.3 * x[0], 0.2, 1.0]);
            let near = |(_, (center, radius)): &(usize, &(Vector, f64))| {
                let off = difference(*center, x);
                let along = dot(off, way);
                dot(off, off) - along * along <= (0.05 + radius).powi(2)
            };
            let scan: Vec<usize> = items.iter().enumerate().filter(near).map(|f| f.0).collect();
            assert_eq!(balls.near(x, way, 0.05), scan);
            assert!(scan.contains(&k));
        }
        assert!(
            Balls::new(Vec::new())
                .near([0.0; 3], [0.0, 0.0, 1.0], 1.0)
                .is_empty()
        );
    }

    #[test]
    fn the_nearest_are_those_of_a_sort() {
        let items = bowl(19);
        let balls = Balls::new(items.clone());
        for (k, count) in [(0, 1), (5, 18), (180, 18), (360, 6), (77, 400)] {
            let point = [items[k].0[0] + 0.01, items[k].0[1], 0.2];
            let off = |k: usize| length(difference(point, items[k].0));
            let mut all: Vec<(f64, usize)> = (0..items.len()).map(|k| (off(k), k)).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let last = all[count.min(all.len()) - 1].0;
            all.retain(|(off, _)| *off <= last * (1.0 + 1e-9));
            assert_eq!(balls.nearest_few(point, count), all);
        }
        assert!(Balls::new(Vec::new()).nearest_few([0.0; 3], 4).is_empty());
    }

    /// With 16 times as many facets only a few more balls are examined on the way to the leaves.
    #[test]
    fn few_are_looked_at_however_many_there_are() {
        let most = |n: usize| {
            let items = bowl(n);
            let balls = Balls::new(items.clone());
            let each = items.iter().map(|&(x, radius)| {
                let mut found = 0;
                let looked_at = balls.visit(x, [0.0, 0.0, 1.0], radius, |_| found += 1);
                (looked_at, found)
            });
            each.fold((0, 0), |m, c| (m.0.max(c.0), m.1.max(c.1)))
        };
        let [(few, facing), (many, facing_many)] = [18, 72].map(most);
        assert!(facing_many <= 12 && facing <= 12, "{facing} {facing_many}");
        assert!(few < 130 && many < 130, "{few} {many}");
    }
}
