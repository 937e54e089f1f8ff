//! Drawings of a plane scene: bodies, supports, loads, contact, and the mesh.

use super::contours::joined;
use super::drawing::{Area, Drawing, failed, stroke, units};
use super::outer;
use super::patchwork::{ring, seen};
use super::picture::Picture;
use super::theme::{CURVES, INK};
use super::window::Window;
use crate::error::Result;
use crate::mesh::Facet;
use crate::mesh::surface::{normals, ordered_nodes};
use crate::model::{Magnitude, Model};
use crate::output::Labels;
use crate::scene::{Field, Support};
use crate::space::{Vector, unit};
use plotters::prelude::*;

/// Colours of the bodies, in turn.
pub(super) const BODIES: [RGBColor; 6] = [
    RGBColor(0x5b, 0x8d, 0xbf),
    RGBColor(0x8f, 0xa8, 0x6b),
    RGBColor(0xb9, 0x8a, 0x62),
    RGBColor(0x8d, 0x7f, 0xb5),
    RGBColor(0x5f, 0xa8, 0xa3),
    RGBColor(0xb0, 0x7a, 0x96),
];
/// Opacity of the bodies.
const FILL: f64 = 0.5;
/// Colours of contact, supports and loads.
pub(super) const CONTACT: RGBColor = CURVES[1];
pub(super) const SUPPORT: RGBColor = CURVES[2];
pub(super) const LOAD: RGBColor = CURVES[4];
/// Largest number of signs along a set.
const MOST_SIGNS: usize = 7;
/// Sizes of signs in pixels.
const TRIANGLE: f64 = 10.0;
const ARROW: f64 = 26.0;
const HEAD: f64 = 7.0;

/// Width of an element in pixels (the root of its area) from which on its sides are drawn.
const SMALLEST_SIDE: f64 = 4.0;
/// Colour of the sides of elements.
const SIDE: RGBColor = RGBColor(0x6a, 0x74, 0x80);

/// Draws the part of the scene in a window, undeformed; with `mesh` also the sides of the elements
/// that are large enough to be visible. Also returns the share of the visible area that these
/// elements cover.
///
/// # Errors
/// `Internal` if it cannot be drawn.
pub(super) fn draw(
    model: &Model,
    labels: &Labels,
    window: Window,
    mesh: bool,
) -> Result<(Drawing, f64)> {
    let mut picture = Picture::large(window);
    let mut sides: Vec<Vec<(usize, usize)>> = vec![Vec::new(); model.mesh.bodies.len()];
    for facet in outer::facets(&model.mesh, 0..model.mesh.n_elements()) {
        let nodes: Vec<usize> = ring(&model.mesh, facet).collect();
        let body = model.mesh.element_body[facet.element] as usize;
        sides[body].extend(nodes.windows(2).map(|ends| (ends[0], ends[1])));
    }
    let mut outlines = Vec::new();
    for (body, sides) in sides.into_iter().enumerate() {
        let place = |ring: Vec<usize>| ring.into_iter().map(|n| model.mesh.in_plane(n)).collect();
        let rings: Vec<Vec<[f64; 2]>> = joined(sides).into_iter().map(place).collect();
        picture.fill(&rings, BODIES[body % BODIES.len()], FILL);
        outlines.extend(rings);
    }
    let (lines, meshed) = match mesh {
        true => sides_seen(model, &picture, window),
        false => (Vec::new(), 0.0),
    };
    picture.stroke(&lines, SIDE, 0.5);
    picture.outline(outlines, INK, 0.9);
    let signs = Signs::new(model, &picture, window);
    let axes = labels.axes(model.kind);
    let drawing = picture.finish([&axes[0], &axes[1]], None, |area| signs.draw(area))?;
    Ok((drawing, meshed))
}

/// Returns the sides of elements that are large enough to be more than a grey area, and the share
/// of the visible area that these elements cover.
fn sides_seen(model: &Model, picture: &Picture, window: Window) -> (Vec<Vec<[f64; 2]>>, f64) {
    let mesh = &model.mesh;
    let pixel = {
        let [a, b] = [window.low, window.high].map(|p| picture.place_of(p));
        window.size()[0] / (b[0] - a[0])
    };
    let (mut drawn, mut all) = (0.0, 0.0);
    let mut sides = Vec::new();
    for element in seen(mesh, [unit(0), unit(1)], window, [false; 2], &[]) {
        let nodes = mesh.nodes(element).iter();
        let Some(bounds) = Window::round(nodes.map(|&n| mesh.in_plane(n as usize))) else {
            continue;
        };
        let area: f64 = (0..2)
            .map(|d| bounds.high[d].min(window.high[d]) - bounds.low[d].max(window.low[d]))
            .map(|extent| extent.max(0.0))
            .product();
        all += area;
        let [w, h] = bounds.size();
        if w * h < (SMALLEST_SIDE * pixel).powi(2) {
            continue;
        }
        drawn += area;
        for local in 0..mesh.shapes[element].n_facets() {
            let nodes: Vec<usize> = ring(mesh, Facet { element, local }).collect();
            sides.extend(nodes.windows(2).map(|ends| [ends[0], ends[1]]));
        }
    }
    let lines = outer::long_lines(sides, |node| mesh.in_plane(node));
    (lines, if all > 0.0 { drawn / all } else { 0.0 })
}

/// The signs that are drawn on the bodies.
struct Signs<'a> {
    model: &'a Model,
    picture: &'a Picture,
    window: Window,
    /// Body of each node, and the middle of each body.
    body: Vec<u32>,
    middles: Vec<[f64; 2]>,
}

impl<'a> Signs<'a> {
    fn new(model: &'a Model, picture: &'a Picture, window: Window) -> Self {
        let mesh = &model.mesh;
        let mut body = vec![0; mesh.n_nodes()];
        let mut boxes = vec![[[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]]; mesh.bodies.len()];
        for element in 0..mesh.n_elements() {
            let owner = mesh.element_body[element];
            for &node in mesh.nodes(element) {
                body[node as usize] = owner;
                let p = mesh.in_plane(node as usize);
                let [low, high] = &mut boxes[owner as usize];
                for k in 0..2 {
                    low[k] = low[k].min(p[k]);
                    high[k] = high[k].max(p[k]);
                }
            }
        }
        let middles = boxes
            .iter()
            .map(|[low, high]| [0, 1].map(|k| 0.5 * (low[k] + high[k])))
            .collect();
        Signs {
            model,
            picture,
            window,
            body,
            middles,
        }
    }

    fn draw(&self, area: &Area) -> Result<()> {
        for contact in &self.model.contacts {
            for name in &contact.names {
                self.line(area, name)?;
            }
        }
        for support in &self.model.scene.support {
            self.support(area, support)?;
        }
        for (load, entry) in self.model.loads.iter().zip(&self.model.scene.load) {
            let (on, pressure) = (&entry.on, entry.pressure.as_ref());
            let nodes = self.spread(on);
            let pulled = nodes
                .iter()
                .filter(|&&node| self.is_outward(node, in_plane(load.direction)))
                .count();
            // Arrows of one direction lie on one side, even if the surface runs along them.
            let outward = 2 * pulled > nodes.len();
            for node in nodes {
                let direction = match (pressure, self.model.mesh.surfaces.get(on)) {
                    (Some(p), Some(surface)) => normals(&self.model.mesh, surface, &[node])
                        .first()
                        .map_or(in_plane(load.direction), |n| {
                            let inward = -self.sign(p, node);
                            [inward * n[0], inward * n[1]]
                        }),
                    _ => in_plane(load.direction),
                };
                let outward = match pressure {
                    Some(_) => self.is_outward(node, direction),
                    None => outward,
                };
                self.arrow(area, node, direction, outward, load.measures)?;
            }
        }
        Ok(())
    }

    /// Returns 1 if a pressure acts into the body, -1 if it pulls; a pressure given by values at
    /// nodes counts as pressing.
    fn sign(&self, pressure: &Field, node: usize) -> f64 {
        let at = pressure.function(self.model.kind);
        let value = at.map_or(1.0, |at| at(self.model.mesh.point(node)));
        if value < 0.0 { -1.0 } else { 1.0 }
    }

    fn is_shown(&self, node: usize) -> bool {
        self.window.sees(&[self.model.mesh.in_plane(node)])
    }

    /// Returns the nodes of a set in order, if they have an order.
    fn nodes(&self, name: &str) -> Vec<usize> {
        let mesh = &self.model.mesh;
        mesh.surfaces
            .get(name)
            .and_then(|surface| ordered_nodes(mesh, surface).ok())
            .or_else(|| mesh.set_nodes(name))
            .unwrap_or_default()
    }

    /// Returns some of the visible nodes of a set, evenly spaced along it.
    fn spread(&self, name: &str) -> Vec<usize> {
        let mut nodes = self.nodes(name);
        nodes.retain(|&node| self.is_shown(node));
        let (Some(&first), Some(&last)) = (nodes.first(), nodes.last()) else {
            return Vec::new();
        };
        let mesh = &self.model.mesh;
        let mut arc = 0.0;
        let mut arcs = vec![0.0];
        for pair in nodes.windows(2) {
            let (p, q) = (mesh.in_plane(pair[0]), mesh.in_plane(pair[1]));
            arc += (q[0] - p[0]).hypot(q[1] - p[1]);
            arcs.push(arc);
        }
        let shown = |node: usize| self.picture.place_of(mesh.in_plane(node));
        let (a, b) = (shown(first), shown(last));
        // Signs need room: there is one for about every forty pixels.
        let [left, right] =
            [self.window.low, self.window.high].map(|p| self.picture.place_of(p)[0]);
        let pixels = arc / self.window.size()[0] * (right - left);
        let pixels = pixels.max((b[0] - a[0]).hypot(b[1] - a[1]));
        let count = ((pixels / 40.0) as usize + 1)
            .min(MOST_SIGNS)
            .min(nodes.len());
        let mut out: Vec<usize> = (0..count)
            .map(|i| {
                let share = match count {
                    1 => 0.5,
                    _ => i as f64 / (count - 1) as f64,
                };
                let place = arcs.partition_point(|s| *s < share * arc);
                nodes[place.min(nodes.len() - 1)]
            })
            .collect();
        out.dedup();
        out
    }

    /// Draws a contact surface.
    fn line(&self, area: &Area, name: &str) -> Result<()> {
        let nodes = self.nodes(name);
        let mut piece: Vec<(i32, i32)> = Vec::new();
        let mut pieces = Vec::new();
        for node in nodes {
            if self.is_shown(node) {
                let [x, y] = self.picture.place_of(self.model.mesh.in_plane(node));
                let at = (units(x), units(y));
                // A point for every two pixels is enough.
                let far = piece
                    .last()
                    .is_none_or(|p| (p.0 - at.0).abs() + (p.1 - at.1).abs() > units(2.0));
                if far {
                    piece.push(at);
                }
            } else if !piece.is_empty() {
                pieces.push(std::mem::take(&mut piece));
            }
        }
        pieces.push(piece);
        for piece in pieces.into_iter().filter(|piece| piece.len() > 1) {
            area.draw(&PathElement::new(piece, stroke(CONTACT, 3.0)))
                .map_err(failed)?;
        }
        Ok(())
    }

    /// Whether a direction at a node points out of its body.
    fn is_outward(&self, node: usize, direction: [f64; 2]) -> bool {
        let p = self.model.mesh.in_plane(node);
        let middle = self.middles[self.body[node] as usize];
        (p[0] - middle[0]) * direction[0] + (p[1] - middle[1]) * direction[1] > 0.0
    }

    /// Draws triangles with their tips at the held nodes, filled if both directions are held.
    fn support(&self, area: &Area, support: &Support) -> Result<()> {
        let directions = support.directions();
        for node in self.spread(&support.on) {
            for &direction in &directions {
                let mut d = in_plane(direction);
                if !self.is_outward(node, d) {
                    d = [-d[0], -d[1]];
                }
                let tip = self.picture.place_of(self.model.mesh.in_plane(node));
                // The downward direction in a drawing is -y.
                let at = |along: f64, across: f64| {
                    (
                        units(tip[0] + along * d[0] - across * d[1]),
                        units(tip[1] - along * d[1] - across * d[0]),
                    )
                };
                let corners = vec![at(0.0, 0.0), at(TRIANGLE, -5.5), at(TRIANGLE, 5.5)];
                let line = stroke(SUPPORT, 1.5);
                if directions.len() > 1 {
                    area.draw(&Polygon::new(corners, SUPPORT.filled()))
                        .map_err(failed)?;
                } else {
                    let closed = [&corners[..], &corners[..1]].concat();
                    area.draw(&PathElement::new(closed, line)).map_err(failed)?;
                    let ground = vec![at(TRIANGLE + 3.0, -7.0), at(TRIANGLE + 3.0, 7.0)];
                    area.draw(&PathElement::new(ground, line)).map_err(failed)?;
                }
            }
        }
        Ok(())
    }

    /// Draws an arrow with its tip or end at a node, on the outer side. The arrow of a prescribed
    /// displacement has an open head.
    fn arrow(
        &self,
        area: &Area,
        node: usize,
        d: [f64; 2],
        outward: bool,
        measures: Magnitude,
    ) -> Result<()> {
        if d == [0.0; 2] {
            return Ok(());
        }
        let foot = self.picture.place_of(self.model.mesh.in_plane(node));
        let (from, to) = if outward {
            (2.0, ARROW + 2.0)
        } else {
            (-ARROW - 2.0, -2.0)
        };
        let at = |along: f64, across: f64| {
            (
                units(foot[0] + along * d[0] - across * d[1]),
                units(foot[1] - along * d[1] - across * d[0]),
            )
        };
        let line = stroke(LOAD, 1.75);
        area.draw(&PathElement::new(
            vec![at(from, 0.0), at(to - 2.0, 0.0)],
            line,
        ))
        .map_err(failed)?;
        let head = vec![at(to - HEAD, -4.0), at(to, 0.0), at(to - HEAD, 4.0)];
        if measures == Magnitude::Displacement {
            area.draw(&PathElement::new(head, line)).map_err(failed)
        } else {
            area.draw(&Polygon::new(head, LOAD.filled()))
                .map_err(failed)
        }
    }
}

/// Returns the first two components of a vector.
fn in_plane([x, y, _]: Vector) -> [f64; 2] {
    [x, y]
}
