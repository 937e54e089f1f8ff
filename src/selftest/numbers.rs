//! Numbers of very different size: stiffness ratios, slivers, units; and two backends.

use super::cases::{
    CaseFamily, Cases, difference, results, results_by, scene, state, worst_quality,
};
use crate::analysis::Analysis;
use crate::error::Result;
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Silent;
use crate::scene::Scene;

pub(super) const FAMILIES: &[CaseFamily] = &[
    CaseFamily {
        name: "stiffness ratio 1 to 1e10",
        figure: "contact force against the load, equilibrium",
        bound: 1e-10,
        source: "equilibrium does not know the ratio; n eps times the grading of the mesh",
        cases: ratios,
    },
    CaseFamily {
        name: "body sizes 1e-6 to 1e3 in a scene",
        figure: "pressure of a fit, pin and plate alike or 1e4 times as stiff",
        bound: 1e-2,
        source: "Lame; the mesh, of order h^2 at least",
        cases: sizes,
    },
    CaseFamily {
        name: "falls and lifts of 1e4 to 1e15",
        figure: "stresses of all elements under uniform pressure",
        bound: 1e-11,
        source: "rigid motions are no part of the deformation; round-off times the condition",
        cases: falls,
    },
    CaseFamily {
        name: "contact at nu 0.4999 to 0.499999",
        figure: "out-of-balance force over the round-off that the state reports, or over 1e-7",
        bound: 1.0,
        source: "2 eps abs(K) abs(u), the round-off of forces; events are located to 10 gamma = \
                 1e-7",
        cases: incompressible_contact,
    },
    CaseFamily {
        name: "slivers of aspect 1e5",
        figure: "uniform pressure",
        bound: 1e10 * f64::EPSILON,
        source: "condition 1e10 times eps",
        cases: slivers,
    },
    CaseFamily {
        name: "units and scales",
        figure: "elastoplastic states under E, load by 1e+-12, lengths by 1e+-9",
        bound: 1e-11,
        source: "equivariance; round-off times the condition (analysis.tolerance = 1e-12: forces \
                 must balance better than that)",
        cases: scales,
    },
    CaseFamily {
        name: "two backends",
        figure: "forces of CHOLMOD against dense Cholesky",
        bound: 1e-10,
        source: "round-off times the condition",
        cases: backends,
    },
];

fn falls(cases: &mut Cases) -> Result<()> {
    const PATCH: &str = include_str!("../../data/scenes/contact_patch.toml");
    for key in ["gap", "interference"] {
        for size in [1e4, 1e8, 1e10, 1e12, 1e15] {
            let line = format!("second = \"lower.top\"\n{key} = {size:e}\n");
            let patch = scene(&PATCH.replace("second = \"lower.top\"\n", &line))?;
            let run = Analysis::new(Model::new(&patch)?, Backend::default())?.run(&mut Silent)?;
            let fields = state(&run, "pressed")?.fields.as_ref();
            for stress in fields.map_or(&[][..], |f| &f.stress).chunks(4) {
                cases.add(stress[1] / -10.0 - 1.0);
            }
        }
    }
    Ok(())
}

fn incompressible_contact(cases: &mut Cases) -> Result<()> {
    const CYLINDER: &str = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
    let mut cylinder = scene(&CYLINDER.replace("resolution = 16", "resolution = 4"))?;
    for nu in [0.4999, 0.49999, 0.499999] {
        for material in cylinder.materials.values_mut() {
            material.poissons_ratio = nu;
        }
        for s in &results(&cylinder)?.states {
            let bound = s.quality.round_off.unwrap_or(f64::NAN).max(1e-7);
            cases.add(s.quality.equilibrium / bound);
        }
    }
    Ok(())
}

fn ratios(cases: &mut Cases) -> Result<()> {
    let mut press = scene(include_str!("../../data/scenes/hard/stiffness_ratio.toml"))?;
    for exponent in [0, 2, 4, 6, 8, 10] {
        if let Some(hard) = press.materials.get_mut("hard") {
            hard.youngs_modulus = 210_000.0 * 10f64.powi(exponent);
        }
        let run = results(&press)?;
        for s in &run.states {
            cases.add(s.contact_force / 500.0 - 1.0);
            cases.add(worst_quality(&run));
        }
    }
    Ok(())
}

fn sizes(cases: &mut Cases) -> Result<()> {
    let mut fit = scene(include_str!("../../data/scenes/hard/body_sizes.toml"))?;
    let e = 210_000.0;
    for [pin, plate] in [[e, e], [e, 1e4 * e], [1e4 * e, e]] {
        for (name, modulus) in [("pin", pin), ("plate", plate)] {
            if let Some(material) = fit.materials.get_mut(name) {
                material.youngs_modulus = modulus;
            }
        }
        // The plate's rim is so far away that it makes no difference; the radius of the pin's bore
        // is half that of the pin.
        let exact = 1e-3 / ((5.0 / 3.0 - 0.3) / pin + 1.3 / plate);
        let run = results(&fit)?;
        for pair in run.states.iter().flat_map(|s| &s.pairs) {
            cases.add(pair.pressure / exact - 1.0);
        }
        cases.add(worst_quality(&run));
    }
    Ok(())
}

fn slivers(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!("../../data/scenes/hard/slivers.toml"))?)?;
    for p in run.states.iter().flat_map(|s| &s.pairs) {
        cases.add(p.pressure / 10.0 - 1.0);
    }
    Ok(())
}

/// Returns the scene with forces, lengths and stresses in other units.
fn scaled(scene: &Scene, stress: f64, length: f64) -> Scene {
    let mut out = scene.clone();
    for material in out.materials.values_mut() {
        material.youngs_modulus *= stress;
        for value in [
            &mut material.yield_stress,
            &mut material.plastic_modulus,
            &mut material.tangent_modulus,
        ]
        .into_iter()
        .flatten()
        {
            *value *= stress;
        }
    }
    if let Some(mesh) = &mut out.mesh.cylinder_on_half_plane {
        mesh.radius *= length;
    }
    // In plane strain forces are per unit of thickness.
    for load in &mut out.load {
        if let Some(force) = &mut load.plane_force {
            force.total *= stress * length;
        }
    }
    out
}

fn scales(cases: &mut Cases) -> Result<()> {
    let mut base = scene(include_str!("../../data/scenes/hard/unload_reload.toml"))?;
    base.analysis.tolerance = 1e-12;
    let reference = results(&base)?;
    for (stress, length) in [
        (1e12, 1.0),
        (1e-12, 1.0),
        (1.0, 1e9),
        (1.0, 1e-9),
        (1e6, 1e-3),
    ] {
        let run = results(&scaled(&base, stress, length))?;
        if run.states.len() != reference.states.len() {
            cases.add(f64::NAN);
        }
        for (a, b) in reference.states.iter().zip(&run.states) {
            cases.add(b.alpha / a.alpha - 1.0);
            cases.add(b.max_pressure / stress / a.max_pressure - 1.0);
            cases.add(b.half_width / length / a.half_width - 1.0);
        }
    }
    Ok(())
}

fn backends(cases: &mut Cases) -> Result<()> {
    for text in [
        include_str!("../../data/scenes/hard/floating_body.toml"),
        include_str!("../../data/scenes/hard/interference.toml"),
        include_str!("../../data/scenes/hard/three_in_a_row.toml"),
    ] {
        let scene = scene(text)?;
        let a = results_by(&scene, Backend::default())?;
        let b = results_by(&scene, Backend::Dense)?;
        for (a, b) in a.states.iter().zip(&b.states) {
            if a.contact_force > 0.0 {
                cases.add(difference(a, b, |p| p.force));
            }
        }
    }
    Ok(())
}
