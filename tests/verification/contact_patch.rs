//! The contact patch test: uniform pressure passes through a contact of matching meshes to
//! round-off.
//!
//! Source: equilibrium; R. L. Taylor and P. Papadopoulos, On a patch test for contact problems in
//! two dimensions (1991).

use crate::support::run_file;
use crate::verification::close;
#[test]
fn uniform_pressure_passes() {
    for shape in ["quad4", "quad8", "tri3", "tri6"] {
        let lower = format!("mesh.parts.0.element=\"{shape}\"");
        let upper = format!("mesh.parts.1.element=\"{shape}\"");
        for (name, pressure) in [("contact_patch", 10.0)] {
            let results = run_file(name, &[&lower, &upper]);
            for pair in &results.states[0].pairs {
                close(pair.pressure, pressure, 1e-10);
                assert!(pair.gap.abs() <= 1e-10 * pressure / 210000.0);
            }
            for stress in results.states[0].fields.as_ref().unwrap().stress.chunks(4) {
                close(stress[1], -pressure, 1e-10);
                assert!(stress[0].abs().max(stress[3].abs()) <= 1e-10 * pressure);
            }
        }
    }
}

#[test]
fn a_gmsh_mesh_passes_too() {
    for pair in &run_file("gmsh_blocks", &[]).states[0].pairs {
        close(pair.pressure, 10.0, 1e-10);
    }
}
