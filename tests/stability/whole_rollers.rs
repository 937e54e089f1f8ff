//! Whole rollers on a block, as a mesher meshes them: the named surface is the whole circle,
//! nothing but contact holds the roller, and a load that is spread over its outline does not pass
//! exactly through its centre.

use crate::support::msh::{Body, Disc, Msh};
use crate::support::random::Random;
use crate::support::{either, parse, run_text_as_far_as_it_goes, try_run};
use brinell::ErrorKind;
use brinell::linalg::Backend;
use std::path::Path;

const FORCE: f64 = 100.0;

/// A scene with a whole roller on a block, and the half of the largest angle between neighbouring
/// nodes of the outline.
fn scene(seed: u64, folder: &Path) -> (String, f64) {
    let random = &mut Random::new(seed);
    let radius = random.one_of(&[5.0f64, 12.0, 0.02]);
    let n = 24 + random.below(40);
    let jitter = random.one_of(&[0.0, 0.3, 0.6]);
    let mut angles: Vec<f64> = (0..n)
        .map(|k| (k as f64 + jitter * random.within(-0.5, 0.5)) / n as f64)
        .collect();
    angles[0] = 0.0;
    let order = 1 + random.below(2);
    let aside = radius * random.one_of(&[0.0, 0.0, 0.21]);
    let disc = Disc {
        name: "roller",
        center: [0.0, radius],
        radius,
        angles,
        rings: 5,
    };
    let [under, level] = [|_: f64| -1.0, |_: f64| 0.0].map(|y| move |x: f64| radius * y(x));
    let block = Body {
        name: "block",
        from: -2.0 * radius + aside,
        width: 4.0 * radius,
        cells: [20 + random.below(20), 6],
        heights: [&under, &level],
        kink: None,
        grading: 1.0,
        jitter: random.one_of(&[0.0, 0.3]),
    };
    let mut msh = Msh::default();
    block.plane(&mut msh, random.share() < 0.3, order, random);
    disc.plane(&mut msh, order);
    // What presses down may press up or to a side as well.
    let turn = random
        .one_of(&[0.0f64, 0.0, 90.0, 180.0, 37.0])
        .to_radians();
    let (sin, cos) = turn.sin_cos();
    let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    msh.map(|[x, y, z]| {
        let [x, y] = turned([x, y]);
        [x, y, z]
    });
    let file = folder.join(format!("{seed}.msh"));
    std::fs::write(&file, msh.text()).unwrap();
    let circle = match random.share() < 0.7 {
        true => {
            let center = turned([0.0, radius]);
            format!(
                "mesh.circles = [{{ on = \"roller outline\", center = {center:?}, \
                 radius = {radius} }}]"
            )
        }
        false => String::new(),
    };
    let [first, second] = match random.share() < 0.5 {
        true => ["roller outline", "block top"],
        false => ["block top", "roller outline"],
    };
    let force = turned([0.0, -FORCE]);
    let half = disc
        .angles
        .iter()
        .zip(disc.angles[1..].iter().chain(&[1.0]));
    let half = half.map(|(a, b)| std::f64::consts::PI * (b - a));
    let text = format!(
        "kind = \"plane_strain\"
mesh.file = {file:?}
{circle}
contact = [{{ first = \"{first}\", second = \"{second}\" }}]
materials.e = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
bodies = {{ block.material = \"e\", roller.material = \"e\" }}
support = [{{ on = \"block bottom\", fix = [\"x\", \"y\"] }}]
load = [{{ on = \"roller outline\", force = {force:?} }}]
program.targets = [{{ load_factor = 1.0 }}, {{ load_factor = 0.0 }}]
"
    );
    (text, half.fold(0.0, f64::max))
}

/// It is taken for what it is, comes to rest under its load and is unloaded. What a pin bears
/// against the unevenness of facets is no more than the sagitta of a facet over the radius.
#[test]
fn a_whole_roller_is_held_by_the_block_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut borne = 0;
    for seed in 1..=either(40, 1000) {
        let (text, half) = scene(seed, folder.path());
        let results = run_text_as_far_as_it_goes(&text);
        let bears = |warning: &&String| warning.contains("which carries this small load");
        borne += results.warnings.iter().filter(bears).count();
        let ending = results.ending();
        assert!(ending.kind().is_none(), "{seed}: {ending:?}\n{text}");
        let [pressed, off] = &results.states[..] else {
            panic!("{} states", results.states.len());
        };
        let share = pressed.contact_force / FORCE - 1.0;
        // The nodes that touch lie at most two facets off the lowest point: their normals turn.
        let turned = 1.0 / (4.0 * half).cos() - 1.0;
        assert!(
            share.abs() <= half * half / 2.0 + turned,
            "{seed}: {share} {half}\n{text}"
        );
        assert!(off.contact_force.abs() < 1e-6 * FORCE, "{seed}\n{text}");
    }
    assert!(borne > 0);
}

/// What turns a roller beyond the unevenness of its facets is refused: nothing would stop it.
#[test]
fn a_roller_that_its_load_turns_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut refused = 0;
    for seed in 1..=20 {
        let (text, half) = scene(seed, folder.path());
        if !text.contains("mesh.circles") {
            continue;
        }
        // Share: the moment of a traction that grows across the roller, over its resultant times
        // the radius.
        let turned = |share: f64| {
            let force = text.find("force = [").unwrap();
            let end = force + text[force..].find(']').unwrap();
            let components = &text[force + "force = [".len()..end];
            let [x, y] = [0, 1].map(|k| components.split(", ").nth(k).unwrap());
            let [cx, cy] = [0, 1].map(|k| {
                let center = text.split("center = [").nth(1).unwrap();
                center.split([',', ']']).nth(k).unwrap().trim()
            });
            let radius = text.split("radius = ").nth(1).unwrap();
            let radius = radius.split([' ', '}']).next().unwrap();
            let part =
                |own: &str, arm: &str| format!("\"{own} + {share} * {FORCE} * {arm} / {radius}\"");
            let [tx, ty] = [
                part(x, &format!("(({cy}) - y)")),
                part(y, &format!("(x - ({cx}))")),
            ];
            format!("{}traction = [{tx}, {ty}{}", &text[..force], &text[end..])
        };
        let small = run_text_as_far_as_it_goes(&turned(1e-9));
        assert!(
            small.ending().kind().is_none(),
            "{seed}: {:?}",
            small.ending()
        );
        // Where the gap is measured along the block's normal, pairs beside the lowest point stop
        // the rotation.
        if !small
            .warnings
            .iter()
            .any(|text| text.contains("rotate about"))
        {
            continue;
        }
        let error = try_run(&parse(&turned(half * half)), Backend::default()).err();
        assert_eq!(error.map(|e| e.kind()), Some(ErrorKind::Unheld), "{seed}");
        refused += 1;
    }
    assert!(refused > 2, "{refused}");
}
