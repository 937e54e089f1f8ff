//! A cylinder or ball on a half plane or half space (paper, sec. 5.1).

use super::grading::{self, Growth};
use super::grid::{BodyBuilder, Side, empty_mesh};
use super::limits;
use crate::mesh::{Curve, Mesh};
use crate::scene::CylinderOnHalfPlane;
use crate::{Error, Result};

const KEY: &str = "mesh.cylinder_on_half_plane";
/// Largest ratio of the candidates' reach to the radius: further out the circle is nearly vertical.
pub const WIDEST: f64 = 0.9;
/// Default size of each body in half widths b, for a cylinder and a ball. A size W changes the
/// stress under a cylinder by order b/W. Under a ball it changes the stress by order (b/W)^2 and
/// the approach by order b/W.
pub(super) const PLANE_FAR_SIZE: f64 = 20_000.0;
pub(super) const ROUND_FAR_SIZE: f64 = 2_000.0;

/// Size of the contact of a cylinder on a half plane, in the unit of the cylinder's radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSize {
    /// Contact half width (radius for a ball) at first yield.
    pub half_width: f64,
    /// Half width that the contact may reach. Values within the even part of the mesh have no
    /// effect.
    pub reach: f64,
    /// Size of each body, in half widths, if the parameters do not give it.
    pub far_size: f64,
}

impl ContactSize {
    /// A contact of a cylinder that stays within the even part of the mesh.
    pub fn at_yield(half_width: f64) -> Self {
        ContactSize {
            half_width,
            reach: 0.0,
            far_size: PLANE_FAR_SIZE,
        }
    }
}

/// Half model (x >= 0) of a cylinder or ball on a half plane or half space.
///
/// With `b` = `half_width` (contact half width at first yield, in the unit of the radius `R`) and
/// `W = far_size b`, the half plane is the block `[0, W] x [-W, 0]` and the cylinder the block `[0,
/// W]` between its surface and the flat top `y = W`. The surface is the circle `y = R - sqrt(R^2 -
/// x^2)` over the candidates and levels off beyond: as in Hertz's theory, both bodies are half
/// planes, flat but for the cylinder's curve near the contact. A body of finite size W changes the
/// stress under the contact by order b/W (a uniform stress along the surface), a true cylinder by
/// b/R. `far_size` is therefore large, which the growing elements make cheap. Elements are even
/// with size `b/resolution` out to `fine_width b` and down to `fine_depth b` (to the nearest whole
/// element). If the contact may reach further, elements grow by `1 + 1/resolution` from there out
/// to its reach, and downwards in proportion: a contact of any half width has at least `resolution`
/// elements over it. Beyond, they grow by `growth`, rising to `far_growth` at the far end. Both
/// surfaces have nodes at the same `x`. Corner and mid-side nodes of the cylinder lie on the circle
/// to round-off, so nodal gaps are the exact gaps.
///
/// Only the even part of the surfaces, and the part beyond that the contact may reach, are contact
/// candidates (`cylinder.contact`, `half_plane.contact`), which keeps the condensed matrix small.
/// The rest is `cylinder.outside` and `half_plane.outside`. Node sets `cylinder.pole` and
/// `half_plane.pole` are the two nodes at the origin.
///
/// # Errors
/// `Input`, naming the key, its value and what to give instead; among other cases for candidates
/// wider than 0.9 radii.
pub fn cylinder_on_half_plane(p: &CylinderOnHalfPlane, contact: ContactSize) -> Result<Mesh> {
    let layout = CylinderLayout::new(p, contact)?;
    let CylinderLayout {
        n_contact,
        size,
        x,
        depth,
        ..
    } = &layout;
    let cells = [x.len() / 2, depth.len() / 2];
    let last = depth.len() - 1;
    let mut mesh = empty_mesh();
    let line = |normal: [f64; 2]| Some(Curve::Line { normal });

    let mut cylinder = BodyBuilder::new(&mut mesh, &p.names[0], p.element);
    let grid = cylinder.patch(
        cells,
        false,
        |i, j| {
            let height = depth[j];
            if j == last {
                return [x[i], height];
            }
            // The curved shape of the bottom fades out linearly towards the flat top.
            [
                x[i],
                height + layout.bottom(p.radius, x[i]) * (1.0 - height / size),
            ]
        },
        |_, _| None,
    );
    let circle = Some(Curve::Circle {
        center: [0.0, p.radius],
        radius: p.radius,
        outward: true,
    });
    let (inside, outside) = (0..*n_contact, *n_contact..cells[0]);
    cylinder.surface(
        "contact",
        grid.side_range(Side::Bottom, inside.clone()),
        circle,
    )?;
    cylinder.surface(
        "outside",
        grid.side_range(Side::Bottom, outside.clone()),
        None,
    )?;
    cylinder.surface("top", grid.side(Side::Top), line([0.0, 1.0]))?;
    cylinder.surface("symmetry", grid.side(Side::Left), line([-1.0, 0.0]))?;
    cylinder.surface("side", grid.side(Side::Right), line([1.0, 0.0]))?;
    cylinder.node_set("pole", grid.node(0, 0))?;

    let mut half_plane = BodyBuilder::new(&mut mesh, &p.names[1], p.element);
    let grid = half_plane.patch(
        cells,
        false,
        |i, j| [x[i], 0.0 - depth[last - j]],
        |_, _| None,
    );
    let up = line([0.0, 1.0]);
    half_plane.surface("contact", grid.side_range(Side::Top, inside), up)?;
    half_plane.surface("outside", grid.side_range(Side::Top, outside), up)?;
    half_plane.surface("bottom", grid.side(Side::Bottom), line([0.0, -1.0]))?;
    half_plane.surface("symmetry", grid.side(Side::Left), line([-1.0, 0.0]))?;
    half_plane.surface("side", grid.side(Side::Right), line([1.0, 0.0]))?;
    half_plane.node_set("pole", grid.node(0, last))?;
    Ok(mesh)
}

/// Name of a parameter for messages.
fn key(name: &str) -> String {
    format!("{KEY}.{name}")
}

/// Refuses parameters that make no mesh, among them candidates where the circle is steep.
fn check_parameters(p: &CylinderOnHalfPlane, half_width: f64, far_size: f64) -> Result<()> {
    limits::positive(&key("radius"), p.radius)?;
    limits::positive(&key("half_width"), half_width)?;
    limits::positive(&key("fine_width"), p.fine_width)?;
    limits::positive(&key("fine_depth"), p.fine_depth)?;
    limits::positive(&key("far_size"), far_size)?;
    limits::growths(&key("growth"), p.growth, &key("far_growth"), p.far_growth)?;
    limits::at_least(&key("resolution"), p.resolution, 1)?;
    let candidates = p.fine_width * half_width;
    if candidates > WIDEST * p.radius {
        return Err(Error::input(format!(
            "{}: fine_width = {} times half_width = {half_width} is {candidates}, more than \
             {WIDEST} of the radius {}; give a fine_width of at most {:.4}, or check radius \
             and materials (the half width at first yield is about radius times yield stress \
             over modulus)",
            key("fine_width"),
            p.fine_width,
            p.radius,
            WIDEST * p.radius / half_width
        )));
    }
    Ok(())
}

/// Grid lines of the cylinder and of the half plane.
struct CylinderLayout {
    /// Number of elements along x that may touch.
    n_contact: usize,
    /// Size `W` of each body.
    size: f64,
    /// Element ends and midpoints along x, 0 to `W`.
    x: Vec<f64>,
    /// Distances from the contact surface, by half steps from 0 to `W`.
    depth: Vec<f64>,
}

impl CylinderLayout {
    /// Height of the cylinder's surface. Out to the last candidate at `c` it is the circle,
    /// computed without the cancellation in `R - sqrt(R^2 - x^2)`. Beyond, it continues with the
    /// slope at `c` as `y_c + slope c (1 - exp(-(x - c)/c))`.
    fn bottom(&self, radius: f64, x: f64) -> f64 {
        let root = |x: f64| ((radius - x) * (radius + x)).sqrt();
        let edge = self.x[2 * self.n_contact];
        let at = x.min(edge);
        let height = at * at / (radius + root(at));
        if x <= edge {
            height
        } else {
            height - edge * edge / root(edge) * (-(x - edge) / edge).exp_m1()
        }
    }

    fn new(p: &CylinderOnHalfPlane, contact: ContactSize) -> Result<CylinderLayout> {
        let ContactSize {
            half_width,
            reach,
            far_size,
        } = contact;
        let far_size = p.far_size.unwrap_or(far_size);
        check_parameters(p, half_width, far_size)?;
        let size = far_size * half_width;
        let resolution = p.resolution as f64;
        let fine = |name: &str, extent: f64| {
            let n = (extent * resolution).round();
            if n < 1.0 {
                return Err(Error::input(format!(
                    "{} = {extent}: with resolution = {} this is less than one element; \
                     give at least {}",
                    key(name),
                    p.resolution,
                    1.0 / resolution
                )));
            }
            if n + 1.0 > far_size * resolution {
                return Err(Error::input(format!(
                    "{} = {}: give at least {}, one element more than {name} = {extent}",
                    key("far_size"),
                    far_size,
                    (n + 1.0) / resolution
                )));
            }
            Ok(n)
        };
        let n_fine = fine("fine_width", p.fine_width)?;
        let n_deep = fine("fine_depth", p.fine_depth)?;

        let h = half_width / resolution;
        let growth = Growth::new(p.growth, p.far_growth, 0.0);
        // Elements are no finer than needed at the edge of the contact: the ratio of size to
        // distance is the one at first yield.
        let slow = (1.0 + 1.0 / resolution).min(p.growth);
        let reach = reach.min(WIDEST * p.radius).min(0.5 * size);
        let near = |n: f64, until: f64| grading::even_then_slow(h, n as usize, until, slow);
        // Too many elements are refused before any line is made: a wrong input can ask for more
        // than memory holds.
        let even = limits::elements(2.0 * n_fine * n_deep, p.element);
        limits::total(&key("resolution"), even)?;
        let near_x = near(n_fine, reach);
        let near_depth = near(n_deep, reach * p.fine_depth / p.fine_width);
        let first = |corners: &[f64]| match corners {
            [.., a, b] => (b - a) * p.growth,
            _ => h,
        };
        let count = |corners: &[f64]| {
            let start = corners.last().copied().unwrap_or(0.0);
            (corners.len() - 1) as f64 + growth.count(first(corners), start, size)
        };
        let cells = 2.0 * count(&near_x) * count(&near_depth);
        limits::total(&key("resolution"), limits::elements(cells, p.element))?;
        let n_contact = near_x.len() - 1;
        let line = |name: &str, corners: Vec<f64>| {
            let first = first(&corners);
            grading::then_grown(&key(name), corners, first, size, growth)
        };
        Ok(CylinderLayout {
            n_contact,
            size,
            x: line("fine_width", near_x)?,
            depth: line("fine_depth", near_depth)?,
        })
    }
}
