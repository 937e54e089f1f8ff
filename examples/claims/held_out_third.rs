//! Scenes that judge what demands cost, and the default estimate once more: written when the way
//! from mesh to mesh was finished, of kinds that no other family has. They judged it once; what
//! they showed has changed it since.

use super::held_out_fourth::refined;
use super::support;
use super::support::families::{Family, Truth, from_file, named, stepped};
use brinell::accuracy::Extent;
use brinell::scene::Scene;
use std::path::Path;

/// All of them; meshes from files go into `folder`.
pub fn families(folder: &Path) -> Vec<Family> {
    let finer = |name: &str, counts: &[usize], scene: &dyn Fn(usize) -> Scene, n: usize| Family {
        name: name.to_string(),
        extent: Extent::Program,
        meshes: named(counts, scene),
        truth: Truth::Finer(stepped(scene(n), 20)),
    };
    // What a truth without smaller elements there would not resolve at first yield.
    let at_contact = |name: &str,
                      counts: &[usize],
                      scene: &dyn Fn(usize) -> Scene,
                      (n, x, times): (usize, f64, usize)| {
        let truth = refined(scene(n), [x, 0.0], 0.12, times);
        Family {
            truth: Truth::Finer(stepped(truth, 20)),
            ..finer(name, counts, scene, counts[0])
        }
    };
    let filed = |n: usize| {
        let folder = folder.join(format!("soft-ball-{n}"));
        let circle = ("ball.outer", [0.0, 5.0], 5.0);
        from_file(soft_ball("quad8", n), &folder, &[circle])
    };
    vec![
        finer("rigid punch with a fillet", &[16, 24, 32], &punch, 96),
        finer(
            "roller in a rigid raceway, quad8",
            &[12, 16, 24],
            &raceway,
            64,
        ),
        finer("hole in a plate beyond yield, quad8", &[4, 6, 8], &hole, 24),
        finer(
            "tube with a ring of pressure",
            &[6, 9, 12],
            &ring_of_pressure,
            48,
        ),
        at_contact(
            "soft ball on a block, quad4",
            &[24, 32, 48],
            &|n| soft_ball("quad4", n),
            (64, 0.0, 5),
        ),
        at_contact(
            "soft ball on a block from a file, quad8",
            &[16, 20, 24],
            &filed,
            (40, 0.0, 5),
        ),
        finer("shrunk ring that is heated, tri3", &[6, 8, 12], &heated, 40),
        at_contact(
            "rigid torus on a block",
            &[24, 32, 40],
            &torus,
            (80, 6.0, 5),
        ),
        finer("rigid cylinder across a brick", &[6, 8, 10], &across, 20),
    ]
}

/// A scene of one block under a rigid body, whose load is a force on that body.
fn block_under(rigid: &str, block: &str, [plastic, axis]: [&str; 2], targets: &str) -> Scene {
    support::parse(&format!(
        r#"
title = "block under a rigid body"
kind = "axisymmetric"
[[mesh.parts]]
body = "block"
block = {{ {block} }}
[materials.metal]
youngs_modulus = 70e3
poissons_ratio = 0.33
{plastic}
[bodies.block]
material = "metal"
[rigid.tool]
{rigid}
[[contact]]
first = "tool"
second = "block.top"
[[load]]
on = "tool"
force = [0.0, -1.0]
{axis}
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
unit = "yield"
targets = [{targets}]
"#
    ))
}

fn punch(n: usize) -> Scene {
    block_under(
        "punch = { center = [0.0, 0.0], axis = [0.0, 1.0], radius = 2.0, fillet = 1.0 }",
        &format!("x = [0.0, 8.0], y = [-8.0, 0.0], elements = [{n}, {n}], bias = [6.0, 0.15]"),
        [
            "yield_stress = 120.0\ntangent_modulus = 3000.0",
            "[[support]]\non = \"block.left\"\nfix = [\"x\"]",
        ],
        "{ yield = true }, { load_factor = 2.5 }, { name = \"off\", load_factor = 0.0 }",
    )
}

fn torus(n: usize) -> Scene {
    block_under(
        "torus = { center = [0.0, 2.0], ring_radius = 6.0, radius = 2.0 }",
        &format!("x = [4.0, 8.0], y = [-3.0, 0.0], elements = [{n}, {n}], bias = [1.0, 0.2]"),
        ["yield_stress = 150.0", ""],
        "{ yield = true }, { load_factor = 2.0 }, { name = \"off\", load_factor = 0.0 }",
    )
}

/// A roller in a rigid hollow cylinder of a slightly larger radius.
fn raceway(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "roller in a rigid raceway"
kind = "plane_strain"
symmetry = 2
[[mesh.parts]]
body = "roller"
element = "quad8"
disc = {{ radius = 8.0, angle = [-90.0, 0.0], elements = {n} }}
[materials.bronze]
youngs_modulus = 100e3
poissons_ratio = 0.34
yield_stress = 90.0
plastic_modulus = 4000.0
[bodies.roller]
material = "bronze"
[rigid.raceway]
cylinder = {{ center = [0.0, 0.1], radius = 8.1, hollow = true }}
[[contact]]
first = "raceway"
second = "roller.outer"
[[support]]
on = "roller.start"
fix = ["x"]
[[load]]
on = "roller.end"
pressure = 1.0
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 1.7 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A hole in a plate under tension, beyond yield and off.
fn hole(n: usize) -> Scene {
    let rings = 2 * n;
    support::parse(&format!(
        r#"
title = "hole in a plate"
kind = "plane_strain"
symmetry = 4
[[mesh.parts]]
body = "plate"
element = "quad8"
ring = {{ radius = [5.0, 40.0], elements = [{rings}, {n}], bias = 8.0 }}
[materials.steel]
youngs_modulus = 205e3
poissons_ratio = 0.3
yield_stress = 240.0
hardening_table = [[0.0, 240.0], [0.01, 300.0], [0.1, 420.0]]
[bodies.plate]
material = "steel"
[[support]]
on = "plate.start"
fix = ["y"]
[[support]]
on = "plate.end"
fix = ["x"]
[[load]]
on = "plate.outer"
kirsch = {{ stress_x = 1.0, radius = 5.0 }}
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 1.6 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A thick tube that is pressed over a third of its length.
fn ring_of_pressure(n: usize) -> Scene {
    let along = 2 * n;
    support::parse(&format!(
        r#"
title = "ring of pressure"
kind = "axisymmetric"
symmetry = 2
[[mesh.parts]]
body = "tube"
block = {{ x = [20.0, 35.0], y = [0.0, 30.0], elements = [{n}, {along}], pieces = [
    {{ name = "ring", side = "left", from = 0.0, to = 10.0 }}] }}
[materials.steel]
youngs_modulus = 205e3
poissons_ratio = 0.3
yield_stress = 260.0
plastic_modulus = 9000.0
[bodies.tube]
material = "steel"
[[support]]
on = "tube.bottom"
fix = ["y"]
[[load]]
on = "tube.ring"
pressure = 1.0
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 1.5 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// Half a ball, pressed evenly on its flat, on a block of the same metal.
fn soft_ball(element: &str, n: usize) -> Scene {
    let half = n / 2;
    support::parse(&format!(
        r#"
title = "soft ball on a block"
kind = "axisymmetric"
[[mesh.parts]]
body = "ball"
element = "{element}"
disc = {{ center = [0.0, 5.0], radius = 5.0, angle = [-90.0, 0.0], elements = {n} }}
[[mesh.parts]]
body = "block"
element = "{element}"
block = {{ x = [0.0, 6.0], y = [-5.0, 0.0], elements = [{n}, {half}], bias = [4.0, 0.3] }}
[materials.lead]
youngs_modulus = 16e3
poissons_ratio = 0.42
yield_stress = 60.0
tangent_modulus = 1600.0
[materials.tin]
youngs_modulus = 45e3
poissons_ratio = 0.35
[bodies]
ball = {{ material = "tin" }}
block = {{ material = "lead" }}
[[contact]]
first = "ball.outer"
second = "block.top"
[[support]]
on = "ball.start"
fix = ["x"]
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["y"]
[[load]]
on = "ball.end"
pressure = 1.0
[program]
targets = [{{ name = "half", load_factor = 1.0 }}, {{ name = "full", load_factor = 2.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A ring shrunk on a core of another metal, heated with it and cooled again.
fn heated(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "shrunk ring"
kind = "plane_stress"
symmetry = 4
[[mesh.parts]]
body = "core"
element = "tri3"
ring = {{ radius = [6.0, 12.0], elements = [{n}, {n}] }}
[[mesh.parts]]
body = "ring"
element = "tri3"
ring = {{ radius = [12.0, 16.0], elements = [{n}, {n}] }}
[materials.brass]
youngs_modulus = 100e3
poissons_ratio = 0.35
thermal_expansion = 2e-5
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
yield_stress = 220.0
tangent_modulus = 5000.0
thermal_expansion = 1.2e-5
[bodies]
core = {{ material = "brass" }}
ring = {{ material = "steel" }}
[[contact]]
first = "core.outer"
second = "ring.inner"
interference = 0.012
[[support]]
on = "core.start"
fix = ["y"]
[[support]]
on = "core.end"
fix = ["x"]
[[support]]
on = "ring.start"
fix = ["y"]
[[support]]
on = "ring.end"
fix = ["x"]
[[load]]
on = "core"
temperature = 1.0
[[load]]
on = "ring"
temperature = 1.0
[program]
targets = [{{ name = "cold", load_factor = 0.0 }}, {{ name = "hot", load_factor = 160.0 }},
    {{ name = "cold again", load_factor = 0.0 }}]
"#
    ))
}

/// A rigid cylinder across a brick of which it presses the whole width.
fn across(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "rigid cylinder across a brick"
kind = "solid"
symmetry = 4
[[mesh.parts]]
body = "brick"
brick = {{ x = [0.0, 2.0], y = [0.0, 2.0], z = [-2.0, 0.0], elements = [{n}, {n}, {n}],
    bias = [1.0, 5.0, 0.2] }}
[materials.metal]
youngs_modulus = 70e3
poissons_ratio = 0.33
yield_stress = 200.0
tangent_modulus = 4000.0
[bodies.brick]
material = "metal"
[rigid.cylinder]
cylinder = {{ center = [0.0, 0.0, 6.0], axis = [1.0, 0.0, 0.0], radius = 6.0 }}
[[contact]]
first = "cylinder"
second = "brick.top"
[[load]]
on = "cylinder"
force = [0.0, 0.0, -1.0]
[[support]]
on = "brick.left"
fix = ["x"]
[[support]]
on = "brick.front"
fix = ["y"]
[[support]]
on = "brick.bottom"
fix = ["z"]
[program]
targets = [{{ name = "half", load_factor = 400.0 }}, {{ name = "full", load_factor = 800.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}
