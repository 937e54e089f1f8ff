//! Hertz's contact for any curvatures: a circle, an ellipse or a line.

use super::{HertzEllipse, HertzLine, Peak, RelativeRadii};
use crate::error::Result;

/// Frictionless contact of elastic bodies: [`HertzLine`] if both bodies are flat along one
/// direction, otherwise [`HertzEllipse`], which includes the circle.
///
/// A load is a force, or for a line contact a force per length. Units are any consistent ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HertzContact {
    /// A contact along a line.
    Line(HertzLine),
    /// A contact in a point; the larger half axis lies along the first of the radii.
    Ellipse(HertzEllipse),
}

impl HertzContact {
    /// The contact of bodies with these relative radii and this contact modulus.
    ///
    /// # Errors
    /// `Input` if the modulus is not finite and positive.
    pub fn new(relative: RelativeRadii, contact_modulus: f64) -> Result<Self> {
        let [large, small] = relative.radii;
        Ok(match large.is_infinite() {
            true => HertzContact::Line(HertzLine::new(small, contact_modulus)?),
            false => HertzContact::Ellipse(HertzEllipse::new([large, small], contact_modulus)?),
        })
    }

    /// Half axes, the larger one first; for a line contact infinity and the half width.
    pub fn semi_axes(&self, load: f64) -> [f64; 2] {
        match self {
            HertzContact::Line(line) => [f64::INFINITY, line.half_width(load)],
            HertzContact::Ellipse(ellipse) => ellipse.semi_axes(load),
        }
    }

    /// Greatest pressure, at the centre of the contact.
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

    /// Largest shear stress below the centre of the contact, in a body with Poisson's ratio
    /// `poisson`.
    pub fn largest_shear(&self, load: f64, poisson: f64) -> Peak {
        match self {
            HertzContact::Line(line) => line.largest_shear(load, poisson),
            HertzContact::Ellipse(ellipse) => ellipse.largest_shear(load, poisson),
        }
    }

    /// Largest von Mises stress below the centre of the contact, in a body with Poisson's ratio
    /// `poisson`.
    pub fn largest_von_mises(&self, load: f64, poisson: f64) -> Peak {
        match self {
            HertzContact::Line(line) => line.largest_von_mises(load, poisson),
            HertzContact::Ellipse(ellipse) => ellipse.largest_von_mises(load, poisson),
        }
    }

    /// Amplitude of the shear stress parallel to the surface for rolling along the smaller half
    /// axis and, for a point contact, for rolling along the larger one.
    pub fn orthogonal_shears(&self, load: f64) -> (Peak, Option<Peak>) {
        match self {
            HertzContact::Line(line) => (line.orthogonal_shear(load), None),
            HertzContact::Ellipse(ellipse) => {
                let [larger, smaller] = [0, 1].map(|axis| ellipse.orthogonal_shear(axis, load));
                (smaller, Some(larger))
            }
        }
    }

    /// Load at which a body with this Poisson's ratio and tensile yield stress first yields
    /// according to von Mises.
    pub fn yield_load(&self, poisson: f64, yield_stress: f64) -> f64 {
        match self {
            HertzContact::Line(line) => line.yield_load(poisson, yield_stress),
            HertzContact::Ellipse(ellipse) => ellipse.yield_load(poisson, yield_stress),
        }
    }
}
