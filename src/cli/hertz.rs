//! `brinell hertz`: Hertz's closed forms as a table, without a mesh or a run.

mod bodies;
mod radii;
mod sheet;
mod table;

use super::streams::{json, print};
use super::values::positive;
use crate::analytical::{HertzContact, RelativeRadii, contact_modulus};
use crate::error::{Error, Result};
use crate::scene::Units;
use bodies::Materials;
use clap::Args;
use radii::Radii;
use sheet::Sheet;

const AFTER_HELP: &str = "\
A radius is positive where the body is convex, negative where it is hollow, `flat` where it is flat.
One number is a sphere, two are the radii in two planes at right angles: 5,flat is a cylinder.
Bodies that are both flat along a direction touch along a line; the load is then per length, or the
total over --length.
Without load, pressure and approach the load is that of first yield.

Examples:
  brinell hertz --radius 5 --load 100 --material 100Cr6 --second-material S355 --json
  brinell hertz --radius 5 --second-radius=-5.2,20 --pressure 4200 --youngs-modulus 208000
  brinell hertz --radius 5,flat --load 2000 --length 10 --youngs-modulus 208000 --yield-stress 2000
  brinell hertz --radius 4,flat --second-radius 6,flat --angle 60 --load 50 --material S355";

/// Arguments of `brinell hertz`.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(super) struct HertzArguments {
    /// Radii of the first body in its two principal planes
    #[arg(long, value_name = "R[,R]", allow_hyphen_values = true)]
    radius: Radii,
    /// Radii of the second body in its two principal planes
    #[arg(
        long,
        value_name = "R[,R]",
        default_value = "flat",
        allow_hyphen_values = true
    )]
    second_radius: Radii,
    /// Angle from the first principal plane of the first body to that of the second [degrees]
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    angle: f64,
    #[command(flatten)]
    given: ContactGiven,
    /// Length of a line contact, over which the load is the total
    #[arg(long, value_name = "L", value_parser = positive, allow_negative_numbers = true)]
    length: Option<f64>,
    /// Depth in a flat body from which the approach of a line contact is counted; in a cylinder it
    /// is counted from the axis
    #[arg(long, value_name = "D", value_parser = positive, allow_negative_numbers = true)]
    depth: Option<f64>,
    #[command(flatten)]
    materials: Materials,
    /// Units of length, force and stress; materials of the list are converted to them
    #[arg(
        long,
        value_name = "LENGTH,FORCE,STRESS",
        default_value = "mm,N,MPa",
        value_parser = units
    )]
    units: Units,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

/// The quantity that determines the contact.
#[derive(Debug, Args)]
#[group(multiple = false)]
struct ContactGiven {
    /// Load
    #[arg(long, value_name = "P", value_parser = positive, allow_negative_numbers = true)]
    load: Option<f64>,
    /// Greatest pressure, in place of the load
    #[arg(long, value_name = "P0", value_parser = positive, allow_negative_numbers = true)]
    pressure: Option<f64>,
    /// Approach of points far from the contact, in place of the load
    #[arg(long, value_name = "D", value_parser = positive, allow_negative_numbers = true)]
    approach: Option<f64>,
}

fn units(text: &str) -> std::result::Result<Units, String> {
    let names: Vec<&str> = text.split(',').map(str::trim).collect();
    let [length, force, stress] = names[..] else {
        return Err("three names are wanted: length, force and stress, as mm,N,MPa".to_string());
    };
    let units = Units {
        length: length.to_string(),
        force: force.to_string(),
        stress: stress.to_string(),
    };
    match units.mismatch() {
        None => Ok(units),
        Some(ratio) => Err(format!(
            "1 {force} on 1 {length} squared is {ratio:.4e} {stress}: give the unit of stress that \
             is force over length squared"
        )),
    }
}

/// Prints the figures of a contact.
pub(super) fn run(arguments: &HertzArguments) -> Result<()> {
    let sheet = arguments.sheet()?;
    print(&match arguments.json {
        true => json(&sheet)?,
        false => table::text(&sheet),
    })
}

impl HertzArguments {
    fn sheet(&self) -> Result<Sheet> {
        let radii = [self.radius.0, self.second_radius.0];
        let relative = RelativeRadii::new(radii[0], radii[1], self.angle)?;
        let bodies = self.materials.bodies(&self.units, radii)?;
        let [[e1, nu1], [e2, nu2]] = [0, 1].map(|i| bodies[i].elastic());
        let modulus = contact_modulus(e1, nu1, e2, nu2);
        let contact = HertzContact::new(relative, modulus)?;
        let is_line = matches!(contact, HertzContact::Line(_));
        if !is_line && (self.length.is_some() || self.depth.is_some()) {
            return Err(Error::input(
                "--length and --depth are of a line contact, and these bodies touch in a point",
            ));
        }
        Ok(Sheet::new(sheet::AskedContact {
            contact,
            relative,
            modulus,
            load: self.given.load(&contact, &bodies, self.length)?,
            length: self.length,
            depth: self.depth,
            bodies,
            units: self.units.clone(),
        }))
    }
}

impl ContactGiven {
    /// Returns the load (per length in a line contact), from whichever quantity is given.
    fn load(
        &self,
        contact: &HertzContact,
        bodies: &[bodies::ContactingBody; 2],
        length: Option<f64>,
    ) -> Result<f64> {
        if let Some(load) = self.load {
            return Ok(load / length.unwrap_or(1.0));
        }
        if let Some(pressure) = self.pressure {
            return Ok(contact.load_for_max_pressure(pressure));
        }
        match (self.approach, contact) {
            (Some(approach), HertzContact::Ellipse(ellipse)) => {
                Ok(ellipse.load_for_approach(approach))
            }
            (Some(_), HertzContact::Line(_)) => Err(Error::input(
                "the approach of a line contact depends on the size of the bodies and not only on \
                 the contact: give its load (--load) or pressure (--pressure)",
            )),
            (None, _) => {
                let first = bodies.iter().filter_map(|body| body.yield_load(contact));
                first.reduce(f64::min).ok_or_else(|| {
                    Error::input(
                        "give what is known of the contact, --load, --pressure or --approach; or a \
                         yield stress (--yield-stress), for the contact at first yield",
                    )
                })
            }
        }
    }
}
