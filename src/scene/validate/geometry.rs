//! The mesh source: one of them, with parameters that make sense.

use super::Checks;
use crate::analytical::HertzEllipse;
use crate::scene::{
    Block, BrickPart, CurvedBodies, CylinderOnHalfPlane, Disc, DiscInPlate, MeshSource, Part, Ring,
    Scene,
};
use crate::shape::Shape;
use crate::space::Space;
use crate::text::exact;
use std::collections::BTreeSet;

impl Checks {
    pub(super) fn geometry(&mut self, scene: &Scene) {
        let mesh = &scene.mesh;
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
            self.disc_in_plate(parameters, scene.kind);
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
                self.part(&format!("mesh.parts.{index}"), part, scene.kind);
            }
        }
        if let Some(file) = &mesh.file {
            self.require(
                !file.as_os_str().is_empty(),
                "mesh.file",
                "is empty; give the path of a Gmsh file, relative to the scene file",
            );
        }
        let from_file = mesh.file.is_some();
        self.require(
            from_file || mesh.subdivisions == 0,
            "mesh.subdivisions",
            "is for meshes from a file; give the generator more elements instead",
        );
        self.require(
            from_file || mesh.circles.is_empty(),
            "mesh.circles",
            "is for meshes from a file; a generator knows the shape of its surfaces",
        );
        for (index, circle) in mesh.circles.iter().enumerate() {
            let key = |name: &str| format!("mesh.circles.{index}.{name}");
            self.positive(key("radius"), circle.radius);
            self.require(
                circle.center.iter().all(|c| c.is_finite()),
                key("center"),
                "must be finite",
            );
        }
        self.bodies_of_mesh(scene);
    }

    fn cylinder_on_half_plane(&mut self, parameters: &CylinderOnHalfPlane, scene: &Scene) {
        let key = |name: &str| format!("mesh.cylinder_on_half_plane.{name}");
        self.positive(key("radius"), parameters.radius);
        self.element(&key("element"), parameters.element, scene.kind);
        self.count(key("resolution"), parameters.resolution, 1);
        self.at_least(key("fine_width"), parameters.fine_width, 1.0);
        if let Some(width) = parameters.contact_width {
            self.at_least(key("contact_width"), width, parameters.fine_width);
        }
        self.positive(key("fine_depth"), parameters.fine_depth);
        self.at_least(key("growth"), parameters.growth, 1.0);
        if let Some(far) = parameters.far_growth {
            self.at_least(key("far_growth"), far, parameters.growth);
        }
        let fine = parameters.fine_width.max(parameters.fine_depth);
        self.require(
            parameters.far_size > fine,
            key("far_size"),
            format!(
                "{} must be greater than fine_width and fine_depth ({})",
                exact(parameters.far_size),
                exact(fine)
            ),
        );
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
        self.at_least(key("fine_width"), parameters.fine_width, 1.0);
        if let Some(width) = parameters.contact_width {
            self.at_least(key("contact_width"), width, parameters.fine_width);
        }
        self.positive(key("fine_depth"), parameters.fine_depth);
        self.at_least(key("growth"), parameters.growth, 1.0);
        let fine = parameters.fine_width.max(parameters.fine_depth);
        self.require(
            parameters.far_size > fine,
            key("far_size"),
            format!(
                "{} must be greater than fine_width and fine_depth ({})",
                exact(parameters.far_size),
                exact(fine)
            ),
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

    /// An element of as many dimensions as the model.
    fn element(&mut self, key: &str, element: Shape, kind: Space) {
        self.require(
            element.dimension() == kind.dimension(),
            key,
            format!(
                "\"{}\" is no element of a {} model",
                element.name(),
                kind.name()
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

    fn part(&mut self, key: &str, part: &Part, kind: Space) {
        self.exactly_one(
            key,
            "shape",
            &[
                ("block", part.block.is_some()),
                ("brick", part.brick.is_some()),
                ("ring", part.ring.is_some()),
                ("disc", part.disc.is_some()),
            ],
        );
        self.require(
            !part.body.is_empty(),
            format!("{key}.body"),
            "is empty; give the body a name",
        );
        let solid = part.brick.is_some();
        self.require(
            solid == kind.is_solid(),
            key,
            match solid {
                true => "a brick is a part of a solid model; use kind = \"solid\", or a block",
                false => "blocks, rings and discs are plane parts; a solid model takes bricks",
            },
        );
        // Quad4 stands for what is not given.
        if !(solid && part.element == Shape::Quad4) {
            self.element(&format!("{key}.element"), part.element, kind);
        }
        if let Some(brick) = &part.brick {
            self.brick(&format!("{key}.brick"), brick);
        }
        if let Some(block) = &part.block {
            self.block(&format!("{key}.block"), block, kind);
        }
        if let Some(ring) = &part.ring {
            self.ring(&format!("{key}.ring"), ring);
        }
        if let Some(disc) = &part.disc {
            self.disc(&format!("{key}.disc"), disc);
        }
    }

    fn brick(&mut self, key: &str, brick: &BrickPart) {
        for (axis, [from, to]) in [brick.x, brick.y, brick.z].into_iter().enumerate() {
            self.require(
                from < to,
                format!("{key}.{}", ["x", "y", "z"][axis]),
                format!(
                    "[{}, {}] must run from the smaller to the larger coordinate",
                    exact(from),
                    exact(to)
                ),
            );
            self.count(format!("{key}.elements.{axis}"), brick.elements[axis], 1);
            self.positive(format!("{key}.bias.{axis}"), brick.bias[axis]);
        }
    }

    fn block(&mut self, key: &str, block: &Block, kind: Space) {
        for (name, [from, to], index) in [("x", block.x, 0), ("y", block.y, 1)] {
            self.require(
                from < to,
                format!("{key}.{name}"),
                format!(
                    "[{}, {}] must run from the smaller to the larger coordinate",
                    exact(from),
                    exact(to)
                ),
            );
            self.count(format!("{key}.elements.{index}"), block.elements[index], 1);
            self.positive(format!("{key}.bias.{index}"), block.bias[index]);
        }
        self.require(
            !kind.is_axisymmetric() || block.x[0] >= 0.0,
            format!("{key}.x"),
            format!(
                "{} is left of the axis: in an axisymmetric model x is the radius",
                exact(block.x[0])
            ),
        );
        let sides = ["left", "right", "bottom", "top"];
        let corners = ["bottom_left", "bottom_right", "top_left", "top_right"];
        let mut names = BTreeSet::new();
        for (index, piece) in block.pieces.iter().enumerate() {
            let key = format!("{key}.pieces.{index}");
            self.require(
                names.insert(&piece.name) && !piece.name.is_empty(),
                format!("{key}.name"),
                format!("\"{}\" is empty or used twice", piece.name),
            );
            self.require(
                !sides.contains(&piece.name.as_str()) && !corners.contains(&piece.name.as_str()),
                format!("{key}.name"),
                format!(
                    "\"{}\" is the name of a side or corner; choose another",
                    piece.name
                ),
            );
            self.require(
                sides.contains(&piece.side.as_str()),
                format!("{key}.side"),
                format!("\"{}\" is none of {}", piece.side, sides.join(", ")),
            );
            self.require(
                piece.from < piece.to,
                key,
                format!(
                    "from = {} must be less than to = {}",
                    exact(piece.from),
                    exact(piece.to)
                ),
            );
        }
    }

    fn ring(&mut self, key: &str, ring: &Ring) {
        let [inner, outer] = ring.radius;
        self.require(
            inner > 0.0 && inner < outer,
            format!("{key}.radius"),
            format!(
                "[{}, {}] must be positive and ascending (a disc has no inner radius)",
                exact(inner),
                exact(outer)
            ),
        );
        let [start, end] = ring.angle;
        self.require(
            start < end && end - start <= 360.0,
            format!("{key}.angle"),
            format!(
                "[{}, {}] must be ascending and at most 360 degrees apart",
                exact(start),
                exact(end)
            ),
        );
        for index in 0..2 {
            self.count(format!("{key}.elements.{index}"), ring.elements[index], 1);
        }
        self.positive(format!("{key}.bias"), ring.bias);
    }

    fn disc(&mut self, key: &str, disc: &Disc) {
        self.positive(format!("{key}.radius"), disc.radius);
        let [start, end] = disc.angle;
        self.require(
            [90.0, 180.0, 360.0].contains(&(end - start)),
            format!("{key}.angle"),
            format!(
                "[{}, {}] must be 90, 180 or 360 degrees apart",
                exact(start),
                exact(end)
            ),
        );
        self.require(
            disc.elements >= 2 && disc.elements.is_multiple_of(2),
            format!("{key}.elements"),
            format!("{} must be an even number, 2 or more", disc.elements),
        );
    }

    /// Generated meshes have known bodies: each needs a material, and there are no others.
    fn bodies_of_mesh(&mut self, scene: &Scene) {
        let Some(names) = generated_bodies(&scene.mesh) else {
            return;
        };
        let mut seen = BTreeSet::new();
        for (index, name) in names.iter().enumerate() {
            if !seen.insert(*name) {
                self.problem(
                    format!("mesh.parts.{index}.body"),
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

/// Names of the bodies of a generated mesh; `None` where a file decides.
fn generated_bodies(mesh: &MeshSource) -> Option<Vec<&str>> {
    if mesh.cylinder_on_half_plane.is_some() {
        Some(vec!["cylinder", "half_plane"])
    } else if mesh.disc_in_plate.is_some() {
        Some(vec!["disc", "plate"])
    } else if mesh.curved_bodies.is_some() {
        Some(vec!["upper", "lower"])
    } else {
        let parts = mesh.parts.as_ref()?;
        Some(parts.iter().map(|part| part.body.as_str()).collect())
    }
}
