//! The scene of a ball or a roller on a flat.

use super::asked::Asked;
use super::materials::{First, Made, Second, section, weaker};
use super::size::Size;
use super::text::{HEAD, UNITS, about_loads, largest, toml};
use crate::analytical::{HertzLine, HertzPoint, contact_modulus};
use crate::cli::values::positive;
use crate::error::Result;
use clap::Args;

/// Ratio to the load at first yield beyond which a run may take minutes: more and more of the
/// material yields.
const FAR: f64 = 6.0;

/// Default radius of a ball or a roller [mm].
pub(super) const RADIUS: f64 = 10.0;

/// Default number of elements over the contact half width at first yield.
pub(super) const RESOLUTION: usize = 16;

/// A ball on a flat.
#[derive(Debug, Args)]
pub(in crate::cli) struct Ball {
    /// Make the scene in three dimensions, as a start for other loads and shapes; the axisymmetric
    /// scene shows the same
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
    /// Elements over the contact half width at first yield, by default 16 (with fewer elements
    /// errors are estimated on finer meshes, which costs more); in three dimensions 6
    #[arg(long, value_name = "N")]
    pub resolution: Option<usize>,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// Returns the scene of a ball or a roller on a flat.
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
    let (shape, name) = match ball {
        true => ("Ball", "ball"),
        false => ("Roller", "roller"),
    };
    let (about, first) = about_loads(load, yield_load, per(ball));
    let patience = match yield_load.is_some_and(|first| load > FAR * first) {
        true => {
            "# So far beyond first yield a run may take minutes, and the estimate of its errors \
             longer: `--no-estimate` leaves the estimate out.\n"
        }
        false => "",
    };
    let on_flat = OnFlat {
        title: &format!("{shape} on a flat"),
        name,
        ball,
        radius,
        resolution: pressed.resolution.unwrap_or(RESOLUTION),
        half_width: yield_load.is_none().then(|| widths(load)),
        made: &made,
    };
    Ok(on_flat.text(&Asked {
        about: about + patience,
        load,
        program: format!(
            "# Pressed to the full load, then let go: what stays is the dent.
[program]
targets = [
{first}    {{ name = \"pressed\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
"
        ),
    }))
}

/// Returns the unit of the load of a round body on a flat.
pub(super) fn per(ball: bool) -> &'static str {
    match ball {
        true => "N over the full circle",
        false => "N per mm of length",
    }
}

/// A ball or a roller on a flat, as the scene describes it.
pub(super) struct OnFlat<'m> {
    pub title: &'m str,
    /// Name of the round body.
    pub name: &'m str,
    /// Whether the round body is a ball, in an axisymmetric model; else it is a roller in plane
    /// strain.
    pub ball: bool,
    pub radius: f64,
    pub resolution: usize,
    /// Half width that the mesh is made for, if nothing yields.
    pub half_width: Option<f64>,
    pub made: &'m [Made; 2],
}

impl OnFlat<'_> {
    /// Returns the text of the scene.
    pub fn text(&self, asked: &Asked) -> String {
        let name = self.name;
        let kind = match self.ball {
            true => "axisymmetric",
            false => "plane_strain",
        };
        let symmetry = match self.ball {
            true => "",
            false => {
                "symmetry = 2                 # half model, x >= 0: loads and results are those \
                 of the whole\n"
            }
        };
        let half_width = self.half_width.map_or(String::new(), |width| {
            let width = toml(width);
            format!("half_width = {width}           # of the contact that the mesh is made for\n")
        });
        let material = section(&[(name, &self.made[0]), ("flat", &self.made[1])]);
        format!(
            "{HEAD}#
{about}title = \"{title}\"
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

{program}",
            about = asked.about,
            title = self.title,
            radius = toml(self.radius),
            resolution = self.resolution,
            total = toml(-asked.load),
            per = per(self.ball),
            program = asked.program,
        )
    }
}
