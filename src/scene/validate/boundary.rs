//! Validation of contacts, ties, equations, supports and loads.

use super::problems::Problems;
use crate::number::exact;
use crate::scene::{
    Contact, Direction, Equation, EquationTerm, Field, History, Load, Relative, Rotation, Scene,
    Support, Tie, VectorField,
};
use crate::space::{Components, Space};
use std::collections::BTreeSet;

pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    for (index, contact) in scene.contact.iter().enumerate() {
        check_contact(problems, &format!("contact.{index}"), contact, scene.kind);
    }
    for (index, tie) in scene.tie.iter().enumerate() {
        check_tie(problems, &format!("tie.{index}"), tie);
    }
    for (index, equation) in scene.equation.iter().enumerate() {
        check_equation(problems, &format!("equation.{index}"), equation, scene.kind);
    }
    for (index, support) in scene.support.iter().enumerate() {
        let key = format!("support.{index}");
        check_set_name(problems, &format!("{key}.on"), &support.on);
        check_support(problems, &key, support, scene.kind);
    }
    let mut names = BTreeSet::new();
    for (index, load) in scene.load.iter().enumerate() {
        let key = format!("load.{index}");
        problems.require(
            load.name.is_empty() || names.insert(load.name.as_str()),
            format!("{key}.name"),
            format!("\"{}\" is the name of an earlier load too", load.name),
        );
        check_load(problems, &key, load, scene.kind);
    }
}

/// Requires a set's name to be present; whether the set exists cannot be checked before there
/// is a mesh.
fn check_set_name(problems: &mut Problems, key: &str, name: &str) {
    problems.require(
        !name.is_empty(),
        key,
        "is empty; name a surface or node set of the mesh",
    );
}

fn check_support(problems: &mut Problems, key: &str, support: &Support, space: Space) {
    let fix = format!("{key}.fix");
    if let Some(direction) = support.direction {
        check_vector(problems, &format!("{key}.direction"), direction, space);
        check_direction(problems, &format!("{key}.direction"), direction);
        problems.require(
            support.fix.is_empty() && support.angle.is_none(),
            fix,
            "has no meaning beside `direction`; make two supports of it",
        );
        return;
    }
    let axes = match space.is_solid() {
        true => "give some of \"x\", \"y\", \"z\"",
        false => "give \"x\", \"y\" or both",
    };
    problems.require(
        !support.fix.is_empty(),
        fix.as_str(),
        format!("is empty; {axes}"),
    );
    let repeated = (1..support.fix.len()).any(|i| support.fix[..i].contains(&support.fix[i]));
    problems.require(!repeated, fix.as_str(), "names a direction twice");
    for direction in &support.fix {
        check_axis(problems, &fix, *direction, space);
    }
}

/// Requires a vector to have as many components as the model has coordinates.
pub(super) fn check_vector(problems: &mut Problems, key: &str, given: Components, space: Space) {
    check_components(problems, key, given.count(), space);
}

fn check_components(problems: &mut Problems, key: &str, count: usize, space: Space) {
    problems.require(
        count == space.dimension(),
        key,
        format!(
            "has {count} components; a {} model needs {}",
            space.name(),
            space.dimension()
        ),
    );
}

pub(super) fn check_direction(problems: &mut Problems, key: &str, given: Components) {
    problems.require(
        given.iter().any(|c| c != 0.0),
        key,
        match given.count() {
            2 => "[0, 0] has no direction",
            _ => "[0, 0, 0] has no direction",
        },
    );
}

/// Refuses direction z except in a solid.
pub(super) fn check_axis(problems: &mut Problems, key: &str, direction: Direction, space: Space) {
    problems.require(
        direction.axis() < space.dimension(),
        key,
        format!("\"z\" is no direction where kind = \"{}\"", space.name()),
    );
}

fn check_contact(problems: &mut Problems, key: &str, contact: &Contact, space: Space) {
    check_set_name(problems, &format!("{key}.first"), &contact.first);
    check_set_name(problems, &format!("{key}.second"), &contact.second);
    problems.require(
        contact.first != contact.second,
        format!("{key}.second"),
        format!(
            "\"{}\" cannot touch itself; name another surface",
            contact.second
        ),
    );
    if let Some(nodes) = &contact.nodes {
        check_set_name(problems, &format!("{key}.nodes"), nodes);
    }
    if let Some(normal) = contact.normal {
        check_vector(problems, &format!("{key}.normal"), normal, space);
        check_direction(problems, &format!("{key}.normal"), normal);
    }
    if let Some(stiffness) = contact.stiffness {
        problems.stress(format!("{key}.stiffness"), stiffness);
    }
    for (name, field) in contact.fields() {
        let key = format!("{key}.{name}");
        // Fields that are not uniform are checked later, at the nodes.
        if let Some(value) = field.uniform() {
            let other = Contact::instead_of_negative(name);
            problems.require(
                value >= 0.0,
                key.as_str(),
                format!("{} is negative; {other}", exact(value)),
            );
        }
        check_field(problems, &key, field, space);
    }
}

/// Requires a formula to use the names of the position only.
fn check_field(problems: &mut Problems, key: &str, field: &Field, space: Space) {
    if let (Field::Formula(_), Err(wrong)) = (field, field.function(space).map(drop)) {
        problems.problem(key, wrong);
    }
}

fn check_tie(problems: &mut Problems, key: &str, tie: &Tie) {
    check_set_name(problems, &format!("{key}.first"), &tie.first);
    check_set_name(problems, &format!("{key}.second"), &tie.second);
    problems.require(
        tie.first != tie.second,
        format!("{key}.second"),
        format!(
            "\"{}\" cannot be tied to itself; name another surface",
            tie.second
        ),
    );
    if let Some(distance) = tie.distance {
        problems.at_least(format!("{key}.distance"), distance, 0.0);
    }
}

fn check_equation(problems: &mut Problems, key: &str, equation: &Equation, space: Space) {
    problems.require(
        equation.terms.len() >= 2,
        format!("{key}.terms"),
        "an equation has at least two terms; hold what is to be zero by a support",
    );
    for (k, term) in equation.terms.iter().enumerate() {
        let key = format!("{key}.terms.{k}");
        check_term(problems, &key, term, space);
        problems.require(
            k > 0 || term.coefficient != 0.0,
            format!("{key}.coefficient"),
            "is 0; that of the first term, which follows the others, is not",
        );
    }
}

fn check_term(problems: &mut Problems, key: &str, term: &EquationTerm, space: Space) {
    check_set_name(problems, &format!("{key}.on"), &term.on);
    check_axis(problems, &format!("{key}.direction"), term.direction, space);
}

/// Checks a prescribed difference of displacements.
fn check_relative(problems: &mut Problems, key: &str, relative: &Relative, space: Space) {
    check_axis(
        problems,
        &format!("{key}.direction"),
        relative.direction,
        space,
    );
    for (k, term) in relative.terms.iter().enumerate() {
        check_term(problems, &format!("{key}.terms.{k}"), term, space);
    }
}

fn check_load(problems: &mut Problems, key: &str, load: &Load, kind: Space) {
    check_set_name(problems, &format!("{key}.on"), &load.on);
    let kinds = load.actions();
    let kinds: Vec<_> = kinds
        .map(|(name, action)| (name, action.is_some()))
        .collect();
    problems.exactly_one(key, "load kind", &kinds);
    if let Some(displacement) = &load.displacement {
        let key = format!("{key}.displacement");
        problems.require(
            displacement.components().iter().any(Option::is_some),
            key.as_str(),
            match kind.is_solid() {
                true => "has no component; give x, y, z or some of them",
                false => "has no component; give x, y or both",
            },
        );
        if displacement.z.is_some() {
            check_axis(problems, &key, Direction::Z, kind);
        }
    }
    if let Some(relative) = &load.relative {
        check_relative(problems, &format!("{key}.relative"), relative, kind);
    }
    if let Some(rotation) = load.rotation {
        check_rotation(problems, &format!("{key}.rotation"), &rotation, kind);
    }
    for (name, field) in load.fields() {
        check_field(problems, &format!("{key}.{name}"), field, kind);
    }
    if let (Some(given), Space::Axisymmetric) = (load.acceleration, kind) {
        problems.require(
            given.vector()[0] == 0.0,
            format!("{key}.acceleration"),
            "has a radial component; of an axisymmetric model only the axial one is symmetric",
        );
    }
    let vectors = [
        ("force", load.force.map(|force| force.count())),
        ("traction", load.traction.as_ref().map(VectorField::count)),
        ("acceleration", load.acceleration.map(|a| a.count())),
    ];
    for (name, count) in vectors {
        if let Some(count) = count {
            check_components(problems, &format!("{key}.{name}"), count, kind);
        }
    }
    if let Some(plane) = load.plane_force {
        check_axis(
            problems,
            &format!("{key}.plane_force.direction"),
            plane.direction,
            kind,
        );
    }
    if let Some(kirsch) = load.kirsch {
        problems.at_least(format!("{key}.kirsch.radius"), kirsch.radius, 0.0);
        problems.require(
            matches!(kind, Space::PlaneStrain | Space::PlaneStress),
            format!("{key}.kirsch"),
            format!("is the field of a plane model; this one is {}", kind.name()),
        );
    }
    check_history(problems, key, &load.history);
}

fn check_rotation(problems: &mut Problems, key: &str, rotation: &Rotation, space: Space) {
    let axis = format!("{key}.axis");
    match rotation.axis {
        Some([x, y, z]) if space.is_solid() => check_direction(problems, &axis, [x, y, z].into()),
        Some(_) => problems.problem(
            axis,
            "is for solids; plane models turn in their plane, axisymmetric ones about their \
             axis",
        ),
        None => problems.require(
            !space.is_solid(),
            axis,
            "is missing; give the direction of the axis",
        ),
    }
    if let Some(center) = rotation.center {
        let key = format!("{key}.center");
        check_vector(problems, &key, center, space);
        problems.require(
            !space.is_axisymmetric(),
            key,
            "has no meaning: axisymmetric models turn about their own axis",
        );
    }
}

fn check_history(problems: &mut Problems, key: &str, history: &History) {
    if let History::Table(rows) = history {
        let key = format!("{key}.history");
        problems.require(
            !rows.is_empty(),
            key.as_str(),
            "is empty; give rows of [load factor, multiple]",
        );
        for (index, pair) in rows.windows(2).enumerate() {
            let key = format!("{key}.{}", index + 1);
            problems.grows(&key, "load factor ", [pair[0][0], pair[1][0]]);
            problems.slope_between(&key, [pair[0], pair[1]]);
        }
    }
}
