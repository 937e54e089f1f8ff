//! Hertz's pressure over a contact, if the scene names it as a reference.

use super::moduli;
use crate::analytical::{HertzLine, HertzPoint};
use crate::model::Model;

/// Returns the pressure of an elastic contact under a load, over the distance from its middle, at
/// the ends of `parts` equal parts from the middle to the edge. `None` if the scene names neither a
/// line nor a point contact of Hertz.
pub fn hertz_pressure(model: &Model, load: f64, parts: usize) -> Option<Vec<[f64; 2]>> {
    let references = &model.scene.reference;
    let line = references.iter().find_map(|r| r.hertz_line);
    let point = references.iter().find_map(|r| r.hertz_point);
    let (modulus, ..) = moduli(model)?;
    let curve = |width: f64, at: &dyn Fn(f64) -> f64| {
        let place = |k: usize| width * k as f64 / parts as f64;
        (0..=parts).map(|k| [place(k), at(place(k))]).collect()
    };
    if let Some(line) = line {
        let hertz = HertzLine::new(line.radius, modulus).ok()?;
        return Some(curve(hertz.half_width(load), &|x| hertz.pressure(x, load)));
    }
    let hertz = HertzPoint::new(point?.radius, modulus).ok()?;
    Some(curve(hertz.contact_radius(load), &|r| {
        hertz.pressure(r, load)
    }))
}
