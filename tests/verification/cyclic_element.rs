//! One element pulled and pushed: uniaxial stress follows the isotropic hardening curve through the
//! whole program.
//!
//! Source: the flow rule in one dimension; J. C. Simo and T. J. R. Hughes, Computational
//! Inelasticity (1998), section 1.4.

use crate::run::{close, run};
use brinell::scene::Scene;

/// Stress of a bar with isotropic hardening `Y + H eps` at each total strain of a history.
fn bar(strains: &[f64]) -> Vec<f64> {
    let (e, y, h) = (200000.0, 200.0, 20000.0);
    let (mut plastic, mut equivalent) = (0.0, 0.0);
    strains
        .iter()
        .map(|strain| {
            let trial: f64 = e * (strain - plastic);
            let beyond = trial.abs() - (y + h * equivalent);
            if beyond > 0.0 {
                let flow = beyond / (e + h);
                plastic += flow * trial.signum();
                equivalent += flow;
            }
            e * (strain - plastic)
        })
        .collect()
}

#[test]
fn cycles_follow_the_hardening_curve() {
    let strains = [0.0008, 0.003, 0.0, -0.004, 0.002, 0.005, 0.0045];
    let targets: Vec<String> = strains
        .iter()
        .map(|s| format!("{{load_factor={s:?}}}"))
        .collect();
    for kind in ["plane_stress", "axisymmetric"] {
        let text = format!(
            r#"
kind = "{kind}"
[[mesh.parts]]
body = "bar"
block = {{ x = [0.0, 1.0], y = [0.0, 1.0], elements = [1, 1] }}
[materials.metal]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 200.0
plastic_modulus = 20000.0
[bodies.bar]
material = "metal"
[[support]]
on = "bar.left"
fix = ["x"]
[[support]]
on = "bar.bottom"
fix = ["y"]
[[load]]
name = "pull"
on = "bar.top"
displacement = {{ y = 1.0 }}
[program]
targets = [{}]
"#,
            targets.join(",")
        );
        let results = run(&Scene::parse(&text, "bar").unwrap());
        for (state, exact) in results.states.iter().zip(bar(&strains)) {
            let stress = &state.fields.as_ref().unwrap().stress;
            // Equilibrium is found to 1e-10 of the force; the worst stress is a tenth of the
            // largest.
            assert!(
                (stress[1] - exact).abs() <= 1e-8 * 200.0,
                "{kind} {}: {} {exact}",
                state.name,
                stress[1]
            );
            assert!(stress[0].abs() <= 1e-8 * 200.0);
            let area = if kind == "axisymmetric" {
                std::f64::consts::PI
            } else {
                1.0
            };
            close(state.load.abs(), exact.abs() * area, 1e-7);
        }
    }
}
