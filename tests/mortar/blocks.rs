//! Two blocks of one material on one another.

use crate::mortar::sheet::Sheet;
use crate::support::build::{Build, elastic};
use crate::support::grid::{Grid, Point};
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::results::State;
use brinell::scene::{Contact, Direction, Kind, SlaveSide};

/// A body's elements: shape and cells.
pub type Cells = (Shape, [usize; 3]);

/// Gives both bodies one material.
pub fn of_one_material(builder: &mut ModelBuilder, bodies: &[&str], modulus: f64, ratio: f64) {
    let material = elastic(modulus, ratio);
    builder.material("steel", material).unwrap();
    for name in bodies {
        builder.of(name, "steel");
    }
}

pub fn touching(builder: &mut ModelBuilder, first: &str, second: &str, slave: SlaveSide) {
    builder.contact(Contact {
        first: first.into(),
        second: second.into(),
        slave,
        ..Contact::default()
    });
}

/// `upper` on `lower`, each a unit square or cube times a `height`.
pub fn stacked(
    kind: Kind,
    height: f64,
    lower: Cells,
    upper: Cells,
    map: &dyn Fn(Point) -> Point,
) -> ModelBuilder {
    let mut builder = ModelBuilder::new(kind);
    let solid = kind == Kind::Solid;
    for (name, (shape, cells), up) in [("lower", lower, 0.0), ("upper", upper, 1.0)] {
        if solid {
            let map = |x: Point| {
                let [a, b, c] = map(x);
                [a, b, height * (c + up)]
            };
            let map = halfway(shape, cells, &map);
            let grid = Grid {
                name,
                cells,
                shape,
                map: &map,
            };
            grid.add(&mut builder);
        } else {
            let sheet = Sheet {
                name,
                cells: [cells[0], cells[2]],
                shape,
                map: &|[x, y]| {
                    let [a, _, c] = map([x, 0.0, y]);
                    [a, height * (c + up)]
                },
            };
            sheet.add(&mut builder);
        }
    }
    builder
}

/// What is the same for all stacks: contact, supports, a load factor of 1.
pub fn supported(builder: &mut ModelBuilder, slave: SlaveSide) {
    let solid = builder.dimension() == 3;
    let names = match solid {
        true => ["upper.z0", "lower.z1", "lower.z0"],
        false => ["upper.bottom", "lower.top", "lower.bottom"],
    };
    touching(builder, names[0], names[1], slave);
    let axis = if solid { Direction::Z } else { Direction::Y };
    builder.hold(names[2], axis);
    builder.reach(1.0);
}

/// The sides of both bodies at x = 0 (and y = 0) are planes of symmetry.
pub fn symmetric(builder: &mut ModelBuilder) {
    for body in ["lower", "upper"] {
        if builder.dimension() == 3 {
            builder.hold(format!("{body}.x0"), Direction::X);
            builder.hold(format!("{body}.y0"), Direction::Y);
        } else {
            builder.hold(format!("{body}.left"), Direction::X);
        }
    }
}

/// Middles of edges halfway between their ends.
fn halfway<'a>(
    shape: Shape,
    cells: [usize; 3],
    map: &'a dyn Fn(Point) -> Point,
) -> impl Fn(Point) -> Point + 'a {
    move |x: Point| {
        if !shape.is_quadratic() {
            return map(x);
        }
        let (mut low, mut high) = (x, x);
        for d in 0..3 {
            let at = x[d] * cells[d] as f64;
            if (at - at.round()).abs() > 1e-9 {
                (low[d], high[d]) = (at.floor() / cells[d] as f64, at.ceil() / cells[d] as f64);
            }
        }
        let (a, b) = (map(low), map(high));
        [0, 1, 2].map(|d| 0.5 * (a[d] + b[d]))
    }
}

/// Largest deviation from a uniform state: of pressures, as a share; of stresses, as a share of the
/// pressure. All pairs are closed.
pub fn off_uniform(state: &State, pressure: f64, along: usize, components: usize) -> f64 {
    let pairs = state
        .pairs
        .iter()
        .map(|pair| pair.pressure / pressure - 1.0);
    let fields = state.fields.as_ref().unwrap();
    let stresses = fields.stress.chunks_exact(components).flat_map(|stress| {
        let exact = |k: usize| if k == along { -pressure } else { 0.0 };
        let off: Vec<f64> = (0..components)
            .map(|k| (stress[k] - exact(k)) / pressure)
            .collect();
        off
    });
    pairs
        .chain(stresses)
        .fold(0.0, |most: f64, off| most.max(off.abs()))
}
