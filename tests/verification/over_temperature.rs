//! Materials at the temperature of a body: what they are there written out gives the same numbers,
//! and a run that goes on at another temperature keeps what flowed.

use crate::support::{load, parse, run};
use crate::verification::close;
use crate::verification::start_from::{run_into, with_targets};
use brinell::scene::{Material, MaterialRow};

fn row(temperature: f64, youngs_modulus: f64, yield_stress: f64) -> MaterialRow {
    MaterialRow {
        temperature,
        youngs_modulus: Some(youngs_modulus),
        yield_stress: Some(yield_stress),
        ..MaterialRow::default()
    }
}

/// One material, two bodies at two temperatures: the contact of two materials.
#[test]
fn bodies_at_two_temperatures_are_of_two_materials() {
    let mut hot = load(
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=6", "reference=[]"],
    );
    let mut written_out = hot.clone();
    let steel = hot.materials.get_mut("steel").unwrap();
    steel.over_temperature = vec![row(20.0, 210_000.0, 240.0), row(420.0, 170_000.0, 160.0)];
    for (name, temperature, modulus, yield_stress) in [
        ("cylinder", 120.0, 200_000.0, 220.0),
        ("half_plane", 320.0, 180_000.0, 180.0),
    ] {
        hot.bodies.get_mut(name).unwrap().temperature = Some(temperature);
        let steel = Material {
            youngs_modulus: modulus,
            yield_stress: Some(yield_stress),
            ..written_out.materials["steel"].clone()
        };
        written_out.bodies.get_mut(name).unwrap().material = name.into();
        written_out.materials.insert(name.into(), steel);
    }
    let [one, other] = [&hot, &written_out].map(run);
    assert_eq!(one.history, other.history);
    assert_eq!(one.counts, other.counts);
    assert_eq!(one.first_yield, other.first_yield);
    let found = one
        .effects
        .iter()
        .find(|e| e.name == "materials over temperature");
    assert!(found.unwrap().on && one.warnings == other.warnings);
    // Beyond the rows: said.
    hot.bodies.get_mut("cylinder").unwrap().temperature = Some(500.0);
    let warned = run(&hot).warnings;
    let words = "bodies.cylinder.temperature: 500 is beyond the rows of steel, 20 to 420";
    assert!(
        warned.iter().any(|text| text.starts_with(words)),
        "{warned:?}"
    );
}

const BAR: &str = r#"
kind = "plane_stress"
support = [{ on = "bar.left", fix = ["x"] }, { on = "bar.bottom", fix = ["y"] }]
load = [{ on = "bar.right", traction = [200.0, 0.0] }]
[[mesh.parts]]
body = "bar"
element = "quad8"
block = { x = [0.0, 2.0], y = [0.0, 1.0], elements = [2, 1] }
[materials.metal]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 150.0
plastic_modulus = 10000.0
[[materials.metal.over_temperature]]
temperature = 20.0
youngs_modulus = 200000.0
yield_stress = 150.0
[[materials.metal.over_temperature]]
temperature = 520.0
youngs_modulus = 100000.0
yield_stress = 100.0
[bodies.bar]
material = "metal"
temperature = 20.0
[program]
targets = [{ load_factor = 1.0 }]
stepping = "steps"
steps = 4
"#;

/// A bar is pulled cold, let go, and pulled again warm: `e = s/E(T) + (s - Y(T))/H`, its plastic
/// part never less than what the cold bar kept.
#[test]
fn a_bar_goes_on_at_another_temperature() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("cold");
    let cold = parse(BAR);
    run_into(&with_targets(&cold, &[1.0, 0.0], None), &dir);
    let kept: f64 = (200.0 - 150.0) / 10_000.0;
    for (temperature, modulus, yield_stress) in
        [(270.0, 150_000.0, 125.0), (20.0, 200_000.0, 150.0)]
    {
        let mut warm = with_targets(&cold, &[0.5, 1.0, 0.0], Some(&dir));
        warm.bodies.get_mut("bar").unwrap().temperature = Some(temperature);
        let results = run(&warm);
        let by_state = [100.0, 200.0, 0.0].map(|stress| {
            let plastic = if stress == 100.0 {
                kept
            } else {
                kept.max((200.0 - yield_stress) / 10_000.0)
            };
            (stress / modulus, plastic)
        });
        for (state, (elastic, plastic)) in results.states.iter().zip(by_state) {
            close(state.max_equivalent_plastic_strain, plastic, 1e-8);
            let u = &state.fields.as_ref().unwrap().displacement;
            let longest = u.chunks(2).fold(0.0, |m: f64, u| m.max(u[0]));
            close(longest, 2.0 * (elastic + plastic), 1e-8);
        }
    }
}
