//! The scene of a roller of finite length, with a profile along its axis, on a race (a quarter, in
//! three dimensions): blocks whose gap has the roller's shape.

use super::asked::Asked;
use super::materials::{Made, section};
use super::text::{HEAD, UNITS, toml};
use clap::ValueEnum;
use std::f64::consts::PI;

/// Default number of elements over the half width.
pub(super) const RESOLUTION: usize = 4;
/// Size of the bodies across and in depth, and length of the race beyond the end of the roller, in
/// half widths under the load that the mesh is made for.
const SIZE: f64 = 30.0;
const BEYOND: f64 = 15.0;
/// Ratio of the sizes of neighbouring elements, across and in depth.
const GROWTH: f64 = 1.15;
/// Number of elements along half of the roller, and the size of the first over that of the last,
/// which is at the end.
const ALONG: usize = 16;
const FIRST_OVER_LAST: f64 = 8.0;
/// Factor `c` of the correction for the end of the roller: the logarithm has the argument
/// `1 - (1 - c b/(l/2)) (2 x/l)^2` with the half width `b` and the length `l`, so that the drop at
/// the end is finite.
///
/// # Source
/// P. M. Johns and R. Gohar, *Roller bearings under radial and eccentric loads*, Tribology
/// International 14 (1981), 131 to 136, as quoted with H. Fujiwara and T. Kawase, NTN Technical
/// Review 75 (2007).
const AT_THE_END: f64 = 0.3033;

/// The shape of a roller along its axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(in crate::cli) enum Profile {
    /// The profile under which the pressure is even along the axis at the design load
    #[default]
    Logarithmic,
    /// A cylinder, with the peaks of pressure at its ends
    Straight,
}

/// A roller of finite length on a race.
pub(super) struct Roller<'m> {
    /// Radius whose curvature is the sum of the curvatures of roller and race.
    pub radius: f64,
    pub length: f64,
    pub profile: Profile,
    /// Load for which the profile is made, for the whole roller.
    pub design_load: f64,
    pub contact_modulus: f64,
    /// Half width under the load that the mesh is made for.
    pub half_width: f64,
    pub resolution: usize,
    pub made: &'m [Made; 2],
}

impl Roller<'_> {
    /// Returns the factor of the logarithm in the drop of the profile. A load `q` per length on a
    /// narrow strip of length `l` presses a half space down by `q/(pi E*) ln(l^2/4 - x^2)` plus a
    /// constant. A roller presses evenly if its profile drops by as much towards its ends:
    /// `q/(pi E*) ln(1/(1 - (2 x/l)^2))`, for both bodies together.
    ///
    /// # Source
    /// G. Lundberg, *Elastische Beruehrung zweier Halbraeume*, Forschung auf dem Gebiete des
    /// Ingenieurwesens 10 (1939), 201 to 211.
    fn drop(&self) -> f64 {
        self.design_load / (PI * self.length * self.contact_modulus)
    }

    /// Returns the half width of a line contact under the design load: `b^2 = 4 q R/(pi E*)`.
    fn design_half_width(&self) -> f64 {
        (4.0 * self.drop() * self.radius).sqrt()
    }

    /// Returns the gap of the unloaded bodies as a formula.
    fn gap(&self) -> String {
        let round = format!("y^2/{}", toml(2.0 * self.radius));
        match self.profile {
            Profile::Straight => round,
            Profile::Logarithmic => {
                let share = 1.0 - AT_THE_END * 2.0 * self.design_half_width() / self.length;
                let drop = toml(self.drop());
                let share = toml(share.max(0.0));
                format!(
                    "{round} - {drop}*log(1 - {share}*(2*x/{})^2)",
                    toml(self.length)
                )
            }
        }
    }

    /// Returns the mesh of the two blocks.
    fn mesh(&self) -> String {
        let b = self.half_width;
        let (size, half) = (SIZE * b, 0.5 * self.length);
        // The first element is b/resolution wide, each next one is larger, up to the size of the
        // body.
        let sum = 1.0 + SIZE * self.resolution as f64 * (GROWTH - 1.0);
        let across = ((sum.ln() / GROWTH.ln()).round() as usize).max(4);
        let bias = GROWTH.powi(across as i32 - 1);
        let end = half + BEYOND * b;
        let beyond = ((end - half) / (half / ALONG as f64)).ceil() as usize;
        format!(
            "\
# x is the axis of the roller, y the direction of rolling. Blocks: the roller's shape is in the gap
# of the contact. The first of the elements across is 1/{resolution} of the half width.
[[mesh.parts]]
body = \"roller\"
element = \"hex8\"

[mesh.parts.brick]
x = [0.0, {half}]
y = [0.0, {size}]
z = [0.0, {size}]
elements = [{ALONG}, {across}, {across}]
bias = [{along}, {bias}, {bias}]

[[mesh.parts]]
body = \"race\"
element = \"hex8\"

[mesh.parts.brick]
x = [0.0, {end}]
y = [0.0, {size}]
z = [-{size}, 0.0]
elements = [{more}, {across}, {across}]
bias = [1.0, {bias}, {against}]
",
            resolution = self.resolution,
            half = toml(half),
            size = toml(size),
            end = toml(end),
            along = toml(1.0 / FIRST_OVER_LAST),
            bias = toml(bias),
            against = toml(1.0 / bias),
            more = ALONG + beyond,
        )
    }

    /// Returns the text of the scene.
    pub fn text(&self, asked: &Asked) -> String {
        format!(
            "{HEAD}#
{about}title = \"Static load of a roller of finite length on its race\"
kind = \"solid\"
{UNITS}
symmetry = 4                 # x and y >= 0 are meshed; loads and results are those of the whole

{mesh}
{material}# {told}
[[contact]]
first = \"roller.bottom\"
second = \"race.top\"
slave = \"first\"             # the gap is known below the roller alone
gap = \"{gap}\"

# Symmetry: nothing crosses the planes x = 0 and y = 0.
[[support]]
on = \"roller.left\"
fix = [\"x\"]

[[support]]
on = \"race.left\"
fix = [\"x\"]

[[support]]
on = \"roller.front\"
fix = [\"y\"]

[[support]]
on = \"race.front\"
fix = [\"y\"]

[[support]]
on = \"race.bottom\"
fix = [\"z\"]

[[load]]
name = \"press\"
on = \"roller.top\"
plane_force = {{ direction = \"z\", total = {total} }}   # N, all of the roller; its top stays plane

{program}",
            about = asked.about,
            mesh = self.mesh(),
            material = section(&[("roller", &self.made[0]), ("race", &self.made[1])]),
            told = match self.profile {
                Profile::Logarithmic => format!(
                    "Logarithmic profile for {} N (Lundberg; Johns and Gohar at the ends)",
                    toml(self.design_load)
                ),
                Profile::Straight => "A cylinder: pressure peaks at its ends.".to_string(),
            },
            gap = self.gap(),
            total = toml(-asked.load),
            program = asked.program,
        )
    }
}
