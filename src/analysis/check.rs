//! Which effects a scene calls for, and what the run will cost: before anything is solved.

use super::zone_choice;
use crate::assembly::assemble;
use crate::error::Result;
use crate::linalg::{self, Backend, Partition, Prediction};
use crate::model::Model;
use crate::results::{Effect, Sizes};
use crate::scene::Stepping;
use crate::substructure::ContactCost;
use serde::Serialize;

/// What a run of the scene will do and cost.
#[derive(Debug, Clone, Serialize)]
pub struct Check {
    /// Effects that the scene calls for.
    pub effects: Vec<Effect>,
    /// Sizes of the model.
    pub sizes: Sizes,
    /// Cost of the factorisation, from the symbolic analysis.
    pub prediction: Prediction,
    /// Cost of the dense part of contact, from the pairs that bodies join.
    pub contact: ContactCost,
    /// Rough time of one factorisation, at the speed that is typical of one core.
    pub predicted_seconds: f64,
    /// Rough time of the whole run without the estimate of its errors: the factorisation, and the trailing solves of its increments.
    pub predicted_run_seconds: f64,
    /// The BLAS in use.
    pub blas: String,
    /// Things the user should know.
    pub notes: Vec<String>,
}

/// Floating point operations per second of a supernodal factorisation that the rough time assumes.
const TYPICAL_FLOPS: f64 = 5e9;
/// Nonzeros of the factor that ordering and analysis handle per second.
const TYPICAL_ANALYSIS: f64 = 2e7;

/// Entries of the factor's trailing columns that a trailing solve handles per second: it reads each twice.
const TYPICAL_SOLVE: f64 = 5e8;
/// Trailing solves of an increment, measured over the scenes of `data/scenes`: 5 to 9 where the material hardens, and some 30 where
/// much of it has next to no stiffness left.
const SOLVES: [f64; 2] = [7.0, 30.0];
/// Plastic modulus over Youngs modulus below which material counts as soft in that sense.
const SOFT: f64 = 0.1;
/// Seconds from which on a run is worth a warning before it begins.
const LONG: f64 = 60.0;

/// Rough number of trailing solves of a run: each pair closes and opens once, each in an increment of its own, or with fixed steps so many to
/// a target.
fn solves(model: &Model, plastic: bool) -> f64 {
    let program = &model.scene.program;
    let increments = match program.stepping {
        Stepping::Events => 2.0 * model.pairs.len() as f64,
        Stepping::Steps => (program.steps * program.targets.len()) as f64,
    };
    let soft = model
        .materials
        .iter()
        .zip(&model.may_yield)
        .any(|(material, may)| {
            let slope = material.hardening.as_ref().map(|h| h.slope(0.0));
            *may && slope.is_some_and(|slope| slope < SOFT * material.youngs_modulus)
        });
    let each = match (plastic, soft) {
        (false, _) => 1.0,
        (true, false) => SOLVES[0],
        (true, true) => SOLVES[1],
    };
    each * (increments + program.targets.len() as f64)
}

/// Predicts effects and cost of a model; solves nothing.
///
/// # Errors
/// Limits of the backend.
pub fn check(model: &Model, backend: Backend) -> Result<Check> {
    let system = assemble(model)?;
    let choice = zone_choice::first_guess(model);
    let zone = zone_choice::zone_freedoms(model, &choice.elements);
    let contact = model
        .pairs
        .iter()
        .map(|p| p.first)
        .chain(model.pairs.iter().map(|p| p.second))
        .filter_map(|node| model.freedoms.normal_freedom(node))
        .collect();
    let partition = Partition {
        n: model.freedoms.n,
        zone,
        contact,
    };
    let mut prediction = linalg::predict(backend, &system.stiffness, &partition)?;
    let contact = ContactCost::of(model);
    prediction.memory_bytes += contact.memory_bytes;
    let sizes = Sizes {
        freedoms: model.freedoms.n,
        nodes: model.mesh.n_nodes(),
        elements: model.mesh.n_elements(),
        contact_pairs: model.pairs.len(),
        zone_freedoms: partition.zone.len(),
        zone_elements: choice.elements.len(),
    };
    let plastic = !choice.elements.is_empty();
    let mut notes = model.warnings.clone();
    if model.scene.accuracy.is_some() {
        notes.push("the scene demands an accuracy: a run chooses its meshes itself, the figures here are of the scene's own".to_string());
    }
    let of_contact = contact.flops / TYPICAL_FLOPS;
    let factorisation = prediction.flops / TYPICAL_FLOPS
        + prediction.factor_nonzeros / TYPICAL_ANALYSIS
        + of_contact;
    let run = factorisation + solves(model, plastic) * prediction.trailing_nonzeros / TYPICAL_SOLVE;
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
            "the run may take about {:.0} min, and the estimate of its errors once or twice that: fewer elements (resolution) or a \
             smaller largest load make it shorter, `--no-estimate` leaves the estimate out",
            (run / 60.0).ceil()
        ));
    }
    Ok(Check {
        effects: effects(model, plastic),
        sizes,
        prediction,
        contact,
        predicted_seconds: factorisation,
        predicted_run_seconds: run,
        blas: linalg::blas_name(),
        notes,
    })
}

/// The ledger: each effect on or off, and why. `yields` says whether the loads reach (or may reach) yield.
pub(super) fn effects(model: &Model, yields: bool) -> Vec<Effect> {
    let effect = |name: &str, on: bool, why: String| Effect {
        name: name.into(),
        on,
        why,
        seconds: 0.0,
        memory_bytes: 0,
    };
    let bodies = &model.mesh.bodies;
    let able: Vec<&str> = bodies
        .iter()
        .zip(&model.may_yield)
        .filter(|(_, may)| **may)
        .map(|(name, _)| name.as_str())
        .collect();
    let contact = match model.pairs.len() {
        0 => effect("contact", false, "the scene names no contact".into()),
        n => effect(
            "contact",
            true,
            match model.contacts.len() {
                1 => format!("{n} pairs of nodes may touch"),
                surfaces => format!("{n} pairs of nodes on {surfaces} pairs of surfaces may touch"),
            },
        ),
    };
    let plasticity = if able.is_empty() {
        effect(
            "plasticity",
            false,
            "no body may yield (no yield stress, or plastic = false)".into(),
        )
    } else if yields {
        effect(
            "plasticity",
            true,
            format!("{} may yield and the loads reach yield", able.join(", ")),
        )
    } else {
        effect(
            "plasticity",
            false,
            format!(
                "{} could yield but stays elastic under these loads",
                able.join(", ")
            ),
        )
    };
    let interference = model.pairs.iter().any(|p| p.interference != 0.0);
    let floating = &model.floating.bodies;
    let preload = model.loads.iter().any(|l| l.factor(0.0, 1.0) != 0.0);
    let on_off = |on: bool, yes: String, no: &str| if on { yes } else { no.to_string() };
    vec![
        contact,
        plasticity,
        effect(
            "interference",
            interference,
            on_off(
                interference,
                "a contact states an interference, applied before the load".into(),
                "no contact states one",
            ),
        ),
        effect(
            "preload",
            preload,
            on_off(
                preload,
                "a load acts at load factor 0".into(),
                "no load acts at load factor 0",
            ),
        ),
        effect(
            "floating bodies",
            !floating.is_empty(),
            on_off(
                !floating.is_empty(),
                format!("{} held by contact alone", floating.join(", ")),
                "supports hold every body",
            ),
        ),
        effect(
            "friction",
            false,
            "not modelled: contact forces are normal".into(),
        ),
        effect(
            "large displacements",
            false,
            "not modelled: small strains, contact pairs fixed".into(),
        ),
    ]
}
