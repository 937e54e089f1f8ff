//! Contents of a deck, keyword by keyword: names and numbers as they are written, each with its
//! place.

use super::expansion::Expansion;
use super::source::{Files, LinePlace};
use crate::scene::{ResultItem, Totals};
use std::collections::BTreeMap;

/// A named set or surface, a single node or element by its number, or all of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum EntitySelection {
    Label(u64),
    Set(String),
    All,
}

/// A member of a set of nodes or elements.
#[derive(Debug, Clone)]
pub(super) enum Member {
    Of(EntitySelection),
    /// A range of numbers: first, last, and step.
    Range(u64, u64, u64),
    /// A range of rows of the deck's nodes or elements: first row, and the row after the last.
    Rows(usize, usize),
    /// The nodes of an element set.
    NodesOf(String),
}

/// Values by name, without regard to case.
#[derive(Debug, Clone)]
pub(super) struct Named<T>(BTreeMap<String, (String, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Named(BTreeMap::new())
    }
}

impl<T> Named<T> {
    pub(super) fn get(&self, name: &str) -> Option<&T> {
        self.0.get(&name.to_uppercase()).map(|(_, value)| value)
    }

    pub(super) fn get_mut(&mut self, name: &str) -> Option<&mut T> {
        self.0.get_mut(&name.to_uppercase()).map(|(_, value)| value)
    }

    /// The value of a name, created if it does not exist.
    pub(super) fn entry(&mut self, name: &str) -> &mut T
    where
        T: Default,
    {
        let new = || (name.to_string(), T::default());
        &mut self.0.entry(name.to_uppercase()).or_insert_with(new).1
    }

    /// Calls `show` with each value.
    pub(super) fn for_each(&mut self, show: impl FnMut(&mut T)) {
        self.0.values_mut().map(|(_, value)| value).for_each(show);
    }

    /// Calls `change` with each name, as it was first written, and its value.
    pub(super) fn for_each_named(&mut self, mut change: impl FnMut(&str, &mut T)) {
        let all = self.0.values_mut();
        all.for_each(|(name, value)| change(name, value));
    }

    /// All values, each with its name as it was first written.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.0.values().map(|(name, value)| (name.as_str(), value))
    }

    /// The spelling in which a name was first written.
    pub(super) fn written(&self, name: &str) -> Option<&str> {
        self.0
            .get(&name.to_uppercase())
            .map(|(name, _)| name.as_str())
    }

    /// All names in lower case, for messages.
    pub(super) fn names(&self) -> Vec<String> {
        self.0
            .values()
            .map(|(name, _)| name.to_lowercase())
            .collect()
    }
}

/// Members of a set, with their places.
pub(super) type Members = Vec<(Member, LinePlace)>;

/// A part of a surface.
#[derive(Debug, Clone)]
pub(super) enum SurfacePart {
    /// One face, by its number, of each of some elements.
    Face(EntitySelection, usize),
    /// The faces of some elements that belong to no other element.
    Free(EntitySelection),
    /// The faces all of whose nodes are among the given ones.
    OfNodes(EntitySelection),
}

/// Sets and surfaces of a deck.
#[derive(Debug, Clone, Default)]
pub(super) struct Sets {
    pub(super) nodes: Named<Members>,
    pub(super) elements: Named<Members>,
    pub(super) surfaces: Named<Vec<(SurfacePart, LinePlace)>>,
}

/// A material, with its curves by temperature.
#[derive(Debug, Clone, Default)]
pub(super) struct MaterialData {
    pub(super) place: LinePlace,
    /// Young's modulus and Poisson's ratio by temperature, ascending.
    pub(super) elastic: Vec<(f64, [f64; 2])>,
    /// Rows of plastic strain and yield stress by temperature, ascending.
    pub(super) plastic: Vec<(f64, HardeningRows)>,
    /// Whether hardening is linear kinematic, that is moves the yield surface.
    pub(super) is_kinematic: bool,
    pub(super) density: Option<f64>,
    pub(super) expansion: Option<Expansion>,
}

/// Rows of plastic strain and yield stress.
pub(super) type HardeningRows = Vec<[f64; 2]>;

/// The material and thickness of a set of elements.
#[derive(Debug, Clone)]
pub(super) struct Section {
    pub(super) elements: String,
    pub(super) material: String,
    /// Thickness of a plane body.
    pub(super) thickness: Option<f64>,
    pub(super) place: LinePlace,
}

/// Law of the pressure between surfaces in contact.
#[derive(Debug, Clone, Default)]
pub(super) struct Interaction {
    pub(super) place: LinePlace,
    /// Pressure over overlap for soft contact; `None` for hard contact.
    pub(super) stiffness: Option<f64>,
}

/// The nodes of a slave surface that are moved onto the master surface.
#[derive(Debug, Clone)]
pub(super) enum Adjust {
    /// Slave nodes within a distance of the master surface.
    Within(f64),
    /// Slave nodes of a set.
    Nodes(EntitySelection),
}

/// Two surfaces that may touch.
#[derive(Debug, Clone)]
pub(super) struct ContactPair {
    pub(super) slave: String,
    pub(super) master: String,
    pub(super) interaction: String,
    pub(super) adjust: Option<Adjust>,
    /// Whether all nodes of the slave surface were moved onto the master surface.
    pub(super) is_closed: bool,
    pub(super) place: LinePlace,
}

impl ContactPair {
    /// Whether the pair is of these surfaces.
    pub(super) fn is_of(&self, slave: &str, master: &str) -> bool {
        self.slave.eq_ignore_ascii_case(slave) && self.master.eq_ignore_ascii_case(master)
    }
}

/// Two surfaces that are tied together.
#[derive(Debug, Clone)]
pub(super) struct TiedPair {
    pub(super) slave: String,
    pub(super) master: String,
    /// Largest distance between the surfaces.
    pub(super) tolerance: Option<f64>,
    pub(super) place: LinePlace,
}

/// The distance between two surfaces, wherever their nodes are.
#[derive(Debug, Clone)]
pub(super) struct Clearance {
    pub(super) slave: String,
    pub(super) master: String,
    pub(super) value: f64,
    pub(super) place: LinePlace,
}

/// A contact pair whose overlap is to be resolved gradually.
#[derive(Debug, Clone)]
pub(super) struct Resolved {
    pub(super) slave: String,
    pub(super) master: String,
    pub(super) place: LinePlace,
}

/// A function of time, piecewise linear, and constant outside its rows.
#[derive(Debug, Clone, Default)]
pub(super) struct Amplitude {
    /// Rows of time and value.
    pub(super) rows: Vec<[f64; 2]>,
    /// Whether times are measured from the beginning of the first step instead of the current step.
    pub(super) is_total: bool,
    /// Whether values are those of the load itself, whatever value the load's line gives.
    pub(super) is_absolute: bool,
}

/// A linear equation `sum coefficient u = 0`.
#[derive(Debug, Clone)]
pub(super) struct LinearEquation {
    /// Terms: nodes, degree of freedom counted from 1, and coefficient.
    pub(super) terms: Vec<(EntitySelection, usize, f64)>,
    pub(super) place: LinePlace,
}

/// Nodes that move like a rigid body, by a displacement and a rotation.
#[derive(Debug, Clone)]
pub(super) struct Rigid {
    pub(super) nodes: RigidNodes,
    /// The reference node: its displacement is the displacement of the body at this node, its
    /// degrees of freedom from 4 on are the body's rotations.
    pub(super) reference: EntitySelection,
    /// The node whose displacement is the body's rotation.
    pub(super) rotation: Option<EntitySelection>,
    /// Axes along which the nodes follow the body.
    pub(super) follows: [bool; 3],
    pub(super) place: LinePlace,
    pub(super) keyword: &'static str,
}

/// The nodes that belong to a rigid body.
#[derive(Debug, Clone)]
pub(super) enum RigidNodes {
    /// Nodes of a set of nodes.
    Set(String),
    /// Nodes of a set of elements.
    Elements(String),
    /// Nodes of a surface.
    Surface(String),
}

/// Local axes for the nodes of a set.
#[derive(Debug, Clone)]
pub(super) struct Transform {
    pub(super) nodes: String,
    /// Whether the axes are cylindrical about a line through two points, instead of along two
    /// vectors.
    pub(super) is_cylindrical: bool,
    pub(super) points: [[f64; 3]; 2],
    pub(super) place: LinePlace,
}

/// Materials, sections, contact and constraints of a deck.
#[derive(Debug, Clone, Default)]
pub(super) struct Properties {
    pub(super) materials: Named<MaterialData>,
    pub(super) sections: Vec<Section>,
    pub(super) interactions: Named<Interaction>,
    pub(super) contacts: Vec<ContactPair>,
    pub(super) ties: Vec<TiedPair>,
    pub(super) clearances: Vec<Clearance>,
    pub(super) resolved: Vec<Resolved>,
    pub(super) equations: Vec<LinearEquation>,
    pub(super) transforms: Vec<Transform>,
    pub(super) rigid: Vec<Rigid>,
}

/// The kind of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ConditionKind {
    /// A prescribed value of degrees of freedom.
    Boundary,
    /// A force on each node along a degree of freedom.
    Force,
    /// A pressure on a face of each element, or on a surface.
    Pressure,
    /// A temperature of nodes.
    Temperature,
    /// A load on the volume of elements.
    Volume,
}

impl ConditionKind {
    /// Number of kinds.
    pub(super) const COUNT: usize = ConditionKind::Volume as usize + 1;
}

/// A load that acts on the volume of elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum VolumeLoad {
    /// An acceleration along a unit vector.
    Acceleration([f64; 3]),
    /// A rotation about an axis, given by a point and a unit vector; its size is the square of the
    /// angular speed.
    Rotation([[f64; 3]; 2]),
}

/// A line of `*BOUNDARY`, `*CLOAD`, `*DLOAD`, `*DSLOAD` or `*TEMPERATURE`.
#[derive(Debug, Clone)]
pub(super) struct Condition {
    pub(super) kind: ConditionKind,
    pub(super) on: EntitySelection,
    /// First and last degree of freedom, counted from 1. For a pressure the number of the face
    /// twice, or 0 for a surface; for a volume load its index twice.
    pub(super) range: [usize; 2],
    pub(super) value: f64,
    pub(super) amplitude: Option<String>,
    /// Whether the value stays as it was at the end of the step before.
    pub(super) is_fixed: bool,
    pub(super) place: LinePlace,
}

impl Condition {
    /// Makes a condition with the data that all lines of a keyword have in common.
    pub(super) fn of_keyword(kind: ConditionKind, place: LinePlace) -> Self {
        Condition {
            kind,
            on: EntitySelection::All,
            range: [1; 2],
            value: 0.0,
            amplitude: None,
            is_fixed: false,
            place,
        }
    }

    /// The condition of a line.
    pub(super) fn line(
        &self,
        on: EntitySelection,
        range: [usize; 2],
        value: f64,
        place: LinePlace,
    ) -> Self {
        Condition {
            on,
            range,
            value,
            place,
            ..self.clone()
        }
    }
}

/// A contact pair that a step switches on or off.
#[derive(Debug, Clone)]
pub(super) struct ContactChange {
    pub(super) slave: String,
    pub(super) master: String,
    pub(super) is_on: bool,
    pub(super) place: LinePlace,
}

/// The kind of entity to which requested results belong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    Node,
    Element,
    Contact,
    Section,
}

/// Results that a step requests.
#[derive(Debug, Clone)]
pub(super) struct OutputRequest {
    pub(super) group: Group,
    /// Whether the request is for a printed table and not for the result file.
    pub(super) is_print: bool,
    pub(super) items: Vec<ResultItem>,
    /// The set of nodes or elements, or for a section its surface; all nodes or elements if `None`.
    pub(super) set: Option<String>,
    /// Slave and master surface, for results of a contact.
    pub(super) contact: Option<[String; 2]>,
    pub(super) totals: Totals,
    /// Whether vectors are given along x, y, z even at nodes with local axes.
    pub(super) is_global: bool,
    pub(super) place: LinePlace,
}

/// The times at which results are requested, in addition to the end of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Schedule {
    /// At every n-th increment.
    Every(usize),
    /// At the time points of this name.
    At(String),
}

/// Times at which results are requested, ascending.
#[derive(Debug, Clone, Default)]
pub(super) struct TimePoints {
    pub(super) times: Vec<f64>,
    /// Whether the times are measured from the beginning of the first step instead of the current
    /// step.
    pub(super) is_total: bool,
}

/// A step with its conditions.
#[derive(Debug, Clone, Default)]
pub(super) struct DeckStep {
    pub(super) place: LinePlace,
    pub(super) period: f64,
    /// Number of increments of the step if all are as long as its first.
    pub(super) increments: usize,
    /// Time of each increment except the last, if it is fixed.
    pub(super) fixed: Option<f64>,
    pub(super) conditions: Vec<Condition>,
    pub(super) contact_changes: Vec<ContactChange>,
    pub(super) outputs: Vec<OutputRequest>,
    /// Times at which the results are requested, if the step gives them.
    pub(super) schedule: Option<Schedule>,
    /// For each kind, the place at which the step declares that conditions replace those of earlier
    /// steps.
    pub(super) renewed: [Option<LinePlace>; ConditionKind::COUNT],
    /// Whether the step has given conditions of each kind. Only the first keyword of a kind decides
    /// on its `OP`.
    pub(super) is_begun: [bool; ConditionKind::COUNT],
}

/// Conditions and steps of a deck.
#[derive(Debug, Clone, Default)]
pub(super) struct DeckProgram {
    /// Conditions that are given before the first step.
    pub(super) initial: Vec<Condition>,
    pub(super) steps: Vec<DeckStep>,
    /// All loads that act on volumes; conditions refer to them by index.
    pub(super) volume_loads: Vec<VolumeLoad>,
    pub(super) amplitudes: Named<Amplitude>,
    pub(super) time_points: Named<TimePoints>,
}

/// A remark on a line of the deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// Place of the line, `FILE, line N`.
    pub place: String,
    /// The keyword, as written in manuals.
    pub keyword: String,
    /// Text of the remark.
    pub text: String,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: *{}: {}", self.place, self.keyword, self.text)
    }
}

/// An account of how a deck was read: what was understood, interpreted differently, ignored and
/// refused.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// Keywords that were read: number of occurrences, and place of the first one.
    pub understood: BTreeMap<String, (usize, String)>,
    /// Remarks on data that brinell interprets differently from the deck's meaning.
    pub taken: Vec<Note>,
    /// Remarks on data that have no effect here, with the reason.
    pub ignored: Vec<Note>,
    /// Remarks on data that ask for effects that brinell does not have.
    pub refused: Vec<Note>,
}

impl Account {
    /// Adds a remark on data that brinell interprets differently.
    pub(super) fn take(&mut self, files: &Files, place: LinePlace, key: &str, text: &str) {
        add(&mut self.taken, files, place, key, text);
    }

    /// Adds a remark on data that have no effect here.
    pub(super) fn ignore(&mut self, files: &Files, place: LinePlace, key: &str, text: &str) {
        add(&mut self.ignored, files, place, key, text);
    }

    /// Adds a remark on data that ask for effects that brinell does not have.
    pub(super) fn refuse(&mut self, files: &Files, place: LinePlace, key: &str, text: &str) {
        add(&mut self.refused, files, place, key, text);
    }
}

/// Adds a remark to a list, unless the list has a remark with the same keyword and text.
fn add(list: &mut Vec<Note>, files: &Files, place: LinePlace, key: &str, text: &str) {
    let is_there = |note: &Note| note.keyword == key && note.text == text;
    if !list.iter().any(is_there) {
        list.push(Note {
            place: files.show(place),
            keyword: key.to_string(),
            text: text.to_string(),
        });
    }
}
