//! Materials of the built-in list that the bodies of a scene name.

use super::Scene;
use super::catalogue::Listed;
use crate::error::{Error, Result};

/// Adds to the scene's materials each listed material that a body names and the scene does not
/// define.
///
/// # Errors
/// `Input` naming the body if the scene does not name its units or its unit of stress is not known.
pub(super) fn fill_in(scene: &mut Scene) -> Result<()> {
    for (name, body) in &scene.bodies {
        let of_scene = scene.materials.contains_key(&body.material);
        let Some(listed) = Listed::of(&body.material).filter(|_| !of_scene) else {
            continue;
        };
        let units = scene.units.as_ref().ok_or_else(|| {
            Error::input(
                "it is taken from the list of materials, in MPa: name the units of the scene, such \
                 as units = { length = \"mm\", force = \"N\", stress = \"MPa\" }",
            )
        });
        let material = units
            .and_then(|units| listed.material(units))
            .map_err(|error| {
                let key = format!("bodies.{name}.material");
                let error = error.within(format!("{key}: \"{}\"", body.material));
                scene.places.in_front(&key, error)
            })?;
        scene.materials.insert(body.material.clone(), material);
    }
    Ok(())
}
