//! The state that a run starts from: the state that an earlier run left in the material.

use super::solver::Solver;
use super::state::State;
use crate::analysis::zone::history::PointHistory;
use crate::checkpoint::read_end_state;
use crate::error::{Error, Result};
use crate::material::Material;
use crate::model::{Model, ProgramTarget, TargetCondition};
use crate::results::{EndState, LeftBy, LeftByBody};
use crate::scene::{Kind, Unit};

/// Reads the state that the scene of a model starts from; `None` if it is a virgin state.
///
/// # Errors
/// Errors of [`read_end_state`]; `Input` if first yield is asked for, a body with plastic strains
/// may not yield, its material has other fading back stresses, the model is of another kind, or a
/// body does not bring along the stresses and strains that it brought along in the earlier run.
pub(in crate::analysis) fn read(model: &Model) -> Result<Option<EndState>> {
    let scene = &model.scene;
    let Some(folder) = scene.start_folder() else {
        return Ok(None);
    };
    let found = read_end_state(&folder, &model.mesh).and_then(|state| checked(model, state));
    let placed = found.map_err(|error| {
        let error = error.within("start_from");
        scene.places.in_front("start_from", error)
    });
    placed.map(|state| Some(state).filter(|state| !state.is_virgin()))
}

fn checked(model: &Model, state: EndState) -> Result<EndState> {
    let program = &model.program;
    let is_yield = |target: &&ProgramTarget| target.condition == TargetCondition::FirstYield;
    let target = program.targets.iter().find(is_yield);
    let asked = match target {
        Some(target) => Some(format!(
            "take the target `{}` out of program.targets",
            target.label
        )),
        None if program.unit == Unit::Yield => {
            Some("count loads with program.unit = \"load\"".to_string())
        }
        None => None,
    };
    if let Some(remedy) = asked.filter(|_| !state.is_virgin()) {
        return Err(Error::input(format!(
            "the material has yielded in the run that this one starts from, so that there is no \
             yield load: {remedy}"
        )));
    }
    let body_of = |&e: &usize| model.mesh.element_body[e] as usize;
    let mut bodies = state.elements.iter().map(body_of);
    if let Some(body) = bodies.find(|&body| !model.may_yield[body]) {
        let name = &model.mesh.bodies[body];
        return Err(Error::input(format!(
            "the earlier run left plastic strains in body `{name}`, which may not yield here: give \
             bodies.{name} a material with a yield stress, and do not set plastic = false"
        )));
    }
    check_origin(model, &state)?;
    let fading = model.materials.iter().map(|m| m.back_stresses.n_stored());
    let here = fading.max().unwrap_or(0);
    let there = state.back_strains.len() / state.strains.len().max(1);
    if there != here && !state.is_virgin() {
        return Err(Error::input(format!(
            "the materials of the earlier run had {there} back stresses that fade, those here have \
             {here}: give the same `back_stresses`"
        )));
    }
    Ok(state)
}

/// Describes the parts of the model on which the meaning of the state that it leaves depends.
fn left_by(model: &Model) -> LeftBy {
    let names = model.mesh.bodies.iter();
    let body = |(name, material): (&String, &Material)| {
        let scene = model.scene.bodies.get(name).into_iter();
        let brought = scene.flat_map(|body| body.brought_along());
        LeftByBody {
            rates: material.back_stresses.rates().collect(),
            brought_along: brought
                .map(|(key, rows)| (key.into(), rows.clone()))
                .collect(),
        }
    };
    LeftBy {
        kind: model.kind,
        bodies: names.zip(&model.materials).map(body).collect(),
    }
}

/// Checks that the model agrees with the model that left the state: in its kind, in the rates of
/// its back stresses, and in the stresses and strains that its bodies bring along.
fn check_origin(model: &Model, state: &EndState) -> Result<()> {
    let here = left_by(model);
    let Some(there) = state.left_by.as_ref().filter(|_| !state.is_virgin()) else {
        return Ok(());
    };
    if there.kind != here.kind {
        let [there, here] = [there.kind, here.kind].map(Kind::name);
        return Err(Error::input(format!(
            "the earlier run was of the kind `{there}`, this one is `{here}`: plastic strains of \
             one kind cannot be used in the other"
        )));
    }
    let names = model.mesh.bodies.iter();
    for ((there, here), name) in there.bodies.iter().zip(&here.bodies).zip(names) {
        let [then, now] = [&there.rates, &here.rates];
        if then.len() == now.len() && then != now {
            return Err(Error::input(format!(
                "the back stresses of body `{name}` faded at the rates {then:?} in the earlier \
                 run, here at {now:?}, so that the stored back strains do not apply: give the same \
                 rates"
            )));
        }
        let mut given = there.brought_along.iter();
        let missing = given.find(|given| !here.brought_along.contains(given));
        if let Some((key, _)) = missing {
            return Err(Error::input(format!(
                "body `{name}` had another `{key}` in the earlier run, which is still in it: give \
                 bodies.{name}.{key} as it was there"
            )));
        }
    }
    Ok(())
}

/// Goes to the unloaded point of the load path, in the state that the run starts from.
///
/// # Errors
/// A body that residual stresses alone push away from every contact.
pub(in crate::analysis) fn begin(solver: &mut Solver) -> Result<()> {
    solver.unload();
    match take_over(solver) {
        true => {
            let nothing = solver.at.clone();
            solver.solve_contact_at(&nothing)
        }
        false => Ok(()),
    }
}

/// Goes to the state in which another structure, with the same pairs and the same plastic history,
/// was at the same load factor.
pub(in crate::analysis) fn begin_at(solver: &mut Solver, before: &State) {
    solver.unload();
    take_over(solver);
    solver.at = solver.structure.point(before.at.alpha);
    solver.zone.set_factors(&solver.at.factors);
    solver.now.gap.copy_from_slice(&before.equilibrium.gap);
    solver.now.force.copy_from_slice(&before.equilibrium.force);
    solver.fresh = false;
    solver.set_springs(&before.springs);
    solver.restore_statuses(&before.open, &before.border);
}

/// Takes over the plastic history that the run starts from. Returns whether there is any.
fn take_over(solver: &mut Solver) -> bool {
    let structure = &solver.structure;
    let Some(start) = &structure.model.start else {
        return false;
    };
    let history = PointHistory::from(start);
    solver.zone.restore_of(&start.elements, &history);
    let initial = solver.zone.initial_load(structure.sub.zeros());
    solver.now.initial = structure.eliminate_initial(initial, &mut solver.cost);
    true
}

/// The state left in the material; `None` if no body may yield.
pub(in crate::analysis) fn end_state(solver: &Solver) -> Option<EndState> {
    let structure = &solver.structure;
    let able = structure.model.may_yield.contains(&true);
    able.then(|| EndState {
        left_by: Some(left_by(structure.model)),
        ..solver.zone.history().end_state(&structure.elements)
    })
}
