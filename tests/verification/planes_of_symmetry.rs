//! A plane of symmetry is a whole plane of both bodies that is held across and free along, never a
//! node: what is read off a contact is the same whichever nodes keep the bodies in place.

use crate::support::random::Random;
use crate::support::{close, either, parse, run, run_on};
use brinell::model::Model;
use brinell::results::State;
use brinell::scene::Scene;

/// A soft block of half width `w` on a hard one of the same mesh, turned by `angle` degrees and
/// pressed evenly; `supports` name the sets `upp.left`, `low.left`, `upp.p` (the left end of the
/// contact) and `upp.q` (a node of the left side above it), and a direction across the left side.
fn pressed(random: &mut Random, angle: f64, supports: &str) -> (f64, State) {
    let (w, n) = (random.within(1.0, 3.0), 3 + random.below(4));
    let kind = random.one_of(&["plane_strain", "plane_stress"]);
    let (sine, cosine) = angle.to_radians().sin_cos();
    let element = random.one_of(&["quad4", "quad8", "tri6"]);
    let parts = [("upp", [0.0, 1.0]), ("low", [-1.0, 0.0])].map(|(body, y)| {
        format!(
            "{{ body = \"{body}\", element = \"{element}\", \
             block = {{ x = [0, {w:?}], y = {y:?}, elements = [{n}, 2] }} }}"
        )
    });
    let scene: Scene = parse(
        &format!(
            r#"kind = "{kind}"
mesh.parts = [{}, {}]
materials.soft = {{ youngs_modulus = 1e3, poissons_ratio = 0.0 }}
materials.hard = {{ youngs_modulus = 1e8, poissons_ratio = 0.0 }}
bodies = {{ upp.material = "soft", low.material = "hard" }}
contact = [{{ first = "upp.bottom", second = "low.top" }}]
support = [{{ on = "low.bottom", fix = ["x", "y"] }}, {supports}]
load = [{{ on = "upp.top", pressure = 10.0 }}]
program.targets = [{{ load_factor = 1.0 }}]
"#,
            parts[0], parts[1],
        )
        .replace("ACROSS", &format!("[{cosine:?}, {sine:?}]")),
    );
    let mut mesh = Model::new(&parse(&format!(
        "kind = \"{kind}\"\nmesh.parts = [{}, {}]\n\
         materials.soft = {{ youngs_modulus = 1e3, poissons_ratio = 0.0 }}\n\
         bodies = {{ upp.material = \"soft\", low.material = \"soft\" }}\n\
         support = [{{ on = \"low.bottom\", fix = [\"x\", \"y\"] }}, \
         {{ on = \"upp.top\", fix = [\"x\", \"y\"] }}]\n\
         load = [{{ on = \"upp.left\", pressure = 1.0 }}]\n\
         program.targets = [{{ load_factor = 1.0 }}]\n",
        parts[0], parts[1]
    )))
    .unwrap()
    .mesh
    .clone();
    let left = mesh.set_nodes("upp.left").unwrap();
    for (name, is_there) in [("upp.p", 0.0), ("upp.q", 0.5)] {
        let at = |&node: &usize| (mesh.point(node)[1] - is_there).abs() < 1e-9;
        let nodes: Vec<usize> = left.iter().copied().filter(at).collect();
        assert_eq!(nodes.len(), 1);
        mesh.node_sets.insert(name.to_string(), nodes);
    }
    for point in mesh.coordinates.chunks_mut(2) {
        let [x, y] = [point[0], point[1]];
        (point[0], point[1]) = (x * cosine - y * sine, x * sine + y * cosine);
    }
    for surface in mesh.surfaces.values_mut() {
        surface.curve = None;
    }
    (w, run_on(&scene, mesh).states.remove(0))
}

/// The half width of a whole block is half its width, of one that ends on a plane of symmetry all
/// of it.
#[test]
fn nodes_that_are_held_bound_nothing() {
    let anchor = r#"{ on = "upp.p", direction = ACROSS }"#;
    let above = r#"{ on = "upp.q", direction = ACROSS }, { on = "upp.p", direction = ACROSS }"#;
    let one_body = r#"{ on = "upp.left", direction = ACROSS }"#;
    let plane =
        r#"{ on = "upp.left", direction = ACROSS }, { on = "low.left", direction = ACROSS }"#;
    for seed in 0..either(3, 30) {
        for (supports, times) in [(anchor, 0.5), (above, 0.5), (one_body, 0.5), (plane, 1.0)] {
            let random = &mut Random::new(seed);
            let angle = random.one_of(&[0.0, 30.0, 123.0]);
            let (w, state) = pressed(random, angle, supports);
            close(supports, state.half_width, times * w, w, 1e-9);
        }
    }
}

/// Three blocks on top of each other, the middle one held by contact alone: the dent of each is
/// that of the whole, where one of its nodes keeps it in place sideways.
#[test]
fn half_a_stack_is_dented_as_the_whole_is() {
    for element in ["quad4", "quad8"] {
        let stack = |half: bool| {
            let block = |body: &str, width: i32, height: [i32; 2], cells: [i32; 2]| {
                let (from, share) = if half { (0, 1) } else { (-width, 2) };
                format!(
                    "{{ body = \"{body}\", element = \"{element}\", block = {{ \
                     x = [{from}, {width}], y = {height:?}, elements = [{}, {}] }} }}",
                    share * cells[0],
                    cells[1]
                )
            };
            let on_plane =
                ["a", "b", "c"].map(|b| format!("{{ on = \"{b}.left\", fix = [\"x\"] }}"));
            let text = format!(
                r#"kind = "plane_strain"
symmetry = {}
mesh.parts = [{}, {}, {}]
materials.s = {{ youngs_modulus = 210e3, poissons_ratio = 0.3, yield_stress = 300,
                plastic_modulus = 3000 }}
bodies = {{ a.material = "s", b.material = "s", c.material = "s" }}
contact = [{{ first = "b.bottom", second = "a.top" }}, {{ first = "c.bottom", second = "b.top" }}]
support = [{{ on = "a.bottom", fix = ["y"] }}, {}]
load = [{{ on = "c.top", pressure = 400.0 }}]
program.targets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
"#,
                if half { 2 } else { 1 },
                block("a", 12, [0, 6], [8, 4]),
                block("b", 8, [6, 9], [7, 3]),
                block("c", 4, [9, 13], [4, 3]),
                if half {
                    on_plane.join(", ")
                } else {
                    String::new()
                },
            );
            let results = run(&parse(&text));
            results.states.into_iter().next_back().expect("a state")
        };
        let [half, whole] = [true, false].map(stack);
        assert!(half.residual_depth > 1e-3, "{}", half.residual_depth);
        let dents = |s: &State| {
            let mut dents = s.residual_depth_by_body.clone();
            dents.extend([s.residual_depth, s.rim_height]);
            dents
        };
        for (found, expected) in dents(&half).into_iter().zip(dents(&whole)) {
            close(element, found, expected, half.residual_depth, 1e-8);
        }
    }
}
