//! What an analysis computed: states, history, quality and cost, free of any solver's types.

mod accuracy;
mod contact;
mod cycles;
mod end_state;
mod ending;
mod history;
mod points;
mod quality;
mod quantities;
mod ranks;

pub use accuracy::{Accuracy, Companion, Demand, EstimateMethod, QuantityError};
pub use contact::{ContactPatch, PairState, Status};
pub use cycles::{CycleOutcome, CycleRow, Cycles};
pub use end_state::{EndState, LeftBy, LeftByBody};
pub use ending::{Ending, Incomplete};
pub use history::{HistoryRow, PathPoint};
pub use points::PointValues;
pub use quality::{Quality, Tolerances};
pub use quantities::{Estimated, Field, QUANTITIES, Quantity, Scope, Unit, value};
pub use ranks::Ranks;

use crate::space::Vector;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

/// Numbers that are not finite are written as null, or as an empty cell.
pub(crate) fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    // Checkpoints are binary and know every number.
    if !from.is_human_readable() {
        return f64::deserialize(from);
    }
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Everything a run leaves behind.
///
/// ```
/// use brinell::results::Status;
/// # use brinell::{analysis::Analysis, linalg::Backend, model::Model};
/// # use brinell::{progress::Silent, scene::Scene};
///
/// # fn main() -> brinell::Result<()> {
/// # let scene = Scene::load("data/scenes/contact_patch.toml")?;
/// # let results = Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut Silent)?;
/// for state in &results.states {
///     let closed = state.pairs.iter().filter(|pair| pair.status == Status::Closed);
///     println!("{}: load {}, {} pairs closed", state.name, state.load, closed.count());
/// }
/// // A run that ends well: done to its end, and every state within its tolerances.
/// assert_eq!(results.ending(), brinell::results::Ending::Complete);
/// # assert_eq!(results.states[0].pairs.iter().filter(|p| p.status == Status::Closed).count(), 9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default)]
pub struct Results {
    /// Number of free freedoms, elements, contact pairs.
    pub sizes: Sizes,
    /// Which effects were simulated, and why.
    pub effects: Vec<Effect>,
    /// First yield, where a body can yield and does.
    pub first_yield: Option<YieldPoint>,
    /// One state per target reached, in the order of the program.
    pub states: Vec<State>,
    /// Outcome of the cycles, in a program that has them; the states are those of the last.
    pub cycles: Option<Cycles>,
    /// What each rank did, in a run on several ranks.
    pub ranks: Option<Ranks>,
    /// One row per accepted increment.
    pub history: Vec<HistoryRow>,
    /// Names of what each row has besides, where the scene asks for it: `approach`,
    /// `contact_1.approach`, `contact_1.force`, `contact_1.area`, `top.displacement_y`,
    /// `top.force_y`, ...
    pub history_columns: Vec<String>,
    /// Points of the path between the rows of the history, where its figures bend: for curves.
    pub path: Vec<PathPoint>,
    /// Seconds by phase, in order of execution.
    pub timings: Vec<(String, f64)>,
    /// Machine-independent cost.
    pub counts: Counts,
    /// Worst figures over all states.
    pub quality: Quality,
    /// Lower bound of the condition of the factored matrix, rows and columns scaled to a unit
    /// diagonal: the largest loss of a pivot to cancellation, of all the run's factorisations.
    /// Relative errors of displacements may be this times round-off.
    pub condition: f64,
    /// Estimated condition of the same matrix, usually right to a factor of three: where the scene
    /// asks for it (`analysis.condition`), a state is inaccurate, or the lower bound is beyond
    /// 1e10. It takes about six full solves.
    pub condition_estimate: Option<f64>,
    /// States whose quality misses its tolerance, with the figure: results not to be trusted.
    pub inaccurate: Vec<String>,
    /// What the factorisation cost.
    pub factor: Prediction,
    /// Reference values and computed ones, where they were compared (by `reference::compare`).
    pub reference: Vec<ReferenceRow>,
    /// How wrong each figure may be, where it was estimated (by `accuracy::estimate`).
    pub accuracy: Option<Accuracy>,
    /// Things the user should know.
    pub warnings: Vec<String>,
    /// How often the run was stopped or killed and went on from a checkpoint.
    pub resumed: usize,
    /// What is left in the material at the end, where a body may yield.
    pub end_state: Option<EndState>,
    /// Set where the run ended before its program did. [`Results::ending`] says how it ended.
    pub incomplete: Option<Incomplete>,
}

/// Sizes of the model.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Sizes {
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// Freedoms after supports.
    pub freedoms: usize,
    /// Number of contact pairs.
    pub contact_pairs: usize,
    /// Freedoms of the plastic zone.
    pub zone_freedoms: usize,
    /// Elements of the plastic zone.
    pub zone_elements: usize,
    /// Lowest polynomial degree of the elements: 1 or 2.
    #[serde(skip)]
    pub degree: usize,
}

/// What a factorisation costs, from the symbolic analysis alone.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Prediction {
    /// Name of the ordering chosen.
    pub ordering: Cow<'static, str>,
    /// Nonzeros of the factor.
    #[serde(serialize_with = "whole", deserialize_with = "number")]
    pub factor_nonzeros: f64,
    /// Nonzeros of the factor's columns that belong to zone and contact freedoms.
    #[serde(serialize_with = "whole", deserialize_with = "number")]
    pub trailing_nonzeros: f64,
    /// Floating point operations of the factorisation.
    #[serde(serialize_with = "whole", deserialize_with = "number")]
    pub flops: f64,
    /// Bytes needed at the peak.
    #[serde(serialize_with = "whole", deserialize_with = "number")]
    pub memory_bytes: f64,
    /// Bytes on each rank of MPI, else empty; `memory_bytes` is the largest of them.
    pub memory_by_rank: Vec<f64>,
}

/// A count kept as a float, written as an integer where that is exact.
fn whole<S: Serializer>(count: &f64, to: S) -> Result<S::Ok, S::Error> {
    const LARGEST_EXACT: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;
    if (0.0..=LARGEST_EXACT).contains(count) {
        to.serialize_u64(count.round() as u64)
    } else {
        to.serialize_f64(*count)
    }
}

/// The row of the time table that has all factorisations.
pub const FACTORISATION_ROW: &str = "factorisation and condensation";

/// Name of the effect that loads are found for targets by a figure of the state.
pub const LOADS_FOUND: &str = "loads found";

/// A row of the effects ledger.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    /// `contact`, `plasticity`, `interference`, `floating bodies`, ...
    pub name: String,
    /// Whether the effect is simulated.
    pub on: bool,
    /// Whether the scene asks for it: one that is off all the same turned out to be nothing.
    pub asked: bool,
    /// Why it is simulated or not.
    pub why: String,
    /// Seconds spent on it.
    pub seconds: f64,
    /// Bytes held for it.
    pub memory_bytes: u64,
}

/// First yield: load, contact and place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct YieldPoint {
    /// Factor on the scene's proportional loads at which the material first yields.
    pub alpha: f64,
    /// Size of the first load that varies: its force of the whole model, its stress or its change
    /// of temperature; of a prescribed displacement the force that moves its nodes along it, of a
    /// gap the force of its contact.
    pub load: f64,
    /// Maximum contact pressure.
    pub max_pressure: f64,
    /// Contact half width: half the arc length of the contact, doubled on a symmetry plane.
    pub half_width: f64,
    /// Accuracy of the half width's reading off the contact pressures.
    #[serde(default)]
    pub half_width_reading: EdgeReading,
    /// Where: coordinates of the point.
    pub location: Vector,
    /// Index of the body that yields.
    pub body: usize,
}

/// How well the half width of the largest contact patch is read off the pressures.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EdgeReading {
    /// Distance to another reading of the same pressures; half a spacing where there is none.
    pub error: f64,
    /// Closed pairs on one side of the middle.
    pub pairs: usize,
}

/// The state at a target.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct State {
    /// Name, from the scene or made from the target.
    pub name: String,
    /// Load factor in the program's unit.
    pub alpha: f64,
    /// Total load (as in [`YieldPoint::load`]).
    pub load: f64,
    /// Whether the scene gives that load, so that it has no error.
    #[serde(default)]
    pub load_is_given: bool,
    /// Whether the scene gives [`State::approach`], by prescribed displacements alone, so that it
    /// has no error.
    #[serde(default)]
    pub approach_is_given: bool,
    /// Sum of all contact forces.
    pub contact_force: f64,
    /// Pairs of nodes that touch.
    #[serde(default)]
    pub closed_pairs: usize,
    /// Maximum contact pressure.
    pub max_pressure: f64,
    /// Pressure at the first pair of the contact surface that lies on a symmetry plane, or at the
    /// middle of the contact.
    pub pole_pressure: f64,
    /// Contact half width.
    pub half_width: f64,
    /// Accuracy of the half width's reading off the contact pressures.
    #[serde(default)]
    pub half_width_reading: EdgeReading,
    /// Area of the contact patch with the largest force, of the whole; in the plane its width.
    #[serde(default)]
    pub contact_area: f64,
    /// For contacts on a circle: begin and end of the contact, in degrees from the middle of the
    /// contact's axis (the pole); `None` elsewhere.
    pub contact_arc: Option<[f64; 2]>,
    /// The dent that the plastic strains leave once all loads and contact forces are gone: how far
    /// the two surfaces of a contact have moved away from each other where that is most, each
    /// measured from its undeformed shape. Rigid motion is that of the far boundary: supports, for
    /// a body without them the surface through which it is loaded.
    pub residual_depth: f64,
    /// Each body's share in it: depth of its surface below the undeformed one at the deepest place
    /// of its contacts. The shares of two bodies in one contact add up to its dent.
    pub residual_depth_by_body: Vec<f64>,
    /// Height of the rim beside the dent: the most that the surface of a body rises above its
    /// undeformed shape among the contact candidates.
    pub rim_height: f64,
    /// Gauss points with plastic strain.
    pub plastic_points: usize,
    /// Gauss points per body with plastic strain.
    pub plastic_points_by_body: Vec<usize>,
    /// Largest equivalent plastic strain at a Gauss point.
    pub max_equivalent_plastic_strain: f64,
    /// How much larger the equivalent plastic strain may be between the outermost Gauss points and
    /// the surface, by the slope over the points of each element.
    #[serde(default)]
    pub plastic_strain_reading: f64,
    /// Area (axisymmetric or solid: volume) of the whole whose Gauss points have plastic strain.
    pub plastic_zone_size: f64,
    /// Size of a layer of Gauss points along the border of that: no finer is it known.
    #[serde(default)]
    pub plastic_zone_layer: f64,
    /// Work done on the plastic strains of the whole, `sum_g w_g int_0^p sigma_y(p) dp` with the
    /// equivalent plastic strain `p` of each Gauss point; in the plane per unit thickness.
    #[serde(default)]
    pub plastic_work: f64,
    /// Largest distance of a Gauss point with plastic strain from a contact surface, along the
    /// normal there; 0 without contact.
    #[serde(default)]
    pub plastic_depth: f64,
    /// Estimated energy norm of the stress error over that of the stress (Zienkiewicz-Zhu); known
    /// where fields are.
    pub energy_error: Option<f64>,
    /// [`State::energy_error`] of the elements that touch a closed pair or have yielded; `None`
    /// if there are none: how wrong pressures and strains there may be.
    #[serde(default)]
    pub local_energy_error: Option<f64>,
    /// Relative approach of the bodies: the work of the loads that vary with the load factor on the
    /// displacements, over the largest force that they exert on one body. Of a single load that is
    /// the mean displacement of its surface along it. Prescribed displacements, where there are
    /// any, count instead of forces: their mean on each body, added up.
    pub approach: f64,
    /// In a solid model the patches of contact, the strongest first.
    #[serde(default)]
    pub patches: Vec<ContactPatch>,
    /// Each contact pair.
    pub pairs: Vec<PairState>,
    /// Fields on the whole mesh, where asked for.
    pub fields: Option<Fields>,
    /// Quality of this state.
    pub quality: Quality,
}

/// Fields on the whole mesh.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Fields {
    /// `n_nodes x dimension` displacements in global axes.
    pub displacement: Vec<f64>,
    /// `n_elements x 4` element means of stress: xx, yy, zz, xy (axisymmetric: rr, zz, tt, rz); of
    /// a solid `n_elements x 6`: xx, yy, zz, xy, yz, zx.
    pub stress: Vec<f64>,
    /// `n_elements` von Mises stress: the largest over the element's Gauss points.
    pub von_mises: Vec<f64>,
    /// `n_elements` equivalent plastic strain: the largest over the element's Gauss points.
    pub plastic_strain: Vec<f64>,
    /// `n_elements`: 1 where a Gauss point has yielded.
    pub yielded: Vec<u8>,
    /// `n_elements` estimated discretisation error of the stress (Zienkiewicz-Zhu): its energy norm
    /// over the element, over the energy norm of the stress of the whole model. The square root of
    /// the sum of squares is [`State::energy_error`].
    pub error: Vec<f64>,
    /// `n_nodes x 4` (of a solid `x 6`) stresses at the nodes, components as of `stress`: the mean
    /// over a node's elements of the polynomials fitted to the stresses around each of them
    /// (Zienkiewicz-Zhu). Empty in files of versions that did not have them.
    #[serde(default)]
    pub nodal_stress: Vec<f64>,
    /// `n_nodes` contact pressure; 0 of nodes that are in no pair.
    #[serde(default)]
    pub contact_pressure: Vec<f64>,
    /// `n_nodes` gap; NaN of nodes that are in no pair.
    #[serde(default)]
    pub gap: Vec<f64>,
    /// `n_nodes x dimension` forces that act from outside: loads and reactions. Not part of a
    /// result directory.
    #[serde(default)]
    pub force: Vec<f64>,
    /// Values at the integration points, where [`crate::scene::Requests::point_values`] asks for
    /// them. Not part of a result directory.
    #[serde(default)]
    pub points: Option<PointValues>,
}

/// Machine-independent cost of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Counts {
    /// Numerical factorisations of the sparse stiffness.
    pub factorizations: usize,
    /// Numerical factorisations of the zone's block alone, with a plastic tangent.
    #[serde(default)]
    pub zone_factorizations: usize,
    /// Solves with the trailing block, forward and backward substitution a half each.
    pub trailing_solves: usize,
    /// Solves with the whole factor.
    pub full_solves: usize,
    /// Plastic iterations (evaluations of the material over the zone).
    pub plastic_iterations: usize,
    /// Changes of contact status.
    pub contact_changes: usize,
    /// Increments that were not found at once: only with equilibrium and length one after the
    /// other, with patience, or in fixed steps. What that took is part of the solves and
    /// iterations.
    pub hard_increments: usize,
}

/// A published or exact value compared with the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReferenceRow {
    /// What: a path in `summary.json`.
    pub quantity: String,
    /// The reference value.
    #[serde(deserialize_with = "number")]
    pub reference: f64,
    /// The computed value.
    #[serde(deserialize_with = "number")]
    pub computed: f64,
    /// computed / reference; not a number where both are 0.
    #[serde(deserialize_with = "number")]
    pub ratio: f64,
    /// The paper's own figure for the ratio, where it gives one.
    pub published_ratio: Option<f64>,
    /// Book, paper, equation.
    pub source: String,
}
