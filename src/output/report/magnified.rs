//! The deformed contour, with displacements magnified until they are visible.

use super::drawing::{Drawing, nice_step};
use super::fields::View;
use super::picture::Picture;
use super::theme::{FAINT, INK};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::number::trimmed;
use crate::results::Fields;

/// Largest displacement that is shown, over the width of the picture.
const SHARE: f64 = 0.1;
/// Smallest magnification that is drawn: if less is needed, the true scale shows the displacements.
const LEAST: f64 = 2.0;

/// Draws the contour of a view in a state over the undeformed one, and returns the drawing with its
/// magnification; `None` if nothing moves or true scale shows it.
///
/// # Errors
/// `Internal` if it cannot be drawn.
pub(super) fn draw(mesh: &Mesh, view: &View, fields: &Fields) -> Result<Option<(Drawing, f64)>> {
    let patchwork = &view.patchwork;
    let at_rest = patchwork.places(mesh, None);
    let moved = patchwork.places(mesh, Some(&fields.displacement));
    let seen = at_rest
        .iter()
        .zip(&moved)
        .filter(|(place, _)| view.window.sees(&[**place]));
    let largest = seen
        .map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1]))
        .fold(0.0, f64::max);
    let Some(times) = magnification(largest, view.window.size()[0]) else {
        return Ok(None);
    };
    let displacement: Vec<f64> = fields.displacement.iter().map(|u| times * u).collect();
    let contour = |places: Vec<[f64; 2]>| {
        let nothing = vec![0.0; places.len()];
        patchwork.sheet(places, nothing).above(f64::NEG_INFINITY)
    };
    let before = contour(at_rest);
    let after = contour(patchwork.places(mesh, Some(&displacement)));
    let mut picture = Picture::new(view.window);
    picture.fill(&after, FAINT, 0.25);
    picture.outline(before, FAINT, 0.9);
    picture.outline(after, INK, 1.2);
    let labels = [view.labels[0].as_str(), view.labels[1].as_str()];
    Ok(Some((picture.finish(labels, None, |_| Ok(()))?, times)))
}

/// Returns the magnification, a round number; `None` if it is below [`LEAST`] or nothing moves.
fn magnification(largest: f64, width: f64) -> Option<f64> {
    let most = SHARE * width / largest;
    // The next nice number above half of `most` is at most `most`.
    let times = nice_step(0.5 * most, 1);
    (largest > 0.0 && most.is_finite() && times >= LEAST).then_some(times)
}

/// Caption of a picture of the deformed bodies.
pub(super) fn caption(view: &View, times: f64, load: &str) -> String {
    format!(
        "Deformed contour{}, displacements {} times as large, {load}; grey: undeformed. Bodies \
         overlap in it where a gap has closed.",
        view.words,
        trimmed(times, 3)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacements_are_magnified_to_a_twentieth_of_the_width_at_least() {
        for largest in [1e-6, 3.3e-4, 0.02] {
            let times = magnification(largest, 10.0).unwrap();
            assert!(
                (0.05 * (1.0 - 1e-9)..=0.1 * (1.0 + 1e-9)).contains(&(times * largest / 10.0)),
                "{largest}: {times}"
            );
        }
        assert_eq!(magnification(0.9, 10.0), None);
        assert_eq!(magnification(0.0, 10.0), None);
    }
}
