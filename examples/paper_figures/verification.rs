//! `data/verification.md`: every reference value of every scene in `data/scenes` beside what is
//! computed.

use crate::{Outcome, runs};
use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::progress::Silent;
use brinell::reference;
use brinell::results::Results;
use brinell::scene::Scene;
use std::fmt::Write;

/// The scene of Table I, run at several resolutions.
const CYLINDER: &str = "cylinder_on_half_plane.toml";
const RESOLUTIONS: [usize; 4] = [4, 8, 16, 32];
/// Scenes with another setting, beside the scene as it is.
const VARIANTS: [(&str, &str); 2] = [
    ("disc_in_plate.toml", "kind=plane_strain"),
    (CYLINDER, "analysis.yield_load=secant"),
];

const HEAD: &str = "\
# What was verified, against what

This file is written by `cargo run --release --example paper_figures -- verification`. Each \
number also stands in the
report of the command beside it. *Ratio* is computed over reference. The sources of the \
reference values are in
[`data/reference`](reference/README.md).
";

pub fn write() -> Outcome<()> {
    let mut text = HEAD.to_string();
    table_1(&mut text)?;
    let mut quality = String::new();
    scenes(&mut text, &mut quality)?;
    text += "\n## Quality of every state\n\nEach figure is the worst over all states of a \
             scene. Backward error is that of the full solve; equilibrium is the out-of-balance \
             force of the stresses divided by the largest nodal force; complementarity is gap \
             times force divided by the product of their largest values; penetration is the \
             overlap divided by the largest displacement.\n\n| scene | states | backward error \
             | equilibrium | complementarity | penetration |\n|---|---|---|---|---|---|\n";
    text += &quality;
    let path = runs::data("verification.md");
    std::fs::write(&path, text)?;
    println!("{}", path.display());
    Ok(())
}

fn load(file: &str, overrides: &[String]) -> Outcome<Scene> {
    Ok(Scene::load_with(
        runs::data("scenes").join(file),
        overrides,
    )?)
}

fn analysis(scene: &Scene) -> Outcome<Analysis> {
    Ok(Analysis::new(Model::new(scene)?, Backend::default())?)
}

fn table_1(text: &mut String) -> Outcome<()> {
    *text += "\n## Table I of the paper: first yield of the cylinder on the half plane\n\n\
             Ratios of computed to exact values (Hertz, von Mises, nu = 0.3), for several \
             numbers of elements over the contact half width b* at first yield.\n\n\
             | elements over b* | load P* | pressure p* | half \
              width b* | depth z* |\n|---|---|---|---|---|\n| paper, 1984 | 0.87 | 0.94 | 0.98 | \
              0.94 |\n";
    for resolution in RESOLUTIONS {
        let scene = load(
            CYLINDER,
            &[format!(
                "mesh.cylinder_on_half_plane.resolution={resolution}"
            )],
        )?;
        let mut analysis = analysis(&scene)?;
        let mut results = analysis.yield_load(&mut Silent)?;
        reference::compare(analysis.model(), &mut results);
        write!(text, "| {resolution} |")?;
        for quantity in [
            "yield.load",
            "yield.max_pressure",
            "yield.half_width",
            "yield.location.y",
        ] {
            let row = results.reference.iter().find(|r| r.quantity == quantity);
            let row = row.ok_or_else(|| format!("no reference value for `{quantity}`"))?;
            write!(text, " {:.4} |", row.ratio)?;
        }
        text.push('\n');
        println!("Table I, {resolution} elements over b*");
    }
    writeln!(
        text,
        "\n`brinell yield data/scenes/{CYLINDER} --set mesh.cylinder_on_half_plane.resolution=32`, \
         and so on."
    )?;
    Ok(())
}

fn scenes(text: &mut String, quality: &mut String) -> Outcome<()> {
    let mut files: Vec<String> = std::fs::read_dir(runs::data("scenes"))?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    files.sort();
    for file in &files {
        let plain = run(file, None)?;
        let mut title = plain.0;
        quality_row(quality, file, &plain.1)?;
        let mut rows = reference_rows(&plain.1)?;
        let mut command = format!("`brinell run data/scenes/{file}`");
        for (_, setting) in VARIANTS.iter().filter(|(name, _)| name == file) {
            append(text, &title, &command, &rows)?;
            let (_, results) = run(file, Some(setting))?;
            rows = reference_rows(&results)?;
            quality_row(quality, &format!("{file}, {setting}"), &results)?;
            command = format!("`brinell run data/scenes/{file} --set {setting}`");
            title.clear();
        }
        append(text, &title, &command, &rows)?;
    }
    Ok(())
}

fn run(file: &str, setting: Option<&str>) -> Outcome<(String, Results)> {
    let overrides: Vec<String> = setting.iter().map(|s| s.to_string()).collect();
    let scene = load(file, &overrides)?;
    let mut analysis = analysis(&scene)?;
    let mut results = analysis.run(&mut Silent)?;
    reference::compare(analysis.model(), &mut results);
    println!("{file} {}", setting.unwrap_or(""));
    Ok((scene.title, results))
}

/// A scene's table; an empty title goes on with the scene above.
fn append(text: &mut String, title: &str, command: &str, rows: &str) -> Outcome<()> {
    if rows.is_empty() {
        return Ok(());
    }
    if !title.is_empty() {
        write!(text, "\n## {title}\n")?;
    }
    write!(
        text,
        "\n{command}\n\n| quantity | reference | computed | ratio | source \
         |\n|---|---|---|---|---|\n{rows}"
    )?;
    Ok(())
}

fn reference_rows(results: &Results) -> Outcome<String> {
    let mut rows = String::new();
    if let Some(end) = &results.incomplete {
        writeln!(rows, "| **ended early** | | | | {} |", end.why)?;
    }
    for r in &results.reference {
        writeln!(
            rows,
            "| {} | {} | {} | {:.5} | {} |",
            r.quantity,
            digits(r.reference),
            digits(r.computed),
            r.ratio,
            r.source
        )?;
    }
    Ok(rows)
}

fn quality_row(out: &mut String, name: &str, results: &Results) -> Outcome<()> {
    let q = &results.quality;
    writeln!(
        out,
        "| {name} | {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} |",
        results.states.len(),
        q.backward_error,
        q.equilibrium,
        q.complementarity,
        q.penetration
    )?;
    Ok(())
}

/// Six significant digits.
pub fn digits(value: f64) -> String {
    let magnitude = if value == 0.0 {
        0
    } else {
        value.abs().log10().floor() as i32
    };
    if (-4..6).contains(&magnitude) {
        format!("{value:.*}", (5 - magnitude).max(0) as usize)
    } else {
        format!("{value:.5e}")
    }
}
