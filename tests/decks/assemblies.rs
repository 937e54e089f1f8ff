//! Decks of parts and an assembly, as Abaqus/CAE writes them, and flat ones that say the same.

use super::{run_text, with_text};
use brinell::deck::{Deck, Options};
use brinell::mesh::inp;
use brinell::results::Results;

/// The sides of a block: a node set each, and a face of elements.
const SIDES: [&str; 4] = ["LEFT", "RIGHT", "BOTTOM", "TOP"];

/// Nodes of a plane block by number, which begin behind `first`: `n` by `n` elements.
fn nodes(n: usize, [width, height]: [f64; 2], first: usize) -> Vec<(usize, [f64; 2])> {
    let rows = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let node = |(i, j)| {
        let share = |k: usize| k as f64 / n as f64;
        let x = [width * share(i), height * share(j)];
        (first + j * (n + 1) + i + 1, x)
    };
    rows.map(node).collect()
}

/// What a block consists of behind its nodes: elements, sets, surfaces and a section, whose names
/// begin with `front`.
fn block(n: usize, first: usize, front: &str) -> String {
    let mut text = format!("*Element, type=CPE4, elset=\"{front}All\"\n");
    for j in 0..n {
        for i in 0..n {
            let a = first + j * (n + 1) + i + 1;
            let element = first + j * n + i + 1;
            let [b, c, d] = [a + 1, a + n + 2, a + n + 1];
            text += &format!("{element}, {a}, {b}, {c}, {d}\n");
        }
    }
    let (corner, last) = (first + 1, first + (n + 1) * (n + 1));
    let ends = [
        [corner, last - n, n + 1],
        [corner + n, last, n + 1],
        [corner, corner + n, 1],
        [last - n, last, 1],
    ];
    let elements = [
        [first + 1, first + n * n - n + 1, n],
        [first + n, first + n * n, n],
        [first + 1, first + n, 1],
        [first + n * n - n + 1, first + n * n, 1],
    ];
    let faces = ["S4", "S2", "S1", "S3"];
    for (((side, [from, to, step]), [a, b, by]), face) in
        SIDES.iter().zip(ends).zip(elements).zip(faces)
    {
        text += &format!("*Nset, nset=\"{front}{side}\", generate\n{from}, {to}, {step}\n");
        text += &format!("*Elset, elset=\"{front}_{side}\", internal, generate\n{a}, {b}, {by}\n");
        text += &format!("*Surface, type=ELEMENT, name=\"{front}{side}_S\"\n");
        text += &format!("\"{front}_{side}\", {face}\n");
    }
    text + &format!("*Solid Section, elset=\"{front}All\", material=Steel\n,\n")
}

fn lines(nodes: &[(usize, [f64; 2])]) -> String {
    let line = |(number, [x, y]): &(usize, [f64; 2])| format!("{number}, {x:?}, {y:?}\n");
    format!("*Node\n{}", nodes.iter().map(line).collect::<String>())
}

const MATERIAL: &str = "\
*Material, name=Steel
*Elastic
210000., 0.3
*Plastic
300., 0.
400., 0.01
";

/// A lower block, 4 by 1, and an upper one, 2 by 1, on its middle, as parts and as a flat deck.
/// Names of the steps' conditions are those from outside of the parts.
fn two_blocks(steps: &str) -> [String; 2] {
    let (lower, upper) = ([4.0, 1.0], [2.0, 1.0]);
    let assembled = format!(
        "*Heading\n** a comment\n*Preprint, echo=NO, model=NO, history=NO, contact=NO\n\
         *Part, name=Lower\n{}{}*End Part\n*Part, name=\"The, upper\"\n{}{}*End Part\n\
         *Assembly, name=Assembly\n*Instance, name=Lower-1, part=LOWER\n*End Instance\n\
         *Instance, name=\"Upper, 1\", part=\"the, upper\"\n1., 1., 0.\n*End Instance\n\
         *Nset, nset=Middle, instance=\"Upper, 1\"\n13,\n\
         *Nset, nset=Middle, instance=Lower-1\n3,\n\
         *Elset, elset=_press, internal, instance=\"Upper, 1\", generate\n13, 16, 1\n\
         *Surface, type=ELEMENT, name=Press\n_press, S3\n*End Assembly\n{MATERIAL}{steps}",
        lines(&nodes(4, lower, 0)),
        block(4, 0, ""),
        lines(&nodes(4, upper, 0)),
        block(4, 0, ""),
    );
    // The numbers and the coordinates that the instances have.
    let moved = |(number, x): (usize, [f64; 2])| (number, x.map(|x| x + 1.0));
    let above: Vec<_> = nodes(4, upper, 200).into_iter().map(moved).collect();
    let flat = format!(
        "{}{}{}{}*Nset, nset=Middle\n213, 103\n\
         *Elset, elset=_press, generate\n213, 216\n*Surface, name=Press\n_press, S3\n\
         {MATERIAL}{steps}",
        lines(&nodes(4, lower, 100)),
        block(4, 100, "Lower-1."),
        lines(&above),
        block(4, 200, "Upper, 1."),
    );
    [assembled, flat]
}

const STEPS: &str = "\
*Surface Interaction, name=Int
1.,
*Surface Behavior, pressure-overclosure=HARD
*Contact Pair, interaction=Int, type=SURFACE TO SURFACE
\"Upper, 1.BOTTOM_S\", Lower-1.TOP_S
*Boundary
lower-1.bottom, 2, 2
Middle, XSYMM
*Step, name=Step-1, nlgeom=NO
*Static
1., 1., 1e-05, 1.
*Dsload
Press, P, 450.
*Restart, write, frequency=0
*Output, field, variable=PRESELECT
*Node Output
U,
*Element Output, directions=YES
S, PE
*Contact Output
CSTRESS,
*End Step
";

/// Displacements and stresses of all states agree to round-off.
fn same(a: &Results, b: &Results) {
    assert_eq!(a.states.len(), b.states.len());
    for (a, b) in a.states.iter().zip(&b.states) {
        let [f, g] = [a, b].map(|state| state.fields.as_ref().unwrap());
        for [f, g] in [
            [&f.displacement, &g.displacement],
            [&f.plastic_strain, &g.plastic_strain],
        ] {
            let scale = f.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(scale > 0.0);
            for (x, y) in f.iter().zip(g) {
                assert!((x - y).abs() <= 1e-12 * scale, "{x:e} {y:e}");
            }
        }
        let force = (a.contact_force / b.contact_force - 1.0).abs();
        assert!(force <= 1e-12, "{force:e}");
    }
}

/// Contact of two parts, sets of instances, surfaces within parts and of the assembly: the deck is
/// the flat one to the last digits.
#[test]
fn a_deck_of_parts_is_its_flat_twin() {
    let [assembled, flat] = two_blocks(STEPS);
    let (model, results) = run_text(&assembled);
    let (twin, of_twin) = run_text(&flat);
    assert_eq!(model.mesh.node_labels, twin.mesh.node_labels);
    assert_eq!(model.mesh.element_labels, twin.mesh.element_labels);
    assert_eq!(model.mesh.coordinates, twin.mesh.coordinates);
    assert_eq!(model.mesh.connectivity, twin.mesh.connectivity);
    assert_eq!(model.mesh.bodies, ["Lower-1", "Upper, 1"]);
    same(&results, &of_twin);
    let last = results.states.last().unwrap();
    assert!((last.contact_force / 900.0 - 1.0).abs() < 1e-6);
    assert!(model.mesh.node_sets.contains_key("Upper, 1.LEFT"));
}

/// The same conditions under other names: quotes around a part of a name, the assembly in front,
/// the number of a node in its instance.
#[test]
fn names_from_outside_may_be_written_in_several_ways() {
    let [plain, _] = two_blocks(STEPS);
    let other = STEPS
        .replace("\"Upper, 1.BOTTOM_S\"", "\"upper, 1\".Bottom_S")
        .replace("lower-1.bottom", "Assembly.Lower-1.BOTTOM")
        .replace("Middle, XSYMM", "\"Upper, 1\".13, 1\nLower-1.3, 1");
    let [other, _] = two_blocks(&other);
    same(&run_text(&plain).1, &run_text(&other).1);
}

/// A part whose instances stand beside each other, moved and turned, with its own mesh or that of
/// an instance.
#[test]
fn instances_of_one_part_are_bodies_of_their_own() {
    let part = format!("{}{}", lines(&nodes(2, [2.0, 1.0], 0)), block(2, 0, ""));
    let assembly = "*Assembly, name=A\n*Instance, name=I, part=P\n*End Instance\n\
                    *Instance, name=J, part=P\n5., 0., 0.\n*End Instance\n\
                    *Instance, name=K, part=P\n10., 0., 0.\n\
                    10., 0., 0., 10., 0., 1., 90.\n*End Instance\n\
                    *Instance, name=L, part=Q\n20., 0., 0.\nOWN*End Instance\n*End Assembly\n";
    let assembly = assembly.replace("OWN", &part);
    let text = format!("*Part, name=P\n{part}*End Part\n*Part, name=Q\n*End Part\n{assembly}");
    let mesh = inp::mesh(&Deck::parse(text.as_bytes(), "a.inp").unwrap()).unwrap();
    assert_eq!(mesh.bodies, ["I", "J", "K", "L"]);
    let at = |label| {
        let labels = &mesh.node_labels;
        let node = labels.iter().position(|l| *l == label).unwrap();
        [mesh.coordinates[2 * node], mesh.coordinates[2 * node + 1]]
    };
    // The corner at (2, 1) of the part.
    assert_eq!(at(19), [2.0, 1.0]);
    assert_eq!(at(29), [7.0, 1.0]);
    assert_eq!(at(39), [9.0, 2.0]);
    assert_eq!(at(49), [22.0, 1.0]);
    assert_eq!(mesh.node_sets["K.RIGHT"].len(), 3);
    assert_eq!(mesh.surfaces["J.TOP_S"].facets.len(), 2);
}

/// A bar that is turned by a right angle is pulled as the one that lies.
#[test]
fn a_turned_instance_answers_as_the_part_does() {
    let part = format!("{}{}", lines(&nodes(2, [2.0, 1.0], 0)), block(2, 0, ""));
    let deck = |place: &str, [along, across]: [usize; 2]| {
        format!(
            "*Part, name=P\n{part}*End Part\n*Assembly\n*Instance, name=I, part=P\n{place}\
             *End Instance\n*End Assembly\n{MATERIAL}*Boundary\nI.LEFT, {along}\nI.1, {across}\n\
             *Step\n*Static\n*Dsload\nI.RIGHT_S, P, -200.\n*End Step\n"
        )
    };
    let turned = "3., 0., 0.\n3., 0., 0., 3., 0., 1., 90.\n";
    let [(_, lying), (model, standing)] =
        [deck("", [1, 2]), deck(turned, [2, 1])].map(|text| run_text(&text));
    assert_eq!(model.mesh.bodies, ["I"]);
    let [lying, standing] = [lying, standing].map(|results| {
        let fields = results.states.last().unwrap().fields.as_ref().unwrap();
        fields.displacement.clone()
    });
    for (a, b) in lying.chunks(2).zip(standing.chunks(2)) {
        assert!((a[0] - b[1]).abs() + (a[1] + b[0]).abs() < 1e-12);
    }
    assert!(lying.iter().any(|u| u.abs() > 1e-4));
}

/// What is wrong with the frame of a deck of parts, and the beginning of what is said of it.
#[test]
fn damage_to_parts_and_assemblies_is_told() {
    let [text, _] = two_blocks(STEPS);
    for (old, new, expected) in [
        (
            "part=LOWER",
            "part=Lowr",
            "*INSTANCE: there is no part Lowr, did you mean LOWER?",
        ),
        (
            "part=LOWER",
            "prt=LOWER",
            "*INSTANCE: unknown parameter PRT, did you mean PART?",
        ),
        (
            "*End Part\n*Part",
            "*Part",
            "*PART: the *PART of a.inp, line 4 has no *END PART; put it",
        ),
        ("*End Assembly\n", "", "*STEP: the *ASSEMBLY of a.inp, line"),
        (
            "*End Part\n*Assembly",
            "*Assembly",
            "*ASSEMBLY: the *PART of a.inp, line",
        ),
        (
            "*Part, name=Lower\n",
            "",
            "*END PART: there is no *PART that it ends; take it out",
        ),
        (
            "\"The, upper\"",
            "lower",
            "*PART: a second part lower; rename one of them",
        ),
        (
            "name=\"Upper, 1\"",
            "name=LOWER-1",
            "*INSTANCE: a second instance LOWER-1",
        ),
        (
            "nset=Middle, instance",
            "nset=Middle, instanc",
            "*NSET: unknown parameter INSTANC, did you mean INSTANCE?",
        ),
        (
            "1\"\n13,",
            "1\"\n999,",
            "*NSET: instance Upper, 1 has no node or element 999; give one",
        ),
        (
            "1\"\n13,",
            "1\"\nTPO,",
            "*NSET: there is no node set Upper, 1.TPO, did you mean UPPER, 1.TOP?",
        ),
        (
            "instance=Lower-1",
            "instance=Lower-2",
            "*NSET: there is no instance Lower-2, did you",
        ),
        (
            "1., 1., 0.\n*End",
            "1., x, 0.\n*End",
            "*INSTANCE: the translation is `x`; give a finite",
        ),
        (
            "1., 1., 0.\n*End",
            "nan, 1., 0.\n*End",
            "*INSTANCE: the translation is `nan`; give a",
        ),
        (
            "1., 1., 0.\n*End",
            "0., 0., 0., 0., 0., 1., 90.\n*End",
            "*INSTANCE: the first line is the translation x, y, z; put a line 0., 0., 0. in front",
        ),
        (
            "1., 1., 0.\n*End",
            "1., 1.\n0., 0., 0., 0., 0., 0., 90.\n*End",
            "*INSTANCE: the two points of the axis of rotation are the same",
        ),
        (
            "1., 1., 0.\n*End",
            "1., 1.\n0., 0., 0., 0., 0., 1.\n*End",
            "*INSTANCE: the line ends where the angle of rotation should be; give it",
        ),
        (
            "1., 1., 0.\n*End",
            "1.\n0., 0., 0., 0., 0., 1., 9.\n1.\n*End",
            "*INSTANCE: this line is one too many; take it out",
        ),
        (
            "Middle, XSYMM",
            "13, 1",
            "*BOUNDARY: there is no node 13 outside of instances; those",
        ),
        (
            "Middle, XSYMM",
            "213, 1",
            "*BOUNDARY: there is no node or element 213 outside of",
        ),
        (
            "*Surface, type",
            "*Distributing, ref node=1, elset=All\n*Surface, type",
            "*DISTRIBUTING: ",
        ),
    ] {
        assert!(text.contains(old), "{old}");
        let deck = Deck::parse(text.replacen(old, new, 1).as_bytes(), "a.inp");
        let error = deck.and_then(|deck| deck.convert(Options::default()));
        let error = error.err().unwrap_or_else(|| panic!("taken: {new}"));
        let message = error.to_string();
        assert!(message.starts_with("a.inp, line "), "{message}");
        assert!(
            message.contains(expected),
            "{message}\nexpected: {expected}"
        );
    }
    // Without any end, and without any instance.
    for (text, expected) in [
        (
            "*PART, NAME=P\n*NODE\n1\n",
            "line 1: *PART: it has no *END PART; put it behind",
        ),
        (
            "*PART, NAME=P\n*END PART\n",
            "line 1: *PART: the deck has no *INSTANCE; put one",
        ),
        (
            "*INSTANCE, NAME=I, PART=P\n",
            "line 1: *INSTANCE: it stands in no *ASSEMBLY; put it",
        ),
        (
            "*ASSEMBLY\n*END ASSEMBLY\n*ASSEMBLY\n",
            "line 3: *ASSEMBLY: a second assembly; put",
        ),
        (
            "*PART\n*END PART\n",
            "line 1: *PART: the parameter NAME is missing",
        ),
    ] {
        let error = Deck::parse(text.as_bytes(), "a.inp").err().unwrap();
        assert!(error.to_string().contains(expected), "{error}");
    }
}

/// The account has the frame, what numbers are, and parts that stand nowhere.
#[test]
fn the_account_tells_of_parts() {
    let [text, _] = two_blocks(STEPS);
    let text = text.replacen("*Assembly,", "*Part, name=Spare\n*End Part\n*Assembly,", 1);
    let deck = Deck::parse(text.as_bytes(), "a.inp").unwrap();
    let account = deck.account();
    assert_eq!(account.understood["PART"].0, 3);
    assert_eq!(account.understood["END INSTANCE"].0, 2);
    assert!(
        account
            .ignored
            .iter()
            .any(|note| note.text == "no *INSTANCE is made of it")
    );
    let expected = "numbers of nodes and elements are those of the part plus 100 in Lower-1, 200 \
                    in Upper, 1";
    assert_eq!(account.taken[0].text, expected);
    let scene = with_text(&text, Ok).unwrap();
    assert!(
        scene
            .warnings
            .iter()
            .any(|warning| warning.ends_with(expected))
    );
}
