//! Size of the contact of generated curved bodies, to which the mesh is fitted. Hertz's theory is
//! used for this size only, as for cylinders.

use super::EllipseSize;
use super::contact_size::{FULLY_PLASTIC, PILE_UP};
use crate::analytical::{HertzEllipse, contact_modulus};
use crate::error::{Error, Result};
use crate::scene::{CurvedBodies, Direction, History, Load, Scene, TargetFigure, Unit};
use std::f64::consts::PI;

/// Factor by which the mesh of an elastic contact is wider than Hertz's contact, so that results
/// can be evaluated beside its edge.
const ROOM: f64 = 1.15;

/// The size of the contact at first yield, and the largest size in the load program.
///
/// # Errors
/// `Input` if a body has no material, if the radii leave no gap, or if no body has a yield stress
/// and the half axes at first yield are not given.
pub(crate) fn of(scene: &Scene, p: &CurvedBodies) -> Result<EllipseSize> {
    let hertz = hertz(scene, p)?;
    let yielding = yield_load(scene, p, &hertz);
    let semi_axes = match (p.semi_axes, yielding) {
        (Some(given), _) => given,
        (None, Some(load)) => hertz.semi_axes(load),
        (None, None) => {
            return Err(Error::input(
                "mesh.curved_bodies: no body has a yield stress, so the half axes of the contact \
                 at yield are unknown; give `semi_axes`",
            ));
        }
    };
    let reach = match p.contact_width {
        Some(width) => width,
        None => reach(scene, p, &hertz, yielding, semi_axes).unwrap_or(0.0),
    };
    Ok(EllipseSize { semi_axes, reach })
}

fn hertz(scene: &Scene, p: &CurvedBodies) -> Result<HertzEllipse> {
    let of = |body: &str| {
        scene.material_of(body).ok_or_else(|| {
            Error::input(format!(
                "the generator curved_bodies needs a body `{body}` with a material"
            ))
        })
    };
    let (a, b) = (of(&p.names[0])?, of(&p.names[1])?);
    let modulus = contact_modulus(
        a.youngs_modulus,
        a.poissons_ratio,
        b.youngs_modulus,
        b.poissons_ratio,
    );
    let radii = HertzEllipse::relative_radii(p.upper, p.lower)
        .map_err(|error| error.within("mesh.curved_bodies"))?;
    HertzEllipse::new(radii, modulus)
}

/// Load at first yield of the weaker body.
fn yield_load(scene: &Scene, p: &CurvedBodies, hertz: &HertzEllipse) -> Option<f64> {
    let bodies = p.names.iter().filter_map(|name| {
        let (body, material) = (scene.bodies.get(name)?, scene.material_of(name)?);
        let yield_stress = body.largest_yield_stress(&material)?;
        Some(hertz.yield_load(material.poissons_ratio, yield_stress))
    });
    bodies.reduce(f64::min)
}

/// The widest contact of the load program relative to the contact at first yield. Elastic half axes
/// grow with the cube root of the load. Beyond first yield the mean pressure only rises, so the
/// area grows no faster than the load. `None` if the loads do not determine the contact.
fn reach(
    scene: &Scene,
    p: &CurvedBodies,
    hertz: &HertzEllipse,
    yielding: Option<f64>,
    semi_axes: [f64; 2],
) -> Option<f64> {
    let targets = scene.program.targets.iter();
    let largest = |m: f64, value: f64| m.max(value.abs());
    let factor = targets
        .clone()
        .filter_map(|t| t.load_factor)
        .fold(0.0, largest);
    let asked = targets
        .clone()
        .filter_map(|t| t.half_width)
        .fold(0.0, largest);
    let figure = |figure| {
        let values = targets.clone().filter_map(move |t| t.value_of(figure));
        values.fold(0.0, largest)
    };
    let area = figure(TargetFigure::ContactArea) / (PI * semi_axes[0] * semi_axes[1]);
    let asked = asked.max(area.sqrt());
    let mut force = 0.0;
    for load in &scene.load {
        force += match &load.history {
            History::Proportional if scene.program.unit == Unit::Yield => factor * yielding?,
            History::Proportional => factor * normal_force(load, p, semi_axes),
            History::Constant => normal_force(load, p, semi_axes),
            History::Table(rows) => {
                let times = rows.iter().map(|row| row[1]).fold(0.0, largest);
                times * normal_force(load, p, semi_axes)
            }
        };
    }
    let force = force.max(figure(TargetFigure::ContactForce));
    let dent = figure(TargetFigure::ResidualDepth);
    let depth = figure(TargetFigure::Approach).max(match yielding {
        Some(load) if dent > 0.0 => depth_with_dent(hertz, load, dent),
        _ => dent,
    });
    let pressed = (0..2).map(|i| (2.0 * PILE_UP * hertz.radii[i] * depth).sqrt() / semi_axes[i]);
    let asked = pressed.fold(asked, f64::max);
    let elastic = ROOM * hertz.semi_axes(force)[0] / semi_axes[0];
    let plastic = yielding.filter(|at| force > *at).map_or(0.0, |at| {
        (force / at).sqrt() * hertz.semi_axes(at)[0] / semi_axes[0]
    });
    Some(elastic.max(plastic).max(ROOM * asked))
}

/// Upper bound of the depth to which the bodies are pressed together to leave a dent: the dent plus
/// the elastic sinking `P/(2 a E*)` of a fully plastic contact of radius `a` and load `3 Y pi a^2`
/// (I. Sneddon, Int. J. Engng Sci. 3 (1965) 47), where `a^2` is at most `2 R` times the depth and
/// the pile-up. The mean pressure at first yield is used as an upper bound of `Y`.
fn depth_with_dent(hertz: &HertzEllipse, at_yield: f64, dent: f64) -> f64 {
    let [a, b] = hertz.semi_axes(at_yield);
    let yield_strain = at_yield / (PI * a * b * hertz.contact_modulus);
    let slope = 0.5 * FULLY_PLASTIC * PI * yield_strain;
    let radius = hertz.radii.into_iter().fold(0.0, f64::max);
    // Solves d = dent + slope a and a^2 = c d for a.
    let c = 2.0 * PILE_UP * radius;
    let a = 0.5 * (c * slope + ((c * slope).powi(2) + 4.0 * c * dent).sqrt());
    dent + slope * a
}

/// Total force along z of a load on the cut surface of the whole model.
fn normal_force(load: &Load, p: &CurvedBodies, semi_axes: [f64; 2]) -> f64 {
    let size = p.far_size * semi_axes[0].max(semi_axes[1]);
    let area = 4.0 * size * size;
    load.pushes_along(Direction::Z, |total| total, |stress| stress * area)
}
