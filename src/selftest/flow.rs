//! Plastic flow: incompressible, at the limit load, in cycles, on the axis of quadratic elements.

use super::cases::{CaseFamily, Cases, difference, results, scene, state};
use crate::error::{ErrorKind, Result};
use crate::shape::Shape;

pub(super) const FAMILIES: &[CaseFamily] = &[
    CaseFamily {
        name: "incompressible flow",
        figure: "limit pressure of a tube, nu 0.3 to 0.4999, quad4, quad8",
        bound: 0.01,
        source: "Hill 1950, 2 k ln(b/a), exact for nu = 1/2; the mesh, of order h^2",
        cases: tube,
    },
    CaseFamily {
        name: "limit load",
        figure: "bracket of the collapse load of a column",
        bound: 2e-6,
        source: "increments are cut to a millionth of the load step",
        cases: column,
    },
    CaseFamily {
        name: "slender elements",
        figure: "plastic strain of two blocks, elements 75 times as high as wide and square ones, \
                 tolerances to 2e-15",
        bound: 1e-8 / 4e-3,
        source: "forces balance to their round-off, 1e-8 at most; a tangent of 4e-3 of the elastic \
                 stiffness",
        cases: slender,
    },
    CaseFamily {
        name: "cycles",
        figure: "loop of the last two of five cycles, unloading and reloading",
        bound: 1e-6,
        source: "shakedown: the steps to it shrink from cycle to cycle",
        cases: cycles,
    },
    CaseFamily {
        name: "ratchetting and shakedown",
        figure: "plastic strain of a cycle, perfectly plastic; of the 200th cycle, hardening",
        bound: 1e-8,
        source: "closed forms; forces balance to 1e-10, twice a cycle",
        cases: ratchet,
    },
    CaseFamily {
        name: "axis of quadratic elements",
        figure: "uniform pressure, elastic and under plastic flow",
        bound: 1e-8,
        source: "uniform stress is in the space of the elements; forces balance to 1e-10",
        cases: axis,
    },
];

fn tube(cases: &mut Cases) -> Result<()> {
    let mut tube = scene(include_str!(
        "../../data/scenes/hard/nearly_incompressible.toml"
    ))?;
    let limit = 2.0 * 240.0 / 3f64.sqrt() * 2f64.ln();
    for shape in [Shape::Quad4, Shape::Quad8] {
        for part in tube.mesh.parts.iter_mut().flatten() {
            part.element = shape;
            if let Some(ring) = &mut part.ring {
                ring.elements = [8, 6];
            }
        }
        for nu in [0.3, 0.49, 0.4999] {
            for material in tube.materials.values_mut() {
                material.poissons_ratio = nu;
            }
            let run = results(&tube)?;
            let collapsed = run.ending().kind() == Some(ErrorKind::Collapse);
            let last = run.history.last().filter(|_| collapsed);
            cases.add(last.map_or(f64::NAN, |row| row.alpha / limit - 1.0));
        }
    }
    Ok(())
}

fn column(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!(
        "../../data/scenes/hard/limit_load.toml"
    ))?)?;
    let collapsed = run.ending().kind() == Some(ErrorKind::Collapse);
    let last = run.history.last().filter(|_| collapsed);
    cases.add(last.map_or(f64::NAN, |row| row.alpha - 1.0));
    Ok(())
}

fn slender(cases: &mut Cases) -> Result<()> {
    let mut blocks = scene(include_str!("../../data/scenes/hard/slender_elements.toml"))?;
    let mut strains = Vec::new();
    for elements in [[4, 2], [300, 2]] {
        for block in blocks.mesh.parts.iter_mut().flatten() {
            if let Some(block) = &mut block.block {
                block.elements = elements;
            }
        }
        for tolerance in [1e-10, 2e-15] {
            blocks.analysis.tolerance = tolerance;
            let run = results(&blocks)?;
            strains.push(state(&run, "pressed")?.max_equivalent_plastic_strain);
        }
    }
    for strain in &strains[1..] {
        cases.add(strain / strains[0] - 1.0);
    }
    Ok(())
}

fn cycles(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!("../../data/scenes/hard/cyclic.toml"))?)?;
    for name in ["high", "low"] {
        let (a, b) = (
            state(&run, &format!("{name} 4"))?,
            state(&run, &format!("{name} 5"))?,
        );
        cases.add(difference(a, b, |p| p.force));
        cases.add(b.max_equivalent_plastic_strain / a.max_equivalent_plastic_strain - 1.0);
    }
    let run = results(&scene(include_str!(
        "../../data/scenes/hard/unload_reload.toml"
    ))?)?;
    cases.add(difference(
        state(&run, "first")?,
        state(&run, "second")?,
        |p| p.force,
    ));
    Ok(())
}

/// A constant tension s acts along y, and the strain along x is cycled by +-e. At yield the stress
/// along x is `s/2 +- q`, `q^2 = Y^2 - 3/4 s^2`, and the flow rule gives an equivalent plastic
/// strain of `Y/q (2 e - 2 q/E)` in each half cycle. With hardening Y grows until `q = E e`.
fn ratchet(cases: &mut Cases) -> Result<()> {
    let (modulus, yield_stress, tension, amplitude) = (2e5f64, 200.0f64, 100.0f64, 0.003);
    let mut sheet = scene(include_str!("../../data/scenes/hard/ratchet.toml"))?;
    let run = results(&sheet)?;
    let q = (yield_stress.powi(2) - 0.75 * tension.powi(2)).sqrt();
    let half = yield_stress / q * (2.0 * amplitude - 2.0 * q / modulus);
    for pair in run.states.windows(2) {
        let grown = pair[1].max_equivalent_plastic_strain - pair[0].max_equivalent_plastic_strain;
        cases.add(grown / half - 1.0);
    }
    for material in sheet.materials.values_mut() {
        material.plastic_modulus = Some(5000.0);
    }
    let cycle = sheet.program.targets.split_off(4);
    for k in 3..=200 {
        for target in &cycle {
            let mut target = target.clone();
            target.name = target.name.map(|name| format!("{name} of {k}"));
            sheet.program.targets.push(target);
        }
    }
    let run = results(&sheet)?;
    let at_rest = ((modulus * amplitude).powi(2) + 0.75 * tension.powi(2)).sqrt();
    let last = run.states.last().map(|s| s.max_equivalent_plastic_strain);
    let reached = last.map_or(f64::NAN, |strain| {
        strain * 5000.0 / (at_rest - yield_stress)
    });
    cases.add(reached - 1.0);
    Ok(())
}

fn axis(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!(
        "../../data/scenes/hard/axis_of_quadratic_elements.toml"
    ))?)?;
    // The first state is elastic, in the second the whole lower block flows: a run without flow
    // would test nothing here.
    let plastic: Vec<bool> = run.states.iter().map(|s| s.plastic_points > 0).collect();
    if plastic != [false, true] {
        cases.add(f64::NAN);
    }
    for s in &run.states {
        let uniform = s.contact_force / (4.0 * std::f64::consts::PI);
        for p in &s.pairs {
            cases.add(p.pressure / uniform - 1.0);
        }
    }
    Ok(())
}
