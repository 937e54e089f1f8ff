//! One element pulled and pushed: uniaxial stress follows isotropic and kinematic hardening through
//! the whole program.
//!
//! Source: the flow rule in one dimension; J. C. Simo and T. J. R. Hughes, Computational
//! Inelasticity (1998), section 1.4.

use crate::support::run_text;
use crate::verification::close;

/// Stress of a bar with isotropic hardening `Y + H eps` about the back stress `C eps_p` at each
/// total strain of a history.
fn bar(strains: &[f64], c: f64) -> Vec<f64> {
    let (e, y, h) = (200000.0, 200.0, 20000.0);
    let (mut plastic, mut equivalent) = (0.0, 0.0);
    strains
        .iter()
        .map(|strain| {
            let trial: f64 = e * (strain - plastic) - c * plastic;
            let beyond = trial.abs() - (y + h * equivalent);
            if beyond > 0.0 {
                let flow = beyond / (e + h + c);
                plastic += flow * trial.signum();
                equivalent += flow;
            }
            e * (strain - plastic)
        })
        .collect()
}

/// One element in each kind of model, pulled along its last axis; the load's area.
const KINDS: [(&str, &str, f64); 3] = [
    ("plane_stress", PLANE, 1.0),
    ("axisymmetric", PLANE, std::f64::consts::PI),
    ("solid", SOLID, 1.0),
];
const PLANE: &str = r#"
mesh.parts = [{ body = "bar", block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [1, 1] } }]
support = [{ on = "bar.left", fix = ["x"] }, { on = "bar.bottom", fix = ["y"] }]
load = [{ on = "bar.top", displacement = { y = 1.0 } }]
"#;
const SOLID: &str = r#"
support = [
    { on = "bar.left", fix = ["x"] },
    { on = "bar.front", fix = ["y"] },
    { on = "bar.bottom", fix = ["z"] },
]
load = [{ on = "bar.top", displacement = { z = 1.0 } }]
[[mesh.parts]]
body = "bar"
[mesh.parts.brick]
x = [0.0, 1.0]
y = [0.0, 1.0]
z = [0.0, 1.0]
elements = [1, 1, 1]
"#;

#[test]
fn cycles_follow_the_hardening_curve() {
    let strains = [0.0008, 0.003, 0.0, -0.004, 0.002, 0.005, 0.0045];
    let targets: Vec<String> = strains
        .iter()
        .map(|s| format!("{{load_factor={s:?}}}"))
        .collect();
    for (kind, geometry, area) in KINDS {
        for modulus in [0.0, 30000.0] {
            let text = format!(
                r#"
kind = "{kind}"
{geometry}
[materials.metal]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 200.0
plastic_modulus = 20000.0
kinematic_modulus = {modulus:?}
[bodies.bar]
material = "metal"
[program]
targets = [{}]
"#,
                targets.join(",")
            );
            let results = run_text(&text);
            let axis = if kind == "solid" { 2 } else { 1 };
            for (state, exact) in results.states.iter().zip(bar(&strains, modulus)) {
                let stress = &state.fields.as_ref().unwrap().stress;
                // Equilibrium is found to 1e-10 of the force; the worst stress is a tenth of the
                // largest.
                assert!(
                    (stress[axis] - exact).abs() <= 1e-8 * 200.0,
                    "{kind} {modulus} {}: {} {exact}",
                    state.name,
                    stress[axis]
                );
                assert!(stress[0].abs() <= 1e-8 * 200.0);
                close(state.load.abs(), exact.abs() * area, 1e-7);
            }
        }
    }
}

/// Work on plastic strains, the area of the loops: `int sigma deps_p` of the bar along a path
/// finely divided.
#[test]
fn plastic_work_is_the_area_of_the_loops() {
    let turns = [0.0, 0.004, -0.003, 0.005];
    let fine: Vec<f64> = (turns.windows(2))
        .flat_map(|ends| {
            let step = (ends[1] - ends[0]) / 20_000.0;
            (1..=20_000).map(move |i| ends[0] + step * f64::from(i))
        })
        .collect();
    let (mut work, mut before) = (0.0, [0.0f64; 2]);
    for (strain, stress) in fine.iter().zip(bar(&fine, 30000.0)) {
        let plastic = strain - stress / 200000.0;
        work += 0.5 * (stress + before[0]) * (plastic - before[1]);
        before = [stress, plastic];
    }
    let text = format!(
        r#"
kind = "solid"
{SOLID}
[materials.metal]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 200.0
plastic_modulus = 20000.0
kinematic_modulus = 30000.0
[bodies.bar]
material = "metal"
[program]
targets = [{{load_factor=0.004}}, {{load_factor=-0.003}}, {{load_factor=0.005}}]
"#
    );
    let results = run_text(&text);
    close(results.states[2].plastic_work, work, 1e-6);
}
