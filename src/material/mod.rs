//! Linear elasticity and von Mises plasticity at a point.
//!
//! Stress and strain are vectors `[xx, yy, zz, xy]` (axisymmetric: `[rr, zz, tt, rz]`), shear strain is the
//! engineering strain `gamma_xy`. The elastic law is `sigma = D (eps - eps_p)`; plastic flow is associated
//! with isotropic hardening, integrated by the implicit (closest point) rule.

mod hardening;
mod plane_stress;
mod radial_return;

pub use hardening::Hardening;

use crate::scene::{self, Kind};
use serde::{Deserialize, Serialize};

/// A symmetric 4 x 4 matrix acting on strain vectors, row by row.
pub type Matrix4 = [[f64; 4]; 4];

/// A material: linear elastic, and plastic where it has a hardening curve.
#[derive(Debug, Clone)]
pub struct Material {
    /// Name in the scene.
    pub name: String,
    /// Young's modulus E.
    pub youngs_modulus: f64,
    /// Poisson's ratio nu.
    pub poissons_ratio: f64,
    /// Yield stress against equivalent plastic strain; `None` for an elastic material.
    pub hardening: Option<Hardening>,
    /// The idealisation, which decides the elastic matrix and the return mapping.
    pub kind: Kind,
}

/// Plastic history at a Gauss point.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PlasticState {
    /// Plastic strain `[xx, yy, zz, xy]`, trace 0.
    pub strain: [f64; 4],
    /// Equivalent plastic strain, the time integral of `sqrt(2/3 deps_p : deps_p)`.
    pub equivalent: f64,
}

/// Result of integrating the flow rule over an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// Plastic history at the end of the increment.
    pub state: PlasticState,
    /// `D - D_ep`: what plastic flow takes off the elastic matrix (consistent tangent). Zero where elastic.
    pub softening: Matrix4,
    /// Whether plastic flow took place.
    pub flows: bool,
}

impl Material {
    /// The material of a scene.
    pub fn new(name: &str, data: &scene::Material, kind: Kind) -> Self {
        Material {
            name: name.to_string(),
            youngs_modulus: data.youngs_modulus,
            poissons_ratio: data.poissons_ratio,
            hardening: Hardening::from_scene(data),
            kind,
        }
    }

    /// Shear modulus `G = E / (2 (1 + nu))`.
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// Bulk modulus `K = E / (3 (1 - 2 nu))`.
    pub fn bulk_modulus(&self) -> f64 {
        self.youngs_modulus / (3.0 * (1.0 - 2.0 * self.poissons_ratio))
    }

    /// Initial yield stress, infinite for an elastic material.
    pub fn yield_stress(&self) -> f64 {
        self.hardening
            .as_ref()
            .map_or(f64::INFINITY, |h| h.yield_stress(0.0))
    }

    /// The elastic matrix D. In plane stress row and column `zz` are zero.
    pub fn elastic_matrix(&self) -> Matrix4 {
        let g = self.shear_modulus();
        let nu = self.poissons_ratio;
        match self.kind {
            Kind::PlaneStress => {
                let c = self.youngs_modulus / (1.0 - nu * nu);
                [
                    [c, c * nu, 0.0, 0.0],
                    [c * nu, c, 0.0, 0.0],
                    [0.0; 4],
                    [0.0, 0.0, 0.0, g],
                ]
            }
            Kind::PlaneStrain | Kind::Axisymmetric => {
                let lambda = self.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
                let d = lambda + 2.0 * g;
                [
                    [d, lambda, lambda, 0.0],
                    [lambda, d, lambda, 0.0],
                    [lambda, lambda, d, 0.0],
                    [0.0, 0.0, 0.0, g],
                ]
            }
        }
    }

    /// Whether a total strain lies within the yield surface of a history: [`Material::integrate`] then changes nothing.
    pub fn stays_elastic(&self, elastic: &Matrix4, strain: &[f64; 4], old: &PlasticState) -> bool {
        self.hardening.as_ref().is_none_or(|hardening| {
            let trial = stress(elastic, strain, &old.strain);
            von_mises(&trial) <= hardening.yield_stress(old.equivalent)
        })
    }

    /// Integrates the flow rule: total strain at the end of the increment, history at its begin.
    /// `elastic` is [`Material::elastic_matrix`], passed in because the caller has it at hand.
    ///
    /// # Source
    /// J. C. Simo, T. J. R. Hughes, *Computational Inelasticity* (1998), boxes 3.1 to 3.3.
    pub fn integrate(&self, elastic: &Matrix4, strain: &[f64; 4], old: &PlasticState) -> Update {
        let idle = Update {
            state: *old,
            softening: [[0.0; 4]; 4],
            flows: false,
        };
        let Some(hardening) = &self.hardening else {
            return idle;
        };
        let trial = stress(elastic, strain, &old.strain);
        if von_mises(&trial) <= hardening.yield_stress(old.equivalent) {
            return idle;
        }
        match self.kind {
            Kind::PlaneStress => plane_stress::integrate(self, hardening, elastic, &trial, old),
            _ => radial_return::integrate(self, hardening, &trial, old),
        }
    }
}

/// `sigma = D (eps - eps_p)`.
pub fn stress(elastic: &Matrix4, strain: &[f64; 4], plastic_strain: &[f64; 4]) -> [f64; 4] {
    let e: [f64; 4] = std::array::from_fn(|i| strain[i] - plastic_strain[i]);
    multiply(elastic, &e)
}

/// Matrix times vector.
pub fn multiply(matrix: &Matrix4, vector: &[f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| (0..4).map(|j| matrix[i][j] * vector[j]).sum())
}

/// Von Mises stress `sqrt(3/2 s:s)`.
pub fn von_mises(stress: &[f64; 4]) -> f64 {
    let [x, y, z, xy] = *stress;
    (0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2)) + 3.0 * xy * xy).sqrt()
}

#[cfg(test)]
mod tests;
