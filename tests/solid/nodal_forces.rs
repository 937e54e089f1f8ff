//! Forces on nodes are the consistent ones, also on quadratic faces in contact, whose freedoms are
//! those of control points.

use crate::support::random::Random;
use crate::support::{either, parse, run_on};
use brinell::model::Model;

/// Two blocks pressed on each other with forces at single nodes of both faces: what acts on a node
/// from outside is what was put there, and nothing anywhere else but at the support.
#[test]
fn a_force_on_a_node_in_contact_is_read_as_it_was_given() {
    for seed in 0..either(6, 100) {
        let random = &mut Random::new(seed);
        let shape = random.one_of(&["hex8", "hex20"]);
        let [a, b] = [1, 1].map(|least| least + random.below(2));
        let text = |more: &str| {
            format!(
                "kind = \"solid\"\n\
                 contact = [{{ first = \"upper.bottom\", second = \"lower.top\" }}]\n\
                 support = [{{ on = \"lower.bottom\", fix = [\"x\", \"y\", \"z\"] }},\n\
                 {{ on = \"upper.left\", fix = [\"x\"] }},\n\
                 {{ on = \"upper.front\", fix = [\"y\"] }}]\n\
                 [[load]]\non = \"upper.top\"\npressure = 10.0\n{more}\n\
                 [[mesh.parts]]\nbody = \"upper\"\nelement = \"{shape}\"\n\
                 brick = {{ x = [0, 1], y = [0, 1], z = [1, 2], elements = [2, 2, 2] }}\n\
                 [[mesh.parts]]\nbody = \"lower\"\nelement = \"{shape}\"\n\
                 brick = {{ x = [-0.5, 1.5], y = [-0.5, 1.5], z = [0, 1],\n\
                 elements = [{}, {}, 2] }}\n\
                 [materials.soft]\nyoungs_modulus = 1000.0\npoissons_ratio = 0.3\n\
                 [bodies]\nupper.material = \"soft\"\nlower.material = \"soft\"\n\
                 [program]\ntargets = [{{ load_factor = 1.0 }}]\n",
                a + 1,
                b + 1
            )
        };
        let mut mesh = Model::new(&parse(&text(""))).unwrap().mesh.clone();
        let between: Vec<usize> = (0..mesh.n_nodes())
            .filter(|&node| {
                let [x, y, z] = mesh.point(node);
                z == 1.0 && x > 0.0 && y > 0.0
            })
            .collect();
        let mut loads = String::new();
        let mut expected = vec![[0.0; 3]; mesh.n_nodes()];
        for k in 0..4 {
            let node = between[random.below(between.len())];
            let force: [f64; 3] = std::array::from_fn(|_| random.within(-0.3, 0.3));
            mesh.node_sets.insert(format!("one{k}"), vec![node]);
            loads += &format!("[[load]]\non = \"one{k}\"\nforce = {force:?}\n");
            (0..3).for_each(|d| expected[node][d] += force[d]);
        }
        let results = run_on(&parse(&text(&loads)), mesh.clone());
        let found = &results.states[0].fields.as_ref().unwrap().force;
        // The pressure adds up to 10.
        let accuracy = 1e-8 * 10.0;
        for (node, expected) in expected.iter().enumerate() {
            let [x, y, z] = mesh.point(node);
            if z > 0.0 && z < 2.0 && x != 0.0 && y != 0.0 {
                for d in 0..3 {
                    let off = found[3 * node + d] - expected[d];
                    assert!(off.abs() < accuracy, "{seed} {shape} node {node}: {off:e}");
                }
            }
        }
    }
}
