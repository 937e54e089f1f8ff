//! `brinell accuracy SCENE`: the cost of accuracy.

use super::common_arguments::CommonArguments;
use super::compute::{at_once, header, prepare};
use super::interrupt;
use super::progress::{Progress, ProgressKind};
use super::streams::{json, print};
use super::table::{ColumnAlignment::*, Table, page_width, wrap};
use super::values::duration;
use crate::accuracy::{Knob, Plan, Price, QuantityStudy, Study, Usage, foremost, study};
use crate::error::{Error, ErrorKind, Result};
use crate::model::Model;
use crate::number::{bytes, seconds, significant};
use crate::output::{self, Claim};
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `brinell accuracy`.
#[derive(Debug, Args)]
pub(super) struct StudyArguments {
    #[command(flatten)]
    pub common: CommonArguments,
    /// Directory for accuracy.json, accuracy.csv and the plots; if it is not given, SCENE with the
    /// ending .accuracy
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Time that the study may take, such as 60s or 10min; runs that would not fit are left out,
    /// except the cheapest
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub budget: Option<f64>,
    /// Number of meshes in a series: the finest has twice as many elements along a line as the
    /// scene, each of the others 1/sqrt(2) times the number of the next finer one
    #[arg(
        long,
        value_name = "N",
        default_value_t = 6,
        value_parser = clap::value_parser!(u16).range(2..=12)
    )]
    pub levels: u16,
    /// Settings to vary, separated by commas: resolution, element, stepping, tolerance, gamma,
    /// algorithm, backend; by default all
    #[arg(long, value_name = "KNOBS", value_delimiter = ',')]
    pub knobs: Vec<String>,
    /// No progress, only results and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// Runs the study, writes it and prints the findings.
pub(super) fn execute(arguments: &StudyArguments) -> Result<()> {
    let common = &arguments.common;
    let scene = prepare(common, None)?;
    let mut plan = Plan {
        levels: usize::from(arguments.levels),
        budget: arguments.budget,
        ..Plan::default()
    };
    if !arguments.knobs.is_empty() {
        plan.knobs = arguments
            .knobs
            .iter()
            .map(|k| Knob::from_name(k))
            .collect::<Result<_>>()?;
    }
    let out = (arguments.out.clone()).unwrap_or_else(|| common.scene.with_extension("accuracy"));
    let claim = Claim::new(&out)?;
    interrupt::listen(None, at_once(Some(&claim)))?;
    let start = Instant::now();
    let mut progress = Progress::new(
        arguments.quiet,
        ProgressKind::default(),
        std::time::Instant::now(),
    );
    let found = study(&scene, common.solver.into(), &plan, &mut progress)?;
    let header = header(&Model::new(&scene)?, common, start.elapsed().as_secs_f64());
    progress.start("output");
    claim.write_study(&header, &found)?;
    progress.finish();
    let text = match common.json {
        true => json(&output::study_json(&header, &found))?,
        false => report(&found, &out),
    };
    print(&text)?;
    match found.stopped {
        false => Ok(()),
        true => Err(Error::new(
            ErrorKind::Stopped,
            format!(
                "the study was stopped after {} runs; they are kept",
                found.runs.len()
            ),
        )),
    }
}

/// Length of the bar of the shortest time, and the length that a factor of ten in time adds.
const BAR: f64 = 6.0;

fn report(study: &Study, out: &Path) -> String {
    let mut text = String::from("Runs\n");
    let mut table = Table::new(&[
        (Text, "series"),
        (Text, "setting"),
        (Number, "freedoms"),
        (Number, "time"),
        (Number, "memory"),
        (Number, "plastic\niterations"),
        (Number, "worst\nerror [%]"),
    ]);
    let all = study.quantities.first();
    for (i, run) in study.runs.iter().enumerate() {
        let error = all.and_then(|q| q.errors[i]);
        table.row([
            run.series.clone(),
            match &run.failed {
                None => run.value.clone(),
                Some(why) => format!("{}: {why}", run.value),
            },
            run.freedoms.to_string(),
            seconds(run.usage.wall_seconds),
            run.usage
                .peak_memory_bytes
                .map_or("-".to_string(), |b| bytes(b as f64)),
            run.counts.plastic_iterations.to_string(),
            error.map_or("-".to_string(), |e| significant(100.0 * e, 3)),
        ]);
    }
    text.push_str(&table.render(page_width()));
    if let Some(all) = all {
        text.push_str(
            "\nWhat accuracy costs (the worst of all quantities; bars are logarithmic)\n",
        );
        text.push_str(&cheapest_settings(study, all).render(page_width()));
    }
    text.push_str("\nPrices\n");
    for quantity in foremost(&study.quantities) {
        prices(quantity, &mut text);
    }
    if !study.left_out.is_empty() {
        text.push_str("\nLeft out\n");
        for item in &study.left_out {
            bullet(item, &mut text);
        }
    }
    text.push_str(&format!(
        "\nStudy in {}: accuracy.json, accuracy.csv, a plot per quantity ({})\n",
        out.display(),
        seconds(study.seconds)
    ));
    text
}

/// Returns the table of the cheapest setting for each error, with its time as a bar.
fn cheapest_settings(study: &Study, all: &QuantityStudy) -> Table {
    let mut table = Table::new(&[
        (Number, "error\n[%]"),
        (Number, "time"),
        (Number, "memory"),
        (Text, "cheapest setting"),
        (Text, ""),
    ]);
    let usage = |price: &Price| price.run.map(|i| study.runs[i].usage);
    let of_time = |usage: Usage| usage.undisturbed_seconds();
    let times = all.prices.iter().filter_map(usage).map(of_time);
    let shortest = times.fold(f64::INFINITY, f64::min);
    for price in &all.prices {
        let error = significant(100.0 * price.accuracy, 2);
        let Some((run, usage)) = price.run.map(|i| &study.runs[i]).zip(usage(price)) else {
            let none = "none of those that were tried".to_string();
            table.row([error, "-".into(), "-".into(), none, String::new()]);
            continue;
        };
        let length = BAR * (1.0 + (of_time(usage) / shortest).log10());
        table.row([
            error,
            seconds(of_time(usage)),
            (usage.peak_memory_bytes).map_or("-".to_string(), |b| bytes(b as f64)),
            format!("{}, {}", run.series, run.value),
            "#".repeat(length.round() as usize),
        ]);
    }
    table
}

fn prices(quantity: &QuantityStudy, text: &mut String) {
    let orders: Vec<String> = quantity
        .orders
        .iter()
        .map(|(series, order)| format!("{series} {}", significant(*order, 2)))
        .collect();
    let reference = match &quantity.reference {
        None => "the worst of all quantities".to_string(),
        Some(r) if r.uncertainty == 0.0 => format!("{} ({})", significant(r.value, 6), r.source),
        Some(r) => format!(
            "{} +- {} ({})",
            significant(r.value, 6),
            significant(r.uncertainty, 2),
            r.source
        ),
    };
    text.push_str(&format!("  {}\n", quantity.quantity));
    bullet(&format!("reference: {reference}"), text);
    if !orders.is_empty() {
        bullet(&format!("observed orders: {}", orders.join(", ")), text);
    }
    for words in &quantity.words {
        bullet(words, text);
    }
}

fn bullet(item: &str, text: &mut String) {
    for (i, line) in wrap(item, page_width() - 6).iter().enumerate() {
        let mark = if i == 0 { "    - " } else { "      " };
        text.push_str(&format!("{mark}{line}\n"));
    }
}
