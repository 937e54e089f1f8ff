//! Messages about a deck are in its own words: keyword and line, never a key of a scene.

use super::with_text;
use crate::support::{run_as_far_as_it_goes, try_run};
use brinell::linalg::Backend;
use brinell::results::Results;
use brinell::{Error, Result};

/// One cube on another.
const DECK: &str = "\
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
11, 0., 0., 1.
12, 1., 0., 1.
13, 1., 1., 1.
14, 0., 1., 1.
15, 0., 0., 2.
16, 1., 0., 2.
17, 1., 1., 2.
18, 0., 1., 2.
*ELEMENT, TYPE=C3D8, ELSET=LOW
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=UP
2, 11, 12, 13, 14, 15, 16, 17, 18
*NSET, NSET=BASE
1, 2, 3, 4
*NSET, NSET=X0
1, 4, 5, 8, 11, 14, 15, 18
*NSET, NSET=Y0
1, 2, 5, 6, 11, 12, 15, 16
*SURFACE, NAME=FLOOR
1, S2
*SURFACE, NAME=FACE
2, S1
*MATERIAL, NAME=My steel
*ELASTIC
210000., 0.3
*PLASTIC
300., 0.
400., 0.1
*SOLID SECTION, ELSET=LOW, MATERIAL=My steel
*SOLID SECTION, ELSET=UP, MATERIAL=My steel
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE, SMALL SLIDING
FACE, FLOOR
*BOUNDARY
BASE, 3, 3
X0, 1, 1
Y0, 2, 2
*STEP
*STATIC
*DLOAD
2, P2, 50.
*END STEP
";

/// What belongs to scenes alone.
const OF_SCENES: [&str; 14] = [
    "materials.",
    "[[",
    "contact.",
    "tie.",
    "load.",
    "support.",
    "equation.",
    "bodies.",
    "slave =",
    "`normal`",
    "`distance`",
    "integration =",
    "_modulus",
    "_stress",
];

fn try_text(text: &str) -> Result<Results> {
    with_text(text, |scene| try_run(&scene, Backend::Dense))
}

fn message(changes: &[(&str, &str)]) -> String {
    let mut text = DECK.to_string();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    let error: Option<Error> = try_text(&text).err();
    error.map_or_else(|| panic!("taken: {changes:?}"), |error| error.to_string())
}

#[test]
fn messages_of_a_deck_have_no_keys_of_scenes() {
    try_text(DECK).unwrap();
    let tie = (
        "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE, SMALL SLIDING",
        "*TIE, NAME=T, POSITION TOLERANCE=1E-4",
    );
    let cases: [(&[(&str, &str)], &str); 14] = [
        (
            &[("210000., 0.3", "-1., 0.3")],
            "*ELASTIC of My steel: Young's modulus",
        ),
        (
            &[("210000., 0.3", "1., 0.5")],
            "*ELASTIC of My steel: Poisson's ratio",
        ),
        (&[("400., 0.1", "200., 0.1")], "*PLASTIC of My steel"),
        (
            &[("300., 0.\n400., 0.1", "-300., 0.")],
            "*PLASTIC of My steel: yield stress",
        ),
        (
            &[("2, P2, 50.", "UP, GRAV, 9.81, 0., 0., -1.")],
            "give *DENSITY of My steel",
        ),
        (
            &[("BASE, 3, 3\n", "")],
            "add a *BOUNDARY or a *CONTACT PAIR",
        ),
        (
            &[("FACE, FLOOR", "FLOOR, FLOOR")],
            "*CONTACT PAIR: \"FLOOR\" cannot touch itself",
        ),
        (
            &[("FACE, FLOOR", "FACE, FLOR")],
            "*CONTACT PAIR: there is no surface FLOR",
        ),
        (
            &[("FACE, FLOOR", "FACE, FLOOR\nFACE, FLOOR")],
            "is the slave of two contacts",
        ),
        (
            &[
                tie,
                ("11, 0., 0., 1.", "11, 0., 0., 1.1"),
                ("12, 1., 0., 1.", "12, 1., 0., 1.1"),
            ],
            "POSITION TOLERANCE",
        ),
        (
            &[("*CONTACT PAIR", "*TIE, NAME=T\nFACE, FLOOR\n*CONTACT PAIR")],
            "*TIE (`",
        ),
        (&[("*BOUNDARY\n", "*BOUNDARY\nALL, 1, 3\n")], "deck.inp"),
        (&[("1, 1, 2, 3, 4, 5", "1, 2, 1, 3, 4, 5")], "element 1"),
        (
            &[(
                "*END STEP",
                "*END STEP\n*STEP\n*STATIC\n*BOUNDARY\n7, 3\n13, 3\n*END STEP",
            )],
            "node 7 cannot be moved along z",
        ),
    ];
    for (changes, expected) in cases {
        let text = message(changes);
        println!("{text}");
        assert!(text.contains(expected), "{expected}: {text}");
        for key in OF_SCENES {
            assert!(!text.contains(key), "{key}: {text}");
        }
        assert!(text.contains("deck.inp") || text.contains("body"), "{text}");
    }
}

/// Warnings are in the words of the deck, too: contacts and ties by their lines, not by numbers.
#[test]
fn warnings_of_a_deck_have_no_numbers_of_entries() {
    // Surfaces that a support takes apart never touch.
    let text = DECK.replacen("2, P2, 50.", "2, P2, -50.", 1);
    let text = text.replacen(
        "BASE, 3, 3\n",
        "BASE, 3, 3\n15, 3, 3\n16, 3, 3\n17, 3, 3\n18, 3, 3\n",
        1,
    );
    let told = try_text(&text).unwrap().warnings.join("\n");
    assert!(told.contains("the *CONTACT PAIR of "), "{told}");
    assert!(told.contains("is open in every state"), "{told}");
    assert!(!told.contains("contact 1"), "{told}");
}

/// Messages about elements and sets name the types and the lines of the deck.
#[test]
fn elements_and_sets_are_told_by_type_and_line() {
    let plane = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, -1., 0.\n6, -1., 1.\n\
                 *ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 3, 4\n2, 5, 1, 4, 6\n\
                 *MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*DENSITY\n1.\n\
                 *SOLID SECTION, ELSET=E, MATERIAL=M\n*NSET, NSET=A\nB\n*NSET, NSET=B\n1\n\
                 *BOUNDARY\n1, 1, 2\n4, 1\n*STEP\n*STATIC\n*DLOAD\n\
                 E, GRAV, 1., 1., 0.\n*END STEP\n";
    try_text(plane).unwrap();
    let axisymmetric = ("CPE4", "CAX4");
    let axial = ("GRAV, 1., 1., 0.", "GRAV, 1., 0., 1.");
    let side = ("5, -1., 0.\n6, -1., 1.", "5, 2., 0.\n6, 2., 1.");
    let other = (
        "\n2, 5, 1, 4, 6",
        "\n*ELEMENT, TYPE=CPS4, ELSET=E\n2, 5, 1, 4, 6",
    );
    let turned = ("2, 5, 1, 4, 6", "2, 2, 5, 6, 3");
    let cases: [(&[(&str, &str)], &str); 6] = [
        (
            &[axisymmetric, axial],
            "deck.inp, line 6: *NODE: node 5 lies at the negative radius -1",
        ),
        (
            &[axisymmetric, side, turned],
            "*DLOAD: GRAV: has a radial component",
        ),
        (
            &[other],
            "line 11: *ELEMENT: elements CPS4 after others CPE4: a model is of",
        ),
        (
            &[("6, -1., 1.", "6, -1., 1., 3.")],
            "deck.inp, line 7: *NODE: node 6 lies at z = 3",
        ),
        (
            &[("B\n1\n", "B\nA\n")],
            "line 18: *NSET: A contains B, and that contains A, but no node",
        ),
        (
            &[("TYPE=CPE4", "TYPE=SPRINGA")],
            "TYPE=SPRINGA: springs, dashpots, masses",
        ),
    ];
    for (changes, expected) in cases {
        let text = changes.iter().fold(plane.to_string(), |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replacen(old, new, 1)
        });
        let text = try_text(&text).map(drop).unwrap_err().to_string();
        assert!(text.contains(expected), "{expected}: {text}");
        assert_eq!(text.matches("deck.inp").count(), 1, "{text}");
        for key in OF_SCENES {
            assert!(!text.contains(key), "{key}: {text}");
        }
    }
}

/// Large displacements are computed as small ones where they are small.
#[test]
fn nlgeom_is_measured() {
    let with = |pressure: &str, curve: &str| {
        let text = DECK.replace("*STEP\n", "*STEP, NLGEOM\n");
        let text = text
            .replace("*END STEP, NLGEOM", "*END STEP")
            .replace("50.", pressure);
        let text = text.replace("*PLASTIC\n300., 0.\n400., 0.1\n", curve);
        let run = |scene| Ok(run_as_far_as_it_goes(&scene, Backend::Dense));
        with_text(&text, run).unwrap()
    };
    let large = |pressure: &str| with(pressure, "");
    let small = large("50.");
    let said = small
        .warnings
        .iter()
        .find(|text| text.contains("*STEP: NLGEOM: displacements"));
    let said = said.expect("what was measured");
    assert!(
        // The stress of 50 over the modulus, without a rotation.
        said.contains("taken for small, and are: strains reach 0.02 %, rotations 0.00 degrees"),
        "{said}"
    );
    assert!(brinell::output::ending(&small).is_ok());
    // Flow at a stress that is a third of the slope of its curve, and at one that is a hundredth.
    let flows = |slope: &str| {
        let curve = format!("*PLASTIC\n300., 0.\n{slope}, 0.1\n");
        let results = with("360.", &curve);
        assert!(results.states[0].plastic_points > 0);
        let mut warnings = results.warnings.into_iter();
        warnings.find(|text| text.contains("of the slope of its curve"))
    };
    assert!(flows("400.").unwrap().contains(" flows at a stress of 3"));
    assert_eq!(flows("3400."), None);
    // Kinematic hardening raises the stress of flow, too: 95 at the slope 1000, and 6 of strain.
    let curve = "*PLASTIC, HARDENING=KINEMATIC\n95., 0.\n195., 0.1\n";
    let results = with("105.", curve);
    let told = |text: &String| text.contains("flows at a stress of 10 % of the slope");
    assert!(results.warnings.iter().any(told), "{:?}", results.warnings);
    let error = brinell::output::ending(&large("50000.")).unwrap_err();
    assert!(
        error.to_string().contains("compute with --small-strain"),
        "{error}"
    );
}
