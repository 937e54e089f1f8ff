//! Drawings of the scene: the whole, and the surroundings of the contact; then both with the mesh.

use super::camera::Stand;
use super::captioned::Captioned;
use super::contact_frame::ContactFrame;
use super::drawing::Drawing;
use super::perspective::Perspective;
use super::{sketch, window};
use crate::error::Result;
use crate::model::Model;
use crate::number::significant;
use crate::output::Labels;
use crate::results::Results;
use crate::space::{Vector, difference, dot, unit};

/// Smallest share of the area with visible elements for which the mesh gets a drawing.
const LEAST_MESH: f64 = 0.2;
/// Ratio of the width of the surroundings of the contact to the width of the model from which the
/// surroundings get no separate drawing.
const MOST_NEAR: f64 = 0.6;
/// Half width of the surroundings of a contact of solids, in half axes of the contact.
const REACH: f64 = 2.6;

/// A function that draws one view without or with the mesh, and returns the share of its area whose
/// mesh is visible.
type DrawView<'v> = (
    &'static str,
    &'static str,
    Box<dyn Fn(bool) -> Result<(Drawing, f64)> + 'v>,
);

/// Draws the scene without the mesh, and with it if it is coarse enough to be visible.
///
/// # Errors
/// `Internal` if a drawing fails.
pub(super) fn draw(
    model: &Model,
    results: &Results,
    labels: &Labels,
    frame: Option<&ContactFrame>,
) -> Result<[Vec<Captioned>; 2]> {
    let (views, about) = match model.kind.is_solid() {
        true => (solid(model, frame), size(model, labels)),
        false => (
            plane(model, results, labels),
            "As given in the scene, without load.".to_string(),
        ),
    };
    let mut out = [Vec::new(), Vec::new()];
    for mesh in [false, true] {
        for (name, title, draw) in &views {
            let (drawing, share) = draw(mesh)?;
            if mesh && share < LEAST_MESH {
                continue;
            }
            let caption = match mesh {
                true if share < 1.0 => {
                    "With the mesh, without load; elements too small to be seen are left plain."
                }
                true => "With the mesh, without load.",
                false => about.as_str(),
            };
            out[usize::from(mesh)].push(Captioned {
                name: format!("{name}{}", if mesh { "_mesh" } else { "" }),
                title: title.to_string(),
                caption: caption.to_string(),
                drawing,
            });
        }
    }
    Ok(out)
}

const WHOLE: [&str; 2] = ["scene", "The whole model"];
const NEAR: [&str; 2] = ["contact_region", "Near the contact"];

fn plane<'v>(model: &'v Model, results: &Results, labels: &'v Labels) -> Vec<DrawView<'v>> {
    let Some(whole) = window::whole(model, [false; 2]) else {
        return Vec::new();
    };
    let near = window::near_contact(model, results, [false; 2])
        .filter(|near| !model.pairs.is_empty() && near.size()[0] < MOST_NEAR * whole.size()[0]);
    let windows = [(WHOLE, Some(whole)), (NEAR, near)];
    let views = windows
        .into_iter()
        .filter_map(|(words, window)| Some((words, window?)));
    views
        .map(|([name, title], window)| -> DrawView {
            let draw = move |mesh| sketch::draw(model, labels, window, mesh);
            (name, title, Box::new(draw))
        })
        .collect()
}

fn solid<'v>(model: &'v Model, frame: Option<&ContactFrame>) -> Vec<DrawView<'v>> {
    let (up, across) = frame.map_or((unit(2), [unit(0), unit(1)]), |f| (f.up, f.axes));
    let stand = Stand::new(model, up, across);
    let [low, high] = window::extent(model);
    let width = difference(high, low).into_iter().fold(0.0, f64::max);
    let near = frame.and_then(|frame| {
        let reach = REACH * frame.reach[0].max(frame.reach[1]);
        let is_near = |x: Vector| {
            let way = difference(x, frame.center);
            [frame.axes[0], frame.axes[1], up]
                .iter()
                .all(|axis| dot(*axis, way).abs() <= reach)
        };
        let is_smaller = 2.0 * reach < MOST_NEAR * width;
        is_smaller.then(|| Perspective::new(model, &stand, is_near))?
    });
    let whole = Perspective::new(model, &stand, |_| true);
    let views = [(WHOLE, whole), (NEAR, near)].into_iter();
    views
        .filter_map(|([name, title], view)| {
            let view = view?;
            let draw = move |mesh| view.draw(model.kind.axes(), mesh);
            Some((name, title, Box::new(draw) as Box<_>))
        })
        .collect()
}

/// Describes the size of the model, which a perspective does not show.
fn size(model: &Model, labels: &Labels) -> String {
    let [low, high] = window::extent(model);
    let sides = difference(high, low).map(|side| significant(side, 3));
    let halves = (0..3).filter(|&d| window::mirrors(model)[d]).count();
    let planes = match halves {
        0 => "",
        1 => "; the plane of symmetry faces the reader",
        _ => "; the planes of symmetry face the reader",
    };
    format!(
        "In perspective, without load{planes}. The whole is {} {}.",
        sides.join(" \u{d7} "),
        labels.length()
    )
    .replace(" .", ".")
}
