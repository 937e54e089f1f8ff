//! Figures 5.2 to 5.5: the cylinder on the half plane.

use crate::chart::{Axis, BLUE, Chart, Curve, GREEN, GREY, ORANGE, Pen, RED};
use crate::runs::{self, Run, first_yield, half_width, load_factor, with_fields};
use crate::{Outcome, zone};
use brinell::results::State;
use plotters::prelude::SeriesLabelPosition;

/// Loading states of the paper's legend with the unloading state of (nearly) the same contact
/// width.
const PAIRS: [(&str, Option<&str>); 4] = [
    ("1.0515", Some("0.8670")),
    ("1.3207", Some("1.1390")),
    ("1.5870", Some("1.4351")),
    ("1.5 b*", None),
];

pub fn draw() -> Outcome<()> {
    let mut targets = vec![first_yield()];
    let between = [1.02, 1.0515, 1.1, 1.2, 1.3207, 1.45, 1.5870, 1.75, 1.9];
    for alpha in between {
        let target = load_factor(alpha, &format!("{alpha:.4}"));
        let wanted = alpha == 1.3207 || alpha == 1.5870;
        targets.push(if wanted { with_fields(target) } else { target });
    }
    targets.push(with_fields(half_width(1.5, "1.5 b*")));
    for (alpha, name) in [(1.4351, "1.4351"), (1.1390, "1.1390"), (0.8670, "0.8670")] {
        targets.push(load_factor(alpha, name));
    }
    targets.push(half_width(0.3, "0.3 b*"));
    targets.push(with_fields(load_factor(0.0, "unloaded")));
    let run = Run::of(runs::cylinder(None, None)?, targets)?;
    history(&run)?;
    pressures(&run)?;
    residual_depth(&run)?;
    zone::draw(&run)
}

/// Fig 5.2: maximum pressure and half width against the load factor.
fn history(run: &Run) -> Outcome<()> {
    let rows = &run.results.history;
    let top = (0..rows.len())
        .max_by(|&a, &b| rows[a].alpha.total_cmp(&rows[b].alpha))
        .unwrap_or(0);
    let series = |range: std::ops::Range<usize>, value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        range
            .filter(|&i| rows[i].half_width > 0.1 * run.yield_half_width)
            .map(|i| (rows[i].alpha, value(i)))
            .collect()
    };
    let pressure = |i: usize| rows[i].max_pressure / run.yield_pressure;
    let width = |i: usize| rows[i].half_width / run.yield_half_width;
    let elastic = (0..=220)
        .map(|i| f64::from(i) * 0.01)
        .map(|a| (a, a.sqrt()))
        .collect();
    Chart {
        file: "fig_5_2_pressure_and_width.svg",
        title: "Cylinder on a half plane: contact against load (paper, Fig 5.2)",
        x: Axis {
            label: "load factor  P/P*",
            from: 0.0,
            to: 2.2,
        },
        y: Axis {
            label: "p/p*  and  b/b*",
            from: 0.0,
            to: 1.6,
        },
        legend: SeriesLabelPosition::LowerRight,
        curves: vec![
            Curve::new(
                "elastic, exact: p/p* = b/b* = sqrt(P/P*)",
                GREY,
                Pen::Dashes,
                elastic,
            ),
            Curve::new(
                "half width b/b*, loading",
                BLUE,
                Pen::LineAndDots,
                series(0..top + 1, &width),
            ),
            Curve::new(
                "half width b/b*, unloading",
                BLUE,
                Pen::DashesAndDots,
                series(top..rows.len(), &width),
            ),
            Curve::new(
                "largest pressure p/p*, loading",
                RED,
                Pen::LineAndDots,
                series(0..top + 1, &pressure),
            ),
            Curve::new(
                "largest pressure p/p*, unloading",
                RED,
                Pen::DashesAndDots,
                series(top..rows.len(), &pressure),
            ),
        ],
    }
    .write()
}

/// Pressure over the contact, from the symmetry plane to the edge.
pub fn profile(run: &Run, state: &State) -> Vec<(f64, f64)> {
    let (b, p) = (run.yield_half_width, run.yield_pressure);
    let mut points: Vec<(f64, f64)> = state
        .pairs
        .iter()
        .filter(|k| k.force > 0.0)
        .map(|k| (k.position[0] / b, k.pressure / p))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.push((state.half_width / b, 0.0));
    points
}

/// Fig 5.3: contact pressure at four widths, loading and unloading.
fn pressures(run: &Run) -> Outcome<()> {
    let colors = [BLUE, GREEN, ORANGE, RED];
    let mut curves = Vec::new();
    for ((up, down), color) in PAIRS.into_iter().zip(colors) {
        let state = run.state(up)?;
        curves.push(Curve::new(
            &format!("loading {:.4}", state.alpha),
            color,
            Pen::LineAndDots,
            profile(run, state),
        ));
        if let Some(down) = down {
            let label = format!("unloading {down}");
            curves.push(Curve::new(
                &label,
                color,
                Pen::DashesAndDots,
                profile(run, run.state(down)?),
            ));
        }
    }
    let hertz = (0..=100)
        .map(|i| f64::from(i) * 0.01)
        .map(|x| (x, (1.0 - x * x).sqrt()))
        .collect();
    curves.push(Curve::new(
        "first yield, exact (Hertz)",
        GREY,
        Pen::Dashes,
        hertz,
    ));
    Chart {
        file: "fig_5_3_pressure_distribution.svg",
        title: "Contact pressure, loading and unloading (paper, Fig 5.3)",
        x: Axis {
            label: "x/b*",
            from: 0.0,
            to: 1.6,
        },
        y: Axis {
            label: "p/p*",
            from: 0.0,
            to: 1.4,
        },
        legend: SeriesLabelPosition::LowerLeft,
        curves,
    }
    .write()
}

/// Fig 5.4: the dent that is left.
fn residual_depth(run: &Run) -> Outcome<()> {
    let micrometres = |s: &State| (s.alpha, 1e3 * s.residual_depth);
    let states = &run.results.states;
    let top = states
        .iter()
        .position(|s| s.name == "1.5 b*")
        .ok_or("no state at 1.5 b*")?;
    Chart {
        file: "fig_5_4_residual_depth.svg",
        title: "Dent left by the plastic strains (paper, Fig 5.4)",
        x: Axis {
            label: "load factor  P/P*",
            from: 0.0,
            to: 2.2,
        },
        y: Axis {
            label: "residual depth at the origin, micrometres (R = 10 mm)",
            from: 0.0,
            to: 0.4,
        },
        legend: SeriesLabelPosition::MiddleLeft,
        curves: vec![
            Curve::new(
                "loading",
                RED,
                Pen::LineAndDots,
                states[..=top].iter().map(micrometres).collect(),
            ),
            Curve::new(
                "unloading from 1.5 b*",
                BLUE,
                Pen::DashesAndDots,
                states[top..].iter().map(micrometres).collect(),
            ),
        ],
    }
    .write()
}
