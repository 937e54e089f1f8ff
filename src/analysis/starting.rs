//! The state that a run starts from: what an earlier one left in the material.

use super::solver::Solver;
use super::zone::History;
use crate::checkpoint::read_end_state;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::results::EndState;
use crate::scene::Unit;

/// Reads the state that the scene of a model starts from; `None` where that is a virgin one.
///
/// # Errors
/// Those of [`read_end_state`]; `Input` where first yield is asked for, a body with plastic strains
/// may not yield, or its material has another number of back stresses that fade.
pub(super) fn read(model: &Model) -> Result<Option<EndState>> {
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
    let program = &model.scene.program;
    let target = program.targets.iter().find(|target| target.first_yield);
    let asked = match target {
        Some(target) => Some(format!(
            "take the target `{}` out of program.targets",
            target.name.as_deref().unwrap_or("yield")
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

impl Solver<'_> {
    /// To where nothing acts, in the state that the run starts from.
    ///
    /// # Errors
    /// A body that residual stresses alone push away from every contact.
    pub(super) fn begin(&mut self) -> Result<()> {
        self.unload();
        let structure = &self.structure;
        let Some(start) = &structure.model.start else {
            return Ok(());
        };
        let history = History::from(start);
        self.zone.restore_of(&start.elements, &history);
        let initial = self.zone.initial_load(structure.sub.zeros());
        self.now.initial = structure.eliminate(initial, &mut self.cost);
        structure.sub.balance(&mut self.now.initial.forces);
        let nothing = self.at.clone();
        self.solve_contact_at(&nothing)
    }

    /// What is left in the material; `None` where no body may yield.
    pub(super) fn end_state(&self) -> Option<EndState> {
        let structure = &self.structure;
        let able = structure.model.may_yield.contains(&true);
        able.then(|| self.zone.history().end_state(&structure.elements))
    }
}
