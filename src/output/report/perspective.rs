//! Solids drawn in perspective: their outer faces, the farthest first (painter's algorithm), with
//! planes of symmetry towards the reader.

use super::camera::{Camera, DISTANCE, Stand, ranks};
use super::contours::{border, joined};
use super::drawing::{Area, Drawing, FINE, failed, stroke, units, write};
use super::outer;
use super::patchwork::{place, ring};
use super::path;
use super::sketch::{BODIES, CONTACT, LOAD};
use super::theme::{INK, hex};
use super::window::Window;
use crate::error::Result;
use crate::mesh::Facet;
use crate::model::{LoadCase, Magnitude, Model};
use crate::scene::Load;
use crate::space::{Vector, along, cross, difference, direction, dot, length};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Width of a drawing in pixels, and its largest height.
const ACROSS: f64 = 500.0;
const DOWN: f64 = 440.0;
/// Room for arrows and axes, in pixels.
const ROOM: f64 = 34.0;
/// Width in pixels of the cubes by which faces are grouped: faces of one colour whose middles lie
/// in one cube are one area.
const CELL: f64 = 64.0;
/// Number of shades of a body.
const SHADES: f64 = 18.0;
/// Cosine of the angle between two faces below which the edge between them is drawn.
const EDGE: f64 = 0.8;
/// Length in pixels below which sides are not drawn.
const SHORTEST_SIDE: f64 = 4.0;
/// Lengths of an arrow and of the axes, in pixels.
const ARROW: f64 = 38.0;
const AXIS: f64 = 24.0;

/// A face that is visible.
struct SeenFace {
    nodes: Vec<usize>,
    body: usize,
    is_contact: bool,
    shade: u8,
    middle: [f64; 2],
    depth: f64,
}

/// Visible faces of one colour that lie close to each other.
struct FaceGroup<'f> {
    body: usize,
    is_contact: bool,
    shade: u8,
    /// Mean distance of the faces from the eye, along the line of sight.
    depth: f64,
    faces: Vec<&'f SeenFace>,
}

/// A perspective view under construction.
pub(super) struct Perspective<'m> {
    model: &'m Model,
    camera: Camera,
    /// Positions of nodes in the drawing, in pixels.
    spots: BTreeMap<usize, [f64; 2]>,
    faces: Vec<SeenFace>,
    /// Rank of each body by height: bodies of the same rank overlap in height.
    ranks: Vec<usize>,
    /// Sides of visible faces that are drawn: those of contact surfaces, and edges.
    contact_sides: BTreeSet<[usize; 2]>,
    edges: BTreeSet<[usize; 2]>,
    /// Distance of the eye from the middle of the part shown.
    distance: f64,
    scale: f64,
    origin: [f64; 2],
    size: [u32; 2],
}

impl<'m> Perspective<'m> {
    /// Makes a view of the elements for whose middle `is_shown` is true; `None` if there are none.
    pub(super) fn new(
        model: &'m Model,
        stand: &Stand,
        is_shown: impl Fn(Vector) -> bool,
    ) -> Option<Self> {
        let mesh = &model.mesh;
        let elements =
            (0..mesh.n_elements()).filter(|&e| is_shown(place(mesh, None, mesh.n_nodes() + e)));
        let facets = outer::facets(mesh, elements);
        let points = facets.iter().flat_map(|&facet| mesh.facet_nodes(facet));
        let nodes: BTreeSet<usize> = points.collect();
        let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let [low, high] = nodes.iter().fold(start, |[low, high], &node| {
            let x = mesh.point(node);
            let less = [0, 1, 2].map(|d| low[d].min(x[d]));
            [less, [0, 1, 2].map(|d| high[d].max(x[d]))]
        });
        let half = 0.5 * length(difference(high, low));
        if nodes.is_empty() || !(half.is_finite() && half > 0.0) {
            return None;
        }
        let center = along(low, 0.5, difference(high, low));
        let camera = Camera::new(center, DISTANCE * half, stand.up, stand.across);
        let at: BTreeMap<usize, [f64; 2]> = nodes
            .into_iter()
            .map(|n| (n, camera.project(mesh.point(n)).0))
            .collect();
        let seen = Window::round(at.values().copied())?;
        let [w, h] = seen.size();
        let scale = ((ACROSS - 2.0 * ROOM) / w).min((DOWN - 2.0 * ROOM) / h);
        let mut out = Perspective {
            model,
            camera,
            spots: BTreeMap::new(),
            faces: Vec::new(),
            ranks: ranks(model, stand.up),
            contact_sides: BTreeSet::new(),
            edges: BTreeSet::new(),
            distance: DISTANCE * half,
            scale,
            origin: [
                0.5 * (ACROSS - scale * w) - scale * seen.low[0],
                ROOM + scale * seen.high[1],
            ],
            size: [ACROSS as u32, (scale * h + 2.0 * ROOM).ceil() as u32],
        };
        out.spots = at
            .into_iter()
            .map(|(node, p)| (node, out.spot(p)))
            .collect();
        out.take(&facets);
        Some(out)
    }

    fn spot(&self, p: [f64; 2]) -> [f64; 2] {
        [
            self.origin[0] + self.scale * p[0],
            self.origin[1] - self.scale * p[1],
        ]
    }

    /// Takes the faces that are turned to the eye, and determines which of their sides are drawn.
    fn take(&mut self, facets: &[Facet]) {
        let mesh = &self.model.mesh;
        let names = self
            .model
            .contacts
            .iter()
            .flat_map(|contact| &contact.names);
        let contact: BTreeSet<Facet> = names
            .filter_map(|name| mesh.surfaces.get(name))
            .flat_map(|surface| surface.facets.iter().copied())
            .collect();
        let light = direction(along(
            along(
                self.camera.axes[2].map(|x| 0.55 * x),
                0.75,
                self.camera.axes[1],
            ),
            -0.35,
            self.camera.axes[0],
        ));
        // For each side the faces that it belongs to: normal, whether visible, whether of a
        // contact.
        let mut sides: BTreeMap<[usize; 2], Vec<(Vector, bool, bool)>> = BTreeMap::new();
        for &facet in facets {
            let nodes: Vec<usize> = ring(mesh, facet).collect();
            let points: Vec<Vector> = nodes.iter().map(|&n| mesh.point(n)).collect();
            let share = 1.0 / points.len() as f64;
            let middle = points.iter().fold([0.0; 3], |sum, x| along(sum, share, *x));
            let next = points.iter().cycle().skip(1);
            let area = points.iter().zip(next).fold([0.0; 3], |sum, (a, b)| {
                along(
                    sum,
                    0.5,
                    cross(difference(*a, middle), difference(*b, middle)),
                )
            });
            let normal = direction(area);
            let is_seen = dot(normal, difference(self.camera.eye, middle)) > 0.0;
            let is_contact = contact.contains(&facet);
            for (k, &a) in nodes.iter().enumerate() {
                let b = nodes[(k + 1) % nodes.len()];
                let side = sides.entry([a.min(b), a.max(b)]).or_default();
                side.push((normal, is_seen, is_contact));
            }
            if is_seen {
                let (at, depth) = self.camera.project(middle);
                self.faces.push(SeenFace {
                    nodes,
                    body: mesh.element_body[facet.element] as usize,
                    is_contact,
                    shade: (dot(normal, light).max(0.0) * SHADES).round() as u8,
                    middle: self.spot(at),
                    depth,
                });
            }
        }
        for (side, faces) in sides
            .into_iter()
            .filter(|(_, faces)| faces.iter().any(|f| f.1))
        {
            let [first, others @ ..] = &faces[..] else {
                continue;
            };
            let differs =
                |other: &(Vector, bool, bool)| other.1 != first.1 || dot(other.0, first.0) < EDGE;
            if others.iter().any(|other| other.2 != first.2) {
                self.contact_sides.insert(side);
            } else if others.is_empty() || others.iter().any(differs) {
                self.edges.insert(side);
            }
        }
    }

    /// Returns the drawing, and the share of the visible area in which the sides of faces are
    /// drawn. These are drawn only if `meshed`, for the faces that are large enough.
    ///
    /// # Errors
    /// `Internal` if it cannot be drawn.
    pub(super) fn draw(&self, names: &[&str], meshed: bool) -> Result<(Drawing, f64)> {
        let (elements, share) = self.painted(meshed);
        let mut drawing = Drawing::new(self.size, |area| {
            for (load, entry) in self.model.loads.iter().zip(&self.model.scene.load) {
                self.arrows(area, load, entry)?;
            }
            self.triad(area, names)
        })?;
        drawing.underlay(&elements);
        Ok((drawing, share))
    }

    /// Groups the faces, the farthest group first.
    fn groups(&self) -> Vec<FaceGroup<'_>> {
        let mut areas: BTreeMap<_, Vec<&SeenFace>> = BTreeMap::new();
        for face in &self.faces {
            let depth = face.depth * self.scale / self.distance;
            let cell = [face.middle[0], face.middle[1], depth];
            let cell = cell.map(|x| (x / CELL).floor() as i64);
            let key = (face.body, face.is_contact, face.shade, cell);
            areas.entry(key).or_default().push(face);
        }
        let mut groups: Vec<FaceGroup> = areas
            .into_iter()
            .map(|((body, is_contact, shade, _), faces)| {
                let sum: f64 = faces.iter().map(|face| face.depth).sum();
                FaceGroup {
                    body,
                    is_contact,
                    shade,
                    depth: sum / faces.len() as f64,
                    faces,
                }
            })
            .collect();
        // The eye is above: a body that lies on another hides it.
        groups.sort_by(|a, b| {
            let [of_a, of_b] = [a, b].map(|group| self.ranks[group.body]);
            of_a.cmp(&of_b).then(b.depth.total_cmp(&a.depth))
        });
        groups
    }

    /// Returns the sides of the faces that are large enough, and adds the areas of these faces and
    /// of all faces to `areas`.
    fn sides_of_large(&self, faces: &[&SeenFace], areas: &mut [f64; 2]) -> Vec<[usize; 2]> {
        let mut large = Vec::new();
        for face in faces {
            let spots = face.nodes.iter().map(|node| self.spots[node]);
            let Some(size) = Window::round(spots).map(|w| w.size()) else {
                continue;
            };
            let area = size[0] * size[1];
            areas[1] += area;
            if area >= SHORTEST_SIDE * SHORTEST_SIDE {
                areas[0] += area;
                let next = face.nodes.iter().cycle().skip(1);
                let sides = face.nodes.iter().copied().zip(next.copied());
                large.extend(sides.map(|(a, b)| [a.min(b), a.max(b)]));
            }
        }
        large
    }

    /// Returns the faces as SVG paths, and the share of the visible area in which their sides are
    /// drawn.
    fn painted(&self, meshed: bool) -> (String, f64) {
        let fine = f64::from(FINE);
        let mut out = format!(
            "<g stroke-width=\"{}\" stroke-linejoin=\"round\">\n",
            1.6 * fine
        );
        let shows = Window {
            low: [0.0; 2],
            high: self.size.map(|x| f64::from(x) * fine),
        };
        let mut areas = [0.0; 2];
        for group in self.groups() {
            let FaceGroup {
                body,
                is_contact,
                shade,
                faces,
                ..
            } = group;
            let sides = || {
                faces.iter().flat_map(|face| {
                    let next = face.nodes.iter().cycle().skip(1);
                    face.nodes.iter().copied().zip(next.copied())
                })
            };
            let place = |node: &usize| self.spots[node].map(|x| x * fine);
            let rings: Vec<Vec<[f64; 2]>> = joined(border(sides()))
                .iter()
                .map(|ring| ring.iter().map(place).collect())
                .collect();
            let color = hex(color(body, is_contact, shade));
            let data = path::area(&rings, shows);
            // Writing to a string does not fail.
            let mut element = |attributes: std::fmt::Arguments, data: &str| {
                let _ = match data.is_empty() {
                    true => Ok(()),
                    false => writeln!(out, "<path {attributes} d=\"{data}\"/>"),
                };
            };
            element(format_args!("fill=\"{color}\" stroke=\"{color}\""), &data);
            let mut lines = |chosen: Vec<[usize; 2]>, color: RGBColor, width: f64| {
                let lines = outer::long_lines(chosen, |node| place(&node));
                let (color, width) = (hex(color), width * fine);
                let attributes =
                    format_args!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"");
                element(attributes, &path::line(&lines, shows));
            };
            let key = |(a, b): (usize, usize)| [a.min(b), a.max(b)];
            if meshed {
                let large = self.sides_of_large(&faces, &mut areas);
                lines(large, shaded(BODIES[body % BODIES.len()], 0.55), 0.5);
            }
            let of = |chosen: &BTreeSet<[usize; 2]>| {
                sides()
                    .map(key)
                    .filter(|side| chosen.contains(side))
                    .collect()
            };
            lines(
                of(&self.edges),
                shaded(BODIES[body % BODIES.len()], 0.4),
                1.0,
            );
            lines(of(&self.contact_sides), CONTACT, 2.5);
        }
        out.push_str("</g>\n");
        let [drawn, all] = areas;
        (out, if all > 0.0 { drawn / all } else { 0.0 })
    }

    /// Draws arrows at some nodes of a load.
    fn arrows(&self, area: &Area, load: &LoadCase, entry: &Load) -> Result<()> {
        let mesh = &self.model.mesh;
        // A pressure has no single direction.
        let nodes = match entry.pressure {
            Some(_) => Vec::new(),
            None => mesh.set_nodes(&entry.on).unwrap_or_default(),
        };
        let shown: Vec<usize> = nodes
            .into_iter()
            .filter(|n| self.spots.contains_key(n))
            .collect();
        let Some(bounds) = Window::round(shown.iter().map(|node| self.spots[node])) else {
            return Ok(());
        };
        let [w, h] = bounds.size();
        let mut at: Vec<usize> = Vec::new();
        // The arrows are at the nodes nearest to the middle and to four places round it.
        for [x, y] in [[0.5, 0.5], [0.25, 0.5], [0.75, 0.5], [0.5, 0.2], [0.5, 0.8]] {
            let target = [bounds.low[0] + x * w, bounds.low[1] + y * h];
            let off = |node: &usize| {
                let p = self.spots[node];
                (p[0] - target[0]).hypot(p[1] - target[1])
            };
            at.extend(
                shown
                    .iter()
                    .copied()
                    .min_by(|a, b| off(a).total_cmp(&off(b))),
            );
        }
        at.sort_unstable();
        at.dedup();
        for node in at {
            let x = mesh.point(node);
            let (foot, depth) = self.camera.project(x);
            let far = self
                .camera
                .project(along(
                    x,
                    -ARROW * depth / self.scale,
                    direction(load.direction),
                ))
                .0;
            let [tip, end] = [foot, far].map(|p| self.spot(p));
            arrow(
                area,
                end,
                tip,
                LOAD,
                load.measures == Magnitude::Displacement,
            )?;
        }
        Ok(())
    }

    /// Draws the directions of the coordinates in a corner.
    fn triad(&self, area: &Area, names: &[&str]) -> Result<()> {
        let origin = [ROOM + 8.0, f64::from(self.size[1]) - ROOM - 2.0];
        for (d, name) in names.iter().enumerate() {
            let way = [self.camera.axes[0][d], -self.camera.axes[1][d]];
            let at = |reach: f64| [0, 1].map(|k| origin[k] + reach * way[k]);
            arrow(area, origin, at(AXIS), INK, true)?;
            write(
                area,
                name,
                at(AXIS + 9.0),
                (HPos::Center, VPos::Center),
                INK,
            )?;
        }
        Ok(())
    }
}

/// Draws an arrow; the head of an open arrow is two strokes.
fn arrow(area: &Area, from: [f64; 2], to: [f64; 2], color: RGBColor, open: bool) -> Result<()> {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = way[0].hypot(way[1]);
    if length < 1.0 {
        return Ok(());
    }
    let [x, y] = way.map(|w| w / length);
    let at = |back: f64, side: f64| {
        (
            units(to[0] - back * x - side * y),
            units(to[1] - back * y + side * x),
        )
    };
    let line = stroke(color, 1.6);
    let shaft = vec![(units(from[0]), units(from[1])), at(1.0, 0.0)];
    area.draw(&PathElement::new(shaft, line)).map_err(failed)?;
    let size = 7.0f64.min(0.5 * length);
    let head = vec![at(size, 0.5 * size), at(0.0, 0.0), at(size, -0.5 * size)];
    match open {
        true => area.draw(&PathElement::new(head, line)),
        false => area.draw(&Polygon::new(head, color.filled())),
    }
    .map_err(failed)
}

/// Returns a body's colour in a shade; contact surfaces are mixed with the colour of contact.
fn color(body: usize, is_contact: bool, shade: u8) -> RGBColor {
    let of_body = BODIES[body % BODIES.len()];
    let base = match is_contact {
        true => RGBColor(
            ((u16::from(of_body.0) + u16::from(CONTACT.0)) / 2) as u8,
            ((u16::from(of_body.1) + u16::from(CONTACT.1)) / 2) as u8,
            ((u16::from(of_body.2) + u16::from(CONTACT.2)) / 2) as u8,
        ),
        false => of_body,
    };
    shaded(base, 0.62 + 0.66 * f64::from(shade) / SHADES)
}

/// Returns a colour made darker for `light` below 1, lighter above.
fn shaded(color: RGBColor, light: f64) -> RGBColor {
    let of = |channel: u8| {
        let value = f64::from(channel);
        let value = match light <= 1.0 {
            true => value * light,
            false => value + (255.0 - value) * (light - 1.0).min(1.0),
        };
        value.round() as u8
    };
    RGBColor(of(color.0), of(color.1), of(color.2))
}
