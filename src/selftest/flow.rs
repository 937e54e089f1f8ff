//! Plastic flow: incompressible, at the limit load, in cycles, on the axis of quadratic elements.

use super::{Cases, Family, difference, results, scene, state};
use crate::error::{ErrorKind, Result};
use crate::shape::Shape;

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "incompressible flow",
        figure: "limit pressure of a tube, nu 0.3 to 0.4999, quad4, quad8",
        bound: 0.01,
        source: "Hill 1950, 2 k ln(b/a), exact for nu = 1/2; the mesh, of order h^2",
        cases: tube,
    },
    Family {
        name: "limit load",
        figure: "bracket of the collapse load of a column",
        bound: 2e-6,
        source: "increments are cut to a millionth of the load step",
        cases: column,
    },
    Family {
        name: "cycles",
        figure: "loop of the last two of five cycles, unloading and reloading",
        bound: 1e-6,
        source: "shakedown: the steps to it shrink from cycle to cycle",
        cases: cycles,
    },
    Family {
        name: "axis of quadratic elements",
        figure: "uniform pressure under plastic flow",
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
        }
        for nu in [0.3, 0.49, 0.4999] {
            for material in tube.materials.values_mut() {
                material.poissons_ratio = nu;
            }
            let run = results(&tube)?;
            let collapsed = run.incomplete_kind == Some(ErrorKind::Collapse);
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
    let collapsed = run.incomplete_kind == Some(ErrorKind::Collapse);
    let last = run.history.last().filter(|_| collapsed);
    cases.add(last.map_or(f64::NAN, |row| row.alpha - 1.0));
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

fn axis(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!(
        "../../data/scenes/hard/axis_of_quadratic_elements.toml"
    ))?)?;
    for s in &run.states {
        let uniform = s.contact_force / (4.0 * std::f64::consts::PI);
        for p in &s.pairs {
            cases.add(p.pressure / uniform - 1.0);
        }
    }
    Ok(())
}
