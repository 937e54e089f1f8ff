//! Scenes of two curved bodies in three dimensions.

use super::asked::Asked;
use super::materials::{First, Made, Second, section, weaker};
use super::pressed::{Pressed, RADIUS};
use super::size::Size;
use super::text::{HEAD, UNITS, about_loads, largest, toml};
use crate::analytical::{HertzEllipse, contact_modulus};
use crate::cli::values::{not_zero, positive};
use crate::error::Result;
use clap::Args;

/// Default radius of a ball in a groove [mm].
const BALL: f64 = 5.0;
/// Default number of elements over the smaller half axis, with which a run takes seconds.
pub(super) const RESOLUTION: usize = 6;

/// Options that all solid scenes have.
#[derive(Debug, Args)]
pub(in crate::cli) struct SolidOptions {
    /// Largest load [N]; by default three times the load at first yield
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub load: Option<f64>,
    /// Elements over the smaller half axis of the contact at first yield
    #[arg(long, value_name = "N", default_value_t = RESOLUTION)]
    pub resolution: usize,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// A ball in the groove of a race.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: brinell new ball-in-groove --radius 5 --groove 5.2 --race 20 --out \
                  groove.toml && brinell run groove.toml"
)]
pub(in crate::cli) struct Groove {
    #[command(flatten)]
    pub size: Size,
    /// Radius of the groove across, larger than the ball's [mm]
    #[arg(
        long,
        value_name = "R",
        default_value_t = 5.2,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub groove: f64,
    /// Radius of the race along the groove [mm]: positive for an inner race, negative for an outer
    /// one
    #[arg(
        long,
        value_name = "R",
        default_value_t = 20.0,
        value_parser = not_zero,
        allow_negative_numbers = true
    )]
    pub race: f64,
    #[command(flatten)]
    pub common: SolidOptions,
}

/// Two cylinders at right angles.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: brinell new crossed-cylinders --upper 4 --lower 12 --out crossed.toml \
                  && brinell run crossed.toml"
)]
pub(in crate::cli) struct Crossed {
    /// Radius of the upper cylinder, whose axis is x [mm]
    #[arg(
        long,
        value_name = "R",
        default_value_t = 4.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub upper: f64,
    /// Radius of the lower cylinder, whose axis is y [mm]
    #[arg(
        long,
        value_name = "R",
        default_value_t = 12.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub lower: f64,
    #[command(flatten)]
    pub common: SolidOptions,
}

/// The two bodies: principal radii along x and y, and the comments of the scene on them.
pub(super) struct BodyPair {
    pub title: &'static str,
    pub names: [&'static str; 2],
    pub upper: ([f64; 2], &'static str),
    pub lower: ([f64; 2], &'static str),
}

pub(super) fn ball_on_flat(pressed: &Pressed) -> Result<String> {
    let bodies = BodyPair {
        title: "Ball on a flat",
        names: ["ball", "flat"],
        upper: ([pressed.size.radius_or(RADIUS); 2], "ball"),
        lower: ([0.0; 2], "flat"),
    };
    let resolution = pressed.resolution.unwrap_or(RESOLUTION);
    let (first, second) = (&pressed.first, &pressed.second);
    scene(&bodies, pressed.load, resolution, first, second)
}

pub(super) fn ball_in_groove(groove: &Groove) -> Result<String> {
    let radius = groove.size.radius_or(BALL);
    let bodies = BodyPair {
        title: "Ball in a groove",
        names: ["ball", "race"],
        upper: ([radius; 2], "ball"),
        lower: (
            [-groove.groove, groove.race],
            "the groove is hollow across; along it the race is convex (positive) or hollow \
             (negative)",
        ),
    };
    groove.common.scene(&bodies)
}

pub(super) fn crossed_cylinders(crossed: &Crossed) -> Result<String> {
    let bodies = BodyPair {
        title: "Crossed cylinders",
        names: ["upper", "lower"],
        upper: ([0.0, crossed.upper], "along its axis a cylinder is flat"),
        lower: ([crossed.lower, 0.0], "the other way round"),
    };
    crossed.common.scene(&bodies)
}

impl SolidOptions {
    fn scene(&self, bodies: &BodyPair) -> Result<String> {
        scene(
            bodies,
            self.load,
            self.resolution,
            &self.first,
            &self.second,
        )
    }
}

fn scene(
    bodies: &BodyPair,
    load: Option<f64>,
    resolution: usize,
    first: &First,
    second: &Second,
) -> Result<String> {
    let made = second.both(first)?;
    let [[e1, nu1], [e2, nu2]] = [made[0].elastic(), made[1].elastic()];
    let radii = HertzEllipse::relative_radii(bodies.upper.0, bodies.lower.0)?;
    let hertz = HertzEllipse::new(radii, contact_modulus(e1, nu1, e2, nu2))?;
    let yield_load = weaker(&made, |nu, y| hertz.yield_load(nu, y));
    let load = largest(load, yield_load)?;
    let (about, first) = about_loads(load, yield_load, "N");
    let semi_axes = yield_load.is_none().then(|| hertz.semi_axes(load));
    let asked = Asked {
        about,
        load,
        program: format!(
            "[program]
targets = [
{first}    {{ name = \"loaded\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
"
        ),
    };
    Ok(bodies.text(&made, resolution, semi_axes, &asked))
}

impl BodyPair {
    /// Returns the scene; if nothing yields, with the half axes that its mesh is made for.
    pub fn text(
        &self,
        made: &[Made; 2],
        resolution: usize,
        semi_axes: Option<[f64; 2]>,
        asked: &Asked,
    ) -> String {
        let semi_axes = semi_axes.map_or(String::new(), |axes| {
            let axes = axes.map(toml).join(", ");
            format!("semi_axes = [{axes}]   # half axes of the contact that the mesh is made for\n")
        });
        let [upper, lower] = self.names;
        let list = |radii: [f64; 2]| radii.map(toml).join(", ");
        let supports: String = ["x", "y"]
            .into_iter()
            .flat_map(|axis| self.names.map(|body| (axis, body)))
            .map(|(axis, body)| {
                format!("[[support]]\non = \"{body}.symmetry_{axis}\"\nfix = [\"{axis}\"]\n\n")
            })
            .collect();
        format!(
            "{HEAD}#
{about}title = \"{title}\"
kind = \"solid\"
{UNITS}
symmetry = 4                 # x and y >= 0 are meshed; loads and results are those of the whole

# Principal radii along x and y: positive convex, negative hollow, 0 flat.
[mesh.curved_bodies]
names = [\"{upper}\", \"{lower}\"]
upper = [{above}]         # {of_upper}
lower = [{below}]         # {of_lower}
{semi_axes}resolution = {resolution}   # elements over its smaller half axis: 4 coarse, 8 fine

{material}[[contact]]
first = \"{upper}.contact\"
second = \"{lower}.contact\"

# Symmetry: nothing crosses the planes x = 0 and y = 0.
{supports}[[support]]
on = \"{lower}.bottom\"
fix = [\"z\"]

[[load]]
name = \"press\"
on = \"{upper}.top\"
plane_force = {{ direction = \"z\", total = {total} }}   # N; the surface stays plane

{program}
[[reference]]
hertz_ellipse = {{ first = [{above}], second = [{below}] }}
",
            about = asked.about,
            title = self.title,
            above = list(self.upper.0),
            of_upper = self.upper.1,
            below = list(self.lower.0),
            of_lower = self.lower.1,
            material = section(&[(upper, &made[0]), (lower, &made[1])]),
            total = toml(-asked.load),
            program = asked.program,
        )
    }
}
