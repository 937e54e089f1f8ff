//! Yield stress by depth below a surface, for case hardening: linear between the rows of the
//! profile and constant beyond.

use super::depth::{self, Simplices};
use super::pairs::ContactSurface;
use crate::error::Result;
use crate::interpolation::interpolate;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::space::Vector;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Yield stress of a body as a function of depth.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct YieldByDepth {
    /// Rows (depth, yield stress), depths ascending.
    rows: Vec<[f64; 2]>,
    surface: Arc<Simplices>,
}

impl YieldByDepth {
    /// Yield stress at a point.
    pub fn at(&self, place: Vector) -> f64 {
        interpolate(&self.rows, self.surface.distance(place))
    }

    /// Yield stress if it is the same at all depths.
    fn constant(&self) -> Option<f64> {
        let first = self.rows[0][1];
        self.rows.iter().all(|row| row[1] == first).then_some(first)
    }
}

/// Resolves the yield stress by depth of each body that has a profile. A body whose profile equals
/// the material's yield stress everywhere gets `None`.
///
/// # Errors
/// A surface that the mesh does not have or that belongs to another body; no `depth_from` in a body
/// without a contact surface.
pub(super) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    materials: &[Material],
    contacts: &[ContactSurface],
) -> Result<Vec<Option<YieldByDepth>>> {
    let bodies = mesh.bodies.iter().zip(materials).enumerate();
    bodies
        .map(|(index, (name, material))| {
            let body = scene.bodies.get(name);
            let Some(rows) = body.and_then(|body| body.yield_by_depth.clone()) else {
                return Ok(None);
            };
            let key = "yield_by_depth";
            let profile = YieldByDepth {
                rows,
                surface: Arc::new(depth::surface_of(
                    scene,
                    mesh,
                    (index, name),
                    key,
                    contacts,
                )?),
            };
            let is_nothing = profile.constant() == Some(material.yield_stress());
            Ok(Some(profile).filter(|_| !is_nothing))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(corners: Vec<[Vector; 3]>) -> YieldByDepth {
        YieldByDepth {
            rows: vec![[0.5, 900.0], [1.0, 700.0], [3.0, 500.0]],
            surface: Arc::new(Simplices::new(corners)),
        }
    }

    #[test]
    fn a_profile_is_straight_between_its_rows_and_constant_beyond() {
        let profile = profile(vec![[[0.0; 3]; 3]]);
        let at = [0.0, 0.5, 0.75, 1.0, 2.0, 3.0, 9.0].map(|depth| profile.at([0.0, depth, 0.0]));
        assert_eq!(at, [900.0, 900.0, 800.0, 700.0, 600.0, 500.0, 500.0]);
    }
}
