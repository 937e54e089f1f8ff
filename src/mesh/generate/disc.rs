//! A disc in the hole of a plate (paper, sec. 5.2).

use super::grading::{self, Growth};
use super::grid::{BodyBuilder, Side, empty_mesh};
use super::limits;
use super::o_grid::{self, disc_grid};
use super::polar::{Sector, ring_grid};
use crate::mesh::{Curve, Mesh};
use crate::scene::DiscInPlate;
use crate::{Error, Result};
use std::f64::consts::FRAC_PI_2;

const KEY: &str = "mesh.disc_in_plate";

/// Quarter model (x, y >= 0) of a disc in the hole of a plate.
///
/// Both contact surfaces lie on radius `R` with nodes at the same, equally spaced angles: in
/// small-strain theory an interference changes the initial gap, not the geometry. The disc is a
/// core of `resolution/2 x resolution/2` elements inside graded layers. The plate is a polar grid
/// whose radial size begins with the arc spacing `pi R/(2 resolution)` and grows by `growth`,
/// rising to `far_growth` at the far radius.
///
/// Bodies, surfaces and units are those of [`DiscInPlate`]. Node sets `disc.pole` and `plate.pole`
/// are the nodes at `(0, R)`, and `disc.center` is the node at the origin. Nodes on symmetry lines
/// lie exactly on them.
///
/// # Errors
/// `Input`, naming the key, its value and what to give instead.
pub fn disc_in_plate(p: &DiscInPlate) -> Result<Mesh> {
    let key = |name: &str| format!("{KEY}.{name}");
    let n = p.resolution;
    limits::positive(&key("radius"), p.radius)?;
    limits::finite(&key("interference"), p.interference)?;
    limits::growths(&key("growth"), p.growth, &key("far_growth"), p.far_growth)?;
    limits::finite(&key("far_radius"), p.far_radius)?;
    if p.far_radius <= 1.0 {
        return Err(Error::input(format!(
            "{}: {} hole radii leave no plate; give more than 1 (20 is usual)",
            key("far_radius"),
            p.far_radius
        )));
    }
    limits::at_least(&key("resolution"), n, 2)?;
    if n % 2 == 1 {
        return Err(Error::input(format!(
            "{} = {n}: give an even number of elements over the quarter circle, such as {}",
            key("resolution"),
            n.saturating_add(1)
        )));
    }

    let width = (p.far_radius - 1.0) * p.radius;
    let spacing = FRAC_PI_2 * p.radius / n as f64;
    let growth = Growth::new(p.growth, p.far_growth, p.radius);
    let layers = growth.count(spacing, 0.0, width);
    let cells = layers * n as f64 + o_grid::n_cells(n, 1);
    limits::total(&key("resolution"), limits::elements(cells, p.element))?;

    let mut mesh = empty_mesh();
    let sector = Sector {
        center: [0.0, 0.0],
        start: 0.0,
        span: 90.0,
        n_angle: n,
    };
    let symmetry_x = Some(Curve::Line {
        normal: [-1.0, 0.0],
    });
    let symmetry_y = Some(Curve::Line {
        normal: [0.0, -1.0],
    });
    let circle = |radius: f64, outward: bool| {
        Some(Curve::Circle {
            center: [0.0, 0.0],
            radius,
            outward,
        })
    };

    let mut disc = BodyBuilder::new(&mut mesh, &p.names[0], p.element);
    let grid = disc_grid(&mut disc, &sector, 1, p.radius)?;
    disc.surface("contact", grid.outer, circle(p.radius, true))?;
    disc.surface("symmetry_y", grid.start, symmetry_y)?;
    disc.surface("symmetry_x", grid.end, symmetry_x)?;
    disc.node_set("center", grid.center)?;
    disc.node_set("pole", grid.pole)?;

    let far = p.far_radius * p.radius;
    let mut radii = grading::even_then_grown(&key("far_radius"), spacing, 0, width, growth)?;
    for r in &mut radii {
        *r += p.radius;
    }
    let last = radii.len() - 1;
    radii[last] = far;
    let mut plate = BodyBuilder::new(&mut mesh, &p.names[1], p.element);
    let grid = ring_grid(&mut plate, &sector, &radii);
    plate.surface("contact", grid.side(Side::Left), circle(p.radius, false))?;
    plate.surface("far", grid.side(Side::Right), circle(far, true))?;
    plate.surface("symmetry_y", grid.side(Side::Bottom), symmetry_y)?;
    plate.surface("symmetry_x", grid.side(Side::Top), symmetry_x)?;
    plate.node_set("pole", grid.node(0, 2 * n))?;
    Ok(mesh)
}
