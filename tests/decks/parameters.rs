//! Parameters and forms that Abaqus/CAE and CalculiX accept: they change nothing here, are
//! understood, or are refused by their names.

use brinell::deck::{Deck, Options};
use brinell::{Error, Result};

/// Two blocks in contact, the upper one pressed down.
const DECK: &str = "\
*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 0., 1.
6, 1., 1.
7, 1., 2.
8, 0., 2.
*NSET, NSET=\"1\"
1, 2
*ELEMENT, TYPE=CPE4, ELSET=BLOCKS
1, 1, 2, 3, 4
2, 5, 6, 7, 8
*SURFACE, NAME=FLOOR
1, S3
*SURFACE, NAME=FACE
2, S1
*SURFACE, NAME=TOP
2, S3
*AMPLITUDE, NAME=A
0., 0., 1., 1.
*MATERIAL, NAME=STEEL
*DENSITY
1.
*ELASTIC
210000., 0.3
*PLASTIC
300., 0.
400., 0.1
*SOLID SECTION, ELSET=BLOCKS, MATERIAL=STEEL
1.
*SURFACE INTERACTION, NAME=SMOOTH
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
*CONTACT PAIR, INTERACTION=SMOOTH, TYPE=SURFACE TO SURFACE
FACE, FLOOR
*BOUNDARY
1, 1, 2
2, 2
5, 1
8, 1
*STEP, NLGEOM=NO
*STATIC
1., 1., 1e-5, 1.
*DSLOAD, AMPLITUDE=A
TOP, P, 10.
*DLOAD
BLOCKS, GRAV, 10., 0., -1.
*OUTPUT, FIELD
*END STEP
";

fn changed(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(DECK.to_string(), |text, (old, new)| {
        assert_eq!(text.matches(old).count(), 1, "{old}");
        text.replace(old, new)
    })
}

/// The scene of a deck, and the remarks on the deck.
fn converted(text: &str) -> Result<(String, String)> {
    let deck = Deck::parse(text.as_bytes(), "deck.inp")?;
    let conversion = deck.convert(Options::default())?;
    conversion.finish("deck.inp", &[])?;
    let account = &conversion.account;
    let notes = account.taken.iter().chain(&account.ignored);
    let notes: Vec<String> = notes.map(ToString::to_string).collect();
    Ok((conversion.scene.to_toml()?, notes.join("\n")))
}

#[track_caller]
fn same(old: &str, new: &str) {
    let found = converted(&changed(&[(old, new)])).unwrap_or_else(|error| panic!("{new}: {error}"));
    assert_eq!(found.0, converted(DECK).unwrap().0, "{new}");
}

fn refused(old: &str, new: &str) -> Error {
    let found = converted(&changed(&[(old, new)]));
    found.err().unwrap_or_else(|| panic!("taken: {new}"))
}

#[test]
fn requests_for_output_are_read_over() {
    for keyword in [
        "*INTEGRATED OUTPUT, SURFACE=TOP\nSOF\n",
        "*DIAGNOSTICS, CONTACT=YES\n",
        "*INCREMENTATION OUTPUT\nDT\n",
        "*ELEMENT MATRIX OUTPUT, STIFFNESS=YES\n",
        "*FILTER, NAME=F\n",
    ] {
        let text = changed(&[("*OUTPUT, FIELD\n", keyword)]);
        let notes = converted(&text).unwrap().1;
        let name = keyword.split([',', '\n']).next().unwrap();
        assert!(notes.contains(&format!("{name}: output: ")), "{notes}");
    }
}

/// `*OUTPUT, HISTORY` is for requests of Abaqus, `*NODE OUTPUT`: a request of CalculiX that follows
/// writes its file.
#[test]
fn a_file_is_written_behind_a_history() {
    let items = |request: &str| {
        let text = changed(&[("*OUTPUT, FIELD\n", request)]);
        let deck = Deck::parse(text.as_bytes(), "deck.inp").unwrap();
        let conversion = deck.convert(Options::default()).unwrap();
        let moments = &conversion.scene.requests.moments;
        moments
            .iter()
            .map(|moment| moment.file.len())
            .sum::<usize>()
    };
    let file = items("*NODE FILE\nU\n");
    assert!(file > 0);
    assert_eq!(
        items("*OUTPUT, HISTORY\n*NODE OUTPUT\nU\n*NODE FILE\nU\n"),
        file
    );
    assert_eq!(items("*OUTPUT, HISTORY\n*NODE OUTPUT\nU\n"), 0);
}

/// A speed whose square becomes negative is none.
#[test]
fn the_square_of_a_speed_is_not_negative() {
    let turning = |last: &str| {
        changed(&[
            (
                "*AMPLITUDE, NAME=A\n0., 0., 1., 1.",
                &format!("*AMPLITUDE, NAME=A\n0., 0., 1., {last}"),
            ),
            (
                "*DLOAD\nBLOCKS, GRAV, 10., 0., -1.",
                "*DLOAD, AMPLITUDE=A\nBLOCKS, CENTRIF, 4., 0., 0., 0., 0., 0., 1.",
            ),
        ])
    };
    assert!(converted(&turning("0.5")).is_ok());
    let error = converted(&turning("-0.5")).unwrap_err().to_string();
    assert!(
        error.contains("*DLOAD: CENTRIF: the square of the speed becomes -2"),
        "{error}"
    );
}

#[test]
fn parameters_that_change_nothing_are_read_over() {
    let pair = "TYPE=SURFACE TO SURFACE";
    for (old, more) in [
        (
            "*STATIC",
            ", STABILIZE, FACTOR=0.0002, ALLSDTOL=0, CONTINUE=NO",
        ),
        ("NLGEOM=NO", ", CONVERT SDI=NO, SOLVER=ITERATIVE"),
        ("*DSLOAD, AMPLITUDE=A", ", FOLLOWER=NO"),
        ("*DSLOAD, AMPLITUDE=A", ", CONSTANT RESULTANT=YES"),
        (pair, ", CPSET=C"),
        (pair, ", NO THICKNESS"),
        (pair, ", SUPPLEMENTARY CONSTRAINTS=NO"),
        (pair, ", MINIMUM DISTANCE=YES"),
        ("*PLASTIC", ", EXTRAPOLATION=CONSTANT, DEPENDENCIES=0"),
        ("PRESSURE-OVERCLOSURE=HARD", ", DIRECT"),
        ("*SURFACE INTERACTION, NAME=SMOOTH", ", PAD THICKNESS=0."),
        ("*ELASTIC", ", DEPENDENCIES=0, MODULI=LONG TERM"),
        ("*DENSITY", ", DEPENDENCIES=0"),
        ("MATERIAL=STEEL\n1.", ", STACK DIRECTION=3\n1."),
        ("MATERIAL=STEEL\n1.", ", REF NODE=7, LAYUP=L, SYMMETRIC\n1."),
    ] {
        let new = match old.split_once('\n') {
            Some((line, _)) => format!("{line}{more}"),
            None => format!("{old}{more}"),
        };
        same(old, &new);
    }
}

/// No set in front of a weight means all elements; values of an amplitude may be the load's own, or
/// be evenly spaced; a set may have a number as its name.
#[test]
fn other_forms_mean_the_same() {
    same("BLOCKS, GRAV", ", GRAV");
    same(
        "*AMPLITUDE, NAME=A\n0., 0., 1., 1.",
        "*AMPLITUDE, NAME=A, DEFINITION=EQUALLY SPACED, FIXED INTERVAL=1.\n0., 1.",
    );
    same(
        "NAME=A\n0., 0., 1., 1.",
        "NAME=A, SHIFTX=-1., SHIFTY=0.5\n1., -0.5, 2., 0.5",
    );
    same("TOP, P, 10.", "TOP, P, 1.+1, 0., 0.0");
    let of_macintosh = converted(&DECK.replace('\n', "\r")).unwrap();
    assert_eq!(of_macintosh.0, converted(DECK).unwrap().0);
    let absolute = changed(&[
        (
            "NAME=A\n0., 0., 1., 1.",
            "NAME=A, VALUE=ABSOLUTE\n0., 0., 1., 10.",
        ),
        ("TOP, P, 10.", "TOP, P, 77."),
    ]);
    assert_eq!(converted(&absolute).unwrap().0, converted(DECK).unwrap().0);
    let [named, plain] = ["\"1\"", "BASE"].map(|name| {
        let held = format!("1, 1\n{name}, 2, 2");
        converted(&changed(&[
            ("NSET=\"1\"", &format!("NSET={name}")),
            ("1, 1, 2\n2, 2", &held),
        ]))
    });
    let [named, plain] = [named.unwrap().0, plain.unwrap().0];
    assert_ne!(named, plain);
    assert_eq!(named.replace("\"1\"", "\"BASE\""), plain);
    let error = refused("BLOCKS, GRAV, 10., 0., -1.", ", P1, 10.").to_string();
    assert!(
        error.contains("line 48: *DLOAD: a pressure acts on faces"),
        "{error}"
    );
}

#[test]
fn parameters_that_would_change_results_are_refused() {
    for (old, more, expected) in [
        (
            "*STATIC",
            ", FACTOR=0.1",
            "*STATIC: FACTOR belongs to STABILIZE",
        ),
        (
            "*SURFACE INTERACTION, NAME=SMOOTH",
            ", PAD THICKNESS=0.1",
            "PAD THICKNESS=0.1: surfaces touch",
        ),
        (
            "*DENSITY",
            ", DEPENDENCIES=1",
            "*DENSITY: DEPENDENCIES=1: materials depend on no",
        ),
        (
            "*SOLID SECTION, ELSET=BLOCKS",
            ", NODAL THICKNESS",
            "NODALTHICKNESS: the thickness of a plane model is one number",
        ),
        (
            "*SOLID SECTION, ELSET=BLOCKS",
            ", COMPOSITE",
            "COMPOSITE: layers are elements of their own",
        ),
        ("TOP, P, 10.", ", 000", "`000` is one value too many"),
        (
            "*AMPLITUDE, NAME=A",
            ", DEFINITION=SMOOTH STEP",
            "give the curve as a table",
        ),
        (
            "*AMPLITUDE, NAME=A",
            ", FIXED INTERVAL=1.",
            "belongs to DEFINITION=EQUALLY SPACED",
        ),
        (
            "TYPE=SURFACE TO SURFACE",
            ", TIED",
            "ADJUST=..., or a *TIE instead",
        ),
        (
            "*PLASTIC",
            ", HARDENING=COMBINED",
            "give HARDENING=ISOTROPIC or HARDENING=KINEMATIC",
        ),
    ] {
        let error = refused(old, &format!("{old}{more}")).to_string();
        assert!(error.starts_with("deck.inp, line "), "{error}");
        assert!(error.contains(expected), "{error}");
    }
}

/// A curve that goes on along its last slope; surfaces in contact that are tied.
#[test]
fn extrapolation_and_tied_contact_are_understood() {
    let text = changed(&[("*PLASTIC", "*PLASTIC, EXTRAPOLATION=LINEAR")]);
    let conversion = Deck::parse(text.as_bytes(), "deck.inp").unwrap();
    let conversion = conversion.convert(Options::default()).unwrap();
    let table = conversion.scene.materials["STEEL"].hardening_table.clone();
    let table = table.unwrap();
    let [.., [from, low], [to, high]] = table[..] else {
        panic!("{table:?}");
    };
    assert!(
        ((high - low) / (to - from) - 1000.0).abs() < 1e-6,
        "{table:?}"
    );
    assert!(to > 100.0);
    let pair = "*CONTACT PAIR, INTERACTION=SMOOTH, TYPE=SURFACE TO SURFACE";
    let tied = changed(&[(pair, &format!("{pair}, ADJUST=0.1, TIED"))]);
    let tie = changed(&[(pair, "*TIE, NAME=T, POSITION TOLERANCE=0.1")]);
    assert_eq!(converted(&tied).unwrap().0, converted(&tie).unwrap().0);
}

/// Elements that are not there are left out of surfaces, as out of sets.
#[test]
fn surfaces_leave_out_what_is_not_there() {
    let more = changed(&[("TOP\n2, S3", "TOP\n77, S3\n2, S3\n78, S3")]);
    let plain = changed(&[("TOP\n2, S3", "TOP\n2, S3\n**\n**")]);
    let (found, notes) = converted(&more).unwrap();
    assert_eq!(found, converted(&plain).unwrap().0);
    let expected = "line 20: *SURFACE: TOP: there is no element 77, nor 1 more: left out";
    assert!(notes.contains(expected), "{notes}");
    let error = refused("TOP\n2, S3", "TOP\n77, S3").to_string();
    assert_eq!(error, "deck.inp, line 20: *SURFACE: there is no element 77");
}

/// `OP` is that of the first keyword of a kind in a step.
#[test]
fn a_later_new_in_a_step_has_no_effect() {
    let step = |first: &str, second: &str| {
        let more = format!(
            "*END STEP\n*STEP\n*STATIC\n*CLOAD{first}\n7, 2, -1.\n*CLOAD{second}\n8, 2, -1.\n\
             *DLOAD\n2, P3, 10.\n*END STEP\n"
        );
        let base = changed(&[(
            "*DLOAD\nBLOCKS, GRAV, 10., 0., -1.",
            "*CLOAD\n8, 1, 3.\n7, 1, 3.",
        )]);
        converted(&base.replace("*END STEP\n", &more)).unwrap()
    };
    let (kept, notes) = step("", ", OP=NEW");
    assert_eq!(kept, step("", "").0);
    assert!(
        notes.contains("*CLOAD: OP=NEW has no effect after another"),
        "{notes}"
    );
    let (renewed, notes) = step(", OP=NEW", "");
    assert_ne!(kept, renewed);
    assert!(!notes.contains("OP=NEW"), "{notes}");
}
