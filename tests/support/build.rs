//! What models that are built by hand have in common: a line for a support, a load, a target.

use brinell::model::ModelBuilder;
use brinell::scene::{Body, Direction, Load, Material, Support, Target};

/// An elastic material.
pub fn elastic(youngs_modulus: f64, poissons_ratio: f64) -> Material {
    Material {
        youngs_modulus,
        poissons_ratio,
        ..Material::default()
    }
}

/// Entries of a model in one line each.
pub trait Build {
    /// Says which material a body is of.
    fn of(&mut self, body: &str, material: &str);
    /// Holds a set along an axis.
    fn hold(&mut self, on: impl Into<String>, axis: Direction);
    /// Holds a set along any direction.
    fn hold_along(&mut self, on: impl Into<String>, direction: [f64; 3]);
    /// Presses on a surface.
    fn press(&mut self, on: impl Into<String>, pressure: f64);
    /// Adds a target at a load factor, with its fields.
    fn reach(&mut self, load_factor: f64);
}

impl Build for ModelBuilder {
    fn of(&mut self, body: &str, material: &str) {
        let entry = Body {
            material: material.into(),
            ..Body::default()
        };
        self.body(body, entry).unwrap();
    }

    fn hold(&mut self, on: impl Into<String>, axis: Direction) {
        self.support(Support {
            on: on.into(),
            fix: vec![axis],
            ..Support::default()
        });
    }

    fn hold_along(&mut self, on: impl Into<String>, direction: [f64; 3]) {
        self.support(Support {
            on: on.into(),
            direction: Some(direction.into()),
            ..Support::default()
        });
    }

    fn press(&mut self, on: impl Into<String>, pressure: f64) {
        self.load(Load {
            on: on.into(),
            pressure: Some(pressure.into()),
            ..Load::default()
        });
    }

    fn reach(&mut self, load_factor: f64) {
        self.target(Target {
            load_factor: Some(load_factor),
            fields: true,
            ..Target::default()
        });
    }
}
