//! Supports, forces and rigid bodies along the axes of a `*TRANSFORM`: each node has its own.

use super::run_text;
use crate::support::random::Random;
use crate::support::{close, either, largest};
use brinell::space::{cross, direction, dot};
use std::fmt::Write;

const AROUND: usize = 24;

/// A ring of 24 x 1 x 1 bricks, pushed outward by the same force at each inner node, and held in
/// its plane around the axis alone.
fn ring() -> String {
    let mut deck = String::from("*NODE, NSET=ALL\n");
    let label =
        |around: usize, out: usize, up: usize| 1 + around % AROUND + AROUND * (out + 2 * up);
    for up in 0..2 {
        for out in 0..2 {
            for around in 0..AROUND {
                let angle = std::f64::consts::TAU * around as f64 / AROUND as f64;
                let (sin, cos) = angle.sin_cos();
                let radius = 10.0 * (1 + out) as f64;
                writeln!(
                    deck,
                    "{}, {:?}, {:?}, {up}.0",
                    label(around, out, up),
                    radius * cos,
                    radius * sin
                )
                .unwrap();
            }
        }
    }
    deck += "*ELEMENT, TYPE=C3D8, ELSET=EALL\n";
    for a in 0..AROUND {
        let of = |up: usize| [(a, 0), (a, 1), (a + 1, 1), (a + 1, 0)].map(|(a, r)| label(a, r, up));
        let nodes: Vec<String> = of(0)
            .iter()
            .chain(&of(1))
            .map(ToString::to_string)
            .collect();
        writeln!(deck, "{}, {}", a + 1, nodes.join(", ")).unwrap();
    }
    deck += "*NSET, NSET=INNER\n";
    for up in 0..2 {
        (0..AROUND).for_each(|a| writeln!(deck, "{},", label(a, 0, up)).unwrap());
    }
    deck + "*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n\
            *SOLID SECTION, ELSET=EALL, MATERIAL=M\n\
            *TRANSFORM, NSET=ALL, TYPE=C\n0., 0., 0., 0., 0., 1.\n\
            *STEP\n*STATIC\n*BOUNDARY\nALL, 2, 3\n*CLOAD\nINNER, 1, 100.\n*END STEP\n"
}

/// All nodes of a circle move outward alike, and nothing else acts on inner ones than their force
/// and a support around the axis. Neither the supports nor the forces, each along its own
/// direction, cost a solve of their own.
#[test]
fn a_ring_in_the_axes_of_its_cylinder() {
    let (model, results) = run_text(&ring());
    // The loads, their sum being one, with the load that is reported; the state.
    assert!(results.counts.full_solves <= 3, "{:?}", results.counts);
    // Two of four freedoms of a node are free in no direction but outward.
    assert_eq!(model.freedoms.n, 4 * AROUND);
    let fields = results.states[0].fields.as_ref().unwrap();
    let [moved, scale] =
        [&fields.displacement, &fields.force].map(|values| largest(values.iter().copied()));
    let mut outward = [Vec::new(), Vec::new()];
    for node in 0..model.mesh.n_nodes() {
        let [x, y, _] = model.mesh.point(node);
        let radius = x.hypot(y);
        let cylindrical = |v: &[f64]| {
            let [a, b] = [v[3 * node], v[3 * node + 1]];
            [
                (a * x + b * y) / radius,
                (b * x - a * y) / radius,
                v[3 * node + 2],
            ]
        };
        let [u, around, up] = cylindrical(&fields.displacement);
        close("around", around, 0.0, moved, 1e-13);
        close("up", up, 0.0, moved, 1e-13);
        let is_inner = radius < 15.0;
        outward[usize::from(is_inner)].push(u);
        let [force, ..] = cylindrical(&fields.force);
        close(
            "force",
            force,
            if is_inner { 100.0 } else { 0.0 },
            scale,
            1e-11,
        );
    }
    for circle in outward {
        assert!(circle[0] > 0.1 * moved);
        circle
            .iter()
            .for_each(|u| close("outward", *u, circle[0], moved, 1e-11));
    }
}

/// A bar of 2 x 2 x 3 bricks whose end is rigid. `{axes}` stands for the keywords of local axes,
/// `{loads}` for what acts on the reference node 900 and the rotation node 901.
fn bar_with_rigid_end(is_coupling: bool, axes: &str, loads: &str) -> String {
    let mut deck = String::from("*NODE, NSET=ALL\n");
    let label = |i: usize, j: usize, k: usize| 1 + i + 3 * (j + 3 * k);
    for k in 0..4 {
        for j in 0..3 {
            for i in 0..3 {
                writeln!(deck, "{}, {i}.0, {j}.0, {k}.0", label(i, j, k)).unwrap();
            }
        }
    }
    deck += "900, 0.5, 1.25, 3.5\n901, 0., 0., 9.\n*ELEMENT, TYPE=C3D8, ELSET=EALL\n";
    for e in 0..12 {
        let (i, j, k) = (e % 2, e / 2 % 2, e / 4);
        let of = |k: usize| {
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| label(i, j, k))
        };
        let nodes: Vec<String> = of(k)
            .iter()
            .chain(&of(k + 1))
            .map(ToString::to_string)
            .collect();
        writeln!(deck, "{}, {}", 1 + e, nodes.join(", ")).unwrap();
    }
    let end = "*NSET, NSET=END, GENERATE\n28, 36\n*NSET, NSET=FOOT, GENERATE\n1, 9\n";
    let rigid = match is_coupling {
        false => "*RIGID BODY, NSET=END, REF NODE=900, ROT NODE=901\n".to_string(),
        true => "*SURFACE, NAME=FACE\n9, S2\n10, S2\n11, S2\n12, S2\n\
                 *COUPLING, REF NODE=900, SURFACE=FACE, CONSTRAINT NAME=C\n*KINEMATIC\n"
            .to_string(),
    };
    format!(
        "{deck}{end}*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n\
         *SOLID SECTION, ELSET=EALL, MATERIAL=M\n{axes}{rigid}\
         *STEP\n*STATIC\n*BOUNDARY\nFOOT, 1, 3\n{loads}*END STEP\n"
    )
}

/// A reference node, a rotation node and nodes of the rigid face may have axes of their own: what
/// is given along them is what it is along x, y and z.
#[test]
fn a_rigid_end_moves_alike_in_any_axes() {
    for seed in 1..=either(12, 200) {
        let random = &mut Random::new(seed);
        let is_coupling = random.below(2) == 1;
        let is_moved = random.below(2) == 1;
        let vector = |random: &mut Random| [0; 3].map(|_| random.within(-1.0, 1.0));
        // Two vectors of a transform, and the axes that they define.
        let turned = |random: &mut Random, set: &str| {
            let (a, b) = (vector(random), vector(random));
            let first = direction(a);
            let third = direction(cross(a, b));
            let card = format!(
                "*NSET, NSET=T{set}\n{set}\n*TRANSFORM, NSET=T{set}\n{:?}, {:?}, {:?}, {:?}, {:?}, \
                 {:?}\n",
                a[0], a[1], a[2], b[0], b[1], b[2]
            );
            (card, [first, cross(third, first), third])
        };
        let own = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut axes = String::new();
        let mut of_nodes = [own; 2];
        for (node, own) in ["900", "901"].iter().zip(&mut of_nodes) {
            if !(is_coupling && *node == "901") {
                let (card, of_node) = turned(random, node);
                axes += &card;
                *own = of_node;
            }
        }
        for node in 28..=36 {
            if random.below(3) > 0 {
                axes += &turned(random, &node.to_string()).0;
            }
        }
        let given = [vector(random), vector(random)];
        let n_nodes = if is_coupling { 1 } else { 2 };
        let loads = |of_nodes: [[[f64; 3]; 3]; 2]| {
            let mut out = String::from(if is_moved { "" } else { "*CLOAD\n" });
            for n in 0..n_nodes {
                for (k, axis) in of_nodes[n].iter().enumerate() {
                    let value = 1e-3 * dot(given[n], *axis);
                    let (node, freedom) = (900 + n, k + 1);
                    match is_moved {
                        true => writeln!(out, "{node}, {freedom}, {freedom}, {value:?}").unwrap(),
                        false => writeln!(out, "{node}, {freedom}, {:?}", 1e5 * value).unwrap(),
                    }
                }
            }
            out
        };
        let plain = bar_with_rigid_end(is_coupling, "", &loads([own; 2]));
        let turned = bar_with_rigid_end(is_coupling, &axes, &loads(of_nodes));
        let [plain, turned] = [plain, turned].map(|deck| {
            let (_, results) = run_text(&deck);
            results.states[0].fields.clone().unwrap().displacement
        });
        let size = largest(plain.iter().copied());
        assert!(size > 0.0, "{seed}");
        for (plain, turned) in plain.iter().zip(&turned) {
            close(&format!("seed {seed}"), *turned, *plain, size, 1e-9);
        }
    }
}
