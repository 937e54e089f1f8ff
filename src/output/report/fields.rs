//! Pictures of a state: von Mises stress, pressure, plastic zone, on the deformed contour.

use super::bands::Bands;
use super::drawing::Drawing;
use super::picture::Picture;
use super::theme::Scale;
use super::units::Units;
use super::window::Window;
use crate::error::Result;
use crate::model::Model;
use crate::results::{Fields, State};
use plotters::style::RGBColor;

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Von Mises stress.
    VonMises,
    /// Mean pressure `-(s_xx + s_yy + s_zz)/3`, compressive positive.
    Pressure,
    /// Equivalent plastic strain of the elements that have yielded.
    PlasticZone,
}

impl Quantity {
    /// Its value in an element.
    fn of(self, fields: &Fields, element: usize) -> f64 {
        match self {
            Quantity::VonMises => fields.von_mises[element],
            Quantity::Pressure => {
                let s = &fields.stress[4 * element..4 * element + 3];
                -(s[0] + s[1] + s[2]) / 3.0
            }
            Quantity::PlasticZone => fields.plastic_strain[element],
        }
    }

    /// Whether it is shown in this element.
    fn is_shown(self, fields: &Fields, element: usize) -> bool {
        self != Quantity::PlasticZone || fields.yielded[element] > 0
    }

    fn scale(self) -> Scale {
        match self {
            Quantity::VonMises => Scale::Rising,
            Quantity::Pressure => Scale::Diverging,
            Quantity::PlasticZone => Scale::Heat,
        }
    }

    fn unit(self, units: &Units) -> &str {
        match self {
            Quantity::PlasticZone => "strain",
            _ => units.stress(),
        }
    }
}

/// What all pictures of a run share, so that they can be compared: window and scales.
pub(super) struct Gallery<'a> {
    model: &'a Model,
    units: &'a Units,
    window: Window,
    mirror: [bool; 2],
    /// Smallest and largest value of each quantity over all states shown.
    common: Ranges,
}

/// Smallest and largest value of each quantity.
type Ranges = [[f64; 2]; 3];

/// A state whose values reach less than this share of the largest ones has a scale of its own:
/// residual stresses are to be seen.
const FAINT: f64 = 0.3;

impl<'a> Gallery<'a> {
    /// Takes the measure of some states.
    pub(super) fn new(
        model: &'a Model,
        units: &'a Units,
        window: Window,
        mirror: [bool; 2],
        states: &[&State],
    ) -> Self {
        let mut gallery = Gallery {
            model,
            units,
            window,
            mirror,
            common: [[0.0; 2]; 3],
        };
        for fields in states.iter().filter_map(|state| state.fields.as_ref()) {
            let ranges = gallery.ranges(fields);
            for (all, one) in gallery.common.iter_mut().zip(ranges) {
                *all = [all[0].min(one[0]), all[1].max(one[1])];
            }
        }
        gallery
    }

    /// The ranges of a state's values in the window, zero always within.
    fn ranges(&self, fields: &Fields) -> Ranges {
        let mut ranges = [[0.0f64; 2]; 3];
        let picture = self.picture(fields);
        for element in picture.visible() {
            for quantity in [
                Quantity::VonMises,
                Quantity::Pressure,
                Quantity::PlasticZone,
            ] {
                let value = quantity.of(fields, element);
                if value.is_finite() && quantity.is_shown(fields, element) {
                    let range = &mut ranges[quantity as usize];
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        ranges
    }

    fn picture<'f>(&self, fields: &'f Fields) -> Picture<'f>
    where
        'a: 'f,
    {
        let mesh = &self.model.mesh;
        Picture::new(mesh, Some(&fields.displacement), self.window, self.mirror)
    }

    /// Whether any state shown has yielded in the window.
    pub(super) fn has_plastic_zone(&self) -> bool {
        self.common[Quantity::PlasticZone as usize][1] > 0.0
    }

    /// The scale of a quantity in a state, and whether it is this state's own.
    fn range(&self, quantity: Quantity, fields: &Fields) -> ([f64; 2], bool) {
        let common = self.common[quantity as usize];
        if quantity == Quantity::PlasticZone {
            return (common, false);
        }
        let own = self.ranges(fields)[quantity as usize];
        let size = |r: [f64; 2]| r[0].abs().max(r[1].abs());
        if size(own) > 0.0 && size(own) < FAINT * size(common) {
            (own, true)
        } else {
            (common, false)
        }
    }

    /// The picture of a quantity in a state, and whether its scale is not that of the other states.
    ///
    /// # Errors
    /// `Internal` where it cannot be drawn.
    pub(super) fn draw(&self, quantity: Quantity, fields: &Fields) -> Result<(Drawing, bool)> {
        let mesh = &self.model.mesh;
        let mut picture = self.picture(fields);
        let neutral = picture.palette.add(RGBColor(0x9a, 0xa5, 0xb1), 0.35);
        let ink = picture.palette.add(RGBColor(0x3a, 0x42, 0x4c), 1.0);
        let (range, own) = self.range(quantity, fields);
        let unit = quantity.unit(self.units);
        let bands = Bands::new(range, quantity.scale(), unit, &mut picture.palette);
        let visible = picture.visible();
        let smooth = nodal_means(self.model, fields, quantity, &visible);
        for &element in &visible {
            // Parts are bodies, and in the plastic picture zones of bodies: their borders are
            // drawn.
            let body = mesh.element_body[element] as u16;
            if quantity.is_shown(fields, element) {
                let zone = u16::from(quantity == Quantity::PlasticZone);
                let value = quantity.of(fields, element);
                picture.element(
                    element,
                    2 * body + 1 + zone,
                    |node| smooth[node],
                    value,
                    |v| bands.index(v),
                );
            } else {
                picture.element(element, 2 * body + 1, |_| 0.0, 0.0, |_| neutral);
            }
        }
        picture.raster.outline(1, ink);
        for contact in &self.model.contacts {
            for pairs in self.model.pairs[contact.range.clone()].windows(2) {
                picture.crack([&pairs[0], &pairs[1]], ink);
            }
        }
        let labels = self.units.axes(self.model.kind);
        let drawing = picture.finish([&labels[0], &labels[1]], Some(&bands), |_| Ok(()))?;
        Ok((drawing, own))
    }
}

/// Means at the nodes of the values of the elements round them: smooth contours. Zero where no
/// element is shown.
fn nodal_means(model: &Model, fields: &Fields, quantity: Quantity, elements: &[usize]) -> Vec<f64> {
    let mut sums = vec![0.0; model.mesh.n_nodes()];
    let mut counts = vec![0u32; model.mesh.n_nodes()];
    for &element in elements {
        if quantity.is_shown(fields, element) {
            let value = quantity.of(fields, element);
            for &node in model.mesh.nodes(element) {
                sums[node as usize] += value;
                counts[node as usize] += 1;
            }
        }
    }
    for (sum, &count) in sums.iter_mut().zip(&counts) {
        *sum /= f64::from(count.max(1));
    }
    sums
}

/// States to show: at most `most` of those of interest, the first, the one with the largest load
/// and the last among them.
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
    // Then, again and again, the one in the middle of the widest hole.
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
