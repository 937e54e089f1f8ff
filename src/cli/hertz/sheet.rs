//! The figures of a Hertz contact.

use super::bodies::ContactingBody;
use crate::analytical::{HertzContact, HertzLine, Peak, RelativeRadii};
use crate::scene::Units;
use serde::Serialize;
use std::f64::consts::PI;

/// A contact whose figures are asked for.
pub(super) struct AskedContact {
    pub contact: HertzContact,
    pub relative: RelativeRadii,
    /// Contact modulus.
    pub modulus: f64,
    /// Load; per length in a line contact.
    pub load: f64,
    pub length: Option<f64>,
    pub depth: Option<f64>,
    pub bodies: [ContactingBody; 2],
    pub units: Units,
}

/// All figures, as `--json` prints them. A figure that does not exist, such as the larger half axis
/// of a line, is `null`.
#[derive(Debug, Serialize)]
pub(super) struct Sheet {
    /// Version of the program.
    pub brinell: &'static str,
    /// `point`, `ellipse` or `line`.
    pub contact: &'static str,
    pub units: Units,
    /// Larger and smaller relative radius.
    pub relative_radii: [Option<f64>; 2],
    /// Degrees from the first principal plane of the first body to the larger half axis.
    pub direction: f64,
    pub contact_modulus: f64,
    /// Load; per length in a line contact.
    pub load: f64,
    /// Length of a line contact, and the load over that length.
    pub length: Option<f64>,
    pub total_load: Option<f64>,
    pub max_pressure: f64,
    pub mean_pressure: f64,
    /// Larger and smaller half axis.
    pub semi_axes: [Option<f64>; 2],
    /// Area of the contact; none for a line without a length.
    pub area: Option<f64>,
    pub approach: Option<f64>,
    /// Slope of the load over the approach.
    pub stiffness: Option<f64>,
    pub orthogonal_shear: OrthogonalShear,
    pub bodies: [BodySheet; 2],
}

/// Amplitude of the shear parallel to the surface, for rolling along the smaller and along the
/// larger half axis.
#[derive(Debug, Serialize)]
pub(super) struct OrthogonalShear {
    pub along_smaller: PeakSheet,
    pub along_larger: Option<PeakSheet>,
}

/// A largest stress and its depth.
#[derive(Debug, Serialize)]
pub(super) struct PeakSheet {
    pub stress: f64,
    pub depth: f64,
}

/// A body, and the stresses in it below the centre of the contact.
#[derive(Debug, Serialize)]
pub(super) struct BodySheet {
    pub name: &'static str,
    /// Principal radii; `null` is flat.
    pub radii: [Option<f64>; 2],
    pub material: Option<String>,
    /// Young's modulus; `null` is rigid.
    pub youngs_modulus: Option<f64>,
    pub poissons_ratio: f64,
    pub yield_stress: Option<f64>,
    pub largest_shear: Option<PeakSheet>,
    pub largest_von_mises: Option<PeakSheet>,
    /// First yield of the body, if it can yield.
    pub first_yield: Option<ContactAtYield>,
}

/// The contact at the first yield of a body, by von Mises' criterion.
#[derive(Debug, Serialize)]
pub(super) struct ContactAtYield {
    /// Load; per length in a line contact.
    pub load: f64,
    pub max_pressure: f64,
    pub depth: f64,
}

/// Returns the number if it is finite.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl From<Peak> for PeakSheet {
    fn from(peak: Peak) -> Self {
        PeakSheet {
            stress: peak.stress,
            depth: peak.depth,
        }
    }
}

impl Sheet {
    pub fn new(asked: AskedContact) -> Sheet {
        let (contact, load) = (&asked.contact, asked.load);
        let [large, small] = contact.semi_axes(load);
        let max_pressure = contact.max_pressure(load);
        let (name, mean, area) = match contact {
            HertzContact::Line(_) => {
                let area = asked.length.map(|length| 2.0 * small * length);
                ("line", 0.25 * PI * max_pressure, area)
            }
            HertzContact::Ellipse(_) => {
                let name = if large == small { "point" } else { "ellipse" };
                (name, max_pressure / 1.5, Some(PI * large * small))
            }
        };
        let approach = asked.approach();
        let stiffness = match contact {
            HertzContact::Ellipse(_) => approach.map(|approach| 1.5 * load / approach),
            HertzContact::Line(_) => None,
        };
        let (smaller, larger) = contact.orthogonal_shears(load);
        Sheet {
            brinell: env!("CARGO_PKG_VERSION"),
            contact: name,
            relative_radii: asked.relative.radii.map(finite),
            direction: asked.relative.direction,
            contact_modulus: asked.modulus,
            load,
            length: asked.length,
            total_load: asked.length.map(|length| load * length),
            max_pressure,
            mean_pressure: mean,
            semi_axes: [large, small].map(finite),
            area,
            approach,
            stiffness,
            orthogonal_shear: OrthogonalShear {
                along_smaller: smaller.into(),
                along_larger: larger.map(PeakSheet::from),
            },
            bodies: [("first", 0), ("second", 1)].map(|(name, i)| asked.body(name, i)),
            units: asked.units,
        }
    }
}

impl AskedContact {
    fn body(&self, name: &'static str, index: usize) -> BodySheet {
        let (contact, body) = (&self.contact, &self.bodies[index]);
        let poisson = body.poissons_ratio;
        // For a rigid body only the pressure is known.
        let inside = |peak: Peak| (!body.is_rigid()).then(|| peak.into());
        BodySheet {
            name,
            radii: body.radii.map(finite),
            material: body.material.clone(),
            youngs_modulus: finite(body.youngs_modulus),
            poissons_ratio: poisson,
            yield_stress: body.yield_stress,
            largest_shear: inside(contact.largest_shear(self.load, poisson)),
            largest_von_mises: inside(contact.largest_von_mises(self.load, poisson)),
            first_yield: body.yield_load(contact).map(|load| ContactAtYield {
                load,
                max_pressure: contact.max_pressure(load),
                depth: contact.largest_von_mises(load, poisson).depth,
            }),
        }
    }

    /// Returns the approach of points far from a point contact; for a line contact the compression
    /// of both bodies, if it is known for both.
    fn approach(&self) -> Option<f64> {
        match &self.contact {
            HertzContact::Ellipse(ellipse) => Some(ellipse.approach(self.load)),
            HertzContact::Line(line) => {
                let [first, second] = [0, 1].map(|i| self.compression(line, &self.bodies[i]));
                Some(first? + second?)
            }
        }
    }

    /// Returns the compression from the contact to the axis of a cylinder, or to the reference
    /// depth of a flat body; `None` for a body with a hollow surface.
    fn compression(&self, line: &HertzLine, body: &ContactingBody) -> Option<f64> {
        let [young, poisson] = body.elastic();
        let curved = body.radii.into_iter().find(|radius| radius.is_finite());
        match curved {
            _ if body.is_rigid() => Some(0.0),
            Some(radius) if radius > 0.0 => {
                Some(line.cylinder_compression(self.load, radius, young, poisson))
            }
            Some(_) => None,
            None => {
                let depth = self.depth?;
                Some(line.half_space_compression(self.load, depth, young, poisson))
            }
        }
    }
}
