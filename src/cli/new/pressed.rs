//! The scene of a ball or a roller on a flat.

use super::materials::{First, Second, section};
use super::size::Size;
use super::{HEAD, UNITS, about_loads, largest, positive, toml, weaker};
use crate::analytical::{HertzLine, HertzPoint, contact_modulus};
use crate::error::Result;
use clap::Args;

/// Loads so many times that of first yield may take minutes: more and more of the material yields.
const FAR: f64 = 6.0;

/// Radius of a ball or a roller [mm].
pub(super) const RADIUS: f64 = 10.0;

/// A ball on a flat.
#[derive(Debug, Args)]
pub(in crate::cli) struct Ball {
    /// In three dimensions: what an axisymmetric model shows too, as a start for what it cannot
    #[arg(long)]
    pub three_dimensional: bool,
    #[command(flatten)]
    pub pressed: Pressed,
}

/// A round body on a flat.
#[derive(Debug, Args)]
pub(in crate::cli) struct Pressed {
    #[command(flatten)]
    pub size: Size,
    /// Largest load [N; roller: N/mm]; by default three times the load at first yield
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub load: Option<f64>,
    /// Elements over the contact half width at first yield, by default 16 (with fewer errors are
    /// estimated on finer meshes, which costs more); in three dimensions 6
    #[arg(long, value_name = "N")]
    pub resolution: Option<usize>,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// The scene of a ball or a roller on a flat.
pub(super) fn scene(pressed: &Pressed, ball: bool) -> Result<String> {
    let radius = pressed.size.radius_or(RADIUS);
    let made = pressed.second.both(&pressed.first)?;
    let [[e1, nu1], [e2, nu2]] = [made[0].elastic(), made[1].elastic()];
    let modulus = contact_modulus(e1, nu1, e2, nu2);
    let (yield_load, widths): (Option<f64>, Box<dyn Fn(f64) -> f64>) = if ball {
        let hertz = HertzPoint::new(radius, modulus)?;
        let first = weaker(&made, |nu, y| hertz.yield_load(nu, y));
        (first, Box::new(move |load| hertz.contact_radius(load)))
    } else {
        let hertz = HertzLine::new(radius, modulus)?;
        let first = weaker(&made, |nu, y| hertz.yield_load(nu, y));
        (first, Box::new(move |load| hertz.half_width(load)))
    };
    let load = largest(pressed.load, yield_load)?;
    let (shape, name, kind, per) = match ball {
        true => ("Ball", "ball", "axisymmetric", "N over the full circle"),
        false => ("Roller", "roller", "plane_strain", "N per mm of length"),
    };
    let (about, first) = about_loads(load, yield_load, per);
    let patience = match yield_load.is_some_and(|first| load > FAR * first) {
        true => {
            "# So far beyond it a run may take minutes, and the estimate of its errors more: \
             `--no-estimate` leaves that out.\n"
        }
        false => "",
    };
    let symmetry = match ball {
        true => "".to_string(),
        false => "symmetry = 2                 # half model, x >= 0: loads and results are those \
                  of the whole\n"
            .to_string(),
    };
    let half_width = match yield_load {
        Some(_) => String::new(),
        None => format!(
            "half_width = {}           # of the contact that the mesh is made for\n",
            toml(widths(load))
        ),
    };
    let material = section(&[(name, &made[0]), ("flat", &made[1])]);
    Ok(format!(
        "{HEAD}#
{about}{patience}title = \"{shape} on a flat\"
kind = \"{kind}\"
{UNITS}
{symmetry}
[mesh.cylinder_on_half_plane]
names = [\"{name}\", \"flat\"]
radius = {radius}
resolution = {resolution}              # elements over the contact half width: 8 coarse, 32 fine
{half_width}
{material}[[contact]]
first = \"{name}.contact\"
second = \"flat.contact\"

# Symmetry: nothing crosses the line x = 0.
[[support]]
on = \"{name}.symmetry\"
fix = [\"x\"]

[[support]]
on = \"flat.symmetry\"
fix = [\"x\"]

[[support]]
on = \"flat.bottom\"
fix = [\"y\"]

[[load]]
name = \"press\"
on = \"{name}.top\"
plane_force = {{ direction = \"y\", total = {total} }}   # {per}; the surface stays plane

# Pressed to the full load, then let go: what stays is the dent.
[program]
targets = [
{first}    {{ name = \"pressed\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
",
        radius = toml(radius),
        resolution = pressed.resolution.unwrap_or(16),
        total = toml(-load),
    ))
}
