//! Cases in three dimensions.

use super::cases::{CaseFamily, Cases, results, scene, worst_quality};
use crate::analytical::{HertzEllipse, contact_modulus};
use crate::error::{Error, Result};
use crate::results::{Results, State};
use crate::scene::{Direction, Extrusion, Scene, Support, Target};
use crate::space::Space;

pub(super) const FAMILIES: &[CaseFamily] = &[
    CaseFamily {
        name: "Hertz in three dimensions",
        figure: "pressure at first yield of a circle and a 2:1 ellipse",
        bound: 0.3 / 9.0,
        source: "Johnson 4.2, the von Mises maximum by quadrature; 3 elements over the smaller \
                 half axis, 0.3 h^2",
        cases: hertz,
    },
    CaseFamily {
        name: "plane strain drawn out",
        figure: "force, pressure, approach, dent and plastic strain of a solid against its section",
        bound: 1e-8,
        source: "hex8 over a prism is quad4 over its section; forces balance to 1e-10, a hundred \
                 times that in displacements",
        cases: drawn_out,
    },
    CaseFamily {
        name: "solids far apart in stiffness and shape",
        figure: "uniform pressure: ratios 1e-8 to 1e8, elements 1:1000, nu 0.4999, hex8 and hex20",
        bound: 1e9 * f64::EPSILON,
        source: "eps times the condition 1e6 (the square of the aspect ratio) times the elements \
                 in a row; it does not know the ratio",
        cases: uniform,
    },
];

fn hertz(cases: &mut Cases) -> Result<()> {
    let modulus = contact_modulus(210e3, 0.3, 210e3, 0.3);
    for (text, upper, lower) in [
        (
            include_str!("../../data/scenes/ball_on_flat_3d.toml"),
            [10.0, 10.0],
            [0.0, 0.0],
        ),
        (
            include_str!("../../data/scenes/crossed_cylinders.toml"),
            [0.0, 4.0],
            [12.0, 0.0],
        ),
    ] {
        let mut pressed = scene(text)?;
        if let Some(mesh) = &mut pressed.mesh.curved_bodies {
            mesh.resolution = 3;
        }
        pressed.program.targets = vec![Target {
            first_yield: true,
            ..Target::default()
        }];
        let run = results(&pressed)?;
        let radii = HertzEllipse::relative_radii(upper, lower)?;
        let exact = HertzEllipse::new(radii, modulus)?.yield_pressure(0.3, 500.0);
        let first = run.first_yield.map_or(f64::NAN, |first| first.max_pressure);
        cases.add(first / exact - 1.0);
    }
    Ok(())
}

/// A function that returns a figure of a state.
type StateFigure = fn(&State) -> f64;

/// Returns a plane scene extruded over a depth between planes of symmetry.
fn solid_of(plane: &Scene, depth: f64) -> Scene {
    let mut solid = plane.clone();
    solid.kind = Space::Solid;
    solid.mesh.extrude = Some(Extrusion { depth, elements: 1 });
    for body in plane.bodies.keys() {
        for end in ["front", "back"] {
            solid.support.push(Support {
                on: format!("{body}.{end}"),
                fix: vec![Direction::Z],
                ..Support::default()
            });
        }
    }
    for force in solid.load.iter_mut().filter_map(|l| l.plane_force.as_mut()) {
        force.total *= depth;
    }
    solid
}

fn drawn_out(cases: &mut Cases) -> Result<()> {
    let depth = 0.25;
    let mut plane = scene(include_str!("../../data/scenes/hard/unload_reload.toml"))?;
    plane.program.unit = crate::scene::Unit::Load;
    for target in &mut plane.program.targets {
        target.load_factor = target.load_factor.map(|factor| 0.1 * factor);
    }
    plane.program.targets.retain(|target| !target.first_yield);
    let (one, other) = (results(&plane)?, results(&solid_of(&plane, depth))?);
    if one.states.len() != other.states.len() || one.states.is_empty() {
        return Err(Error::analysis("a state was not reached"));
    }
    let largest = |run: &Results, of: StateFigure| {
        let values = run.states.iter().map(of);
        values.fold(0.0f64, |m, v| m.max(v.abs()))
    };
    let figures: [(StateFigure, f64); 5] = [
        (|s| s.contact_force, depth),
        (|s| s.max_pressure, 1.0),
        (|s| s.approach, 1.0),
        (|s| s.residual_depth, 1.0),
        (|s| s.max_equivalent_plastic_strain, 1.0),
    ];
    if largest(&one, |s| s.max_equivalent_plastic_strain) == 0.0 {
        return Err(Error::analysis("nothing has yielded"));
    }
    let approach = largest(&one, |s| s.approach);
    for (a, b) in one.states.iter().zip(&other.states) {
        for (k, (of, unit)) in figures.into_iter().enumerate() {
            // The error of a dent is relative to the approach, because a dent is a difference of
            // displacements.
            let scale = if k == 3 { approach } else { largest(&one, of) };
            cases.add((of(b) / unit - of(a)) / scale);
        }
    }
    Ok(())
}

/// Returns a scene of two bricks on one another, of which a quarter is modelled.
fn bricks(element: &str, elements: [usize; 3], nu: f64, ratio: f64) -> Result<Scene> {
    let held: String = ["lower.left", "upper.left"]
        .map(|on| format!("{{ on = \"{on}\", fix = [\"x\"] }},"))
        .concat()
        + &["lower.front", "upper.front"]
            .map(|on| format!("{{ on = \"{on}\", fix = [\"y\"] }},"))
            .concat();
    let brick =
        |z: &str| format!("brick = {{ x = [0, 1], y = [0, 1], z = {z}, elements = {elements:?} }}");
    scene(&format!(
        r#"
kind = "solid"
symmetry = 4
support = [{held} {{ on = "lower.bottom", fix = ["z"] }}]
contact = [{{ first = "upper.bottom", second = "lower.top" }}]
load = [{{ on = "upper.top", pressure = 10.0 }}]
program.targets = [{{ load_factor = 1.0 }}]
[[mesh.parts]]
body = "lower"
element = "{element}"
{}
[[mesh.parts]]
body = "upper"
element = "{element}"
{}
[materials.lower]
youngs_modulus = 1000.0
poissons_ratio = {nu}
[materials.upper]
youngs_modulus = {}
poissons_ratio = {nu}
[bodies]
lower = {{ material = "lower" }}
upper = {{ material = "upper" }}
"#,
        brick("[-1, 0]"),
        brick("[0, 1]"),
        1000.0 * ratio,
    ))
}

fn uniform(cases: &mut Cases) -> Result<()> {
    for (element, elements, nu, ratio) in [
        ("hex8", [3, 3, 3], 0.3, 1.0),
        ("hex8", [3, 3, 3], 0.3, 1e8),
        ("hex8", [3, 3, 3], 0.3, 1e-8),
        ("hex8", [3, 3, 3], 0.4999, 1.0),
        ("hex8", [1, 1000, 1], 0.3, 1.0),
        ("hex8", [1, 1, 1000], 0.3, 1.0),
        ("hex20", [2, 2, 2], 0.4999, 1.0),
        ("hex20", [2, 2, 2], 0.3, 1e8),
        ("hex20", [2, 2, 2], 0.3, 1e-8),
    ] {
        let run = results(&bricks(element, elements, nu, ratio)?)?;
        for pair in run.states.iter().flat_map(|s| &s.pairs) {
            cases.add(pair.pressure / 10.0 - 1.0);
        }
        cases.add(worst_quality(&run));
    }
    Ok(())
}
