//! Division of elements into smaller ones.
//!
//! Everywhere ([`cuts`]), the children have the element's shape and half its size: four in the
//! plane, eight in space.
//!
//! Each corner keeps a child that is the element at half its size. Between these children lie: in a
//! triangle, one child turned by half a turn; in a prism, two such children; in a tetrahedron, an
//! octahedron that is cut into four along one of its three diagonals. Choosing the shortest
//! diagonal keeps the children's angles from degenerating, however often they are cut (M. E. G.
//! Ong, *SIAM J. Sci. Comput.* 15, 1994, 1134).

use super::{Place, Shape};
use crate::space::{Vector, along, cross, difference, dot, unit};
use std::sync::OnceLock;

/// One of the elements into which an element is divided.
#[derive(Debug)]
pub struct CutChild {
    /// Shape of the child.
    pub shape: Shape,
    /// Nodes of the child, as indices of [`Cut::places`].
    pub nodes: Vec<usize>,
}

/// A division of a shape into children.
#[derive(Debug)]
pub struct Cut {
    /// Reference coordinates of the nodes of all children, each once; the element's own nodes come
    /// first.
    pub places: Vec<Place>,
    /// For each place, the corners whose linear shape functions are not zero there, with the values
    /// in parts of [`WHOLE`]. For a place on a facet, both elements at the facet give the same
    /// list.
    pub between: Vec<Vec<(usize, u32)>>,
    /// The elements into which the shape is divided.
    pub children: Vec<CutChild>,
    /// For each facet of the element, the children's facets of which it consists: child and local
    /// facet.
    pub of_facet: Vec<Vec<[usize; 2]>>,
    /// For each facet of the element, the new places on it.
    pub on_facet: Vec<Vec<usize>>,
    /// How a new place in the middle of a quadrilateral or of a hexahedron moves if the new nodes
    /// on its sides move: a weighted sum of their displacements (W. J. Gordon, C. A. Hall, *Int. J.
    /// Numer. Methods Eng.* 7, 1973, 461). Middles of quadrilaterals come first. Filled for linear
    /// elements only: in quadratic elements places on the sides move by a higher order of the
    /// element size.
    pub follows: Vec<(usize, Vec<(f64, usize)>)>,
}

/// The value in [`Cut::between`] of a corner's linear function at the corner itself. A multiple of
/// all denominators that occur: places at quarters of a side have products of up to three quarters.
pub const WHOLE: u32 = 64;

/// An affine map from the reference coordinates of a child to those of the element.
struct ChildMap {
    origin: Place,
    columns: [Place; 3],
}

impl ChildMap {
    /// Maps onto the reference element scaled by `factor` and moved to `origin`.
    fn scaled(origin: Place, factor: [f64; 3]) -> ChildMap {
        ChildMap {
            origin,
            columns: [0, 1, 2].map(|d| unit(d).map(|c| factor[d] * c)),
        }
    }

    /// Maps onto a simplex with the given corners.
    fn simplex([origin, a, b, c]: [Place; 4]) -> ChildMap {
        ChildMap {
            origin,
            columns: [a, b, c].map(|corner| difference(corner, origin)),
        }
    }

    fn apply(&self, at: Place) -> Place {
        let mut out = self.origin;
        for (column, t) in self.columns.iter().zip(at) {
            (0..3).for_each(|d| out[d] += t * column[d]);
        }
        out
    }
}

/// The possible divisions of a shape: three for a tetrahedron, one for each diagonal (between the
/// middles of edges 01-23, 02-13, 03-12), and one for any other shape.
pub fn cuts(shape: Shape) -> &'static [Cut] {
    static CUTS: [OnceLock<Vec<Cut>>; Shape::ALL.len()] =
        [const { OnceLock::new() }; Shape::ALL.len()];
    CUTS[shape as usize].get_or_init(|| match shape {
        Shape::Tet4 | Shape::Tet10 => (0..3)
            .map(|diagonal| Cut::halved(shape, octahedron(shape, diagonal)))
            .collect(),
        _ => vec![Cut::halved(shape, between_corners(shape))],
    })
}

/// Whether an element of a plane shape can be divided at these sides and no others. Bit `k` of
/// `sides` stands for side `k`.
pub fn can_be_cut_at(shape: Shape, sides: usize) -> bool {
    let n = shape.n_corners() as u32;
    sides.count_ones() != n - 1
}

/// The divisions of a plane shape at some of its sides; the index is made of one bit for each
/// divided side ([`can_be_cut_at`]). The last one divides all sides.
pub fn partial_cuts(shape: Shape) -> &'static [Cut] {
    static CUTS: [OnceLock<Vec<Cut>>; Shape::PLANE.len()] =
        [const { OnceLock::new() }; Shape::PLANE.len()];
    CUTS[shape as usize].get_or_init(|| {
        let all = 0..1 << shape.n_corners();
        all.map(|sides| Cut::at_sides(shape, sides)).collect()
    })
}

/// Index in [`cuts`] of the division of an element with these nodes; for a tetrahedron the one
/// along its shortest diagonal.
pub fn cut_of(shape: Shape, nodes: &[Vector]) -> usize {
    if cuts(shape).len() == 1 {
        return 0;
    }
    let squared = |diagonal: usize| {
        let [p, q] = DIAGONALS[diagonal].map(|[a, b]| [0, 1, 2].map(|d| nodes[a][d] + nodes[b][d]));
        let way = difference(p, q);
        dot(way, way)
    };
    (0..3).fold(
        0,
        |best, k| if squared(k) < squared(best) { k } else { best },
    )
}

/// Pairs of edges whose middles each diagonal joins.
const DIAGONALS: [[[usize; 2]; 2]; 3] = [[[0, 1], [2, 3]], [[0, 2], [1, 3]], [[0, 3], [1, 2]]];

/// Maps of the children that lie between the children at the corners, for all shapes except
/// tetrahedra.
fn between_corners(shape: Shape) -> Vec<ChildMap> {
    let turned = |z: f64| ChildMap::scaled([0.5, 0.5, z], [-0.5, -0.5, 0.5]);
    match shape {
        Shape::Tri3 | Shape::Tri6 => vec![turned(0.0)],
        Shape::Prism6 | Shape::Prism15 => vec![turned(-0.5), turned(0.5)],
        _ => Vec::new(),
    }
}

/// Maps of the four tetrahedra around a diagonal of the octahedron between the middles of the
/// edges.
fn octahedron(shape: Shape, diagonal: usize) -> Vec<ChildMap> {
    let corners = shape.reference().nodes;
    let middle = |[a, b]: [usize; 2]| [0, 1, 2].map(|d| 0.5 * (corners[a][d] + corners[b][d]));
    let [p, q] = DIAGONALS[diagonal].map(middle);
    let [[a, c], [b, d]] = [1, 2].map(|k| DIAGONALS[(diagonal + k) % 3].map(middle));
    let ring = [a, b, c, d];
    let child = |k: usize| {
        let (r, s) = (ring[k], ring[(k + 1) % 4]);
        let volume = dot(difference(q, p), cross(difference(r, p), difference(s, p)));
        ChildMap::simplex(if volume > 0.0 {
            [p, q, r, s]
        } else {
            [p, q, s, r]
        })
    };
    (0..4).map(child).collect()
}

impl Cut {
    /// Children of half the size at the corners, and others between them.
    fn halved(shape: Shape, inner: Vec<ChildMap>) -> Cut {
        let row = shape.reference();
        let half = |corner: &Place| ChildMap::scaled(corner.map(|c| 0.5 * c), [0.5; 3]);
        let outer = row.nodes[..row.n_corners].iter().map(half);
        let child = |map: ChildMap| (shape, row.nodes.iter().map(|&at| map.apply(at)).collect());
        Cut::new(shape, outer.chain(inner).map(child).collect())
    }

    /// The division of a plane shape at some sides. Where these sides alone allow none, all sides
    /// are divided.
    fn at_sides(shape: Shape, sides: usize) -> Cut {
        let n = shape.n_corners();
        let divided: Vec<usize> = (0..n).filter(|side| sides >> side & 1 == 1).collect();
        let corners = &shape.reference().nodes[..n];
        let corner = |k: usize| corners[k % n];
        let middle = |k: usize| [0, 1, 2].map(|d| 0.5 * (corner(k)[d] + corner(k + 1)[d]));
        let children: Vec<Vec<Place>> = match (n, &divided[..]) {
            (_, []) => vec![corners.to_vec()],
            (3, &[a]) => {
                let m = middle(a);
                vec![
                    vec![corner(a), m, corner(a + 2)],
                    vec![m, corner(a + 1), corner(a + 2)],
                ]
            }
            (4, &[a]) => {
                let (m, opposite) = (middle(a), [corner(a + 2), corner(a + 3)]);
                vec![
                    vec![corner(a), m, opposite[1]],
                    vec![m, corner(a + 1), opposite[0]],
                    vec![m, opposite[0], opposite[1]],
                ]
            }
            (4, &[a, b]) if b == a + 2 => {
                let [m, opposite] = [middle(a), middle(b)];
                vec![
                    vec![corner(a), m, opposite, corner(a + 3)],
                    vec![m, corner(a + 1), corner(a + 2), opposite],
                ]
            }
            (4, &[a, b]) => {
                // The side `first` is followed by the other divided side.
                let first = if b == a + 1 { a } else { b };
                let [m, next] = [middle(first), middle(first + 1)];
                let (centre, far) = ([0.0; 3], corner(first + 3));
                vec![
                    vec![m, corner(first + 1), next, centre],
                    vec![corner(first), m, centre, far],
                    vec![far, centre, next, corner(first + 2)],
                ]
            }
            _ => return Cut::halved(shape, between_corners(shape)),
        };
        let child = |corners: Vec<Place>| {
            let shape = match (corners.len(), shape.is_quadratic()) {
                (3, false) => Shape::Tri3,
                (3, true) => Shape::Tri6,
                (_, false) => Shape::Quad4,
                (_, true) => Shape::Quad8,
            };
            let nodes = shape.reference().nodes.iter().map(|&at| {
                let values = shape.linear().functions(at).values;
                let terms = values.iter().zip(&corners);
                terms.fold([0.0; 3], |sum, (value, x)| along(sum, *value, *x))
            });
            (shape, nodes.collect())
        };
        Cut::new(shape, children.into_iter().map(child).collect())
    }

    /// The division into children with these shapes and reference coordinates of their nodes.
    fn new(shape: Shape, children: Vec<(Shape, Vec<Place>)>) -> Cut {
        let row = shape.reference();
        let mut out = Cut {
            places: row.nodes.to_vec(),
            between: Vec::new(),
            children: Vec::new(),
            of_facet: Vec::new(),
            on_facet: Vec::new(),
            follows: Vec::new(),
        };
        for (shape, places) in children {
            // All coordinates are multiples of a quarter, so equal coordinates have equal bits.
            let nodes = places.into_iter().map(|place| out.entered(place)).collect();
            out.children.push(CutChild { shape, nodes });
        }
        let linear = |at: &Place| {
            let values = shape.linear().functions(*at).values;
            let parts = values[..row.n_corners].iter().enumerate();
            let parts = parts.map(|(corner, v)| (corner, (v * f64::from(WHOLE)).round() as u32));
            parts.filter(|&(_, part)| part > 0).collect()
        };
        out.between = out.places.iter().map(linear).collect();
        for facet in row.facets {
            let lies_on = |&place: &usize| {
                let mut corners = out.between[place].iter();
                corners.all(|(corner, _)| facet.contains(corner))
            };
            let part = |&[child, local]: &[usize; 2]| {
                let CutChild { shape, nodes } = &out.children[child];
                shape.facet(local).iter().all(|&k| lies_on(&nodes[k]))
            };
            let children = out.children.iter().enumerate();
            let all = children.flat_map(|(child, CutChild { shape, .. })| {
                (0..shape.n_facets()).map(move |local| [child, local])
            });
            let new = row.nodes.len()..out.places.len();
            let (parts, places) = (all.filter(part).collect(), new.filter(lies_on).collect());
            out.of_facet.push(parts);
            out.on_facet.push(places);
        }
        if row.degree == 1 {
            out.follows = out.middles();
        }
        out
    }

    /// The index of a place, which is appended if it is new.
    fn entered(&mut self, place: Place) -> usize {
        let known = self.places.iter().position(|p| *p == place);
        known.unwrap_or_else(|| {
            self.places.push(place);
            self.places.len() - 1
        })
    }

    /// Computes [`Cut::follows`]. The middle of a quadrilateral moves by half the sum over its
    /// sides, the middle of a hexahedron by half the sum over its faces minus a quarter of the sum
    /// over its edges.
    fn middles(&self) -> Vec<(usize, Vec<(f64, usize)>)> {
        let corners = |place: usize| self.between[place].iter().map(|(corner, _)| *corner);
        let mut out = Vec::new();
        for count in [4, 8] {
            let of_count = (0..self.places.len()).filter(|&p| corners(p).count() == count);
            for place in of_count {
                let inside =
                    |&other: &usize| corners(other).all(|c| corners(place).any(|p| p == c));
                let weight = |other: usize| match (count, corners(other).count()) {
                    (4, 2) | (8, 4) => 0.5,
                    (8, 2) => -0.25,
                    _ => 0.0,
                };
                let terms = (0..self.places.len()).filter(inside);
                let terms = terms.map(|other| (weight(other), other));
                out.push((place, terms.filter(|(w, _)| *w != 0.0).collect()));
            }
        }
        out
    }
}
