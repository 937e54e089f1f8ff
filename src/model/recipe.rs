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

impl<'a> Recipe<'a> {
    /// The data from which [`Recipe::make`] makes a model again.
    pub(crate) fn of(model: &'a Model) -> Self {
        Recipe {
            scene: Cow::Borrowed(&model.scene),
            mesh: Cow::Borrowed(&model.mesh),
            given: match &model.origin {
                Origin::Arrays(given) => Cow::Borrowed(given),
                Origin::Scene => Cow::default(),
            },
        }
    }

    /// Makes the model again.
    ///
    /// # Errors
    /// Errors of [`Model::new`], since a recipe read from a file may be damaged.
    pub(crate) fn make(self) -> Result<Model> {
        self.scene.validate_without_mesh()?;
        let (mesh, given) = (self.mesh.into_owned(), self.given.into_owned());
        given.check(mesh.n_nodes())?;
        Model::made(&self.scene, mesh, Origin::Arrays(given))
    }
}
