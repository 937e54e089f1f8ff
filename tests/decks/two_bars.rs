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

/// Sum of the forces along y on nodes, by their numbers in the deck, in the last state.
fn forces((model, results): &(Model, Results), labels: &[u64]) -> f64 {
    let mesh = &model.continuum.mesh;
    let fields = results.states.last().unwrap().fields.as_ref().unwrap();
    let of = |label: &u64| {
        let node = mesh.node_labels.iter().position(|l| l == label).unwrap();
        fields.force[2 * node + 1]
    };
    labels.iter().map(of).sum()
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

/// Nodes of a contact that are moved press on what they meet, whichever surface is the slave.
#[test]
fn moved_nodes_of_a_contact_press() {
    for pairs in [pair("S", "M"), pair("M", "S")] {
        // The whole upper bar moves as a rigid one.
        let run = computed(&bars(0.0, &pairs, "*BOUNDARY\nUPN,2,2,-0.001")).unwrap();
        near(moved(&run, 5)[0], -0.001);
        near(run.1.states[0].contact_force, 2.0 * E * 0.001);
        near(forces(&run, &[11, 12, 13, 14, 15, 16]), -2.0 * E * 0.001);
        near(forces(&run, &[1, 2, 3]), 2.0 * E * 0.001);
        // The contact nodes of the lower bar lift the upper one, and what presses on it goes into
        // what moves them.
        let step = "*BOUNDARY\nMID,2,2,0.001\n*DSLOAD\nTOP,P,1.";
        let before = format!("*NSET, NSET=MID\n4,5,6\n{pairs}");
        let run = computed(&bars(0.0, &before, step)).unwrap();
        near(moved(&run, 12)[0], 0.001);
        near(moved(&run, 15)[0], 0.001 - 1.0 / E);
        near(forces(&run, &[4, 5, 6]), 2.0 + 2.0 * E * 0.001);
        near(forces(&run, &[11, 12, 13]), 0.0);
        // Nodes behind the surface.
        let run = computed(&bars(0.0, &pairs, "*BOUNDARY\nLID,2,2,-0.002")).unwrap();
        near(moved(&run, 12)[0], -0.001);
    }
    // Both surfaces moved: nothing is left to find.
    let step = "*BOUNDARY\nUPN,2,2,-0.001\nMID,2,2,0.001";
    let before = format!("*NSET, NSET=MID\n4,5,6\n{}", pair("S", "M"));
    refused(&bars(0.0, &before, step), &["contact", "displacement"]);
}

/// Slave nodes that make up no face alone touch: a pressure of 1 goes through one node or two.
#[test]
fn single_nodes_press() {
    for (nodes, n) in [("12", 1), ("11\n13", 2), ("11\n12\n13", 3), ("12\n15", 1)] {
        let before = format!("*SURFACE, NAME=N, TYPE=NODE\n{nodes}\n{}", pair("N", "M"));
        let run = computed(&bars(0.0, &before, "*DSLOAD\nTOP,P,1.")).unwrap();
        assert_eq!(run.0.pairs.len(), n, "{nodes:?}");
        near(run.1.states[0].contact_force, 2.0);
        near(forces(&run, &[1, 2, 3]), 2.0);
    }
    // A node of the lid faces nothing.
    let before = format!("*SURFACE, NAME=N, TYPE=NODE\n15\n{}", pair("N", "M"));
    let text = bars(0.0, &before, "*DSLOAD\nTOP,P,1.");
    refused(
        &text,
        &[
            "*CONTACT PAIR",
            "no face at the nodes of N faces the surface M",
        ],
    );
    // What presses on faces needs faces.
    let before = format!("*SURFACE, NAME=N, TYPE=NODE\n15\n{}", pair("S", "M"));
    let text = bars(0.0, &before, "*DSLOAD\nN,P,1.");
    refused(&text, &["*DSLOAD", "N has no faces"]);
}

/// A node alone touches where it lies: the same as an equation with the functions of the face
/// there, on linear and on quadratic elements, in the middle of faces that do not match.
#[test]
fn a_single_node_follows_the_point_under_it() {
    let upper = "*NODE, NSET=ALL
31,0.4,1.\n32,1.5,1.\n33,1.5,2.\n34,0.4,2.\n35,0.95,1.\n36,1.5,1.5\n37,0.95,2.\n38,0.4,1.5
*NODE, NSET=ALL
41,0.,0.\n42,2.,0.\n43,2.,1.\n44,0.,1.\n45,1.,0.\n46,2.,0.5\n47,1.,1.\n48,0.,0.5
";
    let linear = "*ELEMENT, TYPE=CPE4, ELSET=L\n41,41,42,43,44
*ELEMENT, TYPE=CPE4, ELSET=U\n31,31,32,33,34\n";
    let quadratic = "*ELEMENT, TYPE=CPE8, ELSET=L\n41,41,42,43,44,45,46,47,48
*ELEMENT, TYPE=CPE8, ELSET=U\n31,31,32,33,34,35,36,37,38\n";
    let rest = format!(
        "*MATERIAL, NAME=STEEL\n*ELASTIC\n{E:?},0.3
*SOLID SECTION, ELSET=L, MATERIAL=STEEL
*SOLID SECTION, ELSET=U, MATERIAL=STEEL
*SURFACE, NAME=M\n41,S3
*SURFACE, NAME=N, TYPE=NODE\n31
*SURFACE INTERACTION, NAME=SI
"
    );
    // Functions of the upper side of the lower element at x = 0.4, from -1 to 1: s = -0.6.
    let s: f64 = -0.6;
    let on_line = [(44, 0.5 * (1.0 - s)), (43, 0.5 * (1.0 + s))];
    let on_parabola = [
        (44, 0.5 * s * (s - 1.0)),
        (43, 0.5 * s * (s + 1.0)),
        (47, 1.0 - s * s),
    ];
    for (elements, functions, held) in [
        (linear, &on_line[..], ""),
        (
            quadratic,
            &on_parabola[..],
            "45,1,2\n37,1,1\n37,2,2,-0.01\n",
        ),
    ] {
        let terms: String = functions
            .iter()
            .map(|(n, w)| format!("{n},2,{:?}\n", -w))
            .collect();
        let follows = format!("*EQUATION\n{}\n31,2,1.\n{terms}", functions.len() + 1);
        let [touching, following] = [pair("N", "M"), follows].map(|how| {
            computed(&format!(
                "{upper}{elements}{rest}{how}*BOUNDARY\n41,1,2\n42,1,2\n*STEP\n*STATIC\n*BOUNDARY\n\
                 33,1,1\n34,1,1\n33,2,2,-0.01\n34,2,2,-0.01\n{held}*END STEP\n"
            ))
            .unwrap()
        });
        assert_eq!(touching.0.pairs.len(), 1);
        for label in [31, 32, 43, 44] {
            near(moved(&touching, label)[0], moved(&following, label)[0]);
        }
        assert!(moved(&touching, 31)[0] < -1e-4);
    }
}

/// An overlap is resolved over the first step whether or not the deck asks for it.
#[test]
fn an_overlap_is_resolved_as_abaqus_does() {
    let step = |keyword: &str| format!("{keyword}\n*BOUNDARY\nLID,2,2");
    for keyword in [
        "*CONTACT INTERFERENCE, SHRINK\nS, M",
        "*CONTACT INTERFERENCE, TYPE=CONTACT PAIR\ns, m, 0.001",
    ] {
        let run = computed(&bars(0.001, &pair("S", "M"), &step(keyword))).unwrap();
        near(moved(&run, 5)[0], -0.0005);
    }
    for (keyword, word) in [
        (
            "*CONTACT INTERFERENCE, SHRINK\nS, X",
            "no *CONTACT PAIR has S",
        ),
        ("*CONTACT INTERFERENCE\nS, M, -0.1", "*CLEARANCE"),
        ("*CONTACT INTERFERENCE\nS, M, 0.1, 1., 0., 0.", "*CLEARANCE"),
        (
            "*CONTACT INTERFERENCE, AMPLITUDE=A\nS, M, 0.1",
            "give SHRINK",
        ),
        (
            "*CONTACT INTERFERENCE, TYPE=ELEMENT\nS, 0.1",
            "TYPE=ELEMENT",
        ),
    ] {
        let text = bars(0.001, &pair("S", "M"), &step(keyword));
        refused(&text, &["*CONTACT INTERFERENCE", word]);
    }
}

/// Displacement, and force in total, of nodes that belong to no element, as tables list them.
#[test]
fn reference_nodes_have_displacements_and_forces() {
    let body = "*NODE, NSET=REF\n100,3.,2.\n101,3.,2.\n*NODE, NSET=NONE\n102,9.,9.
*RIGID BODY, NSET=LID, REF NODE=100, ROT NODE=101\n";
    let prints = "*NODE PRINT, NSET=REF\nU,RF\n*NODE PRINT, NSET=NONE\nU
*NODE PRINT, NSET=LID, TOTALS=ONLY\nRF";
    let before = pair("S", "M") + body;
    let step = format!("*BOUNDARY\n100,1,2\n101,3,3\n100,2,2,-0.002\n{prints}");
    let (model, results) = computed(&bars(0.0, &before, &step)).unwrap();
    let work = tempfile::tempdir().unwrap();
    let path = work.path().join("bars.dat");
    brinell::output::write_prints(&path, &model, &results).unwrap();
    let text = std::fs::read_to_string(path).unwrap();
    let rows = |head: &str| -> Vec<Vec<f64>> {
        let from = text
            .split(head)
            .nth(1)
            .unwrap_or_else(|| panic!("{head}: {text}"));
        let rows = from.lines().skip(2).take_while(|line| !line.is_empty());
        rows.map(|row| row.split_whitespace().map(|x| x.parse().unwrap()).collect())
            .collect()
    };
    assert_eq!(
        rows("displacements (vx,vy,vz) for set REF"),
        [[100.0, 0.0, -0.002, 0.0], [101.0, 0.0, 0.0, 0.0]]
    );
    assert_eq!(
        rows("displacements (vx,vy,vz) for set NONE"),
        [[102.0, 0.0, 0.0, 0.0]]
    );
    // The lid is pushed down with 2, at 2 to the left of the reference node.
    let forces = rows("forces (fx,fy,fz) for set REF");
    near(forces[0][2], -2.0);
    near(forces[1][3], 4.0);
    near(rows("total force (fx,fy,fz) for set LID")[0][1], -2.0);
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

/// Two blocks side by side, held at the bottom, each with another on top that is pressed by another
/// pressure: tied to each other they behave as blocks that share the nodes.
#[test]
fn contacts_of_tied_bodies_know_of_each_other() {
    let block = |first: usize, [x, y]: [f64; 2], corners: [usize; 4]| {
        let at = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        let nodes = corners.iter().zip(at).filter(|(label, _)| **label >= first);
        let nodes: String = nodes
            .map(|(n, [x, y])| format!("{n}, {x:?}, {y:?}\n"))
            .collect();
        let [a, b, c, d] = corners;
        format!(
            "*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE=CPE4, ELSET=E{first}\n\
             {first}, {a},{b},{c},{d}\n"
        )
    };
    let deck = |is_tied: bool, swapped: [bool; 2]| {
        let right = if is_tied {
            [11, 12, 13, 14]
        } else {
            [2, 12, 13, 3]
        };
        let mut text = block(1, [0.0, 0.0], [1, 2, 3, 4]) + &block(11, [1.0, 0.0], right);
        text += &block(21, [0.0, 1.0], [21, 22, 23, 24]);
        text += &block(31, [1.0, 1.0], [31, 32, 33, 34]);
        text += "*MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3\n";
        for (e, face, name) in [(1, 3, "A"), (11, 3, "B"), (21, 1, "C"), (31, 1, "D")] {
            text += &format!("*SOLID SECTION, ELSET=E{e}, MATERIAL=STEEL\n");
            text += &format!("*SURFACE, NAME={name}\n{e}, S{face}\n");
        }
        text +=
            "*SURFACE, NAME=R\n1, S2\n*SURFACE, NAME=L\n11, S4\n*SURFACE INTERACTION, NAME=SI\n";
        if is_tied {
            text += "*TIE, NAME=T, POSITION TOLERANCE=0.01\nL, R\n";
        }
        for ([over, under], swapped) in [["C", "A"], ["D", "B"]].into_iter().zip(swapped) {
            text += &match swapped {
                true => pair(under, over),
                false => pair(over, under),
            };
        }
        let bottom = if is_tied {
            "1,1,2\n2,1,2\n11,1,2\n12,1,2"
        } else {
            "1,1,2\n2,1,2\n12,1,2"
        };
        format!(
            "{text}*BOUNDARY\n{bottom}\n24,1\n34,1\n21,1\n31,1\n*STEP\n*STATIC\n*DLOAD\n\
             21,P3,10.\n31,P3,3.\n*NODE PRINT, NSET=ALL\nU\n*END STEP\n"
        )
    };
    let one = computed(&deck(false, [false; 2])).unwrap();
    // A corner that both contacts share is the slave of one and the master of the other.
    let other = computed(&deck(false, [true; 2])).unwrap();
    for label in [3, 4, 13, 21, 22, 23, 24, 31, 32, 33, 34] {
        near(moved(&one, label)[0], moved(&other, label)[0]);
    }
    // A corner that follows in the tie is a master: it is no slave of the contact, too.
    for swapped in [[false, true], [true, true]] {
        let tied = computed(&deck(true, swapped)).unwrap();
        assert!(tied.1.inaccurate.is_empty(), "{:?}", tied.1.inaccurate);
        for label in [3, 4, 13, 21, 22, 23, 24, 31, 32, 33, 34] {
            near(moved(&tied, label)[0], moved(&one, label)[0]);
        }
    }
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
