//! Steels and alloys by name, read from `data/materials.toml`, each number with its source.

use super::units::STRESSES;
use super::{Material, Units};
use crate::error::{Error, Result};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// A number and the source in which it is published.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Published(pub f64, pub String);

/// A material of the built-in list: stresses in MPa, density in kg/m^3, thermal expansion per
/// kelvin.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Listed {
    /// Description of the material, and the sizes of pieces for which the yield stress holds.
    pub what: String,
    /// Young's modulus.
    pub youngs_modulus: Published,
    /// Poisson's ratio.
    pub poissons_ratio: Published,
    /// Lowest yield stress; `None` if no single published value applies to the material.
    pub yield_stress: Option<Published>,
    /// Tangent modulus beyond yield.
    pub tangent_modulus: Option<Published>,
    /// Mass per volume.
    pub density: Option<Published>,
    /// Strain per change of temperature.
    pub thermal_expansion: Option<Published>,
}

/// The built-in list of materials, in the order of the file.
static LIST: LazyLock<Vec<(String, Listed)>> = LazyLock::new(|| {
    let text = include_str!("../../data/materials.toml");
    // A test parses this file, so reading cannot fail here: the contents are fixed at build time.
    let mut by_name: BTreeMap<String, Listed> = toml::from_str(text).unwrap_or_default();
    let names = text
        .lines()
        .filter_map(|line| line.strip_prefix("[\"")?.strip_suffix("\"]"));
    names
        .filter_map(|name| by_name.remove_entry(name))
        .collect()
});

/// The materials that a scene can take by name.
pub fn materials() -> &'static [(String, Listed)] {
    &LIST
}

impl Listed {
    /// The listed material of this name, if there is one.
    pub fn of(name: &str) -> Option<&'static Listed> {
        let found = LIST.iter().find(|(listed, _)| listed == name);
        found.map(|(_, listed)| listed)
    }

    /// Numbers of the material: the scene's key for each, its unit in the list, and the number with
    /// its source.
    pub fn figures(&self) -> Vec<(&'static str, &'static str, &Published)> {
        [
            ("youngs_modulus", "MPa", Some(&self.youngs_modulus)),
            ("poissons_ratio", "", Some(&self.poissons_ratio)),
            ("yield_stress", "MPa", self.yield_stress.as_ref()),
            ("tangent_modulus", "MPa", self.tangent_modulus.as_ref()),
            ("density", "kg/m^3", self.density.as_ref()),
            ("thermal_expansion", "1/K", self.thermal_expansion.as_ref()),
        ]
        .into_iter()
        .filter_map(|(key, unit, figure)| Some((key, unit, figure?)))
        .collect()
    }

    /// Converts the material into one of a scene with these units. The density is converted only if
    /// the scene's unit of length is known. The scene's unit of time is taken to be the second and
    /// its unit of temperature the kelvin.
    ///
    /// # Errors
    /// `Input` if the unit of stress is not known.
    pub fn material(&self, units: &Units) -> Result<Material> {
        let stress = units.pascals().ok_or_else(|| {
            let names: Vec<&str> = STRESSES.iter().map(|(name, _)| *name).collect();
            Error::input(format!(
                "its stresses are in MPa, and \"{}\" is none of the units they can be turned \
                 into: {}; or write the material into [materials]",
                units.stress,
                names.join(", ")
            ))
        })?;
        let in_units = |figure: &Published| figure.0 * 1e6 / stress;
        let length = units.metres();
        Ok(Material {
            youngs_modulus: in_units(&self.youngs_modulus),
            poissons_ratio: self.poissons_ratio.0,
            yield_stress: self.yield_stress.as_ref().map(in_units),
            tangent_modulus: self.tangent_modulus.as_ref().map(in_units),
            // kg/m^3 = Pa s^2/m^2.
            density: self
                .density
                .as_ref()
                .and_then(|d| Some(d.0 / stress * length?.powi(2))),
            thermal_expansion: self.thermal_expansion.as_ref().map(|e| e.0),
            ..Material::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn units(length: &str, stress: &str) -> Units {
        Units {
            length: length.into(),
            force: "N".into(),
            stress: stress.into(),
        }
    }

    /// The whole file is read, and every entry is a material that a scene accepts.
    #[test]
    fn every_entry_is_a_valid_material_with_sources() {
        let text = include_str!("../../data/materials.toml");
        let by_name: BTreeMap<String, Listed> = toml::from_str(text).unwrap();
        assert_eq!(materials().len(), by_name.len());
        assert!(materials().len() >= 12);
        for (name, listed) in materials() {
            let scene = include_str!("../../data/scenes/contact_patch.toml");
            let mut scene = Scene::parse(scene, name).unwrap();
            let material = listed.material(&units("mm", "MPa")).unwrap();
            scene.materials.insert(name.clone(), material);
            scene.validate().unwrap();
            assert!(
                listed.figures().iter().all(|(_, _, f)| f.1.len() > 5),
                "{name}"
            );
        }
    }

    #[test]
    fn numbers_are_turned_into_the_units_of_the_scene() {
        let steel = Listed::of("S355").unwrap();
        let [mm, m, inches] =
            [("mm", "MPa"), ("m", "Pa"), ("in", "psi")].map(|(l, s)| steel.material(&units(l, s)));
        let (mm, m, inches) = (mm.unwrap(), m.unwrap(), inches.unwrap());
        assert_eq!((mm.youngs_modulus, mm.yield_stress), (210e3, Some(355.0)));
        assert_eq!((m.youngs_modulus, m.density), (210e9, Some(7850.0)));
        assert_eq!(
            (mm.tangent_modulus, m.tangent_modulus),
            (Some(2100.0), Some(2100e6))
        );
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(near(mm.density.unwrap(), 7.85e-9));
        assert!(near(
            inches.yield_stress.unwrap(),
            355e6 / 6894.757293168361
        ));
        // Slinch (12 slugs) per cubic inch, the unit of density with pounds-force and inches.
        let slinch = 0.45359237 * 9.80665 / 0.0254;
        assert!(near(
            inches.density.unwrap(),
            7850.0 * 0.0254f64.powi(3) / slinch
        ));
        assert_eq!(
            steel.material(&units("furlong", "MPa")).unwrap().density,
            None
        );
        let error = steel.material(&units("mm", "bar")).unwrap_err();
        assert!(error.message().contains("\"bar\" is none of"), "{error}");
    }

    #[test]
    fn a_scene_takes_a_material_by_its_name() {
        let text = include_str!("../../data/scenes/contact_patch.toml");
        let with = |body: &str, units: &str| {
            let overrides = [body, units].map(String::from);
            Scene::parse_with(text, "patch.toml", &overrides)
        };
        let scene = Scene::parse(text, "patch.toml").unwrap();
        let body = format!(
            "bodies.{}.material=S355",
            scene.bodies.keys().next().unwrap()
        );
        let units = "units={ length = \"m\", force = \"N\", stress = \"Pa\" }";
        let taken = with(&body, units).unwrap();
        assert_eq!(taken.materials["S355"].yield_stress, Some(355e6));
        // The scene that the program writes contains the listed material as an entry of its own.
        let again = Scene::parse(&taken.to_toml().unwrap(), "again").unwrap();
        assert_eq!(again.materials, taken.materials);
        let error = with(&body, "title=unnamed").unwrap_err();
        assert!(
            error.message().contains("name the units of the scene"),
            "{error}"
        );
    }
}
