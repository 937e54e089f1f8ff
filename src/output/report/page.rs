//! The page, with its sections in the order in which a reader needs them.

use super::cycles;
use super::figure::{Figure, figures};
use super::film;
use super::tables;
use super::theme;
use super::trust;
use crate::model::Model;
use crate::number::significant;
use crate::output::RunHeader;
use crate::output::labels::{Labels, capitalised};
use crate::results::{Results, State};
use crate::scene::Kind;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("report.css");

/// The figures of a report, by section.
#[derive(Default)]
pub(super) struct PageFigures {
    /// Drawings of the scene.
    pub scene: Vec<Figure>,
    /// Drawings of the scene with the mesh, shown on demand.
    pub meshed: Vec<Figure>,
    /// Charts about the load and the contact.
    pub charts: Vec<Figure>,
    /// Name and pictures of each state shown.
    pub states: Vec<(String, Vec<Figure>)>,
    /// Number of states with fields that are not shown.
    pub states_left_out: usize,
    /// Text about the pictures.
    pub about_pictures: String,
}

/// Returns the whole page.
pub(super) fn page(
    header: &RunHeader,
    model: &Model,
    results: &Results,
    labels: &Labels,
    figures: &PageFigures,
) -> String {
    let title = title(header);
    let sections = [
        (
            "scene",
            "Scene",
            tables::scene(model, labels, &figures.scene, &figures.meshed),
        ),
        ("load", "Along the load", charts(&figures.charts)),
        ("states", "States", tables::states(model, results, labels)),
        ("cycles", "Cycles", cycles::table(results)),
        ("pictures", "Stress and plastic zone", pictures(figures)),
        ("reference", "Reference values", tables::reference(results)),
        (
            "errors",
            "How wrong the numbers may be",
            trust::errors(results, labels),
        ),
        ("effects", "What was simulated", tables::effects(results)),
        (
            "quality",
            "How well the equations were solved",
            trust::quality(results),
        ),
        ("cost", "Time and size", tables::cost(header, results)),
    ];
    let sections: Vec<_> = sections
        .into_iter()
        .filter(|(_, _, content)| !content.0.is_empty())
        .collect();
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(concat!("brinell ", env!("CARGO_PKG_VERSION")));
                // Without an icon in the page a browser would request one.
                link rel="icon" href="data:,";
                title { (title) " \u{2013} brinell" }
                style { (PreEscaped(theme::variables())) (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (title) }
                    p.quiet { (subtitle(header, model)) }
                    @if let Some(incomplete) = &results.incomplete {
                        div.note.bad { b { "Incomplete. " } (incomplete.why) }
                    }
                    p.lead { (story(header, model, results, labels)) }
                    (cards(model, results, labels))
                    nav aria-label="Sections" {
                        @for (id, heading, _) in &sections { a href={ "#" (id) } { (heading) } }
                    }
                }
                main {
                    @for warning in &results.warnings { div.note { (warning) } }
                    @for (id, heading, content) in &sections {
                        section id=(id) {
                            h2 { (heading) }
                            (content)
                        }
                    }
                }
                footer { (files(results)) }
            }
        }
    }
    .into_string()
}

fn title(header: &RunHeader) -> String {
    match (&header.scene_title, &header.scene_file) {
        (title, _) if !title.is_empty() => title.clone(),
        (_, Some(file)) => file.clone(),
        _ => "Untitled scene".to_string(),
    }
}

fn subtitle(header: &RunHeader, model: &Model) -> String {
    let kind = match model.kind {
        Kind::PlaneStrain => "Plane strain",
        Kind::PlaneStress => "Plane stress",
        Kind::Axisymmetric => "Axisymmetric",
        Kind::Solid => "Solid",
    };
    let copies = match model.scene.symmetry {
        2 => ", half model (loads are those of the whole)",
        4 => ", quarter model (loads are those of the whole)",
        8 => ", an eighth (loads are those of the whole)",
        _ => "",
    };
    let file = header
        .scene_file
        .as_ref()
        .map_or(String::new(), |file| format!(" \u{b7} {file}"));
    let units = match &model.scene.units {
        Some(units) => format!(
            " \u{b7} units {}, {}, {}",
            units.force, units.length, units.stress
        ),
        None => " \u{b7} numbers in the scene\u{2019}s own consistent units".to_string(),
    };
    format!("{kind}{copies}{units}{file}")
}

/// Formats a number with four digits; small and large numbers have a power of ten.
fn round(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        let text = format!("{value:.3e}");
        if let Some((digits, exponent)) = text.split_once('e') {
            let exponent: String = exponent.chars().map(superscript).collect();
            return format!("{digits}\u{b7}10{exponent}");
        }
    }
    significant(value, 4)
}

fn superscript(digit: char) -> char {
    match digit {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        '0'..='9' => char::from_u32(u32::from(digit) - u32::from('0') + 0x2070).unwrap_or(digit),
        other => other,
    }
}

/// Formats a number with its unit.
fn quantity(value: f64, unit: &str) -> String {
    if unit.is_empty() {
        round(value)
    } else {
        format!("{}\u{a0}{unit}", round(value))
    }
}

/// Describes the run in a few sentences.
fn story(header: &RunHeader, model: &Model, results: &Results, labels: &Labels) -> String {
    let mut text = String::new();
    let contact = !model.pairs.is_empty();
    match &results.first_yield {
        Some(first) => {
            // With a prescribed displacement without contact the load is known at the states only.
            let load = match first.load.is_finite() {
                true => format!("load of {}", quantity(first.load, labels.load())),
                false => format!("load factor of {}", round(first.alpha)),
            };
            text.push_str(&format!(
                "The material first yields at a {load}, in {} at ({})",
                header.body(first.body),
                (first.location.iter().take(model.mesh.dimension))
                    .map(|x| significant(*x, 3))
                    .collect::<Vec<_>>()
                    .join(", ")
            ));
            if contact {
                text.push_str(&format!(
                    ", under a maximum contact pressure of {} and a {} of {}",
                    quantity(first.max_pressure, labels.stress()),
                    labels.half_width(),
                    quantity(first.half_width, labels.length())
                ));
            }
            text.push_str(". ");
        }
        None => text.push_str("The material does not yield. "),
    }
    let highest = |a: &&State, b: &&State| a.load.total_cmp(&b.load);
    if let Some(top) = results.states.iter().max_by(highest) {
        let plastic = top.max_equivalent_plastic_strain;
        text.push_str(&format!(
            "The largest load of a state is {}{}",
            quantity(top.load, labels.load()),
            if contact {
                format!(
                    ", with a maximum pressure of {}",
                    quantity(top.max_pressure, labels.stress())
                )
            } else {
                String::new()
            }
        ));
        if plastic > 0.0 {
            text.push_str(&format!(
                " and an equivalent plastic strain of up to {} %",
                significant(100.0 * plastic, 3)
            ));
        }
        text.push_str(". ");
    }
    if let Some(last) = results.states.last().filter(|s| s.residual_depth > 0.0) {
        text.push_str(&format!(
            "A dent {} deep remains without load.",
            quantity(last.residual_depth, labels.length())
        ));
    }
    text
}

fn cards(model: &Model, results: &Results, labels: &Labels) -> Markup {
    let contact = !model.pairs.is_empty();
    let width = labels.half_width();
    let mut cards: Vec<(String, f64, &str)> = Vec::new();
    let mut add = |name: &str, value, unit| cards.push((name.to_string(), value, unit));
    if let Some(first) = &results.first_yield {
        add("Yield load", first.load, labels.load());
        if contact {
            add(
                "Pressure at first yield",
                first.max_pressure,
                labels.stress(),
            );
            let name = capitalised(&format!("{width} at first yield"));
            add(&name, first.half_width, labels.length());
        }
    }
    let largest = |value: fn(&State) -> f64| results.states.iter().map(value).fold(0.0, f64::max);
    add("Largest load", largest(|s| s.load), labels.load());
    if contact {
        add(
            "Largest pressure",
            largest(|s| s.max_pressure),
            labels.stress(),
        );
        add(
            &format!("Largest {width}"),
            largest(|s| s.half_width),
            labels.length(),
        );
    }
    add(
        "Residual depth",
        largest(|s| s.residual_depth),
        labels.length(),
    );
    let strain = 100.0 * largest(|s| s.max_equivalent_plastic_strain);
    add("Largest plastic strain", strain, "%");
    html! {
        dl.cards {
            @let shown = |card: &&(String, f64, &str)| card.1 > 0.0 && card.1.is_finite();
            @for (name, value, unit) in cards.iter().filter(shown) {
                div.card {
                    dt { (name) }
                    dd { b { (round(*value)) } " " small { (unit) } }
                }
            }
        }
    }
}

fn charts(list: &[Figure]) -> Markup {
    if list.is_empty() {
        return PreEscaped(String::new());
    }
    figures(list, "figures")
}

fn pictures(all: &PageFigures) -> Markup {
    if all.states.is_empty() {
        return PreEscaped(String::new());
    }
    html! {
        p.quiet { (all.about_pictures) }
        @if all.states_left_out > 0 {
            p.quiet {
                (all.states_left_out) " more "
                (if all.states_left_out == 1 { "state is" } else { "states are" })
                " in the " code { ".vtu" }
                " files (ParaView: open " code { "fields.pvd" } ")."
            }
        }
        @for (name, list) in &all.states {
            h3 { "State \u{201c}" (name) "\u{201d}" }
            (figures(list, "figures three"))
        }
        @let films = film::of(&all.states);
        @if !films.is_empty() {
            h3 { "The states one after the other" }
            p.quiet { "Rest the pointer on a picture to pause it." }
            (figures(&films, "figures three"))
        }
    }
}

fn files(results: &Results) -> Markup {
    let fields = results.states.iter().any(|s| s.fields.is_some());
    html! {
        p {
            "Beside this page: " a href="summary.json" { "summary.json" } " (all figures), "
            a href="history.csv" { "history.csv" } " (a row per increment), "
            @if !results.path.is_empty() {
                a href="path.csv" { "path.csv" } " (points between them), "
            }
            a href="contact.csv" { "contact.csv" } " (a row per state and contact pair)"
            @if fields { ", " a href="fields.pvd" { "fields.pvd" } " (fields for ParaView)" }
            ", the figures as " code { "report_*.svg" } "."
        }
        p {
            "Written by brinell " (env!("CARGO_PKG_VERSION"))
            ". Small strains, no friction; after N. Endahl, Finite Element Analysis of \
             Elastoplastic Contact Problems Without Friction."
        }
    }
}
