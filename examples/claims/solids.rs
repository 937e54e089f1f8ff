//! Families of solids, written when the procedure of `brinell::accuracy` for solids was finished
//! and run once.

use super::support;
use super::support::families::{Family, Truth, named};
use brinell::accuracy::Extent;
use brinell::scene::Scene;

/// All of them.
pub fn families() -> Vec<Family> {
    let finer = |name: &str, extent, counts: &[usize], scene: &dyn Fn(usize) -> Scene, n| Family {
        name: name.to_string(),
        extent,
        meshes: named(counts, scene),
        truth: Truth::Finer(Box::new(scene(n))),
    };
    let (all, first) = (Extent::Program, Extent::Yield);
    vec![
        finer(
            "hollow sphere, hex20",
            all,
            &[3, 4, 6],
            &|n| sphere("quad8", n),
            12,
        ),
        finer(
            "hollow sphere, hex8",
            all,
            &[4, 6, 8],
            &|n| sphere("quad4", n),
            24,
        ),
        finer(
            "tube drawn out, hex8",
            all,
            &[6, 8, 12],
            &|n| tube("quad4", n),
            36,
        ),
        finer(
            "tube drawn out, prism15",
            all,
            &[4, 6, 8],
            &|n| tube("tri6", n),
            20,
        ),
        finer(
            "barrel on aluminium, pressed and off",
            all,
            &[5, 6, 8],
            &barrel,
            11,
        ),
        finer(
            "ball in a close groove, first yield",
            first,
            &[5, 6, 8],
            &groove,
            12,
        ),
    ]
}

/// An octant of a sphere under pressure from within, beyond yield and off.
fn sphere(shape: &str, n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "hollow sphere"
kind = "solid"
[mesh]
revolve = {{ angle = 90.0, elements = {n} }}
[[mesh.parts]]
body = "sphere"
element = "{shape}"
ring = {{ radius = [30.0, 50.0], elements = [{n}, {n}] }}
[materials.steel]
youngs_modulus = 200000.0
poissons_ratio = 0.28
yield_stress = 300.0
tangent_modulus = 6000.0
[bodies.sphere]
material = "steel"
[[support]]
on = "sphere.start"
fix = ["y"]
[[support]]
on = "sphere.front"
fix = ["z"]
[[support]]
on = "sphere.back"
fix = ["x"]
[[load]]
on = "sphere.inner"
pressure = 1.0
[program]
targets = [{{ yield = true }}, {{ load_factor = 220.0 }}, {{ load_factor = 300.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A quarter of a tube in plane strain, drawn out by two elements.
fn tube(shape: &str, n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "tube drawn out"
kind = "solid"
[mesh]
extrude = {{ depth = 10.0, elements = 2 }}
[[mesh.parts]]
body = "tube"
element = "{shape}"
ring = {{ radius = [20.0, 50.0], elements = [{n}, {n}], bias = 2.0 }}
[materials.steel]
youngs_modulus = 200000.0
poissons_ratio = 0.28
yield_stress = 300.0
tangent_modulus = 6000.0
[bodies.tube]
material = "steel"
[[support]]
on = "tube.start"
fix = ["y"]
[[support]]
on = "tube.end"
fix = ["x"]
[[support]]
on = "tube.front"
fix = ["z"]
[[support]]
on = "tube.back"
fix = ["z"]
[[load]]
on = "tube.inner"
pressure = 1.0
[program]
targets = [{{ yield = true }}, {{ load_factor = 200.0 }}, {{ load_factor = 260.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A hard barrel of radii 8 and 20 on aluminium with a table of hardening, to four times first
/// yield.
fn barrel(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "barrel on aluminium"
kind = "solid"
symmetry = 4
[mesh.curved_bodies]
upper = [8.0, 20.0]
lower = [0.0, 0.0]
resolution = {n}
far_size = 8.0
[materials.hard]
youngs_modulus = 300000.0
poissons_ratio = 0.25
[materials.aluminium]
youngs_modulus = 70000.0
poissons_ratio = 0.33
yield_stress = 120.0
hardening_table = [[0.0, 120.0], [0.01, 180.0], [0.1, 300.0]]
[bodies]
upper = {{ material = "hard" }}
lower = {{ material = "aluminium" }}
[[contact]]
first = "upper.contact"
second = "lower.contact"
{SUPPORTS}
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 2.0 }}, {{ load_factor = 4.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A ball of radius 5 in a straight groove of radius 7.
fn groove(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "ball in a close groove"
kind = "solid"
symmetry = 4
[mesh.curved_bodies]
upper = [5.0, 5.0]
lower = [0.0, -7.0]
resolution = {n}
far_size = 8.0
[materials.steel]
youngs_modulus = 210000.0
poissons_ratio = 0.3
yield_stress = 900.0
[bodies]
upper = {{ material = "steel" }}
lower = {{ material = "steel" }}
[[contact]]
first = "upper.contact"
second = "lower.contact"
{SUPPORTS}
[program]
targets = [{{ yield = true }}]
"#
    ))
}

/// Planes of symmetry, a base that is held, and a load on the top.
const SUPPORTS: &str = r#"
[[support]]
on = "upper.symmetry_x"
fix = ["x"]
[[support]]
on = "lower.symmetry_x"
fix = ["x"]
[[support]]
on = "upper.symmetry_y"
fix = ["y"]
[[support]]
on = "lower.symmetry_y"
fix = ["y"]
[[support]]
on = "lower.bottom"
fix = ["z"]
[[load]]
on = "upper.top"
plane_force = { direction = "z", total = -10.0 }
"#;
