//! What the user asks for, as data: the scene file.
//!
//! The types here mirror the TOML file key by key; unknown keys are errors. Units are the user's,
//! consistent (for instance N, mm, MPa). [`Scene::load`] reads a file, [`Scene::parse`] a string.

use crate::mesh::Shape;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A whole scene.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line for humans.
    #[serde(default)]
    pub title: String,
    /// Plane strain, plane stress or axisymmetric.
    pub kind: Kind,
    /// How many copies of the model make the whole: 2 for a half model, 4 for a quarter. Total forces in the
    /// scene and in results are those of the whole.
    #[serde(default = "defaults::single")]
    pub symmetry: usize,
    /// Where the mesh comes from.
    pub mesh: MeshSource,
    /// Materials by name.
    pub materials: BTreeMap<String, Material>,
    /// Bodies by name: the names are those of the mesh.
    pub bodies: BTreeMap<String, Body>,
    /// Pairs of surfaces that may touch.
    #[serde(default)]
    pub contact: Vec<Contact>,
    /// Supports.
    #[serde(default)]
    pub support: Vec<Support>,
    /// Loads.
    #[serde(default)]
    pub load: Vec<Load>,
    /// The load program.
    pub program: Program,
    /// How to compute: every value has a default that needs no thought.
    #[serde(default)]
    pub analysis: Settings,
    /// Published or exact values to put beside the computed ones.
    #[serde(default)]
    pub reference: Vec<Reference>,
    /// The file the scene was read from, and what relative paths in it are relative to.
    #[serde(skip)]
    pub file: Option<PathBuf>,
}

/// The two-dimensional idealisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// No strain out of the plane; forces per unit thickness.
    PlaneStrain,
    /// No stress out of the plane; forces per unit thickness.
    PlaneStress,
    /// Coordinates are (r, z), x = 0 is the axis; forces are totals over the full circle.
    Axisymmetric,
}

/// Where the mesh comes from: exactly one key.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshSource {
    /// Curved indenter on a block (paper 5.1); axisymmetric: ball on half space.
    pub cylinder_on_half_plane: Option<CylinderOnHalfPlane>,
    /// Quarter of a disc in the hole of a plate (paper 5.2).
    pub disc_in_plate: Option<DiscInPlate>,
    /// Blocks and rings, put together.
    pub parts: Option<Vec<Part>>,
    /// A Gmsh file (.msh 2.2 or 4.1, ASCII), relative to the scene file. Physical surfaces are
    /// bodies, physical curves surfaces, physical points node sets.
    pub file: Option<PathBuf>,
}

/// The half model (x >= 0) of a cylinder (ball) pressed on a half plane (half space). Bodies
/// `cylinder` and `half_plane`; surfaces `cylinder.contact`, `cylinder.top`, `cylinder.symmetry`,
/// `half_plane.contact`, `half_plane.bottom`, `half_plane.symmetry`, `half_plane.side`, `cylinder.side`.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderOnHalfPlane {
    /// Radius of the cylinder or ball.
    pub radius: f64,
    /// Elements over the contact half width (radius) at first yield.
    pub resolution: usize,
    /// Contact half width at first yield; by default computed from the materials (Hertz).
    pub half_width: Option<f64>,
    /// Width of the evenly meshed region, in half widths.
    #[serde(default = "defaults::fine_width")]
    pub fine_width: f64,
    /// Depth of the evenly meshed region, in half widths.
    #[serde(default = "defaults::fine_depth")]
    pub fine_depth: f64,
    /// Size of each body, in half widths.
    #[serde(default = "defaults::far_size")]
    pub far_size: f64,
    /// Ratio of neighbouring element sizes outside the even region.
    #[serde(default = "defaults::growth")]
    pub growth: f64,
    /// Element shape.
    #[serde(default = "defaults::shape")]
    pub element: Shape,
}

/// Quarter model (x, y >= 0) of a disc that fills the hole of a plate, tension along x. Bodies
/// `disc` and `plate`; surfaces `disc.contact`, `plate.contact` (the hole), `plate.far`,
/// `disc.symmetry_x`, `plate.symmetry_x` (on x = 0), `disc.symmetry_y`, `plate.symmetry_y` (on y = 0).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiscInPlate {
    /// Radius of the hole and the disc.
    pub radius: f64,
    /// Disc radius minus hole radius: positive is interference, negative clearance.
    #[serde(default)]
    pub interference: f64,
    /// Elements over the quarter circle.
    pub resolution: usize,
    /// Outer radius of the plate, in hole radii.
    #[serde(default = "defaults::far_radius")]
    pub far_radius: f64,
    /// Ratio of neighbouring radial element sizes in the plate.
    #[serde(default = "defaults::disc_growth")]
    pub growth: f64,
    /// Element shape.
    #[serde(default = "defaults::shape")]
    pub element: Shape,
}

/// A block, ring sector or disc sector: one body. Surfaces are `BODY.left`, `.right`, `.bottom`,
/// `.top` for a block; `.inner`, `.outer`, `.start`, `.end` for a ring sector; `.outer`, `.start`, `.end` for a disc sector.
/// The corners of a block are node sets `BODY.bottom_left`, `BODY.bottom_right`, `BODY.top_left`, `BODY.top_right`.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Name of the body.
    pub body: String,
    /// A rectangle.
    pub block: Option<Block>,
    /// A sector of a ring.
    pub ring: Option<Ring>,
    /// A quarter, half or full disc.
    pub disc: Option<Disc>,
    /// Element shape.
    #[serde(default = "defaults::shape")]
    pub element: Shape,
}

/// A rectangle `[x0, x1] x [y0, y1]`.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// From, to.
    pub x: [f64; 2],
    /// From, to.
    pub y: [f64; 2],
    /// Number of elements along x and y.
    pub elements: [usize; 2],
    /// Size of the last element over that of the first, along x and y.
    #[serde(default = "defaults::no_bias")]
    pub bias: [f64; 2],
    /// Named pieces of the sides: surface `BODY.NAME` = facets of `side` whose both ends lie in `from..to`.
    #[serde(default)]
    pub pieces: Vec<Piece>,
}

/// A named piece of a block's side.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Name; the surface is `BODY.NAME`.
    pub name: String,
    /// `left`, `right`, `bottom` or `top`.
    pub side: String,
    /// Coordinate along the side where the piece begins.
    pub from: f64,
    /// Coordinate along the side where the piece ends.
    pub to: f64,
}

/// A ring sector.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Centre.
    #[serde(default)]
    pub center: [f64; 2],
    /// Inner and outer radius.
    pub radius: [f64; 2],
    /// Start and end angle in degrees, counter-clockwise from x. A full circle is closed.
    #[serde(default = "defaults::quarter")]
    pub angle: [f64; 2],
    /// Number of elements along the radius and along the angle.
    pub elements: [usize; 2],
    /// Size of the outermost element over that of the innermost.
    #[serde(default = "defaults::one")]
    pub bias: f64,
}

/// A disc or a sector of 90 or 180 degrees of one.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Centre.
    #[serde(default)]
    pub center: [f64; 2],
    /// Radius.
    pub radius: f64,
    /// Start and end angle in degrees: 90, 180 or 360 apart.
    #[serde(default = "defaults::quarter")]
    pub angle: [f64; 2],
    /// Elements over a quarter circle (even).
    pub elements: usize,
}

/// A material: linear elastic, and von Mises plastic where a yield stress is given.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// E > 0.
    pub youngs_modulus: f64,
    /// -1 < nu < 0.5.
    pub poissons_ratio: f64,
    /// Tensile yield stress; without it the material is elastic.
    pub yield_stress: Option<f64>,
    /// d(yield stress)/d(equivalent plastic strain) of linear hardening.
    pub plastic_modulus: Option<f64>,
    /// d(stress)/d(total strain) of a bar beyond yield; `H = E Et/(E - Et)`.
    pub tangent_modulus: Option<f64>,
    /// Table of (equivalent plastic strain, yield stress), first strain 0, flat after the last row.
    pub hardening_table: Option<Vec<[f64; 2]>>,
}

/// What a body is made of and whether it may yield.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name of the material.
    pub material: String,
    /// May this body yield?
    #[serde(default)]
    pub plastic: Plastic,
}

/// May a body yield?
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]

pub enum Plastic {
    /// If its material can and the loads make it (default).
    #[default]
    Auto,
    /// Yes: an error if its material has no yield stress.
    Yes,
    /// No: treated as elastic whatever its stress.
    No,
}

/// Two surfaces that may touch, without friction. Their nodes must pair.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Surface of the first body.
    pub first: String,
    /// Surface of the second body; its outward normal, reversed, is the paper's i_1.
    pub second: String,
    /// Direction from the second body to the first; by default the second surface's outward normal.
    pub normal: Option<[f64; 2]>,
    /// Initial gap for all pairs instead of the geometric one.
    pub gap: Option<f64>,
    /// Interference: taken off every initial gap, applied gradually before the load program.
    #[serde(default)]
    pub interference: f64,
}

/// A support.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Node set or surface.
    pub on: String,
    /// Directions held: `x`, `y`; in the turned axes where `angle` is given.
    pub fix: Vec<Direction>,
    /// Angle in degrees by which the support's axes are turned counter-clockwise.
    pub angle: Option<f64>,
}

/// A coordinate direction; axisymmetric: x is r, y is z.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// x (r).
    X,
    /// y (z).
    Y,
}

/// A load: exactly one of the kinds, with its own history.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name, for messages.
    #[serde(default)]
    pub name: String,
    /// Surface or node set that is loaded.
    pub on: String,
    /// Total force (x, y), shared by the nodes like a uniform traction (surface) or equally (node set).
    pub force: Option<[f64; 2]>,
    /// Pressure on a surface, positive into the body.
    pub pressure: Option<f64>,
    /// Uniform traction (x, y) on a surface.
    pub traction: Option<[f64; 2]>,
    /// Traction of the Kirsch field: plate with a hole of `radius` at the origin under remote tensions.
    pub kirsch: Option<Kirsch>,
    /// Prescribed displacement: the given components, at load factor 1 of this load.
    pub displacement: Option<Displacement>,
    /// A total force on a surface that is held plane: all its nodes share the displacement in `direction`.
    pub plane_force: Option<PlaneForce>,
    /// How it depends on the load factor.
    #[serde(default)]
    pub history: History,
}

/// Remote tensions of a plate with a hole at the origin.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
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

/// Prescribed displacement components.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Along x (r).
    pub x: Option<f64>,
    /// Along y (z).
    pub y: Option<f64>,
}

/// A total force on a surface held plane.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneForce {
    /// Direction.
    pub direction: Direction,
    /// Total force along it.
    pub total: f64,
}

/// How a load depends on the load factor alpha.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]

pub enum History {
    /// `"proportional"`: alpha times the load (default).
    #[default]
    Proportional,
    /// `"constant"`: a preload, applied gradually before the load program starts.
    Constant,
    /// `[[alpha, factor], ...]`: piecewise linear in alpha, flat outside; the value at 0 is a preload.
    Table(Vec<[f64; 2]>),
}

/// The load program.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Program {
    /// What a load factor of 1 means.
    #[serde(default)]
    pub unit: Unit,
    /// How increments are chosen.
    #[serde(default)]
    pub stepping: Stepping,
    /// Increments from one target to the next with `stepping = "steps"`.
    #[serde(default = "defaults::steps")]
    pub steps: usize,
    /// Relative tolerance with which a change of contact is hit (paper 4.18, 4.23).
    #[serde(default = "defaults::gamma")]
    pub gamma: f64,
    /// The targets, reached one after the other; each leaves a state.
    pub targets: Vec<Target>,
}

/// What a load factor of 1 means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// The loads as given in the scene.
    #[default]
    Load,
    /// The yield load: alpha = P/P* (paper 5.1, 5.3).
    Yield,
}

/// How increments are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stepping {
    /// Each increment ends at the next change of contact (paper 4.10 to 4.23).
    #[default]
    Events,
    /// A fixed number of increments per target, contact solved at the end of each.
    Steps,
}

/// A target: exactly one of the conditions.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Name of the state.
    pub name: Option<String>,
    /// `yield = true`: first yield.
    #[serde(default, rename = "yield")]
    pub first_yield: bool,
    /// A load factor.
    pub load_factor: Option<f64>,
    /// A contact half width, as a multiple of that at first yield.
    pub half_width: Option<f64>,
    /// A displacement.
    pub displacement: Option<DisplacementTarget>,
    /// Write fields (VTU) for this state?
    #[serde(default = "defaults::yes")]
    pub fields: bool,
}

/// A target displacement: the mean over a set reaches a value.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplacementTarget {
    /// Node set or surface.
    pub on: String,
    /// Direction.
    pub direction: Direction,
    /// Value of the mean displacement.
    pub value: f64,
}

/// How to compute.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Yield load: the exact path or the paper's secant (3.14).
    pub yield_load: YieldMethod,
    /// How the plastic iteration is accelerated.
    pub plastic_iteration: PlasticIteration,
    /// Out-of-balance force of the plastic iteration over the contact and applied forces.
    pub tolerance: f64,
    /// Most plastic iterations per increment.
    pub max_iterations: usize,
}

/// How the yield load is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum YieldMethod {
    /// Along the piecewise linear path.
    #[default]
    Exact,
    /// The paper's secant, equation 3.14, bracketed.
    Secant,
}

/// How the plastic iteration runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlasticIteration {
    /// Newton with the consistent tangent, solved by conjugate gradients on the factored elastic stiffness.
    #[default]
    Newton,
    /// Anderson acceleration of the plain iteration.
    Anderson,
    /// The paper's initial-load iteration.
    Plain,
}

/// Reference values: a closed form that applies to the scene, or single values with their source.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Hertz line contact at first yield (paper 5.1, Table I): radius of the cylinder.
    pub hertz_line: Option<RadiusOnly>,
    /// Hertz point contact at first yield: radius of the ball.
    pub hertz_point: Option<RadiusOnly>,
    /// Disc in a plate with a hole (paper 5.2, Table II).
    pub disc_in_plate: Option<NoParameters>,
    /// The quantity a single value is for: a path in `summary.json`, such as `yield.load` or `states.NAME.max_pressure`.
    pub quantity: Option<String>,
    /// The single value.
    pub value: Option<f64>,
    /// Where it comes from.
    pub source: Option<String>,
}

/// A closed form whose only geometric parameter is a radius.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RadiusOnly {
    /// The radius.
    pub radius: f64,
}

/// A closed form that needs no parameter.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoParameters {}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            yield_load: YieldMethod::Exact,
            plastic_iteration: PlasticIteration::Newton,
            tolerance: 1e-10,
            max_iterations: 200,
        }
    }
}

impl Scene {
    /// A path of the scene, relative to the scene's file.
    pub fn resolve_path(&self, path: &std::path::Path) -> PathBuf {
        match self.file.as_deref().and_then(std::path::Path::parent) {
            Some(folder) => folder.join(path),
            None => path.to_path_buf(),
        }
    }
}

mod defaults {
    pub fn single() -> usize {
        1
    }
    use crate::mesh::Shape;
    pub fn fine_width() -> f64 {
        2.0
    }
    pub fn fine_depth() -> f64 {
        1.5
    }
    pub fn far_size() -> f64 {
        50.0
    }
    pub fn growth() -> f64 {
        1.15
    }
    pub fn shape() -> Shape {
        Shape::Quad4
    }
    pub fn far_radius() -> f64 {
        20.0
    }
    pub fn disc_growth() -> f64 {
        1.05
    }
    pub fn no_bias() -> [f64; 2] {
        [1.0, 1.0]
    }
    pub fn one() -> f64 {
        1.0
    }
    pub fn quarter() -> [f64; 2] {
        [0.0, 90.0]
    }
    pub fn steps() -> usize {
        20
    }
    pub fn gamma() -> f64 {
        1e-8
    }
    pub fn yes() -> bool {
        true
    }
}
