//! Scenes whose first yield is far smaller than their elements: written when meshes were first
//! refined around such contacts, and run once.

use super::support;
use super::support::families::{Family, Truth, from_file, named, stepped};
use brinell::accuracy::Extent;
use brinell::scene::{LocalRefinement, Scene};
use std::path::Path;

/// All of them; meshes from files go into `folder`.
pub fn families(folder: &Path) -> Vec<Family> {
    let filed = |n: usize| {
        let folder = folder.join(format!("pad-{n}"));
        from_file(pad(n), &folder, &[("pad.outer", [0.0, 3.0], 3.0)])
    };
    vec![
        near_contact(
            "rigid roller on a soft block, tri6",
            &[12, 16, 20],
            &roller,
            64,
        ),
        near_contact(
            "two rollers of different radius, quad8",
            &[12, 16, 20],
            &rollers,
            40,
        ),
        near_contact(
            "rounded cone on a soft block, quad4",
            &[16, 24, 32],
            &cone,
            96,
        ),
        near_contact(
            "round pad on a block from a file, quad8",
            &[12, 16, 20],
            &filed,
            40,
        ),
    ]
}

/// A family whose contact is at the origin; its truth has elements 64 times smaller there, and up
/// to 256 times where bodies touch.
fn near_contact(
    name: &str,
    counts: &[usize],
    scene: &dyn Fn(usize) -> Scene,
    finest: usize,
) -> Family {
    let truth = refined(scene(finest), [0.0; 2], 0.15, 6);
    let truth = refined(truth, [0.0; 2], 0.06, 7);
    let truth = refined(truth, [0.0; 2], 0.03, 8);
    Family {
        name: name.to_string(),
        extent: Extent::Program,
        meshes: named(counts, scene),
        truth: Truth::Finer(stepped(truth, 20)),
    }
}

/// The scene with elements `2^-times` times as large around a point.
pub fn refined(mut scene: Scene, at: [f64; 2], radius: f64, times: usize) -> Scene {
    let refinement = LocalRefinement { at, radius, times };
    scene.mesh.refine.push(refinement);
    scene
}

/// A block under a rigid surface that a force presses.
fn under(kind: &str, element: &str, n: usize, rigid: &str) -> Scene {
    let symmetry = if kind == "axisymmetric" { 1 } else { 2 };
    support::parse(&format!(
        r#"
title = "soft block under a rigid surface"
kind = "{kind}"
symmetry = {symmetry}
[[mesh.parts]]
body = "block"
element = "{element}"
block = {{ x = [0.0, 6.0], y = [-6.0, 0.0], elements = [{n}, {n}] }}
[materials.soft]
youngs_modulus = 100e3
poissons_ratio = 0.3
yield_stress = 90.0
tangent_modulus = 1000.0
[bodies.block]
material = "soft"
[rigid.tool]
{rigid}
[[contact]]
first = "tool"
second = "block.top"
[[load]]
on = "tool"
force = [0.0, -1.0]
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 3.0 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

fn roller(n: usize) -> Scene {
    let rigid = "sphere = { center = [0.0, 8.0], radius = 8.0 }";
    under("plane_strain", "tri6", n, rigid)
}

fn cone(n: usize) -> Scene {
    let rigid = "cone = { tip = [0.0, 0.0], axis = [0.0, 1.0], half_angle = 80.0, rounding = 5.0 }";
    under("axisymmetric", "quad4", n, rigid)
}

/// Two quarters of rollers of one steel, pressed on each other along a line.
fn rollers(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "two rollers"
kind = "plane_strain"
symmetry = 2
[[mesh.parts]]
body = "upper"
element = "quad8"
disc = {{ center = [0.0, 6.0], radius = 6.0, angle = [-90.0, 0.0], elements = {n} }}
[[mesh.parts]]
body = "lower"
element = "quad8"
disc = {{ center = [0.0, -4.0], radius = 4.0, angle = [0.0, 90.0], elements = {n} }}
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
yield_stress = 150.0
plastic_modulus = 4000.0
[bodies]
upper = {{ material = "steel" }}
lower = {{ material = "steel" }}
[[contact]]
first = "upper.outer"
second = "lower.outer"
[[support]]
on = "upper.start"
fix = ["x"]
[[support]]
on = "lower.end"
fix = ["x"]
[[support]]
on = "lower.start"
fix = ["y"]
[[load]]
on = "upper.end"
pressure = 1.0
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 2.0 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A round pad that stays elastic on a block that flows.
fn pad(n: usize) -> Scene {
    let half = n / 2;
    support::parse(&format!(
        r#"
title = "round pad on a block"
kind = "plane_strain"
symmetry = 2
[[mesh.parts]]
body = "pad"
element = "quad8"
disc = {{ center = [0.0, 3.0], radius = 3.0, angle = [-90.0, 0.0], elements = {n} }}
[[mesh.parts]]
body = "block"
element = "quad8"
block = {{ x = [0.0, 4.0], y = [-4.0, 0.0], elements = [{n}, {half}] }}
[materials.tin]
youngs_modulus = 45e3
poissons_ratio = 0.35
yield_stress = 25.0
tangent_modulus = 800.0
[materials.glass]
youngs_modulus = 70e3
poissons_ratio = 0.22
[bodies]
pad = {{ material = "glass" }}
block = {{ material = "tin" }}
[[contact]]
first = "pad.outer"
second = "block.top"
[[support]]
on = "pad.start"
fix = ["x"]
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["y"]
[[load]]
on = "pad.end"
pressure = 1.0
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 4.0 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}
