//! `brinell new`: a commented scene for a common problem from a few numbers. What a scene needs
//! beyond them (how far the fine mesh reaches, which states to write) is set from the closed forms.

mod punch;
mod solid;

use super::convert::{self, ConvertArguments};
use super::print;
use crate::analytical::{HertzLine, HertzPoint, Plane, ShrinkFit, ThickCylinder, contact_modulus};
use crate::error::{Error, ErrorKind, Result};
use crate::number::significant;
use crate::scene::Scene;
use clap::{Args, Subcommand};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What `brinell new` takes.
#[derive(Debug, Args)]
pub(super) struct NewArguments {
    #[command(subcommand)]
    pub problem: Option<Problem>,
    /// A deck of Abaqus or CalculiX (.inp) to start from, in place of a problem: scene and mesh as
    /// of `brinell convert`
    #[arg(long, value_name = "DECK")]
    pub from: Option<PathBuf>,
    /// File for the scene; without it the scene is printed
    #[arg(long, short, global = true, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// The problems. Units are N, mm and MPa.
#[derive(Debug, Subcommand)]
pub(super) enum Problem {
    /// A ball is pressed on a flat and let go (axisymmetric)
    #[command(
        after_help = "Example: brinell new ball-on-flat --radius 5 --load 20 --out ball.toml && \
                      brinell run ball.toml"
    )]
    BallOnFlat(Ball),
    /// A ball is pressed into the groove of a race and let go (three dimensions)
    BallInGroove(solid::Groove),
    /// Two cylinders are pressed together at right angles and let go (three dimensions)
    CrossedCylinders(solid::Crossed),
    /// A roller is pressed on a flat and let go (plane strain; the load is per mm of length)
    #[command(
        after_help = "Example: brinell new roller-on-flat --radius 5 --load 400 --out roller.toml \
                      && brinell run roller.toml"
    )]
    RollerOnFlat(Pressed),
    /// A shaft that is too thick for its bore: an interference fit (plane stress)
    ShaftInBore(Fit),
    /// A flat rigid punch goes into a block (plane strain)
    Punch(punch::Punch),
}

/// Loads so many times that of first yield may take minutes: more and more of the material flows.
const FAR: f64 = 6.0;

/// What bodies are made of.
#[derive(Debug, Args)]
pub(super) struct Steel {
    /// Young's modulus [MPa]
    #[arg(
        long,
        value_name = "E",
        default_value_t = 210_000.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub youngs_modulus: f64,
    /// Poisson's ratio
    #[arg(
        long,
        value_name = "NU",
        default_value_t = 0.3,
        value_parser = poissons_ratio,
        allow_negative_numbers = true
    )]
    pub poissons_ratio: f64,
    /// Yield stress [MPa]
    #[arg(
        long,
        value_name = "Y",
        default_value_t = 500.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub yield_stress: f64,
    /// Plastic modulus, d(yield stress)/d(plastic strain) [MPa]; 0 is perfectly plastic
    #[arg(
        long,
        value_name = "H",
        default_value_t = 2000.0,
        value_parser = not_negative,
        allow_negative_numbers = true
    )]
    pub plastic_modulus: f64,
}

/// A ball on a flat.
#[derive(Debug, Args)]
pub(super) struct Ball {
    /// In three dimensions: what an axisymmetric model shows too, as a start for what it cannot
    #[arg(long)]
    pub three_dimensional: bool,
    #[command(flatten)]
    pub pressed: Pressed,
}

/// A round body on a flat.
#[derive(Debug, Args)]
pub(super) struct Pressed {
    /// Radius [mm]
    #[arg(
        long,
        value_name = "R",
        default_value_t = 10.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub radius: f64,
    /// Largest load [N; roller: N/mm]; by default three times the load at first yield
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub load: Option<f64>,
    /// Elements over the contact half width at first yield, by default 16 (with fewer errors are
    /// estimated on finer meshes, which costs more); in three dimensions 6
    #[arg(long, value_name = "N")]
    pub resolution: Option<usize>,
    #[command(flatten)]
    pub steel: Steel,
}

/// A shaft in a bore.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: brinell new shaft-in-bore --radius 25 --outer-radius 60 --interference \
                  0.04"
)]
pub(super) struct Fit {
    /// Radius of the shaft and the bore [mm]
    #[arg(
        long,
        value_name = "A",
        default_value_t = 50.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub radius: f64,
    /// Outer radius of the ring [mm]; by default twice the bore's
    #[arg(long, value_name = "B", value_parser = positive, allow_negative_numbers = true)]
    pub outer_radius: Option<f64>,
    /// How much thicker the shaft's radius is [mm]
    #[arg(
        long,
        value_name = "D",
        default_value_t = 0.05,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub interference: f64,
    /// Elements over a quarter circle (even)
    #[arg(long, value_name = "N", default_value_t = 24)]
    pub resolution: usize,
    #[command(flatten)]
    pub steel: Steel,
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| v > 0.0, "greater than 0")
}

fn not_zero(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| v != 0.0, "other than 0")
}

fn not_negative(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| v >= 0.0, "not less than 0")
}

fn poissons_ratio(text: &str) -> std::result::Result<f64, String> {
    within(text, |v| -1.0 < v && v < 0.5, "between -1 and 0.5")
}

/// A finite number that `holds`.
fn within(
    text: &str,
    holds: impl Fn(f64) -> bool,
    range: &str,
) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && holds(value) => Ok(value),
        _ => Err(format!("a number {range} is wanted")),
    }
}

/// Writes the scene of a problem.
pub(super) fn run(arguments: &NewArguments) -> Result<()> {
    let problem = match (&arguments.problem, &arguments.from) {
        (Some(problem), None) => problem,
        (None, Some(deck)) => return from_deck(deck, arguments.out.as_ref()),
        _ => {
            return Err(Error::input(
                "give either a problem (brinell new --help lists them) or a deck (--from DECK)",
            ));
        }
    };
    let text = match problem {
        Problem::BallOnFlat(ball) if ball.three_dimensional => {
            let Pressed {
                radius,
                load,
                resolution,
                steel,
            } = &ball.pressed;
            solid::ball_on_flat(*radius, *load, *resolution, steel)?
        }
        Problem::BallOnFlat(ball) => pressed_scene(&ball.pressed, true)?,
        Problem::BallInGroove(groove) => solid::ball_in_groove(groove)?,
        Problem::CrossedCylinders(crossed) => solid::crossed_cylinders(crossed)?,
        Problem::RollerOnFlat(pressed) => pressed_scene(pressed, false)?,
        Problem::ShaftInBore(fit) => fit_scene(fit)?,
        Problem::Punch(given) => punch::scene(given),
    };
    // What the flags say wrong is said before anything is written.
    Scene::parse(&text, "the new scene")?;
    let Some(path) = &arguments.out else {
        return print(&text);
    };
    let written =
        std::fs::File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    match written {
        Err(cause) if cause.kind() == std::io::ErrorKind::AlreadyExists => Err(Error::new(
            ErrorKind::Io,
            format!(
                "{} exists and is left as it is: choose another name",
                path.display()
            ),
        )),
        Err(cause) => Err(Error::io("write", path, cause)),
        Ok(()) => print(&format!(
            "{0} written; run it with: brinell run {0}\n",
            path.display()
        )),
    }
}

/// A deck's scene and mesh, and how to go on.
fn from_deck(deck: &Path, out: Option<&PathBuf>) -> Result<()> {
    let out = out.map_or_else(|| deck.with_extension("toml"), PathBuf::clone);
    convert::run(&ConvertArguments {
        deck: deck.to_path_buf(),
        out: out.clone(),
        small_strain: false,
        overrides: Vec::new(),
    })?;
    print(&format!("run it with: brinell run {}\n", out.display()))
}

/// Two digits are enough for a load that nobody gave.
fn rounded_up(load: f64) -> f64 {
    let digits = 10f64.powf(load.log10().floor() - 1.0);
    (load / digits).ceil() * digits
}

/// A number as TOML has it: with a point or an exponent.
fn toml(value: f64) -> String {
    let text = format!("{value:?}");
    match text.parse::<f64>() {
        Ok(_) => text,
        // Rust's infinities are not TOML's; reading the scene refuses both.
        Err(_) => "nan".to_string(),
    }
}

/// The material, and the bodies that are made of it.
fn material(steel: &Steel, bodies: &[&str]) -> String {
    let mut text = format!(
        "[materials.steel]
youngs_modulus = {}
poissons_ratio = {}
yield_stress = {}             # without it the material is elastic
plastic_modulus = {}          # slope of yield stress over plastic strain; or tangent_modulus
",
        toml(steel.youngs_modulus),
        toml(steel.poissons_ratio),
        toml(steel.yield_stress),
        toml(steel.plastic_modulus),
    );
    for body in bodies {
        text.push_str(&format!(
            "\n[bodies.{body}]\nmaterial = \"steel\"           # plastic = false keeps a body \
             elastic\n"
        ));
    }
    text
}

const HEAD: &str = "# Made by `brinell new`; every value may be changed.
# Check it with `brinell check`, run it with `brinell run`.
# Units N, mm, MPa: brinell converts nothing, any consistent ones will do.
";
const UNITS: &str =
    "units = { length = \"mm\", force = \"N\", stress = \"MPa\" }   # names for the report";

fn pressed_scene(pressed: &Pressed, ball: bool) -> Result<String> {
    let steel = &pressed.steel;
    let modulus = contact_modulus(
        steel.youngs_modulus,
        steel.poissons_ratio,
        steel.youngs_modulus,
        steel.poissons_ratio,
    );
    let (nu, y) = (steel.poissons_ratio, steel.yield_stress);
    let (yield_load, widths): (f64, Box<dyn Fn(f64) -> f64>) = if ball {
        let hertz = HertzPoint::new(pressed.radius, modulus)?;
        let widths = move |load| hertz.contact_radius(load);
        (hertz.yield_load(nu, y), Box::new(widths))
    } else {
        let hertz = HertzLine::new(pressed.radius, modulus)?;
        (
            hertz.yield_load(nu, y),
            Box::new(move |load| hertz.half_width(load)),
        )
    };
    let load = pressed.load.unwrap_or_else(|| rounded_up(3.0 * yield_load));
    let reach = widths(load) / widths(yield_load);
    let (shape, kind, per) = match ball {
        true => ("Ball", "axisymmetric", "N over the full circle"),
        false => ("Roller", "plane_strain", "N per mm of length"),
    };
    let times = load / yield_load;
    let patience = match times > FAR {
        true => {
            "# So far beyond it a run may take minutes, and the estimate of its errors more: \
             `--no-estimate` leaves that out.\n"
        }
        false => "",
    };
    let first = match load > yield_load {
        true => "    { yield = true },                    # first yield\n",
        false => "",
    };
    let symmetry = match ball {
        true => "".to_string(),
        false => "symmetry = 2                 # half model, x >= 0: loads and results are those \
                  of the whole\n"
            .to_string(),
    };
    // Stress under a point fades with the square of the distance: 200 contact radii are enough.
    let far = if ball {
        format!(
            "far_size = {:?}            # size of the bodies, in half widths at first yield\n",
            (200.0 * reach.max(1.0)).ceil()
        )
    } else {
        String::new()
    };
    let material = material(steel, &["cylinder", "half_plane"]);
    Ok(format!(
        "{HEAD}#
# By Hertz the material first yields at a load of {yields} {per};
# the largest load is {times} times that.
{patience}title = \"{shape} on a flat\"
kind = \"{kind}\"
{UNITS}
{symmetry}
# The generator's names are `cylinder` for the upper body and `half_plane` for the lower one,
# whatever they stand for.
[mesh.cylinder_on_half_plane]
radius = {radius}
resolution = {resolution}              # elements over the contact half width: 8 coarse, 32 fine
{far}
{material}
[[contact]]
first = \"cylinder.contact\"
second = \"half_plane.contact\"

# Symmetry: nothing crosses the line x = 0.
[[support]]
on = \"cylinder.symmetry\"
fix = [\"x\"]

[[support]]
on = \"half_plane.symmetry\"
fix = [\"x\"]

[[support]]
on = \"half_plane.bottom\"
fix = [\"y\"]

[[load]]
name = \"press\"
on = \"cylinder.top\"
plane_force = {{ direction = \"y\", total = {total} }}   # {per}; the surface stays plane

# Pressed to the full load, then let go: what stays is the dent.
[program]
targets = [
{first}    {{ name = \"pressed\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
",
        yields = significant(yield_load, 4),
        times = significant(times, 3),
        radius = toml(pressed.radius),
        resolution = pressed.resolution.unwrap_or(16),
        total = toml(-load),
    ))
}

fn fit_scene(fit: &Fit) -> Result<String> {
    let outer = fit.outer_radius.unwrap_or(2.0 * fit.radius);
    let (young, poisson) = (fit.steel.youngs_modulus, fit.steel.poissons_ratio);
    let ring = ThickCylinder::new(fit.radius, outer, young, poisson, Plane::Stress)?;
    let elastic = ShrinkFit::new(fit.interference, ring, 0.0, young, poisson)?;
    let material = material(&fit.steel, &["shaft", "ring"]);
    Ok(format!(
        "{HEAD}#
# Elastic, the pressure is {pressure} MPa; the ring first yields at an interference of {first} mm.
title = \"Shaft in a bore, interference fit\"
kind = \"plane_stress\"
{UNITS}

# Quarter model. The disc has `elements` over its quarter circle, the ring as many along its
# angle: nodes face each other.
[[mesh.parts]]
body = \"shaft\"
disc = {{ radius = {radius}, elements = {n} }}

[[mesh.parts]]
body = \"ring\"
ring = {{ radius = [{radius}, {outer}], elements = [{n}, {n}] }}

{material}
[[contact]]
first = \"shaft.outer\"
second = \"ring.inner\"
interference = {interference}          # of radii: applied before the load program

# Symmetry: nothing crosses the lines x = 0 and y = 0.
[[support]]
on = \"shaft.start\"
fix = [\"y\"]

[[support]]
on = \"shaft.end\"
fix = [\"x\"]

[[support]]
on = \"ring.start\"
fix = [\"y\"]

[[support]]
on = \"ring.end\"
fix = [\"x\"]

# No load: the state asked for is that of the fit alone.
[program]
targets = [{{ name = \"fitted\", load_factor = 0.0 }}]
",
        pressure = significant(elastic.pressure(), 4),
        first = significant(elastic.ring_yield_interference(fit.steel.yield_stress), 4),
        radius = toml(fit.radius),
        outer = toml(outer),
        n = fit.resolution,
        interference = toml(fit.interference),
    ))
}
