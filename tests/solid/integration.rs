//! Full integration: what holds elements by themselves, and how stiff it is.

use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::scene::Scene;
use brinell::{ErrorKind, Result};

/// A bar of one element across, clamped and pressed sideways at its end.
fn bar(integration: &str) -> Result<f64> {
    let text = format!(
        r#"
        kind = "solid"
        mesh.parts = [{{ body = "b", element = "hex20",
            brick = {{ x = [0, 10], y = [0, 1], z = [0, 1], elements = [5, 1, 1] }} }}]
        materials.m = {{ youngs_modulus = 2e5, poissons_ratio = 0.0 }}
        bodies.b = {{ material = "m", integration = "{integration}" }}
        support = [{{ on = "b.left", fix = ["x", "y", "z"] }}]
        load = [{{ on = "b.right", traction = [0.0, 0.0, 1.0] }}]
        program.targets = [{{ load_factor = 1.0, fields = true }}]
        "#
    );
    let scene = Scene::parse(&text, "bar")?;
    let model = Model::new(&scene)?;
    let mesh = model.mesh.clone();
    let results = Analysis::new(model, Backend::Dense)?.run(&mut Silent)?;
    let u = &results.states[0].fields.as_ref().unwrap().displacement;
    let end = (0..mesh.n_nodes()).filter(|&node| mesh.point(node)[0] == 10.0);
    Ok(end.map(|node| u[3 * node + 2]).fold(0.0, f64::max))
}

/// Reduced points hold nothing of the modes that they do not see. The deflection is Timoshenko's,
/// `F L^3 / (3 E I) + 6/5 F L / (G A)`.
#[test]
fn a_bar_of_one_element_is_held_by_full_integration() {
    let refused = bar("reduced").unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::Unheld);
    let text = refused.to_string();
    assert!(text.contains("`integration = \"full\"`"), "{text}");
    let (force, length, modulus) = (1.0, 10.0f64, 2e5);
    let bending = force * length.powi(3) / (3.0 * modulus / 12.0);
    let shear = 1.2 * force * length / (0.5 * modulus);
    let ratio = bar("full").unwrap() / (bending + shear);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}
