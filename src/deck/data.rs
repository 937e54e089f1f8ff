//! What a deck says, keyword by keyword: names and numbers as they are written, each with its
//! place.

use super::element_type::ElementType;
use super::expansion::Expansion;
use super::source::{Files, Place};
use crate::scene::{ResultItem, Totals};
use std::collections::BTreeMap;

/// Nodes, in the order of the deck.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes {
    pub(super) labels: Vec<u64>,
    /// Three per node.
    pub(super) coordinates: Vec<f64>,
    pub(super) places: Vec<Place>,
}

/// Elements, in the order of the deck.
#[derive(Debug, Clone, Default)]
pub(super) struct Elements {
    pub(super) labels: Vec<u64>,
    pub(super) types: Vec<ElementType>,
    /// Start of the nodes of each element, and the end of the last one's.
    pub(super) offsets: Vec<usize>,
    /// Numbers of the nodes of all elements, one after the other.
    pub(super) nodes: Vec<u64>,
    pub(super) places: Vec<Place>,
}

impl Elements {
    /// Keeps those that are wanted, by their place.
    pub(super) fn retain(&mut self, wanted: impl Fn(usize) -> bool) {
        let old = std::mem::take(self);
        self.offsets.push(0);
        for element in (0..old.labels.len()).filter(|&element| wanted(element)) {
            self.labels.push(old.labels[element]);
            self.types.push(old.types[element]);
            self.places.push(old.places[element]);
            let nodes = &old.nodes[old.offsets[element]..old.offsets[element + 1]];
            self.nodes.extend_from_slice(nodes);
            self.offsets.push(self.nodes.len());
        }
    }
}

/// Something named, or one node or element by its number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Target {
    Label(u64),
    Set(String),
}

/// What is in a set.
#[derive(Debug, Clone)]
pub(super) enum Member {
    Of(Target),
    /// From, to, by steps of.
    Range(u64, u64, u64),
    /// Rows of the deck's nodes or elements, from one to before another.
    Rows(usize, usize),
    /// The nodes of an element set.
    NodesOf(String),
}

/// Names without regard to case, with what they name.
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

    /// The entry of a name, made where there is none yet.
    pub(super) fn entry(&mut self, name: &str) -> &mut T
    where
        T: Default,
    {
        let new = || (name.to_string(), T::default());
        &mut self.0.entry(name.to_uppercase()).or_insert_with(new).1
    }

    /// Shows all that is named.
    pub(super) fn for_each(&mut self, show: impl FnMut(&mut T)) {
        self.0.values_mut().map(|(_, value)| value).for_each(show);
    }

    /// The name as it was first written, and what it names.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.0.values().map(|(name, value)| (name.as_str(), value))
    }

    /// How a name was first written.
    pub(super) fn written(&self, name: &str) -> Option<&str> {
        self.0
            .get(&name.to_uppercase())
            .map(|(name, _)| name.as_str())
    }

    /// All names in small letters, for messages.
    pub(super) fn names(&self) -> Vec<String> {
        self.0
            .values()
            .map(|(name, _)| name.to_lowercase())
            .collect()
    }
}

/// Members of a set with their places.
pub(super) type Members = Vec<(Member, Place)>;

/// What a surface is made of.
#[derive(Debug, Clone)]
pub(super) enum SurfacePart {
    /// A face, by its number, of elements.
    Face(Target, usize),
    /// The faces of elements that belong to no other element.
    Free(Target),
    /// The faces all of whose nodes are among some.
    OfNodes(Target),
}

/// Sets and surfaces.
#[derive(Debug, Clone, Default)]
pub(super) struct Sets {
    pub(super) nodes: Named<Members>,
    pub(super) elements: Named<Members>,
    pub(super) surfaces: Named<Vec<(SurfacePart, Place)>>,
}

/// A material with its curves by temperature.
#[derive(Debug, Clone, Default)]
pub(super) struct MaterialData {
    pub(super) place: Place,
    /// Young's modulus and Poisson's ratio by temperature, ascending.
    pub(super) elastic: Vec<(f64, [f64; 2])>,
    /// Rows of plastic strain and yield stress by temperature, ascending.
    pub(super) plastic: Vec<(f64, Hardening)>,
    /// Whether hardening moves the yield surface: linear.
    pub(super) is_kinematic: bool,
    pub(super) density: Option<f64>,
    pub(super) expansion: Option<Expansion>,
}

/// Plastic strain and yield stress, by row.
pub(super) type Hardening = Vec<[f64; 2]>;

/// What a set of elements is made of.
#[derive(Debug, Clone)]
pub(super) struct Section {
    pub(super) elements: String,
    pub(super) material: String,
    /// Thickness of a plane body.
    pub(super) thickness: Option<f64>,
    pub(super) place: Place,
}

/// How surfaces press on each other.
#[derive(Debug, Clone, Default)]
pub(super) struct Interaction {
    pub(super) place: Place,
    /// Pressure over overlap, where contact is soft.
    pub(super) stiffness: Option<f64>,
}

/// Which nodes of a slave surface are moved onto the master surface.
#[derive(Debug, Clone)]
pub(super) enum Adjust {
    /// Slave nodes within a distance of the master surface.
    Within(f64),
    /// Slave nodes of a set.
    Nodes(Target),
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
    pub(super) place: Place,
}

/// Two surfaces that stay together.
#[derive(Debug, Clone)]
pub(super) struct TiedPair {
    pub(super) slave: String,
    pub(super) master: String,
    /// Largest distance of the surfaces.
    pub(super) tolerance: Option<f64>,
    pub(super) place: Place,
}

/// The distance of two surfaces, whatever the nodes say.
#[derive(Debug, Clone)]
pub(super) struct Clearance {
    pub(super) slave: String,
    pub(super) master: String,
    pub(super) value: f64,
    pub(super) place: Place,
}

/// A function of time, piecewise linear, flat outside.
#[derive(Debug, Clone, Default)]
pub(super) struct Amplitude {
    /// Time and value.
    pub(super) rows: Vec<[f64; 2]>,
    /// Whether times count from the beginning of the first step, not of the step at hand.
    pub(super) is_total: bool,
}

/// `sum coefficient u = 0`.
#[derive(Debug, Clone)]
pub(super) struct Equation {
    /// Nodes, degree of freedom from 1, coefficient.
    pub(super) terms: Vec<(Target, usize, f64)>,
    pub(super) place: Place,
}

/// Nodes that move as a rigid body does: a displacement and a rotation.
#[derive(Debug, Clone)]
pub(super) struct Rigid {
    pub(super) nodes: RigidNodes,
    /// The node whose displacement is the body's there, and whose degrees of freedom from 4 on are
    /// its rotations.
    pub(super) reference: Target,
    /// The node whose displacement is the rotation.
    pub(super) rotation: Option<Target>,
    /// Degrees of freedom that follow.
    pub(super) follows: [bool; 3],
    pub(super) place: Place,
    pub(super) keyword: &'static str,
}

/// Which nodes belong to a rigid body.
#[derive(Debug, Clone)]
pub(super) enum RigidNodes {
    /// Nodes of a set of nodes.
    Set(String),
    /// Nodes of a set of elements.
    Elements(String),
    /// Nodes of a surface.
    Surface(String),
}

/// Local axes of the nodes of a set.
#[derive(Debug, Clone)]
pub(super) struct Transform {
    pub(super) nodes: String,
    /// About an axis through two points, instead of axes along two vectors.
    pub(super) is_cylindrical: bool,
    pub(super) points: [[f64; 3]; 2],
    pub(super) place: Place,
}

/// Materials, contact and constraints.
#[derive(Debug, Clone, Default)]
pub(super) struct Properties {
    pub(super) materials: Named<MaterialData>,
    pub(super) sections: Vec<Section>,
    pub(super) interactions: Named<Interaction>,
    pub(super) contacts: Vec<ContactPair>,
    pub(super) ties: Vec<TiedPair>,
    pub(super) clearances: Vec<Clearance>,
    pub(super) equations: Vec<Equation>,
    pub(super) transforms: Vec<Transform>,
    pub(super) rigid: Vec<Rigid>,
}

/// What a condition does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Degrees of freedom have a value.
    Boundary,
    /// A force on each node along a degree of freedom.
    Force,
    /// A pressure on a face of each element, or on a surface.
    Pressure,
    /// The temperature of nodes.
    Temperature,
    /// A load on the volume of elements.
    Volume,
}

impl Kind {
    /// Number of kinds.
    pub(super) const COUNT: usize = Kind::Volume as usize + 1;
}

/// What acts on the volume of elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum VolumeLoad {
    /// An acceleration along a unit vector.
    Acceleration([f64; 3]),
    /// A rotation, whose size is its speed squared, about an axis: a point and a unit vector.
    Rotation([[f64; 3]; 2]),
}

/// A line of `*BOUNDARY`, `*CLOAD`, `*DLOAD`, `*DSLOAD` or `*TEMPERATURE`.
#[derive(Debug, Clone)]
pub(super) struct Condition {
    pub(super) kind: Kind,
    pub(super) on: Target,
    /// First and last degree of freedom from 1; the number of the face twice, 0 of a surface; the
    /// index of a volume load twice.
    pub(super) range: [usize; 2],
    pub(super) value: f64,
    pub(super) amplitude: Option<String>,
    /// Whether the value is the one that the step before ended with.
    pub(super) is_fixed: bool,
    pub(super) place: Place,
}

/// A contact pair that a step switches on or off.
#[derive(Debug, Clone)]
pub(super) struct ContactChange {
    pub(super) slave: String,
    pub(super) master: String,
    pub(super) is_on: bool,
    pub(super) place: Place,
}

/// What results that are asked for belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    Node,
    Element,
    Contact,
    Section,
}

/// Results that a step asks for.
#[derive(Debug, Clone)]
pub(super) struct OutputRequest {
    pub(super) group: Group,
    /// Whether the request is for a table, not for the result file.
    pub(super) is_print: bool,
    pub(super) items: Vec<ResultItem>,
    /// The set of nodes or elements, of a section its surface; all where none is named.
    pub(super) set: Option<String>,
    /// Slave and master surface of a contact.
    pub(super) contact: Option<[String; 2]>,
    pub(super) totals: Totals,
    /// Whether vectors are along x, y, z at nodes with axes of their own, too.
    pub(super) is_global: bool,
    pub(super) place: Place,
}

/// When results are asked for, besides at the end of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Schedule {
    /// Every so many increments.
    Every(usize),
    /// Results at the time points of this name.
    At(String),
}

/// Times at which results are asked for, ascending.
#[derive(Debug, Clone, Default)]
pub(super) struct TimePoints {
    pub(super) times: Vec<f64>,
    /// Since the beginning of the first step, not of the step at hand.
    pub(super) is_total: bool,
}

/// A step with its conditions.
#[derive(Debug, Clone, Default)]
pub(super) struct Step {
    pub(super) place: Place,
    pub(super) period: f64,
    /// Increments that it is to take, where it says so.
    pub(super) increments: usize,
    /// The time that all of them take but the last, where it is fixed.
    pub(super) fixed: Option<f64>,
    pub(super) conditions: Vec<Condition>,
    pub(super) contact_changes: Vec<ContactChange>,
    pub(super) outputs: Vec<OutputRequest>,
    /// When they are asked for, where it says so.
    pub(super) schedule: Option<Schedule>,
    /// Place where the step says that conditions replace those of the steps before, for each kind.
    pub(super) renewed: [Option<Place>; Kind::COUNT],
}

/// Conditions and steps.
#[derive(Debug, Clone, Default)]
pub(super) struct Program {
    /// Conditions before the first step.
    pub(super) initial: Vec<Condition>,
    pub(super) steps: Vec<Step>,
    /// All that act on volumes.
    pub(super) volume_loads: Vec<VolumeLoad>,
    pub(super) amplitudes: Named<Amplitude>,
    pub(super) time_points: Named<TimePoints>,
}

/// A remark on a line of the deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// `FILE, line N`.
    pub place: String,
    /// The keyword, as it is written in manuals.
    pub keyword: String,
    /// Text of the note.
    pub text: String,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: *{}: {}", self.place, self.keyword, self.text)
    }
}

/// What became of a deck.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// Keywords that were read: how often, and where first.
    pub understood: BTreeMap<String, (usize, String)>,
    /// What is taken otherwise than the deck means it.
    pub taken: Vec<Note>,
    /// What changes nothing here, and why.
    pub ignored: Vec<Note>,
    /// What brinell does not have.
    pub refused: Vec<Note>,
}

impl Account {
    /// Adds a remark to one of its lists, but no second one of the same keyword and text.
    pub(super) fn add(list: &mut Vec<Note>, files: &Files, place: Place, key: &str, text: &str) {
        let is_there = |note: &Note| note.keyword == key && note.text == text;
        if !list.iter().any(is_there) {
            list.push(Note {
                place: files.show(place),
                keyword: key.to_string(),
                text: text.to_string(),
            });
        }
    }
}
