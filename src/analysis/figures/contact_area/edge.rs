//! The edge of a patch between its pairs.
//!
//! Trusted pairs are the pairs far enough inside that their pressures are relied on one by one.
//! Beyond them the square of the pressure continues as the quadratic `q` fitted to them. The error
//! of a quadratic grows with the cube of the distance `d` beyond these pairs, counted in layers,
//! and the pressure vanishes at open pairs:
//!
//! ```text
//! s(x) = q(x) + c d(x)^3 - o(x)^3,
//! ```
//!
//! Here `o` falls linearly to 0 from its values at open pairs, which are the cube roots of `max(q +
//! c d^3, 0)`. The share of the force that each pair at the edge carries depends on where in the
//! face the contact ends; their total force does not, since equilibrium passes it on as a whole.
//! The constant `c` is chosen such that the pressure `sqrt(s)` has this total force. With `N_k`
//! linear between the pairs, and sums over the pairs that are not trusted,
//!
//! ```text
//! int sqrt(max(s, 0)) sum_k N_k dA = int sum_k N_k p_k dA.
//! ```
//!
//! No single pressure of a pair at the edge is trusted, so that a half width does not depend on
//! where in a face the contact ends (`half_widths_of_long_ellipses_are_those_of_hertz`).

use super::fit::LocalPolynomial;
use super::moments::{PatchSums, Polygon, where_positive};
use crate::root;

/// Largest `c`, in units of the square of the largest pressure, at which the search ends: there the
/// correction in the first layer exceeds any pressure.
const LARGEST: f64 = 4.0;

/// A face with at least one corner whose pair is not trusted.
pub(super) struct EdgeFace {
    /// Corners of the face.
    pub(super) corners: Polygon,
    /// Parts of the face that the other body covers.
    pub(super) parts: Vec<Polygon>,
    /// The square of the pressure, fitted to the trusted pairs.
    pub(super) fit: LocalPolynomial,
    /// Number of layers from each corner to the trusted pairs.
    pub(super) layers: Vec<f64>,
    /// Pressure at each corner; 0 at open corners.
    pub(super) pressures: Vec<f64>,
}

/// The shares of a face's corners in the value at a place: the shares of two neighbours in excess
/// of the equal share of all corners.
#[derive(Clone, Copy)]
struct CornerShares {
    /// Index of the first of the two neighbours.
    at: usize,
    of_first: f64,
    of_second: f64,
}

/// Values at the corners of a face, and their mean.
struct AtCorners {
    values: Vec<f64>,
    mean: f64,
}

impl AtCorners {
    fn new(values: Vec<f64>) -> Self {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        AtCorners { values, mean }
    }

    fn at(&self, shares: &CornerShares) -> f64 {
        let [a, b] = [shares.of_first, shares.of_second];
        let next = (shares.at + 1) % self.values.len();
        (1.0 - a - b) * self.mean + a * self.values[shares.at] + b * self.values[next]
    }
}

/// A small piece of a face.
struct FacePiece {
    area: f64,
    shares: CornerShares,
    /// Total share of the corners that are not trusted.
    share: f64,
    /// Value of the fitted quadratic.
    fitted: f64,
    /// Cube `d^3` of the distance beyond the trusted pairs.
    cubed: f64,
}

impl EdgeFace {
    /// The shares of the corners in the value at a place. They are linear in the triangles between
    /// two neighbouring corners and the middle, at which all corners have the same share.
    fn shares(&self, x: [f64; 2]) -> CornerShares {
        let n = self.corners.len();
        let middle = [0, 1].map(|d| self.corners.iter().map(|c| c[d]).sum::<f64>() / n as f64);
        let from = |y: [f64; 2]| [y[0] - middle[0], y[1] - middle[1]];
        let turned = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let x = from(x);
        let of_two = |at: usize| {
            let (a, b) = (from(self.corners[at]), from(self.corners[(at + 1) % n]));
            let whole = turned(a, b);
            CornerShares {
                at,
                of_first: turned(x, b) / whole,
                of_second: turned(a, x) / whole,
            }
        };
        let inside = |shares: &CornerShares| shares.of_first.min(shares.of_second);
        let all = (0..n).map(of_two);
        all.max_by(|a, b| inside(a).total_cmp(&inside(b)))
            .unwrap_or(CornerShares {
                at: 0,
                of_first: 0.0,
                of_second: 0.0,
            })
    }

    /// The values `o` at the corners: cube roots of the positive part of `q + c d^3` at open
    /// corners, 0 at closed ones.
    fn over(&self, constant: f64) -> Vec<f64> {
        let corners = self.corners.iter().zip(&self.layers).zip(&self.pressures);
        let over = corners.map(|((&x, layer), pressure)| match *pressure > 0.0 {
            true => 0.0,
            false => (self.fit.value(x) + constant * layer.powi(3))
                .max(0.0)
                .cbrt(),
        });
        over.collect()
    }

    /// The square `s` of the pressure, as a function of the place.
    fn level(&self, constant: f64) -> impl Fn([f64; 2]) -> f64 + '_ {
        let over = AtCorners::new(self.over(constant));
        let layers = AtCorners::new(self.layers.clone());
        move |x| {
            let shares = self.shares(x);
            let [beyond, over] = [&layers, &over].map(|of| of.at(&shares));
            self.fit.value(x) + constant * beyond.powi(3) - over.powi(3)
        }
    }

    fn pieces(&self) -> Vec<FacePiece> {
        let mut out = Vec::new();
        let layers = AtCorners::new(self.layers.clone());
        let is_ours = |l: &f64| if *l > 0.0 { 1.0 } else { 0.0 };
        let ours = AtCorners::new(self.layers.iter().map(is_ours).collect());
        where_positive(&self.parts, |_| 1.0, &mut |[p, q, r]| {
            let [a, b] = [q, r].map(|x| [x[0] - p[0], x[1] - p[1]]);
            let x = [0, 1].map(|d| (p[d] + q[d] + r[d]) / 3.0);
            let shares = self.shares(x);
            out.push(FacePiece {
                area: 0.5 * (a[0] * b[1] - a[1] * b[0]).abs(),
                share: ours.at(&shares),
                fitted: self.fit.value(x),
                cubed: layers.at(&shares).powi(3),
                shares,
            });
        });
        out
    }

    /// Total force of the pairs that are not trusted, from their pressures.
    fn given(&self, pieces: &[FacePiece]) -> f64 {
        let ours = self.layers.iter().zip(&self.pressures);
        let ours = ours.map(|(l, p)| if *l > 0.0 { *p } else { 0.0 });
        let ours = AtCorners::new(ours.collect());
        let force = |piece: &FacePiece| piece.area * ours.at(&piece.shares);
        pieces.iter().map(force).sum()
    }

    /// Force of the pressure `sqrt(s)` on the pairs that are not trusted.
    fn force(&self, pieces: &[FacePiece], constant: f64) -> f64 {
        let over = AtCorners::new(self.over(constant));
        let force = |piece: &FacePiece| {
            let over = over.at(&piece.shares);
            let square = piece.fitted + constant * piece.cubed - over.powi(3);
            piece.area * piece.share * square.max(0.0).sqrt()
        };
        pieces.iter().map(force).sum()
    }
}

/// The faces at the edge of a patch, and the constant `c` of the edge.
pub(super) struct Edge {
    faces: Vec<EdgeFace>,
    constant: f64,
}

impl Edge {
    /// The edge for which the pairs that are not trusted carry their force.
    pub(super) fn balanced(faces: Vec<EdgeFace>) -> Self {
        let pieces: Vec<Vec<FacePiece>> = faces.iter().map(EdgeFace::pieces).collect();
        let all = || faces.iter().zip(&pieces);
        let given: f64 = all().map(|(face, pieces)| face.given(pieces)).sum();
        let pressures = faces.iter().flat_map(|face| &face.pressures);
        let largest = LARGEST * pressures.fold(0.0f64, |m, p| m.max(*p)).powi(2);
        let force = |constant: f64| -> f64 {
            all()
                .map(|(face, pieces)| face.force(pieces, constant))
                .sum()
        };
        let constant = root::of(|constant| force(constant) - given, -largest, largest);
        Edge { faces, constant }
    }

    /// Whether the quadratic `q` alone is positive at an open pair.
    pub(super) fn passes_open_pairs(&self) -> bool {
        let over = self.faces.iter().flat_map(|face| face.over(0.0));
        over.fold(0.0, f64::max) > 0.0
    }

    /// Adds the part of the faces that belongs to the patch.
    pub(super) fn add_to(&self, sums: &mut PatchSums) {
        for face in &self.faces {
            sums.add_parts(&face.parts, face.level(self.constant));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fit::{Cloud, Known};
    use super::*;

    /// Two unit faces in a row: the pairs at `x <= 0` are trusted, the pairs at 1 have the pressure
    /// `closed`, the pairs at 2 are open.
    fn row(square: impl Fn(f64) -> f64, closed: f64) -> Edge {
        let places = (-3..=0).flat_map(|x| (-3..=3).map(move |y| [f64::from(x), f64::from(y)]));
        let known = places.map(|at| Known {
            at,
            value: square(at[0]),
        });
        let believed = Cloud::new(known.collect());
        let face = |x: f64, [here, beyond]: [f64; 2]| {
            let corners = vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]];
            EdgeFace {
                fit: believed.fit([x + 0.5, 0.5], &[]).unwrap(),
                layers: vec![x, x + 1.0, x + 1.0, x],
                pressures: vec![here, beyond, beyond, here],
                parts: vec![corners.clone()],
                corners,
            }
        };
        let inside = square(0.0).sqrt();
        Edge::balanced(vec![face(0.0, [inside, closed]), face(1.0, [closed, 0.0])])
    }

    /// Area of the row's part of the patch, which is also the place of its edge.
    fn end(edge: &Edge) -> f64 {
        let mut sums = PatchSums::default();
        edge.add_to(&mut sums);
        sums.moments(&[]).area
    }

    /// If the square of the pressure is a cubic, the constant found is that of the cubic.
    #[test]
    fn the_edge_is_where_the_pairs_there_carry_their_force() {
        for cubic in [-0.05, 0.0, -0.4] {
            let quadratic = |x: f64| 1.0 - 0.2 * x - 0.15 * x * x;
            let square = |x: f64| quadratic(x) + cubic * x.powi(3);
            const N: usize = 10_000;
            let places = (0..N).map(|i| 2.0 * (i as f64 + 0.5) / N as f64);
            // The area that belongs to the pairs at 1 is 1: half of the face on either side.
            let forces = places.map(|x| square(x).max(0.0).sqrt() * x.min(1.0));
            let edge = row(quadratic, forces.sum::<f64>() * 2.0 / N as f64);
            // Midpoints of pieces a quarter of a face wide miss some thousandths of the force.
            assert!(
                (edge.constant - cubic).abs() < 0.01,
                "{cubic}: {}",
                edge.constant
            );
            let exact = root::of(square, 0.0, 2.0);
            assert!(
                (end(&edge) - exact).abs() < 0.02,
                "{cubic}: {} {exact}",
                end(&edge)
            );
        }
    }

    /// Under a uniform pressure the quadratic is positive at the open pairs, but the edge lies
    /// before them.
    #[test]
    fn a_uniform_pressure_ends_before_open_pairs() {
        for exact in [1.1, 1.5, 1.8] {
            // The force on half of the first face belongs to the other pairs of that face.
            let edge = row(|_| 1.0, exact - 0.5);
            assert!(edge.passes_open_pairs());
            let found = end(&edge);
            // A pressure that falls with the cube of the distance carries five sixths of a uniform
            // one.
            assert!(
                found > exact && found <= (1.2 * exact + 0.05).min(2.0),
                "{exact}: {found}"
            );
        }
    }
}
