//! Rigid surfaces on solids: parts of symmetric bodies, and slices that are plane strain.

use super::rigid_surfaces::{along, ball, block, near, only, same};
use crate::support::run_text;
use brinell::analytical::HertzEllipse;
use brinell::results::Results;

/// A support.
fn held(side: &str, axis: &str) -> String {
    format!("[[support]]\non = \"block.{side}\"\nfix = [\"{axis}\"]\n")
}

/// A quarter of a brick under a sphere, and all of it; a cylinder across a slice is plane strain.
#[test]
fn spheres_and_cylinders_press_on_solids() {
    let solid = |element: &str, [x, y, z]: [[f64; 2]; 3], elements: [usize; 3], lines: &str| {
        format!(
            r#"kind = "solid"
[[mesh.parts]]
body = "block"
element = "{element}"
brick = {{ x = {x:?}, y = {y:?}, z = {z:?}, elements = {elements:?} }}
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies]
block = {{ material = "steel" }}
[[support]]
on = "block.bottom"
fix = ["x", "y", "z"]
[[contact]]
first = "ball"
second = "block.top"
[program]
targets = [{{ load_factor = 1.0 }}]
{lines}
"#
        )
    };
    let push = "[[load]]\non = \"ball\"\nforce = [0.0, 0.0, -8000.0]\n";
    let sphere =
        format!("[rigid.ball]\nsphere = {{ center = [0.0, 0.0, 10.0], radius = 10.0 }}\n{push}");
    for (element, n) in [("hex8", 4), ("hex20", 2)] {
        let (depth, all) = ([-2.0, 0.0], [-2.0, 2.0]);
        let whole_text = solid(element, [all, all, depth], [2 * n, 2 * n, n], &sphere);
        let whole = run_text(&whole_text);
        let symmetric = format!("{sphere}{}{}", held("left", "x"), held("front", "y"));
        let part = [0.0, 2.0];
        let quarter = solid(element, [part, part, depth], [n, n, n], &symmetric);
        let quarter_text = format!("symmetry = 4\n{quarter}");
        let quarter = run_text(&quarter_text);
        near(
            along(&whole_text, only(&whole), [0.0, 0.0, 1.0]),
            8000.0,
            1e-9,
        );
        near(
            4.0 * along(&quarter_text, only(&quarter), [0.0, 0.0, 1.0]),
            8000.0,
            1e-9,
        );
        near(only(&quarter).max_pressure, only(&whole).max_pressure, 1e-8);
        near(only(&quarter).approach, only(&whole).approach, 1e-8);
        let patch = |results: &Results| {
            let patch = &only(results).patches[0];
            [patch.area, patch.force, patch.semi_axes[0]]
        };
        for (part, all) in patch(&quarter).into_iter().zip(patch(&whole)) {
            near(part, all, 1e-6);
        }
        let depth = only(&whole).approach;
        let moved = sphere.replace(
            "force = [0.0, 0.0, -8000.0]",
            &format!("displacement = {{ z = {} }}", -depth),
        );
        let moved = run_text(&solid(
            element,
            [all, all, [-2.0, 0.0]],
            [2 * n, 2 * n, n],
            &moved,
        ));
        same(&moved, &whole, 1e-8);
    }
    let roller = format!(
        "[rigid.ball.cylinder]\ncenter = [0.0, 0.0, 10.0]\naxis = [0.0, 1.0, 0.0]\nradius = 10.0\n\
         {push}{}{}",
        held("front", "y"),
        held("back", "y")
    );
    let slice = [[-4.0, 4.0], [0.0, 1.0], [-4.0, 0.0]];
    let slice = run_text(&solid(
        "hex8",
        slice,
        [16, 1, 8],
        &roller.replace("-8000.0", "-1500.0"),
    ));
    let plane = block("plane_strain", "quad4", 8, &ball("force = [0.0, -1500.0]"));
    let plane = run_text(&plane.replace(", bias = [20.0, 0.05]", ""));
    near(only(&slice).max_pressure, only(&plane).max_pressure, 1e-8);
    near(only(&slice).approach, only(&plane).approach, 1e-8);
}

/// A barrel, a torus about an axis across, on a quarter of a brick: Hertz's ellipse of the two
/// radii, along the axis that of the tube, across it tube and ring together.
///
/// Source: K. L. Johnson, Contact Mechanics (1985), section 4.2. The brick is five half axes large
/// (the approach of half spaces is therefore not asked for), an element 0.16 of the smaller one.
#[test]
fn a_torus_presses_as_the_ellipse_of_hertz() {
    let hertz = HertzEllipse::new([6.0, 12.0], 210e3 / (1.0 - 0.09)).unwrap();
    let load = 2500.0;
    let results = run_text(&format!(
        r#"kind = "solid"
symmetry = 4
[[mesh.parts]]
body = "block"
element = "hex8"
[mesh.parts.brick]
x = [0.0, 2.0]
y = [0.0, 2.0]
z = [-2.0, 0.0]
elements = [13, 13, 13]
bias = [6.0, 6.0, 0.16]
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies]
block = {{ material = "steel" }}
[[support]]
on = "block.bottom"
fix = ["z"]
{}{}
[rigid.barrel]
torus = {{ center = [0.0, 0.0, 12.0], axis = [1.0, 0.0, 0.0], ring_radius = 6.0, radius = 6.0 }}
[[contact]]
first = "barrel"
second = "block.top"
[[load]]
on = "barrel"
force = [0.0, 0.0, -{load}]
[program]
targets = [{{ load_factor = 1.0 }}]
"#,
        held("left", "x"),
        held("front", "y"),
    ));
    let state = only(&results);
    near(state.max_pressure, hertz.max_pressure(load), 0.03);
    let [short, long] = hertz.semi_axes(load);
    assert!(long > 1.4 * short);
    for (found, exact) in state.patches[0].semi_axes.into_iter().zip([long, short]) {
        near(found, exact, 0.05);
    }
    // The longer half axis lies across the axis of the barrel, where its radius is larger.
    near(state.patches[0].direction[1].abs(), 1.0, 1e-6);
    near(state.contact_force, load, 1e-3);
}
