//! Pictures of a state: von Mises stress, pressure, plastic zone, on the deformed contour of a
//! plane model or of a cut through a solid.

use super::bands::Bands;
use super::contours::TriangleSheet;
use super::drawing::{Drawing, tick};
use super::patchwork::Patchwork;
use super::picture::Picture;
use super::theme::{INK, PAPER, Scale};
use super::window::Window;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::number::significant;
use crate::output::Labels;
use crate::results::{Fields, State};
use plotters::style::RGBColor;
use rayon::prelude::*;

/// A field that a picture can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShownField {
    /// Von Mises stress.
    VonMises,
    /// Mean pressure `-(s_xx + s_yy + s_zz)/3`, compressive positive.
    Pressure,
    /// Equivalent plastic strain in the elements that have yielded.
    PlasticZone,
}

impl ShownField {
    /// Returns the value of the field in an element.
    fn of(self, mesh: &Mesh, fields: &Fields, element: usize) -> f64 {
        match self {
            ShownField::VonMises => fields.von_mises[element],
            ShownField::Pressure => {
                let s = &fields.stress[2 * mesh.dimension * element..][..3];
                -(s[0] + s[1] + s[2]) / 3.0
            }
            ShownField::PlasticZone => fields.plastic_strain[element],
        }
    }

    fn scale(self) -> Scale {
        match self {
            ShownField::VonMises => Scale::Rising,
            ShownField::Pressure => Scale::Diverging,
            ShownField::PlasticZone => Scale::Heat,
        }
    }

    fn unit(self, labels: &Labels) -> &str {
        match self {
            ShownField::PlasticZone => "strain",
            _ => labels.stress(),
        }
    }
}

/// A plane that pictures show.
pub(super) struct View {
    /// Short name, for files; may be empty.
    pub name: &'static str,
    /// Description of the plane, for captions; may be empty.
    pub words: String,
    /// Triangles of the plane, mirror images included.
    pub patchwork: Patchwork,
    /// Window of the plane that is shown.
    pub window: Window,
    /// Labels of the axes of the plane.
    pub labels: [String; 2],
}

/// A picture of a state.
pub(super) struct StatePicture {
    /// Index of the state.
    pub state: usize,
    /// Index of the view.
    pub view: usize,
    /// Field that the picture shows.
    pub quantity: ShownField,
    /// The picture itself.
    pub drawing: Drawing,
    /// Whether the scale of the picture differs from that of the other states.
    pub has_own_scale: bool,
}

/// A state whose values reach less than this fraction of the largest ones gets a scale of its own,
/// so that residual stresses are visible.
const FAINT: f64 = 0.3;
/// Fraction of the yielded elements round a node at which the border of the plastic zone is drawn.
const ZONE: f64 = 0.5;
/// Colour of bodies on which no values are shown.
const NEUTRAL: RGBColor = RGBColor(0x9a, 0xa5, 0xb1);

/// Values of a quantity in a state on a view, and the share of the elements round each point that
/// have yielded.
struct ViewValues<'v> {
    state: usize,
    view: usize,
    quantity: ShownField,
    sheet: TriangleSheet<'v>,
    zone: Vec<f64>,
}

/// Draws the quantities in the states on the views. Each quantity has the same scale in all states.
///
/// # Errors
/// `Internal` if one cannot be drawn.
pub(super) fn draw(
    mesh: &Mesh,
    labels: &Labels,
    views: &[View],
    states: &[(usize, &Fields)],
    quantities: &[ShownField],
) -> Result<Vec<StatePicture>> {
    let tasks: Vec<_> = states
        .iter()
        .flat_map(|state| (0..views.len()).map(move |view| (state, view)))
        .flat_map(|(state, view)| quantities.iter().map(move |&q| (state, view, q)))
        .collect();
    let values: Vec<ViewValues> = tasks
        .into_par_iter()
        .map(|(&(state, fields), view, quantity)| {
            let patchwork = &views[view].patchwork;
            let places = patchwork.places(mesh, Some(&fields.displacement));
            let values = patchwork.of_elements(mesh, |e| quantity.of(mesh, fields, e));
            ViewValues {
                state,
                view,
                quantity,
                sheet: patchwork.sheet(places, values),
                zone: patchwork.of_elements(mesh, |e| f64::from(fields.yielded[e].min(1))),
            }
        })
        .collect();
    let range = |values: &ViewValues| {
        let window = views[values.view].window;
        let shown = values.sheet.places.iter().zip(&values.sheet.values);
        let shown = shown.filter(|(place, value)| value.is_finite() && window.sees(&[**place]));
        // The range always contains zero.
        shown.fold([0.0f64; 2], |[low, high], (_, v)| {
            [low.min(*v), high.max(*v)]
        })
    };
    let ranges: Vec<[f64; 2]> = values.iter().map(range).collect();
    let drawn = values.par_iter().zip(&ranges).map(|(shown, own)| {
        let alike = values
            .iter()
            .zip(&ranges)
            .filter(|(v, _)| v.quantity == shown.quantity);
        let common = alike.fold([0.0f64; 2], |all, (_, r)| {
            [all[0].min(r[0]), all[1].max(r[1])]
        });
        let size = |r: [f64; 2]| r[0].abs().max(r[1].abs());
        let has_own_scale = shown.quantity != ShownField::PlasticZone
            && size(*own) > 0.0
            && size(*own) < FAINT * size(common);
        let range = if has_own_scale { *own } else { common };
        let drawing = draw_one(labels, &views[shown.view], shown, range)?;
        Ok(StatePicture {
            state: shown.state,
            view: shown.view,
            quantity: shown.quantity,
            drawing,
            has_own_scale,
        })
    });
    drawn.collect()
}

fn draw_one(labels: &Labels, view: &View, shown: &ViewValues, range: [f64; 2]) -> Result<Drawing> {
    let quantity = shown.quantity;
    let sheet = &shown.sheet;
    let bands = Bands::new(range, quantity.scale(), quantity.unit(labels));
    let zone = TriangleSheet {
        places: sheet.places.clone(),
        values: shown.zone.clone(),
        ..*sheet
    };
    let zone = zone.above(ZONE);
    let mut picture = Picture::new(view.window);
    let all = sheet.above(f64::NEG_INFINITY);
    // Each band extends under the band above it, so that no background shows through between two
    // bands.
    let is_zone = quantity == ShownField::PlasticZone;
    if is_zone {
        picture.fill(&all, NEUTRAL, 0.35);
    }
    for (band, (level, color)) in bands.levels().enumerate() {
        let above = sheet.above(level);
        let rings = match (band, is_zone) {
            (0, true) => &zone,
            (0, false) => &all,
            _ => &above,
        };
        picture.fill_told(rings, color, 1.0, &bands.words(band));
    }
    picture.outline(all, INK, 0.9);
    if is_zone {
        picture.outline(zone, INK, 0.9);
    } else if quantity == ShownField::VonMises {
        picture.outline(zone.clone(), INK, 2.6);
        picture.outline(zone, PAPER, 1.3);
    }
    if let Some(top) = sheet
        .largest(|p| view.window.sees(&[p]))
        .filter(|&k| sheet.values[k] > 0.0)
    {
        let value = tick(rounded(sheet.values[top]));
        picture.mark(sheet.places[top], &value);
    }
    let labels = [view.labels[0].as_str(), view.labels[1].as_str()];
    picture.finish(labels, Some(&bands), |_| Ok(()))
}

/// Rounds a value to three digits.
fn rounded(value: f64) -> f64 {
    significant(value, 3).parse().unwrap_or(value)
}

/// Chooses the states to show: at most `most` of the states of interest, among them the first, the
/// one with the largest load and the last.
pub(super) fn chosen(
    states: &[State],
    most: usize,
    of_interest: impl Fn(&State) -> bool,
) -> Vec<usize> {
    let with: Vec<usize> = (0..states.len())
        .filter(|&i| of_interest(&states[i]))
        .collect();
    if with.len() <= most {
        return with;
    }
    let by_load = |a: &&usize, b: &&usize| states[**a].load.total_cmp(&states[**b].load);
    let mut out: Vec<usize> = [with.last(), with.iter().max_by(by_load), with.first()]
        .into_iter()
        .flatten()
        .copied()
        .take(most)
        .collect();
    out.sort_unstable();
    out.dedup();
    // Then the state in the middle of the widest gap is added repeatedly.
    while out.len() < most {
        let holes = out.windows(2).map(|pair| {
            let inside: Vec<usize> = with
                .iter()
                .copied()
                .filter(|i| (pair[0] + 1..pair[1]).contains(i))
                .collect();
            inside
        });
        let Some(hole) = holes.max_by_key(Vec::len).filter(|hole| !hole.is_empty()) else {
            break;
        };
        out.push(hole[hole.len() / 2]);
        out.sort_unstable();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_last_and_highest_state_are_shown() {
        let states = |loads: &[f64]| -> Vec<State> {
            loads
                .iter()
                .map(|&load| State {
                    load,
                    fields: Some(Fields::default()),
                    ..State::default()
                })
                .collect()
        };
        let shown = |state: &State| state.fields.is_some();
        let list = chosen(&states(&[1.0, 2.0, 3.0, 9.0, 3.0, 2.0, 1.0, 0.0]), 4, shown);
        assert_eq!(list.len(), 4);
        assert!([0, 3, 7].iter().all(|i| list.contains(i)), "{list:?}");
        assert_eq!(chosen(&states(&[1.0, 2.0]), 4, shown), [0, 1]);
        assert!(chosen(&[State::default()], 4, shown).is_empty());
        assert_eq!(chosen(&states(&[1.0; 9]), 1, shown).len(), 1);
    }
}
