//! Contact, supports and loads.

use super::{Field, VectorField};
use crate::space::{Components, Vector, unit};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;

/// Two surfaces that may touch, without friction. Where their nodes do not face each other they are
/// coupled by the integrals of their shape functions (dual mortar).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Surface of the first body.
    pub first: String,
    /// Surface of the second body; its outward normal, reversed, is the paper's i_1.
    pub second: String,
    /// Direction from the second body to the first; by default the second surface's outward normal.
    pub normal: Option<Components>,
    /// Initial gap for all pairs instead of the geometric one: a number, or a formula of the
    /// position or values at nodes, at the nodes of the slaves.
    pub gap: Option<Field>,
    /// Which surface has the slaves, at whose nodes gaps and pressures are: `"auto"` takes the
    /// finer one (the coarser where its facets are linear and more than twice as long, or longer at
    /// all where they are of a curved surface whose shape is not known), the second where nodes
    /// face each other, and the other one of these where nodes at an edge are slaves of an earlier
    /// contact.
    #[serde(default, skip_serializing_if = "SlaveSide::is_auto")]
    pub slave: SlaveSide,
    /// Pressure over overlap of soft contact: `g + p / stiffness >= 0` in place of `g >= 0`. By
    /// default contact is hard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Interference: taken off every initial gap, applied gradually before the load program; a
    /// number, or a formula of the position or values at nodes, at the nodes of the slaves.
    #[serde(default)]
    pub interference: Field,
    /// Whether the surfaces may overlap in the mesh: by as much as they do, pair by pair, they
    /// interfere. By default an overlap is an error.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub overlap: bool,
    /// Whether supports may hold nodes of the surfaces along the contact normal: a slave that is
    /// held touches nothing, its support bears what presses there; a master that is held is an
    /// obstacle. By default such a node is an error.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub held: bool,
}

impl Contact {
    /// What is said of a negative value of a field.
    pub(crate) fn instead_of_negative(key: &str) -> &'static str {
        match key {
            "gap" => "an overlap is given by `interference`",
            _ => "a clearance is given by `gap`",
        }
    }

    /// What may depend on the position, by its key below that of the contact.
    pub(crate) fn fields(&self) -> Vec<(&'static str, &Field)> {
        let gap = self.gap.iter().map(|gap| ("gap", gap));
        gap.chain([("interference", &self.interference)]).collect()
    }
}

/// Two surfaces that stay together, across and along: whether their nodes face each other or not,
/// the displacement of one follows that of the other (dual mortar). Nodes that do not lie on the
/// other surface are moved onto it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// Name of one surface.
    pub first: String,
    /// Name of the other surface; it may be one of the same body.
    pub second: String,
    /// Which surface follows: `"auto"` takes the finer one.
    #[serde(default, skip_serializing_if = "SlaveSide::is_auto")]
    pub slave: SlaveSide,
    /// Largest distance of the surfaces. By default a twentieth of the longest facet, beyond what
    /// flat facets are off a curved surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
}

/// Which surface of a contact or a tie has the slaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SlaveSide {
    /// The finer surface; the second where nodes face each other.
    #[default]
    Auto,
    /// The first surface.
    First,
    /// The second surface.
    Second,
}

impl SlaveSide {
    /// Whether the side is left open.
    pub(crate) fn is_auto(&self) -> bool {
        *self == SlaveSide::Auto
    }
}

/// A support of a set of nodes or a surface.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Node set or surface.
    pub on: String,
    /// Directions held: `x`, `y`, of a solid `z`; in the turned axes where `angle` is given.
    #[serde(default)]
    pub fix: Vec<Direction>,
    /// Angle in degrees by which the support's axes are turned counter-clockwise, of a solid about
    /// the z axis.
    pub angle: Option<f64>,
    /// Any one direction that is held, instead of `fix`.
    pub direction: Option<Components>,
}

/// A coordinate direction; axisymmetric: x is r, y is z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Direction x; r of an axisymmetric model.
    X,
    /// Direction y; z of an axisymmetric model.
    Y,
    /// Direction z of a solid.
    Z,
}

impl Direction {
    /// All directions, in the order of the axes.
    pub const ALL: [Direction; 3] = [Direction::X, Direction::Y, Direction::Z];

    /// Number of the axis, from 0.
    pub fn axis(self) -> usize {
        self as usize
    }

    /// `x`, `y` or `z`, as in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Direction::X => "x",
            Direction::Y => "y",
            Direction::Z => "z",
        }
    }
}

impl Support {
    /// The directions it holds, in global axes.
    pub fn directions(&self) -> Vec<Vector> {
        if let Some(direction) = self.direction {
            return vec![crate::space::direction(direction.vector())];
        }
        let (sin, cos) = self.angle.unwrap_or(0.0).to_radians().sin_cos();
        let turned = |direction: &Direction| match (self.angle, direction) {
            (None, d) => unit(d.axis()),
            (Some(_), Direction::X) => [cos, sin, 0.0],
            (Some(_), Direction::Y) => [-sin, cos, 0.0],
            (Some(_), Direction::Z) => unit(2),
        };
        self.fix.iter().map(turned).collect()
    }
}

/// A load: exactly one of the kinds, with its own history.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name, for messages.
    #[serde(default)]
    pub name: String,
    /// Surface or node set that is loaded; the body of an `acceleration`, a `rotation` or a
    /// `temperature`.
    pub on: String,
    /// Total force (x, y; of a solid x, y, z), shared by the nodes like a uniform traction
    /// (surface) or equally (node set).
    pub force: Option<Components>,
    /// Pressure on a surface, positive into the body: a number, a formula of the position or values
    /// at nodes.
    pub pressure: Option<Field>,
    /// Traction (x, y; of a solid x, y, z) on a surface: numbers, formulas of the position or
    /// values at nodes.
    pub traction: Option<VectorField>,
    /// Traction of the Kirsch field: plate with a hole of `radius` at the origin under remote
    /// tensions.
    pub kirsch: Option<Kirsch>,
    /// Prescribed displacement: the given components, at load factor 1 of this load.
    pub displacement: Option<Displacement>,
    /// A total force on a surface that is held plane: all its nodes share the displacement in
    /// `direction`.
    pub plane_force: Option<PlaneForce>,
    /// Force per mass on all of a body (x, y; of a solid x, y, z), such as gravity: its material
    /// needs a `density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Components>,
    /// Rotation of a body, whose material needs a `density`: the load factor multiplies the forces,
    /// which go with the square of the speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// Change of temperature of a body, a number or a formula of the position: its material needs
    /// `thermal_expansion`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Field>,
    /// Change of the gap between a surface and those it may touch: positive takes them apart (a
    /// layer ground off, a contact that is to be off), negative presses them together (an
    /// interference that grows). A number, or a formula of the position or values at nodes, at the
    /// nodes of the slaves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<Field>,
    /// Dependence of the load on the load factor.
    #[serde(default)]
    pub history: History,
}

impl Load {
    /// Whether the load acts on the volume of a body, which `on` then names.
    pub fn acts_on_volume(&self) -> bool {
        self.acceleration.is_some() || self.rotation.is_some() || self.temperature.is_some()
    }

    /// What may depend on the position, by its key below that of the load.
    pub(crate) fn fields(&self) -> Vec<(String, &Field)> {
        let named = |key: &str, field| (key.to_string(), field);
        let single = [
            ("pressure", &self.pressure),
            ("temperature", &self.temperature),
            ("gap", &self.gap),
        ];
        let single = single
            .into_iter()
            .filter_map(|(key, field)| Some((key, field.as_ref()?)));
        let mut out: Vec<_> = single.map(|(key, field)| named(key, field)).collect();
        for (k, field) in self.traction.iter().flat_map(VectorField::iter).enumerate() {
            out.push((format!("traction.{k}"), field));
        }
        if let Some(displacement) = &self.displacement {
            let components = Direction::ALL.into_iter().zip(displacement.components());
            let given = components.filter_map(|(axis, field)| Some((axis, field?)));
            out.extend(given.map(|(axis, of)| (format!("displacement.{}", axis.name()), of)));
        }
        out
    }
}

/// Remote tensions of a plate with a hole at the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Kirsch {
    /// Remote stress along x.
    pub stress_x: f64,
    /// Remote stress along y.
    #[serde(default)]
    pub stress_y: f64,
    /// Radius of the hole; 0 for a plain plate.
    pub radius: f64,
}

/// Prescribed displacement components: numbers, formulas of the position or values at nodes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Displacement along x (r).
    pub x: Option<Field>,
    /// Displacement along y (z).
    pub y: Option<Field>,
    /// Displacement along z, of a solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<Field>,
}

impl Displacement {
    /// Components of the displacement, axis by axis.
    pub fn components(&self) -> [Option<&Field>; 3] {
        [self.x.as_ref(), self.y.as_ref(), self.z.as_ref()]
    }
}

/// A total force on a surface held plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneForce {
    /// Direction of the force.
    pub direction: Direction,
    /// Total force along it.
    pub total: f64,
}

/// Rotation about an axis at a constant speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Revolutions per minute, where the scene's density is for seconds (N, mm: t/mm^3).
    pub rpm: f64,
    /// A point of the axis; by default the origin. Axisymmetric models turn about their own axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<Components>,
    /// Direction of the axis, of a solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
}

/// How a load depends on the load factor alpha.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum History {
    /// `"proportional"`: alpha times the load (default).
    #[default]
    Proportional,
    /// `"constant"`: a preload, applied gradually before the load program starts.
    Constant,
    /// `[[alpha, factor], ...]`: piecewise linear in alpha, flat outside; the value at 0 is a
    /// preload.
    Table(Vec<[f64; 2]>),
}

impl JsonSchema for History {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "History".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = generator.subschema_for::<Vec<[f64; 2]>>();
        json_schema!({
            "description": "How a load depends on the load factor: `\"proportional\"` (the \
                            default), `\"constant\"` (a preload), or a table of [load factor, \
                            multiple], piecewise linear.",
            "anyOf": [{ "enum": ["proportional", "constant"] }, table],
        })
    }
}

impl Serialize for History {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            History::Proportional => serializer.serialize_str("proportional"),
            History::Constant => serializer.serialize_str("constant"),
            History::Table(rows) => rows.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for History {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct HistoryVisitor;
        impl<'de> Visitor<'de> for HistoryVisitor {
            type Value = History;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "\"proportional\", \"constant\" or a table [[load factor, multiple], ...]",
                )
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<History, E> {
                match text {
                    "proportional" => Ok(History::Proportional),
                    "constant" => Ok(History::Constant),
                    _ => Err(E::invalid_value(de::Unexpected::Str(text), &self)),
                }
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut rows: A) -> Result<History, A::Error> {
                let mut table = Vec::new();
                while let Some(row) = rows.next_element()? {
                    table.push(row);
                }
                Ok(History::Table(table))
            }
        }
        deserializer.deserialize_any(HistoryVisitor)
    }
}
