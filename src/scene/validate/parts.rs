//! Validation of the parts of a generated mesh.

use super::problems::Problems;
use crate::number::exact;
use crate::scene::{Block, BrickPart, Disc, Part, Ring};
use crate::shape::Shape;
use crate::space::Space;
use std::collections::BTreeSet;

/// Round-off of a difference of angles in degrees.
const OFF: f64 = 1e-9;

pub(super) fn check_part(problems: &mut Problems, key: &str, part: &Part, kind: Space) {
    problems.exactly_one(
        key,
        "shape",
        &[
            ("block", part.block.is_some()),
            ("brick", part.brick.is_some()),
            ("ring", part.ring.is_some()),
            ("disc", part.disc.is_some()),
        ],
    );
    problems.require(
        !part.body.is_empty(),
        format!("{key}.body"),
        "is empty; give the body a name",
    );
    let solid = part.brick.is_some();
    problems.require(
        solid == kind.is_solid(),
        key,
        match solid {
            true => "a brick is a part of a solid model; use kind = \"solid\", or a block",
            false => {
                "blocks, rings and discs are plane parts; a solid model takes bricks, or \
                 mesh.extrude or mesh.revolve"
            }
        },
    );
    // Quad4 is the default, so for a brick it means that no element was given.
    if !(solid && part.element == Shape::Quad4) {
        check_element(problems, &format!("{key}.element"), part.element, kind);
    }
    if let Some(brick) = &part.brick {
        check_brick(problems, &format!("{key}.brick"), brick);
    }
    if let Some(block) = &part.block {
        check_block(problems, &format!("{key}.block"), block, kind);
    }
    if let Some(ring) = &part.ring {
        check_ring(problems, &format!("{key}.ring"), ring);
    }
    if let Some(disc) = &part.disc {
        check_disc(problems, &format!("{key}.disc"), disc);
    }
}

/// Requires elements of the same dimension as the model.
pub(super) fn check_element(problems: &mut Problems, key: &str, element: Shape, kind: Space) {
    problems.require(
        element.dimension() == kind.dimension(),
        key,
        format!(
            "\"{}\" is no element where kind = \"{}\"{}",
            element.name(),
            kind.name(),
            match kind.is_solid() {
                true => "; mesh.extrude and mesh.revolve make solids of plane meshes",
                false => "",
            }
        ),
    );
}

fn check_brick(problems: &mut Problems, key: &str, brick: &BrickPart) {
    let extents = [brick.x, brick.y, brick.z];
    check_extents(problems, key, &extents, &brick.elements, &brick.bias);
}

/// Checks the extents of a part along the axes, with the elements along each and their bias.
fn check_extents(
    problems: &mut Problems,
    key: &str,
    extents: &[[f64; 2]],
    elements: &[usize],
    bias: &[f64],
) {
    for (axis, &extent) in extents.iter().enumerate() {
        problems.pair_must(
            extent[0] < extent[1],
            format!("{key}.{}", ["x", "y", "z"][axis]),
            extent,
            "run from the smaller to the larger coordinate",
        );
        problems.count(format!("{key}.elements.{axis}"), elements[axis], 1);
        problems.positive(format!("{key}.bias.{axis}"), bias[axis]);
    }
}

fn check_block(problems: &mut Problems, key: &str, block: &Block, kind: Space) {
    let extents = [block.x, block.y];
    check_extents(problems, key, &extents, &block.elements, &block.bias);
    problems.require(
        !kind.is_axisymmetric() || block.x[0] >= 0.0,
        format!("{key}.x"),
        format!(
            "{} is left of the axis: in an axisymmetric model x is the radius",
            exact(block.x[0])
        ),
    );
    let sides = ["left", "right", "bottom", "top"];
    let corners = ["bottom_left", "bottom_right", "top_left", "top_right"];
    let mut names = BTreeSet::new();
    for (index, piece) in block.pieces.iter().enumerate() {
        let key = format!("{key}.pieces.{index}");
        problems.require(
            names.insert(&piece.name) && !piece.name.is_empty(),
            format!("{key}.name"),
            format!("\"{}\" is empty or used twice", piece.name),
        );
        problems.require(
            !sides.contains(&piece.name.as_str()) && !corners.contains(&piece.name.as_str()),
            format!("{key}.name"),
            format!(
                "\"{}\" is the name of a side or corner; choose another",
                piece.name
            ),
        );
        problems.require(
            sides.contains(&piece.side.as_str()),
            format!("{key}.side"),
            format!("\"{}\" is none of {}", piece.side, sides.join(", ")),
        );
        problems.require(
            piece.from < piece.to,
            key,
            format!(
                "from = {} must be less than to = {}",
                exact(piece.from),
                exact(piece.to)
            ),
        );
    }
}

fn check_ring(problems: &mut Problems, key: &str, ring: &Ring) {
    let [inner, outer] = ring.radius;
    problems.pair_must(
        inner > 0.0 && inner < outer,
        format!("{key}.radius"),
        ring.radius,
        "be positive and ascending (a disc has no inner radius)",
    );
    let [start, end] = ring.angle;
    problems.pair_must(
        start < end && end - start <= 360.0 + OFF,
        format!("{key}.angle"),
        ring.angle,
        "be ascending and at most 360 degrees apart",
    );
    for index in 0..2 {
        problems.count(format!("{key}.elements.{index}"), ring.elements[index], 1);
    }
    problems.positive(format!("{key}.bias"), ring.bias);
}

fn check_disc(problems: &mut Problems, key: &str, disc: &Disc) {
    problems.positive(format!("{key}.radius"), disc.radius);
    let [start, end] = disc.angle;
    problems.pair_must(
        [90.0, 180.0, 360.0]
            .map(|span| (end - start - span).abs())
            .iter()
            .any(|off| *off <= OFF),
        format!("{key}.angle"),
        disc.angle,
        "be 90, 180 or 360 degrees apart",
    );
    problems.require(
        disc.elements >= 2 && disc.elements.is_multiple_of(2),
        format!("{key}.elements"),
        format!("{} must be an even number, 2 or more", disc.elements),
    );
}
