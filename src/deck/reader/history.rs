//! Reading of steps and the conditions of each step.

use super::mesh::{face, target};
use super::volume::{OnVolume, volume_load};
use super::{Reader, fields};
use crate::deck::bodies::unsupported;
use crate::deck::data::{Condition, ConditionKind, ContactChange, DeckStep, EntitySelection};
use crate::deck::fields::LineFields;
use crate::deck::keyword::Keyword;
use crate::deck::source::Line;
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

impl Reader<'_> {
    pub(super) fn step(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        let known = [
            "INC",
            "INCF",
            "NLGEOM",
            "NAME",
            "AMPLITUDE",
            "PERTURBATION",
            "THERMALNETWORK",
            "EXTRAPOLATION",
            "UNSYMM",
            "SHEARINCR",
            "SOLVER",
            "CONVERTSDI",
        ];
        keyword.allow(files, &known)?;
        if self.is_in_step {
            let message = "the step before has no *END STEP; put it in front of this line";
            return Err(keyword.error(files, message));
        }
        if keyword.has("PERTURBATION") {
            self.refuse(
                keyword,
                keyword.place,
                "PERTURBATION: steps go on where the one before ended",
            );
        }
        let nlgeom = keyword.has("NLGEOM") && !keyword.get("NLGEOM").is_some_and(is_no);
        if nlgeom && self.deck.nlgeom.is_none() {
            self.deck.nlgeom = Some(keyword.place);
        }
        if keyword.choice(&self.source.files, "AMPLITUDE", &["RAMP", "STEP"])? == "STEP" {
            let how =
                "AMPLITUDE=STEP: what changes is ramped over the step; only its end is the same";
            self.take(keyword, keyword.place, how);
        }
        (self.is_in_step, self.is_history) = (true, false);
        let given_before = std::mem::take(&mut self.of_first_step);
        self.n_before = given_before.len();
        self.deck.program.steps.push(DeckStep {
            place: keyword.place,
            period: 1.0,
            conditions: given_before,
            ..DeckStep::default()
        });
        // A line of text may follow, which describes the step.
        self.skip()
    }

    pub(super) fn statics(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(
            files,
            &[
                "DIRECT",
                "SOLVER",
                "EXPLICIT",
                "TIMERESET",
                "TOTALTIMEATSTART",
                "STABILIZE",
                "FACTOR",
                "ALLSDTOL",
                "CONTINUE",
            ],
        )?;
        for key in ["FACTOR", "ALLSDTOL", "CONTINUE"] {
            if keyword.has(key) && !keyword.has("STABILIZE") {
                let message = format!("{key} belongs to STABILIZE; take it out, or add STABILIZE");
                return Err(keyword.error(files, message));
            }
        }
        for key in ["TIMERESET", "TOTALTIMEATSTART"] {
            if keyword.has(key) {
                return Err(keyword.error(
                    files,
                    format!("{key}: time runs on from step to step; take it out"),
                ));
            }
        }
        let Some(step) = self.current_step() else {
            return Err(keyword.error(&self.source.files, "it stands in no *STEP; put it in one"));
        };
        let mut period = 1.0;
        let mut increments = 1.0;
        let mut fixed = None;
        if let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
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
                // The tolerance allows for a rounded share of the time.
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
        self.deck.program.steps[step].period = period;
        self.deck.program.steps[step].increments = increments as usize;
        self.deck.program.steps[step].fixed = fixed;
        self.skip()
    }

    pub(super) fn end_step(&mut self, keyword: &Keyword) -> Result<()> {
        keyword.allow(&self.source.files, &[])?;
        if !self.is_in_step {
            return Err(keyword.error(
                &self.source.files,
                "there is no *STEP that it ends; take it out",
            ));
        }
        self.is_in_step = false;
        self.no_more(keyword)
    }

    /// The index of the current step; `None` outside of steps.
    pub(super) fn current_step(&self) -> Option<usize> {
        self.deck
            .program
            .steps
            .len()
            .checked_sub(1)
            .filter(|_| self.is_in_step)
    }

    /// Reads the parameters that are common to all conditions, and returns the name of the
    /// amplitude.
    pub(super) fn conditions(
        &mut self,
        keyword: &Keyword,
        kind: ConditionKind,
    ) -> Result<Option<String>> {
        let files = &self.source.files;
        let known = [
            "OP",
            "AMPLITUDE",
            "FIXED",
            "TYPE",
            "FOLLOWER",
            "CONSTANTRESULTANT",
        ];
        // Where displacements are small, loads neither turn with the bodies nor grow with them.
        let n_known = match kind {
            ConditionKind::Force | ConditionKind::Pressure => known.len(),
            _ => known.len() - 2,
        };
        keyword.allow(files, &known[..n_known])?;
        let is_new = keyword.choice(files, "OP", &["MOD", "NEW"])? == "NEW";
        keyword.choice(files, "TYPE", &["DISPLACEMENT"])?;
        let amplitude = keyword.get("AMPLITUDE").map(str::to_string);
        match self.current_step() {
            Some(step) => {
                let step = &mut self.deck.program.steps[step];
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
                    let how = "OP=NEW has no effect behind others of its kind in the step, as in \
                               CalculiX: give it to the first";
                    self.take(keyword, keyword.place, how);
                }
            }
            None if kind != ConditionKind::Boundary => {
                return Err(keyword.error(files, "it stands in no *STEP; put it in one"));
            }
            _ => {}
        }
        Ok(amplitude)
    }

    pub(super) fn add(&mut self, condition: Condition) {
        match self.current_step() {
            Some(step) => self.deck.program.steps[step].conditions.push(condition),
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
                    self.deck.program.initial.push(condition);
                }
            }
        }
    }

    pub(super) fn boundary(&mut self, keyword: &Keyword) -> Result<()> {
        let amplitude = self.conditions(keyword, ConditionKind::Boundary)?;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let on = target(&mut row)?;
            let (ranges, value) = freedoms(&mut row)?;
            row.end()?;
            for range in ranges {
                self.add(Condition {
                    kind: ConditionKind::Boundary,
                    on: on.clone(),
                    range,
                    value,
                    amplitude: amplitude.clone(),
                    is_fixed: keyword.has("FIXED"),
                    place: line.place,
                });
            }
        }
        Ok(())
    }

    pub(super) fn cload(&mut self, keyword: &Keyword) -> Result<()> {
        let amplitude = self.conditions(keyword, ConditionKind::Force)?;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
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
            self.add(Condition {
                kind: ConditionKind::Force,
                on,
                range: [freedom; 2],
                value,
                amplitude: amplitude.clone(),
                is_fixed: false,
                place: line.place,
            });
        }
        Ok(())
    }

    pub(super) fn dload(&mut self, keyword: &Keyword) -> Result<()> {
        let amplitude = self.conditions(keyword, ConditionKind::Pressure)?;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let mut ahead = row;
            // Nothing in front of a load on volumes stands for all elements.
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
                    self.refuse(keyword, line.place, &why);
                    continue;
                }
                OnVolume::Load(load, value) => {
                    let loads = &mut self.deck.program.volume_loads;
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
                        on,
                        range: [index; 2],
                        value,
                        amplitude: amplitude.clone(),
                        is_fixed: false,
                        place: line.place,
                    });
                    continue;
                }
            }
            let face = face(&mut row, b'P')?;
            let value = row.number("the pressure")?;
            row.end()?;
            self.add_pressure(on, face, value, &amplitude, line);
        }
        Ok(())
    }

    pub(super) fn dsload(&mut self, keyword: &Keyword) -> Result<()> {
        let amplitude = self.conditions(keyword, ConditionKind::Pressure)?;
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let on = EntitySelection::Set(row.text("the surface")?);
            let what = row.text("the kind of load")?;
            if !what.eq_ignore_ascii_case("P") {
                let why = format!("{what}: of loads on surfaces only pressures, P, are there");
                self.refuse(keyword, line.place, &why);
                continue;
            }
            let value = row.number("the pressure")?;
            row.end()?;
            self.add_pressure(on, 0, value, &amplitude, line);
        }
        Ok(())
    }

    pub(super) fn model_change(&mut self, keyword: &Keyword) -> Result<()> {
        let files = &self.source.files;
        keyword.allow(files, &["TYPE", "ADD", "REMOVE"])?;
        if keyword.choice(files, "TYPE", &["ELEMENT", "CONTACT PAIR"])? == "ELEMENT" {
            let why = "elements are the same in all steps; of *MODEL CHANGE there is \
                       TYPE=CONTACT PAIR";
            self.refuse(keyword, keyword.place, why);
            return self.skip();
        }
        let is_on = keyword.has("ADD");
        if is_on == keyword.has("REMOVE") {
            return Err(keyword.error(files, "give either ADD or REMOVE"));
        }
        let Some(step) = self.current_step() else {
            return Err(keyword.error(files, "it stands in no *STEP; put it in one"));
        };
        let mut changes = Vec::new();
        while let Some(line) = self.source.next_data()? {
            let mut row = fields(&self.source, keyword, line);
            let slave = row.text("the slave surface")?;
            let master = row.text("the master surface")?;
            row.end()?;
            changes.push(ContactChange {
                slave,
                master,
                is_on,
                place: line.place,
            });
        }
        if changes.is_empty() {
            let message = "a line with the slave and the master surface should follow; give it";
            return Err(keyword.error(&self.source.files, message));
        }
        self.deck.program.steps[step]
            .contact_changes
            .extend(changes);
        Ok(())
    }

    fn add_pressure(
        &mut self,
        on: EntitySelection,
        face: usize,
        value: f64,
        amplitude: &Option<String>,
        line: Line,
    ) {
        self.add(Condition {
            kind: ConditionKind::Pressure,
            on,
            range: [face; 2],
            value,
            amplitude: amplitude.clone(),
            is_fixed: false,
            place: line.place,
        });
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
