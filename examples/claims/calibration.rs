//! The families that the constants of `brinell::accuracy` were looked at on.

use super::support::families::{
    Family, HISTORY, SHAPES, TUBE_HISTORY, Truth, named, on_flat, stepped, tube,
};
use brinell::accuracy::Extent;

/// The thick cylinder with all elements, and Hertz's line contact.
pub fn families() -> Vec<Family> {
    let far = "mesh.cylinder_on_half_plane.far_size=20000.0";
    let line = |n: usize| on_flat("cylinder_on_half_plane", n, &[far, HISTORY]);
    let mut out = vec![Family {
        name: "Hertz line, beyond yield and off".to_string(),
        extent: Extent::Program,
        meshes: named(&[4, 6, 8, 12, 16, 24], line),
        truth: Truth::Finer(stepped(line(56), 40)),
    }];
    for shape in SHAPES {
        out.push(Family {
            name: format!("thick cylinder, {shape}"),
            extent: Extent::Program,
            meshes: named(&[4, 6, 8, 12, 16, 24, 32], |n| tube(shape, n, TUBE_HISTORY)),
            truth: Truth::Finer(stepped(tube("quad8", 64, TUBE_HISTORY), 40)),
        });
    }
    out
}
