//! Under pressure: little memory, endless files, characters that a terminal obeys, sizes without a
//! bound.

use super::{Folder, brinell, fails, program, scene_path, stdout};
use crate::support::limit;
use std::process::{Command, Output};
use std::time::Duration;

/// What is linear takes a second or two; what was quadratic took minutes.
const SOON: Duration = Duration::from_secs(60);

fn soon(arguments: &[&str]) -> Output {
    let mut command = program();
    limit::output_within(command.args(arguments), SOON)
}

/// Runs the program under limits of the shell (`ulimit -v 120000`).
#[cfg(target_os = "linux")]
fn limited(limits: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new("sh");
    let script = format!("ulimit -c 0; ulimit {limits} || exit 99; exec \"$0\" \"$@\"");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_brinell")]);
    let output = limit::output_within(command.args(arguments), SOON);
    let stderr = String::from_utf8(output.stderr).unwrap();
    // Ended by a signal there is no code.
    (output.status.code(), stderr)
}

/// Whatever runs out first (mesh, ordering, work buffers of the BLAS, factor, results): the program
/// says how much was asked for.
#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(
    not(any(feature = "cholmod", feature = "faer")),
    ignore = "too large for the dense backend"
)]
fn too_little_memory_is_exit_code_5_with_the_size_asked_for() {
    let scene = scene_path("cylinder_on_half_plane");
    // A BLAS takes a work buffer as it is loaded; without one less suffices.
    let first: &[u64] = if cfg!(feature = "cholmod") {
        &[120]
    } else {
        &[40, 60, 80, 100, 120]
    };
    for &megabytes in first.iter().chain(&[135, 150, 175, 200, 250, 300, 350]) {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let limits = format!("-v {}", megabytes * 1024);
        let arguments = ["run", &scene, "-q", "--out", out.to_str().unwrap()];
        let (code, stderr) = limited(&limits, &arguments);
        if code == Some(0) {
            assert!(megabytes > first[0], "{megabytes} MB suffice?");
            continue;
        }
        assert_eq!(code, Some(5), "{megabytes} MB: {stderr}");
        let lines: Vec<&str> = stderr
            .lines()
            .filter(|l| l.contains("out of memory"))
            .collect();
        let [line] = lines.as_slice() else {
            panic!("{megabytes} MB: {stderr}");
        };
        assert!(
            line.contains(" MB") || line.contains(" bytes were asked for"),
            "{line}"
        );
        assert!(!out.exists());
    }
}

/// A matrix whose factor does not fit is refused by every backend before it is factored.
#[cfg(target_os = "linux")]
#[test]
fn memory_is_compared_with_what_is_available_before_the_factorisation() {
    let scene = scene_path("thick_cylinder");
    let mut sizes = vec![("dense", "[28, 32]", "dense factorisation of 5504 freedoms")];
    for (solver, is_there) in [
        ("cholmod", cfg!(feature = "cholmod")),
        ("faer", cfg!(feature = "faer")),
    ] {
        if is_there {
            sizes.push((solver, "[200, 200]", "factorisation of 240800 freedoms"));
        }
    }
    for (solver, elements, what) in sizes {
        let set = format!("mesh.parts.0.ring.elements={elements}");
        let arguments = ["yield", &scene, "-q", "--solver", solver, "--set", &set];
        let (code, stderr) = limited("-v 560000", &arguments);
        assert_eq!(code, Some(5), "{solver}: {stderr}");
        for part in [what, " needs about ", " MB are available"] {
            assert!(stderr.contains(part), "no {part:?} in {stderr}");
        }
        // So says the check, before anything is run.
        let arguments = ["check", &scene, "--solver", solver, "--set", &set];
        let (code, stderr) = limited("-v 560000", &arguments);
        assert_eq!(code, Some(2), "{solver}: {stderr}");
        assert!(stderr.contains("the run does not fit: about "), "{stderr}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_beyond_the_limit_of_its_size_is_exit_code_3_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = scene_path("contact_patch");
    let arguments = ["run", &scene, "-q", "--out", out.to_str().unwrap()];
    let (code, stderr) = limited("-f 8", &arguments);
    assert_eq!(code, Some(3), "{stderr}");
    assert!(stderr.contains("error: cannot write"), "{stderr}");
    assert!(stderr.contains("File too large"), "{stderr}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn devices_pipes_and_folders_are_no_scene_and_no_mesh() {
    let folder = Folder::with_changes("gmsh_blocks", &[("../meshes/two_blocks.msh", "mesh")]);
    let pipe = folder.path("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status().unwrap();
    assert!(made.success());
    let pipe = pipe.to_str().unwrap();
    let own = folder.folder.path().to_str().unwrap();
    for (path, why) in [
        ("/dev/zero", "no plain file"),
        (pipe, "no plain file"),
        (own, "it is a directory"),
    ] {
        let output = soon(&["check", path]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(why) && stderr.contains(path), "{stderr}");
        let mesh = format!("mesh.file=\"{path}\"");
        let output = soon(&["check", folder.scene().to_str().unwrap(), "--set", &mesh]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(
            stderr.contains(why) && stderr.contains("mesh file"),
            "{stderr}"
        );
    }
}

/// ESC, OSC, C1 and a change of the direction of writing.
const OBEYED: &str = "\u{1b}[31m \u{1b}]0;owned\u{7} \u{9b}2J \u{202e}evil";

fn is_obeyed(c: char) -> bool {
    (c.is_control() && c != '\n' && c != '\t') || ('\u{202a}'..='\u{202e}').contains(&c)
}

#[track_caller]
fn is_harmless(what: &str, text: &str) {
    let found = text.chars().find(|&c| is_obeyed(c));
    assert_eq!(found, None, "{what}: {text:?}");
}

#[test]
fn what_a_terminal_obeys_is_shown_written_out_everywhere() {
    // Escapes of TOML: the file itself is harmless.
    let toml = "\\u001B[31m \\u001B]0;owned\\u0007 \\u009B2J \\u202Eevil";
    let folder = Folder::with_changes(
        "contact_patch",
        &[
            (
                "title = \"Contact patch test\"",
                &format!("title = \"{toml}\""),
            ),
            ("name = \"pressed\"", &format!("name = \"{toml}\"")),
            (
                "quantity = \"states.pressed.max_pressure\"",
                &format!("quantity = \"states.{toml}.max_pressure\""),
            ),
            ("name = \"press\"", &format!("name = \"{toml}\"")),
        ],
    );
    for more in [["--progress", "plain"], ["--progress", "json"]] {
        let output = folder.brinell("run", &more);
        let stderr = String::from_utf8(output.stderr.clone()).unwrap();
        assert_eq!(output.status.code(), Some(0), "{stderr}");
        is_harmless("results", &stdout(&output));
        is_harmless("progress", &stderr);
        assert!(
            stdout(&output).contains("\\u{1b}[31m"),
            "{}",
            stdout(&output)
        );
    }
    for entry in std::fs::read_dir(folder.path("out")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.display().to_string();
        if name.ends_with(".svg") || name.ends_with(".html") {
            is_harmless(&name, &std::fs::read_to_string(&path).unwrap());
        }
        if name.ends_with(".svg") {
            let text = std::fs::read_to_string(&path).unwrap();
            roxmltree::Document::parse(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
    // JSON keeps the character, in the form that JSON has for it.
    let output = folder.brinell("run", &["--json", "-q"]);
    is_harmless("JSON", &stdout(&output));
    let summary: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(summary["scene"], OBEYED);
    let out = folder.path("out");
    let output = brinell(&["view", out.to_str().unwrap(), "--terminal"]);
    is_harmless("view", &stdout(&output));
    // Errors: a path, a key of the scene, an argument.
    let set = format!("{OBEYED}=1");
    let of_patch = scene_path("contact_patch");
    for arguments in [
        vec!["check", OBEYED],
        vec!["check", of_patch.as_str(), "--set", &set],
        vec!["check", of_patch.as_str(), "--solver", OBEYED],
        vec![OBEYED],
    ] {
        let output = brinell(&arguments);
        assert!(matches!(output.status.code(), Some(2 | 3)), "{output:?}");
        is_harmless("error", &String::from_utf8(output.stderr).unwrap());
    }
}

#[test]
fn a_title_of_a_megabyte_takes_no_time() {
    let title = "w".repeat(1_000_000);
    let folder = Folder::with_changes("contact_patch", &[("Contact patch test", &title)]);
    let (scene, out) = (folder.scene(), folder.path("out"));
    let arguments = [
        "run",
        scene.to_str().unwrap(),
        "-q",
        "--out",
        out.to_str().unwrap(),
    ];
    assert_eq!(soon(&arguments).status.code(), Some(0));
}

/// Blocks beside each other, each on supports of its own, and blocks on each other, held by
/// contact.
#[test]
fn hundreds_of_bodies_take_no_longer_than_as_many_elements() {
    use std::fmt::Write;
    for stacked in [false, true] {
        let mut text = String::from("kind = \"plane_strain\"\n");
        text += "[materials.m]\nyoungs_modulus = 2e5\npoissons_ratio = 0.3\n";
        let n = 400;
        for i in 0..n {
            let [x, y] = if stacked { [0, i] } else { [2 * i, 0] };
            let (x1, y1) = (x + 1, y + 1);
            writeln!(text, "[[mesh.parts]]\nbody = \"b{i}\"").unwrap();
            writeln!(
                text,
                "block = {{ x = [{x}, {x1}], y = [{y}, {y1}], elements = [1, 1] }}"
            )
            .unwrap();
            writeln!(text, "[bodies.b{i}]\nmaterial = \"m\"").unwrap();
            writeln!(text, "[[support]]\non = \"b{i}.left\"\nfix = [\"x\"]").unwrap();
            if i == 0 || !stacked {
                writeln!(text, "[[support]]\non = \"b{i}.bottom\"\nfix = [\"y\"]").unwrap();
            } else {
                let below = i - 1;
                writeln!(
                    text,
                    "[[contact]]\nfirst = \"b{i}.bottom\"\nsecond = \"b{below}.top\""
                )
                .unwrap();
            }
        }
        let top = if stacked { n - 1 } else { 0 };
        writeln!(text, "[[load]]\non = \"b{top}.top\"\npressure = 10.0").unwrap();
        text += "[program]\ntargets = [{ load_factor = 1.0 }]\n";
        let folder = Folder::with_scene(&text);
        let scene = folder.scene();
        let output = soon(&["check", scene.to_str().unwrap()]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{stderr}");
    }
}

#[test]
fn ten_thousand_targets_of_one_name_take_no_time_and_more_are_refused() {
    let with = |n: usize| {
        let targets = "{ load_factor = 1 }, ".repeat(n);
        let text = std::fs::read_to_string(scene_path("contact_patch")).unwrap();
        let text = text.split("[[reference]]").next().unwrap();
        let old = "targets = [{ name = \"pressed\", load_factor = 1.0 }]";
        assert!(text.contains(old));
        Folder::with_scene(&text.replace(old, &format!("targets = [{targets}]")))
    };
    let folder = with(10_000);
    let output = soon(&["check", folder.scene().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let folder = with(100_000);
    let output = soon(&["check", folder.scene().to_str().unwrap()]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    let expected = "program.targets: 100000 is too many: at most 10000";
    assert!(stderr.contains(expected), "{stderr}");
}

#[test]
fn sizes_and_values_without_sense_are_refused_with_their_bound() {
    let scene = scene_path("thick_cylinder");
    for (set, fragment) in [
        (
            "program.steps=1000000000000",
            "program.steps: 1000000000000 is too many: at most 10000000",
        ),
        (
            "symmetry=3",
            "symmetry: 3 must be 1 (all of it is meshed), 2 (a half) or 4 (a quarter)",
        ),
        ("symmetry=7", "symmetry: 7 must be 1"),
        (
            "materials.steel.yield_stress=1e-300",
            "yield_stress: 1e-300 must lie between 1e-100 and 1e100",
        ),
        (
            "materials.steel.youngs_modulus=-1e300",
            "youngs_modulus: -1e300 must be greater than zero",
        ),
        (
            "materials.steel.plastic_modulus=1e300",
            "plastic_modulus: the slope is 1e300, beyond 1e100",
        ),
        (
            "materials.steel.hardening_table=[[0, 240.0], [1e-200, 300]]",
            "hardening_table.1: the slope from the row before is 6e201, beyond 1e100",
        ),
        (
            "load.0.history=[[0, 0], [1e-300, 1e300]]",
            "load.0.history.1: the slope from the row before is inf, beyond 1e100",
        ),
    ] {
        fails(&["check", &scene, "--set", set], 2, &[fragment]);
    }
    let ball = super::scene_path("ball_on_half_space");
    let fragment = "symmetry: 4 must be 1 (all of it is meshed) or 2 (half of it";
    fails(&["check", &ball, "--set", "symmetry=4"], 2, &[fragment]);
    let fragment = "give a whole number from 1 to ";
    fails(&["check", &scene, "--threads", "60000"], 2, &[fragment]);
}

#[test]
fn a_large_number_has_an_exponent_in_names_and_tables() {
    let scene = scene_path("contact_patch");
    let set = "program.targets=[{ load_factor = 1e300 }]";
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = brinell(&[
        "run",
        &scene,
        "-q",
        "--no-report",
        "--set",
        set,
        "--set",
        "reference=[]",
        "--out",
        out.to_str().unwrap(),
    ]);
    let text = stdout(&output);
    assert!(text.contains("alpha 1e300"), "{text}");
    assert!(!text.contains("00000000000000000000"), "{text}");
}

#[cfg(unix)]
#[test]
#[should_panic(expected = "took longer than")]
fn a_process_that_never_ends_is_killed_and_fails() {
    limit::output_within(Command::new("sleep").arg("600"), Duration::from_millis(50));
}

#[test]
fn a_test_that_takes_too_long_is_known_by_its_name() {
    limit::watch();
    std::thread::sleep(Duration::from_millis(30));
    // Tests beside this one may be among them.
    let names = limit::overdue(Duration::from_millis(10));
    let own = "cli::pressure::a_test_that_takes_too_long_is_known_by_its_name";
    assert!(names.iter().any(|name| name == own), "{names:?}");
    assert!(limit::overdue(Duration::from_secs(3600)).is_empty());
}
