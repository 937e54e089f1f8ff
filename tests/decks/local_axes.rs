//! Supports and forces along the axes of a cylinder (`*TRANSFORM, TYPE=C`): each node has its own.

use super::run_text;
use crate::support::{close, largest};
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
