//! Fig 5.5 and the picture of the README: plastic zones and von Mises stress on the mesh near the
//! contact.

use crate::chart::{BLUE, FONT, GREEN, ORANGE, RED, save};
use crate::cylinder::profile;
use crate::runs::Run;
use crate::{Outcome, chart};
use brinell::mesh::Mesh;
use brinell::results::{Fields, State};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::collections::BTreeMap;

type Panel<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Half width and half height of the window, in b*.
const WINDOW: [f64; 2] = [2.8, 2.3];
const WIDTH: u32 = 900;
const BAR: u32 = 110;
const Y_LABELS: u32 = 58;
const X_LABELS: u32 = 46;
const MARGIN: u32 = 10;
const CAPTION: u32 = 34;

/// Height of a panel in which both axes have the same scale.
fn field_height() -> u32 {
    let across = f64::from(WIDTH - BAR - Y_LABELS - 2 * MARGIN);
    (across * WINDOW[1] / WINDOW[0]).round() as u32 + X_LABELS + 2 * MARGIN
}

pub fn draw(run: &Run) -> Outcome<()> {
    zones(run)?;
    pressure_and_stress(run)
}

/// Deformed coordinates in multiples of b*, the centre of the contact at the origin.
struct Shape<'a> {
    mesh: &'a Mesh,
    points: Vec<(f64, f64)>,
}

impl<'a> Shape<'a> {
    fn new(run: &'a Run, fields: &Fields) -> Outcome<Shape<'a>> {
        let mesh = &run.analysis.model().mesh;
        let middle = &run.analysis.model().pairs;
        let middle = middle
            .iter()
            .map(|pair| pair.slave)
            .min_by(|&a, &b| mesh.point(a)[0].abs().total_cmp(&mesh.point(b)[0].abs()))
            .ok_or("no contact pair")?;
        let place = |node: usize| {
            let (x, u) = (
                mesh.point(node),
                &fields.displacement[2 * node..2 * node + 2],
            );
            (x[0] + u[0], x[1] + u[1])
        };
        let (x0, y0) = place(middle);
        let b = run.yield_half_width;
        let points = (0..mesh.n_nodes())
            .map(|node| {
                let (x, y) = place(node);
                ((x - x0) / b, (y - y0) / b)
            })
            .collect();
        Ok(Shape { mesh, points })
    }

    fn corners(&self, element: usize) -> Vec<usize> {
        let n = self.mesh.shapes[element].n_corners();
        self.mesh.nodes(element)[..n]
            .iter()
            .map(|&node| node as usize)
            .collect()
    }

    /// Elements that reach into the window.
    fn visible(&self) -> Vec<usize> {
        let inside = |node: usize| {
            let (x, y) = self.points[node];
            x.abs() < WINDOW[0] && y.abs() < WINDOW[1]
        };
        (0..self.mesh.n_elements())
            .filter(|&e| self.corners(e).into_iter().any(inside))
            .collect()
    }

    /// A node's place, moved to the edge of the window where it lies outside.
    fn at(&self, node: usize, side: f64) -> (f64, f64) {
        let (x, y) = self.points[node];
        (
            side * x.clamp(-WINDOW[0], WINDOW[0]),
            y.clamp(-WINDOW[1], WINDOW[1]),
        )
    }

    /// Edges between elements that have yielded and others, not those on a body's surface.
    fn zone_edges(&self, yielded: &[u8]) -> Vec<[usize; 2]> {
        let mut owners: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for element in self.visible() {
            let nodes = self.corners(element);
            for i in 0..nodes.len() {
                let (a, b) = (nodes[i], nodes[(i + 1) % nodes.len()]);
                owners
                    .entry([a.min(b), a.max(b)])
                    .or_default()
                    .push(element);
            }
        }
        let parted = |e: &Vec<usize>| e.len() == 2 && yielded[e[0]] != yielded[e[1]];
        owners
            .into_iter()
            .filter(|(_, e)| parted(e))
            .map(|(edge, _)| edge)
            .collect()
    }
}

fn fields(state: &State) -> Outcome<&Fields> {
    state
        .fields
        .as_ref()
        .ok_or_else(|| format!("state `{}` has no fields", state.name).into())
}

fn field_panel<'a>(
    area: &DrawingArea<SVGBackend<'a>, plotters::coord::Shift>,
) -> Outcome<Panel<'a>> {
    let [w, h] = WINDOW;
    Ok(ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(-w..w, -h..h)?)
}

fn axes(panel: &mut Panel) -> Outcome<()> {
    panel
        .configure_mesh()
        .disable_mesh()
        .x_desc("x/b*")
        .y_desc("y/b*")
        .axis_desc_style((FONT, 16))
        .label_style((FONT, 14))
        .draw()?;
    Ok(())
}

fn name_bodies(panel: &mut Panel, color: RGBColor) -> Outcome<()> {
    let style = (FONT, 17).into_font().color(&color);
    let x = -WINDOW[0] + 0.08;
    panel.draw_series([
        Text::new("cylinder", (x, WINDOW[1] - 0.08), style.clone()),
        Text::new("half plane", (x, -WINDOW[1] + 0.2), style),
    ])?;
    Ok(())
}

fn outline(panel: &mut Panel, shape: &Shape, yielded: &[u8], style: ShapeStyle) -> Outcome<()> {
    let edges = shape.zone_edges(yielded);
    for side in [-1.0, 1.0] {
        panel.draw_series(
            edges
                .iter()
                .map(|e| PathElement::new(e.map(|node| shape.at(node, side)).to_vec(), style)),
        )?;
    }
    Ok(())
}

/// Fig 5.5: the plastic zones at several load factors, on the mesh.
fn zones(run: &Run) -> Outcome<()> {
    let states = [("1.3207", BLUE), ("1.5870", GREEN), ("1.5 b*", ORANGE)];
    let widest = run.state("1.5 b*")?;
    let shape = Shape::new(run, fields(widest)?)?;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, field_height() + CAPTION))
            .into_drawing_area();
        root.fill(&WHITE)?;
        let root = root.titled("Plastic zones under load (paper, Fig 5.5)", (FONT, 18))?;
        let (left, right) = root.split_horizontally(WIDTH - BAR);
        let mut panel = field_panel(&left)?;
        let mut filled = vec![false; shape.mesh.n_elements()];
        for (name, color) in states {
            let yielded = &fields(run.state(name)?)?.yielded;
            let elements: Vec<usize> = shape
                .visible()
                .into_iter()
                .filter(|&e| yielded[e] > 0 && !filled[e])
                .collect();
            for &e in &elements {
                filled[e] = true;
            }
            for side in [-1.0, 1.0] {
                panel.draw_series(elements.iter().map(|&e| {
                    let corners: Vec<_> = shape
                        .corners(e)
                        .into_iter()
                        .map(|node| shape.at(node, side))
                        .collect();
                    Polygon::new(corners, mixed(color, 0.45).filled())
                }))?;
            }
        }
        // The mesh, on one side of the symmetry plane.
        panel.draw_series(shape.visible().into_iter().map(|e| {
            let mut corners: Vec<_> = shape
                .corners(e)
                .into_iter()
                .map(|node| shape.at(node, -1.0))
                .collect();
            corners.push(corners[0]);
            PathElement::new(corners, mixed(BLACK, 0.2).stroke_width(1))
        }))?;
        for (name, color) in states {
            outline(
                &mut panel,
                &shape,
                &fields(run.state(name)?)?.yielded,
                color.stroke_width(2),
            )?;
        }
        name_bodies(&mut panel, BLACK)?;
        axes(&mut panel)?;
        right.draw(&Text::new("P/P*", (22, 24), (FONT, 16).into_font()))?;
        for (i, (name, color)) in states.into_iter().enumerate() {
            let y = 56 + 30 * i as i32;
            right.draw(&Rectangle::new(
                [(4, y - 8), (24, y + 8)],
                mixed(color, 0.45).filled(),
            ))?;
            right.draw(&Rectangle::new(
                [(4, y - 8), (24, y + 8)],
                color.stroke_width(2),
            ))?;
            right.draw(&Text::new(
                format!("{:.3}", run.state(name)?.alpha),
                (32, y - 8),
                (FONT, 15).into_font(),
            ))?;
        }
        root.present()?;
    }
    save("fig_5_5_plastic_zone.svg", &crisp(&text))
}

/// The picture: contact pressure above, von Mises stress and plastic zone below.
fn pressure_and_stress(run: &Run) -> Outcome<()> {
    let state = run.state("1.5 b*")?;
    let fields = fields(state)?;
    let shape = Shape::new(run, fields)?;
    let y = run
        .analysis
        .model()
        .materials
        .first()
        .ok_or("no material")?
        .yield_stress();
    let visible = shape.visible();
    let largest = visible
        .iter()
        .map(|&e| fields.von_mises[e] / y)
        .fold(0.0, f64::max);
    let top = (10.0 * largest).ceil() / 10.0;
    let above = 190;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, CAPTION + above + field_height()))
            .into_drawing_area();
        root.fill(&WHITE)?;
        let title = format!(
            "Cylinder on a half plane at {:.2} times the yield load",
            state.alpha
        );
        let root = root.titled(&title, (FONT, 20))?;
        let (upper, lower) = root.split_vertically(above);
        let (upper, _) = upper.split_horizontally(WIDTH - BAR);
        let (left, right) = lower.split_horizontally(WIDTH - BAR);

        let mut pressure = ChartBuilder::on(&upper)
            .margin(MARGIN)
            .x_label_area_size(8)
            .y_label_area_size(Y_LABELS)
            .build_cartesian_2d(-WINDOW[0]..WINDOW[0], 0.0..1.45)?;
        pressure
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(0)
            .y_labels(4)
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .y_desc("pressure p/p*")
            .axis_desc_style((FONT, 15))
            .label_style((FONT, 14))
            .draw()?;
        let curve = mirrored(&profile(run, state));
        pressure.draw_series([Polygon::new(curve.clone(), mixed(RED, 0.3).filled())])?;
        pressure.draw_series(LineSeries::new(curve, RED.stroke_width(2)))?;
        let load = state.load;
        let elastic: Vec<(f64, f64)> = (0..=120)
            .map(|i| f64::from(i) / 60.0 - 1.0)
            .map(|s| {
                (
                    s * state.alpha.sqrt(),
                    state.alpha.sqrt() * (1.0 - s * s).max(0.0).sqrt(),
                )
            })
            .collect();
        pressure.draw_series(plotters::series::DashedLineSeries::new(
            elastic,
            6,
            5,
            chart::GREY.stroke_width(2),
        ))?;
        let note = (FONT, 14).into_font();
        pressure.draw_series([
            Text::new(
                format!("elastoplastic, P = {load:.0} N/mm"),
                (0.5 * WINDOW[0], 1.36),
                note.clone().color(&RED),
            ),
            Text::new(
                "elastic (Hertz), same load".to_string(),
                (0.5 * WINDOW[0], 1.16),
                note.color(&chart::GREY),
            ),
        ])?;

        let mut panel = field_panel(&left)?;
        for side in [-1.0, 1.0] {
            panel.draw_series(visible.iter().map(|&e| {
                let corners: Vec<_> = shape
                    .corners(e)
                    .into_iter()
                    .map(|node| shape.at(node, side))
                    .collect();
                Polygon::new(corners, shade(fields.von_mises[e] / y / top).filled())
            }))?;
        }
        outline(&mut panel, &shape, &fields.yielded, WHITE.stroke_width(2))?;
        name_bodies(&mut panel, WHITE)?;
        let note = (FONT, 14).into_font().color(&WHITE);
        panel.draw_series([Text::new(
            "white line: plastic zone",
            (0.5 * WINDOW[0], 0.2 - WINDOW[1]),
            note,
        )])?;
        axes(&mut panel)?;
        color_bar(&right, top)?;
        root.present()?;
    }
    save("pressure_and_plastic_zone.svg", &crisp(&text))
}

fn mirrored(half: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let left = half
        .iter()
        .rev()
        .filter(|p| p.0 > 0.0)
        .map(|&(x, y)| (-x, y));
    left.chain(half.iter().copied()).collect()
}

fn color_bar(area: &DrawingArea<SVGBackend, plotters::coord::Shift>, top: f64) -> Outcome<()> {
    let (from, to) = (
        MARGIN as i32,
        field_height() as i32 - (X_LABELS + MARGIN) as i32,
    );
    const STEPS: i32 = 60;
    for i in 0..STEPS {
        let place = |i: i32| to - (to - from) * i / STEPS;
        let color = shade((f64::from(i) + 0.5) / f64::from(STEPS));
        area.draw(&Rectangle::new(
            [(8, place(i + 1)), (28, place(i))],
            color.filled(),
        ))?;
    }
    let ticks = (top / 0.2).round() as i32;
    for i in 0..=ticks {
        let value = 0.2 * f64::from(i);
        if value <= top + 1e-9 {
            let y = to - (f64::from(to - from) * value / top).round() as i32;
            area.draw(&PathElement::new(vec![(28, y), (33, y)], BLACK))?;
            area.draw(&Text::new(
                format!("{value:.1}"),
                (38, y - 7),
                (FONT, 14).into_font(),
            ))?;
        }
    }
    let turned = (FONT, 15).into_font().transform(FontTransform::Rotate90);
    area.draw(&Text::new(
        "von Mises / yield stress",
        (88, (from + to) / 2 - 80),
        turned,
    ))?;
    Ok(())
}

/// From dark to light with the stress, 0 to 1.
fn shade(value: f64) -> RGBColor {
    const STOPS: [[f64; 3]; 6] = [
        [13.0, 8.0, 135.0],
        [84.0, 2.0, 163.0],
        [156.0, 23.0, 158.0],
        [204.0, 71.0, 120.0],
        [237.0, 121.0, 83.0],
        [253.0, 202.0, 38.0],
    ];
    let scaled = value.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let i = (scaled as usize).min(STOPS.len() - 2);
    let t = scaled - i as f64;
    let [r, g, b]: [u8; 3] =
        std::array::from_fn(|c| (STOPS[i][c] + t * (STOPS[i + 1][c] - STOPS[i][c])).round() as u8);
    RGBColor(r, g, b)
}

/// A colour on white paper.
fn mixed(color: RGBColor, strength: f64) -> RGBColor {
    let mix = |c: u8| (255.0 - strength * (255.0 - f64::from(c))).round() as u8;
    RGBColor(mix(color.0), mix(color.1), mix(color.2))
}

/// Without it renderers show hairlines between neighbouring elements. What is fully opaque need not
/// say so.
fn crisp(text: &str) -> String {
    text.replace(" opacity=\"1\"", "")
        .replace("<polygon ", "<polygon shape-rendering=\"crispEdges\" ")
}
