//! Meshes put together of others.

use brinell::mesh::{Facet, Mesh, Surface};

/// The first body of one mesh with the others of a second.
pub fn joined(one: &Mesh, other: &Mesh) -> Mesh {
    let mut out = Mesh {
        dimension: one.dimension,
        bodies: one.bodies.clone(),
        ..Mesh::default()
    };
    let mut first = 0;
    for (mesh, takes) in [(one, true), (other, false)] {
        let is_of = |e: usize| (mesh.element_body[e] == 0) == takes;
        let mut number = vec![u32::MAX; mesh.n_elements()];
        for e in (0..mesh.n_elements()).filter(|&e| is_of(e)) {
            number[e] = out.n_elements() as u32;
            let nodes: Vec<u32> = mesh.nodes(e).iter().map(|n| n + first).collect();
            out.push_element(mesh.shapes[e], mesh.element_body[e] as usize, &nodes);
        }
        out.coordinates.extend(&mesh.coordinates);
        for (name, surface) in &mesh.surfaces {
            if !is_of(surface.facets[0].element) {
                continue;
            }
            let facets = surface.facets.iter().map(|facet| Facet {
                element: number[facet.element] as usize,
                local: facet.local,
            });
            let surface = Surface {
                facets: facets.collect(),
                curve: surface.curve,
            };
            out.surfaces.insert(name.clone(), surface);
        }
        first += mesh.n_nodes() as u32;
    }
    without_loose_nodes(out)
}

fn without_loose_nodes(mut mesh: Mesh) -> Mesh {
    let mut number = vec![u32::MAX; mesh.n_nodes()];
    let mut kept = Vec::new();
    for node in &mut mesh.connectivity {
        let old = *node as usize;
        if number[old] == u32::MAX {
            number[old] = (kept.len() / mesh.dimension) as u32;
            let at = mesh.dimension * old;
            kept.extend(&mesh.coordinates[at..at + mesh.dimension]);
        }
        *node = number[old];
    }
    mesh.coordinates = kept;
    mesh
}
