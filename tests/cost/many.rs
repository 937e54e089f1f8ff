//! Many bodies: what they cost grows with their number, not with its square or cube.

use crate::support::{parse, try_run};
use brinell::assembly::assemble;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::substructure::{ContactCost, Substructure};
use std::fmt::Write;

/// Stacks of one-element blocks, each of `height` of them, pressed by 10 + the number of the stack.
/// The lowest `held` of each are held along x.
fn stacks(n: usize, height: usize) -> String {
    stacks_held(n, height, height)
}

fn stacks_held(n: usize, height: usize, held: usize) -> String {
    let mut text = String::from(
        "kind = \"plane_strain\"\n\
         [materials.steel]\nyoungs_modulus = 210000.0\npoissons_ratio = 0.3\n",
    );
    let mut conditions = String::new();
    for i in 0..n {
        for j in 0..height {
            let (x, y) = (2.0 * i as f64, j as f64);
            write!(
                text,
                "[[mesh.parts]]\nbody = \"b{i}_{j}\"\n\
                 block = {{ x = [{x:?}, {:?}], y = [{y:?}, {:?}], elements = [1, 1] }}\n",
                x + 1.0,
                y + 1.0
            )
            .unwrap();
            writeln!(conditions, "[bodies.b{i}_{j}]\nmaterial = \"steel\"").unwrap();
            if j < held {
                writeln!(
                    conditions,
                    "[[support]]\non = \"b{i}_{j}.left\"\nfix = [\"x\"]"
                )
                .unwrap();
            }
            if j > 0 {
                write!(
                    conditions,
                    "[[contact]]\nfirst = \"b{i}_{j}.bottom\"\nsecond = \"b{i}_{}.top\"\n",
                    j - 1
                )
                .unwrap();
            }
        }
        write!(
            conditions,
            "[[support]]\non = \"b{i}_0.bottom\"\nfix = [\"y\"]\n\
             [[load]]\non = \"b{i}_{}.top\"\npressure = {:?}\n",
            height - 1,
            10.0 + i as f64
        )
        .unwrap();
    }
    text + &conditions + "[program]\ntargets = [{ name = \"end\", load_factor = 1.0 }]\n"
}

fn structure(text: &str) -> (ContactCost, Substructure) {
    let model = Model::new(&parse(text)).unwrap();
    let system = assemble(&model, Backend::default()).unwrap();
    let structure =
        Substructure::new(&model, &system, Default::default(), Backend::default()).unwrap();
    (ContactCost::of(&model), structure)
}

#[test]
fn separate_bodies_cost_what_each_of_them_costs() {
    let [(one, single), (few, tens), (many, hundreds)] =
        [1, 40, 160].map(|n| structure(&stacks(n, 2)));
    for (n, cost, structure) in [(40, few, tens), (160, many, hundreds)] {
        assert_eq!((cost.groups, cost.largest_group), (n, 2));
        let times = n as f64;
        // A sum of equal terms, to round-off.
        assert!((cost.flops / (times * one.flops) - 1.0).abs() < 1e-13);
        assert_eq!(cost.memory_bytes, times * one.memory_bytes);
        assert_eq!(structure.contact_bytes(), n as u64 * single.contact_bytes());
        assert_eq!(structure.tableau().matrix().n_entries(), 4 * n);
        // The factor has no entries between bodies either.
        assert_eq!(
            structure.cost().trailing_nonzeros,
            times * single.cost().trailing_nonzeros
        );
    }
}

#[test]
fn pairs_that_bodies_join_are_dense_and_said_to_be() {
    let (cost, tower) = structure(&stacks(1, 21));
    assert_eq!((cost.pairs, cost.groups, cost.largest_group), (40, 1, 40));
    assert_eq!(tower.tableau().matrix().n_entries(), 40 * 40);
    let (half, _) = structure(&stacks(1, 11));
    assert_eq!(cost.flops, 8.0 * half.flops);
    assert_eq!(cost.memory_bytes, 4.0 * half.memory_bytes);
}

/// A coarse hard block that carries a fine soft one: the hard nodes have the gaps, and soft nodes
/// follow all the others. Putting them together takes no more than two products of full matrices.
#[test]
fn followers_of_many_leaders_cost_two_products() {
    let text = "kind = \"solid\"\n\
        mesh.parts = [\n\
        { body = \"soft\", brick = { x = [-6, 6], y = [-3, 3], z = [0, 3],\n\
        elements = [16, 8, 2] } },\n\
        { body = \"hard\", brick = { x = [-7, 7], y = [-4, 4], z = [-2, 0],\n\
        elements = [6, 4, 2] } }]\n\
        materials.soft = { youngs_modulus = 1e3, poissons_ratio = 0.0 }\n\
        materials.hard = { youngs_modulus = 1e9, poissons_ratio = 0.0 }\n\
        bodies = { soft.material = \"soft\", hard.material = \"hard\" }\n\
        contact = [{ first = \"soft.bottom\", second = \"hard.top\" }]\n\
        support = [{ on = \"hard.bottom\", fix = [\"x\", \"y\", \"z\"] },\n\
        { on = \"soft.left\", fix = [\"x\"] }, { on = \"soft.front\", fix = [\"y\"] }]\n\
        load = [{ on = \"soft.top\", pressure = 10.0 }]\n\
        program.targets = [{ load_factor = 1.0 }]\n";
    let (cost, structure) = structure(text);
    let rows = cost.pairs;
    let leaders = Model::new(&parse(text)).unwrap().rows.n_contact() - rows;
    let taken = structure.tying_multiplications();
    assert!(rows > 20 && leaders > 100, "{rows} {leaders}");
    // The rows are those of hard slaves: more than each leader's own entry.
    assert!(taken > 10 * leaders * leaders, "{taken}");
    assert!(taken <= leaders * rows * (leaders + rows), "{taken}");
    // Pairs of nodes: each leader has one follower.
    let (pairs, single) = self::structure(&stacks(1, 21));
    assert!(single.tying_multiplications() <= 2 * pairs.pairs.pow(2));
}

/// Beside others every stack does what it does alone: uniform pressure, its own.
#[test]
fn groups_do_not_feel_one_another() {
    let results = try_run(&parse(&stacks(12, 3)), Backend::default()).unwrap();
    let state = &results.states[0];
    for pair in &state.pairs {
        let stack = (pair.position[0] / 2.0).floor();
        // Round-off of a stack of three elements; forces of all stacks share a scale.
        assert!(
            (pair.pressure - (10.0 + stack)).abs() <= 1e-11 * 22.0,
            "{pair:?}"
        );
    }
    assert_eq!(state.pairs.len(), 12 * 4);
}

/// Nothing holds the upper blocks along x: each is pinned for itself, and the work of finding them
/// is that of the blocks.
#[test]
fn every_free_body_is_pinned() {
    let text = stacks_held(9, 2, 1);
    let model = Model::new(&parse(&text)).unwrap();
    assert_eq!(model.floating.pins.len(), 9);
    assert!(
        model
            .floating
            .pins
            .iter()
            .all(|pin| pin.motion.contains("move along x"))
    );
}
