//! Points of one elastic structure share its factorisation.

use super::{program, stdout, succeeds};
use serde_json::Value;
use std::path::Path;

/// A ball on a flat whose mesh does not depend on the yield stress.
fn ball(folder: &Path) -> String {
    let scene = folder.join("ball.toml");
    let text = std::fs::read_to_string(super::scene_path("ball_on_half_space")).unwrap();
    let mesh = "resolution = 3\nhalf_width = 0.16\ncontact_width = 4.0";
    let text = text.replace("resolution = 12", mesh);
    let text = text.replace("far_size = 200.0", "far_size = 20.0");
    let (text, _) = text.split_once("[program]").unwrap();
    let program = "[program]\ntargets = [{ name = \"pressed\", load_factor = 1.0 }, \
                   { name = \"off\", load_factor = 0.0 }]\n";
    std::fs::write(&scene, format!("{text}{program}")).unwrap();
    scene.to_str().unwrap().to_string()
}

fn swept(scene: &str, more: &[&str]) -> Vec<Value> {
    let all = ["sweep", scene, "--no-estimate", "--no-report", "--json"];
    let run = succeeds(&[&all[..], more].concat());
    let found: Value = serde_json::from_slice(&run.stdout).unwrap();
    found["points"].as_array().unwrap().clone()
}

fn made(points: &[Value]) -> Vec<u64> {
    let of_point = |point: &Value| point["factorizations"].as_u64().unwrap();
    points.iter().map(of_point).collect()
}

/// Figures are those of a run by itself, the points stand in order, and only the one that yields
/// furthest, which is run first, is factored for.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn yield_stresses_and_loads_share_a_factorisation() {
    for (key, values, furthest) in [
        ("materials.steel.yield_stress", ["600", "450"], 1),
        ("load.press.plane_force.total", ["-70", "-100"], 1),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let scene = ball(folder.path());
        let load = ["--set", "load.press.plane_force.total=-100"];
        let vary = format!("{key}={}", values.join(","));
        let points = swept(&scene, &[&load[..], &["--vary", &vary]].concat());
        let made = made(&points);
        for (k, (point, value)) in points.iter().zip(values).enumerate() {
            assert_eq!(point["values"][key], value);
            assert_eq!(made[k] > 0, k == furthest, "{key}: {made:?}");
            let alone = succeeds(&[
                "run",
                &scene,
                "-q",
                "--no-estimate",
                "--no-report",
                "--json",
                load[0],
                load[1],
                "--set",
                &format!("{key}={value}"),
            ]);
            let alone: Value = serde_json::from_str(&stdout(&alone)).unwrap();
            assert!(alone["counts"]["factorizations"].as_u64() >= Some(1));
            for (state, name) in [(0, "pressed"), (1, "off")] {
                for figure in [
                    "approach",
                    "residual_depth",
                    "max_equivalent_plastic_strain",
                ] {
                    let found = &point["figures"][format!("states.{name}.{figure}")];
                    let expected = alone["states"][state][figure].as_f64().unwrap();
                    let off = found.as_f64().unwrap() - expected;
                    let size = alone["states"][0][figure].as_f64().unwrap();
                    assert!(
                        off.abs() <= 1e-9 * size,
                        "{key} {value} {name} {figure}: {off:e}"
                    );
                }
            }
        }
    }
}

/// Another modulus is another structure; and a point that fails leaves the others as they are.
#[test]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn other_structures_have_factors_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let scene = ball(folder.path());
    let vary = "materials.steel.youngs_modulus=200e3,210e3";
    let points = swept(&scene, &["--vary", vary]);
    assert!(made(&points).iter().all(|made| *made > 0), "{points:?}");
}

/// A process that ends amid a point takes that point with it; another one runs the rest.
#[test]
#[cfg(target_os = "linux")]
#[cfg(any(feature = "cholmod", feature = "faer"))]
fn a_killed_process_takes_one_point_with_it() {
    use std::process::Stdio;
    use std::time::{Duration, Instant};
    let folder = tempfile::tempdir().unwrap();
    let scene = ball(folder.path());
    let out = folder.path().join("swept");
    let child = program()
        .args(["sweep", &scene, "--no-estimate", "--no-report", "--json"])
        .args(["--vary", "materials.steel.yield_stress=450,600,650"])
        .args(["--out", out.to_str().unwrap()])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // Its worker is the process that it is the parent of.
    let worker = || {
        let path = format!("/proc/{0}/task/{0}/children", child.id());
        let children = std::fs::read_to_string(path).unwrap_or_default();
        let of_main = children.split_whitespace().next().map(str::to_string);
        of_main.or_else(|| {
            let tasks = std::fs::read_dir(format!("/proc/{}/task", child.id())).ok()?;
            let files = tasks.flatten().map(|task| task.path().join("children"));
            let mut lists = files.filter_map(|file| std::fs::read_to_string(file).ok());
            lists.find_map(|list| list.split_whitespace().next().map(str::to_string))
        })
    };
    let start = Instant::now();
    let id = loop {
        // The first point is under way as soon as its directory is in the making.
        let is_under_way = std::fs::read_dir(&out).map_or(0, |d| d.count()) > 0;
        if let Some(id) = worker().filter(|_| is_under_way) {
            break id.parse().unwrap();
        }
        assert!(start.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    };
    let pid = rustix::process::Pid::from_raw(id).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::KILL).unwrap();
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(5));
    let found: Value = serde_json::from_slice(&ended.stdout).unwrap();
    let codes = found["points"].as_array().unwrap().iter();
    let codes: Vec<Option<i64>> = codes.map(|point| point["exit_code"].as_i64()).collect();
    assert_eq!(codes, [None, Some(0), Some(0)]);
}
