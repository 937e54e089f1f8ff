//! Targets: from the current load factor to the next state that the program asks for.

use super::aim::Aim;
use super::check::gaps_are_alike;
use super::drive::{Arrival, Monitor, stopped};
use super::engine::Engine;
use super::place::Search;
use super::program::{DOUBLINGS, Run};
use crate::error::{Error, Result};
use crate::scene::{Direction, DisplacementTarget, Kind, Stepping, Target};

impl Run<'_, '_> {
    /// Ends of the straight pieces from the current load factor to `alpha`: the kinks of the loads'
    /// histories in between.
    pub(super) fn stops(&self, alpha: f64) -> Vec<f64> {
        let from = self.engine.at.alpha;
        let mut stops: Vec<f64> = self
            .model()
            .loads
            .iter()
            .flat_map(|l| l.kinks())
            .chain(self.standing.yield_alpha.filter(|_| !self.standing.plastic))
            .filter(|k| (*k - from) * (alpha - *k) > 0.0)
            .collect();
        stops.sort_by(|a, b| a.total_cmp(b));
        if alpha < from {
            stops.reverse();
        }
        stops.dedup();
        stops.push(alpha);
        stops
    }

    /// Drives to a load factor along straight pieces between the kinks of the loads' histories.
    /// Wherever the path leaves what the search for the yield load went through, it is watched for
    /// first yield.
    pub(super) fn drive_to_factor(
        &mut self,
        alpha: f64,
        monitor: Option<&Monitor>,
    ) -> Result<Arrival> {
        // A run that goes on has the stops of its begin.
        let left = self
            .resumed
            .as_mut()
            .map(|place| std::mem::take(&mut place.stops));
        let stops = left.filter(|stops| !stops.is_empty());
        let stops = stops.unwrap_or_else(|| self.stops(alpha));
        for (i, &stop) in stops.iter().enumerate() {
            self.place.stops = stops[i..].to_vec();
            let end = self.engine.point(stop);
            loop {
                let [low, high] = self.standing.elastic_range;
                let from = self.engine.at.alpha;
                let known = from.min(stop) >= low && from.max(stop) <= high;
                let resumed = self.resumed.as_ref().and_then(|place| place.drive.as_ref());
                let watch_yield =
                    resumed.map_or(!self.standing.plastic && !known, |d| d.watch_yield);
                match self.drive(&end, monitor, watch_yield)? {
                    Arrival::End => break,
                    Arrival::Yield(peak) => {
                        self.record_yield(peak)?;
                        self.standing
                            .yield_alpha
                            .get_or_insert(self.engine.at.alpha);
                    }
                    Arrival::Stopped => return Err(stopped()),
                    other => return Ok(other),
                }
            }
            if self.standing.yield_alpha == Some(stop) {
                self.standing.plastic = true;
            }
        }
        Ok(Arrival::End)
    }

    fn aim_at_factor(&mut self, to: f64) {
        let from = self.engine.at.alpha;
        let power = self.changes_by_load();
        self.aim = Aim::Factor { from, to, power };
    }

    /// Power of the load in which changes of contact lie evenly: that of the width of Hertz'
    /// contacts where the contact grows pair by pair.
    fn changes_by_load(&self) -> f64 {
        let model = self.model();
        let mut contacts = model.contacts.iter().map(|c| &model.pairs[c.range.clone()]);
        let grows = model.scene.program.stepping == Stepping::Events
            && contacts.any(|pairs| !gaps_are_alike(pairs));
        match (grows, model.kind) {
            (false, _) => 1.0,
            (true, Kind::Axisymmetric) => 1.0 / 3.0,
            (true, _) => 0.5,
        }
    }

    pub(super) fn reach(&mut self, target: &Target, label: &str) -> Result<()> {
        if target.first_yield {
            let alpha = self.standing.yield_alpha.ok_or_else(|| {
                Error::analysis(format!("target `{label}`: no yield load was found before the program's largest load factor"))
            })?;
            self.aim_at_factor(alpha);
            self.drive_to_factor(alpha, None)?;
            return Ok(());
        }
        if let Some(alpha) = target.load_factor {
            self.aim_at_factor(alpha);
            self.drive_to_factor(alpha, None)?;
            return Ok(());
        }
        if let Some(multiple) = target.half_width {
            let at_yield = self
                .results
                .first_yield
                .map(|y| y.half_width)
                .filter(|b| *b > 0.0)
                .ok_or_else(|| {
                    Error::analysis(format!(
                        "target `{label}`: the contact half width at yield is not known"
                    ))
                })?;
            let goal = multiple * at_yield;
            // Relative, so that the accuracy of the search does not depend on units.
            let monitor =
                move |engine: &mut Engine| Ok(engine.contact_figures().half_width / goal - 1.0);
            let upward = self.engine.contact_figures().half_width < goal;
            return self.search(&monitor, upward, 1.0, label);
        }
        match &target.displacement {
            Some(goal) => self.reach_displacement(goal, label),
            None => Err(Error::input(format!("target `{label}` has no condition"))),
        }
    }

    /// Moves on until the mean displacement of a set has a value.
    fn reach_displacement(&mut self, goal: &DisplacementTarget, label: &str) -> Result<()> {
        let nodes = self.model().mesh.set_nodes(&goal.on).ok_or_else(|| {
            Error::input(format!(
                "target `{label}`: the mesh has no set `{}`",
                goal.on
            ))
        })?;
        let direction = usize::from(goal.direction == Direction::Y);
        let value = goal.value;
        let distance = move |engine: &mut Engine| -> Result<f64> {
            let u = engine.all_displacements()?;
            let (freedoms, factors) = (&engine.model.freedoms, &engine.at.factors);
            let along = |&n: &usize| freedoms.displacement(n, &u, factors)[direction];
            Ok(nodes.iter().map(along).sum::<f64>() / nodes.len() as f64 - value)
        };
        let resumed = self.resumed.as_ref().and_then(|place| place.search);
        let scale = match resumed {
            Some(search) => search.scale,
            None => value.abs().max(distance(&mut self.engine)?.abs()),
        };
        let monitor = move |engine: &mut Engine| {
            let off = distance(engine)?;
            Ok(if scale > 0.0 { off / scale } else { off })
        };
        if let Some(search) = resumed {
            return self.search(&monitor, search.upward, scale, label);
        }
        let here = monitor(&mut self.engine)?;
        let ahead = {
            let alpha = self.engine.at.alpha;
            let probe = self.engine.point(alpha + 1e-3 * alpha.abs().max(1.0));
            let saved = (self.engine.at.clone(), self.engine.now.clone());
            let initial = self.engine.now.initial.clone();
            self.engine.now = self.engine.respond(&probe, initial);
            self.engine.at = probe;
            let value = monitor(&mut self.engine);
            (self.engine.at, self.engine.now) = saved;
            value?
        };
        let upward = (ahead - here) * here <= 0.0;
        self.search(&monitor, upward, scale, label)
    }

    /// Moves the load factor up (doubling) or down to zero until the monitored quantity, measured
    /// against `scale`, vanishes.
    pub(super) fn search(
        &mut self,
        monitor: &Monitor,
        upward: bool,
        scale: f64,
        label: &str,
    ) -> Result<()> {
        self.aim = Aim::Monitored { at_first: None };
        let resumed = self.resumed.as_mut().and_then(|place| place.search.take());
        // One that goes on is on the way to the end that it had.
        let mut under_way = resumed.is_some();
        let mut search = resumed.unwrap_or(Search {
            end: self.engine.at.alpha,
            rounds: 0,
            upward,
            scale,
        });
        while search.rounds < DOUBLINGS {
            if !under_way {
                search.end = match (search.upward, search.end > 0.0) {
                    (true, _) => {
                        2.0 * search
                            .end
                            .max(0.5 * self.standing.yield_alpha.unwrap_or(1.0))
                    }
                    (false, true) => 0.0,
                    (false, false) => break,
                };
            }
            under_way = false;
            self.place.search = Some(search);
            search.rounds += 1;
            match self.drive_to_factor(search.end, Some(monitor))? {
                Arrival::Monitor => return Ok(()),
                Arrival::End => {}
                _ => return Err(stopped()),
            }
        }
        let off = monitor(&mut self.engine)?;
        Err(Error::analysis(format!(
            "target `{label}` was never reached: the load factor went to {:.6} and the target quantity is still off by {off:.6e}",
            self.engine.at.alpha
        )))
    }
}
