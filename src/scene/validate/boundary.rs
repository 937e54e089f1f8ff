//! Contact, supports and loads.

use super::Checks;
use crate::scene::{Contact, History, Load, Scene};
use crate::space::Space;
use crate::text::exact;
use std::collections::BTreeSet;

impl Checks {
    pub(super) fn boundary(&mut self, scene: &Scene) {
        for (index, contact) in scene.contact.iter().enumerate() {
            self.contact(&format!("contact.{index}"), contact);
        }
        for (index, support) in scene.support.iter().enumerate() {
            let key = format!("support.{index}");
            self.set_name(&format!("{key}.on"), &support.on);
            self.require(
                !support.fix.is_empty(),
                format!("{key}.fix"),
                "is empty; give \"x\", \"y\" or both",
            );
            let repeated =
                (1..support.fix.len()).any(|i| support.fix[..i].contains(&support.fix[i]));
            self.require(!repeated, format!("{key}.fix"), "names a direction twice");
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

    /// A set's name cannot be looked up before there is a mesh, but it can be missing.
    fn set_name(&mut self, key: &str, name: &str) {
        self.require(
            !name.is_empty(),
            key,
            "is empty; name a surface or node set of the mesh",
        );
    }

    fn contact(&mut self, key: &str, contact: &Contact) {
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
        if let Some(normal) = contact.normal {
            self.require(
                normal != [0.0, 0.0],
                format!("{key}.normal"),
                "[0, 0] has no direction",
            );
        }
        if let Some(gap) = contact.gap {
            self.require(
                gap >= 0.0,
                format!("{key}.gap"),
                format!(
                    "{} is negative; an overlap is given by `interference`",
                    exact(gap)
                ),
            );
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
                ("plane_force", load.plane_force.is_some()),
            ],
        );
        if let Some(displacement) = load.displacement {
            self.require(
                displacement.x.is_some() || displacement.y.is_some(),
                format!("{key}.displacement"),
                "has no component; give x, y or both",
            );
        }
        if let Some(kirsch) = load.kirsch {
            self.at_least(format!("{key}.kirsch.radius"), kirsch.radius, 0.0);
            self.require(
                !kind.is_axisymmetric(),
                format!("{key}.kirsch"),
                "is the field of a plane model; this one is axisymmetric",
            );
        }
        if let History::Table(rows) = &load.history {
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
