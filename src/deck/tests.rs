mod requests;

use super::*;
use crate::scene::{Direction, History, Scene};
use std::path::PathBuf;

fn read(name: &str) -> Deck {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    Deck::read(&root.join(name)).unwrap()
}

fn small_strain(deck: &Deck) -> Conversion {
    deck.convert(Options {
        small_strain: true,
        ..Options::default()
    })
    .unwrap()
}

fn directions(scene: &Scene, on: &str) -> Vec<Direction> {
    let mut of = scene.support.iter().filter(|support| support.on == on);
    of.next().map_or(Vec::new(), |support| support.fix.clone())
}

/// A square of one element that rests on its lower side, followed by the given lines of a deck.
fn square(rest: &str) -> Scene {
    let square = "\
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
*BOUNDARY
1, 1, 2
2, 2
";
    let deck = Deck::parse(format!("{square}{rest}").as_bytes(), "a.inp").unwrap();
    small_strain(&deck).scene
}

#[test]
fn a_deck_begins_with_a_keyword() {
    for text in ["1, 2", "$MeshFormat", "kind = \"solid\""] {
        let error = Deck::parse(text.as_bytes(), "a.inp").err().unwrap();
        assert!(error.message().starts_with("a.inp, line 1: "), "{error}");
    }
    // A deck without data can be read, but is not a model.
    let deck = Deck::parse(b"** a comment\n\n", "a.inp").unwrap();
    assert!(deck.convert(Options::default()).is_err());
}

#[test]
fn every_keyword_becomes_what_it_means() {
    let deck = read("tests/fuzz/seeds/every_keyword.inp");
    let conversion = small_strain(&deck);
    let scene = conversion.finish("every.inp", &[]).unwrap();
    // One section has two bodies that share no node: sets that are exactly the bodies give the
    // names.
    assert_eq!(scene.bodies.keys().collect::<Vec<_>>(), ["HIGH", "LOW"]);
    let steel = &scene.materials["STEEL"];
    assert_eq!(steel.first_yield_stress(), Some(300.0));
    assert_eq!(
        steel.hardening_table,
        Some(vec![[0.0, 300.0], [0.1, 400.0]])
    );
    // The axes of the transform coincide with the global ones.
    let turned = scene
        .support
        .iter()
        .filter(|support| support.direction.is_some());
    assert_eq!(turned.count(), 2);
    assert_eq!(directions(&scene, "boundary-line-60"), [Direction::X]);
    // Load 0 is the force on the leader of a plane, divided by the thickness. Load 1 is the
    // pressure that is removed again.
    let plane = &scene.load[0];
    assert_eq!(plane.plane_force.unwrap().total, -2.5);
    assert_eq!(
        plane.history,
        History::Table(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 0.5]])
    );
    let pressure = &scene.load[1];
    assert_eq!(pressure.pressure, Some(3.0.into()));
    assert_eq!(
        pressure.history,
        History::Table(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]])
    );
    let contact = &scene.contact[0];
    assert_eq!(contact.first, "UNDER");
    assert_eq!(contact.gap, Some(0.0.into()));
    let targets = scene.program.targets.iter();
    let targets: Vec<_> = targets
        .map(|t| (t.name.as_deref(), t.load_factor))
        .collect();
    assert_eq!(
        targets,
        [(Some("step-1"), Some(1.0)), (Some("step-2"), Some(2.0))]
    );
    // Places in the scene refer to the deck.
    assert!(
        scene
            .places
            .of("load.1.pressure")
            .unwrap()
            .ends_with("line 68")
    );
}

#[test]
fn loads_that_change_alike_give_load_factors() {
    let text = "\
*STEP
*STATIC
1., 4.
*CLOAD
3, 2, 10.
4, 2, 10.
*DLOAD
1, P3, -2.
*END STEP
*STEP
*STATIC
*CLOAD
3, 2, 5.
4, 2, 5.
*DLOAD
1, P3, -1.
*END STEP
";
    let scene = square(text);
    assert!(
        scene
            .load
            .iter()
            .all(|load| load.history == History::Proportional)
    );
    // The two nodes form one set, whose force is the sum of both.
    assert_eq!(scene.load.len(), 2);
    assert_eq!(scene.load[0].force.unwrap().vector(), [0.0, 20.0, 0.0]);
    let factors: Vec<_> = scene
        .program
        .targets
        .iter()
        .map(|t| t.load_factor)
        .collect();
    assert_eq!(factors, [Some(1.0), Some(0.5)]);
}

/// An amplitude over step time restarts in each step that names it; one over total time continues.
#[test]
fn amplitudes_over_step_time_begin_anew_in_each_step() {
    let steps = |second: &str| {
        format!(
            "\
*AMPLITUDE, NAME=A
0., 0., 1., 4., 2., 1., 3., 8.
*AMPLITUDE, NAME=B
0., 4., 2., 1., 3., 8.
*AMPLITUDE, NAME=WHOLE, TIME=TOTAL TIME
0., 0., 1., 4., 2., 1., 3., 8.
*STEP
*STATIC
1., 1.
*CLOAD, AMPLITUDE=A
3, 2, 10.
*END STEP
*STEP
*STATIC
1., 2.
*CLOAD, AMPLITUDE={second}
3, 2, 10.
*END STEP
"
        )
    };
    let forces = |second: &str| -> Vec<f64> {
        let scene = square(&steps(second));
        let load = &scene.load[0];
        let size = load.force.unwrap().vector()[1];
        let factor = |of: f64| match &load.history {
            History::Proportional => of,
            History::Constant => 1.0,
            History::Table(rows) => {
                let row = rows.iter().find(|row| row[0] == of);
                row.unwrap_or_else(|| panic!("{rows:?} at {of}"))[1]
            }
        };
        let targets = scene.program.targets.iter();
        targets
            .map(|t| size * factor(t.load_factor.unwrap()))
            .collect()
    };
    let ends = |forces: &[f64]| [forces[0], forces[forces.len() - 1]];
    assert_eq!(ends(&forces("B")), [40.0, 10.0]);
    assert_eq!(ends(&forces("WHOLE")), [40.0, 80.0]);
}

/// Sets that contain themselves or each other do not cause endless recursion.
#[test]
fn sets_in_a_circle_are_the_sum_of_their_members() {
    let text = "*NODE\n1\n2\n3\n*NSET, NSET=A\nB, 1\n*NSET, NSET=B\nA, B, 3\n";
    let deck = Deck::parse(text.as_bytes(), "a.inp").unwrap();
    let a = data::EntitySelection::Set("a".to_string());
    let at = (LinePlace::default(), "NSET");
    assert_eq!(
        deck.lookup().indices(sets::What::Nodes, &a, at).unwrap(),
        [0, 2]
    );
}

#[test]
fn kinematic_hardening_is_the_slope_of_its_curve() {
    let text = include_str!("../../tests/fuzz/seeds/every_keyword.inp");
    let kinematic = text.replacen("*PLASTIC\n", "*PLASTIC, HARDENING=KINEMATIC\n", 1);
    assert_ne!(kinematic, text);
    let deck = Deck::parse(kinematic.as_bytes(), "a.inp").unwrap();
    let scene = small_strain(&deck).finish("a.inp", &[]).unwrap();
    let steel = &scene.materials["STEEL"];
    assert_eq!(
        (steel.yield_stress, &steel.hardening_table),
        (Some(300.0), &None)
    );
    let modulus = steel.kinematic_modulus.unwrap();
    assert!((modulus - 1000.0).abs() < 1e-9, "{modulus}");
}

/// Instances are translated, then rotated about any axis in space, together with the axes of
/// `*TRANSFORM`.
#[test]
fn instances_are_moved_then_turned() {
    let axes = "*TRANSFORM, NSET=N, TYPE=C\n1., 2., 3., 1., 2., 4.\n*TRANSFORM, NSET=N\n1., 0., \
                0., 0., 1., 0.\n";
    let placed = |place: &str| {
        let text = format!(
            "*PART, NAME=P\n*NODE, NSET=N\n7, 1., 2., 3.\n{axes}*END PART\n*ASSEMBLY\n\
             *INSTANCE, NAME=I, PART=P\n{place}*END INSTANCE\n*END ASSEMBLY\n"
        );
        let deck = Deck::parse(text.as_bytes(), "a.inp").unwrap();
        assert_eq!(deck.mesh.node_name(0), "7 of instance I");
        let [axis, ways] = [0, 1].map(|index: usize| deck.properties.transforms[index].points);
        (deck.mesh.point(0), axis, ways)
    };
    let (x, axis, ways) = placed("");
    assert_eq!((x, axis[1]), ([1.0, 2.0, 3.0], [1.0, 2.0, 4.0]));
    assert_eq!(ways, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    // A right angle about x, through the point at z = 1.
    let (x, axis, ways) = placed("1., 0., 0.\n0., 0., 1., 2., 0., 1., 90.\n");
    assert_eq!(x, [2.0, -2.0, 3.0]);
    assert_eq!(axis, [[2.0, -2.0, 3.0], [2.0, -3.0, 3.0]]);
    assert_eq!(ways, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    // A third of a turn about the diagonal maps each axis to the next.
    let (x, _, _) = placed("0., 0., 0.\n0., 0., 0., 1., 1., 1., 120.\n");
    assert!(
        (0..3).all(|d| (x[d] - [3.0, 1.0, 2.0][d]).abs() < 1e-14),
        "{x:?}"
    );
    // Whole turns have no effect.
    let (x, _, _) = placed("0., 0., 0.\n0., 0., 0., 1., 1., 1., -720.\n");
    assert_eq!(x, [1.0, 2.0, 3.0]);
}

#[test]
fn instances_are_bodies() {
    let deck = read("tests/fuzz/seeds/assembly.inp");
    let scene = small_strain(&deck).finish("a.inp", &[]).unwrap();
    assert_eq!(scene.bodies.keys().collect::<Vec<_>>(), ["High 1", "Low"]);
    let contact = &scene.contact[0];
    assert_eq!(contact.first, "High 1.Top");
    assert_eq!(contact.second, "Low.Top");
    assert_eq!(scene.equation.len(), 1);
}
