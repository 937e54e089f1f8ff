//! Figures 5.7 and 5.8: the disc in the plate.

use crate::Outcome;
use crate::chart::{Axis, BLUE, Chart, Curve, GREEN, GREY, Pen, RED};
use crate::runs::{self, Run, first_yield, load_factor};
use brinell::analytical::DiscInPlate;
use brinell::results::State;
use plotters::prelude::SeriesLabelPosition;

/// Load factors of the distributions, up and down.
const SHOWN: [f64; 3] = [1.0, 1.5, 2.0];

pub fn draw() -> Outcome<()> {
    let mut targets = vec![first_yield()];
    for i in 1..=10 {
        let alpha = 1.0 + 0.1 * f64::from(i);
        targets.push(load_factor(alpha, &format!("up {alpha:.1}")));
    }
    for i in (0..20).rev() {
        let alpha = 0.1 * f64::from(i);
        targets.push(load_factor(alpha, &format!("down {alpha:.1}")));
    }
    let run = Run::of(runs::scene("disc_in_plate.toml")?, targets)?;
    history(&run)?;
    distribution(&run)
}

/// Remote tension at first yield over the yield stress.
fn yield_tension(run: &Run) -> Outcome<f64> {
    let first = run.results.first_yield.ok_or("no first yield")?;
    Ok(first.load / yield_stress(run)?)
}

fn yield_stress(run: &Run) -> Outcome<f64> {
    let materials = &run.analysis.model().materials;
    Ok(materials.first().ok_or("no material")?.yield_stress())
}

/// Fig 5.7: largest contact pressure against the load factor.
fn history(run: &Run) -> Outcome<()> {
    let exact = DiscInPlate::new(10.0)?;
    let (tension, y) = (yield_tension(run)?, yield_stress(run)?);
    let states = &run.results.states;
    let up = |s: &State| (s.alpha, s.max_pressure / y);
    let top = states
        .iter()
        .position(|s| s.name == "up 2.0")
        .ok_or("no state at 2")?;
    let mut loading = vec![(0.0, 0.0)];
    loading.extend(states[..=top].iter().map(up));
    let elastic = vec![(0.0, 0.0), (2.2, exact.pressure(0.0, 2.2 * tension))];
    Chart {
        file: "fig_5_7_disc_pressure.svg",
        title: "Disc in a plate: largest contact pressure (paper, Fig 5.7)",
        x: Axis {
            label: "load factor  S/S*",
            from: 0.0,
            to: 2.2,
        },
        y: Axis {
            label: "largest contact pressure / yield stress",
            from: 0.0,
            to: 0.6,
        },
        legend: SeriesLabelPosition::UpperLeft,
        curves: vec![
            Curve::new("elastic, exact: 0.609 S", GREY, Pen::Dashes, elastic),
            Curve::new("loading", RED, Pen::LineAndDots, loading),
            Curve::new(
                "unloading",
                BLUE,
                Pen::DashesAndDots,
                states[top..].iter().map(up).collect(),
            ),
        ],
    }
    .write()
}

/// Fig 5.8: pressure over the angle from the pole.
fn distribution(run: &Run) -> Outcome<()> {
    let exact = DiscInPlate::new(10.0)?;
    let (tension, y) = (yield_tension(run)?, yield_stress(run)?);
    let profile = |state: &State| -> Vec<(f64, f64)> {
        let mut points: Vec<(f64, f64)> = state
            .pairs
            .iter()
            .map(|k| {
                (
                    k.position[0].atan2(k.position[1]).to_degrees(),
                    k.pressure / y,
                )
            })
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let closed = |i: usize| points.get(i).is_some_and(|p| p.1 > 0.0);
        // The contact and the first open pair at either end.
        (0..points.len())
            .filter(|&i| closed(i) || closed(i + 1) || (i > 0 && closed(i - 1)))
            .map(|i| points[i])
            .collect()
    };
    let mut curves = Vec::new();
    for (alpha, color) in SHOWN.into_iter().zip([BLUE, GREEN, RED]) {
        let name = if alpha == 1.0 {
            "yield".to_string()
        } else {
            format!("up {alpha:.1}")
        };
        let up = run.state(&name)?;
        curves.push(Curve::new(
            &format!("loading {alpha:.1}"),
            color,
            Pen::LineAndDots,
            profile(up),
        ));
        if alpha < 2.0 {
            let down = run.state(&format!("down {alpha:.1}"))?;
            let label = format!("unloading {alpha:.1}");
            curves.push(Curve::new(&label, color, Pen::DashesAndDots, profile(down)));
        }
    }
    let fine = (0..=100).map(|i| exact.half_angle() * f64::from(i) / 100.0);
    let at_yield = fine
        .map(|t| (t.to_degrees(), exact.pressure(t, tension * y) / y))
        .collect();
    curves.push(Curve::new(
        "first yield, exact",
        GREY,
        Pen::Dashes,
        at_yield,
    ));
    Chart {
        file: "fig_5_8_disc_pressure_distribution.svg",
        title: "Disc in a plate: contact pressure (paper, Fig 5.8)",
        x: Axis {
            label: "angle from the pole, degrees",
            from: 0.0,
            to: 30.0,
        },
        y: Axis {
            label: "contact pressure / yield stress",
            from: 0.0,
            to: 0.5,
        },
        legend: SeriesLabelPosition::UpperRight,
        curves,
    }
    .write()
}
