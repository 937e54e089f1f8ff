//! Data from which a model can be made again if no scene alone describes it.

use super::given::Given;
use super::{Model, Origin};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Scene, mesh, and further data given as arrays.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Recipe<'a> {
    scene: Cow<'a, Scene>,
    mesh: Cow<'a, Mesh>,
    given: Cow<'a, Given>,
}

impl Model {
    /// The data from which [`Model::from_recipe`] makes this model again.
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

    /// Makes the model again.
    ///
    /// # Errors
    /// Errors of [`Model::new`], since a recipe read from a file may be damaged.
    pub(crate) fn from_recipe(recipe: Recipe<'_>) -> Result<Self> {
        recipe.scene.validate_without_mesh()?;
        let (mesh, given) = (recipe.mesh.into_owned(), recipe.given.into_owned());
        given.check(mesh.n_nodes())?;
        Self::made(&recipe.scene, mesh, Origin::Arrays(given))
    }
}
