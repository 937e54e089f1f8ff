//! The program from the outside: what it prints where, and its exit codes.

mod accuracy;
mod below;
mod ccx;
mod directory;
mod guide;
mod hardness;
mod hertz;
mod interruption;
mod iso76;
mod kernels;
mod mutations;
mod outputs;
mod pressure;
mod readme;
mod refusals;
mod scene_help;
mod shown;
mod solids;
mod solvers;
mod sweep;
mod sweep_points;
mod sweep_shared;
mod targets;
mod watching;

use crate::support::program::{program, stderr, stdout, summary};
use crate::support::{limit, scene_path};
use std::path::PathBuf;
use std::process::Output;

/// Runs the program.
fn brinell(arguments: &[&str]) -> Output {
    limit::output(program().args(arguments))
}

/// Runs the program, which must succeed.
#[track_caller]
fn succeeds(arguments: &[&str]) -> Output {
    crate::support::program::succeeds(program().args(arguments))
}

/// A scene in a folder of its own: what a failed command leaves behind shows there.
struct Folder {
    folder: tempfile::TempDir,
}

impl Folder {
    fn with_scene(text: &str) -> Folder {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), text).unwrap();
        Folder { folder }
    }

    /// A scene of `data/scenes`, each of `changes` (old, new) made at its only place.
    fn with_changes(name: &str, changes: &[(&str, &str)]) -> Folder {
        let mut text = std::fs::read_to_string(scene_path(name)).unwrap();
        for (old, new) in changes {
            assert_eq!(text.matches(old).count(), 1, "{old:?} in {name}");
            text = text.replace(old, new);
        }
        Folder::with_scene(&text)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn scene(&self) -> PathBuf {
        self.path("scene.toml")
    }

    fn entries(&self) -> usize {
        std::fs::read_dir(self.folder.path()).unwrap().count()
    }

    /// Runs `command` on the scene, results going to `out` in the folder (`check` has none).
    fn brinell(&self, command: &str, more: &[&str]) -> Output {
        let (scene, out) = (self.scene(), self.path("out"));
        let mut arguments = vec![command, scene.to_str().unwrap()];
        if command != "check" {
            arguments.extend(["--out", out.to_str().unwrap()]);
        }
        arguments.extend(more);
        brinell(&arguments)
    }

    /// `run` fails with `code` and one error that holds the `fragments`, and leaves nothing behind.
    fn refused(&self, code: i32, fragments: &[&str]) {
        let entries = self.entries();
        let output = self.brinell("run", &["--quiet"]);
        let stderr = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{stderr}");
        assert_eq!(stderr.matches("error: ").count(), 1, "{stderr}");
        for fragment in fragments {
            assert!(stderr.contains(fragment), "no {fragment:?} in {stderr}");
        }
        assert_eq!(stdout(&output), "");
        assert_eq!(self.entries(), entries, "something was left behind");
    }

    fn summary(&self) -> serde_json::Value {
        summary(&self.path("out"))
    }
}

/// A figure is the expected one to a share of it.
#[track_caller]
fn near(found: f64, expected: f64, share: f64) {
    assert!((found / expected - 1.0).abs() < share, "{found} {expected}");
}

/// The command fails with `code`, says why on standard error and nothing on standard output.
fn fails(arguments: &[&str], code: i32, fragments: &[&str]) {
    let output = brinell(arguments);
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    for fragment in fragments {
        assert!(stderr.contains(fragment), "no {fragment:?} in {stderr}");
    }
    assert_eq!(stdout(&output), "");
}

#[test]
fn help_tells_commands_options_examples_and_exit_codes() {
    let output = brinell(&["--help"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    for fragment in ["run", "yield", "check", "Examples:", "Exit codes:", "130"] {
        assert!(text.contains(fragment), "no {fragment:?} in {text}");
    }
    for command in ["run", "yield", "check"] {
        let output = brinell(&[command, "--help"]);
        assert_eq!(output.status.code(), Some(0));
        let text = stdout(&output);
        for fragment in [
            "--set",
            "--solver",
            "cholmod",
            "faer",
            "dense",
            "--threads",
            "--json",
            "SCENE",
            "Example:",
        ] {
            assert!(
                text.contains(fragment),
                "{command}: no {fragment:?} in {text}"
            );
        }
        assert_eq!(text.contains("--out"), command != "check");
    }
}

#[test]
fn version_is_that_of_the_package() {
    let output = brinell(&["--version"]);
    assert_eq!(
        stdout(&output),
        concat!("brinell ", env!("CARGO_PKG_VERSION"), "\n")
    );
}

#[test]
fn a_wrong_command_line_is_exit_code_2() {
    fails(&[], 2, &["Usage: brinell"]);
    fails(&["press"], 2, &["unrecognized subcommand 'press'"]);
    fails(&["run"], 2, &["SCENE"]);
    fails(
        &["run", "a.toml", "--solver", "magic"],
        2,
        &["magic", "cholmod", "faer", "dense"],
    );
    fails(&["run", "a.toml", "--threads", "0"], 2, &["--threads"]);
    fails(
        &["run", "a.toml", "--thread", "2"],
        2,
        &["--thread", "--threads"],
    );
}

#[test]
fn a_missing_scene_is_exit_code_3_with_the_reason() {
    for command in ["run", "yield", "check"] {
        fails(
            &[command, "no/such/scene.toml"],
            3,
            &[
                "error: cannot read the scene no/such/scene.toml",
                "caused by: No such file",
            ],
        );
    }
}

#[test]
fn an_unknown_key_is_exit_code_2_with_line_and_suggestion_and_leaves_nothing_behind() {
    let good = std::fs::read_to_string(scene_path("contact_patch")).unwrap();
    let line = 1 + good
        .lines()
        .position(|l| l.starts_with("poissons_ratio"))
        .unwrap();
    let folder = Folder::with_scene(&good.replace("poissons_ratio", "poisson_ratio"));
    let path = folder.scene();
    let path = path.to_str().unwrap();
    for command in ["run", "yield", "check"] {
        fails(
            &[command, path],
            2,
            &[&format!(
                "error: {path}:{line}:1: unknown key `poisson_ratio`, did you mean \
                 `poissons_ratio`?"
            )],
        );
    }
    assert_eq!(folder.entries(), 1);
}

#[test]
fn an_effect_that_brinell_has_not_is_exit_code_2() {
    let good = std::fs::read_to_string(scene_path("contact_patch")).unwrap();
    let folder = Folder::with_scene(&good.replace("[[contact]]", "[[contact]]\nfriction = 0.3"));
    fails(
        &["run", folder.scene().to_str().unwrap()],
        2,
        &["contact.0.friction: brinell has no friction"],
    );
    assert_eq!(folder.entries(), 1);
}

#[test]
fn a_wrong_override_is_exit_code_2_and_names_itself() {
    let scene = scene_path("contact_patch");
    for (text, fragment) in [
        ("kind", "error: --set kind: an override is KEY=VALUE"),
        (
            "materials.steel.youngs_modulos=3",
            "error: --set materials.steel.youngs_modulos=3: unknown key `youngs_modulos`, did you \
             mean `youngs_modulus`?",
        ),
        ("contact.7.gap=1", "`contact` has no entry `7`"),
        (
            "materials.steel.youngs_modulus=nan",
            "materials.steel.youngs_modulus: nan is not a finite number",
        ),
        (
            "materials.steel.poissons_ratio=0.5",
            "error: --set materials.steel.poissons_ratio=0.5: materials.steel.poissons_ratio: 0.5 \
             must lie",
        ),
    ] {
        fails(&["check", &scene, "--set", text], 2, &[fragment]);
    }
}
