//! Validation of contacts, ties, equations, supports and loads.

use super::Checks;
use crate::number::exact;
use crate::scene::{
    Contact, Direction, Equation, EquationTerm, Field, History, Load, Relative, Rotation, Scene,
    Support, Tie, VectorField,
};
use crate::space::{Components, Space};
use std::collections::BTreeSet;

impl Checks {
    pub(super) fn boundary(&mut self, scene: &Scene) {
        for (index, contact) in scene.contact.iter().enumerate() {
            self.contact(&format!("contact.{index}"), contact, scene.kind);
        }
        for (index, tie) in scene.tie.iter().enumerate() {
            self.tie(&format!("tie.{index}"), tie);
        }
        for (index, equation) in scene.equation.iter().enumerate() {
            self.equation(&format!("equation.{index}"), equation, scene.kind);
        }
        for (index, support) in scene.support.iter().enumerate() {
            let key = format!("support.{index}");
            self.set_name(&format!("{key}.on"), &support.on);
            self.support(&key, support, scene.kind);
        }
        let mut names = BTreeSet::new();
        for (index, load) in scene.load.iter().enumerate() {
            let key = format!("load.{index}");
            self.require(
                load.name.is_empty() || names.insert(load.name.as_str()),
                format!("{key}.name"),
                format!("\"{}\" is the name of an earlier load too", load.name),
            );
            self.load(&key, load, scene.kind);
        }
    }

    /// Requires a set's name to be present; whether the set exists cannot be checked before there
    /// is a mesh.
    fn set_name(&mut self, key: &str, name: &str) {
        self.require(
            !name.is_empty(),
            key,
            "is empty; name a surface or node set of the mesh",
        );
    }

    fn support(&mut self, key: &str, support: &Support, space: Space) {
        let fix = format!("{key}.fix");
        if let Some(direction) = support.direction {
            self.vector(&format!("{key}.direction"), direction, space);
            self.is_direction(&format!("{key}.direction"), direction);
            self.require(
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
        self.require(
            !support.fix.is_empty(),
            fix.as_str(),
            format!("is empty; {axes}"),
        );
        let repeated = (1..support.fix.len()).any(|i| support.fix[..i].contains(&support.fix[i]));
        self.require(!repeated, fix.as_str(), "names a direction twice");
        for direction in &support.fix {
            self.is_in(&fix, *direction, space);
        }
    }

    /// Requires a vector to have as many components as the model has coordinates.
    pub(super) fn vector(&mut self, key: &str, given: Components, space: Space) {
        self.components(key, given.count(), space);
    }

    fn components(&mut self, key: &str, count: usize, space: Space) {
        self.require(
            count == space.dimension(),
            key,
            format!(
                "has {count} components; a {} model needs {}",
                space.name(),
                space.dimension()
            ),
        );
    }

    pub(super) fn is_direction(&mut self, key: &str, given: Components) {
        self.require(
            given.iter().any(|c| c != 0.0),
            key,
            match given.count() {
                2 => "[0, 0] has no direction",
                _ => "[0, 0, 0] has no direction",
            },
        );
    }

    /// Refuses direction z except in a solid.
    fn is_in(&mut self, key: &str, direction: Direction, space: Space) {
        self.require(
            direction.axis() < space.dimension(),
            key,
            format!("\"z\" is no direction where kind = \"{}\"", space.name()),
        );
    }

    fn contact(&mut self, key: &str, contact: &Contact, space: Space) {
        self.set_name(&format!("{key}.first"), &contact.first);
        self.set_name(&format!("{key}.second"), &contact.second);
        self.require(
            contact.first != contact.second,
            format!("{key}.second"),
            format!(
                "\"{}\" cannot touch itself; name another surface",
                contact.second
            ),
        );
        if let Some(nodes) = &contact.nodes {
            self.set_name(&format!("{key}.nodes"), nodes);
        }
        if let Some(normal) = contact.normal {
            self.vector(&format!("{key}.normal"), normal, space);
            self.is_direction(&format!("{key}.normal"), normal);
        }
        if let Some(stiffness) = contact.stiffness {
            self.stress(format!("{key}.stiffness"), stiffness);
        }
        for (name, field) in contact.fields() {
            let key = format!("{key}.{name}");
            // Fields that are not uniform are checked later, at the nodes.
            if let Some(value) = field.uniform() {
                let other = Contact::instead_of_negative(name);
                self.require(
                    value >= 0.0,
                    key.as_str(),
                    format!("{} is negative; {other}", exact(value)),
                );
            }
            self.field(&key, field, space);
        }
    }

    /// Requires a formula to use the names of the position only.
    fn field(&mut self, key: &str, field: &Field, space: Space) {
        if let (Field::Formula(_), Err(wrong)) = (field, field.function(space).map(drop)) {
            self.problem(key, wrong);
        }
    }

    fn tie(&mut self, key: &str, tie: &Tie) {
        self.set_name(&format!("{key}.first"), &tie.first);
        self.set_name(&format!("{key}.second"), &tie.second);
        self.require(
            tie.first != tie.second,
            format!("{key}.second"),
            format!(
                "\"{}\" cannot be tied to itself; name another surface",
                tie.second
            ),
        );
        if let Some(distance) = tie.distance {
            self.at_least(format!("{key}.distance"), distance, 0.0);
        }
    }

    fn equation(&mut self, key: &str, equation: &Equation, space: Space) {
        self.require(
            equation.terms.len() >= 2,
            format!("{key}.terms"),
            "an equation has at least two terms; hold what is to be zero by a support",
        );
        for (k, term) in equation.terms.iter().enumerate() {
            let key = format!("{key}.terms.{k}");
            self.term(&key, term, space);
            self.require(
                k > 0 || term.coefficient != 0.0,
                format!("{key}.coefficient"),
                "is 0; that of the first term, which follows the others, is not",
            );
        }
    }

    fn term(&mut self, key: &str, term: &EquationTerm, space: Space) {
        self.set_name(&format!("{key}.on"), &term.on);
        self.is_in(&format!("{key}.direction"), term.direction, space);
    }

    /// Checks a prescribed difference of displacements.
    fn relative(&mut self, key: &str, relative: &Relative, space: Space) {
        self.is_in(&format!("{key}.direction"), relative.direction, space);
        for (k, term) in relative.terms.iter().enumerate() {
            self.term(&format!("{key}.terms.{k}"), term, space);
        }
    }

    fn load(&mut self, key: &str, load: &Load, kind: Space) {
        self.set_name(&format!("{key}.on"), &load.on);
        self.exactly_one(
            key,
            "load kind",
            &[
                ("force", load.force.is_some()),
                ("pressure", load.pressure.is_some()),
                ("traction", load.traction.is_some()),
                ("kirsch", load.kirsch.is_some()),
                ("displacement", load.displacement.is_some()),
                ("relative", load.relative.is_some()),
                ("plane_force", load.plane_force.is_some()),
                ("acceleration", load.acceleration.is_some()),
                ("rotation", load.rotation.is_some()),
                ("temperature", load.temperature.is_some()),
                ("gap", load.gap.is_some()),
            ],
        );
        if let Some(displacement) = &load.displacement {
            let key = format!("{key}.displacement");
            self.require(
                displacement.components().iter().any(Option::is_some),
                key.as_str(),
                match kind.is_solid() {
                    true => "has no component; give x, y, z or some of them",
                    false => "has no component; give x, y or both",
                },
            );
            if displacement.z.is_some() {
                self.is_in(&key, Direction::Z, kind);
            }
        }
        if let Some(relative) = &load.relative {
            self.relative(&format!("{key}.relative"), relative, kind);
        }
        if let Some(rotation) = load.rotation {
            self.rotation(&format!("{key}.rotation"), &rotation, kind);
        }
        for (name, field) in load.fields() {
            self.field(&format!("{key}.{name}"), field, kind);
        }
        if let (Some(given), Space::Axisymmetric) = (load.acceleration, kind) {
            self.require(
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
                self.components(&format!("{key}.{name}"), count, kind);
            }
        }
        if let Some(plane) = load.plane_force {
            self.is_in(
                &format!("{key}.plane_force.direction"),
                plane.direction,
                kind,
            );
        }
        if let Some(kirsch) = load.kirsch {
            self.at_least(format!("{key}.kirsch.radius"), kirsch.radius, 0.0);
            self.require(
                matches!(kind, Space::PlaneStrain | Space::PlaneStress),
                format!("{key}.kirsch"),
                format!("is the field of a plane model; this one is {}", kind.name()),
            );
        }
        self.history(key, &load.history);
    }

    fn rotation(&mut self, key: &str, rotation: &Rotation, space: Space) {
        let axis = format!("{key}.axis");
        match rotation.axis {
            Some([x, y, z]) if space.is_solid() => self.is_direction(&axis, [x, y, z].into()),
            Some(_) => self.problem(
                axis,
                "is for solids; plane models turn in their plane, axisymmetric ones about their \
                 axis",
            ),
            None => self.require(
                !space.is_solid(),
                axis,
                "is missing; give the direction of the axis",
            ),
        }
        if let Some(center) = rotation.center {
            let key = format!("{key}.center");
            self.vector(&key, center, space);
            self.require(
                !space.is_axisymmetric(),
                key,
                "has no meaning: axisymmetric models turn about their own axis",
            );
        }
    }

    fn history(&mut self, key: &str, history: &History) {
        if let History::Table(rows) = history {
            let key = format!("{key}.history");
            self.require(
                !rows.is_empty(),
                key.as_str(),
                "is empty; give rows of [load factor, multiple]",
            );
            for (index, pair) in rows.windows(2).enumerate() {
                self.require(
                    pair[1][0] > pair[0][0],
                    format!("{key}.{}", index + 1),
                    format!(
                        "load factor {} must be greater than {} of the row before",
                        exact(pair[1][0]),
                        exact(pair[0][0])
                    ),
                );
                if pair[1][0] > pair[0][0] {
                    let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
                    let key = format!("{key}.{}", index + 1);
                    self.slope(key, "the slope from the row before", slope);
                }
            }
        }
    }
}
