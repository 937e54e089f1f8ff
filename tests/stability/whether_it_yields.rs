//! Whether a body yields, on meshes that nobody chose for it.
//!
//! The load at first yield is that of a stress recovered between the points of several elements.
//! Codes that ask nothing else call a body elastic whose elements are beyond yield: bodies one
//! element thick, planes taken for planes of symmetry, coarse meshes. Passing means that no state
//! is elastic while a Gauss point is beyond its yield stress, and that it does not matter how a
//! support is written.

use crate::support::msh::{Body, Msh};
use crate::support::random::Random;
use crate::support::{close, either, parse, run_text, try_run};
use brinell::linalg::Backend;
use brinell::results::Results;
use std::fmt::Write;
use std::path::Path;

/// Yield stress of all models.
const YIELD: f64 = 200.0;

/// A block sheared between a base and a top that hold it in planes: the middle is in simple shear,
/// whose von Mises stress is `sqrt(3) G` times the angle.
#[test]
fn planes_that_are_held_along_themselves_too_are_no_mirrors() {
    let angle = 0.002;
    let exact = YIELD / (3f64.sqrt() * 200e3 / 2.6 * angle);
    let plane = r#"kind = "plane_strain"
mesh.parts = [{ body = "b", block = { x = [0, 10], y = [0, 1], elements = [10, 2] } }]
support = [{ on = "b.bottom", fix = ["x", "y"] }, { on = "b.top", fix = ["y"] }]
"#;
    let solid = |[m, n]: [usize; 2]| {
        format!(
            r#"kind = "solid"
mesh.parts = [{{ body = "b", brick = {{ x = [0, 10], y = [0, 1], z = [0, 1],
               elements = [10, {m}, {n}] }} }}]
support = [{{ on = "b.bottom", fix = ["x", "z"] }}, {{ on = "b.top", fix = ["z"] }},
           {{ on = "b.front", fix = ["y"] }}, {{ on = "b.back", fix = ["y"] }}]
"#
        )
    };
    let models = [
        plane.to_string(),
        solid([2, 1]),
        solid([1, 2]),
        solid([2, 2]),
        solid([1, 3]),
    ];
    for model in models {
        let text = format!(
            r#"{model}
materials.m.youngs_modulus = 200e3
materials.m.poissons_ratio = 0.3
materials.m.yield_stress = {YIELD}
materials.m.plastic_modulus = 2000
bodies.b.material = "m"
load = [{{ on = "b.top", displacement = {{ x = {angle} }} }}]
program.targets = [{{ load_factor = 1.0 }}]
"#
        );
        let results = run_text(&text);
        let first = results.first_yield.expect("it yields");
        // The middle is in simple shear but for what the free ends, ten heights away, leave there;
        // beside them, where the base is held, the stress is higher, and grows with the mesh.
        assert!(
            first.alpha < exact * (1.0 + 1e-6),
            "{}\n{text}",
            first.alpha / exact
        );
        assert!(results.states[0].plastic_points > 0, "{text}");
    }
}

/// A cantilever one element wide yields where that of two does, and bends as far beyond its plastic
/// moment.
#[test]
fn a_beam_one_element_wide_is_that_of_two() {
    let of_width = |n: usize, load: f64| {
        run_text(&format!(
            r#"kind = "solid"
mesh.parts = [{{ body = "b", element = "hex8", brick = {{ x = [0, 10], y = [0, 1], z = [0, 1],
               elements = [40, {n}, 6] }} }}]
materials.m.youngs_modulus = 200e3
materials.m.poissons_ratio = 0.3
materials.m.yield_stress = {YIELD}
materials.m.plastic_modulus = 2000
bodies.b.material = "m"
support = [{{ on = "b.left", fix = ["x", "y", "z"] }}]
load = [{{ on = "b.right", traction = [0.0, 0.0, {load}] }}]
program.targets = [{{ load_factor = 1.0 }}]
"#
        ))
    };
    let [one, two] = [1, 2].map(|n| of_width(n, 7.0));
    let alphas = [&one, &two].map(|results| results.first_yield.unwrap().alpha);
    // Two unlike meshes across a clamped end, where stresses grow with the mesh.
    close("first yield", alphas[0], alphas[1], alphas[1], 0.05);
    assert!((0.45..0.6).contains(&alphas[0]), "{alphas:?}");
    let bent = [&one, &two].map(|results| results.states[0].max_equivalent_plastic_strain);
    close("plastic strain", bent[0], bent[1], bent[1], 0.2);
}

/// Strips one element high under bending moments about their plastic moment `Y b h^2/4`: the Gauss
/// points tell.
#[test]
fn a_strip_one_element_high_yields() {
    for element in ["quad4", "quad8"] {
        for height in [1, 2] {
            let text = format!(
                r#"kind = "plane_stress"
mesh.parts = [{{ body = "b", element = "{element}", block = {{ x = [0, 10], y = [0, 1],
               elements = [40, {height}] }} }}]
materials.m.youngs_modulus = 200e3
materials.m.poissons_ratio = 0.3
materials.m.yield_stress = {YIELD}
materials.m.plastic_modulus = 2000
bodies.b.material = "m"
support = [{{ on = "b.left", fix = ["x", "y"] }}]
load = [{{ on = "b.right", traction = [0.0, 7.0] }}]
program.targets = [{{ load_factor = 1.0 }}]
"#
            );
            let results = run_text(&text);
            // Moment 70 at the end that is held, 33 at first yield, 50 fully plastic.
            assert!(results.states[0].plastic_points > 0, "{text}");
            let alpha = results.first_yield.unwrap().alpha;
            // Linear elements alone across a bent strip are too stiff, and so carry less stress.
            assert!((0.35..1.0).contains(&alpha), "{element} {height}: {alpha}");
        }
    }
}

/// Plates one element thick, bent in cylinders: `M = Y h^2/(6 sqrt(1 - nu + nu^2))` per width at
/// first yield in plane strain, 1.5 times as much and more when fully plastic.
#[test]
fn a_plate_one_element_thick_yields() {
    let (force, thickness) = (5.5, 0.5f64);
    for element in ["hex8", "hex20"] {
        for cells in [[24, 1, 1], [24, 3, 1], [24, 1, 2]] {
            let text = format!(
                r#"kind = "solid"
mesh.parts = [{{ body = "b", element = "{element}", brick = {{ x = [0, 10], y = [0, 2],
               z = [0, {thickness}], elements = {cells:?} }} }}]
materials.m.youngs_modulus = 200e3
materials.m.poissons_ratio = 0.3
materials.m.yield_stress = {YIELD}
materials.m.plastic_modulus = 2000
bodies.b.material = "m"
support = [{{ on = "b.left", fix = ["x", "y", "z"] }}, {{ on = "b.front", fix = ["y"] }},
           {{ on = "b.back", fix = ["y"] }}]
load = [{{ on = "b.right", traction = [0.0, 0.0, {force}] }}]
program.targets = [{{ load_factor = 1.0 }}]
"#
            );
            let results = run_text(&text);
            let alpha = results.first_yield.expect("it yields").alpha;
            let moment = YIELD * thickness.powi(2) / 6.0 / (1.0f64 - 0.3 + 0.09).sqrt();
            let exact = moment / (force * thickness * 10.0);
            assert!(results.states[0].plastic_points > 0, "{text}");
            // In the middle of two layers is half of the stress at the surface; the clamped edge
            // has more than the plate.
            let share = alpha / exact;
            assert!((0.5..2.0).contains(&share), "{element} {cells:?}: {share}");
        }
    }
}

/// What holds a model: sets with the axes along which they do not move.
type Held = &'static [(&'static str, &'static [&'static str])];

const PLANE: [Held; 4] = [
    &[("b.left", &["x", "y"])],
    &[("b.left", &["x"]), ("b.bottom", &["y"])],
    &[("b.bottom", &["y"]), ("b.bottom_left", &["x"])],
    &[("b.left", &["x", "y"]), ("b.right", &["y"])],
];
const AXISYMMETRIC: [Held; 3] = [
    &[("b.bottom", &["y"])],
    &[("b.bottom", &["x", "y"])],
    &[("b.left", &["x"]), ("b.bottom", &["y"])],
];
const SOLID: [Held; 4] = [
    &[("b.left", &["x", "y", "z"])],
    &[
        ("b.left", &["x"]),
        ("b.bottom", &["z"]),
        ("b.front", &["y"]),
    ],
    &[("b.left", &["x", "z"]), ("b.front", &["y"])],
    &[
        ("b.bottom", &["x", "z"]),
        ("b.front", &["y"]),
        ("b.back", &["y"]),
    ],
];

/// Drawn from a plane mesh: up is along y.
const DRAWN: [Held; 3] = [
    &[("b.left", &["x", "y", "z"])],
    &[
        ("b.left", &["x"]),
        ("b.bottom", &["y"]),
        ("b.front", &["z"]),
    ],
    &[("b.left", &["x", "y"]), ("b.front", &["z"])],
];
/// Of a mesh of tetrahedra.
const TETRAHEDRA: [Held; 2] = [
    &[("b bottom", &["x", "y", "z"])],
    &[
        ("b axis 0", &["x"]),
        ("b axis 1", &["y"]),
        ("b bottom", &["z"]),
    ],
];

/// The mesh of a block, what holds it, and the faces that loads act on.
fn mesh(random: &mut Random, kind: &str, file: &Path) -> (String, Held, [&'static str; 2]) {
    let mut cells = || 1 + random.below(6);
    let (m, n, k) = (cells(), cells(), 1 + cells() / 2);
    // On the axis of revolution nothing moves outward, and so cannot be told to.
    let x = random.one_of(&[0.0, 1.0]);
    let x = if kind == "axisymmetric" { 1.0 } else { x };
    let end = x + random.one_of(&[1.0, 2.0, 8.0]);
    let faces = ["b.right", "b.top"];
    // Another block that is tied to the first one's top, on a mesh of its own.
    let tied = random.share() < 0.25;
    let parts = |element: &str, shape: &str, [from, to]: [&str; 2], k: &str| {
        let part = |body: &str, up: [f64; 2], n: usize| {
            format!(
                "{{ body = \"{body}\", element = \"{element}\", {shape} = {{ x = [{x}, {end}], \
                 {from}{up:?}{to}, elements = [{}, {n}{k}] }} }}",
                if body == "b" { m } else { m + 1 }
            )
        };
        let tie =
            "\ntie = [{ first = \"c.bottom\", second = \"b.top\" }]\nbodies.c.material = \"m\"";
        match tied {
            true => {
                let parts = [part("b", [0.0, 1.0], n), part("c", [1.0, 1.5], 1 + n / 2)];
                format!("mesh.parts = [{}]{tie}", parts.join(", "))
            }
            false => format!("mesh.parts = [{}]", part("b", [0.0, 1.0], n)),
        }
    };
    let faces = if tied { ["b.right", "c.top"] } else { faces };
    if kind != "solid" {
        let element = random.one_of(&["quad4", "quad8", "tri3", "tri6"]);
        let held = match kind {
            "axisymmetric" => random.one_of(&AXISYMMETRIC),
            _ => random.one_of(&PLANE),
        };
        let mut text = parts(element, "block", ["y = ", ""], "");
        // The right end stays plane, where its corner is not held.
        let held_there = held
            .iter()
            .any(|(on, fix)| *on == "b.bottom" && fix.contains(&"x"));
        if random.share() < 0.3 && !held_there {
            text += "\n[[equation]]\nterms = [";
            text += "{ on = \"b.right\", direction = \"x\", coefficient = 1 },";
            text += "{ on = \"b.bottom_right\", direction = \"x\", coefficient = -1 }]";
        }
        return (text, held, faces);
    }
    match random.below(3) {
        0 => {
            let element = random.one_of(&["hex8", "hex20"]);
            let text = parts(element, "brick", ["y = [0, 1], z = ", ""], "");
            let text = text.replace(", elements = [", &format!(", elements = [{k}, "));
            (text, random.one_of(&SOLID), faces)
        }
        1 => {
            let element = random.one_of(&["quad4", "tri3", "tri6"]);
            let text = parts(element, "block", ["y = ", ""], "");
            let drawn = format!("\nmesh.extrude = {{ depth = 1.0, elements = {k} }}");
            (text + &drawn, random.one_of(&DRAWN), faces)
        }
        _ => {
            let mut msh = Msh::default();
            let body = Body {
                name: "b",
                from: 0.0,
                width: random.one_of(&[0.3, 1.0, 3.0]),
                cells: [1 + m / 3, 1 + n / 2],
                heights: [&|_| 0.0, &|_| 1.0],
                kink: None,
                grading: 1.0,
                jitter: random.one_of(&[0.0, 0.5]),
            };
            body.solid(&mut msh, true, 1 + random.below(2), random);
            std::fs::write(file, msh.text()).unwrap();
            let text = format!("mesh.file = {file:?}");
            (text, random.one_of(&TETRAHEDRA), ["b top", "b top"])
        }
    }
}

/// A block of any kind under any load, but for its supports; `file` takes its mesh.
fn block(random: &mut Random, file: &Path) -> (String, Held) {
    let kind = random.one_of(&["plane_stress", "plane_strain", "axisymmetric", "solid"]);
    let (mesh, held, faces) = mesh(random, kind, file);
    let mut text = format!(
        "kind = \"{kind}\"\n{mesh}\n\
         [materials.m]\nyoungs_modulus = 200e3\npoissons_ratio = 0.3\nyield_stress = {YIELD}\n\
         plastic_modulus = 20e3\nthermal_expansion = 1e-5\n[bodies.b]\nmaterial = \"m\"\n"
    );
    let mut loads = Vec::new();
    let force = |random: &mut Random, axes: usize| {
        let parts = (0..axes).map(|_| format!("{:.6}", random.within(-150.0, 150.0)));
        format!("[{}]", parts.collect::<Vec<_>>().join(", "))
    };
    let axes = if kind == "solid" { 3 } else { 2 };
    for on in faces {
        if random.share() < 0.7 {
            let traction = force(random, axes);
            loads.push(format!("{{ on = \"{on}\", traction = {traction} }}"));
        }
    }
    if random.share() < 0.3 || loads.is_empty() {
        let change = random.within(-60.0, 60.0);
        let field = match kind {
            "axisymmetric" => "(1 + r - z)",
            _ => "(1 + x - y)",
        };
        loads.push(format!(
            "{{ on = \"b\", temperature = \"{change:.4} * {field}\" }}"
        ));
    }
    if random.share() < 0.2 {
        let stress = random.within(-80.0, 80.0);
        let _ = writeln!(text, "initial_stress = [[0.0, {stress:.4}, 0.0, 0.0]]");
    }
    let _ = writeln!(
        text,
        "[program]\ntargets = [{{ load_factor = 0.5, fields = true }}, \
         {{ load_factor = 1.0, fields = true }}]"
    );
    let text = format!("load = [{}]\n{text}", loads.join(", "));
    (text, held)
}

/// Supports, or displacements of zero.
fn with_supports(text: &str, held: Held, as_displacements: bool) -> String {
    if !as_displacements {
        let entries = held
            .iter()
            .map(|(on, fix)| format!("{{ on = \"{on}\", fix = {fix:?} }}"));
        let entries = entries.collect::<Vec<_>>().join(", ");
        return format!("support = [{entries}]\n{text}");
    }
    let entries = held.iter().map(|(on, fix)| {
        let axes = fix.iter().map(|axis| format!("{axis} = 0.0"));
        let axes = axes.collect::<Vec<_>>().join(", ");
        format!("{{ on = \"{on}\", displacement = {{ {axes} }} }}, ")
    });
    text.replace(
        "load = [",
        &format!("load = [{}", entries.collect::<String>()),
    )
}

#[test]
fn no_state_is_elastic_while_a_gauss_point_is_beyond_yield() {
    let (mut yielded, mut elastic, mut refused) = (0, 0, 0);
    let folder = tempfile::tempdir().unwrap();
    let seeds = either(100, 300);
    for seed in 1..=seeds {
        let mut random = Random::new(seed);
        let file = folder.path().join(format!("{seed}.msh"));
        let (text, held) = block(&mut random, &file);
        let both = [false, true].map(|as_displacements| {
            let text = with_supports(&text, held, as_displacements);
            (try_run(&parse(&text), Backend::default()), text)
        });
        let [(one, text), (other, _)] = both;
        let (one, other) = match (one, other) {
            (Ok(one), Ok(other)) => (one, other),
            // Beyond the limit load, in both.
            (Err(one), Err(other)) => {
                assert_eq!(one.kind(), other.kind(), "{seed}: {one}\n{other}\n{text}");
                refused += 1;
                continue;
            }
            (one, other) => panic!("{seed}: {:?} {:?}\n{text}", one.err(), other.err()),
        };
        let alpha = |results: &Results| results.first_yield.as_ref().map(|first| first.alpha);
        match (alpha(&one), alpha(&other)) {
            (Some(a), Some(b)) => close(&format!("{seed}\n{text}"), a, b, b, 1e-10),
            (a, b) => assert_eq!(a, b, "{seed}\n{text}"),
        }
        for state in one.states.iter().chain(&other.states) {
            let fields = state.fields.as_ref().unwrap();
            let largest = fields.von_mises.iter().fold(0.0f64, |m, v| m.max(*v));
            if state.plastic_points > 0 {
                yielded += 1;
            } else {
                elastic += 1;
                assert!(
                    largest <= YIELD * (1.0 + 1e-7),
                    "{seed}, {}: {largest}\n{text}",
                    state.name
                );
            }
        }
    }
    assert!(
        yielded > 2 * seeds / 3 && elastic > 2 * seeds / 3 && refused < seeds / 5,
        "{yielded} {elastic} {refused}"
    );
}
