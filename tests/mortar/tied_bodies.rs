//! Tied bodies against closed forms and meshes that match; what cannot be tied.

use crate::mortar::blocks::{of_one_material, touching};
use crate::mortar::sheet::Sheet;
use crate::mortar::tie::{aim, tied};
use crate::support::build::Build;
use crate::support::{parse, run_built, run_with_model};
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::results::State;
use brinell::scene::{Contact, Direction, Kind, SlaveSide, Tie};

/// A tube of two rings that are meshed apart.
fn tube(
    shape: Shape,
    [inner, outer]: [[usize; 2]; 2],
    slave: SlaveSide,
    sides: bool,
) -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::PlaneStrain);
    let half_turn = if sides { 0.5 } else { 2.0 };
    for (name, from, to, cells) in [("inner", 1.0, 2.0, inner), ("outer", 2.0, 4.0, outer)] {
        let sheet = Sheet {
            name,
            cells,
            shape,
            map: &|[r, angle]| {
                let (r, angle) = (
                    from + r * (to - from),
                    half_turn * std::f64::consts::PI * angle,
                );
                [r * angle.cos(), r * angle.sin()]
            },
        };
        sheet.add(&mut builder);
        if sides {
            builder.hold(format!("{name}.bottom"), Direction::Y);
            builder.hold(format!("{name}.top"), Direction::X);
        }
    }
    of_one_material(&mut builder, &["inner", "outer"], 1000.0, 0.3);
    tied(&mut builder, "inner.right", "outer.left", slave);
    builder.press("inner.left", 10.0);
    aim(&mut builder);
    builder
}

/// Lamé: displacement of the bore of a tube from 1 to 4, plane strain.
const BORE: f64 = 1.3 * 10.0 / (1000.0 * (16.0 - 1.0)) * (0.4 + 16.0);

/// Largest error of the displacement of the bore.
fn bore(shape: Shape, n: usize, slave: SlaveSide) -> f64 {
    let builder = tube(shape, [[2 * n, 4 * n], [2 * n, 3 * n]], slave, true);
    let model = builder.build().unwrap();
    let results = run_built(&builder);
    let u = &results.states[0].fields.as_ref().unwrap().displacement;
    let nodes = model.mesh.set_nodes("inner.left").unwrap();
    let errors = nodes.into_iter().map(|node| {
        let [x, y] = model.mesh.in_plane(node);
        let radial = (u[2 * node] * x + u[2 * node + 1] * y) / x.hypot(y);
        (radial / BORE - 1.0).abs()
    });
    errors.fold(0.0, f64::max)
}

/// The order is that of the elements: 2 and more, whichever surface follows.
#[test]
fn displacements_converge_across_a_tie() {
    for (shape, order) in [(Shape::Quad4, 1.8), (Shape::Quad8, 2.8), (Shape::Tri6, 2.7)] {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            let [coarse, fine] = [3, 6].map(|n| bore(shape, n, slave));
            let seen = (coarse / fine).log2();
            println!("{shape:?} {slave:?}: {coarse:.2e} {fine:.2e}, order {seen:.2}");
            assert!(
                seen > order && fine < 0.02,
                "{shape:?} {slave:?}: {coarse:.2e} {fine:.2e} {seen:.2}"
            );
        }
    }
}

/// Facets of two sizes do not lie on one another; the rings still turn together without strain: all
/// three motions of the plane are free, and nothing else.
#[test]
fn a_rigid_motion_stays_one() {
    for shape in [Shape::Quad4, Shape::Quad8] {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            let builder = tube(shape, [[2, 18], [2, 14]], slave, false);
            let model = builder.build().unwrap();
            assert_eq!(model.floating.pins.len(), 3, "{shape:?} {slave:?}");
        }
    }
}

/// Surfaces that do not match, tied, in place of a mesh that goes over from fine to coarse: a bump
/// pressed into a block.
#[test]
fn a_fine_part_in_a_coarse_body() {
    let pressed_into = |is_tied: bool| {
        let mut builder = ModelBuilder::new(Kind::PlaneStrain);
        let sheet =
            |builder: &mut ModelBuilder, name: &str, cells, map: &dyn Fn([f64; 2]) -> [f64; 2]| {
                let shape = Shape::Quad4;
                Sheet {
                    name,
                    cells,
                    shape,
                    map,
                }
                .add(builder);
            };
        sheet(&mut builder, "bump", [24, 8], &|[x, y]| {
            [x, 1.0 - (1.0 - y) * (1.0 - 0.02 * x * x)]
        });
        sheet(&mut builder, "fine", [24, 12], &|[x, y]| [x, y - 1.0]);
        let bodies = ["bump", "fine", "coarse"];
        let coarse = if is_tied { [6, 8] } else { [24, 8] };
        sheet(&mut builder, "coarse", coarse, &|[x, y]| [x, 3.0 * y - 4.0]);
        of_one_material(&mut builder, &bodies, 1000.0, 0.3);
        touching(&mut builder, "bump.bottom", "fine.top", SlaveSide::Auto);
        tied(&mut builder, "fine.bottom", "coarse.top", SlaveSide::Auto);
        for body in bodies {
            builder.hold(format!("{body}.left"), Direction::X);
        }
        builder.hold("coarse.bottom", Direction::Y);
        builder.press("bump.top", 2.0);
        aim(&mut builder);
        let state = run_built(&builder).states.remove(0);
        (state.max_pressure, state.half_width)
    };
    let [(p, b), (exact_p, exact_b)] = [true, false].map(pressed_into);
    let [of_p, of_b] = [p / exact_p - 1.0, b / exact_b - 1.0];
    println!("{p} {exact_p}, {b} {exact_b}");
    assert!(
        of_p.abs() < 0.005 && of_b.abs() < 0.005,
        "{of_p:.4} {of_b:.4}"
    );
}

/// Two blocks `gap` apart, tied.
fn apart(gap: f64) -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::PlaneStress);
    for (name, up, n) in [("lower", 0.0, 3), ("upper", 1.0 + gap, 4)] {
        let sheet = Sheet {
            name,
            cells: [n, 2],
            shape: Shape::Quad4,
            map: &|[x, y]| [x, y + up],
        };
        sheet.add(&mut builder);
    }
    of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
    builder.hold("lower.bottom", Direction::Y);
    builder.hold("lower.left", Direction::X);
    builder.press("upper.top", 1.0);
    aim(&mut builder);
    builder
}

fn refused(builder: &ModelBuilder, expected: &[&str]) {
    let error = builder.build().map(|_| ()).unwrap_err();
    assert_eq!(error.kind(), brinell::ErrorKind::Input);
    for expected in expected {
        assert!(error.to_string().contains(expected), "{error}\n{expected}");
    }
}

fn same(a: &State, b: &State) {
    let [a, b] = [a, b].map(|state| &state.fields.as_ref().unwrap().displacement);
    let size = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < 1e-12 * size, "{a} for {b}");
    }
}

/// A surface that is tied in two parts, which share a node, is tied as the whole is, whichever part
/// comes first.
#[test]
fn a_surface_may_be_tied_in_parts() {
    let whole = {
        let mut builder = apart(0.0);
        tied(&mut builder, "upper.bottom", "lower.top", SlaveSide::First);
        builder
    };
    let whole_model = whole.build().unwrap();
    let facets = &whole_model.mesh.surfaces["upper.bottom"].facets;
    let expected = run_built(&whole).states[0].clone();
    for cut in 1..facets.len() {
        for swapped in [false, true] {
            let mut builder = apart(0.0);
            let mut parts = [&facets[..cut], &facets[cut..]];
            if swapped {
                parts.reverse();
            }
            for (part, name) in parts.into_iter().zip(["one", "other"]) {
                let facets = part.iter().map(|facet| (facet.element, facet.local));
                builder.surface(name, facets).unwrap();
                tied(&mut builder, name, "lower.top", SlaveSide::First);
            }
            same(&run_built(&builder).states[0], &expected);
        }
    }
}

/// A block in the corner of an L, tied to both of its sides, whose meshes do not match: a uniform
/// stress of two different tractions on the sides passes exactly.
#[test]
fn a_tie_around_a_corner_passes_a_uniform_stress() {
    let text = r#"
kind = "plane_strain"
mesh.parts = [
    { body = "floor", element = "quad4",
        block = { x = [0.0, 3.0], y = [0.0, 1.0], elements = [5, 2] } },
    { body = "wall", element = "quad4",
        block = { x = [-1.0, 0.0], y = [1.0, 3.0], elements = [1, 3] } },
    { body = "block", element = "quad4",
        block = { x = [0.0, 3.0], y = [1.0, 3.0], elements = [3, 2] } },
]
tie = [
    { first = "block.bottom", second = "floor.top", slave = "first" },
    { first = "block.left", second = "wall.right", slave = "first" },
]
support = [{ on = "floor.bottom", fix = ["y"] }, { on = "wall.left", fix = ["x"] }]
# The strains of the block between the origin of the displacements and these sides.
load = [{ on = "wall.bottom", displacement = { y = -0.002 } },
    { on = "floor.left", displacement = { x = -0.005 } },
    { on = "block.right", pressure = 5.0 }, { on = "floor.right", pressure = 5.0 },
    { on = "block.top", pressure = 2.0 }, { on = "wall.top", pressure = 2.0 }]
[materials.steel]
youngs_modulus = 1000.0
poissons_ratio = 0.0
[bodies.floor]
material = "steel"
[bodies.wall]
material = "steel"
[bodies.block]
material = "steel"
[program]
targets = [{ load_factor = 1.0 }]
"#;
    let (model, results) = run_with_model(&parse(text));
    let fields = results.states[0].fields.as_ref().unwrap();
    let of_block = (0..model.mesh.n_elements()).filter(|&e| model.mesh.element_body[e] == 2);
    for e in of_block {
        let [xx, yy, _, xy] = [0, 1, 2, 3].map(|k| fields.stress[4 * e + k]);
        for (found, exact) in [(xx, -5.0), (yy, -2.0), (xy, 0.0)] {
            assert!((found - exact).abs() < 1e-10, "{e}: {found} for {exact}");
        }
    }
}

/// A surface that is tied on one part and touches on the rest: the contact ends at the tie, which
/// is no end beyond which the bodies could touch. A uniform pressure goes through both.
#[test]
fn a_contact_ends_at_a_tie() {
    let mut whole = apart(0.0);
    tied(&mut whole, "upper.bottom", "lower.top", SlaveSide::First);
    let mesh = whole.build().unwrap().mesh.clone();
    let facets = &mesh.surfaces["upper.bottom"].facets;
    for (cut, slave) in (1..facets.len()).flat_map(|cut| {
        [SlaveSide::First, SlaveSide::Second, SlaveSide::Auto].map(|slave| (cut, slave))
    }) {
        let mut builder = apart(0.0);
        for (name, part) in [("tied", &facets[..cut]), ("touching", &facets[cut..])] {
            let part = part.iter().map(|facet| (facet.element, facet.local));
            builder.surface(name, part).unwrap();
        }
        tied(&mut builder, "tied", "lower.top", SlaveSide::First);
        touching(&mut builder, "lower.top", "touching", slave);
        let results = run_built(&builder);
        let u = &results.states[0].fields.as_ref().unwrap().displacement;
        for node in mesh.set_nodes("upper.top").unwrap() {
            let down = u[2 * node + 1];
            assert!((down + 2e-3).abs() < 1e-11, "{cut}: {down}");
        }
    }
}

/// Only the chosen nodes touch, on surfaces that do not match: the whole load goes through them.
#[test]
fn only_some_nodes_touch() {
    let chosen = |nodes: &[usize], slave: SlaveSide| {
        let mut builder = apart(0.0);
        // What the supports of the lower body hold sideways is held here.
        builder.hold("upper.left", Direction::X);
        builder.node_set("chosen", nodes).unwrap();
        builder.contact(Contact {
            first: "lower.top".into(),
            second: "upper.bottom".into(),
            slave,
            nodes: Some("chosen".into()),
            ..Contact::default()
        });
        builder
    };
    let bottom: Vec<usize> = (apart(0.0).set_nodes("upper.bottom").iter())
        .map(|(node, _)| *node)
        .collect();
    assert_eq!(bottom.len(), 5);
    for nodes in [&bottom[2..3], &bottom[1..4], &[bottom[0], bottom[4]][..]] {
        let builder = chosen(nodes, SlaveSide::Auto);
        let model = builder.build().unwrap();
        let slaves: Vec<usize> = model.pairs.iter().map(|pair| pair.slave).collect();
        assert_eq!(slaves.len(), nodes.len());
        assert!(slaves.iter().all(|node| nodes.contains(node)));
        let force = run_built(&builder).states[0].contact_force;
        assert!((force - 1.0).abs() < 1e-12, "{force}");
    }
    refused(
        &chosen(&bottom[2..3], SlaveSide::First),
        &["is not on `lower.top`"],
    );
    refused(
        &chosen(&[0], SlaveSide::Auto),
        &["nodes = \"chosen\"", "node 0"],
    );
}

/// Nodes that nothing pushes and nothing holds bear no force, also where one surface follows the
/// other: what it would bear is handed on, not written twice.
#[test]
fn the_forces_of_a_tie_are_in_balance() {
    for slave in [SlaveSide::First, SlaveSide::Second] {
        let mut builder = apart(0.0);
        tied(&mut builder, "upper.bottom", "lower.top", slave);
        let model = builder.build().unwrap();
        let results = run_built(&builder);
        let force = &results.states[0].fields.as_ref().unwrap().force;
        let size = |node: usize| force[2 * node].hypot(force[2 * node + 1]);
        let largest = (0..model.mesh.n_nodes()).map(size).fold(0.0, f64::max);
        assert!(largest > 0.1);
        for set in ["upper.bottom", "lower.top"] {
            for node in model.mesh.set_nodes(set).unwrap() {
                let is_held = model.mesh.in_plane(node)[0] == 0.0;
                assert!(
                    is_held || size(node) < 1e-9 * largest,
                    "{set} {slave:?}: {}",
                    size(node)
                );
            }
        }
    }
}

#[test]
fn what_cannot_be_tied_is_named() {
    let tie = |builder: &mut ModelBuilder, slave| {
        tied(builder, "upper.bottom", "lower.top", slave);
    };
    let mut far = apart(0.1);
    tie(&mut far, SlaveSide::First);
    refused(
        &far,
        &[
            "5 of 5 nodes of `upper.bottom` are farther from `lower.top` than",
            "by 1.000e-1",
        ],
    );
    let mut into = apart(-0.1);
    tie(&mut into, SlaveSide::First);
    refused(
        &into,
        &["are farther from `lower.top` than", "by -1.000e-1"],
    );
    // It is the user's to say so; the nodes are moved.
    let mut said = apart(0.1);
    said.tie(Tie {
        first: "upper.bottom".into(),
        second: "lower.top".into(),
        slave: SlaveSide::First,
        distance: Some(0.2),
    });
    let model = said.build().unwrap();
    for node in model.mesh.set_nodes("upper.bottom").unwrap() {
        assert!((model.mesh.point(node)[1] - 1.0).abs() < 1e-14);
    }
    // Said twice is said once.
    let mut said_once = apart(0.0);
    tie(&mut said_once, SlaveSide::First);
    let mut twice = apart(0.0);
    tie(&mut twice, SlaveSide::First);
    tie(&mut twice, SlaveSide::First);
    let [once, twice] = [&said_once, &twice].map(|builder| run_built(builder).states[0].clone());
    same(&once, &twice);
    let mut circle = apart(0.0);
    tie(&mut circle, SlaveSide::First);
    tie(&mut circle, SlaveSide::Second);
    refused(&circle, &["go in a circle"]);
    let mut touched = apart(0.0);
    tie(&mut touched, SlaveSide::First);
    touching(&mut touched, "lower.top", "upper.bottom", SlaveSide::Auto);
    refused(
        &touched,
        &["contact 1", "surfaces that are tied cannot touch"],
    );
    let mut elsewhere = apart(0.0);
    tied(&mut elsewhere, "upper.right", "lower.top", SlaveSide::Auto);
    refused(&elsewhere, &["no part of"]);
    let mut unknown = apart(0.0);
    tied(&mut unknown, "upper.botom", "lower.top", SlaveSide::Auto);
    refused(
        &unknown,
        &["tie 1 surface `upper.botom`", "did you mean `upper.bottom`"],
    );
    let mut itself = apart(0.0);
    tied(&mut itself, "lower.top", "lower.top", SlaveSide::Auto);
    refused(&itself, &["cannot be tied to itself"]);
    // Nothing would hold the upper block by what is held already.
    let mut all_held = apart(0.0);
    all_held.hold("lower.top", Direction::Y);
    tie(&mut all_held, SlaveSide::Second);
    refused(
        &all_held,
        &["are held along (0, 1)", "make the other surface the slave"],
    );
    let mut other = apart(0.0);
    other.hold("lower.top", Direction::Y);
    tie(&mut other, SlaveSide::First);
    assert!(other.build().is_ok());
}
