//! A contact that reaches the end of its candidate pairs although its bodies extend further: no
//! result beyond this load is valid.

use super::step::{Arrival, IncrementReport, Step};
use crate::analysis::structure::loose::{refuse_driven_bodies, settle_springs};
use crate::analysis::structure::solver::Solver;
use crate::error::{Error, ErrorKind, Result};
use crate::model::ProgramTarget;
use crate::scene::Kind;

/// Fraction of the largest contact force below which a pair counts as about to open or just closed.
const VANISHING: f64 = 1e-7;

/// Completes the step for an accepted increment; the increment before it ended at load factor
/// `from`.
///
/// # Errors
/// A load that drives a body away from every contact; [`ErrorKind::Outgrown`] if contact has
/// reached an end of the candidates beyond which the bodies extend.
pub(in crate::analysis) fn accepted(
    solver: &mut Solver,
    from: f64,
    report: IncrementReport,
    arrival: Option<Arrival>,
) -> Result<Step> {
    refuse_driven_bodies(solver)?;
    if arrival.is_some() {
        settle_springs(solver)?;
    }
    match outgrown_at(solver) {
        Some(pair) => Err(outgrown(solver, pair, from)),
        None => Ok(Step {
            increment: Some(report),
            arrival,
        }),
    }
}

/// The first pair that carries force and lies at an end of a contact beyond which the bodies
/// extend.
fn outgrown_at(solver: &Solver) -> Option<usize> {
    let force = &solver.now.force;
    let carries = |k: usize| {
        let contact = &solver.structure.model.contacts[solver.structure.model.pairs[k].contact];
        let largest = force[contact.range.clone()]
            .iter()
            .fold(0.0f64, |m, r| m.max(*r));
        force[k] > VANISHING * largest.max(VANISHING * solver.scales.force)
    };
    let contacts = solver.structure.model.contacts.iter();
    let ends = contacts.flat_map(|c| &c.goes_on);
    ends.copied().find(|&k| carries(k))
}

fn outgrown(solver: &Solver, pair: usize, reached: f64) -> Error {
    let model = solver.structure.model;
    let place: Vec<String> = (model.mesh.point(model.pairs[pair].slave).iter())
        .take(model.mesh.dimension)
        .map(|x| format!("{x:.6}"))
        .collect();
    let place = place.join(", ");
    let names = &model.contacts[model.pairs[pair].contact].names;
    let targets = model.program.targets.iter();
    let largest = targets
        .filter_map(ProgramTarget::load_factor)
        .fold(0.0f64, |m, f| m.max(f.abs()));
    let ratio = largest / reached.abs();
    // The mean pressure never falls as the load rises, so the area of contact grows no faster than
    // the load.
    let wider = match model.kind {
        Kind::Axisymmetric | Kind::Solid => ratio.sqrt(),
        _ => ratio,
    };
    let how_far = if wider > 1.0 && wider.is_finite() {
        format!(" For load factor {largest} they may have to reach up to {wider:.2} times as far.")
    } else {
        String::new()
    };
    let remedy = match model.scene.mesh.key_of_contact_width() {
        Some(key) => format!("give a larger {key}"),
        None => "make the surfaces longer".to_string(),
    };
    Error::new(
        ErrorKind::Outgrown,
        format!(
            "the contact of `{}` on `{}` reaches the end of its candidates at ({place}) from \
             load factor {:.6} on: both bodies go on there, but what lies beyond was not \
             allowed to touch; {remedy}.{how_far}",
            names[0], names[1], reached,
        ),
    )
}
