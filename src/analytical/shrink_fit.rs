//! Shrink fit of a shaft in a ring.

use super::domain::{between, poisson as check_poisson, positive};
use super::{Plane, ThickCylinder};
use crate::error::{Error, Result};

/// Elastic interference fit of a solid or hollow shaft in a ring; the materials may differ.
///
/// The pressure closes the interference: `p = d/(u_ring(p = 1) - u_shaft(p = 1))`. For a solid
/// shaft and a ring of one material in plane stress `p = E d (b^2 - a^2)/(2 a b^2)`, with `d` on
/// the *radius*. Frictionless; units are any consistent ones.
///
/// # Source
/// S. Timoshenko, *Strength of Materials*, Part II, 3rd ed. 1956, ch. VI (shrink-fit pressures of
/// built-up cylinders); the fields are Lame's, see [`ThickCylinder`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShrinkFit {
    /// Interference on the radius: radius of the free shaft minus radius of the free bore.
    pub interference: f64,
    /// The ring; its inner radius is the contact radius.
    pub ring: ThickCylinder,
    /// Inner radius of the shaft; 0 for a solid shaft.
    pub shaft_bore: f64,
    /// Young's modulus of the shaft.
    pub shaft_young: f64,
    /// Poisson's ratio of the shaft.
    pub shaft_poisson: f64,
}

impl ShrinkFit {
    /// A fit of a shaft in `ring` with the radial interference `interference >= 0`, both in the
    /// ring's plane idealisation.
    ///
    /// # Errors
    /// `Input` if the interference is negative or not finite, if the bore of the shaft is not
    /// smaller than the contact radius, or if the constants of the shaft are out of range.
    pub fn new(
        interference: f64,
        ring: ThickCylinder,
        shaft_bore: f64,
        shaft_young: f64,
        shaft_poisson: f64,
    ) -> Result<Self> {
        let what = "shrink fit";
        if shaft_bore >= ring.inner_radius {
            return Err(Error::input(format!(
                "{what}: the bore {shaft_bore} of the shaft must be less than the contact radius \
                 {}",
                ring.inner_radius
            )));
        }
        Ok(ShrinkFit {
            interference: between(what, "interference", interference, 0.0, f64::MAX)?,
            ring,
            shaft_bore: between(what, "bore of the shaft", shaft_bore, 0.0, f64::MAX)?,
            shaft_young: positive(what, "Young's modulus of the shaft", shaft_young)?,
            shaft_poisson: check_poisson(what, shaft_poisson)?,
        })
    }

    /// Contact pressure between shaft and ring.
    pub fn pressure(&self) -> f64 {
        let a = self.ring.inner_radius;
        self.interference / (self.ring.displacement(a, 1.0, 0.0) - self.shaft_displacement(a, 1.0))
    }

    /// Stresses `[s_rr, s_tt (hoop), s_zz]` in the ring at the radius `r`.
    pub fn ring_stress(&self, r: f64) -> [f64; 3] {
        self.ring.stress(r, self.pressure(), 0.0)
    }

    /// Stresses `[s_rr, s_tt (hoop), s_zz]` in the shaft at the radius `r`.
    pub fn shaft_stress(&self, r: f64) -> [f64; 3] {
        let pressure = self.pressure();
        match self.hollow_shaft() {
            Some(shaft) => shaft.stress(r, 0.0, pressure),
            None => {
                let out_of_plane = self
                    .plane()
                    .out_of_plane(-2.0 * pressure, self.shaft_poisson);
                [-pressure, -pressure, out_of_plane]
            }
        }
    }

    /// Interference at which the ring first yields according to von Mises, at its bore.
    pub fn ring_yield_interference(&self, yield_stress: f64) -> f64 {
        let a = self.ring.inner_radius;
        let compliance = self.ring.displacement(a, 1.0, 0.0) - self.shaft_displacement(a, 1.0);
        self.ring.yield_pressure(yield_stress) * compliance
    }

    fn plane(&self) -> Plane {
        self.ring.plane
    }

    fn hollow_shaft(&self) -> Option<ThickCylinder> {
        (self.shaft_bore > 0.0).then_some(ThickCylinder {
            inner_radius: self.shaft_bore,
            outer_radius: self.ring.inner_radius,
            young: self.shaft_young,
            poisson: self.shaft_poisson,
            plane: self.plane(),
        })
    }

    /// Radial displacement of the shaft at `r` under the pressure `pressure`, negative because
    /// inwards.
    fn shaft_displacement(&self, r: f64, pressure: f64) -> f64 {
        match self.hollow_shaft() {
            Some(shaft) => shaft.displacement(r, 0.0, pressure),
            None => {
                let bulk = 0.5 * (self.plane().kolosov(self.shaft_poisson) - 1.0);
                -(1.0 + self.shaft_poisson) / self.shaft_young * bulk * pressure * r
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(plane: Plane) -> ThickCylinder {
        ThickCylinder::new(50.0, 100.0, 210e3, 0.3, plane).unwrap()
    }

    #[test]
    fn solid_shaft_of_the_same_material() {
        let fit = ShrinkFit::new(0.05, ring(Plane::Stress), 0.0, 210e3, 0.3).unwrap();
        assert!((fit.pressure() - 78.75).abs() < 1e-12);
        assert_eq!(fit.shaft_stress(20.0)[0], -fit.pressure());
        assert!((fit.ring_stress(50.0)[0] + 78.75).abs() < 1e-12);
        // In plane strain the plane modulus takes the place of E.
        let strain = ShrinkFit::new(0.05, ring(Plane::Strain), 0.0, 210e3, 0.3).unwrap();
        assert!((strain.pressure() * 0.91 / 78.75 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn surfaces_meet_for_any_pair() {
        for plane in [Plane::Strain, Plane::Stress] {
            let fit = ShrinkFit::new(0.03, ring(plane), 20.0, 70e3, 0.33).unwrap();
            let p = fit.pressure();
            let opening = fit.ring.displacement(50.0, p, 0.0) - fit.shaft_displacement(50.0, p);
            assert!((opening / 0.03 - 1.0).abs() < 1e-14);
            assert!(fit.shaft_stress(20.0)[0].abs() < 1e-13 * p);
            assert!((fit.shaft_stress(50.0)[0] / -p - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_small_bore_tends_to_solid_and_yield_scales() {
        let solid = ShrinkFit::new(0.05, ring(Plane::Stress), 0.0, 210e3, 0.3).unwrap();
        let bored = ShrinkFit::new(0.05, ring(Plane::Stress), 1e-4, 210e3, 0.3).unwrap();
        assert!((bored.pressure() / solid.pressure() - 1.0).abs() < 1e-11);
        let d = solid.ring_yield_interference(240.0);
        let at_yield = ShrinkFit {
            interference: d,
            ..solid
        };
        let equivalent = super::super::von_mises(at_yield.ring_stress(50.0), 0.0);
        assert!((equivalent / 240.0 - 1.0).abs() < 1e-14);
        assert!(ShrinkFit::new(0.05, ring(Plane::Stress), 50.0, 1.0, 0.3).is_err());
        assert!(ShrinkFit::new(-0.05, ring(Plane::Stress), 0.0, 1.0, 0.3).is_err());
    }
}
