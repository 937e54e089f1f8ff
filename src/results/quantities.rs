//! The quantities that a run reports. This one table defines the quantities of `summary.json`, the
//! tables of terminal and report, C, Python, the error estimates and the demands on accuracy. To
//! add a quantity, add its field to [`State`] with its computation, an entry here, and its meaning
//! to the schema, which a test compares with this table.

use super::{HistoryRow, PathPoint, Results, State, YieldPoint};

/// The unit in which a quantity is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Dimensionless: a factor, a count, a strain, a relative error.
    One,
    /// A length, in units of the mesh.
    Length,
    /// A stress, in units of the moduli.
    Stress,
    /// The unit of the load: a force, in the plane a force per length; a stress if a stress is the
    /// load.
    Load,
    /// A length in the plane, otherwise an area.
    Area,
    /// An area in the plane, otherwise a volume.
    Size,
    /// An energy, in the plane an energy per length.
    Work,
}

/// The runs in which a quantity carries information.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Runs of every kind.
    Always,
    /// Runs with contact.
    Contact,
    /// Runs in which the material yields.
    Yielding,
    /// Runs with contact in which the material yields.
    YieldingContact,
}

impl Scope {
    /// All scopes, in order.
    pub const ALL: [Scope; 4] = [
        Scope::Always,
        Scope::Contact,
        Scope::Yielding,
        Scope::YieldingContact,
    ];

    /// Whether the scope contains a run, given whether it has contact and whether material yields
    /// in it.
    pub fn holds(self, contact: bool, yielding: bool) -> bool {
        match self {
            Scope::Always => true,
            Scope::Contact => contact,
            Scope::Yielding => yielding,
            Scope::YieldingContact => contact && yielding,
        }
    }
}

/// Access to a quantity in a record. Counts are numbers too; the value of an unknown quantity is
/// NaN.
#[derive(Debug)]
pub struct Field<Record> {
    /// Reads the quantity.
    pub get: fn(&Record) -> f64,
    /// Writes the quantity when a summary is read back.
    pub(crate) set: fn(&mut Record, f64),
}

impl<Record> Clone for Field<Record> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Record> Copy for Field<Record> {}

/// The estimate of the error of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Estimated {
    /// Short name of the quantity for demands on it.
    pub short: &'static str,
    /// Whether the quantity is one of single Gauss points, which converges with first order.
    pub is_of_points: bool,
    /// Whether a demand on all quantities includes this one.
    pub in_all: bool,
}

/// A quantity that runs report: key, unit, and the records that have it.
#[derive(Debug)]
pub struct Quantity {
    /// Key of the quantity in `summary.json`, name of its column in the tables and in Python.
    pub key: &'static str,
    /// Unit of the quantity.
    pub unit: Unit,
    /// Whether the quantity is a count.
    pub is_count: bool,
    /// Runs in which the quantity carries information.
    pub scope: Scope,
    /// Heading of the quantity's column in the tables for readers, in lines; empty if no table has
    /// it.
    pub heading: &'static str,
    /// Whether narrow tables leave out the quantity.
    pub is_detail: bool,
    /// Key of the quantity that makes this column redundant if both are equal.
    pub twin: Option<&'static str>,
    /// Estimate of the quantity's error, if there is one.
    pub estimated: Option<Estimated>,
    /// The quantity at first yield.
    pub at_yield: Option<Field<YieldPoint>>,
    /// The quantity in a state.
    pub in_state: Field<State>,
    /// The quantity in a row of the history.
    pub in_history: Option<Field<HistoryRow>>,
    /// The quantity on the path between two rows.
    pub on_path: Option<Field<PathPoint>>,
}

impl Quantity {
    /// Returns the quantity of a key.
    pub fn of(key: &str) -> Option<&'static Quantity> {
        QUANTITIES.iter().find(|quantity| quantity.key == key)
    }

    /// Returns the value of the quantity at a state or at first yield of a run.
    fn at(&self, place: &QuantityPlace) -> Option<f64> {
        match place {
            QuantityPlace::Yield(point) => Some((self.at_yield?.get)(point)),
            QuantityPlace::State(state) => Some((self.in_state.get)(state)),
        }
    }
}

/// Creates the access to the field of a name.
macro_rules! field {
    ($name:ident) => {
        Field {
            get: |record| record.$name as f64,
            set: |record, value| record.$name = value as _,
        }
    };
}

/// Returns a quantity with default settings: it exists in states only, and in no table for readers.
const fn plain(key: &'static str, unit: Unit, scope: Scope, in_state: Field<State>) -> Quantity {
    Quantity {
        key,
        unit,
        is_count: false,
        scope,
        heading: "",
        is_detail: false,
        twin: None,
        estimated: None,
        at_yield: None,
        in_state,
        in_history: None,
        on_path: None,
    }
}

/// Creates an entry: a field of states with its unit and scope, the other records that have a field
/// of the same name, and further settings.
macro_rules! entry {
    ($name:ident, $unit:ident, $scope:ident, [$($place:ident)*] $(, $more:ident: $value:expr)*) => {
        entry!(field!($name), $name, $unit, $scope, [$($place)*] $(, $more: $value)*)
    };
    (
        $field:expr, $name:ident, $unit:ident, $scope:ident,
        [$($place:ident)*] $(, $more:ident: $value:expr)*
    ) => {
        Quantity {
            $($place: Some(field!($name)),)*
            $($more: $value,)*
            ..plain(stringify!($name), Unit::$unit, Scope::$scope, $field)
        }
    };
}

/// Returns the entry of a quantity whose error is estimated.
const fn error(short: &'static str, is_of_points: bool, in_all: bool) -> Option<Estimated> {
    Some(Estimated {
        short,
        is_of_points,
        in_all,
    })
}

/// All quantities, in the order of `summary.json`.
#[rustfmt::skip] // a row for each
pub static QUANTITIES: [Quantity; 17] = [
    entry!(alpha, One, Always, [at_yield in_history on_path], heading: "load\nfactor"),
    entry!(load, Load, Always, [at_yield in_history on_path],
        heading: "load", estimated: error("load", false, true)),
    entry!(contact_force, Load, Contact, [in_history],
        heading: "contact\nforce", twin: Some("load")),
    entry!(closed_pairs, One, Contact, [in_history], is_count: true),
    entry!(max_pressure, Stress, Contact, [at_yield in_history on_path],
        heading: "max\npressure", estimated: error("pressure", false, true)),
    entry!(pole_pressure, Stress, Contact, [],
        heading: "pole\npressure", twin: Some("max_pressure"),
        estimated: error("pole", false, false)),
    entry!(half_width, Length, Contact, [at_yield in_history on_path],
        heading: "half\nwidth", estimated: error("width", false, true)),
    entry!(contact_area, Area, Contact, [],
        heading: "contact\narea", is_detail: true, estimated: error("area", false, false)),
    entry!(residual_depth, Length, YieldingContact, [],
        heading: "residual\ndepth", estimated: error("dent", false, true)),
    entry!(rim_height, Length, YieldingContact, []),
    entry!(approach, Length, Always, [],
        heading: "approach", estimated: error("approach", false, true)),
    entry!(plastic_points, One, Yielding, [in_history], heading: "plastic\npoints", is_count: true),
    entry!(max_equivalent_plastic_strain, One, Yielding, [in_history],
        heading: "plastic\nstrain", estimated: error("strain", true, false)),
    entry!(plastic_zone_size, Size, Yielding, [],
        heading: "plastic\nzone", is_detail: true, estimated: error("zone", true, false)),
    entry!(plastic_work, Work, Yielding, [],
        heading: "plastic\nwork", is_detail: true, estimated: error("work", false, false)),
    entry!(plastic_depth, Length, YieldingContact, []),
    entry!(ENERGY_ERROR, energy_error, One, Always, []),
];

/// Access to the energy error, which is known if the state has fields.
const ENERGY_ERROR: Field<State> = Field {
    get: |state| state.energy_error.unwrap_or(f64::NAN),
    set: |state, value| state.energy_error = (!value.is_nan()).then_some(value),
};

/// A place that has quantities: a state, or first yield.
enum QuantityPlace<'r> {
    Yield(&'r YieldPoint),
    State(&'r State),
}

/// Returns the number at a path of `summary.json`: `yield.KEY` or `states.NAME.KEY`, where the
/// number of the state, from 0, may stand for its name. `None` if the run has no such number.
pub fn value(results: &Results, path: &str) -> Option<f64> {
    let (head, rest) = path.split_once('.')?;
    if head == "yield" {
        let point = results.first_yield.as_ref()?;
        let axis = |axis: &str| ["x", "y", "z"].iter().position(|name| *name == axis);
        return match rest.strip_prefix("location.") {
            Some(name) => Some(point.location[axis(name)?]),
            None => Quantity::of(rest)?.at(&QuantityPlace::Yield(point)),
        };
    }
    let (name, key) = rest.rsplit_once('.').filter(|_| head == "states")?;
    let states = &results.states;
    let by_number = || states.get(name.parse::<usize>().ok()?);
    let named = states.iter().find(|state| state.name == name);
    Quantity::of(key)?.at(&QuantityPlace::State(named.or_else(by_number)?))
}
