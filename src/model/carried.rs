//! What one leg of the program leaves to the next, in which other supports hold the model.
//!
//! Displacements are total ones in every leg. At the load factor `a` at which a leg begins, with
//! displacements `u_a`:
//!
//! ```text
//! a support that begins         u(t) = u_a
//! a prescribed displacement     u(t) = u_a (b - t)/(b - a) + u_b (t - a)/(b - a),   a <= t <= b
//! that begins                   with the next row of its history, u_b at b
//! a support that ends           f(t) = f_a (c - t)/(c - a),   a <= t <= c
//! ```
//!
//! with the support forces `f_a` at its end, and the load factor `c` at which they have been taken
//! away. The displacements `u_a`, and the support forces, are load cases of their own.

use super::given::Given;
use super::loads::{LoadCase, on_freedoms};
use super::{Freedoms, Model, Origin};
use crate::deck::words;
use crate::error::{Error, ErrorKind, Result};
use crate::number::significant;
use crate::scene::{History, Load, Scene, Support};
use crate::space::{Vector, along, length};
use serde::{Deserialize, Serialize};

/// What one leg of the program leaves to the next.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Carried {
    /// Load factor at which the next leg begins.
    pub(crate) at: f64,
    /// Displacements of all nodes.
    displacements: Vec<Vector>,
    /// Forces of supports that have ended.
    released: Vec<Released>,
}

/// Forces of supports that have ended.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Released {
    /// Load factors at which the supports ended, and at which nothing is left of the forces.
    until: [f64; 2],
    /// Force on the control point of each node.
    forces: Vec<(usize, Vector)>,
}

impl Carried {
    /// Whether all data are those of a mesh with so many nodes.
    pub(super) fn is_of(&self, n_nodes: usize) -> bool {
        let forces = self.released.iter().flat_map(|released| &released.forces);
        let mut nodes = forces.map(|(node, _)| *node);
        self.displacements.len() == n_nodes && nodes.all(|node| node < n_nodes)
    }

    /// Number of the load case of supports that hold nodes where they were.
    pub(super) fn held_case(scene: &Scene) -> usize {
        scene.load.len()
    }

    /// Displacement of a node at the beginning of the leg.
    pub(super) fn of_node(&self, node: usize) -> Vector {
        self.displacements[node]
    }

    /// Loads of the scene whose nodes are on their way to the values of their histories, with the
    /// number of the load case for the displacements from which they come.
    fn on_their_way(&self, scene: &Scene) -> Vec<(usize, usize, f64)> {
        let is_on_its_way = |load: &Load| {
            let arrives = load.arrives().filter(|arrives| self.at < *arrives);
            arrives.filter(|_| load.span().holds_from(self.at))
        };
        let loads = scene.load.iter().enumerate();
        let found = loads.filter_map(|(index, load)| Some((index, is_on_its_way(load)?)));
        let first = Self::held_case(scene) + 1;
        let numbered = found.enumerate();
        numbered
            .map(|(k, (index, arrives))| (index, first + k, arrives))
            .collect()
    }

    /// What a load of the scene prescribes, by the numbers of load cases: where its nodes came to
    /// be, `before`, or a sum of shares of this and of the `value` at its factor 1. `None` if it is
    /// the value alone, or if the load does not hold in this leg.
    pub(super) fn taken_over(
        &self,
        scene: &Scene,
        load: usize,
        [value, before]: [f64; 2],
    ) -> Option<Vec<(usize, f64)>> {
        let entry = &scene.load[load];
        if entry.stays() && entry.span().holds_from(self.at) {
            return Some(vec![(Self::held_case(scene), before)]);
        }
        let mut all = self.on_their_way(scene).into_iter();
        let (_, origin, _) = all.find(|(index, ..)| *index == load)?;
        Some(vec![(load, value), (origin, before)])
    }

    /// Adds the load cases of what was carried over, and lets loads whose nodes come from elsewhere
    /// begin with nothing.
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

impl Model {
    /// Load factor at which the leg of the program begins in which the model's supports hold.
    pub(super) fn start_of_leg(&self) -> f64 {
        match &self.origin {
            Origin::Arrays(given) => given.carried.as_ref().map_or(0.0, |carried| carried.at),
            Origin::Scene => 0.0,
        }
    }

    /// Load factor at which the leg of the program ends in which the model's supports hold; `None`
    /// if it is the last.
    pub(crate) fn end_of_leg(&self) -> Option<f64> {
        let mut changes = self.scene.changes_of_support().into_iter();
        changes.find(|change| *change > self.start_of_leg())
    }

    /// Number of the program's targets that are reached once the leg ends.
    pub(crate) fn targets_up_to_end_of_leg(&self) -> usize {
        let targets = &self.scene.program.targets;
        let Some(end) = self.end_of_leg() else {
            return targets.len();
        };
        let factors = targets.iter().filter_map(|target| target.load_factor);
        factors.filter(|factor| *factor <= end).count()
    }

    /// The model of the next leg, which begins at the load factor `at` from the given displacements
    /// of all nodes, the external forces on them, and the factors of the loads.
    ///
    /// # Errors
    /// Errors of [`Model::new`], for the supports of the next leg.
    pub(crate) fn next_leg(
        &self,
        at: f64,
        (displacements, external): (Vec<Vector>, Vec<Vector>),
        factors: &[f64],
    ) -> Result<Model> {
        let mut given = self.given();
        let earlier = given.carried.take().unwrap_or_default();
        let on_supports = self.less_loads(external, factors);
        let mut released = earlier.released;
        released.retain(|released| at < released.until[1]);
        released.extend(self.ending_at(at, &on_supports));
        given.carried = Some(Carried {
            at,
            displacements,
            released,
        });
        self.of_leg(given, at)
    }

    /// Checks that the model can be built for all later legs of the program.
    ///
    /// # Errors
    /// Errors of [`Model::next_leg`].
    pub(super) fn check_later_legs(&self) -> Result<()> {
        for at in self.scene.changes_of_support() {
            let mut given = self.given();
            given.carried = Some(Carried {
                at,
                displacements: vec![[0.0; 3]; self.mesh.n_nodes()],
                released: Vec::new(),
            });
            self.of_leg(given, at)?;
        }
        Ok(())
    }

    /// Builds the model of a later leg; fails if contact nodes differ or pins are new.
    fn of_leg(&self, given: Given, at: f64) -> Result<Model> {
        let made = Self::resolve(&self.scene, self.mesh.clone(), Origin::Arrays(given));
        let mut next = made.map_err(|error| words::of_deck(&self.scene, error))?;
        for text in &mut next.warnings {
            *text = words::text_of_deck(&self.scene, text);
        }
        let slaves = |model: &Model| -> Vec<usize> {
            let pairs = model.pairs.iter();
            pairs.map(|pair| pair.slave).collect()
        };
        let at = significant(at, 6);
        if slaves(self) != slaves(&next) {
            return Err(Error::new(
                ErrorKind::Unsupported,
                format!(
                    "with the supports from load factor {at} on, other nodes are in contact than \
                     before"
                ),
            ));
        }
        let mut pins = next.floating.pins.iter();
        match pins.find(|pin| !self.floating.pins.contains(pin)) {
            None => Ok(next),
            Some(pin) => Err(Error::new(
                ErrorKind::Unheld,
                format!(
                    "{}: nothing holds this motion from load factor {at} on, at which supports \
                     end; add a support or a contact",
                    pin.motion
                ),
            )),
        }
    }

    /// Forces on control points that are not those of loads, from the external forces on all nodes.
    fn less_loads(&self, mut external: Vec<Vector>, factors: &[f64]) -> Vec<Vector> {
        self.freedoms.basis.share(&mut external);
        // The forces of free strains stand for stresses, and are not external.
        let acting = self.loads.iter().zip(factors);
        for (load, &factor) in acting.filter(|(load, _)| load.free_strain.is_empty()) {
            for &(node, force) in load.nodal() {
                external[node] = along(external[node], -factor, force);
            }
        }
        external
    }

    /// The forces of supports, equations and prescribed displacements, if any of them ends at a
    /// load factor. Those that go on bear the same forces in the next leg, in which these forces do
    /// no work. All nodes are taken: the middle of an edge that is held acts on its ends, too.
    fn ending_at(&self, at: f64, forces: &[Vector]) -> Option<Released> {
        let supports = self.scene.support.iter().map(Support::span);
        let spans = supports.chain(self.scene.load.iter().map(Load::span));
        let mut ends = spans.filter_map(|span| span.until);
        let until = ends.find(|until| until[0] == at)?;
        Some(Released {
            until,
            forces: forces.iter().copied().enumerate().collect(),
        })
    }
}
