//! Tables of a scene as text, apart from its mesh.

use super::ModelBuilder;
use crate::error::{Error, Result};
use crate::scene::{
    Body, Contact, Equation, Load, Material, Program, RigidSurface, Settings, Support, Tie, Units,
};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Tables of a scene without `kind`, `symmetry` and `mesh`, which come with the arrays.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct SceneTables {
    title: Option<String>,
    units: Option<Units>,
    materials: BTreeMap<String, Material>,
    bodies: BTreeMap<String, Body>,
    rigid: BTreeMap<String, RigidSurface>,
    contact: Vec<Contact>,
    tie: Vec<Tie>,
    equation: Vec<Equation>,
    support: Vec<Support>,
    load: Vec<Load>,
    program: Option<Program>,
    analysis: Option<Settings>,
}

impl ModelBuilder {
    /// Adds tables of a scene (TOML): materials, bodies, `[rigid.NAME]`, `[[contact]]`, `[[tie]]`,
    /// `[[equation]]`, `[[support]]`, `[[load]]`, `[program]`, `[analysis]`, `[units]`, `title`.
    /// Materials, bodies, rigid surfaces, contacts, ties, equations, supports and loads are added
    /// to the existing ones; the other tables replace the existing ones.
    ///
    /// ```
    /// # use brinell::model::ModelBuilder;
    /// # use brinell::scene::Kind;
    /// let mut builder = ModelBuilder::new(Kind::PlaneStrain);
    /// builder.tables(
    ///     r#"
    ///     materials.steel = { youngs_modulus = 210e3, poissons_ratio = 0.3, yield_stress = 500.0 }
    ///     bodies.ball = { material = "steel" }
    ///     support = [{ on = "floor", fix = ["y"] }]
    ///     load = [{ on = "top", pressure = 10.0 }]
    ///     "#,
    /// )?;
    /// # Ok::<(), brinell::Error>(())
    /// ```
    ///
    /// # Errors
    /// Invalid TOML, an unknown key, or a value of the wrong type, with line and column; a material
    /// or body that already exists.
    pub fn tables(&mut self, text: &str) -> Result<&mut Self> {
        let tables: SceneTables =
            toml::from_str(text).map_err(|e| Error::input(format!("scene text: {e}")))?;
        let mut out = self.clone();
        for (name, material) in tables.materials {
            out.material(&name, material)?;
        }
        for (name, body) in tables.bodies {
            out.body(&name, body)?;
        }
        for (name, surface) in tables.rigid {
            out.rigid(&name, surface)?;
        }
        let scene = &mut out.scene;
        scene.contact.extend(tables.contact);
        scene.tie.extend(tables.tie);
        scene.equation.extend(tables.equation);
        scene.support.extend(tables.support);
        scene.load.extend(tables.load);
        scene.title = tables.title.unwrap_or(std::mem::take(&mut scene.title));
        scene.units = tables.units.or(scene.units.take());
        if let Some(program) = tables.program {
            scene.program = program;
        }
        if let Some(settings) = tables.analysis {
            scene.analysis = settings;
        }
        *self = out;
        Ok(self)
    }
}
