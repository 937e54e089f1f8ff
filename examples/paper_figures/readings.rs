//! Which meaning of "hardening coefficient equal to 0.6" (Fig 5.1) gives the load factors of Fig
//! 5.3's legend.
//!
//! The legend names four load factors on the way up and three on the way down, "at four contact
//! widths". Read as the same widths up and down, 1.0515 belongs to 0.8670, 1.3207 to 1.1390, 1.5870
//! to 1.4351, and 2.0635 to 1.5 b*. For each reading the widths are measured on the way up; the
//! load factors at which they come back on the way down from 2.0635, and the load factor at 1.5 b*,
//! are compared with the legend: four numbers that no choice of ours enters.

use crate::Outcome;
use crate::runs::{self, Run, first_yield, half_width, load_factor};

const LOADING: [f64; 3] = [1.0515, 1.3207, 1.5870];
const UNLOADING: [f64; 3] = [0.8670, 1.1390, 1.4351];
const TOP: f64 = 2.0635;
const TOP_WIDTH: f64 = 1.5;
const RESOLUTIONS: [usize; 2] = [16, 32];

/// Readings by their ratio H/E of plastic modulus to Young's modulus, nu = 0.3: G = E/2.6.
const READINGS: [(&str, f64); 8] = [
    ("perfectly plastic", 0.0),
    ("H/G = 0.6", 0.6 / 2.6),
    ("sqrt(H/E) = 0.6", 0.36),
    ("H/E = 0.6", 0.6),
    ("H/3G = 0.6", 0.6 * 3.0 / 2.6),
    ("H/E = sqrt(0.6)", 0.774_596_669_241_483_4),
    ("H/E = 1", 1.0),
    ("Et/E = H/(E+H) = 0.6", 1.5),
];

/// What a reading gives: b/b* at the legend's loading factors, load factor at 1.5 b*, load factors
/// on the way down.
struct Answer {
    widths: [f64; 3],
    at_top_width: f64,
    down: [f64; 3],
}

impl Answer {
    fn compute(ratio: f64, resolution: usize) -> Outcome<Answer> {
        let names = ["1", "2", "3"];
        let mut up = vec![first_yield()];
        up.extend(
            LOADING
                .iter()
                .zip(names)
                .map(|(&alpha, name)| load_factor(alpha, name)),
        );
        up.push(half_width(TOP_WIDTH, "top"));
        let up = Run::of(runs::cylinder(Some(ratio), Some(resolution))?, up)?;
        let mut widths = [0.0; 3];
        for (width, name) in widths.iter_mut().zip(names) {
            *width = up.state(name)?.half_width / up.yield_half_width;
        }
        let mut down = vec![first_yield(), load_factor(TOP, "top")];
        down.extend(
            widths
                .iter()
                .zip(names)
                .rev()
                .map(|(&width, name)| half_width(width, name)),
        );
        let run = Run::of(runs::cylinder(Some(ratio), Some(resolution))?, down)?;
        let mut back = [0.0; 3];
        for (alpha, name) in back.iter_mut().zip(names) {
            *alpha = run.state(name)?.alpha;
        }
        Ok(Answer {
            widths,
            at_top_width: up.state("top")?.alpha,
            down: back,
        })
    }

    /// Hertz: b/b* = sqrt(alpha), up and down.
    fn elastic() -> Answer {
        Answer {
            widths: LOADING.map(f64::sqrt),
            at_top_width: TOP_WIDTH * TOP_WIDTH,
            down: LOADING,
        }
    }

    /// Root mean square of the relative differences from the legend's four load factors.
    fn misfit(&self) -> f64 {
        let off = |computed: f64, legend: f64| (computed / legend - 1.0).powi(2);
        let down: f64 = self
            .down
            .iter()
            .zip(UNLOADING)
            .map(|(c, l)| off(*c, l))
            .sum();
        (0.25 * (off(self.at_top_width, TOP) + down)).sqrt()
    }
}

pub fn write() -> Outcome<()> {
    let path = runs::data("reference/endahl/hardening_readings.csv");
    let mut file = csv::Writer::from_path(&path)?;
    file.write_record([
        "reading",
        "plastic_modulus_over_E",
        "resolution",
        "half_width_at_1.0515",
        "half_width_at_1.3207",
        "half_width_at_1.5870",
        "load_factor_at_1.5_b*",
        "unloading_at_first_width",
        "unloading_at_second_width",
        "unloading_at_third_width",
        "rms_difference_from_legend",
    ])?;
    let mut row = |reading: &str, ratio: &str, resolution: &str, answer: &Answer| -> Outcome<()> {
        let mut record = vec![
            reading.to_string(),
            ratio.to_string(),
            resolution.to_string(),
        ];
        let numbers = answer
            .widths
            .iter()
            .chain([&answer.at_top_width])
            .chain(&answer.down);
        record.extend(numbers.map(|v| format!("{v:.4}")));
        record.push(format!("{:.4}", answer.misfit()));
        println!("{}", record.join(", "));
        Ok(file.write_record(&record)?)
    };
    for resolution in RESOLUTIONS {
        for (reading, ratio) in READINGS {
            let answer = Answer::compute(ratio, resolution)?;
            row(
                reading,
                &format!("{ratio:.4}"),
                &resolution.to_string(),
                &answer,
            )?;
        }
    }
    row("elastic", "", "exact", &Answer::elastic())?;
    file.flush()?;
    println!("{}", path.display());
    Ok(())
}
