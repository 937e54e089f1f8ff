//! The scene of a flat punch on a block.

use super::materials::{First, section};
use super::text::{HEAD, UNITS, toml};
use crate::cli::values::positive;
use crate::error::Result;
use crate::number::significant;
use clap::Args;

/// A flat punch on a block.
#[derive(Debug, Args)]
#[command(after_help = "Example: brinell new punch --half-width 2 --depth 0.05")]
pub(in crate::cli) struct Punch {
    /// Half width of the punch [mm]
    #[arg(
        long,
        value_name = "A",
        default_value_t = 1.0,
        value_parser = positive,
        allow_negative_numbers = true
    )]
    pub half_width: f64,
    /// Depth to which the punch is pressed [mm]; by default a fiftieth of its half width
    #[arg(long, value_name = "D", value_parser = positive, allow_negative_numbers = true)]
    pub depth: Option<f64>,
    /// Elements over the half width
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub resolution: usize,
    #[command(flatten)]
    pub first: First,
}

/// Returns the text of the scene.
pub(super) fn scene(punch: &Punch) -> Result<String> {
    let a = punch.half_width;
    let depth = punch.depth.unwrap_or(0.02 * a);
    let made = punch.first.made()?;
    let limit = made.first_yield_stress().map_or(String::new(), |stress| {
        let limit = (2.0 + std::f64::consts::PI) * stress / 3f64.sqrt() * 2.0 * a;
        format!(
            "#
# A perfectly plastic block carries 2a (2 + pi) Y/sqrt(3) = {} N per mm (Prandtl 1920);
# elements give a little more.
",
            significant(limit, 4)
        )
    });
    let n = 5 * punch.resolution;
    let material = section(&[("block", &made)]);
    Ok(format!(
        "{HEAD}{limit}title = \"Flat punch on a block\"
kind = \"plane_strain\"
{UNITS}
symmetry = 2                 # half model, x >= 0: loads and results are those of the whole

# The punch itself needs no mesh: it is a prescribed displacement of a piece of the block's top,
# free to slide.
[[mesh.parts]]
body = \"block\"

[mesh.parts.block]
x = [0.0, {far}]
y = [-{far}, 0.0]
elements = [{n}, {n}]
pieces = [{{ name = \"punch\", side = \"top\", from = 0.0, to = {a} }}]

{material}[[support]]
on = \"block.left\"            # symmetry
fix = [\"x\"]

[[support]]
on = \"block.right\"           # held in: a free side gives way
fix = [\"x\"]

[[support]]
on = \"block.bottom\"
fix = [\"x\", \"y\"]

[[load]]
name = \"punch\"
on = \"block.punch\"
displacement = {{ y = {depth} }}

# Fixed steps: without contact there is no event to step to.
[program]
stepping = \"steps\"
steps = 10
targets = [
    {{ load_factor = 0.25 }},
    {{ load_factor = 0.5 }},
    {{ name = \"pressed\", load_factor = 1.0 }},   # not back to 0: that would pull
]
",
        far = toml(5.0 * a),
        a = toml(a),
        depth = toml(-depth),
    ))
}
