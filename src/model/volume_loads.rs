//! Loads on the volume of a body: its weight, rotation, a change of temperature.

use super::heat::FreeStrain;
use super::load_case::{LoadCase, Magnitude, name};
use super::names::SceneEntry;
use super::on_mesh::OnMesh;
use super::{body_forces, heat};
use crate::error::{Error, Result};
use crate::material::{Lame, Material};
use crate::mesh::Mesh;
use crate::scene::{self, Field, Scene, VolumeAction};
use crate::space::Vector;

pub(super) fn resolve(
    action: VolumeAction,
    (index, load): (usize, &scene::Load),
    scene: &Scene,
    mesh: &Mesh,
) -> Result<LoadCase> {
    let refused = |text: String| {
        let text = format!("load {} on `{}`: {text}", index + 1, load.on);
        SceneEntry::of_list(scene, "load", index).refused(Error::input(text))
    };
    let Some(body) = mesh.bodies.iter().position(|name| *name == load.on) else {
        let bodies = mesh.bodies.join("`, `");
        return Err(refused(format!(
            "acts on the volume of a body, and there is no such body; there are `{bodies}`"
        )));
    };
    let material = scene.bodies.get(&load.on).map(|b| b.material.as_str());
    let material = material.unwrap_or_default();
    let data = scene.material_of(&load.on).unwrap_or_default();
    let needed = |what: &str, key: &str, value: Option<f64>| {
        let text = format!("needs the {what} of the body; give materials.{material}.{key}");
        value.ok_or_else(|| refused(text))
    };
    let density = || needed("mass", "density", data.density);
    let on_body = |density: f64, field: &dyn Fn(Vector) -> Vector| {
        body_forces::on_body(scene.kind, mesh, body, density, field)
    };
    let forces = match action {
        VolumeAction::Acceleration(a) => on_body(density()?, &|_| a.vector()),
        VolumeAction::Rotation(r) => on_body(density()?, &body_forces::spinning(scene.kind, &r)),
        // Only the volumes of the nodes are needed.
        VolumeAction::Temperature(_) => on_body(1.0, &|_| [0.0; 3]),
    };
    let volume: f64 = forces.volumes.iter().sum();
    let mut case = LoadCase {
        name: name(index, load),
        nodes: forces.nodal.iter().map(|(node, _)| *node).collect(),
        shares: forces.volumes.iter().map(|v| v / volume).collect(),
        nodal: forces.nodal,
        forces: Vec::new(),
        history: load.history.clone(),
        magnitude: 0.0,
        measures: Magnitude::Force,
        body: body as u32,
        direction: [0.0; 3],
        free_strain: Vec::new(),
        opens: Vec::new(),
    };
    match action {
        VolumeAction::Temperature(temperature) => {
            let expansion = data.thermal_expansion;
            let expansion = needed("thermal expansion", "thermal_expansion", expansion)?;
            let changes = changes(temperature, scene, mesh, &case.nodes)
                .map_err(|error| refused(error.message().to_string()))?;
            let law = Material::new(material, &data, scene.kind).lame();
            set_temperature(&mut case, (scene, mesh), (body, law), (&changes, expansion));
        }
        VolumeAction::Acceleration(a) => {
            let mass = scene.symmetry as f64 * density()? * volume;
            case.set_size(a.vector().map(|a| mass * a), Magnitude::Force);
        }
        // Forces of rotation have no common direction: their sizes are added.
        VolumeAction::Rotation(_) => case.magnitude = scene.symmetry as f64 * case.size(),
    }
    Ok(case)
}

/// Sets up a load case for given changes of temperature in a body: its free strain, and the nodal
/// forces that would cause this strain.
fn set_temperature(
    case: &mut LoadCase,
    (scene, mesh): (&Scene, &Mesh),
    (body, law): (usize, Lame),
    (changes, expansion): (&[f64], f64),
) {
    let free = FreeStrain {
        components: 0..3,
        nodal: changes.iter().map(|change| expansion * change).collect(),
    };
    let kind = (scene.kind, scene.mesh.formulation);
    case.nodal = heat::forces(kind, mesh, (body, law), std::slice::from_ref(&free));
    case.measures = Magnitude::Temperature;
    case.magnitude = changes.iter().fold(0.0, |m, change| m.max(change.abs()));
    case.free_strain = Some(free)
        .filter(|free| !free.is_none())
        .into_iter()
        .collect();
}

/// Change of temperature at every node of the mesh; zero at nodes of other bodies.
fn changes(field: &Field, scene: &Scene, mesh: &Mesh, nodes: &[usize]) -> Result<Vec<f64>> {
    let field = OnMesh::new(field, "temperature", scene, mesh)?;
    let mut out = vec![0.0; mesh.n_nodes()];
    for &node in nodes {
        out[node] = field.at_node(node)?;
    }
    Ok(out)
}
