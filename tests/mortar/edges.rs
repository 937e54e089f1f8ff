//! What stands at the ends of surfaces, on supports, and between three bodies; what is refused.

use crate::mortar::blocks::{
    of_one_material, off_uniform, stacked, supported, symmetric, touching,
};
use crate::mortar::sheet::Sheet;
use crate::support::build::Build;
use crate::support::random::Random;
use crate::support::{either, run_built, run_text, run_with_model};
use brinell::mesh::Shape;
use brinell::model::{Model, ModelBuilder};
use brinell::scene::{Direction, History, Kind, SlaveSide};

/// A punch from 0 to `WIDTH` on a block from 0 to 2 with edges of 0.4.
const WIDTH: f64 = 1.56;

fn punch(shape: Shape, width: f64, slave: SlaveSide) -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::PlaneStress);
    for (name, wide, up, cells) in [("lower", 2.0, 0.0, [5, 2]), ("upper", width, 1.0, [4, 2])] {
        let sheet = Sheet {
            name,
            cells,
            shape,
            map: &|[x, y]| [wide * x, y + up],
        };
        sheet.add(&mut builder);
    }
    of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
    supported(&mut builder, slave);
    symmetric(&mut builder);
    builder.press("upper.top", 25.0);
    builder
}

/// Forces of a pressure on the part of an edge beyond `from`, on its two or three nodes.
fn forces(ends: [f64; 2], quadratic: bool, from: f64, pressure: f64) -> Vec<f64> {
    let (a, b) = (from.clamp(ends[0], ends[1]), ends[1]);
    let mut out = vec![0.0; if quadratic { 3 } else { 2 }];
    // Gauss' rule of degree 3.
    for side in [-1.0, 1.0] {
        let x = 0.5 * (a + b) + 0.5 * (b - a) * side / 3f64.sqrt();
        let t = 2.0 * (x - ends[0]) / (ends[1] - ends[0]) - 1.0;
        let values = match quadratic {
            true => vec![0.5 * t * (t - 1.0), 0.5 * t * (t + 1.0), 1.0 - t * t],
            false => vec![0.5 * (1.0 - t), 0.5 * (1.0 + t)],
        };
        for (force, value) in out.iter_mut().zip(values) {
            *force -= 0.5 * (b - a) * pressure * value;
        }
    }
    out
}

/// One state in both bodies, whichever of them has the slaves.
pub fn taylor(shape: Shape, slave: SlaveSide) {
    let mut builder = punch(shape, WIDTH, slave);
    let mut nodes = builder.set_nodes("lower.top");
    nodes.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    let quadratic = shape.is_quadratic();
    let step = if quadratic { 2 } else { 1 };
    let (mut on, mut pushed) = (Vec::new(), Vec::new());
    for k in (0..nodes.len() - 1).step_by(step) {
        let mut edge = vec![nodes[k], nodes[k + step]];
        edge.extend(quadratic.then(|| nodes[k + 1]));
        let ends = [edge[0].1[0], edge[1].1[0]];
        for (node, force) in edge.iter().zip(forces(ends, quadratic, WIDTH, 25.0)) {
            on.push(node.0);
            pushed.push([0.0, force, 0.0]);
        }
    }
    builder
        .nodal_load("beside", &on, &pushed, History::Proportional)
        .unwrap();
    let results = run_built(&builder);
    let off = off_uniform(&results.states[0], 25.0, 1, 4);
    assert!(off < 1e-10, "{shape:?} {slave:?}: {off:.1e}");
}

/// The force is passed on whole, whatever part of an edge is covered.
#[test]
fn partly_covered_edges() {
    for shape in Shape::PLANE {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            for width in [1.2 + 1e-9, 1.21, 1.3, 1.4, 1.599] {
                let results = run_built(&punch(shape, width, slave));
                let force: f64 = results.states[0].pairs.iter().map(|p| p.force).sum();
                let off = (force / (25.0 * width) - 1.0).abs();
                assert!(off < 1e-10, "{shape:?} {slave:?} {width}: {off:.1e}");
                // The ends of the punch press most.
                let inner = results.states[0]
                    .pairs
                    .iter()
                    .filter(|p| p.position[0] < 0.7 * width);
                for pair in inner {
                    let share = pair.pressure / 25.0;
                    assert!(
                        (0.7..1.2).contains(&share),
                        "{shape:?} {slave:?} {width}: {pair:?}"
                    );
                }
            }
        }
    }
}

/// Three plates whose nodes do not face each other: those of the middle one are slaves below and
/// masters above, or both.
#[test]
fn three_in_a_row() {
    for sides in [
        [SlaveSide::First, SlaveSide::First],
        [SlaveSide::First, SlaveSide::Second],
        [SlaveSide::Second, SlaveSide::First],
        [SlaveSide::Second, SlaveSide::Second],
    ] {
        for modulus in [1000.0, 1e6, 1.0] {
            let mut builder = ModelBuilder::new(Kind::PlaneStress);
            for (k, name) in ["lower", "middle", "upper"].into_iter().enumerate() {
                let sheet = Sheet {
                    name,
                    // One element through the middle: its nodes are on both surfaces' elements.
                    cells: [[4, 2], [5, 1], [7, 2]][k],
                    shape: Shape::Quad4,
                    map: &|[x, y]| [2.0 * x, y + k as f64],
                };
                sheet.add(&mut builder);
            }
            of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
            let other = brinell::scene::Material {
                youngs_modulus: modulus,
                poissons_ratio: 0.3,
                ..Default::default()
            };
            builder.material("other", other).unwrap();
            let body = brinell::scene::Body {
                material: "other".into(),
                ..Default::default()
            };
            builder.body("middle", body).unwrap();
            touching(&mut builder, "middle.bottom", "lower.top", sides[0]);
            touching(&mut builder, "upper.bottom", "middle.top", sides[1]);
            builder.hold("lower.bottom", Direction::Y);
            for body in ["lower", "middle", "upper"] {
                builder.hold(format!("{body}.left"), Direction::X);
            }
            builder.reach(1.0);
            builder.press("upper.top", 10.0);
            let results = run_built(&builder);
            let off = off_uniform(&results.states[0], 10.0, 1, 4);
            assert!(off < 1e-10, "{sides:?} {modulus}: {off:.1e}");
        }
    }
}

/// Digits do not depend on how stiff the bodies are beside each other, as long as rows of a stiff
/// slave are no more than masters of the soft one: else some of its own displacements follow, at a
/// loss of `eps` times the ratio.
#[test]
fn stiffness_ratios() {
    for ratio in [1e-12, 1e-6, 1e-2, 1e2, 1e6, 1e12] {
        for slave in [SlaveSide::First, SlaveSide::Second] {
            let cells = [(Shape::Quad4, [5, 1, 2]), (Shape::Quad8, [3, 1, 2])];
            let mut builder = stacked(Kind::PlaneStress, 1.0, cells[0], cells[1], &|x| x);
            of_one_material(&mut builder, &["lower"], 1000.0, 0.3);
            let other = brinell::scene::Material {
                youngs_modulus: 1000.0 * ratio,
                poissons_ratio: 0.3,
                ..Default::default()
            };
            builder.material("other", other).unwrap();
            let body = brinell::scene::Body {
                material: "other".into(),
                ..Default::default()
            };
            builder.body("upper", body).unwrap();
            supported(&mut builder, slave);
            symmetric(&mut builder);
            builder.press("upper.top", 10.0);
            let results = run_built(&builder);
            let off = off_uniform(&results.states[0], 10.0, 1, 4);
            let more_rows = ratio > 1.0 && slave == SlaveSide::First;
            println!("{ratio:e} {slave:?}: {off:.1e}");
            let loss = if more_rows {
                100.0 * f64::EPSILON * ratio
            } else {
                0.0
            };
            assert!(off < loss.max(1e-10), "{ratio} {slave:?}: {off:.1e}");
        }
    }
}

fn refusal(builder: &ModelBuilder) -> String {
    let error = builder.build().map(|_: Model| ()).unwrap_err();
    assert_eq!(error.kind(), brinell::ErrorKind::Input);
    error.to_string()
}

#[test]
fn a_slave_of_two_contacts_is_named() {
    let cells = [(Shape::Quad4, [5, 1, 2]), (Shape::Quad4, [3, 1, 2])];
    let mut builder = stacked(Kind::PlaneStress, 1.0, cells[0], cells[1], &|x| x);
    of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
    supported(&mut builder, SlaveSide::Second);
    touching(&mut builder, "upper.bottom", "lower.top", SlaveSide::Second);
    builder.press("upper.top", 10.0);
    let why = refusal(&builder);
    assert!(
        why.contains("is the slave of two contacts, 1 and 2"),
        "{why}"
    );
    assert!(why.contains("`slave = \"first\"`"), "{why}");
}

#[test]
fn surfaces_that_do_not_face_each_other_are_named() {
    let cells = [(Shape::Quad4, [5, 1, 2]), (Shape::Quad4, [3, 1, 2])];
    let mut builder = stacked(Kind::PlaneStress, 1.0, cells[0], cells[1], &|x| x);
    of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
    touching(&mut builder, "upper.left", "lower.top", SlaveSide::Auto);
    builder.press("upper.top", 10.0);
    let why = refusal(&builder);
    assert!(why.contains("lies opposite"), "{why}");
}

/// The finer surface has the slaves, unless the scene says which.
#[test]
fn the_finer_surface_has_the_slaves() {
    for (slave, cells, expected) in [
        (SlaveSide::Auto, [5, 3], 6),
        (SlaveSide::Auto, [3, 5], 6),
        (SlaveSide::First, [5, 3], 4),
        (SlaveSide::Second, [5, 3], 6),
        // Nested nodes face each other, their edges do not.
        (SlaveSide::Auto, [3, 6], 7),
        // Kinks between facets more than twice as long would be seen.
        (SlaveSide::Auto, [3, 7], 4),
    ] {
        let of = |n| (Shape::Quad4, [n, 1, 2]);
        let mut builder = stacked(Kind::PlaneStress, 1.0, of(cells[0]), of(cells[1]), &|x| x);
        of_one_material(&mut builder, &["lower", "upper"], 1000.0, 0.3);
        supported(&mut builder, slave);
        builder.press("upper.top", 10.0);
        let model = builder.build().unwrap();
        assert_eq!(model.pairs.len(), expected, "{slave:?} {cells:?}");
        for pair in &model.pairs {
            let sum: f64 = pair.masters.iter().map(|(_, w)| w).sum();
            assert!(
                (sum - 1.0).abs() < 1e-14 && pair.gap.abs() < 1e-14,
                "{pair:?}"
            );
        }
    }
}

/// A block that stands on a larger one of nearly equal elements is the slave, whichever is finer
/// and whatever is first: slaves of the larger one, outside the edge, would touch with some
/// thousandths of their areas, at pressures of many times the mean.
#[test]
fn a_block_on_a_larger_one_has_the_slaves() {
    for seed in 1..=either(8, 60) {
        let random = &mut Random::new(seed);
        let ends = |random: &mut Random| [random.within(0.1, 0.6), random.within(1.4, 1.9)];
        let (x, y) = (ends(random), ends(random));
        let cells = |random: &mut Random, length: f64| {
            format!("{}", (length / random.within(0.26, 0.42)).round())
        };
        let upper = [x, y].map(|[a, b]| cells(random, b - a)).join(", ");
        let lower = [2.0, 2.0].map(|length| cells(random, length)).join(", ");
        let contact =
            random.one_of(&[["upper.bottom", "lower.top"], ["lower.top", "upper.bottom"]]);
        let text = format!(
            r#"
kind = "solid"
[[mesh.parts]]
body = "lower"
brick = {{ x = [0, 2], y = [0, 2], z = [-1, 0], elements = [{lower}, 2] }}
[[mesh.parts]]
body = "upper"
brick = {{ x = {x:?}, y = {y:?}, z = [0, 1], elements = [{upper}, 2] }}
[[contact]]
first = "{}"
second = "{}"
[[support]]
on = "lower.bottom"
fix = ["x", "y", "z"]
[[support]]
on = "upper.top"
fix = ["x", "y"]
[[load]]
on = "upper.top"
displacement = {{ z = -1e-3 }}
[bodies]
lower.material = "m"
upper.material = "m"
[materials.m]
youngs_modulus = 210e3
poissons_ratio = 0.3
[program]
targets = [{{ load_factor = 1.0 }}]
"#,
            contact[0], contact[1]
        );
        let state = &run_text(&text).states[0];
        let within = |at: f64, [a, b]: [f64; 2]| a - 1e-9 <= at && at <= b + 1e-9;
        let outside = state
            .pairs
            .iter()
            .find(|pair| !(within(pair.position[0], x) && within(pair.position[1], y)));
        assert!(outside.is_none(), "{seed}: {outside:?}");
        let mean = state.contact_force / ((x[1] - x[0]) * (y[1] - y[0]));
        // On elements of a third of the width the edge of a punch, where the pressure has no limit,
        // has two to three times the mean at its corners.
        assert!(
            state.max_pressure < 4.0 * mean,
            "{seed}: {} {mean}",
            state.max_pressure
        );
    }
}

/// Fields show pressures between zero and the largest one, also on masters, whose weights may be
/// negative on elements of second order; on the axis, where such elements have no pair, too.
#[test]
fn fields_show_no_pressure_beyond_the_largest() {
    for element in ["quad4", "quad8", "tri6"] {
        let text = format!(
            r#"
kind = "axisymmetric"
[[mesh.parts]]
body = "lower"
element = "{element}"
block = {{ x = [0, 2], y = [-2, 0], elements = [9, 6] }}
[[mesh.parts]]
body = "upper"
element = "{element}"
block = {{ x = [0, 2], y = [0, 2], elements = [12, 6] }}
[materials.m]
youngs_modulus = 210e3
poissons_ratio = 0.3
[bodies]
lower.material = "m"
upper.material = "m"
[[contact]]
first = "upper.bottom"
second = "lower.top"
gap = "r^2 / 100"
[[support]]
on = "lower.bottom"
fix = ["y"]
[[support]]
on = "lower.left"
fix = ["x"]
[[support]]
on = "upper.left"
fix = ["x"]
[[load]]
on = "upper.top"
displacement = {{ y = -0.02 }}
[program]
targets = [{{ load_factor = 1.0 }}]
"#
        );
        let (model, results) = run_with_model(&crate::support::parse(&text));
        let state = &results.states[0];
        let shown = &state.fields.as_ref().unwrap().contact_pressure;
        let most = shown.iter().copied().fold(0.0, f64::max);
        assert!(
            most <= state.max_pressure * (1.0 + 1e-12),
            "{element}: {most}"
        );
        let contact = [0, 1].map(|k| {
            let name = ["upper.bottom", "lower.top"][k];
            let nodes = model.mesh.set_nodes(name).unwrap();
            nodes
                .into_iter()
                .find(|&node| model.mesh.point(node)[0] == 0.0)
                .unwrap()
        });
        // One of them is the slave, whose pressure is that of the pole.
        let at_pole = contact.map(|node| (shown[node] / state.pole_pressure - 1.0).abs());
        assert!(
            at_pole.iter().any(|off| *off <= 1e-12),
            "{element}: {at_pole:?}"
        );
    }
}
