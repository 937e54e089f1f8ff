//! Initial stresses and strains of a body, expressed as strains without stress.
//!
//! ```text
//! sigma = D (eps - eps_0),   eps_0 = eps_p0 - C sigma_0,   C = D^-1 in space
//! ```
//!
//! Initial strains are loads that act from the start, whatever the load factor.

use super::Freedoms;
use super::depth;
use super::heat::{self, FreeStrain};
use super::load_case::{LoadCase, Magnitude, on_freedoms};
use super::pairs::ContactSurface;
use crate::error::Result;
use crate::interpolation::interpolate;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::scene::{History, Scene};

/// Number of components of a symmetric tensor.
const COMPONENTS: usize = 6;

/// Resolves the loads of the bodies' initial stresses and strains. An initial field that is zero
/// everywhere is no load.
///
/// # Errors
/// Errors of [`depth::surface_of`].
pub(super) fn resolve(
    scene: &Scene,
    mesh: &Mesh,
    (materials, contacts): (&[Material], &[ContactSurface]),
    freedoms: &Freedoms,
) -> Result<Vec<LoadCase>> {
    let mut out = Vec::new();
    for (index, name) in mesh.bodies.iter().enumerate() {
        let Some(body) = scene.bodies.get(name) else {
            continue;
        };
        for (key, rows) in body.brought_along() {
            let of_place = (scene, mesh, contacts);
            let values = nodal(of_place, (index, name), (key, rows))?;
            let free: Vec<FreeStrain> = match key {
                "initial_stress" => parts(values.iter().map(|s| strain_of(&materials[index], s))),
                _ => parts(values.iter().copied()),
            };
            if !free.is_empty() {
                let law = materials[index].lame();
                let kind = (scene.kind, scene.mesh.formulation);
                let forces = heat::forces(kind, mesh, (index, law), &free);
                let mut case = case(format!("{key} of {name}"), index, forces, free);
                let sizes = values.iter().flatten().map(|v| v.abs());
                case.magnitude = sizes.fold(0.0, f64::max);
                case.nodal = freedoms.basis.share_of(case.nodal);
                case.forces = on_freedoms(&case.nodal, freedoms);
                out.push(case);
            }
        }
    }
    Ok(out)
}

/// Value of a profile at each node of the mesh; zero at nodes of other bodies.
fn nodal(
    (scene, mesh, contacts): (&Scene, &Mesh, &[ContactSurface]),
    body: (usize, &str),
    (key, rows): (&str, &[Vec<f64>]),
) -> Result<Vec<[f64; COMPONENTS]>> {
    let column = |k: usize| -> Vec<[f64; 2]> {
        let value = |row: &Vec<f64>| row.get(k + 1).copied().unwrap_or(0.0);
        rows.iter().map(|row| [row[0], value(row)]).collect()
    };
    let columns: [Vec<[f64; 2]>; COMPONENTS] = std::array::from_fn(column);
    // A profile of a single row has the same value at any depth.
    let surface = match rows.len() {
        1 => None,
        _ => Some(depth::surface_of(scene, mesh, body, key, contacts)?),
    };
    let mut out = vec![[0.0; COMPONENTS]; mesh.n_nodes()];
    let mut known = vec![false; mesh.n_nodes()];
    for element in (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body.0) {
        for &node in mesh.nodes(element) {
            let node = node as usize;
            if !std::mem::replace(&mut known[node], true) {
                let depth = surface
                    .as_ref()
                    .map_or(0.0, |s| s.distance(mesh.point(node)));
                out[node] = columns.each_ref().map(|rows| interpolate(rows, depth));
            }
        }
    }
    Ok(out)
}

/// Strain whose elastic stress cancels an initial stress: `-C sigma_0`.
fn strain_of(material: &Material, stress: &[f64; COMPONENTS]) -> [f64; COMPONENTS] {
    let (e, nu) = (material.youngs_modulus, material.poissons_ratio);
    let trace: f64 = stress[..3].iter().sum();
    std::array::from_fn(|k| match k < 3 {
        true => (nu * trace - (1.0 + nu) * stress[k]) / e,
        false => -stress[k] / material.shear_modulus(),
    })
}

/// Splits strains into components, leaving out components that are zero everywhere.
fn parts(strains: impl Iterator<Item = [f64; COMPONENTS]> + Clone) -> Vec<FreeStrain> {
    let component = |k: usize| FreeStrain {
        components: k..k + 1,
        nodal: strains.clone().map(|strain| strain[k]).collect(),
    };
    let all = (0..COMPONENTS).map(component);
    all.filter(|part| !part.is_none()).collect()
}

fn case(
    name: String,
    body: usize,
    nodal: Vec<(usize, crate::space::Vector)>,
    free_strain: Vec<FreeStrain>,
) -> LoadCase {
    let nodes: Vec<usize> = nodal.iter().map(|(node, _)| *node).collect();
    LoadCase {
        name,
        shares: vec![1.0 / nodes.len() as f64; nodes.len()],
        nodes,
        nodal,
        forces: Vec::new(),
        history: History::Constant,
        magnitude: 0.0,
        measures: Magnitude::Strain,
        body: body as u32,
        direction: [0.0; 3],
        free_strain,
        opens: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::strain_of;
    use crate::material::{BackStresses, Material};
    use crate::space::Space;

    /// The elastic stress of the strain cancels the initial stress, component by component.
    #[test]
    fn the_stress_of_the_strain_is_the_negative_of_the_initial_one() {
        let material = Material {
            name: "m".into(),
            youngs_modulus: 200.0,
            poissons_ratio: 0.3,
            hardening: None,
            back_stresses: BackStresses::default(),
            space: Space::Solid,
        };
        let stress = [3.0, -1.0, 2.0, 0.7, -0.4, 1.1];
        let taken = material.lame().times(&strain_of(&material, &stress));
        for (a, b) in taken.iter().zip(stress) {
            assert!((a + b).abs() < 1e-14, "{taken:?}");
        }
    }
}
