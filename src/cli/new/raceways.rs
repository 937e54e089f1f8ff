//! The scene of a roller between two raceways, and its mesh.

use super::materials::{First, Second, section, weaker};
use super::size::Size;
use super::text::{HEAD, Started, UNITS, about_loads, largest, toml};
use crate::analytical::{HertzLine, contact_modulus};
use crate::cli::values::positive;
use crate::error::Result;
use crate::mesh::Shape;
use crate::mesh::generate::raceways::Raceways;
use crate::number::significant;
use clap::Args;

/// Default radius of a roller [mm].
const RADIUS: f64 = 5.0;
/// Range over which elements have equal size, in half widths of the wider contact under the largest
/// load.
const REACH: f64 = 1.3;

/// Supports of a half model of a roller between two rings.
const SUPPORTS: &str = "\
# Symmetry: nothing crosses the line x = 0. The roller is held by its contacts alone.
[[support]]
on = \"roller.symmetry\"
fix = [\"x\"]

[[support]]
on = \"inner.symmetry\"
fix = [\"x\"]

[[support]]
on = \"outer.symmetry\"
fix = [\"x\"]

[[support]]
on = \"inner.bore\"
fix = [\"x\", \"y\"]

";

/// A roller between the raceways of two rings.
#[derive(Debug, Args)]
pub(in crate::cli) struct Bearing {
    #[command(flatten)]
    pub size: Size,
    /// Radius of the inner raceway [mm]; by default four times the roller's
    #[arg(long, value_name = "R", value_parser = positive, allow_negative_numbers = true)]
    pub inner_radius: Option<f64>,
    /// Radius of the outer raceway [mm]; by default that of the inner one plus the roller's
    /// diameter
    #[arg(long, value_name = "R", value_parser = positive, allow_negative_numbers = true)]
    pub outer_radius: Option<f64>,
    /// Thickness of the rings [mm]; by default the roller's radius
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    pub thickness: Option<f64>,
    /// Largest load [N/mm]; by default three times the load at first yield
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    pub load: Option<f64>,
    /// Elements over the half width of the inner contact at first yield
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub resolution: usize,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// Returns the scene, which reads its mesh from the file `mesh`.
pub(super) fn scene(bearing: &Bearing, mesh: &str) -> Result<Started> {
    let roller = bearing.size.radius_or(RADIUS);
    let inner = bearing.inner_radius.unwrap_or(4.0 * roller);
    let outer = bearing.outer_radius.unwrap_or(inner + 2.0 * roller);
    let made = bearing.second.both(&bearing.first)?;
    let [[e1, nu1], [e2, nu2]] = [made[0].elastic(), made[1].elastic()];
    let modulus = contact_modulus(e1, nu1, e2, nu2);
    // The curvatures of roller and raceway add up at the inner raceway; at the outer one the
    // curvature of the raceway is subtracted.
    let at_inner = HertzLine::new(1.0 / (1.0 / roller + 1.0 / inner), modulus)?;
    let at_outer = HertzLine::new(1.0 / (1.0 / roller - 1.0 / outer), modulus)?;
    let yield_load = weaker(&made, |nu, y| at_inner.yield_load(nu, y));
    let load = largest(bearing.load, yield_load)?;
    let raceways = Raceways {
        roller,
        inner,
        outer,
        thickness: bearing.thickness.unwrap_or(roller),
        size: at_inner.half_width(yield_load.unwrap_or(load)) / bearing.resolution.max(1) as f64,
        reach: REACH * at_outer.half_width(load.max(yield_load.unwrap_or(load))),
    };
    let (about, first) = about_loads(load, yield_load, "N per mm of length, at the inner ring");
    let [below, above] = raceways.centers().map(toml);
    let steel = section(&[
        ("roller", &made[0]),
        ("inner", &made[1]),
        ("outer", &made[1]),
    ]);
    let text = format!(
        "{HEAD}#
{about}# There the elastic pressures are {inner_pressure} and {outer_pressure} MPa (inner, outer).
title = \"Roller between two raceways\"
kind = \"plane_strain\"
{UNITS}
symmetry = 2                 # half model, x >= 0: loads and results are those of the whole

# Made for this load; surfaces of the file have the shapes that stand here.
[mesh]
file = \"{mesh}\"
circles = [
    {{ on = \"roller.inner\", radius = {roller_radius} }},
    {{ on = \"roller.outer\", radius = {roller_radius} }},
    {{ on = \"inner.raceway\", center = [0.0, {below}], radius = {inner_radius} }},
    {{ on = \"outer.raceway\", center = [0.0, {above}], radius = {outer_radius} }},
]

{steel}[[contact]]
first = \"roller.inner\"
second = \"inner.raceway\"

[[contact]]
first = \"outer.raceway\"
second = \"roller.outer\"

{SUPPORTS}[[load]]
name = \"press\"
on = \"outer.seat\"
plane_force = {{ direction = \"y\", total = {total} }}   # N per mm; the seat moves as one

# Pressed to the full load, then let go: what stays are the dents.
[program]
targets = [
{first}    {{ name = \"pressed\", load_factor = 1.0 }},
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
",
        inner_pressure = significant(at_inner.max_pressure(load), 4),
        outer_pressure = significant(at_outer.max_pressure(load), 4),
        roller_radius = toml(roller),
        inner_radius = toml(inner),
        outer_radius = toml(outer),
        total = toml(-load),
    );
    let mesh = raceways.mesh(Shape::Quad4)?;
    Ok(Started {
        mesh: Some(mesh),
        ..text.into()
    })
}
