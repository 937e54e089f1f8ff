//! Validation of rigid surfaces and of the loads on them.

use super::boundary::{check_direction, check_vector};
use super::problems::Problems;
use crate::number::exact;
use crate::scene::{Field, Load, RigidSurface, Scene, SlaveSide};
use crate::space::{Components, Space};

pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    for (name, surface) in &scene.rigid {
        let key = format!("rigid.{name}");
        problems.require(
            !scene.bodies.contains_key(name),
            key.as_str(),
            format!("`{name}` is a body of the mesh too: give the rigid surface another name"),
        );
        problems.exactly_one(key.as_str(), "kind of rigid surface", &surface.kinds());
        check_round(problems, &key, surface, scene.kind);
        check_flat(problems, &key, surface, scene.kind);
        check_pushed(problems, scene, name);
        let mut contacts = scene.contact.iter();
        problems.require(
            contacts.any(|c| [&c.first, &c.second].contains(&name)),
            key.as_str(),
            format!("`{name}` touches nothing: name it in a [[contact]]"),
        );
    }
    for (index, contact) in scene.contact.iter().enumerate() {
        let key = format!("contact.{index}");
        let is_rigid = [&contact.first, &contact.second].map(|n| scene.rigid.contains_key(n));
        if is_rigid == [true, true] {
            problems.problem(
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
        problems.require(
            side.is_none_or(|side| !is_rigid[side]),
            format!("{key}.slave"),
            "is a rigid surface, which has no nodes: leave it out",
        );
        problems.require(
            contact.normal.is_none() || is_rigid == [false, false],
            format!("{key}.normal"),
            "is known of a rigid surface: leave it out",
        );
    }
}

fn check_round(problems: &mut Problems, key: &str, surface: &RigidSurface, space: Space) {
    if let Some(of) = &surface.sphere {
        let key = format!("{key}.sphere");
        check_on_axis(problems, &format!("{key}.center"), of.center, space);
        problems.positive(format!("{key}.radius"), of.radius);
    }
    if let Some(of) = &surface.cylinder {
        let key = format!("{key}.cylinder");
        check_on_axis(problems, &format!("{key}.center"), of.center, space);
        check_axis(problems, &format!("{key}.axis"), of.axis, space);
        problems.positive(format!("{key}.radius"), of.radius);
    }
    if let Some(of) = &surface.torus {
        let key = format!("{key}.torus");
        check_on_axis(problems, &format!("{key}.center"), of.center, space);
        check_axis(problems, &format!("{key}.axis"), of.axis, space);
        problems.positive(format!("{key}.ring_radius"), of.ring_radius);
        problems.positive(format!("{key}.radius"), of.radius);
    }
}

fn check_flat(problems: &mut Problems, key: &str, surface: &RigidSurface, space: Space) {
    if let Some(of) = &surface.cone {
        let key = format!("{key}.cone");
        check_on_axis(problems, &format!("{key}.tip"), of.tip, space);
        check_along_axis(problems, &format!("{key}.axis"), of.axis, space);
        problems.must(
            of.half_angle > 0.0 && of.half_angle < 90.0,
            format!("{key}.half_angle"),
            of.half_angle,
            "lie between 0 and 90 degrees",
        );
        problems.must(
            of.rounding > 0.0,
            format!("{key}.rounding"),
            of.rounding,
            "be greater than zero: under a sharp tip the pressure has no bound",
        );
    }
    if let Some(of) = &surface.plane {
        let key = format!("{key}.plane");
        check_vector(problems, &format!("{key}.point"), of.point, space);
        check_along_axis(problems, &format!("{key}.normal"), of.normal, space);
    }
    if let Some(of) = &surface.punch {
        let key = format!("{key}.punch");
        check_on_axis(problems, &format!("{key}.center"), of.center, space);
        check_along_axis(problems, &format!("{key}.axis"), of.axis, space);
        problems.positive(format!("{key}.radius"), of.radius);
        problems.require(
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
fn check_on_axis(problems: &mut Problems, key: &str, point: Components, space: Space) {
    check_vector(problems, key, point, space);
    problems.require(
        !space.is_axisymmetric() || point.vector()[0] == 0.0,
        key,
        format!(
            "r = {} must be 0: the surface of revolution has its centre on the axis",
            exact(point.vector()[0])
        ),
    );
}

/// Requires a direction in an axisymmetric model to lie along the axis of revolution.
fn check_along_axis(problems: &mut Problems, key: &str, given: Components, space: Space) {
    check_vector(problems, key, given, space);
    check_direction(problems, key, given);
    problems.require(
        !space.is_axisymmetric() || given.vector()[0] == 0.0,
        key,
        "must lie along the axis of revolution: [0, 1] or [0, -1]",
    );
}

/// Requires the axis of a round surface in a solid; in other models the axis follows from the
/// kind.
fn check_axis(problems: &mut Problems, key: &str, axis: Option<[f64; 3]>, space: Space) {
    match axis {
        Some(axis) if space.is_solid() => check_direction(problems, key, axis.into()),
        Some(_) => problems.problem(
            key,
            format!("follows from kind = \"{}\": leave it out", space.name()),
        ),
        None => problems.require(
            !space.is_solid(),
            key,
            "is missing: give the direction of the axis, [x, y, z]",
        ),
    }
}

/// Checks what is defined on a rigid surface: no support, tie or equation, and as loads either
/// forces or a single displacement.
fn check_pushed(problems: &mut Problems, scene: &Scene, name: &str) {
    for (index, support) in scene.support.iter().enumerate() {
        problems.require(
            support.on != name,
            format!("support.{index}.on"),
            format!(
                "`{name}` is rigid and held already, except along its load: leave the support out"
            ),
        );
    }
    for (index, tie) in scene.tie.iter().enumerate() {
        problems.require(
            tie.first != name && tie.second != name,
            format!("tie.{index}"),
            format!("`{name}` is rigid and may touch, not be tied: prescribe a displacement"),
        );
    }
    for (index, equation) in scene.equation.iter().enumerate() {
        problems.require(
            equation.terms.iter().all(|term| term.on != name),
            format!("equation.{index}"),
            format!("`{name}` is rigid and takes no part in equations"),
        );
    }
    for (index, load) in scene.load.iter().enumerate() {
        let relative = load.relative.iter();
        let mut terms = relative.flat_map(|relative| &relative.terms);
        problems.require(
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
            problems.require(
                given.all(|field: &Field| field.uniform().is_some()),
                format!("{key}.displacement"),
                format!("`{name}` is rigid and moves as one: give numbers"),
            );
        } else if !moves {
            problems.require(
                load.gap.is_some(),
                key,
                format!("`{name}` is rigid: push it by `force` or `displacement`"),
            );
            continue;
        }
        match first {
            None => first = Some(load),
            Some(other) => problems.require(
                other.displacement.is_none() && load.displacement.is_none(),
                key,
                format!("`{name}` is moved by a displacement and something else: keep one of them"),
            ),
        }
    }
}
