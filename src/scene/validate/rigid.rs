//! Validation of rigid surfaces and of the loads on them.

use super::Checks;
use crate::number::exact;
use crate::scene::{Field, Load, RigidSurface, Scene, SlaveSide};
use crate::space::{Components, Space};

impl Checks {
    pub(super) fn rigid(&mut self, scene: &Scene) {
        for (name, surface) in &scene.rigid {
            let key = format!("rigid.{name}");
            self.require(
                !scene.bodies.contains_key(name),
                key.as_str(),
                format!("`{name}` is a body of the mesh too: give the rigid surface another name"),
            );
            self.exactly_one(key.as_str(), "kind of rigid surface", &surface.kinds());
            self.round_surfaces(&key, surface, scene.kind);
            self.flat_surfaces(&key, surface, scene.kind);
            self.pushed(scene, name);
            let mut contacts = scene.contact.iter();
            self.require(
                contacts.any(|c| [&c.first, &c.second].contains(&name)),
                key.as_str(),
                format!("`{name}` touches nothing: name it in a [[contact]]"),
            );
        }
        for (index, contact) in scene.contact.iter().enumerate() {
            let key = format!("contact.{index}");
            let is_rigid = [&contact.first, &contact.second].map(|n| scene.rigid.contains_key(n));
            if is_rigid == [true, true] {
                self.problem(
                    format!("{key}.second"),
                    format!(
                        "`{}` and `{}` are both rigid: one side of a contact is a surface of the \
                         mesh",
                        contact.first, contact.second
                    ),
                );
            }
            let side = match contact.slave {
                SlaveSide::Auto => None,
                SlaveSide::First => Some(0),
                SlaveSide::Second => Some(1),
            };
            self.require(
                side.is_none_or(|side| !is_rigid[side]),
                format!("{key}.slave"),
                "is a rigid surface, which has no nodes: leave it out",
            );
            self.require(
                contact.normal.is_none() || is_rigid == [false, false],
                format!("{key}.normal"),
                "is known of a rigid surface: leave it out",
            );
        }
    }

    fn round_surfaces(&mut self, key: &str, surface: &RigidSurface, space: Space) {
        if let Some(of) = &surface.sphere {
            let key = format!("{key}.sphere");
            self.on_axis(&format!("{key}.center"), of.center, space);
            self.positive(format!("{key}.radius"), of.radius);
        }
        if let Some(of) = &surface.cylinder {
            let key = format!("{key}.cylinder");
            self.on_axis(&format!("{key}.center"), of.center, space);
            self.axis_of(&format!("{key}.axis"), of.axis, space);
            self.positive(format!("{key}.radius"), of.radius);
        }
        if let Some(of) = &surface.torus {
            let key = format!("{key}.torus");
            self.on_axis(&format!("{key}.center"), of.center, space);
            self.axis_of(&format!("{key}.axis"), of.axis, space);
            self.positive(format!("{key}.ring_radius"), of.ring_radius);
            self.positive(format!("{key}.radius"), of.radius);
        }
    }

    fn flat_surfaces(&mut self, key: &str, surface: &RigidSurface, space: Space) {
        if let Some(of) = &surface.cone {
            let key = format!("{key}.cone");
            self.on_axis(&format!("{key}.tip"), of.tip, space);
            self.along_axis(&format!("{key}.axis"), of.axis, space);
            self.require(
                of.half_angle > 0.0 && of.half_angle < 90.0,
                format!("{key}.half_angle"),
                format!("{} must lie between 0 and 90 degrees", exact(of.half_angle)),
            );
            self.require(
                of.rounding > 0.0,
                format!("{key}.rounding"),
                format!(
                    "{} must be greater than zero: under a sharp tip the pressure has no bound",
                    exact(of.rounding)
                ),
            );
        }
        if let Some(of) = &surface.plane {
            let key = format!("{key}.plane");
            self.vector(&format!("{key}.point"), of.point, space);
            self.along_axis(&format!("{key}.normal"), of.normal, space);
        }
        if let Some(of) = &surface.punch {
            let key = format!("{key}.punch");
            self.on_axis(&format!("{key}.center"), of.center, space);
            self.along_axis(&format!("{key}.axis"), of.axis, space);
            self.positive(format!("{key}.radius"), of.radius);
            self.require(
                of.fillet > 0.0 && of.fillet <= of.radius,
                format!("{key}.fillet"),
                format!(
                    "{} must be greater than zero, for a sharp edge has an infinite pressure, and \
                     no more than the radius {}",
                    exact(of.fillet),
                    exact(of.radius)
                ),
            );
        }
    }

    /// Requires a point of an axisymmetric model to lie on the axis of revolution.
    fn on_axis(&mut self, key: &str, point: Components, space: Space) {
        self.vector(key, point, space);
        self.require(
            !space.is_axisymmetric() || point.vector()[0] == 0.0,
            key,
            format!(
                "r = {} must be 0: the surface of revolution has its centre on the axis",
                exact(point.vector()[0])
            ),
        );
    }

    /// Requires a direction in an axisymmetric model to lie along the axis of revolution.
    fn along_axis(&mut self, key: &str, given: Components, space: Space) {
        self.vector(key, given, space);
        self.is_direction(key, given);
        self.require(
            !space.is_axisymmetric() || given.vector()[0] == 0.0,
            key,
            "must lie along the axis of revolution: [0, 1] or [0, -1]",
        );
    }

    /// Requires the axis of a round surface in a solid; in other models the axis follows from the
    /// kind.
    fn axis_of(&mut self, key: &str, axis: Option<[f64; 3]>, space: Space) {
        match axis {
            Some(axis) if space.is_solid() => self.is_direction(key, axis.into()),
            Some(_) => self.problem(
                key,
                format!("follows from kind = \"{}\": leave it out", space.name()),
            ),
            None => self.require(
                !space.is_solid(),
                key,
                "is missing: give the direction of the axis, [x, y, z]",
            ),
        }
    }

    /// Checks what is defined on a rigid surface: no support, tie or equation, and as loads either
    /// forces or a single displacement.
    fn pushed(&mut self, scene: &Scene, name: &str) {
        for (index, support) in scene.support.iter().enumerate() {
            self.require(
                support.on != name,
                format!("support.{index}.on"),
                format!(
                    "`{name}` is rigid and held across its push as it is: leave the support out"
                ),
            );
        }
        for (index, tie) in scene.tie.iter().enumerate() {
            self.require(
                tie.first != name && tie.second != name,
                format!("tie.{index}"),
                format!("`{name}` is rigid and may touch, not be tied: prescribe a displacement"),
            );
        }
        for (index, equation) in scene.equation.iter().enumerate() {
            self.require(
                equation.terms.iter().all(|term| term.on != name),
                format!("equation.{index}"),
                format!("`{name}` is rigid and takes no part in equations"),
            );
        }
        for (index, load) in scene.load.iter().enumerate() {
            let relative = load.relative.iter();
            let mut terms = relative.flat_map(|relative| &relative.terms);
            self.require(
                terms.all(|term| term.on != name),
                format!("load.{index}.relative"),
                format!("`{name}` is rigid and takes no part in equations"),
            );
        }
        let mut first: Option<&Load> = None;
        for (index, load) in scene.load.iter().enumerate().filter(|(_, l)| l.on == name) {
            let key = format!("load.{index}");
            let moves = load.force.is_some() || load.plane_force.is_some();
            if let Some(displacement) = &load.displacement {
                let mut given = displacement.components().into_iter().flatten();
                self.require(
                    given.all(|field: &Field| field.uniform().is_some()),
                    format!("{key}.displacement"),
                    format!("`{name}` is rigid and moves as one: give numbers"),
                );
            } else if !moves {
                self.require(
                    load.gap.is_some(),
                    key,
                    format!("`{name}` is rigid: push it by `force` or `displacement`"),
                );
                continue;
            }
            match first {
                None => first = Some(load),
                Some(other) => self.require(
                    other.displacement.is_none() && load.displacement.is_none(),
                    key,
                    format!(
                        "`{name}` is moved by a displacement and something else: keep one of them"
                    ),
                ),
            }
        }
    }
}
