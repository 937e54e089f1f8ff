//! The load of a run that displacements drive is the force that moves what they prescribe,
//! whatever lies between: that of the stresses at its nodes, and the one by which the same state is
//! reached.

use crate::support::random::Random;
use crate::support::{either, parse, run, run_text, run_with_model};
use brinell::results::State;
use brinell::scene::Scene;

/// A structure that is pressed along its last axis.
struct Pressed {
    kind: &'static str,
    /// Bodies, contacts and supports.
    text: String,
    /// What is moved.
    on: &'static str,
    /// How far, for strains of one per cent.
    by: f64,
}

impl Pressed {
    fn axis(&self) -> &'static str {
        if self.kind == "solid" { "z" } else { "y" }
    }

    fn body(&self) -> &str {
        self.on.split('.').next().unwrap()
    }

    /// The scene with a load, with the materials of bodies that may yield at a stress.
    fn scene(&self, load: &str, yield_stress: Option<f64>, targets: &str) -> Scene {
        let plastic = yield_stress.map_or(String::new(), |stress| {
            format!("yield_stress = {stress:?}\nplastic_modulus = 50.0\n")
        });
        let text = format!(
            "kind = \"{}\"\nsymmetry = 2\n{}\n[materials.metal]\nyoungs_modulus = 1000.0\n\
             poissons_ratio = 0.3\nthermal_expansion = 1e-5\ndensity = 1.0\n{plastic}{load}\n\
             [program]\ntargets = {targets}\n",
            self.kind, self.text
        );
        parse(&text)
    }

    fn displacement(&self, by: f64) -> String {
        let axis = self.axis();
        format!(
            "[[load]]\non = \"{}\"\ndisplacement = {{ {axis} = {by:?} }}",
            self.on
        )
    }
}

/// Blocks of unlike widths and meshes on one another.
fn stack(kind: &'static str, random: &mut Random) -> Pressed {
    let n = 1 + random.below(3);
    let mut text = String::new();
    for i in 0..n {
        let width = random.within(0.6, 1.5);
        let [a, b] = [1, 1].map(|least| least + random.below(4));
        let shape = match kind {
            "solid" => format!(
                "element = \"{}\"\nbrick = {{ x = [0, {width:?}], y = [0, 1], z = [{i}, {}], \
                 elements = [{a}, 1, {b}] }}",
                random.one_of(&["hex8", "hex20"]),
                i + 1
            ),
            _ => format!(
                "element = \"{}\"\nblock = {{ x = [0, {width:?}], y = [{i}, {}], \
                 elements = [{a}, {b}] }}",
                random.one_of(&["quad4", "quad8"]),
                i + 1
            ),
        };
        text += &format!(
            "[[mesh.parts]]\nbody = \"b{i}\"\n{shape}\n[bodies.b{i}]\nmaterial = \"metal\"\n"
        );
        let mut sides = vec![("left", "x")];
        if kind == "solid" {
            sides.push(("front", "y"));
        }
        if kind != "axisymmetric" {
            for (side, axis) in sides {
                text += &format!("[[support]]\non = \"b{i}.{side}\"\nfix = [\"{axis}\"]\n");
            }
        }
        if i > 0 {
            text += &format!(
                "[[contact]]\nfirst = \"b{i}.bottom\"\nsecond = \"b{}.top\"\n",
                i - 1
            );
        }
    }
    let axis = if kind == "solid" { "z" } else { "y" };
    text += &format!("[[support]]\non = \"b0.bottom\"\nfix = [\"{axis}\"]\n");
    Pressed {
        kind,
        text,
        on: ["b0.top", "b1.top", "b2.top"][n - 1],
        by: -0.01 * n as f64,
    }
}

/// A segment of a ring in a hollow: the pressures of both flanks work against one another.
fn hollow(kind: &'static str, random: &mut Random) -> Pressed {
    let half = random.within(20.0, 80.0);
    let [a, b] = [2, 2].map(|least| least + random.below(4));
    let ring = |body: &str, radius: &str| {
        format!(
            "[[mesh.parts]]\nbody = \"{body}\"\nring = {{ radius = {radius}, angle = [{:?}, {:?}], \
             elements = [{a}, {}] }}\n[bodies.{body}]\nmaterial = \"metal\"\n",
            270.0 - half,
            270.0 + half,
            4 * b
        )
    };
    let text = ring("inner", "[5.0, 10.0]")
        + &ring("outer", "[10.0, 15.0]")
        + "[[contact]]\nfirst = \"inner.outer\"\nsecond = \"outer.inner\"\n\
           [[support]]\non = \"outer.outer\"\nfix = [\"x\", \"y\"]\n\
           [[support]]\non = \"inner.inner\"\nfix = [\"x\"]\n";
    Pressed {
        kind,
        text,
        on: "inner.inner",
        by: -0.1,
    }
}

fn pressed(random: &mut Random) -> Pressed {
    let kind = random.one_of(&["plane_strain", "plane_stress", "axisymmetric", "solid"]);
    match kind {
        "plane_strain" | "plane_stress" if random.share() < 0.5 => hollow(kind, random),
        _ => stack(kind, random),
    }
}

/// Sum of the forces that the stresses exert on what is moved, along its displacement.
fn of_stresses(scene: &Scene, on: &str) -> (State, f64) {
    let (model, results) = run_with_model(scene);
    let mesh = &model.mesh;
    let state = results.states.last().unwrap().clone();
    assert_eq!(state.load, results.history.last().unwrap().load);
    let force = &state.fields.as_ref().unwrap().force;
    let d = mesh.dimension;
    let nodes = mesh.set_nodes(on).unwrap();
    let sum: f64 = nodes.iter().map(|&node| force[d * node + d - 1]).sum();
    (state, -2.0 * sum)
}

/// Elastic and plastic, where bodies are warm and heavy, too. The forces of the stresses are in
/// balance to the tolerance of the plastic iteration, 1e-8.
#[test]
fn the_load_of_a_displacement_is_the_force_of_the_stresses() {
    let mut yielded = 0;
    for seed in 0..either(24, 200) {
        let random = &mut Random::new(seed);
        let model = pressed(random);
        let yields = (seed % 2 == 0).then_some(random.within(2.0, 8.0));
        let mut load = model.displacement(model.by);
        if seed % 3 == 0 {
            let body = model.body();
            load +=
                &format!("\n[[load]]\non = \"{body}\"\ntemperature = 20.0\nhistory = \"constant\"");
        }
        let (state, force) = of_stresses(&model.scene(&load, yields, TO_THE_END), model.on);
        yielded += usize::from(state.plastic_points > 0);
        let off = (state.load / force - 1.0).abs();
        assert!(off < 1e-7, "{seed}: {} {force}", state.load);
    }
    assert!(yielded > 5);
}

const TO_THE_END: &str = "[{ load_factor = 1.0 }]";

/// Elastic, so that states do not depend on the way to them: a force that keeps its surface plane,
/// and the displacement that it finds.
#[test]
fn a_state_has_the_same_load_by_force_and_by_displacement() {
    for seed in 0..either(24, 200) {
        let random = &mut Random::new(1000 + seed);
        let model = pressed(random);
        let (on, axis) = (model.on, model.axis());
        let constant = |on: &str, key: &str, size: f64| {
            let along = match axis {
                "z" => format!("[0.0, 0.0, {size:?}]"),
                _ => format!("[0.0, {size:?}]"),
            };
            format!("\n[[load]]\non = \"{on}\"\n{key} = {along}\nhistory = \"constant\"")
        };
        let other = match seed % 3 {
            0 => constant(on, "traction", -0.3),
            1 => constant(model.body(), "acceleration", -0.05),
            _ => String::new(),
        };
        let by_force = format!(
            "[[load]]\non = \"{on}\"\n\
             plane_force = {{ direction = \"{axis}\", total = -7.0 }}{other}"
        );
        let pressed = run(&model.scene(&by_force, None, TO_THE_END));
        let expected = &pressed.states[0];
        assert_eq!(expected.load, 7.0);
        let load = model.displacement(-expected.approach) + &other;
        let found = run(&model.scene(&load, None, TO_THE_END));
        let off = (found.states[0].load / 7.0 - 1.0).abs();
        assert!(off < 1e-9, "{seed}: {}", found.states[0].load);
    }
}

/// A wedge between held blocks passes the same force on through both contacts.
#[test]
fn the_load_of_a_gap_is_the_force_of_its_contact() {
    let mut text = String::from("kind = \"plane_strain\"\n");
    for i in 0..3 {
        text += &format!(
            "[[mesh.parts]]\nbody = \"b{i}\"\n\
             block = {{ x = [0, 1], y = [{i}, {}], elements = [2, 2] }}\n\
             [bodies.b{i}]\nmaterial = \"metal\"\n[[support]]\non = \"b{i}.left\"\nfix = [\"x\"]\n",
            i + 1
        );
    }
    text += "[[contact]]\nfirst = \"b1.bottom\"\nsecond = \"b0.top\"\n\
             [[contact]]\nfirst = \"b2.bottom\"\nsecond = \"b1.top\"\n\
             [[support]]\non = \"b0.bottom\"\nfix = [\"y\"]\n\
             [[support]]\non = \"b2.top\"\nfix = [\"y\"]\n\
             [materials.metal]\nyoungs_modulus = 1000.0\npoissons_ratio = 0.0\n\
             [[load]]\non = \"b1.bottom\"\ngap = -0.03\n\
             [program]\ntargets = [{ load_factor = 1.0 }]\n";
    let results = run_text(&text);
    let state = &results.states[0];
    // Three blocks in a row of the length 3, shortened by the wedge: E * 0.03 / 3.
    assert!((state.load - 10.0).abs() < 1e-10, "{}", state.load);
    assert!((state.contact_force - 20.0).abs() < 1e-10);
}
