//! A scene of each kind.

use crate::backends::agreement::{AGREEMENT, all};
use crate::support::{close, largest, load, sparse, try_run};
use brinell::ErrorKind;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::scene::Scene;
use brinell::substructure::Substructure;

const CYLINDER: &str = "hard/unload_reload";
const SHORT: &str = "program.targets=[{ yield = true }, { load_factor = 1.6 }, \
                     { half_width = 1.1 }, { load_factor = 0.0 }]";

/// Changes of contact are hit within gamma and forces balance within the tolerance: both below the
/// agreement asked for.
const SHARP: [&str; 2] = ["program.gamma=1e-12", "analysis.tolerance=1e-11"];

/// A cylinder that the dense backend takes a second for.
const SMALL: [&str; 2] = [
    "mesh.cylinder_on_half_plane.resolution=3",
    "mesh.cylinder_on_half_plane.far_size=20.0",
];

fn runs(name: &str, overrides: &[&str]) {
    let small = if name == CYLINDER { &SMALL[..] } else { &[] };
    let overrides = [&SHARP, small, overrides].concat();
    assert!(
        all(&load(name, &overrides)).is_some(),
        "{name} does not run"
    );
}

/// The condensed contact matrix T, with and without a zone.
#[test]
fn condensed_contact_matrices_agree() {
    for name in [
        CYLINDER,
        "hard/three_in_a_row",
        "hard/zero_gap_conforming",
        "hard/floating_body",
        "hard/interference",
    ] {
        let small = if name == CYLINDER { &SMALL[..] } else { &[] };
        let model = Model::new(&load(name, small)).unwrap();
        let system = brinell::assembly::assemble(&model, Backend::default()).unwrap();
        let contact = Substructure::new(&model, &system, Default::default(), Backend::Dense)
            .unwrap()
            .partition
            .contact;
        let free = (0..model.freedoms.n).filter(|f| !contact.contains(f));
        // Every third freedom: the groups interleave as badly as they can.
        let zones = [vec![], free.step_by(3).collect::<Vec<_>>()];
        for zone in zones {
            let matrix = |backend| {
                let sub = Substructure::new(&model, &system, zone.clone(), backend).unwrap();
                sub.tableau().matrix().dense()
            };
            let a = matrix(Backend::Dense);
            for backend in sparse() {
                let off = (&a - matrix(backend)).amax();
                close(name, off, 0.0, a.amax(), AGREEMENT);
            }
            assert!(a.nrows() > 2 && a.amax() > 0.0);
        }
    }
}

#[test]
fn cylinder_up_and_down() {
    runs(CYLINDER, &[SHORT]);
}

#[test]
fn cylinder_in_fixed_steps() {
    runs(
        CYLINDER,
        &[SHORT, "program.stepping=steps", "program.steps=4"],
    );
}

#[test]
fn cylinder_perfectly_plastic() {
    runs(CYLINDER, &[SHORT, "materials.steel.plastic_modulus=0.0"]);
}

#[test]
fn cylinder_of_quadratic_elements() {
    runs(
        CYLINDER,
        &[
            SHORT,
            "mesh.cylinder_on_half_plane.element=quad8",
            "mesh.cylinder_on_half_plane.resolution=2",
            "mesh.cylinder_on_half_plane.far_size=20.0",
        ],
    );
}

#[test]
fn cylinder_by_the_papers_secant() {
    runs(
        CYLINDER,
        &[
            "program.targets=[{ yield = true }]",
            "analysis.yield_load=secant",
        ],
    );
}

#[test]
fn ball() {
    runs(CYLINDER, &[SHORT, "kind=axisymmetric"]);
}

#[test]
fn disc_in_plane_stress_and_plane_strain() {
    for kind in ["plane_stress", "plane_strain"] {
        runs(
            "hard/zero_gap_conforming",
            &[
                "materials.steel.yield_stress=500.0",
                "materials.steel.plastic_modulus=5000.0",
                "program.unit=yield",
                "program.targets=[{ yield = true }, { load_factor = 1.5 }, { load_factor = 0.5 }]",
                &format!("kind={kind}"),
            ],
        );
    }
}

#[test]
fn blocks_bodies_and_rings() {
    for name in [
        "contact_patch",
        "gmsh_blocks",
        "hard/floating_body",
        "hard/lift_off",
        "hard/grazing",
        "hard/one_pair",
        "hard/all_closed",
        "hard/three_in_a_row",
        "hard/interference",
    ] {
        runs(name, &[]);
    }
}

#[test]
fn rigid_surface() {
    runs("hard/rigid_ball", &[]);
}

#[test]
fn shim_between_blocks() {
    runs(
        "three_bodies",
        &[
            "program.targets=[{ name = \"clamped\", load_factor = 0.0 }, { yield = true }, \
             { load_factor = 2.0 }, { load_factor = 0.0 }]",
        ],
    );
}

/// Both stop at the limit load: with the same kind of error.
#[test]
fn collapse() {
    let scene: Scene = load("hard/limit_load", &[]);
    for backend in [sparse(), vec![Backend::Dense]].concat() {
        let error = crate::support::try_run(&scene, backend).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Collapse, "{error}");
    }
}

/// Plain and Anderson-accelerated iteration reach the states of Newton's, to the plastic tolerance:
/// an out-of-balance force of 1e-10 moves stresses by as much and plastic strains by (E + H) / H =
/// 4.5 of it; events are hit within gamma. The backends agree in Newton's.
#[test]
fn iterations_agree() {
    let steel = "materials.steel.plastic_modulus=60000.0";
    let with = |iteration: &str| {
        let set = format!("analysis.plastic_iteration={iteration}");
        load(
            CYLINDER,
            &[&SMALL[..], &[SHORT, steel, &set], &SHARP].concat(),
        )
    };
    let newton = all(&with("newton")).unwrap();
    for iteration in ["plain", "anderson"] {
        let other = try_run(&with(iteration), Backend::default()).unwrap();
        for (a, b) in newton.states.iter().zip(&other.states) {
            let force = largest(a.pairs.iter().map(|p| p.force)).max(1.0);
            for (p, q) in a.pairs.iter().zip(&b.pairs) {
                close(
                    &format!("{iteration}: force of pair {} at {}", p.pair, a.name),
                    p.force,
                    q.force,
                    force,
                    1e-6,
                );
            }
            let strain = newton.states[1].max_equivalent_plastic_strain;
            close(
                iteration,
                a.max_equivalent_plastic_strain,
                b.max_equivalent_plastic_strain,
                strain,
                1e-6,
            );
        }
    }
}
