//! Materials of the bodies of a contact.

use crate::analytical::HertzContact;
use crate::cli::materials::of_list;
use crate::cli::values::{poissons_ratio, positive};
use crate::error::{Error, Result};
use crate::scene::Units;
use clap::Args;

/// The materials of both bodies; values that are not given for the second body are those of the
/// first.
#[derive(Debug, Args)]
pub(super) struct Materials {
    /// Material of both bodies, from the list that `brinell materials` prints
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with_all = ["youngs_modulus", "poissons_ratio"]
    )]
    material: Option<String>,
    /// Young's modulus of both bodies, or `rigid`
    #[arg(long, value_name = "E", value_parser = modulus, allow_negative_numbers = true)]
    youngs_modulus: Option<f64>,
    /// Poisson's ratio of both bodies
    #[arg(
        long,
        value_name = "NU",
        default_value_t = 0.3,
        value_parser = poissons_ratio,
        allow_negative_numbers = true
    )]
    poissons_ratio: f64,
    /// Yield stress of both bodies; without it, and without a material of the list, nothing yields
    #[arg(long, value_name = "Y", value_parser = positive, allow_negative_numbers = true)]
    yield_stress: Option<f64>,
    /// Material of the second body, from the list
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with_all = ["second_youngs_modulus", "second_poissons_ratio"]
    )]
    second_material: Option<String>,
    /// Young's modulus of the second body, or `rigid`
    #[arg(long, value_name = "E", value_parser = modulus, allow_negative_numbers = true)]
    second_youngs_modulus: Option<f64>,
    /// Poisson's ratio of the second body
    #[arg(long, value_name = "NU", value_parser = poissons_ratio, allow_negative_numbers = true)]
    second_poissons_ratio: Option<f64>,
    /// Yield stress of the second body
    #[arg(long, value_name = "Y", value_parser = positive, allow_negative_numbers = true)]
    second_yield_stress: Option<f64>,
}

/// Reads Young's modulus, infinite for `rigid`.
fn modulus(text: &str) -> std::result::Result<f64, String> {
    match text {
        "rigid" => Ok(f64::INFINITY),
        _ => positive(text).map_err(|wanted| format!("{wanted}, or rigid")),
    }
}

/// A body: its shape at the contact and its material.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ContactingBody {
    /// Principal radii.
    pub radii: [f64; 2],
    /// Name in the list of materials.
    pub material: Option<String>,
    /// Young's modulus; infinite if the body is rigid.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Yield stress, if the body can yield.
    pub yield_stress: Option<f64>,
}

impl ContactingBody {
    /// Whether the body is rigid.
    pub fn is_rigid(&self) -> bool {
        self.youngs_modulus.is_infinite()
    }

    /// Returns Young's modulus and Poisson's ratio.
    pub fn elastic(&self) -> [f64; 2] {
        [self.youngs_modulus, self.poissons_ratio]
    }

    /// Returns the load at the first yield of the body, if it can yield.
    pub fn yield_load(&self, contact: &HertzContact) -> Option<f64> {
        let stress = self.yield_stress.filter(|_| !self.is_rigid())?;
        Some(contact.yield_load(self.poissons_ratio, stress))
    }

    fn of_list(name: &str, units: &Units, radii: [f64; 2], flag: &str) -> Result<ContactingBody> {
        let within = |error: Error| error.within(flag);
        let material = of_list(name)
            .and_then(|listed| listed.material(units))
            .map_err(within)?;
        Ok(ContactingBody {
            radii,
            material: Some(name.to_string()),
            youngs_modulus: material.youngs_modulus,
            poissons_ratio: material.poissons_ratio,
            yield_stress: material.yield_stress,
        })
    }
}

impl Materials {
    /// Returns both bodies, with their radii.
    pub fn bodies(&self, units: &Units, radii: [[f64; 2]; 2]) -> Result<[ContactingBody; 2]> {
        let mut first = match (&self.material, self.youngs_modulus) {
            (Some(name), _) => ContactingBody::of_list(name, units, radii[0], "--material")?,
            (None, modulus) => ContactingBody {
                radii: radii[0],
                material: None,
                youngs_modulus: modulus.ok_or_else(|| {
                    Error::input("give a material of the list (--material) or --youngs-modulus")
                })?,
                poissons_ratio: self.poissons_ratio,
                yield_stress: None,
            },
        };
        first.yield_stress = self.yield_stress.or(first.yield_stress);
        let mut second = match &self.second_material {
            Some(name) => ContactingBody::of_list(name, units, radii[1], "--second-material")?,
            None => self.changed(&first, radii[1]),
        };
        second.yield_stress = self.second_yield_stress.or(second.yield_stress);
        if first.is_rigid() && second.is_rigid() {
            return Err(Error::input(
                "both bodies are rigid: give one of them a Young's modulus",
            ));
        }
        Ok([first, second])
    }

    /// Returns the first body's material with the elastic constants that are given for the second.
    fn changed(&self, first: &ContactingBody, radii: [f64; 2]) -> ContactingBody {
        let mut second = ContactingBody {
            radii,
            ..first.clone()
        };
        if self.second_youngs_modulus.is_some() || self.second_poissons_ratio.is_some() {
            second.material = None;
        }
        second.youngs_modulus = self.second_youngs_modulus.unwrap_or(first.youngs_modulus);
        second.poissons_ratio = self.second_poissons_ratio.unwrap_or(first.poissons_ratio);
        second
    }
}
