//! Families that judge the default estimate, which takes no more than the run: written when it was
//! finished, of kinds that no other family has, and run once.

use super::pressed_file::PressedFile;
use super::support;
use super::support::families::{Family, Truth, from_file, named, stepped};
use brinell::accuracy::Extent;
use brinell::scene::{Direction, Extrusion, Kind, Scene};
use std::path::Path;

/// All of them; meshes from files go into `folder`.
pub fn families(folder: &Path) -> Vec<Family> {
    let finer = |name: &str, counts: &[usize], scene: &dyn Fn(usize) -> Scene, n: usize| Family {
        name: name.to_string(),
        extent: Extent::Program,
        meshes: named(counts, scene),
        truth: Truth::Finer(stepped(scene(n), 20)),
    };
    let mut out = vec![
        finer(
            "rigid ball, a dent asked for",
            &[16, 24, 32, 48],
            &|n| indented("axisymmetric", DENT, n),
            128,
        ),
        finer(
            "rigid roller, steps of load",
            &[16, 24, 32, 48],
            &|n| indented("plane_strain", LOADS, n),
            128,
        ),
        finer(
            "hub on a shaft, back stresses that fade",
            &[4, 6, 8, 12, 16],
            &pressed_rings,
            48,
        ),
        finer("pin in a lug, plane stress", &[16, 24, 32, 48], &lug, 128),
        finer("hot core in a shell", &[4, 6, 8, 12, 16], &hot_sphere, 48),
        finer(
            "hub in space, hex8",
            &[4, 6, 8],
            &|n| drawn_rings("quad4", n),
            20,
        ),
        finer(
            "hub in space, hex20",
            &[3, 4],
            &|n| drawn_rings("quad8", n),
            10,
        ),
    ];
    for (name, triangles, order) in [
        ("quad4", false, 1),
        ("tri3", true, 1),
        ("quad8", false, 2),
        ("tri6", true, 2),
    ] {
        out.push(hump(name, triangles, order, folder));
    }
    for element in ["quad4", "quad8"] {
        out.push(pressed_rings_from_file(element, folder));
    }
    out
}

const DENT: &str = "targets = [{ yield = true }, { name = \"dented\", residual_depth = 2e-4 }, \
                    { name = \"off\", load_factor = 0.0 }]";
const LOADS: &str = "targets = [{ yield = true }, { name = \"half\", load_factor = 150.0 }, \
                     { name = \"full\", load_factor = 300.0 }, \
                     { name = \"off\", load_factor = 0.0 }]";

/// A rigid circle of radius 10 on a block that hardens by a table.
fn indented(kind: &str, targets: &str, n: usize) -> Scene {
    let symmetry = if kind == "axisymmetric" { 1 } else { 2 };
    support::parse(&format!(
        r#"
title = "rigid circle on a block"
kind = "{kind}"
symmetry = {symmetry}
[[mesh.parts]]
body = "block"
block = {{ x = [0.0, 3.0], y = [-3.0, 0.0], elements = [{n}, {n}], bias = [40.0, 0.025] }}
[materials.brass]
youngs_modulus = 105e3
poissons_ratio = 0.34
yield_stress = 150.0
hardening_table = [[0.0, 150.0], [0.02, 220.0], [0.2, 350.0]]
[bodies]
block = {{ material = "brass" }}
[rigid.ball]
sphere = {{ center = [0.0, 10.0], radius = 10.0 }}
[[contact]]
first = "ball"
second = "block.top"
[[load]]
on = "ball"
force = [0.0, -1.0]
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
{targets}
"#
    ))
}

/// A hub pressed on a shaft, with back stresses that fade, and a pressure in its bore on and off.
fn pressed_rings(n: usize) -> Scene {
    rings("quad4", n)
}

fn rings(element: &str, n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "hub on a shaft"
kind = "plane_strain"
[[mesh.parts]]
body = "shaft"
element = "{element}"
ring = {{ radius = [20.0, 40.0], elements = [{n}, {n}] }}
[[mesh.parts]]
body = "hub"
element = "{element}"
ring = {{ radius = [40.0, 70.0], elements = [{n}, {n}], bias = 2.0 }}
[materials.steel]
youngs_modulus = 205e3
poissons_ratio = 0.29
yield_stress = 180.0
plastic_modulus = 500.0
back_stresses = [[20e3, 100.0]]
[bodies]
shaft = {{ material = "steel" }}
hub = {{ material = "steel" }}
[[contact]]
first = "shaft.outer"
second = "hub.inner"
interference = 0.06
[[support]]
on = "shaft.start"
fix = ["y"]
[[support]]
on = "shaft.end"
fix = ["x"]
[[support]]
on = "hub.start"
fix = ["y"]
[[support]]
on = "hub.end"
fix = ["x"]
[[load]]
on = "shaft.inner"
pressure = 1.0
[program]
targets = [{{ name = "pressed", load_factor = 0.0 }}, {{ name = "full", load_factor = 120.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// The same from a file that knows nothing of the circles.
fn pressed_rings_from_file(element: &str, folder: &Path) -> Family {
    let shaped = |n: usize| rings(element, n);
    let filed = |n: usize| {
        let folder = folder.join(format!("rings-{element}-{n}"));
        from_file(shaped(n), &folder, &[])
    };
    Family {
        name: format!("rings pressed together from a file, {element}"),
        extent: Extent::Program,
        meshes: named(&[4, 6, 8, 12], filed),
        truth: Truth::Finer(stepped(
            shaped(if element == "quad4" { 48 } else { 24 }),
            20,
        )),
    }
}

/// A pin with play in the hole of a lug of aluminium, pushed beyond yield and let go.
fn lug(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "pin in a lug"
kind = "plane_stress"
symmetry = 2
[[mesh.parts]]
body = "pin"
disc = {{ radius = 8.0, angle = [-90.0, 0.0], elements = {n} }}
[[mesh.parts]]
body = "lug"
ring = {{ radius = [8.0, 24.0], angle = [-90.0, 0.0], elements = [{n}, {n}], bias = 5.0 }}
[materials.aluminium]
youngs_modulus = 72e3
poissons_ratio = 0.33
yield_stress = 90.0
tangent_modulus = 5000.0
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies]
pin = {{ material = "steel" }}
lug = {{ material = "aluminium" }}
[[contact]]
first = "pin.outer"
second = "lug.inner"
gap = 0.01
[[support]]
on = "pin.start"
fix = ["x"]
[[support]]
on = "lug.start"
fix = ["x"]
[[support]]
on = "lug.outer"
fix = ["x", "y"]
[[load]]
on = "pin.end"
pressure = 1.0
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 1.8 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A hollow ball of which the inner half grows hot: it yields by its own expansion.
fn hot_sphere(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "hot core"
kind = "axisymmetric"
[[mesh.parts]]
body = "core"
ring = {{ radius = [10.0, 20.0], angle = [0.0, 90.0], elements = [{n}, {n}] }}
[[mesh.parts]]
body = "shell"
ring = {{ radius = [20.0, 30.0], angle = [0.0, 90.0], elements = [{n}, {n}] }}
[materials.hot]
youngs_modulus = 190e3
poissons_ratio = 0.3
thermal_expansion = 1.6e-5
[materials.cold]
youngs_modulus = 190e3
poissons_ratio = 0.3
yield_stress = 200.0
tangent_modulus = 8000.0
[bodies]
core = {{ material = "hot" }}
shell = {{ material = "cold" }}
[[contact]]
first = "core.outer"
second = "shell.inner"
[[support]]
on = "core.start"
fix = ["y"]
[[support]]
on = "shell.start"
fix = ["y"]
[[load]]
on = "core"
temperature = 1.0
[program]
targets = [{{ yield = true }}, {{ name = "hot", load_factor = 150.0 }},
    {{ name = "cold", load_factor = 0.0 }}]
"#
    ))
}

/// The hub on its shaft in space, two layers of elements between planes.
fn drawn_rings(element: &str, n: usize) -> Scene {
    let mut scene = rings(element, n);
    scene.kind = Kind::Solid;
    scene.mesh.extrude = Some(Extrusion {
        depth: 8.0,
        elements: 2,
    });
    for body in ["shaft", "hub"] {
        for side in ["front", "back"] {
            let mut plane = scene.support[0].clone();
            plane.on = format!("{body}.{side}");
            plane.fix = vec![Direction::Z];
            scene.support.push(plane);
        }
    }
    scene.validate().unwrap();
    scene
}

/// A round hump on a flat: pressed beyond yield and off.
fn hump(name: &str, triangles: bool, order: usize, folder: &Path) -> Family {
    let scene = |n: usize, jitter: f64| {
        let pressed = PressedFile {
            title: "hump on a flat",
            names: ["hump", "flat"],
            width: 4.0,
            underside: &|x| x * x / 40.0,
            height: 4.0,
            grading: 1.8,
            jitter,
            seed: 7,
            head: "symmetry = 2",
            lower: "youngs_modulus = 110e3\npoissons_ratio = 0.34\nyield_stress = 120.0\n\
                    tangent_modulus = 6000.0",
            load: "traction = [0.0, -1.0]",
            program: "targets = [{ yield = true }, { name = \"pressed\", load_factor = 60.0 }, \
                      { name = \"off\", load_factor = 0.0 }]",
        };
        pressed.scene(folder, (triangles, order), n)
    };
    let finest = if order == 1 { 64 } else { 36 };
    Family {
        name: format!("hump on a flat from a file, {name}"),
        extent: Extent::Program,
        meshes: named(&[8, 12, 18], |n| scene(n, 0.3)),
        truth: Truth::Finer(stepped(scene(finest, 0.0), 20)),
    }
}
