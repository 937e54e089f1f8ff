//! The element types of a deck.

use super::keyword::plain;
use crate::shape::{Integration, Shape};
use crate::space::Space;

/// The element that brinell uses for an element type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ElementType {
    pub(super) shape: Shape,
    pub(super) space: Space,
    /// Integration of the type; reduced for shapes that have only one rule.
    pub(super) integration: Integration,
    /// Difference between the type's formulation and the one with which it is computed.
    pub(super) note: Option<&'static str>,
}

/// Differences between the formulation of a type and of the element used for it.
const REDUCED: &str = "the type has one point with hourglass control, brinell full integration \
                       with mean dilatation (B-bar)";
const MODES: &str = "the type has incompatible modes, brinell mean dilatation (B-bar) instead";
const HYBRID: &str =
    "the type has pressure unknowns, brinell none: mean dilatation, or the same points";
const PORE: &str = "the type has pore pressures, brinell none";
const MODIFIED: &str = "the type is modified, brinell takes the plain quadratic element";

/// Families of plane elements, by the beginning of their names.
const PLANE: [(&str, Space); 3] = [
    ("CPE", Space::PlaneStrain),
    ("CPS", Space::PlaneStress),
    ("CAX", Space::Axisymmetric),
];

impl ElementType {
    /// The plain name of a type, without letters for its formulation.
    pub(super) fn name(&self) -> String {
        let family = PLANE.iter().find(|(_, space)| *space == self.space);
        let start = family.map_or("C3D", |(start, _)| start);
        format!("{start}{}", self.shape.n_nodes())
    }

    /// The type of the given name, or the reason why it cannot be used.
    ///
    /// # Errors
    /// The reason in words, with the types that can be used.
    pub(super) fn from_name(name: &str) -> Result<ElementType, String> {
        let name = plain(name);
        let plane = PLANE.iter().find_map(|(start, space)| {
            let (shape, note) = in_plane(name.strip_prefix(start)?)?;
            Some((shape, *space, note))
        });
        let solid = name.strip_prefix("C3D").and_then(in_space);
        let solid = solid.map(|(shape, note)| (shape, Space::Solid, note));
        let (shape, space, note) = plane.or(solid).ok_or_else(|| {
            let is_point = [
                "SPRING", "DASHPOT", "MASS", "GAP", "DCOUP", "CONN", "ROTARY",
            ];
            let why = match name.as_bytes() {
                _ if is_point.iter().any(|start| name.starts_with(start)) => {
                    "springs, dashpots, masses, gaps and connectors are not"
                }
                [b'S', ..] | [b'M', b'3', ..] => "shells and membranes are not",
                [b'B', ..] | [b'T', ..] => "beams and trusses are not",
                [b'R', b'3', ..] | [b'R', b'2', ..] | [b'R', b'A', ..] => "rigid elements are not",
                _ => "it is not",
            };
            format!(
                "TYPE={name}: {why} among the elements of brinell, which are CPE, CPS and CAX with \
                 3, 4, 6 and 8 nodes and C3D4, C3D6, C3D8, C3D10, C3D15, C3D20"
            )
        })?;
        let is_reduced = name.ends_with('R') || name.ends_with("RH");
        let integration = match has_two_rules(shape) && !is_reduced {
            true => Integration::Full,
            false => Integration::Reduced,
        };
        Ok(ElementType {
            shape,
            space,
            integration,
            note,
        })
    }
}

/// Whether full and reduced integration differ for the shape.
pub(super) fn has_two_rules(shape: Shape) -> bool {
    shape.n_points(Integration::Full) > shape.n_points(Integration::Reduced)
}

type TypeFound = Option<(Shape, Option<&'static str>)>;

fn in_plane(rest: &str) -> TypeFound {
    Some(match rest {
        "3" => (Shape::Tri3, None),
        "3H" => (Shape::Tri3, Some(HYBRID)),
        "4" => (Shape::Quad4, None),
        "4R" | "4RH" => (Shape::Quad4, Some(REDUCED)),
        "4I" | "4IH" => (Shape::Quad4, Some(MODES)),
        "4H" => (Shape::Quad4, Some(HYBRID)),
        "4P" => (Shape::Quad4, Some(PORE)),
        "6" => (Shape::Tri6, None),
        "6H" => (Shape::Tri6, Some(HYBRID)),
        "6M" | "6MH" => (Shape::Tri6, Some(MODIFIED)),
        "8" => (Shape::Quad8, None),
        "8R" => (Shape::Quad8, None),
        "8H" | "8RH" => (Shape::Quad8, Some(HYBRID)),
        _ => return None,
    })
}

fn in_space(rest: &str) -> TypeFound {
    Some(match rest {
        "4" => (Shape::Tet4, None),
        "4H" => (Shape::Tet4, Some(HYBRID)),
        "6" => (Shape::Prism6, None),
        "6H" => (Shape::Prism6, Some(HYBRID)),
        "8" => (Shape::Hex8, None),
        "8R" | "8RH" => (Shape::Hex8, Some(REDUCED)),
        "8I" | "8IH" => (Shape::Hex8, Some(MODES)),
        "8H" => (Shape::Hex8, Some(HYBRID)),
        "10" => (Shape::Tet10, None),
        "10T" | "10M" | "10MH" | "10I" => (Shape::Tet10, Some(MODIFIED)),
        "10H" => (Shape::Tet10, Some(HYBRID)),
        "15" => (Shape::Prism15, None),
        "15H" => (Shape::Prism15, Some(HYBRID)),
        "20" => (Shape::Hex20, None),
        "20R" => (Shape::Hex20, None),
        "20H" | "20RH" => (Shape::Hex20, Some(HYBRID)),
        _ => return None,
    })
}

/// Corners of the faces of each shape, in the order of face numbers in a deck.
fn faces(shape: Shape) -> &'static [&'static [usize]] {
    match shape {
        Shape::Tet4 | Shape::Tet10 => &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]],
        Shape::Hex8 | Shape::Hex20 => &[
            &[0, 1, 2, 3],
            &[4, 7, 6, 5],
            &[0, 4, 5, 1],
            &[1, 5, 6, 2],
            &[2, 6, 7, 3],
            &[3, 7, 4, 0],
        ],
        Shape::Prism6 | Shape::Prism15 => &[
            &[0, 1, 2],
            &[3, 5, 4],
            &[0, 3, 4, 1],
            &[1, 4, 5, 2],
            &[2, 5, 3, 0],
        ],
        Shape::Tri3 | Shape::Tri6 => &[&[0, 1], &[1, 2], &[2, 0]],
        Shape::Quad4 | Shape::Quad8 => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
    }
}

/// The local facet of a face number of the deck, counted from 1; `None` if there is no such face.
pub(super) fn facet(shape: Shape, number: usize) -> Option<usize> {
    let corners = faces(shape).get(number.checked_sub(1)?)?;
    (0..shape.n_facets()).find(|&local| {
        let n = shape.facet_reference(local).n_corners;
        let own = &shape.facet(local)[..n];
        n == corners.len() && own.iter().all(|corner| corners.contains(corner))
    })
}

/// The number in a deck, counted from 1, of a local facet.
pub(crate) fn face_number(shape: Shape, local: usize) -> Option<usize> {
    (1..=shape.n_facets()).find(|&number| facet(shape, number) == Some(local))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_is_a_facet_and_no_facet_is_two_faces() {
        for shape in Shape::ALL {
            let mut found: Vec<usize> = (1..=shape.n_facets())
                .map(|number| facet(shape, number).unwrap())
                .collect();
            found.sort_unstable();
            found.dedup();
            assert_eq!(found.len(), shape.n_facets(), "{shape:?}");
            assert_eq!(facet(shape, shape.n_facets() + 1), None);
            assert_eq!(facet(shape, 0), None);
        }
    }
}
