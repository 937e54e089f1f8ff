//! The tables of the page.

use super::figure::{Figure, figures};
use super::load_factor::{factor, factor_unit};
use super::sketch::{BODIES, CONTACT, LOAD, SUPPORT};
use super::theme::hex;
use crate::model::Model;
use crate::number::{bytes, number, seconds, trimmed, with_unit};
use crate::output::RunHeader;
use crate::output::columns::of_states;
use crate::output::labels::{Labels, in_line, labelled};
use crate::results::Results;
use crate::scene::{Direction, Field, History, Load, LoadAction, NodeAction, VolumeAction};
use crate::space::Components;
use maud::{Markup, PreEscaped, html};
use plotters::style::RGBColor;

/// Lays out a table that may be wider than the page. Columns that hold numbers are aligned to the
/// right.
pub(super) fn table(head: &[(bool, String)], rows: &[Vec<Markup>]) -> Markup {
    html! {
        div.wide tabindex="0" {
            table {
                thead { tr {
                    @for (is_number, name) in head {
                        th class=[is_number.then_some("n")] scope="col" { (name) }
                    }
                } }
                tbody {
                    @for row in rows {
                        tr {
                            @for (cell, _) in row.iter().zip(head).take(1) {
                                th scope="row" { (cell) }
                            }
                            @for (cell, (is_number, _)) in row.iter().zip(head).skip(1) {
                                td class=[is_number.then_some("n")] { (cell) }
                            }
                        }
                    }
                }
            }
        }
    }
}

pub(super) fn text(name: &str) -> (bool, String) {
    (false, name.to_string())
}

pub(super) fn numbers(name: impl Into<String>) -> (bool, String) {
    (true, name.into())
}

pub(super) fn plain(text: impl AsRef<str>) -> Markup {
    html! { (text.as_ref()) }
}

fn swatch(color: RGBColor, name: &str) -> Markup {
    html! { i.swatch style={ "background:" (hex(color)) } {} (name) }
}

/// Returns the table of the components of the scene, next to its drawing.
pub(super) fn scene(model: &Model, labels: &Labels, drawn: &[Figure], meshed: &[Figure]) -> Markup {
    html! {
        (figures(drawn, "figures"))
        @if !meshed.is_empty() {
            details {
                summary { "Show the mesh" }
                (figures(meshed, "figures"))
            }
        }
        h3 { "Bodies" }
        (bodies(model, labels))
        h3 { "Contact, supports, loads" }
        (conditions(model, labels))
    }
}

fn bodies(model: &Model, labels: &Labels) -> Markup {
    let stress = labels.stress();
    let head = [
        text("body"),
        text("material"),
        numbers(labelled("E", stress)),
        numbers("\u{3bd}"),
        numbers(labelled("yield stress", stress)),
        text("hardening"),
    ];
    let rows: Vec<Vec<Markup>> = (0..model.mesh.bodies.len())
        .filter_map(|index| {
            let name = &model.mesh.bodies[index];
            let body = model.scene.bodies.get(name)?;
            let material = model.scene.material_of(name)?;
            let yields = material
                .first_yield_stress()
                .filter(|_| model.may_yield[index]);
            let hardening = match (yields, material.plastic_modulus_resolved()) {
                (None, _) => "elastic".to_string(),
                (_, Some(0.0)) => "none (perfectly plastic)".to_string(),
                (_, Some(h)) => {
                    format!("linear, H = {}", with_unit(&given(h), stress))
                }
                (_, None) => "table".to_string(),
            };
            let back = material
                .back_stresses()
                .into_iter()
                .filter(|[c, _]| *c != 0.0);
            let back: Vec<String> = back
                .map(|[c, gamma]| match gamma == 0.0 {
                    true => format!("C = {}", with_unit(&given(c), stress)),
                    false => {
                        let c = with_unit(&given(c), stress);
                        format!("C = {c}, \u{3b3} = {}", given(gamma))
                    }
                })
                .collect();
            let hardening = match back.is_empty() || yields.is_none() {
                true => hardening,
                false => format!("{hardening}; kinematic, {}", back.join("; ")),
            };
            let by_depth = model.yield_by_depth[index].is_some();
            Some(vec![
                swatch(BODIES[index % BODIES.len()], name),
                plain(&body.material),
                plain(given(material.youngs_modulus)),
                plain(given(material.poissons_ratio)),
                plain(yields.map_or("\u{2013}".to_string(), |y| match by_depth {
                    true => "by depth".to_string(),
                    false => given(y),
                })),
                plain(hardening),
            ])
        })
        .collect();
    table(&head, &rows)
}

/// Formats a number of the input as it was given, with up to six digits.
fn given(value: f64) -> String {
    trimmed(value, 6)
}

/// Formats a number with its unit; a formula is shown as it is.
fn stated(field: &Field, unit: &str) -> String {
    match field.uniform() {
        Some(value) => with_unit(&given(value), unit),
        None => field.to_string(),
    }
}

fn conditions(model: &Model, labels: &Labels) -> Markup {
    let scene = &model.scene;
    let mut rows: Vec<Vec<Markup>> = Vec::new();
    for (contact, surface) in scene.contact.iter().zip(&model.contacts) {
        let mut what = format!("{} pairs of nodes, without friction", surface.range.len());
        if contact.interference != Field::default() {
            let interference = stated(&contact.interference, labels.length());
            what.push_str(&format!(", interference {interference}"));
        }
        if let Some(gap) = &contact.gap {
            what.push_str(&format!(", initial gap {}", stated(gap, labels.length())));
        }
        let on = format!("{} on {}", contact.first, contact.second);
        rows.push(vec![swatch(CONTACT, "contact"), plain(on), plain(what)]);
    }
    for support in &scene.support {
        let fixed: Vec<&str> = support.fix.iter().map(|d| axis(model, *d)).collect();
        let turned = support.angle.map_or(String::new(), |a| {
            format!(", axes turned by {}\u{b0}", given(a))
        });
        let what = format!("{} held{turned}", fixed.join(" and "));
        rows.push(vec![
            swatch(SUPPORT, "support"),
            plain(&support.on),
            plain(what),
        ]);
    }
    for load in &scene.load {
        let what = describe(model, load, labels);
        rows.push(vec![swatch(LOAD, "load"), plain(&load.on), plain(what)]);
    }
    table(&[text(""), text("on"), text("what")], &rows)
}

fn axis(model: &Model, direction: Direction) -> &'static str {
    model.kind.axes()[direction.axis()]
}

fn vector(components: Components) -> String {
    let parts: Vec<String> = components.iter().map(given).collect();
    format!("({})", parts.join(", "))
}

/// Describes what a load does to the nodes of a surface or a node set.
fn on_nodes(model: &Model, action: NodeAction, labels: &Labels) -> String {
    match action {
        NodeAction::Force(force) => format!("force {}", vector(force)),
        NodeAction::Pressure(pressure) => {
            format!("pressure {}", stated(pressure, labels.stress()))
        }
        NodeAction::Traction(traction) => {
            let parts: Vec<String> = traction.iter().map(|part| stated(part, "")).collect();
            format!("traction ({}) {}", parts.join(", "), labels.stress())
        }
        NodeAction::Kirsch(kirsch) => format!(
            "traction of a plate with a hole under remote tensions {}",
            vector([kirsch.stress_x, kirsch.stress_y].into())
        ),
        NodeAction::Displacement(displacement) => {
            let components = Direction::ALL.into_iter().zip(displacement.components());
            let given = components.filter_map(|(direction, value)| {
                let value = stated(value?, labels.length());
                Some(format!("{} = {value}", axis(model, direction)))
            });
            format!("displacement {}", given.collect::<Vec<_>>().join(", "))
        }
        NodeAction::Relative(relative) => format!(
            "displacement along {}, {} more than that of the set it follows",
            axis(model, relative.direction),
            stated(&relative.value.into(), labels.length())
        ),
        NodeAction::PlaneForce(plane) => format!(
            "force {} along {}, the surface held plane",
            given(plane.total),
            axis(model, plane.direction)
        ),
        NodeAction::Gap(gap) => format!("gap changed by {}", stated(gap, labels.length())),
    }
}

/// Describes what a load does to the volume of a body.
fn on_volume(action: VolumeAction) -> String {
    match action {
        VolumeAction::Acceleration(a) => format!("acceleration {} of its mass", vector(a)),
        VolumeAction::Rotation(rotation) => format!("rotation at {} rpm", given(rotation.rpm)),
        VolumeAction::Temperature(nodal @ Field::Nodal(_)) => {
            format!("temperature changed {nodal}")
        }
        VolumeAction::Temperature(change) => {
            format!("temperature changed by {}", stated(change, ""))
        }
    }
}

fn describe(model: &Model, load: &Load, labels: &Labels) -> String {
    let mut what = match load.action() {
        Some(LoadAction::OnNodes(action)) => on_nodes(model, action, labels),
        Some(LoadAction::OnVolume(action)) => on_volume(action),
        None => String::new(),
    };
    match &load.history {
        History::Proportional => {}
        History::Constant => what.push_str(", constant (preload)"),
        History::Table(rows) => {
            let rows: Vec<String> = rows.iter().map(|r| vector((*r).into())).collect();
            what.push_str(&format!(
                ", times a table of (load factor, multiple): {}",
                rows.join(" ")
            ));
        }
    }
    if load.name.is_empty() {
        what
    } else {
        format!("{}: {what}", load.name)
    }
}

/// Returns the table of states, with the columns that carry information in this scene.
pub(super) fn states(model: &Model, results: &Results, labels: &Labels) -> Markup {
    let states = &results.states;
    if states.is_empty() {
        return PreEscaped(String::new());
    }
    let columns = of_states(states, labels, model.kind, !model.pairs.is_empty(), false);
    let unit = model.program.unit;
    let mut head = vec![text("state"), numbers(factor(unit))];
    let rest = columns
        .iter()
        .skip(1)
        .map(|column| numbers(labelled(&in_line(column.heading), &column.unit)));
    head.extend(rest);
    let rows: Vec<Vec<Markup>> = states
        .iter()
        .enumerate()
        .map(|(index, state)| {
            let cells = columns.iter().map(|column| plain(&column.cells[index]));
            std::iter::once(plain(&state.name)).chain(cells).collect()
        })
        .collect();
    html! {
        p.quiet { "A load factor is " (factor_unit(unit)) "." }
        (table(&head, &rows))
    }
}

/// Returns the table of reference values compared with computed ones.
pub(super) fn reference(results: &Results) -> Markup {
    if results.reference.is_empty() {
        return PreEscaped(String::new());
    }
    let published = results
        .reference
        .iter()
        .any(|r| r.published_ratio.is_some());
    let mut head = vec![
        text("quantity"),
        numbers("reference"),
        numbers("computed"),
        numbers("computed / reference"),
        numbers("difference"),
    ];
    if published {
        head.push(numbers("ratio of the paper"));
    }
    head.push(text("source"));
    let rows: Vec<Vec<Markup>> = results
        .reference
        .iter()
        .map(|row| {
            let mut cells = vec![
                html! { code { (row.quantity) } },
                plain(number(row.reference)),
                plain(number(row.computed)),
                plain(number(row.ratio)),
                plain(difference(row.ratio)),
            ];
            if published {
                cells.push(plain(
                    row.published_ratio
                        .map_or("\u{2013}".to_string(), |r| r.to_string()),
                ));
            }
            cells.push(plain(&row.source));
            cells
        })
        .collect();
    table(&head, &rows)
}

/// Formats the excess of the computed value over the reference in per cent; `none` if the ratio is
/// not finite.
fn difference(ratio: f64) -> String {
    if ratio.is_finite() {
        format!("{:+.2} %", 100.0 * (ratio - 1.0))
    } else {
        "none".to_string()
    }
}

/// Returns the table of effects.
pub(super) fn effects(results: &Results) -> Markup {
    if results.effects.is_empty() {
        return PreEscaped(String::new());
    }
    html! {
        div.wide tabindex="0" {
            table {
                thead { tr {
                    th scope="col" { "effect" } th scope="col" { "" } th scope="col" { "why" }
                    th.n scope="col" { "time" } th.n scope="col" { "memory" }
                } }
                tbody {
                    @for effect in &results.effects {
                        tr class=[(!effect.on).then_some("off")] {
                            th scope="row" { (effect.name) }
                            td { @if effect.on { b { "on" } } @else { "off" } }
                            td.why { (effect.why) }
                            td.n {
                                @if effect.on && effect.seconds > 0.0 { (seconds(effect.seconds)) }
                            }
                            td.n {
                                @if effect.on && effect.memory_bytes > 0 {
                                    (bytes(effect.memory_bytes as f64))
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Returns the tables of time by phase, sizes and counts.
pub(super) fn cost(header: &RunHeader, results: &Results) -> Markup {
    let total = header.wall_seconds;
    let phases: Vec<&(String, f64)> = results.timings.iter().filter(|(_, t)| *t > 0.0).collect();
    let longest = phases.iter().map(|(_, t)| *t).fold(0.0, f64::max);
    let sizes = &results.sizes;
    let counts = &results.counts;
    let figures = [
        ("elements", sizes.elements),
        ("nodes", sizes.nodes),
        ("freedoms", sizes.freedoms),
        ("contact pairs", sizes.contact_pairs),
        ("freedoms of the plastic zone", sizes.zone_freedoms),
        ("increments", results.history.len()),
        ("factorisations", counts.factorizations),
        (
            "factorisations of the zone's tangent",
            counts.zone_factorizations,
        ),
        ("solves with the trailing block", counts.trailing_solves),
        ("full solves", counts.full_solves),
        ("plastic iterations", counts.plastic_iterations),
        ("changes of contact", counts.contact_changes),
        (
            "increments that took more than one attempt",
            counts.hard_increments,
        ),
    ];
    html! {
        div.wide tabindex="0" {
            table {
                thead { tr {
                    th scope="col" { "phase" } th.n scope="col" { "time" }
                    th.n scope="col" { "share" } th.bar scope="col" {}
                } }
                tbody {
                    @for (phase, t) in &phases {
                        tr {
                            th scope="row" { (phase) }
                            td.n { (seconds(*t)) }
                            td.n { (format!("{:.0} %", 100.0 * t / total.max(*t))) }
                            td.bar {
                                i style={ "width:" (format!("{:.1}", 100.0 * t / longest)) "%" } {}
                            }
                        }
                    }
                    tr {
                        th scope="row" { b { "all" } }
                        td.n { b { (seconds(total)) } } td {} td {}
                    }
                }
            }
        }
        div.wide tabindex="0" {
            table {
                tbody {
                    @for (name, count) in figures.iter().filter(|f| f.1 > 0) {
                        tr { th scope="row" { (name) } td.n { (grouped(*count)) } }
                    }
                    @if results.factor.factor_nonzeros > 0.0 {
                        tr {
                            th scope="row" {
                                "nonzeros of the factor (order " (results.factor.ordering) ")"
                            }
                            td.n { (grouped(results.factor.factor_nonzeros as usize)) }
                        }
                        tr {
                            th scope="row" { "memory of the factor" }
                            td.n { (bytes(results.factor.memory_bytes)) }
                        }
                    }
                    tr { th scope="row" { "solver" } td.n { (header.solver) } }
                }
            }
        }
    }
}

/// Formats a count with thin spaces between thousands.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push('\u{202f}');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::difference;

    #[test]
    fn a_difference_is_a_share_of_the_reference() {
        for (ratio, expected) in [(1.25, "+25.00 %"), (0.8, "-20.00 %"), (1.0, "+0.00 %")] {
            assert_eq!(difference(ratio), expected);
        }
        assert_eq!(difference(f64::NAN), "none");
    }
}
