//! A scene as a deck of CalculiX: the same mesh, materials, supports and load history; contact
//! surface to surface with a linear penalty.

use brinell::mesh::Shape;
use brinell::model::Model;
use brinell::scene::{Direction, Field, Kind};
use std::fmt::Write;

/// What a deck needs beside the scene.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// Pressure per penetration.
    pub penalty: f64,
    /// How far the first body is moved into the second, so that something touches at the beginning.
    pub overlap: f64,
    /// Increments of a leg.
    pub increments: usize,
    /// `SURFACE TO SURFACE` or `NODE TO SURFACE`.
    pub kind: &'static str,
    /// Name of a solver; empty for the default.
    pub solver: &'static str,
}

/// The deck: one step for each load factor of the legs.
///
/// # Errors
/// Where the scene holds what no deck is made of here: other elements than quad4, several contacts
/// or loads.
pub fn deck(model: &Model, settings: &Settings, legs: &[f64]) -> Result<String, String> {
    let (mesh, scene) = (&model.mesh, &model.scene);
    let element_type = match (scene.kind, mesh.shapes[0]) {
        (Kind::PlaneStrain, Shape::Quad4) => "CPE4",
        (Kind::PlaneStress, Shape::Quad4) => "CPS4",
        (Kind::Axisymmetric, Shape::Quad4) => "CAX4",
        (Kind::Solid, Shape::Hex8) => "C3D8",
        (Kind::Solid, Shape::Hex20) => "C3D20R",
        (_, shape) => return Err(format!("a deck is not made of {}", shape.name())),
    };
    // The overlap is along the axis that the bodies are pressed together by.
    let up = mesh.dimension - 1;
    let axis = |direction: Direction| match direction {
        Direction::X => 1,
        Direction::Y => 2,
        Direction::Z => 3,
    };
    let [contact] = &scene.contact[..] else {
        return Err("a deck is made of scenes with one contact".into());
    };
    let moved = contact.first.split('.').next().unwrap_or_default();
    let moved = mesh.bodies.iter().position(|body| body == moved);
    let mut is_moved = vec![false; mesh.n_nodes()];
    for element in 0..mesh.n_elements() {
        if mesh.shapes[element] != mesh.shapes[0] {
            return Err("a deck is made of elements of one shape".into());
        }
        for &node in mesh.nodes(element) {
            is_moved[node as usize] = Some(mesh.element_body[element] as usize) == moved;
        }
    }
    let mut text = String::new();
    let mut say = |line: String| {
        let _ = writeln!(text, "{line}");
    };
    say("*NODE, NSET=NALL".into());
    for node in 0..mesh.n_nodes() {
        let mut x = mesh.point(node);
        if is_moved[node] {
            x[up] -= settings.overlap;
        }
        let [x, y, z] = x;
        say(format!("{}, {x:.12e}, {y:.12e}, {z:.12e}", node + 1));
    }
    for (body, name) in mesh.bodies.iter().enumerate() {
        say(format!(
            "*ELEMENT, TYPE={element_type}, ELSET=B{body}\n** {name}"
        ));
        for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body) {
            let nodes: Vec<String> = mesh
                .nodes(element)
                .iter()
                .map(|n| (n + 1).to_string())
                .collect();
            // No more than sixteen numbers fit on a line.
            let lines: Vec<String> = nodes.chunks(10).map(|n| n.join(", ")).collect();
            say(format!("{}, {}", element + 1, lines.join(",\n")));
        }
    }
    for (name, surface) in [("SLAVE", &contact.first), ("MASTER", &contact.second)] {
        let surface = mesh.surfaces.get(surface).ok_or("no such surface")?;
        say(format!("*SURFACE, NAME={name}, TYPE=ELEMENT"));
        for facet in &surface.facets {
            say(format!("{}, S{}", facet.element + 1, facet.local + 1));
        }
    }
    for (body, name) in mesh.bodies.iter().enumerate() {
        let material = &scene.materials[&scene.bodies[name].material];
        say(format!(
            "*MATERIAL, NAME=M{body}\n*ELASTIC\n{:e}, {:e}",
            material.youngs_modulus, material.poissons_ratio
        ));
        if let (Some(stress), true) = (material.yield_stress, model.may_yield[body]) {
            let slope = material
                .plastic_modulus_resolved()
                .ok_or("a table of hardening")?;
            say(format!(
                "*PLASTIC\n{stress:e}, 0.\n{:e}, 1.",
                stress + slope
            ));
        }
        say(format!(
            "*SOLID SECTION, ELSET=B{body}, MATERIAL=M{body}\n1."
        ));
    }
    say(format!(
        "*SURFACE INTERACTION, NAME=FRICTIONLESS\n*SURFACE BEHAVIOR, \
         PRESSURE-OVERCLOSURE=LINEAR\n{:e}\n*CONTACT PAIR, INTERACTION=FRICTIONLESS, \
         TYPE={}\nSLAVE, MASTER",
        settings.penalty, settings.kind
    ));
    say("*BOUNDARY".into());
    for support in &scene.support {
        for node in mesh.set_nodes(&support.on).ok_or("no such set")? {
            for direction in &support.fix {
                let d = axis(*direction);
                say(format!("{}, {d}, {d}", node + 1));
            }
        }
    }
    let [load] = &scene.load[..] else {
        return Err("a deck is made of scenes with one load".into());
    };
    let nodes = mesh.set_nodes(&load.on).ok_or("no such set")?;
    let applied: Box<dyn Fn(f64) -> String> = match (load.plane_force, &load.displacement) {
        (Some(force), _) => {
            let d = axis(force.direction);
            let leader = nodes[0] + 1;
            say("*EQUATION".into());
            for node in &nodes[1..] {
                say(format!("2\n{}, {d}, 1., {leader}, {d}, -1.", node + 1));
            }
            let share = force.total / model.symmetry;
            Box::new(move |alpha| format!("*CLOAD\n{leader}, {d}, {:.12e}", alpha * share))
        }
        (_, Some(displacement)) => {
            let y = displacement.y.as_ref().and_then(Field::uniform);
            let y = y.ok_or("a displacement in y")?;
            let overlap = settings.overlap;
            Box::new(move |alpha| {
                let lines = nodes
                    .iter()
                    .map(|n| format!("\n{}, 2, 2, {:.12e}", n + 1, alpha * y + overlap));
                format!("*BOUNDARY{}", lines.collect::<String>())
            })
        }
        _ => {
            // The consistent forces of brinell's own assembly.
            let forces: Vec<(u32, u8, f64)> = model.loads[0]
                .forces
                .iter()
                .map(|&(freedom, force)| {
                    let (node, direction) = model.freedoms.owners[freedom];
                    (node, direction, force)
                })
                .collect();
            if forces
                .iter()
                .any(|f| model.freedoms.is_turned(f.0 as usize))
            {
                return Err("a deck is made of loads in global axes".into());
            }
            Box::new(move |alpha| {
                let lines = forces
                    .iter()
                    .map(|(n, d, f)| format!("\n{}, {}, {:.12e}", n + 1, d + 1, alpha * f));
                format!("*CLOAD{}", lines.collect::<String>())
            })
        }
    };
    let step = 1.0 / settings.increments as f64;
    let solver = match settings.solver {
        "" => String::new(),
        name => format!(", SOLVER={name}"),
    };
    for &alpha in legs {
        say(format!(
            "*STEP, INC=1000\n*STATIC{solver}\n{step}, 1., 1e-6, {step}\n{}\n*NODE FILE\nU\n\
             *CONTACT FILE\nCDIS, CSTR\n*END STEP",
            applied(alpha)
        ));
    }
    Ok(text)
}
