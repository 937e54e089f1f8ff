//! Evaluation of an indentation by a ball: Brinell's hardness, the pile-up, and the modulus from
//! the initial stiffness of unloading.

use super::domain::positive;
use crate::error::{Error, Result};
use std::f64::consts::PI;

/// An indentation by a ball, under its largest load. Units are any consistent ones; forces and
/// depths are positive into the body.
///
/// ```
/// use brinell::analytical::Indentation;
/// // An elastic contact, Hertz: a^2 = R h, P = 4/3 E* a h, S = 2 E* a.
/// let elastic = Indentation::new(10.0, 0.1, 4.0 / 3.0 * 5e4 * 0.1, 1.0).unwrap();
/// assert!((elastic.pile_up() - 0.5).abs() < 1e-15);
/// assert!((elastic.reduced_modulus(2.0 * 5e4) / 5e4 - 1.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indentation {
    /// Radius of the ball.
    pub radius: f64,
    /// Depth of the indentation: the approach of ball and body.
    pub depth: f64,
    /// Force on the ball.
    pub force: f64,
    /// Radius of the contact under the load.
    pub contact_radius: f64,
}

impl Indentation {
    /// Kilogram-force over newton, `1/9.80665` rounded as in the standard.
    ///
    /// # Source
    /// ISO 6506-1.
    const STANDARD: f64 = 0.102;
    /// Oliver and Pharr's `epsilon` for a paraboloid of revolution.
    ///
    /// # Source
    /// W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564, doi:10.1557/JMR.1992.1564.
    const PARABOLOID: f64 = 0.75;

    /// An indentation to the depth `depth` by the force `force`, with a contact out to
    /// `contact_radius`.
    ///
    /// # Errors
    /// `Input` if a value is not finite and positive, or if the contact is wider than the ball.
    pub fn new(radius: f64, depth: f64, force: f64, contact_radius: f64) -> Result<Self> {
        let of = |name, value| positive("indentation", name, value);
        if contact_radius > radius {
            return Err(Error::input(format!(
                "indentation: the contact radius {contact_radius} is larger than the ball's, \
                 {radius}"
            )));
        }
        Ok(Indentation {
            radius: of("radius", radius)?,
            depth: of("depth", depth)?,
            force: of("force", force)?,
            contact_radius: of("contact radius", contact_radius)?,
        })
    }

    /// Contact area `A = pi a^2`.
    pub fn area(&self) -> f64 {
        PI * self.contact_radius * self.contact_radius
    }

    /// Mean pressure `p_m = P/(pi a^2)`, which is Meyer's hardness.
    pub fn mean_pressure(&self) -> f64 {
        self.force / self.area()
    }

    /// Brinell's hardness as a stress, the force over the area of the spherical cap of the indent,
    ///
    /// ```text
    /// 2 P/(pi D (D - (D^2 - d^2)^(1/2))),  D = 2 R, d = 2 a
    /// ```
    ///
    /// The standard measures `d` on the indent that remains after unloading; here `d` belongs to
    /// the contact under the load.
    ///
    /// # Source
    /// ISO 6506-1.
    pub fn brinell_stress(&self) -> f64 {
        let [ball, indent] = [2.0 * self.radius, 2.0 * self.contact_radius];
        // Computes D - (D^2 - d^2)^(1/2) without a difference of nearly equal numbers.
        let sagitta = indent * indent / (ball + (ball * ball - indent * indent).sqrt());
        2.0 * self.force / (PI * ball * sagitta)
    }

    /// Brinell's hardness number HBW, if force and lengths are in N and mm (stresses in MPa):
    /// `0.102` [`Self::brinell_stress`].
    ///
    /// ```
    /// use brinell::analytical::Indentation;
    /// // Tables of ISO 6506: HBW 10/3000, an indent of 4 mm under 29420 N is 229.
    /// let test = Indentation::new(5.0, 0.4, 29420.0, 2.0).unwrap();
    /// assert_eq!(test.brinell_number().round(), 229.0);
    /// ```
    ///
    /// # Source
    /// ISO 6506-1.
    pub fn brinell_number(&self) -> f64 {
        Self::STANDARD * self.brinell_stress()
    }

    /// Pile-up `c^2 = a^2/(2 R h)`: more than 1 if the surface is piled up around the ball, less
    /// than 1 if it has sunk in; 1/2 in an elastic contact.
    ///
    /// # Source
    /// R. Hill, B. Storakers, A. B. Zdunek, Proc. R. Soc. A 423 (1989) 301,
    /// doi:10.1098/rspa.1989.0056.
    pub fn pile_up(&self) -> f64 {
        self.contact_radius * self.contact_radius / (2.0 * self.radius * self.depth)
    }

    /// Reduced modulus `E_r = pi^(1/2)/2 S/A^(1/2)` from the initial stiffness `S` of unloading and
    /// the area of the contact.
    ///
    /// # Source
    /// G. M. Pharr, W. C. Oliver, F. R. Brotzen, J. Mater. Res. 7 (1992) 613,
    /// doi:10.1557/JMR.1992.0613.
    pub fn reduced_modulus(&self, stiffness: f64) -> f64 {
        of_area(stiffness, self.area())
    }

    /// Reduced modulus from a measurement that does not show the contact area: the area is that of
    /// the ball's cap at the depth `h_c = h - 0.75 P/S`. `None` if this depth or area is not
    /// positive.
    ///
    /// # Source
    /// W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564, doi:10.1557/JMR.1992.1564.
    pub fn reduced_modulus_by_depth(&self, stiffness: f64) -> Option<f64> {
        let depth = self.depth - Self::PARABOLOID * self.force / stiffness;
        let area = PI * depth * (2.0 * self.radius - depth);
        (depth > 0.0 && area > 0.0).then(|| of_area(stiffness, area))
    }
}

fn of_area(stiffness: f64, area: f64) -> f64 {
    0.5 * (PI / area).sqrt() * stiffness
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analytical::HertzPoint;

    /// An elastic contact unloads as it was loaded: both moduli equal the contact modulus, the
    /// modulus by depth only up to `h_c/(2 R)`, because the ball is not a paraboloid.
    #[test]
    fn an_elastic_contact_gives_its_modulus() {
        let (radius, modulus, load) = (5.0, 1e5, 100.0);
        let hertz = HertzPoint::new(radius, modulus).unwrap();
        let (depth, contact_radius) = (hertz.approach(load), hertz.contact_radius(load));
        let test = Indentation::new(radius, depth, load, contact_radius).unwrap();
        let stiffness = 1.5 * load / depth;
        assert!((test.reduced_modulus(stiffness) / modulus - 1.0).abs() < 1e-12);
        let by_depth = test.reduced_modulus_by_depth(stiffness).unwrap();
        assert!((by_depth / modulus - 1.0).abs() < depth / radius);
        assert!((test.mean_pressure() / hertz.max_pressure(load) * 1.5 - 1.0).abs() < 1e-12);
        // The indentation is shallow, so the cap is about as large as the circle.
        assert!((test.brinell_stress() / test.mean_pressure() - 1.0).abs() < depth / radius);
        // A stiffness too small for the depth: the resulting contact depth is not positive.
        assert_eq!(test.reduced_modulus_by_depth(0.5 * load / depth), None);
    }

    #[test]
    fn what_is_no_indentation_is_refused() {
        for (radius, depth, force, contact) in [
            (5.0, 0.1, 1.0, 5.1),
            (5.0, 0.0, 1.0, 1.0),
            (5.0, 0.1, f64::NAN, 1.0),
            (-5.0, 0.1, 1.0, -6.0),
        ] {
            assert!(Indentation::new(radius, depth, force, contact).is_err());
        }
    }
}
