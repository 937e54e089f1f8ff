//! The program begins anew where OpenBLAS computes with less than the processor has. An OpenBLAS
//! that does not know the processor is played by a library that is loaded before it.

use super::program;
use crate::support::limit;
use crate::support::program::summary;
use crate::support::tools;
use brinell::linalg::cholmod::{KERNEL_SETTING, kernels};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Says `Prescott` until it is told which kernels to take, then what is true, or always `Prescott`.
const OLD_LIBRARY: &str = r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
char *openblas_get_corename(void) {
    char *(*truth)(void) = (char *(*)(void))dlsym(RTLD_NEXT, "openblas_get_corename");
    if (getenv("STUBBORN") || !getenv("OPENBLAS_CORETYPE")) return "Prescott";
    return truth();
}
"#;

fn old_library(directory: &Path) -> PathBuf {
    let (source, library) = (directory.join("old.c"), directory.join("old.so"));
    std::fs::write(&source, OLD_LIBRARY).unwrap();
    let mut compiler = Command::new("cc");
    compiler.args(["-shared", "-fPIC", "-o"]).arg(&library);
    let output = compiler.arg(&source).arg("-ldl").output().unwrap();
    assert!(output.status.success(), "{output:?}");
    library
}

/// The kernels that `brinell check` names with settings of the environment.
fn named(settings: &[(&str, &str)], library: Option<&Path>) -> String {
    let scene = crate::support::scene_file("flat_punch");
    let mut command = program();
    command.arg("check").arg(scene).env_remove(KERNEL_SETTING);
    command.envs(settings.iter().copied());
    if let Some(library) = library {
        command.env("LD_PRELOAD", library);
    }
    let output = limit::output(&mut command);
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    let (_, after) = text
        .split_once("(kernels ")
        .unwrap_or_else(|| panic!("{text}"));
    after.split(',').next().unwrap().to_string()
}

#[test]
fn kernels_of_an_old_processor_are_replaced_once_and_never_over_the_user_s() {
    let is_asked = cfg!(all(target_os = "linux", target_arch = "x86_64")) && kernels().is_some();
    if !is_asked || !tools::has("cc") {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let library = old_library(directory.path());
    let expected = if is_x86_feature_detected!("avx512vl") {
        "SkylakeX"
    } else if is_x86_feature_detected!("avx2") {
        "Haswell"
    } else {
        return;
    };
    assert_eq!(named(&[], Some(&library)), expected);
    // One beginning anew is enough where it does not help.
    assert_eq!(named(&[("STUBBORN", "1")], Some(&library)), "Prescott");
    // What the user says stays, also where the processor or OpenBLAS does not have it.
    assert_eq!(named(&[(KERNEL_SETTING, "Prescott")], None), "Prescott");
    assert_eq!(named(&[(KERNEL_SETTING, "Nehalem")], None), "Nehalem");
    let _ = named(&[(KERNEL_SETTING, "NoSuchCore")], None);
}

#[test]
fn results_of_other_kernels_agree_to_round_off() {
    if !cfg!(target_arch = "x86_64") || kernels().is_none() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let states = |name: &str| -> Vec<serde_json::Value> {
        let out = directory.path().join(name);
        let mut command = program();
        command
            .arg("run")
            .arg(crate::support::scene_file("cylinder_on_half_plane"))
            .args(["--set", "mesh.cylinder_on_half_plane.resolution=4"])
            .args(["--no-estimate", "--quiet", "--out"])
            .arg(&out)
            .env(KERNEL_SETTING, name);
        let output = limit::output(&mut command);
        assert!(output.status.success(), "{output:?}");
        let summary = summary(&out);
        assert_eq!(summary["kernels"], name);
        summary["states"].as_array().unwrap().clone()
    };
    // Kernels that differ in the order of their sums.
    let fast = if is_x86_feature_detected!("avx2") {
        "Haswell"
    } else {
        "Nehalem"
    };
    let pairs: Vec<_> = states("Prescott").into_iter().zip(states(fast)).collect();
    assert!(pairs.len() > 3);
    for (state, twin) in &pairs {
        for key in ["load", "max_pressure", "half_width", "approach"] {
            let (a, b) = (state[key].as_f64().unwrap(), twin[key].as_f64().unwrap());
            // Round-off times the condition of the model, some 1e4, as far as plastic flow keeps
            // it.
            assert!(
                (a - b).abs() <= 1e-8 * a.abs().max(1.0),
                "{key}: {a} and {b}"
            );
        }
    }
}
