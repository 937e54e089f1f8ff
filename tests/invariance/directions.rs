//! Supports along directions of each node's own: freedoms lie along them, whatever else acts.
//!
//! A support along a unit vector `n` is the equation `n . u = 0`. Written as a support it turns
//! the freedoms of the node; written as `[[equation]]` one displacement follows the others. Results
//! are in global axes and agree to round-off; a support costs no solve.

use crate::support::grid::Grid;
use crate::support::random::Random;
use crate::support::{close, either, largest, parse, run_on};
use brinell::mesh::{Mesh, Shape};
use brinell::model::{Model, ModelBuilder};
use brinell::results::{Fields, Results};
use brinell::scene::{Direction, Equation, EquationTerm, Kind, Scene, Support};
use std::collections::BTreeMap;

type Vector = [f64; 3];

const PLANE: [Shape; 4] = [Shape::Quad4, Shape::Quad8, Shape::Tri3, Shape::Tri6];
const SOLID: [Shape; 6] = [
    Shape::Hex8,
    Shape::Hex20,
    Shape::Tet4,
    Shape::Tet10,
    Shape::Prism6,
    Shape::Prism15,
];

/// Surfaces of a part: bottom, top, left, front.
fn surfaces(kind: &str) -> [&'static str; 4] {
    match kind {
        "solid" => ["z0", "z1", "x0", "y0"],
        _ => ["bottom", "top", "left", ""],
    }
}

/// Parts of a plane mesh; those of a solid scene are not used.
fn parts(kind: &str, shape: Shape, two: bool, n: usize) -> String {
    let part = |(name, low): (&str, f64)| {
        let (low, high) = (low, low + 1.0);
        match kind {
            "solid" => format!(
                "[[mesh.parts]]\nbody = \"{name}\"\nbrick = {{ x = [0, 1], y = [0, 1], \
                 z = [{low:?}, {high:?}], elements = [1, 1, 1] }}\n"
            ),
            _ => format!(
                "[[mesh.parts]]\nbody = \"{name}\"\nelement = \"{}\"\n\
                 block = {{ x = [1, 2], y = [{low:?}, {high:?}], elements = [{n}, 2] }}\n",
                shape.name()
            ),
        }
    };
    let all = [("lower", 0.0), ("upper", 1.0)];
    all.into_iter()
        .take(1 + usize::from(two))
        .map(part)
        .collect()
}

/// The mesh: of a solid one of any shape.
fn mesh_of(text: &str, kind: &str, shape: Shape, two: bool, n: usize) -> Mesh {
    if kind != "solid" {
        let held = "[[support]]\non = \"lower.bottom\"\nfix = [\"x\", \"y\"]\n";
        let model = Model::new(&parse(&format!("{text}{held}"))).unwrap();
        return model.mesh.clone();
    }
    let mut builder = ModelBuilder::new(Kind::Solid);
    let mut conditions =
        String::from("[materials.m]\nyoungs_modulus = 2e5\npoissons_ratio = 0.3\n[bodies]\n");
    for (name, low) in [("lower", 0.0), ("upper", 1.0)] {
        if name == "lower" || two {
            let map = |[x, y, z]: Vector| [x, y, low + z];
            let cells = [n, 1, 2];
            Grid {
                name,
                cells,
                shape,
                map: &map,
            }
            .add(&mut builder);
            conditions += &format!("{name}.material = \"m\"\n");
        }
    }
    conditions += "[[support]]\non = \"lower.z0\"\nfix = [\"x\", \"y\", \"z\"]\n";
    conditions += "[[load]]\non = \"lower.z1\"\npressure = 1.0\n\
                   [program]\ntargets = [{ load_factor = 1.0 }]\n";
    builder.tables(&conditions).unwrap();
    builder.build().unwrap().mesh.clone()
}

/// A block that yields, heated, pressed by itself or by another on it that does not.
fn text(kind: &str, shape: Shape, two: bool, n: usize, random: &mut Random) -> String {
    let [bottom, top, left, front] = surfaces(kind);
    let mut text = format!("kind = \"{kind}\"\n");
    if two {
        text +=
            &format!("contact = [{{ first = \"upper.{bottom}\", second = \"lower.{top}\" }}]\n");
    }
    text += &parts(kind, shape, two, n);
    let pressed = if two { "upper" } else { "lower" };
    let (pressure, heat) = (random.within(100.0, 350.0), random.within(-60.0, 60.0));
    text += &format!(
        "[[load]]\non = \"{pressed}.{top}\"\npressure = {pressure:?}\n\
         [[load]]\non = \"lower\"\ntemperature = {heat:?}\nhistory = \"constant\"\n\
         [materials.m]\nyoungs_modulus = 2e5\npoissons_ratio = 0.3\nyield_stress = 200.0\n\
         thermal_expansion = 1.2e-5\nplastic_modulus = 2e4\n\
         [bodies]\nlower.material = \"m\"\n"
    );
    if two {
        text += "upper.material = \"m\"\nupper.plastic = false\n";
        // Contact holds it across, this along the faces.
        let sides = [(left, "x"), (front, "y")].into_iter();
        for (side, axis) in sides.filter(|(side, _)| !side.is_empty()) {
            text += &format!("[[support]]\non = \"upper.{side}\"\nfix = [\"{axis}\"]\n");
        }
    }
    text + "[program]\nstepping = \"steps\"\nsteps = 2\n\
            targets = [{ name = \"up\", load_factor = 1.0 }]\n"
}

/// The scene with each node of `held` in a set of its own and held along its direction, as supports
/// and as equations.
fn both(scene: &Scene, mesh: &mut Mesh, held: &BTreeMap<usize, Vector>) -> [Scene; 2] {
    let (mut supports, mut equations) = (scene.clone(), scene.clone());
    let dimension = mesh.dimension;
    for (&node, n) in held {
        let on = format!("held{node}");
        mesh.node_sets.insert(on.clone(), vec![node]);
        supports.support.push(Support {
            on: on.clone(),
            direction: Some(match dimension {
                2 => [n[0], n[1]].into(),
                _ => (*n).into(),
            }),
            ..Support::default()
        });
        // The largest component follows.
        let mut axes: Vec<usize> = (0..dimension).collect();
        axes.sort_by(|a, b| n[*b].abs().total_cmp(&n[*a].abs()));
        let term = |d: usize| EquationTerm {
            on: on.clone(),
            direction: Direction::ALL[d],
            coefficient: n[d],
        };
        let terms = axes.into_iter().map(term).collect();
        equations.equation.push(Equation { terms });
    }
    [supports, equations]
}

fn fields(results: &Results) -> &Fields {
    results.states[0].fields.as_ref().unwrap()
}

#[test]
fn a_support_along_a_node_s_own_direction_is_its_equation() {
    let mut yielded = 0;
    for seed in 1..=either(30, 400) {
        let random = &mut Random::new(seed);
        let kind = random.one_of(&["plane_strain", "plane_stress", "axisymmetric", "solid"]);
        let shape = match kind {
            "solid" => random.one_of(&SOLID),
            _ => random.one_of(&PLANE),
        };
        let two = random.below(2) == 0;
        let n = 2 + random.below(2);
        let text = text(kind, shape, two, n, random);
        let scene = parse(&text);
        let mut mesh = mesh_of(&text, kind, shape, two, n);
        let d = mesh.dimension;
        let bottom = (0..mesh.n_nodes()).filter(|&node| mesh.point(node)[d - 1] == 0.0);
        let held: BTreeMap<usize, Vector> = bottom
            .map(|node| {
                let mut n = [0.0; 3];
                (0..d).for_each(|i| n[i] = random.within(-0.6, 0.6));
                n[d - 1] = 1.0;
                let length = n.iter().map(|n| n * n).sum::<f64>().sqrt();
                (node, n.map(|n| n / length))
            })
            .collect();
        let scenes = both(&scene, &mut mesh, &held);
        let [turned, followed] = scenes.map(|scene| run_on(&scene, mesh.clone()));
        let what = format!("{seed}: {kind}, {shape:?}, {two}");
        let states = [&turned, &followed].map(|results| &results.states[0]);
        yielded += usize::from(states[0].plastic_points > 0);
        assert_eq!(states[0].plastic_points, states[1].plastic_points, "{what}");
        // Both iterate to 1e-10 of the largest force; supports at angles leave the model a
        // condition of some hundred.
        let [a, b] = [&turned, &followed].map(fields);
        for (name, a, b) in [
            ("displacement", &a.displacement, &b.displacement),
            ("stress", &a.stress, &b.stress),
            ("plastic strain", &a.plastic_strain, &b.plastic_strain),
            ("pressure", &a.contact_pressure, &b.contact_pressure),
        ] {
            let scale = largest(a.iter().copied());
            for (a, b) in a.iter().zip(b) {
                close(&format!("{what}: {name}"), *a, *b, scale, 1e-7);
            }
        }
        // Supports are no loads: a few solves for loads, first yield, zones and states.
        assert_eq!(
            turned.counts.full_solves, followed.counts.full_solves,
            "{what}"
        );
        assert!(
            turned.counts.full_solves <= 12,
            "{what}: {:?}",
            turned.counts
        );
        reactions(&what, &turned, &mesh, &held);
    }
    assert!(yielded > 5, "{yielded}");
}

/// What a support does to its node lies along its direction, in global axes.
fn reactions(what: &str, results: &Results, mesh: &Mesh, held: &BTreeMap<usize, Vector>) {
    let (d, force) = (mesh.dimension, &fields(results).force);
    let scale = largest(force.iter().copied());
    assert!(scale > 0.0);
    for (&node, n) in held {
        let own = &force[d * node..d * (node + 1)];
        let along: f64 = own.iter().zip(n).map(|(f, n)| f * n).sum();
        for i in 0..d {
            close(
                &format!("{what}: reaction at {node}"),
                own[i],
                along * n[i],
                scale,
                1e-7,
            );
        }
    }
}
