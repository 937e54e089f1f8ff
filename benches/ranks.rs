//! Memory, time and messages against ranks: the elastic ball of `data/scenes/ball_on_flat_3d.toml`
//! by CHOLMOD and by MUMPS on 1, 2 and 4 ranks of this machine, and with the plastic zone of its
//! yield load in the smallest size.
//!
//! `cargo bench --features mumps --bench ranks` prints the table, and what the growth of operations
//! and memory between the two largest sizes comes to at ten million freedoms; the figures go to
//! `bench-results/ranks.json`. `-- 50k 110k` takes some sizes only.

mod process;

use process::Failure;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_brinell");
const RANKS: [usize; 3] = [1, 2, 4];
/// Name, elements over the contact radius, growth.
const SIZES: [(&str, usize, f64); 3] = [("50k", 5, 1.3), ("110k", 7, 1.3), ("300k", 10, 1.2)];
/// Freedoms of the model on paper.
const PAPER: f64 = 1e7;

/// Where a run was measured.
#[derive(Clone, Copy, PartialEq)]
enum Engine {
    Cholmod,
    Ranks(usize),
}

fn main() -> Result<(), Failure> {
    let names: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let folder = tempfile::tempdir()?;
    let mut all = Vec::new();
    println!(
        "| model | freedoms | engine | ranks | operations | memory of each rank, MB | predicted \
         | factor, s | stresses, s | run, s | requests | MB to and from others |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut largest = Vec::new();
    for (k, (name, resolution, growth)) in SIZES.into_iter().enumerate() {
        if !names.is_empty() && !names.iter().any(|wanted| wanted == name) {
            continue;
        }
        for plastic in [false, true].into_iter().take(if k == 0 { 2 } else { 1 }) {
            let scene = scene(folder.path(), resolution, growth, plastic)?;
            let engines = RANKS.map(Engine::Ranks);
            for engine in [&[Engine::Cholmod][..], &engines].concat() {
                let summary = run(&scene, engine, folder.path())?;
                let model = if plastic { "with a zone" } else { "elastic" };
                report(model, engine, &summary);
                if !plastic && engine == Engine::Ranks(4) {
                    largest.push(summary.clone());
                }
                all.push(json!({
                    "size": name, "plastic": plastic, "summary": summary,
                }));
            }
        }
    }
    if let [.., small, large] = &largest[..] {
        on_paper(small, large);
    }
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    let text = serde_json::to_string_pretty(&json!(all))?;
    std::fs::write(results.join("ranks.json"), text + "\n")?;
    Ok(())
}

/// The ball, elastic under what makes it yield, or up to its yield load.
fn scene(folder: &Path, resolution: usize, growth: f64, plastic: bool) -> Result<PathBuf, Failure> {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/ball_on_flat_3d.toml"
    );
    let text = std::fs::read_to_string(file)?;
    let (model, _) = text.split_once("[program]").ok_or("no program")?;
    let mesh = format!("semi_axes = [0.11, 0.11]\nresolution = {resolution}\ngrowth = {growth:?}");
    let mut text = model.replace("resolution = 6", &mesh);
    if plastic {
        text += "[program]\nunit = \"yield\"\ntargets = [{ yield = true }]\n";
    } else {
        text = text.replace(
            "material = \"steel\"",
            "material = \"steel\"\nplastic = false",
        );
        text += "[program]\ntargets = [{ load_factor = 0.02 }]\n";
    }
    let path = folder.join("ball.toml");
    std::fs::write(&path, text)?;
    Ok(path)
}

fn run(scene: &Path, engine: Engine, folder: &Path) -> Result<Value, Failure> {
    let mut command = match engine {
        Engine::Cholmod => Command::new(PROGRAM),
        Engine::Ranks(ranks) => {
            let mut command = Command::new("mpirun");
            command
                .args(["--oversubscribe", "-n", &ranks.to_string(), PROGRAM])
                .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
                .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
            command
        }
    };
    command
        .arg("run")
        .arg(scene)
        .arg("--out")
        .arg(folder.join("out"));
    command.args(["-q", "--json", "--no-estimate", "--no-report"]);
    let solver = match engine {
        Engine::Cholmod => "cholmod",
        Engine::Ranks(_) => "mumps",
    };
    let output = command.args(["--solver", solver]).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// Of each rank.
fn list(value: &Value) -> Vec<f64> {
    let values = value.as_array().map(Vec::as_slice).unwrap_or_default();
    values.iter().map(number).collect()
}

fn report(model: &str, engine: Engine, summary: &Value) {
    let megabytes = |bytes: &[f64]| {
        let each = bytes.iter().map(|bytes| format!("{:.0}", bytes / 1e6));
        each.collect::<Vec<_>>().join(", ")
    };
    let (factor, ranks) = (&summary["factor"], &summary["ranks"]);
    let timings = &summary["timings"];
    let figures = format!(
        "{:.2} | {:.2} | {:.1}",
        number(&timings["factorisation and condensation"]),
        number(&timings["stresses"]),
        number(&timings["total"])
    );
    let freedoms = &summary["freedoms"];
    let flops = number(&factor["flops"]);
    match engine {
        Engine::Cholmod => println!(
            "| {model} | {freedoms} | CHOLMOD | | {flops:.2e} | {} | {} | {figures} | | |",
            megabytes(&[number(&summary["peak_memory_bytes"])]),
            megabytes(&[number(&factor["memory_bytes"])]),
        ),
        Engine::Ranks(n) => println!(
            "| {model} | {freedoms} | MUMPS | {n} | {flops:.2e} | {} | {} | {figures} | {} \
             | {:.0} |",
            megabytes(&list(&ranks["peak_memory_bytes"])),
            megabytes(&list(&factor["memory_by_rank"])),
            ranks["requests"],
            number(&ranks["bytes"]) / 1e6,
        ),
    }
}

/// What operations, entries, memory and messages grow to: the first two by their own powers of the
/// freedoms, memory with the factor, messages with the freedoms.
fn on_paper(small: &Value, large: &Value) {
    let both = [small, large];
    let freedoms = both.map(|summary| number(&summary["freedoms"]));
    let grown = |key: &str| {
        let [a, b] = both.map(|summary| number(&summary["factor"][key]));
        let power = (b / a).ln() / (freedoms[1] / freedoms[0]).ln();
        (power, b * (PAPER / freedoms[1]).powf(power))
    };
    println!("\nAt {PAPER:e} freedoms, from the last two sizes on four ranks:\n");
    println!("| | growth | at {PAPER:e} |\n|---|---|---|");
    let (power, flops) = grown("flops");
    println!("| operations | power {power:.2} | {flops:.2e} |");
    let (power, entries) = grown("factor_nonzeros");
    println!(
        "| factor | power {power:.2} | {:.0} GB |",
        8.0 * entries / 1e9
    );
    // Matrix, work and program grow more slowly than the factor: at most as many times.
    let held = list(&large["ranks"]["peak_memory_bytes"])
        .iter()
        .sum::<f64>();
    let times = held / (8.0 * number(&large["factor"]["factor_nonzeros"]));
    println!(
        "| memory of all ranks | at most {times:.1} times the factor | {:.0} GB |",
        times * 8.0 * entries / 1e9
    );
    let bytes = number(&large["ranks"]["bytes"]) / freedoms[1];
    println!(
        "| to and from the first rank | {bytes:.0} bytes a freedom | {:.1} GB |",
        bytes * PAPER / 1e9
    );
}
