//! The scene of a hardness test: a ball is pressed into a flat and unloaded.

use super::asked::Asked;
use super::materials::{First, Made, weaker};
use super::pressed::{OnFlat, RESOLUTION};
use super::size::Size;
use super::text::{about_loads, toml};
use crate::analytical::{HertzPoint, contact_modulus};
use crate::cli::hardness::SMALL;
use crate::cli::values::{poissons_ratio, positive};
use crate::error::Result;
use clap::Args;

/// Radius of the ball [mm].
const RADIUS: f64 = 5.0;
/// Young's modulus of a rigid ball over that of the flat: the ball deforms a thousandth as much.
const RIGID: f64 = 1e3;

const AFTER_HELP: &str = "\
Example: brinell new hardness --diameter 10 --load 3000 --yield-stress 500 --out test.toml && \
brinell run test.toml && brinell hardness test.out";

/// A ball on a flat, loaded to a load or to a depth.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(in crate::cli) struct Hardness {
    #[command(flatten)]
    pub size: Size,
    #[command(flatten)]
    pub until: Until,
    /// Young's modulus of the ball, which does not yield [MPa]; by default a thousand times the
    /// modulus of the flat, so that the ball is practically rigid
    #[arg(long, value_name = "E", value_parser = positive, allow_negative_numbers = true)]
    pub ball_modulus: Option<f64>,
    /// Poisson's ratio of the ball
    #[arg(
        long,
        value_name = "NU",
        default_value_t = 0.3,
        value_parser = poissons_ratio,
        allow_negative_numbers = true
    )]
    pub ball_poissons_ratio: f64,
    /// Number of elements over the contact radius at first yield; a larger contact has at least as
    /// many
    #[arg(long, value_name = "N", default_value_t = RESOLUTION)]
    pub resolution: usize,
    #[command(flatten)]
    pub flat: First,
}

/// The end of the indentation: a load or a depth.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(in crate::cli) struct Until {
    /// Load [N]
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub load: Option<f64>,
    /// Depth over the radius of the ball, h/R, under the load
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    pub depth: Option<f64>,
}

/// Returns the text of the scene.
pub(super) fn scene(test: &Hardness) -> Result<String> {
    let radius = test.size.radius_or(RADIUS);
    let flat = test.flat.made()?;
    let [modulus, ratio] = flat.elastic();
    let of_ball = test.ball_modulus.unwrap_or(RIGID * modulus);
    let made = [
        Made::elastic_body("ball", of_ball, test.ball_poissons_ratio),
        flat,
    ];
    let contact = contact_modulus(of_ball, test.ball_poissons_ratio, modulus, ratio);
    let hertz = HertzPoint::new(radius, contact)?;
    let first = weaker(&made, |nu, y| hertz.yield_load(nu, y));
    let depth = test.until.depth.map(|depth| depth * radius);
    // At a given depth the load on an elastic flat is larger than the load on any flat that yields.
    let load = match (test.until.load, depth) {
        (Some(load), _) => load,
        (None, depth) => hertz.load_for_approach(depth.unwrap_or(radius)),
    };
    let (about, yields) = about_loads(load, first, "N");
    let reached = match depth {
        Some(depth) => format!("approach = {}", toml(depth)),
        None => "load_factor = 1.0".to_string(),
    };
    let end = match depth {
        Some(_) => {
            "# That is the elastic load at the depth asked for; the run ends at the part of it at \
                    which the flat reaches this depth.\n"
        }
        None => "",
    };
    // Under the same load an elastic contact is smaller than any elastic-plastic one.
    let far = match hertz.contact_radius(load) > SMALL * radius {
        true => {
            "# Even an elastic contact is wider than 0.2 of the ball's radius here: small \
             strains no\n# longer hold.\n"
        }
        false => "",
    };
    let on_flat = OnFlat {
        title: "Hardness test: a ball in a flat",
        name: "ball",
        ball: true,
        radius,
        resolution: test.resolution,
        half_width: first.is_none().then(|| hertz.contact_radius(load)),
        made: &made,
    };
    Ok(on_flat.text(&Asked {
        about: format!("{about}{end}{far}"),
        load,
        program: format!(
            "# Pressed in, then let go; the history has the depth (approach) in each increment.
# `brinell hardness` reads the results: hardness, mean pressure, pile-up, unloading stiffness.
[program]
history = [\"ball.top\"]
targets = [
{yields}    {{ name = \"indented\", {reached} }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
"
        ),
    }))
}
