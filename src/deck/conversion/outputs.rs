//! The results that each step requests.

use super::super::Deck;
use super::super::constraints::local_axes;
use super::super::data::{
    Account, DeckStep, EntitySelection, Group, Named, OutputRequest, Properties, Schedule,
    TimePoints,
};
use super::super::sets::What;
use crate::error::Result;
use crate::scene::{FileRequest, Moment, NamedSet, Print, Requests, ResultItem};
use crate::space::Space;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Distance from the end of a step, as a fraction of the step, up to which a time counts as the
/// end.
const CLOSE: f64 = 1e-9;
/// Largest number of increments at which results may be requested.
const MOST_MOMENTS: usize = 10_000;

/// The requests in force in a step. Requests of a group remain until a step makes new requests for
/// the group.
struct InForce<'d> {
    requests: Vec<&'d OutputRequest>,
    /// Schedule for all requests.
    schedule: Schedule,
}

impl<'d> InForce<'d> {
    fn renew(&mut self, step: &'d DeckStep) {
        let of_step = &step.outputs;
        let alike =
            |a: &OutputRequest, b: &OutputRequest| (a.group, a.is_print) == (b.group, b.is_print);
        self.requests
            .retain(|old| !of_step.iter().any(|new| alike(old, new)));
        self.requests.extend(of_step);
        if let Some(schedule) = &step.schedule {
            self.schedule = schedule.clone();
        }
    }

    /// Increments of a step at which results are requested: number and time within the step; the
    /// last is the end of the step.
    fn instants(
        &self,
        step: &DeckStep,
        start: f64,
        time_points: &Named<TimePoints>,
    ) -> Vec<(usize, f64)> {
        let mut out = Vec::new();
        match &self.schedule {
            Schedule::Every(every) => {
                let Some(time) = step.fixed else {
                    return vec![(1, step.period)];
                };
                // The tolerance allows for an increment that is a rounded fraction of the step's
                // time.
                let n = (step.period / time - 1e-6).ceil().max(1.0) as usize;
                let every = if *every == 0 { n } else { *every };
                let within = (every..n).step_by(every).take(MOST_MOMENTS);
                out.extend(within.map(|k| (k, time * k as f64)));
                out.push((n, step.period));
            }
            Schedule::At(name) => {
                let points = time_points.get(name).into_iter();
                let times = points.flat_map(|points| {
                    let shift = if points.is_total { start } else { 0.0 };
                    points.times.iter().map(move |time| time - shift)
                });
                let least = CLOSE * step.period;
                let within = times.filter(|time| (least..step.period - least).contains(time));
                out.extend((1..).zip(within.chain([step.period])));
            }
        }
        out
    }
}

/// The results that a deck requests, at each increment that leaves a state or at steps alone.
pub(super) fn requests(
    deck: &Deck,
    (space, thickness): (Space, f64),
    by_increments: bool,
    account: &mut Account,
) -> Result<Requests> {
    let program = &deck.program;
    let is_plane = matches!(space, Space::PlaneStrain | Space::PlaneStress);
    let mut out = Requests {
        heading: deck.heading.clone(),
        materials: deck.properties.material_names(),
        thickness: is_plane.then_some(thickness),
        ..Requests::default()
    };
    let mut sets = RequestedSets {
        deck,
        account,
        known: BTreeMap::new(),
    };
    let mut in_force = InForce {
        requests: Vec::new(),
        schedule: Schedule::Every(1),
    };
    let mut start = 0.0;
    for (number, (step, end)) in program.steps.iter().zip(program.step_ends()).enumerate() {
        in_force.renew(step);
        let instants = match by_increments && deck.properties.is_nonlinear() {
            true => in_force.instants(step, start, &program.time_points),
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
                add(request, sets.of(request)?, &mut moment);
            }
            // Section prints come after all other prints.
            let prints = &mut moment.prints;
            prints.sort_by_key(|print| print.item == ResultItem::Section);
            moment.file.sort_by_key(|request| request.item);
            out.moments.push(moment);
        }
        if by_increments && out.moments.len() > MOST_MOMENTS {
            let message = format!(
                "results at more than {MOST_MOMENTS} increments are asked for; give a FREQUENCY"
            );
            return Err(deck.error(step.place, "STEP", message));
        }
        start = end;
    }
    let needs_points = |moment: &Moment| {
        let of_file = moment.file.iter().map(|request| request.item);
        let mut items = of_file.chain(moment.prints.iter().map(|print| print.item));
        items.any(ResultItem::needs_points)
    };
    let axes = local_axes(&deck.properties.transforms, deck.lookup())?.into_iter();
    let axes = axes.map(|(node, axes)| (deck.mesh.node_label(node as usize), axes));
    out.axes = Arc::new(axes.collect());
    out.point_values = out.moments.iter().any(needs_points);
    Ok(out)
}

impl Properties {
    /// Whether a step takes more than one linear solution.
    fn is_nonlinear(&self) -> bool {
        let mut materials = self.materials.iter();
        !self.contacts.is_empty() || materials.any(|(_, of)| !of.plastic.is_empty())
    }

    /// Names of materials and surface interactions, in the order of the deck.
    fn material_names(&self) -> Vec<String> {
        let materials = self.materials.iter();
        let mut out: Vec<_> = materials.map(|(name, of)| (of.place, name)).collect();
        let interactions = self.interactions.iter();
        out.extend(interactions.map(|(name, of)| (of.place, name)));
        out.sort();
        out.into_iter().map(|(_, name)| name.to_string()).collect()
    }
}

/// Adds a request to a moment.
fn add(request: &OutputRequest, on: On, moment: &mut Moment) {
    for &item in &request.items {
        match (&on, request.is_print) {
            (On::Nothing, _) | (On::All, true) => {}
            (_, false) => {
                moment.file.retain(|known| known.item != item);
                let nodes = on.clone().set();
                moment.file.push(FileRequest {
                    item,
                    nodes,
                    is_global: request.is_global,
                });
            }
            // Gap and pressure form one table, whichever of them is named.
            (On::Set(_), true)
                if item == ResultItem::Contact
                    && moment.prints.iter().any(|print| print.item == item) => {}
            // Force, moment and area of a surface form one table.
            (On::Section(set, _), true)
                if (moment.prints.iter()).any(|p| p.item == item && p.set.name == set.name) => {}
            (On::Set(set) | On::Section(set, _), true) => moment.prints.push(Print {
                item,
                set: set.clone(),
                totals: request.totals,
                is_global: request.is_global,
                faces: match &on {
                    On::Section(_, faces) => faces.clone(),
                    _ => Arc::default(),
                },
            }),
        }
    }
}

/// The nodes, elements or faces to which a request refers.
#[derive(Debug, Clone)]
enum On {
    All,
    /// A set that does not exist.
    Nothing,
    Set(NamedSet),
    /// A surface, given by its elements and its faces.
    Section(NamedSet, Arc<Vec<(u64, u8)>>),
}

impl On {
    fn set(self) -> Option<NamedSet> {
        match self {
            On::Set(set) | On::Section(set, _) => Some(set),
            On::All | On::Nothing => None,
        }
    }
}

/// The sets to which requests refer; each is looked up once.
struct RequestedSets<'d, 'a> {
    deck: &'d Deck,
    account: &'a mut Account,
    /// Known sets, by whether they are sets of elements and by name in capitals.
    known: BTreeMap<(bool, String), NamedSet>,
}

impl RequestedSets<'_, '_> {
    /// The set of a request. A set that does not exist causes a remark.
    fn of(&mut self, request: &OutputRequest) -> Result<On> {
        let deck = self.deck;
        let keyword = match (request.group, request.is_print) {
            (Group::Element, true) => "EL PRINT",
            (Group::Element, false) => "EL FILE",
            (Group::Node, true) => "NODE PRINT",
            (Group::Node, false) => "NODE FILE",
            (Group::Contact, true) => "CONTACT PRINT",
            (Group::Contact, false) => "CONTACT FILE",
            (Group::Section, _) => return self.section(request),
        };
        let is_of_elements = keyword == "EL PRINT";
        let Some(name) = request.set.as_ref().map(|name| name.to_uppercase()) else {
            if keyword == "CONTACT PRINT" {
                return Ok(self.contact(request));
            }
            if request.is_print {
                self.remark(
                    request,
                    keyword,
                    "no set is named: nothing is printed for it",
                );
            }
            return Ok(On::All);
        };
        let (what, sets) = match is_of_elements {
            true => (What::Elements, &deck.sets.elements),
            false => (What::Nodes, &deck.sets.nodes),
        };
        if sets.get(&name).is_none() {
            let text = format!("there is no set {name}: nothing is written for it");
            self.remark(request, keyword, &text);
            return Ok(On::Nothing);
        }
        let key = (is_of_elements, name.clone());
        if let Some(set) = self.known.get(&key) {
            return Ok(On::Set(set.clone()));
        }
        let target = EntitySelection::Set(name.clone());
        let found = deck
            .lookup()
            .indices(what, &target, (request.place, keyword))?;
        let label = |index: &u32| match what {
            What::Nodes => deck.mesh.node_label(*index as usize),
            What::Elements => deck.mesh.element_label(*index as usize),
        };
        let labels = Arc::new(found.iter().map(label).collect());
        let set = NamedSet { name, labels };
        self.known.insert(key, set.clone());
        Ok(On::Set(set))
    }

    /// The faces of the surface that a request names. A surface that does not exist causes a
    /// remark.
    fn section(&mut self, request: &OutputRequest) -> Result<On> {
        let (deck, keyword) = (self.deck, "SECTION PRINT");
        let name = request.set.clone().unwrap_or_default().to_uppercase();
        if deck.sets.surfaces.get(&name).is_none() {
            let text = format!("there is no surface {name}: nothing is written for it");
            self.remark(request, keyword, &text);
            return Ok(On::Nothing);
        }
        let found = deck.lookup().surface(&name, (request.place, keyword))?;
        let label =
            |&(element, local): &(u32, u8)| (deck.mesh.element_label(element as usize), local);
        let faces: Vec<(u64, u8)> = found.iter().map(label).collect();
        let mut labels: Vec<u64> = faces.iter().map(|(element, _)| *element).collect();
        labels.dedup();
        let labels = Arc::new(labels);
        Ok(On::Section(NamedSet { name, labels }, Arc::new(faces)))
    }

    /// The number of the contact between the surfaces that a request names. A missing pair causes a
    /// remark; a request without surfaces gives an empty set.
    fn contact(&mut self, request: &OutputRequest) -> On {
        let [slave, master] = request.contact.clone().unwrap_or_default();
        let mut pairs = self.deck.properties.contacts.iter();
        let number = pairs.position(|pair| pair.is_of(&slave, &master));
        let [slave, master] = [slave, master].map(|name| name.to_uppercase());
        if number.is_none() && request.contact.is_some() {
            let text = format!(
                "there is no *CONTACT PAIR of slave {slave} and master {master}: nothing is \
                 printed for it"
            );
            self.remark(request, "CONTACT PRINT", &text);
            return On::Nothing;
        }
        On::Set(NamedSet {
            name: format!("slave set {slave}, master set {master}"),
            labels: Arc::new(number.iter().map(|&number| number as u64).collect()),
        })
    }

    fn remark(&mut self, request: &OutputRequest, keyword: &str, text: &str) {
        self.account
            .take(&self.deck.files, request.place, keyword, text);
    }
}
