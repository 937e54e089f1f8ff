use super::*;
use crate::mesh::generate;
use crate::scene::{CylinderOnHalfPlane, DiscInPlate};

fn generated(shape: Shape) -> [Mesh; 2] {
    let cylinder = CylinderOnHalfPlane {
        names: ["cylinder", "half_plane"].map(String::from),
        radius: 1.0 / 3.0,
        resolution: 3,
        half_width: None,
        fine_width: 2.0,
        contact_width: None,
        fine_depth: 1.5,
        far_size: Some(30.0),
        growth: 1.2,
        far_growth: None,
        element: shape,
    };
    let disc = DiscInPlate {
        names: ["disc", "plate"].map(String::from),
        radius: 0.1,
        interference: 0.0,
        resolution: 6,
        far_radius: 7.0,
        growth: 1.1,
        far_growth: None,
        element: shape,
    };
    [
        generate::cylinder_on_half_plane(&cylinder, generate::ContactSize::at_yield(0.007))
            .unwrap(),
        generate::disc_in_plate(&disc).unwrap(),
    ]
}

/// Everything except the exact curves is recovered, and coordinates are equal bit for bit.
#[test]
fn generated_meshes_come_back_as_they_were() {
    for shape in Shape::PLANE {
        for mesh in generated(shape) {
            let mut text = Vec::new();
            write(&mesh, &mut text).unwrap();
            let read = parse(&text, "written.msh").unwrap();
            validate(&read).unwrap();
            assert_eq!(read.coordinates, mesh.coordinates);
            assert_eq!(read.connectivity, mesh.connectivity);
            assert_eq!(read.offsets, mesh.offsets);
            assert_eq!(read.shapes, mesh.shapes);
            assert_eq!(read.bodies, mesh.bodies);
            assert_eq!(read.element_body, mesh.element_body);
            assert_eq!(read.node_sets, mesh.node_sets);
            assert!(read.surfaces.keys().eq(mesh.surfaces.keys()));
            for (name, surface) in &mesh.surfaces {
                let mut facets = surface.facets.clone();
                facets.sort_unstable();
                assert_eq!(read.surfaces[name].facets, facets, "{name}");
            }
            let mut again = Vec::new();
            write(&read, &mut again).unwrap();
            assert_eq!(
                parse(&again, "again.msh").unwrap().coordinates,
                mesh.coordinates
            );
        }
    }
}

#[test]
fn numbers_of_the_file_are_kept() {
    let mesh = parsed(V2);
    let mut text = Vec::new();
    write(&mesh, &mut text).unwrap();
    let read = parse(&text, "written.msh").unwrap();
    assert_eq!(read.node_labels, mesh.node_labels);
    assert_eq!(read.element_labels, mesh.element_labels);
    assert_eq!(read.surfaces, mesh.surfaces);
    assert_eq!(read.node_sets, mesh.node_sets);
}

#[test]
fn a_name_that_the_format_cannot_hold_is_refused() {
    for name in ["a\"b", "a\nb"] {
        let mut mesh = parsed(V2);
        mesh.bodies[0] = name.to_string();
        let error = write(&mesh, &mut Vec::new()).unwrap_err();
        assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput);
    }
}

/// A sink that refuses everything written to it.
struct Full;

impl std::io::Write for Full {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(std::io::ErrorKind::StorageFull.into())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_reported() {
    let error = write(&parsed(V2), &mut Full).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::StorageFull);
}
