//! A square punch, elastic and at its limit load.

use crate::support::build::{Build, elastic};
use crate::support::grid::{Grid, Point};
use crate::support::run_built;
use brinell::analytical::contact_modulus;
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::scene::{Contact, Direction, Displacement, Kind, Load, Material, PlaneForce, Target};

/// Even elements out to 1, then so many more that each is longer than the one before by the same
/// ratio, out to `extent`.
fn graded(t: f64, fine: usize, more: usize, extent: f64) -> f64 {
    let h = 1.0 / fine as f64;
    let k = t * (fine + more) as f64;
    if k <= fine as f64 {
        return k * h;
    }
    let sum = |q: f64, n: f64| h * q * (q.powf(n) - 1.0) / (q - 1.0);
    let (mut low, mut high) = (1.0 + 1e-9, 10.0);
    for _ in 0..100 {
        let q = 0.5 * (low + high);
        if 1.0 + sum(q, more as f64) < extent {
            low = q
        } else {
            high = q
        }
    }
    1.0 + sum(low, k - fine as f64)
}

/// A quarter of a block, and on it that of a stiff smooth punch 2 by 2.
fn punch(fine: usize, more: usize, extent: f64, block: Material) -> ModelBuilder {
    let g = move |t: f64| graded(t, fine, more, extent);
    let below = move |[x, y, z]: Point| [g(x), g(y), -g(1.0 - z)];
    let mut builder = ModelBuilder::new(Kind::Solid);
    builder.symmetry(4);
    let stiff = elastic(1e5 * block.youngs_modulus, 0.3);
    for (name, cells, map, material) in [
        (
            "block",
            [fine + more; 3],
            &below as &dyn Fn(Point) -> Point,
            block,
        ),
        ("punch", [fine, fine, 1], &|x| x, stiff),
    ] {
        let grid = Grid {
            name,
            cells,
            shape: Shape::Hex8,
            map,
        };
        grid.add(&mut builder);
        builder.material(name, material).unwrap();
        builder.of(name, name);
        for (side, direction) in [("x0", Direction::X), ("y0", Direction::Y)] {
            builder.hold(format!("{name}.{side}"), direction);
        }
    }
    builder.hold("block.z0", Direction::Z);
    builder.contact(Contact {
        first: "punch.z0".into(),
        second: "block.z1".into(),
        ..Contact::default()
    });
    builder
}

/// A rigid smooth square of side 2 a on a half space sinks in by `P / (2 a E* 2 beta/sqrt(pi))`
/// with beta = 1.012 (R. B. King, Int. J. Solids Struct. 23 (1987) 1657-1664, table 1).
#[test]
fn a_square_punch_sinks_in_as_king_has_it() {
    let elastic = elastic(1000.0, 0.3);
    // The punch's side is rigid.
    let modulus = contact_modulus(1000.0, 0.3, 1e12, 0.3);
    let stiffness = |fine: usize, extent: f64| {
        let mut builder = punch(fine, 3 * fine, extent, elastic.clone());
        builder.load(Load {
            on: "punch.z1".into(),
            plane_force: Some(PlaneForce {
                direction: Direction::Z,
                total: -4.0,
            }),
            ..Load::default()
        });
        let state = &run_built(&builder).states[0];
        4.0 / state.approach / (2.0 * modulus)
    };
    let exact = 1.012 * 2.0 / std::f64::consts::PI.sqrt();
    // The block's end is felt as its distance, the jump at the edge as h: both to first order.
    let [a, b, c] = [(3, 40.0), (6, 40.0), (6, 80.0)].map(|(n, l)| 1.0 / stiffness(n, l));
    let found = 1.0 / (b + (b - a) + 2.0 * (c - b));
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

/// R. T. Shield and D. C. Drucker, J. Appl. Mech. 20 (1953) 453-460: a smooth square punch on
/// Tresca's material needs 5 k to 5.71 k. Tresca's hexagon with k = Y/2 lies within von Mises'
/// ellipse, that with k = Y/sqrt(3) round it: 2.5 Y to 3.297 Y.
#[test]
fn the_limit_load_of_a_square_punch_lies_between_its_bounds() {
    let limit = |n: usize| {
        let metal = Material {
            youngs_modulus: 1000.0,
            poissons_ratio: 0.3,
            yield_stress: Some(1.0),
            ..Material::default()
        };
        let mut builder = punch(n, n + 2, 3.0, metal);
        builder.load(Load {
            on: "punch.z1".into(),
            displacement: Some(Displacement {
                z: Some((-0.08).into()),
                ..Displacement::default()
            }),
            ..Load::default()
        });
        for load_factor in [0.5, 1.0] {
            builder.target(Target {
                load_factor: Some(load_factor),
                ..Target::default()
            });
        }
        let results = run_built(&builder);
        let [half, whole] = [0, 1].map(|k| results.states[k].contact_force / 4.0);
        // Collapsed: the second half of the way adds next to nothing.
        assert!(whole < 1.02 * half, "{n}: {half} {whole}");
        whole
    };
    // From above, of order h: the jump of pressure at the edge takes one element.
    let (coarse, fine) = (limit(2), limit(4));
    let extrapolated = 2.0 * fine - coarse;
    assert!(fine < coarse, "{coarse} {fine}");
    assert!(
        2.5 < extrapolated && extrapolated < 5.71 / 3f64.sqrt(),
        "{coarse} {fine} {extrapolated}"
    );
}
