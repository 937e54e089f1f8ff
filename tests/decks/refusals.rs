//! What is wrong with a deck, or is not there, is told by file, line and keyword.

use brinell::deck::{Deck, Options};
use brinell::mesh::{self, inp};
use brinell::{Error, ErrorKind};

/// One line of it is replaced or followed by something wrong.
const DECK: &str = "\
*HEADING
one element
*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPE4, ELSET=BODY
1, 1, 2, 3, 4
*NSET, NSET=BASE
1, 2
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL
1.
*BOUNDARY
BASE, 1, 2
*STEP
*STATIC
1., 1.
*CLOAD
3, 2, 5.
*END STEP
";

/// The error that reading, converting or meshing a deck ends with.
fn error(text: &str) -> Option<Error> {
    let deck = match Deck::parse(text.as_bytes(), "deck.inp") {
        Ok(deck) => deck,
        Err(error) => return Some(error),
    };
    let converted = deck.convert(Options::default());
    let meshed = inp::mesh(&deck).and_then(|mesh| mesh::validate(&mesh));
    let finished = converted.and_then(|conversion| conversion.finish("deck.inp", &[]));
    finished.err().or(meshed.err())
}

#[track_caller]
fn refused(kind: ErrorKind, old: &str, new: &str, expected: &str) {
    assert_eq!(DECK.matches(old).count(), 1, "{old}");
    let text = DECK.replace(old, new);
    let error = error(&text).unwrap_or_else(|| panic!("taken: {new}"));
    assert!(
        error.message().contains(expected),
        "{error}\nexpected: {expected}"
    );
    assert!(error.message().starts_with("deck.inp, line "), "{error}");
    assert_eq!(error.kind(), kind, "{error}");
}

#[test]
fn the_deck_itself_is_taken() {
    assert!(error(DECK).is_none());
}

#[test]
fn damage_is_told_by_line_and_keyword() {
    let input = |old, new, expected| refused(ErrorKind::Input, old, new, expected);
    for (old, new, expected) in [
        (
            "2, 1., 0.\n",
            "2, 1., x\n",
            "line 5: *NODE: y is `x`; give a finite number",
        ),
        (
            "2, 1., 0.\n",
            "2, 1., 0., 0., 0.5\n",
            "line 5: *NODE: `0.5` is one value too many",
        ),
        (
            "2, 1., 0.\n",
            "1, 1., 0.\n",
            "line 5: *NODE: number 1 is given twice",
        ),
        (
            "1, 1, 2, 3, 4",
            "1, 1, 2, 3",
            "line 9: *ELEMENT: element 1 has 3 nodes, 4 of them are needed",
        ),
        (
            "1, 1, 2, 3, 4",
            "1, 1, 2, 3, 5",
            "line 9: *ELEMENT: element 1 refers to node 5",
        ),
        (
            "*ELEMENT, TYPE=CPE4",
            "*ELEMENT",
            "line 8: *ELEMENT: the parameter TYPE is missing",
        ),
        (
            "*ELEMENT, TYPE=CPE4",
            "*ELEMENT, TYP=CPE4",
            "line 8: *ELEMENT: unknown parameter TYP, did you mean TYPE?",
        ),
        (
            "*ELASTIC",
            "*ELASTC",
            "line 13: *ELASTC: unknown keyword, did you mean *ELASTIC?",
        ),
        (
            "*HEADING",
            "*WHATEVER",
            "line 1: *WHATEVER: unknown keyword; take it out",
        ),
        (
            "1, 2\n*MAT",
            "9\n*MAT",
            "line 11: *NSET: there is no node 9",
        ),
        (
            "1, 2\n*MAT",
            "1, OTHER\n*MAT",
            "line 11: *NSET: there is no node set OTHER",
        ),
        (
            "*NSET, NSET=BASE\n1, 2",
            "*NSET, NSET=BASE, GENERATE\n2, 1",
            "line 11: *NSET: GENERATE from 2 to 1 by 1",
        ),
        (
            "*NSET, NSET=BASE\n1, 2",
            "*NSET, NSET=BASE, GENERATE\n5, 999999999",
            "GENERATE from 5 to 999999999 by 1: there is no such node",
        ),
        (
            "BASE, 1, 2",
            "BAS, 1, 2",
            "line 18: *BOUNDARY: there is no node set BAS, did you mean BASE?",
        ),
        (
            "BASE, 1, 2",
            "BASE, 2, 1",
            "line 18: *BOUNDARY: degrees of freedom 2 to 1",
        ),
        (
            "BASE, 1, 2",
            "BASE, FIXED",
            "line 18: *BOUNDARY: FIXED is neither a degree of freedom nor one of XSYMM",
        ),
        (
            "3, 2, 5.",
            "3, 4, 5.",
            "line 23: *CLOAD: degree of freedom 4",
        ),
        (
            "3, 2, 5.",
            "3, 2",
            "line 23: *CLOAD: the line ends where the force should be",
        ),
        (
            "ELSET=BODY, MATERIAL=STEEL",
            "ELSET=BODY, MATERIAL=IRON",
            "line 15: *SOLID SECTION: there is no *MATERIAL IRON",
        ),
        (
            "ELSET=BODY, MATERIAL=STEEL",
            "ELSET=REST, MATERIAL=STEEL",
            "line 15: *SOLID SECTION: there is no element set REST",
        ),
        (
            "*ELASTIC\n210000., 0.3\n",
            "",
            "line 12: *MATERIAL: STEEL has no *ELASTIC",
        ),
        (
            "210000., 0.3",
            "210000., 0.7",
            "deck.inp, line 12: *ELASTIC of STEEL: Poisson's ratio: 0.7",
        ),
        (
            "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n1.",
            "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n-1.",
            "the thickness is -1",
        ),
        (
            "*STEP",
            "*STEP\n*STATIC\n1., 1.\n*STEP",
            "*STEP: the step before has no *END STEP",
        ),
        (
            "*STATIC\n1., 1.",
            "*STATIC\n1., -1.",
            "*STATIC: the time of the step is -1",
        ),
        (
            "*CLOAD",
            "*CLOAD, AMPLITUDE=A",
            "*CLOAD: there is no *AMPLITUDE A",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*DLOAD\n1, P9, 5.",
            "*DLOAD: the face is `P9`",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*DLOAD\n1, P5, 5.",
            "*DLOAD: element 1 is a quad4 and has 4 faces, none with number 5",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*DSLOAD\nTOP, P, 5.",
            "*DSLOAD: there is no surface TOP",
        ),
        (
            "*BOUNDARY",
            "*CONTACT PAIR, INTERACTION=I\nA, B\n*BOUNDARY",
            "line 18: *CONTACT PAIR: there is no *SURFACE INTERACTION I",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*DLOAD\nBODY, GRAV, 9810., 0., 0., 0.",
            "line 23: *DLOAD: the direction of GRAV has no length",
        ),
        (
            "210000., 0.3",
            "210000., 0.3, 20.\n200000., 0.3, 20.",
            "line 15: *ELASTIC: temperature 20 must be greater than 20 before it",
        ),
        (
            "*CLOAD",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nA, B\n*CLOAD",
            "line 23: *MODEL CHANGE: there is no *CONTACT PAIR with the slave A and the master B",
        ),
        (
            "*CLOAD",
            "*MODEL CHANGE, TYPE=CONTACT PAIR\nA, B\n*CLOAD",
            "line 22: *MODEL CHANGE: give either ADD or REMOVE",
        ),
        (
            "*BOUNDARY",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, ADD\nA, B\n*BOUNDARY",
            "*MODEL CHANGE: it stands in no *STEP",
        ),
        (
            "*BOUNDARY",
            "*INCLUDE, INPUT=not/there.inp\n*BOUNDARY",
            "*INCLUDE",
        ),
        (
            "*BOUNDARY",
            "*EQUATION\n2\n1, 1, 1.\n*BOUNDARY",
            "*EQUATION: a line with node, degree of freedom",
        ),
        (
            "*BOUNDARY",
            "*AMPLITUDE, NAME=A\n0., 0., 0., 1.\n*BOUNDARY",
            "*AMPLITUDE: time 0 must be greater than 0",
        ),
    ] {
        if new.contains("not/there") {
            refused(ErrorKind::Io, old, new, expected);
        } else {
            input(old, new, expected);
        }
    }
}

#[test]
fn what_brinell_does_not_have_is_told_by_line_and_reason() {
    let before = "*SOLID SECTION, ELSET=BODY";
    for (old, new, expected) in [
        (
            "TYPE=CPE4",
            "TYPE=S9R5",
            "line 8: *ELEMENT: TYPE=S9R5: shells and membranes are not",
        ),
        (
            before,
            "*SHELL SECTION, ELSET=BODY",
            "bodies are continua: there are no shells, beams or membranes",
        ),
        (
            "*CLOAD",
            "*MODEL CHANGE, REMOVE\nBODY\n*CLOAD",
            "*MODEL CHANGE: elements are the same in all steps",
        ),
        (
            "TYPE=CPE4",
            "TYPE=T3D2T",
            "TYPE=T3D2T: beams and trusses are not",
        ),
        (
            "*STATIC\n1., 1.",
            "*DYNAMIC\n0.1, 1.",
            "line 20: *DYNAMIC: loads are applied slowly",
        ),
        (
            "*STATIC\n1., 1.",
            "*FREQUENCY\n3",
            "line 20: *FREQUENCY: loads are applied slowly",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*DLOAD\nBODY, BX, 9810.",
            "line 23: *DLOAD: BX: of loads on volumes GRAV and CENTRIF are there",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*DLOAD\nBODY, CENTRIF, 4., 0., 0., 0., 1., 0., 0.",
            "line 23: *DLOAD: CENTRIF turns plane models about an axis along z",
        ),
        (
            "*CLOAD\n3, 2, 5.",
            "*TEMPERATURE\nBASE, 100.\n*END STEP\n*STEP\n*STATIC\n*TEMPERATURE\n3, 50.",
            "line 28: *TEMPERATURE: the temperatures of nodes 1 and 3 of body BODY do not change",
        ),
        (
            before,
            "*ELASTIC\n2., 0.3, 0.\n1., 0.3, 9.\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\n3, \
             5.\n*SOLID SECTION, ELSET=BODY",
            "depends on temperature, and body BODY has several: moduli and yield stresses",
        ),
        (
            before,
            "*PLASTIC, HARDENING=KINEMATIC\n300., 0.\n350., 0.01\n370., 0.02\n*SOLID SECTION, \
             ELSET=BODY",
            "line 15: *PLASTIC: kinematic hardening of a deck is linear",
        ),
        (
            before,
            "*PLASTIC, HARDENING=COMBINED\n300., 0.\n*SOLID SECTION, ELSET=BODY",
            "line 15: *PLASTIC: hardening of decks is isotropic or linear kinematic",
        ),
        (
            before,
            "*CREEP\n1., 1., 1.\n*SOLID SECTION, ELSET=BODY",
            "line 15: *CREEP: materials are isotropic",
        ),
        (
            before,
            "*FRICTION\n0.2\n*SOLID SECTION, ELSET=BODY",
            "line 15: *FRICTION: contact is frictionless",
        ),
        (
            before,
            "*DISTRIBUTING\n1, 2\n*SOLID SECTION, ELSET=BODY",
            "*DISTRIBUTING: nodes are tied by",
        ),
        (
            before,
            "*TIE, NAME=T, CYCLIC SYMMETRY\nA, B\n*SOLID SECTION, ELSET=BODY",
            "line 15: *TIE: there is no cyclic symmetry",
        ),
        (
            before,
            "*MPC\nTIE, 1, 2\n*SOLID SECTION, ELSET=BODY",
            "line 15: *MPC: nodes are tied by",
        ),
        (
            before,
            "*COUPLING, REF NODE=1, SURFACE=S, ORIENTATION=O\n*KINEMATIC\n1, 2\n*SOLID SECTION, \
             ELSET=BODY",
            "*COUPLING: ORIENTATION",
        ),
        (
            before,
            "*PRE-TENSION SECTION, NODE=1\n*SOLID SECTION, ELSET=BODY",
            "*PRE-TENSION SECTION",
        ),
        (
            before,
            "*EQUATION\n2\n3, 4, 1., 4, 1, 2.\n*SOLID SECTION, ELSET=BODY",
            "*EQUATION: degree of freedom 4 is none of a node here",
        ),
    ] {
        refused(ErrorKind::Unsupported, old, new, expected);
    }
    // All lines that are refused are told at once.
    let text = DECK
        .replace("*STATIC", "*DYNAMIC")
        .replace(before, "*CREEP\n1.\n*SOLID SECTION, ELSET=BODY");
    let message = error(&text).unwrap().to_string();
    assert!(
        message.contains("*CREEP") && message.contains("*DYNAMIC"),
        "{message}"
    );
    // Small strains where the user says so.
    let deck = Deck::parse(
        DECK.replace("*STEP\n", "*STEP, NLGEOM\n")
            .replace("*END STEP, NLGEOM", "*END STEP")
            .as_bytes(),
        "deck.inp",
    );
    let conversion = deck
        .unwrap()
        .convert(Options {
            small_strain: true,
            ..Options::default()
        })
        .unwrap();
    assert!(conversion.account.taken[0].text.contains("NLGEOM"));
}

#[test]
fn what_changes_nothing_is_ignored_with_its_reason() {
    let text = DECK.replace(
        "*SOLID SECTION",
        "*SPECIFIC HEAT\n4e8\n*CONDUCTIVITY\n50.\n*FRICTION\n0.\n*CONTROLS, \
         PARAMETERS=FIELD\n1\n*SOLID SECTION",
    );
    assert!(error(&text).is_none());
    let deck = Deck::parse(text.as_bytes(), "deck.inp").unwrap();
    let ignored: Vec<String> = deck
        .account()
        .ignored
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(ignored.len(), 3, "{ignored:#?}");
    assert_eq!(
        ignored[0],
        "deck.inp, line 15: *SPECIFIC HEAT: temperatures are prescribed: no heat flows"
    );
    assert_eq!(
        deck.account().understood["NODE"],
        (1, "deck.inp, line 3".to_string())
    );
}
