//! The scene of ISO 76's question: which load leaves a dent of a ten-thousandth of the rolling
//! element's diameter? Beside it stand the loads at which elastic bodies reach the contact stresses
//! that the standard rates by; they are told, and the one of the bearing at hand is load factor 1.

use super::materials::{First, Made, Second};
use super::pressed::{self, OnFlat};
use super::size::Size;
use super::solid::{self, Bodies};
use super::{Asked, Started, not_zero, positive, toml, weaker};
use crate::analytical::{HertzContact, RelativeRadii, contact_modulus};
use crate::error::{Error, Result};
use crate::number::significant;
use clap::Args;

/// Diameter of the rolling element over the dent of both bodies together.
///
/// # Source
/// ISO 76:2006, notes on the basic static load ratings in clause 3.
const DIAMETER_OVER_DENT: f64 = 1e4;
/// Contact stress in the middle of the most heavily loaded contact [MPa], and of which bearings.
///
/// # Source
/// ISO 76:2006, clause 3: definitions of the basic static radial and axial load rating.
const BALLS: Rated = (4200.0, "ball bearings");
const SELF_ALIGNING: Rated = (4600.0, "self-aligning ball bearings");
const ROLLERS: Rated = (4000.0, "roller bearings");

type Rated = (f64, &'static str);

/// Radius of a rolling element [mm].
const RADIUS: f64 = 5.0;

const AFTER_HELP: &str = "\
The curve of the steel has to be given: the dent depends on little else.

Examples:
  brinell new iso76 --diameter 10 --hardening-table steel.csv --out c0.toml && brinell run c0.toml
  brinell new iso76 --diameter 10 --groove 5.2 --race 20 --hardening-table steel.csv --out c0.toml
  brinell new iso76 --roller --diameter 10 --race 20 --yield-stress 2000 --out c0.toml";

/// A ball or a roller on a race.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(in crate::cli) struct StaticLoad {
    #[command(flatten)]
    pub size: Size,
    /// Radius of the groove across, larger than the ball's [mm]; without it the race is flat across
    #[arg(
        long,
        value_name = "R",
        value_parser = positive,
        allow_negative_numbers = true,
        conflicts_with = "roller"
    )]
    pub groove: Option<f64>,
    /// Radius of the race along which the element rolls [mm]: positive for an inner race, negative
    /// for an outer one; without it the race is flat
    #[arg(long, value_name = "R", value_parser = not_zero, allow_negative_numbers = true)]
    pub race: Option<f64>,
    /// A cylindrical roller in place of a ball
    #[arg(long, conflicts_with = "self_aligning")]
    pub roller: bool,
    /// Of a self-aligning ball bearing, which ISO 76 rates at 4600 MPa
    #[arg(long)]
    pub self_aligning: bool,
    /// Elements over the contact half width, in a groove over the smaller half axis, at first
    /// yield; by default 16, in a groove 6
    #[arg(long, value_name = "N")]
    pub resolution: Option<usize>,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// The scene, and the loads of the standard's stresses.
pub(super) fn scene(given: &StaticLoad) -> Result<Started> {
    if !given.first.yields_as_given() {
        return Err(Error::input(
            "the dent depends on the steel: give its curve (--hardening-table FILE, --tensile-test \
             FILE), a yield stress (--yield-stress, --plastic-modulus) or a material of the list \
             (--material)",
        ));
    }
    let made = given.second.both(&given.first)?;
    let radius = given.size.radius_or(RADIUS);
    let contact = given.contact(radius, &made)?;
    let first = weaker(&made, |nu, y| contact.yield_load(nu, y)).ok_or_else(|| {
        Error::input(
            "nothing yields, so that no load leaves a dent: 100Cr6 and others of the list are \
             elastic, since their curve depends on the heat treatment; give yours \
             (--hardening-table FILE)",
        )
    })?;
    let loads = Loads {
        given,
        contact,
        first,
    };
    let note = loads.about();
    let asked = Asked {
        about: commented(&note),
        load: contact.load_for_max_pressure(given.rated().0),
        program: program(2.0 * radius),
    };
    Ok(Started {
        note,
        ..given.text(radius, &made, &contact, &asked).into()
    })
}

impl StaticLoad {
    /// The stress that the standard rates this bearing by.
    fn rated(&self) -> Rated {
        match (self.roller, self.self_aligning) {
            (true, _) => ROLLERS,
            (false, true) => SELF_ALIGNING,
            (false, false) => BALLS,
        }
    }

    /// The race's radii across and along.
    fn race(&self) -> [f64; 2] {
        let across = self.groove.map_or(f64::INFINITY, |groove| -groove);
        [across, self.race.unwrap_or(f64::INFINITY)]
    }

    fn contact(&self, radius: f64, made: &[Made; 2]) -> Result<HertzContact> {
        let [[e1, nu1], [e2, nu2]] = [made[0].elastic(), made[1].elastic()];
        let across = if self.roller { f64::INFINITY } else { radius };
        let relative = RelativeRadii::new([across, radius], self.race(), 0.0)?;
        HertzContact::new(relative, contact_modulus(e1, nu1, e2, nu2))
    }

    fn text(&self, radius: f64, made: &[Made; 2], contact: &HertzContact, asked: &Asked) -> String {
        let is_flat = self.groove.is_none() && self.race.is_none();
        if let HertzContact::Ellipse(_) = contact
            && !is_flat
        {
            let flat_is_zero = |radius: f64| if radius.is_finite() { radius } else { 0.0 };
            let bodies = Bodies {
                title: "Static load of a ball on its race",
                names: ["ball", "race"],
                upper: ([radius; 2], "ball"),
                lower: (
                    self.race().map(flat_is_zero),
                    "across (a groove is hollow) and along (an outer race is hollow)",
                ),
            };
            let resolution = self.resolution.unwrap_or(solid::RESOLUTION);
            return bodies.text(made, resolution, None, asked);
        }
        let on_flat = OnFlat {
            title: match self.roller {
                true => "Static load of a roller on its race",
                false => "Static load of a ball on a flat",
            },
            name: if self.roller { "roller" } else { "ball" },
            ball: !self.roller,
            // A roller on a curved race has the gap of one with the relative radius on a flat.
            radius: self
                .race
                .map_or(radius, |race| 1.0 / (1.0 / radius + 1.0 / race)),
            resolution: self.resolution.unwrap_or(pressed::RESOLUTION),
            half_width: None,
            made,
        };
        on_flat.text(asked)
    }
}

/// What elastic bodies say of the loads.
struct Loads<'g> {
    given: &'g StaticLoad,
    contact: HertzContact,
    /// Load of first yield.
    first: f64,
}

impl Loads<'_> {
    /// The loads by Hertz, line by line.
    fn about(&self) -> String {
        let unit = if self.given.roller { "N/mm" } else { "N" };
        let load = |load: f64| format!("{} {unit}", significant(load, 4));
        let mut text = format!(
            "By Hertz, elastic:\n  first yield at {}\n",
            load(self.first)
        );
        let rows: &[Rated] = match self.given.roller {
            true => &[ROLLERS],
            false => &[BALLS, SELF_ALIGNING],
        };
        for &(stress, bearings) in rows {
            let at = load(self.contact.load_for_max_pressure(stress));
            text.push_str(&format!(
                "  {stress} MPa (ISO 76:2006, {bearings}) at {at}\n"
            ));
        }
        text.push_str(&format!(
            "The load factor of state C0 is its load over that of {} MPa.\n",
            self.given.rated().0
        ));
        if self.given.roller && self.given.race.is_some() {
            text.push_str(
                "The roller of the scene has the relative radius of roller and race: on a flat it \
                 leaves\nthe gap that they leave.\n",
            );
        }
        text
    }
}

fn commented(text: &str) -> String {
    text.lines().map(|line| format!("# {line}\n")).collect()
}

fn program(diameter: f64) -> String {
    format!(
        "# Loaded until this dent would stay, of both bodies together, then let go.
[program]
targets = [
    {{ yield = true }},                    # first yield
    {{ name = \"C0\", residual_depth = {} }},   # 1/{DIAMETER_OVER_DENT} of the diameter {}
    {{ name = \"unloaded\", load_factor = 0.0 }},
]
",
        toml(diameter / DIAMETER_OVER_DENT),
        toml(diameter),
    )
}
