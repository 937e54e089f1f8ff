//! The results of an analysis: states, history, quality and cost, free of any solver's types.

mod accuracy;
mod contact;
mod cycles;
mod end_state;
mod ending;
mod history;
mod incomplete;
mod number;
mod points;
mod quality;
mod quantities;
mod ranks;
mod stiffness;

pub use accuracy::{Accuracy, Companion, Demand, EstimateMethod, QuantityError};
pub use contact::{ContactPatch, PairState, Status};
pub use cycles::{CycleOutcome, CycleRow, Cycles};
pub use end_state::{EndState, LeftBy, LeftByBody};
pub use ending::Ending;
pub use history::{HistoryRow, PathPoint};
pub use incomplete::Incomplete;
pub(crate) use number::number;
pub use points::PointValues;
pub use quality::{Quality, Tolerances};
pub use quantities::{Estimated, Field, QUANTITIES, Quantity, Scope, Unit, value};
pub use ranks::Ranks;

use crate::space::Vector;
use serde::{Deserialize, Serialize, Serializer};
use std::borrow::Cow;

/// All results of a run.
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
    /// Numbers of nodes, elements, freedoms and contact pairs.
    pub sizes: Sizes,
    /// Names of the bodies, in the order of all lists that have one value per body.
    pub bodies: Vec<String>,
    /// The effects that were simulated or not, and why.
    pub effects: Vec<Effect>,
    /// First yield, if a body can yield and does.
    pub first_yield: Option<YieldPoint>,
    /// One state per target reached, in the order of the program.
    pub states: Vec<State>,
    /// Outcome of the cycles, in a program that has them; the states are those of the last cycle.
    pub cycles: Option<Cycles>,
    /// Work of each rank, in a run on several ranks.
    pub ranks: Option<Ranks>,
    /// One row per accepted increment.
    pub history: Vec<HistoryRow>,
    /// Names of the additional columns of each row, if the scene asks for any: `approach`,
    /// `contact_1.approach`, `contact_1.force`, `contact_1.area`, `top.displacement_y`,
    /// `top.force_y`, ...
    pub history_columns: Vec<String>,
    /// Points of the load path between the rows of the history, at places where a curve of the path
    /// bends; for plots.
    pub path: Vec<PathPoint>,
    /// Seconds by phase, in order of execution.
    pub timings: Vec<(String, f64)>,
    /// Machine-independent cost.
    pub counts: Counts,
    /// Worst figures over all states.
    pub quality: Quality,
    /// Lower bound of the condition number of the factored matrix, rows and columns scaled to a
    /// unit diagonal: the largest loss of a pivot to cancellation, over all factorisations of the
    /// run. Relative errors of displacements may be as large as this number times round-off.
    pub condition: f64,
    /// Estimated condition of the same matrix, usually right to a factor of three. It is computed
    /// if the scene asks for it (`analysis.condition`), a state is inaccurate, or the lower bound
    /// is beyond 1e10, and takes about six full solves.
    pub condition_estimate: Option<f64>,
    /// Reasons not to trust the results: states whose quality misses its tolerance, with the
    /// figure; a contact that presses although a load has opened it by more than half the model;
    /// displacements that are not small although a deck asks for large ones.
    pub inaccurate: Vec<String>,
    /// Predicted cost of the factorisation.
    pub factor: Prediction,
    /// Reference values and computed values, if they were compared (by `reference::compare`).
    pub reference: Vec<ReferenceRow>,
    /// Estimated error of each figure, if it was estimated (by `accuracy::estimate`).
    pub accuracy: Option<Accuracy>,
    /// Messages that the user should know.
    pub warnings: Vec<String>,
    /// Number of times that the run was stopped or killed and continued from a checkpoint.
    pub resumed: usize,
    /// State of the material at the end, if a body may yield.
    pub end_state: Option<EndState>,
    /// Set if the run ended before its program did. [`Results::ending`] says how it ended.
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

/// Cost of a factorisation, from the symbolic analysis alone.
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
    /// Bytes on each rank of MPI, empty without MPI; `memory_bytes` is the largest of them.
    pub memory_by_rank: Vec<f64>,
}

/// Writes a count that is kept as a float, as an integer if that is exact.
fn whole<S: Serializer>(count: &f64, to: S) -> Result<S::Ok, S::Error> {
    const LARGEST_EXACT: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;
    if (0.0..=LARGEST_EXACT).contains(count) {
        to.serialize_u64(count.round() as u64)
    } else {
        to.serialize_f64(*count)
    }
}

/// Name of the row of the time table for all factorisations.
pub const FACTORISATION_ROW: &str = "factorisation and condensation";

/// Name of the effect in which loads are searched for: it is on if a target gives a figure of the
/// state, such as a half width, instead of a load.
pub const LOADS_FOUND: &str = "loads found";

/// A row of the effects ledger.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    /// Name, such as `contact`, `plasticity`, `floating bodies`.
    pub name: String,
    /// Whether the effect is simulated.
    pub on: bool,
    /// Whether the scene asks for the effect; an effect that is asked for but off turned out to be
    /// zero.
    pub asked: bool,
    /// The reason why it is simulated or not.
    pub why: String,
    /// Seconds spent on the effect.
    pub seconds: f64,
    /// Bytes held for the effect.
    pub memory_bytes: u64,
}

/// First yield: load, contact and place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct YieldPoint {
    /// Factor on the scene's proportional loads at which the material first yields.
    pub alpha: f64,
    /// Size of the first load that varies: its force on the whole model, its stress or its change
    /// of temperature; for a prescribed displacement the force that moves its nodes along it, for a
    /// gap the force of its contact.
    pub load: f64,
    /// Maximum contact pressure.
    pub max_pressure: f64,
    /// Contact half width: half the arc length of the contact, doubled on a symmetry plane.
    pub half_width: f64,
    /// Accuracy with which the half width is read from the contact pressures.
    #[serde(default)]
    pub half_width_reading: EdgeReading,
    /// Coordinates of the point at which the material first yields.
    pub location: Vector,
    /// Index of the body that yields.
    pub body: usize,
}

/// Accuracy with which the half width of the largest contact patch is read from the pressures.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EdgeReading {
    /// Difference from another reading of the same pressures; half a spacing if there is none.
    pub error: f64,
    /// Number of closed pairs on one side of the middle: half of all, rounded down, so that a
    /// single closed pair between open ones gives 0.
    pub pairs: usize,
}

impl EdgeReading {
    /// Number of pairs at the edge, the last closed one included, of which only the total force is
    /// trusted: the share of each depends on where in the facet the contact ends.
    pub(crate) const AT_EDGE: usize = 2;

    /// Whether the contact of this half width ends inside the surfaces, where pressures show its
    /// edge; at the edge of a surface both readings agree to round-off.
    pub(crate) fn is_of_pressures(&self, half_width: f64) -> bool {
        self.error > 1e-9 * half_width
    }
}

/// The state of the model at a target.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct State {
    /// Name of the state, from the scene or made from the target.
    pub name: String,
    /// Load factor, in the unit of the load program.
    pub alpha: f64,
    /// Number of increments up to the state: rows of the history.
    #[serde(default)]
    pub increments: usize,
    /// Total load, defined as [`YieldPoint::load`].
    pub load: f64,
    /// Whether any load acts, the leading one or another.
    #[serde(default)]
    pub is_loaded: bool,
    /// Whether the scene gives the load, so that it has no error.
    #[serde(default)]
    pub load_is_given: bool,
    /// Whether the scene gives [`State::approach`], by prescribed displacements alone, so that it
    /// has no error.
    #[serde(default)]
    pub approach_is_given: bool,
    /// Sum of all contact forces.
    pub contact_force: f64,
    /// Number of pairs of nodes that touch.
    #[serde(default)]
    pub closed_pairs: usize,
    /// Maximum contact pressure.
    pub max_pressure: f64,
    /// Pressure at the first pair of the contact surface that lies on a symmetry plane, or at the
    /// centre of the contact.
    pub pole_pressure: f64,
    /// Contact half width.
    pub half_width: f64,
    /// Accuracy with which the half width is read from the contact pressures.
    #[serde(default)]
    pub half_width_reading: EdgeReading,
    /// Area of the contact patch with the largest force, for the whole body; in plane strain and
    /// plane stress the width of that patch.
    #[serde(default)]
    pub contact_area: f64,
    /// For contacts on a circle: begin and end of the contact, in degrees from the middle of the
    /// contact's axis (the pole); `None` for others.
    pub contact_arc: Option<[f64; 2]>,
    /// The dent that the plastic strains leave once all loads and contact forces have vanished: the
    /// largest distance by which the two surfaces of a contact have moved away from each other,
    /// each measured from its undeformed shape. The rigid motion of a body is that of its far
    /// boundary: the supports, or for a body without supports the surface through which it is
    /// loaded.
    pub residual_depth: f64,
    /// Each body's share in [`State::residual_depth`]: depth of its surface below the undeformed
    /// one at the deepest place of its contacts. The shares of two bodies in one contact add up to
    /// its dent.
    pub residual_depth_by_body: Vec<f64>,
    /// Height of the rim next to the dent: the largest height to which the surface of a body rises
    /// above its undeformed shape among the contact candidates.
    pub rim_height: f64,
    /// Number of Gauss points with plastic strain.
    pub plastic_points: usize,
    /// Number of Gauss points with plastic strain, per body.
    pub plastic_points_by_body: Vec<usize>,
    /// Largest equivalent plastic strain at a Gauss point.
    pub max_equivalent_plastic_strain: f64,
    /// Amount by which the equivalent plastic strain may be larger between the outermost Gauss
    /// points and the surface, extrapolated with the slope over the points of each element.
    #[serde(default)]
    pub plastic_strain_reading: f64,
    /// Size of the plastic zone of the whole body: the area (axisymmetric or solid: volume) of the
    /// Gauss points that have plastic strain.
    pub plastic_zone_size: f64,
    /// Size of a layer of Gauss points along the border of the plastic zone, which is the
    /// resolution of [`State::plastic_zone_size`].
    #[serde(default)]
    pub plastic_zone_layer: f64,
    /// Work of the stresses on the plastic strains of the whole body, in the plane per unit
    /// thickness: `sum_g w_g int_0^p sigma_y(p) dp` with the equivalent plastic strain `p` of each
    /// Gauss point, and the work that back stresses store and lose.
    #[serde(default)]
    pub plastic_work: f64,
    /// Largest distance of a Gauss point with plastic strain from a contact surface, along the
    /// surface normal; 0 without contact.
    #[serde(default)]
    pub plastic_depth: f64,
    /// Estimated energy norm of the stress error over that of the stress (Zienkiewicz-Zhu); known
    /// if the state has fields.
    pub energy_error: Option<f64>,
    /// [`State::energy_error`] of the elements that touch a closed pair or have yielded, as an
    /// estimate of the error of pressures and strains there; `None` if there are no such elements.
    #[serde(default)]
    pub local_energy_error: Option<f64>,
    /// Relative approach of the bodies: the work of the loads that vary with the load factor on the
    /// displacements, over the largest force that they exert on one body. For a single load this is
    /// the mean displacement of its surface along the load. If displacements are prescribed, they
    /// count instead of forces: their mean on each body, added up.
    pub approach: f64,
    /// Patches of contact in a solid model, the one with the largest force first.
    #[serde(default)]
    pub patches: Vec<ContactPatch>,
    /// Each contact pair.
    pub pairs: Vec<PairState>,
    /// Fields on the whole mesh, if they were asked for.
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
    /// `n_elements`: 1 if a Gauss point has yielded.
    pub yielded: Vec<u8>,
    /// `n_elements` estimated discretisation error of the stress (Zienkiewicz-Zhu): its energy norm
    /// over the element, over the energy norm of the stress of the whole model. The square root of
    /// the sum of squares is [`State::energy_error`].
    pub error: Vec<f64>,
    /// `n_nodes x 4` (for a solid `x 6`) stresses at the nodes, components as for `stress`: the
    /// mean over a node's elements of the polynomials fitted to the stresses around each of them
    /// (Zienkiewicz-Zhu). Empty in files of versions that did not have this field.
    #[serde(default)]
    pub nodal_stress: Vec<f64>,
    /// `n_nodes` contact pressure; 0 at nodes that are in no pair.
    #[serde(default)]
    pub contact_pressure: Vec<f64>,
    /// `n_nodes` gap; NaN at nodes that are in no pair.
    #[serde(default)]
    pub gap: Vec<f64>,
    /// `n_nodes x dimension` forces that act from outside: loads and reactions. Not part of a
    /// result directory.
    #[serde(default)]
    pub force: Vec<f64>,
    /// Values at the integration points, if [`crate::scene::Requests::point_values`] asks for them.
    /// Not part of a result directory.
    #[serde(default)]
    pub points: Option<PointValues>,
}

/// Machine-independent cost of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Counts {
    /// Number of numerical factorisations of the sparse stiffness.
    pub factorizations: usize,
    /// Number of numerical factorisations of the zone's block alone, with a plastic tangent.
    #[serde(default)]
    pub zone_factorizations: usize,
    /// Number of solves with the trailing block; forward and backward substitution count a half
    /// each.
    pub trailing_solves: usize,
    /// Number of solves with the whole factor.
    pub full_solves: usize,
    /// Number of plastic iterations (evaluations of the material over the zone).
    pub plastic_iterations: usize,
    /// Number of changes of contact status.
    pub contact_changes: usize,
    /// Number of increments that were not found in one iteration, but only with equilibrium and
    /// length one after the other, with many more iterations, or in fixed steps. The additional
    /// work is part of the solves and iterations.
    pub hard_increments: usize,
}

impl Counts {
    /// The sum of the counts of two runs.
    pub(crate) fn and(&self, other: &Counts) -> Counts {
        Counts {
            factorizations: self.factorizations + other.factorizations,
            zone_factorizations: self.zone_factorizations + other.zone_factorizations,
            trailing_solves: self.trailing_solves + other.trailing_solves,
            full_solves: self.full_solves + other.full_solves,
            plastic_iterations: self.plastic_iterations + other.plastic_iterations,
            contact_changes: self.contact_changes + other.contact_changes,
            hard_increments: self.hard_increments + other.hard_increments,
        }
    }
}

/// A published or exact value compared with the computed one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReferenceRow {
    /// Path of the quantity in `summary.json`.
    pub quantity: String,
    /// The reference value.
    #[serde(deserialize_with = "number")]
    pub reference: f64,
    /// The computed value.
    #[serde(deserialize_with = "number")]
    pub computed: f64,
    /// Ratio computed / reference; not a number if both are 0.
    #[serde(deserialize_with = "number")]
    pub ratio: f64,
    /// The paper's own figure for the ratio, if it gives one.
    pub published_ratio: Option<f64>,
    /// Source of the reference: book, paper, equation.
    pub source: String,
}
