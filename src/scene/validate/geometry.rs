//! Validation of the mesh source: exactly one is given, with sensible parameters.

use super::Checks;
use crate::analytical::HertzEllipse;
use crate::number::exact;
use crate::scene::{
    CurvedBodies, CylinderOnHalfPlane, DiscInPlate, LocalRefinement, MeshSource, Scene,
};
use crate::shape::Shape;
use crate::space::{Space, length};
use std::collections::BTreeSet;

impl Checks {
    pub(super) fn geometry(&mut self, scene: &Scene) {
        let mesh = &scene.mesh;
        let section = mesh.section(scene.kind);
        self.exactly_one(
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
            self.cylinder_on_half_plane(parameters, scene);
        }
        if let Some(parameters) = &mesh.disc_in_plate {
            self.disc_in_plate(parameters, section);
        }
        if let Some(parameters) = &mesh.curved_bodies {
            self.curved_bodies(parameters, scene);
        }
        if let Some(parts) = &mesh.parts {
            self.require(
                !parts.is_empty(),
                "mesh.parts",
                "is empty; give at least one part",
            );
            for (index, part) in parts.iter().enumerate() {
                self.part(&format!("mesh.parts.{index}"), part, section);
            }
        }
        if let Some(file) = &mesh.file {
            self.require(
                !file.as_os_str().is_empty(),
                "mesh.file",
                "is empty; give the path of a Gmsh file or a deck, relative to the scene file",
            );
        }
        self.require(
            mesh.file.is_some() || mesh.subdivisions == 0,
            "mesh.subdivisions",
            "is for meshes from a file; give the generator more elements instead",
        );
        self.declared_shapes(mesh);
        for (index, refinement) in mesh.refine.iter().enumerate() {
            self.refinement(&format!("mesh.refine.{index}"), refinement);
        }
        self.sweep(scene);
        self.bodies_of_mesh(scene);
    }

    fn refinement(&mut self, key: &str, refinement: &LocalRefinement) {
        self.require(
            refinement.at.iter().all(|c| c.is_finite()),
            format!("{key}.at"),
            "must be two numbers",
        );
        self.positive(format!("{key}.radius"), refinement.radius);
        self.require(
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
    fn declared_shapes(&mut self, mesh: &MeshSource) {
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
            self.require(
                from_file || radii.is_empty(),
                format!("mesh.{list}"),
                "is for meshes from a file; a generator knows the shape of its surfaces",
            );
            for (index, radius) in radii.into_iter().enumerate() {
                self.positive(format!("mesh.{list}.{index}.radius"), radius);
            }
        }
        for (index, cylinder) in mesh.cylinders.iter().enumerate() {
            self.axis(&format!("mesh.cylinders.{index}.axis"), cylinder.axis);
        }
        for (index, torus) in mesh.tori.iter().enumerate() {
            self.axis(&format!("mesh.tori.{index}.axis"), torus.axis);
            self.require(
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

    fn axis(&mut self, key: &str, axis: [f64; 3]) {
        let size = length(axis);
        self.require(
            size > 0.0 && size.is_finite(),
            key,
            "must be a direction: three numbers that are not all zero",
        );
    }

    /// Checks the key that sweeps a plane mesh into a solid one.
    fn sweep(&mut self, scene: &Scene) {
        let mesh = &scene.mesh;
        let (key, elements) = match (&mesh.extrude, &mesh.revolve) {
            (None, None) => return,
            (Some(_), Some(_)) => {
                return self.problem(
                    "mesh.revolve",
                    "the mesh is extruded already; give extrude or revolve",
                );
            }
            (Some(extrude), None) => {
                self.positive("mesh.extrude.depth".to_string(), extrude.depth);
                ("mesh.extrude", extrude.elements)
            }
            (None, Some(revolve)) => {
                self.require(
                    revolve.angle > 0.0 && revolve.angle <= 360.0,
                    "mesh.revolve.angle",
                    format!(
                        "{} must be an angle in degrees, more than 0 and at most 360",
                        exact(revolve.angle)
                    ),
                );
                // Each element must turn by less than 120 degrees.
                let least = if revolve.angle >= 270.0 {
                    4
                } else {
                    1 + (revolve.angle / 90.0) as usize
                };
                self.count("mesh.revolve.elements".to_string(), revolve.elements, least);
                ("mesh.revolve", revolve.elements)
            }
        };
        self.count(format!("{key}.elements"), elements, 1);
        self.require(
            scene.kind.is_solid(),
            "kind",
            format!("{key} makes a solid model; use kind = \"solid\""),
        );
        let solid = mesh.curved_bodies.is_some()
            || mesh.parts.iter().flatten().any(|part| part.brick.is_some());
        self.require(
            !solid,
            key,
            "is for plane meshes; this one is solid without it",
        );
    }

    /// Checks a mesh that is even near the contact and grows from there on; all lengths are in half
    /// widths.
    fn graded(
        &mut self,
        mesh: &str,
        [width, depth]: [f64; 2],
        contact_width: Option<f64>,
        [growth, far_size]: [f64; 2],
    ) {
        let key = |name: &str| format!("{mesh}.{name}");
        self.at_least(key("fine_width"), width, 1.0);
        if let Some(contact) = contact_width {
            self.at_least(key("contact_width"), contact, width);
        }
        self.positive(key("fine_depth"), depth);
        self.at_least(key("growth"), growth, 1.0);
        let fine = width.max(depth);
        self.require(
            far_size > fine,
            key("far_size"),
            format!(
                "{} must be greater than fine_width and fine_depth ({})",
                exact(far_size),
                exact(fine)
            ),
        );
    }

    fn cylinder_on_half_plane(&mut self, parameters: &CylinderOnHalfPlane, scene: &Scene) {
        let key = |name: &str| format!("mesh.cylinder_on_half_plane.{name}");
        self.positive(key("radius"), parameters.radius);
        let section = scene.mesh.section(scene.kind);
        self.element(&key("element"), parameters.element, section);
        self.count(key("resolution"), parameters.resolution, 1);
        self.graded(
            "mesh.cylinder_on_half_plane",
            [parameters.fine_width, parameters.fine_depth],
            parameters.contact_width,
            [
                parameters.growth,
                parameters.far_size.unwrap_or(f64::INFINITY),
            ],
        );
        if let Some(far) = parameters.far_growth {
            self.at_least(key("far_growth"), far, parameters.growth);
        }
        match parameters.half_width {
            Some(half_width) => {
                self.positive(key("half_width"), half_width);
                self.require(
                    half_width < parameters.radius,
                    key("half_width"),
                    format!(
                        "{} must be less than the radius ({}): small deformation",
                        exact(half_width),
                        exact(parameters.radius)
                    ),
                );
            }
            None => self.require(
                super::may_yield(scene),
                key("half_width"),
                "is missing, and cannot be computed because no body can yield: give it, \
                 or a yield_stress to a material",
            ),
        }
    }

    fn curved_bodies(&mut self, parameters: &CurvedBodies, scene: &Scene) {
        let key = |name: &str| format!("mesh.curved_bodies.{name}");
        self.require(
            scene.kind.is_solid(),
            "kind",
            "curved_bodies is a solid model; use kind = \"solid\"",
        );
        self.require(
            scene.symmetry == parameters.copies(),
            "symmetry",
            format!(
                "{} must be {}: that many copies of mesh.curved_bodies.model make the whole",
                scene.symmetry,
                parameters.copies()
            ),
        );
        if let Err(error) = HertzEllipse::relative_radii(parameters.upper, parameters.lower) {
            self.problem(key("upper"), error.message());
        }
        self.count(key("resolution"), parameters.resolution, 1);
        self.graded(
            "mesh.curved_bodies",
            [parameters.fine_width, parameters.fine_depth],
            parameters.contact_width,
            [parameters.growth, parameters.far_size],
        );
        for semi_axis in parameters.semi_axes.into_iter().flatten() {
            self.positive(key("semi_axes"), semi_axis);
        }
        self.require(
            parameters.semi_axes.is_some() || super::may_yield(scene),
            key("semi_axes"),
            "are missing, and cannot be computed because no body can yield: give them, \
             or a yield_stress to a material",
        );
        self.element(&key("element"), parameters.element, scene.kind);
    }

    /// Requires elements of the same dimension as the model.
    pub(super) fn element(&mut self, key: &str, element: Shape, kind: Space) {
        self.require(
            element.dimension() == kind.dimension(),
            key,
            format!(
                "\"{}\" is no element where kind = \"{}\"{}",
                element.name(),
                kind.name(),
                match kind.is_solid() {
                    true => "; mesh.extrude and mesh.revolve make solids of plane meshes",
                    false => "",
                }
            ),
        );
    }

    fn disc_in_plate(&mut self, parameters: &DiscInPlate, kind: Space) {
        let key = |name: &str| format!("mesh.disc_in_plate.{name}");
        self.positive(key("radius"), parameters.radius);
        self.require(
            parameters.resolution >= 2 && parameters.resolution.is_multiple_of(2),
            key("resolution"),
            format!(
                "{} must be an even number, 2 or more",
                parameters.resolution
            ),
        );
        self.require(
            parameters.far_radius > 1.0,
            key("far_radius"),
            format!(
                "{} must be greater than 1: it is counted in hole radii",
                exact(parameters.far_radius)
            ),
        );
        self.at_least(key("growth"), parameters.growth, 1.0);
        if let Some(far) = parameters.far_growth {
            self.at_least(key("far_growth"), far, parameters.growth);
        }
        self.require(
            parameters.interference.abs() < parameters.radius,
            key("interference"),
            format!(
                "{} must be small against the radius ({})",
                exact(parameters.interference),
                exact(parameters.radius)
            ),
        );
        self.require(
            matches!(kind, Space::PlaneStress | Space::PlaneStrain),
            "kind",
            "disc_in_plate is a plane model; use plane_stress or plane_strain",
        );
        self.element(&key("element"), parameters.element, kind);
    }

    /// Requires a material for each body of a generated mesh, whose bodies are known, and no other
    /// bodies.
    fn bodies_of_mesh(&mut self, scene: &Scene) {
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
                self.problem(key, "is empty; give the body a name");
            } else if !seen.insert(*name) {
                self.problem(
                    key,
                    format!("\"{name}\" is used twice; every part is a body of its own"),
                );
            } else if !scene.bodies.contains_key(*name) {
                self.problem(
                    "bodies",
                    format!("the mesh has a body `{name}`; give it a material in [bodies.{name}]"),
                );
            }
        }
        for name in scene.bodies.keys() {
            self.require(
                seen.contains(name.as_str()),
                format!("bodies.{name}"),
                format!("the mesh has no such body, only {}", names.join(", ")),
            );
        }
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
