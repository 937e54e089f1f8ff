//! Hard cases in three dimensions.

use crate::support::build::{Build, elastic};
use crate::support::grid::{Grid, Point};
use crate::support::{close, healthy, largest, parse, run, run_built};
use brinell::mesh::Shape;
use brinell::model::{ModelBuilder, NodePair};
use brinell::results::Status;
use brinell::scene::{Contact, Direction, Displacement, Kind, Load, Material, PlaneForce, Target};

/// Quarter models of boxes one on top of the other, `[0, 1]^2` wide: name, material,
/// height of the lower side.
fn stack(bodies: &[(&str, Material, f64)], shape: Shape, cells: [usize; 3]) -> ModelBuilder {
    let mut builder = ModelBuilder::new(Kind::Solid);
    builder.symmetry(4);
    for (name, material, low) in bodies {
        let (name, low) = (*name, *low);
        let map = move |[x, y, z]: Point| [x, y, low + z];
        let grid = Grid {
            name,
            cells,
            shape,
            map: &map,
        };
        grid.add(&mut builder);
        builder.material(name, material.clone()).unwrap();
        builder.of(name, name);
        for (side, direction) in [("x0", Direction::X), ("y0", Direction::Y)] {
            builder.hold(format!("{name}.{side}"), direction);
        }
    }
    let base = bodies[0].0;
    builder.hold(format!("{base}.z0"), Direction::Z);
    builder
}

fn pressed(builder: &mut ModelBuilder, on: &str, total: f64) {
    builder.load(Load {
        on: on.into(),
        plane_force: Some(PlaneForce {
            direction: Direction::Z,
            total: -total,
        }),
        ..Load::default()
    });
}

/// The pairs between two boxes by place, with the gaps of a surface of radius `radius`.
fn curved(builder: &mut ModelBuilder, first: &str, second: &str, radius: f64) {
    curved_off(builder, first, second, radius, 0.0);
}

/// The same with a gap at the pole.
fn curved_off(builder: &mut ModelBuilder, first: &str, second: &str, radius: f64, gap: f64) {
    let firsts = builder.set_nodes(&format!("{first}.z0"));
    let pairs: Vec<NodePair> = (builder.set_nodes(&format!("{second}.z1")).iter())
        .map(|(node, at)| {
            let same = |x: &&(usize, Point)| x.1[0] == at[0] && x.1[1] == at[1];
            NodePair {
                first: firsts.iter().find(same).unwrap().0,
                second: *node,
                normal: Some([0.0, 0.0, 1.0]),
                gap: Some(gap + (at[0] * at[0] + at[1] * at[1]) / (2.0 * radius)),
            }
        })
        .collect();
    let contact = Contact {
        first: format!("{first}.z0"),
        second: format!("{second}.z1"),
        ..Contact::default()
    };
    builder.contact_pairs(contact, &pairs).unwrap();
}

/// A ball between two flats, held by nothing but contact on both sides, as soft as they are, and
/// 1e8 times as stiff or soft: both contacts carry the whole force, and with like flats the same
/// pressures.
#[test]
fn a_floating_ball_between_two_flats() {
    for ratio in [1.0, 1e8, 1e-8] {
        let bodies = [
            ("flat", elastic(1000.0, 0.3), 0.0),
            ("ball", elastic(1000.0 * ratio, 0.3), 1.0),
            ("lid", elastic(1000.0, 0.3), 2.0),
        ];
        let mut builder = stack(&bodies, Shape::Hex8, [6, 6, 4]);
        curved(&mut builder, "ball", "flat", 20.0);
        curved(&mut builder, "lid", "ball", 20.0);
        // The compliance of the softest body decides how far the contact spreads.
        let force = 4.0 * f64::min(1.0, ratio);
        pressed(&mut builder, "lid.z1", force);
        let results = run_built(&builder);
        healthy(&results);
        let state = &results.states[0];
        for contact in 0..2 {
            let of_contact = state.pairs.iter().filter(|p| p.contact == contact);
            let sum: f64 = of_contact.clone().map(|p| 4.0 * p.force).sum();
            close("force", sum, force, force, 1e-9);
            let open = of_contact.filter(|p| p.status == Status::Open).count();
            assert!(open > 0, "ratio {ratio}: contact {contact} is closed whole");
        }
        if ratio == 1.0 {
            // Seen from the ball the two flats are mirror images.
            let (one, two) = state.pairs.split_at(state.pairs.len() / 2);
            let scale = largest(state.pairs.iter().map(|p| p.pressure));
            for (p, q) in one.iter().zip(two) {
                close("pressure", q.pressure, p.pressure, scale, 1e-9);
            }
        }
    }
}

/// All pairs closed, under every element: the pressure is uniform, also beside the two planes of
/// symmetry, in slivers of 1 : 1000, and near incompressibility.
#[test]
fn flat_faces_pass_a_uniform_pressure() {
    for (shape, nu, cells) in [
        (Shape::Hex8, 0.3, [3, 3, 3]),
        (Shape::Hex20, 0.4999, [2, 2, 2]),
        (Shape::Tet10, 0.4999, [2, 2, 2]),
        (Shape::Hex8, 0.4999, [3, 3, 3]),
        (Shape::Prism6, 0.3, [3, 3, 3]),
        (Shape::Prism15, 0.3, [2, 2, 2]),
        (Shape::Hex8, 0.3, [1, 1000, 1]),
        (Shape::Hex8, 0.3, [1, 1, 1000]),
    ] {
        let bodies = [
            ("lower", elastic(1000.0, nu), 0.0),
            ("upper", elastic(1000.0, nu), 1.0),
        ];
        let mut builder = stack(&bodies, shape, cells);
        builder.contact(Contact {
            first: "upper.z0".into(),
            second: "lower.z1".into(),
            ..Contact::default()
        });
        builder.press("upper.z1", 10.0);
        let results = run_built(&builder);
        healthy(&results);
        for pair in &results.states[0].pairs {
            assert_eq!(pair.status, Status::Closed);
            close("pressure", pair.pressure, 10.0, 10.0, 1e-7);
        }
    }
}

/// One pair carries a small force. Forces come of what is far larger, the gaps of the others times
/// the contact's stiffness (here 250 per 1, gaps to 0.2): their round-off is some eps of that.
#[test]
fn one_pair_carries_the_force() {
    let round_off = 100.0 * f64::EPSILON * 250.0 * 0.2;
    for force in [1e-6, 1e-3] {
        let mut builder = ball_on_flat(0.0);
        pressed(&mut builder, "ball.z1", force);
        let results = run_built(&builder);
        let state = &results.states[0];
        let closed = state.pairs.iter().filter(|p| p.status == Status::Closed);
        assert_eq!(closed.count(), 1, "{force}");
        assert_eq!(state.pairs[0].status, Status::Closed);
        close("force", state.contact_force, force, 1.0, round_off);
        assert_eq!(state.patches.len(), 1);
    }
}

/// A ball is let down by just its gap, lifted, let down again, pressed and let go: it grazes in its
/// pole without force, and the way back is the way there.
#[test]
fn a_ball_grazes_without_force() {
    let gap = 0.25;
    let mut builder = ball_on_flat(gap);
    builder.load(Load {
        on: "ball.z1".into(),
        displacement: Some(Displacement {
            z: Some((-gap).into()),
            ..Displacement::default()
        }),
        ..Load::default()
    });
    for load_factor in [1.0, 0.5, 1.0, 1.04, 1.0, 0.0] {
        builder.target(Target {
            load_factor: Some(load_factor),
            ..Target::default()
        });
    }
    let results = run_built(&builder);
    healthy(&results);
    let [graze, away, again, pressed, back, start] = &results.states[..] else {
        panic!("{} states", results.states.len());
    };
    assert!(pressed.contact_force > 1.0, "{pressed:?}");
    for state in [graze, again, back] {
        close(
            "force",
            state.contact_force,
            0.0,
            pressed.contact_force,
            1e-9,
        );
        close("gap", state.pairs[0].gap, 0.0, gap, 1e-12);
        assert!(state.pairs[1..].iter().all(|p| p.gap > 0.0), "{state:?}");
    }
    for (state, height) in [(away, 0.5 * gap), (start, gap)] {
        close("gap", state.pairs[0].gap, height, gap, 1e-12);
        assert_eq!(state.contact_force, 0.0);
    }
    // Each pair that closed on the way down opens on the way up.
    assert_eq!(results.counts.contact_changes % 2, 0);
}

/// A ball of radius 5 over a flat, so far off it.
fn ball_on_flat(gap: f64) -> ModelBuilder {
    let bodies = [
        ("flat", elastic(1000.0, 0.3), 0.0),
        ("ball", elastic(1000.0, 0.3), 1.0),
    ];
    let mut builder = stack(&bodies, Shape::Hex8, [4, 4, 2]);
    curved_off(&mut builder, "ball", "flat", 5.0, gap);
    builder
}

/// A ball with interference in a bowl of its own radius: conforming from pole to rim. For a solid
/// sphere of radius a in a shell up to b the pressure is that of the two displacements
/// `p a (1 - 2 nu)/E` inward and `p a ((1 - 2 nu) a^3 + (1 + nu) b^3/2)/(E (b^3 - a^3))` outward,
/// all over.
#[test]
fn a_ball_in_a_bowl_of_its_own_radius() {
    let (e, nu, fit) = (1000.0, 0.3, 0.01f64);
    let (a, b) = (1.0f64, 2.0f64);
    let inward = (1.0 - 2.0 * nu) / e;
    let shell = b.powi(3) - a.powi(3);
    let outward = ((1.0 - 2.0 * nu) * a.powi(3) + 0.5 * (1.0 + nu) * b.powi(3)) / (e * shell);
    let exact = fit / (a * (inward + outward));
    let mut off = Vec::new();
    for n in [4, 8] {
        let text = format!(
            r#"
kind = "solid"
symmetry = 8
support = [
    {{ on = "ball.start", fix = ["y"] }}, {{ on = "ball.front", fix = ["z"] }},
    {{ on = "ball.back", fix = ["x"] }},
    {{ on = "bowl.start", fix = ["y"] }}, {{ on = "bowl.front", fix = ["z"] }},
    {{ on = "bowl.back", fix = ["x"] }},
]
contact = [{{ first = "ball.outer", second = "bowl.inner", interference = {fit} }}]
[mesh]
revolve = {{ angle = 90, elements = {n} }}
parts = [
    {{ body = "ball", disc = {{ radius = {a}, elements = {n} }} }},
    {{ body = "bowl", ring = {{ radius = [{a}, {b}], elements = [{n}, {n}] }} }},
]
[materials.m]
youngs_modulus = {e}
poissons_ratio = {nu}
[bodies]
ball = {{ material = "m" }}
bowl = {{ material = "m" }}
[program]
targets = [{{ name = "fitted", load_factor = 0.0 }}]
"#
        );
        let results = run(&parse(&text));
        healthy(&results);
        let pairs = &results.states[0].pairs;
        assert!(pairs.iter().all(|p| p.status == Status::Closed));
        let area: f64 = pairs.iter().map(|p| p.area).sum();
        let mean = pairs.iter().map(|p| p.force).sum::<f64>() / area;
        off.push((mean / exact - 1.0).abs());
    }
    let order = (off[0] / off[1]).log2();
    assert!(off[1] < 0.02 && order > 1.5, "{off:?} {order}");
}

/// Two blocks between walls across y, free along x, pressed to ten times the strain at yield: one
/// state everywhere, which tends to `2 Y/sqrt(3)`, that of plane strain. Elements that lock carry
/// more, and not alike.
#[test]
fn plastic_flow_near_incompressibility_passes_through_a_contact() {
    let limit = 2.0 / 3f64.sqrt();
    for (shape, cells) in [
        (Shape::Hex8, [3, 3, 3]),
        (Shape::Hex20, [2, 2, 2]),
        (Shape::Tet10, [2, 2, 2]),
        (Shape::Prism15, [2, 2, 2]),
    ] {
        let metal = Material {
            yield_stress: Some(1.0),
            ..elastic(1000.0, 0.4999)
        };
        let bodies = [("lower", metal.clone(), 0.0), ("upper", metal, 1.0)];
        let mut builder = stack(&bodies, shape, cells);
        for body in ["lower", "upper"] {
            builder.hold(format!("{body}.y1"), Direction::Y);
        }
        builder.contact(Contact {
            first: "upper.z0".into(),
            second: "lower.z1".into(),
            ..Contact::default()
        });
        // Both blocks are 2 high.
        builder.load(Load {
            on: "upper.z1".into(),
            displacement: Some(Displacement {
                z: Some((-0.02).into()),
                ..Displacement::default()
            }),
            ..Load::default()
        });
        let results = run_built(&builder);
        healthy(&results);
        let state = &results.states[0];
        assert!(state.plastic_points > 0);
        for pair in &state.pairs {
            assert_eq!(pair.status, Status::Closed, "{shape:?}");
            close("pressure", pair.pressure, limit, limit, 1e-3);
            close("even", pair.pressure, state.pairs[0].pressure, limit, 1e-7);
        }
    }
}

/// The pair on two planes of symmetry has a quarter of the whole's area, those on one plane a
/// half: its pressure is the largest, and falls outward alike along both planes.
#[test]
fn pairs_on_planes_of_symmetry_carry_their_share() {
    let bodies = [
        ("flat", elastic(1000.0, 0.3), 0.0),
        ("ball", elastic(1000.0, 0.3), 1.0),
    ];
    let mut builder = stack(&bodies, Shape::Hex8, [6, 6, 3]);
    curved(&mut builder, "ball", "flat", 20.0);
    pressed(&mut builder, "ball.z1", 4.0);
    let results = run_built(&builder);
    healthy(&results);
    let state = &results.states[0];
    // Pressures fall from the pole outward, whatever the share of a pair in its force.
    let along = |axis: usize| -> Vec<f64> {
        let on_axis = |p: &&brinell::results::PairState| p.position[1 - axis] == 0.0;
        let mut pairs: Vec<_> = state.pairs.iter().filter(on_axis).collect();
        pairs.sort_by(|a, b| a.position[axis].total_cmp(&b.position[axis]));
        assert_eq!(pairs[0].position[axis], 0.0);
        close(
            "area",
            2.0 * pairs[0].area,
            pairs[1].area,
            pairs[1].area,
            1e-12,
        );
        pairs.iter().map(|p| p.pressure).collect()
    };
    let (x, y) = (along(0), along(1));
    for (a, b) in x.iter().zip(&y) {
        close("x and y alike", *a, *b, x[0], 1e-9);
    }
    assert!(x.windows(2).all(|p| p[1] < p[0] || p[0] == 0.0), "{x:?}");
    let force: f64 = state.pairs.iter().map(|p| 4.0 * p.force).sum();
    close("force", force, 4.0, 4.0, 1e-9);
}
