//! The printed summaries: required content, and width of the page.

use super::*;
use crate::linalg::Backend;
use crate::model::Model;
use crate::results::{Counts, HistoryRow, Incomplete};
use std::path::PathBuf;

fn scene() -> Scene {
    let text = include_str!("../../../data/scenes/cylinder_on_half_plane.toml");
    Scene::parse(text, "scene.toml").unwrap()
}

fn report(of: &Results, out: Option<&Path>) -> String {
    let header = RunHeader::new(&Model::new(&scene()).unwrap(), Backend::Dense, 5.0);
    results(&scene(), &header, of, 5.0, out)
}

/// An effect that is on, one that nobody asked for, and one that is off though asked for.
fn effects() -> Vec<Effect> {
    vec![
        Effect {
            name: "contact".into(),
            on: true,
            asked: true,
            why: "the scene pairs cylinder.contact with half_plane.contact; ".repeat(4),
            seconds: 0.1234,
            memory_bytes: 1_500_000,
        },
        Effect {
            name: "interference".into(),
            on: false,
            asked: false,
            why: "no contact has one".into(),
            seconds: 0.0,
            memory_bytes: 0,
        },
        Effect {
            name: "temperature".into(),
            on: false,
            asked: true,
            why: "no temperature changes".into(),
            seconds: 0.0,
            memory_bytes: 0,
        },
    ]
}

fn full() -> Results {
    let name = "a state with a name that is much longer than anybody would want to read in a table";
    Results {
        sizes: Sizes {
            freedoms: 12345678,
            nodes: 6180001,
            elements: 6100000,
            contact_pairs: 4321,
            zone_freedoms: 98765,
            zone_elements: 54321,
            ..Sizes::default()
        },
        effects: effects(),
        first_yield: Some(YieldPoint {
            alpha: 0.217,
            load: 217.0,
            max_pressure: 896.85,
            half_width: 0.15543,
            half_width_reading: Default::default(),
            location: [0.0, -0.10947, 0.0],
            body: 1,
        }),
        states: vec![State {
            name: name.into(),
            alpha: 1.0515,
            load: -1234567.8,
            max_pressure: 1234.5678,
            half_width: 1.6e-7,
            residual_depth: -1.234567e-12,
            plastic_points: 1234567,
            max_equivalent_plastic_strain: 1.2345678e-5,
            fields: Some(Default::default()),
            ..State::default()
        }],
        history: vec![HistoryRow::default(); 3],
        timings: vec![("assembly".into(), 1.0), ("factorisation".into(), 3.0)],
        counts: Counts {
            factorizations: 1,
            zone_factorizations: 0,
            trailing_solves: 1234,
            full_solves: 12,
            plastic_iterations: 345,
            contact_changes: 67,
            hard_increments: 2,
        },
        quality: Quality {
            backward_error: 1.234e-16,
            componentwise_error: Some(4.56e-16),
            round_off: Some(7.8e-14),
            equilibrium: 3.2e-11,
            complementarity: 0.0,
            penetration: 0.0,
            adhesion: 0.0,
        },
        factor: Prediction {
            ordering: "camd".into(),
            factor_nonzeros: 1.5e6,
            flops: 3.25e9,
            trailing_nonzeros: 4.5e4,
            memory_bytes: 24.3e6,
            memory_by_rank: Vec::new(),
        },
        reference: vec![ReferenceRow {
            quantity: "yield.max_pressure".into(),
            reference: 896.85,
            computed: 893.9,
            ratio: 0.99671,
            published_ratio: Some(0.94),
            source: "Hertz line contact at first yield, von Mises with nu = 0.3; paper Table I"
                .into(),
        }],
        warnings: vec!["something that the user should know and read to its end; ".repeat(4)],
        ..Results::default()
    }
}

#[test]
fn a_report_fits_the_page_and_holds_every_section() {
    let text = report(&full(), Some(&PathBuf::from("cylinder.out")));
    for line in text.lines() {
        assert!(line.chars().count() <= page_width(), "too wide: {line}");
        assert_eq!(line, line.trim_end(), "blanks at the end: {line:?}");
    }
    for fragment in [
        "Cylinder on a half plane, linear hardening (Endahl 5.1) (plane strain)\n",
        "6100000 elements, 6180001 nodes, 12345678 freedoms, 4321 contact pairs",
        "order camd, 1500000 nonzeros (3.0 % trailing), 3.25e9 flops, 24 MB",
        "\nEffects\n",
        "0.123 s",
        "1.5 MB",
        "\nFirst yield\n",
        "0.217000  217.000",
        "half_plane",
        "-0.109470",
        "  [N/mm]",
        "[MPa]",
        "\nStates (load factor 1 is first yield)\n",
        "1.05150",
        "-1234568",
        "-1.23457e-12",
        "\nReference values\n",
        "0.996710",
        "0.94",
        "backward error 1.2e-16 (row by row 4.6e-16), equilibrium 3.2e-11 (round-off",
        "3 increments, 1 factorization, 1234 trailing solves",
        "factorisation  3.000 s   60 %",
        "total          5.000 s",
        "\nWarnings\n  - something",
        "Results in cylinder.out: summary.json, history.csv, contact.csv, fields.pvd\n",
    ] {
        assert!(text.contains(fragment), "no {fragment:?} in\n{text}");
    }
    assert!(!text.contains("INCOMPLETE"));
}

#[test]
fn an_effect_that_is_off_has_no_cost() {
    let text = report(&full(), None);
    let line = text.lines().find(|l| l.contains("temperature")).unwrap();
    let cells: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(cells[1], "off");
    assert_eq!(cells[cells.len() - 2..], ["-", "-"]);
    // An effect that nobody asked for gets no line of its own.
    assert!(text.contains("\n  off: interference (why"), "{text}");
    assert!(!text.contains("Results in"));
}

#[test]
fn what_there_is_nothing_of_is_left_out() {
    let text = report(&Results::default(), None);
    for heading in [
        "Effects",
        "First yield",
        "States",
        "Reference",
        "Time",
        "Warnings",
        "Factor",
    ] {
        assert!(!text.contains(heading), "{heading} in\n{text}");
    }
}

#[test]
fn columns_are_those_that_tell_something() {
    let mut results = full();
    results.states[0].name = "pulled".into();
    results.states[0].pole_pressure = results.states[0].max_pressure;
    let plain = report(&results, None);
    for heading in ["half", "residual", "approach"] {
        assert!(plain.contains(heading), "{plain}");
    }
    assert!(
        !plain.contains("[deg]") && !plain.contains("displace-"),
        "{plain}"
    );
    results.states[0].contact_arc = Some([-0.0, 19.4855]);
    let state = results.states[0].clone();
    results.states.push(State {
        contact_arc: None,
        name: "parted".into(),
        ..state
    });
    let arc = report(&results, None);
    assert!(arc.contains("[deg]") && !arc.contains("approach"), "{arc}");
    let row = |name: &str| arc.lines().find(|l| l.contains(name)).unwrap().to_string();
    assert!(row("pulled").contains(" 0.00  19.49 "), "{arc}");
    assert!(row("parted").contains(" -      - "), "{arc}");
    results.sizes.contact_pairs = 0;
    let lone = report(&results, None);
    assert!(lone.contains("displace-"), "{lone}");
    for heading in ["pole", "arc ", "residual"] {
        assert!(!lone.contains(heading), "{lone}");
    }
}

#[test]
fn an_incomplete_run_says_so() {
    let mut partial = full();
    partial.incomplete = Some(Incomplete {
        kind: crate::ErrorKind::Stopped,
        why: "stopped at load factor 1.2".into(),
    });
    let text = report(&partial, None);
    assert!(
        text.contains("\nINCOMPLETE: stopped at load factor 1.2\n"),
        "{text}"
    );
}

#[test]
fn a_check_tells_effects_cost_and_notes() {
    let full = full();
    let prediction = Check {
        effects: full.effects,
        sizes: full.sizes,
        prediction: full.factor,
        available_bytes: Some(8e9),
        contact: Default::default(),
        predicted_seconds: 12.34,
        predicted_run_seconds: 56.78,
        blas: "OpenBLAS 0.3.21".into(),
        error_estimate: "runs with elements 1.5 and 2 times as large".into(),
        notes: vec!["use a finer mesh".into()],
    };
    let text = check(&scene(), &prediction, false);
    for fragment in [
        "Predicted  about 12.3 s for each factorisation, 56.8 s for the run without its error",
        "\nErrors     runs with elements 1.5 and 2 times as large\n",
        "\nEffects\n",
        "\nNotes\n  - use a finer mesh\n",
        "  off: interference (why: `brinell check --effects`)\n",
    ] {
        assert!(text.contains(fragment), "no {fragment:?} in\n{text}");
    }
    assert!(
        text.lines()
            .all(|line| line.chars().count() <= page_width())
    );
    assert!(!text.contains("no contact has one"), "{text}");
    assert!(text.contains("\nMemory     the run fits: about "), "{text}");
    let bytes = prediction.prediction.memory_bytes;
    for (available, fits, said) in [
        (Some(bytes), Some(true), "the run fits"),
        (
            Some(0.99 * bytes),
            Some(false),
            "the run does not fit: about ",
        ),
        (None, None, "how much is available is not known"),
    ] {
        let other = Check {
            available_bytes: available,
            ..prediction.clone()
        };
        assert_eq!(other.fits(), fits);
        assert!(check(&scene(), &other, false).contains(said));
    }
    let all = check(&scene(), &prediction, true);
    assert!(
        all.contains("no contact has one") && !all.contains("off: "),
        "{all}"
    );
}
