//! `brinell hardness`: the figures of a hardness test, from the results of a ball on a flat.

use super::streams::{json, print, warn};
use super::table::{ColumnAlignment, Table, page_width, wrap};
use crate::analytical::{Indentation, contact_modulus};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::number::significant;
use crate::output::{self, Recorded};
use crate::results::State;
use crate::scene::Units;
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;

/// Contact radius over the ball's radius up to which strains are small: the representative plastic
/// strain, 0.2 a/R, is 4 % there.
///
/// # Source
/// D. Tabor, The Hardness of Metals (1951), chapter 5.
pub(super) const SMALL: f64 = 0.2;
/// Fraction of the largest force below which a state counts as unloaded: round-off.
const UNLOADED: f64 = 1e-9;
/// Number of significant digits printed: more than a mesh gives.
const DIGITS: usize = 5;

/// Arguments of `brinell hardness`.
#[derive(Debug, Args)]
pub(super) struct HardnessArguments {
    /// A directory that `brinell run` wrote for a scene of `brinell new hardness` or for an
    /// axisymmetric ball on a flat
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

/// The figures, as `--json` prints them; an unknown figure is `null`.
#[derive(Debug, Serialize)]
struct HardnessSheet {
    /// Version of the program.
    brinell: &'static str,
    /// State with the largest force.
    state: String,
    units: Option<Units>,
    ball_diameter: f64,
    force: f64,
    /// Approach of ball and flat.
    depth: f64,
    contact_radius: f64,
    contact_radius_over_ball_radius: f64,
    /// Brinell hardness, if the units are known.
    hbw: Option<f64>,
    mean_pressure: f64,
    /// Initial yield stress of the flat; null if it does not yield.
    yield_stress: Option<f64>,
    mean_pressure_over_yield_stress: Option<f64>,
    /// Pile-up or sink-in, `a^2/(2 R h)`.
    pile_up: f64,
    /// Depth of the dent after unloading.
    residual_depth: Option<f64>,
    rim_height: Option<f64>,
    /// Unloading stiffness, if the history follows the approach.
    unloading_stiffness: Option<f64>,
    reduced_modulus: Option<f64>,
    reduced_modulus_by_depth: Option<f64>,
    /// Contact modulus from the elastic constants of both bodies, to compare with the two moduli
    /// that are found from the unloading stiffness.
    contact_modulus: f64,
    /// Whether the contact is too wide for the assumption of small strains.
    beyond_small_strains: bool,
}

/// Prints the figures of a result directory.
pub(super) fn run(arguments: &HardnessArguments) -> Result<()> {
    let dir = &arguments.dir;
    if let Some(why) = output::stale(dir) {
        warn(&why);
    }
    let recorded = output::read(dir)?;
    let sheet = HardnessSheet::of(&recorded).map_err(|error| error.within(dir.display()))?;
    if sheet.beyond_small_strains {
        warn(&format!(
            "the contact radius is {} of the ball's: beyond {SMALL} strains are no longer small, \
             as they are taken to be, and these figures are no measure of a real test",
            significant(sheet.contact_radius_over_ball_radius, 3)
        ));
    }
    print(&match arguments.json {
        true => json(&sheet)?,
        false => sheet.text(),
    })
}

/// Returns the radius of the ball, if the scene is one of a ball on a flat.
fn ball(model: &Model) -> Option<f64> {
    let made = model.scene.mesh.cylinder_on_half_plane.as_ref()?;
    (model.scene.kind.is_axisymmetric() && model.materials.len() == 2).then_some(made.radius)
}

impl HardnessSheet {
    fn of(recorded: &Recorded) -> Result<HardnessSheet> {
        let (model, results) = (&recorded.model, &recorded.results);
        let radius = ball(model).ok_or_else(|| {
            Error::input(
                "no ball on a flat: scenes of `brinell new hardness` and `new ball-on-flat` make \
                 one (axisymmetric, mesh.cylinder_on_half_plane)",
            )
        })?;
        let by_force = |a: &&State, b: &&State| a.contact_force.total_cmp(&b.contact_force);
        let pressed = results.states.iter().max_by(by_force);
        let pressed = pressed.filter(|state| state.contact_force > 0.0);
        let pressed =
            pressed.ok_or_else(|| Error::input("in none of its states is there contact"))?;
        let test = Indentation::new(
            radius,
            pressed.approach,
            pressed.contact_force,
            pressed.half_width,
        )?;
        let is_free = |state: &&State| state.contact_force <= UNLOADED * pressed.contact_force;
        let free = results.states.iter().rev().find(is_free);
        let stiffness = results.unloading_stiffness();
        let [of_ball, flat] = [&model.materials[0], &model.materials[1]];
        let yield_stress = flat.yield_stress();
        let yield_stress = yield_stress.is_finite().then_some(yield_stress);
        let relative = test.contact_radius / radius;
        let units = model.scene.units.clone();
        Ok(HardnessSheet {
            brinell: env!("CARGO_PKG_VERSION"),
            state: pressed.name.clone(),
            ball_diameter: 2.0 * radius,
            force: test.force,
            depth: test.depth,
            contact_radius: test.contact_radius,
            contact_radius_over_ball_radius: relative,
            hbw: megapascals(units.as_ref()).map(|unit| unit * test.brinell_number()),
            units,
            mean_pressure: test.mean_pressure(),
            yield_stress,
            mean_pressure_over_yield_stress: yield_stress.map(|y| test.mean_pressure() / y),
            pile_up: test.pile_up(),
            residual_depth: free.map(|state| state.residual_depth),
            rim_height: free.map(|state| state.rim_height),
            unloading_stiffness: stiffness,
            reduced_modulus: stiffness.map(|s| test.reduced_modulus(s)),
            reduced_modulus_by_depth: stiffness.and_then(|s| test.reduced_modulus_by_depth(s)),
            contact_modulus: contact_modulus(
                of_ball.youngs_modulus,
                of_ball.poissons_ratio,
                flat.youngs_modulus,
                flat.poissons_ratio,
            ),
            beyond_small_strains: relative > SMALL,
        })
    }

    /// The figures of the table: name, value (`None` if unknown), unit, and what it is.
    fn rows(&self) -> [(&'static str, Option<f64>, String, &'static str); 16] {
        let unit = |of: fn(&Units) -> &str| self.units.as_ref().map_or("", of).to_string();
        let [length, force] = [unit(|u| &u.length), unit(|u| &u.force)];
        let stress = unit(|u| &u.stress);
        let stiffness = match self.units {
            Some(_) => format!("{force}/{length}"),
            None => String::new(),
        };
        let none = String::new;
        [
            (
                "diameter of the ball D",
                Some(self.ball_diameter),
                &length,
                "",
            ),
            ("force", Some(self.force), &force, ""),
            ("depth h", Some(self.depth), &length, "approach"),
            (
                "contact radius a",
                Some(self.contact_radius),
                &length,
                "under the load",
            ),
            (
                "a/R",
                Some(self.contact_radius_over_ball_radius),
                &none(),
                "",
            ),
            ("HBW", self.hbw, &none(), "ISO 6506, with d = 2 a"),
            (
                "mean pressure p_m",
                Some(self.mean_pressure),
                &stress,
                "force over pi a^2",
            ),
            (
                "yield stress Y of the flat",
                self.yield_stress,
                &stress,
                "initial",
            ),
            ("p_m/Y", self.mean_pressure_over_yield_stress, &none(), ""),
            (
                "a^2/(2 R h)",
                Some(self.pile_up),
                &none(),
                "> 1 piles up, < 1 sinks in",
            ),
            ("residual dent", self.residual_depth, &length, ""),
            ("rim beside it", self.rim_height, &length, ""),
            (
                "unloading stiffness S",
                self.unloading_stiffness,
                &stiffness,
                "first increment",
            ),
            (
                "modulus by S and a",
                self.reduced_modulus,
                &stress,
                "S/(2 a)",
            ),
            (
                "modulus by S and depth",
                self.reduced_modulus_by_depth,
                &stress,
                "Oliver, Pharr 1992",
            ),
            (
                "modulus of the materials",
                Some(self.contact_modulus),
                &stress,
                "E*",
            ),
        ]
        .map(|(name, value, unit, about)| (name, value, unit.clone(), about))
    }

    fn text(&self) -> String {
        let mut table = Table::new(&[
            (ColumnAlignment::Text, "figure"),
            (ColumnAlignment::Number, "value"),
            (ColumnAlignment::Text, "unit"),
            (ColumnAlignment::Text, "what it is"),
        ]);
        for (name, value, unit, about) in self.rows() {
            let value = value.map_or("unknown".to_string(), |v| significant(v, DIGITS));
            table.row([name.to_string(), value, unit, about.to_string()]);
        }
        let page = page_width();
        let notes = self.notes().into_iter().flat_map(|note| wrap(note, page));
        let notes: String = notes.map(|line| line + "\n").collect();
        format!(
            "Indentation in state {}\n\n{}\n{notes}",
            self.state,
            table.render(page)
        )
    }

    fn notes(&self) -> Vec<&'static str> {
        let mut notes = vec![
            "HBW takes the diameter of the contact under the load; the standard measures that of \
             the residual indent.",
        ];
        if self.hbw.is_none() {
            notes.push("HBW needs the scene's units, as `units = { stress = \"MPa\", ... }`.");
        }
        if self.unloading_stiffness.is_none() {
            notes.push(
                "The stiffness needs a history that follows the approach, as `program.history = \
                 [\"ball.top\"]`, and a load that is taken off.",
            );
        }
        notes
    }
}

/// Returns the unit of stress in MPa, if it is consistent with the units of length and force.
fn megapascals(units: Option<&Units>) -> Option<f64> {
    let units = units.filter(|units| units.mismatch().is_none())?;
    Some(units.pascals()? * 1e-6)
}
