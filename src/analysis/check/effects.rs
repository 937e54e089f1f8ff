//! The effects that a scene calls for and the cost of its run, before anything is solved.

use super::seconds;
use crate::analysis::choice::zone_choice;
use crate::analysis::structure::factored::zone_freedoms;
use crate::analysis::structure::starting;
use crate::assembly::assemble;
use crate::error::Result;
use crate::linalg::{Backend, Partition, Prediction};
use crate::memory;
use crate::model::{LoadCase, Magnitude, Model, TargetCondition};
use crate::number::exact;
use crate::results::{Effect, EndState, LOADS_FOUND, Sizes};
use crate::scene::{LoadAction, VolumeAction};
use crate::substructure::ContactCost;
use serde::Serialize;
use std::collections::BTreeMap;

/// Effects and predicted cost of a run of the scene.
#[derive(Debug, Clone, Serialize)]
pub struct Check {
    /// Effects that the scene calls for.
    pub effects: Vec<Effect>,
    /// Sizes of the model.
    pub sizes: Sizes,
    /// Cost of the factorisation, from the symbolic analysis.
    pub prediction: Prediction,
    /// Memory that this process may still take, in bytes, and into which the run must fit. `None`
    /// if the system does not report it.
    pub available_bytes: Option<f64>,
    /// Cost of the dense part of contact, from the numbers of pairs that are joined by bodies.
    pub contact: ContactCost,
    /// Rough time of one factorisation, at the speed that is typical of one core.
    pub predicted_seconds: f64,
    /// Rough time of the whole run without the estimate of its errors and without the report: mesh
    /// and assembly, factorisation, yield load, increments, states. On the machine to which it was
    /// fitted, it is within a factor of 3 of the time that the scenes of `data/scenes` take. Runs
    /// that come near a limit load are an exception: they may take 50 times as long.
    pub predicted_run_seconds: f64,
    /// The BLAS in use.
    pub blas: String,
    /// What the estimate of the run's errors will do and how long it will take, in words; empty if
    /// no estimate was asked for.
    pub error_estimate: String,
    /// Things the user should know.
    pub notes: Vec<String>,
}

impl Check {
    /// Whether the run fits into the available memory; `None` if that is not known.
    pub fn fits(&self) -> Option<bool> {
        let needed = self.prediction.memory_bytes;
        self.available_bytes.map(|available| needed <= available)
    }
}

/// Number of freedoms from which faer is recommended on one thread: the smaller of the two solids
/// on which it was measured to be faster
/// (`cargo bench --features faer --bench history -- backends 110k 300k`).
const FASTER_BY_FAER: usize = 100_000;

/// Predicted seconds above which the user is warned before a run.
const LONG: f64 = 60.0;

/// Predicts effects and cost of a model; solves nothing.
///
/// # Errors
/// Limits of the backend; errors of the directory that the scene starts from.
pub fn check(model: &Model, backend: Backend) -> Result<Check> {
    let start = starting::read(model)?;
    let system = assemble(model, backend)?;
    let choice = zone_choice::first_guess(model);
    let zone = zone_freedoms(model, &choice.elements);
    let partition = Partition {
        n: model.freedoms.n,
        zone,
        contact: model.rows.freedoms.clone(),
    };
    let mut prediction = system.stiffness.predict(backend, &partition)?;
    let contact = ContactCost::of(model);
    prediction.memory_bytes += contact.memory_bytes;
    if let Some(first) = prediction.memory_by_rank.first_mut() {
        *first += contact.memory_bytes;
        let ranks = prediction.memory_by_rank.iter().copied();
        prediction.memory_bytes = ranks.fold(0.0, f64::max);
    }
    let sizes = Sizes {
        freedoms: model.freedoms.n,
        nodes: model.mesh.n_nodes(),
        elements: model.mesh.n_elements(),
        contact_pairs: model.pairs.len(),
        zone_freedoms: partition.zone.len(),
        zone_elements: choice.elements.len(),
        degree: model.mesh.degree(),
    };
    let of_contact = seconds::of_contact(&contact);
    let factorisation = seconds::of_factorisation(&prediction, backend) + of_contact;
    let again = model.program.support_changes.len() as f64 * factorisation;
    let run = again + seconds::of_run(model, &sizes, &prediction, factorisation);
    let mut notes = model.warnings.clone();
    notes.extend(notes_on_program(model));
    notes.extend(faster_solver(model, backend));
    notes.extend(notes_on_time(&contact, of_contact, run));
    Ok(Check {
        effects: effects(model, !choice.elements.is_empty(), start.as_ref()),
        sizes,
        prediction,
        available_bytes: memory::available(),
        contact,
        predicted_seconds: factorisation,
        predicted_run_seconds: run,
        blas: backend.arithmetic(),
        error_estimate: String::new(),
        notes,
    })
}

/// Notes on parts of the program that the prediction leaves out.
fn notes_on_program(model: &Model) -> Vec<String> {
    let mut notes = Vec::new();
    if model.scene.accuracy.is_some() {
        notes.push(
            "the scene demands an accuracy: a run chooses its meshes itself, the figures here are \
             of the scene's own"
                .to_string(),
        );
    }
    let cycles = model.program.cycles;
    if cycles > 1 {
        notes.push(format!(
            "the program has at most {cycles} cycles: memory is that of all, time that of one"
        ));
    }
    notes
}

/// A note on a solver that takes less time for the model.
fn faster_solver(model: &Model, backend: Backend) -> Option<String> {
    let is_faster = backend == Backend::Cholmod
        && Backend::Faer.is_built_in()
        && model.mesh.is_solid()
        && model.freedoms.n >= FASTER_BY_FAER
        && Backend::Cholmod.threads() == Some(1);
    is_faster.then(|| {
        "on one thread the solver faer takes about a tenth less for such solids: --solver faer \
         (on two CHOLMOD is the faster one: OPENBLAS_NUM_THREADS)"
            .to_string()
    })
}

/// Notes on contact and on runs that take long, in seconds.
fn notes_on_time(contact: &ContactCost, of_contact: f64, run: f64) -> Vec<String> {
    let mut notes = Vec::new();
    if of_contact > LONG {
        notes.push(format!(
            "{} pairs are joined by bodies: the dense matrices of their contact take about \
             {:.0} min (the cube of their number) and {:.0} MB (the square); fewer pairs, or \
             bodies that nothing joins, take less",
            contact.largest_group,
            (of_contact / 60.0).ceil(),
            (contact.memory_bytes / 1e6).ceil()
        ));
    }
    if run > LONG {
        notes.push(format!(
            "the run may take about {:.0} min, and the estimate of its errors as long again: fewer \
             elements (resolution) or a smaller largest load make it shorter, `--estimate none` \
             leaves the estimate out",
            (run / 60.0).ceil()
        ));
    }
    notes
}

fn effect(name: &str, on: bool, why: String) -> Effect {
    Effect {
        name: name.into(),
        on,
        asked: on,
        why,
        seconds: 0.0,
        memory_bytes: 0,
    }
}

/// An effect that the scene asks for. It is reported as off if it has no consequence in this run.
fn effect_asked_for(name: &str, asked: bool, on: bool, why: String) -> Effect {
    Effect {
        asked,
        ..effect(name, asked && on, why)
    }
}

fn kinematic_hardening(model: &Model, yields: bool) -> Effect {
    let materials = model.materials.iter().zip(&model.may_yield);
    let asked = materials.filter(|(m, may)| **may && !m.back_stresses.is_none());
    let asked: BTreeMap<&str, usize> = asked
        .map(|(m, _)| (m.name.as_str(), m.back_stresses.n_stored()))
        .collect();
    let names = asked.keys().copied().collect::<Vec<_>>().join(", ");
    let why = match (asked.is_empty(), yields, asked.values().max()) {
        (false, true, Some(0)) => {
            format!("{names} hardens so; its back stress follows from the plastic strain")
        }
        (false, true, Some(1)) => format!("{names} hardens so, with a back stress that fades"),
        (false, true, Some(n)) => format!("{names} hardens so, with {n} back stresses that fade"),
        (false, ..) => format!("{names} could, but stays elastic under these loads"),
        (true, ..) => "no material that may yield has a back stress".to_string(),
    };
    effect_asked_for("kinematic hardening", !asked.is_empty(), yields, why)
}

fn yield_by_depth(model: &Model, yields: bool) -> Effect {
    let bodies = model.mesh.bodies.iter().zip(&model.yield_by_depth);
    let asked = bodies
        .zip(&model.may_yield)
        .filter(|((_, profile), may)| profile.is_some() && **may);
    let names: Vec<&str> = asked.map(|((name, _), _)| name.as_str()).collect();
    let names = names.join(", ");
    let why = match (names.is_empty(), yields) {
        (true, _) => {
            "no body that may yield has another yield stress than its material".to_string()
        }
        (false, true) => format!("the yield stress of {names} depends on the depth"),
        (false, false) => format!("{names} stays elastic under these loads"),
    };
    effect_asked_for("yield stress by depth", !names.is_empty(), yields, why)
}

fn volume_forces(model: &Model) -> Effect {
    let loads = model.scene.load.iter().zip(&model.loads);
    let asked = loads.filter(|(load, _)| match load.action() {
        Some(LoadAction::OnVolume(action)) => match action {
            VolumeAction::Acceleration(_) | VolumeAction::Rotation(_) => true,
            VolumeAction::Temperature(_) => false,
        },
        Some(LoadAction::OnNodes(_)) | None => false,
    });
    let (asked, acting) = asked.fold((0, 0), |(n, acting), (_, case)| {
        (n + 1, acting + usize::from(case.magnitude != 0.0))
    });
    let why = match (asked, acting) {
        (0, _) => "no load by acceleration or rotation".to_string(),
        (_, 0) => "the accelerations and speeds are zero".to_string(),
        (_, 1) => "a load acts on the volume of a body".to_string(),
        (_, n) => format!("{n} loads act on the volumes of bodies"),
    };
    effect_asked_for("forces on volumes", asked > 0, acting > 0, why)
}

fn temperature(model: &Model) -> Effect {
    let loads = model.loads.iter();
    let asked = loads.filter(|load| load.measures == Magnitude::Temperature);
    let (asked, acting) = asked.fold((0, 0), |(n, acting), load| {
        (n + 1, acting + usize::from(!load.free_strain.is_empty()))
    });
    let why = match (asked, acting) {
        (0, _) => "no load by temperature".to_string(),
        (_, 0) => "no temperature changes, or nothing expands by it".to_string(),
        (_, 1) => "a load changes the temperature of a body".to_string(),
        (_, n) => format!("{n} loads change the temperatures of bodies"),
    };
    effect_asked_for("temperature", asked > 0, acting > 0, why)
}

fn over_temperature(model: &Model) -> Effect {
    let scene = &model.scene;
    let asked = scene
        .bodies
        .iter()
        .filter(|(_, body)| body.temperature.is_some());
    let asked: Vec<(&String, &str)> = asked
        .map(|(name, body)| (name, body.material.as_str()))
        .collect();
    let varies = |material: &str| {
        let material = scene.materials.get(material);
        material.is_some_and(|material| material.temperatures().is_some())
    };
    let acting = asked.iter().filter(|(_, material)| varies(material));
    let names: Vec<&str> = acting.map(|(name, _)| name.as_str()).collect();
    let why = match (asked.is_empty(), names.is_empty()) {
        (true, _) => "no body has a temperature of its own".to_string(),
        (_, true) => "no material of the bodies with a temperature depends on it".to_string(),
        _ => format!(
            "{} at one temperature for the whole run: another temperature needs a new \
             factorisation",
            names.join(", ")
        ),
    };
    let name = "materials over temperature";
    effect_asked_for(name, !asked.is_empty(), !names.is_empty(), why)
}

fn initial_state(model: &Model) -> Effect {
    let loads = model.loads.iter();
    let acting = loads.filter(|load| load.measures == Magnitude::Strain);
    let names: Vec<&str> = acting.map(|load| load.name.as_str()).collect();
    let bodies = model.mesh.bodies.iter();
    let mut bodies = bodies.filter_map(|name| model.scene.bodies.get(name));
    let asked = bodies.any(|body| body.brought_along().next().is_some());
    let why = match (names.is_empty(), asked) {
        (false, _) => format!("{}, before the loads", names.join(", ")),
        (true, true) => "what the bodies bring along is zero".to_string(),
        (true, false) => "no body brings stresses or plastic strains along".to_string(),
    };
    effect_asked_for("initial state", asked, !names.is_empty(), why)
}

fn earlier_run(model: &Model, start: Option<&EndState>) -> Effect {
    let folder = model.scene.start_from.as_ref().map(|dir| dir.display());
    // A later leg of the program starts from the state that the one before has left.
    let start = start.filter(|_| folder.is_some());
    let why = match (folder, start) {
        (None, _) => "the run starts from a virgin state".to_string(),
        (Some(folder), None) => format!("nothing had yielded in the run in {folder}"),
        (Some(folder), Some(start)) => format!(
            "the run in {folder} left plastic strains in {} elements",
            start.elements.len()
        ),
    };
    let asked = model.scene.start_from.is_some();
    effect_asked_for("earlier run", asked, start.is_some(), why)
}

fn prescribed_displacements(model: &Model) -> Effect {
    let loads = model.loads.iter();
    let prescribing = |load: &&LoadCase| load.measures == Magnitude::Displacement;
    let asked: Vec<&LoadCase> = loads.filter(prescribing).collect();
    let of_a_leg = model
        .scene
        .load
        .iter()
        .filter(|load| !load.span().is_whole());
    let of_a_leg: Vec<&str> = of_a_leg.map(|load| load.name.as_str()).collect();
    let acts = |load: &&&LoadCase| load.acts() || of_a_leg.contains(&load.name.as_str());
    let acting = asked.iter().filter(acts);
    let acting: Vec<&str> = acting.map(|load| load.name.as_str()).collect();
    let why = match (asked.is_empty(), acting.is_empty()) {
        (true, _) => "no load prescribes one".to_string(),
        (false, true) => "all prescribed displacements are zero: they act as supports".to_string(),
        (false, false) => format!("by {}: the force that it takes is found", acting.join(", ")),
    };
    let name = "prescribed displacements";
    effect_asked_for(name, !asked.is_empty(), !acting.is_empty(), why)
}

fn cycles(model: &Model) -> Effect {
    let why = match model.program.cycles {
        1 => "the program is gone through once".to_string(),
        n => format!("the targets at most {n} times, until a cycle is like the last"),
    };
    effect("cycles", model.program.cycles > 1, why)
}

/// The effect of targets for which the load is searched.
fn loads_found(model: &Model) -> Effect {
    let mut words = Vec::new();
    for target in &model.program.targets {
        let what = match &target.condition {
            TargetCondition::Figure(goal) => {
                format!("{} = {}", goal.figure.key(), exact(goal.value))
            }
            TargetCondition::HalfWidth(width) => format!("half_width = {}", exact(*width)),
            _ => continue,
        };
        words.push(format!("`{}` ({what})", target.label));
    }
    let why = match words.is_empty() {
        true => "no target is a figure of the state".to_string(),
        false => format!("the load is searched for {}", words.join(", ")),
    };
    effect(LOADS_FOUND, !words.is_empty(), why)
}

fn contact(model: &Model) -> Effect {
    let (n, surfaces) = (model.pairs.len(), model.contacts.len());
    let why = match (n, surfaces, model.freedoms.springs.len()) {
        (0, ..) => "the scene names no contact".to_string(),
        (_, 1, 0) => format!("{n} pairs of nodes may touch"),
        (_, _, 0) => format!("{n} pairs of nodes on {surfaces} pairs of surfaces may touch"),
        (_, _, soft) => format!("{n} pairs of nodes may touch, {soft} of them softly"),
    };
    effect("contact", n > 0, why)
}

fn plasticity(model: &Model, yields: bool) -> Effect {
    let bodies = model.mesh.bodies.iter().zip(&model.may_yield);
    let able: Vec<&str> = (bodies.filter(|(_, may)| **may))
        .map(|(name, _)| name.as_str())
        .collect();
    let names = able.join(", ");
    let why = match (able.is_empty(), yields) {
        (true, _) => "no body may yield (no yield stress, or plastic = false)".to_string(),
        (false, true) => format!("{names} may yield and the loads reach yield"),
        (false, false) => format!("{names} could yield but stays elastic under these loads"),
    };
    effect_asked_for("plasticity", !able.is_empty(), yields, why)
}

fn ties(model: &Model) -> Effect {
    let (tied, scene) = (model.freedoms.n_tied(), &model.scene);
    let relative = scene.load.iter().filter(|load| load.relative.is_some());
    let why = match tied {
        0 => "the scene ties no surfaces and has no equations".to_string(),
        _ => format!(
            "{tied} displacements follow others: surfaces tied {}, equations {}",
            scene.tie.len(),
            scene.equation.len() + relative.count()
        ),
    };
    effect("ties", tied > 0, why)
}

fn interference(model: &Model) -> Effect {
    let stated = model.pairs.iter().any(|p| p.interference != 0.0);
    let changed: Vec<&str> = (model.loads.iter())
        .filter(|load| load.measures == Magnitude::Gap && load.acts())
        .map(|load| load.name.as_str())
        .collect();
    let why = match (stated, model.program.interference_until) {
        (true, Some(_)) => "a contact states an interference, applied with the load".to_string(),
        (true, None) => "a contact states an interference, applied before the load".to_string(),
        (false, _) if changed.is_empty() => "no contact states one".to_string(),
        (false, _) => format!("{} changes gaps", changed.join(", ")),
    };
    effect("interference", stated || !changed.is_empty(), why)
}

fn preload(model: &Model) -> Effect {
    let acts = |load: &LoadCase| {
        let is_own = match load.measures {
            Magnitude::Strain | Magnitude::Carried => false,
            Magnitude::Force
            | Magnitude::Stress
            | Magnitude::Displacement
            | Magnitude::Temperature
            | Magnitude::Gap => true,
        };
        is_own && load.acts() && load.factor(0.0, 1.0) != 0.0
    };
    let (on, why) = match model.loads.iter().any(acts) {
        true => (true, "a load acts at load factor 0"),
        false => (false, "no load acts at load factor 0"),
    };
    effect("preload", on, why.to_string())
}

fn changing_supports(model: &Model) -> Effect {
    let legs = model.program.support_changes.len() + 1;
    let why = match legs {
        1 => "the same displacements are held throughout".to_string(),
        _ => format!("{legs} legs of the program, each with a factorisation of its own"),
    };
    effect("changing supports", legs > 1, why)
}

fn floating_bodies(model: &Model) -> Effect {
    let floating = &model.floating.bodies;
    let why = match floating.is_empty() {
        true => "supports hold every body".to_string(),
        false => format!("{} held by contact alone", floating.join(", ")),
    };
    effect("floating bodies", !floating.is_empty(), why)
}

/// The list of all effects, each on or off with the reason. `yields` tells whether the loads reach
/// (or may reach) yield.
pub(in crate::analysis) fn effects(
    model: &Model,
    yields: bool,
    start: Option<&EndState>,
) -> Vec<Effect> {
    let not_modelled = |name, why: &str| effect(name, false, format!("not modelled: {why}"));
    vec![
        contact(model),
        plasticity(model, yields),
        kinematic_hardening(model, yields),
        yield_by_depth(model, yields),
        volume_forces(model),
        temperature(model),
        over_temperature(model),
        initial_state(model),
        earlier_run(model, start),
        ties(model),
        interference(model),
        prescribed_displacements(model),
        changing_supports(model),
        cycles(model),
        loads_found(model),
        preload(model),
        floating_bodies(model),
        not_modelled("friction", "contact forces are normal"),
        not_modelled("large displacements", "small strains, contact pairs fixed"),
    ]
}
