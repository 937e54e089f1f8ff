//! The scene of a shaft in a bore: an interference fit, or a clearance and a load.

use super::materials::{First, Made, Second, section};
use super::size::Size;
use super::text::{HEAD, UNITS, rounded_up, toml};
use crate::analytical::{PinInHole, Plane, ShrinkFit, ThickCylinder, contact_modulus};
use crate::cli::values::positive;
use crate::error::Result;
use crate::number::significant;
use clap::Args;

/// Radius of a bore [mm].
const RADIUS: f64 = 50.0;

/// A shaft in a bore.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  brinell new shaft-in-bore --radius 25 --outer-radius 60 --interference 0.04
  brinell new shaft-in-bore --diameter 20 --clearance 0.02 --load 500")]
pub(in crate::cli) struct Fit {
    #[command(flatten)]
    pub size: Size,
    /// Outer radius of the ring [mm]; by default twice the radius of the bore, or ten times with
    /// clearance
    #[arg(long, value_name = "B", value_parser = positive, allow_negative_numbers = true)]
    pub outer_radius: Option<f64>,
    /// Excess of the shaft's radius over the bore's [mm]; by default 0.05
    #[arg(
        long,
        value_name = "D",
        value_parser = interference,
        allow_negative_numbers = true
    )]
    pub interference: Option<f64>,
    /// Excess of the bore's radius over the shaft's [mm]
    #[arg(
        long,
        value_name = "C",
        value_parser = positive,
        allow_negative_numbers = true,
        conflicts_with = "interference"
    )]
    pub clearance: Option<f64>,
    /// Load on the shaft, only with clearance [N/mm]; by default the load at which the contact
    /// reaches 30 degrees to either side
    #[arg(
        long,
        value_name = "P",
        value_parser = positive,
        allow_negative_numbers = true,
        requires = "clearance"
    )]
    pub load: Option<f64>,
    /// Elements over a quarter circle (even)
    #[arg(long, value_name = "N", default_value_t = 24)]
    pub resolution: usize,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// Reads a positive interference.
fn interference(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(below) if below < 0.0 => Err(format!(
            "an interference below 0 is a gap: give --clearance {}",
            -below
        )),
        _ => positive(text),
    }
}

/// Default interference, on the default radius.
const INTERFERENCE: f64 = 0.05;

/// Returns the text of the scene.
pub(super) fn scene(fit: &Fit) -> Result<String> {
    let radius = fit.size.radius_or(RADIUS);
    let made = fit.second.both(&fit.first)?;
    match fit.clearance {
        Some(clearance) => loose(fit, radius, clearance, &made),
        None => tight(fit, radius, &made),
    }
}

fn tight(fit: &Fit, radius: f64, made: &[Made; 2]) -> Result<String> {
    let outer = fit.outer_radius.unwrap_or(2.0 * radius);
    let interference = fit.interference.unwrap_or(INTERFERENCE);
    let [[shaft_e, shaft_nu], [ring_e, ring_nu]] = [made[0].elastic(), made[1].elastic()];
    let ring = ThickCylinder::new(radius, outer, ring_e, ring_nu, Plane::Stress)?;
    let elastic = ShrinkFit::new(interference, ring, 0.0, shaft_e, shaft_nu)?;
    let first = match made[1].first_yield_stress() {
        Some(stress) => format!(
            "the ring first yields at an interference of {} mm",
            significant(elastic.ring_yield_interference(stress), 4)
        ),
        None => "the ring does not yield".to_string(),
    };
    Ok(format!(
        "{HEAD}#
# Elastic, the pressure is {pressure} MPa; {first}.
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

{materials}[[contact]]
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
        materials = section(&[("shaft", &made[0]), ("ring", &made[1])]),
        radius = toml(radius),
        outer = toml(outer),
        n = fit.resolution,
        interference = toml(interference),
    ))
}

/// Half of the arc of contact under the default load [degrees].
const ARC: f64 = 30.0;

/// Supports of a half model of a shaft in a bore.
const LOOSE_SUPPORTS: &str = "\
# Symmetry: nothing crosses the line x = 0.
[[support]]
on = \"shaft.start\"
fix = [\"x\"]

[[support]]
on = \"shaft.end\"
fix = [\"x\"]

[[support]]
on = \"ring.start\"
fix = [\"x\"]

[[support]]
on = \"ring.end\"
fix = [\"x\"]

[[support]]
on = \"ring.outer\"
fix = [\"x\", \"y\"]

";

/// Returns the scene of a shaft in a bore with clearance.
fn loose(fit: &Fit, radius: f64, clearance: f64, made: &[Made; 2]) -> Result<String> {
    let outer = fit.outer_radius.unwrap_or(10.0 * radius);
    let shaft = made[0].clone().kept_elastic();
    // In plane stress E* depends on E alone.
    let [[e1, _], [e2, _]] = [made[0].elastic(), made[1].elastic()];
    let pin = PinInHole::new(radius, clearance, contact_modulus(e1, 0.0, e2, 0.0))?;
    let load = match fit.load {
        Some(load) => load,
        None => rounded_up(pin.load_for_half_angle(ARC.to_radians())?),
    };
    Ok(format!(
        "{HEAD}#
# Elastic, in a plate without end and of one material, the shaft is pressed on an arc of {angle}
# degrees to either side of the load, with {pressure} MPa at most (Persson 1964). The shaft is kept
# elastic: under a force on its centre alone it would yield there.
title = \"Shaft in a bore with clearance\"
kind = \"plane_stress\"
{UNITS}
symmetry = 2                 # half model, x >= 0: loads and results are those of the whole

# Both are drawn with the bore's radius, nodes facing each other; `gap` is the clearance.
[[mesh.parts]]
body = \"shaft\"
disc = {{ radius = {radius}, angle = [-90.0, 90.0], elements = {n} }}

[[mesh.parts]]
body = \"ring\"

[mesh.parts.ring]
radius = [{radius}, {outer}]
angle = [-90.0, 90.0]
elements = [{rings}, {n}]
bias = {bias}              # the outermost element over the innermost

{materials}[[contact]]
first = \"shaft.outer\"
second = \"ring.inner\"
gap = {clearance}              # of radii, all round before the load

{LOOSE_SUPPORTS}[[load]]
name = \"press\"
on = \"shaft.center\"
force = [0.0, {total}]          # N per mm of length

[program]
targets = [
    {{ name = \"pressed\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
",
        angle = significant(pin.half_angle(load)?.to_degrees(), 3),
        pressure = significant(pin.max_pressure(load)?, 4),
        materials = section(&[("shaft", &shaft), ("ring", &made[1])]),
        radius = toml(radius),
        outer = toml(outer),
        n = 2 * fit.resolution,
        rings = fit.resolution,
        // This bias makes elements as thick as they are long, at the bore and at the outer circle.
        bias = toml(outer / radius),
        clearance = toml(clearance),
        total = toml(-load),
    ))
}
