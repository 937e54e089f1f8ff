//! Colours by their role: fixed in the file of a figure, CSS variables in the page, so that one
//! drawing is legible on a light and on a dark background and on paper.

use plotters::style::RGBColor;

/// Colour of text and axes.
pub(super) const INK: RGBColor = RGBColor(0x1c, 0x21, 0x28);
/// Colour of secondary lines: grid, reference lines.
pub(super) const FAINT: RGBColor = RGBColor(0x8a, 0x93, 0x9e);
/// Colour of the background.
pub(super) const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xfe);
/// Colours of curves, in order: they also differ in lightness, for readers who cannot distinguish
/// all hues.
pub(super) const CURVES: [RGBColor; 8] = [
    RGBColor(0x1f, 0x62, 0xad),
    RGBColor(0xc4, 0x44, 0x2f),
    RGBColor(0x2a, 0x86, 0x55),
    RGBColor(0xc9, 0x80, 0x12),
    RGBColor(0x7b, 0x4f, 0xb0),
    RGBColor(0x12, 0x8a, 0x98),
    RGBColor(0xb0, 0x3a, 0x7c),
    RGBColor(0x5d, 0x67, 0x73),
];

/// Name of a colour, with its light and its dark value.
struct Role {
    name: &'static str,
    light: RGBColor,
    dark: &'static str,
}

const ROLES: [Role; 11] = [
    role("ink", INK, "#e4e8ed"),
    role("faint", FAINT, "#7d8794"),
    role("paper", PAPER, "#181c22"),
    role("curve-1", CURVES[0], "#6cabf2"),
    role("curve-2", CURVES[1], "#f0806a"),
    role("curve-3", CURVES[2], "#63c793"),
    role("curve-4", CURVES[3], "#f0b24c"),
    role("curve-5", CURVES[4], "#b794ec"),
    role("curve-6", CURVES[5], "#56c6d3"),
    role("curve-7", CURVES[6], "#ea83ba"),
    role("curve-8", CURVES[7], "#a9b3bf"),
];

const fn role(name: &'static str, light: RGBColor, dark: &'static str) -> Role {
    Role { name, light, dark }
}

/// Formats a colour as `#RRGGBB`, as the drawing library writes it.
pub(super) fn hex(color: RGBColor) -> String {
    format!("#{:02X}{:02X}{:02X}", color.0, color.1, color.2)
}

/// Replaces the values of the colours of a drawing by their names.
pub(super) fn themed(svg: &str) -> String {
    ROLES.iter().fold(svg.to_string(), |text, role| {
        text.replace(
            &format!("\"{}\"", hex(role.light)),
            &format!("\"var(--{})\"", role.name),
        )
    })
}

/// Returns the CSS variables: light values, and dark values if the reader prefers them and the page
/// is not printed.
pub(super) fn variables() -> String {
    let list = |dark: bool| -> String {
        let value = |role: &Role| match dark {
            true => role.dark.to_string(),
            false => hex(role.light),
        };
        ROLES
            .iter()
            .map(|role| format!("--{}:{};", role.name, value(role)))
            .collect()
    };
    format!(
        ":root{{color-scheme:light dark;{}}}\n@media screen and (prefers-color-scheme: \
         dark){{:root{{{}}}}}\n",
        list(false),
        list(true)
    )
}

/// A scale of colours from low to high.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scale {
    /// From dark blue to yellow (viridis), for a quantity that is never negative.
    Rising,
    /// Blue below zero, red above zero.
    Diverging,
    /// From pale yellow to dark red, for a quantity that is zero in most places.
    Heat,
}

impl Scale {
    /// Returns the colour of `value` if values run from `low` to `high`.
    pub(super) fn color(self, value: f64, low: f64, high: f64) -> RGBColor {
        const RISING: [[u8; 3]; 9] = [
            [68, 1, 84],
            [71, 44, 122],
            [59, 81, 139],
            [44, 113, 142],
            [33, 144, 141],
            [39, 173, 129],
            [92, 200, 99],
            [170, 220, 50],
            [253, 231, 37],
        ];
        const DIVERGING: [[u8; 3]; 9] = [
            [33, 82, 156],
            [67, 133, 195],
            [134, 184, 219],
            [199, 220, 236],
            [244, 243, 241],
            [250, 210, 187],
            [236, 150, 119],
            [207, 78, 70],
            [150, 16, 42],
        ];
        const HEAT: [[u8; 3]; 7] = [
            [254, 229, 145],
            [254, 204, 92],
            [253, 170, 65],
            [246, 123, 46],
            [224, 74, 30],
            [178, 32, 28],
            [112, 6, 32],
        ];
        let share = match self {
            Scale::Diverging => 0.5 + 0.5 * value / low.abs().max(high.abs()),
            _ => (value - low) / (high - low),
        };
        match self {
            Scale::Rising => between(&RISING, share),
            Scale::Diverging => between(&DIVERGING, share),
            Scale::Heat => between(&HEAT, share),
        }
    }
}

fn between(stops: &[[u8; 3]], share: f64) -> RGBColor {
    let share = if share.is_nan() { 0.0 } else { share };
    let place = share.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let first = (place as usize).min(stops.len().saturating_sub(2));
    let part = place - first as f64;
    let [r, g, b] = std::array::from_fn(|k| {
        let (a, b) = (f64::from(stops[first][k]), f64::from(stops[first + 1][k]));
        (a + part * (b - a)).round() as u8
    });
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_role_has_a_colour_of_its_own() {
        for (i, a) in ROLES.iter().enumerate() {
            for b in &ROLES[i + 1..] {
                assert_ne!(hex(a.light), hex(b.light), "{} and {}", a.name, b.name);
            }
        }
    }

    #[test]
    fn a_scale_runs_from_end_to_end() {
        for scale in [Scale::Rising, Scale::Diverging, Scale::Heat] {
            let color = |v| scale.color(v, -2.0, 2.0);
            assert_ne!(color(-2.0), color(2.0));
            assert_eq!(color(-5.0), color(-2.0));
            assert_eq!(color(5.0), color(2.0));
        }
        // Zero is neutral, even if all values lie on one side of it.
        assert_eq!(
            Scale::Diverging.color(0.0, 0.0, 3.0),
            RGBColor(244, 243, 241)
        );
        assert_eq!(Scale::Rising.color(f64::NAN, 0.0, 1.0), RGBColor(68, 1, 84));
    }
}
