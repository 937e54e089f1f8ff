//! A run that starts from what an earlier one left does what one run of both programs does.

use crate::support::{analysis, load, parse, run};
use crate::verification::close;
use brinell::ErrorKind;
use brinell::analysis::Analysis;
use brinell::checkpoint::Checkpoints;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::output::{self, RunHeader};
use brinell::progress::{Flow, Observer, Silent};
use brinell::results::{HistoryRow, Results};
use brinell::scene::{Kind, Scene, Stepping};
use std::path::{Path, PathBuf};

/// Runs a scene and leaves its result directory.
pub fn run_into(scene: &Scene, dir: &Path) -> Results {
    let results = run(scene);
    let model = Model::new(scene).unwrap();
    let header = RunHeader::new(&model, Backend::default(), 0.0);
    output::write_without_report(dir, &header, &model, &results).unwrap();
    results
}

pub fn with_targets(scene: &Scene, factors: &[f64], start: Option<&Path>) -> Scene {
    let mut scene = scene.clone();
    let usual = scene.program.targets[0].clone();
    scene.program.targets = (factors.iter())
        .map(|factor| brinell::scene::Target {
            load_factor: Some(*factor),
            first_yield: false,
            name: None,
            ..usual.clone()
        })
        .collect();
    scene.reference.clear();
    scene.start_from = start.map(PathBuf::from);
    scene
}

const SHEET: &str = r#"
kind = "plane_stress"
support = [{ on = "sheet.left", fix = ["x"] }, { on = "sheet.bottom", fix = ["y"] }]
load = [{ on = "sheet.right", displacement = { x = 0.01 } }]
[[mesh.parts]]
body = "sheet"
element = "quad8"
block = { x = [0.0, 1.0], y = [0.0, 2.0], elements = [2, 2] }
[materials.metal]
youngs_modulus = 200000.0
poissons_ratio = 0.3
yield_stress = 250.0
plastic_modulus = 2000.0
back_stresses = [[20000.0, 100.0], [8000.0, 30.0], [5000.0, 0.0]]
[bodies.sheet]
material = "metal"
[program]
targets = [{ load_factor = 1.0 }]
"#;

/// A sheet with a back stress that fades, pulled, pushed, and pulled again by a second and a third
/// run: nothing of the history is lost, in whatever order the back stresses are listed.
#[test]
fn a_sheet_goes_on_where_it_was_left() {
    let folder = tempfile::tempdir().unwrap();
    let dirs = ["one", "two"].map(|name| folder.path().join(name));
    let sheet = parse(SHEET);
    let whole = run(&with_targets(&sheet, &[1.0, 0.0, -0.5, 0.0, 1.2], None));
    run_into(&with_targets(&sheet, &[1.0, 0.0], None), &dirs[0]);
    let start = Some(dirs[0].as_path());
    let mut second = with_targets(&sheet, &[-0.5, 0.0], start);
    let laws = second.materials.get_mut("metal").unwrap();
    laws.back_stresses.as_mut().unwrap().reverse();
    run_into(&second, &dirs[1]);
    let last = run(&with_targets(&sheet, &[1.2], Some(&dirs[1])));
    let [one, other] = [&whole.states[4], &last.states[0]];
    // Each of three increments is in equilibrium to 1e-10 of the forces.
    let accuracy = 1e-8;
    close(
        other.max_equivalent_plastic_strain,
        one.max_equivalent_plastic_strain,
        accuracy,
    );
    close(other.load, one.load, accuracy);
    close(other.plastic_work, one.plastic_work, accuracy);
    let stress = |results: &Results, k: usize| {
        let fields = results.states[k].fields.as_ref().unwrap();
        fields.stress[0]
    };
    close(stress(&last, 0), stress(&whole, 4), accuracy);
    assert!(last.first_yield.is_none());
    let effect = last.effects.iter().find(|e| e.name == "earlier run");
    assert!(effect.unwrap().on);
}

/// A tube that was pressed beyond yield keeps its residual stress, and under less than that
/// pressure nothing yields any more.
#[test]
fn an_autofrettaged_tube_stays_elastic_up_to_its_pressure() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("tube");
    let tube = load(
        "thick_cylinder",
        &["mesh.parts.0.ring.elements=[8,8]", "reference=[]"],
    );
    let before = run_into(&with_targets(&tube, &[160.0, 0.0], None), &dir);
    let after = run(&with_targets(&tube, &[0.0, 150.0, 170.0], Some(&dir)));
    let stress = |results: &Results, k: usize| {
        let fields = results.states[k].fields.as_ref().unwrap();
        fields.stress.clone()
    };
    for (a, b) in stress(&before, 1).iter().zip(stress(&after, 0)) {
        assert!((a - b).abs() < 1e-7 * 240.0, "{a} {b}");
    }
    let [left, same, more] = [
        before.states[1].max_equivalent_plastic_strain,
        after.states[1].max_equivalent_plastic_strain,
        after.states[2].max_equivalent_plastic_strain,
    ];
    close(same, left, 1e-12);
    assert!(more > 1.05 * left, "{more} {left}");
}

fn rollers() -> Scene {
    load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=6",
            "program.unit=load",
            "reference=[]",
        ],
    )
}

/// The cylinder, held by contact alone, pressed into the half plane, taken off, and pressed again.
#[test]
fn a_dent_is_pressed_again() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("dent");
    let rollers = rollers();
    let first = analysis(&rollers).yield_load(&mut Silent);
    let at_yield = first.unwrap().first_yield.unwrap().alpha;
    let [one, more] = [1.5 * at_yield, 1.8 * at_yield];
    let whole = run(&with_targets(&rollers, &[one, 0.0, more, 0.0], None));
    run_into(&with_targets(&rollers, &[one, 0.0], None), &dir);
    let second = run(&with_targets(&rollers, &[more, 0.0], Some(&dir)));
    for k in 0..2 {
        let [one, other] = [&whole.states[2 + k], &second.states[k]];
        // Increments end at other places, and each is in equilibrium to its tolerance.
        close(other.residual_depth, one.residual_depth, 1e-4);
        close(
            other.max_equivalent_plastic_strain,
            one.max_equivalent_plastic_strain,
            1e-4,
        );
    }
    close(
        second.states[0].max_pressure,
        whole.states[2].max_pressure,
        1e-4,
    );
}

struct UpTo(usize);

impl Observer for UpTo {
    fn increment(&mut self, row: &HistoryRow, _fraction: f64) -> Flow {
        match row.increment < self.0 {
            true => Flow::Continue,
            false => Flow::Stop,
        }
    }
}

#[test]
fn such_a_run_goes_on_from_checkpoints_and_knows_its_start() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("dent");
    let kept = Checkpoints::new(folder.path().join("kept"));
    let rollers = rollers();
    let first = analysis(&rollers).yield_load(&mut Silent);
    let at_yield = first.unwrap().first_yield.unwrap().alpha;
    run_into(&with_targets(&rollers, &[1.5 * at_yield, 0.0], None), &dir);
    let scene = with_targets(&rollers, &[1.6 * at_yield], Some(&dir));
    let whole = run(&scene);
    let stopped = analysis(&scene)
        .run_with_checkpoints(&kept, &mut UpTo(3))
        .unwrap();
    assert!(stopped.incomplete.is_some());
    let resumed = analysis(&scene).resume(&kept, &mut Silent).unwrap();
    assert_eq!(
        format!("{:?}", resumed.states),
        format!("{:?}", whole.states)
    );
    assert_eq!(resumed.end_state, whole.end_state);
    // Another start: refused by name.
    run_into(&with_targets(&rollers, &[1.4 * at_yield, 0.0], None), &dir);
    let error = analysis(&scene).resume(&kept, &mut Silent);
    let error = error.unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Input);
    let text = error.to_string();
    assert!(text.contains("start_from"), "{text}");
}

#[test]
fn what_cannot_be_started_from_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("sheet");
    let sheet = parse(SHEET);
    let start = with_targets(&sheet, &[1.0], Some(&dir));
    let refused = |scene: &Scene, words: &str| {
        let refused = Model::new(scene).and_then(|model| Analysis::new(model, Backend::default()));
        let error = refused.map(drop).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Input, "{error}");
        let text = error.to_string();
        assert!(
            text.contains(words) && text.contains("start_from"),
            "{text}"
        );
    };
    refused(&start, "there is no such directory");
    std::fs::create_dir(&dir).unwrap();
    refused(&start, "it holds no end_state.bin");
    std::fs::remove_dir(&dir).unwrap();
    run_into(&with_targets(&sheet, &[1.0, 0.0], None), &dir);
    analysis(&start);
    let mut other = start.clone();
    if let Some(part) = other
        .mesh
        .parts
        .as_mut()
        .and_then(|parts| parts.first_mut())
    {
        let block = part.block.as_mut().unwrap();
        block.elements = [2, 3];
    }
    refused(&other, "its run was on another mesh");
    let mut other = start.clone();
    other.materials.get_mut("metal").unwrap().back_stresses = None;
    refused(&other, "2 back stresses that fade, those here have 0");
    let mut other = start.clone();
    other.kind = match start.kind {
        Kind::PlaneStrain => Kind::PlaneStress,
        _ => Kind::PlaneStrain,
    };
    refused(&other, "the earlier run was of the kind");
    let mut other = start.clone();
    for law in other
        .materials
        .get_mut("metal")
        .unwrap()
        .back_stresses
        .iter_mut()
        .flatten()
    {
        law[1] *= 1.5;
    }
    refused(&other, "faded at the rates");
    let mut stressed = with_targets(&sheet, &[1.0, 0.0], None);
    let rows = vec![vec![0.0, 5.0, 0.0, 0.0, 0.0]];
    stressed.bodies.get_mut("sheet").unwrap().initial_stress = Some(rows);
    run_into(&stressed, &dir);
    refused(&start, "another `initial_stress`");
    run_into(&with_targets(&sheet, &[1.0, 0.0], None), &dir);
    let mut other = start.clone();
    other.bodies.get_mut("sheet").unwrap().plastic = brinell::scene::Plastic::No;
    refused(&other, "body `sheet`, which may not yield here");
    let file = dir.join("end_state.bin");
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, &bytes[..bytes.len() - 1]).unwrap();
    refused(&start, "the end state is damaged");
    let end = bytes.iter().position(|b| *b == b'\n').unwrap();
    let older = [b"brinell end state, format 0, version 0", &bytes[end..]].concat();
    std::fs::write(&file, older).unwrap();
    refused(&start, "written by another version");
    // It has yielded: there is no yield load to count by.
    let mut other = start.clone();
    other.program.unit = brinell::scene::Unit::Yield;
    std::fs::write(&file, &bytes).unwrap();
    refused(
        &other,
        "there is no yield load: count loads with program.unit",
    );
    let mut other = start.clone();
    other.program.targets[0].first_yield = true;
    other.program.targets[0].load_factor = None;
    refused(&other, "take the target `yield` out of program.targets");
    let text = start.to_toml().unwrap();
    let error = Scene::parse(&format!("accuracy = \"1 %\"\n{text}"), "sheet").unwrap_err();
    let words = "start_from: a state belongs to one mesh";
    assert!(error.to_string().contains(words), "{error}");
}

/// An earlier run in which nothing yielded is none: off, and it says so.
#[test]
fn a_run_in_which_nothing_yielded_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("sheet");
    let sheet = parse(SHEET);
    run_into(&with_targets(&sheet, &[0.1, 0.0], None), &dir);
    let plain = run(&with_targets(&sheet, &[1.0], None));
    let after = run(&with_targets(&sheet, &[1.0], Some(&dir)));
    assert_eq!(format!("{:?}", after.states), format!("{:?}", plain.states));
    assert_eq!(after.counts, plain.counts);
    let effect = after
        .effects
        .iter()
        .find(|e| e.name == "earlier run")
        .unwrap();
    assert!(
        !effect.on && effect.why.contains("nothing had yielded"),
        "{}",
        effect.why
    );
}

/// A body that contact alone holds lies on what the earlier run left: a target without load, where
/// nothing moves, takes nothing from what comes after.
#[test]
fn a_target_where_a_run_starts_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"
kind = "plane_strain"
support = [
    { on = "low.bottom", fix = ["y"] },
    { on = "low.left", fix = ["x"] },
    { on = "up.left", fix = ["x"] },
]
contact = [{ first = "up.bottom", second = "low.top" }]
load = [{ on = "up.top", pressure = 300.0 }]
mesh.parts = [
    { body = "low", block = { x = [0, 4], y = [0, 2], elements = [12, 6], bias = [3.0, 0.5] } },
    { body = "up", block = { x = [0, 2], y = [2, 3], elements = [7, 4] } },
]
bodies = { low.material = "low", up.material = "up" }
program = { targets = [{ load_factor = 1.0 }, { load_factor = 0.0 }] }
[materials.low]
youngs_modulus = 2e5
poissons_ratio = 0.3
yield_stress = 200
plastic_modulus = 2000
[materials.up]
youngs_modulus = 1e5
poissons_ratio = 0.25
yield_stress = 300
plastic_modulus = 5000
"#;
    for stepping in [Stepping::Events, Stepping::Steps] {
        let mut scene = parse(text);
        scene.program.stepping = stepping;
        run_into(&scene, folder.path());
        let [with, without] = [&[0.0, 1.0][..], &[1.0]].map(|factors| {
            let results = run(&with_targets(&scene, factors, Some(folder.path())));
            results.states.last().unwrap().clone()
        });
        assert!(with.residual_depth != 0.0);
        for (a, b) in with.pairs.iter().zip(&without.pairs) {
            let off = (a.pressure - b.pressure).abs() / with.max_pressure;
            assert!(off < 1e-6, "{stepping:?}: {off:e}");
        }
        let [a, b] = [&with, &without].map(|state| state.max_equivalent_plastic_strain);
        close(a, b, 1e-6);
    }
}
