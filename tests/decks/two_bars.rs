//! Two bars on top of each other, of nodes that face each other, under the conditions that decks
//! state in several ways: all in closed form, since Poisson's ratio is 0.

use super::deck;
use brinell::analysis::Analysis;
use brinell::deck::Options;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::results::Results;
use brinell::{Error, Result};

/// Bars of 2 x 1 (elastic modulus E), the lower one held at its bottom, the upper one at the height
/// 1 - `overlap`, with what stands before the step and in it.
fn bars(overlap: f64, before: &str, step: &str) -> String {
    let low = 1.0 - overlap;
    let high = 2.0 - overlap;
    format!(
        "*NODE, NSET=ALL
1,0.,0.\n2,1.,0.\n3,2.,0.\n4,0.,1.\n5,1.,1.\n6,2.,1.
11,0.,{low:?}\n12,1.,{low:?}\n13,2.,{low:?}\n14,0.,{high:?}\n15,1.,{high:?}\n16,2.,{high:?}
*ELEMENT, TYPE=CPE4, ELSET=LOW
1,1,2,5,4\n2,2,3,6,5
*ELEMENT, TYPE=CPE4, ELSET=UPP
11,11,12,15,14\n12,12,13,16,15
*NSET, NSET=BOT\n1,2,3
*NSET, NSET=LID\n14,15,16
*NSET, NSET=UPN\n11,12,13,14,15,16
*SURFACE, NAME=M\n1,S3\n2,S3
*SURFACE, NAME=SA\n11,S1
*SURFACE, NAME=SB\n12,S1
*SURFACE, NAME=S\n11,S1\n12,S1
*SURFACE, NAME=TOP\n11,S3\n12,S3
*MATERIAL, NAME=STEEL
*ELASTIC\n{E:?},0.
*SOLID SECTION, ELSET=LOW, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPP, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=SI
*BOUNDARY\nBOT,1,2\n11,1,1\n14,1,1
{before}
*STEP
*STATIC
{step}
*NODE PRINT, NSET=ALL\nU
*END STEP\n"
    )
}

const E: f64 = 1000.0;

fn pair(slave: &str, master: &str) -> String {
    format!("*CONTACT PAIR, INTERACTION=SI, TYPE=SURFACE TO SURFACE\n{slave},{master}\n")
}

fn computed(text: &str) -> Result<(Model, Results)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bars.inp");
    std::fs::write(&path, text).unwrap();
    let scene = deck::load_with(
        &path,
        &[],
        Options {
            increments: true,
            ..Options::default()
        },
    )?;
    let model = Model::new(&scene)?;
    let mut analysis = Analysis::new(model.clone(), Backend::default())?;
    let results = analysis.run(&mut Silent)?;
    assert!(results.incomplete.is_none(), "{:?}", results.incomplete);
    Ok((model, results))
}

/// Displacement along y of a node, by its number in the deck, in each state.
fn moved((model, results): &(Model, Results), label: u64) -> Vec<f64> {
    let mesh = &model.continuum.mesh;
    let node = mesh.node_labels.iter().position(|l| *l == label).unwrap();
    let of =
        |state: &brinell::results::State| state.fields.as_ref().unwrap().displacement[2 * node + 1];
    results.states.iter().map(of).collect()
}

fn refused(text: &str, words: &[&str]) {
    let error: Error = computed(text).expect_err("it is refused");
    for word in words {
        assert!(error.message().contains(word), "{error} lacks {word}");
    }
}

fn near(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-9 * expected.abs().max(1e-6),
        "{found} for {expected}"
    );
}

/// A pressure of 1 shortens each bar by 1/E, however the contact is cut into pairs of surfaces.
#[test]
fn contacts_that_share_nodes_are_one() {
    let both = pair("SA", "M") + &pair("SB", "M");
    let ways = [
        pair("S", "M"),
        both.clone(),
        pair("SB", "M") + &pair("SA", "M"),
        pair("S", "M") + &pair("M", "S"),
        pair("M", "S") + &pair("S", "M"),
        both + &pair("M", "S"),
    ];
    for pairs in ways {
        let run = computed(&bars(0.0, &pairs, "*DSLOAD\nTOP,P,1.")).unwrap();
        for (label, expected) in [
            (15, -2.0 / E),
            (16, -2.0 / E),
            (12, -1.0 / E),
            (5, -1.0 / E),
        ] {
            near(moved(&run, label)[0], expected);
        }
        let state = &run.1.states[0];
        let area: f64 = run.0.pairs.iter().map(|pair| pair.area).sum();
        near(area, 2.0);
        near(state.contact_force, 2.0);
        state.pairs.iter().for_each(|pair| near(pair.pressure, 1.0));
    }
}

/// A displacement given to a node of a contact would leave its force out.
#[test]
fn moved_nodes_of_a_contact_are_refused() {
    for nodes in ["UPN", "12"] {
        let step = format!("*BOUNDARY\n{nodes},2,2,-0.001");
        let text = bars(0.0, &pair("S", "M"), &step);
        refused(&text, &["contact", "displacement"]);
    }
    let step = "*BOUNDARY\nLID,2,2,-0.002";
    let run = computed(&bars(0.0, &pair("S", "M"), step)).unwrap();
    near(moved(&run, 12)[0], -0.001);
}

/// The last line before the steps holds; `OP=NEW` in the first step releases what it does not
/// repeat.
#[test]
fn the_last_displacement_before_the_steps_counts() {
    let press = "*DSLOAD\nTOP,P,1.";
    let before = |lines: &str| pair("S", "M") + "*BOUNDARY\n" + lines;
    for (lines, expected) in [
        ("LID,2,2,-0.002", -0.002),
        ("LID,2,2,-0.002\nLID,2,2", 0.0),
        ("LID,2,2\nLID,2,2,-0.002", -0.002),
        ("LID,2,2,-0.001\nLID,2,2,-0.002", -0.002),
    ] {
        let run = computed(&bars(0.0, &before(lines), press)).unwrap();
        near(moved(&run, 15)[0], expected);
    }
    let renewed = format!("*BOUNDARY, OP=NEW\nBOT,1,2\n11,1,1\n14,1,1\n{press}");
    let run = computed(&bars(0.0, &before("LID,2,2,-0.005"), &renewed)).unwrap();
    near(moved(&run, 15)[0], -2.0 / E);
}

/// `ADJUST` moves overclosed nodes whatever its distance, and nodes apart within it.
#[test]
fn overclosed_nodes_are_adjusted_however_deep() {
    let with = |adjust: f64| {
        pair("S", "M").replace(
            "INTERACTION=SI",
            &format!("INTERACTION=SI, ADJUST={adjust:?}"),
        )
    };
    for adjust in [0.0, 1e-4] {
        let run = computed(&bars(0.001, &with(adjust), "*DSLOAD\nTOP,P,1.")).unwrap();
        // The bar is longer by the adjusted thousandth.
        near(moved(&run, 12)[0], -1.0 / E);
    }
    let lifted = bars(-0.001, &with(1e-4), "*BOUNDARY\nLID,2,2,-0.0005");
    near(moved(&computed(&lifted).unwrap(), 5)[0], 0.0);
}

/// An overlap is pushed apart in proportion to the time of the first step, and stays.
#[test]
fn an_overlap_grows_over_the_first_step() {
    let held = "*BOUNDARY\nLID,2,2";
    let text = bars(0.001, &pair("S", "M"), held);
    let quarter = text.replace("*STATIC\n", "*STATIC, DIRECT\n0.25, 1.\n");
    let run = computed(&quarter).unwrap();
    let found = moved(&run, 5);
    assert_eq!(found.len(), 4);
    for (number, found) in found.into_iter().enumerate() {
        near(found, -0.0005 * 0.25 * (number + 1) as f64);
    }
    let note = run.1.warnings.join("; ");
    assert!(note.contains("over load factors from 0 to 1"), "{note}");
    // A second step presses and a third lets go: the interference is there all the time.
    let more = "*STEP\n*STATIC\n*DSLOAD\nTOP,P,0.\n*END STEP\n";
    let run = computed(&(text + more + more)).unwrap();
    moved(&run, 5)
        .into_iter()
        .for_each(|found| near(found, -0.0005));
}

#[test]
fn a_clearance_needs_its_pair() {
    let before = pair("S", "M") + "*CLEARANCE, MASTER=S, SLAVE=M, VALUE=0.01";
    refused(
        &bars(0.0, &before, "*DSLOAD\nTOP,P,1."),
        &["*CLEARANCE", "no *CONTACT PAIR has M as its slave surface"],
    );
}

/// A body whose only support is a contact that a step removes goes through it: told.
#[test]
fn a_body_that_loses_its_contact_is_named() {
    let step = "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nS,M\n*DSLOAD\nTOP,P,1.";
    let (_, results) = computed(&bars(0.0, &pair("S", "M"), step)).unwrap();
    let told = results.inaccurate.join("; ");
    assert!(
        told.contains("though its surfaces are taken apart"),
        "{told}"
    );
}
