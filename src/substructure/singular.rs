//! Error message that names the place where a stiffness is singular.

use crate::error::Error;
use crate::linalg::NotDefinite;
use crate::model::Model;
use crate::shape::Shape;
use crate::space::Space;

/// Adds to the error the place where the stiffness is singular, and the likely cause.
pub(super) fn name_freedom(error: Error, model: &Model) -> Error {
    let freedom = std::error::Error::source(&error)
        .and_then(|s| s.downcast_ref::<NotDefinite>())
        .map(|n| n.freedom);
    match freedom {
        Some(freedom) => {
            let place = model.freedoms.describe(&model.mesh, freedom);
            let cause = match shape_with_zero_energy_modes(model, freedom) {
                // Rigid motions have been checked already, and are held.
                Some(shape) => format!(
                    "elements of the shape {} have deformations without stiffness (hourglass \
                     modes), and nothing here holds them; give the body `integration = \"full\"`, \
                     two elements across, another shape, or more supports",
                    shape.name()
                ),
                None => "a part of the model is not held, or an element there is degenerate".into(),
            };
            let message = format!("the stiffness is singular at {place}: {cause}");
            Error::new(crate::ErrorKind::Unheld, message).because(error)
        }
        None => error,
    }
}

/// The shape of an element at the freedom's node that has fewer strains at its Gauss points than
/// modes of deformation.
fn shape_with_zero_energy_modes(model: &Model, freedom: usize) -> Option<Shape> {
    let (node, _) = *model.freedoms.owners.get(freedom)?;
    let n_strains = match model.kind {
        Space::PlaneStrain | Space::PlaneStress => 3,
        space => space.components().len(),
    };
    let n_rigid = model.kind.rigid_motions().len();
    let mesh = &model.mesh;
    let beside = (0..mesh.n_elements()).filter(|&e| mesh.nodes(e).contains(&node));
    let mut kinds = beside.map(|e| (mesh.shapes[e], mesh.n_points(e)));
    let found = kinds.find(|(shape, n_points)| {
        let n_deforming = shape.n_nodes() * shape.dimension() - n_rigid;
        n_deforming > n_points * n_strains
    });
    found.map(|(shape, _)| shape)
}
