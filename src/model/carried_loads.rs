//! Load cases of the displacements and support forces that an earlier leg of the program has left.

use super::carried::Carried;
use super::freedoms::Freedoms;
use super::load_case::{LoadCase, on_freedoms};
use crate::scene::{History, Scene};
use crate::space::length;

impl Carried {
    /// Adds the load cases of the displacements and forces carried over. The factor of a load
    /// begins at zero if its nodes are still on their way to the prescribed value.
    pub(super) fn add_cases(
        &self,
        scene: &Scene,
        (loads, freedoms): (&mut Vec<LoadCase>, &Freedoms),
    ) {
        let largest = self
            .displacements
            .iter()
            .map(|u| length(*u))
            .fold(0.0, f64::max);
        let displaced = |name: &str, history: History| LoadCase {
            magnitude: largest,
            ..LoadCase::carried(name, history)
        };
        for (load, entry) in loads.iter_mut().zip(&scene.load) {
            if entry.stays() {
                load.magnitude = 0.0;
            }
        }
        let held = displaced("displacements at which supports begin", History::Constant);
        loads.push(held);
        for (index, _, arrives) in self.on_their_way(scene) {
            let load = &mut loads[index];
            let name = format!("displacements from which {} begins", load.name);
            if let History::Table(rows) = &mut load.history {
                rows.retain(|row| row[0] >= arrives);
                rows.insert(0, [self.at, 0.0]);
            }
            let leaves = History::Table(vec![[self.at, 1.0], [arrives, 0.0]]);
            loads.push(displaced(&name, leaves));
        }
        for released in &self.released {
            let [from, gone] = released.until;
            let history = History::Table(vec![[from, 1.0], [gone, 0.0]]);
            let mut case = LoadCase::carried("forces of supports that have ended", history);
            let sizes = released.forces.iter().map(|(_, force)| length(*force));
            case.magnitude = sizes.sum();
            case.nodal.clone_from(&released.forces);
            case.forces = on_freedoms(&case.nodal, freedoms);
            loads.push(case);
        }
    }
}
