//! Going on from checkpoints.
//!
//! Naive restarts keep what is easily named (displacements, plastic strains) and lose what the next
//! increment is also made of: statuses at their border, the tangent that predicts, the pivots
//! behind a dense factor, the rest of a search. Then "restart changes the answer". Passing means
//! the same bits.

use crate::support::{SMALL_BALL, SMALL_PUNCH, analysis, either, load};
use brinell::analysis::Analysis;
use brinell::checkpoint::Checkpoints;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::{Flow, Observer, Silent};
use brinell::results::{HistoryRow, Results};
use brinell::scene::Scene;
use brinell::{ErrorKind, Result};
use std::path::{Path, PathBuf};

/// Copies the checkpoint that there is before each increment.
struct Collector<'c> {
    from: &'c Path,
    to: &'c Path,
    copies: Vec<PathBuf>,
    stop_after: usize,
}

impl Observer for Collector<'_> {
    fn increment(&mut self, row: &HistoryRow, _fraction: f64) -> Flow {
        if self.from.join("checkpoint").is_file() {
            let copy = self.to.join(format!("{}", row.increment));
            std::fs::create_dir(&copy).unwrap();
            for entry in std::fs::read_dir(self.from).unwrap() {
                let entry = entry.unwrap();
                std::fs::copy(entry.path(), copy.join(entry.file_name())).unwrap();
            }
            self.copies.push(copy);
        }
        if row.increment == self.stop_after {
            Flow::Stop
        } else {
            Flow::Continue
        }
    }
}

/// All numbers of a run, bit by bit: `Debug` writes the shortest text that only the same number
/// reads as.
fn text(results: &Results) -> String {
    format!(
        "{:?} {:?} {:?} {:?} {:?} {:?}",
        results.first_yield,
        results.history,
        results.states,
        results.counts,
        results.quality,
        results.incomplete
    ) + &format!("{:?}", results.cycles)
}

/// Runs the scene, then goes on from the checkpoint of every increment (`every`-th of them, from
/// the last): all the same bits. Returns how many were tried.
fn same_from_everywhere(scene: &Scene, every: usize) -> usize {
    let plain = text(&analysis(scene).run(&mut Silent).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("run"), folder.path().join("copies"));
    std::fs::create_dir(&to).unwrap();
    let mut collector = Collector {
        from: &from,
        to: &to,
        copies: Vec::new(),
        stop_after: usize::MAX,
    };
    let kept = analysis(scene)
        .run_with_checkpoints(&Checkpoints::new(&from), &mut collector)
        .unwrap();
    assert!(
        text(&kept) == plain,
        "{}: checkpoints changed the run",
        scene.title
    );
    assert_eq!(kept.resumed, 0);
    let mut tried = 0;
    for copy in collector.copies.iter().rev().step_by(every) {
        let resumed = analysis(scene)
            .resume(&Checkpoints::new(copy), &mut Silent)
            .unwrap_or_else(|e| panic!("{}: {e}", copy.display()));
        let resumed_text = text(&resumed);
        if resumed_text != plain {
            let differs = plain
                .bytes()
                .zip(resumed_text.bytes())
                .position(|(a, b)| a != b);
            let at = differs.unwrap_or(0);
            let part = |t: &str| t[at.saturating_sub(300)..(at + 100).min(t.len())].to_string();
            panic!(
                "{} resumed before increment {}:\n{}\n{}",
                scene.title,
                copy.file_name().unwrap().display(),
                part(&plain),
                part(&resumed_text)
            );
        }
        assert_eq!(resumed.resumed, 1);
        assert!(
            resumed.warnings.iter().all(|w| !w.contains("last digits")),
            "{:?}",
            resumed.warnings
        );
        tried += 1;
    }
    tried
}

/// A rigid surface without a mesh, whose way the history follows.
#[test]
fn a_rigid_surface_goes_on_from_every_increment() {
    let scene = load("hard/rigid_ball", &[]);
    assert!(same_from_everywhere(&scene, either(4, 1)) >= 3);
}

/// Loading by events with a zone that follows the load, a search for a half width, unloading on
/// elastic stretches, other targets after it.
#[test]
fn the_paper_s_cylinder_goes_on_from_every_increment() {
    let scene = load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=6",
            "program.targets=[{ yield = true }, { load_factor = 1.3 }, { half_width = 1.3 }, \
             { load_factor = 0.4 }, { load_factor = 1.8 }, { load_factor = 0.0 }]",
        ],
    );
    assert!(same_from_everywhere(&scene, either(5, 2)) >= either(4, 10));
}

/// The search for the load that leaves a dent: looks at what unloading leaves are no part of the
/// run's state.
#[test]
fn the_search_for_a_dent_goes_on_from_every_increment() {
    let scene = load(
        "cylinder_on_half_plane",
        &[
            "mesh.cylinder_on_half_plane.resolution=6",
            "program.targets=[{ residual_depth = 5e-5 }, { load_factor = 0.0 }, \
             { approach = 0.02 }]",
            "program.history=[\"cylinder.top\"]",
        ],
    );
    assert!(same_from_everywhere(&scene, either(5, 2)) >= either(4, 10));
}

/// Solids, interference (a preload that yields), fixed steps, the other iterations, separation and
/// contact found again, cycles, collapse, bodies without contact, a target displacement: the number
/// is every how many increments a run goes on from.
#[test]
fn every_kind_of_way_goes_on() {
    let mut tried = 0;
    let cylinder = "cylinder_on_half_plane";
    let coarse = "mesh.cylinder_on_half_plane.resolution=4";
    let ball = [
        &SMALL_BALL[..],
        &["program.targets=[{ yield = true }, { load_factor = 2.0 }, { load_factor = 0.0 }]"],
    ]
    .concat();
    let soft = [&ball[..], &["contact.0.stiffness=1e6"]].concat();
    let apart = [
        "mesh.parts.0.brick.elements=[2, 2, 2]",
        "mesh.parts.1.brick.elements=[5, 5, 4]",
    ];
    let tied = [
        &apart[..],
        &[
            "contact=[]",
            "tie=[{ first = \"punch.bottom\", second = \"block.top\" }]",
            "program.stepping=steps",
            "program.steps=4",
        ],
    ]
    .concat();
    let fading = [
        "materials.metal.plastic_modulus=2000",
        "materials.metal.back_stresses=[[40000, 300], [5000, 20]]",
        "program.stepping=steps",
        "program.steps=3",
    ];
    let cycles = [
        "program.cycles=4",
        "program.targets=[{ load_factor = 2.0 }, { load_factor = 0.3 }]",
    ];
    let cases: [(&str, &[&str], usize); 22] = [
        (
            "flat_punch",
            &["mesh.parts.0.block.elements=[10,10]", "program.steps=2"],
            4,
        ),
        ("hard/cyclic", &cycles, 9),
        (
            "hard/ratchet",
            &[
                "program.cycles=9",
                "program.targets=[{ load_factor = 1.0 }, { load_factor = -1.0 }]",
            ],
            1,
        ),
        ("hard/ratchet", &fading, 2),
        (
            "hard/cyclic",
            &["materials.steel.back_stresses=[[20000, 50]]"],
            3,
        ),
        ("ball_on_flat_3d", &soft, 2),
        ("roller_on_plate", &[], 4),
        ("square_punch", &apart, 2),
        ("square_punch", &tied, 1),
        ("ball_on_flat_3d", &ball, 2),
        ("square_punch", &SMALL_PUNCH, 2),
        (
            "hard/interference",
            &[
                "materials.steel.yield_stress=200",
                "materials.steel.plastic_modulus=20000",
                "program.targets=[{ load_factor = 3.0 }, { load_factor = 10.0 }, \
                 { load_factor = 0.0 }]",
            ],
            1,
        ),
        (
            cylinder,
            &[
                coarse,
                "program.stepping=steps",
                "program.steps=5",
                "program.targets=[{ load_factor = 1.6 }, { load_factor = 0.0 }]",
            ],
            1,
        ),
        (
            cylinder,
            &[
                coarse,
                "analysis.plastic_iteration=anderson",
                "program.targets=[{ load_factor = 1.4 }, { load_factor = 0.0 }]",
            ],
            3,
        ),
        (
            cylinder,
            &[
                coarse,
                "program.targets=[\
                 { displacement = { on = \"cylinder.top\", direction = \"y\", value = -0.03 } }]",
            ],
            2,
        ),
        ("hard/lift_off", &[], 1),
        ("hard/grazing", &[], 1),
        ("hard/to_and_fro", &[], 9),
        ("hard/cyclic", &[], 2),
        ("hard/limit_load", &[], 1),
        ("hard/zero_gap_conforming", &[], 4),
        (
            "thick_cylinder",
            &["program.stepping=steps", "program.steps=3"],
            4,
        ),
    ];
    for (name, overrides, every) in cases {
        let every = either(3, 1) * every;
        let n = same_from_everywhere(&load(name, overrides), every);
        assert!(n > 0, "{name} {overrides:?}");
        tried += n;
    }
    assert!(tried >= either(25, 40), "{tried}");
}

fn copy(from: &Path, to: &Path) -> Checkpoints {
    let _ = std::fs::remove_dir_all(to);
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
    }
    Checkpoints::new(to)
}

fn refused(outcome: Result<Results>, kind: ErrorKind, fragments: &[&str]) {
    let error = outcome.map(|_| ()).unwrap_err();
    assert_eq!(error.kind(), kind, "{error}");
    for fragment in fragments {
        assert!(
            error.message().contains(fragment),
            "{fragment:?} not in {error}"
        );
    }
}

/// A checkpoint of something else, or a damaged one, must not go on as if nothing had happened.
#[test]
fn what_is_not_the_same_run_is_refused_by_name() {
    let scene = load(
        "cylinder_on_half_plane",
        &["mesh.cylinder_on_half_plane.resolution=4"],
    );
    let folder = tempfile::tempdir().unwrap();
    let (dir, other) = (folder.path().join("run"), folder.path().join("other"));
    let stop = &mut Collector {
        from: Path::new("nowhere"),
        to: Path::new("nowhere"),
        copies: Vec::new(),
        stop_after: 8,
    };
    // The last increment before a stop is kept, however few are asked for.
    let checkpoints = Checkpoints::new(&dir).every(1000);
    let stopped = analysis(&scene)
        .run_with_checkpoints(&checkpoints, stop)
        .unwrap();
    assert_eq!(stopped.ending().kind(), Some(ErrorKind::Stopped));
    assert!(checkpoints.exist());

    let changed = |overrides: &[&str]| {
        let mut all = vec!["mesh.cylinder_on_half_plane.resolution=4"];
        all.extend(overrides);
        let scene = load("cylinder_on_half_plane", &all);
        analysis(&scene).resume(&copy(&dir, &other), &mut Silent)
    };
    refused(
        changed(&["materials.steel.yield_stress=501"]),
        ErrorKind::Input,
        &["materials.steel.yield_stress", "500", "501"],
    );
    refused(
        changed(&["mesh.cylinder_on_half_plane.resolution=5"]),
        ErrorKind::Input,
        &["resolution"],
    );
    refused(
        changed(&["analysis.tolerance=1e-9"]),
        ErrorKind::Input,
        &["analysis.tolerance"],
    );
    let mut model = Model::new(&scene).unwrap();
    model.continuum.mesh.coordinates[7] += 1e-13;
    let moved = Analysis::new(model, Backend::default())
        .unwrap()
        .resume(&copy(&dir, &other), &mut Silent);
    refused(moved, ErrorKind::Input, &["mesh", "file has changed"]);
    let dense = Analysis::new(Model::new(&scene).unwrap(), Backend::Dense)
        .unwrap()
        .resume(&copy(&dir, &other), &mut Silent);
    if Backend::default() != Backend::Dense {
        refused(
            dense,
            ErrorKind::Input,
            &["solver", Backend::default().name(), "dense"],
        );
    }
    let nothing = folder.path().join("nothing");
    refused(
        analysis(&scene).resume(&Checkpoints::new(&nothing), &mut Silent),
        ErrorKind::Io,
        &["nothing"],
    );

    // Any byte of any file. An analysis that was refused can be asked again.
    let mut unharmed = analysis(&scene);
    let files: Vec<PathBuf> = std::fs::read_dir(&dir)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    assert!(files.len() >= 3, "{files:?}");
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        // Of the first line, of length and hash, and of the content.
        for k in 0..if bytes.is_empty() { 0 } else { 12 } {
            let at = (k * k * k * bytes.len()) / (12 * 12 * 12);
            let checkpoints = copy(&dir, &other);
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x10;
            std::fs::write(other.join(file.file_name().unwrap()), &damaged).unwrap();
            refused(
                unharmed.resume(&checkpoints, &mut Silent),
                ErrorKind::Input,
                &[file.file_name().unwrap().to_str().unwrap()],
            );
        }
        if !bytes.is_empty() {
            let checkpoints = copy(&dir, &other);
            std::fs::write(
                other.join(file.file_name().unwrap()),
                &bytes[..bytes.len() / 2],
            )
            .unwrap();
            refused(
                unharmed.resume(&checkpoints, &mut Silent),
                ErrorKind::Input,
                &["damaged"],
            );
        }
    }
    let checkpoints = copy(&dir, &other);
    let root = other.join("checkpoint");
    let bytes = std::fs::read(&root).unwrap();
    let end = bytes.iter().position(|&b| b == b'\n').unwrap();
    let mut older = b"brinell checkpoint, format 1, version 0.0.9".to_vec();
    older.extend(&bytes[end..]);
    std::fs::write(&root, older).unwrap();
    refused(
        unharmed.resume(&checkpoints, &mut Silent),
        ErrorKind::Input,
        &["another version", "0.0.9"],
    );

    // One at a time.
    struct Second<'s>(&'s Scene, &'s Checkpoints, usize);
    impl Observer for Second<'_> {
        fn increment(&mut self, _: &HistoryRow, _: f64) -> Flow {
            if self.2 == 0 {
                self.2 = 1;
                refused(
                    analysis(self.0).resume(self.1, &mut Silent),
                    ErrorKind::Input,
                    &["another run"],
                );
            }
            Flow::Continue
        }
    }
    let checkpoints = copy(&dir, &other);
    let mut second = Second(&scene, &checkpoints, 0);
    let whole = analysis(&scene).resume(&checkpoints, &mut second).unwrap();
    assert_eq!(second.2, 1);
    assert_eq!(
        text(&whole),
        text(&analysis(&scene).run(&mut Silent).unwrap())
    );
    checkpoints.remove().unwrap();
    assert!(!other.exists());
}
