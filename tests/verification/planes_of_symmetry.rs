//! A plane of symmetry is a whole plane of both bodies that is held across and free along, never a
//! node: what is read off a contact is the same whichever nodes keep the bodies in place.

use crate::support::random::Random;
use crate::support::{close, either, parse, run_on};
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
