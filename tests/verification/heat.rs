//! Loads by temperature: free expansion, a clamped bar that yields, fits by heat, a disc with a
//! radial temperature.
//!
//! Source: S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed. (1970), section 150.

use crate::support::{load, parse, run, run_file, run_text, yield_load};
use crate::verification::close;
use brinell::model::Model;
use brinell::results::Results;
use brinell::scene::{Field, Scene};

const E: f64 = 200000.0;
const EXPANSION: f64 = 1.2e-5;

/// A block, heated by `temperature`, with supports.
fn block(kind: &str, element: &str, temperature: &str, supports: &str, targets: &str) -> Scene {
    let part = match kind {
        "solid" => {
            "brick = { x = [1.0, 3.0], y = [0.0, 1.0], z = [0.0, 1.0], elements = [2, 1, 2] }"
        }
        _ => "block = { x = [1.0, 3.0], y = [0.0, 1.0], elements = [3, 2] }",
    };
    let text = format!(
        r#"
kind = "{kind}"
support = [{supports}]
[[mesh.parts]]
body = "bar"
element = "{element}"
{part}
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
thermal_expansion = {EXPANSION:?}
yield_stress = 200.0
plastic_modulus = 20000.0
[bodies.bar]
material = "metal"
[[load]]
on = "bar"
temperature = {temperature}
[program]
targets = [{targets}]
"#
    );
    parse(&text)
}

const SIDES: &str = r#"{ on = "bar.left", fix = ["x"] }, { on = "bar.bottom", fix = ["y"] }"#;
const FACES: &str = r#"{ on = "bar.left", fix = ["x"] }, { on = "bar.front", fix = ["y"] },
    { on = "bar.bottom", fix = ["z"] }"#;
const CORNERS: &str =
    r#"{ on = "bar.bottom_left", fix = ["x", "y"] }, { on = "bar.bottom_right", fix = ["y"] }"#;

fn largest_stress(results: &Results, state: usize) -> f64 {
    let stress = &results.states[state].fields.as_ref().unwrap().stress;
    stress.iter().fold(0.0, |m, s| m.max(s.abs()))
}

/// Where nothing holds a body it expands without stress; quadratic elements by a temperature that
/// is linear in the position too, which bends the sides.
#[test]
fn what_expands_freely_has_no_stress() {
    let linear = "\"20 + 30*x - 10*y\"";
    for (kind, element, temperature, supports) in [
        ("plane_stress", "quad4", "50.0", SIDES),
        ("plane_stress", "tri3", "50.0", SIDES),
        ("plane_stress", "quad8", linear, CORNERS),
        ("plane_stress", "tri6", linear, CORNERS),
        ("solid", "hex8", "50.0", FACES),
        ("solid", "hex20", "50.0", FACES),
    ] {
        let targets = "{ load_factor = 1.0 }, { load_factor = 0.5 }";
        let results = run(&block(kind, element, temperature, supports, targets));
        for state in 0..2 {
            let stress = largest_stress(&results, state);
            // Round-off of stresses that cancel.
            assert!(
                stress < 1e-10 * E * EXPANSION * 100.0,
                "{kind} {element} {stress:e}"
            );
        }
        assert_eq!(results.states[0].plastic_points, 0);
    }
}

/// In plane strain the thickness is held: `sigma_zz = -E alpha dT`.
#[test]
fn a_free_section_of_plane_strain_is_pressed_across() {
    for element in ["quad4", "quad8"] {
        let results = run(&block(
            "plane_strain",
            element,
            "50.0",
            SIDES,
            "{ load_factor = 1.0 }",
        ));
        let stress = &results.states[0].fields.as_ref().unwrap().stress;
        for s in stress.chunks(4) {
            close(s[2], -E * EXPANSION * 50.0, 1e-10);
            assert!(s[0].abs() + s[1].abs() + s[3].abs() < 1e-10 * s[2].abs());
        }
    }
}

/// A bar between two walls that is heated beyond yield, cooled, and heated again: uniaxial stress
/// at the mechanical strain `-alpha dT`, with isotropic hardening.
#[test]
fn a_clamped_bar_yields_by_heat() {
    let (y, h) = (200.0, 20000.0);
    let path = [50.0, 250.0, 0.0, 300.0];
    let (mut plastic, mut hardened) = (0.0, 0.0);
    let exact = path.map(|change| {
        let strain = -EXPANSION * change;
        let trial: f64 = E * (strain - plastic);
        let beyond = (trial.abs() - y - h * hardened).max(0.0) / (E + h);
        plastic += beyond * trial.signum();
        hardened += beyond;
        E * (strain - plastic)
    });
    let targets: Vec<String> = path
        .iter()
        .map(|f| format!("{{ load_factor = {f:?} }}"))
        .collect();
    let ends = r#", { on = "bar.right", fix = ["x"] }"#;
    for (kind, element, supports) in [
        ("plane_stress", "quad4", SIDES),
        ("plane_stress", "quad8", SIDES),
        ("solid", "hex8", FACES),
        ("solid", "hex20", FACES),
    ] {
        let supports = format!("{supports}{ends}");
        let results = run(&block(kind, element, "1.0", &supports, &targets.join(", ")));
        for (state, exact) in results.states.iter().zip(exact) {
            let stress = state.fields.as_ref().unwrap().stress[0];
            // Equilibrium is found to 1e-10 of the forces.
            assert!(
                (stress - exact).abs() < 1e-7 * y,
                "{kind} {element}: {stress} {exact}"
            );
        }
    }
}

/// A shaft that is heated in its ring until it fits, and beyond: what an interference of
/// `alpha dT a` less the gap does. The elements expand exactly, so both differ by round-off.
#[test]
fn a_fit_by_heat_is_a_fit_by_interference() {
    let (gap, change, radius) = (0.01, 100.0, 50.0);
    let fitted = EXPANSION * change * radius - gap;
    let by_interference = run_file("shrink_fit", &[&format!("contact.0.interference={fitted}")]);
    let mut heated = load(
        "shrink_fit",
        &[
            "contact.0.interference=0.0",
            &format!("contact.0.gap={gap}"),
            &format!("materials.steel.thermal_expansion={EXPANSION}"),
            &format!("load=[{{ on = \"shaft\", temperature = {change:?} }}]"),
            "program.targets=[{ load_factor = 0.5 }, { load_factor = 1.0 }]",
        ],
    );
    heated.reference.clear();
    let by_heat = run(&heated);
    let closes = gap / (EXPANSION * change * radius);
    let rows = by_heat.history.iter();
    let mut closing = rows.filter(|row| (row.alpha - closes).abs() < 1e-9);
    assert!(closing.next().is_some());
    close(
        by_heat.states[1].max_pressure,
        by_interference.states[0].max_pressure,
        1e-9,
    );
}

const INNER: f64 = 20.0;
const OUTER: f64 = 60.0;

/// A thin disc with a hole that is hotter inside, `dT = log(b/r)`: the first yield is at the bore,
/// where `sigma_t = alpha E (2/(b^2 - a^2) int_a^b T r dr - T(a))`.
#[test]
fn a_disc_with_a_radial_temperature_yields_first_at_its_bore() {
    let (a, b) = (INNER, OUTER);
    // int_a^b log(b/r) r dr
    let integral = 0.25 * (b * b - a * a) - 0.5 * a * a * (b / a).ln();
    let hoop = EXPANSION * E * (2.0 / (b * b - a * a) * integral - (b / a).ln());
    let exact = 200.0 / hoop.abs();
    let errors = [4, 8, 16].map(|n| {
        let text = format!(
            r#"
kind = "plane_stress"
support = [{{ on = "disc.start", fix = ["y"] }}, {{ on = "disc.end", fix = ["x"] }}]
[[mesh.parts]]
body = "disc"
element = "quad8"
[mesh.parts.ring]
radius = [{a:?}, {b:?}]
elements = [{n}, {n}]
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
thermal_expansion = {EXPANSION:?}
yield_stress = 200.0
[bodies.disc]
material = "metal"
[[load]]
on = "disc"
temperature = "log({b:?}/r)"
[program]
targets = [{{ yield = true }}]
"#
        );
        let found = yield_load(&parse(&text));
        (found.first_yield.unwrap().alpha / exact - 1.0).abs()
    });
    // A halved element has a quarter of the error; a third where the next order still counts.
    assert!(
        errors[1] < errors[0] / 3.0 && errors[2] < errors[1] / 3.0,
        "{errors:?}"
    );
    assert!(errors[2] < 3e-3, "{errors:?}");
}

/// What cannot be is named, before anything is computed.
#[test]
fn temperatures_that_cannot_be_are_named() {
    let scene = block(
        "plane_stress",
        "quad4",
        "50.0",
        SIDES,
        "{ load_factor = 1.0 }",
    );
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut changed = scene.clone();
        change(&mut changed);
        Model::new(&changed).unwrap_err().to_string()
    };
    let formula = |text: &str| Some(Field::Formula(text.into()));
    let error = refused(&|s| s.load[0].temperature = formula("log(x - 2)"));
    assert!(
        error.contains("the temperature at node") && error.contains("NaN"),
        "{error}"
    );
    let error = refused(&|s| s.load[0].temperature = formula("t + 1"));
    assert!(error.contains("unknown name `t`"), "{error}");
    let error = refused(&|s| s.materials.get_mut("metal").unwrap().thermal_expansion = None);
    assert!(
        error.contains("materials.metal.thermal_expansion"),
        "{error}"
    );
}

/// A strip of two metals bends by heat: with `m` the ratio of the thicknesses and `n` that of the
/// moduli the curvature is `6 (a2 - a1) dT (1 + m)^2/(h (3 (1 + m)^2 + (1 + m n)(m^2 + 1/(m n))))`
/// (S. Timoshenko, J. Opt. Soc. Am. 11 (1925) 233). Plane stress and no thickness to speak of.
#[test]
fn a_strip_of_two_metals_bends() {
    let (length, [lower, upper]) = (40.0, [0.6f64, 0.4]);
    let (moduli, expansions, change) = ([200_000.0, 100_000.0], [1e-5, 2e-5], 100.0);
    let text = format!(
        r#"
kind = "plane_stress"
[[mesh.parts]]
body = "lower"
element = "quad8"
block = {{ x = [0.0, {length:?}], y = [0.0, {lower:?}], elements = [40, 2] }}
[[mesh.parts]]
body = "upper"
element = "quad8"
block = {{ x = [0.0, {length:?}], y = [{lower:?}, 1.0], elements = [40, 2] }}
[materials.lower]
youngs_modulus = {:?}
poissons_ratio = 0.3
thermal_expansion = {:?}
[materials.upper]
youngs_modulus = {:?}
poissons_ratio = 0.3
thermal_expansion = {:?}
[bodies.lower]
material = "lower"
[bodies.upper]
material = "upper"
[[tie]]
first = "lower.top"
second = "upper.bottom"
[[support]]
on = "lower.left"
fix = ["x"]
[[support]]
on = "upper.left"
fix = ["x"]
[[support]]
on = "lower.bottom_left"
fix = ["y"]
[[load]]
on = "lower"
temperature = {change:?}
[[load]]
on = "upper"
temperature = {change:?}
[program]
targets = [{{ load_factor = 1.0 }}]
"#,
        moduli[0], expansions[0], moduli[1], expansions[1]
    );
    let scene = parse(&text);
    let mesh = Model::new(&scene).unwrap().continuum.mesh;
    let results = run(&scene);
    let u = &results.states[0].fields.as_ref().unwrap().displacement;
    // Deflections of the lowest fibre in the middle of the strip, free of what goes on at the end.
    let at = |x: f64| {
        let node = (0..mesh.n_nodes()).find(|&n| {
            let place = mesh.point(n);
            (place[0] - x).abs() < 1e-9 && place[1].abs() < 1e-9
        });
        u[2 * node.unwrap() + 1]
    };
    let curvature = -(at(10.0) - 2.0 * at(20.0) + at(30.0)) / 100.0;
    let (m, n) = (lower / upper, moduli[0] / moduli[1]);
    let stiffness = 3.0 * (1.0 + m).powi(2) + (1.0 + m * n) * (m * m + 1.0 / (m * n));
    let bending = 6.0 * (expansions[1] - expansions[0]) * change * (1.0 + m).powi(2);
    close(curvature, bending / stiffness, 1e-4);
}

/// A bar that is heated until it closes its gap to a wall, and beyond: no force before, then
/// `E (alpha dT - gap/length)`.
#[test]
fn a_heated_bar_closes_its_gap() {
    let (length, gap, change) = (10.0, 0.012, 200.0);
    let text = format!(
        r#"
kind = "plane_stress"
[[mesh.parts]]
body = "bar"
block = {{ x = [0.0, 1.0], y = [0.0, {length:?}], elements = [2, 4] }}
[[mesh.parts]]
body = "wall"
block = {{ x = [0.0, 1.0], y = [{:?}, {:?}], elements = [2, 1] }}
[materials.steel]
youngs_modulus = {E:?}
poissons_ratio = 0.0
thermal_expansion = {EXPANSION:?}
[materials.rigid]
youngs_modulus = {:?}
poissons_ratio = 0.0
[bodies.bar]
material = "steel"
[bodies.wall]
material = "rigid"
[[contact]]
first = "bar.top"
second = "wall.bottom"
[[support]]
on = "bar.bottom"
fix = ["y"]
[[support]]
on = "bar.left"
fix = ["x"]
[[support]]
on = "wall.top"
fix = ["x", "y"]
[[load]]
on = "bar"
temperature = {change:?}
[program]
targets = [{{ load_factor = 0.4 }}, {{ load_factor = 1.0 }}]
"#,
        length + gap,
        length + gap + 1.0,
        1e12 * E
    );
    let results = run_text(&text);
    let closes = gap / (EXPANSION * change * length);
    assert!(closes > 0.4, "{closes}");
    assert_eq!(results.states[0].max_pressure, 0.0);
    let mut rows = results.history.iter();
    assert!(
        rows.any(|row| (row.alpha - closes).abs() < 1e-9),
        "{closes}"
    );
    let pressed = E * (EXPANSION * change - gap / length);
    close(results.states[1].max_pressure, pressed, 1e-9);
}

/// Temperatures from a file do what the formula does that the file was made with; a file of another
/// mesh is told by its nodes.
#[test]
fn temperatures_of_nodes_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("heat.msh");
    let of = |temperature: &str| {
        let targets = "{ load_factor = 1.0 }";
        block("plane_stress", "quad8", temperature, SIDES, targets)
    };
    let by_formula = of("\"150 + 40*x - 30*y\"");
    let mesh = Model::new(&by_formula).unwrap().continuum.mesh;
    let write = |nodes: &[usize]| {
        let mut text = format!("$NodeData\n1\n\"T\"\n1\n0.0\n3\n0\n1\n{}\n", nodes.len());
        for &node in nodes {
            let [x, y, _] = mesh.point(node);
            let value = 150.0 + 40.0 * x - 30.0 * y;
            text += &format!("{} {value:?}\n", mesh.node_label(node));
        }
        std::fs::write(&path, text + "$EndNodeData\n").unwrap();
    };
    let mut all: Vec<usize> = (0..mesh.n_nodes()).rev().collect();
    write(&all);
    let by_file = of(&format!("{{ file = {path:?} }}"));
    let [formula, file] = [&by_formula, &by_file].map(run);
    let [formula, file] = [&formula, &file].map(|r| r.states[0].fields.as_ref().unwrap());
    let largest = formula.stress.iter().fold(0.0f64, |m, s| m.max(s.abs()));
    for (a, b) in formula.stress.iter().zip(&file.stress) {
        // The same values, but for the last digit of the formula's.
        assert!(
            (a - b).abs() <= 1e-12 * largest.max(E * EXPANSION),
            "{a} {b}"
        );
    }
    let refused = |why: &str| {
        let error = Model::new(&by_file).unwrap_err();
        assert!(error.message().contains(why), "{error}");
    };
    let text = std::fs::read_to_string(&path).unwrap();
    for value in ["NaN", "inf"] {
        let (first, rest) = text.split_once("\n5 ").unwrap();
        let (_, rest) = rest.split_once('\n').unwrap();
        std::fs::write(&path, format!("{first}\n5 {value}\n{rest}")).unwrap();
        refused("node 5");
    }
    all.pop();
    write(&all);
    refused("no value of node 1 at");
}
