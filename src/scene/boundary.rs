//! Contact, supports and loads.

use super::{Direction, Field, Relative, VectorField};
use crate::space::{Components, Vector, unit};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;

/// Two surfaces that may touch, without friction. If their nodes do not face each other, the
/// surfaces are coupled by the integrals of their shape functions (dual mortar).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Surface of the first body.
    pub first: String,
    /// Surface of the second body; its outward normal, reversed, is the paper's i_1.
    pub second: String,
    /// Direction from the second body to the first; by default the second surface's outward normal.
    pub normal: Option<Components>,
    /// Initial gap of all contact pairs, used instead of the gap in the mesh: a number, a formula
    /// of the position, or values at nodes. A formula or nodal values are read at the slave nodes.
    pub gap: Option<Field>,
    /// Which surface is the slave: gaps and pressures are defined at the slave nodes. `"auto"`
    /// takes the finer surface, with four exceptions. A flat surface beyond whose edges the other
    /// extends is the slave if the facets of neither are more than twice as long as those of the
    /// other. The coarser surface is the slave if its facets are linear and more than twice as long
    /// as those of the finer one (or longer at all, on a curved surface whose shape is not known).
    /// The second surface is the slave if the nodes of the two surfaces face each other. The other
    /// surface becomes the slave if nodes at an edge are already slaves of an earlier contact or,
    /// with `held`, if fewer of its nodes are held.
    #[serde(default, skip_serializing_if = "SlaveSide::is_auto")]
    pub slave: SlaveSide,
    /// Set of the only nodes that may touch: nodes of one of the surfaces, which becomes the slave.
    /// Each of them touches at the point of the other surface that is nearest to it. Other nodes
    /// pass through that surface, and the contact may reach the end of the set. By default all
    /// nodes may touch, in the mean over the facets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nodes: Option<String>,
    /// Stiffness of soft contact, pressure over overlap: `g + p / stiffness >= 0` in place of
    /// `g >= 0`. By default contact is hard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Interference, subtracted from every initial gap and applied gradually before the load
    /// program: a number, a formula of the position, or values at nodes. A formula or nodal values
    /// are read at the slave nodes.
    #[serde(default)]
    pub interference: Field,
    /// Whether the surfaces may overlap in the mesh. If so, the overlap of each contact pair is the
    /// pair's interference. By default an overlap is rejected.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub overlap: bool,
    /// Whether supports may hold nodes of the surfaces along the contact normal. A held slave node
    /// touches nothing: its support carries whatever force presses on it. A held master node is an
    /// obstacle. By default a held node is rejected.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub held: bool,
}

impl Contact {
    /// The advice given if the field `key` is negative: which other key to use.
    pub(crate) fn instead_of_negative(key: &str) -> &'static str {
        match key {
            "gap" => "an overlap is given by `interference`",
            _ => "a clearance is given by `gap`",
        }
    }

    /// The fields of the contact that may depend on the position, each with its key relative to the
    /// contact's key.
    pub(crate) fn fields(&self) -> Vec<(&'static str, &Field)> {
        let gap = self.gap.iter().map(|gap| ("gap", gap));
        gap.chain([("interference", &self.interference)]).collect()
    }
}

/// Two surfaces that stay together, both normal and tangential to the surface (tied contact): the
/// displacement of one follows the displacement of the other, whether or not their nodes face each
/// other (dual mortar). Nodes that do not lie on the other surface are moved onto it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// Name of one surface.
    pub first: String,
    /// Name of the other surface; both may belong to the same body.
    pub second: String,
    /// Which surface is the slave, whose displacement follows: `"auto"` takes the finer one.
    #[serde(default, skip_serializing_if = "SlaveSide::is_auto")]
    pub slave: SlaveSide,
    /// Largest distance between the surfaces. By default a twentieth of the longest facet, plus the
    /// distance by which flat facets deviate from a curved surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
}

/// The choice of the slave surface of a contact or a tie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SlaveSide {
    /// The finer surface; the second one if the nodes face each other.
    #[default]
    Auto,
    /// The first surface.
    First,
    /// The second surface.
    Second,
}

impl SlaveSide {
    /// Whether the choice of the slave surface is left to the program.
    pub(crate) fn is_auto(&self) -> bool {
        *self == SlaveSide::Auto
    }
}

/// A support of a node set or a surface.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Node set or surface.
    pub on: String,
    /// Directions held: `x`, `y` and, in a solid, `z`; along the turned axes if `angle` is given.
    #[serde(default)]
    pub fix: Vec<Direction>,
    /// Angle in degrees by which the support's axes are turned counter-clockwise; in a solid, about
    /// the z axis.
    pub angle: Option<f64>,
    /// A single direction, of any orientation, that is held; given instead of `fix`.
    pub direction: Option<Components>,
    /// Load factor from which on the nodes are held at the position that they then have. By default
    /// they are held from the start, at their position in the mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since: Option<f64>,
    /// Two load factors. The nodes are held up to the first. Their support forces are then reduced
    /// linearly, to zero at the second. By default the nodes are held to the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<[f64; 2]>,
}

impl Support {
    /// The directions that the support holds, in global axes.
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

/// A load: exactly one of the kinds below, with its own history.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name of the load, for messages.
    #[serde(default)]
    pub name: String,
    /// Surface or node set that is loaded; the name of a body for an `acceleration`, a `rotation`
    /// or a `temperature`.
    pub on: String,
    /// Total force (x, y; in a solid x, y, z). On a surface it is distributed to the nodes like a
    /// uniform traction, on a node set equally.
    pub force: Option<Components>,
    /// Pressure on a surface, positive into the body: a number, a formula of the position, or
    /// values at nodes.
    pub pressure: Option<Field>,
    /// Traction (x, y; in a solid x, y, z) on a surface: numbers, formulas of the position, or
    /// values at nodes.
    pub traction: Option<VectorField>,
    /// Traction of the Kirsch field: a plate with a hole of `radius` at the origin under remote
    /// tension.
    pub kirsch: Option<Kirsch>,
    /// Prescribed displacement: the given components, reached when this load's factor is 1.
    pub displacement: Option<Displacement>,
    /// Prescribed difference between the displacement of the loaded set and other displacements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative: Option<Relative>,
    /// Total force on a surface that stays plane: all its nodes share one displacement in
    /// `direction`.
    pub plane_force: Option<PlaneForce>,
    /// Force per mass on all of a body (x, y; in a solid x, y, z), such as gravity: the body's
    /// material needs a `density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Components>,
    /// Rotation of a body, whose material needs a `density`. The load factor multiplies the
    /// centrifugal forces, which are proportional to the square of the speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// Change of temperature of a body, a number or a formula of the position: the body's material
    /// needs `thermal_expansion`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Field>,
    /// Change of the gap between a surface and the surfaces it may touch. A positive change moves
    /// them apart (a layer ground off, a contact to be released), a negative one presses them
    /// together (a growing interference). Given as a number, a formula of the position, or values
    /// at nodes; a formula or nodal values are read at the slave nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<Field>,
    /// Dependence of the load on the load factor.
    #[serde(default)]
    pub history: History,
    /// Load factor from which on a displacement (or a `relative` one) is prescribed. The nodes
    /// begin at the position that they then have, and move linearly to the next row of the
    /// `history`, a table; with the history `"constant"` they stay at that position. By default a
    /// displacement is prescribed from the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since: Option<f64>,
    /// Two load factors. The displacement is prescribed up to the first. The forces that prescribe
    /// it are then reduced linearly, to zero at the second. By default the displacement is
    /// prescribed to the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<[f64; 2]>,
}

impl Load {
    /// The fields of the load that may depend on the position, each with its key relative to the
    /// load's key.
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
    /// Radius of the hole; 0 for a plate without a hole.
    pub radius: f64,
}

/// Components of a prescribed displacement: numbers, formulas of the position, or values at nodes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Displacement along x (r in an axisymmetric model).
    pub x: Option<Field>,
    /// Displacement along y (z in an axisymmetric model).
    pub y: Option<Field>,
    /// Displacement along z, in solids only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<Field>,
}

impl Displacement {
    /// Components of the displacement, axis by axis.
    pub fn components(&self) -> [Option<&Field>; 3] {
        [self.x.as_ref(), self.y.as_ref(), self.z.as_ref()]
    }
}

/// A total force on a surface that stays plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneForce {
    /// Direction of the force.
    pub direction: Direction,
    /// Total force along `direction`.
    pub total: f64,
}

/// Rotation about an axis at a constant speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Revolutions per minute. The scene's density must then use seconds as the unit of time (with
    /// N and mm: t/mm^3).
    pub rpm: f64,
    /// A point of the axis; by default the origin. Axisymmetric models turn about their own axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<Components>,
    /// Direction of the axis, in solids only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
}

/// How a load depends on the load factor alpha.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum History {
    /// `"proportional"`: the load times alpha (default).
    #[default]
    Proportional,
    /// `"constant"`: a preload, applied gradually before the load program begins.
    Constant,
    /// `[[alpha, factor], ...]`: a multiple of the load that is piecewise linear in alpha and
    /// constant outside the table; the value at alpha = 0 is a preload.
    Table(Vec<[f64; 2]>),
}

impl History {
    /// Whether the load changes with the load factor.
    pub(crate) fn varies(&self) -> bool {
        match self {
            History::Proportional => true,
            History::Constant => false,
            History::Table(rows) => rows.windows(2).any(|pair| pair[0][1] != pair[1][1]),
        }
    }
}

impl JsonSchema for History {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "History".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = generator.subschema_for::<Vec<[f64; 2]>>();
        json_schema!({
            "description": "How a load depends on the load factor: `\"proportional\"` (the \
                            default), `\"constant\"` (a preload), or a table of rows \
                            `[load factor, multiple]`, piecewise linear.",
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
