//! `data/validation.md`: figures that others published beside what is computed, with its stated
//! error.

use crate::{Outcome, runs};
use brinell::accuracy::{Extent, estimate};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::reference;
use brinell::scene::Scene;
use std::fmt::Write;
use std::time::Instant;

const HEAD: &str = "\
# Held against published figures

Computed by `cargo run --release --example paper_figures -- validation`, which writes this file; \
`brinell run SCENE` shows the same.
*Stated* is the error that brinell states of its own figure, *ratio* is computed over published, \
seconds are those of the run
without that estimate. Formulas fitted to finite elements are held to be good to some 5 % in the \
load and 3 % in the radius.
";

pub fn write() -> Outcome<()> {
    let mut files: Vec<String> = std::fs::read_dir(runs::data("validation"))?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    files.sort();
    let mut text = HEAD.to_string();
    for file in files {
        text += &table(&file)?;
    }
    let path = runs::data("validation.md");
    std::fs::write(&path, text)?;
    println!("{}", path.display());
    Ok(())
}

fn table(file: &str) -> Outcome<String> {
    let scene = Scene::load(runs::data("validation").join(file))?;
    let start = Instant::now();
    let mut analysis = Analysis::new(Model::new(&scene)?, Backend::default())?;
    let mut results = analysis.run(&mut Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let accuracy = estimate(
        &scene,
        Backend::default(),
        &results,
        Extent::Program,
        &mut Silent,
    );
    reference::compare(analysis.model(), &mut results);
    let mut text = format!(
        "\n## {}\n\n`data/validation/{file}`, {seconds:.1} s\n\n| quantity | published | computed \
         | stated | ratio | source |\n|---|---|---|---|---|---|\n",
        scene.title
    );
    for row in &results.reference {
        let of_row = |q: &&brinell::results::QuantityError| q.quantity == row.quantity;
        let stated = accuracy.quantities.iter().find(of_row);
        let stated = stated
            .and_then(|q| q.relative_error)
            .map(|e| format!("{:.2} %", 100.0 * e));
        writeln!(
            text,
            "| {} | {:.5} | {:.5} | {} | {:.3} | {} |",
            row.quantity,
            row.reference,
            row.computed,
            stated.unwrap_or_else(|| "-".into()),
            row.ratio,
            row.source
        )?;
    }
    println!("{file}");
    Ok(text)
}
