//! Two bodies of any curvature pressed together: Hertz's model in space.

use super::brick::{Brick, BrickSide};
use super::grading::{self, Growth};
use super::limits;
use crate::analytical::HertzEllipse;
use crate::mesh::Mesh;
use crate::scene::CurvedBodies;
use crate::{Error, Result};

const KEY: &str = "mesh.curved_bodies";
/// Largest ratio of the element length along the larger half axis to the length along the smaller
/// half axis.
const LONGEST: f64 = 4.0;
/// Tolerance on a number of elements, far above its round-off and far below one.
const ROUND_OFF: f64 = 1e-9;

/// Size of the contact of two curved bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipseSize {
    /// Half axes along x and y at first yield.
    pub semi_axes: [f64; 2],
    /// Half axes that the contact may reach, as multiples of those at first yield. Values within
    /// the even part of the mesh have no effect.
    pub reach: f64,
}

/// Generates two bodies that are half spaces except for their curvature near the contact, as
/// Hertz's theory assumes. The first contact is at the origin, and z points from the lower body to
/// the upper.
///
/// Before loading, the upper surface is at the height `z = x^2/(2 R_x) + y^2/(2 R_y)` above the
/// lower surface, which is flat: only the sum of the two bodies' curvatures matters. Beyond the
/// candidates the upper surface levels off. Elements have a uniform size out to `fine_width` half
/// axes, and down to `fine_depth` times the smaller half axis. Their size in depth is the smaller
/// half axis divided by `resolution`; along x and y it is the half axis divided by `resolution`,
/// but at most four times the size in depth. If the contact may reach further, elements grow by
/// `1 + 1/resolution` up to its reach, and from there on by `growth`. Both surfaces have nodes at
/// the same x and y.
///
/// # Errors
/// `Input`, naming the key, its value and what to give instead.
pub fn curved_bodies(p: &CurvedBodies, contact: EllipseSize) -> Result<Mesh> {
    let layout = CurvedLayout::new(p, contact)?;
    let [x, y, depth] = &layout.lines;
    let cells = [x.len() / 2, y.len() / 2, depth.len() / 2];
    let last = depth.len() - 1;
    let mut mesh = Mesh {
        dimension: 3,
        ..Mesh::default()
    };
    let [above, below] = &p.names;
    let upper = Brick::add(&mut mesh, above, p.element, cells, |[i, j, k]| {
        let height = depth[k];
        // The raised shape of the bottom fades out linearly towards the flat top.
        let raised = layout.height(x[i], y[j]) * (1.0 - height / layout.size);
        [x[i], y[j], if k == last { height } else { height + raised }]
    })?;
    let lower = Brick::add(&mut mesh, below, p.element, cells, |[i, j, k]| {
        [x[i], y[j], 0.0 - depth[last - k]]
    })?;
    let inside = &layout.candidates;
    let is_inside = |i: usize, j: usize| inside[0].contains(&i) && inside[1].contains(&j);
    let whole = [0..cells[0], 0..cells[1]];
    for (body, touching, cut, cut_name) in [
        (&upper, BrickSide::Bottom, BrickSide::Top, "top"),
        (&lower, BrickSide::Top, BrickSide::Bottom, "bottom"),
    ] {
        body.surface(&mut mesh, "contact", touching, inside.clone(), |_, _| true);
        let outside = |i, j| !is_inside(i, j);
        body.surface(&mut mesh, "outside", touching, whole.clone(), outside);
        body.side(&mut mesh, cut_name, cut);
        let left = if p.halved()[0] { "symmetry_x" } else { "left" };
        let front = if p.halved()[1] { "symmetry_y" } else { "front" };
        body.side(&mut mesh, left, BrickSide::Left);
        body.side(&mut mesh, "right", BrickSide::Right);
        body.side(&mut mesh, front, BrickSide::Front);
        body.side(&mut mesh, "back", BrickSide::Back);
    }
    // The origin is the corner of the contact surfaces, or their middle in a full model.
    let origin = [layout.origin[0], layout.origin[1]];
    for (name, body, k) in [(above, &upper, 0), (below, &lower, last)] {
        let pole = body.node([origin[0], origin[1], k]);
        mesh.node_sets.insert(format!("{name}.pole"), vec![pole]);
    }
    Ok(mesh)
}

/// Name of a parameter for messages.
fn key(name: &str) -> String {
    format!("{KEY}.{name}")
}

/// Refuses parameters that make no mesh.
fn check_parameters(p: &CurvedBodies, semi_axes: [f64; 2]) -> Result<()> {
    for semi_axis in semi_axes {
        limits::positive(&key("semi_axes"), semi_axis)?;
    }
    limits::positive(&key("fine_width"), p.fine_width)?;
    limits::positive(&key("fine_depth"), p.fine_depth)?;
    limits::positive(&key("far_size"), p.far_size)?;
    limits::growths(&key("growth"), p.growth, &key("growth"), None)?;
    limits::at_least(&key("resolution"), p.resolution, 1)
}

/// Size of the even elements along x, y or the depth (`d` = 0, 1 or 2), their number, and the
/// distance from the first contact to which elements stay small because the contact may reach so
/// far.
fn plan_of_line(p: &CurvedBodies, contact: EllipseSize, d: usize) -> (f64, f64, f64) {
    let EllipseSize { semi_axes, reach } = contact;
    let small = semi_axes[0].min(semi_axes[1]);
    let resolution = p.resolution as f64;
    let fine = small / resolution;
    let (h, even) = match d {
        2 => (fine, p.fine_depth * small),
        _ => {
            let h = (semi_axes[d] / resolution).min(LONGEST * fine);
            (h, p.fine_width * semi_axes[d])
        }
    };
    // The tolerance keeps round-off, and so the choice of units, from deciding whether half an
    // element is rounded up.
    let n = (even / h * (1.0 + ROUND_OFF)).round().max(1.0);
    let until = match d {
        2 => reach * p.fine_depth / p.fine_width * small,
        _ => reach * semi_axes[d],
    };
    (h, n, until)
}

/// A line from 0 on, with its mirror image before it.
fn with_mirror_image(half: &[f64]) -> Vec<f64> {
    let mirrored = half.iter().skip(1).rev().map(|x| -x);
    mirrored.chain(half.iter().copied()).collect()
}

/// Grid lines of both curved bodies.
struct CurvedLayout {
    /// Coordinates along x and y by half steps, and the distance from the contact surface by half
    /// steps.
    lines: [Vec<f64>; 3],
    /// Half steps from the beginning of the line to 0, along x and y.
    origin: [usize; 2],
    /// Ranges of cells that may touch, along x and y.
    candidates: [std::ops::Range<usize>; 2],
    /// Coordinates at which the candidate cells end, along x and y.
    edge: [f64; 2],
    /// Relative radii of curvature along x and y.
    radii: [f64; 2],
    /// Size of each body.
    size: f64,
}

impl CurvedLayout {
    /// Height of the upper surface. It is quadratic out to the last candidate at `c`; beyond, `x^2`
    /// is replaced along each axis by `c^2 + 2 c^2 (1 - exp(-(x - c)/c))`.
    fn height(&self, x: f64, y: f64) -> f64 {
        let along = |d: usize, x: f64| {
            let (x, edge) = (x.abs(), self.edge[d]);
            let at = x.min(edge);
            let square = match x <= edge {
                true => at * at,
                false => edge * edge * (1.0 - 2.0 * (-(x - edge) / edge).exp_m1()),
            };
            square / (2.0 * self.radii[d])
        };
        along(0, x) + along(1, y)
    }

    fn new(p: &CurvedBodies, contact: EllipseSize) -> Result<CurvedLayout> {
        let semi_axes = contact.semi_axes;
        check_parameters(p, semi_axes)?;
        let radii =
            HertzEllipse::relative_radii(p.upper, p.lower).map_err(|error| error.within(KEY))?;
        let large = semi_axes[0].max(semi_axes[1]);
        let size = p.far_size * large;
        let resolution = p.resolution as f64;
        let slow = (1.0 + 1.0 / resolution).min(p.growth);
        let growth = Growth::new(p.growth, None, 0.0);
        // Along x, y and the depth: element size, number of even elements, and reach.
        let plans = [0, 1, 2].map(|d| {
            let (h, n, until) = plan_of_line(p, contact, d);
            (h, n, until.min(0.5 * size))
        });
        // Too many elements are refused before any line is allocated.
        let even: f64 = plans.iter().map(|(_, n, _)| n).product();
        limits::total(&key("resolution"), 2.0 * even)?;
        let near = plans.map(|(h, n, until)| grading::even_then_slow(h, n as usize, until, slow));
        let first = |d: usize| match near[d][..] {
            [.., a, b] => (b - a) * p.growth,
            _ => plans[d].0,
        };
        let end = |d: usize| near[d].last().copied().unwrap_or(0.0);
        let counts = [0, 1, 2].map(|d| {
            let n = (near[d].len() - 1) as f64 + growth.count(first(d), end(d), size);
            if d < 2 && !p.halved()[d] { 2.0 * n } else { n }
        });
        limits::solids(&key("resolution"), &[counts; 2], p.element)?;
        if end(0).max(end(1)) >= size {
            return Err(Error::input(format!(
                "{} = {}: the bodies end within the contact candidates; give more",
                key("far_size"),
                p.far_size
            )));
        }
        let edge = [end(0), end(1)];
        let n_near = [0, 1].map(|d| near[d].len() - 1);
        let mut lines: Vec<Vec<f64>> = Vec::with_capacity(3);
        for (d, corners) in near.iter().enumerate() {
            let name = if d == 2 { "fine_depth" } else { "fine_width" };
            let line = grading::then_grown(&key(name), corners.clone(), first(d), size, growth)?;
            lines.push(line);
        }
        let mut origin = [0; 2];
        let mut candidates = n_near.map(|n| 0..n);
        for d in 0..2 {
            if !p.halved()[d] {
                origin[d] = lines[d].len() - 1;
                lines[d] = with_mirror_image(&lines[d]);
                let middle = origin[d] / 2;
                candidates[d] = middle - n_near[d]..middle + n_near[d];
            }
        }
        let mut lines = lines.into_iter();
        Ok(CurvedLayout {
            lines: std::array::from_fn(|_| lines.next().unwrap_or_default()),
            origin,
            candidates,
            edge,
            radii,
            size,
        })
    }
}
