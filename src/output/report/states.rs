//! The pictures of the states: the choice of states and fields, and their captions.

use super::captioned::Captioned;
use super::contact_frame::{ContactFrame, global};
use super::contact_map::ContactMap;
use super::fields::{self, ShownField, StatePicture, View, chosen};
use super::magnified;
use super::patchwork::{Patchwork, seen};
use super::section::SectionPlane;
use super::window::{self, mirrors, negligible};
use crate::error::Result;
use crate::model::Model;
use crate::number::significant;
use crate::output::Labels;
use crate::results::{Fields, Results, State};
use crate::space::unit;

/// Largest number of states whose pictures the page shows.
const MOST_STATES: usize = 4;
/// Beginning of the names of pictures of magnified shapes.
pub(super) const MAGNIFIED: &str = "magnified";

/// The pictures of a run.
pub(super) struct Pictures {
    /// Index and pictures of each state shown.
    pub states: Vec<(usize, Vec<Captioned>)>,
    /// Number of states of interest that are not shown.
    pub left_out: usize,
    /// Text about all pictures.
    pub about: String,
}

/// Draws the states of a run.
///
/// # Errors
/// `Internal` if a picture cannot be drawn.
pub(super) fn draw(
    model: &Model,
    results: &Results,
    labels: &Labels,
    frame: Option<&ContactFrame>,
) -> Result<Pictures> {
    let touches = |state: &State| state.patches.iter().any(|patch| patch.force > 0.0);
    let is_of_interest = |state: &State| state.fields.is_some() || touches(state);
    let shown = chosen(&results.states, MOST_STATES, is_of_interest);
    let with_fields: Vec<(usize, &Fields)> = shown
        .iter()
        .filter_map(|&index| Some((index, results.states[index].fields.as_ref()?)))
        .collect();
    let views = views(model, results, labels, frame, &with_fields);
    let quantities: &[ShownField] = match model.kind.is_solid() {
        true => &[ShownField::VonMises],
        false => &[
            ShownField::VonMises,
            ShownField::Pressure,
            ShownField::PlasticZone,
        ],
    };
    let yields = |(_, fields): &(usize, &Fields)| fields.yielded.iter().any(|y| *y > 0);
    let any_yields = with_fields.iter().any(yields);
    let quantities: Vec<ShownField> = (quantities.iter().copied())
        .filter(|q| *q != ShownField::PlasticZone || any_yields)
        .collect();
    let drawn = fields::draw(&model.mesh, labels, &views, &with_fields, &quantities)?;
    let map =
        frame.and_then(|f| ContactMap::new(model, f, mirrors(model), &results.states, labels));
    let mut states: Vec<(usize, Vec<Captioned>)> = Vec::new();
    for &index in &shown {
        let state = &results.states[index];
        let mut pictures = Vec::new();
        if let Some(map) = map.as_ref().filter(|_| touches(state)) {
            pictures.push(Captioned {
                name: named(index, "contact_pressure"),
                title: String::new(),
                caption: format!("Contact pressure, {}.", load(state, labels)),
                drawing: map.draw(state)?,
            });
        }
        states.push((index, pictures));
    }
    for picture in drawn {
        let state = &results.states[picture.state];
        if let Some(entry) = states.iter_mut().find(|entry| entry.0 == picture.state) {
            entry.1.push(captioned(picture, state, &views, labels));
        }
    }
    for (index, fields) in &with_fields {
        for view in &views {
            let picture = magnified::draw(&model.mesh, view, fields)?;
            let entry = states.iter_mut().find(|entry| entry.0 == *index);
            if let (Some((drawing, times)), Some(entry)) = (picture, entry) {
                entry.1.push(Captioned {
                    name: named(*index, &format!("{MAGNIFIED}{}", view.name)),
                    title: String::new(),
                    caption: magnified::caption(
                        view,
                        times,
                        &load(&results.states[*index], labels),
                    ),
                    drawing,
                });
            }
        }
    }
    states.retain(|(_, pictures)| !pictures.is_empty());
    let of_interest = results.states.iter().filter(|s| is_of_interest(s)).count();
    Ok(Pictures {
        left_out: of_interest - shown.len(),
        about: about(model, map.is_some(), !views.is_empty()),
        states,
    })
}

/// Returns the name of a picture of a state.
fn named(state: usize, what: &str) -> String {
    format!("state_{:02}_{what}", state + 1)
}

/// Returns the part of a picture's name that is the same for all states.
pub(super) fn of_state(name: &str) -> &str {
    let after = name.strip_prefix("state_");
    after
        .and_then(|rest| rest.split_once('_'))
        .map_or(name, |(_, what)| what)
}

/// Returns the plane of a plane model, or the cuts through the contact of a solid one.
fn views(
    model: &Model,
    results: &Results,
    labels: &Labels,
    frame: Option<&ContactFrame>,
    states: &[(usize, &Fields)],
) -> Vec<View> {
    let mesh = &model.mesh;
    let halves = mirrors(model);
    let displacements: Vec<&[f64]> = states.iter().map(|(_, f)| &f.displacement[..]).collect();
    if states.is_empty() {
        return Vec::new();
    }
    if !model.kind.is_solid() {
        let mirror = [halves[0], halves[1]];
        let Some(window) = window::near_contact(model, results, mirror) else {
            return Vec::new();
        };
        let elements = seen(mesh, [unit(0), unit(1)], window, mirror, &displacements);
        let patchwork = Patchwork::of_plane(mesh, &elements);
        return vec![View {
            name: "",
            words: String::new(),
            patchwork: patchwork.mirrored(mesh, mirror, negligible(model)),
            window,
            labels: labels.axes(model.kind),
        }];
    }
    let Some(frame) = frame else {
        return Vec::new();
    };
    let cuts = SectionPlane::both(frame)
        .into_iter()
        .zip(["_section_1", "_section_2"])
        .enumerate();
    cuts.filter_map(|(axis, (cut, name))| {
        let mirror = cut.axes.map(|axis| global(axis).is_some_and(|d| halves[d]));
        let window = frame.window(model, axis, mirror)?;
        let patchwork = cut.pieces(mesh, window, mirror, &displacements);
        let labels = cut.axes.map(|axis| ContactFrame::label(axis, labels));
        let words = match global(cut.axes[0]) {
            Some(d) => format!(" in the section along {}", ["x", "y", "z"][d]),
            None if axis == 0 => " in the section along the longer half axis".to_string(),
            None => " in the section along the shorter half axis".to_string(),
        };
        (!patchwork.is_empty()).then(|| View {
            name,
            words,
            patchwork: patchwork.mirrored(mesh, mirror, negligible(model)),
            window,
            labels,
        })
    })
    .collect()
}

fn about(model: &Model, has_map: bool, has_fields: bool) -> String {
    let mut out = String::new();
    if has_map {
        out.push_str(
            "Pressure over the contact that carries most, seen along its normal; the line is the \
             ellipse of the half axes. ",
        );
    }
    if has_fields && model.kind.is_solid() {
        out.push_str(
            "Sections through the middle of this contact, along the axes of the contact and its \
             normal. ",
        );
    }
    if has_fields {
        out.push_str("The deformed contour, displacements at true scale; ");
        if mirrors(model).contains(&true) {
            out.push_str("mirrored at planes or the axis of symmetry; ");
        }
        out.push_str(
            "the ring marks the largest value. A double line is the border of the plastic zone. \
             Scales of colour are the same for all states where nothing else is said.",
        );
    }
    out
}

fn load(state: &State, labels: &Labels) -> String {
    let load = format!("load {} {}", significant(state.load, 4), labels.load());
    load.trim_end().to_string()
}

fn captioned(picture: StatePicture, state: &State, views: &[View], labels: &Labels) -> Captioned {
    let view = &views[picture.view];
    let (name, words) = match picture.quantity {
        ShownField::VonMises => ("von_mises", "Von Mises stress"),
        ShownField::Pressure => (
            "pressure",
            "Hydrostatic pressure \u{2212}(\u{3c3}\u{2081}+\u{3c3}\u{2082}+\u{3c3}\u{2083})/3 \
             (red: compression)",
        ),
        ShownField::PlasticZone => (
            "plastic_zone",
            "Plastic zone: equivalent plastic strain where the material has yielded",
        ),
    };
    let strain = match picture.quantity {
        ShownField::PlasticZone if state.plastic_points == 0 => ": none yet".to_string(),
        ShownField::PlasticZone => format!(
            ": up to {}",
            significant(state.max_equivalent_plastic_strain, 3)
        ),
        _ => String::new(),
    };
    let own = match picture.has_own_scale {
        true => " Colours on a scale of their own.",
        false => "",
    };
    Captioned {
        name: named(picture.state, &format!("{name}{}", view.name)),
        title: String::new(),
        caption: format!(
            "{words}{}, {}{strain}.{own}",
            view.words,
            load(state, labels)
        ),
        drawing: picture.drawing,
    }
}
