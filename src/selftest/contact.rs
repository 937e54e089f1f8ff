//! Contact: floating bodies, conforming surfaces, ties, events, complementarity.

use super::cases::{CaseFamily, Cases, difference, results, scene, state, worst_quality};
use crate::analysis::Analysis;
use crate::analytical::{HertzLine, contact_modulus};
use crate::contact::{Tableau, solve};
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Silent;
use crate::results::Status;
use crate::scene::{Plastic, Target, Unit};
use nalgebra::{DMatrix, DVector};

/// Bound of the error for conforming surfaces: `2 n^2 eps` with the `n` = 25 pairs of the disc. The
/// condensed stiffness of a surface is an operator of first order: its condition is about the
/// number of elements along it.
const CONFORMING: f64 = 2.0 * 25.0 * 25.0 * f64::EPSILON;

pub(super) const FAMILIES: &[CaseFamily] = &[
    CaseFamily {
        name: "bodies held by contact alone",
        figure: "contact force against the load",
        bound: 1e-10,
        source: "round-off of gaps 1000 times the elastic displacement",
        cases: floating,
    },
    CaseFamily {
        name: "contact lost and found",
        figure: "same load, same state",
        bound: 1e-9,
        source: "the path is reversible; round-off at loads a million times as large as the first",
        cases: lost_and_found,
    },
    CaseFamily {
        name: "conforming surfaces",
        figure: "pressure over load from 1e-6 to 1e6",
        bound: CONFORMING,
        source: "receding contact is proportional; two solves, each off by eps times the pairs \
                 (25) and the condition of their matrix (about as many)",
        cases: conforming,
    },
    CaseFamily {
        name: "ties",
        figure: "spread of 301 pairs that open and close as one",
        bound: 1e-10,
        source: "the solution is uniform; round-off times the condition",
        cases: ties,
    },
    CaseFamily {
        name: "complementarity",
        figure: "residual of 10,000 singular and degenerate problems",
        bound: 1e-11,
        source: "n eps times the condition, at most 1e4",
        cases: complementarity,
    },
    CaseFamily {
        name: "contact that spreads",
        figure: "half width at 0.1 to 50 times first yield against Hertz",
        bound: 1.0 / 64.0,
        source: "candidates follow from the load; the edge is read to an eighth of an element, of \
                 16; a circle in place of a parabola, (b/R)^2/8",
        cases: spreading,
    },
    CaseFamily {
        name: "dents",
        figure: "each body's share against the displacements after unloading, over the approach",
        bound: 1e-8,
        source: "forces balance to 1e-10, a hundred times that in displacements",
        cases: dents,
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

/// Small integers from a linear congruential generator: ties and singular matrices are exact, and
/// the same on all machines.
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

/// Runs the elastic line contact at multiples of the load at first yield, with contact candidates
/// that follow from the load.
fn spreading(cases: &mut Cases) -> Result<()> {
    const CYLINDER: &str = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
    let (modulus, y) = (contact_modulus(210e3, 0.3, 210e3, 0.3), 500.0);
    let hertz = HertzLine::new(10.0, modulus)?;
    for times in [0.1, 1.0, 10.0, 50.0] {
        let load = times * hertz.yield_load(0.3, y);
        let mut pressed = scene(CYLINDER)?;
        pressed.reference.clear();
        pressed.program.unit = Unit::Load;
        pressed.program.targets = vec![Target {
            load_factor: Some(1.0),
            ..Target::default()
        }];
        if let Some(force) = pressed
            .load
            .first_mut()
            .and_then(|l| l.plane_force.as_mut())
        {
            force.total = -load;
        }
        if let Some(mesh) = &mut pressed.mesh.cylinder_on_half_plane {
            mesh.half_width = Some(hertz.yield_half_width(0.3, y).min(hertz.half_width(load)));
        }
        pressed
            .bodies
            .values_mut()
            .for_each(|b| b.plastic = Plastic::No);
        let results = results(&pressed)?;
        for state in &results.states {
            cases.add(state.half_width / hertz.half_width(load) - 1.0);
        }
    }
    Ok(())
}

/// Compares each body's share in a dent with the displacements of the whole mesh after unloading,
/// at its pole and its far surface.
fn dents(cases: &mut Cases) -> Result<()> {
    const SCENES: [&str; 2] = [
        include_str!("../../data/scenes/cylinder_on_half_plane.toml"),
        include_str!("../../data/scenes/ball_on_half_space.toml"),
    ];
    for text in SCENES {
        let mut pressed = scene(text)?;
        if let Some(mesh) = &mut pressed.mesh.cylinder_on_half_plane {
            mesh.resolution = 6;
        }
        let target = |factor: f64| Target {
            load_factor: Some(factor),
            fields: true,
            ..Target::default()
        };
        pressed.program.targets = vec![target(1.5), target(0.0)];
        let model = Model::new(&pressed)?;
        let results = Analysis::new(model.clone(), Backend::default())?.run(&mut Silent)?;
        let [loaded, unloaded] = &results.states[..] else {
            return Err(Error::internal("two targets leave two states"));
        };
        let fields = unloaded.fields.as_ref();
        let mean = |set: &str| {
            let nodes = model.mesh.set_nodes(set).unwrap_or_default();
            let sum: f64 = nodes
                .iter()
                .filter_map(|&n| fields.map(|f| f.displacement[2 * n + 1]))
                .sum();
            sum / nodes.len() as f64
        };
        let shown = [
            mean("cylinder.pole") - mean("cylinder.top"),
            mean("half_plane.bottom") - mean("half_plane.pole"),
        ];
        for (share, shown) in unloaded.residual_depth_by_body.iter().zip(shown) {
            cases.add((share - shown) / loaded.approach);
        }
    }
    Ok(())
}
