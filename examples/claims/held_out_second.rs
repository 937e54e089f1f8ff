//! Families that judge the estimate of runs that no other mesh judges, and the default estimate
//! once more: written when found loads and readings of plastic strains had their rules, of kinds
//! that no other family has, and run once.

use super::pressed_file::PressedFile;
use super::support;
use super::support::families::{Family, Truth, from_file, named, stepped};
use brinell::accuracy::Extent;
use brinell::model::Model;
use brinell::scene::Scene;
use std::fmt::Write;
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
            "rounded cone, a plastic strain asked for",
            &[16, 24, 32],
            &cone,
            96,
        ),
        finer("O-ring squeezed", &[12, 16, 24, 32], &o_ring, 80),
        finer(
            "ring squeezed, quad8",
            &[2, 3, 4, 6],
            &|n| squeezed("quad8", n),
            16,
        ),
        finer(
            "ring squeezed, tri6",
            &[2, 3, 4, 6],
            &|n| squeezed("tri6", n),
            16,
        ),
        finer("rigid ball in space, hex8", &[6, 8, 10], &in_space, 20),
        finer(
            "tube of nodal forces, a deck",
            &[4, 6, 8, 12],
            &|n| deck(folder, n),
            48,
        ),
    ];
    for element in ["quad4", "tri3", "quad8"] {
        let filed = |n: usize| {
            let folder = folder.join(format!("squeezed-{element}-{n}"));
            let mut scene = squeezed(element, n);
            // The mesh of the ring alone: of a rigid surface there is none.
            let mut ring = scene.clone();
            ring.rigid.clear();
            ring.contact.clear();
            ring.load[0].on = "ring.inner".to_string();
            scene.mesh = from_file(ring, &folder, &[]).mesh;
            scene
        };
        let (counts, finest) = match element {
            "quad8" => ([3, 4, 6], 16),
            _ => ([4, 6, 8], 24),
        };
        out.push(Family {
            name: format!("ring squeezed from a file, {element}"),
            extent: Extent::Program,
            meshes: named(&counts, filed),
            truth: Truth::Finer(stepped(squeezed(element, finest), 20)),
        });
    }
    for (name, triangles, order) in [("quad4", false, 1), ("tri6", true, 2)] {
        let finest = if order == 1 { 48 } else { 28 };
        out.push(Family {
            name: format!("waves on a flat from a file, {name}"),
            extent: Extent::Program,
            meshes: named(&[6, 8, 12], |n| waves(folder, (triangles, order), n, 0.25)),
            truth: Truth::Finer(stepped(waves(folder, (triangles, order), finest, 0.0), 20)),
        });
    }
    out
}

/// A rigid cone with a rounded tip in a block, perfectly plastic.
fn cone(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "cone"
kind = "axisymmetric"
[[mesh.parts]]
body = "block"
block = {{ x = [0.0, 4.0], y = [-4.0, 0.0], elements = [{n}, {n}], bias = [30.0, 0.033] }}
[materials.copper]
youngs_modulus = 120e3
poissons_ratio = 0.34
yield_stress = 200.0
[bodies]
block = {{ material = "copper" }}
[rigid.cone]
cone = {{ tip = [0.0, 0.0], axis = [0.0, 1.0], half_angle = 80.0, rounding = 6.0 }}
[[contact]]
first = "cone"
second = "block.top"
[[load]]
on = "cone"
force = [0.0, -1.0]
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.bottom"
fix = ["x", "y"]
[program]
targets = [{{ yield = true }}, {{ name = "strained", max_equivalent_plastic_strain = 0.002 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A ring of round section between rigid flats, of which the upper half is a model.
fn o_ring(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "O-ring"
kind = "axisymmetric"
symmetry = 2
[[mesh.parts]]
body = "ring"
disc = {{ center = [20.0, 0.0], radius = 3.0, angle = [0.0, 180.0], elements = {n} }}
[materials.brass]
youngs_modulus = 105e3
poissons_ratio = 0.34
yield_stress = 180.0
tangent_modulus = 3000.0
[bodies]
ring = {{ material = "brass" }}
[rigid.flat]
plane = {{ point = [20.0, 3.0], normal = [0.0, -1.0] }}
[[contact]]
first = "flat"
second = "ring.outer"
[[load]]
on = "flat"
force = [0.0, -1.0]
[[support]]
on = "ring.start"
fix = ["y"]
[[support]]
on = "ring.end"
fix = ["y"]
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ name = "pressed", load_factor = 3.0 }},
    {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A quarter of a ring between rigid flats: it bends, and touches where it is pressed.
fn squeezed(element: &str, n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "ring between flats"
kind = "plane_strain"
symmetry = 4
[[mesh.parts]]
body = "ring"
element = "{element}"
ring = {{ radius = [16.0, 20.0], elements = [{n}, {along}] }}
[materials.steel]
youngs_modulus = 200e3
poissons_ratio = 0.3
yield_stress = 300.0
tangent_modulus = 10e3
[bodies]
ring = {{ material = "steel" }}
[rigid.flat]
plane = {{ point = [0.0, 20.0], normal = [0.0, -1.0] }}
[[contact]]
first = "flat"
second = "ring.outer"
[[load]]
on = "flat"
force = [0.0, -1.0]
[[support]]
on = "ring.start"
fix = ["y"]
[[support]]
on = "ring.end"
fix = ["x"]
[program]
unit = "yield"
targets = [{{ yield = true }}, {{ name = "pressed", load_factor = 1.3 }},
    {{ name = "off", load_factor = 0.0 }}]
"#,
        along = 6 * n
    ))
}

/// A quarter of a block under a rigid ball.
fn in_space(n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "rigid ball in space"
kind = "solid"
symmetry = 4
[[mesh.parts]]
body = "block"
brick = {{ x = [0.0, 2.0], y = [0.0, 2.0], z = [-2.0, 0.0], elements = [{n}, {n}, {n}],
    bias = [8.0, 8.0, 0.125] }}
[materials.brass]
youngs_modulus = 105e3
poissons_ratio = 0.34
yield_stress = 150.0
tangent_modulus = 4000.0
[bodies]
block = {{ material = "brass" }}
[rigid.ball]
sphere = {{ center = [0.0, 0.0, 10.0], radius = 10.0 }}
[[contact]]
first = "ball"
second = "block.top"
[[load]]
on = "ball"
force = [0.0, 0.0, -1.0]
[[support]]
on = "block.left"
fix = ["x"]
[[support]]
on = "block.front"
fix = ["y"]
[[support]]
on = "block.bottom"
fix = ["x", "y", "z"]
[program]
targets = [{{ name = "pressed", load_factor = 300.0 }}, {{ name = "off", load_factor = 0.0 }}]
"#
    ))
}

/// A tube in a deck, its pressure as forces on nodes.
fn deck(folder: &Path, n: usize) -> Scene {
    let ring = support::parse(&format!(
        r#"
title = "tube"
kind = "plane_strain"
[[mesh.parts]]
body = "tube"
ring = {{ radius = [10.0, 25.0], elements = [{n}, {n}], bias = 2.0 }}
[materials.steel]
youngs_modulus = 200e3
poissons_ratio = 0.3
[bodies]
tube = {{ material = "steel" }}
[[support]]
on = "tube.start"
fix = ["y"]
[[support]]
on = "tube.end"
fix = ["x"]
[[load]]
on = "tube.inner"
pressure = 1.0
[program]
targets = [{{ load_factor = 1.0 }}]
"#
    ));
    let model = Model::new(&ring).unwrap();
    let mesh = &model.continuum.mesh;
    let mut out = String::from("*NODE\n");
    for node in 0..mesh.n_nodes() {
        let [x, y, _] = mesh.point(node);
        writeln!(out, "{}, {x:?}, {y:?}", node + 1).unwrap();
    }
    out += "*ELEMENT, TYPE=CPE4, ELSET=TUBE\n";
    for element in 0..mesh.n_elements() {
        let nodes: Vec<String> = (mesh.nodes(element).iter())
            .map(|node| (node + 1).to_string())
            .collect();
        writeln!(out, "{}, {}", element + 1, nodes.join(", ")).unwrap();
    }
    for (set, name) in [("START", "tube.start"), ("END", "tube.end")] {
        writeln!(out, "*NSET, NSET={set}").unwrap();
        for node in mesh.set_nodes(name).unwrap() {
            writeln!(out, "{},", node + 1).unwrap();
        }
    }
    out += "*SOLID SECTION, ELSET=TUBE, MATERIAL=STEEL\n1.\n*MATERIAL, NAME=STEEL\n*ELASTIC\n\
            200000., 0.3\n*PLASTIC\n250., 0.\n300., 0.02\n500., 0.5\n*BOUNDARY\nSTART, 2\n\
            END, 1\n";
    // The forces of a pressure on straight sides: half of it at either end.
    let mut forces = vec![[0.0; 2]; mesh.n_nodes()];
    for facet in &mesh.surfaces["tube.inner"].facets {
        let nodes: Vec<usize> = mesh.facet_nodes(*facet).collect();
        let [a, b] = [nodes[0], nodes[1]];
        let [p, q] = [mesh.point(a), mesh.point(b)];
        // The body is on the left of the facet, so that this is the way into it.
        let force = [0.5 * (p[1] - q[1]), 0.5 * (q[0] - p[0])];
        for node in [a, b] {
            (0..2).for_each(|d| forces[node][d] += force[d]);
        }
    }
    for pressure in [200.0, 0.0] {
        out += "*STEP\n*STATIC\n1., 1.\n*CLOAD, OP=NEW\n";
        for (node, force) in forces.iter().enumerate() {
            for (d, value) in force.iter().enumerate() {
                if *value != 0.0 {
                    writeln!(out, "{}, {}, {:?}", node + 1, d + 1, pressure * value).unwrap();
                }
            }
        }
        out += "*NODE PRINT, NSET=START\nU\n*END STEP\n";
    }
    let file = folder.join(format!("tube-{n}.inp"));
    std::fs::write(&file, out).unwrap();
    brinell::deck::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

/// A block with a wavy underside on a flat one: pressed, it touches ever more of it.
fn waves(folder: &Path, of: (bool, usize), n: usize, jitter: f64) -> Scene {
    let pressed = PressedFile {
        title: "waves",
        names: ["upper", "lower"],
        width: 2.0,
        underside: &|x| 0.01 * (1.0 - (std::f64::consts::PI * x / 2.0).cos()),
        height: 2.0,
        grading: 1.3,
        jitter,
        seed: 11,
        head: "",
        lower: "youngs_modulus = 60e3\npoissons_ratio = 0.35\nyield_stress = 300.0\n\
                plastic_modulus = 2000.0",
        load: "pressure = 1.0",
        program: "unit = \"yield\"\ntargets = [{ yield = true }, \
                  { name = \"pressed\", load_factor = 1.6 }, \
                  { name = \"off\", load_factor = 0.0 }]",
    };
    pressed.scene(folder, of, n)
}
