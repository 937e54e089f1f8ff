//! Linear elasticity and von Mises plasticity at a point.
//!
//! Stress and strain are vectors `[xx, yy, zz, xy | yz, zx]` (axisymmetric: `[rr, zz, tt, rz]`) of
//! S = 4 components in the plane, 6 in space; shear strains are engineering strains `gamma`. The
//! elastic law is `sigma = D (eps - eps_p)`, isotropic ([`Lame`]); plastic flow is associated with
//! isotropic ([`Hardening`]) and kinematic hardening ([`BackStresses`]), integrated by the implicit
//! (closest point) rule.

mod back_stresses;
mod flow_rule;
mod hardening;
mod history;
mod lame;
mod plane_stress;
mod radial_return;
mod strain_path;
mod tensor;

pub use back_stresses::BackStresses;
pub use hardening::Hardening;
pub use history::{Past, PlasticState, Update};
pub use lame::{Lame, Softening};
pub use strain_path::Memory;
pub(crate) use tensor::resized;
pub use tensor::von_mises;

use crate::root::{self, RootTolerance};
use crate::scene;
use crate::space::Space;
use serde::{Deserialize, Serialize};

/// A material: linear elastic, and plastic if it has a hardening curve.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Material {
    /// Name of the material in the scene.
    pub name: String,
    /// Young's modulus E.
    pub youngs_modulus: f64,
    /// Poisson's ratio nu.
    pub poissons_ratio: f64,
    /// Yield stress against equivalent plastic strain; `None` for an elastic material.
    pub hardening: Option<Hardening>,
    /// Kinematic hardening: the back stresses that move the yield surface.
    pub back_stresses: BackStresses,
    /// Idealisation of space, which decides the elastic matrix and the return mapping.
    pub space: Space,
}

impl Material {
    /// Converts the material of a scene.
    pub fn new(name: &str, data: &scene::Material, space: Space) -> Self {
        Material {
            name: name.to_string(),
            youngs_modulus: data.youngs_modulus,
            poissons_ratio: data.poissons_ratio,
            hardening: Hardening::from_scene(data),
            back_stresses: BackStresses::new(data.back_stresses()),
            space,
        }
    }

    /// Shear modulus `G = E / (2 (1 + nu))`.
    pub(crate) fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// Work on plastic strains per volume, 0 for an elastic material: `int sigma_y deps_p` over the
    /// equivalent plastic strain, and the work that the back stresses store (`C/3 z:z`). Work that
    /// the back stresses have lost by fading is not included ([`BackStresses::carry`]).
    pub fn plastic_work<const S: usize>(&self, past: &Past<S>) -> f64 {
        let equivalent = past.state.equivalent;
        let worked = |h: &Hardening| h.work(equivalent) + past.harder * equivalent;
        let held = self.back_stresses.held(&past.state.strain, past.back);
        self.hardening.as_ref().map_or(0.0, worked) + held
    }

    /// Initial yield stress; infinite for an elastic material.
    pub fn yield_stress(&self) -> f64 {
        self.hardening
            .as_ref()
            .map_or(f64::INFINITY, |h| h.yield_stress(0.0))
    }

    /// Elastic law. In plane stress `lambda* = 2 lambda mu/(lambda + 2 mu)` replaces `lambda`, and
    /// `zz` takes no part.
    pub fn lame(&self) -> Lame {
        let (e, nu, mu) = (
            self.youngs_modulus,
            self.poissons_ratio,
            self.shear_modulus(),
        );
        match self.space {
            Space::PlaneStress => Lame {
                // This is 2 lambda mu/(lambda + 2 mu) without the pole at nu = 1/2.
                lambda: e * nu / (1.0 - nu * nu),
                mu,
                across: 0.0,
            },
            Space::PlaneStrain | Space::Axisymmetric | Space::Solid => Lame {
                lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
                mu,
                across: 1.0,
            },
        }
    }
}

/// Finds the increment of equivalent plastic strain at which the excess over the yield stress
/// vanishes. The excess is a stress of the size of `scale`, positive at zero; it falls by at least
/// `stiffness` per unit of the increment.
fn flow_to_root(excess: impl Fn(f64) -> f64, stiffness: f64, scale: f64) -> f64 {
    let first = excess(0.0);
    let end = first / stiffness;
    let accuracy = RootTolerance {
        value: 4.0 * f64::EPSILON * scale,
        place: f64::EPSILON,
    };
    root::between([(0.0, first), (end, excess(end))], accuracy, excess)
}

#[cfg(test)]
mod tests;
