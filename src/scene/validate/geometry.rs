//! Validation of the mesh source: exactly one is given, with sensible parameters.

use super::parts::{check_element, check_part};
use super::problems::Problems;
use crate::analytical::HertzEllipse;
use crate::number::exact;
use crate::scene::{
    CurvedBodies, CylinderOnHalfPlane, DiscInPlate, LocalRefinement, MeshSource, Scene,
};
use crate::space::{Space, length};
use std::collections::BTreeSet;

pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    let mesh = &scene.mesh;
    let section = mesh.section(scene.kind);
    problems.exactly_one(
        "mesh",
        "mesh source",
        &[
            (
                "cylinder_on_half_plane",
                mesh.cylinder_on_half_plane.is_some(),
            ),
            ("disc_in_plate", mesh.disc_in_plate.is_some()),
            ("curved_bodies", mesh.curved_bodies.is_some()),
            ("parts", mesh.parts.is_some()),
            ("file", mesh.file.is_some()),
        ],
    );
    if let Some(parameters) = &mesh.cylinder_on_half_plane {
        check_cylinder_on_half_plane(problems, parameters, scene);
    }
    if let Some(parameters) = &mesh.disc_in_plate {
        check_disc_in_plate(problems, parameters, section);
    }
    if let Some(parameters) = &mesh.curved_bodies {
        check_curved_bodies(problems, parameters, scene);
    }
    if let Some(parts) = &mesh.parts {
        problems.require(
            !parts.is_empty(),
            "mesh.parts",
            "is empty; give at least one part",
        );
        for (index, part) in parts.iter().enumerate() {
            check_part(problems, &format!("mesh.parts.{index}"), part, section);
        }
    }
    if let Some(file) = &mesh.file {
        problems.require(
            !file.as_os_str().is_empty(),
            "mesh.file",
            "is empty; give the path of a Gmsh file or a deck, relative to the scene file",
        );
    }
    problems.require(
        mesh.file.is_some() || mesh.subdivisions == 0,
        "mesh.subdivisions",
        "is for meshes from a file; give the generator more elements instead",
    );
    check_declared_shapes(problems, mesh);
    for (index, refinement) in mesh.refine.iter().enumerate() {
        check_refinement(problems, &format!("mesh.refine.{index}"), refinement);
    }
    check_sweep(problems, scene);
    check_bodies(problems, scene);
}

fn check_refinement(problems: &mut Problems, key: &str, refinement: &LocalRefinement) {
    problems.require(
        refinement.at.iter().all(|c| c.is_finite()),
        format!("{key}.at"),
        "must be two numbers",
    );
    problems.positive(format!("{key}.radius"), refinement.radius);
    problems.require(
        (1..=LocalRefinement::MOST_TIMES).contains(&refinement.times),
        format!("{key}.times"),
        format!(
            "{} must be between 1 and {}",
            refinement.times,
            LocalRefinement::MOST_TIMES
        ),
    );
}

/// Checks the shapes that are declared for surfaces of a file.
fn check_declared_shapes(problems: &mut Problems, mesh: &MeshSource) {
    let from_file = mesh.file.is_some();
    let radii = |list: &'static str, radii: Vec<f64>| (list, radii);
    for (list, radii) in [
        radii("circles", mesh.circles.iter().map(|s| s.radius).collect()),
        radii("spheres", mesh.spheres.iter().map(|s| s.radius).collect()),
        radii(
            "cylinders",
            mesh.cylinders.iter().map(|s| s.radius).collect(),
        ),
        radii("tori", mesh.tori.iter().map(|s| s.radius).collect()),
    ] {
        problems.require(
            from_file || radii.is_empty(),
            format!("mesh.{list}"),
            "is for meshes from a file; a generator knows the shape of its surfaces",
        );
        for (index, radius) in radii.into_iter().enumerate() {
            problems.positive(format!("mesh.{list}.{index}.radius"), radius);
        }
    }
    for (index, cylinder) in mesh.cylinders.iter().enumerate() {
        check_axis(
            problems,
            &format!("mesh.cylinders.{index}.axis"),
            cylinder.axis,
        );
    }
    for (index, torus) in mesh.tori.iter().enumerate() {
        check_axis(problems, &format!("mesh.tori.{index}.axis"), torus.axis);
        problems.require(
            torus.ring_radius > torus.radius,
            format!("mesh.tori.{index}.ring_radius"),
            format!(
                "{} must be greater than the radius of the tube ({})",
                exact(torus.ring_radius),
                exact(torus.radius)
            ),
        );
    }
}

fn check_axis(problems: &mut Problems, key: &str, axis: [f64; 3]) {
    let size = length(axis);
    problems.require(
        size > 0.0 && size.is_finite(),
        key,
        "must be a direction: three numbers that are not all zero",
    );
}

/// Checks the key that sweeps a plane mesh into a solid one.
fn check_sweep(problems: &mut Problems, scene: &Scene) {
    let mesh = &scene.mesh;
    let (key, elements) = match (&mesh.extrude, &mesh.revolve) {
        (None, None) => return,
        (Some(_), Some(_)) => {
            return problems.problem(
                "mesh.revolve",
                "the mesh is extruded already; give extrude or revolve",
            );
        }
        (Some(extrude), None) => {
            problems.positive("mesh.extrude.depth".to_string(), extrude.depth);
            ("mesh.extrude", extrude.elements)
        }
        (None, Some(revolve)) => {
            problems.must(
                revolve.angle > 0.0 && revolve.angle <= 360.0,
                "mesh.revolve.angle",
                revolve.angle,
                "be an angle in degrees, more than 0 and at most 360",
            );
            // Each element must turn by less than 90 degrees; four may make a full turn.
            let least = if revolve.angle >= 270.0 {
                4
            } else {
                1 + (revolve.angle / 90.0) as usize
            };
            problems.count("mesh.revolve.elements".to_string(), revolve.elements, least);
            ("mesh.revolve", revolve.elements)
        }
    };
    problems.count(format!("{key}.elements"), elements, 1);
    problems.require(
        scene.kind.is_solid(),
        "kind",
        format!("{key} makes a solid model; use kind = \"solid\""),
    );
    let solid = mesh.curved_bodies.is_some()
        || mesh.parts.iter().flatten().any(|part| part.brick.is_some());
    problems.require(
        !solid,
        key,
        "is for plane meshes; this one is solid without it",
    );
}

/// Checks a mesh that is even near the contact and grows from there on; all lengths are in half
/// widths.
fn check_grading(
    problems: &mut Problems,
    mesh: &str,
    [width, depth]: [f64; 2],
    contact_width: Option<f64>,
    [growth, far_size]: [f64; 2],
) {
    let key = |name: &str| format!("{mesh}.{name}");
    problems.at_least(key("fine_width"), width, 1.0);
    if let Some(contact) = contact_width {
        problems.at_least(key("contact_width"), contact, width);
    }
    problems.positive(key("fine_depth"), depth);
    problems.at_least(key("growth"), growth, 1.0);
    let fine = width.max(depth);
    problems.require(
        far_size > fine,
        key("far_size"),
        format!(
            "{} must be greater than fine_width and fine_depth ({})",
            exact(far_size),
            exact(fine)
        ),
    );
}

fn check_cylinder_on_half_plane(
    problems: &mut Problems,
    parameters: &CylinderOnHalfPlane,
    scene: &Scene,
) {
    let key = |name: &str| format!("mesh.cylinder_on_half_plane.{name}");
    problems.positive(key("radius"), parameters.radius);
    let section = scene.mesh.section(scene.kind);
    check_element(problems, &key("element"), parameters.element, section);
    problems.count(key("resolution"), parameters.resolution, 1);
    check_grading(
        problems,
        "mesh.cylinder_on_half_plane",
        [parameters.fine_width, parameters.fine_depth],
        parameters.contact_width,
        [
            parameters.growth,
            parameters.far_size.unwrap_or(f64::INFINITY),
        ],
    );
    if let Some(far) = parameters.far_growth {
        problems.at_least(key("far_growth"), far, parameters.growth);
    }
    match parameters.half_width {
        Some(half_width) => {
            problems.positive(key("half_width"), half_width);
            problems.require(
                half_width < parameters.radius,
                key("half_width"),
                format!(
                    "{} must be less than the radius ({}): small deformation",
                    exact(half_width),
                    exact(parameters.radius)
                ),
            );
        }
        None => problems.require(
            scene.may_yield(),
            key("half_width"),
            "is missing, and cannot be computed because no body can yield: give it, \
             or a yield_stress to a material",
        ),
    }
}

fn check_curved_bodies(problems: &mut Problems, parameters: &CurvedBodies, scene: &Scene) {
    let key = |name: &str| format!("mesh.curved_bodies.{name}");
    problems.require(
        scene.kind.is_solid(),
        "kind",
        "curved_bodies is a solid model; use kind = \"solid\"",
    );
    problems.require(
        scene.symmetry == parameters.copies(),
        "symmetry",
        format!(
            "{} must be {}: that many copies of mesh.curved_bodies.model make the whole",
            scene.symmetry,
            parameters.copies()
        ),
    );
    if let Err(error) = HertzEllipse::relative_radii(parameters.upper, parameters.lower) {
        problems.problem(key("upper"), error.message());
    }
    problems.count(key("resolution"), parameters.resolution, 1);
    check_grading(
        problems,
        "mesh.curved_bodies",
        [parameters.fine_width, parameters.fine_depth],
        parameters.contact_width,
        [parameters.growth, parameters.far_size],
    );
    for semi_axis in parameters.semi_axes.into_iter().flatten() {
        problems.positive(key("semi_axes"), semi_axis);
    }
    problems.require(
        parameters.semi_axes.is_some() || scene.may_yield(),
        key("semi_axes"),
        "are missing, and cannot be computed because no body can yield: give them, \
         or a yield_stress to a material",
    );
    check_element(problems, &key("element"), parameters.element, scene.kind);
}

fn check_disc_in_plate(problems: &mut Problems, parameters: &DiscInPlate, kind: Space) {
    let key = |name: &str| format!("mesh.disc_in_plate.{name}");
    problems.positive(key("radius"), parameters.radius);
    problems.require(
        parameters.resolution >= 2 && parameters.resolution.is_multiple_of(2),
        key("resolution"),
        format!(
            "{} must be an even number, 2 or more",
            parameters.resolution
        ),
    );
    problems.must(
        parameters.far_radius > 1.0,
        key("far_radius"),
        parameters.far_radius,
        "be greater than 1: it is counted in hole radii",
    );
    problems.at_least(key("growth"), parameters.growth, 1.0);
    if let Some(far) = parameters.far_growth {
        problems.at_least(key("far_growth"), far, parameters.growth);
    }
    problems.require(
        parameters.interference.abs() < parameters.radius,
        key("interference"),
        format!(
            "{} must be small against the radius ({})",
            exact(parameters.interference),
            exact(parameters.radius)
        ),
    );
    problems.require(
        matches!(kind, Space::PlaneStress | Space::PlaneStrain),
        "kind",
        "disc_in_plate is a plane model; use plane_stress or plane_strain",
    );
    check_element(problems, &key("element"), parameters.element, kind);
}

/// Requires a material for each body of a generated mesh, whose bodies are known, and no other
/// bodies.
fn check_bodies(problems: &mut Problems, scene: &Scene) {
    let Some(names) = generated_bodies(&scene.mesh) else {
        return;
    };
    let mut seen = BTreeSet::new();
    for (index, name) in names.iter().enumerate() {
        let key = match scene.mesh.named_pair() {
            Some((generator, _)) => format!("mesh.{generator}.names.{index}"),
            None => format!("mesh.parts.{index}.body"),
        };
        let is_pair = scene.mesh.named_pair().is_some();
        if is_pair && name.is_empty() {
            problems.problem(key, "is empty; give the body a name");
        } else if !seen.insert(*name) {
            problems.problem(
                key,
                format!("\"{name}\" is used twice; every part is a body of its own"),
            );
        } else if !scene.bodies.contains_key(*name) {
            problems.problem(
                "bodies",
                format!("the mesh has a body `{name}`; give it a material in [bodies.{name}]"),
            );
        }
    }
    for name in scene.bodies.keys() {
        problems.require(
            seen.contains(name.as_str()),
            format!("bodies.{name}"),
            format!("the mesh has no such body, only {}", names.join(", ")),
        );
    }
}

/// Names of the bodies of a generated mesh; `None` if the mesh comes from a file.
fn generated_bodies(mesh: &MeshSource) -> Option<Vec<&str>> {
    if let Some((_, names)) = mesh.named_pair() {
        return Some(names.iter().map(String::as_str).collect());
    }
    let parts = mesh.parts.as_ref()?;
    Some(parts.iter().map(|part| part.body.as_str()).collect())
}
