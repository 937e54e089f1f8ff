//! Rigid motions of bodies in words, for messages.

use super::motions::{Mode, Motions};
use crate::space::{self, RigidMotion};

impl Motions<'_> {
    /// Names the bodies that move in a mode, and their motion.
    pub(super) fn describe(&self, mode: &Mode) -> String {
        let groups = self.moved(mode);
        let bodies: Vec<String> = groups
            .iter()
            .flat_map(|&g| self.names[g].iter())
            .map(|n| format!("`{n}`"))
            .collect();
        let first = groups.first().copied().unwrap_or(0);
        let motion = self.in_words(mode, first);
        let together = if groups.len() > 1 { " together" } else { "" };
        format!(
            "bod{} {} can {motion}{together}",
            if groups.len() > 1 { "ies" } else { "y" },
            bodies.join(" and ")
        )
    }

    /// Describes the motion of a group in a mode.
    fn in_words(&self, mode: &Mode, group: usize) -> String {
        let motions = self.space.rigid_motions();
        let (mut shift, mut turn) = ([0.0; 3], [0.0; 3]);
        for (m, motion) in motions.iter().enumerate() {
            let share = mode.at(motions.len() * group + m);
            match *motion {
                RigidMotion::Along(axis) => shift[axis] = share,
                RigidMotion::About(axis) => turn[axis] = share,
            }
        }
        let axes = self.space.axes();
        let (size, s) = (self.size[group], 2.0 / self.size[group]);
        let angle = space::length(turn);
        if angle > 1e-6 * mode.largest() {
            // Point nearest to the centre that the rotation leaves in place or moves along its
            // axis.
            let arm = space::cross(turn, shift).map(|x| x / (s * angle * angle));
            let at: Vec<String> = (0..axes.len())
                .map(|d| format!("{:.4}", tidy(self.center[group][d] + arm[d], size)))
                .collect();
            let at = at.join(", ");
            if !self.space.is_solid() {
                return format!("rotate about ({at})");
            }
            let axis = turn.map(|t| tidy(t / angle, 1.0));
            return match (0..3).find(|&d| axis[d].abs() == space::length(axis)) {
                Some(d) => format!("rotate about {} through ({at})", axes[d]),
                None => format!(
                    "rotate about ({:.3}, {:.3}, {:.3}) through ({at})",
                    axis[0], axis[1], axis[2]
                ),
            };
        }
        let far = space::length(shift);
        if self.space.is_axisymmetric() {
            return "move along the axis".to_string();
        }
        match (0..axes.len()).find(|&d| shift[d].abs() >= (1.0 - 1e-12) * far) {
            Some(d) => format!("move along {}", axes[d]),
            None => {
                let along: Vec<String> = (shift.iter().take(axes.len()))
                    .map(|x| format!("{:.3}", tidy(*x, far)))
                    .collect();
                format!("move along ({})", along.join(", "))
            }
        }
    }
}

/// Sets a coordinate to zero if it is only round-off for a body of this size.
fn tidy(coordinate: f64, size: f64) -> f64 {
    if coordinate.abs() < 1e-9 * size {
        0.0
    } else {
        coordinate
    }
}
