//! Scenes of two curved bodies in three dimensions.

use super::{HEAD, Steel, UNITS, material, not_zero, positive, rounded_up, toml};
use crate::analytical::{HertzEllipse, contact_modulus};
use crate::error::Result;
use crate::number::significant;
use clap::Args;

/// Elements over the smaller half axis where nothing is said: a run takes seconds.
const RESOLUTION: usize = 6;

/// What all of them have.
#[derive(Debug, Args)]
pub(in crate::cli) struct Common {
    /// Largest load [N]; by default three times the load at first yield
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub load: Option<f64>,
    /// Elements over the smaller half axis of the contact at first yield
    #[arg(long, value_name = "N", default_value_t = RESOLUTION)]
    pub resolution: usize,
    #[command(flatten)]
    pub steel: Steel,
}

/// A ball in the groove of a race.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: brinell new ball-in-groove --radius 5 --groove 5.2 --race 20 --out \
                  groove.toml && brinell run groove.toml"
)]
pub(in crate::cli) struct Groove {
    /// Radius of the ball [mm]
    #[arg(
        long,
        value_name = "R",
        default_value_t = 5.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub radius: f64,
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
    pub common: Common,
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
    pub common: Common,
}

/// The two bodies: principal radii along x and y, and what the scene states about them.
struct Bodies {
    title: &'static str,
    upper: ([f64; 2], &'static str),
    lower: ([f64; 2], &'static str),
}

pub(super) fn ball_on_flat(
    radius: f64,
    load: Option<f64>,
    resolution: Option<usize>,
    steel: &Steel,
) -> Result<String> {
    let bodies = Bodies {
        title: "Ball on a flat",
        upper: ([radius; 2], "ball"),
        lower: ([0.0; 2], "flat"),
    };
    scene(&bodies, load, resolution.unwrap_or(RESOLUTION), steel)
}

pub(super) fn ball_in_groove(groove: &Groove) -> Result<String> {
    let bodies = Bodies {
        title: "Ball in a groove",
        upper: ([groove.radius; 2], "ball"),
        lower: (
            [-groove.groove, groove.race],
            "the groove is hollow across; along it the race is convex (positive) or hollow \
             (negative)",
        ),
    };
    let Common {
        load,
        resolution,
        steel,
    } = &groove.common;
    scene(&bodies, *load, *resolution, steel)
}

pub(super) fn crossed_cylinders(crossed: &Crossed) -> Result<String> {
    let bodies = Bodies {
        title: "Crossed cylinders",
        upper: ([0.0, crossed.upper], "along its axis a cylinder is flat"),
        lower: ([crossed.lower, 0.0], "the other way round"),
    };
    let Common {
        load,
        resolution,
        steel,
    } = &crossed.common;
    scene(&bodies, *load, *resolution, steel)
}

fn scene(bodies: &Bodies, load: Option<f64>, resolution: usize, steel: &Steel) -> Result<String> {
    let (e, nu) = (steel.youngs_modulus, steel.poissons_ratio);
    let radii = HertzEllipse::relative_radii(bodies.upper.0, bodies.lower.0)?;
    let hertz = HertzEllipse::new(radii, contact_modulus(e, nu, e, nu))?;
    let yield_load = hertz.yield_load(nu, steel.yield_stress);
    let load = load.unwrap_or_else(|| rounded_up(3.0 * yield_load));
    let first = match load > yield_load {
        true => "    { yield = true },                    # first yield\n",
        false => "",
    };
    let list = |radii: [f64; 2]| radii.map(toml).join(", ");
    let supports: String = ["x", "y"]
        .into_iter()
        .flat_map(|axis| ["upper", "lower"].map(|body| (axis, body)))
        .map(|(axis, body)| {
            format!("[[support]]\non = \"{body}.symmetry_{axis}\"\nfix = [\"{axis}\"]\n\n")
        })
        .collect();
    Ok(format!(
        "{HEAD}#
# By Hertz the material first yields at a load of {yields} N;
# the largest load is {times} times that.
title = \"{title}\"
kind = \"solid\"
{UNITS}
symmetry = 4                 # x and y >= 0 are meshed; loads and results are those of the whole

# Principal radii along x and y: positive convex, negative hollow, 0 flat.
[mesh.curved_bodies]
upper = [{upper}]         # {of_upper}
lower = [{lower}]         # {of_lower}
resolution = {resolution}   # elements over the smaller half axis of the contact: 4 coarse, 8 fine

{material}
[[contact]]
first = \"upper.contact\"
second = \"lower.contact\"

# Symmetry: nothing crosses the planes x = 0 and y = 0.
{supports}[[support]]
on = \"lower.bottom\"
fix = [\"z\"]

[[load]]
name = \"press\"
on = \"upper.top\"
plane_force = {{ direction = \"z\", total = {total} }}   # N; the surface stays plane

[program]
targets = [
{first}    {{ name = \"loaded\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]

[[reference]]
hertz_ellipse = {{ first = [{upper}], second = [{lower}] }}
",
        yields = significant(yield_load, 4),
        times = significant(load / yield_load, 3),
        title = bodies.title,
        upper = list(bodies.upper.0),
        of_upper = bodies.upper.1,
        lower = list(bodies.lower.0),
        of_lower = bodies.lower.1,
        material = material(steel, &["upper", "lower"]),
        total = toml(-load),
    ))
}
