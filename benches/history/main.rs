//! A whole history against bare CHOLMOD: the cylinder on the half plane, loaded to 1.5 b* and
//! unloaded, beside what CHOLMOD alone needs to analyse (in the order it chooses by default),
//! factor and solve the same matrix once.
//!
//! Every measurement has a process of its own, so that peaks of memory do not mix: `run` is brinell
//! from scene to written results, `matrix` writes the assembled matrix to a file, `cholmod` reads
//! that file and does nothing else.
//!
//! `cargo bench --bench history` takes the sizes of [`SIZES`]; `-- 10k` or `-- 100k` or `-- 1M` one
//! of them. `-- solid` takes the ball of `data/peers/ball_contact.toml` in three dimensions, loaded
//! to five times first yield and back, in [`SOLID`]. The table goes to the terminal, the figures to
//! `bench-results/history.json`. `-- perfect` the same without hardening. `-- unlike` runs a pin in
//! a hole, where nodes face each other and where they do not ([`UNLIKE`]). `-- scaling` runs meshes
//! from ten thousand to three million freedoms instead, on one thread and on two
//! (`scaling.rs`). `--features faer` and `-- backends` put the sparse backends beside one
//! another (`backends.rs`).

mod backends;
#[path = "../process/mod.rs"]
mod process;
mod scaling;

use brinell::analysis::Analysis;
use brinell::linalg::cholmod::{blas_name, cholmod_version, solve_unconstrained};
use brinell::linalg::{Backend, SymmetricCsc};
use brinell::model::Model;
use brinell::output::{self, RunHeader};
use brinell::progress::Silent;
use brinell::scene::Scene;
use process::{Failure, child, peak_memory, processor_seconds};
use serde_json::{Value, json};
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/");
const LINE: &str = "scenes/cylinder_on_half_plane.toml";
const PIN: &str = "scenes/hard/to_and_fro.toml";
const BALL: &str = "peers/ball_contact.toml";

/// Name, and what is changed in the scene's mesh: elements over b* and growth of the element sizes
/// outside the even region. The finer the contact, the more slowly sizes should grow: the
/// discretisation errors stay balanced.
const SIZES: [(&str, &[&str]); 4] = [
    (
        "10k",
        &[
            "mesh.cylinder_on_half_plane.resolution=8",
            "mesh.cylinder_on_half_plane.growth=1.25",
        ],
    ),
    (
        "100k",
        &[
            "mesh.cylinder_on_half_plane.resolution=32",
            "mesh.cylinder_on_half_plane.growth=1.08",
        ],
    ),
    (
        "1M",
        &[
            "mesh.cylinder_on_half_plane.resolution=64",
            "mesh.cylinder_on_half_plane.growth=1.02",
        ],
    ),
    (
        "1M, even finer far field",
        &[
            "mesh.cylinder_on_half_plane.resolution=32",
            "mesh.cylinder_on_half_plane.growth=1.015",
        ],
    ),
];

/// The same of the ball: elements over its contact radius at first yield.
const SOLID: [(&str, &[&str]); 4] = [
    (
        "50k",
        &[
            "mesh.curved_bodies.resolution=5",
            "mesh.curved_bodies.growth=1.3",
        ],
    ),
    (
        "110k",
        &[
            "mesh.curved_bodies.resolution=7",
            "mesh.curved_bodies.growth=1.3",
        ],
    ),
    (
        "300k",
        &[
            "mesh.curved_bodies.resolution=10",
            "mesh.curved_bodies.growth=1.2",
        ],
    ),
    (
        "700k",
        &[
            "mesh.curved_bodies.resolution=13",
            "mesh.curved_bodies.growth=1.15",
        ],
    ),
];

/// The pin of `data/scenes/hard/to_and_fro.toml`: elements of the pin (counted over a quarter) on
/// those of the plate (over the half).
const UNLIKE: [(&str, &[&str]); 3] = [
    ("1:1", &["mesh.parts.0.disc.elements=144", PLATE]),
    ("3:2", &["mesh.parts.0.disc.elements=216", PLATE]),
    ("2:3", &["mesh.parts.0.disc.elements=96", PLATE]),
];
const PLATE: &str = "mesh.parts.1.ring.elements=[144,288]";

/// Pairs of runs of which the medians count, where bare CHOLMOD takes less than `LONG` seconds.
const REPEATED: usize = 7;
const LONG: f64 = 5.0;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["run", changes, directory] => {
            print(&run(Backend::Cholmod, changes, Path::new(directory))?)
        }
        ["run-by", name, changes, directory] => {
            let backend = Backend::from_name(name)?;
            print(&run(backend, changes, Path::new(directory))?)
        }
        ["factor-by", name, changes] => {
            print(&backends::factor(Backend::from_name(name)?, changes)?)
        }
        ["backends", ref names @ ..] => backends::measure(names),
        ["matrix", changes, directory] => write_matrix(changes, Path::new(directory)),
        ["cholmod", directory] => print(&bare(Path::new(directory))?),
        ["check", changes] => print(&scaling::prediction(changes)?),
        ["scaling"] => scaling::measure(),
        ["auto", ref names @ ..] => compare(
            (LINE, &SIZES, names),
            &["program.stepping=\"auto\""],
            "history_auto",
        ),
        ["perfect", ref names @ ..] => compare(
            (LINE, &SIZES, names),
            &["materials.steel.plastic_modulus=0.0"],
            "history_perfect",
        ),
        ["unlike", ref names @ ..] => compare((PIN, &UNLIKE, names), &[], "history_unlike"),
        ["solid", ref names @ ..] => compare((BALL, &SOLID, names), &[], "history_solid"),
        ref names => compare((LINE, &SIZES, names), &[], "history"),
    }
}

fn print(value: &Value) -> Result<(), Failure> {
    println!("{value}");
    Ok(())
}

/// A scene and what is changed in it, separated by semicolons.
fn scene(case: &str) -> Result<Scene, Failure> {
    let mut parts = case.split(';').map(str::to_string);
    let file = parts.next().ok_or("no scene")?;
    let overrides: Vec<String> = parts.collect();
    let mut scene = Scene::load_with(Path::new(DATA).join(file), &overrides)?;
    // Fields of one state, as a user with a large model would ask for.
    for target in &mut scene.program.targets {
        target.fields = target.name.as_deref() == Some("1.5 b*");
    }
    Ok(scene)
}

/// brinell from scene to files.
fn run(backend: Backend, changes: &str, directory: &Path) -> Result<Value, Failure> {
    rayon::ThreadPoolBuilder::new()
        .use_current_thread()
        .build_global()?;
    let start = Instant::now();
    let scene = scene(changes)?;
    let model = Model::new(&scene)?;
    let modelled = start.elapsed().as_secs_f64();
    let mut analysis = Analysis::new(model, backend)?;
    let results = analysis.run(&mut Silent)?;
    let analysed = start.elapsed().as_secs_f64();
    let header = RunHeader {
        scene_title: scene.title.clone(),
        kind: scene.kind.name().to_string(),
        solver: backend.name().to_string(),
        kernels: backend.kernels(),
        bodies: analysis.model().mesh.bodies.clone(),
        ..RunHeader::default()
    };
    output::write(
        &directory.join("out"),
        &header,
        &analysis.model().mesh,
        &results,
    )?;
    let total = start.elapsed().as_secs_f64();
    let mut phases = vec![json!(["mesh and model", modelled])];
    phases.extend(
        results
            .timings
            .iter()
            .map(|(phase, seconds)| json!([phase, seconds])),
    );
    phases.push(json!(["output", total - analysed]));
    Ok(json!({
        "seconds": total,
        "processor_seconds": processor_seconds()?,
        "peak_bytes": peak_memory()?,
        "phases": phases,
        "sizes": results.sizes,
        "counts": results.counts,
        "factor": results.factor,
        "quality": results.quality,
        "increments": results.history.len(),
        "states": results.states.len(),
        "incomplete": results.incomplete.as_ref().map(|end| &end.why),
    }))
}

/// The matrix that is factored, `K + D` on the contact freedoms of the body that contact alone
/// holds: `n`, the number of entries, column pointers, rows, values.
fn write_matrix(changes: &str, directory: &Path) -> Result<(), Failure> {
    let analysis = Analysis::new(Model::new(&scene(changes)?)?, Backend::Cholmod)?;
    let model = analysis.model();
    let stiffness = &analysis.system().stiffness;
    let matrix = stiffness.whole().ok_or("the matrix is elsewhere")?;
    let columns = matrix.proper_indptr();
    let mut values = matrix.data().to_vec();
    for (freedom, floats) in model.rows.freedoms.iter().zip(&model.floating.of_contact) {
        if *floats {
            values[columns[freedom + 1] as usize - 1] *= 2.0;
        }
    }
    let mut file = BufWriter::new(std::fs::File::create(directory.join("matrix"))?);
    let integers = [matrix.cols() as i64, matrix.nnz() as i64];
    for value in integers
        .iter()
        .chain(columns.iter())
        .chain(matrix.indices())
    {
        file.write_all(&value.to_le_bytes())?;
    }
    for value in values {
        file.write_all(&value.to_le_bytes())?;
    }
    Ok(file.flush()?)
}

/// CHOLMOD alone: analyse, factor, solve once.
fn bare(directory: &Path) -> Result<Value, Failure> {
    let mut file = BufReader::new(std::fs::File::open(directory.join("matrix"))?);
    let mut word = || -> Result<[u8; 8], Failure> {
        let mut bytes = [0; 8];
        file.read_exact(&mut bytes)?;
        Ok(bytes)
    };
    let n = i64::from_le_bytes(word()?) as usize;
    let entries = i64::from_le_bytes(word()?) as usize;
    let mut columns = Vec::with_capacity(n + 1);
    for _ in 0..=n {
        columns.push(i64::from_le_bytes(word()?));
    }
    let mut rows = Vec::with_capacity(entries);
    for _ in 0..entries {
        rows.push(i64::from_le_bytes(word()?));
    }
    let mut values = Vec::with_capacity(entries);
    for _ in 0..entries {
        values.push(f64::from_le_bytes(word()?));
    }
    let matrix = SymmetricCsc::new_csc((n, n), columns, rows, values);
    let load = vec![1.0; n];
    let before = processor_seconds()?;
    let cost = solve_unconstrained(&matrix, &load)?;
    Ok(json!({
        "freedoms": n,
        "entries": entries,
        "analyse": cost.analyse_seconds,
        "factor": cost.factor_seconds,
        "solve": cost.solve_seconds,
        "seconds": cost.analyse_seconds + cost.factor_seconds + cost.solve_seconds,
        "processor_seconds": processor_seconds()? - before,
        "factor_nonzeros": cost.prediction.factor_nonzeros,
        "flops": cost.prediction.flops,
        "peak_bytes": peak_memory()?,
    }))
}

/// A scene, the sizes of its meshes, and the names of those to be taken; none for all.
type Sizes<'a> = (&'a str, &'a [(&'a str, &'a [&'a str])], &'a [&'a str]);

fn compare((file, sizes, names): Sizes, always: &[&str], to: &str) -> Result<(), Failure> {
    println!("CHOLMOD {}, {}\n", cholmod_version(), blas_name());
    let mut all = Vec::new();
    for &(name, changes) in sizes {
        if !names.is_empty() && !names.contains(&name) {
            continue;
        }
        let directory = tempfile::tempdir()?;
        let path = directory
            .path()
            .to_str()
            .ok_or("a temporary directory with an odd name")?;
        let changes = [&[file], changes, always].concat().join(";");
        child(&["matrix", &changes, path], None)?;
        let (bare, run) = median_pair(&["cholmod", path], &["run", &changes, path])?;
        report(name, &changes, &bare, &run);
        all.push(json!({"size": name, "changes": changes, "cholmod": bare, "brinell": run}));
    }
    let results = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("bench-results");
    std::fs::create_dir_all(&results)?;
    let file = results.join(format!("{to}.json"));
    let text = serde_json::to_string_pretty(&json!({
        "cholmod_version": cholmod_version(),
        "blas": blas_name(),
        "processors": std::thread::available_parallelism()?.get(),
        "sizes": all,
    }))?;
    std::fs::write(&file, text + "\n")?;
    Ok(())
}

/// Both programs in turn, as often as their time allows: the median of each.
fn median_pair(bare: &[&str], run: &[&str]) -> Result<(Value, Value), Failure> {
    let mut pairs: [Vec<Value>; 2] = Default::default();
    let seconds = |value: &Value| value["seconds"].as_f64().unwrap_or(f64::NAN);
    loop {
        for (values, arguments) in pairs.iter_mut().zip([bare, run]) {
            values.push(serde_json::from_str(&child(arguments, None)?)?);
        }
        if pairs[0].len() == REPEATED || seconds(&pairs[0][0]) > LONG {
            break;
        }
    }
    let [bare, run] = pairs.map(|mut values| {
        values.sort_by(|a, b| seconds(a).total_cmp(&seconds(b)));
        values.swap_remove(values.len() / 2)
    });
    Ok((bare, run))
}

fn report(name: &str, changes: &str, bare: &Value, run: &Value) {
    let number = |value: &Value, key: &str| value[key].as_f64().unwrap_or(f64::NAN);
    let seconds = number(bare, "seconds");
    let count = |group: &str, key: &str| run[group][key].as_u64().unwrap_or(0);
    println!(
        "{name} ({}): {} freedoms, {} elements, {} pairs, zone {} freedoms",
        changes
            .replace("mesh.cylinder_on_half_plane.", "")
            .replace("mesh.curved_bodies.", "")
            .replace(';', ", "),
        count("sizes", "freedoms"),
        count("sizes", "elements"),
        count("sizes", "contact_pairs"),
        count("sizes", "zone_freedoms"),
    );
    let row = |what: &str, value: f64| {
        println!("  {what:34} {value:9.3} s {:7.2} x", value / seconds);
    };
    println!("  bare CHOLMOD");
    for what in ["analyse", "factor", "solve"] {
        row(what, number(bare, what));
    }
    println!("  brinell");
    for phase in run["phases"].as_array().into_iter().flatten() {
        row(
            phase[0].as_str().unwrap_or("?"),
            phase[1].as_f64().unwrap_or(f64::NAN),
        );
    }
    row("total", number(run, "seconds"));
    let (busy, bare_busy) = (
        number(run, "processor_seconds"),
        number(bare, "processor_seconds"),
    );
    println!(
        "  processor time {busy:.2} s against {bare_busy:.2} s, {:.2} x",
        busy / bare_busy
    );
    let (memory, bare_memory) = (number(run, "peak_bytes"), number(bare, "peak_bytes"));
    println!(
        "  peak memory: {:.0} MB against {:.0} MB, {:.2} x",
        memory / 1e6,
        bare_memory / 1e6,
        memory / bare_memory
    );
    println!(
        "  {} increments to {} states; {} factorisations, {} full and {} trailing solves, {} \
         plastic iterations\n",
        run["increments"],
        run["states"],
        count("counts", "factorizations"),
        count("counts", "full_solves"),
        count("counts", "trailing_solves"),
        count("counts", "plastic_iterations"),
    );
}
