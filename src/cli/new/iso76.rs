//! The scene of ISO 76's question: which load leaves a dent of a ten-thousandth of the rolling
//! element's diameter? The scene also states the loads at which elastic bodies reach the contact
//! stresses by which the standard rates bearings; the load for the bearing at hand has load factor
//! 1.

use super::asked::Asked;
use super::materials::{First, Made, Second, weaker};
use super::pressed::{self, OnFlat};
use super::profile::{self, Profile, Roller};
use super::size::Size;
use super::solid::{self, BodyPair};
use super::text::{Started, toml};
use crate::analytical::{HertzContact, RelativeRadii, contact_modulus};
use crate::cli::values::{not_zero, positive};
use crate::error::{Error, Result};
use crate::number::significant;
use clap::Args;

/// Ratio of the rolling element's diameter to the depth of the dent, summed over both bodies.
///
/// # Source
/// ISO 76:2006, notes on the basic static load ratings in clause 3.
const DIAMETER_OVER_DENT: f64 = 1e4;
/// Contact stress at the centre of the most heavily loaded contact [MPa], and the kind of bearing.
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
    /// Radius of a roller's crown along its axis [mm]: the contact is a point (three dimensions,
    /// loads in N)
    #[arg(
        long,
        value_name = "R",
        value_parser = positive,
        allow_negative_numbers = true,
        requires = "roller",
        conflicts_with_all = ["length", "profile", "design_load"]
    )]
    pub crown: Option<f64>,
    /// Length of a roller [mm]; the scene then models the ends and the profile of the roller (three
    /// dimensions, loads in N)
    #[arg(
        long,
        value_name = "L",
        value_parser = positive,
        allow_negative_numbers = true,
        requires = "roller"
    )]
    pub length: Option<f64>,
    /// Profile of a roller of finite length
    #[arg(long, value_enum, requires = "length", default_value_t)]
    pub profile: Profile,
    /// Load for which a logarithmic profile is made [N]; by default the load at 4000 MPa
    #[arg(
        long,
        value_name = "P",
        value_parser = positive,
        allow_negative_numbers = true,
        requires = "length"
    )]
    pub design_load: Option<f64>,
    /// Rate the bearing as a self-aligning ball bearing, for which ISO 76 has 4600 MPa
    #[arg(long)]
    pub self_aligning: bool,
    /// Elements over the contact half width at first yield (in a groove: over the smaller half
    /// axis); by default 16, in a groove 6
    #[arg(long, value_name = "N")]
    pub resolution: Option<usize>,
    #[command(flatten)]
    pub first: First,
    #[command(flatten)]
    pub second: Second,
}

/// Returns the scene, with the loads of the standard's stresses.
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
    let loads = ElasticLoads {
        given,
        contact,
        first,
        poisson: made[0].elastic()[1],
    };
    let note = loads.about();
    let asked = Asked {
        about: commented(&note),
        load: contact.load_for_max_pressure(given.rated().0) * given.length(),
        program: program(2.0 * radius),
    };
    Ok(Started {
        note,
        ..given.text(radius, &made, &contact, &asked).into()
    })
}

impl StaticLoad {
    /// Returns the stress by which the standard rates this bearing.
    fn rated(&self) -> Rated {
        match (self.roller, self.self_aligning) {
            (true, _) => ROLLERS,
            (false, true) => SELF_ALIGNING,
            (false, false) => BALLS,
        }
    }

    /// Returns the factor for the loads per length of the closed forms: the length of a roller
    /// whose ends are in the scene, else 1.
    fn length(&self) -> f64 {
        self.length.unwrap_or(1.0)
    }

    /// Returns the race's radii across and along.
    fn race(&self) -> [f64; 2] {
        let across = self.groove.map_or(f64::INFINITY, |groove| -groove);
        [across, self.race.unwrap_or(f64::INFINITY)]
    }

    fn contact(&self, radius: f64, made: &[Made; 2]) -> Result<HertzContact> {
        let [[e1, nu1], [e2, nu2]] = [made[0].elastic(), made[1].elastic()];
        let across = match self.roller {
            true => self.crown.unwrap_or(f64::INFINITY),
            false => radius,
        };
        let relative = RelativeRadii::new([across, radius], self.race(), 0.0)?;
        HertzContact::new(relative, contact_modulus(e1, nu1, e2, nu2))
    }

    fn text(&self, radius: f64, made: &[Made; 2], contact: &HertzContact, asked: &Asked) -> String {
        let is_flat = self.groove.is_none() && self.race.is_none();
        // A roller on a curved race has the same gap as a roller with the relative radius on a
        // flat.
        let relative = self
            .race
            .map_or(radius, |race| 1.0 / (1.0 / radius + 1.0 / race));
        if let (Some(length), HertzContact::Line(line)) = (self.length, contact) {
            let [[e1, nu1], [e2, nu2]] = [made[0].elastic(), made[1].elastic()];
            let roller = Roller {
                radius: relative,
                length,
                profile: self.profile,
                design_load: self.design_load.unwrap_or(asked.load),
                contact_modulus: contact_modulus(e1, nu1, e2, nu2),
                half_width: line.half_width(asked.load / length),
                resolution: self.resolution.unwrap_or(profile::RESOLUTION),
                made,
            };
            return roller.text(asked);
        }
        if let HertzContact::Ellipse(_) = contact
            && (!is_flat || self.crown.is_some())
        {
            let flat_is_zero = |radius: f64| if radius.is_finite() { radius } else { 0.0 };
            let bodies = BodyPair {
                title: match self.crown {
                    Some(_) => "Static load of a crowned roller on its race",
                    None => "Static load of a ball on its race",
                },
                names: [if self.roller { "roller" } else { "ball" }, "race"],
                upper: match self.crown {
                    Some(crown) => ([crown, radius], "crown along the axis, and roller"),
                    None => ([radius; 2], "ball"),
                },
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
            radius: relative,
            resolution: self.resolution.unwrap_or(pressed::RESOLUTION),
            half_width: None,
            made,
        };
        on_flat.text(asked)
    }
}

/// The loads of elastic bodies by Hertz.
struct ElasticLoads<'g> {
    given: &'g StaticLoad,
    contact: HertzContact,
    /// Load at first yield.
    first: f64,
    /// Poisson's ratio of the rolling element.
    poisson: f64,
}

impl ElasticLoads<'_> {
    /// Returns the loads by Hertz as comment lines.
    fn about(&self) -> String {
        let is_plane =
            self.given.roller && self.given.crown.is_none() && self.given.length.is_none();
        let unit = if is_plane { "N/mm" } else { "N" };
        let length = self.given.length();
        let load = |load: f64| format!("{} {unit}", significant(length * load, 4));
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
        text.push_str(&self.below());
        text.push_str(&format!(
            "The load factor of state C0 is its load over that of {} MPa.\n",
            self.given.rated().0
        ));
        if is_plane && self.given.race.is_some() {
            text.push_str(
                "The roller of the scene has the relative radius of roller and race, so that on a \
                 flat\nit has the same gap.\n",
            );
        }
        text
    }
}

impl ElasticLoads<'_> {
    /// Describes the largest shear stresses below the contact under the load at load factor 1.
    fn below(&self) -> String {
        let (stress, _) = self.given.rated();
        let load = self.contact.load_for_max_pressure(stress);
        let shear = self.contact.largest_shear(load, self.poisson);
        let (orthogonal, _) = self.contact.orthogonal_shears(load);
        let told = |stress: f64, depth: f64| {
            let (stress, depth) = (significant(stress, 4), significant(depth, 4));
            format!("{stress} MPa, {depth} mm below the surface")
        };
        format!(
            "Below a contact of {stress} MPa:\n  largest shear {}\n  orthogonal shear, amplitude \
             in rolling, {}\n",
            told(shear.stress, shear.depth),
            told(orthogonal.stress, orthogonal.depth)
        )
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
