//! Reading of steps and the conditions of each step.

use super::block::BlockReader;
use super::mesh::{face, target};
use super::volume::{OnVolume, volume_load};
use crate::deck::bodies::unsupported;
use crate::deck::data::{
    Condition, ConditionKind, ContactChange, DeckProgram, DeckStep, EntitySelection,
};
use crate::deck::fields::LineFields;
use crate::deck::source::LinePlace;
use crate::error::Result;
use crate::number::exact;

/// Largest number of increments of a step that is taken over from the deck.
const MOST_INCREMENTS: f64 = 1000.0;

/// Named kinds of supports, with the ranges of degrees of freedom that they hold.
const NAMED_SUPPORTS: [(&str, &[[usize; 2]]); 5] = [
    ("XSYMM", &[[1, 1], [5, 6]]),
    ("YSYMM", &[[2, 2], [4, 4], [6, 6]]),
    ("ZSYMM", &[[3, 3], [4, 5]]),
    ("PINNED", &[[1, 3]]),
    ("ENCASTRE", &[[1, 6]]),
];

/// Reads steps and their conditions.
#[derive(Default)]
pub(super) struct StepReader {
    pub(super) program: DeckProgram,
    /// First place at which large deformation is requested.
    pub(super) nlgeom: Option<LinePlace>,
    is_in_step: bool,
    /// Displacements that are given before the first step, and are reached over the first step.
    of_first_step: Vec<Condition>,
    /// Number of conditions of the first step that were given before it.
    n_before: usize,
}

impl StepReader {
    /// Begins a step of the history.
    pub(super) fn step(&mut self, block: &mut BlockReader) -> Result<()> {
        let keyword = block.keyword;
        let known = "INC INCF NLGEOM NAME AMPLITUDE PERTURBATION THERMALNETWORK EXTRAPOLATION \
                     UNSYMM SHEARINCR SOLVER CONVERTSDI";
        block.allow(known)?;
        if self.is_in_step {
            let message = "the step before has no *END STEP; put it in front of this line";
            return Err(block.error(message));
        }
        if keyword.has("PERTURBATION") {
            block.refuse("PERTURBATION: each step continues from the end of the previous one");
        }
        let nlgeom = keyword.has("NLGEOM") && !keyword.get("NLGEOM").is_some_and(is_no);
        if nlgeom && self.nlgeom.is_none() {
            self.nlgeom = Some(keyword.place);
        }
        if block.choice("AMPLITUDE", &["RAMP", "STEP"])? == "STEP" {
            let how =
                "AMPLITUDE=STEP: what changes is ramped over the step; only its end is the same";
            block.take(how);
        }
        self.is_in_step = true;
        let given_before = std::mem::take(&mut self.of_first_step);
        self.n_before = given_before.len();
        self.program.steps.push(DeckStep {
            place: keyword.place,
            period: 1.0,
            conditions: given_before,
            ..DeckStep::default()
        });
        // A line of text may follow, which describes the step.
        block.skip()
    }

    pub(super) fn statics(&mut self, block: &mut BlockReader) -> Result<()> {
        let keyword = block.keyword;
        block.allow(
            "DIRECT SOLVER EXPLICIT TIMERESET TOTALTIMEATSTART STABILIZE FACTOR ALLSDTOL CONTINUE",
        )?;
        for key in ["FACTOR", "ALLSDTOL", "CONTINUE"] {
            if keyword.has(key) && !keyword.has("STABILIZE") {
                let message = format!("{key} belongs to STABILIZE; take it out, or add STABILIZE");
                return Err(block.error(message));
            }
        }
        for key in ["TIMERESET", "TOTALTIMEATSTART"] {
            if keyword.has(key) {
                return Err(block.error(format!(
                    "{key}: time runs on from step to step; take it out"
                )));
            }
        }
        let Some(step) = self.current() else {
            return Err(block.error("it stands in no *STEP; put it in one"));
        };
        let mut period = 1.0;
        let mut increments = 1.0;
        let mut fixed = None;
        if let Some((_, mut row)) = block.row()? {
            let first = row.number_or("the first increment", 1.0)?;
            if !row.is_at_end() {
                period = row.number_or("the time of the step", 1.0)?;
            }
            if period <= 0.0 {
                let message = format!(
                    "the time of the step is {}; it must be positive",
                    exact(period)
                );
                return Err(row.place.error(message));
            }
            if first > 0.0 {
                // The tolerance allows for an increment that is a rounded fraction of the step's
                // time.
                increments = (period / first - 1e-6).ceil().clamp(1.0, MOST_INCREMENTS);
                // Increments that may not grow are fixed too.
                let largest = match row.is_at_end() {
                    true => 0.0,
                    false => {
                        row.number_or("the least increment", 0.0)?;
                        row.number_or("the largest increment", 0.0)?
                    }
                };
                let is_fixed = keyword.has("DIRECT") || largest == first;
                fixed = is_fixed.then_some(first);
            }
        }
        step.period = period;
        step.increments = increments as usize;
        step.fixed = fixed;
        block.skip()
    }

    pub(super) fn end_step(&mut self, block: &mut BlockReader) -> Result<()> {
        block.allow("")?;
        if !self.is_in_step {
            return Err(block.error("there is no *STEP that it ends; take it out"));
        }
        self.is_in_step = false;
        block.no_more()
    }

    /// The index of the current step; `None` outside of steps.
    pub(super) fn number(&self) -> Option<usize> {
        let last = self.program.steps.len().checked_sub(1);
        last.filter(|_| self.is_in_step)
    }

    /// The current step; `None` outside of steps.
    pub(super) fn current(&mut self) -> Option<&mut DeckStep> {
        let last = self.program.steps.last_mut();
        last.filter(|_| self.is_in_step)
    }

    /// Reads the parameters of a keyword of conditions, and returns what its lines have in common.
    fn conditions(&mut self, block: &mut BlockReader, kind: ConditionKind) -> Result<Condition> {
        let keyword = block.keyword;
        // Where displacements are small, loads neither turn with the bodies nor grow with them.
        let known = match kind {
            ConditionKind::Force | ConditionKind::Pressure => {
                "OP AMPLITUDE FIXED TYPE FOLLOWER CONSTANTRESULTANT"
            }
            _ => "OP AMPLITUDE FIXED TYPE",
        };
        block.allow(known)?;
        let is_new = block.choice("OP", &["MOD", "NEW"])? == "NEW";
        block.choice("TYPE", &["DISPLACEMENT"])?;
        let amplitude = keyword.get("AMPLITUDE").map(str::to_string);
        let is_fixed = kind == ConditionKind::Boundary && keyword.has("FIXED");
        match self.program.steps.last_mut().filter(|_| self.is_in_step) {
            Some(step) => {
                let is_first = !std::mem::replace(&mut step.is_begun[kind as usize], true);
                if is_new && is_first {
                    step.renewed[kind as usize] = Some(keyword.place);
                    if kind == ConditionKind::Boundary {
                        step.conditions.drain(..std::mem::take(&mut self.n_before));
                    }
                    if kind == ConditionKind::Pressure {
                        step.renewed[ConditionKind::Volume as usize] = Some(keyword.place);
                    }
                } else if is_new && step.renewed[kind as usize].is_none() {
                    let how = "OP=NEW has no effect after another keyword of this kind in the \
                               step, as in CalculiX: give it on the first";
                    block.take(how);
                }
            }
            None if kind != ConditionKind::Boundary => {
                return Err(block.error("it stands in no *STEP; put it in one"));
            }
            _ => {}
        }
        Ok(Condition {
            amplitude,
            is_fixed,
            ..Condition::of_keyword(kind, keyword.place)
        })
    }

    fn add(&mut self, condition: Condition) {
        match self.current() {
            Some(step) => step.conditions.push(condition),
            None => {
                // A displacement given before the first step is reached over that step, unless a
                // later line holds the node.
                let is_support =
                    condition.kind == ConditionKind::Boundary && condition.value == 0.0;
                if condition.kind == ConditionKind::Boundary
                    && (!is_support || !self.of_first_step.is_empty())
                {
                    self.of_first_step.push(condition.clone());
                }
                if is_support || condition.kind != ConditionKind::Boundary {
                    self.program.initial.push(condition);
                }
            }
        }
    }

    pub(super) fn boundary(&mut self, block: &mut BlockReader) -> Result<()> {
        let common = self.conditions(block, ConditionKind::Boundary)?;
        while let Some((place, mut row)) = block.row()? {
            let on = target(&mut row)?;
            let (ranges, value) = freedoms(&mut row)?;
            row.end()?;
            for range in ranges {
                self.add(common.line(on.clone(), range, value, place));
            }
        }
        Ok(())
    }

    pub(super) fn cload(&mut self, block: &mut BlockReader) -> Result<()> {
        let common = self.conditions(block, ConditionKind::Force)?;
        while let Some((place, mut row)) = block.row()? {
            let on = target(&mut row)?;
            let freedom = row.label("the degree of freedom")? as usize;
            let value = row.number("the force")?;
            row.end()?;
            if !(1..=6).contains(&freedom) {
                return Err(row.place.error(format!(
                    "degree of freedom {freedom}: forces act along 1, 2 and 3, moments about 4, 5 \
                     and 6 of a reference node; heat flows do not"
                )));
            }
            self.add(common.line(on, [freedom; 2], value, place));
        }
        Ok(())
    }

    pub(super) fn dload(&mut self, block: &mut BlockReader) -> Result<()> {
        let common = self.conditions(block, ConditionKind::Pressure)?;
        while let Some((place, mut row)) = block.row()? {
            let mut ahead = row;
            // An empty first value in front of a load on volumes stands for all elements.
            let on = match ahead.word().is_empty() && !ahead.is_at_end() {
                true => {
                    row = ahead;
                    EntitySelection::All
                }
                false => target(&mut row)?,
            };
            match volume_load(row)? {
                OnVolume::Face if on == EntitySelection::All => {
                    let message = "a pressure acts on faces of some elements: give their set or \
                                   number in front of it";
                    return Err(row.place.error(message));
                }
                OnVolume::Face => {}
                OnVolume::Refused(why) => {
                    block.refuse_at(place, &why);
                    continue;
                }
                OnVolume::Load(load, value) => {
                    let loads = &mut self.program.volume_loads;
                    let known = loads.iter().position(|known| *known == load);
                    let index = known.unwrap_or(loads.len());
                    if known.is_none() {
                        loads.push(load);
                    }
                    if index > usize::from(u8::MAX) {
                        let message = "there are more than 256 directions and axes of such loads";
                        return Err(row.place.error(message));
                    }
                    self.add(Condition {
                        kind: ConditionKind::Volume,
                        ..common.line(on, [index; 2], value, place)
                    });
                    continue;
                }
            }
            let face = face(&mut row, b'P')?;
            let value = row.number("the pressure")?;
            row.end()?;
            self.add(common.line(on, [face; 2], value, place));
        }
        Ok(())
    }

    pub(super) fn dsload(&mut self, block: &mut BlockReader) -> Result<()> {
        let common = self.conditions(block, ConditionKind::Pressure)?;
        while let Some((place, mut row)) = block.row()? {
            let on = EntitySelection::Set(row.text("the surface")?);
            let what = row.text("the kind of load")?;
            if !what.eq_ignore_ascii_case("P") {
                let why = format!("{what}: of loads on surfaces only pressures, P, are there");
                block.refuse_at(place, &why);
                continue;
            }
            let value = row.number("the pressure")?;
            row.end()?;
            self.add(common.line(on, [0; 2], value, place));
        }
        Ok(())
    }

    pub(super) fn model_change(&mut self, block: &mut BlockReader) -> Result<()> {
        let keyword = block.keyword;
        block.allow("TYPE ADD REMOVE")?;
        if block.choice("TYPE", &["ELEMENT", "CONTACT PAIR"])? == "ELEMENT" {
            let why = "elements are the same in all steps; of *MODEL CHANGE there is \
                       TYPE=CONTACT PAIR";
            block.refuse(why);
            return block.skip();
        }
        let is_on = keyword.has("ADD");
        if is_on == keyword.has("REMOVE") {
            return Err(block.error("give either ADD or REMOVE"));
        }
        let Some(step) = self.current() else {
            return Err(block.error("it stands in no *STEP; put it in one"));
        };
        let pairs = block.pairs()?.into_iter();
        let changes = pairs.map(|(place, [slave, master])| ContactChange {
            slave,
            master,
            is_on,
            place,
        });
        step.contact_changes.extend(changes);
        Ok(())
    }

    pub(super) fn temperature(&mut self, block: &mut BlockReader) -> Result<()> {
        let common = self.conditions(block, ConditionKind::Temperature)?;
        self.temperatures(block, common)
    }

    /// Reads lines of nodes and their temperatures.
    fn temperatures(&mut self, block: &mut BlockReader, common: Condition) -> Result<()> {
        while let Some((place, mut row)) = block.row()? {
            let on = target(&mut row)?;
            let value = row.number("the temperature")?;
            row.end()?;
            self.add(common.line(on, [1; 2], value, place));
        }
        Ok(())
    }

    pub(super) fn initial_conditions(&mut self, block: &mut BlockReader) -> Result<()> {
        match block.keyword.get("TYPE").map(str::to_uppercase).as_deref() {
            Some("TEMPERATURE") => {
                block.allow("TYPE")?;
                let common = Condition::of_keyword(ConditionKind::Temperature, block.keyword.place);
                return self.temperatures(block, common);
            }
            _ => block.refuse("bodies begin without stress and strain"),
        }
        block.skip()
    }
}

fn is_no(value: &str) -> bool {
    value.trim().eq_ignore_ascii_case("no")
}

/// Reads ranges of degrees of freedom, and the prescribed value.
fn freedoms(row: &mut LineFields) -> Result<(Vec<[usize; 2]>, f64)> {
    let mut ahead = *row;
    let word = ahead.word();
    if word.first().is_some_and(u8::is_ascii_alphabetic) {
        let name = row.text("the support")?.to_uppercase();
        let named = NAMED_SUPPORTS.iter().find(|(known, _)| *known == name);
        let Some((_, ranges)) = named else {
            let known: Vec<&str> = NAMED_SUPPORTS.iter().map(|(known, _)| *known).collect();
            let known = known.join(", ");
            return Err(row.place.error(format!(
                "{name} is neither a degree of freedom nor one of {known}"
            )));
        };
        return Ok((ranges.to_vec(), 0.0));
    }
    let first = row.label("the first degree of freedom")? as usize;
    let mut last = first;
    if !row.is_at_end() {
        let mut ahead = *row;
        if ahead.word().is_empty() {
            row.word();
        } else {
            last = row.label("the last degree of freedom")? as usize;
        }
    }
    let value = match row.is_at_end() {
        true => 0.0,
        false => row.number_or("the value", 0.0)?,
    };
    if first == 11 {
        let message = "degree of freedom 11 is the temperature, and there is no heat flow here: \
                       compute the temperatures elsewhere, and give them by *TEMPERATURE";
        return Err(unsupported(row.place.error(message)));
    }
    if first == 0 || last < first || last > 6 {
        return Err(row.place.error(format!(
            "degrees of freedom {first} to {last}: displacements are 1, 2 and 3, the last must not \
             be less than the first"
        )));
    }
    Ok((vec![[first, last]], value))
}
