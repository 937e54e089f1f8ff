//! A row of line contacts beside one another, pressed in turn as rolling does it step by step: the
//! limit of shakedown.
//!
//! Source: K. L. Johnson, Contact Mechanics (1985), section 9.2: in rolling without friction a half
//! plane shakes down up to `p_0 = 4 k`, k the yield stress in shear. At a depth of 0.5 a the shear
//! stress goes to and fro between `+-0.25 p_0`, and residual stresses can only take up the others.

use crate::support::build::Build;
use crate::support::{either, run_model};
use brinell::linalg::Backend;
use brinell::mesh::Shape;
use brinell::model::{Model, ModelBuilder};
use brinell::results::CycleOutcome;
use brinell::scene::{Direction, History, Kind, Material, Program, Stepping, Target};

/// Half width of the contact.
const A: f64 = 1.0;
/// Centres are so far apart: the shear stress of a contact is largest 0.87 a beside its centre.
const APART: f64 = 0.87 * A;
const PLACES: usize = 5;
/// Yield stress in shear.
const K: f64 = 100.0;

/// Lines from 0 outwards: of the fine size up to `fine`, then growing up to `end`.
fn lines(size: f64, fine: f64, end: f64) -> Vec<f64> {
    let mut out = vec![0.0];
    let mut step = size;
    loop {
        let last = out[out.len() - 1];
        if last > fine - 1e-9 {
            step *= 1.5;
        }
        if last + 1.5 * step > end {
            out.push(end);
            return out;
        }
        out.push(last + step);
    }
}

/// A half plane of quad8 elements of the size `h` below a row of contacts of the peak pressure
/// `p_0`, pressed one after the other to the right, and back. Two apart, they bring the largest
/// shear stress of either sign to the same place.
fn row(h: f64, p0: f64) -> Model {
    let half = 0.5 * APART * (PLACES - 1) as f64;
    let right = lines(h, half + 1.5 * A, half + 100.0 * A);
    let xs: Vec<f64> = right[1..]
        .iter()
        .rev()
        .map(|x| -x)
        .chain(right.iter().copied())
        .collect();
    let ys: Vec<f64> = lines(h, 1.5 * A, 100.0 * A)
        .iter()
        .rev()
        .map(|y| -y)
        .collect();
    // Corners and mid-side nodes.
    let fine = |lines: &[f64]| -> Vec<f64> {
        let mids = lines.windows(2).flat_map(|l| [l[0], 0.5 * (l[0] + l[1])]);
        mids.chain(lines.last().copied()).collect()
    };
    let (fx, fy) = (fine(&xs), fine(&ys));
    let (mut coordinates, mut index) = (Vec::new(), vec![vec![usize::MAX; fy.len()]; fx.len()]);
    for (j, y) in fy.iter().enumerate() {
        for (i, x) in fx.iter().enumerate() {
            if i % 2 == 0 || j % 2 == 0 {
                index[i][j] = coordinates.len() / 2;
                coordinates.extend([*x, *y]);
            }
        }
    }
    let mut elements = Vec::new();
    for j in (0..fy.len() - 1).step_by(2) {
        for i in (0..fx.len() - 1).step_by(2) {
            for (a, b) in [
                (0, 0),
                (2, 0),
                (2, 2),
                (0, 2),
                (1, 0),
                (2, 1),
                (1, 2),
                (0, 1),
            ] {
                elements.push(index[i + a][j + b]);
            }
        }
    }
    let mut builder = ModelBuilder::new(Kind::PlaneStrain);
    builder.nodes(&coordinates).unwrap();
    builder.elements(Shape::Quad8, "plane", &elements).unwrap();
    let top: Vec<usize> = index.iter().map(|column| column[fy.len() - 1]).collect();
    let sides: Vec<usize> = [0, fx.len() - 1]
        .iter()
        .flat_map(|&i| index[i].iter().copied().filter(|n| *n != usize::MAX))
        .collect();
    let bottom: Vec<usize> = index
        .iter()
        .map(|c| c[0])
        .filter(|n| *n != usize::MAX)
        .collect();
    for (name, nodes, direction) in [
        ("sides", sides, Direction::X),
        ("bottom", bottom, Direction::Y),
    ] {
        builder.node_set(name, &nodes).unwrap();
        builder.hold(name, direction);
    }
    let metal = Material {
        youngs_modulus: 2e5,
        poissons_ratio: 0.3,
        yield_stress: Some(K * 3f64.sqrt()),
        ..Material::default()
    };
    builder.material("metal", metal).unwrap();
    builder.of("plane", "metal");
    for k in 0..PLACES {
        let centre = APART * k as f64 - half;
        let forces = hertz(&fx, centre, p0);
        let peak = k as f64 + 1.0;
        let history = vec![[peak - 1.0, 0.0], [peak, 1.0], [peak + 1.0, 0.0]];
        let name = format!("place {k}");
        let of =
            |(node, force): (&usize, f64)| (force != 0.0).then_some((*node, [0.0, -force, 0.0]));
        let (nodes, forces): (Vec<usize>, Vec<[f64; 3]>) =
            top.iter().zip(forces).filter_map(of).unzip();
        builder
            .nodal_load(&name, &nodes, &forces, History::Table(history))
            .unwrap();
    }
    let target = |factor: f64| Target {
        load_factor: Some(factor),
        ..Target::default()
    };
    builder.program(Program {
        stepping: Stepping::Steps,
        steps: 2 * (PLACES + 1),
        targets: vec![target(PLACES as f64 + 1.0), target(0.0)],
        cycles: 12,
        ..Program::default()
    });
    builder.build().unwrap()
}

/// Nodal forces of the pressure `p_0 sqrt(1 - (x/a)^2)` on edges of three nodes.
fn hertz(x: &[f64], centre: f64, p0: f64) -> Vec<f64> {
    const STRIPS: usize = 400;
    let mut out = vec![0.0; x.len()];
    for edge in (0..x.len() - 1).step_by(2) {
        let length = x[edge + 2] - x[edge];
        for strip in 0..STRIPS {
            let s = (strip as f64 + 0.5) / STRIPS as f64;
            let at = (x[edge] + s * length - centre) / A;
            let pressure = p0 * (1.0 - at * at).max(0.0).sqrt();
            let weights = [
                (1.0 - s) * (1.0 - 2.0 * s),
                4.0 * s * (1.0 - s),
                s * (2.0 * s - 1.0),
            ];
            for (k, weight) in weights.iter().enumerate() {
                out[edge + k] += weight * pressure * length / STRIPS as f64;
            }
        }
    }
    out
}

/// What cycles of a row of five places, 0.87 a apart, come to, and what flows in the last of them
/// over what flowed in the first.
fn outcome(h: f64, factor: f64) -> (CycleOutcome, f64) {
    let results = run_model(row(h * A, factor * K), Backend::default());
    let cycles = results.cycles.unwrap();
    (cycles.outcome, cycles.last().flow / cycles.rows[0].flow)
}

/// First yield at `p_0 = 3.1 k` (1.79 of the yield stress in tension, von Mises), shakedown up to
/// 4 k: on finer meshes between closer limits.
#[test]
fn a_row_of_contacts_shakes_down_up_to_four_times_the_shear_yield_stress() {
    let (h, elastic, yields) = either((0.25, 3.0, 3.2), (0.125, 3.05, 3.15));
    assert_eq!(outcome(h, elastic).0, CycleOutcome::Elastic);
    assert_eq!(outcome(h, yields).0, CycleOutcome::ElasticShakedown);
    let limits = [(0.5, 3.7, 4.2), (0.25, 3.9, 4.1), (0.125, 3.95, 4.05)];
    for &(h, below, above) in either(&limits[..2], &limits) {
        let (found, _) = outcome(h, below);
        assert_eq!(found, CycleOutcome::ElasticShakedown, "{h} {below}");
        let (found, flow) = outcome(h, above);
        assert_ne!(found, CycleOutcome::ElasticShakedown, "{h} {above}");
        assert!(flow > 0.02, "{h} {above}: {flow}");
    }
}
