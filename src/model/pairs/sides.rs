//! Detects surfaces whose faces look away from the other body, because wrong faces were named.
//!
//! Outward normals of surfaces that touch or overlap are opposed to one another. If they agree, and
//! nothing else of the one surface opposes the other there, one of the two faces is on the far side
//! of its element. If both are on the far side, they oppose one another too, and the surfaces seem
//! to overlap by what lies between them. A true overlap lies inside both bodies; this space lies
//! first inside one body, then inside the other.

use super::Pair;
use super::contact_input::ContactInput;
use crate::balls::Balls;
use crate::deck::face_number;
use crate::error::{Error, Result};
use crate::mesh::{Facet, Mesh, Surface};
use crate::number::significant;
use crate::space::{Vector, along, cross, difference, direction, dot, length, unit};
use std::collections::BTreeMap;

/// Cosine of the largest angle between outward normals that count as equal, or of elements' faces
/// that count as opposed.
const AGREE: f64 = 0.5;
/// Fraction of the depth of a slave's element beyond which an overlap is examined: a face on the
/// far side is off by the full depth.
const DEEP: f64 = 0.9;
/// Largest number of faces that are examined, the deepest ones.
const MOST: usize = 8;
/// Distance from either end of an overlap, as a fraction of the overlap, at which a point is tested
/// for being inside the bodies.
const NEAR_ENDS: f64 = 0.125;
/// Fraction of an element's size by which a point may lie outside its faces and still count as
/// inside.
const OUTSIDE: f64 = 1e-3;

/// Facets of a surface, searchable for the facets that a line meets.
struct Looking {
    /// Each facet with its middle, outward unit normal and corners.
    facets: Vec<(Facet, Vector, Vector, Vec<Vector>)>,
    near: Balls,
}

impl Looking {
    fn new(mesh: &Mesh, surface: &Surface) -> Self {
        let of = |&facet: &Facet| {
            let (middle, normal) = outward(mesh, facet);
            let corners = mesh.facet_nodes(facet).take(mesh.facet_corners(facet));
            let corners = corners.map(|node| mesh.point(node)).collect();
            (facet, middle, normal, corners)
        };
        let facets: Vec<_> = surface.facets.iter().map(of).collect();
        let ball = |(_, middle, _, corners): &(Facet, Vector, Vector, Vec<Vector>)| {
            let reach = corners.iter().map(|x| length(difference(*x, *middle)));
            (*middle, reach.fold(0.0, f64::max))
        };
        let near = Balls::new(facets.iter().map(ball).collect());
        Looking { facets, near }
    }

    /// Finds the facets that a line through a point along a unit vector meets: facet, outward
    /// normal, and distance of its middle along the line.
    fn met(&self, x: Vector, line: Vector) -> impl Iterator<Item = (Facet, Vector, f64)> {
        let near = self.near.near(x, line, 0.0).into_iter();
        near.filter_map(move |k| {
            let (facet, middle, normal, corners) = &self.facets[k];
            let off = dot(difference(*middle, x), line);
            is_met(corners, x, line).then_some((*facet, *normal, off))
        })
    }
}

/// Whether a line passes between the corners of a facet.
fn is_met(corners: &[Vector], x: Vector, line: Vector) -> bool {
    let n = corners.len();
    let way = |k: usize| difference(corners[k % n], x);
    // Twice the area between an edge and the line, seen along the line; for an edge in the plane,
    // the sides of the line on which its ends lie.
    let side = |k: usize| match n {
        2 => dot(cross(line, way(k)), unit(2)),
        _ => dot(cross(way(k), way(k + 1)), line),
    };
    let most = (0..n).map(side).fold(f64::NEG_INFINITY, f64::max);
    let least = (0..n).map(side).fold(f64::INFINITY, f64::min);
    match n {
        2 => most >= 0.0 && least <= 0.0,
        _ => most <= 0.0 || least >= 0.0,
    }
}

impl ContactInput<'_> {
    /// Refuses a facet whose outward normal equals that of the opposite facet of the other surface,
    /// unless the line through both meets a facet of either surface that looks at the other
    /// surface, at whatever angle: a whole circle has facets on its far side, too.
    pub(super) fn check_sides(&self) -> Result<()> {
        let looking = self
            .surfaces
            .map(|surface| Looking::new(self.mesh, surface));
        for side in [0, 1] {
            let (own, other) = (&looking[side], &looking[1 - side]);
            for &(facet, middle, normal, _) in &own.facets {
                let across: Vec<_> = other.met(middle, normal).collect();
                if across.iter().any(|(_, n, _)| dot(*n, normal) < 0.0) {
                    continue;
                }
                let alike = across.iter().filter(|(_, n, _)| dot(*n, normal) > AGREE);
                let nearest = alike.min_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
                let Some(&(opposite, n, off)) = nearest else {
                    continue;
                };
                if !own.met(middle, normal).any(|(_, m, _)| dot(m, n) < 0.0) {
                    // A facet looks away from what lies behind it; otherwise the facet ahead looks
                    // away.
                    return Err(match off < 0.0 {
                        true => self.looks_away(facet, side, -off),
                        false => self.looks_away(opposite, 1 - side, off),
                    });
                }
            }
        }
        Ok(())
    }

    fn looks_away(&self, facet: Facet, side: usize, off: f64) -> Error {
        let [own, other] = [self.name(side), self.name(1 - side)];
        Error::input(format!(
            "{} of `{own}` looks away from `{other}`, which lies {} behind it: {}",
            self.facet_name(facet),
            significant(off, 4),
            self.advice(&[facet])
        ))
    }

    /// Refuses surfaces that overlap by more than the depth of their elements if the space between
    /// them is not inside both bodies.
    pub(super) fn check_overlap(&self, slave: usize, pairs: &[Pair]) -> Result<()> {
        let (mesh, slaves) = (self.mesh, self.surfaces[slave]);
        let overlaps: BTreeMap<usize, f64> = (pairs.iter())
            .filter(|pair| pair.gap < 0.0)
            .map(|pair| (pair.slave, -pair.gap))
            .collect();
        if overlaps.is_empty() {
            return Ok(());
        }
        let mut deep: Vec<(f64, Facet)> = (slaves.facets.iter())
            .filter_map(|&facet| {
                let mut nodes = mesh.facet_nodes(facet);
                let least = nodes.try_fold(f64::INFINITY, |least, node| {
                    overlaps.get(&node).map(|overlap| least.min(*overlap))
                })?;
                (least >= DEEP * depth(mesh, facet)).then_some((least, facet))
            })
            .collect();
        deep.sort_by(|a, b| b.0.total_cmp(&a.0));
        deep.truncate(MOST);
        let bodies = [slave, 1 - slave].map(|side| bodies(mesh, self.surfaces[side]));
        let is_real = |&(overlap, facet): &(f64, Facet)| {
            let (center, normal) = outward(mesh, facet);
            let at = |share: f64| along(center, -share * overlap, normal);
            is_inside(mesh, &bodies[1], at(NEAR_ENDS))
                && is_inside(mesh, &bodies[0], at(1.0 - NEAR_ENDS))
        };
        let unreal: Vec<_> = deep.iter().filter(|found| !is_real(found)).collect();
        let Some((overlap, facet)) = unreal.first().filter(|_| 2 * unreal.len() > deep.len())
        else {
            return Ok(());
        };
        let center = outward(mesh, *facet).0;
        let end = along(center, -overlap, outward(mesh, *facet).1);
        let masters = self.surfaces[1 - slave].facets.iter();
        let apart = |other: &&Facet| {
            let way = difference(outward(mesh, **other).0, end);
            dot(way, way)
        };
        let nearest = masters.min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let wrong: Vec<Facet> = [*facet].into_iter().chain(nearest.copied()).collect();
        let named: Vec<String> = (wrong.iter().zip([slave, 1 - slave]))
            .map(|(&facet, side)| format!("{} of `{}`", self.facet_name(facet), self.name(side)))
            .collect();
        Err(Error::input(format!(
            "{} look away from each other: the surfaces would overlap by {}, and what lies between \
             them is not inside both bodies: {}",
            named.join(" and "),
            significant(*overlap, 4),
            self.advice(&wrong)
        )))
    }

    fn name(&self, side: usize) -> &str {
        [&self.contact.first, &self.contact.second][side]
    }

    /// Names a facet: by its number in a deck, otherwise by its nodes.
    fn facet_name(&self, facet: Facet) -> String {
        let element = self.mesh.element_label(facet.element);
        match face_number(self.mesh.shapes[facet.element], facet.local) {
            Some(number) if self.is_of_deck => format!("face S{number} of element {element}"),
            _ => {
                let nodes = self.mesh.facet_nodes(facet);
                let nodes: Vec<usize> = nodes.take(self.mesh.facet_corners(facet)).collect();
                let what = if self.mesh.is_solid() { "face" } else { "edge" };
                let nodes = super::list(self.mesh, &nodes);
                format!("the {what} of element {element} with {nodes}")
            }
        }
    }

    /// Advice to name the facets of the same elements on the other side.
    fn advice(&self, wrong: &[Facet]) -> String {
        let mesh = self.mesh;
        let instead = |&facet: &Facet| {
            let (_, normal) = outward(mesh, facet);
            let count = mesh.shapes[facet.element].n_facets();
            let others = (0..count).map(|local| Facet { local, ..facet });
            let along = others.map(|other| (dot(outward(mesh, other).1, normal), other));
            let other = along.min_by(|a, b| a.0.total_cmp(&b.0))?;
            (other.0 < -AGREE).then(|| self.facet_name(other.1))
        };
        let names: Option<Vec<String>> = wrong.iter().map(instead).collect();
        match names {
            Some(names) => format!("name {} instead", names.join(" and ")),
            None => "name the faces that look at the other body".to_string(),
        }
    }
}

/// Middle of a facet and outward unit normal there.
fn outward(mesh: &Mesh, facet: Facet) -> (Vector, Vector) {
    let points: Vec<Vector> = mesh.facet_nodes(facet).map(|n| mesh.point(n)).collect();
    let reference = mesh.facet_reference(facet);
    let at = (reference.functions)(reference.center());
    let values = at.values.iter().zip(&points);
    let middle = values.fold([0.0; 3], |sum, (value, x)| along(sum, *value, *x));
    (middle, direction(reference.area(&at, &points)))
}

/// Distance by which the element of a facet reaches behind the facet.
fn depth(mesh: &Mesh, facet: Facet) -> f64 {
    let (middle, normal) = outward(mesh, facet);
    let behind = mesh.nodes(facet.element).iter().map(|&node| {
        let way = difference(mesh.point(node as usize), middle);
        -dot(way, normal)
    });
    behind.fold(0.0, f64::max)
}

/// Bodies of the elements of a surface, ascending.
fn bodies(mesh: &Mesh, surface: &Surface) -> Vec<u32> {
    let all = surface.facets.iter().map(|f| mesh.element_body[f.element]);
    let mut all: Vec<u32> = all.collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Whether a point is inside an element of some bodies, that is, behind the planes through the
/// middles of all its facets.
fn is_inside(mesh: &Mesh, bodies: &[u32], x: Vector) -> bool {
    let own = (0..mesh.n_elements()).filter(|&e| bodies.contains(&mesh.element_body[e]));
    let mut holds = own.filter(|&element| {
        let nodes = || (mesh.nodes(element).iter()).map(|&node| mesh.point(node as usize));
        let [low, high] = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
            let start = nodes().next().unwrap_or_default();
            nodes().fold(start, |a, b| std::array::from_fn(|d| pick(a[d], b[d])))
        });
        let size = (0..3).map(|d| high[d] - low[d]).fold(0.0, f64::max);
        let slack = OUTSIDE * size;
        if (0..3).any(|d| x[d] < low[d] - slack || x[d] > high[d] + slack) {
            return false;
        }
        (0..mesh.shapes[element].n_facets()).all(|local| {
            let (middle, normal) = outward(mesh, Facet { element, local });
            dot(difference(x, middle), normal) <= slack
        })
    });
    holds.next().is_some()
}
