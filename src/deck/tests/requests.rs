//! Results that a deck requests.

use super::{Conversion, Deck, Options};
use crate::deck::Note;
use crate::scene::{Moment, ResultItem, Totals};

const BLOCK: &str = "\
*HEADING
One
Two
*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*NSET, NSET=Top
3, 4
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=ZINC
*ELASTIC
1., 0.
*PLASTIC
1., 0.
*MATERIAL, NAME=BRASS
*SOLID SECTION, ELSET=E, MATERIAL=ZINC
0.5
*TIME POINTS, NAME=AT
0.25, 0.75, 9.
*TIME POINTS, NAME=RUN, GENERATE, TIME=TOTAL TIME
4.5, 5.5, 0.25
*BOUNDARY
1, 1, 2
2, 2
";

fn converted(steps: &[&str], increments: bool) -> Conversion {
    let step = |text: &&str| {
        format!("*STEP\n*STATIC{text}*CLOAD\n3, 2, 0.1\n*END STEP\n").replace("; ", "\n")
    };
    let text: String = steps.iter().map(step).collect();
    let deck = Deck::parse(format!("{BLOCK}{text}").as_bytes(), "a.inp").unwrap();
    let options = Options {
        increments,
        ..Options::default()
    };
    deck.convert(options).unwrap()
}

fn items(moment: &Moment) -> Vec<ResultItem> {
    moment.file.iter().map(|request| request.item).collect()
}

/// Requests for a group in a later step replace the earlier requests of the same group only.
#[test]
fn requests_stay_until_their_group_is_asked_for_anew() {
    use ResultItem::{Displacement, Force, PlasticStrain, Stress, StressJump};
    let found = converted(
        &[
            "; *EL FILE; S, PEEQ, SDV; *NODE FILE, NSET=TOP; U; \
             *NODE PRINT, NSET=TOP, TOTALS=YES; RF\n",
            "; *NODE FILE; RF\n",
            "; *EL FILE; S, NOE; *NODE FILE, NSET=NONE; U\n",
        ],
        false,
    );
    let requests = &found.scene.requests;
    assert_eq!(requests.heading, ["One", "Two"]);
    assert_eq!(requests.materials, ["ZINC", "BRASS"]);
    assert_eq!(requests.thickness, Some(0.5));
    assert!(requests.point_values);
    let [first, second, third] = &requests.moments[..] else {
        panic!("{requests:?}");
    };
    assert_eq!(
        items(first),
        [Displacement, Stress, PlasticStrain, StressJump]
    );
    let set = first.file[0].nodes.as_ref().unwrap();
    assert_eq!((set.name.as_str(), &set.labels[..]), ("TOP", &[3, 4][..]));
    assert_eq!(items(second), [Stress, Force, PlasticStrain, StressJump]);
    assert!(second.file.iter().all(|request| request.nodes.is_none()));
    assert_eq!(items(third), [Stress]);
    for moment in &requests.moments {
        let [print] = &moment.prints[..] else {
            panic!("{moment:?}");
        };
        assert_eq!((print.item, print.totals), (Force, Totals::Yes));
    }
    let texts = |notes: &[Note]| -> Vec<String> { notes.iter().map(|n| n.text.clone()).collect() };
    let expected = ["SDV: not among the results that are written"];
    assert_eq!(texts(&found.account.ignored), expected);
    let absent = "there is no set NONE: nothing is written for it".to_string();
    assert!(texts(&found.account.taken).contains(&absent));
}

/// Requests for a contact pair, or at time points, that the deck does not have are told.
#[test]
fn what_is_asked_for_and_absent_is_told() {
    let found = converted(
        &[
            "; *CONTACT PRINT, SLAVE=A, MASTER=B; CF\n",
            "; *NODE PRINT, NSET=TOP, TIME POINTS=NONE; U\n",
        ],
        false,
    );
    let told: Vec<String> = found.account.taken.iter().map(|n| n.text.clone()).collect();
    for expected in [
        "there is no *CONTACT PAIR of slave A and master B: nothing is printed for it",
        "there is no *TIME POINTS, NAME=NONE: results are those of the ends of steps",
    ] {
        assert!(told.iter().any(|text| text == expected), "{told:#?}");
    }
    let prints = &found.scene.requests.moments[0].prints;
    assert!(
        prints.iter().all(|print| print.set.name == "TOP"),
        "{prints:?}"
    );
}

/// With the option `increments`, increments of `DIRECT` and time points become targets.
#[test]
fn increments_are_those_that_results_are_asked_for() {
    let steps = [
        ", DIRECT; 0.1, 1.; *NODE FILE, FREQUENCY=4; U\n",
        "; 0.1, 3.; *EL FILE, TIME POINTS=AT; S\n",
        "; 0.1, 1.; *EL FILE, TIME POINTS=RUN; S\n",
    ];
    let instants = |steps: &[&str], increments: bool| -> Vec<(usize, usize, f64)> {
        let found = converted(steps, increments);
        let moments = &found.scene.requests.moments;
        assert_eq!(moments.len(), found.scene.program.targets.len());
        let each = moments.iter();
        each.map(|m| (m.step, m.increment, m.time.unwrap()))
            .collect()
    };
    let ends = [(1, 1, 1.0), (2, 1, 4.0), (3, 1, 5.0)];
    assert_eq!(instants(&steps, false), ends);
    let output = "; 0.1, 1., 1e-5, 0.1; *OUTPUT, FREQUENCY=5; *NODE FILE; U\n";
    assert_eq!(instants(&[output], true), [(1, 5, 0.5), (1, 10, 1.0)]);
    let expected = [
        (1, 4, 0.4),
        (1, 8, 0.8),
        (1, 10, 1.0),
        (2, 1, 1.25),
        (2, 2, 1.75),
        (2, 3, 4.0),
        (3, 1, 4.5),
        (3, 2, 4.75),
        (3, 3, 5.0),
    ];
    assert_eq!(instants(&steps, true), expected);
    let names = converted(&steps, true).scene.program.labels();
    assert_eq!(
        names[..3],
        ["step-1 increment 4", "step-1 increment 8", "step-1"]
    );
}

/// Field output of Abaqus is written; history output is skipped.
#[test]
fn histories_are_read_over() {
    let found = converted(
        &["; *OUTPUT, FIELD; *NODE OUTPUT; U, RF; *OUTPUT, HISTORY; *NODE OUTPUT, NSET=TOP; U\n"],
        false,
    );
    let moment = &found.scene.requests.moments[0];
    assert_eq!(items(moment), [ResultItem::Displacement, ResultItem::Force]);
    assert!(moment.file.iter().all(|request| request.nodes.is_none()));
}
