//! Models from arrays: loads and the load program.

use super::border::{SizePrefixed, shared, slice, text};
use super::conditions::{BRINELL_X, BRINELL_Y, BRINELL_Z, directions, rows, zero_or};
use super::model::{brinell_model, change, one_of};
use crate::error::{Error, Result};
use crate::scene::{
    Direction, Displacement, DisplacementTarget, History, Kirsch, Load, PlaneForce,
    PlasticIteration, Program, Settings, Stepping, Target, Unit, YieldMethod,
};
use std::ffi::c_char;

/// Total force (x, y), shared by the nodes like a uniform traction (surface) or equally (node set).
pub const BRINELL_LOAD_FORCE: i32 = 0;
/// Pressure on a surface, positive into the body: the first of `values`.
pub const BRINELL_LOAD_PRESSURE: i32 = 1;
/// Uniform traction (x, y) on a surface.
pub const BRINELL_LOAD_TRACTION: i32 = 2;
/// Traction of a plate with a hole at the origin under remote stress along x and y: values are both
/// stresses and the radius.
pub const BRINELL_LOAD_KIRSCH: i32 = 3;
/// Prescribed displacement (x, y) in the given directions.
pub const BRINELL_LOAD_DISPLACEMENT: i32 = 4;
/// Total force (the first of `values`) along the one given direction, on a surface that is held
/// plane.
pub const BRINELL_LOAD_PLANE_FORCE: i32 = 5;
/// A force of its own (x, y) on each of `nodes`; `name` is needed, `on` is not.
pub const BRINELL_LOAD_NODAL: i32 = 6;

/// The load factor times the load.
pub const BRINELL_PROPORTIONAL: i32 = 0;
/// A preload, applied gradually before the load program.
pub const BRINELL_CONSTANT: i32 = 1;
/// By a table over the load factor.
pub const BRINELL_TABLE: i32 = 2;

/// A load at factor 1.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_load {
    /// sizeof(brinell_load).
    pub size: usize,
    /// One of BRINELL_LOAD_...
    pub kind: i32,
    /// BRINELL_X, BRINELL_Y, BRINELL_Z or several (or-ed), where the kind needs it.
    pub directions: i32,
    /// Name for messages; NULL if not given.
    pub name: *const c_char,
    /// Surface or node set.
    pub on: *const c_char,
    /// What the kind says.
    pub values: [f64; 3],
    /// n_nodes nodes of a nodal load.
    pub nodes: *const i64,
    /// n_nodes x 2 forces, of a solid x 3.
    pub forces: *const f64,
    /// Nodes of a nodal load.
    pub n_nodes: usize,
    /// BRINELL_PROPORTIONAL, BRINELL_CONSTANT or BRINELL_TABLE.
    pub history: i32,
    /// n_table rows of (load factor, multiple), piecewise linear.
    pub table: *const f64,
    /// Rows of the table.
    pub n_table: usize,
}

// SAFETY: repr(C), begins with its size, numbers and pointers.
unsafe impl SizePrefixed for brinell_load {
    const NAME: &'static str = "brinell_load";
}

/// A load factor.
pub const BRINELL_TARGET_LOAD_FACTOR: i32 = 0;
/// First yield.
pub const BRINELL_TARGET_YIELD: i32 = 1;
/// A contact half width as a multiple of that at first yield.
pub const BRINELL_TARGET_HALF_WIDTH: i32 = 2;
/// A mean displacement of `on` along `direction`.
pub const BRINELL_TARGET_DISPLACEMENT: i32 = 3;

/// A target of the load program: it leaves a state.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_target {
    /// sizeof(brinell_target).
    pub size: usize,
    /// One of BRINELL_TARGET_...
    pub kind: i32,
    /// BRINELL_X or BRINELL_Y of a displacement.
    pub direction: i32,
    /// Load factor, multiple or displacement.
    pub value: f64,
    /// Node set or surface of a displacement.
    pub on: *const c_char,
    /// Name of the state; NULL to have one made.
    pub name: *const c_char,
    /// 1 to leave out the fields of this state.
    pub no_fields: i32,
}

// SAFETY: repr(C), begins with its size, numbers and pointers.
unsafe impl SizePrefixed for brinell_target {
    const NAME: &'static str = "brinell_target";
}

/// How the load program is computed. What is zero is as by default.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct brinell_program {
    /// sizeof(brinell_program).
    pub size: usize,
    /// What a load factor of 1 means: the loads as given (0), the yield load (1).
    pub unit: i32,
    /// Increments end at the next change of contact (0), or there are `steps` of them for each
    /// target (1).
    pub stepping: i32,
    /// Increments for each target.
    pub steps: usize,
    /// Relative tolerance with which a change of contact is landed on.
    pub gamma: f64,
    /// Yield load along the exact path (0) or by the paper's secant (1).
    pub yield_load: i32,
    /// Plastic iteration: Newton (0), Anderson (1), plain (2).
    pub plastic_iteration: i32,
    /// Out-of-balance force of the plastic iteration over the contact and applied forces.
    pub tolerance: f64,
    /// Most plastic iterations of an increment.
    pub max_iterations: usize,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl SizePrefixed for brinell_program {
    const NAME: &'static str = "brinell_program";
}

fn direction(which: i32, what: &str) -> Result<Direction> {
    match which {
        BRINELL_X => Ok(Direction::X),
        BRINELL_Y => Ok(Direction::Y),
        BRINELL_Z => Ok(Direction::Z),
        other => Err(Error::input(format!(
            "{what}: {other} is no direction; give BRINELL_X, BRINELL_Y or BRINELL_Z"
        ))),
    }
}

/// A text or nothing.
///
/// # Safety
/// As [`text`].
unsafe fn optional_text(from: *const c_char, what: &str) -> Result<String> {
    if from.is_null() {
        return Ok(String::new());
    }
    // SAFETY: as vouched for by the caller.
    unsafe { text(from, what) }.map(str::to_string)
}

/// Adds a load.
///
/// # Safety
/// `model` is a living handle, `load` as long as it says and so are its arrays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_load(
    model: *mut brinell_model,
    load: *const brinell_load,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            shared(load, "the load")?;
            let given = zero_or(load)?;
            let history = match given.history {
                BRINELL_PROPORTIONAL => History::Proportional,
                BRINELL_CONSTANT => History::Constant,
                BRINELL_TABLE => History::Table(rows(given.table, given.n_table, "table")?),
                other => return Err(Error::input(format!("there is no history {other}"))),
            };
            if given.kind == BRINELL_LOAD_NODAL {
                let nodes = slice(given.nodes, given.n_nodes, "nodes of the load")?;
                let forces = m.vectors(given.forces, given.n_nodes, "forces of the load")?;
                let name = text(given.name, "the name of a nodal load")?;
                m.builder.nodal_load(name, nodes, &forces, history)?;
                return Ok(());
            }
            let mut load = Load {
                name: optional_text(given.name, "the name of the load")?,
                on: text(given.on, "the surface or node set of the load")?.to_string(),
                history,
                ..Load::default()
            };
            let [x, y, z] = given.values;
            match given.kind {
                BRINELL_LOAD_FORCE => load.force = Some(m.builder.components([x, y, z])),
                BRINELL_LOAD_PRESSURE => load.pressure = Some(x),
                BRINELL_LOAD_TRACTION => load.traction = Some(m.builder.components([x, y, z])),
                BRINELL_LOAD_KIRSCH => {
                    load.kirsch = Some(Kirsch {
                        stress_x: x,
                        stress_y: y,
                        radius: z,
                    });
                }
                BRINELL_LOAD_DISPLACEMENT => {
                    let moved = directions(given.directions, "displacement")?;
                    load.displacement = Some(Displacement {
                        x: moved.contains(&Direction::X).then_some(x),
                        y: moved.contains(&Direction::Y).then_some(y),
                        z: moved.contains(&Direction::Z).then_some(z),
                    });
                }
                BRINELL_LOAD_PLANE_FORCE => {
                    load.plane_force = Some(PlaneForce {
                        direction: direction(given.directions, "plane force")?,
                        total: x,
                    });
                }
                other => return Err(Error::input(format!("there is no kind of load {other}"))),
            }
            m.builder.load(load);
            Ok(())
        })
    }
}

/// Adds a target of the load program. A model without one has load factor 1 as its target.
///
/// # Safety
/// `model` is a living handle, `target` as long as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_target(
    model: *mut brinell_model,
    target: *const brinell_target,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            shared(target, "the target")?;
            let given = zero_or(target)?;
            let name = optional_text(given.name, "the name of the target")?;
            let mut target = Target {
                name: (!name.is_empty()).then_some(name),
                fields: given.no_fields == 0,
                ..Target::default()
            };
            match given.kind {
                BRINELL_TARGET_LOAD_FACTOR => target.load_factor = Some(given.value),
                BRINELL_TARGET_YIELD => target.first_yield = true,
                BRINELL_TARGET_HALF_WIDTH => target.half_width = Some(given.value),
                BRINELL_TARGET_DISPLACEMENT => {
                    target.displacement = Some(DisplacementTarget {
                        on: text(given.on, "the set of the target")?.to_string(),
                        direction: direction(given.direction, "target")?,
                        value: given.value,
                    });
                }
                other => return Err(Error::input(format!("there is no kind of target {other}"))),
            }
            m.program.targets.push(target);
            Ok(())
        })
    }
}

/// States how the load program is computed; the targets stay.
///
/// # Safety
/// `model` is a living handle, `program` NULL or as long as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_program(
    model: *mut brinell_model,
    program: *const brinell_program,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let given = zero_or(program)?;
            let iterations = [
                PlasticIteration::Newton,
                PlasticIteration::Anderson,
                PlasticIteration::Plain,
            ];
            let methods = [YieldMethod::Exact, YieldMethod::Secant];
            let mut settings = Settings {
                yield_load: one_of(&methods, given.yield_load, "way to the yield load")?,
                plastic_iteration: one_of(
                    &iterations,
                    given.plastic_iteration,
                    "plastic iteration",
                )?,
                ..Settings::default()
            };
            let mut program = Program {
                unit: one_of(&[Unit::Load, Unit::Yield], given.unit, "unit")?,
                stepping: one_of(
                    &[Stepping::Events, Stepping::Steps],
                    given.stepping,
                    "stepping",
                )?,
                targets: m.program.targets.clone(),
                ..Program::default()
            };
            if given.steps != 0 {
                program.steps = given.steps;
            }
            if given.gamma != 0.0 {
                program.gamma = given.gamma;
            }
            if given.tolerance != 0.0 {
                settings.tolerance = given.tolerance;
            }
            if given.max_iterations != 0 {
                settings.max_iterations = given.max_iterations;
            }
            m.program = program;
            m.builder.settings(settings);
            Ok(())
        })
    }
}
