//! Pressures, tractions, displacements, gaps and interferences that depend on the position: by
//! formula and by values at nodes, against closed forms that the elements can show exactly.

use crate::support::{parse, run};
use brinell::analytical::HertzLine;
use brinell::model::{LoadCase, Model};
use brinell::results::Results;
use brinell::scene::Scene;

const STEEL: (f64, f64) = (210_000.0, 0.3);

/// A scene with one elastic material and one target.
fn parsed(kind: &str, text: &str) -> Scene {
    let (young, poisson) = STEEL;
    let text = format!(
        "kind = \"{kind}\"\n{text}\n\
         [materials.m]\nyoungs_modulus = {young:?}\npoissons_ratio = {poisson:?}\n\
         [bodies]\nb = {{ material = \"m\" }}\n\
         [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
    );
    parse(&text)
}

fn displacement(results: &Results) -> &[f64] {
    &results.states[0].fields.as_ref().unwrap().displacement
}

/// Forces of the first load at the nodes, which are free along all axes.
fn forces(model: &Model) -> Vec<(usize, usize, f64)> {
    let load: &LoadCase = &model.loads[0];
    let at = |&(freedom, force): &(usize, f64)| {
        let (node, axis) = model.freedoms.owners[freedom];
        (node as usize, axis as usize, force)
    };
    load.forces.iter().map(at).collect()
}

/// Pure bending of a plate by the traction `s y`: `u = s x y/E`, `v = -s (x^2 + nu y^2)/(2 E)`,
/// which is given on the left. Quadratic elements have all of it.
#[test]
fn a_plate_bends_under_a_traction() {
    let (young, nu) = STEEL;
    let s = 50.0;
    let scene = parsed(
        "plane_stress",
        &format!(
            r#"
[[mesh.parts]]
body = "b"
element = "quad8"
block = {{ x = [0.0, 4.0], y = [-1.0, 1.0], elements = [4, 2] }}
[[load]]
on = "b.right"
traction = ["{s} * y", 0.0]
[[load]]
on = "b.left"
displacement = {{ x = 0.0, y = "-{s} * {nu} * y^2 / (2 * {young})" }}
"#
        ),
    );
    let results = run(&scene);
    let mesh = &Model::new(&scene).unwrap().mesh;
    for (node, found) in displacement(&results).chunks(2).enumerate() {
        let [x, y, _] = mesh.point(node);
        let exact = [s * x * y / young, -s * (x * x + nu * y * y) / (2.0 * young)];
        for (found, exact) in found.iter().zip(exact) {
            assert!(
                (found - exact).abs() < 1e-9 * s * 16.0 / young,
                "{x} {y}: {found} {exact}"
            );
        }
    }
}

/// Bricks of twenty nodes bend the same way, `w = -s nu y z/E`, by displacements on two faces and a
/// traction on a third.
#[test]
fn a_bar_bends_in_space() {
    let (young, nu) = STEEL;
    let s = 50.0;
    let scene = parsed(
        "solid",
        &format!(
            r#"
[[mesh.parts]]
body = "b"
element = "hex20"
brick = {{ x = [0, 3], y = [-1, 1], z = [0, 1], elements = [2, 2, 1] }}
[[load]]
on = "b.right"
traction = ["{s} * y", 0.0, "0 * z"]
[[load]]
on = "b.left"
displacement = {{ x = 0.0, y = "{half} * (y^2 - z^2)", z = "2 * {half} * y * z" }}
"#,
            half = -0.5 * s * nu / young
        ),
    );
    let results = run(&scene);
    let mesh = &Model::new(&scene).unwrap().mesh;
    for (node, found) in displacement(&results).chunks(3).enumerate() {
        let [x, y, z] = mesh.point(node);
        let exact = [
            s * x * y / young,
            -s * (x * x + nu * (y * y - z * z)) / (2.0 * young),
            -s * nu * y * z / young,
        ];
        for (found, exact) in found.iter().zip(exact) {
            assert!(
                (found - exact).abs() < 1e-9 * s * 9.0 / young,
                "{x} {y} {z}: {found} {exact}"
            );
        }
    }
}

/// A displacement that is linear in the position strains everything alike.
#[test]
fn a_linear_displacement_is_a_uniform_strain() {
    let (young, nu) = STEEL;
    let scene = parsed(
        "plane_stress",
        r#"
[[mesh.parts]]
body = "b"
element = "tri3"
block = { x = [0.0, 2.0], y = [0.0, 1.0], elements = [3, 3] }
[[load]]
on = "b.left"
displacement = { x = "1e-3*x + 2e-4*y", y = "1e-4*x - 5e-4*y" }
[[load]]
on = "b.right"
displacement = { x = "1e-3*x + 2e-4*y", y = "1e-4*x - 5e-4*y" }
"#,
    );
    // On the other sides, whose corners are those of the first, the traction of that strain.
    let modulus = young / (1.0 - nu * nu);
    let [xx, yy, xy] = [1e-3, -5e-4, 3e-4];
    let [sxx, syy] = [modulus * (xx + nu * yy), modulus * (yy + nu * xx)];
    let sxy = 0.5 * young / (1.0 + nu) * xy;
    let mut free = scene;
    for (on, sign) in [("b.bottom", -1.0), ("b.top", 1.0)] {
        free.load.push(brinell::scene::Load {
            on: on.into(),
            traction: Some([sign * sxy, sign * syy].into()),
            ..Default::default()
        });
    }
    let results = run(&free);
    let stress = &results.states[0].fields.as_ref().unwrap().stress;
    for found in stress.chunks(4) {
        for (found, exact) in [(found[0], sxx), (found[1], syy), (found[3], sxy)] {
            assert!((found - exact).abs() < 1e-9 * sxx, "{found} {exact}");
        }
    }
}

/// Resultants and moments of linear pressures are exact, of every kind of model: in the plane,
/// round an axis (`int 2 pi r r dr`), in space.
#[test]
fn resultants_and_moments_are_exact() {
    let of = |kind: &str, element: &str, shape: &str, on: &str, pressure: &str| {
        let third = if kind == "solid" { ", \"z\"" } else { "" };
        let text = format!(
            "[[mesh.parts]]\nbody = \"b\"\nelement = \"{element}\"\n{shape}\n\
             [[support]]\non = \"b.bottom\"\nfix = [\"x\", \"y\"{third}]\n\
             [[load]]\non = \"b.{on}\"\npressure = \"{pressure}\"\n"
        );
        let model = Model::new(&parsed(kind, &text)).unwrap();
        let along = model.mesh.dimension - 1;
        let forces = forces(&model);
        let sum = |arm: &dyn Fn([f64; 3]) -> f64| -> f64 {
            let own = forces.iter().filter(|(_, axis, _)| *axis == along);
            own.map(|(node, _, force)| force * arm(model.mesh.point(*node)))
                .sum()
        };
        [sum(&|_| 1.0), sum(&|x| x[0])]
    };
    let near =
        |found: f64, exact: f64| assert!((found - exact).abs() < 1e-12 * 10.0, "{found} {exact}");
    let block = "block = { x = [1.0, 3.0], y = [0.0, 1.0], elements = [3, 1] }";
    for element in ["quad4", "quad8", "tri3", "tri6"] {
        // Pressure 2 + x: int_1^3 (2 + x) dx = 8, with the arm x 16 + 2/3.
        let [force, moment] = of("plane_strain", element, block, "top", "2 + x");
        near(force, -8.0);
        near(moment, -(8.0 + 26.0 / 3.0));
        let [force, _] = of("axisymmetric", element, block, "top", "r");
        near(force, -2.0 * std::f64::consts::PI * 26.0 / 3.0);
    }
    for element in ["hex8", "hex20"] {
        let brick = "brick = { x = [1, 3], y = [0, 1], z = [0, 1], elements = [2, 2, 1] }";
        let [force, moment] = of("solid", element, brick, "top", "x + 2*y");
        // int x + 2 y over [1, 3] x [0, 1] = 4 + 2.
        near(force, -6.0);
        near(moment, -(26.0 / 3.0 + 4.0));
    }
}

/// Values at nodes are what lies between them by the shape functions: those of a linear pressure
/// are its formula.
#[test]
fn values_at_nodes_are_the_formula() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |pressure: &str| {
        format!(
            "kind = \"plane_strain\"\n[[mesh.parts]]\nbody = \"b\"\nelement = \"quad8\"\n\
             block = {{ x = [0.0, 2.0], y = [0.0, 1.0], elements = [3, 2] }}\n\
             [materials.m]\nyoungs_modulus = 1.0\npoissons_ratio = 0.3\n\
             [bodies]\nb = {{ material = \"m\" }}\n\
             [[support]]\non = \"b.bottom\"\nfix = [\"x\", \"y\"]\n\
             [[load]]\non = \"b.top\"\npressure = {pressure}\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
        )
    };
    let load = |name: &str, pressure: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, scene(pressure)).unwrap();
        Model::new(&Scene::load(&path).unwrap())
    };
    let by_formula = load("formula.toml", "\"3 - x + y\"").unwrap();
    let values = |mesh: &brinell::mesh::Mesh, count: usize| {
        let rows = (0..count).map(|node| {
            let [x, y, _] = mesh.point(node);
            format!("{} {:?}\n", mesh.node_label(node), 3.0 - x + y)
        });
        let rows: String = rows.collect();
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n1\n\"pressure\"\n1\n0.0\n3\n0\n1\n\
             {count}\n{rows}$EndNodeData\n"
        )
    };
    let mesh = &by_formula.mesh;
    let file = folder.path().join("values.msh");
    std::fs::write(&file, values(mesh, mesh.n_nodes())).unwrap();
    let by_values = load("values.toml", "{ file = \"values.msh\" }").unwrap();
    assert_eq!(by_formula.loads[0].magnitude, 4.0);
    let [found, exact] = [&by_values, &by_formula].map(|model| model.loads[0].magnitude);
    assert!((found - exact).abs() < 1e-14, "{found} {exact}");
    for (found, exact) in forces(&by_values).iter().zip(forces(&by_formula)) {
        assert_eq!((found.0, found.1), (exact.0, exact.1));
        assert!((found.2 - exact.2).abs() < 1e-14, "{found:?} {exact:?}");
    }
    // A file that ends early.
    std::fs::write(&file, values(mesh, 1)).unwrap();
    let error = load("values.toml", "{ file = \"values.msh\" }").unwrap_err();
    for part in ["load 1 on `b.top`", "has no value of node", "another mesh"] {
        assert!(error.message().contains(part), "{error}");
    }
}

/// The half of a half plane, or of what lies on it, with its surface finely meshed round `x = 0`:
/// sixty half widths of contact, so that what the sides hold back is a share of 1/120.
fn half(body: &str, y: [f64; 2], bias: f64) -> String {
    let [from, to] = y;
    format!(
        "[[mesh.parts]]\nbody = \"{body}\"\nelement = \"quad8\"\n\
         block = {{ x = [0.0, 60.0], y = [{from:?}, {to:?}], elements = [26, 18], \
         bias = [120.0, {bias:?}] }}\n"
    )
}

/// Two flat blocks whose gap is stated as `x^2/(2 R)` are Hertz's line contact: half width and
/// pressure to what this mesh shows (five elements in the half width).
#[test]
fn a_gap_by_formula_is_a_line_contact() {
    let (young, nu) = STEEL;
    let modulus = 0.5 * young / (1.0 - nu * nu);
    let radius = 50.0;
    let line = HertzLine::new(radius, modulus).unwrap();
    let load = line.load_for_half_width(1.0);
    let text = format!(
        "symmetry = 2\n{}{}\
         [[contact]]\nfirst = \"u.bottom\"\nsecond = \"b.top\"\ngap = \"x^2 / (2 * {radius:?})\"\n\
         [[support]]\non = \"b.left\"\nfix = [\"x\"]\n\
         [[support]]\non = \"u.left\"\nfix = [\"x\"]\n\
         [[support]]\non = \"b.bottom\"\nfix = [\"y\"]\n\
         [[load]]\non = \"u.top\"\nplane_force = {{ direction = \"y\", total = {:?} }}\n",
        half("b", [-60.0, 0.0], 1.0 / 120.0),
        half("u", [0.0, 60.0], 120.0),
        -load
    );
    let results = run(&parsed_two(&text));
    let state = &results.states[0];
    let [p0, b] = [line.max_pressure(load), line.half_width(load)];
    assert!(
        (state.max_pressure / p0 - 1.0).abs() < 0.02,
        "{} {p0}",
        state.max_pressure
    );
    assert!(
        (state.half_width / b - 1.0).abs() < 0.03,
        "{} {b}",
        state.half_width
    );
    assert!((state.contact_force / load - 1.0).abs() < 1e-9);
}

fn parsed_two(text: &str) -> Scene {
    let (young, poisson) = STEEL;
    let text = format!(
        "kind = \"plane_strain\"\n{text}\
         [materials.m]\nyoungs_modulus = {young:?}\npoissons_ratio = {poisson:?}\n\
         [bodies]\nb = {{ material = \"m\" }}\nu = {{ material = \"m\" }}\n\
         [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
    );
    parse(&text)
}

/// Hertz's pressure as a load: the difference of the stresses below it is that of the contact.
#[test]
fn a_pressure_by_formula_is_that_of_a_contact() {
    let line = HertzLine::new(1.0, 1.0).unwrap();
    let (load, p0) = (
        line.load_for_half_width(1.0),
        line.max_pressure(line.load_for_half_width(1.0)),
    );
    let text = format!(
        "symmetry = 2\n{}\
         [[support]]\non = \"b.left\"\nfix = [\"x\"]\n\
         [[support]]\non = \"b.bottom\"\nfix = [\"y\"]\n\
         [[load]]\non = \"b.top\"\npressure = \"{p0:?} * sqrt(max(0, 1 - x^2))\"\n",
        half("b", [-60.0, 0.0], 1.0 / 120.0)
    );
    let scene = parsed("plane_strain", &text);
    let results = run(&scene);
    let mesh = &Model::new(&scene).unwrap().mesh;
    let fields = results.states[0].fields.as_ref().unwrap();
    let mut compared = 0;
    for (element, stress) in fields.stress.chunks(4).enumerate() {
        let nodes = mesh.nodes(element);
        let n = nodes.len() as f64;
        let mean = |d: usize| {
            nodes
                .iter()
                .map(|i| mesh.point(*i as usize)[d])
                .sum::<f64>()
                / n
        };
        let [x, z] = [mean(0), -mean(1)];
        // Where an element's mean is the stress in its middle.
        if !(0.3..1.5).contains(&z) || x > 1.5 {
            continue;
        }
        let [sxx, _, szz, sxz] = line.stress(x, z, load, STEEL.1);
        let found = [stress[0] - stress[1], stress[3]];
        for (found, exact) in found.into_iter().zip([sxx - szz, -sxz]) {
            assert!(
                (found - exact).abs() < 0.02 * p0,
                "{x} {z}: {found} {exact}"
            );
        }
        compared += 1;
    }
    assert!(compared > 10, "{compared}");
}

/// A block under one that hardly gives, overlapping by a formula: its top follows the formula at
/// every node, of quadratic faces too, whose freedoms are those of control points. Nodes face each
/// other, or not.
#[test]
fn interference_by_formula_moves_every_node_by_it() {
    for (element, upper) in [("hex20", 3), ("hex20", 2), ("hex8", 3)] {
        let of = |contact: &str, load: &str| {
            let text = format!(
                r#"
kind = "solid"
contact = [{{ first = "u.bottom", second = "b.top", {contact} }}]
support = [
    {{ on = "b.bottom", fix = ["x", "y", "z"] }}, {{ on = "u.top", fix = ["x", "y", "z"] }},
]
load = [{load}]
[[mesh.parts]]
body = "u"
element = "{element}"
brick = {{ x = [0, 1], y = [0, 1], z = [1, 2], elements = [{upper}, {upper}, 1] }}
[[mesh.parts]]
body = "b"
element = "{element}"
brick = {{ x = [0, 1], y = [0, 1], z = [0, 1], elements = [3, 3, 2] }}
[materials]
m = {{ youngs_modulus = 1.0, poissons_ratio = 0.3 }}
hard = {{ youngs_modulus = 1e9, poissons_ratio = 0.3 }}
[bodies]
b = {{ material = "m" }}
u = {{ material = "hard" }}
[program]
targets = [{{ load_factor = 1.0 }}]
"#
            );
            let scene = parse(&text);
            (Model::new(&scene).unwrap(), run(&scene))
        };
        let formula = "\"0.01 + 0.004*x^2 + 0.002*x*y\"";
        let stated = of(&format!("interference = {formula}"), "");
        let driven = of(
            "",
            &format!(
                "{{ on = \"u.bottom\", gap = \"-({})\" }}",
                &formula[1..formula.len() - 1]
            ),
        );
        for (model, results) in [stated, driven] {
            let found = displacement(&results);
            for node in model.mesh.set_nodes("b.top").unwrap() {
                let [x, y, _] = model.mesh.point(node);
                let exact = -(0.01 + 0.004 * x * x + 0.002 * x * y);
                let own = found[3 * node + 2];
                assert!(
                    (own - exact).abs() < 1e-7,
                    "{element} {upper} {x} {y}: {own} {exact}"
                );
            }
        }
    }
}
