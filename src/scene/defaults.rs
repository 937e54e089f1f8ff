//! Default values of the keys that a scene may leave out.

use crate::shape::Shape;

pub(super) fn fine_width() -> f64 {
    2.0
}

pub(super) fn fine_depth() -> f64 {
    1.5
}

pub(super) fn growth() -> f64 {
    1.15
}

pub(super) fn shape() -> Shape {
    Shape::Quad4
}

pub(super) fn cylinder_names() -> [String; 2] {
    ["cylinder", "half_plane"].map(String::from)
}

pub(super) fn disc_names() -> [String; 2] {
    ["disc", "plate"].map(String::from)
}

pub(super) fn curved_names() -> [String; 2] {
    ["upper", "lower"].map(String::from)
}

pub(super) fn far_radius() -> f64 {
    100.0
}

pub(super) fn disc_growth() -> f64 {
    1.05
}

pub(super) fn no_bias() -> [f64; 2] {
    [1.0, 1.0]
}

pub(super) fn no_solid_bias() -> [f64; 3] {
    [1.0; 3]
}

pub(super) fn solid_fine_width() -> f64 {
    1.25
}

pub(super) fn solid_fine_depth() -> f64 {
    1.0
}

pub(super) fn solid_far_size() -> f64 {
    30.0
}

pub(super) fn solid_growth() -> f64 {
    1.4
}

pub(super) fn solid_shape() -> Shape {
    Shape::Hex8
}

pub(super) fn one() -> f64 {
    1.0
}

pub(super) fn quarter() -> [f64; 2] {
    [0.0, 90.0]
}

pub(super) fn steps() -> usize {
    20
}

pub(super) fn cycles() -> usize {
    1
}

/// A change of plastic strain too small to be seen in a result or resolved by a mesh.
pub(super) fn steady() -> f64 {
    1e-3
}

pub(super) fn path_error() -> f64 {
    1e-3
}

/// An upper bound far above the increments of any known load program: days of computing even for
/// the smallest model.
pub(super) fn max_increments() -> usize {
    1_000_000
}

pub(super) fn gamma() -> f64 {
    1e-8
}

pub(super) fn yes() -> bool {
    true
}

pub(super) fn single() -> usize {
    1
}

pub(super) fn quarter_turn() -> f64 {
    90.0
}
