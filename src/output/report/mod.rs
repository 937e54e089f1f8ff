//! `report.html`: a run for readers, with its figures as separate files.
//!
//! The report is one page without scripts that needs no network, to be read on a screen, a phone
//! and paper.
//!
//! | file | what |
//! |---|---|
//! | `page`, `tables`, `cycles`, `trust`, `load_factor` | the page: sections, tables, words |
//! | `figure`, `captioned`, `titled`, `film` | figures with captions; films of the states |
//! | `curves`, `along_contact`, `followed`, `chart` | charts: which, and how they are drawn |
//! | `profile` | chart of the stresses below the contact |
//! | `scenery`, `sketch`, `perspective`, `camera` | drawings of the scene: plane, solid |
//! | `outer` | boundary of the bodies |
//! | `states`, `fields`, `magnified` | pictures of states: fields, deformed contours |
//! | `contact_map` | pressure over a contact of solids |
//! | `patchwork`, `section` | a mesh as triangles of a plane; cuts through solids |
//! | `contact_frame`, `window` | where solids are cut; the part of a plane that is shown |
//! | `contours`, `path` | lines of equal value over triangles; lines as SVG |
//! | `picture`, `bands` | areas and lines under axes; scales of colours |
//! | `drawing`, `theme` | SVG text, colours for light and dark |
//!
//! A picture costs one pass over the elements and the work for the part in its window. The length
//! of its text depends on the lines that can be seen, not on the mesh.

mod along_contact;
mod bands;
mod camera;
mod captioned;
mod chart;
mod contact_frame;
mod contact_map;
mod contours;
mod curves;
mod cycles;
mod drawing;
mod fields;
mod figure;
mod film;
mod followed;
mod load_factor;
mod magnified;
mod outer;
mod page;
mod patchwork;
mod path;
mod perspective;
mod picture;
mod profile;
mod scenery;
mod section;
mod sketch;
mod states;
mod tables;
mod theme;
mod titled;
mod trust;
mod window;

use super::RunHeader;
use super::names::{FIGURE_PREFIX, FIGURE_SUFFIX, REPORT_FILE};
use crate::error::Result;
use crate::model::Model;
use crate::results::Results;
use crate::text::shown;
use captioned::Captioned;
#[cfg(feature = "cli")]
use chart::{Chart, ChartCurve, Pen};
use contact_frame::ContactFrame;
use page::PageFigures;
#[cfg(feature = "cli")]
use plotters::prelude::SeriesLabelPosition;
use rayon::prelude::*;
use std::borrow::Cow;

/// Draws a chart of some named curves and returns the text of an SVG file.
///
/// # Errors
/// `Internal` if it cannot be drawn.
#[cfg(feature = "cli")]
pub(super) fn line_chart(
    labels: [String; 2],
    curves: Vec<(String, Vec<[f64; 2]>)>,
) -> Result<String> {
    let curve = |(index, (label, points)): (usize, (String, Vec<[f64; 2]>))| ChartCurve {
        label,
        color: Some(index),
        pen: Pen::Dotted,
        points,
    };
    let chart = Chart {
        labels,
        widened: if curves.len() > 1 { 0.3 } else { 0.0 },
        curves: curves.into_iter().enumerate().map(curve).collect(),
        from_zero: [false, true],
        legend: SeriesLabelPosition::UpperRight,
    };
    Ok(shown(&chart.draw()?.file()).into_owned())
}

/// Returns names and contents of the report's files, the page last.
///
/// # Errors
/// `Internal` if a figure cannot be drawn.
pub(super) fn files(
    header: &RunHeader,
    model: &Model,
    results: &Results,
) -> Result<Vec<(String, String)>> {
    let labels = &header.labels;
    let frame = ContactFrame::new(model, &results.states);
    let [scene, meshed] = scenery::draw(model, results, labels, frame.as_ref())?;
    let charts: Vec<Captioned> = curves::charts(model, results, labels, frame.as_ref())
        .into_par_iter()
        .map(|titled| {
            Ok(Captioned {
                drawing: titled.chart.draw()?,
                name: titled.name,
                title: titled.title,
                caption: titled.caption,
            })
        })
        .collect::<Result<_>>()?;
    let pictures = states::draw(model, results, labels, frame.as_ref())?;
    let of = |list: &[Captioned]| list.iter().map(Captioned::figure).collect();
    let figures = PageFigures {
        scene: of(&scene),
        meshed: of(&meshed),
        charts: of(&charts),
        states: (pictures.states.iter())
            .map(|(index, list)| (results.states[*index].name.clone(), of(list)))
            .collect(),
        states_left_out: pictures.left_out,
        about_pictures: pictures.about,
    };
    let of_states = pictures.states.iter().flat_map(|(_, list)| list);
    let mut out: Vec<(String, String)> = (scene.iter().chain(&meshed).chain(&charts))
        .chain(of_states)
        .map(|figure| {
            let name = format!("{FIGURE_PREFIX}{}{FIGURE_SUFFIX}", figure.name);
            (name, figure.drawing.file())
        })
        .collect();
    let page = page::page(header, model, results, labels, &figures);
    out.push((REPORT_FILE.to_string(), page));
    for (_, text) in &mut out {
        // Titles and names may contain characters that XML does not allow.
        if let Cow::Owned(escaped) = shown(text) {
            *text = escaped;
        }
    }
    Ok(out)
}
