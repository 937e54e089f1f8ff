//! Families of other physics, written when the procedure of `brinell::accuracy` was finished and
//! run once: what its stated errors are worth on scenes that nobody has looked at.

use super::support;
use super::support::families::{Family, Truth, from_file, named, on_flat, stepped};
use brinell::accuracy::Extent;
use brinell::analytical::{HertzLine, HertzPoint, PinInHole, contact_modulus};
use brinell::scene::Scene;
use std::path::Path;

/// A scene of a family by the number of its elements.
type Build = fn(usize) -> Scene;

/// All of them; meshes from files go into `folder`.
pub fn families(folder: &Path) -> Vec<Family> {
    let mut out = vec![unlike_cylinders(), hard_ball(), plane_stress_tube("quad4")];
    out.extend([
        plane_stress_tube("tri6"),
        hole_in_plate("quad4"),
        hole_in_plate("quad8"),
    ]);
    out.extend(["quad4", "tri6"].map(|shape| pin_from_file(shape, folder)));
    let history: Vec<(&str, &[usize], Build, usize)> = vec![
        (
            "tube into a sleeve, quad4",
            &[4, 6, 8, 12, 16],
            |n| sleeve("quad4", n),
            48,
        ),
        (
            "tube into a sleeve, quad8",
            &[4, 6, 8, 12],
            |n| sleeve("quad8", n),
            32,
        ),
        (
            "soft block on a base, strip of pressure",
            &[2, 3, 4, 6, 8],
            strip,
            20,
        ),
        ("ball in a socket", &[12, 18, 24, 36], socket, 96),
        (
            "roller on bronze, loaded twice",
            &[4, 6, 8, 12, 16],
            bronze,
            40,
        ),
        (
            "hollow sphere, pressure both ways",
            &[4, 6, 8, 12, 16],
            reversed_sphere,
            48,
        ),
    ];
    let made = history
        .into_iter()
        .map(|(name, counts, scene, finer)| Family {
            name: name.to_string(),
            extent: Extent::Program,
            meshes: named(counts, scene),
            truth: Truth::Finer(stepped(scene(finer), 20)),
        });
    out.extend(made);
    out
}

/// Overrides for a flat of bronze under steel.
const BRONZE: [&str; 2] = [
    "materials.bronze={ youngs_modulus = 110000.0, poissons_ratio = 0.34, yield_stress = 40.0, \
     hardening_table = [[0.0, 40.0], [0.01, 70.0], [0.1, 120.0]] }",
    "bodies.half_plane={ material = \"bronze\" }",
];

/// A steel roller on bronze, which yields first.
fn unlike_cylinders() -> Family {
    let line = HertzLine::new(10.0, contact_modulus(210e3, 0.3, 110e3, 0.34)).unwrap();
    let far = "mesh.cylinder_on_half_plane.far_size=20000.0";
    let mut all = vec![far];
    all.extend(BRONZE);
    Family {
        name: "steel on bronze, line, first yield".to_string(),
        extent: Extent::Yield,
        meshes: named(&[4, 6, 8, 10, 12, 16, 20, 24], |n| {
            on_flat("cylinder_on_half_plane", n, &all)
        }),
        truth: Truth::Exact(vec![
            ("yield.load", line.yield_load(0.34, 40.0)),
            ("yield.max_pressure", HertzLine::yield_pressure(0.34, 40.0)),
            ("yield.half_width", line.yield_half_width(0.34, 40.0)),
        ]),
    }
}

/// A ball of hard metal on steel.
fn hard_ball() -> Family {
    let point = HertzPoint::new(10.0, contact_modulus(600e3, 0.22, 210e3, 0.3)).unwrap();
    let all = [
        "mesh.cylinder_on_half_plane.far_size=2000.0",
        "materials.hard={ youngs_modulus = 600000.0, poissons_ratio = 0.22 }",
        "bodies.cylinder={ material = \"hard\" }",
    ];
    Family {
        name: "hard ball on steel, first yield".to_string(),
        extent: Extent::Yield,
        meshes: named(&[4, 6, 8, 10, 12, 16, 20, 24], |n| {
            on_flat("ball_on_half_space", n, &all)
        }),
        truth: Truth::Exact(vec![
            ("yield.load", point.yield_load(0.3, 50.0)),
            ("yield.max_pressure", HertzPoint::yield_pressure(0.3, 50.0)),
            ("yield.half_width", point.yield_contact_radius(0.3, 50.0)),
        ]),
    }
}

/// A ring of three times its bore under pressure from within, free at its faces: at the bore `-p`
/// and `p (b^2 + a^2)/(b^2 - a^2)`.
fn plane_stress_tube(shape: &'static str) -> Family {
    let hoop = (9.0 + 1.0) / (9.0 - 1.0);
    let mises = f64::sqrt(hoop * hoop + hoop + 1.0);
    Family {
        name: format!("ring in plane stress, first yield, {shape}"),
        extent: Extent::Yield,
        meshes: named(&[4, 6, 8, 12, 16, 24], |n| {
            let ring = format!(
                "mesh.parts.0.ring={{ radius = [40.0, 120.0], elements = [{n}, {n}], bias = 3.0 }}"
            );
            let element = format!("mesh.parts.0.element=\"{shape}\"");
            support::load(
                "thick_cylinder",
                &["kind=\"plane_stress\"", &ring, &element],
            )
        }),
        truth: Truth::Exact(vec![("yield.load", 240.0 / mises)]),
    }
}

/// A hole in a plate under tension, with Kirsch's stresses at the outer edge: three times the
/// tension at the hole.
fn hole_in_plate(shape: &'static str) -> Family {
    let scene = |n: usize| {
        let rings = 2 * n;
        support::parse(&format!(
            r#"
title = "hole in a plate"
kind = "plane_stress"
[[mesh.parts]]
body = "plate"
element = "{shape}"
ring = {{ radius = [10.0, 60.0], elements = [{rings}, {n}], bias = 6.0 }}
[materials.steel]
youngs_modulus = 70000.0
poissons_ratio = 0.33
yield_stress = 300.0
tangent_modulus = 7000.0
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
kirsch = {{ stress_x = 1.0, radius = 10.0 }}
[program]
targets = [{{ yield = true }}]
"#
        ))
    };
    Family {
        name: format!("hole in a plate, first yield, {shape}"),
        extent: Extent::Yield,
        meshes: named(&[4, 6, 8, 12, 16, 24], scene),
        truth: Truth::Exact(vec![("yield.load", 100.0)]),
    }
}

/// Persson's pin, from a file that knows nothing of its shape, with its subdivisions.
fn pin_from_file(shape: &'static str, folder: &Path) -> Family {
    let clearance = 4e-3;
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    let exact = PinInHole::new(10.0, clearance, modulus).unwrap();
    let scene = support::load(
        "pin_in_hole",
        &[
            &format!("mesh.parts.0.element=\"{shape}\""),
            &format!("mesh.parts.1.element=\"{shape}\""),
            "mesh.parts.0.disc.elements=16",
            "mesh.parts.1.ring.elements=[20,32]",
            &format!("contact.0.gap={clearance:.6}"),
            "program.targets=[{ name = \"pushed\", load_factor = 1.0 }]",
        ],
    );
    let circles = [
        ("pin.outer", [0.0; 2], 10.0),
        ("plate.inner", [0.0; 2], 10.0),
        ("plate.outer", [0.0; 2], 1000.0),
    ];
    let scene = from_file(scene, &folder.join(format!("pin-{shape}")), &circles);
    let subdivided = |n: usize| {
        let mut scene = scene.clone();
        scene.mesh.subdivisions = n;
        scene
    };
    Family {
        name: format!("pin in a hole from a file, {shape}"),
        extent: Extent::Program,
        meshes: named(&[0, 1, 2], subdivided),
        truth: Truth::Exact(vec![
            (
                "states.pushed.max_pressure",
                exact.max_pressure(1000.0).unwrap(),
            ),
            (
                "states.pushed.half_width",
                10.0 * exact.half_angle(1000.0).unwrap(),
            ),
        ]),
    }
}

/// A tube that yields under pressure from within, touches its sleeve and is held by it when the
/// pressure is gone.
fn sleeve(shape: &str, n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "tube into a sleeve"
kind = "plane_strain"
[[mesh.parts]]
body = "tube"
element = "{shape}"
ring = {{ radius = [50.0, 60.0], elements = [{n}, {n}] }}
[[mesh.parts]]
body = "sleeve"
element = "{shape}"
ring = {{ radius = [60.0, 90.0], elements = [{n}, {n}], bias = 1.5 }}
[materials.soft]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 250.0
tangent_modulus = 4000.0
[materials.hard]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 700.0
[bodies]
tube = {{ material = "soft" }}
sleeve = {{ material = "hard" }}
[[contact]]
first = "tube.outer"
second = "sleeve.inner"
gap = 0.1
[[support]]
on = "tube.start"
fix = ["y"]
[[support]]
on = "tube.end"
fix = ["x"]
[[support]]
on = "sleeve.start"
fix = ["y"]
[[support]]
on = "sleeve.end"
fix = ["x"]
[[load]]
on = "tube.inner"
pressure = 1.0
[program]
targets = [{{ yield = true }}, {{ load_factor = 60.0 }}, {{ load_factor = 150.0 }}, 
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A soft block on an elastic base, under a strip of pressure that makes it yield and its ends lift
/// off.
fn strip(n: usize) -> Scene {
    let (along, across, below) = (12 * n, 4 * n, 4 * n);
    support::parse(&format!(
        r#"
title = "strip of pressure"
kind = "plane_stress"
[[mesh.parts]]
body = "block"
block = {{ x = [0.0, 6.0], y = [0.0, 2.0], elements = [{along}, {across}], pieces = [
    {{ name = "strip", side = "top", from = 0.0, to = 1.5 }}] }}
[[mesh.parts]]
body = "base"
block = {{ x = [0.0, 6.0], y = [-4.0, 0.0], elements = [{along}, {below}], bias = [1.0, 0.5] }}
[materials.soft]
youngs_modulus = 70000.0
poissons_ratio = 0.33
yield_stress = 100.0
tangent_modulus = 3500.0
[materials.stiff]
youngs_modulus = 210000.0
poissons_ratio = 0.3
[bodies]
block = {{ material = "soft" }}
base = {{ material = "stiff" }}
[[contact]]
first = "block.bottom"
second = "base.top"
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "base.left"
fix = ["x"]
[[support]]
on = "base.bottom"
fix = ["y"]
[[load]]
on = "block.strip"
pressure = 1.0
[program]
targets = [{{ yield = true }}, {{ load_factor = 120.0 }}, {{ load_factor = 150.0 }}, 
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// Half a ball in a spherical seat that is a little too wide for it, pressed beyond yield and let
/// go.
fn socket(n: usize) -> Scene {
    let across = n;
    support::parse(&format!(
        r#"
title = "ball in a socket"
kind = "axisymmetric"
[[mesh.parts]]
body = "ball"
disc = {{ radius = 10.0, angle = [-90.0, 0.0], elements = {n} }}
[[mesh.parts]]
body = "seat"
ring = {{ radius = [10.0, 30.0], angle = [-90.0, 0.0], elements = [{across}, {n}], bias = 8.0 }}
[materials.soft]
youngs_modulus = 70000.0
poissons_ratio = 0.33
yield_stress = 60.0
tangent_modulus = 3500.0
[materials.hard]
youngs_modulus = 210000.0
poissons_ratio = 0.3
[bodies]
ball = {{ material = "hard" }}
seat = {{ material = "soft" }}
[[contact]]
first = "ball.outer"
second = "seat.inner"
gap = 0.02
[[support]]
on = "ball.start"
fix = ["x"]
[[support]]
on = "seat.start"
fix = ["x"]
[[support]]
on = "seat.outer"
fix = ["x", "y"]
[[load]]
on = "ball.end"
pressure = 1.0
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ load_factor = 1.5 }}, {{ load_factor = 2.0 }}, 
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A roller on hardening bronze, off and on again.
fn bronze(n: usize) -> Scene {
    let mut all = vec![
        "mesh.cylinder_on_half_plane.far_size=2000.0",
        "program.targets=[{ yield = true }, { load_factor = 2.0 }, \
         { name = \"off\", load_factor = 0.0 }, { name = \"again\", load_factor = 2.5 }]",
    ];
    all.extend(BRONZE);
    on_flat("cylinder_on_half_plane", n, &all)
}

/// A hollow sphere of hardening steel under pressure from within, then from without.
fn reversed_sphere(n: usize) -> Scene {
    support::load(
        "thick_sphere",
        &[
            "mesh.parts.0.element=\"quad4\"",
            &format!("mesh.parts.0.ring={{ radius = [50.0, 80.0], elements = [{n}, {n}] }}"),
            "materials.steel.tangent_modulus=5000.0",
            "program.targets=[{ yield = true }, { name = \"in\", load_factor = 200.0 }, \
             { name = \"out\", load_factor = -180.0 }, { name = \"off\", load_factor = 0.0 }]",
        ],
    )
}
