//! Blocks, bricks, ring sectors and disc sectors, combined into one mesh.

use super::angle::direction;
use super::brick::{Brick, BrickSide};
use super::grid::{BodyBuilder, Side, empty_mesh};
use super::o_grid::{self, disc_grid};
use super::polar::{Sector, is_full_circle, ring_grid};
use super::{grading, limits};
use crate::mesh::{Curve, Mesh, Shape};
use crate::scene::{Block, BrickPart, Disc, Part, Piece, Ring};
use crate::{Error, Result};
use std::collections::BTreeSet;

/// Generates any number of bodies, each a block, a brick, a ring sector or a disc sector, with the
/// surfaces and node sets that [`Part`] documents. The centre of a disc is the node set
/// `BODY.center`. Bodies never share nodes.
///
/// # Errors
/// `Input`, naming the part, the key, the value and what to give instead.
pub fn parts(parts: &[Part]) -> Result<Mesh> {
    if parts.is_empty() {
        return Err(Error::input(
            "mesh.parts is empty; give at least one block, ring or disc",
        ));
    }
    let solid = parts.iter().any(|part| part.brick.is_some());
    let mut names = BTreeSet::new();
    let mut elements = 0.0;
    let mut bricks = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        let context = || format!("mesh.parts: part {} (body `{}`)", index + 1, part.body);
        if part.body.trim().is_empty() {
            return Err(Error::input("body is empty; give the body a name").within(context()));
        }
        if !names.insert(part.body.as_str()) {
            return Err(Error::input(
                "another part has the same body name; each part is a body of its own",
            )
            .within(context()));
        }
        if part.brick.is_some() != solid {
            let mixed =
                "a brick is solid, the other parts are plane; a model has parts of one kind";
            return Err(Error::input(mixed).within(context()));
        }
        let cells = predicted_cells(part).map_err(|e| e.within(context()))?;
        elements += limits::elements(cells, part.element);
        limits::total("elements", elements).map_err(|e| e.within(context()))?;
        if let Some(brick) = &part.brick {
            bricks.push(brick.elements.map(|n| n as f64));
            limits::solids("elements", &bricks, part.element).map_err(|e| e.within(context()))?;
        }
    }
    let mut mesh = empty_mesh();
    if solid {
        mesh.dimension = 3;
        for (part, brick) in parts
            .iter()
            .filter_map(|part| Some((part, part.brick.as_ref()?)))
        {
            make_brick(&mut mesh, part, brick)?;
        }
        return Ok(mesh);
    }
    for (index, part) in parts.iter().enumerate() {
        let mut builder = BodyBuilder::new(&mut mesh, &part.body, part.element);
        let made = match (&part.block, &part.ring, &part.disc) {
            (Some(block), _, _) => make_block(&mut builder, block),
            (_, Some(ring), _) => make_ring(&mut builder, ring),
            (_, _, Some(disc)) => make_disc(&mut builder, disc),
            // A part without a shape has been refused by `predicted_cells`.
            (None, None, None) => Ok(()),
        };
        made.map_err(|e| {
            e.within(format!(
                "mesh.parts: part {} (body `{}`)",
                index + 1,
                part.body
            ))
        })?;
    }
    Ok(mesh)
}

/// Checks a part and counts its cells, before anything is allocated.
fn predicted_cells(part: &Part) -> Result<f64> {
    if let (Some(brick), None, None, None) = (&part.brick, &part.block, &part.ring, &part.disc) {
        for (axis, range) in ["x", "y", "z"].into_iter().zip([brick.x, brick.y, brick.z]) {
            limits::range(&format!("brick.{axis}"), range)?;
        }
        for (axis, bias) in ["x", "y", "z"].into_iter().zip(brick.bias) {
            limits::positive(&format!("brick.bias ({axis})"), bias)?;
        }
        for n in brick.elements {
            limits::at_least("brick.elements", n, 1)?;
        }
        return Ok(brick.elements.iter().map(|n| *n as f64).product());
    }
    match (&part.block, &part.ring, &part.disc) {
        (Some(block), None, None) => {
            limits::range("block.x", block.x)?;
            limits::range("block.y", block.y)?;
            for (axis, bias) in ["x", "y"].iter().zip(block.bias) {
                limits::positive(&format!("block.bias ({axis})"), bias)?;
            }
            cells("block.elements", block.elements)
        }
        (None, Some(ring), None) => {
            limits::finite("ring.center (x)", ring.center[0])?;
            limits::finite("ring.center (y)", ring.center[1])?;
            if ring.radius[0] <= 0.0 {
                return Err(Error::input(format!(
                    "ring.radius = [{}, {}]: the inner radius must be positive; use a disc for \
                     none",
                    ring.radius[0], ring.radius[1]
                )));
            }
            limits::range("ring.radius", ring.radius)?;
            limits::positive("ring.bias", ring.bias)?;
            let span = span("ring.angle", ring.angle)?;
            let least = ((span / 90.0 - 1e-9).ceil() as usize).max(1);
            limits::at_least("ring.elements (along the angle)", ring.elements[1], least)?;
            cells("ring.elements", ring.elements)
        }
        (None, None, Some(disc)) => {
            limits::finite("disc.center (x)", disc.center[0])?;
            limits::finite("disc.center (y)", disc.center[1])?;
            limits::positive("disc.radius", disc.radius)?;
            limits::at_least("disc.elements", disc.elements, 2)?;
            if disc.elements % 2 == 1 {
                return Err(Error::input(format!(
                    "disc.elements = {}: give an even number over a quarter circle",
                    disc.elements
                )));
            }
            Ok(o_grid::n_cells(disc.elements, quarters(disc)?))
        }
        _ => Err(Error::input(
            "give exactly one of block, brick, ring and disc in a part",
        )),
    }
}

fn cells(key: &str, elements: [usize; 2]) -> Result<f64> {
    for n in elements {
        limits::at_least(key, n, 1)?;
    }
    Ok(elements[0] as f64 * elements[1] as f64)
}

/// Checks a range of angles and returns its span in degrees, at most a full circle.
fn span(key: &str, angle: [f64; 2]) -> Result<f64> {
    limits::range(key, angle)?;
    let span = angle[1] - angle[0];
    if angle.iter().any(|a| a.abs() > 720.0) || span > 360.0 + 1e-9 {
        return Err(Error::input(format!(
            "{key} = [{}, {}]: give degrees between -720 and 720, at most 360 apart",
            angle[0], angle[1]
        )));
    }
    Ok(span)
}

/// Number of quarters that a disc covers: 1, 2 or 4.
fn quarters(disc: &Disc) -> Result<usize> {
    let span = span("disc.angle", disc.angle)?;
    [1usize, 2, 4]
        .into_iter()
        .find(|&q| (span - 90.0 * q as f64).abs() <= 1e-9)
        .ok_or_else(|| {
            Error::input(format!(
                "disc.angle = [{}, {}]: the angles must be 90, 180 or 360 degrees apart",
                disc.angle[0], disc.angle[1]
            ))
        })
}

const SIDES: [(&str, Side, [f64; 2]); 4] = [
    ("left", Side::Left, [-1.0, 0.0]),
    ("right", Side::Right, [1.0, 0.0]),
    ("bottom", Side::Bottom, [0.0, -1.0]),
    ("top", Side::Top, [0.0, 1.0]),
];

fn make_brick(mesh: &mut Mesh, part: &Part, brick: &BrickPart) -> Result<()> {
    let [nx, ny, nz] = brick.elements;
    let x = grading::biased("brick.x", brick.x[0], brick.x[1], nx, brick.bias[0])?;
    let y = grading::biased("brick.y", brick.y[0], brick.y[1], ny, brick.bias[1])?;
    let z = grading::biased("brick.z", brick.z[0], brick.z[1], nz, brick.bias[2])?;
    let point = |[i, j, k]: [usize; 3]| [x[i], y[j], z[k]];
    // Quad4, the default for all parts, stands for hex8 in a brick.
    let element = match part.element {
        Shape::Quad4 => Shape::Hex8,
        given => given,
    };
    let body = Brick::add(mesh, &part.body, element, brick.elements, point)
        .map_err(|e| e.within(format!("mesh.parts (body `{}`)", part.body)))?;
    for (name, face) in BrickSide::ALL {
        body.side(mesh, name, face);
    }
    Ok(())
}

fn make_block(builder: &mut BodyBuilder, block: &Block) -> Result<()> {
    let [nx, ny] = block.elements;
    let x = grading::biased("block.x", block.x[0], block.x[1], nx, block.bias[0])?;
    let y = grading::biased("block.y", block.y[0], block.y[1], ny, block.bias[1])?;
    let grid = builder.patch([nx, ny], false, |i, j| [x[i], y[j]], |_, _| None);
    for (name, side, normal) in SIDES {
        builder.surface(name, grid.side(side), Some(Curve::Line { normal }))?;
    }
    for (name, i, j) in [
        ("bottom_left", 0, 0),
        ("bottom_right", 2 * nx, 0),
        ("top_left", 0, 2 * ny),
        ("top_right", 2 * nx, 2 * ny),
    ] {
        builder.node_set(name, grid.node(i, j))?;
    }
    for piece in &block.pieces {
        let key = format!("block.pieces `{}`", piece.name);
        let Some(&(_, side, normal)) = SIDES.iter().find(|(name, ..)| *name == piece.side) else {
            return Err(Error::input(format!(
                "{key}: side = \"{}\" is none of left, right, bottom and top",
                piece.side
            )));
        };
        let along = match side {
            Side::Bottom | Side::Top => &x,
            Side::Left | Side::Right => &y,
        };
        let facets = grid.side_range(side, piece_cells(&key, piece, along)?);
        builder.surface(&piece.name, facets, Some(Curve::Line { normal }))?;
    }
    Ok(())
}

/// The cells of a side both of whose ends lie in the piece, up to the round-off of the positions.
fn piece_cells(key: &str, piece: &Piece, along: &[f64]) -> Result<std::ops::Range<usize>> {
    if piece.name.trim().is_empty() {
        return Err(Error::input(format!("{key}: give the piece a name")));
    }
    limits::range(&format!("{key}: [from, to]"), [piece.from, piece.to])?;
    let n = along.len() / 2;
    let slack = 1e-9 * (along[2 * n] - along[0]);
    let first = (0..n).find(|&i| along[2 * i] >= piece.from - slack);
    let end = (0..n).rev().find(|&i| along[2 * i + 2] <= piece.to + slack);
    match (first, end) {
        (Some(first), Some(end)) if first <= end => Ok(first..end + 1),
        _ => Err(Error::input(format!(
            "{key}: no element of side {} lies between from = {} and to = {}; the side runs from \
             {} to {} in {n} elements: move the ends or use more elements",
            piece.side,
            piece.from,
            piece.to,
            along[0],
            along[2 * n]
        ))),
    }
}

/// The straight sides of a sector, at its start and its end angle.
fn start_and_end(angle: [f64; 2]) -> [Option<Curve>; 2] {
    let [c0, s0] = direction(angle[0]);
    let [c1, s1] = direction(angle[1]);
    [[s0, 0.0 - c0], [0.0 - s1, c1]].map(|normal| Some(Curve::Line { normal }))
}

fn make_ring(builder: &mut BodyBuilder, ring: &Ring) -> Result<()> {
    let [n_radius, n_angle] = ring.elements;
    let [inner, outer] = ring.radius;
    let radii = grading::biased("ring.radius", inner, outer, n_radius, ring.bias)?;
    let sector = Sector {
        center: ring.center,
        start: ring.angle[0],
        span: ring.angle[1] - ring.angle[0],
        n_angle,
    };
    let grid = ring_grid(builder, &sector, &radii);
    let circle = |radius: f64, outward: bool| {
        Some(Curve::Circle {
            center: ring.center,
            radius,
            outward,
        })
    };
    builder.surface("inner", grid.side(Side::Left), circle(inner, false))?;
    builder.surface("outer", grid.side(Side::Right), circle(outer, true))?;
    if !is_full_circle(sector.span) {
        let [start, end] = start_and_end(ring.angle);
        builder.surface("start", grid.side(Side::Bottom), start)?;
        builder.surface("end", grid.side(Side::Top), end)?;
    }
    Ok(())
}

fn make_disc(builder: &mut BodyBuilder, disc: &Disc) -> Result<()> {
    let quarters = quarters(disc)?;
    let sector = Sector {
        center: disc.center,
        start: disc.angle[0],
        span: 90.0 * quarters as f64,
        n_angle: quarters * disc.elements,
    };
    let grid = disc_grid(builder, &sector, quarters, disc.radius)?;
    let circle = Curve::Circle {
        center: disc.center,
        radius: disc.radius,
        outward: true,
    };
    builder.surface("outer", grid.outer, Some(circle))?;
    if quarters < 4 {
        let [start, end] = start_and_end(disc.angle);
        builder.surface("start", grid.start, start)?;
        builder.surface("end", grid.end, end)?;
    }
    builder.node_set("center", grid.center)?;
    Ok(())
}
