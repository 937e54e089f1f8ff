//! The printed summaries.

use super::number::{bytes, number, seconds, significant};
use super::table::{Column::*, Table, WIDTH, wrap};
use crate::analysis::Check;
use crate::linalg::Prediction;
use crate::results::{Effect, Quality, ReferenceRow, Results, Sizes, State, YieldPoint};
use crate::scene::{Kind, Scene};
use std::path::Path;

/// The summary of a run or of a yield load.
pub(super) fn results(scene: &Scene, results: &Results, out: Option<&Path>) -> String {
    let mut report = Report::new(scene);
    report.sizes(&results.sizes);
    report.factor(&results.factor);
    report.effects(&results.effects);
    report.first_yield(results.first_yield.as_ref());
    report.states(&results.states);
    if let Some(why) = &results.incomplete {
        report.paragraph(&format!("INCOMPLETE: {why}"));
    }
    report.reference(&results.reference);
    report.quality(&results.quality);
    report.cost(results);
    report.list("Warnings", &results.warnings);
    if let Some(out) = out {
        report.paragraph(&format!(
            "Results in {}: summary.json, history.csv, contact.csv, fields.pvd",
            out.display()
        ));
    }
    report.text
}

/// What a run would do and cost.
pub(super) fn check(scene: &Scene, check: &Check) -> String {
    let mut report = Report::new(scene);
    report.sizes(&check.sizes);
    report.factor(&check.prediction);
    report.labelled(
        "Predicted",
        &format!(
            "{} for the factorisation; BLAS: {}",
            seconds(check.predicted_seconds),
            check.blas
        ),
    );
    report.effects(&check.effects);
    report.list("Notes", &check.notes);
    report.text
}

/// Width of the labels.
const LABEL: usize = 9;

struct Report {
    text: String,
}

impl Report {
    fn new(scene: &Scene) -> Self {
        let kind = match scene.kind {
            Kind::PlaneStrain => "plane strain",
            Kind::PlaneStress => "plane stress",
            Kind::Axisymmetric => "axisymmetric",
        };
        let title = match (scene.title.as_str(), &scene.file) {
            ("", Some(file)) => file.display().to_string(),
            ("", None) => "Untitled".to_string(),
            (title, _) => title.to_string(),
        };
        let mut report = Report {
            text: String::new(),
        };
        report.lines(&format!("{title} ({kind})"));
        report.text.push('\n');
        report
    }

    fn lines(&mut self, text: &str) {
        for line in wrap(text, WIDTH) {
            self.text.push_str(&line);
            self.text.push('\n');
        }
    }

    /// A label with its text beside it.
    fn labelled(&mut self, label: &str, text: &str) {
        let indent = LABEL + 2;
        for (index, line) in wrap(text, WIDTH - indent).iter().enumerate() {
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
        self.text.push_str(&table.render());
    }

    fn list(&mut self, heading: &str, items: &[String]) {
        if items.is_empty() {
            return;
        }
        self.paragraph(heading);
        for item in items {
            for (index, line) in wrap(item, WIDTH - 4).iter().enumerate() {
                let mark = if index == 0 { "  - " } else { "    " };
                self.text.push_str(&format!("{mark}{line}\n"));
            }
        }
    }

    fn sizes(&mut self, sizes: &Sizes) {
        self.labelled(
            "Model",
            &format!(
                "{} elements, {} nodes, {} freedoms, {} contact pairs; \
             plastic zone {} elements, {} freedoms",
                sizes.elements,
                sizes.nodes,
                sizes.freedoms,
                sizes.contact_pairs,
                sizes.zone_elements,
                sizes.zone_freedoms
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

    fn effects(&mut self, effects: &[Effect]) {
        if effects.is_empty() {
            return;
        }
        let mut table = Table::new(&[
            (Text, "effect"),
            (Text, ""),
            (Text, "why"),
            (Number, "time"),
            (Number, "memory"),
        ]);
        for effect in effects {
            let (time, memory) = if effect.on {
                (seconds(effect.seconds), bytes(effect.memory_bytes as f64))
            } else {
                ("-".to_string(), "-".to_string())
            };
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
    }

    fn first_yield(&mut self, first: Option<&YieldPoint>) {
        let Some(first) = first else { return };
        let mut table = Table::new(&[
            (Number, "load\nfactor"),
            (Number, "load"),
            (Number, "max\npressure"),
            (Number, "half\nwidth"),
            (Number, "x"),
            (Number, "y"),
        ]);
        table.row(
            [
                first.alpha,
                first.load,
                first.max_pressure,
                first.half_width,
                first.location[0],
                first.location[1],
            ]
            .map(number),
        );
        self.section("First yield", &table);
    }

    fn states(&mut self, states: &[State]) {
        if states.is_empty() {
            return;
        }
        let mut table = Table::new(&[
            (Text, "state"),
            (Number, "load\nfactor"),
            (Number, "load"),
            (Number, "max\npressure"),
            (Number, "half\nwidth"),
            (Number, "residual\ndepth"),
            (Number, "plastic\npoints"),
            (Number, "max plastic\nstrain"),
        ]);
        for state in states {
            table.row([
                state.name.clone(),
                number(state.alpha),
                number(state.load),
                number(state.max_pressure),
                number(state.half_width),
                number(state.residual_depth),
                state.plastic_points.to_string(),
                number(state.max_equivalent_plastic_strain),
            ]);
        }
        self.section("States", &table);
    }

    fn reference(&mut self, rows: &[ReferenceRow]) {
        if rows.is_empty() {
            return;
        }
        let mut table = Table::new(&[
            (Text, "quantity"),
            (Number, "reference"),
            (Number, "computed"),
            (Number, "ratio"),
            (Number, "ratio of\nthe paper"),
            (Text, "source"),
        ]);
        for row in rows {
            table.row([
                row.quantity.clone(),
                number(row.reference),
                number(row.computed),
                number(row.ratio),
                row.published_ratio
                    .map_or("-".to_string(), |ratio| ratio.to_string()),
                row.source.clone(),
            ]);
        }
        self.section("Reference values", &table);
    }

    fn quality(&mut self, quality: &Quality) {
        let figure = |value| significant(value, 2);
        self.text.push('\n');
        self.labelled(
            "Quality",
            &format!(
                "backward error {}, equilibrium {}, complementarity {}, penetration {}",
                figure(quality.backward_error),
                figure(quality.equilibrium),
                figure(quality.complementarity),
                figure(quality.penetration)
            ),
        );
    }

    fn cost(&mut self, results: &Results) {
        let counts = &results.counts;
        self.labelled(
            "Counts",
            &format!(
                "{} increments, {} factorizations, {} trailing solves, {} full solves, \
             {} plastic iterations, {} contact changes",
                results.history.len(),
                counts.factorizations,
                counts.trailing_solves,
                counts.full_solves,
                counts.plastic_iterations,
                counts.contact_changes
            ),
        );
        if results.timings.is_empty() {
            return;
        }
        let total: f64 = results.timings.iter().map(|(_, time)| time).sum();
        let mut table = Table::new(&[(Text, "phase"), (Number, "time"), (Number, "share")]);
        for (phase, time) in &results.timings {
            let share = if total > 0.0 {
                100.0 * time / total
            } else {
                0.0
            };
            table.row([phase.clone(), seconds(*time), format!("{share:.0} %")]);
        }
        table.row(["total".to_string(), seconds(total), String::new()]);
        self.section("Time", &table);
    }
}

#[cfg(test)]
mod tests;
