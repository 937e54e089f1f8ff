//! What a model was made from, as data: of a model that no scene alone makes again.

use super::given::Given;
use super::{Model, Origin};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Scene, mesh, and what arrays state besides them.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Recipe<'a> {
    scene: Cow<'a, Scene>,
    mesh: Cow<'a, Mesh>,
    given: Cow<'a, Given>,
}

impl Model {
    /// What [`Model::from_recipe`] makes this model of.
    pub(crate) fn recipe(&self) -> Recipe<'_> {
        Recipe {
            scene: Cow::Borrowed(&self.scene),
            mesh: Cow::Borrowed(&self.mesh),
            given: match &self.origin {
                Origin::Arrays(given) => Cow::Borrowed(given),
                Origin::Scene => Cow::default(),
            },
        }
    }

    /// The model again.
    ///
    /// # Errors
    /// Errors of [`Model::new`]: what was read from a file may be damaged.
    pub(crate) fn from_recipe(recipe: Recipe<'_>) -> Result<Self> {
        recipe.scene.validate_without_mesh()?;
        let (mesh, given) = (recipe.mesh.into_owned(), recipe.given.into_owned());
        given.check(mesh.n_nodes())?;
        Self::resolve(&recipe.scene, mesh, Origin::Arrays(given))
    }
}
