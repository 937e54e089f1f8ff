//! Two spheres of radius 50 pressed together by 4: by symmetry one against a rigid plane, by 2.
//!
//! Source: Code_Aster SSNV104 (`data/reference/code_aster_ssnv104`), after Hertz.

use crate::support::{run_file, state};
use crate::verification::close;
use brinell::analytical::{HertzPoint, contact_modulus};

/// The force is Hertz's for a radius of contact of 10: P = 4/3 E* a^3/R. The sphere is a circle
/// where Hertz has a parabola: its gap is larger by up to (a/R)^2/4 = 1 %, and so are stresses and
/// the radius by shares of it; both are of order h^2.
#[test]
fn centre_stress_and_contact_radius() {
    let modulus = contact_modulus(20e3, 0.3, 2e13, 0.3);
    let hertz = HertzPoint::new(50.0, modulus).unwrap();
    let force = hertz.load_for_contact_radius(10.0);
    close(hertz.max_pressure(force), 2798.0, 1e-3);
    let errors = |n: usize| {
        let set = [
            "materials.rigid={ youngs_modulus = 2e13, poissons_ratio = 0.3 }".to_string(),
            "materials.steel.youngs_modulus=20000.0".to_string(),
            "materials.steel.yield_stress=".to_string(),
            "materials.steel.tangent_modulus=".to_string(),
            "bodies.half_plane.material=rigid".to_string(),
            "mesh.cylinder_on_half_plane.radius=50.0".to_string(),
            "mesh.cylinder_on_half_plane.half_width=10.0".to_string(),
            format!("mesh.cylinder_on_half_plane.resolution={n}"),
            format!("load.press.plane_force.total={:e}", -force),
            "program={ unit = \"load\", targets = [{ name = \"pressed\", load_factor = 1.0 }] }"
                .to_string(),
            "reference=[]".to_string(),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let results = run_file("ball_on_half_space", &set);
        let s = state(&results, "pressed");
        close(s.contact_force, force, 1e-9);
        [s.max_pressure / 2798.0 - 1.0, s.half_width / 10.0 - 1.0].map(f64::abs)
    };
    for n in [8, 16] {
        let found = errors(n);
        let bound = 0.01 + 1.0 / (n * n) as f64;
        assert!(found.iter().all(|e| *e <= bound), "{n}: {found:?} {bound}");
    }
}
