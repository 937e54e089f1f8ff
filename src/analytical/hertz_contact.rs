//! Hertz's contact, whatever the curvatures: a circle, an ellipse or a line.

use super::{HertzEllipse, HertzLine, Peak, RelativeRadii};
use crate::error::Result;

/// Frictionless contact of elastic bodies: [`HertzLine`] where both are flat along a direction,
/// else [`HertzEllipse`], of which a circle is one.
///
/// A load is a force, of a line a force per length. Units are consistent, any.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HertzContact {
    /// Bodies that touch along a line.
    Line(HertzLine),
    /// Bodies that touch in a point; the larger half axis lies along the first of the radii.
    Ellipse(HertzEllipse),
}

impl HertzContact {
    /// The contact of bodies with these relative radii and contact modulus.
    ///
    /// # Errors
    /// Where the modulus is not finite and positive.
    pub fn new(relative: RelativeRadii, contact_modulus: f64) -> Result<Self> {
        let [large, small] = relative.radii;
        Ok(match large.is_infinite() {
            true => HertzContact::Line(HertzLine::new(small, contact_modulus)?),
            false => HertzContact::Ellipse(HertzEllipse::new([large, small], contact_modulus)?),
        })
    }

    /// Half axes, the larger one first; of a line it is infinite, the other one its half width.
    pub fn semi_axes(&self, load: f64) -> [f64; 2] {
        match self {
            HertzContact::Line(line) => [f64::INFINITY, line.half_width(load)],
            HertzContact::Ellipse(ellipse) => ellipse.semi_axes(load),
        }
    }

    /// Greatest pressure, in the middle.
    pub fn max_pressure(&self, load: f64) -> f64 {
        match self {
            HertzContact::Line(line) => line.max_pressure(load),
            HertzContact::Ellipse(ellipse) => ellipse.max_pressure(load),
        }
    }

    /// Load at which the greatest pressure is `pressure`.
    pub fn load_for_max_pressure(&self, pressure: f64) -> f64 {
        match self {
            HertzContact::Line(line) => line.load_for_max_pressure(pressure),
            HertzContact::Ellipse(ellipse) => ellipse.load_for_max_pressure(pressure),
        }
    }

    /// Largest shear below the middle of a body with Poisson's ratio `poisson`.
    pub fn largest_shear(&self, load: f64, poisson: f64) -> Peak {
        match self {
            HertzContact::Line(line) => line.largest_shear(load, poisson),
            HertzContact::Ellipse(ellipse) => ellipse.largest_shear(load, poisson),
        }
    }

    /// Largest von Mises stress below the middle of a body with Poisson's ratio `poisson`.
    pub fn largest_von_mises(&self, load: f64, poisson: f64) -> Peak {
        match self {
            HertzContact::Line(line) => line.largest_von_mises(load, poisson),
            HertzContact::Ellipse(ellipse) => ellipse.largest_von_mises(load, poisson),
        }
    }

    /// Amplitude of the shear parallel to the surface for rolling along the smaller half axis, and
    /// of a point contact along the larger one.
    pub fn orthogonal_shears(&self, load: f64) -> (Peak, Option<Peak>) {
        match self {
            HertzContact::Line(line) => (line.orthogonal_shear(load), None),
            HertzContact::Ellipse(ellipse) => {
                let [larger, smaller] = [0, 1].map(|axis| ellipse.orthogonal_shear(axis, load));
                (smaller, Some(larger))
            }
        }
    }

    /// Load at which a body with this Poisson's ratio and tensile yield stress first yields after
    /// von Mises.
    pub fn yield_load(&self, poisson: f64, yield_stress: f64) -> f64 {
        match self {
            HertzContact::Line(line) => line.yield_load(poisson, yield_stress),
            HertzContact::Ellipse(ellipse) => ellipse.yield_load(poisson, yield_stress),
        }
    }
}
