//! `report.html`: a run to look at, and its figures as files of their own.
//!
//! One page without scripts that needs no network, to be read on a screen, a phone and paper.
//!
//! | file | what |
//! |---|---|
//! | `page`, `tables`, `trust` | the page |
//! | `curves`, `chart` | charts: which, and how they are drawn |
//! | `fields`, `sketch` | pictures of states; the scene drawn |
//! | `contact_map` | pressure over a contact of solids |
//! | `picture`, `raster`, `bands`, `window` | elements as pixels under axes, their scale of colours; what is shown |
//! | `drawing`, `theme`, `units` | SVG text, colours for light and dark, names of units |
//!
//! What a picture costs is set by its pixels: a mesh of a million freedoms adds a pass over its
//! elements.

mod bands;
mod chart;
mod contact_map;
mod curves;
mod drawing;
mod fields;
mod page;
mod picture;
mod raster;
mod sketch;
mod tables;
mod theme;
mod trust;
mod units;
mod window;

use super::number::significant;
use super::{FIGURE_PREFIX, FIGURE_SUFFIX, REPORT_FILE, RunHeader};
use crate::error::Result;
use crate::model::Model;
use crate::results::{Results, State};
use crate::text::shown;
use contact_map::ContactMap;
use drawing::Drawing;
use fields::{Gallery, Quantity};
use page::{Figure, Figures};
use rayon::prelude::*;
use std::borrow::Cow;
use units::Units;

/// Least share of the area whose elements are large enough to be seen that is worth a drawing of
/// the mesh.
const LEAST_MESH: f64 = 0.2;
/// Most states whose pictures the page shows.
const MOST_STATES: usize = 4;

/// Names and contents of the report's files, the page last.
///
/// # Errors
/// `Internal` where a figure cannot be drawn.
pub(super) fn files(
    header: &RunHeader,
    model: &Model,
    results: &Results,
) -> Result<Vec<(String, String)>> {
    let units = Units::of(model);
    let mut out = Vec::new();
    let mut figures = Figures::default();
    let mut keep = |name: &str, drawing: &Drawing, title: &str, caption: &str| {
        out.push((
            format!("{FIGURE_PREFIX}{name}{FIGURE_SUFFIX}"),
            drawing.file(),
        ));
        Figure {
            title: title.to_string(),
            caption: caption.to_string(),
            svg: drawing.inline(if title.is_empty() { caption } else { title }),
        }
    };
    for sketch in scene(model, results, &units)? {
        let figure = keep(&sketch.name, &sketch.drawing, sketch.title, &sketch.caption);
        match sketch.meshed {
            true => figures.meshed.push(figure),
            false => figures.scene.push(figure),
        }
    }
    let charts = curves::charts(model, results, &units);
    let drawn: Vec<Drawing> = charts
        .par_iter()
        .map(|titled| titled.chart.draw())
        .collect::<Result<_>>()?;
    for (titled, drawing) in charts.iter().zip(&drawn) {
        figures
            .charts
            .push(keep(&titled.name, drawing, &titled.title, &titled.caption));
    }
    for (index, drawing) in contact_maps(model, results, &units, &mut figures)? {
        let state = &results.states[index];
        let load = format!("load {} {}", significant(state.load, 4), units.load());
        let caption = format!("Contact pressure, {}.", load.trim_end());
        let name = format!("state_{:02}_contact_pressure", index + 1);
        let figure = keep(&name, &drawing, "", &caption);
        figures.states.push((state.name.clone(), vec![figure]));
    }
    let pictures = pictures(model, results, &units, &mut figures)?;
    for (index, list) in pictures {
        let state = &results.states[index];
        let shown = list.iter().map(|(quantity, drawing, own)| {
            let (name, title) = words(*quantity);
            let own = if *own {
                " Colours on a scale of their own."
            } else {
                ""
            };
            let caption = format!("{title}, {}{own}", about(state, *quantity, &units));
            let name = format!("state_{:02}_{name}", index + 1);
            keep(&name, drawing, "", &caption)
        });
        let shown = shown.collect();
        figures.states.push((state.name.clone(), shown));
    }
    out.push((
        REPORT_FILE.to_string(),
        page::page(header, model, results, &units, &figures),
    ));
    for (_, text) in &mut out {
        // Titles and names with characters that are no XML.
        if let Cow::Owned(escaped) = shown(text) {
            *text = escaped;
        }
    }
    Ok(out)
}

/// What the pictures of solids are.
const OF_SOLIDS: &str = "Pressure over the contact that carries most, seen along its normal, where it is modelled; \
     the line is the ellipse of the half axes. For stresses and the plastic zone open fields.pvd in ParaView.";

/// A drawing of the scene.
struct Sketched {
    name: String,
    title: &'static str,
    caption: String,
    drawing: Drawing,
    /// Whether the mesh is drawn.
    meshed: bool,
}

/// The scene: all of it, and the surroundings of the contact; then both with the mesh, where it is
/// coarse enough to be seen.
fn scene(model: &Model, results: &Results, units: &Units) -> Result<Vec<Sketched>> {
    let plane = Some(model).filter(|model| !model.kind.is_solid());
    let Some(whole) = plane.and_then(|model| window::whole(model, [false; 2])) else {
        return Ok(Vec::new());
    };
    let near = window::near_contact(model, results, [false; 2])
        .filter(|near| !model.pairs.is_empty() && near.size()[0] < 0.6 * whole.size()[0]);
    let mut views = vec![("scene", "The whole model", whole)];
    views.extend(near.map(|near| ("contact_region", "Near the contact", near)));
    let mut out = Vec::new();
    for mesh in [false, true] {
        for &(name, title, window) in &views {
            let (drawing, meshed) = sketch::draw(model, units, window, mesh)?;
            if mesh && meshed < LEAST_MESH {
                continue;
            }
            out.push(Sketched {
                name: match mesh {
                    true => format!("{name}_mesh"),
                    false => name.to_string(),
                },
                title,
                caption: match mesh {
                    true if meshed < 1.0 => {
                        "With the mesh, without load; elements too small to be seen are left plain."
                            .to_string()
                    }
                    true => "With the mesh, without load.".to_string(),
                    false => "As given in the scene, without load.".to_string(),
                },
                drawing,
                meshed: mesh,
            });
        }
    }
    Ok(out)
}

/// The pressure over the contact of solids in the states shown.
fn contact_maps(
    model: &Model,
    results: &Results,
    units: &Units,
    figures: &mut Figures,
) -> Result<Vec<(usize, Drawing)>> {
    let touches = |state: &State| state.patches.iter().any(|patch| patch.force > 0.0);
    let Some(map) = ContactMap::new(model, &results.states, units) else {
        return Ok(Vec::new());
    };
    figures.about_pictures = OF_SOLIDS.to_string();
    let shown = fields::chosen(&results.states, MOST_STATES, touches);
    let of_interest = results.states.iter().filter(|s| touches(s)).count();
    figures.states_left_out = of_interest - shown.len();
    let drawn = shown.into_iter();
    drawn
        .map(|index| Ok((index, map.draw(&results.states[index])?)))
        .collect()
}

type Pictured = (usize, Vec<(Quantity, Drawing, bool)>);

/// The pictures of the states shown.
fn pictures(
    model: &Model,
    results: &Results,
    units: &Units,
    figures: &mut Figures,
) -> Result<Vec<Pictured>> {
    if model.kind.is_solid() {
        return Ok(Vec::new());
    }
    let mirror = window::mirrors(model);
    let Some(window) = window::near_contact(model, results, mirror) else {
        return Ok(Vec::new());
    };
    let shown = fields::chosen(&results.states, MOST_STATES, |s| s.fields.is_some());
    let with_fields = results.states.iter().filter(|s| s.fields.is_some()).count();
    figures.states_left_out = with_fields - shown.len();
    let states: Vec<&State> = shown.iter().map(|&i| &results.states[i]).collect();
    let gallery = Gallery::new(model, units, window, mirror, &states);
    figures.about_pictures = format!(
        "The deformed contour, displacements at true scale{}. Scales of colour are the same for all states where nothing else is said.",
        match mirror {
            [false, false] => "",
            [true, true] => "; mirrored at both planes of symmetry",
            _ => "; mirrored at the plane or axis of symmetry",
        }
    );
    let mut quantities = vec![Quantity::VonMises, Quantity::Pressure];
    if gallery.has_plastic_zone() {
        quantities.push(Quantity::PlasticZone);
    }
    let tasks: Vec<(usize, Quantity)> = shown
        .iter()
        .flat_map(|&state| quantities.iter().map(move |&q| (state, q)))
        .collect();
    let drawn: Vec<Option<(Drawing, bool)>> = tasks
        .par_iter()
        .map(|&(state, quantity)| {
            let fields = results.states[state].fields.as_ref();
            fields.map(|f| gallery.draw(quantity, f)).transpose()
        })
        .collect::<Result<_>>()?;
    let mut out: Vec<Pictured> = shown.iter().map(|&state| (state, Vec::new())).collect();
    for ((state, quantity), drawing) in tasks.into_iter().zip(drawn) {
        if let (Some(entry), Some((drawing, own))) =
            (out.iter_mut().find(|e| e.0 == state), drawing)
        {
            entry.1.push((quantity, drawing, own));
        }
    }
    Ok(out)
}

/// Name for the file and words for the reader.
fn words(quantity: Quantity) -> (&'static str, &'static str) {
    match quantity {
        Quantity::VonMises => ("von_mises", "Von Mises stress"),
        Quantity::Pressure => (
            "pressure",
            "Hydrostatic pressure \u{2212}(\u{3c3}\u{2081}+\u{3c3}\u{2082}+\u{3c3}\u{2083})/3 (red: compression)",
        ),
        Quantity::PlasticZone => (
            "plastic_zone",
            "Plastic zone: equivalent plastic strain where the material has yielded",
        ),
    }
}

/// The load of a state, and how much of it has yielded.
fn about(state: &State, quantity: Quantity, units: &Units) -> String {
    let load = format!("load {} {}", significant(state.load, 4), units.load());
    let load = load.trim_end().to_string();
    match quantity {
        Quantity::PlasticZone if state.plastic_points == 0 => format!("{load}: none yet."),
        Quantity::PlasticZone => format!(
            "{load}: up to {}.",
            significant(state.max_equivalent_plastic_strain, 3)
        ),
        _ => format!("{load}."),
    }
}
