//! The printed summaries.

use super::table::{ColumnAlignment::*, Table, page_width, wrap};
use crate::accuracy::for_a_tenth;
use crate::analysis::Check;
use crate::linalg::Prediction;
use crate::number::{bytes, number, percent, seconds, significant};
use crate::output::columns::{cell, of_states};
use crate::output::{Labels, RunHeader};
use crate::results::{
    Cycles, Effect, QUANTITIES, Quality, Ranks, ReferenceRow, Results, Sizes, State, YieldPoint,
};
use crate::scene::{Kind, Scene, Unit};
use crate::space::Space;
use crate::text::shown_in_line;
use std::path::Path;

/// Returns the summary of a run or of a yield load. `wall_seconds` is the time of the whole
/// command.
pub(super) fn results(
    scene: &Scene,
    header: &RunHeader,
    results: &Results,
    wall_seconds: f64,
    out: Option<&Path>,
) -> String {
    let mut report = Report::new(scene, header.labels.clone());
    report.sizes(&results.sizes);
    report.factor(&results.factor);
    report.ranks(&results.factor, results.ranks.as_ref());
    report.effects(&results.effects, false);
    if let Some(first) = &results.first_yield {
        report.first_yield(first, &header.bodies, results.sizes.contact_pairs > 0);
    }
    report.states(
        &results.states,
        scene.program.unit,
        results.sizes.contact_pairs > 0,
    );
    if let Some(cycles) = &results.cycles {
        report.cycles(cycles, scene.program.cycles);
    }
    if let Some(incomplete) = &results.incomplete {
        report.paragraph(&format!("INCOMPLETE: {}", incomplete.why));
    }
    report.reference(&results.reference);
    if let Some(far) = far_boundary::in_words(scene).filter(|_| !results.reference.is_empty()) {
        report.lines(&format!("  {far}"));
    }
    if let Some(accuracy) = &results.accuracy {
        report.accuracy(accuracy);
    }
    report.quality(results);
    report.cost(results, wall_seconds);
    report.list("Warnings", &results.warnings);
    if let Some(next) = for_a_tenth(scene, results) {
        report.paragraph(&format!(
            "For a tenth of the error of {} ({}, the largest that a demand on all counts): \
             elements {} times smaller, about {}, {}",
            next.quantity,
            percent(next.relative_error),
            significant(next.finer, 2),
            seconds(next.seconds),
            bytes(next.memory_bytes)
        ));
    }
    if let Some(out) = out {
        let with_fields = results.states.iter().any(|state| state.fields.is_some());
        report.paragraph(&format!(
            "Results in {}: {}summary.json, history.csv, contact.csv{}",
            out.display(),
            if out.join("report.html").exists() {
                "report.html, "
            } else {
                ""
            },
            if with_fields { ", fields.pvd" } else { "" }
        ));
    }
    report.text
}

/// Describes what a run would do and cost; with `all_effects` every effect that is off has a row
/// too.
pub(super) fn check(scene: &Scene, check: &Check, all_effects: bool) -> String {
    let mut report = Report::new(scene, Labels::default());
    report.sizes(&check.sizes);
    report.factor(&check.prediction);
    report.ranks(&check.prediction, None);
    report.labelled("Memory", &fit(check));
    report.labelled(
        "Predicted",
        &format!(
            "about {} for each factorisation, {} for the run without its error estimate; BLAS: {}",
            seconds(check.predicted_seconds),
            seconds(check.predicted_run_seconds),
            check.blas
        ),
    );
    if !check.error_estimate.is_empty() {
        report.labelled("Errors", &check.error_estimate);
    }
    report.effects(&check.effects, all_effects);
    report.list("Notes", &check.notes);
    report.text
}

/// Says in one line whether the run fits into the available memory.
pub(super) fn fit(check: &Check) -> String {
    let needed = bytes(check.prediction.memory_bytes);
    match (check.available_bytes.map(bytes), check.fits()) {
        (Some(available), Some(true)) => {
            format!("the run fits: about {needed} of the {available} that are available")
        }
        (Some(available), _) => {
            format!("the run does not fit: about {needed} are needed, {available} are available")
        }
        (None, _) => format!("about {needed}; how much is available is not known"),
    }
}

/// Formats a count with its noun: `3 elements`, `1 element`.
fn counted(count: usize, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {what}{plural}")
}

/// Width of the labels in characters.
const LABEL: usize = 9;

/// Returns the table of states.
pub(super) fn states_table(
    states: &[State],
    labels: &Labels,
    space: Space,
    contact: bool,
) -> Table {
    let columns = of_states(states, labels, space, contact, true);
    let numbers = columns
        .iter()
        .map(|c| (Number, with_unit_below(c.heading, &c.unit)));
    let state = (Text, "state".to_string());
    let headings: Vec<_> = std::iter::once(state).chain(numbers).collect();
    let mut table = Table::new(&headings);
    for (index, state) in states.iter().enumerate() {
        let cells = columns.iter().map(|column| column.cells[index].clone());
        table.row(std::iter::once(state.name.clone()).chain(cells));
    }
    table
}

/// Adds the unit to a heading as its last line.
fn with_unit_below(heading: &str, unit: &str) -> String {
    match unit {
        "" => heading.to_string(),
        unit => format!("{heading}\n[{unit}]"),
    }
}

struct Report {
    text: String,
    space: Space,
    labels: Labels,
    width: usize,
}

impl Report {
    fn new(scene: &Scene, labels: Labels) -> Self {
        let kind = match scene.kind {
            Kind::PlaneStrain => "plane strain",
            Kind::PlaneStress => "plane stress",
            Kind::Axisymmetric => "axisymmetric",
            Kind::Solid => "solid",
        };
        let title = match (scene.title.as_str(), &scene.file) {
            ("", Some(file)) => file.display().to_string(),
            ("", None) => "Untitled".to_string(),
            (title, _) => title.to_string(),
        };
        let mut report = Report {
            text: String::new(),
            space: scene.kind,
            labels,
            width: page_width(),
        };
        report.lines(&format!("{} ({kind})", shown_in_line(&title)));
        report.text.push('\n');
        report
    }

    fn lines(&mut self, text: &str) {
        for line in wrap(text, self.width) {
            self.text.push_str(&line);
            self.text.push('\n');
        }
    }

    /// Adds a label with its text beside it.
    fn labelled(&mut self, label: &str, text: &str) {
        let indent = LABEL + 2;
        for (index, line) in wrap(text, self.width - indent).iter().enumerate() {
            let label = if index == 0 { label } else { "" };
            self.text.push_str(&format!("{label:<indent$}{line}\n"));
        }
    }

    fn paragraph(&mut self, text: &str) {
        self.text.push('\n');
        self.lines(text);
    }

    fn section(&mut self, heading: &str, table: &Table) {
        self.text.push('\n');
        self.text.push_str(heading);
        self.text.push('\n');
        self.text.push_str(&table.render(self.width));
    }

    fn list(&mut self, heading: &str, items: &[String]) {
        if items.is_empty() {
            return;
        }
        self.paragraph(heading);
        for item in items {
            self.list_item("  - ", item);
        }
    }

    fn sizes(&mut self, sizes: &Sizes) {
        self.labelled(
            "Model",
            &format!(
                "{}, {}, {}, {}; {}",
                counted(sizes.elements, "element"),
                counted(sizes.nodes, "node"),
                counted(sizes.freedoms, "freedom"),
                counted(sizes.contact_pairs, "contact pair"),
                match sizes.zone_elements {
                    0 => "no plastic zone".to_string(),
                    n => format!(
                        "plastic zone {}, {}",
                        counted(n, "element"),
                        counted(sizes.zone_freedoms, "freedom")
                    ),
                }
            ),
        );
    }

    fn factor(&mut self, factor: &Prediction) {
        if factor.factor_nonzeros == 0.0 {
            return;
        }
        self.labelled(
            "Factor",
            &format!(
                "order {}, {} nonzeros ({} % trailing), {} flops, {}",
                factor.ordering,
                significant(factor.factor_nonzeros, 3),
                significant(100.0 * factor.trailing_nonzeros / factor.factor_nonzeros, 2),
                significant(factor.flops, 3),
                bytes(factor.memory_bytes)
            ),
        );
    }

    /// Adds the memory that several ranks need, and the memory that they held.
    fn ranks(&mut self, factor: &Prediction, ranks: Option<&Ranks>) {
        if factor.memory_by_rank.len() < 2 {
            return;
        }
        let list = |of: Vec<String>| of.join(", ");
        let predicted = factor.memory_by_rank.iter().map(|&n| bytes(n)).collect();
        let mut text = format!(
            "{}, predicted memory {}",
            factor.memory_by_rank.len(),
            list(predicted)
        );
        if let Some(ranks) = ranks {
            let peak = |peak: &Option<u64>| peak.map_or("?".to_string(), |n| bytes(n as f64));
            text += &format!(
                "; held at most {}; the first sent the others {} requests, {} transferred",
                list(ranks.peak_memory_bytes.iter().map(peak).collect()),
                ranks.requests,
                bytes(ranks.bytes as f64)
            );
        }
        self.labelled("Ranks", &text);
    }

    /// Adds a row for each effect that is on or asked for, or for all effects if `all`; the others
    /// are named in one line.
    fn effects(&mut self, effects: &[Effect], all: bool) {
        if effects.is_empty() {
            return;
        }
        let has_row = |effect: &Effect| all || effect.on || effect.asked;
        let rows = effects.iter().filter(|effect| has_row(effect));
        let mut table = Table::new(&[
            (Text, "effect"),
            (Text, ""),
            (Text, "why"),
            (Number, "time"),
            (Number, "memory"),
        ]);
        for effect in rows {
            // An effect that is off, or that costs nothing separately, has no figures.
            let cost = |nonzero: bool, text: String| match nonzero {
                true => text,
                false => "-".to_string(),
            };
            let time = cost(effect.on && effect.seconds > 0.0, seconds(effect.seconds));
            let memory = cost(
                effect.on && effect.memory_bytes > 0,
                bytes(effect.memory_bytes as f64),
            );
            let on = if effect.on { "on" } else { "off" };
            table.row([
                effect.name.clone(),
                on.to_string(),
                effect.why.clone(),
                time,
                memory,
            ]);
        }
        self.section("Effects", &table);
        let off = effects.iter().filter(|effect| !has_row(effect));
        let off: Vec<&str> = off.map(|effect| effect.name.as_str()).collect();
        if !off.is_empty() {
            let off = off.join(", ");
            self.list_item(
                "  off: ",
                &format!("{off} (why: `brinell check --effects`)"),
            );
        }
    }

    /// Adds text after a mark; its further lines are indented by the width of the mark.
    fn list_item(&mut self, mark: &str, text: &str) {
        let indent = mark.len();
        for (index, line) in wrap(text, self.width - indent).iter().enumerate() {
            let mark = if index == 0 { mark } else { "" };
            self.text.push_str(&format!("{mark:indent$}{line}\n"));
        }
    }

    fn cycles(&mut self, cycles: &Cycles, most: usize) {
        self.paragraph(&format!(
            "Cycles     {} of at most {most}: {}",
            cycles.last().cycle,
            cycles.told()
        ));
    }

    fn first_yield(&mut self, first: &YieldPoint, bodies: &[String], contact: bool) {
        let mut columns: Vec<(super::table::ColumnAlignment, String, String)> = Vec::new();
        let labels = &self.labels;
        for quantity in QUANTITIES.iter().filter(|q| q.scope.holds(contact, true)) {
            let heading = match quantity.key {
                "alpha" => "factor on\nthe loads",
                _ => labels.heading(quantity),
            };
            let heading = with_unit_below(heading, &labels.unit(quantity.unit));
            let value = quantity.at_yield.map(|field| (field.get)(first));
            columns.extend(value.map(|value| (Number, heading, cell(quantity, value))));
        }
        let body = bodies.get(first.body).cloned().unwrap_or_default();
        columns.push((Text, "in body".to_string(), body));
        for (axis, name) in self.space.axes().iter().enumerate() {
            let at = if axis == 0 { "at " } else { "" };
            let heading = with_unit_below(&format!("{at}{name}"), labels.length());
            columns.push((Number, heading, number(first.location[axis])));
        }
        let headings: Vec<_> = columns.iter().map(|c| (c.0, c.1.as_str())).collect();
        let mut table = Table::new(&headings);
        table.row(columns.into_iter().map(|c| c.2));
        self.section("First yield", &table);
    }

    /// Adds the states, with the columns that carry information in this scene.
    fn states(&mut self, states: &[State], unit: Unit, contact: bool) {
        if states.is_empty() {
            return;
        }
        self.section(
            match unit {
                Unit::Load => "States",
                Unit::Yield => "States (load factor 1 is first yield)",
            },
            &states_table(states, &self.labels, self.space, contact),
        );
    }

    fn reference(&mut self, rows: &[ReferenceRow]) {
        if rows.is_empty() {
            return;
        }
        let published = rows.iter().any(|row| row.published_ratio.is_some());
        let mut headings = vec![
            (Text, "quantity"),
            (Number, "reference"),
            (Number, "computed"),
            (Number, "ratio"),
        ];
        if published {
            headings.push((Number, "ratio of\nthe paper"));
        }
        headings.push((Text, "source"));
        let mut table = Table::new(&headings);
        for row in rows {
            let mut cells = vec![
                row.quantity.clone(),
                number(row.reference),
                number(row.computed),
                number(row.ratio),
            ];
            if published {
                let ratio = row.published_ratio.map(|ratio| ratio.to_string());
                cells.push(ratio.unwrap_or_else(|| "-".to_string()));
            }
            cells.push(row.source.clone());
            table.row(cells);
        }
        self.section("Reference values", &table);
    }

    fn quality(&mut self, results: &Results) {
        let figure = |value| significant(value, 2);
        let quality: &Quality = &results.quality;
        let componentwise = quality
            .componentwise_error
            .map_or_else(String::new, |value| {
                format!(" (row by row {})", figure(value))
            });
        let round_off = quality.round_off.map_or_else(String::new, |value| {
            format!(" (round-off alone {})", figure(value))
        });
        let condition = match (results.condition_estimate, results.condition) {
            (Some(estimate), _) => format!("; condition about {}", figure(estimate)),
            (None, least) if least > 0.0 => format!("; condition at least {}", figure(least)),
            _ => String::new(),
        };
        self.text.push('\n');
        self.labelled(
            "Quality",
            &format!(
                "backward error {}{componentwise}, equilibrium {}{round_off}, complementarity {}, \
                 penetration {}, adhesion {}{condition}",
                figure(quality.backward_error),
                figure(quality.equilibrium),
                figure(quality.complementarity),
                figure(quality.penetration),
                figure(quality.adhesion)
            ),
        );
    }

    fn cost(&mut self, results: &Results, wall_seconds: f64) {
        let counts = &results.counts;
        let mut list = vec![
            counted(results.history.len(), "increment"),
            counted(counts.factorizations, "factorization"),
            counted(counts.trailing_solves, "trailing solve"),
            counted(counts.full_solves, "full solve"),
            counted(counts.plastic_iterations, "plastic iteration"),
            counted(counts.contact_changes, "contact change"),
        ];
        if counts.zone_factorizations > 0 {
            let zone = counted(counts.zone_factorizations, "factorization");
            list.insert(2, format!("{zone} of the zone's tangent"));
        }
        if counts.hard_increments > 0 {
            let hard = counted(counts.hard_increments, "increment");
            list.push(format!("{hard} took more than one attempt"));
        }
        self.labelled("Counts", &list.join(", "));
        if results.timings.is_empty() {
            return;
        }
        let mut table = Table::new(&[(Text, "phase"), (Number, "time"), (Number, "share")]);
        // Phases that took less than half of the last digit shown are left out.
        for (phase, time) in results.timings.iter().filter(|(_, time)| *time >= 5e-4) {
            let share = 100.0 * time / wall_seconds.max(*time);
            table.row([phase.clone(), seconds(*time), format!("{share:.0} %")]);
        }
        table.row(["total".to_string(), seconds(wall_seconds), String::new()]);
        self.section("Time", &table);
    }
}

mod accuracy;
mod far_boundary;
#[cfg(test)]
mod tests;
