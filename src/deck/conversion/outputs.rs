//! Which results each step asks for.

use super::super::Deck;
use super::super::data::{Account, Group, OutputRequest, Schedule, Step, Target};
use super::super::sets::What;
use super::Options;
use crate::error::Result;
use crate::scene::{FileRequest, Moment, NamedSet, Print, Requests, ResultItem};
use crate::space::Space;
use std::sync::Arc;

/// Times closer to an end of a step than this share of it are that end.
const CLOSE: f64 = 1e-9;
/// Most time points of a step that are taken over.
const MOST_INSTANTS: usize = 1000;

/// The requests that hold in a step. Those of a group stay until a step asks for the group anew.
struct InForce<'d> {
    requests: Vec<&'d OutputRequest>,
    /// The last one that was named holds for all requests.
    schedule: Schedule,
}

impl<'d> InForce<'d> {
    fn renew(&mut self, of_step: &'d [OutputRequest]) {
        let alike =
            |a: &OutputRequest, b: &OutputRequest| (a.group, a.is_print) == (b.group, b.is_print);
        self.requests
            .retain(|old| !of_step.iter().any(|new| alike(old, new)));
        self.requests.extend(of_step);
        let from_last = of_step.iter().rev();
        let mut named = from_last.filter_map(|request| request.schedule.as_ref());
        if let Some(last) = named.next() {
            self.schedule = last.clone();
        }
    }
}

impl Deck {
    /// What is asked for, increment by increment.
    pub(super) fn requests(
        &self,
        (space, thickness): (Space, f64),
        options: Options,
        account: &mut Account,
    ) -> Result<Requests> {
        let is_plane = matches!(space, Space::PlaneStrain | Space::PlaneStress);
        let mut out = Requests {
            heading: self.heading.clone(),
            materials: self.material_names(),
            thickness: is_plane.then_some(thickness),
            ..Requests::default()
        };
        let mut in_force = InForce {
            requests: Vec::new(),
            schedule: Schedule::Every(1),
        };
        let mut start = 0.0;
        for (number, (step, end)) in self.program.steps.iter().zip(self.step_ends()).enumerate() {
            in_force.renew(&step.outputs);
            let instants = match options.increments && self.is_nonlinear() {
                true => self.instants(step, &in_force.schedule, start),
                false => vec![(1, step.period)],
            };
            for (index, &(increment, step_time)) in instants.iter().enumerate() {
                let is_last = index + 1 == instants.len();
                let mut moment = Moment {
                    step: number + 1,
                    increment,
                    time: Some(if is_last { end } else { start + step_time }),
                    step_time,
                    ..Moment::default()
                };
                for request in &in_force.requests {
                    self.add_request(request, &mut moment, account)?;
                }
                moment.file.sort_by_key(|request| request.item);
                out.moments.push(moment);
            }
            start = end;
        }
        let needs_points = |moment: &Moment| {
            let of_file = moment.file.iter().map(|request| request.item);
            let mut items = of_file.chain(moment.prints.iter().map(|print| print.item));
            items.any(ResultItem::needs_points)
        };
        out.point_values = out.moments.iter().any(needs_points);
        Ok(out)
    }

    /// Whether a step is more than one solution of linear equations.
    fn is_nonlinear(&self) -> bool {
        let mut materials = self.properties.materials.iter();
        !self.properties.contacts.is_empty() || materials.any(|(_, of)| !of.plastic.is_empty())
    }

    /// Increments of a step that results are asked for: number and time of the step, its end last.
    fn instants(&self, step: &Step, schedule: &Schedule, start: f64) -> Vec<(usize, f64)> {
        let mut out = Vec::new();
        match schedule {
            Schedule::Every(every) => {
                if let Some(time) = step.fixed {
                    let all = (1..step.increments).filter(|k| k.is_multiple_of(*every));
                    out.extend(all.map(|k| (k, time * k as f64)));
                    out.push((step.increments, step.period));
                } else {
                    out.push((1, step.period));
                }
            }
            Schedule::At(name) => {
                let points = self.program.time_points.get(name).into_iter();
                let times = points.flat_map(|points| {
                    let shift = if points.is_total { start } else { 0.0 };
                    points.times.iter().map(move |time| time - shift)
                });
                let least = CLOSE * step.period;
                let within = times.filter(|time| (least..step.period - least).contains(time));
                let within = within.take(MOST_INSTANTS);
                out.extend((1..).zip(within.chain([step.period])));
            }
        }
        out
    }

    /// Materials, then surface interactions, in the order of the deck.
    fn material_names(&self) -> Vec<String> {
        let properties = &self.properties;
        let materials = properties.materials.iter();
        let mut out: Vec<_> = materials.map(|(name, of)| (of.place, name)).collect();
        let interactions = properties.interactions.iter();
        out.extend(interactions.map(|(name, of)| (of.place, name)));
        out.sort();
        out.into_iter().map(|(_, name)| name.to_string()).collect()
    }

    fn add_request(
        &self,
        request: &OutputRequest,
        moment: &mut Moment,
        account: &mut Account,
    ) -> Result<()> {
        let Some(set) = self.named_set(request, account)? else {
            return Ok(());
        };
        for &item in &request.items {
            match (&set, request.is_print) {
                (_, false) => {
                    moment.file.retain(|known| known.item != item);
                    let nodes = set.clone();
                    moment.file.push(FileRequest { item, nodes });
                }
                // Gap and pressure are one table each, whichever of them is named.
                (Some(_), true)
                    if item == ResultItem::Contact
                        && moment.prints.iter().any(|print| print.item == item) => {}
                (Some(set), true) => moment.prints.push(Print {
                    item,
                    set: set.clone(),
                    totals: request.totals,
                }),
                (None, true) => {}
            }
        }
        Ok(())
    }

    /// The set that a request is for: `Some(None)` where it is for all, `None` where it is for a
    /// set that there is not, which is a remark.
    fn named_set(
        &self,
        request: &OutputRequest,
        account: &mut Account,
    ) -> Result<Option<Option<NamedSet>>> {
        let (what, keyword, sets) = match (request.group, request.is_print) {
            (Group::Element, true) => (What::Elements, "EL PRINT", &self.sets.elements),
            (Group::Element, false) => (What::Nodes, "EL FILE", &self.sets.nodes),
            (Group::Node, true) => (What::Nodes, "NODE PRINT", &self.sets.nodes),
            (Group::Node, false) => (What::Nodes, "NODE FILE", &self.sets.nodes),
            (Group::Contact, true) => (What::Nodes, "CONTACT PRINT", &self.sets.nodes),
            (Group::Contact, false) => (What::Nodes, "CONTACT FILE", &self.sets.nodes),
        };
        let mut remark = |text: &str| {
            let list = &mut account.ignored;
            Account::add(list, &self.files, request.place, keyword, text);
        };
        let Some(name) = &request.set else {
            if (request.group, request.is_print) == (Group::Contact, true) {
                let (name, labels) = (String::new(), Arc::default());
                return Ok(Some(Some(NamedSet { name, labels })));
            }
            if request.is_print {
                remark("no set is named: nothing is printed for it");
            }
            return Ok(Some(None));
        };
        let Some(written) = sets.written(name) else {
            remark(&format!(
                "there is no set {name}: nothing is written for it"
            ));
            return Ok(None);
        };
        let target = Target::Set(name.clone());
        let found = self.indices(what, &target, (request.place, keyword))?;
        let label = |index: &u32| match what {
            What::Nodes => self.node_label(*index as usize),
            What::Elements => self.element_label(*index as usize),
        };
        Ok(Some(Some(NamedSet {
            name: written.to_uppercase(),
            labels: Arc::new(found.iter().map(label).collect()),
        })))
    }
}
