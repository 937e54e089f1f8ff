//! Models as users write them: bodies one element thick, punches with arbitrary ends, stacks,
//! unlike and coarse meshes, heat under a loose body.

use super::cases::{CaseFamily, Cases, results, scene};
use crate::analysis::Analysis;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Silent;
use crate::results::{Results, State};

pub(super) const FAMILIES: &[CaseFamily] = &[
    CaseFamily {
        name: "bodies on few elements",
        figure: "stress at Gauss points of elastic states, over yield, less 1",
        bound: 1e-7,
        source: "where a Gauss point is beyond yield the state is elastoplastic; forces balance to \
                 1e-10",
        cases: few_elements,
    },
    CaseFamily {
        name: "punches on larger and coarser bases",
        figure: "area of contact; area by mean pressure against the force",
        bound: 1e-9,
        source: "a uniform pressure on the punch's own face; forces balance to 1e-10",
        cases: punches,
    },
    CaseFamily {
        name: "stacks moved by displacement",
        figure: "load against the force of each contact",
        bound: 1e-8,
        source: "one force goes through the stack; forces balance to 1e-10",
        cases: stacks,
    },
    CaseFamily {
        name: "heat and residual stress under a loose body",
        figure: "contact force against the load",
        bound: 1e-8,
        source: "they push no body away; forces balance to 1e-10",
        cases: loose,
    },
    CaseFamily {
        name: "bodies that nothing holds sideways",
        figure: "pressure and dent against those of the same bodies held at a corner",
        bound: 1e-7,
        source: "a motion that nothing drives changes nothing; forces balance to 1e-10, a hundred \
                 times that in displacements",
        cases: sideways,
    },
    CaseFamily {
        name: "unlike meshes, far beyond yield",
        figure: "out-of-balance force at twice the pressure at which a bar yields",
        bound: 1e-8,
        source: "forces balance to 1e-10, and to round-off of the mesh; any other end is infinite",
        cases: unlike,
    },
];

const METAL: &str = "[materials.m]\nyoungs_modulus = 200e3\npoissons_ratio = 0.3\n\
                     thermal_expansion = 1.2e-5\nyield_stress = 200\nplastic_modulus = 2000\n\
                     [program]\ntargets = [{ load_factor = 1.0 }]\n";

fn with_fields(text: &str, load_factor: f64) -> Result<Results> {
    let mut scene = scene(text)?;
    for target in &mut scene.program.targets {
        target.load_factor = Some(load_factor);
        target.fields = true;
    }
    Analysis::new(Model::new(&scene)?, Backend::default())?.run(&mut Silent)
}

fn few_elements(cases: &mut Cases) -> Result<()> {
    let block = |kind: &str, part: &str, support: &str, load: &str| {
        format!(
            "kind = \"{kind}\"\nmesh.parts = [{{ body = \"b\", {part} }}]\n\
             bodies.b.material = \"m\"\nsupport = [{support}]\nload = [{load}]\n{METAL}"
        )
    };
    let mut all = Vec::new();
    for element in ["tri3", "tri6", "quad4", "quad8"] {
        for [along, high] in [[12, 1], [3, 2], [1, 1], [1, 6]] {
            let part = format!(
                "element = \"{element}\", block = {{ x = [0, 4], y = [0, 1], \
                 elements = [{along}, {high}] }}"
            );
            let clamped = "{ on = \"b.left\", fix = [\"x\", \"y\"] }";
            let bent = "{ on = \"b.right\", traction = [0.0, 30.0] }";
            all.push(block("plane_stress", &part, clamped, bent));
            // Two sides are held in both directions, also along themselves, so they are not planes
            // of symmetry.
            let sheared = "{ on = \"b.top\", displacement = { x = 0.01 } }";
            let between = "{ on = \"b.bottom\", fix = [\"x\", \"y\"] }, \
                           { on = \"b.top\", fix = [\"y\"] }";
            all.push(block("plane_strain", &part, between, sheared));
        }
    }
    for [along, wide, high] in [[8, 1, 4], [4, 1, 1], [2, 2, 2]] {
        let part = format!(
            "element = \"hex8\", brick = {{ x = [0, 4], y = [0, 1], z = [0, 1], \
             elements = [{along}, {wide}, {high}] }}"
        );
        let clamped = "{ on = \"b.left\", fix = [\"x\", \"y\", \"z\"] }";
        let bent = "{ on = \"b.right\", traction = [0.0, 0.0, 30.0] }";
        all.push(block("solid", &part, clamped, bent));
    }
    for text in all {
        let first = with_fields(&text, 1.0)?.first_yield;
        let alpha = first.map_or(1.0, |first| first.alpha.min(1.0));
        for share in [0.9, 0.97, 0.999] {
            let found = with_fields(&text, share * alpha)?;
            for state in found
                .states
                .iter()
                .filter(|state| state.plastic_points == 0)
            {
                let fields = state.fields.as_ref();
                let stress = fields.map_or(f64::NAN, |f| {
                    f.von_mises.iter().copied().fold(0.0, f64::max)
                });
                cases.add((stress / 200.0 - 1.0).max(0.0));
            }
        }
    }
    Ok(())
}

fn punches(cases: &mut Cases) -> Result<()> {
    for slave in ["first", "second"] {
        for [along, across] in [[9, 5], [14, 8], [30, 16]] {
            let text = format!(
                "kind = \"solid\"\n\
                 mesh.parts = [{{ body = \"punch\", brick = {{ x = [-6, 6], y = [-3, 3], \
                 z = [0, 3], elements = [12, 6, 1] }} }}, \
                 {{ body = \"base\", brick = {{ x = [-7, 7], y = [-4, 4], \
                 z = [-2, 0], elements = [{along}, {across}, 1] }} }}]\n\
                 materials.soft = {{ youngs_modulus = 1000.0, poissons_ratio = 0.0 }}\n\
                 materials.hard = {{ youngs_modulus = 1e9, poissons_ratio = 0.0 }}\n\
                 bodies = {{ punch.material = \"soft\", base.material = \"hard\" }}\n\
                 contact = [{{ first = \"punch.bottom\", second = \"base.top\", \
                 slave = \"{slave}\" }}]\n\
                 support = [{{ on = \"base.bottom\", fix = [\"x\", \"y\", \"z\"] }}, \
                 {{ on = \"punch.left\", fix = [\"x\"] }}, \
                 {{ on = \"punch.front\", fix = [\"y\"] }}]\n\
                 load = [{{ on = \"punch.top\", pressure = 10.0 }}]\n\
                 program.targets = [{{ load_factor = 1.0 }}]\n"
            );
            let found = results(&scene(&text)?)?;
            for patch in found.states.iter().flat_map(|state| &state.patches) {
                cases.add(patch.area / 72.0 - 1.0);
                cases.add(patch.area * patch.mean_pressure / 720.0 - 1.0);
            }
        }
    }
    Ok(())
}

fn stacks(cases: &mut Cases) -> Result<()> {
    for kind in ["plane_strain", "plane_stress", "axisymmetric"] {
        for n in 1..=4 {
            let part = |i: usize| {
                format!(
                    "{{ body = \"b{i}\", block = {{ x = [0, {}], y = [{i}, {}], \
                     elements = [{}, 2] }} }}",
                    4 - i,
                    i + 1,
                    3 + i
                )
            };
            let each = |of: &dyn Fn(usize) -> String, count: usize| {
                (0..count).map(of).collect::<Vec<_>>().join(", ")
            };
            let contact =
                |i: usize| format!("{{ first = \"b{i}.top\", second = \"b{}.bottom\" }}", i + 1);
            let held = |i: usize| format!("{{ on = \"b{i}.left\", fix = [\"x\"] }}");
            let text = format!(
                "kind = \"{kind}\"\nmesh.parts = [{}]\nbodies = {{ {} }}\ncontact = [{}]\n\
                 support = [{}, {{ on = \"b0.bottom\", fix = [\"y\"] }}]\n\
                 load = [{{ on = \"b{}.top\", displacement = {{ y = -0.01 }} }}]\n{METAL}",
                each(&part, n),
                each(&|i| format!("b{i}.material = \"m\""), n),
                each(&contact, n - 1),
                each(&held, n),
                n - 1,
            );
            let found = results(&scene(&text)?)?;
            for state in &found.states {
                for contact in 0..n - 1 {
                    let pairs = state.pairs.iter().filter(|pair| pair.contact == contact);
                    cases.add(pairs.map(|pair| pair.force).sum::<f64>() / state.load - 1.0);
                }
            }
        }
    }
    Ok(())
}

/// Returns a scene of a block under pressure that lies on another block; `of_low` adds keys to the
/// lower body, `rest` adds loads.
fn on_block(kind: &str, of_low: &str, rest: &str, [low, up]: [&str; 2]) -> String {
    format!(
        "kind = \"{kind}\"\n\
         mesh.parts = [{{ body = \"low\", {low} }}, {{ body = \"up\", {up} }}]\n\
         contact = [{{ first = \"up.bottom\", second = \"low.top\" }}]\n\
         support = [{{ on = \"low.bottom\", fix = [\"y\"] }}, \
         {{ on = \"low.left\", fix = [\"x\"] }}, {{ on = \"up.left\", fix = [\"x\"] }}]\n\
         bodies = {{ low = {{ material = \"m\"{of_low} }}, up.material = \"m\" }}\n\
         load = [{{ on = \"up.top\", pressure = 100.0 }}{rest}]\n{METAL}"
    )
}

fn loose(cases: &mut Cases) -> Result<()> {
    let low = "block = { x = [0, 4], y = [0, 2], elements = [12, 6] }";
    let up = "block = { x = [0, 2], y = [2, 3], elements = [7, 4] }";
    let heat =
        |by: f64| format!(", {{ on = \"low\", temperature = {by:?}, history = \"constant\" }}");
    let stress = |by: f64| format!(", initial_stress = [[0.0, {by:?}, 0.0, 0.0]]");
    for kind in ["plane_strain", "plane_stress", "axisymmetric"] {
        for by in [-81.0, 1.0, 60.0, 79.0, 80.0, 81.0] {
            for (of_low, rest) in [(String::new(), heat(by)), (stress(by), String::new())] {
                let found = results(&scene(&on_block(kind, &of_low, &rest, [low, up]))?)?;
                for state in &found.states {
                    let area = match kind {
                        "axisymmetric" => 4.0 * std::f64::consts::PI,
                        _ => 2.0,
                    };
                    cases.add(state.contact_force / (100.0 * area) - 1.0);
                }
            }
        }
    }
    Ok(())
}

fn sideways(cases: &mut Cases) -> Result<()> {
    let low = "block = { x = [0, 4], y = [0, 2], elements = [12, 6] }";
    for kind in ["plane_strain", "plane_stress"] {
        for element in ["tri3", "tri6", "quad4", "quad8"] {
            let up = format!(
                "element = \"{element}\", block = {{ x = [1, 3], y = [2, 3], elements = [7, 4] }}"
            );
            let of = |on: &str| {
                let text = on_block(kind, "", "", [low, &up]);
                let text = text.replace("{ on = \"up.left\", fix = [\"x\"] }", on);
                results(&scene(&text.replace(
                    "[{ load_factor = 1.0 }]",
                    "[{ load_factor = 1.0 }, { load_factor = 3.0 }, { load_factor = 0.0 }]",
                ))?)
            };
            let [loose, held] = [of("")?, of("{ on = \"up.top_left\", fix = [\"x\"] }")?];
            for (loose, held) in loose.states.iter().zip(&held.states) {
                for figure in [|s: &State| s.max_pressure, |s: &State| s.residual_depth] {
                    let size = figure(held);
                    if size > 0.0 {
                        cases.add(figure(loose) / size - 1.0);
                    }
                }
            }
        }
    }
    Ok(())
}

fn unlike(cases: &mut Cases) -> Result<()> {
    for kind in ["plane_strain", "plane_stress", "axisymmetric"] {
        for element in ["tri3", "tri6", "quad4", "quad8"] {
            for [cells, other] in [[12, 7], [7, 12]] {
                let part = |to: f64, y: [f64; 2], n: usize| {
                    format!(
                        "element = \"{element}\", block = {{ x = [0, {to:?}], y = {y:?}, \
                         elements = [{n}, 4] }}"
                    )
                };
                let [low, up] = [part(4.0, [0.0, 2.0], cells), part(2.0, [2.0, 3.0], other)];
                let text = on_block(kind, "", "", [&low, &up]);
                // The pressure is twice that at which a bar yields.
                let text = text.replace("pressure = 100.0", "pressure = 400.0");
                let found = results(&scene(&text)?)?;
                match found.ending().kind() {
                    None => cases.add(found.quality.equilibrium),
                    other => return Err(Error::analysis(format!("{kind}, {element}: {other:?}"))),
                }
            }
        }
    }
    Ok(())
}
