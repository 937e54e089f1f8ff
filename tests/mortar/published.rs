//! Published cases by name.

use crate::mortar::blocks::{of_one_material, stacked, supported, symmetric};
use crate::support::build::Build;
use crate::support::run_built;
use brinell::mesh::Shape;
use brinell::scene::{Displacement, Kind, Load, SlaveSide};

/// code_aster SSNP121 (N. El-Abbasi, K.-J. Bathe, Comput. Struct. 79 (2001) 1473): two blocks,
/// E = 2e6, nu = 0, of height 2 together, pressed by 0.1: 1e5 everywhere, the interface moves 0.05.
#[test]
fn ssnp121_contact_patch() {
    let plane: &[(Shape, [usize; 3], Shape, [usize; 3])] = &[
        (Shape::Quad4, [4, 1, 2], Shape::Quad4, [5, 1, 2]),
        (Shape::Quad8, [4, 1, 2], Shape::Quad8, [5, 1, 2]),
        (Shape::Quad4, [4, 1, 2], Shape::Quad8, [3, 1, 2]),
        (Shape::Tri6, [2, 1, 2], Shape::Quad8, [3, 1, 2]),
        (Shape::Tri3, [2, 1, 2], Shape::Tri6, [3, 1, 2]),
    ];
    let solid: &[(Shape, [usize; 3], Shape, [usize; 3])] = &[
        (Shape::Hex8, [5, 5, 1], Shape::Hex20, [4, 4, 1]),
        (Shape::Hex20, [3, 3, 1], Shape::Hex20, [2, 2, 1]),
        (Shape::Tet10, [2, 2, 1], Shape::Hex20, [3, 3, 1]),
        (Shape::Tet4, [2, 2, 1], Shape::Hex8, [3, 3, 1]),
    ];
    let cases = plane.iter().map(|case| (Kind::PlaneStrain, case));
    for (kind, &(lower, m, upper, n)) in cases.chain(solid.iter().map(|case| (Kind::Solid, case))) {
        let mut builder = stacked(kind, 1.0, (lower, m), (upper, n), &|x| x);
        of_one_material(&mut builder, &["lower", "upper"], 2e6, 0.0);
        supported(&mut builder, SlaveSide::Auto);
        symmetric(&mut builder);
        let solid = kind == Kind::Solid;
        builder.load(Load {
            on: if solid { "upper.z1" } else { "upper.top" }.into(),
            displacement: Some(Displacement {
                y: (!solid).then_some((-0.1).into()),
                z: solid.then_some((-0.1).into()),
                ..Displacement::default()
            }),
            ..Load::default()
        });
        let model = builder.build().unwrap();
        let results = run_built(&builder);
        let state = &results.states[0];
        let u = &state.fields.as_ref().unwrap().displacement;
        let d = model.mesh.dimension;
        for (pair, row) in state.pairs.iter().zip(&model.pairs) {
            let off = (pair.pressure / 1e5 - 1.0).abs();
            assert!(off < 1e-10, "{lower:?} {upper:?}: {pair:?}");
            let moved = u[d * row.slave + d - 1];
            assert!((moved + 0.05).abs() < 1e-11, "{lower:?} {upper:?}: {moved}");
        }
    }
}

/// The unit cube, E = 900, nu = 0.25, under a traction of 100, in two parts: the corner moves by
/// (1/36, 1/36, -1/9).
#[test]
fn divided_cube() {
    for shapes in [
        [Shape::Hex8, Shape::Hex8],
        [Shape::Hex20, Shape::Tet10],
        [Shape::Tet10, Shape::Hex8],
    ] {
        let [lower, upper] = [(shapes[0], [3, 3, 1]), (shapes[1], [2, 2, 1])];
        let mut builder = stacked(Kind::Solid, 0.5, lower, upper, &|x| x);
        of_one_material(&mut builder, &["lower", "upper"], 900.0, 0.25);
        supported(&mut builder, SlaveSide::Auto);
        symmetric(&mut builder);
        builder.press("upper.z1", 100.0);
        let model = builder.build().unwrap();
        let results = run_built(&builder);
        let u = &results.states[0].fields.as_ref().unwrap().displacement;
        let corner = (0..model.mesh.n_nodes())
            .find(|&n| model.mesh.point(n) == [1.0; 3])
            .unwrap();
        let exact = [1.0 / 36.0, 1.0 / 36.0, -1.0 / 9.0];
        for (u, exact) in u[3 * corner..].iter().zip(exact) {
            assert!((u - exact).abs() < 1e-12, "{shapes:?}: {u} {exact}");
        }
    }
}

/// code_aster SSNP170, after R. L. Taylor and P. Papadopoulos (1991): a punch on a wider block; the
/// pressure of 25 acts on the punch and on the block beside it, so that one state fills both. The
/// punch ends within an edge of the block.
#[test]
fn ssnp170_taylor_patch() {
    for shape in [Shape::Quad4, Shape::Quad8] {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            crate::mortar::edges::taylor(shape, slave);
        }
    }
}
