//! Contact: floating bodies, conforming surfaces, ties, events, complementarity.

use super::{Cases, Family, difference, results, scene, state, worst_quality};
use crate::contact::{Tableau, solve};
use crate::error::Result;
use crate::results::Status;
use nalgebra::{DMatrix, DVector};

/// `2 n^2 eps` with the 25 pairs of the disc. The condensed stiffness of a surface is an operator of first order: its condition is about the number of
/// elements along it.
const CONFORMING: f64 = 2.0 * 25.0 * 25.0 * f64::EPSILON;

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "bodies held by contact alone",
        figure: "contact force against the load",
        bound: 1e-10,
        source: "round-off of gaps 1000 times the elastic displacement",
        cases: floating,
    },
    Family {
        name: "contact lost and found",
        figure: "same load, same state",
        bound: 1e-9,
        source: "the path is reversible; round-off at loads a million times as large as the first",
        cases: lost_and_found,
    },
    Family {
        name: "conforming surfaces",
        figure: "pressure over load from 1e-6 to 1e6",
        bound: CONFORMING,
        source: "receding contact is proportional; two solves, each off by eps times the pairs (25) and the condition of their matrix (about as many)",
        cases: conforming,
    },
    Family {
        name: "ties",
        figure: "spread of 301 pairs that open and close as one",
        bound: 1e-10,
        source: "the solution is uniform; round-off times the condition",
        cases: ties,
    },
    Family {
        name: "complementarity",
        figure: "residual of 10,000 singular and degenerate problems",
        bound: 1e-11,
        source: "n eps times the condition, at most 1e4",
        cases: complementarity,
    },
];

fn floating(cases: &mut Cases) -> Result<()> {
    let one = results(&scene(include_str!(
        "../../data/scenes/hard/floating_body.toml"
    ))?)?;
    for (s, force) in one.states.iter().zip([20.0, 5.0, 20.0]) {
        cases.add(s.contact_force / force - 1.0);
    }
    let row = results(&scene(include_str!(
        "../../data/scenes/hard/three_in_a_row.toml"
    ))?)?;
    for (s, force) in row.states.iter().zip([100.0, 50.0]) {
        for contact in 0..2 {
            let of_contact = s.pairs.iter().filter(|p| p.contact == contact);
            cases.add(of_contact.map(|p| p.force).sum::<f64>() / force - 1.0);
        }
    }
    Ok(())
}

fn lost_and_found(cases: &mut Cases) -> Result<()> {
    let lifted = results(&scene(include_str!(
        "../../data/scenes/hard/lift_off.toml"
    ))?)?;
    let up = state(&lifted, "up")?;
    cases.add(up.contact_force);
    let (down, again) = (state(&lifted, "down")?, state(&lifted, "down again")?);
    cases.add(difference(down, again, |p| p.force));
    let pair = results(&scene(include_str!(
        "../../data/scenes/hard/one_pair.toml"
    ))?)?;
    if let [touch, _, again] = &pair.states[..] {
        cases.add(difference(touch, again, |p| p.force));
    } else {
        cases.add(f64::NAN);
    }
    Ok(())
}

fn conforming(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!(
        "../../data/scenes/hard/zero_gap_conforming.toml"
    ))?)?;
    let one = state(&run, "one")?;
    for (name, factor) in [("tiny", 1e-6), ("huge", 1e6), ("back", 1.0)] {
        let s = state(&run, name)?;
        for (a, b) in one.pairs.iter().zip(&s.pairs) {
            cases.add((b.pressure / factor - a.pressure) / one.max_pressure);
        }
    }
    cases.add(worst_quality(&run));
    Ok(())
}

fn ties(cases: &mut Cases) -> Result<()> {
    let run = results(&scene(include_str!("../../data/scenes/hard/ties.toml"))?)?;
    for s in &run.states {
        let closed = s
            .pairs
            .iter()
            .filter(|p| p.status == Status::Closed)
            .count();
        if closed != 0 && closed != s.pairs.len() {
            cases.add(f64::NAN);
        }
        let pressures = s.pairs.iter().map(|p| p.pressure);
        let least = pressures.clone().fold(f64::INFINITY, f64::min);
        cases.add(if s.max_pressure > 0.0 {
            1.0 - least / s.max_pressure
        } else {
            0.0
        });
    }
    Ok(())
}

/// Small integers by a linear congruential generator: ties and singular matrices are exact, and the same everywhere.
struct Integers(u64);

impl Integers {
    fn next(&mut self, most: u64) -> f64 {
        // Knuth, The Art of Computer Programming, volume 2, section 3.3.4.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % (2 * most + 1)) as f64 - most as f64
    }
}

fn complementarity(cases: &mut Cases) -> Result<()> {
    let mut integers = Integers(1);
    for case in 0..10_000 {
        let (n, rank) = (1 + case % 9, 1 + case / 9 % 9);
        let a = DMatrix::from_fn(n, rank, |_, _| integers.next(3));
        let t = &a * a.transpose();
        let sides = DVector::from_fn(n, |_, _| integers.next(3));
        let q = sides.map(|s| (-s).max(0.0)) - &t * sides.map(|s| s.max(0.0));
        let (mut g, mut r) = (vec![0.0; n], vec![0.0; n]);
        let solved = solve(&mut Tableau::new(t.clone()), q.as_slice(), &mut g, &mut r);
        if solved.is_err() {
            cases.add(f64::NAN);
            continue;
        }
        let off = DVector::from_column_slice(&r) - &q - &t * DVector::from_column_slice(&g);
        let size = q.amax() + t.amax() * g.iter().fold(0.0f64, |m, v| m.max(*v));
        let both = g.iter().zip(&r).fold(0.0f64, |m, (g, r)| m.max(g * r));
        cases.add(if size > 0.0 {
            off.amax() / size + both
        } else {
            0.0
        });
    }
    Ok(())
}
